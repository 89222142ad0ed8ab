//! wgpu on SwiftShader, the software Vulkan driver that Chromium ships: another compiler than Mesa's.

use std::path::Path;
use std::sync::Once;

use super::{Entry, Unavailable};
use crate::harness::gpu::{Named, Shaders, Wanted};

pub const EXECUTOR: Entry = Entry {
    name: "swiftshader",
    about: "wgpu on Vulkan, Chromium's SwiftShader",
    needs: &["chromium", "libvulkan1"],
    open: || {
        if !announce() {
            return Err(Unavailable { reason: format!("there is no {} driver", NAME) });
        }
        super::opened(Wanted { backend: wgpu::Backends::VULKAN, named: Named::With(NAME), shaders: Shaders::Translated })
    },
};

/// Part of the adapter's name.
pub const NAME: &str = "SwiftShader";

/// Where packages put the driver's manifest.
const MANIFESTS: &[&str] = &[
    "/usr/lib/chromium/vk_swiftshader_icd.json",
    "/usr/lib64/chromium-browser/vk_swiftshader_icd.json",
    "/opt/google/chrome/vk_swiftshader_icd.json",
];

/// Tells the Vulkan loader of the driver, beside those it knows; false where it is not installed.
///
/// The loader reads the environment when an instance is made. Call this before other threads are
/// started: it is done once, and opening the executor does it too.
pub fn announce() -> bool {
    static ONCE: Once = Once::new();
    let Some(manifest) = MANIFESTS.iter().find(|path| Path::new(path).is_file()) else { return false };
    ONCE.call_once(|| {
        let known = std::env::var("VK_ADD_DRIVER_FILES").unwrap_or_default();
        let list = if known.is_empty() { (*manifest).to_owned() } else { format!("{known}:{manifest}") };
        // SAFETY: Rust's own accesses are locked. The command line and the tests call this while
        // they have one thread, so that no foreign code reads the environment meanwhile.
        unsafe { std::env::set_var("VK_ADD_DRIVER_FILES", list) };
    });
    true
}

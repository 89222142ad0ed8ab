//! wgpu on SwiftShader, the software Vulkan driver that comes with Chromium. Its compiler is not
//! Mesa's.
//!
//! Runs on: every system but WebAssembly

use std::path::Path;
use std::sync::Once;

use super::{DEVICE_SAMPLES, ExecutorEntry, Shipping, Unavailable};
use crate::dispatch::ComputeForm;
use crate::Session;
use crate::gpu::{AdapterName, Shaders};
use lamplight_bundle::Target;

pub const EXECUTOR: ExecutorEntry = ExecutorEntry {
    name: "swiftshader",
    about: "wgpu on Vulkan, Chromium's SwiftShader",
    needs: &["chromium", "libvulkan1"],
    before_threads: Some(announce),
    samples: Some(DEVICE_SAMPLES),
    open,
    // wgpu reads WGSL itself.
    shipping: Some(Shipping { target: Target::WGSL, open }),
    reads_glsl: false,
    compute: Some(ComputeForm::Output(Target::WGSL)),
};

fn open() -> Result<Box<dyn Session>, Unavailable> {
    installed()?;
    super::open_vulkan(AdapterName::With(NAME), Shaders::Translated)
}

/// Whether the driver is installed. If so, it is announced to the loader.
pub fn installed() -> Result<(), Unavailable> {
    announce();
    Ok(driver_manifest().map(|_| ()).ok_or_else(|| format!("there is no {NAME} driver"))?)
}

/// Part of the adapter's name.
pub const NAME: &str = "SwiftShader";

/// Where packages install the driver's manifest.
const MANIFESTS: &[&str] = &[
    "/usr/lib/chromium/vk_swiftshader_icd.json",
    "/usr/lib64/chromium-browser/vk_swiftshader_icd.json",
    "/opt/google/chrome/vk_swiftshader_icd.json",
];

/// Tells the Vulkan loader about the driver, if it is installed, in addition to the drivers that it
/// finds itself.
///
/// The loader reads the environment when an instance is made. Call this before other threads are
/// started: it is done once, and opening the executor does it too.
pub fn announce() {
    static ONCE: Once = Once::new();
    let Some(manifest) = driver_manifest() else { return };
    ONCE.call_once(|| {
        let known = std::env::var("VK_ADD_DRIVER_FILES").unwrap_or_default();
        let list =
            if known.is_empty() { manifest.to_owned() } else { format!("{known}:{manifest}") };
        // SAFETY: Rust's own accesses are locked. The command line and the tests call this while
        // they have one thread, so that no foreign code reads the environment meanwhile.
        unsafe { std::env::set_var("VK_ADD_DRIVER_FILES", list) };
    });
}

/// The path of the driver's manifest, if it is installed.
fn driver_manifest() -> Option<&'static str> {
    MANIFESTS.iter().copied().find(|path| Path::new(path).is_file())
}

//! Everything that can run a kernel: one file of `executors/` for each. The line `Runs on:` of a
//! file says which systems have the executor. The build script reads it.

use super::Session;
use super::dispatch::ComputeForm;
use lamplight_bundle::Target;

/// An executor that is not open yet.
pub struct ExecutorEntry {
    /// Name on the command line.
    pub name: &'static str,
    /// One line.
    pub about: &'static str,
    /// Debian packages it needs.
    pub needs: &'static [&'static str],
    /// What must be done before the executor is opened, while the process has only one thread.
    pub before_threads: Option<fn()>,
    /// The default number of samples per pixel of a picture. `None` if the executor does not draw
    /// frames.
    pub samples: Option<u32>,
    /// Opens a device.
    pub open: OpenSession,
    /// What it can draw from the bytes of a bundle.
    pub shipping: Option<Shipping>,
    /// Whether it compiles the text of GLSL modules itself, so that it runs no others.
    pub reads_glsl: bool,
    /// The form in which it runs compute entry points: [`Session::dispatch`]. `None` if it has
    /// no such stage.
    pub compute: Option<ComputeForm>,
}

pub type OpenSession = fn() -> Result<Box<dyn Session>, Unavailable>;

/// A target, and what opens a session that draws the files of this target as they are. Every target
/// has an executor with one.
pub struct Shipping {
    pub target: Target,
    pub open: OpenSession,
}

/// Why an executor cannot be used on this machine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unavailable {
    pub reason: String,
}

impl From<String> for Unavailable {
    fn from(reason: String) -> Self {
        Self { reason }
    }
}

impl ExecutorEntry {
    /// Opens the executor. The error is a message that also says how to install it. Open, use and
    /// drop it inside of [`on_thread`](super::on_thread).
    pub fn start(&self) -> Result<Box<dyn Session>, String> {
        (self.open)().map_err(|unavailable| self.missing(&unavailable))
    }

    /// The message for someone on whose machine it is missing, with the command that installs it.
    pub fn missing(&self, unavailable: &Unavailable) -> String {
        let install = if self.needs.is_empty() {
            String::new()
        } else {
            format!("\ninstall it with: apt-get install {}", self.needs.join(" "))
        };
        format!("the executor `{}` is not available: {}{install}", self.name, unavailable.reason)
    }
}

/// The default number of samples per pixel on devices.
#[cfg(not(target_family = "wasm"))]
const DEVICE_SAMPLES: u32 = 4;

/// A session on a device of wgpu.
#[cfg(not(target_family = "wasm"))]
fn open_gpu(wanted: super::gpu::DeviceRequest) -> Result<Box<dyn Session>, Unavailable> {
    Ok(Box::new(super::gpu::open_gpu(wanted)?))
}

/// A session on the Vulkan driver with that name.
#[cfg(not(target_family = "wasm"))]
fn open_vulkan(
    named: super::gpu::AdapterName,
    shaders: super::gpu::Shaders,
) -> Result<Box<dyn Session>, Unavailable> {
    open_gpu(super::gpu::DeviceRequest { backend: wgpu::Backends::VULKAN, named, shaders })
}

/// A session on a context of OpenGL, for the texts of a target. The target's version of GLSL says
/// which OpenGL that is.
#[cfg(not(target_family = "wasm"))]
fn opened_opengl(target: Target) -> Result<Box<dyn Session>, Unavailable> {
    Ok(Box::new(super::gpu::OpenGl::open(opengl_of(target)?, target)?))
}

/// The same for the author's own texts in GLSL.
#[cfg(not(target_family = "wasm"))]
fn opened_source(target: Target) -> Result<Box<dyn Session>, Unavailable> {
    Ok(Box::new(super::gpu::OpenGl::open_source(opengl_of(target)?, target)?))
}

/// A session for texts in HLSL or MSL that are given with kernels.
#[cfg(not(target_family = "wasm"))]
pub(super) fn open_written(target: Target) -> Result<Box<dyn Session>, Unavailable> {
    use super::gpu::{AdapterName, Shaders};
    match target {
        Target::HLSL => open_vulkan(AdapterName::Without(swiftshader::NAME), Shaders::Written),
        Target::MSL => {
            let metal = super::metal::Metal::open_written().map_err(|missing| missing.reason)?;
            Ok(Box::new(metal))
        }
        _ => Err(format!("texts for `{target}` are not run").into()),
    }
}

#[cfg(not(target_family = "wasm"))]
fn opengl_of(target: Target) -> Result<super::gpu::OpenGlApi, Unavailable> {
    let version = lamplight_emit::targets::find(target).and_then(|entry| entry.glsl);
    let not_glsl = || format!("`{target}` is not GLSL: its file has no version");
    Ok(super::gpu::OpenGlApi::of_glsl(version.ok_or_else(not_glsl)?))
}

/// A session in a page of a browser.
#[cfg(not(target_family = "wasm"))]
fn opened_page(api: super::web::WebApi) -> Result<Box<dyn Session>, Unavailable> {
    Ok(Box::new(super::web::Web::open(api)?))
}

include!(concat!(env!("OUT_DIR"), "/executors.rs"));

/// Prepares the process for executors. Call this while it has only one thread.
pub fn prepare_process(entries: &[&ExecutorEntry]) {
    if entries.iter().any(|entry| !entry.needs.is_empty()) {
        without_windows();
    }
    entries.iter().filter_map(|entry| entry.before_threads).for_each(|prepare| prepare());
}

/// The executors that draw a target's files as they are.
pub fn shipping(
    target: Target,
) -> impl Iterator<Item = (&'static ExecutorEntry, &'static Shipping)> {
    let all = ALL.iter().filter_map(|entry| Some((*entry, entry.shipping.as_ref()?)));
    all.filter(move |(_, shipping)| shipping.target == target)
}

/// Tells Mesa's layers that there is no window system, if there is none. They look for Wayland in
/// the folder that `XDG_RUNTIME_DIR` names, and print an error where it is not set.
fn without_windows() {
    let is_absolute = |name| {
        std::env::var_os(name).is_some_and(|value| std::path::Path::new(&value).is_absolute())
    };
    if !is_absolute("XDG_RUNTIME_DIR") && !is_absolute("WAYLAND_DISPLAY") {
        // SAFETY: Rust's own accesses are locked, and the only other thread waits for this one.
        unsafe { std::env::set_var("WAYLAND_DISPLAY", "/nonexistent") };
    }
}

pub fn find_executor(name: &str) -> Option<&'static ExecutorEntry> {
    ALL.iter().copied().find(|entry| entry.name == name)
}

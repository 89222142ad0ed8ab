//! Everything that can run a kernel: one file of `executors/` each.

use super::Session;
use crate::bundle::Target;

/// An executor, closed.
pub struct Entry {
    /// Name on the command line.
    pub name: &'static str,
    /// One line.
    pub about: &'static str,
    /// Debian packages it needs.
    pub needs: &'static [&'static str],
    /// What must be done while the process has one thread, before the executor is opened.
    pub before_threads: Option<fn()>,
    /// Places in each pixel of a picture that are averaged, where no other number is asked for;
    /// `None` if the executor draws no frames.
    pub samples: Option<u32>,
    /// Opens a device.
    pub open: Open,
    /// What it draws from the bytes of a bundle.
    pub shipping: Option<Shipping>,
}

/// Opens a session.
pub type Open = fn() -> Result<Box<dyn Session>, Unavailable>;

/// A target, and what opens a session that draws its files as they are. Each target has an
/// executor that does.
pub struct Shipping {
    pub target: Target,
    pub open: Open,
}

/// Why an executor cannot be used on this machine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unavailable {
    pub reason: String,
}

impl Entry {
    /// An open executor; the error is for someone on whose machine it is missing. Open, use and
    /// drop it inside of [`on_thread`](super::on_thread).
    pub fn start(&self) -> Result<Box<dyn Session>, String> {
        (self.open)().map_err(|unavailable| self.missing(&unavailable))
    }

    /// What to tell someone on whose machine it is missing.
    pub fn missing(&self, unavailable: &Unavailable) -> String {
        let install = if self.needs.is_empty() {
            String::new()
        } else {
            format!("\ninstall it with: apt-get install {}", self.needs.join(" "))
        };
        format!("the executor `{}` is not available: {}{install}", self.name, unavailable.reason)
    }
}

/// Places in each pixel that devices average.
#[cfg(not(target_family = "wasm"))]
const DEVICE_SAMPLES: u32 = 4;

/// A session on a device of wgpu.
#[cfg(not(target_family = "wasm"))]
fn opened(wanted: super::gpu::Wanted) -> Result<Box<dyn Session>, Unavailable> {
    match super::gpu::open(wanted) {
        Ok(gpu) => Ok(Box::new(gpu)),
        Err(reason) => Err(Unavailable { reason }),
    }
}

/// A session on a context of OpenGL, for the texts of a target.
#[cfg(not(target_family = "wasm"))]
fn opened_opengl(api: super::gpu::Api, target: Target) -> Result<Box<dyn Session>, Unavailable> {
    match super::gpu::OpenGl::open(api, target) {
        Ok(opengl) => Ok(Box::new(opengl)),
        Err(reason) => Err(Unavailable { reason }),
    }
}

/// A session in a page of a browser.
#[cfg(not(target_family = "wasm"))]
fn opened_page(api: super::web::Api) -> Result<Box<dyn Session>, Unavailable> {
    match super::web::Web::open(api) {
        Ok(web) => Ok(Box::new(web)),
        Err(reason) => Err(Unavailable { reason }),
    }
}

include!(concat!(env!("OUT_DIR"), "/executors.rs"));

/// Prepares the process for executors. Call this while it has one thread.
pub fn prepare(entries: &[&Entry]) {
    if entries.iter().any(|entry| !entry.needs.is_empty()) {
        without_windows();
    }
    entries.iter().filter_map(|entry| entry.before_threads).for_each(|prepare| prepare());
}

/// The executors that draw a target's files as they are.
pub fn shipping(target: Target) -> impl Iterator<Item = (&'static Entry, &'static Shipping)> {
    let all = ALL.iter().filter_map(|entry| Some((*entry, entry.shipping.as_ref()?)));
    all.filter(move |(_, shipping)| shipping.target == target)
}

/// Tells Mesa's layers that there is no window system, where there is none: they look for Wayland in
/// the folder that `XDG_RUNTIME_DIR` names, and print an error where that is not set.
fn without_windows() {
    let is_absolute = |name| {
        std::env::var_os(name).is_some_and(|value| std::path::Path::new(&value).is_absolute())
    };
    if !is_absolute("XDG_RUNTIME_DIR") && !is_absolute("WAYLAND_DISPLAY") {
        // SAFETY: Rust's own accesses are locked, and the process has one thread.
        unsafe { std::env::set_var("WAYLAND_DISPLAY", "/nonexistent") };
    }
}

/// The executor of that name.
pub fn find(name: &str) -> Option<&'static Entry> {
    ALL.iter().copied().find(|entry| entry.name == name)
}

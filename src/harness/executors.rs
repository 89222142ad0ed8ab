//! Everything that can run a kernel: one file of `executors/` each.

use super::Session;
use super::gpu;

/// An executor, closed.
pub struct Entry {
    /// Name on the command line.
    pub name: &'static str,
    /// One line.
    pub about: &'static str,
    /// Debian packages it needs.
    pub needs: &'static [&'static str],
    /// Opens a device.
    pub open: fn() -> Result<Box<dyn Session>, Unavailable>,
}

/// Why an executor cannot be used on this machine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unavailable {
    pub reason: String,
}

impl Entry {
    /// What to tell someone on whose machine it is missing.
    pub fn missing(&self, unavailable: &Unavailable) -> String {
        let install =
            if self.needs.is_empty() { String::new() } else { format!("\ninstall it with: apt-get install {}", self.needs.join(" ")) };
        format!("the executor `{}` is not available: {}{install}", self.name, unavailable.reason)
    }
}

/// A session on a device of wgpu.
fn opened(wanted: gpu::Wanted) -> Result<Box<dyn Session>, Unavailable> {
    match gpu::open(wanted) {
        Ok(gpu) => Ok(Box::new(gpu)),
        Err(reason) => Err(Unavailable { reason }),
    }
}

include!(concat!(env!("OUT_DIR"), "/executors.rs"));

/// The executor of that name.
pub fn find(name: &str) -> Option<&'static Entry> {
    ALL.iter().copied().find(|entry| entry.name == name)
}

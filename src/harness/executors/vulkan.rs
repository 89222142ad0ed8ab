//! wgpu on a Vulkan driver: lavapipe where it is installed.

use super::{Entry, Unavailable};
use crate::harness::gpu;

pub const EXECUTOR: Entry = Entry {
    name: "vulkan",
    about: "wgpu on Vulkan, Mesa's lavapipe preferred",
    needs: &["mesa-vulkan-drivers", "libvulkan1"],
    open: || match gpu::open(wgpu::Backends::VULKAN) {
        Ok(gpu) => Ok(Box::new(gpu)),
        Err(reason) => Err(Unavailable { reason }),
    },
};

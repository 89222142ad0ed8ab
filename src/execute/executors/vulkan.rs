//! wgpu on a Vulkan driver, which is lavapipe where that is installed.
//!
//! Runs on: every system but WebAssembly

use super::{DEVICE_SAMPLES, Entry, swiftshader};
use crate::execute::gpu::{Named, Shaders};

pub const EXECUTOR: Entry = Entry {
    name: "vulkan",
    about: "wgpu on Vulkan, Mesa's lavapipe preferred",
    needs: &["mesa-vulkan-drivers", "libvulkan1"],
    before_threads: None,
    samples: Some(DEVICE_SAMPLES),
    open: || super::open_vulkan(Named::Without(swiftshader::NAME), Shaders::Translated),
    shipping: None,
};

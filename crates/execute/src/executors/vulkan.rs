//! wgpu on a Vulkan driver, which is lavapipe where that is installed.
//!
//! Runs on: every system but WebAssembly

use super::{DEVICE_SAMPLES, ExecutorEntry, swiftshader};
use crate::dispatch::ComputeForm;
use crate::gpu::{AdapterName, Shaders};
use lamplight_bundle::Target;

pub const EXECUTOR: ExecutorEntry = ExecutorEntry {
    name: "vulkan",
    about: "wgpu on Vulkan, Mesa's lavapipe preferred",
    needs: &["mesa-vulkan-drivers", "libvulkan1"],
    before_threads: None,
    samples: Some(DEVICE_SAMPLES),
    open: || super::open_vulkan(AdapterName::Without(swiftshader::NAME), Shaders::Translated),
    shipping: None,
    reads_glsl: false,
    compute: Some(ComputeForm::Output(Target::WGSL)),
};

//! wgpu on OpenGL, through EGL and without a window. Without a GPU this is llvmpipe.
//!
//! Runs on: every system but WebAssembly

use super::{DEVICE_SAMPLES, ExecutorEntry, swiftshader};
use crate::dispatch::ComputeForm;
use crate::gpu::{AdapterName, DeviceRequest, Shaders};
use lamplight_bundle::Target;

pub const EXECUTOR: ExecutorEntry = ExecutorEntry {
    name: "gl",
    about: "wgpu on OpenGL over EGL, Mesa's llvmpipe preferred",
    needs: &["libegl1", "libgles2", "libgl1-mesa-dri"],
    before_threads: None,
    samples: Some(DEVICE_SAMPLES),
    open: || {
        super::open_gpu(DeviceRequest {
            backend: wgpu::Backends::GL,
            named: AdapterName::Without(swiftshader::NAME),
            shaders: Shaders::Translated,
        })
    },
    shipping: None,
    reads_glsl: false,
    compute: Some(ComputeForm::Output(Target::WGSL)),
};

//! wgpu on OpenGL, through EGL and without a window. Without a GPU this is llvmpipe.
//!
//! Runs on: every system but WebAssembly

use super::{DEVICE_SAMPLES, Entry, swiftshader};
use crate::execute::gpu::{Named, Shaders, Wanted};

pub const EXECUTOR: Entry = Entry {
    name: "gl",
    about: "wgpu on OpenGL over EGL, Mesa's llvmpipe preferred",
    needs: &["libegl1", "libgles2", "libgl1-mesa-dri"],
    before_threads: None,
    samples: Some(DEVICE_SAMPLES),
    open: || {
        super::open_gpu(Wanted {
            backend: wgpu::Backends::GL,
            named: Named::Without(swiftshader::NAME),
            shaders: Shaders::Translated,
        })
    },
    shipping: None,
};

//! wgpu on OpenGL through EGL without a surface: llvmpipe where there is no GPU.

use super::{Entry, swiftshader};
use crate::harness::gpu::{Named, Shaders, Wanted};

pub const EXECUTOR: Entry = Entry {
    name: "gl",
    about: "wgpu on OpenGL over EGL, Mesa's llvmpipe preferred",
    needs: &["libegl1", "libgles2", "libgl1-mesa-dri"],
    open: || super::opened(Wanted { backend: wgpu::Backends::GL, named: Named::Without(swiftshader::NAME), shaders: Shaders::Translated }),
};

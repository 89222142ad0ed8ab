//! wgpu on OpenGL through EGL without a surface: llvmpipe where there is no GPU.

use super::{Entry, Unavailable};
use crate::harness::gpu;

pub const EXECUTOR: Entry = Entry {
    name: "gl",
    about: "wgpu on OpenGL ES over EGL, Mesa's llvmpipe preferred",
    needs: &["libegl1", "libgles2", "libgl1-mesa-dri"],
    open: || match gpu::open(wgpu::Backends::GL) {
        Ok(gpu) => Ok(Box::new(gpu)),
        Err(reason) => Err(Unavailable { reason }),
    },
};

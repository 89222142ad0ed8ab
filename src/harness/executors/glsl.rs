//! The emitted GLSL 4.50 as it is, on the driver of `gl`.

use super::{Entry, Unavailable, swiftshader};
use crate::harness::gpu::{self, Direct, Named, Shaders, Wanted};

pub const EXECUTOR: Entry = Entry {
    name: "glsl",
    about: "the emitted GLSL 4.50 as it is, on OpenGL, Mesa's llvmpipe preferred",
    needs: &["libegl1", "libgles2", "libgl1-mesa-dri"],
    open: || {
        let wanted = Wanted { backend: wgpu::Backends::GL, named: Named::Without(swiftshader::NAME), shaders: Shaders::Translated };
        match gpu::open(wanted) {
            Ok(gpu) => Ok(Box::new(Direct::new(gpu))),
            Err(reason) => Err(Unavailable { reason }),
        }
    },
};

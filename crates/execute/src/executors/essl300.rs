//! Runs the emitted GLSL ES 3.00 unchanged, on OpenGL ES 3.0.
//!
//! Runs on: every system but WebAssembly

use super::{ExecutorEntry, Shipping, Unavailable};
use crate::Session;
use lamplight_bundle::Target;

pub const EXECUTOR: ExecutorEntry = ExecutorEntry {
    name: "essl300",
    about: "the emitted GLSL ES 3.00 as it is, on OpenGL ES 3.0, Mesa's llvmpipe preferred",
    needs: &["libegl1", "libgles2", "libgl1-mesa-dri"],
    before_threads: None,
    samples: None,
    open,
    shipping: Some(Shipping { target: Target::ESSL300, open }),
    reads_glsl: false,
    compute: None,
};

fn open() -> Result<Box<dyn Session>, Unavailable> {
    super::opened_opengl(Target::ESSL300)
}

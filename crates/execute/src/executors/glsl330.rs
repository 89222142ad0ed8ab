//! Runs the emitted GLSL 3.30 unchanged, on OpenGL 3.3 with the core profile.
//!
//! Runs on: every system but WebAssembly

use super::{ExecutorEntry, Shipping, Unavailable};
use crate::Session;
use lamplight_bundle::Target;

pub const EXECUTOR: ExecutorEntry = ExecutorEntry {
    name: "glsl330",
    about: "the emitted GLSL 3.30 as it is, on OpenGL 3.3 core, Mesa's llvmpipe preferred",
    needs: &["libegl1", "libgl1-mesa-dri"],
    before_threads: None,
    samples: None,
    open,
    shipping: Some(Shipping { target: Target::GLSL330, open }),
    reads_glsl: false,
    compute: None,
};

fn open() -> Result<Box<dyn Session>, Unavailable> {
    super::opened_opengl(Target::GLSL330)
}

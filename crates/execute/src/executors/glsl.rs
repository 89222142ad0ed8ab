//! Runs the emitted GLSL 4.50 unchanged, on OpenGL 4.5.
//!
//! Runs on: every system but WebAssembly

use super::{ExecutorEntry, Shipping, Unavailable};
use crate::dispatch::ComputeForm;
use crate::Session;
use lamplight_bundle::Target;

pub const EXECUTOR: ExecutorEntry = ExecutorEntry {
    name: "glsl",
    about: "the emitted GLSL 4.50 as it is, on OpenGL 4.5, Mesa's llvmpipe preferred",
    needs: &["libegl1", "libgl1-mesa-dri"],
    before_threads: None,
    samples: None,
    open,
    shipping: Some(Shipping { target: Target::GLSL450, open }),
    reads_glsl: false,
    compute: Some(ComputeForm::Output(Target::GLSL450)),
};

fn open() -> Result<Box<dyn Session>, Unavailable> {
    super::opened_opengl(Target::GLSL450)
}

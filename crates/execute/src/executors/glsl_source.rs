//! Runs the text of GLSL modules itself, compiled by the driver's front end as GLSL 4.50. Nothing of
//! naga is between the author and the result.
//!
//! Runs on: every system but WebAssembly

use super::{ExecutorEntry, Unavailable};
use crate::Session;
use lamplight_bundle::Target;

pub const EXECUTOR: ExecutorEntry = ExecutorEntry {
    name: "glsl_source",
    about: "the author's GLSL itself as 4.50, on OpenGL 4.5, Mesa's llvmpipe preferred",
    needs: &["libegl1", "libgl1-mesa-dri"],
    before_threads: None,
    samples: None,
    open,
    shipping: None,
    reads_glsl: true,
    compute: None,
};

fn open() -> Result<Box<dyn Session>, Unavailable> {
    super::opened_source(Target::GLSL450)
}

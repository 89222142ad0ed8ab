//! Runs the emitted MSL unchanged: clang compiles it for the CPU, with headers of our own.
//!
//! Runs on: every system but WebAssembly

use super::{ExecutorEntry, Shipping, Unavailable};
use crate::dispatch::ComputeForm;
use crate::Session;
use crate::metal::Metal;
use lamplight_bundle::Target;
use lamplight_tools::CLANG;

pub const EXECUTOR: ExecutorEntry = ExecutorEntry {
    name: "msl",
    about: "the emitted MSL as it is, compiled for the CPU by clang",
    needs: &[CLANG.package],
    before_threads: None,
    samples: Some(1),
    open,
    shipping: Some(Shipping { target: Target::MSL, open }),
    reads_glsl: false,
    compute: Some(ComputeForm::Output(Target::MSL)),
};

fn open() -> Result<Box<dyn Session>, Unavailable> {
    Ok(Box::new(Metal::open().map_err(|missing| missing.reason)?))
}

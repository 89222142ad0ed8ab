//! Runs the emitted WGSL unchanged in a page of Chromium. It is compiled by Tint and run by Dawn,
//! which are independent of naga and wgpu.
//!
//! Runs on: every system but WebAssembly

use super::{ExecutorEntry, Shipping, Unavailable};
use crate::Session;
use crate::web::WebApi;
use lamplight_bundle::Target;
use lamplight_tools::browser::PACKAGE;

pub const EXECUTOR: ExecutorEntry = ExecutorEntry {
    name: "webgpu",
    about: "the emitted WGSL as it is, on WebGPU in Chromium",
    needs: &[PACKAGE],
    before_threads: None,
    samples: None,
    open,
    shipping: Some(Shipping { target: Target::WGSL, open }),
    reads_glsl: false,
    compute: None,
};

fn open() -> Result<Box<dyn Session>, Unavailable> {
    super::opened_page(WebApi::WebGpu)
}

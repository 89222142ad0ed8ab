//! Runs the emitted GLSL ES 3.00 unchanged in a page of Chromium. It is compiled by ANGLE, which is
//! independent of Mesa.
//!
//! Runs on: every system but WebAssembly

use super::{ExecutorEntry, Shipping, Unavailable};
use crate::Session;
use crate::web::WebApi;
use lamplight_bundle::Target;
use lamplight_tools::browser::PACKAGE;

pub const EXECUTOR: ExecutorEntry = ExecutorEntry {
    name: "webgl2",
    about: "the emitted GLSL ES 3.00 as it is, on WebGL2 in Chromium",
    needs: &[PACKAGE],
    before_threads: None,
    samples: None,
    open,
    shipping: Some(Shipping { target: Target::ESSL300, open }),
    reads_glsl: false,
    compute: None,
};

fn open() -> Result<Box<dyn Session>, Unavailable> {
    super::opened_page(WebApi::WebGl2)
}

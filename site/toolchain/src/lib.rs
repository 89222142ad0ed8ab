//! Lamplight's toolchain for browsers and Node: the same functions as the command line's, over
//! files in memory.
//!
//! Each function takes one value and returns one. The types of both are generated for TypeScript.
//! Errors in the input are returned as diagnostics in the value, and never thrown as exceptions.

mod choose;
mod cost;
mod debug;
mod diagnostic;
mod editor;
mod library;
mod linkers;
mod number;
mod package;
mod picture;
mod shader;

use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

/// A value for the page. The error is about the form of an argument, which is the caller's mistake.
type Answer<T> = Result<Ts<T>, JsError>;

fn answer<T: Tsify + serde::Serialize>(value: &T) -> Answer<T> {
    value.into_ts().map_err(JsError::from)
}

/// Name and version of Lamplight.
#[wasm_bindgen]
pub fn version() -> String {
    format!("lamplight {}", env!("CARGO_PKG_VERSION"))
}

/// Names of the output languages.
#[wasm_bindgen]
pub fn targets() -> Vec<String> {
    lamplight::bundle::Target::ALL.iter().map(|target| target.name().to_owned()).collect()
}

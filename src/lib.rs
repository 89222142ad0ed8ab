//! Lamplight: lighting and shadow functions in WGSL and GLSL, composed, compiled and proven.
//!
//! Data flows one way, each arrow one function:
//!
//! `source -> parse -> resolve -> permute -> compose -> validate -> emit -> bundle`

pub mod bundle;
pub mod input;
pub mod limits;
pub mod output;
#[cfg(feature = "single-file")]
#[path = "packing/zstd.rs"]
mod packing;
#[cfg(not(feature = "single-file"))]
#[path = "packing/absent.rs"]
mod packing;

#[cfg(feature = "compile")]
pub mod cache;
#[cfg(feature = "compile")]
pub mod compose;
#[cfg(feature = "compile")]
pub mod diagnostic;
#[cfg(feature = "compile")]
pub mod emit;
#[cfg(feature = "eval")]
pub mod eval;
#[cfg(feature = "compile")]
pub mod generate;
#[cfg(feature = "compile")]
pub mod keys;
#[cfg(feature = "compile")]
pub mod link;
#[cfg(feature = "eval")]
pub mod metal;
#[cfg(feature = "compile")]
pub mod parse;
#[cfg(feature = "compile")]
pub mod permute;
#[cfg(feature = "compile")]
pub mod project;
#[cfg(feature = "compile")]
pub mod resolve;
#[cfg(feature = "compile")]
pub mod source;
#[cfg(feature = "store")]
pub mod store;
#[cfg(all(feature = "compile", not(feature = "store")))]
#[path = "store/absent.rs"]
pub mod store;
#[cfg(feature = "compile")]
pub mod tools;
#[cfg(feature = "compile")]
pub mod validate;

#[cfg(feature = "harness")]
pub mod catalogue;
#[cfg(feature = "harness")]
pub mod execute;
#[cfg(feature = "harness")]
pub mod picture;
#[cfg(feature = "harness")]
pub mod proof;
#[cfg(feature = "harness")]
pub mod report;
#[cfg(feature = "harness")]
pub mod scene;

#[cfg(feature = "cli")]
pub mod cli;

//! The function that the targets of cargo-fuzz call. The kinds of input are in `kinds.rs` and
//! `checks.rs`.

mod checks;
mod kinds;

pub use kinds::{KINDS, Kind};

/// Runs an input of a kind twice.
///
/// # Panics
/// If there is no such kind, if the crate panics, or if the two answers differ.
pub fn check(name: &str, bytes: &[u8]) {
    let mut kinds = KINDS.iter().chain(checks::KINDS);
    let kind = kinds.find(|known| known.name == name).expect("a kind of this name");
    let same = (kind.run)(bytes) == (kind.run)(bytes);
    assert!(same, "the kind `{name}` gave two answers to one input");
}

//! The function that the targets of cargo-fuzz call. The kinds of input are in `kinds.rs` and
//! `proofs.rs`.

mod kinds;
mod proofs;

pub use kinds::{KINDS, Kind};

/// Runs an input of a kind twice.
///
/// # Panics
/// If the crate panics, or if the two answers differ.
pub fn judge(kind: &str, bytes: &[u8]) {
    for kind in KINDS.iter().chain(proofs::KINDS).filter(|known| known.name == kind) {
        let same = (kind.run)(bytes) == (kind.run)(bytes);
        assert!(same, "the kind `{}` gave two answers to one input", kind.name);
    }
}

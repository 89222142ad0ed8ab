//! Bundles and cache records that were made by hand, with checksums that are right.

use libtest_mimic::Trial;

pub fn trials() -> Vec<Trial> {
    Vec::new()
}

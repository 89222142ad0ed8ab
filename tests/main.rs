#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
//! One test binary; each kind of test lists its trials.

mod shaderlib;

fn main() {
    let arguments = libtest_mimic::Arguments::from_args();
    libtest_mimic::run(&arguments, shaderlib::trials()).exit()
}

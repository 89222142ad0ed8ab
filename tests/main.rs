#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod harness;

fn main() {
    let arguments = libtest_mimic::Arguments::from_args();
    libtest_mimic::run(&arguments, harness::trials()).exit();
}

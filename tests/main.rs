//! The one test binary: kinds of tests, cases found by their files.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stderr)]

mod compose_wesl;
mod shaderlib;

fn main() {
    let arguments = libtest_mimic::Arguments::from_args();
    let trials = compose_wesl::trials().into_iter().chain(shaderlib::trials()).collect();
    libtest_mimic::run(&arguments, trials).exit();
}

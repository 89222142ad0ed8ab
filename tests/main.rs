//! Every test; cases are found by their files.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, clippy::print_stderr)]

mod compose_glsl;
mod permute;
mod shaderlib;

fn main() {
    let arguments = libtest_mimic::Arguments::from_args();
    let trials = [compose_glsl::trials(), permute::trials(), shaderlib::trials()].into_iter().flatten().collect();
    libtest_mimic::run(&arguments, trials).exit();
}

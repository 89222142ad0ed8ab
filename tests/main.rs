//! Every test; cases are found by their files.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, clippy::print_stderr)]

mod compose_glsl;
mod compose_wesl;
mod emit;
mod permute;
mod programs;
mod shaderlib;

fn main() {
    let arguments = libtest_mimic::Arguments::from_args();
    let kinds = [
        compose_glsl::trials(),
        compose_wesl::trials(),
        emit::trials(),
        permute::trials(),
        programs::trials(),
        shaderlib::trials(),
    ];
    libtest_mimic::run(&arguments, kinds.into_iter().flatten().collect()).exit();
}

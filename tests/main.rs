//! Every test, one binary; a case is a file or a folder under `tests/`.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod compose_glsl;

fn main() {
    let arguments = libtest_mimic::Arguments::from_args();
    libtest_mimic::run(&arguments, compose_glsl::trials()).exit();
}

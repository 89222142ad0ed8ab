//! The one test binary: every case is a file, found by itself.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

mod bundle;
mod emit;

fn main() {
    let arguments = libtest_mimic::Arguments::from_args();
    let trials = [bundle::trials(), emit::trials()].into_iter().flatten().collect();
    libtest_mimic::run(&arguments, trials).exit();
}

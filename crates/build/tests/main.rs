//! The package's tests. Each module lists its own.

#![allow(clippy::unwrap_used)]

mod identity;

use libtest_mimic::Arguments;

fn main() -> std::process::ExitCode {
    libtest_mimic::run(&Arguments::from_args(), identity::tests()).exit_code()
}

//! The package's tests.

#![allow(clippy::print_stdout)]

mod bindings;
mod identifiers;

fn main() -> std::process::ExitCode {
    let tests = identifiers::tests().into_iter().chain(bindings::tests()).collect();
    libtest_mimic::run(&libtest_mimic::Arguments::from_args(), tests).exit_code()
}

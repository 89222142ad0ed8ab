//! The package's tests.

mod identifiers;

fn main() -> std::process::ExitCode {
    libtest_mimic::run(&libtest_mimic::Arguments::from_args(), identifiers::tests()).exit_code()
}

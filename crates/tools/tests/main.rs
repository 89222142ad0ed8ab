//! The package's tests.

mod attributes;

fn main() -> std::process::ExitCode {
    libtest_mimic::run(&libtest_mimic::Arguments::from_args(), attributes::tests()).exit_code()
}

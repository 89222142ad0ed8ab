//! The package's tests.

mod plots;

fn main() -> std::process::ExitCode {
    libtest_mimic::run(&libtest_mimic::Arguments::from_args(), plots::tests()).exit_code()
}

//! The package's tests.

mod counts;

fn main() -> std::process::ExitCode {
    libtest_mimic::run(&libtest_mimic::Arguments::from_args(), counts::tests()).exit_code()
}

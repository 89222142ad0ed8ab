//! The package's tests.

mod tokens;

fn main() -> std::process::ExitCode {
    libtest_mimic::run(&libtest_mimic::Arguments::from_args(), tokens::tests()).exit_code()
}

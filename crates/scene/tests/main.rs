//! The package's tests.

mod scene;

fn main() -> std::process::ExitCode {
    libtest_mimic::run(&libtest_mimic::Arguments::from_args(), scene::tests()).exit_code()
}

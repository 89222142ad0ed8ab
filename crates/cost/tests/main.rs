//! The package's tests.

mod counts;
mod machine;
mod paths;

fn main() -> std::process::ExitCode {
    let tests = [counts::tests(), machine::tests(), paths::tests()].into_iter().flatten().collect();
    libtest_mimic::run(&libtest_mimic::Arguments::from_args(), tests).exit_code()
}

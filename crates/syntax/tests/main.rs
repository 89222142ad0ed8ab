//! The package's tests.

mod damaged;
mod tokens;

fn main() -> std::process::ExitCode {
    let tests = damaged::tests().into_iter().chain(tokens::tests()).collect();
    libtest_mimic::run(&libtest_mimic::Arguments::from_args(), tests).exit_code()
}

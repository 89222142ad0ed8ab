//! The command line as users meet it. Each test is named after what a user would expect of it.

mod checks;
mod compile;
mod package;
mod reload;
mod render;
mod roots;
mod same_bytes;
mod shaders;
mod tools;
mod warnings;

use libtest_mimic::Trial;

type Outcome = Result<(), libtest_mimic::Failed>;

/// The name of a test, and its function.
type Case = (&'static str, fn() -> Outcome);

pub fn tests() -> Vec<Trial> {
    let cases = [
        checks::CASES,
        compile::CASES,
        reload::CASES,
        render::CASES,
        roots::CASES,
        same_bytes::CASES,
        shaders::CASES,
        tools::CASES,
        warnings::CASES,
    ];
    let named = |(name, case): &Case| Trial::test(format!("command_line::{name}"), *case);
    cases.into_iter().flatten().map(named).collect()
}

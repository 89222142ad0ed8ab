//! What users of the command line meet: each trial is named after what a person expects.

mod checks;
mod command_line;
mod package;
mod reload;
mod roots;
mod same_bytes;
mod shaders;
mod told;
mod tools;

use libtest_mimic::Trial;

type Outcome = Result<(), libtest_mimic::Failed>;

/// A kind of trials: names and what they do.
type Case = (&'static str, fn() -> Outcome);

pub fn trials() -> Vec<Trial> {
    let cases = [
        checks::CASES,
        command_line::CASES,
        reload::CASES,
        roots::CASES,
        same_bytes::CASES,
        shaders::CASES,
        told::CASES,
        tools::CASES,
    ];
    let named = |(name, case): &Case| Trial::test(format!("doors::{name}"), *case);
    cases.into_iter().flatten().map(named).collect()
}

//! Every promise of SECURITY.md names tests that there are.

use std::path::Path;

use libtest_mimic::Failed;

use crate::{ROOT, git};

/// Each promise names at least one test, and the sources of the tests have its name.
pub fn have_tests() -> Result<(), Failed> {
    let text = std::fs::read_to_string(Path::new(ROOT).join("SECURITY.md"))?;
    let promised = text.split("## What is promised").nth(1).ok_or("no promises")?;
    let promised = promised.split("\n## ").next().unwrap_or_default();
    let sources = sources_of_tests()?;
    let mut missing = Vec::new();
    for promise in promised.split("\n- ").skip(1) {
        let tests: Vec<&str> = names_in(promise).collect();
        if tests.is_empty() {
            let first = promise.lines().next().unwrap_or_default();
            missing.push(format!("no test of `{first}`"));
        }
        let absent = tests.into_iter().filter(|name| !is_there(&sources, name));
        missing.extend(absent.map(|name| format!("there is no test `{name}`")));
    }
    match missing.is_empty() {
        true => Ok(()),
        false => Err(missing.join("\n").into()),
    }
}

/// The names of tests in a promise: words in code that have `::`.
fn names_in(promise: &str) -> impl Iterator<Item = &str> {
    let tests = promise.split_once("Tests:").map_or("", |(_, tests)| tests);
    tests.split('`').skip(1).step_by(2).filter(|word| word.contains("::"))
}

/// A name that ends with `::` or `_` is that of a group. Other names are written as a whole, or
/// without the group, or in a list of names that get the part before them.
fn is_there(sources: &str, name: &str) -> bool {
    let is_written = |words: String| sources.contains(&format!("\"{words}"));
    let (group, own) = name.rsplit_once("::").unwrap_or(("", name));
    if own.is_empty() || own.ends_with('_') {
        return is_written(format!("{name}{{"));
    }
    let in_list = |(at, _)| {
        let (before, after) = own.split_at(at + 1);
        is_written(format!("{group}::{before}{{")) && is_written(format!("{after}\""))
    };
    is_written(format!("{name}\""))
        || is_written(format!("{own}\"")) && sources.contains(&format!("{group}::"))
        || own.match_indices('_').any(in_list)
}

fn sources_of_tests() -> Result<String, Failed> {
    let paths = git(&["ls-files", "-z", "tests", "crates/*/tests/*"])?;
    let sources = paths.iter().filter(|path| path.ends_with(".rs"));
    Ok(sources
        .filter_map(|path| std::fs::read_to_string(Path::new(ROOT).join(path)).ok())
        .collect())
}

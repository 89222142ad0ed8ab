//! How many mistakes the numeric cases notice: mutants of a few modules, the list of equivalent
//! mutants, and the statements and branches that the cases reach. A mutant is a function with one
//! small change.

use std::sync::{Arc, Mutex};

use crate::LIBRARY_FILES;
use lamplight_check::library::Library;
use lamplight_diagnostic::render::{Form, render};
use lamplight_diagnostic::source::{Memory, SourceSet};
use lamplight_mutate::{self as mutate, Fate, MutantReport};
use libtest_mimic::{Failed, Trial};
use toml::Table;

type Outcome = Result<(), Failed>;
type Case = fn() -> Outcome;

pub fn tests() -> Vec<Trial> {
    let cases: [(&str, Case); 7] = [
        ("library_kills", library_kills),
        ("list_is_sound", list_is_sound),
        ("hidden_by_tolerance", hidden_by_tolerance),
        ("survivors_are_reported", survivors_are_reported),
        ("mistakes_run", mistakes_run),
        ("stale_entries_are_reported", stale_entries_are_reported),
        ("every_block_is_reached", every_block_is_reached),
    ];
    cases.into_iter().map(|(name, case)| Trial::test(format!("mutate::{name}"), case)).collect()
}

fn mutants(library: &Library, modules: &[&str]) -> Result<MutantReport, Failed> {
    let sources = Mutex::new(SourceSet::default());
    let modules: Vec<String> = modules.iter().map(|module| (*module).to_owned()).collect();
    let report = mutate::run_mutants(library, &sources, &modules);
    report.map_err(|errors| render(&sources.into_inner().unwrap(), &errors, Form::Short).into())
}

/// Modules that are quick to test. `cargo xtask mutate` tests all modules.
const QUICK: &[&str] =
    &["lighting::spot", "lighting::material", "math::safe", "shadow::bias", "surface::view"];

/// How many mutants these modules have, at least.
const LEAST_QUICK: usize = 290;

/// The cases of these modules notice every mutant but one.
fn library_kills() -> Outcome {
    let report = mutants(&Library::shipped(LIBRARY_FILES), QUICK)?;
    let (killed, all) = report.killed();
    // Only one mutant, of `is_nan_bits`, is not noticed, and the list has the reason.
    let explained =
        report.outcomes.iter().filter(|outcome| matches!(outcome.fate, Fate::Explained(_))).count();
    if all < LEAST_QUICK || all - killed != 1 || explained != 1 {
        let counts = format!("{killed} of {all} killed, {explained} explained");
        let what = "expected more mutants, all killed but one that is explained";
        return Err(format!("{what}: {counts}\n{}", report.survivors()).into());
    }
    assert_eq!(report.summary(), format!("killed {killed} of {all} mutants"));
    Ok(())
}

/// Every entry of the list of equivalent mutants has a function and a line that exist, and a reason,
/// and is listed once. The entries of a quick module are mutants that really survive.
fn list_is_sound() -> Outcome {
    let library = Library::shipped(LIBRARY_FILES);
    let list: Table =
        toml::from_str(&library.text("survivors.toml").ok_or("no `survivors.toml`")?)?;
    let entries =
        ["equivalent", "survivor"].map(|kind| list[kind].as_array().map_or(&[][..], Vec::as_slice));
    let mut seen = Vec::new();
    for entry in entries.concat() {
        let entry = &entry;
        let text = |key: &str| entry[key].as_str().unwrap_or_default().to_owned();
        let function = text("function");
        let (module, name) = function.rsplit_once("::").ok_or("no path")?;
        let source = library
            .text(&format!("{}.wesl", module.replace("::", "/")))
            .ok_or_else(|| format!("no module `{module}`"))?;
        let body = source
            .split_once(&format!("\nfn {name}("))
            .ok_or_else(|| format!("no function `{function}`"))?
            .1;
        let body = body.split("\n}").next().unwrap_or_default();
        let has_line = body.lines().any(|line| line.trim() == text("line"));
        if !has_line || text("reason").len() < 20 || text("mutation").is_empty() {
            let what = "needs a line of its function, a mutation, and a reason of 20 characters";
            return Err(format!("an entry of survivors.toml {what}: {entry}").into());
        }
        let key = (function.clone(), text("line"), text("mutation"));
        if seen.contains(&key) {
            return Err(format!("survivors.toml has this entry twice: {entry}").into());
        }
        seen.push(key);
    }
    let listed =
        seen.iter().filter(|(function, _, _)| function.starts_with("shadow::bias::")).count();
    let report = mutants(&library, &["shadow::bias"])?;
    let found = report
        .outcomes
        .iter()
        .filter(|outcome| matches!(outcome.fate, Fate::Equivalent(_)))
        .count();
    if listed > 0 && found == listed {
        Ok(())
    } else {
        let what = "mutants that survive, expected all";
        Err(format!("{found} of the {listed} entries of `shadow::bias` are {what}").into())
    }
}

fn package(files: &[(&str, &str)]) -> Library {
    let files = files.iter().map(|(path, text)| ((*path).to_owned(), (*text).to_owned())).collect();
    Library::new("mine", Arc::new(Memory(files)), Vec::new())
}

const HALF: &str = "fn half(x: f32) -> f32 {\n    return x * 0.5;\n}\n";

/// A constant that is 1 % off is noticed however large the tolerance for f32 is, since mutants are
/// compared in f64.
fn hidden_by_tolerance() -> Outcome {
    let cases = "[[case]]\nfunction = \"half\"\nformula = \"0.5*x\"\ntolerance = { abs = 10 }\ninputs = { x = { grid = [0, 1], count = 9 } }\n";
    let report = mutants(&package(&[("mine.wesl", HALF), ("mine.toml", cases)]), &["mine"])?;
    if report.summary() == "killed 4 of 4 mutants" {
        Ok(())
    } else {
        let found = format!("{}{}", report.survivors(), report.summary());
        Err(format!("expected all mutants to be killed, found:\n{found}").into())
    }
}

/// A case whose oracle is the evaluator kills no mutants, since it compares the code with itself. The
/// report says if no case runs a function.
fn survivors_are_reported() -> Outcome {
    let module = format!("{HALF}fn other(x: f32) -> f32 {{\n    return 1.0 - x;\n}}\n");
    let cases = "[[case]]\nfunction = \"half\"\noracle = \"eval\"\ntolerance = { abs = 10 }\ninputs = { x = { grid = [0, 1], count = 9 } }\n";
    let report = mutants(&package(&[("mine.wesl", &module), ("mine.toml", cases)]), &["mine"])?;
    let text = report.survivors();
    for expected in [
        "mine.wesl:2: mine::half: `0.505` instead of `0.5`\n",
        "mine.wesl:5: mine::other: operator `+` in `1.0 - x` (no case runs this function)\n",
    ] {
        if !text.contains(expected) {
            return Err(format!("expected `{expected}` among the survivors:\n{text}").into());
        }
    }
    match report.passed() {
        true => Err("the report passes although mutants survive".into()),
        false => Ok(()),
    }
}

/// Where every result is accepted, mutants survive: they are noticed by their values, and never because
/// they could not run. Each kind of mistake is among them.
fn mistakes_run() -> Outcome {
    let module = "fn inner(a: vec3f, b: vec3f) -> vec3f {\n    return a * 2.0 + b;\n}\n
fn outer(x: f32, y: f32, on: bool) -> f32 {
    var sum = vec3f(x, y, 1.0);
    if (on) {
        sum.x = floor(y);
    }
    if (x > 3.0) {
        return 1.0;
    }
    sum = inner(sum, vec3f(y, x, 0.5));
    let s = select(x, y, y < x);
    return s - min(sum.zyx.x, 1.0) + clamp(-x, -2.0, 1.0);
}\n";
    let cases = "[[case]]\nfunction = \"outer\"\noracle = \"eval\"\ntolerance = { abs = 1e9 }\ninputs = { x = [0.1, 0.7, 5], y = [0.3, 0.9], on = [0, 1] }\n";
    let report = mutants(&package(&[("mine.wesl", module), ("mine.toml", cases)]), &["mine"])?;
    let (killed, all) = report.killed();
    let text = report.survivors();
    let kinds = [
        "`2.02` instead of `2.0`",
        "`a` instead of `a * 2.0`",
        "`x` and `y` exchanged in `vec3f(x, y, 1.0)`",
        "`true` instead of `on`",
        "`false` instead of `on`",
        "component `y` in `sum.x`",
        "`ceil` in `floor(y)`",
        "`y` instead of `floor(y)`",
        "operator `>=` in `x > 3.0`",
        "no early exit at `x > 3.0`",
        "`sum` and `vec3f(y, x, 0.5)` exchanged in `inner(sum, vec3f(y, x, 0.5))`",
        "operands swapped in `select(x, y, y < x)`",
        "`y` instead of `select(x, y, y < x)`",
        "operands swapped in `sum.zyx`",
        "`max` in `min(sum.zyx.x, 1.0)`",
        "no lower bound in `clamp(-x, -2.0, 1.0)`",
        "`x` instead of `-x`",
        "no assignment `sum.x = floor(y)`",
    ];
    let missing: Vec<&str> = kinds.into_iter().filter(|kind| !text.contains(kind)).collect();
    if killed == 0 && all > 40 && missing.is_empty() {
        Ok(())
    } else {
        Err(format!("{killed} of {all} killed, missing are {missing:?} in:\n{text}").into())
    }
}

/// An entry for a mutant that is killed is reported as stale, and an entry without a reason is
/// refused.
fn stale_entries_are_reported() -> Outcome {
    let cases = "[[case]]\nfunction = \"half\"\nformula = \"0.5*x\"\ninputs = { x = 3 }\n";
    let entry = "[[equivalent]]\nfunction = \"mine::half\"\nline = \"return x * 0.5;\"\nmutation = \"`0.505` instead of `0.5`\"\nreason = \"none\"\n";
    let files = [("mine.wesl", HALF), ("mine.toml", cases), ("survivors.toml", entry)];
    let report = mutants(&package(&files), &["mine"])?;
    assert_eq!(report.stale, ["mine::half: `0.505` instead of `0.5` (in `return x * 0.5;`)"]);
    let without = entry.replace("reason", "because");
    let files = [("mine.wesl", HALF), ("mine.toml", cases), ("survivors.toml", &without)];
    let error =
        mutants(&package(&files), &["mine"]).err().ok_or("an entry without a reason is taken")?;
    let message = error.message().unwrap_or_default().to_owned();
    match message.contains("`reason`") {
        true => Ok(()),
        false => Err(format!("expected `reason` in the error: {message}").into()),
    }
}

/// Cases reach every statement and every branch of the library.
fn every_block_is_reached() -> Outcome {
    let (library, sources) = (Library::shipped(LIBRARY_FILES), Mutex::new(SourceSet::default()));
    let found = mutate::measure_coverage(&library, &sources, &library.modules());
    let found =
        found.map_err(|errors| render(&sources.into_inner().unwrap(), &errors, Form::Short))?;
    let missed: String = found
        .iter()
        .filter(|module| !module.uncovered.is_empty())
        .map(ToString::to_string)
        .collect();
    let blocks: usize = found.iter().map(|module| module.blocks).sum();
    if missed.is_empty() && blocks > 250 {
        Ok(())
    } else {
        let what = "blocks (expected more than 250), no case reaches these";
        Err(format!("of {blocks} {what}:\n{missed}").into())
    }
}

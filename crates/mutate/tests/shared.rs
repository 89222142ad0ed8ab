//! Mistakes that a function and its reference share: what notices them, and the page `docs/mutants.md` with
//! what the library's cases notice. A few modules are measured in each run; with `UPDATE_EXPECT=1`, all are,
//! and the page is written.

use std::sync::{Arc, Mutex};

use crate::LIBRARY_FILES;
use lamplight_check::library::Library;
use lamplight_diagnostic::render::{Form, render};
use lamplight_diagnostic::source::{Memory, SourceSet};
use lamplight_mutate::{SHARED_HEAD, SharedFate, SharedReport, run_shared_mutants};
use lamplight_testing::snapshot;
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;
type Case = fn() -> Outcome;

pub fn tests() -> Vec<Trial> {
    let cases: [(&str, Case); 4] = [
        ("page", page),
        ("guards_put_in", guards_put_in),
        ("formulas_notice_nothing", formulas_notice_nothing),
        ("integrals_notice", integrals_notice),
    ];
    cases.into_iter().map(|(name, case)| Trial::test(format!("shared::{name}"), case)).collect()
}

fn measured(library: &Library, modules: &[String]) -> Result<SharedReport, Failed> {
    let sources = Mutex::new(SourceSet::default());
    let report = run_shared_mutants(library, &sources, modules);
    report.map_err(|errors| render(&sources.into_inner().unwrap(), &errors, Form::Short).into())
}

/// Modules that are quick to measure.
const QUICK: [&str; 4] = ["fog::height", "lighting::spot", "lighting::units", "surface::view"];

const PAGE: &str = "docs/mutants.md";
const START: &str = "<!-- measured -->\n";

/// The page has what is measured.
fn page() -> Outcome {
    let library = Library::shipped(LIBRARY_FILES);
    let file = snapshot::root().join(PAGE);
    let text = std::fs::read_to_string(&file)?;
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        let report = measured(&library, &library.modules())?;
        let (head, _) =
            text.split_once(START).ok_or("the page has no place for what is measured")?;
        std::fs::write(&file, format!("{head}{START}{}", tables(&report)))?;
        return if report.passed() { Ok(()) } else { Err(report.summary().into()) };
    }
    let report = measured(&library, &QUICK.map(str::to_owned))?;
    let rows = report.functions();
    let missing: Vec<&str> =
        rows.iter().map(|(_, row)| row.as_str()).filter(|row| !text.contains(row)).collect();
    match missing[..] {
        _ if rows.len() < 10 => Err(format!("expected more functions than {}", rows.len()).into()),
        [] => Ok(()),
        _ => Err(format!(
            "{PAGE} is not current, run with UPDATE_EXPECT=1; it lacks:\n{}",
            missing.join("\n")
        )
        .into()),
    }
}

fn tables(report: &SharedReport) -> String {
    let rows: Vec<String> = report.functions().into_iter().map(|(_, row)| row).collect();
    let section = |title: &str, text: &str| match text {
        "" => String::new(),
        _ => format!("\n## {title}\n\n{text}"),
    };
    let kinds = SHARED_HEAD.replace("| function |", "| mistake |");
    format!(
        "\nThe cases {}.\n\n{kinds}\n{}\n{}{}{}",
        report.summary(),
        report.kinds().join("\n"),
        section("By function", &format!("{SHARED_HEAD}\n{}\n", rows.join("\n"))),
        section("Missed", &report.list(SharedFate::Missed)),
        section("Within the error", &report.list(SharedFate::WithinError)),
    )
}

const SHARE: &str = "fn share(x: f32) -> f32 {\n    return clamp(2.0 * x, 0.0, 1.0);\n}\n";

fn of_package(module: &str, cases: &str) -> Result<SharedReport, Failed> {
    let files = [("mine.wesl", module), ("mine.toml", cases)];
    let files = files.iter().map(|(path, text)| ((*path).to_owned(), (*text).to_owned())).collect();
    measured(&Library::new("mine", Arc::new(Memory(files)), Vec::new()), &["mine".to_owned()])
}

/// A formula is mistaken too, so that it notices nothing. Numbers of a table do, and laws.
fn formulas_notice_nothing() -> Outcome {
    let formula = "[[case]]\nfunction = \"share\"\nformula = \"clamp(2*x, 0, 1)\"\ntolerance = { abs = 1e-9 }\ninputs = { x = { grid = [-1, 1], count = 41 } }\n";
    let range = formula.replace("inputs", "laws = [{ range = [0, 1] }]\ninputs");
    let stated = format!(
        "{formula}[[case]]\nfunction = \"share\"\nrows = [{{ x = -1, expect = 0 }}, {{ x = 1, expect = 1 }}]\n"
    );
    // Without the guard, without either bound, and both bounds moved.
    for (cases, expected) in [
        (formula, "noticed 0 of 5 shared mistakes"),
        (&range, "noticed 4 of 5 shared mistakes"),
        (&stated, "noticed 5 of 5 shared mistakes"),
    ] {
        let report = of_package(SHARE, cases)?;
        if report.summary() != expected {
            let found = format!("{}{}", report.missed(), report.summary());
            return Err(format!("expected `{expected}` for\n{cases}\nfound\n{found}").into());
        }
    }
    Ok(())
}

/// A mistake is put into all functions that a law is about.
fn integrals_notice() -> Outcome {
    let cases = "[[case]]\nfunction = \"share\"\noracle = \"none\"\nlaws = [{ area = \"share\", along = \"x\", from = 0, to = 1, gives = 0.75, within = 1e-3, steps = 64 }]\ninputs = { x = 1 }\n";
    let report = of_package(SHARE, cases)?;
    let by = report.functions().into_iter().map(|(_, row)| row).collect::<String>();
    match by.contains("`area`") {
        true => Ok(()),
        false => Err(format!("expected that the integral notices a mistake: {by}").into()),
    }
}

/// Numbers outside of [0, 1] notice that results are limited to it, in every branch.
fn guards_put_in() -> Outcome {
    let module = "fn bent(x: f32) -> vec2f {\n    if (x < 0.0) {\n        return vec2f(x, 0.5);\n    }\n    return vec2f(0.5, 2.0 * x);\n}\n";
    let cases = |rows: &str| format!("[[case]]\nfunction = \"bent\"\nrows = [{rows}]\n");
    let inside = "{ x = 0.25, expect = [0.5, 0.5] }";
    let outside =
        format!("{inside}, {{ x = -1, expect = [-1, 0.5] }}, {{ x = 3, expect = [0.5, 6] }}");
    for (rows, fate) in [(inside, SharedFate::WithinError), (&outside, SharedFate::Noticed("rows"))]
    {
        let report = of_package(module, &cases(rows))?;
        let limits = report.outcomes.iter().filter(|one| one.mistake.starts_with("results of"));
        let fates: Vec<SharedFate> = limits.map(|one| one.fate).collect();
        if fates != [fate; 2] {
            return Err(format!("expected {fate:?} twice for {rows}, found {fates:?}").into());
        }
    }
    Ok(())
}

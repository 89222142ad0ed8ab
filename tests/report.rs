//! `lamplight check --report` on a user's own module writes a page, JSON and JUnit. A failure is
//! printed as a case that can be pasted into the case file, and fails again with the same values.

use std::fs;
use std::process::{Command, Output};

use libtest_mimic::{Failed, Trial};
use serde_json::Value;
use tempfile::TempDir;

type Outcome = Result<(), Failed>;
type Case = fn() -> Outcome;

pub fn tests() -> Vec<Trial> {
    let cases: [(&str, Case); 7] = [
        ("forms_list_the_failure", forms_list_the_failure),
        ("pasted_case_fails_alike", pasted_case_fails_alike),
        ("off_before_rounding", off_before_rounding),
        ("broken_laws", broken_laws),
        ("kept_laws", kept_laws),
        ("at_allows_the_error_of_its_value", at_allows_the_error_of_its_value),
        ("passing_report", passing_report),
    ];
    cases.into_iter().map(|(name, case)| Trial::test(format!("report::{name}"), case)).collect()
}

/// A fade that lacks its lower bound, and functions that are right.
const MODULE: &str = "\
fn fade(d: f32, reach: f32) -> f32 {
    return min(1.0 - d / reach, 1.0);
}

fn threshold(x: f32) -> f32 {
    return select(0.0, 1.0, x > 0.5);
}

fn lobe(n: vec3f, l: vec3f) -> f32 {
    return max(dot(n, l), 0.0);
}
";

const CASES: &str = "\
[[case]]
function = \"fade\"
formula = \"clamp(1 - d/reach, 0, 1)\"
tolerance = { abs = 1e-6 }
laws = [{ falling = \"d\" }]

[case.inputs]
d = { random = [0, 7.3], count = 300 }
reach = [1.7, 3.1]

[[case]]
function = \"threshold\"
rows = [{ x = 0.25, expect = 0 }, { x = 0.75, expect = 1 }]
laws = [{ range = [0, 1] }]
";

struct Checked {
    folder: TempDir,
    output: Output,
}

impl Checked {
    fn new(module: &str, cases: &str) -> Result<Self, Failed> {
        let folder = TempDir::new()?;
        fs::write(folder.path().join("fades & more.wesl"), module)?;
        fs::write(folder.path().join("fades & more.toml"), cases)?;
        let output = Command::new(env!("CARGO_BIN_EXE_lamplight"))
            .args(["check", ".", "--report", "out"])
            .current_dir(&folder)
            .output()?;
        Ok(Self { folder, output })
    }

    fn read(&self, form: &str) -> Result<String, Failed> {
        Ok(fs::read_to_string(self.folder.path().join("out").join(form))?)
    }

    fn errors(&self) -> String {
        String::from_utf8_lossy(&self.output.stderr).into_owned()
    }

    #[track_caller]
    fn exits(&self, code: i32) -> Outcome {
        let place = std::panic::Location::caller();
        if self.output.status.code() == Some(code) {
            Ok(())
        } else {
            let found = format!("{}: {}", self.output.status, self.errors());
            Err(format!("{place}: expected exit code {code}, found {found}").into())
        }
    }
}

/// All forms have the failure, and are well formed.
fn forms_list_the_failure() -> Outcome {
    let checked = Checked::new(MODULE, CASES)?;
    checked.exits(3)?;
    json_lists(&checked.read("report.json")?)?;
    let xml = checked.read("junit.xml")?;
    well_formed(&xml, &[])?;
    // Each function has two tests: the run in f32, and the code in f64.
    contains(
        &xml,
        &[
            "<testsuites name=\"lamplight\" tests=\"4\" failures=\"2\">",
            "classname=\"fades &amp; more\"",
            "<failure message=",
        ],
    )?;
    contains(
        &checked.read("errors.md")?,
        &[
            "| eval | lamplight eval, f32 | 1 | 1 | 0 |",
            "| <code>fades &amp; more::fade</code> | **FAILED** ",
            "| <code>fades &amp; more::threshold</code> | exact |",
        ],
    )?;
    let page = checked.read("index.html")?;
    well_formed(page.strip_prefix("<!doctype html>").ok_or("no document type")?, &["meta"])?;
    contains(
        &page,
        &[
            "<section id=\"fades &amp; more::fade\">",
            "not all hold",
            "function = &quot;fade&quot;",
            "<svg",
            "worst inputs",
        ],
    )
}

fn json_lists(text: &str) -> Outcome {
    let report: Value = serde_json::from_str(text)?;
    let outcomes = report["outcomes"].as_array().ok_or("no outcomes")?;
    let of = |function: &str| {
        outcomes
            .iter()
            .find(|outcome| outcome["function"] == function)
            .ok_or_else(|| format!("no `{function}`"))
    };
    let (fade, threshold) = (of("fade")?, of("threshold")?);
    assert_eq!(
        (&report["passed"], &fade["passed"], &threshold["passed"]),
        (&Value::Bool(false), &Value::Bool(false), &Value::Bool(true))
    );
    let verdict = &fade["verdict"];
    assert_eq!(verdict["inputs"], 600);
    let (failing, smallest) = (
        verdict["failing"].as_u64().unwrap_or(0),
        verdict["smallest"].as_str().unwrap_or_default(),
    );
    if failing < 100
        || !smallest.contains("[[case]]")
        || verdict["worst_inputs"].as_array().is_none_or(Vec::is_empty)
    {
        let what = "expected 100 failing inputs, a case to paste, and the worst inputs";
        return Err(format!("{what}: {verdict:#}").into());
    }
    Ok(())
}

/// The printed case, in a file of its own, fails with the same values.
fn pasted_case_fails_alike() -> Outcome {
    let checked = Checked::new(MODULE, CASES)?;
    let errors = checked.errors();
    let start = errors.find("[[case]]").ok_or_else(|| format!("nothing to paste in\n{errors}"))?;
    let pasted = errors[start..].split("\n\n").next().unwrap_or_default();
    contains(pasted, &["function = \"fade\"", "# d = 0x", "expect = [0.0]"])?;
    let found =
        |text: &str| text.lines().find(|line| line.trim().starts_with("found ")).map(str::to_owned);
    let again = Checked::new(MODULE, pasted)?;
    again.exits(3)?;
    if found(&again.errors()) == found(&errors) {
        Ok(())
    } else {
        let again = again.errors();
        Err(format!("first:\n{errors}\nthe pasted case fails otherwise:\n{again}").into())
    }
}

/// A function, a law that it breaks, the inputs, and whether a single input breaks it. Such an input
/// is shrunk and printed as a case.
const BROKEN: &[(&str, &str, &str, bool)] = &[
    ("threshold", "{ range = [0, 0.5] }", "{ x = { grid = [0, 1], count = 9 } }", true),
    ("threshold", "{ falling = \"x\" }", "{ x = { around = 0.5, ulps = 9 } }", true),
    ("threshold", "{ continuous = \"x\", slope = 4 }", "{ x = { around = 0.5, ulps = 9 } }", true),
    ("threshold", "{ at = { x = 2 }, gives = 0 }", "{ x = 0 }", true),
    ("threshold", "{ even = \"x\" }", "{ x = [0, 0.75] }", true),
    ("fade", "{ swap = [\"d\", \"reach\"] }", "{ d = [1, 3], reach = [1, 2] }", true),
    ("fade", "{ reaches = [0, 2] }", "{ d = 1, reach = [1, 2] }", false),
    (
        "lobe",
        "{ integral = \"l\", about = \"n\", gives = 3.1, within = 0.01 }",
        "{ n = { unit = 4 }, l = { same = \"n\" } }",
        false,
    ),
    (
        "lobe",
        "{ integral = \"l\", about = \"n\", cosine = true, at_most = 2, within = 0.01 }",
        "{ n = { unit = 4 }, l = { same = \"n\" } }",
        false,
    ),
    (
        "lobe",
        "{ integral = \"l\", about = \"n\", gives = 0, within = 9 }",
        "{ n = [[[0, 0, 0]]], l = { unit = 9 } }",
        false,
    ),
];

/// Broken laws are reported. If a single input breaks a law, the report has a case that can be
/// pasted.
fn broken_laws() -> Outcome {
    for (function, law, inputs, is_of_one_input) in BROKEN {
        let name = law.trim_start_matches("{ ").split(' ').next().unwrap_or_default();
        let message = format!("the law `{name}` is broken");
        let case = format!(
            "[[case]]\nfunction = \"{function}\"\noracle = \"none\"\nlaws = [{law}]\ninputs = {inputs}\n"
        );
        let checked = Checked::new(MODULE, &case)?;
        checked.exits(3)?;
        let errors = checked.errors();
        contains(&errors, &[&message])?;
        match errors.find("[[case]]") {
            Some(start) if *is_of_one_input => {
                let again =
                    Checked::new(MODULE, errors[start..].split("\n\n").next().unwrap_or_default())?;
                again.exits(3)?;
                contains(&again.errors(), &[&message])?;
            }
            None if !is_of_one_input => {}
            _ => {
                let what = format!("{law}: a case to paste should be printed: {is_of_one_input}");
                return Err(format!("{what}; found:\n{errors}").into());
            }
        }
    }
    Ok(())
}

/// Laws that hold for the same functions are not reported.
fn kept_laws() -> Outcome {
    let laws = [
        ("lobe", "{ integral = \"l\", about = \"n\", gives = 3.141592653589793, within = 1e-6 }"),
        (
            "lobe",
            "{ integral = \"l\", about = \"n\", cosine = true, at_most = 2.0944, within = 1e-4 }",
        ),
        ("lobe", "{ integral = \"l\", steps = 64, gives = 3.141592653589793, within = 1e-2 }"),
        ("lobe", "{ continuous = \"l\", slope = 1.01 }"),
    ];
    for (function, law) in laws {
        let inputs = "{ n = { unit = 8 }, l = { unit = 8 } }";
        let case = format!(
            "[[case]]\nfunction = \"{function}\"\noracle = \"none\"\ntolerance = {{ ulp = 2 }}\nlaws = [{law}]\ninputs = {inputs}\n"
        );
        Checked::new(MODULE, &case)?.exits(0)?;
    }
    Ok(())
}

/// Two units of 5 are allowed where the law gives 5, and not two units of what a row itself gives:
/// 0.25 or 1024.
fn at_allows_the_error_of_its_value() -> Outcome {
    for (far, code) in [("5.000001", 0), ("5.00001", 3)] {
        let module = format!(
            "fn jump(x: f32) -> f32 {{ return select(select(0.25, 1024.0, x > 0.0), {far}, x > 1.0); }}\n"
        );
        let case = "[[case]]\nfunction = \"jump\"\noracle = \"none\"\ntolerance = { ulp = 2 }\nlaws = [{ at = { x = 2 }, gives = 5 }]\ninputs = { x = [0, 1] }\n";
        Checked::new(&module, case)?.exits(code)?;
    }
    Ok(())
}

/// A mistake that is smaller than the tolerance for f32 is found in f64.
fn off_before_rounding() -> Outcome {
    let cases = "[[case]]\nfunction = \"threshold\"\nformula = \"select(0, 0.75, x > 0.5)\"\ntolerance = { abs = 0.3 }\ninputs = { x = { grid = [0, 1], count = 9 } }\n";
    let checked = Checked::new(MODULE, cases)?;
    checked.exits(3)?;
    contains(
        &checked.errors(),
        &[
            "`fades & more::threshold`: the code in f64, without any rounding, is off on 4 of 9 inputs",
            "fades & more.toml:2:12",
            "most with x = ",
        ],
    )
}

/// All three forms of a report say if everything passes.
fn passing_report() -> Outcome {
    let start = CASES.rfind("[[case]]").ok_or("no case")?;
    let checked = Checked::new(MODULE, &CASES[start..])?;
    checked.exits(0)?;
    let report: Value = serde_json::from_str(&checked.read("report.json")?)?;
    assert_eq!(report["passed"], true);
    contains(&checked.read("junit.xml")?, &["failures=\"0\">"])?;
    contains(&checked.read("index.html")?, &["all hold"])
}

/// Fails, with the place of the call, unless a text contains all parts.
#[track_caller]
fn contains(text: &str, expected: &[&str]) -> Outcome {
    let place = std::panic::Location::caller();
    match expected.iter().find(|expected| !text.contains(**expected)) {
        None => Ok(()),
        Some(missing) => Err(format!("{place}: expected `{missing}` in\n{text}").into()),
    }
}

/// Fails unless tags are closed in order, attributes have closing quotes, and `&` is escaped.
fn well_formed(text: &str, void: &[&str]) -> Outcome {
    let mut open: Vec<&str> = Vec::new();
    let mut parts = text.split('<');
    bare(parts.next().unwrap_or_default())?;
    for part in parts {
        let (tag, after) =
            part.split_once('>').ok_or_else(|| format!("`<{part}` is not closed"))?;
        if open.last() != Some(&"style") {
            bare(after)?;
        }
        let name = tag.trim_start_matches('/').split([' ', '\n', '/']).next().unwrap_or_default();
        if tag.starts_with('/') {
            let expected = open.pop();
            if expected != Some(name) {
                return Err(format!("`</{name}>` closes {expected:?}").into());
            }
        } else if tag.matches('"').count() % 2 != 0 {
            return Err(format!("`<{tag}>` has an open quote").into());
        } else if !tag.starts_with('?') && !tag.ends_with('/') && !void.contains(&name) {
            open.push(name);
        }
    }
    if open.is_empty() { Ok(()) } else { Err(format!("tags are not closed: {open:?}").into()) }
}

fn bare(text: &str) -> Outcome {
    let entities = ["amp;", "lt;", "gt;", "quot;"];
    let wrong = text
        .split('&')
        .skip(1)
        .find(|rest| !entities.iter().any(|entity| rest.starts_with(entity)));
    wrong.map_or(Ok(()), |rest| {
        let start = rest.chars().take(20).collect::<String>();
        Err(format!("an `&` that is not escaped, before `{start}`").into())
    })
}

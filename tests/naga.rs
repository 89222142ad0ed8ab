//! Issues of naga, and what became of each here: `tests/naga/issues.toml`, which explains its form.
//!
//! Every input of the table does what the table says: some targets accept it, and the validators of
//! these accept the outputs; others refuse it with a diagnostic that has a place. Values in question
//! are cases of `tests/outputs/values/naga.wesl`.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use lamplight::bundle::{Target, blob_files};
use lamplight::validators;
use libtest_mimic::{Failed, Trial};
use serde::Deserialize;

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

/// The fewest issues that the table has. It grows, and shrinks only with what naga has repaired.
const FEWEST: usize = 120;

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 4] =
        [("table", table), ("accepted", accepted), ("refused", refused), ("page", page)];
    cases.into_iter().map(|(name, case)| Trial::test(format!("naga::{name}"), case)).collect()
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    /// The version of naga that all of it was tried with.
    naga: String,
    input: Vec<Input>,
    unreached: Vec<Unreached>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Input {
    file: String,
    issues: Vec<String>,
    about: String,
    verdict: Verdict,
    /// The file that keeps what naga does wrong from outputs.
    by: Option<String>,
    targets: Vec<String>,
    #[serde(default)]
    refused: Vec<String>,
    code: Option<String>,
}

#[derive(Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Verdict {
    Repaired,
    Refused,
    Fixed,
}

impl Verdict {
    fn word(self) -> &'static str {
        match self {
            Self::Repaired => "repaired",
            Self::Refused => "refused",
            Self::Fixed => "fixed upstream",
        }
    }
}

/// What no input can show, since nothing here does it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Unreached {
    issues: Vec<String>,
    about: String,
    why: String,
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/naga")
}

fn read_table() -> Result<Table, Failed> {
    let table: Table = toml::from_str(&fs::read_to_string(folder().join("issues.toml"))?)?;
    Ok(table)
}

/// The table names every file once, says of each what can be checked, and has the version of naga
/// that is built.
fn table() -> Outcome {
    let table = read_table()?;
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let lock = fs::read_to_string(root.join("Cargo.lock"))?;
    if !lock.contains(&format!("name = \"naga\"\nversion = \"{}\"", table.naga)) {
        let what = format!("the table is of naga {}, and Cargo.lock has another", table.naga);
        return Err(format!("{what}: docs/naga.md says how to go through the table").into());
    }
    for input in &table.input {
        let is_complete = match input.verdict {
            Verdict::Repaired => input.by.as_ref().is_some_and(|by| root.join(by).is_file()),
            Verdict::Refused => !input.refused.is_empty() && input.code.is_some(),
            Verdict::Fixed => !input.targets.is_empty() && input.refused.is_empty(),
        };
        if !is_complete || input.about.is_empty() || input.issues.is_empty() {
            return Err(format!("{}: the entry does not say all of its verdict", input.file).into());
        }
    }
    let listed: Vec<&str> = table.input.iter().map(|input| input.file.as_str()).collect();
    let names = fs::read_dir(folder())?.map(|entry| Ok(entry?.file_name()));
    let names = names.collect::<Result<Vec<_>, Failed>>()?;
    let there = names.iter().filter_map(|name| name.to_str()).filter(|name| *name != "issues.toml");
    let (there, once): (BTreeSet<&str>, BTreeSet<&str>) =
        (there.collect(), listed.iter().copied().collect());
    if there != once || once.len() != listed.len() {
        let differing: Vec<&&str> = there.symmetric_difference(&once).collect();
        return Err(format!("files and entries differ: {differing:?}").into());
    }
    let count = issues(&table).len();
    match count >= FEWEST {
        true => Ok(()),
        false => Err(format!("the table has {count} issues, and had {FEWEST}").into()),
    }
}

/// Every issue, in words such as `wgpu 4558`, with what became of it.
fn issues(table: &Table) -> BTreeMap<(String, u32), Vec<String>> {
    let mut found: BTreeMap<_, Vec<String>> = BTreeMap::new();
    let mut add = |issues: &[String], what: String| {
        for issue in issues {
            let (repository, number) = issue.split_once(' ').unwrap_or_default();
            let key = (repository.to_owned(), number.parse().unwrap_or_default());
            found.entry(key).or_default().push(what.clone());
        }
    };
    for input in &table.input {
        let more = match (&input.by, &input.code) {
            (Some(by), _) => format!(" by `{by}`"),
            (None, Some(code)) => format!(", `{code}`"),
            (None, None) => String::new(),
        };
        let file = &input.file;
        add(&input.issues, format!("{}: {}{more} (`{file}`)", input.about, input.verdict.word()));
    }
    for one in &table.unreached {
        add(&one.issues, format!("{}: not reached, since {}", one.about, one.why));
    }
    found
}

fn lamplight(arguments: &[&str], folder: &Path) -> Result<Output, Failed> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
    Ok(command.current_dir(folder).args(arguments).output()?)
}

fn printed(output: &Output) -> String {
    let all = [output.stdout.as_slice(), output.stderr.as_slice()].concat();
    String::from_utf8_lossy(&all).into_owned()
}

/// A manifest with a program for each input, for the targets that accept it.
fn manifest(table: &Table) -> String {
    let mut text = String::new();
    for input in table.input.iter().filter(|input| !input.targets.is_empty()) {
        let file = &input.file;
        let name = file.split('.').next().unwrap_or_default();
        let source = match file.split('.').rev().nth(1) {
            Some("vert") => format!("glsl = {{ vertex = \"{file}\" }}"),
            Some("frag") => format!("glsl = {{ fragment = \"{file}\" }}"),
            _ => format!("wesl = \"{file}\""),
        };
        let targets: Vec<String> =
            input.targets.iter().map(|target| format!("\"{target}\"")).collect();
        let targets = targets.join(", ");
        let _ = writeln!(text, "[program.{name}]\n{source}\ntargets = [{targets}]\n");
    }
    text
}

/// The validators of all targets accept what one run of `gen` writes for all inputs.
fn accepted() -> Outcome {
    let table = read_table()?;
    let package = tempfile::tempdir()?;
    for input in &table.input {
        fs::copy(folder().join(&input.file), package.path().join(&input.file))?;
    }
    fs::write(package.path().join("lamplight.toml"), manifest(&table))?;
    let output = lamplight(&["gen", "--no-cache", "-o", "bundle"], package.path())?;
    if !output.status.success() {
        return Err(printed(&output).into());
    }
    let outputs = validators::outputs(blob_files(package.path().join("bundle"))?)?;
    match validators::validate_outputs(&outputs, None, &|_, _| ())?.first() {
        None => Ok(()),
        Some(refusal) => Err(format!("{refusal:?}").into()),
    }
}

/// Each refusal has the code of the table, and a place in the input.
fn refused() -> Outcome {
    for input in read_table()?.input.iter().filter(|input| !input.refused.is_empty()) {
        let code = input.code.as_deref().unwrap_or_default();
        for target in &input.refused {
            Target::find(target).ok_or_else(|| format!("there is no target `{target}`"))?;
            let out = tempfile::tempdir()?;
            let out = out.path().to_string_lossy().into_owned();
            let arguments = ["compile", &input.file, "--target", target, "-o", &out];
            let output = lamplight(&arguments, &folder())?;
            let text = printed(&output);
            let is_placed = text.contains(&format!("┌─ {}:", input.file));
            let is_right = text.contains(&format!("error[{code}]")) && is_placed;
            if output.status.success() || !is_right {
                let what = format!("expected `{code}` with a place for {target}");
                return Err(format!("{}: {what}:\n{text}", input.file).into());
            }
            // All targets refuse most inputs for the same reason: the last is asked too.
            if input.targets.is_empty() && input.refused.last() != Some(target) {
                break;
            }
        }
    }
    Ok(())
}

/// `docs/naga.md` ends with the table.
fn page() -> Outcome {
    const HEADING: &str = "## The list\n\n";
    let table = read_table()?;
    let mut list = format!("All of it was tried with naga {}.\n\n", table.naga);
    for ((repository, number), all) in issues(&table) {
        let place = format!("https://github.com/gfx-rs/{repository}/issues/{number}");
        let _ = writeln!(list, "- [{repository} {number}]({place}): {}.", all.join("; "));
    }
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/naga.md");
    let text = fs::read_to_string(&page)?;
    let (before, recorded) = text.split_once(HEADING).ok_or("the page has no list")?;
    if std::env::var("INSTA_UPDATE").is_ok_and(|mode| mode == "always") {
        fs::write(&page, format!("{before}{HEADING}{list}"))?;
        return Ok(());
    }
    match recorded == list {
        true => Ok(()),
        false => {
            Err("docs/naga.md is not that of the table: `cargo xtask record naga::page`".into())
        }
    }
}

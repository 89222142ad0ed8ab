//! What messages teach: each table of `tests/mistakes/*.toml` has mistakes as people make them, each
//! with its line, the lines that correct it, and what the corrected text computes.
//!
//! - `text` is the file with the mistake, `file` its name, `files` others beside it.
//! - `line` is where the mistake is. `places` lists lines where the message may point, if there are
//!   several.
//! - `fixed` has the corrected lines by their numbers, `fixed_run` a corrected command.
//! - `run` is the command; without it the file is linted, which finds what nothing reaches too.
//! - `value` has expressions of WGSL over the corrected text, and what they are.
//! - `given` lists tokens that an author knows without the message: numbers of his own choice, what the
//!   function is for.
//!
//! The message is in a snapshot. It must have a place on a line of the mistake, and a help. It
//! *teaches* if every token that the corrected lines add is in it, outside of the excerpt: then the
//! line can be written from the source and the message. Words and numbers of the lines that are
//! replaced need not be repeated. Where nothing is added, what is removed must be in it, or that
//! something is to be left out; where lines only move, it says where.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use lamplight_testing::commands::{run_line, stderr_text};
use libtest_mimic::{Failed, Trial};
use serde::Deserialize;

use crate::snapshot;

/// The command.
const LAMPLIGHT: &str = env!("CARGO_BIN_EXE_lamplight");

/// How many mistakes there must be.
const FEWEST: usize = 200;

/// How many of a hundred must be taught.
const TAUGHT: usize = 95;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    mistake: Vec<Mistake>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Mistake {
    name: String,
    file: Option<String>,
    #[serde(default)]
    files: BTreeMap<String, String>,
    text: String,
    line: usize,
    #[serde(default)]
    places: Vec<usize>,
    run: Option<String>,
    #[serde(default)]
    fixed: BTreeMap<String, String>,
    fixed_run: Option<String>,
    #[serde(default)]
    given: BTreeSet<String>,
    value: BTreeMap<String, String>,
}

pub fn tests() -> Vec<Trial> {
    let table = |path: std::path::PathBuf| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Trial::test(format!("mistakes::{name}"), move || check_table(&name, &path))
    };
    let mut tests: Vec<Trial> = tables().into_iter().map(table).collect();
    tests.push(Trial::test("mistakes are taught", taught));
    tests.push(Trial::test("mistakes without false alarms", no_alarms));
    tests
}

fn tables() -> Vec<std::path::PathBuf> {
    let folder = snapshot::root().join("tests/mistakes");
    let mut found: Vec<_> = fs::read_dir(folder)
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    found.sort();
    found
}

/// Every mistake of a table is reported where it is, with a help, and its correction works.
fn check_table(name: &str, path: &Path) -> Result<(), Failed> {
    let table: Table = toml::from_str(&fs::read_to_string(path)?)?;
    let default = if name.starts_with("glsl") { "main.frag" } else { "main.wesl" };
    let (mut text, mut wrong) = (String::new(), Vec::new());
    for mistake in &table.mistake {
        let file = mistake.file.as_deref().unwrap_or(default);
        let message = tried(mistake, file, &mistake.text, mistake.run.as_deref())?;
        wrong.extend(
            points_and_helps(mistake, file, &message)
                .err()
                .map(|why| format!("{}: {why}", mistake.name)),
        );
        wrong.extend(corrected(mistake, file)?.map(|why| format!("{}: {why}", mistake.name)));
        let missing = untaught(mistake, &message.text);
        let verdict = match missing.is_empty() {
            true => "taught".to_owned(),
            false => format!("not taught: {}", missing.into_iter().collect::<Vec<_>>().join(" ")),
        };
        write!(text, "# {}: {verdict}\n{}\n", mistake.name, message.text)?;
    }
    snapshot::check("mistakes", name, text.trim_end())?;
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n").into()) }
}

/// What a command says.
struct Message {
    text: String,
    failed: bool,
}

/// Runs the command of a mistake, or its corrected one, with a text as the file.
fn tried(mistake: &Mistake, file: &str, text: &str, run: Option<&str>) -> Result<Message, Failed> {
    let folder = tempfile::tempdir()?;
    write_files(mistake, file, text, folder.path())?;
    let line = run.map_or_else(|| format!("lint {file}"), str::to_owned);
    let output = run_line(LAMPLIGHT, folder.path(), &line)?;
    let text = stderr_text(&output);
    let lines = text.lines().map(|line| line.trim_end().to_owned() + "\n");
    Ok(Message { text: lines.collect(), failed: !output.status.success() })
}

fn write_files(mistake: &Mistake, file: &str, text: &str, folder: &Path) -> Result<(), Failed> {
    let files = mistake.files.iter().map(|(name, text)| (name.as_str(), text.as_str()));
    for (name, text) in files.chain([(file, text)]) {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().ok_or("a file without a folder")?)?;
        fs::write(path, text)?;
    }
    Ok(())
}

/// Whether a message is about the mistake: it refuses or warns, points to its line, and helps.
fn points_and_helps(mistake: &Mistake, file: &str, message: &Message) -> Result<(), String> {
    if !message.failed && !message.text.contains("warning[") {
        return Err("it is accepted".to_owned());
    }
    let helps = ["help: ", "declared: ", "did you mean"];
    if !helps.iter().any(|help| message.text.contains(help)) {
        return Err("the message has no help".to_owned());
    }
    // Line 0 stands for a command line, which has no place in a file.
    if mistake.line == 0 {
        return Ok(());
    }
    let place = message.text.split_once(&format!("┌─ {file}:"));
    let line = place.and_then(|(_, rest)| rest.split(':').next()?.parse::<usize>().ok());
    match line.is_some_and(|line| line == mistake.line || mistake.places.contains(&line)) {
        true => Ok(()),
        false => Err(format!("the message points to line {line:?}, not {}", mistake.line)),
    }
}

fn corrected_text(mistake: &Mistake) -> String {
    let lines = mistake.text.lines().enumerate().map(|(at, line)| {
        mistake.fixed.get(&(at + 1).to_string()).map_or(line, String::as_str).to_owned() + "\n"
    });
    lines.collect()
}

/// What is wrong with a correction: it is refused, or has another value.
fn corrected(mistake: &Mistake, file: &str) -> Result<Option<String>, Failed> {
    let text = corrected_text(mistake);
    let run = mistake.fixed_run.as_deref().or(mistake.run.as_deref());
    let message = tried(mistake, file, &text, run)?;
    if message.failed || message.text.contains("warning[") {
        return Ok(Some(format!("the correction is refused:\n{}", message.text)));
    }
    let folder = tempfile::tempdir()?;
    write_files(mistake, file, &text, folder.path())?;
    let mut module = file.to_owned();
    if !file.ends_with(".wesl") {
        let output = run_line(LAMPLIGHT, folder.path(), &format!("translate {file} --to wgsl"))?;
        "value.wesl".clone_into(&mut module);
        fs::write(folder.path().join(&module), output.stdout)?;
    }
    for (expression, expected) in &mistake.value {
        let own = fs::read_to_string(folder.path().join(&module))?;
        let path = format!("package::{}", module.trim_end_matches(".wesl").replace('/', "::"));
        let mut command = std::process::Command::new(LAMPLIGHT);
        let expression = with_paths(expression, &own, &path);
        command.current_dir(folder.path()).args(["eval", "--root", ".", &expression]);
        let output = command.output()?;
        let found = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        if found != *expected {
            let why = stderr_text(&output);
            return Ok(Some(format!("`{expression}` is {found}, not {expected}\n{why}")));
        }
    }
    Ok(None)
}

/// An expression with the path of the module before the names that it declares.
fn with_paths(expression: &str, module: &str, path: &str) -> String {
    let mut text = String::new();
    for token in tokens(expression) {
        let declares = ["fn ", "struct "].iter().any(|word| {
            [format!("{word}{token}("), format!("{word}{token} ")]
                .iter()
                .any(|head| module.contains(head))
        });
        text += &if declares { format!("{path}::{token}") } else { token.to_owned() };
        text.push(' ');
    }
    text
}

/// The words, numbers and marks of a text.
fn tokens(text: &str) -> Vec<&str> {
    const PAIRS: [&str; 8] = ["::", "->", "&&", "||", "==", "!=", "<=", ">="];
    let mut found = Vec::new();
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        let is_word = |one: char| one.is_alphanumeric() || one == '_';
        let is_number = |one: char| is_word(one) || one == '.';
        let length = match first {
            first if first.is_ascii_digit() => rest.find(|one| !is_number(one)),
            first if is_word(first) => rest.find(|one| !is_word(one)),
            first => {
                let pair = PAIRS.iter().find(|pair| rest.starts_with(**pair));
                Some(pair.map_or(first.len_utf8(), |pair| pair.len()))
            }
        };
        let (token, after) = rest.split_at(length.unwrap_or(rest.len()));
        found.push(token);
        rest = after.trim_start();
    }
    found
}

/// The tokens of the correction that neither the message nor the replaced lines have.
fn untaught<'m>(mistake: &'m Mistake, message: &str) -> BTreeSet<&'m str> {
    let said = message.lines().filter(|line| !is_excerpt(line)).collect::<Vec<_>>().join("\n");
    let said: BTreeSet<&str> = tokens(&said).into_iter().collect();
    let lines: Vec<&str> = mistake.text.lines().collect();
    let replaced = |number: &String| {
        let at = number.parse::<usize>().unwrap_or(1).saturating_sub(1);
        lines.get(at).copied().unwrap_or_default()
    };
    let known: BTreeSet<&str> =
        mistake.fixed.keys().flat_map(|number| tokens(replaced(number))).collect();
    let old: Vec<&str> = mistake.fixed.keys().flat_map(|number| tokens(replaced(number))).collect();
    let new: Vec<&str> = mistake.fixed.values().flat_map(|line| tokens(line)).collect();
    let (mut added, removed) = (beyond(&new, &old), beyond(&old, &new));
    let is_word = |token: &str| token.starts_with(|one: char| one.is_alphanumeric() || one == '_');
    added.retain(|token| !(is_word(token) && known.contains(token)));
    if let Some(run) = &mistake.fixed_run {
        let old = mistake.run.as_deref().unwrap_or_default();
        added.extend(tokens(run).into_iter().filter(|token| !tokens(old).contains(token)));
    }
    let moves = added.is_empty() && removed.is_empty();
    let leaves_out = added.is_empty() && !moves;
    added.retain(|token| !mistake.given.contains(*token));
    const WHERE: [&str; 5] = ["above", "before", "behind", "order", "write"];
    let needed = match (moves, leaves_out) {
        (true, _) if WHERE.iter().any(|word| said.contains(word)) => BTreeSet::new(),
        (true, _) => BTreeSet::from(["where"]),
        (false, true) if message.contains("leave") => BTreeSet::new(),
        (false, true) => removed,
        (false, false) => added,
    };
    needed.into_iter().filter(|token| !said.contains(token)).collect()
}

/// The tokens that one text has more often than another.
fn beyond<'t>(text: &[&'t str], other: &[&str]) -> BTreeSet<&'t str> {
    let count = |tokens: &[&str], token: &str| tokens.iter().filter(|one| **one == token).count();
    text.iter().filter(|token| count(text, token) > count(other, token)).copied().collect()
}

/// Whether a line of a message is one of the author's, which has a number in front.
fn is_excerpt(line: &str) -> bool {
    line.split_once('│').is_some_and(|(number, _)| number.trim().parse::<usize>().is_ok())
}

/// There are enough mistakes, no two with one name in a table, and most messages teach: the snapshots
/// say which.
fn taught() -> Result<(), Failed> {
    let (mut all, mut taught) = (0, 0);
    for path in tables() {
        let table: Table = toml::from_str(&fs::read_to_string(&path)?)?;
        let names: BTreeSet<&String> = table.mistake.iter().map(|mistake| &mistake.name).collect();
        if names.len() < table.mistake.len() {
            return Err(format!("{}: a name stands twice", path.display()).into());
        }
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let recorded = snapshot::root().join(format!("snapshots/mistakes/{name}.snap"));
        let recorded = fs::read_to_string(recorded)?;
        all += table.mistake.len();
        taught += recorded
            .lines()
            .filter(|line| line.starts_with("# ") && line.ends_with(": taught"))
            .count();
    }
    if all >= FEWEST && taught * 100 >= all * TAUGHT {
        return Ok(());
    }
    Err(format!("{taught} of {all} mistakes are taught").into())
}

/// The library and the examples contradict none of the library's documentation.
fn no_alarms() -> Result<(), Failed> {
    for folder in ["shaderlib", "examples/wesl_crate"] {
        let output =
            run_line(LAMPLIGHT, &snapshot::root().join(folder), "lint . --diagnostics short")?;
        let text = stderr_text(&output);
        let is_alarm = |line: &&str| line.contains("[argument-");
        if let Some(alarm) = text.lines().find(is_alarm) {
            return Err(format!("{folder}: {alarm}").into());
        }
        let output = String::from_utf8_lossy(&output.stdout).into_owned();
        if !output.contains(" 0 errors") {
            return Err(format!("{folder} was not checked: {text}{output}").into());
        }
    }
    Ok(())
}

//! Puts mistakes into the files that the guide shows. Users make such mistakes when they copy a
//! file, and the command that reads it must then end with an ordinary exit code.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use libtest_mimic::{Failed, Trial};

use super::block::{self, Kind};
use super::{generated, pages, stem};

/// The number of mistakes for each file. They are put in one at a time.
const MISTAKES: u64 = 4;
/// The longest time that one command may take, on a busy machine.
const PATIENCE: Duration = Duration::from_secs(20);

pub fn tests() -> Vec<Trial> {
    vec![Trial::test("guide files with mistakes are answered", answered)]
}

/// A file of a page: its path and its text.
type Shown = (String, String);

fn answered() -> Result<(), Failed> {
    let mut problems = Vec::new();
    for page in pages().iter().filter(|page| !generated::is_generated(page)) {
        let text = fs::read_to_string(page)?;
        let lines: Vec<&str> = text.lines().collect();
        let shown: Vec<Shown> = block::read(&lines)?
            .into_iter()
            .filter_map(|block| match block.kind {
                Kind::File(path) => Some((path, lines[block.lines].join("\n") + "\n")),
                _ => None,
            })
            .collect();
        problems
            .extend(of_page(&shown)?.iter().map(|problem| format!("{}: {problem}", stem(page))));
    }
    if problems.is_empty() { Ok(()) } else { Err(problems.join("\n").into()) }
}

fn of_page(shown: &[Shown]) -> Result<Vec<String>, Failed> {
    let folder = tempfile::tempdir()?;
    for (path, text) in shown {
        put(folder.path(), path, text)?;
    }
    let mut problems = Vec::new();
    for (path, text) in shown {
        let Some(arguments) = command(path, shown) else { continue };
        for seed in 0..MISTAKES {
            let wrong = mistaken(text, seed);
            put(folder.path(), path, &wrong)?;
            let problem = problem(folder.path(), &arguments)?;
            problems.extend(problem.map(|problem| format!("{path}: {problem}\n{wrong}")));
        }
        put(folder.path(), path, text)?;
    }
    Ok(problems)
}

fn put(folder: &Path, path: &str, text: &str) -> Result<(), Failed> {
    let path = folder.join(path);
    fs::create_dir_all(path.parent().unwrap_or(folder))?;
    Ok(fs::write(path, text)?)
}

/// The arguments of the command that reads a file.
fn command(path: &str, shown: &[Shown]) -> Option<Vec<String>> {
    let words = |words: &[&str]| Some(words.iter().map(|word| (*word).to_owned()).collect());
    let shader = || shown.iter().find(|(path, _)| path.ends_with(".wesl")).map(|(path, _)| path);
    let name = path.rsplit('/').next().unwrap_or(path);
    match (name, name.rsplit('.').next().unwrap_or_default()) {
        ("lamplight.toml", _) => words(&["variants", "--manifest", path]),
        ("wesl.toml", _) => words(&["compose", shader()?]),
        ("Cargo.toml" | "tolerances.toml", _) => None,
        (_, "toml") => words(&["check", path]),
        (_, "wesl" | "frag" | "vert") => words(&["compile", path, "--target", "wgsl"]),
        _ => None,
    }
}

/// What is wrong with how a command ended: a signal, a panic, an unknown exit code, or a long time.
fn problem(folder: &Path, arguments: &[String]) -> Result<Option<String>, Failed> {
    let start = Instant::now();
    let output = Command::new(env!("CARGO_BIN_EXE_lamplight"))
        .current_dir(folder)
        .args(arguments)
        .output()?;
    let stderr = String::from_utf8_lossy(&output.stderr);
    let problem = match output.status.code() {
        None => Some("killed by a signal".to_owned()),
        Some(0 | 1 | 3) if stderr.contains("panicked") => Some(stderr.into_owned()),
        Some(0 | 1 | 3) if start.elapsed() < PATIENCE => None,
        Some(0 | 1 | 3) => Some(format!("took {:?}", start.elapsed())),
        Some(code) => Some(format!("exit code {code}: {stderr}")),
    };
    Ok(problem)
}

/// Characters that have a meaning in one of the languages.
const SIGNS: &[&str] = &["{", "}", "(", ")", "[", "]", "\"", "=", ";", ",", "@if(", "#", "0", "é"];

/// The text with one mistake: a part is left out, a part is repeated, or one of [`SIGNS`] is put in.
fn mistaken(text: &str, seed: u64) -> String {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ text.len() as u64;
    let mut below = |limit: usize| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % limit.max(1)
    };
    let start = text.floor_char_boundary(below(text.len()));
    let end = text.ceil_char_boundary((start + 1 + below(12)).min(text.len()));
    let (before, part, after) = (&text[..start], &text[start..end], &text[end..]);
    match seed % 3 {
        0 => format!("{before}{after}"),
        1 => format!("{before}{part}{part}{after}"),
        _ => format!("{before}{}{part}{after}", SIGNS[below(SIGNS.len())]),
    }
}

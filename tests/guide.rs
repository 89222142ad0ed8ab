//! The guide: whatever its pages show is run, and compared with what they say.
//!
//! A page is a Markdown file of `docs/guide/`. Its fenced blocks say by their info string what
//! they are; `CONTRIBUTING.md` lists the forms, [`block`] reads them. Each page is one session of
//! a shell in an empty folder. `INSTA_UPDATE=always` writes what was found into the pages.

mod block;
mod compare;
mod generated;
mod mutated;
mod page;
mod references;
mod session;

use std::path::PathBuf;

use libtest_mimic::{Failed, Trial};

use crate::snapshot;

pub fn trials() -> Vec<Trial> {
    let mut trials: Vec<Trial> = pages()
        .into_iter()
        .map(|path| Trial::test(format!("guide::{}", stem(&path)), move || page::check(&path)))
        .collect();
    trials.extend(compare::trials());
    trials.extend(mutated::trials());
    trials.extend(references::trials());
    trials
}

/// Where the pages are.
fn folder() -> PathBuf {
    snapshot::root().join("docs/guide")
}

/// The pages, sorted by name, without the list of them.
fn pages() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder()).into_iter().flatten().flatten();
    let mut found: Vec<PathBuf> = entries
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "md"))
        .filter(|path| stem(path) != "SUMMARY")
        .collect();
    found.sort();
    found
}

fn stem(path: &std::path::Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// The text of a file that a page shows.
pub fn shown_file(page: &str, name: &str) -> Result<String, Failed> {
    let lines: Vec<&str> = page.lines().collect();
    let is_wanted =
        |block: &block::Block| matches!(&block.kind, block::Kind::File(path) if path == name);
    let found = block::read(&lines)?.into_iter().find(is_wanted);
    let found = found.ok_or_else(|| format!("the page shows no `{name}`"))?;
    Ok(lines[found.lines].join("\n") + "\n")
}

/// Compares what a program printed with the block of a page that begins with its command.
pub fn shows_output(page: &str, command: &str, printed: &[String]) -> Result<(), Failed> {
    let lines: Vec<&str> = page.lines().collect();
    let is_wanted = |block: &block::Block| {
        lines[block.lines.start].starts_with("$ ") && lines[block.lines.start].contains(command)
    };
    let found = block::read(&lines)?.into_iter().find(is_wanted);
    let found = found.ok_or_else(|| format!("the page does not run `{command}`"))?;
    let shown = &lines[found.lines.start + 1..found.lines.end];
    let printed: Vec<&str> = printed.iter().map(String::as_str).collect();
    match compare::matches(shown, &printed) {
        true => Ok(()),
        false => Err(format!("the page shows {shown:#?}, printed was {printed:#?}").into()),
    }
}

/// Waits until something holds; whether it did within a minute.
pub fn waits_for(holds: impl Fn() -> bool) -> bool {
    let start = std::time::Instant::now();
    while !holds() && start.elapsed() < std::time::Duration::from_secs(60) {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    holds()
}

/// The first heading of a page.
fn title(text: &str) -> Result<&str, Failed> {
    let heading = text.lines().find_map(|line| line.strip_prefix("# "));
    heading.ok_or_else(|| "the page has no title".into())
}

/// Whether differences are to be written rather than told.
fn accepts() -> bool {
    std::env::var("INSTA_UPDATE").is_ok_and(|mode| mode == "always")
}

/// How to accept a difference.
const ACCEPT: &str = "accept with: INSTA_UPDATE=always cargo test --test all -- guide::";

//! The guide: the commands of its pages are run, and their output is compared with the pages.
//!
//! A page is a Markdown file of `docs/guide/`, or the README of the repository. The info string of a
//! fenced block says what the block is. `CONTRIBUTING.md` lists the forms, and [`block`] reads them.
//! Each page is one shell session in an empty folder. `INSTA_UPDATE=always` writes the outputs that
//! were found into the pages.

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

pub fn tests() -> Vec<Trial> {
    let mut tests: Vec<Trial> = pages()
        .into_iter()
        .map(|path| Trial::test(format!("guide::{}", stem(&path)), move || page::check(&path)))
        .collect();
    let readme = snapshot::root().join("README.md");
    tests.push(Trial::test("guide::front_page", move || page::check(&readme)));
    tests.extend(compare::tests());
    tests.extend(mutated::tests());
    tests.extend(references::tests());
    tests
}

/// The folder of the pages.
fn folder() -> PathBuf {
    snapshot::root().join("docs/guide")
}

/// The pages, sorted by name, without the table of contents.
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
        false => {
            let what = format!("the page shows {shown:#?}, it printed {printed:#?}");
            Err(format!("`{command}`: {what}").into())
        }
    }
}

/// Waits until a condition holds. Gives whether it did within a minute.
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

/// Whether differences are written into the pages, and not reported.
fn accepts() -> bool {
    std::env::var("INSTA_UPDATE").is_ok_and(|mode| mode == "always")
}

/// The command that accepts differences.
const ACCEPT: &str = "accept with: cargo xtask record guide::";

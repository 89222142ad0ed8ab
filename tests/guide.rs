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

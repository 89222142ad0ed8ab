//! The page that is generated from the explanations of diagnostics.

use std::fmt::Write as _;
use std::path::Path;

use lamplight::diagnostic::{Code, codes, guide};
use libtest_mimic::Failed;

use super::{ACCEPT, accepts, stem};

const PAGE: &str = "troubleshooting";

/// Whether a page is generated. Nothing in such a page is run.
pub fn is_generated(page: &Path) -> bool {
    stem(page) == PAGE
}

/// Compares the page with the generated text. A difference is written or reported.
pub fn check(path: &Path) -> Result<(), Failed> {
    let text = text();
    match (std::fs::read_to_string(path).is_ok_and(|known| known == text), accepts()) {
        (true, _) => Ok(()),
        (false, true) => Ok(std::fs::write(path, text)?),
        (false, false) => Err(format!("{} is not up to date; {ACCEPT}", path.display()).into()),
    }
}

const HEAD: &str = "# Troubleshooting by diagnostic

Every error and warning has a code, which stands in brackets: `error[unknown-axis]`.
`lamplight explain unknown-axis` prints what this page says of it, and `lamplight explain` lists
all codes.

This page is made from those explanations: `crates/diagnostic/src/codes/` has one file for each.
";

fn text() -> String {
    let mut text = HEAD.to_owned();
    for page in guide::PAGES {
        let _ = write!(text, "\n## {}\n", heading(page));
        for code in page.codes() {
            section(&mut text, code);
        }
    }
    text
}

/// The heading above a page's codes. Codes that belong to no other page belong to this one.
fn heading(page: &guide::GuidePage) -> String {
    match page.file.strip_suffix(".md") {
        Some(PAGE) => "Data of the library".to_owned(),
        _ => format!("[{}]({})", page.title, page.file),
    }
}

fn section(text: &mut String, code: &Code) {
    let _ = write!(text, "\n### {}\n\n**{}.** {}\n", code.name, code.title, code.explanation);
}

/// The codes that name no page.
pub fn homeless() -> Vec<&'static str> {
    let missing = codes::ALL.iter().filter(|code| guide::page_of(code).is_none());
    missing.map(|code| code.name).collect()
}

//! The page of the guide with all rows and what was measured.

use std::fmt::Write as _;

use libtest_mimic::Failed;

use super::rows::{Expected, Row, all};
use super::{all_measured, failed};
use crate::snapshot;

const PAGE: &str = "docs/guide/gltf.md";
const START: &str = "<!-- rows -->\n";
/// What is between the two figures of a row that differs.
pub const MEDIAN: &str = "; half are off by more than ";

/// Whether the page is written, and not compared with.
pub fn is_updated() -> bool {
    std::env::var_os("UPDATE_EXPECT").is_some()
}

/// The page has all rows. Its figures are those of the evaluator: the rows' own tests compare them. With
/// `UPDATE_EXPECT=1`, they are measured and written.
pub fn is_current() -> Result<(), Failed> {
    let file = snapshot::root().join(PAGE);
    let text = std::fs::read_to_string(&file)?;
    let (head, _) = text.split_once(START).ok_or_else(|| failed(format!("no `{START}`")))?;
    if is_updated() {
        let mut lines = String::new();
        for (row, found) in all_measured() {
            let found = found.as_ref().map_err(|reason| format!("{}: {reason}", row.name))?;
            lines += &line(row, &found.figure(row.expected));
        }
        std::fs::write(&file, format!("{head}{START}{lines}"))?;
        return Ok(());
    }
    let mut wanted = String::new();
    for row in all() {
        wanted += &line(&row, &figure(&text, &row).map_err(failed)?);
    }
    match text == format!("{head}{START}{wanted}") {
        true => Ok(()),
        false => Err(format!("{PAGE} is not current: run with UPDATE_EXPECT=1").into()),
    }
}

fn line(row: &Row, figure: &str) -> String {
    let mut line = format!("| `{}` | {} | {}", row.name, row.text, row.about);
    if let Expected::Differs { why } = row.expected {
        write!(line, "; **differs**: {why}").expect("a string");
    }
    line + &format!(" | {figure} |\n")
}

/// What the page says of a row.
fn figure(text: &str, row: &Row) -> Result<String, String> {
    let start = format!("| `{}` |", row.name);
    let line = text.lines().find(|line| line.starts_with(&start));
    let line = line.ok_or_else(|| format!("{PAGE} has no row `{}`", row.name))?;
    let mut cells = line.trim_end_matches('|').rsplit('|');
    Ok(cells.next().unwrap_or_default().trim().to_owned())
}

/// The figure that the page has for a row.
pub fn printed(row: &Row) -> Result<String, String> {
    let text = std::fs::read_to_string(snapshot::root().join(PAGE)).map_err(|e| e.to_string())?;
    figure(&text, row)
}

/// The share of pixels that the page says agree, and the difference that it says half of them exceed.
pub fn listed(row: &Row) -> Result<(f64, f64), String> {
    let printed = printed(row)?;
    let number = |text: &str| {
        let percent = text.trim().parse::<f64>();
        percent.map(|percent| percent / 100.0).map_err(|error| format!("{printed}: {error}"))
    };
    let (agree, median) = printed.split_once(MEDIAN).unwrap_or((&printed, "0"));
    Ok((number(agree)?, number(median)?))
}

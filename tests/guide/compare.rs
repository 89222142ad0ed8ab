//! Compares the output that a page shows with a real output. `...` within a line stands for any
//! text, and a line `...` for any lines: those that change from run to run or are left out.

use libtest_mimic::{Failed, Trial};

const ANY: &str = "...";

pub fn tests() -> Vec<Trial> {
    vec![Trial::test("guide compares outputs", compares)]
}

/// Whether the lines of a page describe the lines of an output.
pub fn matches(page: &[&str], output: &[&str]) -> bool {
    // `reach[n]`: whether the page's lines so far describe the first `n` lines of the output.
    let mut reach = vec![false; output.len() + 1];
    reach[0] = true;
    for pattern in page {
        reach = if pattern.trim() == ANY {
            let first = reach.iter().position(|reached| *reached).unwrap_or(reach.len());
            (0..reach.len()).map(|count| count >= first).collect()
        } else {
            let fits = |count: usize| reach[count - 1] && line_matches(pattern, output[count - 1]);
            (0..reach.len()).map(|count| count > 0 && fits(count)).collect()
        };
    }
    reach[output.len()]
}

/// Whether a line of a page describes a line of an output.
fn line_matches(pattern: &str, line: &str) -> bool {
    let Some((start, rest)) = pattern.split_once(ANY) else { return pattern == line };
    let Some(mut left) = line.strip_prefix(start) else { return false };
    let parts: Vec<&str> = rest.split(ANY).collect();
    let (last, between) = parts.split_last().unwrap_or((&"", &[]));
    for part in between {
        let Some(at) = left.find(part) else { return false };
        left = &left[at + part.len()..];
    }
    left.ends_with(last)
}

/// The lines that a page should show: its own lines where they still hold, else the output's.
pub fn merged(page: &[&str], output: &[&str]) -> Vec<String> {
    let mut lines = Vec::new();
    let (mut of_page, mut of_output) = (0, 0);
    for (pattern, line) in aligned(page, output) {
        gap(&page[of_page..pattern], &output[of_output..line], &mut lines);
        lines.push(page[pattern].to_owned());
        (of_page, of_output) = (pattern + 1, line + 1);
    }
    gap(&page[of_page..], &output[of_output..], &mut lines);
    lines
}

/// Writes the lines between two that still hold. A single `...` stays, and anything else becomes
/// the lines of the output.
fn gap(page: &[&str], output: &[&str], lines: &mut Vec<String>) {
    match page {
        [only] if only.trim() == ANY && !output.is_empty() => lines.push((*only).to_owned()),
        _ => lines.extend(output.iter().map(|line| settled(line))),
    }
}

/// The longest common subsequence: pairs of a line of the page and a line that it describes.
fn aligned(page: &[&str], output: &[&str]) -> Vec<(usize, usize)> {
    let fits = |i: usize, j: usize| page[i].trim() != ANY && line_matches(page[i], output[j]);
    let mut best = vec![vec![0; output.len() + 1]; page.len() + 1];
    for i in (0..page.len()).rev() {
        for j in (0..output.len()).rev() {
            best[i][j] = match fits(i, j) {
                true => best[i + 1][j + 1] + 1,
                false => best[i + 1][j].max(best[i][j + 1]),
            };
        }
    }
    let (mut i, mut j, mut pairs) = (0, 0, Vec::new());
    while i < page.len() && j < output.len() {
        if fits(i, j) {
            pairs.push((i, j));
            (i, j) = (i + 1, j + 1);
        } else if best[i + 1][j] >= best[i][j + 1] {
            i += 1;
        } else {
            j += 1;
        }
    }
    pairs
}

/// A line with `...` for times and speeds, which change from run to run.
fn settled(line: &str) -> String {
    let words: Vec<&str> = line.split(' ').collect();
    let is_measured = |at: usize| {
        let next = |offset: usize| words.get(at + offset).map(|word| word.trim_end_matches(','));
        let is_number = words[at].parse::<f64>().is_ok();
        is_number && (next(1) == Some("s") || (next(1), next(2)) == (Some("a"), Some("second")))
    };
    let settled = (0..words.len()).map(|at| if is_measured(at) { ANY } else { words[at] });
    settled.collect::<Vec<_>>().join(" ")
}

/// Differences are found, `...` is kept in a page that is updated, and times become `...`. Without
/// this test, a comparison that accepts everything would make all tests of pages pass.
fn compares() -> Result<(), Failed> {
    let output = ["one", "two 2", "three", "done in 0.25 s, 12 a second"];
    let cases: [(&[&str], bool); 7] = [
        (&["one", "two 2", "three", "done in ... s, ... a second"], true),
        (&["one", "...", "done in ..."], true),
        (&["...", "three", "..."], true),
        (&["one", "two 2", "three"], false),
        (&["one", "two 3", "..."], false),
        (&["one", "...", "two 2"], false),
        (&["two 2", "..."], false),
    ];
    for (page, expected) in cases {
        if matches(page, &output) != expected {
            return Err(format!("{page:?} matches {output:?}: expected {expected}").into());
        }
    }
    let merged = merged(&["zero", "two ...", "..."], &output);
    let expected = ["one", "two ...", "..."];
    if merged != expected {
        return Err(format!("merged to {merged:?}, expected {expected:?}").into());
    }
    let settled = settled(output[3]);
    if settled != "done in ... s, ... a second" {
        return Err(format!("times should become `...`: `{settled}`").into());
    }
    Ok(())
}

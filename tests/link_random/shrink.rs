//! Makes the text of a finding smaller: lines are removed as long as it has the same finding.

/// The most texts that are tried.
const MOST: usize = 600;

/// A smaller text, of which this is true as well.
pub fn shrunk(text: &str, has: &dyn Fn(&str) -> bool) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    let (mut size, mut at, mut tries) = (lines.len() / 2, 0, 0);
    while size > 0 && tries < MOST {
        if at >= lines.len() {
            (size, at) = (size / 2, 0);
            continue;
        }
        let end = (at + size).min(lines.len());
        let fewer = [&lines[..at], &lines[end..]].concat();
        tries += 1;
        match has(&joined(&fewer)) {
            true => lines = fewer,
            false => at = end,
        }
    }
    let mut at = 0;
    while at < lines.len() && tries < 2 * MOST {
        let smaller = without_block(&lines, at).into_iter().find(|fewer| {
            tries += 1;
            has(&joined(fewer))
        });
        match smaller {
            Some(fewer) => lines = fewer,
            None => at += 1,
        }
    }
    joined(&lines)
}

fn joined(lines: &[&str]) -> String {
    lines.join("\n") + "\n"
}

/// The lines without the block that begins at a line, and without its first and last line alone.
fn without_block<'t>(lines: &[&'t str], at: usize) -> Vec<Vec<&'t str>> {
    if !lines[at].trim_end().ends_with('{') {
        return vec![[&lines[..at], &lines[at + 1..]].concat()];
    }
    let mut depth = 0;
    let mut ends = |line: &str| {
        depth += line.matches('{').count() as i32 - line.matches('}').count() as i32;
        depth <= 0
    };
    let Some(end) = lines[at..].iter().position(|line| ends(line)) else { return Vec::new() };
    let (before, inner, behind) =
        (&lines[..at], &lines[at + 1..at + end.max(1)], &lines[at + end + 1..]);
    vec![[before, behind].concat(), [before, inner, behind].concat()]
}

//! A line of the changelog.

use super::{NewFiles, Repository, TaskKind};

pub const KIND: TaskKind =
    TaskKind { name: "change", example: &["Pictures", "The scene `staircase`."], rest: "", make };

const CHANGELOG: &str = "CHANGELOG.md";

/// Adds the line at the end of a section of what is not released yet.
fn make(repository: &Repository<'_>, section: &str, rest: &[&str]) -> Result<NewFiles, String> {
    let [words] = rest else {
        return Err("name a section and say what changed: SECTION 'WHAT USERS NOTICE.'".into());
    };
    let text = repository.read(CHANGELOG)?;
    let start = text.find("\n## Unreleased\n").ok_or("the changelog has no \"Unreleased\"")? + 1;
    let end = text[start + 2..].find("\n## ").map_or(text.len(), |at| start + 2 + at + 1);
    let sections = || text[start..end].lines().filter_map(|line| line.strip_prefix("### "));
    if !sections().any(|known| known == section) {
        let known = sections().collect::<Vec<_>>().join(", ");
        return Err(format!("no section `{section}` below \"Unreleased\": {known}"));
    }
    let heading = format!("\n### {section}\n");
    let lines = text[start..end].find(&heading).map_or(end, |at| start + at + heading.len());
    let next = text[lines..end].find("\n### ").map_or(end, |at| lines + at);
    let list = text[lines..next].trim_end();
    let (before, after) = (&text[..lines], &text[next..]);
    let gap = if after.trim().is_empty() { "" } else { "\n" };
    let changed = format!("{before}{list}\n- {}\n{gap}{}", words.trim(), after.trim_start());
    Ok(NewFiles {
        files: vec![(CHANGELOG.to_owned(), changed)],
        next: vec!["read the line once more".to_owned()],
    })
}

//! Runs one page as a session, and compares the results with the page.

use std::fs;
use std::ops::Range;
use std::path::Path;

use libtest_mimic::Failed;

use super::block::{self, Block, Kind};
use super::session::{Outcome, Session, Step};
use super::{ACCEPT, accepts, compare, generated};

/// Lines of the page that should be replaced.
struct Change {
    lines: Range<usize>,
    becomes: Vec<String>,
}

/// Runs the page. Differences are written into it or reported.
pub fn check(path: &Path) -> Result<(), Failed> {
    if generated::is_generated(path) {
        return generated::check(path);
    }
    let text = fs::read_to_string(path)?;
    let lines: Vec<&str> = text.lines().collect();
    let blocks = block::read(&lines)?;
    let steps = steps(&lines, &blocks);
    if steps.is_empty() {
        return Ok(());
    }
    let session = Session::run(&steps)?;
    let changes = changes(&lines, &blocks, &session)?;
    match (changes.is_empty(), accepts()) {
        (true, _) => Ok(()),
        (false, true) => Ok(fs::write(path, changed(&lines, &changes))?),
        (false, false) => {
            let differences: Vec<String> =
                changes.iter().map(|change| describe_change(&lines, change)).collect();
            Err(format!("{}\n{ACCEPT}", differences.join("\n")).into())
        }
    }
}

fn steps<'a>(lines: &[&str], blocks: &'a [Block]) -> Vec<Step<'a>> {
    let mut steps = Vec::new();
    for block in blocks {
        match &block.kind {
            Kind::File(path) => {
                let text = lines[block.lines.clone()].iter().map(|line| format!("{line}\n"));
                steps.push(Step::File { path, text: text.collect() });
            }
            Kind::Console(_, commands) => {
                steps.extend(commands.iter().map(|command| Step::Command(&command.text)))
            }
            Kind::Made(_) | Kind::Text => {}
        }
    }
    steps
}

/// The differences between the page and the session.
fn changes(lines: &[&str], blocks: &[Block], session: &Session) -> Result<Vec<Change>, Failed> {
    let mut outcomes = session.outcomes.iter();
    let mut changes = Vec::new();
    for block in blocks {
        match &block.kind {
            Kind::Console(code, commands) => {
                let ran: Vec<&Outcome> = outcomes.by_ref().take(commands.len()).collect();
                changes.extend(exit(lines, block, *code, &ran)?);
                let pairs = commands.iter().zip(&ran);
                changes.extend(pairs.filter_map(|(command, outcome)| {
                    let found: Vec<&str> = outcome.lines.iter().map(String::as_str).collect();
                    change(lines, command.output.clone(), &found)
                }));
            }
            Kind::Made(path) => {
                let made = session.made(path)?;
                let made: Vec<&str> = made.lines().map(str::trim_end).collect();
                changes.extend(change(lines, block.lines.clone(), &made));
            }
            Kind::File(_) | Kind::Text => {}
        }
    }
    Ok(changes)
}

fn change(lines: &[&str], shown: Range<usize>, found: &[&str]) -> Option<Change> {
    let page = &lines[shown.clone()];
    let same = compare::matches(page, found);
    (!same).then(|| Change { lines: shown, becomes: compare::merged(page, found) })
}

/// The change of a console block's info string, if its last command ended with another exit code.
/// An earlier command must end with 0, since the info string has only one code.
fn exit(
    lines: &[&str],
    block: &Block,
    code: i32,
    ran: &[&Outcome],
) -> Result<Option<Change>, Failed> {
    let fence = block.lines.start - 1;
    let Some((last, earlier)) = ran.split_last() else { return Ok(None) };
    if let Some(failed) = earlier.iter().find(|outcome| outcome.code != 0) {
        let place =
            format!("line {}: a command before the last ended with {}", fence + 1, failed.code);
        return Err(format!("{place}\n{}", failed.lines.join("\n")).into());
    }
    if last.code == code {
        return Ok(None);
    }
    let fences = lines[fence].trim_end_matches(|letter| letter != '`');
    let becomes = match last.code {
        0 => format!("{fences}console"),
        code => format!("{fences}console exit={code}"),
    };
    Ok(Some(Change { lines: fence..fence + 1, becomes: vec![becomes] }))
}

fn changed(lines: &[&str], changes: &[Change]) -> String {
    let (mut text, mut at) = (String::new(), 0);
    let mut sorted: Vec<&Change> = changes.iter().collect();
    sorted.sort_by_key(|change| change.lines.start);
    for change in sorted {
        lines[at..change.lines.start].iter().for_each(|line| text += &format!("{line}\n"));
        change.becomes.iter().for_each(|line| text += &format!("{line}\n"));
        at = change.lines.end;
    }
    lines[at..].iter().for_each(|line| text += &format!("{line}\n"));
    text
}

fn describe_change(lines: &[&str], change: &Change) -> String {
    let place = format!("line {}:", change.lines.start + 1);
    let old = lines[change.lines.clone()].iter().map(|line| format!("- {line}"));
    let new = change.becomes.iter().map(|line| format!("+ {line}"));
    std::iter::once(place).chain(old).chain(new).collect::<Vec<_>>().join("\n")
}

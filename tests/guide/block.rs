//! Reads the fenced blocks of a page.
//!
//! | info string | the block is |
//! |---|---|
//! | `LANGUAGE file=PATH` | a file that the commands after it find at that path |
//! | `LANGUAGE made=PATH` | the file that a command before it wrote to that path |
//! | `console` | commands after `$ ` (continued after `> `), each with its output |
//! | `console exit=N` | the same; the last command ends with that exit code |
//! | `text` | text that is not run: a grammar, a diagram |

use std::ops::Range;

use libtest_mimic::Failed;

/// A block: its kind, and the lines between its fences.
pub struct Block {
    pub kind: Kind,
    /// The lines of the page, counted from 0.
    pub lines: Range<usize>,
}

pub enum Kind {
    /// A file with this path, which is written before the commands after the block.
    File(String),
    /// A file with this path, which is compared with the one that earlier commands wrote.
    Made(String),
    /// Commands, with the exit code of the last one.
    Console(i32, Vec<Command>),
    /// A text that is not run.
    Text,
}

/// A command of a console block.
pub struct Command {
    pub text: String,
    /// The lines of the page that show its output.
    pub output: Range<usize>,
}

const FENCE: &str = "```";

/// The blocks of a page, in order.
pub fn read(lines: &[&str]) -> Result<Vec<Block>, Failed> {
    let mut blocks = Vec::new();
    let mut at = 0;
    while at < lines.len() {
        let Some(info) = opening(lines[at]) else {
            at += 1;
            continue;
        };
        let fence = &lines[at][..lines[at].len() - info.len()];
        let length = lines[at + 1..].iter().position(|line| *line == fence);
        let length = length.ok_or_else(|| format!("line {}: the block never ends", at + 1))?;
        let inner = at + 1..at + 1 + length;
        let kind = kind(info, lines, inner.clone())
            .and_then(|kind| named(kind, &lines[..at]))
            .map_err(|reason| format!("line {}: {reason}", at + 1))?;
        at = inner.end + 1;
        blocks.push(Block { kind, lines: inner });
    }
    Ok(blocks)
}

/// The info string, if the line opens a block. A block with four backticks may contain three.
fn opening(line: &str) -> Option<&str> {
    line.starts_with(FENCE).then(|| line.trim_start_matches('`'))
}

fn kind(info: &str, lines: &[&str], inner: Range<usize>) -> Result<Kind, String> {
    let mut words = info.split_whitespace();
    let language = words.next().unwrap_or_default();
    let attributes: Vec<(&str, &str)> =
        words.map(|word| word.split_once('=').unwrap_or((word, ""))).collect();
    match (language, attributes.as_slice()) {
        ("text", []) => Ok(Kind::Text),
        ("console", []) => Ok(Kind::Console(0, commands(lines, inner)?)),
        ("console", [("exit", code)]) => {
            let code = code.parse().map_err(|_| format!("`{code}` is not an exit code"))?;
            Ok(Kind::Console(code, commands(lines, inner)?))
        }
        (_, [("file", path)]) => Ok(Kind::File((*path).to_owned())),
        (_, [("made", path)]) => Ok(Kind::Made((*path).to_owned())),
        _ => Err(format!(
            "`{info}` is not a form of a block: use `console`, `file=PATH`, `made=PATH` or `text`"
        )),
    }
}

/// Fails unless the text above a file names it. Readers do not see the info string.
fn named(kind: Kind, above: &[&str]) -> Result<Kind, String> {
    let (Kind::File(path) | Kind::Made(path)) = &kind else { return Ok(kind) };
    let name = format!("`{path}`");
    match above.iter().rev().find(|line| !line.is_empty()) {
        Some(line) if line.contains(&name) => Ok(kind),
        _ => Err(format!("the line above does not name {name}")),
    }
}

fn commands(lines: &[&str], inner: Range<usize>) -> Result<Vec<Command>, String> {
    let mut commands: Vec<Command> = Vec::new();
    for at in inner {
        let line = lines[at];
        match (line.strip_prefix("$ "), commands.last_mut()) {
            (Some(text), _) => {
                commands.push(Command { text: text.to_owned(), output: at + 1..at + 1 })
            }
            (None, Some(last)) if last.output.is_empty() && line.starts_with("> ") => {
                last.text += &format!("\n{}", &line[2..]);
                last.output = at + 1..at + 1;
            }
            (None, Some(last)) => last.output.end = at + 1,
            (None, None) => return Err("a console block must start with `$ `".to_owned()),
        }
    }
    match commands.is_empty() {
        true => Err("a console block must have a command".to_owned()),
        false => Ok(commands),
    }
}

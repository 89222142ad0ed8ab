//! Functions and files are short enough to be read in one go.

use std::collections::BTreeSet;
use std::path::Path;

use libtest_mimic::Failed;

use crate::{ROOT, git};

/// The most lines of a function, from `fn` to its closing brace.
const FUNCTION: usize = 50;

/// The most lines of a file.
const FILE: usize = 800;

const ARMS: &str = "a table: one arm for each case of an enumeration of naga's";

/// Functions that may be longer: file, name, reason.
const FUNCTIONS: &[(&str, &str, &str)] = &[
    ("crates/eval/src/machine/compute.rs", "compute", "a table: one arm for each instruction"),
    (
        "crates/link/src/spirv/operands.rs",
        "operand_layout",
        "a table: one arm for each layout of opcodes",
    ),
    ("crates/validate/src/words/entry.rs", "entry_words", ARMS),
    ("crates/validate/src/words/entry.rs", "varying_words", ARMS),
    ("crates/validate/src/words/expression.rs", "expression_words", ARMS),
    ("crates/validate/src/words/function.rs", "function_words", ARMS),
    ("crates/validate/src/words/types.rs", "type_of", ARMS),
];

/// Files that may be longer: file, reason.
const FILES: &[(&str, &str)] = &[];

/// No function and no file is too long, except for those in the tables above. Every entry of the
/// tables is still needed.
pub fn are_kept() -> Result<(), Failed> {
    let mut problems = Vec::new();
    let (mut long_functions, mut long_files) = (BTreeSet::new(), BTreeSet::new());
    for path in git(&["ls-files", "-z", "*.rs"])? {
        // git still lists a file that is deleted before the deletion is committed.
        let Ok(text) = std::fs::read_to_string(Path::new(ROOT).join(&path)) else { continue };
        let lines = text.lines().count();
        if lines > FILE {
            if !FILES.iter().any(|(file, _)| *file == path) {
                problems.push(format!("{path} has {lines} lines, more than {FILE}"));
            }
            long_files.insert(path.clone());
        }
        for (name, lines) in functions(&text).into_iter().filter(|(_, lines)| *lines > FUNCTION) {
            if !FUNCTIONS.iter().any(|(file, known, _)| *file == path && *known == name) {
                problems.push(format!("{path}: `{name}` has {lines} lines, more than {FUNCTION}"));
            }
            long_functions.insert((path.clone(), name));
        }
    }
    let is_short = |file: &str, name: &str| !long_functions.contains(&(file.into(), name.into()));
    let short = FUNCTIONS.iter().filter(|(file, name, _)| is_short(file, name));
    problems.extend(short.map(|(file, name, _)| {
        format!("{file}: `{name}` is short now, remove it from xtask/tests/house/lengths.rs")
    }));
    let short = FILES.iter().filter(|(file, _)| !long_files.contains(*file));
    problems.extend(short.map(|(file, _)| {
        format!("{file} is short now, remove it from xtask/tests/house/lengths.rs")
    }));
    if problems.is_empty() { Ok(()) } else { Err(problems.join("\n").into()) }
}

/// Functions are found with their lengths, and strings and comments are not taken for code.
pub fn are_counted() -> Result<(), Failed> {
    let text = "
fn one(a: [u8; 2], f: fn(u8) -> u8) -> u8 {
    // fn not(a) {
    let brace = ('{', '\\'', \"fn nor_this() { \\\" {\", r#\"}\" fn {\"#);
    fn inner<'a>() {}
    /* } /* } */ */
}
trait Two { fn declared(); fn given() { } }
const C: &str = \"
fn shader() {
}\";
fn taken(Pair { left, right }: Pair) -> u8 {
    left + right
}
";
    let expected = [("one", 6), ("inner", 1), ("given", 1), ("taken", 3)]
        .map(|(name, lines)| (name.into(), lines));
    let found = functions(text);
    match found == expected {
        true => Ok(()),
        false => Err(format!("expected the functions {expected:?}, found {found:?}").into()),
    }
}

/// The names of a text's functions, with how many lines each has.
fn functions(text: &str) -> Vec<(String, usize)> {
    let code = code_of(text);
    let follows = |letter: char| letter.is_alphanumeric() || letter == '_';
    let starts = code.match_indices("fn ").map(|(start, _)| start);
    let starts = starts.filter(|start| !code[..*start].ends_with(follows));
    let found = starts.filter_map(|start| {
        let rest = &code[start + 3..];
        let name: String = rest.chars().take_while(|letter| follows(*letter)).collect();
        let body = &rest[..end_of_body(rest)?];
        (!name.is_empty()).then(|| (name, body.matches('\n').count() + 1))
    });
    found.collect()
}

/// The end of a function's body, if it has one.
fn end_of_body(code: &str) -> Option<usize> {
    let (mut braces, mut brackets) = (0_usize, 0_usize);
    for (at, letter) in code.char_indices() {
        match letter {
            // A parameter may be a pattern with braces of its own.
            '(' | '[' if braces == 0 => brackets += 1,
            ')' | ']' if braces == 0 => brackets -= 1,
            _ if brackets > 0 => {}
            ';' if braces == 0 => return None,
            '{' => braces += 1,
            '}' if braces == 1 => return Some(at),
            '}' => braces -= 1,
            _ => {}
        }
    }
    None
}

/// A text without comments, strings and characters, with as many lines as before.
fn code_of(text: &str) -> String {
    let mut code = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(letter) = rest.chars().next() {
        let length = hidden(rest, code.chars().next_back());
        let (part, after) = rest.split_at(if length == 0 { letter.len_utf8() } else { length });
        if length == 0 {
            code.push(letter);
        } else {
            code.push(' ');
            code.extend(part.chars().filter(|letter| *letter == '\n'));
        }
        rest = after;
    }
    code
}

/// The length of the comment, string or character at the start of a text; 0 if it starts with code.
fn hidden(text: &str, before: Option<char>) -> usize {
    let is_word = before.is_some_and(|letter| letter.is_alphanumeric() || letter == '_');
    let hashes = text.get(1..).map_or(0, |rest| rest.len() - rest.trim_start_matches('#').len());
    let until = |from: usize, end: &str| {
        text.get(from..)
            .and_then(|rest| rest.find(end))
            .map_or(text.len(), |at| from + at + end.len())
    };
    if text.starts_with("//") {
        text.find('\n').unwrap_or(text.len())
    } else if text.starts_with("/*") {
        block_comment(text)
    } else if text.starts_with('"') {
        escaped(text, '"')
    } else if text.starts_with('r') && text[1 + hashes..].starts_with('"') && !is_word {
        until(2 + hashes, &format!("\"{}", "#".repeat(hashes)))
    } else if text.starts_with("'\\") || text.starts_with('\'') && is_character(text) {
        escaped(text, '\'')
    } else {
        0
    }
}

/// Whether a quote starts a character, not a lifetime.
fn is_character(text: &str) -> bool {
    text.chars().nth(2) == Some('\'')
}

/// The length of a block comment, which may contain others.
fn block_comment(text: &str) -> usize {
    let (mut at, mut depth) = (0, 0);
    while at < text.len() {
        let rest = &text.as_bytes()[at..];
        match rest {
            [b'/', b'*', ..] => (at, depth) = (at + 2, depth + 1),
            [b'*', b'/', ..] => (at, depth) = (at + 2, depth - 1),
            _ => at += 1,
        }
        if depth == 0 {
            break;
        }
    }
    at
}

/// The length of a string or a character, in which a backslash escapes the next character.
fn escaped(text: &str, end: char) -> usize {
    let mut is_hidden = false;
    for (at, letter) in text.char_indices().skip(1) {
        match letter {
            _ if is_hidden => is_hidden = false,
            '\\' => is_hidden = true,
            _ if letter == end => return at + 1,
            _ => {}
        }
    }
    text.len()
}

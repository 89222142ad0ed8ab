//! What to write where something else was expected: the habits of other languages, and what is
//! forgotten at the end of a line.

use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::source::Span;

use super::token::{TokenKind, Tokens};
use crate::foreign::wgsl_text;

/// Whether a word is a type of WGSL or of another language.
fn is_type(name: &str) -> bool {
    const STARTS: [&str; 5] = ["vec", "mat", "array", "texture", "sampler"];
    matches!(name, "bool" | "f16" | "f32" | "i32" | "u32")
        || native_type(name) != name
        || STARTS.iter().any(|start| name.starts_with(start))
}

/// A type of another language as WGSL calls it, or the same.
fn native_type(name: &str) -> String {
    let is_code = |text: &String| !text.contains([' ', '(', '`']);
    match name {
        // Without a type of numbers they are no types.
        "vec2" | "vec3" | "vec4" => format!("{name}f"),
        // WGSL has `f16` where it is enabled only.
        "half" => "f32".to_owned(),
        _ => wgsl_text(name).filter(is_code).unwrap_or_else(|| name.to_owned()),
    }
}

/// Adds advice to the error that something was expected at a token.
pub fn advised(tokens: Tokens<'_>, at: usize, what: &str, error: Diagnostic) -> Diagnostic {
    match what {
        "`;`" | "`;` after the import" => missing_semicolon(tokens, at, error),
        "a declaration" => declaration(tokens, at, error),
        "`:` and a type" => typed_name(tokens, at, error),
        "`{`" => braces(tokens, at, error),
        "a name" if tokens.word(at).is_some() && declares_name(tokens, at) => {
            error.note(format!("help: take another name, such as `{}_`", tokens.text(at)))
        }
        _ => error,
    }
}

/// Whether a name at a token would be one that is declared there.
fn declares_name(tokens: Tokens<'_>, at: usize) -> bool {
    let before = at.checked_sub(1).map_or("", |before| tokens.text(before));
    let is_import = line_until(tokens, at).starts_with("import");
    let declaring = ["(", ",", "fn", "let", "var", "const", "struct", "alias", "override", ">"];
    declaring.contains(&before) && !is_import
}

/// The text of a line, up to the end of a token and without comments.
fn line_until(tokens: Tokens<'_>, at: usize) -> &str {
    let end = tokens.tokens.get(at).map_or(tokens.text.len(), |token| token.end as usize);
    let text = tokens.text.get(..end).unwrap_or_default();
    text.rsplit('\n').next().unwrap_or_default().trim_start()
}

fn missing_semicolon(tokens: Tokens<'_>, at: usize, error: Diagnostic) -> Diagnostic {
    let Some(last) = at.checked_sub(1) else { return error };
    let between = tokens.text.get(tokens.span(last).end as usize..tokens.start(at) as usize);
    let between = between.unwrap_or_default();
    // On one line, something else is wrong.
    if !between.contains('\n') && !tokens.is(at, b'}') && at < tokens.len() {
        return error;
    }
    let mut error = error;
    error.message = "`;` is missing".to_owned();
    error.labels.clear();
    let line = line_until(tokens, last);
    error.at(tokens.span(last), "after this").note(format!("help: write `{line};`"))
}

/// What stands where a declaration of the module begins.
fn declaration(tokens: Tokens<'_>, at: usize, error: Diagnostic) -> Diagnostic {
    let (first, second) = (tokens.text(at), tokens.text(at + 1));
    if first == "let" {
        let end = tokens.find(at, tokens.len(), b';').unwrap_or(at);
        let rest = tokens.text.get(tokens.start(at) as usize + 3..tokens.start(end) as usize);
        let Some(rest) = rest else { return error };
        return error.note(format!("help: `let` is for functions: write `const{rest};`"));
    }
    if first == "[" && second == "[" {
        return old_attributes(tokens, at, error);
    }
    if matches!(first, "function" | "func" | "fun" | "def" | "void")
        && tokens.word(at + 1).is_some()
    {
        return error.note(format!("help: write `fn {second}`"));
    }
    if tokens.word(at).is_none() || tokens.word(at + 1).is_none() {
        return error;
    }
    let of_type = native_type(first);
    match tokens.text(at + 2) {
        "(" => error.note(format!(
            "help: WGSL declares functions with `fn`: write `fn {second}({}) -> {of_type}`",
            parameters(tokens, at + 2)
        )),
        "=" => error.note(format!(
            "help: write `const {second} = ...;`, or `var<private> {second}: {of_type} = ...;`"
        )),
        _ => error.note(format!("help: write `var<private> {second}: {of_type};`")),
    }
}

/// Parameters of C as WGSL writes them.
fn parameters(tokens: Tokens<'_>, open: usize) -> String {
    let close = tokens.partner(open);
    let mut found = Vec::new();
    let mut at = open + 1;
    while at < close {
        let end = tokens.find(at, close, b',').unwrap_or(close);
        if end >= at + 2 {
            let (name, of_type) = (tokens.text(end - 1), native_type(tokens.text(end - 2)));
            found.push(format!("{name}: {of_type}"));
        }
        at = end + 1;
    }
    found.join(", ")
}

/// `[[stage(fragment)]]`, as attributes were once written.
fn old_attributes(tokens: Tokens<'_>, at: usize, error: Diagnostic) -> Diagnostic {
    let close = tokens.partner(at + 1);
    let inside = tokens.start(at + 2) as usize..tokens.start(close) as usize;
    let text = tokens.text.get(inside).unwrap_or_default().trim();
    let plain = text.strip_prefix("stage(").and_then(|rest| rest.strip_suffix(')'));
    error.note(format!("help: attributes begin with `@`: write `@{}`", plain.unwrap_or(text)))
}

/// A parameter or a member with its type in front.
fn typed_name(tokens: Tokens<'_>, at: usize, error: Diagnostic) -> Diagnostic {
    let Some(before) = at.checked_sub(1).filter(|_| tokens.word(at).is_some()) else {
        return error;
    };
    let (of_type, name) = (tokens.text(before), tokens.text(at));
    // `inout x: f32` and `inout float x`.
    let pointed = match (tokens.text(at + 1), tokens.word(at + 1)) {
        (":", _) => native_type(tokens.text(at + 2)),
        (_, Some(_)) => native_type(name),
        _ => "f32".to_owned(),
    };
    let named = if tokens.word(at + 1).is_some() { tokens.text(at + 1) } else { name };
    match of_type {
        "inout" | "out" => error.note(format!(
            "help: write `{named}: ptr<function, {pointed}>`, `*{named}` for its value, and `&` before \
             the variable in calls"
        )),
        "in" | "const" => error.note(format!("help: write `{named}: {pointed}`")),
        // The colon is missing.
        _ if is_type(name) && !is_type(of_type) => {
            error.note(format!("help: write `{of_type}: {}`", native_type(name)))
        }
        _ => error.note(format!(
            "help: names come before their types: write `{name}: {}{}`",
            native_type(of_type),
            // Members end with a comma.
            if tokens.text(at + 1) == ";" { "," } else { "" }
        )),
    }
}

/// A statement without braces behind a condition.
fn braces(tokens: Tokens<'_>, at: usize, error: Diagnostic) -> Diagnostic {
    let Some(TokenKind::Word(_)) = tokens.kind(at) else { return error };
    let end = tokens.find(at, tokens.len(), b';').unwrap_or(at);
    let text = tokens.text.get(tokens.start(at) as usize..tokens.span(end).end as usize);
    let text = text.unwrap_or_default();
    if text.is_empty() || text.contains('\n') || text.contains('{') {
        return error;
    }
    error.note(format!("help: statements stand in braces: write `{{ {text} }}`"))
}

/// Adds the place where a bracket is missing: before the token that was found instead.
pub fn missing_closer(text: &str, before: Span, mark: char, error: Diagnostic) -> Diagnostic {
    let (start, end) = (before.start as usize, before.end as usize);
    let line = text[..start].rfind('\n').map_or(0, |found| found + 1);
    let rest = text[end..].lines().next().unwrap_or_default().trim_end();
    let last = text.get(start..end).unwrap_or_default();
    let mut error = error;
    let found =
        text[end..].trim_start().chars().next().filter(|one| matches!(one, ')' | ']' | '}'));
    let is_beside = !text[end..].trim_start_matches([' ', '\t']).starts_with(['\n', '\r']);
    if let Some(found) = found.filter(|_| is_beside) {
        return error.note(format!("help: write `{mark}` instead of `{found}`, or before it"));
    }
    error.labels.insert(
        0,
        lamplight_diagnostic::Label {
            span: before,
            message: format!(
                "`{mark}` is missing {} this",
                if last == ";" { "before" } else { "behind" }
            ),
        },
    );
    let written = match last {
        ";" => format!("{}{mark};{rest}", &text[line..start]),
        _ => format!("{}{mark}{rest}", &text[line..end]),
    };
    error.note(format!("help: write `{}`", written.trim()))
}

/// The bracket that is likely the one that is not closed, as the author's indentation tells: what closes
/// it stands further left than it. Also the number of the line before which it should be closed.
pub fn unclosed_by_indentation(
    text: &str,
    pairs: impl Iterator<Item = (usize, usize)>,
) -> Option<(usize, usize)> {
    let indentation = |at: usize| {
        let line = text[..at].rfind('\n').map_or(0, |found| found + 1);
        text[line..].len() - text[line..].trim_start_matches([' ', '\t']).len()
    };
    let open = pairs
        .filter(|(open, close)| {
            let line = text[..*close].rfind('\n').map_or(0, |found| found + 1);
            text[line..*close].trim().is_empty() && indentation(*close) < indentation(*open)
        })
        .map(|(open, _)| open)
        .min()?;
    let own = indentation(open);
    let first = text[..open].matches('\n').count() + 1;
    let mut lines = text.lines().enumerate().skip(first);
    let (line, _) = lines.find(|(_, line)| {
        let trimmed = line.trim_start_matches([' ', '\t']);
        !trimmed.is_empty() && line.len() - trimmed.len() <= own
    })?;
    Some((open, line + 1))
}

/// What to write for a directive of a preprocessor.
pub fn directive(text: &str, at: usize) -> String {
    let line = text[at..].lines().next().unwrap_or_default();
    let mut words = line.trim_start_matches('#').split_whitespace();
    match (words.next(), words.next()) {
        (Some("define"), Some(name)) if !name.contains('(') => {
            let value = words.collect::<Vec<_>>().join(" ");
            match value.is_empty() {
                true => {
                    "help: write `@if(NAME)` before declarations, and set it outside".to_owned()
                }
                false => format!("help: write `const {name} = {value};`"),
            }
        }
        (Some("define"), _) => "help: write a function, or `const NAME = ...;`".to_owned(),
        (Some("if" | "ifdef"), Some(name)) => {
            format!("help: write `@if({name})` before the declaration or the statement")
        }
        (Some("include" | "import"), _) => "help: write `import package::module::name;`".to_owned(),
        _ => "help: use `import` and `@if(...)`".to_owned(),
    }
}

/// What to write for an `import` of a file's name.
pub fn quoted_import(text: &str, at: usize) -> Option<String> {
    let line = text[..at].rfind('\n').map_or(0, |found| found + 1);
    if !text[line..at].trim_start().starts_with("import") {
        return None;
    }
    let path = text[at + 1..].split(['"', '\'']).next()?;
    let path = path.trim_start_matches("./").rsplit_once('.').map_or(path, |(path, _)| path);
    let module = path.trim_start_matches("./").replace('/', "::");
    Some(format!("help: write `import package::{module}::NAME;` with the name of an item"))
}

/// Whether a bracket opens the arguments of an attribute, as in `@if(`.
pub fn opens_condition(text: &str, at: usize) -> bool {
    let before = text[..at].trim_end();
    before.trim_end_matches(|one: char| one.is_alphanumeric() || one == '_').ends_with('@')
}

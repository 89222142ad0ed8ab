//! Declarations and their doc comments, at the top level of a module's text.

use super::Kind;

/// A declaration without its body.
pub struct Declaration {
    pub kind: Kind,
    pub name: String,
    pub doc: Vec<String>,
    pub declaration: String,
}

/// Functions and structs of a WESL module that have a doc comment.
pub fn wesl(text: &str) -> Vec<Declaration> {
    declarations(text, wesl_name).into_iter().filter(|found| !found.doc.is_empty()).collect()
}

/// Functions and structs of a GLSL module.
pub fn glsl(text: &str) -> Vec<Declaration> {
    declarations(text, glsl_name)
}

/// First line of the comment that opens a module.
pub fn module_summary(text: &str) -> String {
    let first = text.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
    first.trim().trim_start_matches(['/', '!', ' ']).to_owned()
}

type Naming = fn(&str) -> Option<(Kind, String)>;

fn declarations(text: &str, name: Naming) -> Vec<Declaration> {
    let mut found = Vec::new();
    let mut doc = Vec::new();
    let mut depth = 0i32;
    let mut lines = text.lines().enumerate();
    while let Some((index, line)) = lines.next() {
        if let Some(comment) = line.strip_prefix("///") {
            doc.push(comment.strip_prefix(' ').unwrap_or(comment).trim_end().to_owned());
            continue;
        }
        let named = if depth == 0 { name(line) } else { None };
        if let Some((kind, name)) = named {
            found.push(Declaration { kind, name, doc: std::mem::take(&mut doc), declaration: declaration(kind, text, index) });
        }
        doc.clear();
        depth += nesting(line);
    }
    found
}

/// From the line to the body's brace, or for a struct to its closing one, in single spaces.
fn declaration(kind: Kind, text: &str, line: usize) -> String {
    let rest: Vec<&str> = text.lines().skip(line).map(without_comment).collect();
    let rest = rest.join("\n");
    match kind {
        Kind::Function => single_spaced(rest.split('{').next().unwrap_or_default()),
        Kind::Struct => rest
            .split_inclusive('}')
            .next()
            .unwrap_or_default()
            .lines()
            .filter(|line| !line.trim().is_empty())
            .collect::<Vec<_>>()
            .join("\n"),
    }
}

fn single_spaced(text: &str) -> String {
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    text.replace("( ", "(").replace(" )", ")").replace(",)", ")")
}

fn without_comment(line: &str) -> &str {
    line.split("//").next().unwrap_or_default().trim_end()
}

fn nesting(line: &str) -> i32 {
    without_comment(line).chars().map(|letter| i32::from(letter == '{') - i32::from(letter == '}')).sum()
}

fn wesl_name(line: &str) -> Option<(Kind, String)> {
    let (kind, rest) = match (line.strip_prefix("fn "), line.strip_prefix("struct ")) {
        (Some(rest), _) => (Kind::Function, rest),
        (_, Some(rest)) => (Kind::Struct, rest),
        _ => return None,
    };
    Some((kind, identifier(rest)))
}

fn glsl_name(line: &str) -> Option<(Kind, String)> {
    if let Some(rest) = line.strip_prefix("struct ") {
        return Some((Kind::Struct, identifier(rest)));
    }
    let (before, _) = line.split_once('(')?;
    let (result, name) = before.rsplit_once(' ')?;
    let plain = |word: &str| !word.is_empty() && word.chars().all(|letter| letter.is_alphanumeric() || "_[] ".contains(letter));
    (plain(result) && plain(name)).then(|| (Kind::Function, name.to_owned()))
}

fn identifier(text: &str) -> String {
    text.chars().take_while(|letter| letter.is_alphanumeric() || *letter == '_').collect()
}

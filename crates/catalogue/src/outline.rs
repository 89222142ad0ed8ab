//! Finds the declarations at the top level of a module's text, with their doc comments.

use super::{CatalogueItemKind, CatalogueMember};
use lamplight_syntax::words::{continues_word, leading_word};

/// A declaration without its body.
pub struct CatalogueDeclaration {
    pub kind: CatalogueItemKind,
    pub name: String,
    pub doc: Vec<String>,
    pub declaration: String,
    pub members: Vec<CatalogueMember>,
    pub result: Option<String>,
}

/// Functions, structs and constants of a WESL module.
pub fn wesl_declarations(text: &str) -> Vec<CatalogueDeclaration> {
    find_declarations(text, wesl_name)
}

/// Functions, structs and constants of a GLSL module.
pub fn glsl_declarations(text: &str) -> Vec<CatalogueDeclaration> {
    find_declarations(text, glsl_name)
}

/// The comment that opens a module, without its marks.
pub fn module_doc(text: &str) -> Vec<String> {
    let lines = text
        .lines()
        .skip_while(|line| line.trim().is_empty())
        .map_while(|line| line.strip_prefix("//!"));
    lines.map(|line| line.strip_prefix(' ').unwrap_or(line).trim_end().to_owned()).collect()
}

type Naming = fn(&str) -> Option<(CatalogueItemKind, String)>;

fn find_declarations(text: &str, name: Naming) -> Vec<CatalogueDeclaration> {
    let mut found = Vec::new();
    let mut doc = Vec::new();
    let mut depth = 0i32;
    let lines: Vec<&str> = text.lines().collect();
    for (index, line) in lines.iter().enumerate() {
        if let Some(comment) = line.strip_prefix("///") {
            doc.push(comment.strip_prefix(' ').unwrap_or(comment).trim_end().to_owned());
            continue;
        }
        let named = if depth == 0 { name(line) } else { None };
        if let Some((kind, name)) = named {
            found.push(make_declaration(kind, name, std::mem::take(&mut doc), &lines[index..]));
        }
        doc.clear();
        depth += bracket_depth(line);
    }
    found
}

fn make_declaration(
    kind: CatalogueItemKind,
    name: String,
    doc: Vec<String>,
    lines: &[&str],
) -> CatalogueDeclaration {
    let code = lines.iter().map(|line| without_comment(line)).collect::<Vec<_>>().join("\n");
    let (declaration, members) = match kind {
        CatalogueItemKind::Function => {
            let head = single_spaced(code.split('{').next().unwrap_or_default());
            let members = parse_parameters(&head);
            (head, members)
        }
        CatalogueItemKind::Struct => {
            let body = code.split_inclusive('}').next().unwrap_or_default();
            (
                body.lines().filter(|line| !line.trim().is_empty()).collect::<Vec<_>>().join("\n"),
                struct_fields(lines),
            )
        }
        CatalogueItemKind::Constant => {
            (single_spaced(code.split_inclusive(';').next().unwrap_or_default()), Vec::new())
        }
    };
    let result = declaration
        .rsplit_once("-> ")
        .filter(|_| kind == CatalogueItemKind::Function)
        .map(|(_, ty)| ty.to_owned());
    CatalogueDeclaration { kind, name, doc, members, result, declaration }
}

/// The `name: type` of each parameter. A comma within brackets belongs to a type.
fn parse_parameters(head: &str) -> Vec<CatalogueMember> {
    let list = head
        .split_once('(')
        .and_then(|(_, rest)| rest.split_once(')'))
        .map_or("", |(list, _)| list);
    let mut depth = 0i32;
    let parts = list.split(|letter: char| {
        depth += i32::from(letter == '<') - i32::from(letter == '>');
        letter == ',' && depth == 0
    });
    parts.filter_map(|part| parse_member(part, Vec::new())).collect()
}

/// The fields of a struct with their doc comments, up to its closing brace.
fn struct_fields(lines: &[&str]) -> Vec<CatalogueMember> {
    let mut found = Vec::new();
    let mut doc = Vec::new();
    for line in
        lines.iter().skip(1).map(|line| line.trim()).take_while(|line| !line.starts_with('}'))
    {
        match line.strip_prefix("///") {
            Some(comment) => doc.push(comment.trim().to_owned()),
            None => found.extend(parse_member(
                without_comment(line).trim_end_matches(','),
                std::mem::take(&mut doc),
            )),
        }
    }
    found
}

fn parse_member(text: &str, doc: Vec<String>) -> Option<CatalogueMember> {
    let (name, ty) = text.split_once(':')?;
    Some(CatalogueMember {
        name: name.trim().to_owned(),
        ty: ty.trim().to_owned(),
        doc: doc.join(" "),
    })
}

fn single_spaced(text: &str) -> String {
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    text.replace("( ", "(").replace(" )", ")").replace(",)", ")")
}

fn without_comment(line: &str) -> &str {
    line.split("//").next().unwrap_or_default().trim_end()
}

fn bracket_depth(line: &str) -> i32 {
    without_comment(line)
        .chars()
        .map(|letter| i32::from(letter == '{') - i32::from(letter == '}'))
        .sum()
}

fn wesl_name(line: &str) -> Option<(CatalogueItemKind, String)> {
    let words = [
        ("fn ", CatalogueItemKind::Function),
        ("struct ", CatalogueItemKind::Struct),
        ("const ", CatalogueItemKind::Constant),
    ];
    words
        .iter()
        .find_map(|(word, kind)| Some((*kind, leading_word(line.strip_prefix(word)?).to_owned())))
}

fn glsl_name(line: &str) -> Option<(CatalogueItemKind, String)> {
    if let Some(rest) = line.strip_prefix("struct ") {
        return Some((CatalogueItemKind::Struct, leading_word(rest).to_owned()));
    }
    if let Some((_, name)) = line.strip_prefix("const ").and_then(|rest| rest.split_once(' ')) {
        return Some((CatalogueItemKind::Constant, leading_word(name).to_owned()));
    }
    // An indented line continues the list of parameters.
    let (before, _) = line.split_once('(').filter(|_| !line.starts_with(' '))?;
    let (result, name) = before.rsplit_once(' ')?;
    let plain = |word: &str| {
        !word.is_empty()
            && word.chars().all(|letter| continues_word(letter) || "[] ".contains(letter))
    };
    (plain(result) && plain(name)).then(|| (CatalogueItemKind::Function, name.to_owned()))
}

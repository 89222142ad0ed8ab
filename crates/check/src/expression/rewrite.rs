//! Writes an expression as a module in either language, with a map back to its bytes.

use std::ops::Range;

use naga::{ArraySize, Handle, Module, ScalarKind, Type, TypeInner};

use super::FUNCTION;
use crate::library::Library;
use lamplight_compose::project::LIBRARY;
use lamplight_syntax::words::piece_at;

/// A module's text made from an expression.
pub struct Rewritten {
    pub text: String,
    /// For each piece that was copied or translated, its range in the text and in the expression.
    pieces: Vec<(Range<usize>, Range<usize>)>,
    /// Bytes of the expression.
    length: usize,
}

impl Rewritten {
    /// The bytes of the expression for a range of the text; the whole expression for text that was
    /// added.
    pub fn original(&self, range: Range<usize>) -> Range<usize> {
        let touched = self.pieces.iter().filter(|(made, _)| {
            made.start < range.end.max(range.start + 1) && range.start < made.end
        });
        let (mut start, mut end) = (self.length, 0);
        for (made, source) in touched {
            let exact = made.len() == source.len();
            start = start.min(if exact {
                source.start + range.start.saturating_sub(made.start)
            } else {
                source.start
            });
            end = end.max(if exact {
                source.end - made.end.saturating_sub(range.end)
            } else {
                source.end
            });
        }
        if start <= end { start..end } else { 0..self.length }
    }

    fn push(&mut self, text: &str, source: Range<usize>) {
        let start = self.text.len();
        self.text.push_str(text);
        self.pieces.push((start..self.text.len(), source));
    }
}

/// Writes the WESL module `fn lamplight_eval() { let value = (...); }`. Paths into the library
/// become absolute.
pub fn rewrite_wesl(expression: &str, library: &Library) -> Rewritten {
    let homes = Homes::new(library);
    let mut made = Rewritten {
        text: format!("fn {FUNCTION}() {{ let value = ("),
        pieces: Vec::new(),
        length: expression.len(),
    };
    let tokens = expression_tokens(expression);
    for (index, range) in tokens.iter().enumerate() {
        let text = &expression[range.clone()];
        let follows = |by: usize, wanted: &str| {
            tokens.get(index + by).is_some_and(|range| &expression[range.clone()] == wanted)
        };
        let after_path = index > 0 && &expression[tokens[index - 1].clone()] == "::";
        match homes.of(text).filter(|_| !after_path && follows(1, "::")) {
            Some((package, true)) => made.push(package, range.clone()),
            Some((package, false)) => {
                made.text += &format!("{package}::");
                made.push(text, range.clone());
            }
            None => made.push(text, range.clone()),
        }
    }
    made.text += "\n); }\n";
    made
}

/// Finds the package of a path by the first name of the path.
struct Homes<'a> {
    library: &'a Library,
    own: Vec<String>,
    shipped: Vec<String>,
}

impl<'a> Homes<'a> {
    fn new(library: &'a Library) -> Self {
        Self { library, own: library.folders(), shipped: library.folders_of_dependency(LIBRARY) }
    }

    /// The package, and whether the name is `package` itself: the name of the package then replaces
    /// it, and otherwise goes before it.
    fn of(&self, first: &str) -> Option<(&str, bool)> {
        let is = |folders: &[String]| folders.iter().any(|folder| folder == first);
        match first {
            "package" => Some((self.library.name(), true)),
            _ if is(&self.own) => Some((self.library.name(), false)),
            _ if is(&self.shipped) => Some((LIBRARY, false)),
            _ => None,
        }
    }
}

/// The same in GLSL: `T lamplight_eval() { return (...); }` after the includes it needs.
pub fn rewrite_glsl(
    expression: &str,
    library: &Library,
    module: &Module,
    ty: Handle<Type>,
) -> Rewritten {
    let tokens = expression_tokens(expression);
    let mut pieces = Vec::new();
    let mut includes = std::collections::BTreeSet::new();
    let homes = Homes::new(library);
    let mut at = 0;
    while at < tokens.len() {
        let (text, used) = translate_tokens(expression, &tokens[at..], &homes, &mut includes);
        pieces.push((text, tokens[at].start..tokens[at + used - 1].end));
        at += used;
    }
    let mut made = Rewritten {
        text: "#version 450\n".to_owned(),
        pieces: Vec::new(),
        length: expression.len(),
    };
    for module in includes {
        made.text += &format!("#include <{module}.glsl>\n");
    }
    made.text += &format!("{} {FUNCTION}() {{ return (", type_name(module, ty));
    for (text, source) in pieces {
        made.push(&text, source);
    }
    made.text += "\n); }\nvoid main() {}\n";
    made
}

/// The GLSL for the first tokens, and how many tokens that covers.
fn translate_tokens(
    expression: &str,
    tokens: &[Range<usize>],
    homes: &Homes<'_>,
    includes: &mut std::collections::BTreeSet<String>,
) -> (String, usize) {
    let text = |index: usize| tokens.get(index).map_or("", |range| &expression[range.clone()]);
    if text(1) == "::" {
        let mut used = 1;
        while text(used) == "::" && tokens.len() > used + 1 {
            used += 2;
        }
        let mut path: Vec<&str> = (0..used).step_by(2).map(text).collect();
        match homes.of(path[0]) {
            Some((package, true)) => path[0] = package,
            Some((package, false)) => path.insert(0, package),
            None => {}
        }
        if let Some((name, module)) = path.split_last() {
            includes.insert(module.join("/"));
            return ((*name).to_owned(), used);
        }
    }
    // A type may have spaces in it. They are skipped here, but counted.
    let solid: Vec<usize> =
        (0..tokens.len().min(48)).filter(|index| !text(*index).trim().is_empty()).collect();
    let starts_here = solid.first() == Some(&0);
    match type_constructor(&solid.iter().map(|index| text(*index)).collect::<Vec<_>>())
        .filter(|_| starts_here)
    {
        // GLSL has no constructor without arguments.
        Some((name, used))
            if solid
                .get(used + 1)
                .is_some_and(|close| (text(solid[used]), text(*close)) == ("(", ")"))
                && !name.contains('[') =>
        {
            let zero = if name.starts_with('b') { "false" } else { "0" };
            (format!("{name}({zero})"), solid[used + 1] + 1)
        }
        Some((name, used)) => (name, solid[used - 1] + 1),
        None => (glsl_literal(text(0)), 1),
    }
}

/// A type at the start of the tokens, as GLSL names it.
fn type_constructor(tokens: &[&str]) -> Option<(String, usize)> {
    let scalar = |name: &str| SCALARS.iter().find(|(wgsl, ..)| *wgsl == name);
    let first = *tokens.first()?;
    if let Some((_, _, glsl)) = scalar(first) {
        return Some(((*glsl).to_owned(), 1));
    }
    let generic = tokens.get(1) == Some(&"<");
    if first == "array" && generic {
        let (base, used) = type_constructor(&tokens[2..])?;
        let (comma, count, close) =
            (tokens.get(2 + used)?, tokens.get(3 + used)?, tokens.get(4 + used)?);
        return (*comma == "," && *close == ">")
            .then(|| (format!("{base}[{}]", glsl_literal(count)), 5 + used));
    }
    let (stem, suffix) = first.split_at_checked(if first.starts_with("mat") { 6 } else { 4 })?;
    let prefix = match (suffix, generic) {
        ("", true) => scalar(tokens.get(2)?)?.1,
        (suffix, false) => SUFFIXES.iter().find(|(wgsl, _)| *wgsl == suffix)?.1,
        _ => return None,
    };
    let used = if generic { 4 } else { 1 };
    match (stem.as_bytes(), prefix) {
        (b"vec2" | b"vec3" | b"vec4", prefix) => Some((format!("{prefix}{stem}"), used)),
        ([b'm', b'a', b't', b'2'..=b'4', b'x', b'2'..=b'4'], "") => Some((stem.to_owned(), used)),
        _ => None,
    }
}

/// Scalar in WGSL, prefix of vectors in GLSL, scalar in GLSL.
const SCALARS: &[(&str, &str, &str)] =
    &[("f32", "", "float"), ("i32", "i", "int"), ("u32", "u", "uint"), ("bool", "b", "bool")];
/// Suffix of vectors in WGSL, prefix in GLSL.
const SUFFIXES: &[(&str, &str)] = &[("f", ""), ("i", "i"), ("u", "u")];

/// A number without the suffixes `f` and `i`, which are not the same in GLSL. Other tokens stay as
/// they are.
fn glsl_literal(token: &str) -> String {
    let is_number = token.starts_with(|c: char| c.is_ascii_digit() || c == '.') && token.len() > 1;
    let is_hex = token.starts_with("0x");
    match token.strip_suffix(['f', 'i']) {
        Some(rest) if is_number && !is_hex => {
            let whole = token.ends_with('f') && !rest.contains(['.', 'e', 'E']);
            if whole { format!("{rest}.0") } else { rest.to_owned() }
        }
        _ => token.to_owned(),
    }
}

fn type_name(module: &Module, ty: Handle<Type>) -> String {
    let scalar = |kind: ScalarKind| match kind {
        ScalarKind::Sint => ("i", "int"),
        ScalarKind::Uint => ("u", "uint"),
        ScalarKind::Bool => ("b", "bool"),
        _ => ("", "float"),
    };
    match &module.types[ty].inner {
        TypeInner::Scalar(of) => scalar(of.kind).1.to_owned(),
        TypeInner::Vector { size, scalar: of } => {
            format!("{}vec{}", scalar(of.kind).0, *size as u32)
        }
        TypeInner::Matrix { columns, rows, .. } => {
            format!("mat{}x{}", *columns as u32, *rows as u32)
        }
        TypeInner::Array { base, size: ArraySize::Constant(count), .. } => {
            format!("{}[{count}]", type_name(module, *base))
        }
        _ => module.types[ty].name.clone().unwrap_or_else(|| "float".to_owned()),
    }
}

/// The byte ranges of the tokens: words, numbers, `::`, blanks, and other characters one by one.
pub fn expression_tokens(text: &str) -> Vec<Range<usize>> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(piece) = piece_at(text, at) {
        let end = if text[at..].starts_with("::") { at + 2 } else { piece.end() };
        tokens.push(at..end);
        at = end;
    }
    tokens
}

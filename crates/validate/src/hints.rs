//! Suggests what an unknown name may mean: an item of the library, a name of another language, or a
//! similar name.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use lamplight_bundle::Language;
use lamplight_compose::{Composed, PartKind};
use lamplight_diagnostic::{Diagnostic, nearest_name};
use lamplight_syntax::wesl::blank::without_comments;
use lamplight_syntax::words::{Lexeme, LexemeKind, is_word, leading_word, pieces, word_around};

use super::advice::{note_unknown, note_unknown_glsl};
use super::foreign::native_text;

/// Functions and types of both languages that are often misspelt.
const SHARED: &[&str] = &[
    "abs",
    "acos",
    "all",
    "any",
    "asin",
    "atan",
    "ceil",
    "clamp",
    "cos",
    "cross",
    "degrees",
    "determinant",
    "distance",
    "dot",
    "exp",
    "exp2",
    "floor",
    "fract",
    "fwidth",
    "length",
    "log",
    "log2",
    "max",
    "min",
    "mix",
    "normalize",
    "pow",
    "radians",
    "reflect",
    "refract",
    "round",
    "sign",
    "sin",
    "smoothstep",
    "sqrt",
    "step",
    "tan",
    "transpose",
    "trunc",
    "bool",
    "vec2",
    "vec3",
    "vec4",
];

/// Those that only WGSL has.
const WGSL: &[&str] = &[
    "array",
    "atan2",
    "f32",
    "faceForward",
    "fma",
    "i32",
    "inverseSqrt",
    "mat2x2f",
    "mat3x3f",
    "mat4x4f",
    "saturate",
    "select",
    "textureLoad",
    "textureSample",
    "textureSampleCompare",
    "textureSampleLevel",
    "u32",
    "vec2f",
    "vec2i",
    "vec2u",
    "vec3f",
    "vec3i",
    "vec3u",
    "vec4f",
    "vec4i",
    "vec4u",
];

/// Those that only GLSL has.
const GLSL: &[&str] = &[
    "float",
    "int",
    "inversesqrt",
    "ivec2",
    "ivec3",
    "ivec4",
    "mat2",
    "mat3",
    "mat4",
    "mod",
    "texelFetch",
    "texture",
    "textureLod",
    "uint",
    "uvec2",
    "uvec3",
    "uvec4",
];

/// Functions and types of GLSL that are used often.
pub fn glsl_words() -> impl Iterator<Item = &'static str> {
    SHARED.iter().chain(GLSL).copied()
}

/// Adds the import that is missing, what another language's name is called here, or the nearest name.
/// `place` is where the name is in the composed text.
pub fn hint_unknown(
    error: Diagnostic,
    composed: &Composed,
    name: &str,
    place: Option<Range<usize>>,
) -> Diagnostic {
    let names = library_names(composed);
    if let Some(modules) = names.get(name) {
        return modules.iter().fold(error, |error, module| {
            error.note(format!(
                "help: the library has it: `{}`",
                missing_import(composed, module, name)
            ))
        });
    }
    let (own, spoken) = match composed.language {
        Language::Wesl => (WGSL, "WGSL"),
        Language::Glsl => (GLSL, "GLSL"),
    };
    if let Some(native) = native_text(composed.language, name) {
        return error.note(format!("help: in {spoken}, write {}", in_backticks(&native)));
    }
    let locals = place.as_ref().map_or_else(BTreeSet::new, |place| local_names(composed, place));
    let declared = composed.parts.iter().flat_map(|part| part.names.iter().map(String::as_str));
    let here: Vec<&str> =
        declared.chain(locals).chain(SHARED.iter().copied()).chain(own.iter().copied()).collect();
    let of_library = names.keys().map(String::as_str);
    // All names are searched together, so that the nearest one is suggested wherever it comes from.
    match nearest_name(name, here.iter().copied().chain(of_library)) {
        Some(near) if here.contains(&near) => error.note(format!("help: did you mean `{near}`?")),
        Some(near) => names[near].iter().fold(error, |error, module| {
            let import = missing_import(composed, module, near);
            error.note(format!("help: did you mean the library's `{near}`? `{import}`"))
        }),
        None => {
            let note = place.and_then(|place| match composed.language {
                Language::Wesl => note_unknown(&composed.text, name, place.start),
                Language::Glsl => note_unknown_glsl(&composed.text, name, place.start),
            });
            note.into_iter().fold(error, Diagnostic::note)
        }
    }
}

/// Code in backticks; words that have some of their own as they are.
fn in_backticks(text: &str) -> String {
    if text.contains('`') { text.to_owned() } else { format!("`{text}`") }
}

/// Parameters and local variables that are declared before a place in the function around it.
fn local_names<'c>(composed: &'c Composed, place: &Range<usize>) -> BTreeSet<&'c str> {
    let around = composed.parts.iter().find(|part| part.range.contains(&place.start));
    let text = around.and_then(|part| composed.text.get(part.range.start..place.start));
    declared_locals(composed.language, text.unwrap_or_default())
}

/// Words that may come before a name in GLSL without declaring it.
const NOT_TYPES: &[&str] = &["return", "else", "case", "do", "in", "out", "inout", "const"];

/// In WGSL, names after `let`, `var` and `const`, and those before a colon. In GLSL, names after
/// another word, which is their type.
fn declared_locals(language: Language, text: &str) -> BTreeSet<&str> {
    let bare = without_comments(text);
    let pieces = pieces(&bare).filter(|piece| piece.kind != LexemeKind::Blank);
    let pieces: Vec<Lexeme<'_>> = pieces.collect();
    let declares = |at: usize| {
        let before = at.checked_sub(1).map_or("", |before| pieces[before].text);
        let sign = |at: usize| pieces.get(at).map_or("", |piece| piece.text);
        match language {
            Language::Wesl => {
                matches!(before, "let" | "var" | "const")
                    || sign(at + 1) == ":" && sign(at + 2) != ":"
            }
            Language::Glsl => is_word(before) && !NOT_TYPES.contains(&before),
        }
    };
    let words = (0..pieces.len()).filter(|at| pieces[*at].kind == LexemeKind::Word);
    words.filter(|at| declares(*at)).map(|at| &text[pieces[at].at..pieces[at].end()]).collect()
}

/// Adds the nearest member of all structures, for a member that there is not.
pub fn hint_member(error: Diagnostic, composed: &Composed, name: &str) -> Diagnostic {
    let structures = composed.parts.iter().filter(|part| part.kind == PartKind::Struct);
    let members = structures.flat_map(|part| {
        let text = composed.text.get(part.range.clone()).unwrap_or_default();
        let body = text.split_once('{').map_or("", |(_, body)| body);
        declared_locals(composed.language, body)
    });
    match nearest_name(name, members) {
        Some(near) => error.note(format!("help: did you mean `{near}`?")),
        None => error,
    }
}

fn missing_import(composed: &Composed, module: &str, name: &str) -> String {
    match composed.language {
        Language::Wesl => format!("import lamplight::{}::{name};", module.replace('/', "::")),
        Language::Glsl => format!("#include <lamplight/{module}.glsl>"),
    }
}

/// The modules of the library, by the names that they declare.
fn library_names(composed: &Composed) -> BTreeMap<String, Vec<String>> {
    let mut items: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let texts = composed.library.map_or(&[][..], |library| library.texts);
    for (path, text) in texts {
        let Some(module) = path.strip_suffix(".wesl") else { continue };
        if module.starts_with("programs/") {
            continue;
        }
        for name in text.lines().filter_map(declared_name) {
            items.entry(name.to_owned()).or_default().push(module.to_owned());
        }
    }
    items
}

/// The name that a line at the top of a module declares.
fn declared_name(line: &str) -> Option<&str> {
    let rest = ["fn ", "const ", "struct "].iter().find_map(|word| line.strip_prefix(word))?;
    Some(leading_word(rest))
}

/// The name before the parenthesis that is open at the end of a text.
pub fn enclosing_call(before: &str) -> Option<&str> {
    let mut depth = 0;
    for (at, letter) in before.char_indices().rev() {
        match letter {
            ')' => depth += 1,
            '(' if depth > 0 => depth -= 1,
            '(' => return Some(last_word(&before[..at])).filter(|name| !name.is_empty()),
            ';' | '{' | '}' => return None,
            _ => {}
        }
    }
    None
}

/// The word at the end of a text, but for blanks.
pub fn last_word(text: &str) -> &str {
    let text = text.trim_end();
    &text[word_around(text, text.len()..text.len())]
}

/// Adds a note with each declaration of a function, for a call whose arguments fit none of them.
pub fn note_signatures(error: Diagnostic, composed: &Composed, name: &str) -> Diagnostic {
    let declares = |part: &&lamplight_compose::Part| {
        matches!(part.kind, PartKind::Function | PartKind::Prototype)
            && part.names.iter().any(|found| found == name)
    };
    composed.parts.iter().filter(declares).fold(error, |error, part| {
        let text = composed.text.get(part.range.clone()).unwrap_or_default();
        let code: Vec<&str> =
            text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
        let code = code.join(" ");
        let head = code.split(['{', ';']).next().unwrap_or_default();
        let head = head.split_whitespace().collect::<Vec<_>>().join(" ");
        error.note(format!("declared: `{head}`"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn locals_of_wgsl() {
        let text = "fn f(normal: vec3f, @location(0) uv: vec2f) {\n  let n = normalize(normal); // let x\n\
                    var<private> a = n; var light: f32 = package::b;";
        let found: Vec<_> = declared_locals(Language::Wesl, text).into_iter().collect();
        assert_eq!(found, ["light", "n", "normal", "uv"]);
    }

    #[test]
    fn locals_of_glsl() {
        let text = "vec4 f(vec3 normal) {\n  float light = 1.0; if (light > 0.5) return normal;";
        let found: Vec<_> = declared_locals(Language::Glsl, text).into_iter().collect();
        assert_eq!(found, ["f", "light", "normal"]);
    }
}

//! The declarations of a text in WGSL that no composer made, such as a translation.

use std::ops::Range;

use rustc_hash::FxHashMap;

use super::{Part, PartKind};
use lamplight_syntax::wesl::blank::comment_length;
use lamplight_syntax::words::{Lexeme, LexemeKind, piece_at, words};

/// The declarations of a text, and which of them each one names. No name of the module's scope may be
/// that of a local variable. A member of a structure that has the name of a declaration counts as a use
/// of it.
pub fn parts_of_wgsl(text: &str) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    let mut at = 0;
    while let Some(declared) = declaration(text, at) {
        at = declared.range.end;
        parts.push(declared);
    }
    let named: FxHashMap<&str, u32> =
        parts.iter().zip(0..).filter_map(|(part, at)| Some((&**part.names.first()?, at))).collect();
    let uses = |(part, own): (&Part, u32)| {
        let used =
            words(&text[part.range.clone()]).filter(|word| !matches!(word.before, b'.' | b'@'));
        let mut used: Vec<u32> =
            used.filter_map(|word| named.get(word.text).copied()).filter(|at| *at != own).collect();
        used.sort_unstable();
        used.dedup();
        used
    };
    let uses: Vec<Vec<u32>> = parts.iter().zip(0..).map(uses).collect();
    for (part, uses) in parts.iter_mut().zip(uses) {
        part.uses = uses;
    }
    parts
}

/// The first declaration from a byte on, with the comments before it.
fn declaration(text: &str, from: usize) -> Option<Part> {
    let (mut at, mut depth, mut lexemes) = (from, 0_usize, Vec::new());
    let end = loop {
        at += comment_length(&text[at..]);
        let Some(piece) = piece_at(text, at) else { break text.len() };
        at = piece.end();
        match piece.text {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 && matches!(piece.text, ";" | "}") {
            break at;
        }
        // Only its head says what it is.
        if piece.kind != LexemeKind::Blank && lexemes.len() < HEAD {
            lexemes.push(piece);
        }
    };
    (!lexemes.is_empty()).then(|| part_of(&lexemes, from..end))
}

/// Lexemes that a declaration has before its name, and its name: attributes of an entry point and the
/// address space of a variable are among them.
const HEAD: usize = 48;

fn part_of(head: &[Lexeme<'_>], range: Range<usize>) -> Part {
    let (mut found, mut at) = (None, 0);
    while let Some(piece) = head.get(at) {
        at += 1;
        if piece.text == "@" {
            at = behind_attribute(head, at);
        } else if piece.kind == LexemeKind::Word {
            found = kind_of(piece.text);
            break;
        }
    }
    let kind = found.unwrap_or(PartKind::Other);
    // The angle brackets of a variable hold its address space.
    if head.get(at).is_some_and(|piece| piece.text == "<") {
        at += head[at..].iter().position(|piece| piece.text == ">").unwrap_or_default() + 1;
    }
    let is_named = !matches!(kind, PartKind::Directive | PartKind::Assertion | PartKind::Other);
    let name = head.get(at).filter(|piece| is_named && piece.kind == LexemeKind::Word);
    let names = name.into_iter().map(|piece| piece.text.to_owned()).collect();
    Part { kind, names, range, uses: Vec::new(), aliases: Vec::new() }
}

/// Where an attribute ends whose name is at a place.
fn behind_attribute(head: &[Lexeme<'_>], at: usize) -> usize {
    if head.get(at + 1).is_none_or(|piece| piece.text != "(") {
        return at + 1;
    }
    let closing = head[at..].iter().position(|piece| piece.text == ")");
    closing.map_or(head.len(), |length| at + length + 1)
}

fn kind_of(word: &str) -> Option<PartKind> {
    Some(match word {
        "enable" | "requires" | "diagnostic" => PartKind::Directive,
        "fn" => PartKind::Function,
        "struct" => PartKind::Struct,
        "alias" => PartKind::Alias,
        "const" => PartKind::Constant,
        "var" => PartKind::Variable,
        "override" => PartKind::Override,
        "const_assert" => PartKind::Assertion,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::{PartKind, parts_of_wgsl};

    const TEXT: &str = "enable f16;
// A comment; with { brackets.
struct Light {
    color: vec3f,
}
/* One /* within; */ another */ @group(0) @binding(1) var<uniform> light: Light;
const two = 2.0;
@id(3) override taps: i32 = 4;
var<private> sum: array<f32, 4>;

fn twice(value: f32) -> f32 { return two * value; }

@compute @workgroup_size(taps, 1)
fn main(@builtin(position) at: vec4f) { sum[0] = twice(light.color.x); { ; } }
";

    #[test]
    fn declarations_name_one_another() {
        let parts = parts_of_wgsl(TEXT);
        let found: Vec<_> =
            parts.iter().map(|part| (part.kind, part.names.join(" "), part.uses.clone())).collect();
        let expected = [
            (PartKind::Directive, "", vec![]),
            (PartKind::Struct, "Light", vec![]),
            (PartKind::Variable, "light", vec![1]),
            (PartKind::Constant, "two", vec![]),
            (PartKind::Override, "taps", vec![]),
            (PartKind::Variable, "sum", vec![]),
            (PartKind::Function, "twice", vec![3]),
            (PartKind::Function, "main", vec![2, 4, 5, 6]),
        ];
        let expected = expected.map(|(kind, name, uses)| (kind, name.to_owned(), uses));
        assert_eq!(found, expected);
    }

    #[test]
    fn parts_cover_the_text() {
        let parts = parts_of_wgsl(TEXT);
        let joined: String = parts.iter().map(|part| &TEXT[part.range.clone()]).collect();
        assert_eq!(joined, TEXT.trim_end());
    }

    #[test]
    fn what_ends_early_is_kept() {
        for end in 0..TEXT.len() {
            let parts = parts_of_wgsl(&TEXT[..end]);
            assert!(parts.iter().all(|part| part.range.end <= end), "{end}");
        }
    }
}

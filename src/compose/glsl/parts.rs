//! The declarations of the output, for those who take it apart.

use std::ops::Range;

use super::Written;
use super::items::{Item, Items};
use super::preprocess::Preprocessed;
use super::token::Tok;
use crate::compose::{Part, PartKind};
use crate::parse::glsl::{Kind, Symbol, known};

/// Declarations of one name after which a text has no parts: only overloads share a name, and to
/// follow each of very many would take too long.
const OF_ONE_NAME: usize = 64;

/// The directives as one part, then a part for each kept item; none where too many share a name.
pub fn parts(
    preprocessed: &Preprocessed<'_, '_>,
    items: &Items,
    kept: &[bool],
    written: Written,
) -> Vec<Part> {
    let (tokens, spellings) = (&preprocessed.tokens, &preprocessed.spellings);
    let mut numbers = vec![u32::MAX; items.list.len()];
    let kept: Vec<usize> = (0..items.list.len()).filter(|index| kept[*index]).collect();
    let mut parts = vec![part(PartKind::Directive, written.header)];
    for (index, range) in kept.iter().zip(written.items) {
        numbers[*index] = parts.len() as u32;
        parts.push(part(
            kind(&tokens[items.list[*index].tokens.clone()], &items.list[*index]),
            range,
        ));
    }
    let mut declared: Vec<Vec<u32>> = vec![Vec::new(); spellings.count()];
    for (symbol, item) in &items.names {
        let number = numbers[*item as usize];
        if number != u32::MAX {
            parts[number as usize].names.push(spellings.text(*symbol).to_owned());
            declared[symbol.index()].push(number);
        }
    }
    if declared.iter().any(|parts| parts.len() > OF_ONE_NAME) {
        return Vec::new();
    }
    for index in kept {
        let number = numbers[index];
        let item = &tokens[items.list[index].tokens.clone()];
        parts[number as usize].uses = uses(item, number, &declared, &parts);
    }
    parts.extend(
        written.main.map(|range| Part {
            names: vec!["main".to_owned()],
            ..part(PartKind::Function, range)
        }),
    );
    parts
}

fn part(kind: PartKind, range: Range<usize>) -> Part {
    Part { kind, names: Vec::new(), range, uses: Vec::new(), aliases: Vec::new() }
}

fn kind(tokens: &[Tok], item: &Item) -> PartKind {
    let has = |symbol: Symbol| tokens.iter().any(|token| token.symbol == symbol);
    let ends = |symbol: Symbol| tokens.last().is_some_and(|token| token.symbol == symbol);
    let first = tokens.first().map(|token| token.symbol);
    // What follows the brace of a structure declares variables with it.
    let only_struct = tokens.len() > 2 && tokens[tokens.len() - 2].symbol == known::CLOSE_BRACE;
    match item {
        Item { always: true, .. } => PartKind::Other,
        Item { function: true, .. } if ends(known::SEMICOLON) => PartKind::Prototype,
        Item { function: true, .. } => PartKind::Function,
        _ if first == Some(known::STRUCT) && only_struct => PartKind::Struct,
        _ if has(known::STRUCT) => PartKind::Other,
        _ if first == Some(known::CONST) => PartKind::Constant,
        _ if first == Some(known::INVARIANT) || first == Some(known::PRECISE) => PartKind::Other,
        _ => PartKind::Variable,
    }
}

/// The parts that an item names, itself left out.
fn uses(item: &[Tok], own: u32, declared: &[Vec<u32>], parts: &[Part]) -> Vec<u32> {
    let mut uses = Vec::new();
    let mut previous = known::SEMICOLON;
    for (index, token) in item.iter().enumerate() {
        // A function is named only to be called; a local variable may have its name.
        let is_call = item.get(index + 1).is_some_and(|next| next.symbol == known::OPEN);
        let is_use = |part: &&u32| {
            **part != own && (is_call || parts[**part as usize].kind != PartKind::Function)
        };
        // What follows a dot is a member, not a name of this scope.
        if token.kind == Kind::Identifier && previous != known::DOT {
            uses.extend(declared[token.symbol.index()].iter().filter(is_use));
        }
        previous = token.symbol;
    }
    uses.sort_unstable();
    uses.dedup();
    uses
}

//! Finds the declarations of the output, and what each of them names.

use std::ops::Range;

use super::WrittenPieces;
use super::items::{GlslItem, Items};
use super::preprocess::Preprocessed;
use super::token::Tok;
use crate::{Part, PartKind};
use lamplight_syntax::glsl::{Symbol, TokenKind, known};

/// The most declarations of one name: a text with more gets no parts. Only overloads share a name,
/// and following very many would take too long.
const OF_ONE_NAME: usize = 64;

/// The directives as one part, then a part for each kept item; none where too many share a name.
pub fn make_parts(
    preprocessed: &Preprocessed<'_, '_>,
    items: &Items,
    kept: &[bool],
    written: WrittenPieces,
) -> Vec<Part> {
    let (tokens, spellings) = (&preprocessed.tokens, &preprocessed.spellings);
    let mut numbers = vec![u32::MAX; items.list.len()];
    let kept: Vec<usize> = (0..items.list.len()).filter(|index| kept[*index]).collect();
    let mut parts = vec![make_part(PartKind::Directive, written.header)];
    for (index, range) in kept.iter().zip(written.items) {
        numbers[*index] = parts.len() as u32;
        parts.push(make_part(
            part_kind(&tokens[items.list[*index].tokens.clone()], &items.list[*index]),
            range,
        ));
    }
    let mut declared = DeclaringParts::new(spellings.count(), items.names.len());
    for (symbol, item) in &items.names {
        let number = numbers[*item as usize];
        if number != u32::MAX {
            parts[number as usize].names.push(spellings.text(*symbol).to_owned());
            declared.add(*symbol, number);
        }
    }
    if items.names.iter().any(|(symbol, _)| declared.of(*symbol).nth(OF_ONE_NAME).is_some()) {
        return Vec::new();
    }
    for index in kept {
        let number = numbers[index];
        let item = &tokens[items.list[index].tokens.clone()];
        parts[number as usize].uses = used_parts(item, number, &declared, &parts);
    }
    parts.extend(written.main.map(|range| Part {
        names: vec!["main".to_owned()],
        ..make_part(PartKind::Function, range)
    }));
    parts
}

/// The parts that declare each name.
struct DeclaringParts {
    /// For each symbol, one more than the index in `links` of the last part that declares it; 0 for
    /// none.
    heads: Vec<u32>,
    /// A part, and one more than the index of the previous link for the same name; 0 for none.
    links: Vec<(u32, u32)>,
}

impl DeclaringParts {
    fn new(symbols: usize, names: usize) -> Self {
        Self { heads: vec![0; symbols], links: Vec::with_capacity(names) }
    }

    fn add(&mut self, symbol: Symbol, part: u32) {
        let head = &mut self.heads[symbol.index()];
        self.links.push((part, *head));
        *head = self.links.len() as u32;
    }

    fn of(&self, symbol: Symbol) -> impl Iterator<Item = u32> {
        let mut next = self.heads[symbol.index()];
        std::iter::from_fn(move || {
            let (part, before) = *self.links.get(next.checked_sub(1)? as usize)?;
            next = before;
            Some(part)
        })
    }
}

fn make_part(kind: PartKind, range: Range<usize>) -> Part {
    Part { kind, names: Vec::new(), range, uses: Vec::new(), aliases: Vec::new() }
}

fn part_kind(tokens: &[Tok], item: &GlslItem) -> PartKind {
    let has = |symbol: Symbol| tokens.iter().any(|token| token.symbol == symbol);
    let ends = |symbol: Symbol| tokens.last().is_some_and(|token| token.symbol == symbol);
    let first = tokens.first().map(|token| token.symbol);
    // A variable may be declared with the structure, behind its closing brace.
    let only_struct = tokens.len() > 2 && tokens[tokens.len() - 2].symbol == known::CLOSE_BRACE;
    match item {
        GlslItem { always: true, .. } => PartKind::Other,
        GlslItem { function: true, .. } if ends(known::SEMICOLON) => PartKind::Prototype,
        GlslItem { function: true, .. } => PartKind::Function,
        _ if first == Some(known::STRUCT) && only_struct => PartKind::Struct,
        _ if has(known::STRUCT) => PartKind::Other,
        _ if first == Some(known::CONST) => PartKind::Constant,
        _ if first == Some(known::INVARIANT) || first == Some(known::PRECISE) => PartKind::Other,
        _ => PartKind::Variable,
    }
}

/// The parts that an item names, except itself.
fn used_parts(item: &[Tok], own: u32, declared: &DeclaringParts, parts: &[Part]) -> Vec<u32> {
    let mut uses = Vec::new();
    let mut previous = known::SEMICOLON;
    for (index, token) in item.iter().enumerate() {
        // A function is named only where it is called. Elsewhere the name is that of a local
        // variable.
        let is_call = item.get(index + 1).is_some_and(|next| next.symbol == known::OPEN);
        let is_use = |part: &u32| {
            *part != own && (is_call || parts[*part as usize].kind != PartKind::Function)
        };
        // After a dot the name is a member's, not one of this scope.
        if token.kind == TokenKind::Identifier && previous != known::DOT {
            uses.extend(declared.of(token.symbol).filter(is_use));
        }
        previous = token.symbol;
    }
    uses.sort_unstable();
    uses.dedup();
    uses
}

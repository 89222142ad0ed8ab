//! Cuts preprocessed text into top-level declarations and finds the names each declares.

use std::ops::Range;

use super::token::Tok;
use lamplight_diagnostic::source::LIMITS;
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_syntax::glsl::{Module, Symbol, TokenKind, known};

/// A top-level declaration.
#[derive(Debug)]
pub struct GlslItem {
    /// Its tokens.
    pub tokens: Range<usize>,
    /// Whether it is a function or a prototype.
    pub function: bool,
    /// Kept whether or not anything names it: a statement without a name, or text that is not
    /// understood.
    pub always: bool,
}

/// Items in order, with `(name, item)` for every name they declare.
#[derive(Debug, Default)]
pub struct Items {
    pub list: Vec<GlslItem>,
    pub names: Vec<(Symbol, u32)>,
}

/// Cuts tokens into items at top level. Brackets nest up to a limit. Tokens at the end that no `;`
/// or `}` closes are an item too.
pub fn split_items(tokens: &[Tok], modules: &[Module]) -> Result<Items, Diagnostic> {
    let mut items = Items::default();
    let mut start = 0;
    while start < tokens.len() {
        let end = end_of(tokens, start).map_err(|token| too_deep(token, modules))?;
        let item = &tokens[start..end];
        if item[0].symbol != known::SEMICOLON && !is_per_vertex(item) {
            let (first, number) = (items.names.len(), items.list.len() as u32);
            let function = give_names(item, &mut |name| items.names.push((name, number)));
            items.list.push(GlslItem {
                tokens: start..end,
                function,
                always: items.names.len() == first,
            });
        }
        start = end;
    }
    Ok(items)
}

/// Whether an item is the block `gl_PerVertex`, which only repeats what a stage has anyway.
fn is_per_vertex(item: &[Tok]) -> bool {
    let open = item.iter().position(|token| token.symbol == known::OPEN_BRACE);
    let name = open.and_then(|open| item.get(open.checked_sub(1)?));
    name.is_some_and(|name| name.symbol == known::PER_VERTEX)
}

fn too_deep(token: &Tok, modules: &[Module]) -> Diagnostic {
    let message = format!("brackets nest deeper than {}", LIMITS.nesting);
    Diagnostic::error(codes::NESTING_TOO_DEEP, message).at(token.span(modules), "one too many")
}

/// One past the last token of the item: a `;` at top level, or the `}` of a function's body.
fn end_of(tokens: &[Tok], start: usize) -> Result<usize, &Tok> {
    let mut depth = 0usize;
    let mut body = false;
    for (index, token) in tokens.iter().enumerate().skip(start) {
        match token.symbol {
            known::OPEN | known::OPEN_BRACKET | known::OPEN_BRACE => {
                body |= depth == 0
                    && token.symbol == known::OPEN_BRACE
                    && index > start
                    && tokens[index - 1].symbol == known::CLOSE;
                depth += 1;
                if depth > LIMITS.nesting {
                    return Err(token);
                }
            }
            known::CLOSE | known::CLOSE_BRACKET | known::CLOSE_BRACE => {
                depth = depth.saturating_sub(1);
                if depth == 0 && token.symbol == known::CLOSE_BRACE && (body || index == start) {
                    return Ok(index + 1);
                }
            }
            known::SEMICOLON if depth == 0 => return Ok(index + 1),
            _ => {}
        }
    }
    Ok(tokens.len())
}

/// Calls `give` with each name that an item declares. Returns whether the item is a function.
fn give_names(item: &[Tok], give: &mut impl FnMut(Symbol)) -> bool {
    match item {
        [first, ..] if first.symbol == known::PRECISION => false,
        [first, name, _] if first.symbol == known::INVARIANT || first.symbol == known::PRECISE => {
            give(name.symbol);
            false
        }
        _ => declared_names(item, give),
    }
}

/// The same, for items other than `precision`, `invariant` and `precise` statements.
fn declared_names(item: &[Tok], give: &mut impl FnMut(Symbol)) -> bool {
    let mut at = 0;
    let mut is_struct = false;
    let mut block_members = None;
    while at < item.len() {
        let token = &item[at];
        let next = item.get(at + 1).map(|token| token.symbol);
        match token.symbol {
            known::LAYOUT => at = close_of(item, at + 1),
            known::STRUCT => is_struct = true,
            known::OPEN_BRACE => {
                let close = close_of(item, at);
                block_members = (!is_struct).then_some(at + 1..close.max(at + 1));
                at = close;
            }
            known::ASSIGN => {
                at = next_declarator(item, at);
                continue;
            }
            _ if token.kind == TokenKind::Identifier && !is_qualifier(token.symbol) => match next {
                Some(known::OPEN) => {
                    give(token.symbol);
                    return true;
                }
                Some(known::OPEN_BRACE) if is_struct => give(token.symbol),
                Some(known::SEMICOLON | known::COMMA | known::ASSIGN) => {
                    give(token.symbol);
                    block_members = None;
                }
                Some(known::OPEN_BRACKET) if !is_type(item, at) => {
                    give(token.symbol);
                    block_members = None;
                }
                _ => {}
            },
            _ => {}
        }
        at += 1;
    }
    if let Some(members) = block_members {
        member_names(&item[members], give);
    }
    false
}

/// A block without an instance name puts its members into the global scope.
fn member_names(members: &[Tok], give: &mut impl FnMut(Symbol)) {
    for pair in members.windows(2) {
        let ends = matches!(pair[1].symbol, known::SEMICOLON | known::COMMA | known::OPEN_BRACKET);
        if ends && pair[0].kind == TokenKind::Identifier {
            give(pair[0].symbol);
        }
    }
}

fn is_qualifier(symbol: Symbol) -> bool {
    matches!(symbol, known::IN | known::OUT | known::UNIFORM | known::BUFFER | known::CONST)
}

/// Whether the name before a `[` is the element type of `float[3] name`.
fn is_type(item: &[Tok], at: usize) -> bool {
    let mut after = at + 1;
    while item.get(after).is_some_and(|token| token.symbol == known::OPEN_BRACKET) {
        after = close_of(item, after) + 1;
    }
    item.get(after).is_some_and(|token| token.kind == TokenKind::Identifier)
}

/// The bracket that closes the one at `open`, or the last token.
fn close_of(item: &[Tok], open: usize) -> usize {
    let mut depth = 0usize;
    for (index, token) in item.iter().enumerate().skip(open) {
        match token.symbol {
            known::OPEN | known::OPEN_BRACKET | known::OPEN_BRACE => depth += 1,
            known::CLOSE | known::CLOSE_BRACKET | known::CLOSE_BRACE => {
                depth = depth.saturating_sub(1)
            }
            _ => {}
        }
        if depth == 0 {
            return index;
        }
    }
    item.len() - 1
}

/// The `,` or `;` that ends an initialiser.
fn next_declarator(item: &[Tok], mut at: usize) -> usize {
    while at < item.len() {
        match item[at].symbol {
            known::COMMA | known::SEMICOLON => return at,
            known::OPEN | known::OPEN_BRACKET | known::OPEN_BRACE => at = close_of(item, at),
            _ => {}
        }
        at += 1;
    }
    at
}

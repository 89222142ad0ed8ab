//! Finds which items are kept.

use super::items::Items;
use super::table::Spellings;
use super::token::Tok;
use crate::Keep;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_syntax::glsl::{Symbol, TokenKind, known};

/// Whether each item is kept: those that `keep` names, and those that they reach by name. Overloads
/// share a name, so they are kept together.
pub fn reached_items(
    tokens: &[Tok],
    items: &Items,
    spellings: &Spellings<'_>,
    keep: &Keep,
) -> Result<Vec<bool>, Diagnostics> {
    if *keep == Keep::All {
        return Ok(vec![true; items.list.len()]);
    }
    let mut search = ReachSearch::new(items, spellings.count());
    let always = items.list.iter().enumerate().filter(|(_, item)| item.always);
    always.for_each(|(index, _)| search.keep(index as u32));
    match keep {
        Keep::Items(names) => start_at(&mut search, items, spellings, names)?,
        Keep::EntryPoints if search.declares(known::MAIN) => search.name(known::MAIN),
        // A module without an entry point is composed for everything that it declares itself.
        _ => (0..items.list.len())
            .filter(|index| tokens[items.list[*index].tokens.start].module == 0)
            .for_each(|index| search.keep(index as u32)),
    }
    search.run(tokens, items);
    Ok(search.kept)
}

fn start_at(
    search: &mut ReachSearch,
    items: &Items,
    spellings: &Spellings<'_>,
    names: &[String],
) -> Result<(), Diagnostics> {
    let mut errors = Vec::new();
    for name in names {
        match spellings.find(name).filter(|symbol| search.declares(*symbol)) {
            Some(symbol) => search.name(symbol),
            None => {
                let functions =
                    items.names.iter().filter(|(_, item)| items.list[*item as usize].function);
                let known = functions.map(|(symbol, _)| spellings.text(*symbol));
                errors.push(
                    Diagnostic::error(
                        codes::MISSING_ITEM,
                        format!("there is no function `{name}`"),
                    )
                    .about_item(name)
                    .suggest(name, known),
                );
            }
        }
    }
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

struct ReachSearch {
    kept: Vec<bool>,
    work: Vec<u32>,
    /// For each symbol, one more than the index in `links` of the last item that declares it; 0 if
    /// no item does, or if the symbol was visited.
    heads: Vec<u32>,
    /// An item, and one more than the index of the previous link for the same name; 0 for none.
    links: Vec<(u32, u32)>,
}

impl ReachSearch {
    fn new(items: &Items, symbols: usize) -> Self {
        let mut heads = vec![0; symbols];
        let mut links = Vec::with_capacity(items.names.len());
        for (symbol, item) in &items.names {
            links.push((*item, heads[symbol.index()]));
            heads[symbol.index()] = links.len() as u32;
        }
        Self { kept: vec![false; items.list.len()], work: Vec::new(), heads, links }
    }

    fn declares(&self, symbol: Symbol) -> bool {
        self.heads[symbol.index()] != 0
    }

    fn keep(&mut self, item: u32) {
        if !std::mem::replace(&mut self.kept[item as usize], true) {
            self.work.push(item);
        }
    }

    fn name(&mut self, symbol: Symbol) {
        let mut link = std::mem::take(&mut self.heads[symbol.index()]);
        while link != 0 {
            let (item, next) = self.links[link as usize - 1];
            self.keep(item);
            link = next;
        }
    }

    fn run(&mut self, tokens: &[Tok], items: &Items) {
        while let Some(item) = self.work.pop() {
            let range = items.list[item as usize].tokens.clone();
            let mut previous = known::SEMICOLON;
            for token in &tokens[range] {
                // After a dot the name is a member's, not one of this scope.
                if token.kind == TokenKind::Identifier && previous != known::DOT {
                    self.name(token.symbol);
                }
                previous = token.symbol;
            }
        }
    }
}

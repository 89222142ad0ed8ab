//! Finds functions of a module that no case calls.

use std::collections::{BTreeMap, BTreeSet};

use super::cases::CaseFile;
use lamplight_diagnostic::source::{SourceId, SourceSet};
use lamplight_syntax::glsl::{self, FilePart, Symbol, Symbols, Token, TokenKind, known};
use lamplight_syntax::wesl::{self, Event, Item, ItemKind, Module, Name, Names, UsedName};

/// Paths of the functions of a WESL module that no case names and that no named function calls.
/// Entry points need no cases.
pub fn untested_functions(module: &str, text: &str, file: &CaseFile) -> Vec<String> {
    let mut names = Names::default();
    let parsed = wesl::parse(SourceId(0), text.into(), &mut names);
    let tried = named_functions(file).filter_map(|name| names.find(name)).collect();
    let reached = reached_from(tried, |name| {
        let items = parsed.items.iter().filter(|item| item.name == name);
        items.flat_map(|item| used_names(&parsed, item)).collect()
    });
    let functions = parsed.items.iter().filter(|item| item.kind == ItemKind::Function);
    let missed = functions.filter(|item| !item.entry && !reached.contains(&item.name));
    function_paths(module, missed.map(|item| names.text(item.name)))
}

/// As [`untested_functions`], for a GLSL module. Functions in all branches of its preprocessor
/// conditions count.
pub fn of_glsl(module: &str, text: &str, file: &CaseFile) -> Vec<String> {
    let (mut sources, mut symbols) = (SourceSet::default(), Symbols::default());
    let id = sources.add(format!("{module}.glsl"), text);
    let functions = function_definitions(&glsl::parse(&sources, id, &mut symbols));
    let tried = named_functions(file).filter_map(|name| symbols.find(name)).collect();
    let reached = reached_from(tried, |name| functions.get(&name).cloned().unwrap_or_default());
    let missed = functions.keys().filter(|name| **name != known::MAIN && !reached.contains(name));
    function_paths(module, missed.map(|name| symbols.text(*name)))
}

/// The functions that cases name, partners of laws among them.
fn named_functions(file: &CaseFile) -> impl Iterator<Item = &str> {
    file.cases.iter().flat_map(|case| {
        let partners = case.laws.iter().flat_map(|law| &law.partners);
        std::iter::once(case.function.as_str()).chain(partners.map(|partner| partner.as_str()))
    })
}

/// The given names and all that they use, directly or through others.
fn reached_from<N: Copy + Ord>(mut open: Vec<N>, uses: impl Fn(N) -> Vec<N>) -> BTreeSet<N> {
    let mut reached = BTreeSet::new();
    while let Some(name) = open.pop() {
        if reached.insert(name) {
            open.extend(uses(name));
        }
    }
    reached
}

fn function_paths<'a>(module: &str, names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let paths: BTreeSet<String> = names.map(|name| format!("{module}::{name}")).collect();
    paths.into_iter().collect()
}

/// Every function that a GLSL file defines, with the identifiers of its body.
fn function_definitions(module: &glsl::Module) -> BTreeMap<Symbol, Vec<Symbol>> {
    let texts = module.parts.iter().filter_map(|part| match part {
        FilePart::Text(text) => Some(text.tokens.start as usize..text.tokens.end as usize),
        FilePart::Directive(..) => None,
    });
    let tokens: Vec<&Token> = texts.flat_map(|range| &module.tokens[range]).collect();
    let mut found: BTreeMap<Symbol, Vec<Symbol>> = BTreeMap::new();
    let mut at = 0;
    while at < tokens.len() {
        let next = |at: usize| tokens.get(at).map(|token| token.symbol);
        if next(at) == Some(known::OPEN_BRACE) {
            at = closing_token(&tokens, at, known::OPEN_BRACE, known::CLOSE_BRACE);
        } else if tokens[at].kind == TokenKind::Identifier && next(at + 1) == Some(known::OPEN) {
            let body = closing_token(&tokens, at + 1, known::OPEN, known::CLOSE);
            if next(body) == Some(known::OPEN_BRACE) {
                let end = closing_token(&tokens, body, known::OPEN_BRACE, known::CLOSE_BRACE);
                let words =
                    tokens[body..end].iter().filter(|word| word.kind == TokenKind::Identifier);
                found.entry(tokens[at].symbol).or_default().extend(words.map(|word| word.symbol));
                at = end;
            } else {
                at = body;
            }
        } else {
            at += 1;
        }
    }
    found
}

/// The token after the bracket that closes the one at `at`.
fn closing_token(tokens: &[&Token], at: usize, open: Symbol, close: Symbol) -> usize {
    let mut depth = 0usize;
    for (index, token) in tokens.iter().enumerate().skip(at) {
        if token.symbol == open {
            depth += 1;
        } else if token.symbol == close {
            depth -= 1;
            if depth == 0 {
                return index + 1;
            }
        }
    }
    tokens.len()
}

/// The module's own names that an item uses.
fn used_names<'a>(module: &'a Module, item: &'a Item) -> impl Iterator<Item = Name> + 'a {
    item.events.iter().filter_map(|event| match event {
        Event::Use { reference, .. } => match &module.references[*reference as usize] {
            UsedName::Name(name) => Some(*name),
            UsedName::Path(_) => None,
        },
        _ => None,
    })
}

//! Functions of a module that no case calls.

use std::collections::BTreeSet;

use super::cases::File;
use crate::parse::wesl::{self, Event, Item, ItemKind, Module, Name, Names, Reference};
use crate::source::SourceId;

/// Paths of the functions of a WESL module that no case names and that no function which a case
/// names calls. Entry points have no cases.
pub fn of(module: &str, text: &str, file: &File) -> Vec<String> {
    let mut names = Names::default();
    let parsed = wesl::parse(SourceId(0), text.into(), &mut names);
    let named = file.cases.iter().flat_map(|case| {
        let partners = case.laws.iter().flat_map(|law| &law.partners);
        std::iter::once(case.function.as_str()).chain(partners.map(|partner| partner.as_str()))
    });
    let mut open: Vec<Name> = named.filter_map(|name| names.find(name)).collect();
    let mut reached = BTreeSet::new();
    while let Some(name) = open.pop() {
        if reached.insert(name) {
            let items = parsed.items.iter().filter(|item| item.name == name);
            open.extend(items.flat_map(|item| used(&parsed, item)));
        }
    }
    let functions = parsed.items.iter().filter(|item| item.kind == ItemKind::Function);
    let missed = functions.filter(|item| !item.entry && !reached.contains(&item.name));
    let paths: BTreeSet<String> =
        missed.map(|item| format!("{module}::{}", names.text(item.name))).collect();
    paths.into_iter().collect()
}

/// The module's own names that an item uses.
fn used<'a>(module: &'a Module, item: &'a Item) -> impl Iterator<Item = Name> + 'a {
    item.events.iter().filter_map(|event| match event {
        Event::Use { reference, .. } => match &module.references[*reference as usize] {
            Reference::Name(name) => Some(*name),
            Reference::Path(_) => None,
        },
        _ => None,
    })
}

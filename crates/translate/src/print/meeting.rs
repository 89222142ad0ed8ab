//! Names that meet: GLSL has one scope for all files that are included together.

use std::collections::{BTreeMap, BTreeSet};

use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::Span;

use super::names::Names;
use super::place::{Part, Places};
use super::uses::item_uses;
use crate::tree::{Item, ItemPath, Node};
use crate::wesl::untranslated;

/// The items of each module, by the file that they go to.
pub type AllPlaces = BTreeMap<Vec<String>, Places>;

/// The errors for items that have the name of an item of another module that is included with them.
pub fn check_meetings(places: &AllPlaces, names: &Names) -> Diagnostics {
    let mut errors = Diagnostics::new();
    let mut reported = BTreeSet::new();
    for (module, parts) in places {
        let own: Vec<&Node<Item>> = parts.parts.values().flatten().collect();
        let mut known: BTreeMap<&str, ItemPath> = BTreeMap::new();
        let reached = reached(module, &own, places);
        let others = reached.iter().flat_map(|path| named(path, shared(path, places), names));
        for (path, span) in others.chain(named(module, own, names)) {
            let name = names.item(&path);
            match known.get(name) {
                Some(found) if found.module != path.module => {
                    if reported.insert(path.clone()) {
                        let with = found.module.join("::");
                        let what = format!(
                            "`{}`, which has the name of an item of `{with}`: both are included",
                            path.name
                        );
                        let error = untranslated(span, what);
                        errors.push(error.note("help: give one of them another name"));
                    }
                }
                Some(_) => {}
                None => drop(known.insert(name, path)),
            }
        }
    }
    errors
}

/// What others include of a module.
fn shared<'a>(module: &[String], places: &'a AllPlaces) -> Vec<&'a Node<Item>> {
    let parts = places.get(module).map(|places| &places.parts);
    parts.and_then(|parts| parts.get(&Part::Shared)).into_iter().flatten().collect()
}

/// The paths of items that have a name in GLSL.
fn named(module: &[String], items: Vec<&Node<Item>>, names: &Names) -> Vec<(ItemPath, Span)> {
    let path =
        |node: &Node<Item>| ItemPath { module: module.to_vec(), name: node.body.name().to_owned() };
    let all = items.into_iter().map(|node| (path(node), node.span));
    all.filter(|(path, _)| !path.name.is_empty() && !names.item(path).is_empty()).collect()
}

/// The other modules that some items include, and what these include.
fn reached(module: &[String], items: &[&Node<Item>], places: &AllPlaces) -> BTreeSet<Vec<String>> {
    let mut found: BTreeSet<Vec<String>> = BTreeSet::new();
    let mut work = items.to_vec();
    while let Some(node) = work.pop() {
        item_uses(&node.body, &mut |path, _| {
            if path.module != module && found.insert(path.module.clone()) {
                work.extend(shared(&path.module, places));
            }
        });
    }
    found
}

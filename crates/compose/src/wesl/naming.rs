//! Chooses the names in the output: a declaration keeps its name, or gets its qualified path where
//! two have the same name.

use std::collections::HashSet;

use super::reached::{Reached, Thing, name_of};
use crate::resolve::wesl::Graph;
use crate::{Mangle, Options};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_syntax::wesl::{ItemKind, Name};
use lamplight_syntax::words::continues_word;

/// The new names of the things that do not keep theirs.
pub struct ItemRenames {
    /// For each thing, one more than its index in `texts`; 0 where it keeps its name.
    indices: Vec<u32>,
    texts: Vec<String>,
}

impl ItemRenames {
    /// The name of a thing in the output.
    pub fn text<'a>(&'a self, graph: &'a Graph, reached: &Reached, thing: Thing) -> &'a str {
        match self.indices[reached.index(thing)] {
            0 => graph.names.text(name_of(graph, thing)),
            index => &self.texts[index as usize - 1],
        }
    }
}

/// How firmly a thing holds its name against another of the same name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Hold {
    /// Imported: renamed where something else has the name.
    Loose,
    /// Of the root module: renamed only where the name would change what a use means.
    Root,
    /// An entry point or an override: never renamed, since the host asks for it by name.
    Fixed,
}

/// Chooses the names of all that is kept.
pub fn choose_names(
    graph: &Graph,
    reached: &Reached,
    options: &Options,
    errors: &mut Diagnostics,
) -> ItemRenames {
    let things = kept_things(graph, reached);
    let mut table = NameTable::new(graph, reached, &things);
    let mut renames = ItemRenames { indices: vec![0; reached.len()], texts: Vec::new() };
    let mut made = HashSet::new();
    for thing in &things {
        let name = reached.name(graph, *thing);
        let hold = name_hold(graph, reached, *thing);
        let taken = table.free[name.0 as usize] || reached.is_hidden(*thing);
        if hold == Hold::Fixed || (hold == Hold::Root && !taken) {
            let clash = table.firm[name.0 as usize].replace(*thing).filter(|_| !taken);
            errors.extend(clash.map(|other| name_conflict(graph, *thing, other)));
            errors.extend(taken.then(|| captured_name(graph, *thing)));
            if name != name_of(graph, *thing) {
                renames.texts.push(graph.names.text(name).to_owned());
                renames.indices[reached.index(*thing)] = renames.texts.len() as u32;
            }
            continue;
        }
        let twin = table.loose[name.0 as usize]
            .replace(*thing)
            .filter(|twin| node_of(*twin) == node_of(*thing));
        errors.extend(twin.map(|twin| name_conflict(graph, *thing, twin)));
        let mangled = options.mangle == Mangle::Underscore && hold == Hold::Loose;
        if mangled || taken || table.claims[name.0 as usize] > 1 {
            let text = table.unique(mangled_name(graph, *thing), &made);
            made.insert(text.clone());
            renames.texts.push(text);
            renames.indices[reached.index(*thing)] = renames.texts.len() as u32;
        }
    }
    renames
}

/// Everything with a name, in the order of the output.
fn kept_things(graph: &Graph, reached: &Reached) -> Vec<Thing> {
    let constants =
        (0..graph.constants.len() as u32).map(Thing::Constant).filter(|thing| reached.has(*thing));
    let mut things: Vec<Thing> = constants.collect();
    for node in reached.nodes() {
        let items = &graph.nodes[node as usize].module.items;
        let named = reached
            .items(node, items.len())
            .filter(|item| items[*item as usize].kind != ItemKind::ConstAssert);
        things.extend(named.map(|item| Thing::Item { node, item }));
    }
    things
}

fn name_hold(graph: &Graph, reached: &Reached, thing: Thing) -> Hold {
    let Thing::Item { node, item } = thing else { return Hold::Loose };
    if reached.exposed.contains_key(&reached.index(thing)) {
        return Hold::Fixed;
    }
    let item = &graph.nodes[node as usize].module.items[item as usize];
    match item.kind {
        _ if item.entry => Hold::Fixed,
        ItemKind::Override => Hold::Fixed,
        _ if node == 0 => Hold::Root,
        _ => Hold::Loose,
    }
}

/// Tables over all names of the graph: which kept things have each name.
struct NameTable<'a> {
    graph: &'a Graph,
    reached: &'a Reached,
    claims: Vec<u32>,
    /// Whether a kept item uses the name for something predeclared.
    free: Vec<bool>,
    /// The thing that has the name and is never renamed.
    firm: Vec<Option<Thing>>,
    /// The last thing that has the name and may be renamed.
    loose: Vec<Option<Thing>>,
}

impl<'a> NameTable<'a> {
    fn new(graph: &'a Graph, reached: &'a Reached, things: &[Thing]) -> Self {
        let count = graph.names.len();
        let mut table = Self {
            graph,
            reached,
            claims: vec![0; count],
            free: vec![false; count],
            firm: vec![None; count],
            loose: vec![None; count],
        };
        for thing in things {
            table.claims[reached.name(graph, *thing).0 as usize] += 1;
        }
        let free = reached.nodes().flat_map(|node| {
            let items = &graph.nodes[node as usize].module.items;
            reached.items(node, items.len()).flat_map(|item| items[item as usize].free.iter())
        });
        free.chain(&reached.free).for_each(|name| table.free[name.0 as usize] = true);
        table
    }

    /// The text, with a number appended if something else has that name.
    fn unique(&self, text: String, made: &HashSet<String>) -> String {
        let mut candidate = text.clone();
        let mut number = 2;
        while made.contains(&candidate) || self.is_taken(&candidate) {
            candidate = format!("{text}_{number}");
            number += 1;
        }
        candidate
    }

    fn is_taken(&self, text: &str) -> bool {
        self.graph.names.find(text).is_some_and(|name| {
            self.claims[name.0 as usize] > 0
                || self.free[name.0 as usize]
                || self.reached.nodes().any(|node| self.is_local(node, name))
        })
    }

    fn is_local(&self, node: u32, name: Name) -> bool {
        let items = &self.graph.nodes[node as usize].module.items;
        self.reached
            .items(node, items.len())
            .any(|item| items[item as usize].locals.binary_search(&name).is_ok())
    }
}

/// The underscore form of the WESL specification: the parts of the path joined by single
/// underscores, with the underscores inside a part doubled.
fn mangled_name(graph: &Graph, thing: Thing) -> String {
    let name = graph.names.text(name_of(graph, thing));
    let label = match thing {
        Thing::Item { node, .. } => graph.nodes[node as usize].label.as_str(),
        Thing::Constant(_) => "constants",
    };
    let mut text = String::with_capacity(label.len() + name.len() + 4);
    for part in label.split("::").chain([name]) {
        if !text.is_empty() {
            text.push('_');
        }
        text.extend(part.chars().flat_map(escape_letter));
    }
    text
}

/// A character of a part. Those that no identifier has, from file names, become underscores.
fn escape_letter(letter: char) -> impl Iterator<Item = char> {
    let allowed = continues_word(letter) && letter != '_';
    [if allowed { letter } else { '_' }, '_'].into_iter().take(if allowed { 1 } else { 2 })
}

fn node_of(thing: Thing) -> Option<u32> {
    match thing {
        Thing::Item { node, .. } => Some(node),
        Thing::Constant(_) => None,
    }
}

fn name_conflict(graph: &Graph, thing: Thing, other: Thing) -> Diagnostic {
    if let (Thing::Item { node, item: again }, Thing::Item { node: same, item: first }) =
        (thing, other)
        && node == same
    {
        let module = &graph.nodes[node as usize];
        return module.declared_twice(&graph.names, again as usize, first as usize);
    }
    let name = graph.names.text(name_of(graph, thing));
    let message = format!("two declarations must both be named `{name}`");
    let error = Diagnostic::error(codes::NAME_CONFLICT, message);
    let error = label_declaration(graph, thing, error, "this one");
    label_declaration(graph, other, error, "and this one")
}

fn captured_name(graph: &Graph, thing: Thing) -> Diagnostic {
    let name = graph.names.text(name_of(graph, thing));
    let message = format!(
        "`{name}` must keep its name, but other code of the output refers to something else by it"
    );
    label_declaration(
        graph,
        thing,
        Diagnostic::error(codes::NAME_CONFLICT, message),
        "an entry point or an override",
    )
}

fn label_declaration(graph: &Graph, thing: Thing, error: Diagnostic, label: &str) -> Diagnostic {
    let Thing::Item { node, item } = thing else { return error };
    let module = &graph.nodes[node as usize].module;
    error.at(module.span(module.items[item as usize].name_range.clone()), label)
}

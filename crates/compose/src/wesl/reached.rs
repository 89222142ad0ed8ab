//! What a permutation keeps, and what its references mean.

use crate::resolve::wesl::Graph;
use lamplight_diagnostic::source::Span;
use lamplight_syntax::wesl::Name;
use std::collections::BTreeMap;

/// An item, or a number from the virtual module `constants`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Thing {
    Item { node: u32, item: u32 },
    Constant(u32),
}

/// What a reference means under the settings.
#[derive(Debug, Clone, Copy)]
pub enum ReferenceMeaning {
    Unknown,
    /// Something predeclared, or an error that has been reported.
    Free,
    Thing(Thing),
}

/// A use, by a declaration that is not a function, whose condition holds.
#[derive(Debug, Clone, Copy)]
pub struct Dependency {
    pub user: Thing,
    pub used: Thing,
    pub span: Span,
}

/// Everything that is kept. Tables are over all items of all nodes, with the constants after them.
pub struct Reached {
    /// Whether each thing is kept.
    pub(super) things: Vec<bool>,
    /// Whether a local of the same name would hide it at a place where it is used.
    pub(super) hidden: Vec<bool>,
    pub(super) nodes: Vec<bool>,
    /// For each binding of all nodes, its meaning.
    pub(super) meanings: Vec<ReferenceMeaning>,
    pub(super) order: Vec<u32>,
    pub(super) items: u32,
    pub(super) bases: Vec<u32>,
    /// For each constant, its value as text.
    pub constants: Vec<Option<(&'static str, String)>>,
    pub dependencies: Vec<Dependency>,
    /// By the index of a thing: the name under which the root module passes it on to the host.
    pub exposed: BTreeMap<usize, Name>,
    /// Predeclared names that are used although the module has a disabled item of that name.
    pub free: Vec<Name>,
}

impl Reached {
    /// The index of a thing in the tables over all things.
    pub fn index(&self, thing: Thing) -> usize {
        match thing {
            Thing::Item { node, item } => (self.bases[node as usize] + item) as usize,
            Thing::Constant(index) => (self.items + index) as usize,
        }
    }

    /// The name that a thing has for the host and for the text, unless another thing has it.
    pub fn name(&self, graph: &Graph, thing: Thing) -> Name {
        self.exposed.get(&self.index(thing)).copied().unwrap_or_else(|| name_of(graph, thing))
    }

    pub fn has(&self, thing: Thing) -> bool {
        self.things[self.index(thing)]
    }

    pub fn is_hidden(&self, thing: Thing) -> bool {
        self.hidden[self.index(thing)]
    }

    pub fn len(&self) -> usize {
        self.things.len()
    }

    /// The nodes of which something is kept, in the order of the output.
    pub fn nodes(&self) -> impl Iterator<Item = u32> {
        self.order.iter().copied().filter(|node| self.nodes[*node as usize])
    }

    /// The kept items of a node, in source order.
    pub fn items(&self, node: u32, count: usize) -> impl Iterator<Item = u32> {
        (0..count as u32).filter(move |item| self.has(Thing::Item { node, item: *item }))
    }

    /// What a reference of a node means.
    pub fn meaning(&self, graph: &Graph, node: u32, reference: u32) -> ReferenceMeaning {
        self.meanings[(graph.nodes[node as usize].bases.bindings + reference) as usize]
    }
}

/// The declared name of a thing.
pub fn name_of(graph: &Graph, thing: Thing) -> Name {
    match thing {
        Thing::Item { node, item } => graph.nodes[node as usize].module.items[item as usize].name,
        Thing::Constant(index) => graph.constants[index as usize].name,
    }
}

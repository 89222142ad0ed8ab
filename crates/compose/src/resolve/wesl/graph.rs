//! The resolved modules.

use std::collections::BTreeMap;
use std::sync::Arc;

use rustc_hash::FxHashMap;

use lamplight_diagnostic::source::{Embedded, SourceId, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_syntax::wesl::{
    ConditionId, Expression, Item, Name, Names, PlacedModule, Visibility,
};

/// The most imports that a diagnostic lists of the chain that led to its file.
const TRACED: usize = 16;

/// Every module that a root module may reach, ready to be composed any number of times.
#[derive(Debug)]
pub struct Graph {
    pub names: Arc<Names>,
    /// The root module first.
    pub nodes: Vec<ModuleNode>,
    /// The nodes in the order of the output: by label, with the root module last.
    pub order: Vec<u32>,
    pub constants: Vec<ConstantUse>,
    /// Errors that are reported once something needs what failed.
    pub failures: Vec<Diagnostic>,
    /// How many items, conditions and bindings all nodes have together.
    pub totals: Bases,
    pub by_source: BTreeMap<SourceId, u32>,
    /// What hints about unknown names are taken from.
    pub library: Option<Embedded>,
}

impl Graph {
    /// The imports that led to a file, from its own importer to one in the root module.
    ///
    /// Empty for the root module and for files that are not of this graph.
    pub fn chain(&self, source: SourceId) -> Vec<Span> {
        self.importers(source).map(|(span, _)| span).collect()
    }

    /// For each file but that of the root module, the import that led to it first.
    pub fn imports(&self) -> impl Iterator<Item = (SourceId, Span)> {
        let found = |(source, node): (&SourceId, &u32)| {
            let importer = self.nodes[*node as usize].importer.as_ref()?;
            Some((*source, importer.span))
        };
        self.by_source.iter().filter_map(found)
    }

    /// [`Self::chain`] as notes: `imported by main.wesl:3:8`.
    pub fn trace(&self, source: SourceId) -> Vec<String> {
        self.importers(source).map(|(_, note)| note.to_owned()).collect()
    }

    /// The diagnostic with the chain of imports that led to the file it stands in.
    pub fn traced(&self, diagnostic: Diagnostic) -> Diagnostic {
        let source = diagnostic.labels.first().map(|label| label.span.source);
        let notes = source.into_iter().flat_map(|source| self.importers(source)).take(TRACED);
        notes.fold(diagnostic, |diagnostic, (_, note)| diagnostic.note(note))
    }

    /// Whether any condition or `constants::` may ask for the axis or feature.
    pub fn may_ask(&self, name: &str) -> bool {
        let Some(name) = self.names.find(name) else { return false };
        let expressions = self.nodes.iter().flat_map(|node| &node.module.expressions);
        expressions.flat_map(Expression::names).any(|used| used == name)
            || self.constants.iter().any(|constant| constant.name == name)
    }

    /// Whether the file is in the root package.
    pub fn is_own(&self, source: SourceId) -> bool {
        self.by_source.get(&source).is_some_and(|node| self.nodes[*node as usize].package == 0)
    }

    fn importers(&self, source: SourceId) -> impl Iterator<Item = (Span, &str)> {
        let first = self
            .by_source
            .get(&source)
            .and_then(|node| self.nodes[*node as usize].importer.as_ref());
        std::iter::successors(first, |importer| {
            let node = self.by_source.get(&importer.span.source)?;
            self.nodes[*node as usize].importer.as_ref()
        })
        .map(|importer| (importer.span, importer.note.as_str()))
    }
}

/// Where a module's entries start in tables over all modules.
#[derive(Debug, Clone, Copy, Default)]
pub struct Bases {
    pub items: u32,
    pub conditions: u32,
    pub bindings: u32,
}

/// A module with its place in the graph.
#[derive(Debug)]
pub struct ModuleNode {
    /// Its items, imports and conditions.
    pub module: PlacedModule,
    /// 0 for the root package, else one more than the dependency's index.
    pub package: usize,
    /// Names from the package's root.
    pub path: Vec<String>,
    /// `package::a::b` or `lamplight::brdf::specular`.
    pub label: String,
    /// Item indices by name, in source order.
    pub sets: Arc<FxHashMap<Name, Vec<u32>>>,
    /// Indices of imports, by the name that they bring into scope.
    pub aliases: Arc<FxHashMap<Name, Vec<usize>>>,
    /// For each import, what it may lead to.
    pub imports: Arc<Vec<Vec<PathTarget>>>,
    /// For each reference, what it may mean: the first candidate whose conditions hold.
    pub bindings: Arc<Vec<Vec<Candidate>>>,
    /// Imports that lead nowhere, with their conditions. They are reported if the module is reached
    /// and the conditions hold.
    pub broken_imports: Vec<(Vec<NodeCondition>, u32)>,
    /// What its `public import` statements pass on, by the names that they give it.
    pub passed: Vec<(Name, Candidate)>,
    /// Declarations of a name that is declared twice under the same condition. These failures are
    /// reported if the module is reached, unless items were asked for by name.
    pub duplicates: Vec<(Option<ConditionId>, u32)>,
    /// Warnings, only for modules of the root package.
    pub lints: Vec<Diagnostic>,
    /// What led here first; `None` for the root module.
    pub importer: Option<Importer>,
    /// Offsets of this module's items, conditions and bindings in the tables over all modules.
    pub bases: Bases,
}

impl ModuleNode {
    /// Whether another module can name an item of this one.
    pub fn shows(&self, item: &Item, other: &ModuleNode) -> bool {
        match item.visibility {
            Visibility::Public => true,
            Visibility::Package => self.package == other.package || !self.module.says_visibility,
            Visibility::Private => self.package == other.package && self.path == other.path,
        }
    }

    /// Whether another module can name an item of this one that has the name.
    pub fn shows_name(&self, name: Name, other: &ModuleNode) -> bool {
        let items = self.sets.get(&name).into_iter().flatten();
        items.into_iter().any(|index| self.shows(&self.module.items[*index as usize], other))
    }

    /// The error about an item that cannot be named at a place of another module.
    pub fn not_visible(&self, names: &Names, item: &Item, place: Span) -> Diagnostic {
        let text = names.text(item.name);
        let (message, help) = match item.visibility {
            Visibility::Private => {
                (format!("`{text}` is private to `{}`", self.label), "remove `private`")
            }
            _ => (
                format!("`{text}` of `{}` is not public", self.label),
                "write `public` before the declaration",
            ),
        };
        Diagnostic::error(codes::NOT_VISIBLE, message)
            .at(place, "cannot be named here")
            .at(self.module.span(item.name_range.clone()), "declared here")
            .note(format!("help: {help}"))
    }

    /// The error about an item whose name an earlier one has, by their indices.
    pub fn declared_twice(&self, names: &Names, again: usize, first: usize) -> Diagnostic {
        let [again, first] = [again, first].map(|index| &self.module.items[index]);
        let message = format!("`{}` is declared twice in `{}`", names.text(again.name), self.label);
        Diagnostic::error(codes::DUPLICATE_ITEM, message)
            .at(self.module.span(again.name_range.clone()), "declared again")
            .at(self.module.span(first.name_range.clone()), "declared first")
    }
}

/// The import or inline path that led to a module.
#[derive(Debug, Clone)]
pub struct Importer {
    pub span: Span,
    pub note: String,
}

/// One thing that a use may mean.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// Conditions of the modules that it goes through. All must hold.
    pub conditions: Vec<NodeCondition>,
    /// What the import leads to.
    pub target: PathTarget,
    /// Whether a wildcard brings it. Two of these must not lead to different things.
    pub is_wildcard: bool,
}

impl Candidate {
    /// What is meant whatever the settings are.
    pub fn certain(target: PathTarget) -> Self {
        Self { conditions: Vec::new(), target, is_wildcard: false }
    }
}

/// A condition of a module.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NodeCondition {
    /// Number of the module.
    pub node: u32,
    /// The condition in it.
    pub condition: ConditionId,
}

/// What a path leads to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PathTarget {
    /// The items of that name in a node; conditions choose.
    Items {
        /// Number of the module.
        node: u32,
        /// Name of its items.
        name: Name,
    },
    /// Index into [`Graph::constants`].
    Constant(u32),
    /// A module, which can be imported but is no value itself.
    Module,
    /// Index into [`Graph::failures`].
    Failed(u32),
}

/// `constants::NAME`, used somewhere.
#[derive(Debug)]
pub struct ConstantUse {
    /// The name that is imported.
    pub name: Name,
    /// Its first use.
    pub span: Span,
}

/// The errors that every composition has: those of the root module, and of what it imports without
/// a condition.
pub fn certain_errors(graph: &Graph) -> Diagnostics {
    let mut certain = vec![false; graph.nodes.len()];
    let mut failed = vec![false; graph.failures.len()];
    let mut errors = Vec::new();
    let mut open = vec![0];
    while let Some(index) = open.pop() {
        if std::mem::replace(&mut certain[index], true) {
            continue;
        }
        let node = &graph.nodes[index];
        let broken = node.broken_imports.iter().filter(|(conditions, _)| conditions.is_empty());
        let broken =
            broken.filter(|(_, failure)| !std::mem::replace(&mut failed[*failure as usize], true));
        let found = node
            .module
            .errors
            .iter()
            .chain(broken.map(|(_, failure)| &graph.failures[*failure as usize]));
        errors.extend(found.map(|error| graph.traced(error.clone())));
        let certainly =
            node.bindings.iter().flatten().filter(|candidate| candidate.conditions.is_empty());
        open.extend(certainly.filter_map(|candidate| match candidate.target {
            PathTarget::Items { node, .. } => Some(node as usize),
            _ => None,
        }));
    }
    errors.sort_by_key(|error| error.labels.first().map(|label| label.span));
    errors.dedup();
    errors
}

//! Which file each item of a module goes to, and in which order.
//!
//! GLSL has one file for each stage, and a name must be declared before it is used. What only one
//! stage of a module reaches is in the file of that stage; what both reach, or other modules import,
//! is in a file that they include.

use std::collections::{BTreeMap, BTreeSet};

use lamplight_diagnostic::Diagnostic;

use super::facts::Facts;
use super::uses::item_uses;
use crate::condition::Condition;
use crate::tree::{Branch, Expression, ExpressionKind, Function, Item, ItemPath, Meaning, Module};
use crate::tree::{Node, Space, Stage, Type, whole_conditions};
use crate::types::Globals;
use crate::wesl::untranslated;

/// A file that is made from a module.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// What may be included.
    Shared,
    Stage(Stage),
}

/// The items of a module by the file that they go to, in an order in which names are declared before
/// they are used.
#[derive(Debug, Default)]
pub struct Places {
    pub parts: BTreeMap<Part, Vec<Node<Item>>>,
}

/// The names that other modules use of each module.
pub type Exports = BTreeMap<Vec<String>, BTreeSet<String>>;

/// Collects what modules use of each other.
pub fn exports_of(modules: &[Module]) -> Exports {
    let mut exports = Exports::new();
    for module in modules {
        for node in &module.items {
            item_uses(&node.body, &mut |path, _| {
                if path.module != module.path {
                    exports.entry(path.module.clone()).or_default().insert(path.name.clone());
                }
            });
        }
    }
    exports
}

/// Finds the places of a module's items.
pub fn place_items(
    module: &Module,
    facts: &Facts,
    exports: &Exports,
) -> Result<Places, Diagnostic> {
    let graph = Graph::of(module);
    let stages: Vec<(Stage, BTreeSet<&str>)> = module
        .items
        .iter()
        .filter_map(|node| match &node.body {
            Item::Function(function) => {
                function.stage.map(|stage| (stage, graph.reached([function.name.as_str()])))
            }
            _ => None,
        })
        .collect();
    let none = BTreeSet::new();
    let exported = exports.get(&module.path).unwrap_or(&none);
    let exported = graph.reached(exported.iter().map(String::as_str));
    let mut split: BTreeMap<Part, Vec<usize>> = BTreeMap::new();
    for (index, node) in module.items.iter().enumerate() {
        if is_dropped(module, &node.body, facts) {
            continue;
        }
        let part = part_of(&node.body, &stages, &exported);
        if part == Part::Shared && is_of_stage(&node.body, facts) {
            return Err(untranslated(node.span, "a function of several stages that takes theirs"));
        }
        split.entry(part).or_default().push(index);
    }
    let mut places = Places::default();
    for (part, indices) in split {
        places.parts.insert(part, graph.ordered(module, &indices));
    }
    Ok(places)
}

fn part_of(item: &Item, stages: &[(Stage, BTreeSet<&str>)], exported: &BTreeSet<&str>) -> Part {
    if let Item::Function(function) = item
        && let Some(stage) = function.stage
    {
        return Part::Stage(stage);
    }
    let name = item.name();
    let mut by = stages.iter().filter(|(_, reached)| reached.contains(name));
    match (exported.contains(name), by.next(), by.next()) {
        (false, Some((stage, _)), None) => Part::Stage(*stage),
        _ => Part::Shared,
    }
}

/// Whether an item has no declaration of its own in GLSL.
fn is_dropped(module: &Module, item: &Item, facts: &Facts) -> bool {
    match item {
        Item::Alias(..) => true,
        Item::Structure(structure) => {
            let path = ItemPath { module: module.path.clone(), name: structure.name.clone() };
            facts.is_stage_structure(&path) || facts.is_block(&path)
        }
        _ => false,
    }
}

/// Whether a function takes what a stage takes.
fn is_of_stage(item: &Item, facts: &Facts) -> bool {
    match item {
        Item::Function(function) => {
            function.parameters.iter().any(|node| facts.is_stage_type(&node.body.ty))
        }
        _ => false,
    }
}

/// The uses of a module's items among themselves.
struct Graph<'a> {
    uses: BTreeMap<&'a str, BTreeSet<&'a str>>,
}

impl<'a> Graph<'a> {
    fn of(module: &'a Module) -> Self {
        let names: BTreeSet<&str> = module.items.iter().map(|node| node.body.name()).collect();
        let mut uses: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
        for node in &module.items {
            let mut found = Vec::new();
            item_uses(&node.body, &mut |path, _| {
                if path.module == module.path {
                    found.extend(names.get(path.name.as_str()).copied());
                }
            });
            uses.entry(node.body.name()).or_default().extend(found);
        }
        Self { uses }
    }

    /// Names, and all that they use.
    fn reached<'n>(&self, names: impl IntoIterator<Item = &'n str>) -> BTreeSet<&'a str> {
        let mut found = BTreeSet::new();
        let mut work: Vec<&'a str> = Vec::new();
        for name in names {
            work.extend(self.uses.get_key_value(name).map(|(name, _)| *name));
        }
        while let Some(name) = work.pop() {
            if found.insert(name) {
                work.extend(self.uses.get(name).into_iter().flatten().copied());
            }
        }
        found
    }

    /// Some items in the order of the module, each behind what it uses.
    fn ordered(&self, module: &Module, indices: &[usize]) -> Vec<Node<Item>> {
        let units = units_of(module, indices);
        let mut by_name: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (number, unit) in units.iter().enumerate() {
            for node in unit {
                by_name.entry(node.body.name()).or_default().push(number);
            }
        }
        let mut done = vec![false; units.len()];
        let mut order = Vec::new();
        for number in 0..units.len() {
            self.visit(number, &units, &by_name, &mut done, &mut order);
        }
        order.into_iter().flat_map(|number| units[number].clone()).collect()
    }

    fn visit(
        &self,
        number: usize,
        units: &[Vec<Node<Item>>],
        by_name: &BTreeMap<&str, Vec<usize>>,
        done: &mut [bool],
        order: &mut Vec<usize>,
    ) {
        // An explicit stack: chains of uses may be as long as the module.
        let mut stack = vec![(number, false)];
        while let Some((number, is_left)) = stack.pop() {
            if is_left {
                order.push(number);
                continue;
            }
            if std::mem::replace(&mut done[number], true) {
                continue;
            }
            stack.push((number, true));
            let mut needed = BTreeSet::new();
            for node in &units[number] {
                for name in self.uses.get(node.body.name()).into_iter().flatten() {
                    needed.extend(by_name.get(name).into_iter().flatten().copied());
                }
            }
            let needed = needed.into_iter().rev().filter(|other| !done[*other]);
            stack.extend(needed.map(|other| (other, false)));
        }
    }
}

/// Items with the siblings that their conditions need. Siblings that are not all there get whole
/// conditions instead.
fn units_of(module: &Module, indices: &[usize]) -> Vec<Vec<Node<Item>>> {
    let conditions = whole_conditions(&module.items);
    let mut units: Vec<Vec<Node<Item>>> = Vec::new();
    let mut at = 0;
    while at < indices.len() {
        let first = indices[at];
        let chain = chain_from(module, first);
        let length = indices[at..].iter().take_while(|index| chain.contains(index)).count();
        let is_whole = length == chain.len();
        let mut unit = Vec::new();
        for index in &indices[at..at + length.max(1)] {
            let mut node = module.items[*index].clone();
            if !is_whole && node.branch.is_some() {
                node.branch = match conditions[*index].clone() {
                    Condition::Literal(true) => None,
                    condition => Some(Branch::If(condition)),
                };
            }
            match is_whole {
                true => unit.push(node),
                false => units.push(vec![node]),
            }
        }
        if !unit.is_empty() {
            units.push(unit);
        }
        at += length.max(1);
    }
    units
}

/// The siblings from an item on that belong to its `@if`.
fn chain_from(module: &Module, first: usize) -> Vec<usize> {
    let is_start = !matches!(module.items[first].branch, Some(Branch::Elif(_) | Branch::Else));
    let mut chain = vec![first];
    if !is_start {
        // The beginning is elsewhere: this one is no whole chain.
        chain.push(usize::MAX);
        return chain;
    }
    for (index, node) in module.items.iter().enumerate().skip(first + 1) {
        match node.branch {
            Some(Branch::Elif(_) | Branch::Else) => chain.push(index),
            _ => break,
        }
    }
    chain
}

/// The samplers that textures are read with.
pub type Samplers = BTreeMap<ItemPath, Sampler>;

/// A sampler of the module, and whether it compares.
#[derive(Debug, Clone)]
pub struct Sampler {
    pub path: ItemPath,
    pub compares: bool,
}

/// The textures of a module with samplers that exist wherever they do.
pub fn samplers_of(module: &Module, globals: &Globals) -> Samplers {
    let mut samplers = Samplers::new();
    for node in &module.items {
        let Item::Function(function) = &node.body else { continue };
        read_pairs(function, &mut |texture, sampler| {
            let (Meaning::Item(texture), Meaning::Item(path)) = (texture.meaning, sampler.meaning)
            else {
                return;
            };
            let exists = |condition: &Condition| {
                globals.items(path).iter().any(|one| condition.implies(&one.condition))
            };
            if globals.items(texture).iter().all(|one| exists(&one.condition)) {
                let compares = matches!(sampler.ty, Type::Sampler { compares: true });
                let found = Sampler { path: path.clone(), compares };
                samplers.entry(texture.clone()).or_insert(found);
            }
        });
    }
    samplers
}

/// The parameters that are samplers, by the parameters that are read with them.
pub type Pairs = BTreeMap<u32, (u32, bool)>;

/// The pairs of a function: what it reads together, or what stands together in its head.
pub fn parameter_samplers(function: &Function) -> Pairs {
    let mut pairs = Pairs::new();
    read_pairs(function, &mut |texture, sampler| {
        if let (Meaning::Local(texture), Meaning::Local(found)) = (texture.meaning, sampler.meaning)
            && let ([texture], [found]) = (texture.as_slice(), found.as_slice())
        {
            let compares = matches!(sampler.ty, Type::Sampler { compares: true });
            pairs.entry(*texture).or_insert((*found, compares));
        }
    });
    for pair in function.parameters.windows(2) {
        if let (Type::Texture(_), Type::Sampler { compares }) = (&pair[0].body.ty, &pair[1].body.ty)
        {
            let found = (pair[1].body.span.start, *compares);
            pairs.entry(pair[0].body.span.start).or_insert(found);
        }
    }
    pairs
}

/// A name in an expression.
struct Named<'a> {
    meaning: &'a Meaning,
    ty: &'a Type,
}

fn named(value: &Expression) -> Option<Named<'_>> {
    match &value.bare().kind {
        ExpressionKind::Name(_, meaning) => Some(Named { meaning, ty: &value.ty }),
        _ => None,
    }
}

/// Calls `visit` with each texture and the sampler that is an argument behind it.
fn read_pairs(function: &Function, visit: &mut dyn FnMut(Named<'_>, Named<'_>)) {
    super::visit::block_expressions(&function.body, &mut |value| {
        let ExpressionKind::Call { arguments, .. } = &value.kind else { return };
        for pair in arguments.windows(2) {
            if let (Some(texture), Some(sampler)) = (named(&pair[0].value), named(&pair[1].value))
                && let (Type::Texture(_), Type::Sampler { .. }) = (texture.ty, sampler.ty)
            {
                visit(texture, sampler);
            }
        }
    });
}

/// Whether a variable is one line, which may stand below another one without a blank line between.
pub fn is_short(item: &Item) -> bool {
    match item {
        Item::Variable(variable) => {
            !matches!(variable.space, Space::Uniform | Space::Storage { .. })
        }
        Item::Constant(_) => true,
        _ => false,
    }
}

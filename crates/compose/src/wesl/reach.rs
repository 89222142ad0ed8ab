//! Finds what a permutation keeps: from its roots along every use whose condition holds.

use std::collections::BTreeMap;

use super::evaluate::Evaluator;
use super::reached::{Dependency, Reached, ReferenceMeaning, Thing, name_of};
use crate::resolve::wesl::{Graph, ModuleNode, PLACES, PathTarget};
use crate::{Keep, Options};
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_files::limits::count_steps;
use lamplight_permute::Setting;
use lamplight_syntax::wesl::{Event, Item, ItemKind, Name, PlacedModule, UsedName};

/// Finds what is kept. Errors are added to those of the evaluator.
pub fn find_reached(graph: &Graph, evaluator: &mut Evaluator<'_>, options: &Options) -> Reached {
    let things = graph.totals.items as usize + graph.constants.len();
    let reached = Reached {
        things: vec![false; things],
        hidden: vec![false; things],
        nodes: vec![false; graph.nodes.len()],
        meanings: vec![ReferenceMeaning::Unknown; graph.totals.bindings as usize],
        order: graph.order.clone(),
        items: graph.totals.items,
        bases: graph.nodes.iter().map(|node| node.bases.items).collect(),
        constants: vec![None; graph.constants.len()],
        dependencies: Vec::new(),
        exposed: BTreeMap::new(),
        free: Vec::new(),
    };
    let (all, some) = (options.keep == Keep::All, matches!(options.keep, Keep::Items(_)));
    let mut walk = ReachWalk { graph, evaluator, all, some, reached, queue: Vec::new() };
    walk.node(0);
    walk.expose();
    match &options.keep {
        Keep::EntryPoints => walk.entry_points(),
        Keep::Items(names) => names.iter().for_each(|name| walk.named(name)),
        Keep::Root => walk.everything(),
        Keep::All => {}
    }
    while let Some((node, item)) = walk.queue.pop() {
        walk.follow(node, item);
    }
    walk.reached
}

struct ReachWalk<'a, 'b, 'c> {
    graph: &'a Graph,
    evaluator: &'c mut Evaluator<'b>,
    all: bool,
    /// Whether items were asked for by name. Then a name that is declared twice is an error only if
    /// something kept uses it.
    some: bool,
    reached: Reached,
    queue: Vec<(u32, u32)>,
}

impl ReachWalk<'_, '_, '_> {
    fn entry_points(&mut self) {
        let items = &self.graph.nodes[0].module.items;
        let mut any = false;
        for (index, _) in items.iter().enumerate().filter(|(_, item)| item.entry) {
            any |= self.item_if(0, index as u32);
        }
        for (_, thing) in self.passed() {
            if self.is_entry(thing) {
                self.keep(thing);
                any = true;
            }
        }
        if !any {
            self.everything();
        }
    }

    /// What the root module passes on by `public import`, with the names that it gives.
    fn passed(&mut self) -> Vec<(Name, Thing)> {
        let graph = self.graph;
        let mut found = Vec::new();
        for (alias, candidate) in &graph.nodes[0].passed {
            let PathTarget::Items { node, name } = candidate.target else { continue };
            if self.evaluator.all_hold(&candidate.conditions)
                && let Some(item) = self.chosen(node, name)
            {
                found.push((*alias, Thing::Item { node, item }));
            }
        }
        found
    }

    fn is_entry(&self, thing: Thing) -> bool {
        matches!(thing, Thing::Item { node, item }
            if self.graph.nodes[node as usize].module.items[item as usize].entry)
    }

    /// Gives what the host can choose, set or bind the names under which the root module passes it
    /// on.
    fn expose(&mut self) {
        let graph = self.graph;
        for (alias, thing) in self.passed() {
            let Thing::Item { node, item } = thing else { continue };
            let module = &graph.nodes[node as usize].module;
            let item = &module.items[item as usize];
            if !(item.entry || matches!(item.kind, ItemKind::Override | ItemKind::Var)) {
                continue;
            }
            let first = *self.reached.exposed.entry(self.reached.index(thing)).or_insert(alias);
            if first != alias {
                let [first, again] = [first, alias].map(|name| graph.names.text(name));
                let message = format!("the host would know one item as `{first}` and `{again}`");
                let place = module.span(item.name_range.clone());
                let error = Diagnostic::error(codes::NAME_CONFLICT, message);
                self.evaluator.errors.push(error.at(place, "passed on by two names"));
            }
        }
    }

    fn everything(&mut self) {
        for (_, thing) in self.passed() {
            self.keep(thing);
        }
        for index in 0..self.graph.nodes[0].module.items.len() as u32 {
            self.item_if(0, index);
            let name = self.graph.nodes[0].module.items[index as usize].name;
            // Of each name only one item may be left, whether anything uses it or not.
            if self.graph.nodes[0].sets.get(&name).is_some_and(|set| set.first() == Some(&index)) {
                self.chosen(0, name);
            }
        }
    }

    fn named(&mut self, name: &str) {
        let set = self.graph.names.find(name).and_then(|name| self.graph.nodes[0].sets.get(&name));
        let mut kept =
            set.is_some_and(|set| set.iter().fold(false, |any, item| self.item_if(0, *item) | any));
        for (alias, thing) in self.passed() {
            if self.graph.names.text(alias) == name {
                self.keep(thing);
                kept = true;
            }
        }
        if !kept {
            let root = &self.graph.nodes[0];
            let known = root.module.items.iter().map(|item| self.graph.names.text(item.name));
            let message = format!(
                "`{}` has no item `{name}`{}",
                root.label,
                if set.is_some() { " in this permutation" } else { "" }
            );
            let code = if set.is_some() { codes::DISABLED_ITEM } else { codes::MISSING_ITEM };
            let error = Diagnostic::error(code, message).about_item(name).suggest(name, known);
            self.evaluator.errors.push(error);
        }
    }

    /// Keeps an item if its condition holds. Returns whether it does.
    fn item_if(&mut self, node: u32, item: u32) -> bool {
        let condition = self.graph.nodes[node as usize].module.items[item as usize].condition;
        let holds = condition.is_none_or(|condition| self.evaluator.holds(node, condition));
        if holds {
            self.keep(Thing::Item { node, item });
        }
        holds
    }

    fn keep(&mut self, thing: Thing) {
        let index = self.reached.index(thing);
        if std::mem::replace(&mut self.reached.things[index], true) {
            return;
        }
        match thing {
            Thing::Item { node, item } => {
                self.queue.push((node, item));
                self.node(node);
            }
            Thing::Constant(index) => self.constant(index),
        }
    }

    fn constant(&mut self, index: u32) {
        let constant = &self.graph.constants[index as usize];
        if let Some(literal) = self.evaluator.given(constant.name) {
            self.reached.constants[index as usize] = Some(("const", format!(" = {literal}")));
            return;
        }
        let open = self.evaluator.open(constant.name);
        let Some(value) =
            open.clone().or_else(|| self.evaluator.number(constant.name, constant.span))
        else {
            return;
        };
        if let Setting::Name(value) = &value {
            let message = format!(
                "`{}` is an enum axis and has no constant",
                self.graph.names.text(constant.name)
            );
            let error = Diagnostic::error(codes::WRONG_KIND, message)
                .at(constant.span, format!("its value is `{value}`"));
            self.evaluator.errors.push(error.note("help: choose code with `@if(axis == value)`"));
        }
        self.reached.constants[index as usize] = Some(match (open, &value) {
            (None, value) => ("const", format!(" = {value}")),
            (Some(_), Setting::Bool(value)) => ("override", format!(": bool = {value}")),
            (Some(_), value) => ("override", format!(": i32 = {value}")),
        });
    }

    /// Makes an override a constant. It is used where WGSL takes no override, or where targets need
    /// its value: in the size of a workgroup, the length of an array, the default of another
    /// override. So each value of its axis has a text of its own.
    fn fix(&mut self, index: u32) {
        let constant = &self.graph.constants[index as usize];
        let kept = &self.reached.constants[index as usize];
        if kept.as_ref().is_some_and(|(keyword, _)| *keyword == "override")
            && let Some(value) = self.evaluator.number(constant.name, constant.span)
        {
            self.reached.constants[index as usize] = Some(("const", format!(" = {value}")));
        }
    }

    /// Called when something of a module is first kept: its `const_assert`s are kept too, and its
    /// errors count.
    fn node(&mut self, node: u32) {
        if std::mem::replace(&mut self.reached.nodes[node as usize], true) {
            return;
        }
        let graph = self.graph;
        let here = &graph.nodes[node as usize];
        self.evaluator.errors.extend(here.module.errors.iter().cloned());
        for (conditions, failure) in &here.broken_imports {
            if self.evaluator.all_hold(conditions) {
                self.evaluator.errors.push(graph.failures[*failure as usize].clone());
            }
        }
        for (condition, failure) in here.duplicates.iter().filter(|_| !self.some) {
            if condition.is_none_or(|condition| self.evaluator.holds(node, condition)) {
                self.evaluator.errors.push(graph.failures[*failure as usize].clone());
            }
        }
        for (index, item) in here.module.items.iter().enumerate() {
            if self.all || item.kind == ItemKind::ConstAssert {
                self.item_if(node, index as u32);
            }
        }
    }

    fn follow(&mut self, node: u32, index: u32) {
        let graph = self.graph;
        let module = &graph.nodes[node as usize].module;
        let item = &module.items[index as usize];
        let user = Thing::Item { node, item: index };
        let mut uses = Vec::new();
        self.evaluator.live(node, &item.events, |_, event| {
            if let Event::Use { reference, start, end, .. } = event {
                uses.push((reference, start..end));
            }
        });
        for (reference, range) in uses {
            let ReferenceMeaning::Thing(used) =
                self.meaning(node, reference, module.span(range.clone()))
            else {
                continue;
            };
            self.keep(used);
            // The attributes before a function's name, and its head, are outside of its body.
            if let Thing::Constant(constant) = used
                && (item.kind != ItemKind::Function || range.start < body_of(module, item))
            {
                self.fix(constant);
            }
            if item.kind != ItemKind::Function {
                self.reached.dependencies.push(Dependency {
                    user,
                    used,
                    span: module.span(range.clone()),
                });
            }
            let name = self.reached.name(graph, used);
            let written = &module.text[range.start as usize..range.end as usize];
            if item.locals.binary_search(&name).is_ok() && graph.names.text(name) != written {
                let index = self.reached.index(used);
                self.reached.hidden[index] = true;
            }
        }
    }

    fn meaning(&mut self, node: u32, reference: u32, span: Span) -> ReferenceMeaning {
        let index = (self.graph.nodes[node as usize].bases.bindings + reference) as usize;
        if let ReferenceMeaning::Unknown = self.reached.meanings[index] {
            self.reached.meanings[index] = self.find(node, reference, span);
        }
        self.reached.meanings[index]
    }

    fn find(&mut self, node: u32, reference: u32, span: Span) -> ReferenceMeaning {
        let graph = self.graph;
        let mut disabled = Vec::new();
        let mut brought = None;
        for candidate in &graph.nodes[node as usize].bindings[reference as usize] {
            count_steps(1);
            if !self.evaluator.all_hold(&candidate.conditions) {
                continue;
            }
            let thing = match candidate.target {
                PathTarget::Constant(index) => Thing::Constant(index),
                PathTarget::Failed(index) => {
                    self.evaluator.errors.push(graph.failures[index as usize].clone());
                    return ReferenceMeaning::Free;
                }
                PathTarget::Module => {
                    self.evaluator.errors.push(module_as_item(span));
                    return ReferenceMeaning::Free;
                }
                PathTarget::Items { node: other, name } => match self.chosen(other, name) {
                    Some(item) => self.shown(node, (other, item), span),
                    None => {
                        disabled.push((other, name));
                        continue;
                    }
                },
            };
            match brought {
                None if candidate.is_wildcard => brought = Some(thing),
                None => return ReferenceMeaning::Thing(thing),
                Some(first) if first == thing => {}
                Some(first) => {
                    let error = self.ambiguous([first, thing], span);
                    self.evaluator.errors.push(error);
                    return ReferenceMeaning::Free;
                }
            }
        }
        match brought {
            Some(thing) => ReferenceMeaning::Thing(thing),
            None => self.nothing(node, reference, span, &disabled),
        }
    }

    /// An item that is named in a module; with an error where the module cannot name it.
    fn shown(&mut self, node: u32, (other, item): (u32, u32), span: Span) -> Thing {
        let graph = self.graph;
        let [here, there] = [node, other].map(|node| &graph.nodes[node as usize]);
        let found = &there.module.items[item as usize];
        // What another module passes on is public itself.
        if there.module.says_visibility && !there.shows(found, here) {
            self.evaluator.errors.push(there.not_visible(&graph.names, found, span));
        }
        Thing::Item { node: other, item }
    }

    /// The error about a name that two wildcards bring.
    fn ambiguous(&self, things: [Thing; 2], span: Span) -> Diagnostic {
        let graph = self.graph;
        let name = graph.names.text(name_of(graph, things[0]));
        let message = format!("two wildcards bring a `{name}`, and they differ");
        let error = Diagnostic::error(codes::AMBIGUOUS_NAME, message).at(span, "used here");
        let error = things.iter().fold(error, |error, thing| match thing {
            Thing::Item { node, item } => {
                let module = &graph.nodes[*node as usize].module;
                let place = module.span(module.items[*item as usize].name_range.clone());
                error.at(place, "one of them")
            }
            Thing::Constant(_) => error,
        });
        error.note("help: import the one that is meant by its name")
    }

    /// The item of a name whose condition holds.
    fn chosen(&mut self, node: u32, name: Name) -> Option<u32> {
        let here = &self.graph.nodes[node as usize];
        let mut chosen = None;
        for index in here.sets.get(&name).into_iter().flatten() {
            let item = &here.module.items[*index as usize];
            count_steps(1);
            if !item.condition.is_none_or(|condition| self.evaluator.holds(node, condition)) {
                continue;
            }
            if let Some(first) = chosen {
                let error = here.declared_twice(&self.graph.names, *index as usize, first as usize);
                self.evaluator.errors.push(error);
                break;
            }
            chosen = Some(*index);
        }
        chosen
    }

    /// Handles a use without candidates: the name is predeclared, or the use is an error.
    fn nothing(
        &mut self,
        node: u32,
        reference: u32,
        span: Span,
        disabled: &[(u32, Name)],
    ) -> ReferenceMeaning {
        let graph = self.graph;
        let here = &graph.nodes[node as usize];
        let mut imports: &[usize] = &[];
        // In a module with wildcards, any name may be one that they bring.
        let is_open = here.bindings[reference as usize].is_empty();
        let text = match &here.module.references[reference as usize] {
            UsedName::Name(name)
                if is_open
                    || naga::keywords::wgsl::BUILTIN_IDENTIFIERS
                        .contains(&graph.names.text(*name)) =>
            {
                self.reached.free.push(*name);
                return ReferenceMeaning::Free;
            }
            UsedName::Name(name) => {
                imports = here.aliases.get(name).map_or(&[], Vec::as_slice);
                graph.names.text(*name)
            }
            UsedName::Path(path) => path.segments.last().map_or("", |name| graph.names.text(*name)),
        };
        let message = format!("`{text}` exists but is disabled by its condition");
        let mut error = Diagnostic::error(codes::DISABLED_ITEM, message).at(span, "used here");
        for (other, name) in disabled {
            error = at_disabled(error, &graph.nodes[*other as usize], *name);
        }
        for import in imports
            .iter()
            .map(|index| &here.module.imports[*index])
            .filter(|import| import.condition.is_some())
            .take(PLACES)
        {
            error = error
                .at(here.module.span(import.alias_range.clone()), "imported under a condition");
        }
        self.evaluator.errors.push(error);
        ReferenceMeaning::Free
    }
}

/// The error with the places of a module's items of a name.
fn at_disabled(error: Diagnostic, node: &ModuleNode, name: Name) -> Diagnostic {
    let items = node.sets.get(&name).into_iter().flatten().take(PLACES);
    let place = |item: &u32| {
        let item = &node.module.items[*item as usize];
        node.module.span(item.name_range.clone())
    };
    items.map(place).fold(error, |error, place| error.at(place, "not in this permutation"))
}

fn module_as_item(span: Span) -> Diagnostic {
    let message = "a module is not a value, a function or a type";
    Diagnostic::error(codes::NOT_AN_ITEM, message)
        .at(span, "a module")
        .note("help: name one of its items: `module::item`")
}

/// Where the body of a function begins. Nothing before it has braces but comments.
fn body_of(module: &PlacedModule, item: &Item) -> u32 {
    let start = item.name_range.end;
    let head = module.text.get(start as usize..item.range.end as usize).unwrap_or_default();
    start + head.find('{').unwrap_or(head.len()) as u32
}

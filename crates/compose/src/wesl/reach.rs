//! Finds what a permutation keeps: from its roots along every use whose condition holds.

use super::evaluate::Evaluator;
use super::reached::{Dependency, Reached, ReferenceMeaning, Thing, name_of};
use crate::resolve::wesl::{Graph, PLACES, PathTarget};
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
        free: Vec::new(),
    };
    let (all, some) = (options.keep == Keep::All, matches!(options.keep, Keep::Items(_)));
    let mut walk = ReachWalk { graph, evaluator, all, some, reached, queue: Vec::new() };
    walk.node(0);
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
        if !any {
            self.everything();
        }
    }

    fn everything(&mut self) {
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
        let kept =
            set.is_some_and(|set| set.iter().fold(false, |any, item| self.item_if(0, *item) | any));
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
            if self.evaluator.all_hold(node, conditions) {
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
            let name = name_of(graph, used);
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
        for candidate in &graph.nodes[node as usize].bindings[reference as usize] {
            count_steps(1);
            if !self.evaluator.all_hold(node, &candidate.conditions) {
                continue;
            }
            match candidate.target {
                PathTarget::Constant(index) => {
                    return ReferenceMeaning::Thing(Thing::Constant(index));
                }
                PathTarget::Failed(index) => {
                    self.evaluator.errors.push(graph.failures[index as usize].clone());
                    return ReferenceMeaning::Free;
                }
                PathTarget::Module => {
                    let error = Diagnostic::error(
                        codes::NOT_AN_ITEM,
                        "a module is not a value, a function or a type",
                    )
                    .at(span, "a module");
                    self.evaluator
                        .errors
                        .push(error.note("help: name one of its items: `module::item`"));
                    return ReferenceMeaning::Free;
                }
                PathTarget::Items { node: other, name } => match self.chosen(other, name) {
                    Some(item) => {
                        return ReferenceMeaning::Thing(Thing::Item { node: other, item });
                    }
                    None => disabled.push((other, name)),
                },
            }
        }
        self.nothing(node, reference, span, &disabled)
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
        let text = match &here.module.references[reference as usize] {
            UsedName::Name(name)
                if naga::keywords::wgsl::BUILTIN_IDENTIFIERS.contains(&graph.names.text(*name)) =>
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
            let module = &graph.nodes[*other as usize].module;
            let set = graph.nodes[*other as usize].sets.get(name);
            for item in set.into_iter().flatten().take(PLACES) {
                error = error.at(
                    module.span(module.items[*item as usize].name_range.clone()),
                    "not in this permutation",
                );
            }
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

/// Where the body of a function begins. Nothing before it has braces but comments.
fn body_of(module: &PlacedModule, item: &Item) -> u32 {
    let start = item.name_range.end;
    let head = module.text.get(start as usize..item.range.end as usize).unwrap_or_default();
    start + head.find('{').unwrap_or(head.len()) as u32
}

//! Writes the output: directives, numbers, imported modules by path, and the root module.

use std::ops::Range;

use super::evaluate::Evaluator;
use super::naming::ItemRenames;
use super::reached::{Reached, ReferenceMeaning, Thing};
use crate::resolve::wesl::Graph;
use crate::{Part, PartKind, Segment, SourceMap};
use lamplight_diagnostic::source::{LIMITS, Span};
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_syntax::wesl::{Directive, Event, Item, ItemKind, Name, PlacedModule};

/// Writes what is kept, with the map back and the declarations.
pub fn write_reached(
    graph: &Graph,
    reached: &Reached,
    names: &ItemRenames,
    evaluator: &mut Evaluator<'_>,
) -> (String, SourceMap, Vec<Part>) {
    let mut writer = Writer {
        graph,
        reached,
        names,
        text: String::with_capacity(16 << 10),
        map: SourceMap::default(),
        copied: None,
        parts: Vec::with_capacity(64),
        numbers: vec![u32::MAX; reached.len()],
    };
    writer.directives(evaluator);
    writer.constants();
    for node in reached.nodes() {
        writer.module(node, evaluator);
    }
    if writer.text.len() > LIMITS.expansion_bytes {
        let message = format!("the composed text has more than {} bytes", LIMITS.expansion_bytes);
        evaluator.errors.push(Diagnostic::error(codes::OUTPUT_TOO_LARGE, message));
    }
    let parts = writer.parts();
    (writer.text, writer.map, parts)
}

struct Writer<'a> {
    graph: &'a Graph,
    reached: &'a Reached,
    names: &'a ItemRenames,
    text: String,
    map: SourceMap,
    /// What was copied last, if nothing of the composer's own was written after it. After a rename
    /// it is a span that no copied text continues.
    copied: Option<Span>,
    /// What was written so far. Uses are indices into the tables over all things.
    parts: Vec<Part>,
    /// For each thing, its index among the parts.
    numbers: Vec<u32>,
}

impl Writer<'_> {
    /// Writes text of the composer's own.
    fn own(&mut self, text: &str) {
        if self.copied.take().is_some() || self.text.is_empty() {
            self.map.push(Segment { start: self.text.len() as u32, span: None, verbatim: false });
        }
        self.text.push_str(text);
    }

    fn copy(&mut self, module: &PlacedModule, range: Range<u32>) {
        if range.start >= range.end || self.text.len() > LIMITS.expansion_bytes {
            return;
        }
        let span = module.span(range);
        if self.copied.is_none_or(|last| last.source != span.source || last.end != span.start) {
            self.map.push(Segment {
                start: self.text.len() as u32,
                span: Some(span),
                verbatim: true,
            });
        }
        self.copied = Some(span);
        self.text.push_str(&module.text[span.range()]);
    }

    fn rename(&mut self, span: Span, name: &str) {
        self.map.push(Segment { start: self.text.len() as u32, span: Some(span), verbatim: false });
        self.copied = Some(Span { start: u32::MAX, end: u32::MAX, ..span });
        self.text.push_str(name);
    }

    /// Writes a blank line, except at the start.
    fn gap(&mut self) {
        if !self.text.is_empty() {
            self.own("\n");
        }
    }

    fn directives(&mut self, evaluator: &mut Evaluator<'_>) {
        let mut seen: Vec<(Name, Vec<Name>)> = Vec::new();
        let graph = self.graph;
        let nodes: Vec<u32> =
            std::iter::once(0).chain(self.reached.nodes().filter(|node| *node != 0)).collect();
        for node in nodes {
            let module = &graph.nodes[node as usize].module;
            for directive in &module.directives {
                let holds =
                    directive.condition.is_none_or(|condition| evaluator.holds(node, condition));
                if holds && is_new(&mut seen, directive) {
                    let start = self.text.len();
                    self.copy(module, directive.range.clone());
                    self.part(PartKind::Directive, Vec::new(), start);
                    self.own("\n");
                }
            }
        }
    }

    fn constants(&mut self) {
        let graph = self.graph;
        let mut kept: Vec<(&str, u32)> = (0..graph.constants.len() as u32)
            .filter(|index| self.reached.has(Thing::Constant(*index)))
            .map(|index| (graph.names.text(graph.constants[index as usize].name), index))
            .collect();
        kept.sort_unstable();
        if !kept.is_empty() {
            self.gap();
            self.own("// constants\n\n");
        }
        for (_, index) in kept {
            let thing = Thing::Constant(index);
            let name = self.names.text(graph, self.reached, thing);
            let Some((keyword, rest)) = &self.reached.constants[index as usize] else { continue };
            let line = format!("{keyword} {name}{rest};\n");
            let kind = if *keyword == "const" { PartKind::Constant } else { PartKind::Override };
            self.numbers[self.reached.index(thing)] = self.parts.len() as u32;
            let start = self.text.len();
            self.own(&line);
            self.part(kind, vec![name.to_owned()], start);
        }
    }

    fn module(&mut self, node: u32, evaluator: &mut Evaluator<'_>) {
        let here = &self.graph.nodes[node as usize];
        let items: Vec<u32> = self.reached.items(node, here.module.items.len()).collect();
        if items.is_empty() {
            return;
        }
        // The root module needs no banner where it is the only module.
        if node != 0 || !self.text.is_empty() {
            self.gap();
            self.own("// ");
            self.own(&here.label);
            self.own("\n\n");
        }
        let mut last: Option<u32> = None;
        for index in items {
            if last.is_some_and(|last| !are_adjacent(&here.module, last, index)) {
                self.own("\n");
            }
            self.item(node, index, evaluator);
            self.own("\n");
            last = Some(index);
        }
    }

    fn item(&mut self, node: u32, index: u32, evaluator: &mut Evaluator<'_>) {
        let graph = self.graph;
        let module = &graph.nodes[node as usize].module;
        let item = &module.items[index as usize];
        let own = Thing::Item { node, item: index };
        let (mut at, start_of_part) = (item.range.start, self.text.len());
        let (mut uses, mut aliases) = (Vec::new(), Vec::new());
        // An override with a value from outside is a constant. Its default is left out.
        let given = evaluator.given(item.name).filter(|_| item.kind == ItemKind::Override);
        let given = given.map(str::to_owned);
        let mut end = item.range.end;
        if given.is_some() {
            self.own("const ");
            (at, end) = (item.name_range.start, value_start(module, item));
        }
        evaluator.live(node, &item.events, |_, event| match event {
            Event::Cut { start, .. } | Event::Node { start, .. } | Event::Use { start, .. }
                if given.is_some() && !(at..end).contains(&start) => {}
            Event::Cut { start, end } | Event::Node { start, end, .. } => {
                self.copy(module, at..start);
                at = at.max(end);
            }
            Event::Definition { start, end } => self.name(module, own, &mut at, start..end),
            Event::Use { reference, start, end, .. } => {
                if let ReferenceMeaning::Thing(thing) = self.reached.meaning(graph, node, reference)
                {
                    uses.push(self.reached.index(thing) as u32);
                    let before = self.text.len() + start.saturating_sub(at) as usize;
                    self.name(module, thing, &mut at, start..end);
                    if self.is_alias(thing) {
                        let name = self.names.text(graph, self.reached, thing);
                        let range = before..before + name.len();
                        aliases.push((range, self.reached.index(thing) as u32));
                    }
                }
            }
        });
        self.copy(module, at..end);
        given.iter().for_each(|value| self.own(&format!(" = {value};")));
        self.numbers[self.reached.index(own)] = self.parts.len() as u32;
        let name = match item.kind {
            ItemKind::ConstAssert => Vec::new(),
            _ => vec![self.names.text(graph, self.reached, own).to_owned()],
        };
        let kind = if given.is_some() { PartKind::Constant } else { part_kind(item.kind) };
        self.part(kind, name, start_of_part);
        if let Some(part) = self.parts.last_mut() {
            (part.uses, part.aliases) = (uses, aliases);
        }
    }

    fn is_alias(&self, thing: Thing) -> bool {
        matches!(thing, Thing::Item { node, item }
            if self.graph.nodes[node as usize].module.items[item as usize].kind == ItemKind::Alias)
    }

    fn part(&mut self, kind: PartKind, names: Vec<String>, start: usize) {
        let range = start..self.text.len();
        self.parts.push(Part { kind, names, range, uses: Vec::new(), aliases: Vec::new() });
    }

    /// The parts, with their uses as indices of parts, which are known once everything is written.
    fn parts(&mut self) -> Vec<Part> {
        let mut parts = std::mem::take(&mut self.parts);
        for part in &mut parts {
            part.uses.iter_mut().for_each(|thing| *thing = self.numbers[*thing as usize]);
            part.uses.sort_unstable();
            part.uses.dedup();
            part.aliases.iter_mut().for_each(|(_, thing)| *thing = self.numbers[*thing as usize]);
        }
        parts
    }

    /// Writes a name. Where it does not change, it is copied together with the text around it.
    fn name(&mut self, module: &PlacedModule, thing: Thing, at: &mut u32, range: Range<u32>) {
        let names = self.names;
        let name = names.text(self.graph, self.reached, thing);
        if &module.text[range.start as usize..range.end as usize] != name {
            self.copy(module, *at..range.start);
            self.rename(module.span(range.clone()), name);
            *at = range.end;
        }
    }
}

/// Where the default of an override begins, with the `=` and the blanks before it; or else the
/// semicolon.
fn value_start(module: &PlacedModule, item: &Item) -> u32 {
    let start = item.name_range.end;
    let rest = module.text.get(start as usize..item.range.end as usize).unwrap_or_default();
    let before = &rest[..rest.find(['=', ';']).unwrap_or(rest.len())];
    start + before.trim_end().len() as u32
}

fn part_kind(kind: ItemKind) -> PartKind {
    match kind {
        ItemKind::Function => PartKind::Function,
        ItemKind::Struct => PartKind::Struct,
        ItemKind::Const => PartKind::Constant,
        ItemKind::Override => PartKind::Override,
        ItemKind::Var => PartKind::Variable,
        ItemKind::Alias => PartKind::Alias,
        ItemKind::ConstAssert => PartKind::Assertion,
    }
}

/// Whether a directive says something that no earlier one said.
fn is_new(seen: &mut Vec<(Name, Vec<Name>)>, directive: &Directive) -> bool {
    let known = match directive.keyword {
        Name::DIAGNOSTIC => seen
            .iter()
            .any(|(keyword, names)| *keyword == directive.keyword && *names == directive.names),
        keyword => {
            let enabled = |name: &Name| {
                seen.iter().any(|(known, names)| *known == keyword && names.contains(name))
            };
            directive.names.iter().all(enabled)
        }
    };
    if !known {
        seen.push((directive.keyword, directive.names.clone()));
    }
    !known
}

/// Whether there is no blank line between two items in the author's text, or in what stands between
/// them.
fn are_adjacent(module: &PlacedModule, last: u32, next: u32) -> bool {
    module.items[last as usize..=next as usize].windows(2).all(|pair| {
        let gap = &module.text[pair[0].range.end as usize..pair[1].range.start as usize];
        gap.matches('\n').count() <= 1
    })
}

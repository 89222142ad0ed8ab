//! Members of structs in WESL. The type of the expression before the dot is not known, so a name
//! means each member of this name: in the structs that the module names, or else in all.

use std::collections::BTreeSet;
use std::ops::Range;

use super::package::PackageModules;
use super::place::word_at_byte;
use lamplight_compose::resolve::wesl::ModuleNode;
use lamplight_diagnostic::source::Span;
use lamplight_syntax::wesl::blank::without_comments;
use lamplight_syntax::wesl::{Item, ItemKind};
use lamplight_syntax::words::{LexemeKind, pieces};

/// A member with its struct.
pub struct StructMember<'m> {
    pub node: &'m ModuleNode,
    pub item: &'m Item,
    /// The place of its name.
    pub place: Span,
    /// The name with its type.
    pub text: &'m str,
}

/// The members that a name after a dot may mean, with the place of the name.
pub fn members_at(
    modules: &PackageModules,
    node: u32,
    byte: usize,
) -> Option<(Span, Vec<StructMember<'_>>)> {
    let module = &modules.graph.nodes[node as usize].module;
    let word = word_at_byte(&module.text, byte);
    let name = module.text.get(word.clone()).filter(|name| !name.is_empty())?;
    if !module.text[..word.start].trim_end().ends_with('.') || is_swizzle(name) {
        return None;
    }
    let symbols = modules.places_in(node).filter_map(|(symbol, _)| modules.item(symbol));
    let mut found: Vec<StructMember<'_>> =
        symbols.flat_map(|(node, item)| named_members(node, item, name)).collect();
    if found.is_empty() {
        let nodes = modules.graph.nodes.iter();
        let items = nodes.flat_map(|node| node.module.items.iter().map(move |item| (node, item)));
        found = items.flat_map(|(node, item)| named_members(node, item, name)).collect();
    }
    let mut known = BTreeSet::new();
    found.retain(|member| known.insert(member.place));
    Some((module.span(word.start as u32..word.end as u32), found))
}

/// Whether a name is a swizzle.
fn is_swizzle(name: &str) -> bool {
    let of = |letters: &str| name.chars().all(|letter| letters.contains(letter));
    name.len() <= 4 && (of("xyzw") || of("rgba"))
}

fn named_members<'m>(node: &'m ModuleNode, item: &'m Item, name: &str) -> Vec<StructMember<'m>> {
    if item.kind != ItemKind::Struct {
        return Vec::new();
    }
    let member = |(range, whole): (Range<u32>, Range<u32>)| StructMember {
        node,
        item,
        place: node.module.span(range),
        text: &node.module.text[whole.start as usize..whole.end as usize],
    };
    let declared = declared_members(&node.module.text, item);
    declared.into_iter().filter(|(range, _)| node_text(node, range) == name).map(member).collect()
}

fn node_text<'m>(node: &'m ModuleNode, range: &Range<u32>) -> &'m str {
    &node.module.text[range.start as usize..range.end as usize]
}

/// For each member of a struct: the range of its name, and the range of its name with its type.
fn declared_members(text: &str, item: &Item) -> Vec<(Range<u32>, Range<u32>)> {
    let start = item.name_range.end as usize;
    let body = without_comments(&text[start..item.range.end as usize]);
    let mut found: Vec<(Range<u32>, Range<u32>)> = Vec::new();
    let (mut nested, mut last, mut is_type) = (0_i32, None, false);
    for piece in pieces(&body).filter(|piece| piece.kind != LexemeKind::Blank) {
        let at = |byte: usize| (start + byte) as u32;
        match piece.text {
            "(" | "<" | "[" => nested += 1,
            ")" | ">" | "]" => nested -= 1,
            "," | "}" if nested == 0 => is_type = false,
            ":" if nested == 0 => {
                let name: Option<Range<u32>> = last.take();
                found.extend(name.map(|name| (name.clone(), name)));
                is_type = true;
                continue;
            }
            _ => {}
        }
        if is_type && let Some((_, whole)) = found.last_mut() {
            whole.end = at(piece.end());
        }
        last = (piece.kind == LexemeKind::Word).then(|| at(piece.at)..at(piece.end()));
    }
    found
}

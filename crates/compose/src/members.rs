//! Renames the variables and constants of a GLSL text that have the name of a block's member.
//!
//! The members of a block with an instance name are reached through that name alone, so a constant
//! may be called as one of them. naga's front end declares such members as variables of the module
//! all the same, and of two declarations with one name the later one wins. So a constant before the
//! block would be read from the block.

use std::collections::{BTreeMap, BTreeSet};

use super::{Composed, Part, PartKind};
use lamplight_bundle::Language;
use lamplight_syntax::words::{LexemeKind, has_word, pieces, words};

/// The text with such variables and constants renamed in every place. Members keep their names,
/// since engines see them.
pub fn rename_like_members(composed: Composed) -> Composed {
    if composed.language != Language::Glsl {
        return composed;
    }
    let names = new_names(&composed);
    if names.is_empty() { composed } else { renamed_members(&composed, &names) }
}

/// The new name of each variable and constant that needs one.
fn new_names(composed: &Composed) -> BTreeMap<String, String> {
    let blocks = composed.parts.iter().filter(|part| is_block(composed, part));
    let members: BTreeSet<&str> = blocks.flat_map(|block| members(composed, block)).collect();
    let is_plain = |part: &&Part| {
        matches!(part.kind, PartKind::Variable | PartKind::Constant) && !is_block(composed, part)
    };
    let names = composed.parts.iter().filter(is_plain).flat_map(|part| &part.names);
    let alike: Vec<&String> = names.filter(|name| members.contains(name.as_str())).collect();
    if alike.is_empty() {
        return BTreeMap::new();
    }
    let taken: BTreeSet<&str> = words(&composed.text).map(|word| word.text).collect();
    let mut names: BTreeMap<String, String> = BTreeMap::new();
    for name in alike {
        let mut numbered = (1..u32::MAX).map(|number| format!("{name}_{number}"));
        let is_free = |new: &String| {
            !taken.contains(new.as_str()) && names.values().all(|known| known != new)
        };
        if let Some(new) = numbered.find(is_free) {
            names.insert(name.clone(), new);
        }
    }
    names
}

/// Whether a part is a GLSL interface block with an instance name. Such a block declares only that
/// name in the global scope, not its members.
fn is_block(composed: &Composed, part: &Part) -> bool {
    let text = &composed.text[part.range.clone()];
    let behind = text.rsplit_once('}').map_or("", |(_, behind)| behind);
    part.kind == PartKind::Variable && words(behind).next().is_some()
}

/// The words between a block's braces, but those within brackets, which are lengths of arrays.
/// Types are among them, and no variable has the name of a type.
fn members<'c>(composed: &'c Composed, block: &Part) -> impl Iterator<Item = &'c str> {
    let text = &composed.text[block.range.clone()];
    let open = text.find('{').map_or(text.len(), |at| at + 1);
    let close = text.rfind('}').unwrap_or(text.len());
    let mut brackets = Brackets::default();
    pieces(text.get(open..close).unwrap_or_default()).filter_map(move |piece| {
        let is_outside = brackets.is_outside(piece.text);
        (is_outside && piece.kind == LexemeKind::Word).then_some(piece.text)
    })
}

/// Follows the pieces of a text, and counts the `[` that are open.
#[derive(Default)]
struct Brackets(u32);

impl Brackets {
    /// Takes the next piece. Returns whether no bracket is open after it.
    fn is_outside(&mut self, piece: &str) -> bool {
        match piece {
            "[" => self.0 += 1,
            "]" => self.0 = self.0.saturating_sub(1),
            _ => {}
        }
        self.0 == 0
    }
}

fn renamed_members(composed: &Composed, names: &BTreeMap<String, String>) -> Composed {
    let mut text = String::with_capacity(composed.text.len());
    let mut parts = Vec::with_capacity(composed.parts.len());
    let mut end = 0;
    for part in &composed.parts {
        text.push_str(&composed.text[end..part.range.start]);
        end = part.range.end;
        let start = text.len();
        let declares_members = part.kind == PartKind::Struct || is_block(composed, part);
        append_renamed(&composed.text[part.range.clone()], names, declares_members, &mut text);
        let new = |name: &String| names.get(name).unwrap_or(name).clone();
        let own = part.names.iter().map(new).collect();
        let mut uses = part.uses.clone();
        if declares_members {
            uses.retain(|used| is_named(&text[start..], &composed.parts[*used as usize], names));
        }
        parts.push(Part { names: own, range: start..text.len(), uses, ..part.clone() });
    }
    text.push_str(&composed.text[end..]);
    Composed { text, parts, ..composed.clone() }
}

/// Whether a renamed declaration of members names a part. The composer takes a member for a use of
/// the variable that has its name.
fn is_named(text: &str, part: &Part, names: &BTreeMap<String, String>) -> bool {
    part.names.iter().all(|name| names.get(name).is_none_or(|new| has_word(text, new)))
}

/// Appends a part. Names behind a point are members. So are those of a structure or block, except
/// within brackets, where the length of an array stands. A qualifier of a layout is no name either,
/// but what it is set to may be one.
fn append_renamed(
    text: &str,
    names: &BTreeMap<String, String>,
    declares_members: bool,
    out: &mut String,
) {
    let (mut before, mut brackets, mut in_layout) = (' ', Brackets::default(), false);
    for piece in pieces(text) {
        match piece.text {
            "layout" => in_layout = true,
            ")" => in_layout = false,
            _ => {}
        }
        let is_outside = brackets.is_outside(piece.text);
        let is_member =
            before == '.' || declares_members && is_outside || in_layout && before != '=';
        let new = names.get(piece.text).filter(|_| piece.kind == LexemeKind::Word && !is_member);
        out.push_str(new.map_or(piece.text, String::as_str));
        if piece.kind != LexemeKind::Blank {
            before = piece.text.chars().next_back().unwrap_or(' ');
        }
    }
}

//! Numbers bindings for each target, by fixed schemes.

use naga::ResourceBinding;

use super::reflect::{binding_count, binding_kind, used_globals};
use super::{EmitSource, immediates};
use lamplight_bundle::{BindingKind, BindingSlot, Native};

/// How a target numbers bindings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Numbering {
    /// Group and binding as the author wrote them.
    Author,
    /// `16 * group + binding`, one number.
    Explicit,
    /// Buffers, textures and samplers each from 0, in the order of group and binding.
    PerKind,
    /// None: by name only.
    Named,
}

/// [`Numbering::Explicit`] has numbers only for groups and bindings below this.
pub const EXPLICIT_LIMIT: u32 = 16;

/// A used binding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct UsedBinding {
    /// Group and binding.
    pub place: ResourceBinding,
    /// What is bound; the elements' kind, for an array of bindings.
    pub kind: BindingKind,
    /// How many bindings an array of them has; 0 if the host decides it.
    pub count: Option<u32>,
}

/// Every used binding, sorted, with its number in the target.
pub fn assign_slots(
    source: &EmitSource<'_>,
    numbering: Numbering,
) -> Vec<(UsedBinding, Option<u32>)> {
    let globals = used_globals(source.module, source.info.get_entry_point(source.index));
    let mut found: Vec<UsedBinding> = globals
        .filter_map(|(_, variable)| {
            let kind = binding_kind(source.module, variable)?;
            let count = binding_count(source.module, variable.ty);
            Some(UsedBinding { place: immediates::place(variable)?, kind, count })
        })
        .collect();
    found.sort();
    let mut next = [0; 3];
    found
        .into_iter()
        .map(|used| match used.kind {
            // Where immediates are no buffer, they have no number.
            BindingKind::Immediate => (used, None),
            _ => (used, slot_number(numbering, used.place, &mut next[slot_table(used)])),
        })
        .collect()
}

/// The reflection of a target without combined samplers.
pub fn native_reflection(source: &EmitSource<'_>, entry: &str, numbering: Numbering) -> Native {
    let slots = assign_slots(source, numbering)
        .into_iter()
        .map(|(UsedBinding { place, kind: _, count: _ }, index)| BindingSlot {
            group: place.group,
            binding: place.binding,
            space: index.filter(|_| numbering == Numbering::Author).map(|_| place.group),
            index,
            register: None,
            name: None,
        })
        .collect();
    Native { entry_name: entry.to_owned(), slots, ..Native::default() }
}

fn slot_number(numbering: Numbering, binding: ResourceBinding, next: &mut u32) -> Option<u32> {
    match numbering {
        Numbering::Author => Some(binding.binding),
        Numbering::Explicit => (binding.group < EXPLICIT_LIMIT && binding.binding < EXPLICIT_LIMIT)
            .then(|| EXPLICIT_LIMIT * binding.group + binding.binding),
        Numbering::PerKind => {
            *next += 1;
            Some(*next - 1)
        }
        Numbering::Named => None,
    }
}

/// The table of a target that counts by kind. Metal has arrays of bindings in argument buffers.
fn slot_table(used: UsedBinding) -> usize {
    match used.kind {
        _ if used.count.is_some() => 0,
        BindingKind::Uniform | BindingKind::Storage | BindingKind::Immediate => 0,
        BindingKind::Texture | BindingKind::StorageTexture => 1,
        BindingKind::Sampler | BindingKind::ComparisonSampler => 2,
    }
}

//! Numbers bindings for each target, by fixed schemes.

use naga::ResourceBinding;

use super::EmitSource;
use super::reflect::{binding_kind, used_globals};
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

/// Every used binding, sorted, with its kind and its number in the target.
pub fn assign_slots(
    source: &EmitSource<'_>,
    numbering: Numbering,
) -> Vec<(ResourceBinding, BindingKind, Option<u32>)> {
    let globals = used_globals(source.module, source.info.get_entry_point(source.index));
    let mut found: Vec<(ResourceBinding, BindingKind)> = globals
        .filter_map(|(_, variable)| {
            Some((variable.binding?, binding_kind(source.module, variable)?))
        })
        .collect();
    found.sort();
    let mut next = [0; 3];
    found
        .into_iter()
        .map(|(binding, kind)| {
            (binding, kind, slot_number(numbering, binding, &mut next[slot_table(kind)]))
        })
        .collect()
}

/// The reflection of a target without combined samplers.
pub fn native_reflection(source: &EmitSource<'_>, entry: &str, numbering: Numbering) -> Native {
    let slots = assign_slots(source, numbering)
        .into_iter()
        .map(|(binding, _, index)| BindingSlot {
            group: binding.group,
            binding: binding.binding,
            space: (numbering == Numbering::Author).then_some(binding.group),
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

fn slot_table(kind: BindingKind) -> usize {
    match kind {
        BindingKind::Uniform | BindingKind::Storage => 0,
        BindingKind::Texture | BindingKind::StorageTexture => 1,
        BindingKind::Sampler | BindingKind::ComparisonSampler => 2,
    }
}

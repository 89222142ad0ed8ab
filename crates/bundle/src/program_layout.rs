//! The layout of a program: what all of its permutations together bind, so that an engine makes one
//! pipeline layout for all of them, or a few.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use super::key;
use super::loader::constants;
use super::{
    Axis, Binding, BindingKind, Constant, Error, Reflection, SampleType, Stage, TextureShape,
};

/// A binding that some permutations of a program have.
///
/// Where permutations differ, the largest buffer counts, with its members; and a texture that one
/// permutation filters is one that can be filtered. If two permutations bind different kinds of
/// things in one place, each is an entry of the layout.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LayoutBinding {
    /// What is bound.
    #[serde(flatten)]
    pub binding: Binding,
    /// The stages that use it in some permutation, sorted.
    pub stages: BTreeSet<Stage>,
    /// For each axis that decides about it: the values with which some permutation has it.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub when: BTreeMap<String, BTreeSet<String>>,
}

/// Where a binding is, and what cannot be one binding for two permutations.
type Slot = (u32, u32, BindingKind, Option<(String, bool, Option<String>)>);

/// The values of each axis, in the order of the axes, one bit for each.
type Seen = Vec<Vec<bool>>;

/// One entry point: each of its reflections, with the keys that have it.
#[derive(Default)]
pub(super) struct EntryKeys<'a> {
    pub reflections: Vec<(&'a Reflection, Vec<&'a str>)>,
}

impl<'a> EntryKeys<'a> {
    /// Groups the keys of an entry point by the address of their reflection, in the order of the
    /// keys.
    pub fn new(keys: impl Iterator<Item = (&'a str, &'a Reflection)>) -> Self {
        let mut places: BTreeMap<*const Reflection, usize> = BTreeMap::new();
        let mut reflections: Vec<(&Reflection, Vec<&str>)> = Vec::new();
        for (key, reflection) in keys {
            let place = *places.entry(std::ptr::from_ref(reflection)).or_insert(reflections.len());
            match reflections.get_mut(place) {
                Some((_, known)) => known.push(key),
                None => reflections.push((reflection, vec![key])),
            }
        }
        Self { reflections }
    }

    /// The constants of each key that chooses some.
    pub fn constants(&self, axes: &[Axis]) -> Result<BTreeMap<&'a str, Vec<Constant>>, Error> {
        let mut found = BTreeMap::new();
        for (reflection, keys) in &self.reflections {
            for key in keys {
                let constants = constants(axes, key, reflection)?;
                if constants.is_empty() {
                    break;
                }
                found.insert(*key, constants);
            }
        }
        Ok(found)
    }
}

/// The union of the bindings of all entry points in one language, by group and binding.
pub(super) fn program_layout(axes: &[Axis], entries: &[EntryKeys<'_>]) -> Vec<LayoutBinding> {
    let mut found: BTreeMap<Slot, LayoutBinding> = BTreeMap::new();
    let mut seen: BTreeMap<Slot, Seen> = BTreeMap::new();
    let mut all = nothing_seen(axes);
    for (reflection, keys) in entries.iter().flat_map(|entry| &entry.reflections) {
        let values = values_seen(axes, keys);
        merge_seen(&mut all, &values);
        for binding in &reflection.bindings {
            let slot = slot_of(binding);
            merge_seen(seen.entry(slot.clone()).or_insert_with(|| nothing_seen(axes)), &values);
            add_binding(found.entry(slot), binding, reflection.stage);
        }
    }
    for (slot, entry) in &mut found {
        entry.when = deciding_values(axes, &all, &seen[slot]);
    }
    found.into_values().collect()
}

fn slot_of(binding: &Binding) -> Slot {
    let texture = binding.texture.as_ref().map(|texture| {
        // Of sampled textures, the class decides: filtering does not.
        let class = texture.sample_type.map(|sample| match sample {
            SampleType::UnfilterableFloat | SampleType::Float => "float".to_owned(),
            SampleType::Depth => "depth".to_owned(),
            SampleType::Sint => "sint".to_owned(),
            SampleType::Uint => "uint".to_owned(),
        });
        (texture.dimension.clone(), texture.multisampled, class.or_else(|| texture.format.clone()))
    });
    (binding.group, binding.binding, binding.kind, texture)
}

fn add_binding(place: Entry<'_, Slot, LayoutBinding>, binding: &Binding, stage: Stage) {
    match place {
        Entry::Vacant(place) => drop(place.insert(LayoutBinding {
            binding: binding.clone(),
            stages: BTreeSet::from([stage]),
            when: BTreeMap::new(),
        })),
        Entry::Occupied(place) => {
            let known = place.into_mut();
            known.stages.insert(stage);
            widen_binding(&mut known.binding, binding);
        }
    }
}

fn widen_binding(known: &mut Binding, other: &Binding) {
    if other.size > known.size {
        let (writable, count, texture) = (known.writable, known.count, known.texture.take());
        *known = Binding { writable, count, texture, ..other.clone() };
    }
    known.count = known.count.max(other.count);
    known.writable |= other.writable;
    if let (Some(known), Some(other)) = (&mut known.texture, &other.texture) {
        widen_texture(known, other);
    }
}

fn widen_texture(known: &mut TextureShape, other: &TextureShape) {
    if other.sample_type == Some(SampleType::Float) {
        known.sample_type = other.sample_type;
    }
    if known.access != other.access {
        known.access = known.access.map(|_| super::Access::ReadWrite);
    }
}

fn nothing_seen(axes: &[Axis]) -> Seen {
    axes.iter().map(|axis| vec![false; axis.values.len()]).collect()
}

fn merge_seen(into: &mut Seen, from: &Seen) {
    let pairs = into.iter_mut().flatten().zip(from.iter().flatten());
    pairs.for_each(|(into, from)| *into |= from);
}

fn values_seen(axes: &[Axis], keys: &[&str]) -> Seen {
    let mut seen = nothing_seen(axes);
    for key in keys {
        for (axis, seen) in axes.iter().zip(&mut seen) {
            let value = key::value(key, axis);
            let at = axis.values.iter().position(|known| known == value);
            if let Some(place) = at.and_then(|at| seen.get_mut(at)) {
                *place = true;
            }
        }
    }
    seen
}

/// The axes with values that occur, but never with the binding; each with the values that do.
fn deciding_values(axes: &[Axis], all: &Seen, with: &Seen) -> BTreeMap<String, BTreeSet<String>> {
    let decides = axes.iter().zip(all.iter().zip(with)).filter(|(_, (all, with))| all != with);
    decides
        .map(|(axis, (_, with))| {
            let values = axis.values.iter().zip(with).filter(|(_, with)| **with);
            (axis.name.clone(), values.map(|(value, _)| value.clone()).collect())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes() -> Vec<Axis> {
        let axis = |name: &str, values: &[&str]| Axis {
            name: name.to_owned(),
            values: values.iter().map(|value| (*value).to_owned()).collect(),
            default: values[0].to_owned(),
            mode: "static".to_owned(),
        };
        vec![axis("shadow", &["none", "hard"]), axis("fog", &["false", "true"])]
    }

    fn buffer(binding: u32, size: u32) -> Binding {
        Binding {
            group: 0,
            binding,
            name: format!("buffer_{binding}"),
            kind: BindingKind::Uniform,
            ty: format!("Block{size}"),
            count: None,
            size: Some(size),
            writable: false,
            shape: None,
            texture: None,
            members: Vec::new(),
        }
    }

    fn texture(sample_type: SampleType, dimension: &str) -> Binding {
        let texture = TextureShape {
            dimension: dimension.to_owned(),
            multisampled: false,
            sample_type: Some(sample_type),
            format: None,
            access: None,
        };
        let kind = BindingKind::Texture;
        Binding { kind, size: None, texture: Some(texture), ..buffer(1, 0) }
    }

    fn with(stage: Stage, bindings: Vec<Binding>) -> Reflection {
        Reflection { bindings, ..Reflection::of(stage) }
    }

    #[test]
    fn the_union_has_the_largest_of_each() {
        let plain = with(Stage::Vertex, vec![buffer(0, 16)]);
        let shadowed = with(
            Stage::Fragment,
            vec![buffer(0, 48), texture(SampleType::UnfilterableFloat, "2d")],
        );
        let filtered = with(Stage::Fragment, vec![texture(SampleType::Float, "2d")]);
        let entries = [
            EntryKeys { reflections: vec![(&plain, vec!["default", "fog", "shadow=hard"])] },
            EntryKeys {
                reflections: vec![(&shadowed, vec!["shadow=hard"]), (&filtered, vec!["fog"])],
            },
        ];
        let layout = program_layout(&axes(), &entries);
        assert_eq!(layout.len(), 2);
        assert_eq!(layout[0].binding, buffer(0, 48));
        assert_eq!(layout[0].stages, BTreeSet::from([Stage::Vertex, Stage::Fragment]));
        assert!(layout[0].when.is_empty());
        assert_eq!(layout[1].binding, texture(SampleType::Float, "2d"));
        assert!(layout[1].when.is_empty(), "each value occurs with it: {:?}", layout[1].when);
    }

    /// The size of one permutation, and the number of bindings of the other.
    #[test]
    fn sizes_and_counts_are_apart() {
        let many = with(Stage::Vertex, vec![Binding { count: Some(4), ..buffer(0, 16) }]);
        let large = with(Stage::Vertex, vec![Binding { count: Some(2), ..buffer(0, 32) }]);
        for reflections in [[&many, &large], [&large, &many]] {
            let reflections =
                vec![(reflections[0], vec!["default"]), (reflections[1], vec!["fog"])];
            let layout = program_layout(&axes(), &[EntryKeys { reflections }]);
            let binding = &layout[0].binding;
            assert_eq!((binding.size, binding.count), (Some(32), Some(4)));
        }
    }

    #[test]
    fn axes_that_decide_are_named() {
        let bare = with(Stage::Fragment, Vec::new());
        let full = with(Stage::Fragment, vec![buffer(0, 16)]);
        let reflections =
            vec![(&bare, vec!["default", "fog"]), (&full, vec!["shadow=hard", "fog,shadow=hard"])];
        let layout = program_layout(&axes(), &[EntryKeys { reflections }]);
        let when = BTreeMap::from([("shadow".to_owned(), BTreeSet::from(["hard".to_owned()]))]);
        assert_eq!(layout[0].when, when);
    }

    #[test]
    fn different_things_in_one_place_are_apart() {
        let flat = with(Stage::Fragment, vec![texture(SampleType::Float, "2d")]);
        let cube = with(Stage::Fragment, vec![texture(SampleType::Float, "cube")]);
        let reflections = vec![(&flat, vec!["default"]), (&cube, vec!["fog"])];
        assert_eq!(program_layout(&axes(), &[EntryKeys { reflections }]).len(), 2);
    }
}

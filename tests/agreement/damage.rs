//! Ways to damage what a bundle says of an output.

use std::sync::Arc;

use lamplight::bundle::{Binding, BindingKind, Member, Native, Reflection, Shape, Stage, Target};
use lamplight::validators::Output;

/// One way: it returns whether there is what it damages.
pub struct Damage {
    pub name: &'static str,
    damage: fn(&mut Reflection, &mut Native) -> bool,
    /// Whether the language of an output does not say it.
    hidden: fn(&Output) -> bool,
}

impl Damage {
    /// The output with another description.
    pub fn of(&self, output: &Output) -> Option<Output> {
        let (mut reflection, mut native) = ((*output.reflection).clone(), (*output.native).clone());
        let (stage, file) = (output.stage.name(), output.file.display());
        (self.damage)(&mut reflection, &mut native).then(|| Output {
            reflection: Arc::new(reflection),
            native: Arc::new(native),
            description: format!("another {} of {stage} in {} {file}", self.name, output.target),
            ..output.clone()
        })
    }

    pub fn is_hidden(&self, output: &Output) -> bool {
        (self.hidden)(output)
    }
}

fn never(_: &Output) -> bool {
    false
}

/// Buffers of bytes: HLSL has their layout in functions.
fn in_hlsl(output: &Output) -> bool {
    output.target == Target::HLSL
}

fn is_glsl(output: &Output) -> bool {
    [Target::GLSL330, Target::GLSL450, Target::ESSL300].contains(&output.target)
}

/// Hosts of Metal choose it.
fn in_msl(output: &Output) -> bool {
    output.target == Target::MSL
}

fn named<'r>(reflection: &'r mut Reflection, name: &str) -> Option<&'r mut Binding> {
    reflection.bindings.iter_mut().find(|one| one.name == name)
}

fn lamp(reflection: &mut Reflection) -> Option<&mut Binding> {
    named(reflection, "lamp")
}

fn items(reflection: &mut Reflection) -> Option<&mut Binding> {
    named(reflection, "items")
}

/// Changes the member of that name.
fn change(binding: Option<&mut Binding>, name: &str, change: fn(&mut Member)) -> bool {
    let member = binding.and_then(|one| one.members.iter_mut().find(|one| one.name == name));
    member.map(change).is_some()
}

/// Changes a member of a member.
fn change_inner(
    binding: Option<&mut Binding>,
    name: &str,
    inner: &str,
    change: fn(&mut Member),
) -> bool {
    let member = binding.and_then(|one| one.members.iter_mut().find(|one| one.name == name));
    let inner = member.and_then(|one| one.members.iter_mut().find(|one| one.name == inner));
    inner.map(change).is_some()
}

fn change_shape(member: &mut Member, change: fn(&mut Shape)) {
    member.shape.iter_mut().for_each(change);
}

pub const DAMAGES: &[Damage] = &[
    Damage {
        name: "offset",
        damage: |reflection, _| change(lamp(reflection), "last", |one| one.offset += 8),
        hidden: never,
    },
    Damage {
        name: "larger offset",
        damage: |reflection, _| change(lamp(reflection), "last", |one| one.offset += 16),
        hidden: never,
    },
    Damage {
        name: "offset in an element",
        damage: |reflection, _| {
            change_inner(lamp(reflection), "weights", "level", |one| one.offset += 4)
        },
        hidden: never,
    },
    Damage {
        name: "offset in storage",
        damage: |reflection, _| change(items(reflection), "first", |one| one.offset -= 4),
        hidden: in_hlsl,
    },
    Damage {
        name: "stride",
        damage: |reflection, _| change(lamp(reflection), "turns", |one| one.stride = Some(80)),
        hidden: never,
    },
    Damage {
        name: "stride of structures",
        damage: |reflection, _| change(lamp(reflection), "weights", |one| one.stride = Some(68)),
        hidden: never,
    },
    Damage {
        name: "stride in storage",
        damage: |reflection, _| change(items(reflection), "all", |one| one.stride = Some(48)),
        hidden: in_hlsl,
    },
    Damage {
        name: "stride without an array",
        damage: |reflection, _| change(lamp(reflection), "power", |one| one.stride = Some(4)),
        hidden: never,
    },
    Damage {
        name: "matrix stride",
        damage: |reflection, _| {
            change(lamp(reflection), "near", |one| {
                change_shape(one, |shape| shape.matrix_stride = Some(12));
            })
        },
        hidden: never,
    },
    Damage {
        name: "matrix stride in storage",
        damage: |reflection, _| {
            change_inner(items(reflection), "all", "turn", |one| {
                change_shape(one, |shape| shape.matrix_stride = Some(16));
            })
        },
        hidden: in_hlsl,
    },
    Damage {
        name: "number of columns",
        damage: |reflection, _| {
            change(lamp(reflection), "far", |one| {
                change_shape(one, |shape| shape.columns = Some(3))
            })
        },
        hidden: never,
    },
    Damage {
        name: "number of elements",
        damage: |reflection, _| {
            change(lamp(reflection), "turns", |one| {
                change_shape(one, |shape| shape.count = Some(3))
            })
        },
        hidden: never,
    },
    Damage {
        name: "scalar type",
        damage: |reflection, _| {
            change(lamp(reflection), "moved", |one| {
                change_shape(one, |shape| shape.scalar = Some("u32".to_owned()));
            })
        },
        hidden: never,
    },
    Damage {
        name: "size of a member",
        damage: |reflection, _| change(lamp(reflection), "turns", |one| one.size += 16),
        hidden: never,
    },
    Damage {
        name: "smaller size of a buffer",
        damage: |reflection, _| {
            let size = lamp(reflection).and_then(|one| one.size.as_mut());
            size.map(|size| *size -= 64).is_some()
        },
        hidden: never,
    },
    Damage {
        name: "larger size of a buffer",
        damage: |reflection, _| {
            let size = lamp(reflection).and_then(|one| one.size.as_mut());
            size.map(|size| *size += 64).is_some()
        },
        // SPIR-V says where members begin, not what is behind the last one, and GLSL is read as it.
        hidden: |output| output.target == Target::SPIRV || is_glsl(output),
    },
    Damage {
        name: "missing member",
        damage: |reflection, _| lamp(reflection).and_then(|one| one.members.pop()).is_some(),
        hidden: never,
    },
    Damage {
        name: "binding",
        damage: |reflection, native| {
            let number = |binding: &mut u32| *binding += 1;
            let slot = native.slots.iter_mut().find(|one| (one.group, one.binding) == (0, 3));
            let Some(slot) = slot else { return false };
            slot.index.as_mut().map(number);
            if slot.index.is_none() {
                slot.name = Some("Another".to_owned());
            }
            lamp(reflection).is_some()
        },
        hidden: never,
    },
    Damage {
        name: "missing binding",
        damage: |reflection, native| {
            let is_lamp = |one: &Binding| [one.group, one.binding] == [0, 3];
            let before = reflection.bindings.len();
            reflection.bindings.retain(|one| !is_lamp(one));
            native.slots.retain(|one| [one.group, one.binding] != [0, 3]);
            reflection.bindings.len() < before
        },
        hidden: never,
    },
    Damage {
        name: "place of a texture",
        damage: |reflection, native| {
            if named(reflection, "image").is_none() {
                return false;
            }
            let slot = native.slots.iter_mut().find(|one| (one.group, one.binding) == (0, 1));
            let Some(slot) = slot else { return false };
            match &mut slot.index {
                Some(index) => *index += 1,
                None => native.combined.iter_mut().for_each(|one| one.name += "_other"),
            }
            true
        },
        hidden: never,
    },
    Damage {
        name: "place of a sampler",
        damage: |_, native| {
            let is_sampler = |group: u32, binding: u32| [group, binding] == [1, 5];
            let slots = native.slots.iter_mut().filter(|one| is_sampler(one.group, one.binding));
            let heaps = native.sampler_heaps.iter_mut().flat_map(|heap| &mut heap.samplers);
            let indices = slots.filter_map(|one| one.index.as_mut());
            indices.chain(heaps.map(|one| &mut one.element)).map(|index| *index += 1).count() > 0
        },
        hidden: never,
    },
    Damage {
        name: "kind",
        damage: |reflection, _| {
            lamp(reflection).map(|one| one.kind = BindingKind::Storage).is_some()
        },
        hidden: never,
    },
    Damage {
        name: "dimension",
        damage: |reflection, _| {
            let mut textures =
                reflection.bindings.iter_mut().filter_map(|one| one.texture.as_mut());
            textures.next().map(|one| one.dimension = "3d".to_owned()).is_some()
        },
        hidden: never,
    },
    Damage {
        name: "size of a workgroup",
        damage: |reflection, _| {
            reflection.workgroup_size.as_mut().map(|size| size[1] = 8).is_some()
        },
        hidden: in_msl,
    },
    Damage {
        name: "entry point",
        damage: |_, native| {
            native.entry_name += "_other";
            true
        },
        hidden: never,
    },
    Damage {
        name: "stage",
        damage: |reflection, _| {
            reflection.stage = match reflection.stage {
                Stage::Vertex => Stage::Fragment,
                Stage::Fragment | Stage::Compute => Stage::Vertex,
            };
            true
        },
        // A text in GLSL or HLSL is of the stage that it is compiled for, but for workgroups.
        hidden: |output| {
            (in_hlsl(output) || is_glsl(output)) && output.reflection.workgroup_size.is_none()
        },
    },
    Damage {
        name: "semantic",
        damage: |_, native| native.semantics.iter_mut().map(|one| one.index += 7).count() > 0,
        hidden: never,
    },
];

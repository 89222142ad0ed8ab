//! What somebody can change in a picture: where its lamps are, and the numbers of its uniforms.

use std::cell::OnceCell;
use std::collections::BTreeSet;

use glam::{DMat4, DVec3};

use super::Shot;
use super::light::LightView;
use super::mesh::vertex_attributes;
use super::passes::{Lit, stage_bindings};
use super::plan::{Pass, Plan, known_program};
use super::values::{PassCamera, UniformValues, eye_projection, follows};
use crate::frame::{BufferLeaf, Programs, buffer_leaves};
use lamplight_bundle::BindingKind;
use lamplight_diagnostic::Diagnostics;
use lamplight_scenes::sets::LampKind;

/// Everything that can be changed, as [`Changes`](super::Changes) take it.
#[derive(Debug, Clone)]
pub struct Controls {
    /// From world space to the clip space of the picture.
    pub clip_from_world: DMat4,
    /// The lamps that shine, or whose shadow falls.
    pub lamps: Vec<LampControl>,
    /// The numbers of all passes, each once.
    pub uniforms: Vec<Uniform>,
}

#[derive(Debug, Clone, Copy)]
pub struct LampControl {
    /// Its index in the scene.
    pub index: usize,
    /// What it is in this permutation.
    pub kind: LampKind,
    /// In world space.
    pub position: DVec3,
}

/// A scalar or a vector of a uniform buffer.
#[derive(Debug, Clone)]
pub struct Uniform {
    /// The program that reads it.
    pub program: String,
    /// Such as `lamps.lights[2].color`.
    pub path: String,
    /// Type in WGSL.
    pub ty: String,
    /// Its numbers in the picture. Where each object has its own, those of the first object.
    pub numbers: Vec<f64>,
}

/// What can be changed in the picture of a plan. Matrices, and numbers that must agree with
/// them or with textures, follow from the scene and cannot.
///
/// # Errors
/// Those of compositions.
pub fn picture_controls(
    programs: &Programs,
    plan: &Plan,
    shot: &Shot,
) -> Result<Controls, Diagnostics> {
    let Lit { scene, key, lit, size, .. } = Lit::of(plan, shot)?;
    let eye = eye_projection(&scene.eye, shot);
    let light = LightView::new(&scene, &key, plan, lit, size, eye);
    let values = UniformValues {
        plan,
        scene: &scene,
        lit,
        light: &light,
        shot,
        clusters: OnceCell::new(),
        probes: OnceCell::new(),
    };
    let shining = values.lamps().unwrap_or(usize::from(lit.needs.caster.is_some()));
    let lamps = scene.lamps.iter().enumerate().take(shining).map(|(index, lamp)| LampControl {
        index,
        kind: values.kind(index, lamp),
        position: lamp.position,
    });
    let clip_from_world = PassCamera::of_viewer(&scene.eye, shot).clip_from_world;
    let mut uniforms = Vec::new();
    let mut known = BTreeSet::new();
    for pass in plan.passes.iter().rev() {
        for uniform in pass_uniforms(programs, pass, &values)? {
            if known.insert(uniform.path.clone()) {
                uniforms.push(uniform);
            }
        }
    }
    Ok(Controls { clip_from_world, lamps: lamps.collect(), uniforms })
}

fn pass_uniforms(
    programs: &Programs,
    pass: &Pass,
    values: &UniformValues<'_>,
) -> Result<Vec<Uniform>, Diagnostics> {
    let program = known_program(programs, &pass.program)?;
    let stages = programs.stages(program, &pass.settings, values.shot.language)?;
    let has_objects = !vertex_attributes(&stages.vertex.reflection).is_empty();
    let object = values.scene.objects.first().filter(|_| has_objects);
    let numbers = |path: &str| match object {
        Some(object) => values.object(object, path),
        None => values.number(path),
    };
    let bindings = stage_bindings(&stages);
    let blocks = bindings.iter().filter(|binding| binding.kind == BindingKind::Uniform);
    let leaves = blocks.flat_map(buffer_leaves);
    let leaves = leaves.filter(|leaf| !leaf.ty.starts_with("mat") && !follows(&leaf.path));
    let uniform = |leaf: BufferLeaf<'_>| {
        // Arrays end with zeros that no lamp or object reads.
        let numbers = numbers(&leaf.path).filter(|numbers| !numbers.is_empty())?;
        let (program, ty) = (pass.program.clone(), leaf.ty.to_owned());
        Some(Uniform { program, path: leaf.path, ty, numbers })
    };
    Ok(leaves.filter_map(uniform).collect())
}

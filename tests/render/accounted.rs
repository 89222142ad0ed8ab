//! Every number that a preset's picture depends on comes from the preset's source, or is marked as
//! one that the source leaves open.

use std::collections::BTreeSet;

use lamplight::bundle::Language;
use lamplight::catalogue::preset::Preset;
use lamplight::picture::Pass;
use lamplight::picture::frame::Stages;
use lamplight::scene::sets::LampKind;
use libtest_mimic::{Failed, Trial};
use naga::proc::TypeResolution;
use naga::{Expression, Function, Module, TypeInner};

use super::{library, plan, rendered};

/// Structures of uniforms, the group of a preset's numbers for each, and fields that describe the
/// scene, which a source does not give. `Cascades`, `Clusters`, `Probes` and `Room` are not among
/// them: their numbers must agree with maps and lists that are made of the scene.
const STRUCTURES: &[(&str, &str, &[&str])] = &[
    ("Object", "object", &["world_from_object", "normal_from_object"]),
    ("Lamp", "light", &["light", "half_vector"]),
    ("Light", "light", &["kind", "shadow_layer"]),
    ("Area", "area", &[]),
    ("Profile", "profile", &["uv_from_world", "right", "share", "scale", "offset"]),
    ("Material", "material", &[]),
    ("Layers", "layers", &["sky_levels"]),
    ("Surroundings", "surroundings", &["sh"]),
    ("Haze", "haze", &[]),
    ("Caster", "caster", &["clip_from_world", "light", "texel", "near", "far"]),
    ("Moments", "moments", &[]),
    ("Display", "display", &[]),
    ("March", "march", &[]),
    ("Horizon", "horizon", &[]),
    ("Lobe", "lobe", &["world_from_clip"]),
];

/// The numbers with which the shadow map of a spot light is drawn.
const FRUSTUM: &[&str] = &["fov", "near", "far"];
/// The numbers that avoid shadow acne when the map is drawn.
const BIAS: &[&str] = &["polygon_offset", "cull_front"];

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("render/numbers_are_accounted_for", all_accounted),
        Trial::test("render/a_missing_number_is_noticed", missing_is_noticed),
    ]
}

/// The numbers that the passes of a preset read, as group and field.
fn numbers_read(preset: &Preset) -> Result<BTreeSet<(&'static str, String)>, String> {
    let (library, plan) = (library(), plan(preset)?);
    let mut found = BTreeSet::new();
    for pass in &plan.passes {
        let program = library.programs.manifest().program(&pass.program).ok_or("no program")?;
        let stages = library.programs.stages(program, &pass.settings, Language::Wesl);
        let Stages { vertex, fragment } = stages.map_err(rendered)?;
        for composed in [Some(vertex), fragment].into_iter().flatten() {
            read_by(&composed.validated, &mut found);
        }
    }
    // A pass with depths as the viewer sees them is not a shadow map.
    let last = plan.last().ok_or("no pass")?;
    let before = plan.passes.len() - 1 - last.needs.seen_before();
    let is_map = |pass: &Pass| ["depth", "moments"].contains(&&*pass.program);
    let has_map = plan.passes[..before].iter().any(is_map);
    let is_of_spot = last.needs.caster.is_none_or(|kind| kind == LampKind::Spot);
    let has_moments = plan.passes.iter().any(|pass| pass.program == "moments");
    let of_map = BIAS.iter().filter(|_| has_map && !has_moments);
    let of_spot = FRUSTUM.iter().filter(|_| has_map && is_of_spot);
    found.extend(of_map.chain(of_spot).map(|field| ("depth_pass", (*field).to_owned())));
    Ok(found)
}

/// Adds the fields of the structures that a function of the module reads one by one.
fn read_by(
    validated: &lamplight::validate::Validated,
    found: &mut BTreeSet<(&'static str, String)>,
) {
    let module = &validated.module;
    for (handle, function) in module.functions.iter() {
        fields(module, function, &validated.info[handle], found);
    }
    for (index, point) in module.entry_points.iter().enumerate() {
        fields(module, &point.function, validated.info.get_entry_point(index), found);
    }
}

fn fields(
    module: &Module,
    function: &Function,
    info: &naga::valid::FunctionInfo,
    found: &mut BTreeSet<(&'static str, String)>,
) {
    for (_, expression) in function.expressions.iter() {
        let Expression::AccessIndex { base, index } = *expression else { continue };
        let ty = match &info[base].ty {
            TypeResolution::Handle(ty) => match module.types[*ty].inner {
                TypeInner::Pointer { base, .. } => base,
                _ => *ty,
            },
            TypeResolution::Value(TypeInner::Pointer { base, .. }) => *base,
            TypeResolution::Value(_) => continue,
        };
        let TypeInner::Struct { members, .. } = &module.types[ty].inner else { continue };
        let name = module.types[ty].name.as_deref().unwrap_or_default();
        let known = STRUCTURES.iter().find(|(structure, _, _)| *structure == name);
        let field = members[index as usize].name.as_deref().unwrap_or_default();
        if let Some((_, group, _)) = known.filter(|(_, _, not)| !not.contains(&field)) {
            found.insert((group, field.to_owned()));
        }
    }
}

/// The numbers that are read and neither given nor open, and those that are open and not read.
fn unaccounted(preset: &Preset) -> Result<(Vec<String>, Vec<String>), String> {
    let read = numbers_read(preset)?;
    let is_given = |group: &str, field: &String| {
        preset.numbers.get(group).is_some_and(|fields| fields.contains_key(field))
    };
    let is_open = |group: &str, field: &str| preset.open.contains(&format!("{group}.{field}"));
    let missing =
        read.iter().filter(|(group, field)| !is_given(group, field) && !is_open(group, field));
    let missing = missing.map(|(group, field)| format!("{group}.{field}")).collect();
    let read: BTreeSet<String> =
        read.iter().map(|(group, field)| format!("{group}.{field}")).collect();
    let unread = preset.open.difference(&read).cloned().collect();
    Ok((missing, unread))
}

fn all_accounted() -> Result<(), Failed> {
    let mut wrong = String::new();
    for preset in &library().presets {
        let (missing, unread) = unaccounted(preset)?;
        if !missing.is_empty() {
            wrong += &format!("{}: neither given nor open: {missing:?}\n", preset.name);
        }
        if !unread.is_empty() {
            wrong += &format!("{}: marked as open, but not read: {unread:?}\n", preset.name);
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.into()) }
}

/// The check notices a preset without a number or a mark, and a mark that is not needed.
fn missing_is_noticed() -> Result<(), Failed> {
    let known = library().presets.iter().find(|preset| preset.name == "hpg_5_shadow");
    let mut preset = known.ok_or("no such preset")?.clone();
    preset.numbers.remove("caster");
    preset.open.remove("light.position");
    preset.open.insert("haze.density".to_owned());
    let (missing, unread) = unaccounted(&preset)?;
    match (
        missing.contains(&"caster.min_w".to_owned()),
        missing.contains(&"light.position".to_owned()),
    ) {
        (true, true) if unread == ["haze.density"] => Ok(()),
        _ => Err(format!(
            "expected caster.min_w and light.position to be missing, found {missing:?}; \
             expected haze.density to be unread, found {unread:?}"
        )
        .into()),
    }
}

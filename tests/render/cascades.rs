//! Compares shadows of cascades with rays from fragments to the light.

use glam::DVec3;
use lamplight::picture::PreparedPass;
use lamplight::scene::Surfaces;
use lamplight::scene::sets;

use super::closed_forms::Form;
use super::frames::{Bench, Fragment, Numbers, uniform};
use super::shadows::{Casters, DIRECTIONAL, TOWARDS, Way, casters, visibility};

pub const FORMS: &[(&str, Form)] = &[
    ("cascades", cascades),
    ("cascades_in_one_map", parts_of_a_map),
    ("cascades_reach_the_farthest", farthest_shadow),
];

/// The width and the height of a frame, in pixels.
const SIZE: u32 = 128;

/// With cascades, each part of the viewer's depth has a map of its own, and the nearest is finer
/// than one map of the whole scene. In each part, every fragment is lit or dark as its ray says.
/// Together the parts give the picture.
fn cascades(bench: &Bench<'_>) -> Result<(), String> {
    let (casters, towards) = (casters()?, TOWARDS.normalize());
    let axis = (-towards).to_array();
    let numbers: Numbers<'_> = &[("light", "axis", &axis), ("light", "color", &[1.0; 3])];
    let plan = bench.plan(&format!("{DIRECTIONAL},shadow=hard"), "casters", numbers)?;
    let single = bench.prepared(&plan, SIZE)?;
    let nearest = bench.cascaded(&plan, SIZE, 3)?;
    let slices: Vec<&PreparedPass> = std::iter::once(&nearest).chain(&nearest.farther).collect();
    let mut fragments = 0;
    for slice in &slices {
        let margin = 3.0 * texel(slice)?;
        let seen = bench.fragments_of(slice, SIZE)?;
        fragments += seen.len();
        check_slice(&casters, &seen, towards, |_| margin)?;
    }
    let (fine, coarse, whole) =
        (texel(&nearest)?, texel(&single)?, bench.fragments_of(&single, SIZE)?.len());
    if slices.len() != 3 || fine > 0.8 * coarse || fragments < whole {
        return Err(format!(
            "{} cascades, expected 3; texels of {fine}, {coarse} with one map; {fragments} \
             fragments of {whole}",
            slices.len()
        ));
    }
    compare_pictures(bench, &nearest, &single)
}

fn texel(prepared: &PreparedPass) -> Result<f64, &'static str> {
    uniform(prepared, "caster", "texel").ok_or("no texel")
}

/// Fails unless fragments that face the light are lit exactly if the ray to the light is clear.
fn check_slice(
    casters: &Casters,
    seen: &[Fragment],
    towards: DVec3,
    margin: impl Fn(&Fragment) -> f64,
) -> Result<(), String> {
    let (mut counts, mut wrong) = ([0, 0], 0);
    for fragment in seen.iter().filter(|fragment| fragment.normal.dot(towards) > 0.25) {
        let wanted = match casters.way(fragment, towards, margin(fragment)) {
            Way::Unclear => continue,
            Way::Clear => 1,
            Way::Blocked => 0,
        };
        counts[wanted] += 1;
        wrong += usize::from((visibility(fragment, towards) - wanted as f64).abs() > 0.01);
    }
    if wrong > 0 || counts[1] < 100 {
        return Err(format!("of {counts:?} dark and lit fragments of a cascade {wrong} are wrong"));
    }
    Ok(())
}

/// Fails unless the picture with cascades is that with one map, apart from the borders of shadows.
fn compare_pictures(
    bench: &Bench<'_>,
    nearest: &PreparedPass,
    single: &PreparedPass,
) -> Result<(), String> {
    let (parts, one) = (bench.photograph(nearest, SIZE)?, bench.photograph(single, SIZE)?);
    let (mut drawn, mut apart) = (0, 0);
    for index in 0..SIZE * SIZE {
        let (x, y) = (index % SIZE, index / SIZE);
        let (part, one) = (parts.drawn(x, y), one.drawn(x, y));
        drawn += usize::from(one.is_some());
        let is_alike = part
            .zip(one)
            .map_or(part.is_none() && one.is_none(), |(part, one)| part.distance(one) < 0.01);
        apart += usize::from(!is_alike);
    }
    if 25 * apart > drawn {
        Err(format!("{apart} of {drawn} pixels differ from one map's, at most 4 % may"))
    } else {
        Ok(())
    }
}

/// With a map in four parts, every fragment is lit or dark as its ray says, also where a part fades
/// into the next one. Nearby the map is finer than one of the whole scene, and several parts are
/// seen.
fn parts_of_a_map(bench: &Bench<'_>) -> Result<(), String> {
    let (casters, towards) = (casters()?, TOWARDS.normalize());
    let axis = (-towards).to_array();
    let numbers: Numbers<'_> = &[("light", "axis", &axis), ("light", "color", &[1.0; 3])];
    let drawn = |key: &str| {
        let plan = bench.plan(&format!("{DIRECTIONAL},shadow=hard{key}"), "casters", numbers)?;
        bench.prepared(&plan, SIZE)
    };
    let (single, parted) = (drawn("")?, drawn(",cascades")?);
    let parts = |field| uniforms::<4>(&parted, "cascades", field).ok_or("no cascades");
    let (splits, texels) = (parts("splits")?, parts("texels")?);
    let view = sets::scene("casters").ok_or("no casters")?.eye.view();
    let part = |fragment: &Fragment| {
        let depth = -view.transform_point3(fragment.position).z;
        splits.iter().take(3).filter(|split| depth >= **split).count()
    };
    let seen = bench.fragments_of(&parted, SIZE)?;
    check_slice(&casters, &seen, towards, |fragment| 3.0 * texels[(part(fragment) + 1).min(3)])?;
    let counts = [0, 1, 2, 3].map(|index| seen.iter().filter(|one| part(one) == index).count());
    let coarse = texel(&single)?;
    let parts_seen = counts.iter().filter(|count| **count > 500).count();
    if texels[0] > 0.6 * coarse || !texels.is_sorted() || parts_seen < 3 {
        return Err(format!("texels of {texels:?}, {coarse} with one map; {counts:?} fragments"));
    }
    compare_pictures(bench, &parted, &single)
}

/// The surfaces that are farthest from the viewer receive the whole shadow: here, on the wall at
/// the back.
fn farthest_shadow(bench: &Bench<'_>) -> Result<(), String> {
    let scene = sets::scene("room").ok_or("no room")?;
    let (surfaces, towards) = (Surfaces::of(&scene), DVec3::new(0.4, 0.3, 1.0).normalize());
    let axis = (-towards).to_array();
    let numbers: Numbers<'_> = &[("light", "axis", &axis), ("light", "color", &[1.0; 3])];
    let plan = bench.plan(&format!("{DIRECTIONAL},shadow=hard,cascades"), "room", numbers)?;
    let prepared = bench.prepared(&plan, SIZE)?;
    let texels = uniforms::<4>(&prepared, "cascades", "texels").ok_or("no cascades")?;
    let view = scene.eye.view();
    let depth = |fragment: &Fragment| -view.transform_point3(fragment.position).z;
    let mut seen = bench.fragments_of(&prepared, SIZE)?;
    let farthest = seen.iter().map(depth).fold(0.0, f64::max);
    seen.retain(|fragment| depth(fragment) > 0.98 * farthest);
    let (mut dark, mut wrong) = (0, 0);
    for fragment in seen.iter().filter(|fragment| fragment.normal.dot(towards) > 0.25) {
        let from = fragment.position + 1e-3 * fragment.normal;
        let (side, up) = fragment.normal.any_orthonormal_pair();
        let around = [side, -side, up, -up].map(|one| from + 3.0 * texels[3] * one);
        let is_blocked = |from: DVec3| !surfaces.is_clear(from, from + 100.0 * towards);
        if around.iter().all(|from| is_blocked(*from)) {
            dark += 1;
            wrong += usize::from(visibility(fragment, towards) > 0.01);
        }
    }
    if dark < 100 || wrong > 0 {
        let all = seen.len();
        return Err(format!("of {all} fragments at the back {dark} are dark, {wrong} are lit"));
    }
    Ok(())
}

/// The numbers of a vector in a uniform block.
fn uniforms<const N: usize>(prepared: &PreparedPass, block: &str, field: &str) -> Option<[f64; N]> {
    let stage = prepared.stages.fragment.as_ref()?;
    let binding = stage.reflection.bindings.iter().find(|binding| binding.name == block)?;
    let member = binding.members.iter().find(|member| member.name == field)?;
    let bytes = prepared.buffers.get(&(binding.group, binding.binding))?;
    let words = bytes.get(member.offset as usize..)?.as_chunks::<4>().0;
    let words: &[[u8; 4]; N] = words.get(..N)?.try_into().ok()?;
    Some(words.map(|word| f64::from(f32::from_le_bytes(word))))
}

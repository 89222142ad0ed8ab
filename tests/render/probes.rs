//! Fields of light probes in whole frames: what is drawn is what the host computes, and no light comes
//! through walls.

use std::sync::Arc;

use glam::DVec3;
use lamplight::execute::fixture::{Fixture, FixtureTexture};
use lamplight::scene::sets::{self, Probes, Scene};
use lamplight::scene::{ProbeField, ProbeGrid, Surfaces};

use super::closed_forms::Form;
use super::frames::{Bench, Fragment};

pub const FORMS: &[(&str, Form)] = &[
    ("probes_of_the_host", same_field),
    ("probes_leak_nothing", no_leaks),
    ("probes_see_what_was_changed", follow_changes),
];

/// The width and the height of a frame, in pixels.
const SIZE: u32 = 128;
const KEY: &str = "ambient=ddgi,lights=spot,max_lights=1,specular=none";

fn halls() -> Result<Scene, String> {
    sets::scene("halls").ok_or_else(|| "no halls".to_owned())
}

/// With a wall that glows and a lamp that is off, every fragment has the light that the field of the
/// host has there.
fn same_field(bench: &Bench<'_>) -> Result<(), String> {
    let mut scene = halls()?;
    scene.objects[2].material.emission = DVec3::new(0.9, 0.3, 0.2);
    let points = scene.points();
    let low = points.iter().copied().reduce(DVec3::min).ok_or("no points")?;
    let high = points.iter().copied().reduce(DVec3::max).ok_or("no points")?;
    let probes = scene.probes.unwrap_or_default();
    let grid = ProbeGrid::within(low, high, probes.counts);
    let surfaces = Surfaces::of(&scene);
    let field = ProbeField::new(grid, &surfaces, &|_, _| DVec3::ZERO, probes.beyond);
    let mut plan = bench.plan(
        KEY,
        "halls",
        &[("light", "color", &[0.0; 3]), ("light", "ambient", &[0.0; 3])],
    )?;
    plan.model = Some(Arc::new(scene));
    let (mut seen, mut largest) = (0, 0.0_f64);
    for fragment in bench.fragments(&plan, SIZE)?.iter().filter(|one| one.position.x > -2.99) {
        let wanted = fragment.base * field.light_at(fragment.position, fragment.normal);
        let error = (fragment.color - wanted).abs().max_element();
        if error.is_nan() || error > 1e-3 {
            return Err(format!("{fragment:?}: the host has {wanted}"));
        }
        (seen, largest) = (seen + 1, largest.max(wanted.max_element()));
    }
    if seen > 3000 && largest > 0.1 {
        Ok(())
    } else {
        Err(format!("{seen} fragments, of which the brightest has {largest}"))
    }
}

/// The probes are lit by the lamps and the colours of the plan, with the user's changes. The
/// uniforms of the probes themselves cannot be changed, since they must agree with the probes'
/// textures.
fn follow_changes(bench: &Bench<'_>) -> Result<(), String> {
    let key = format!("{KEY},attenuation=inverse_square_window,cone=smooth");
    // A coarse grid is enough to see a change.
    let probes = Some(Probes { counts: [6, 3, 4], beyond: DVec3::ZERO });
    let scene = Arc::new(Scene { probes, ..halls()? });
    let light = |change: Option<(&str, &[f64])>| -> Result<_, String> {
        let mut plan = bench.plan(&key, "halls", &[])?;
        plan.model = Some(scene.clone());
        let change = change.map(|(path, numbers)| (path.to_owned(), numbers.to_vec()));
        plan.changes.uniforms.extend(change);
        let prepared = bench.prepared(&plan, SIZE)?;
        let stage = prepared.stages.fragment.as_ref().ok_or("no fragment stage")?;
        let place = |name: &str| {
            let found = stage.reflection.bindings.iter().find(|binding| binding.name == name);
            found.map(|found| (found.group, found.binding)).ok_or(format!("no {name}"))
        };
        let texture = prepared.fixtures.get(&place("probe_light")?).map(|one| (**one).clone());
        let Some(Fixture::Texture(texture)) = texture else {
            return Err("no texture of light".to_owned());
        };
        Ok((texture.texels, prepared.buffers.get(&place("probes")?).cloned()))
    };
    let before = light(None)?;
    let changes: [(&str, &[f64]); 7] = [
        ("object.color", &[0.2, 0.9, 0.3, 1.0]),
        ("materials.items[0].diffuse", &[0.2, 0.2, 0.9]),
        ("lamps.lights[0].color", &[1.0, 2.0, 3.0]),
        ("lamps.lights[0].position", &[0.5, 1.0, 0.5]),
        ("lamps.lights[0].axis", &[0.0, -1.0, 0.0]),
        ("lamps.lights[0].range", &[1.0]),
        ("lamps.lights[0].outer", &[0.999]),
    ];
    for (path, numbers) in changes {
        if light(Some((path, numbers)))? == before {
            return Err(format!("the probes do not see `{path}`"));
        }
    }
    for (path, numbers) in [("probes.counts", &[4.0; 3][..]), ("probes.spacing", &[9.0; 3])] {
        if light(Some((path, numbers)))? != before {
            return Err(format!("`{path}` is changed"));
        }
    }
    // A range of zero means that the range is not limited, not that there is no light.
    let endless = light(Some(("lamps.lights[0].range", &[0.0])))?;
    match endless.0.iter().sum::<f32>() >= before.0.iter().sum::<f32>() {
        true => Ok(()),
        false => Err("without a range, the probes have less light".to_owned()),
    }
}

/// Beside the wall between the rooms, the floor of the dark one is much darker than that of the lit
/// one, which is reddish. If probes see through walls, it is not. The grid is so coarse that all the
/// floor beside the wall is between probes of both rooms.
fn no_leaks(bench: &Bench<'_>) -> Result<(), String> {
    let mut plan = bench.plan(&format!("{KEY},cone=smooth,shadow=pcf_3x3"), "halls", &[])?;
    let probes = Some(Probes { counts: [12, 4, 8], beyond: DVec3::ZERO });
    plan.model = Some(Arc::new(Scene { probes, ..halls()? }));
    let mut prepared = bench.prepared(&plan, SIZE)?;
    let [lit, dark] = beside_wall(&bench.fragments_of(&prepared, SIZE)?);
    let stage = prepared.stages.fragment.as_ref().ok_or("no fragment stage")?;
    let depths = stage.reflection.bindings.iter().find(|binding| binding.name == "probe_depths");
    let depths = depths.ok_or("no distances")?;
    let place = (depths.group, depths.binding);
    let Some(Fixture::Texture(seen)) = prepared.fixtures.get(&place).map(|one| &**one) else {
        return Err("no texture of distances".to_owned());
    };
    let texels = [1e3, 1e6, 0.0, 1.0].repeat(seen.texels.len() / 4);
    let endless = Fixture::Texture(FixtureTexture { texels, ..seen.clone() });
    prepared.fixtures.insert(place, Arc::new(endless));
    let [_, leaking] = beside_wall(&bench.fragments_of(&prepared, SIZE)?);
    let what = format!("lit {lit}, dark {dark}, without distances {leaking}");
    println!("{what}");
    let reddish = lit.x > 1.2 * lit.y;
    if reddish && dark.y < 0.15 * lit.y && leaking.y > 2.0 * dark.y { Ok(()) } else { Err(what) }
}

/// The mean light on the floor at both sides of the wall, far from its opening.
fn beside_wall(fragments: &[Fragment]) -> [DVec3; 2] {
    let mean = |from: f64, to: f64| {
        let inside = fragments.iter().filter(|fragment| {
            let at = fragment.position;
            fragment.normal.y > 0.99 && at.y < -1.39 && from < at.x && at.x < to && at.z > 1.0
        });
        let light: Vec<DVec3> = inside.map(|fragment| fragment.color / fragment.base).collect();
        light.iter().sum::<DVec3>() / light.len().max(1) as f64
    };
    [mean(-0.6, -0.1), mean(0.1, 0.6)]
}

//! Deferred shading gives the colours of forward shading: `gbuffer` and `deferred` are drawn after
//! each other, and compared with `forward` pixel by pixel. Shadows from moments are not compared:
//! their map has mip levels, and at the edges of objects the level depends on neighbouring pixels.

use std::sync::Arc;

use glam::DVec3;
use lamplight::bundle::Language;
use lamplight::catalogue::preset::Preset;
use lamplight::execute::Session;
use lamplight::picture::{Pass, Plan};
use lamplight::scene::sets::{self, Maps, Material};
use lamplight::scene::{Layers, brick_materials, bricks};
use libtest_mimic::Trial;

use super::{BACKENDS, library, linear_plan, on_device, rendered, surface_pixels};

/// Keys of `deferred`, and of `forward` for the same picture.
const KEYS: &[(&str, &str, &str)] = &[
    ("classic", "default", "material=array"),
    ("two_sided", "max_lights=10,two_sided", "material=array,max_lights=10,two_sided"),
    (
        "shadowed",
        "ambient=ibl,shadow=pcf_vogel,specular=ggx",
        "ambient=ibl,material=array,shadow=pcf_vogel,specular=ggx",
    ),
    (
        "rough",
        "ambient=hemisphere,diffuse=oren_nayar,shadow=pcf_5x5",
        "ambient=hemisphere,diffuse=oren_nayar,material=array,shadow=pcf_5x5",
    ),
    (
        "occluded",
        "ambient=ibl,occlusion=screen,specular=ggx",
        "ambient=ibl,material=array,occlusion=screen,specular=ggx",
    ),
    ("unlit", "ambient=sh9,lights=none", "ambient=sh9,lights=none"),
];

/// Keys of surfaces of glTF, which are the same for both.
const GLTF: &[(&str, &str)] = &[
    ("gltf", "metallic_roughness,specular=ggx"),
    ("gltf_shadowed", "ambient=ibl,metallic_roughness,shadow=pcf_vogel,specular=ggx"),
    ("gltf_occluded", "ambient=ibl,metallic_roughness,occlusion=screen,specular=ggx"),
    (
        "gltf_wide",
        "area=rectangle,attenuation=inverse_square_window,metallic_roughness,specular=ggx",
    ),
];
/// The materials of the scene's shapes: the metallic factor, and the emission.
const SURFACES: [(f64, DVec3); 4] =
    [(0.0, DVec3::ZERO), (1.0, DVec3::ZERO), (0.0, DVec3::new(0.0, 0.02, 0.1)), (0.6, DVec3::ZERO)];

/// The size of the frames.
const SIZE: [u32; 2] = [128, 96];
/// The largest difference of a channel: positions and normals pass through textures of f32, which
/// moves them by some parts in a million, and highlights and edges of shadows enlarge this.
const TOLERANCE: f64 = 1e-3;
/// The share of the pixels that may differ by more. A point on the edge of a shadow or of a lamp's
/// cone may be on either side of it.
const BEYOND: f64 = 0.002;
/// The least share of the pixels that show a surface.
const SEEN: f64 = 0.3;

/// The plans of `deferred` and of `forward` for the same picture.
type Both = Result<[Plan; 2], String>;

pub fn tests() -> Vec<Trial> {
    let on = |(backend, language): (&'static str, Language)| {
        let test = move |name: &str, both: Box<dyn FnOnce() -> Both + Send>| {
            Trial::test(format!("render/deferred_is_forward/{name}/{backend}"), move || {
                on_device(backend, |painter| same(painter, language, &both()?))
            })
        };
        let classic = KEYS.iter().map(move |(name, deferred, forward)| {
            test(
                name,
                Box::new(|| Ok([plan_of("deferred", deferred)?, plan_of("forward", forward)?])),
            )
        });
        let gltf = GLTF.iter().map(move |(name, key)| test(name, Box::new(|| of_gltf(key))));
        classic.chain(gltf).chain([test("gltf_maps", Box::new(with_map))])
    };
    BACKENDS.into_iter().flat_map(on).collect()
}

fn plan_of(program: &str, key: &str) -> Result<Plan, String> {
    let plan = Plan::of_key(&library().programs, program, key).map_err(rendered)?;
    Ok(Plan { scene: "casters".to_owned(), ..plan })
}

/// The same scene with surfaces of glTF.
fn of_gltf(key: &str) -> Both {
    let mut scene = sets::scene("casters").ok_or("no such scene")?;
    for (object, (metallic, emission)) in scene.objects.iter_mut().zip(SURFACES) {
        let layers = Some(Layers { metallic, ..Layers::default() });
        object.material = Material { layers, emission, ..object.material };
    }
    let model = Some(Arc::new(scene));
    let (deferred, forward) = (plan_of("deferred", key)?, plan_of("forward", key)?);
    Ok([Plan { model: model.clone(), ..deferred }, Plan { model, ..forward }])
}

/// The same with a texture of metal and roughness, and with blank textures otherwise.
fn with_map() -> Both {
    const KEY: &str = "metallic_roughness,specular=ggx";
    let [mut deferred, forward] = of_gltf(KEY)?;
    let mut scene = forward.model.as_deref().cloned().ok_or("no scene")?;
    let mut maps = brick_materials();
    maps.retain(|name, _| *name == "metallic_roughness_map");
    scene.own_maps = Some(Arc::new(Maps { material: maps, ..bricks() }));
    let model = Some(Arc::new(scene));
    let forward = plan_of("forward", &format!("material_maps,{KEY}"))?;
    deferred.passes[0] = surface_pass("metallic_roughness,metallic_roughness_map")?;
    Ok([Plan { model: model.clone(), ..deferred }, Plan { model, ..forward }])
}

/// The pass that draws the surfaces, which is no picture by itself.
fn surface_pass(key: &str) -> Result<Pass, String> {
    let known = library().presets.first().ok_or("no preset")?;
    let (program, key) = ("gbuffer".to_owned(), key.to_owned());
    let preset = Preset { program, key, passes: Vec::new(), ..known.clone() };
    let mut plan = Plan::of_preset(&library().programs, &preset, &[]).map_err(rendered)?;
    plan.passes.pop().ok_or_else(|| "no pass".to_owned())
}

fn same(
    painter: &dyn Session,
    language: Language,
    [deferred, forward]: &[Plan; 2],
) -> Result<(), String> {
    let found = linear_plan(painter, language, deferred, SIZE)?;
    let wanted = linear_plan(painter, language, forward, SIZE)?;
    let key = deferred.last().map_or("", |pass| &pass.key);
    let (mut seen, mut beyond, mut largest) = (0, 0, 0.0_f64);
    for (_, [found, wanted]) in surface_pixels(&found, &wanted, SIZE)? {
        let error = (found - wanted).abs().max_element();
        // A NaN is not near.
        let is_near = error <= TOLERANCE * wanted.abs().max_element().max(1.0);
        (seen, beyond) = (seen + 1, beyond + usize::from(!is_near));
        largest = largest.max(error);
    }
    let pixels = f64::from(SIZE[0] * SIZE[1]);
    println!("{key}: {beyond} of {seen} pixels differ, the largest difference is {largest:e}");
    if (seen as f64) < SEEN * pixels || beyond as f64 > BEYOND * seen as f64 {
        let what = format!("{beyond} of {seen} pixels differ by more than {TOLERANCE:e}");
        return Err(format!("{what}, at most {BEYOND} of them may; the largest is {largest:e}"));
    }
    Ok(())
}

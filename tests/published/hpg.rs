//! OpenGL: Build High Performance Graphics, chapter 4, as its recipes are printed: in view space, with
//! the names of the book.

use glam::{DVec2, DVec3, DVec4};
use lamplight::execute::fixture::FixtureTexture;

use super::geometry::Corner;
use super::listing::{Fragment, Listing, Passed, base_color, power};
use super::numbers::Given;
use super::sampling::{compared, filtered, is_inside};

pub fn listing(example: &str) -> Option<Listing> {
    let made = |vertex, fragment| Some(Listing { vertex, fragment });
    match example {
        "hpg_1_vertex" => made(vertex_1, color_alone),
        "hpg_1_fragment" => made(in_view, fragment_1),
        "hpg_2" => made(in_view, fragment_2),
        "hpg_3" => made(in_view, fragment_3),
        "hpg_4" => made(in_view, fragment_4),
        "hpg_5" => made(in_view, fragment_5),
        "hpg_6_3x3" => made(in_view, fragment_6_3x3),
        "hpg_6_5x5" => made(in_view, fragment_6_5x5),
        "hpg_6_random" => made(in_view, fragment_6_random),
        "hpg_7" => made(in_view, fragment_7),
        _ => None,
    }
}

/// `diffuse_color`, `vEyeSpacePosition`, `vEyeSpaceNormal` and `vShadowCoords`.
fn in_view(given: &Given, corner: &Corner) -> Passed {
    let world = given.model() * corner.position.extend(1.0);
    let model_view = given.view() * given.model();
    let normal = Given::normal_matrix(model_view) * corner.normal;
    let mut passed = vec![base_color(given, corner), given.view() * world, normal.extend(0.0)];
    if given.texture("shadow_map").or(given.texture("shadow_moments")).is_some() {
        passed.push(given.matrix("caster.clip_from_world") * world);
    }
    passed
}

/// The first recipe: `light_position` is in object space, and its host gives each object the same.
fn blinn(given: &Given, normal: DVec3, position: DVec3, color: DVec3) -> Option<DVec3> {
    let model_view = given.view() * given.model();
    let light = model_view.transform_point3(given.lamp_vector(0, "position"));
    let l = (light - position).normalize();
    let v = (-position).normalize();
    let h = (l + v).normalize();
    let diffuse = normal.dot(l).max(0.0);
    let shininess = given.number("materials.items[0].shininess");
    let specular = power(normal.dot(h), shininess)?.max(0.0);
    Some(diffuse * color + specular * given.vector("materials.items[0].specular"))
}

/// Undefined values are passed on as numbers that are none.
fn vertex_1(given: &Given, corner: &Corner) -> Passed {
    let passed = in_view(given, corner);
    let [color, position, normal] = [0, 1, 2].map(|index| passed[index].truncate());
    let lit = blinn(given, normal.normalize(), position, color);
    vec![lit.unwrap_or(DVec3::NAN).extend(1.0)]
}

fn color_alone(_: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    Some(passed[0].truncate()).filter(|color| color.is_finite())
}

fn fragment_1(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    let [color, position, normal] = [0, 1, 2].map(|index| passed[index].truncate());
    blinn(given, normal.normalize(), position, color)
}

fn fragment_2(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    let direction = given.view().transform_vector3(-given.lamp_vector(0, "axis"));
    Some(passed[2].truncate().dot(direction).max(0.0) * passed[0].truncate())
}

/// The direction to the light, and its attenuation.
fn point_light(given: &Given, passed: &[DVec4]) -> (DVec3, f64) {
    let light = given.view().transform_point3(given.lamp_vector(0, "position"));
    let offset = light - passed[1].truncate();
    let d = offset.length();
    let k = given.lamp_vector(0, "attenuation");
    (offset.normalize(), 1.0 / (k.x + k.y * d + k.z * d * d))
}

fn diffuse_light(given: &Given, passed: &[DVec4]) -> f64 {
    let (l, attenuation) = point_light(given, passed);
    passed[2].truncate().dot(l).max(0.0) * attenuation
}

fn fragment_3(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    Some(diffuse_light(given, passed) * passed[0].truncate())
}

/// Outside of the cone, the recipe writes nothing, and the picture is black.
fn fragment_4(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    let (l, attenuation) = point_light(given, passed);
    let d = given.view().transform_vector3(given.lamp_vector(0, "axis")).normalize();
    let effect = (-l).dot(d);
    if effect <= given.lamp(0, "cutoff") {
        return Some(DVec3::ZERO);
    }
    let effect = effect.powf(given.lamp(0, "exponent"));
    let diffuse = passed[2].truncate().dot(l).max(0.0) * effect * attenuation;
    Some(diffuse * passed[0].truncate())
}

/// The place in the map and the depth, rows from the top; `None` if w is not above 1.
fn projected(given: &Given, passed: &[DVec4]) -> Option<(DVec2, f64)> {
    let sc = passed[3];
    let at = sc.truncate() / sc.w;
    let place = DVec2::new(0.5 + 0.5 * at.x, 0.5 - 0.5 * at.y);
    (sc.w > given.number("caster.min_w")).then_some((place, at.z))
}

/// A comparison with a map whose border has the depth 1. Its format is GL_DEPTH_COMPONENT24, with which
/// OpenGL clamps the number that it compares.
fn bordered(map: &FixtureTexture, place: DVec2, depth: f64) -> f64 {
    let depth = depth.clamp(0.0, 1.0);
    let one = |x, y, texel| compared(depth, if is_inside(map, x, y) { texel } else { DVec4::ONE });
    filtered(map, place, one).x
}

/// The recipes' `mix(diffuse, diffuse*shadow, 0.5)`.
fn mixed(
    given: &Given,
    passed: &[DVec4],
    shadow: impl Fn(&FixtureTexture, DVec2, f64) -> f64,
) -> Option<DVec3> {
    let mut diffuse = diffuse_light(given, passed);
    if let Some((place, depth)) = projected(given, passed) {
        let shadow = shadow(given.texture("shadow_map")?, place, depth);
        let share = given.lamp(0, "shadow_strength");
        diffuse = diffuse * (1.0 - share) + diffuse * shadow * share;
    }
    Some(diffuse * passed[0].truncate())
}

/// The nearest texel: the middle of the texel that the place is in.
fn fragment_5(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    mixed(given, passed, |map, place, depth| {
        let size = DVec2::new(f64::from(map.width), f64::from(map.height));
        bordered(map, ((place * size).floor() + 0.5) / size, depth)
    })
}

fn grid(given: &Given, passed: &[DVec4], reach: i32) -> Option<DVec3> {
    mixed(given, passed, |map, place, depth| {
        let texel = 1.0 / DVec2::new(f64::from(map.width), f64::from(map.height));
        let steps = || (-reach..=reach).map(|step| 2.0 * f64::from(step));
        let taps = steps().flat_map(|y| steps().map(move |x| DVec2::new(x, y)));
        let sum: f64 = taps.map(|tap| bordered(map, place + tap * texel, depth)).sum();
        sum / f64::from((2 * reach + 1) * (2 * reach + 1))
    })
}

fn fragment_6_3x3(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    grid(given, passed, 1)
}

fn fragment_6_5x5(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    grid(given, passed, 2)
}

/// The recipe's random number. Its language has 32 bits, of which the sine leaves none: with more of
/// them, it would be another number.
fn random(seed: [f32; 4]) -> f64 {
    let [x, y, z, w] = seed;
    let dot = x * 12.9898 + y * 78.233 + z * 45.164 + w * 94.673;
    let product = dot.sin() * 43758.547;
    f64::from(product - product.floor())
}

/// Where sines are rounded in another way, other places are chosen. A point is then defined only if
/// all places agree that can be chosen.
fn fragment_6_random(given: &Given, passed: &[DVec4], at: &Fragment) -> Option<DVec3> {
    let [x, y] = at.pixel.map(|one| one as f32 + 0.5);
    let w = passed[3].w;
    let chosen = (0..16).map(|i| {
        let across = random([x, y, x, i as f32]);
        DVec2::new(across, -random([y, x, y, i as f32]))
    });
    let possible = (0..144).map(|i| DVec2::new(f64::from(i % 12), -f64::from(i / 12)) / 11.0);
    let share = |places: &[DVec2]| {
        mixed(given, passed, |map, place, depth| {
            let taps = places.iter().map(|one| bordered(map, place + 0.25 * *one / w, depth));
            taps.sum::<f64>() / places.len() as f64
        })
    };
    let found = share(&chosen.collect::<Vec<_>>())?;
    let all = share(&possible.collect::<Vec<_>>())?;
    (at.exact || (found - all).abs().max_element() < 1e-3).then_some(found)
}

fn fragment_7(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    let mut diffuse = diffuse_light(given, passed);
    if let Some((place, depth)) = projected(given, passed) {
        let map = given.texture("shadow_moments")?;
        let border = DVec4::new(1.0, 0.0, 0.0, 0.0);
        let moments =
            filtered(map, place, |x, y, texel| if is_inside(map, x, y) { texel } else { border });
        let variance = (moments.y - moments.x * moments.x).max(given.number("caster.min_variance"));
        let distance = depth - moments.x;
        let p_max = variance / (variance + distance * distance);
        let least = given.number("caster.least");
        diffuse *= p_max.max(if depth <= moments.x { 1.0 } else { least });
    }
    Some(diffuse * passed[0].truncate())
}

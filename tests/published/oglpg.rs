//! OpenGL Programming Guide, 9th edition, chapter 7, as its listings are printed: in view space, with
//! the names of the book.

use glam::{DMat3, DVec3, DVec4};

use super::geometry::Corner;
use super::listing::{Fragment, Listing, Passed, at_most_white, base_color, power};
use super::numbers::Given;
use super::sampling::{around, compared, filtered};

pub fn listing(example: &str) -> Option<Listing> {
    let made = |vertex, fragment| Some(Listing { vertex, fragment });
    match example {
        "oglpg_7_1" => made(color_alone, example_1),
        "oglpg_7_2" => made(color_alone, example_2),
        "oglpg_7_3" => made(in_view, example_3),
        "oglpg_7_4" => made(in_view, example_4),
        "oglpg_7_5" => made(in_view, example_5),
        "oglpg_7_6" => made(vertex_6, example_6),
        "oglpg_7_8" => made(in_view, example_8),
        "oglpg_7_10" => made(in_view, example_10),
        "oglpg_7_11" => made(in_view, example_11),
        "oglpg_7_12" => made(vertex_12, first_out),
        "oglpg_7_13" => made(vertex_13, example_13),
        "oglpg_7_14" => made(vertex_14, first_out),
        "oglpg_7_21" => made(vertex_20, example_21),
        _ => None,
    }
}

const EYE_DIRECTION: DVec3 = DVec3::Z;

fn color_alone(given: &Given, corner: &Corner) -> Passed {
    vec![base_color(given, corner)]
}

fn example_1(_: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    Some(passed[0].truncate())
}

fn first_out(_: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    Some(passed[0].truncate())
}

fn example_2(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    Some(at_most_white(passed[0].truncate() * given.vector("surroundings.color")))
}

/// `Color`, `Normal` and `Position` of examples 7.3 to 7.11, and the index of the material.
fn in_view(given: &Given, corner: &Corner) -> Passed {
    let model_view = given.view() * given.model();
    let normal = (Given::normal_matrix(model_view) * corner.normal).normalize();
    let position = model_view.transform_point3(corner.position);
    let index = DVec4::splat(corner.material as f64);
    vec![base_color(given, corner), normal.extend(0.0), position.extend(1.0), index]
}

/// Lambert's cosine and the highlight of examples 7.3 to 7.11.
fn cosines(normal: DVec3, light: DVec3, half: DVec3, shininess: f64) -> (f64, f64) {
    let diffuse = normal.dot(light).max(0.0);
    let specular = normal.dot(half).max(0.0);
    (diffuse, if diffuse == 0.0 { 0.0 } else { specular.powf(shininess) })
}

fn eye_place(given: &Given, index: usize) -> DVec3 {
    given.view().transform_point3(given.lamp_vector(index, "position"))
}

fn eye_axis(given: &Given, index: usize) -> DVec3 {
    given.view().transform_vector3(given.lamp_vector(index, "axis"))
}

/// `1 / (constant + linear d + quadratic d^2)`.
fn attenuation(given: &Given, index: usize, d: f64) -> f64 {
    let k = given.lamp_vector(index, "attenuation");
    1.0 / (k.x + k.y * d + k.z * d * d)
}

/// The last lines of examples 7.3 to 7.6.
fn finished(given: &Given, color: DVec3, diffuse: f64, specular: f64, attenuation: f64) -> DVec3 {
    let light = given.lamp_vector(0, "color");
    let scattered = given.vector("surroundings.color") + light * diffuse * attenuation;
    let reflected = light * specular * given.lamp(0, "strength") * attenuation;
    at_most_white(color * scattered + reflected)
}

fn shininess(given: &Given) -> f64 {
    given.number("materials.items[0].shininess")
}

fn example_3(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    let direction = -eye_axis(given, 0).normalize();
    let half = (direction + EYE_DIRECTION).normalize();
    let (diffuse, specular) = cosines(passed[1].truncate(), direction, half, shininess(given));
    Some(finished(given, passed[0].truncate(), diffuse, specular, 1.0))
}

fn example_4(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    Some(local_light(given, passed, 1.0))
}

fn example_5(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    let direction = (eye_place(given, 0) - passed[2].truncate()).normalize();
    Some(local_light(given, passed, cone(given, 0, direction)))
}

/// The factor of the cone of example 7.5.
fn cone(given: &Given, index: usize, direction: DVec3) -> f64 {
    let cosine = direction.dot(-eye_axis(given, index));
    if cosine < given.lamp(index, "cutoff") {
        0.0
    } else {
        cosine.powf(given.lamp(index, "exponent"))
    }
}

fn local_light(given: &Given, passed: &[DVec4], cone: f64) -> DVec3 {
    let offset = eye_place(given, 0) - passed[2].truncate();
    let d = offset.length();
    let direction = offset / d;
    let half = (direction + EYE_DIRECTION).normalize();
    let (diffuse, specular) = cosines(passed[1].truncate(), direction, half, shininess(given));
    finished(given, passed[0].truncate(), diffuse, specular, attenuation(given, 0, d) * cone)
}

/// Example 7.6 subtracts `VertexPosition` as it is, so its uniforms are in the space of the vertices.
fn vertex_6(given: &Given, corner: &Corner) -> Passed {
    let back = given.model().inverse();
    let light = back.transform_point3(given.lamp_vector(0, "position"));
    let eye = back.transform_vector3(given.view().inverse().transform_vector3(EYE_DIRECTION));
    let offset = light - corner.position;
    let d = offset.length();
    let direction = offset / d;
    let half = (direction + eye).normalize();
    vec![
        base_color(given, corner),
        corner.normal.normalize().extend(0.0),
        direction.extend(0.0),
        half.extend(0.0),
        DVec4::splat(attenuation(given, 0, d)),
    ]
}

fn example_6(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    let [normal, direction, half] = [1, 2, 3].map(|index| passed[index].truncate());
    let (diffuse, specular) = cosines(normal, direction, half, shininess(given));
    Some(finished(given, passed[0].truncate(), diffuse, specular, passed[4].x))
}

/// A material of examples 7.9 to 7.11.
struct Material {
    emission: DVec3,
    ambient: DVec3,
    diffuse: DVec3,
    specular: DVec3,
    shininess: f64,
}

fn material(given: &Given, index: usize) -> Material {
    let vector = |field: &str| given.vector(&format!("materials.items[{index}].{field}"));
    Material {
        emission: vector("emission"),
        ambient: vector("ambient"),
        diffuse: vector("diffuse"),
        specular: vector("specular"),
        shininess: given.number(&format!("materials.items[{index}].shininess")),
    }
}

/// The loop of example 7.8, with the materials of example 7.10.
fn many_lights(given: &Given, passed: &[DVec4], material: &Material) -> DVec3 {
    let [color, normal, position] = [0, 1, 2].map(|index| passed[index].truncate());
    let (mut scattered, mut reflected) = (DVec3::ZERO, DVec3::ZERO);
    for light in 0..given.lamps() {
        let kind = given.lamp(light, "kind");
        let mut direction = -eye_axis(given, light);
        let mut fade = 1.0;
        if kind != 1.0 {
            let offset = eye_place(given, light) - position;
            let d = offset.length();
            direction = offset / d;
            fade = attenuation(given, light, d);
            if kind == 3.0 {
                fade *= cone(given, light, direction);
            }
        }
        let half = (direction + EYE_DIRECTION).normalize();
        let (diffuse, specular) = cosines(normal, direction, half, material.shininess);
        let light_color = given.lamp_vector(light, "color");
        scattered += given.lamp_vector(light, "ambient") * material.ambient * fade
            + light_color * material.diffuse * diffuse * fade;
        reflected +=
            light_color * material.specular * specular * given.lamp(light, "strength") * fade;
    }
    at_most_white(material.emission + color * scattered + reflected)
}

fn example_8(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    let plain = Material {
        emission: DVec3::ZERO,
        ambient: DVec3::ONE,
        diffuse: DVec3::ONE,
        specular: DVec3::ONE,
        shininess: shininess(given),
    };
    Some(many_lights(given, passed, &plain))
}

fn example_10(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    Some(many_lights(given, passed, &material(given, passed[3].x.round() as usize)))
}

/// Even indices are fronts and odd ones are backs, so an index is twice the number of a pair.
fn example_11(given: &Given, passed: &[DVec4], at: &Fragment) -> Option<DVec3> {
    let index = 2 * passed[3].x.round() as usize;
    let index = if at.front { index } else { index + 1 };
    Some(many_lights(given, passed, &material(given, index)))
}

fn vertex_12(given: &Given, corner: &Corner) -> Passed {
    let passed = in_view(given, corner);
    let light = (eye_place(given, 0) - passed[2].truncate()).normalize();
    let a = passed[1].truncate().dot(light) * 0.5 + 0.5;
    let [ground, sky] = ["surroundings.ground", "surroundings.sky"].map(|path| given.vector(path));
    vec![(ground * (1.0 - a) + sky * a).extend(1.0)]
}

fn vertex_13(given: &Given, corner: &Corner) -> Passed {
    let passed = in_view(given, corner);
    let [normal, eye] = [1, 2].map(|index| passed[index].truncate());
    let mirrored = eye - 2.0 * normal.dot(eye) * normal;
    vec![passed[0], normal.extend(0.0), mirrored.extend(0.0)]
}

fn example_13(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    let [base, normal, mirrored] = [0, 1, 2].map(|index| passed[index].truncate());
    let read = |name, direction: DVec3| {
        Some(around(given.texture(name)?, direction.normalize(), |texel| texel).truncate())
    };
    let (diffuse, specular) = (read("sky_diffuse", normal)?, read("sky_specular", mirrored)?);
    let diffuse_percent = given.number("surroundings.diffuse_share");
    let specular_percent = given.number("surroundings.specular_share");
    let color = base.lerp(diffuse * base, diffuse_percent);
    Some(color.lerp(specular + color, specular_percent))
}

/// Equation 7.1 with the constants of example 7.14.
fn vertex_14(given: &Given, corner: &Corner) -> Passed {
    let (c1, c2, c3, c4, c5) = (0.429043, 0.511664, 0.743125, 0.886227, 0.247708);
    let n = in_view(given, corner)[1];
    let [l00, l1m1, l10, l11, l2m2, l2m1, l20, l21, l22] =
        std::array::from_fn(|index| given.vector(&format!("surroundings.sh[{index}]")));
    let sum = c1 * l22 * (n.x * n.x - n.y * n.y) + c3 * l20 * n.z * n.z + c4 * l00 - c5 * l20
        + 2.0 * c1 * (l2m2 * n.x * n.y + l21 * n.x * n.z + l2m1 * n.y * n.z)
        + 2.0 * c2 * (l11 * n.x + l1m1 * n.y + l10 * n.z);
    vec![(sum * given.number("surroundings.scale")).extend(1.0)]
}

/// `shadow_coord` in the light's clip space, `world_coord`, `eye_coord` and `normal` of example 7.20.
fn vertex_20(given: &Given, corner: &Corner) -> Passed {
    let world = given.model() * corner.position.extend(1.0);
    let eye = given.view() * world;
    let normal = DMat3::from_mat4(given.view() * given.model()) * corner.normal;
    let shadow = given.matrix("caster.clip_from_world") * world;
    vec![base_color(given, corner), world, eye, normal.extend(0.0), shadow]
}

fn example_21(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    let [base, world, eye, n] = [0, 1, 2, 3].map(|index| passed[index].truncate());
    let own = material(given, 0);
    let l = (given.lamp_vector(0, "position") - world).normalize();
    let r = -l - 2.0 * n.dot(-l) * n;
    let e = eye.normalize();
    let diffuse = n.dot(l).max(0.0);
    let at = passed[4].truncate() / passed[4].w;
    // Clip space has y upwards, and rows of the map are counted from the top; depths are from 0 to 1.
    let place = glam::DVec2::new(0.5 + 0.5 * at.x, 0.5 - 0.5 * at.y);
    // The format is GL_DEPTH_COMPONENT32, with which OpenGL clamps the number that it compares.
    let depth = at.z.clamp(0.0, 1.0);
    let f = filtered(given.texture("shadow_map")?, place, |_, _, texel| compared(depth, texel)).x;
    // In full shadow, nothing depends on the highlight.
    let specular = if f == 0.0 { 0.0 } else { power((-e).dot(r), own.shininess)?.max(0.0) };
    Some(base * own.ambient + f * (base * own.diffuse * diffuse + own.specular * specular))
}

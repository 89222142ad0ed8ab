//! Newcastle's tutorial 11 and Igalia's articles as their listings are printed: in the world, with
//! their names.

use glam::{DVec2, DVec3, DVec4};

use super::geometry::Corner;
use super::listing::{Fragment, Listing, Passed, base_color};
use super::numbers::Given;
use super::sampling::{around, compared, filtered, repeated};

pub fn listing(example: &str) -> Option<Listing> {
    let made = |vertex, fragment| Some(Listing { vertex, fragment });
    match example {
        "ncl_11_flat" => made(flat, per_vertex),
        "ncl_11_gouraud" => made(gouraud, per_vertex),
        "ncl_11_phong" => made(per_pixel, |given, passed, _| one_light(given, passed, point)),
        "ncl_11_lightmap" => made(per_pixel, lightmap),
        "ncl_11_further_1" => made(per_pixel, |given, passed, _| one_light(given, passed, colored)),
        "ncl_11_further_2" => made(per_pixel, four_lights),
        "ncl_11_further_3" => made(per_pixel, |given, passed, _| one_light(given, passed, sun)),
        "ncl_11_further_4" => made(per_pixel, |given, passed, _| one_light(given, passed, spot)),
        "igl_1_directional" | "igl_1_point" | "igl_1_spot" | "igl_1_multiple" => {
            made(igalia, |given, passed, _| Some(all_lights(given, passed, 1.0)))
        }
        "igl_2_spot" | "igl_2_directional" => made(igalia, flat_shadow),
        "igl_2_cube" => made(igalia, cube_shadow),
        _ => None,
    }
}

fn camera(given: &Given) -> DVec3 {
    given.view().inverse().w_axis.truncate()
}

/// Colour, texture coordinates, `normal` and `worldPos` of PerPixelVertex.
fn per_pixel(given: &Given, corner: &Corner) -> Passed {
    let normal = (Given::normal_matrix(given.model()) * corner.normal.normalize()).normalize();
    let position = given.model().transform_point3(corner.position);
    let uv = DVec4::new(corner.uv.x, corner.uv.y, corner.light_uv.x, corner.light_uv.y);
    vec![base_color(given, corner), uv, normal.extend(0.0), position.extend(1.0)]
}

/// A light of the tutorial at a point: the direction to it, its fading, and the colours of its
/// diffuse light and of its highlight.
struct Light {
    incident: DVec3,
    atten: f64,
    color: DVec3,
    specular: DVec3,
}

fn point_light(given: &Given, index: usize, position: DVec3) -> Light {
    let offset = given.lamp_vector(index, "position") - position;
    let color = given.lamp_vector(index, "color");
    Light {
        incident: offset.normalize(),
        atten: 1.0 - (offset.length() / given.lamp(index, "range")).clamp(0.0, 1.0),
        color,
        specular: color,
    }
}

fn point(given: &Given, position: DVec3) -> Light {
    point_light(given, 0, position)
}

fn colored(given: &Given, position: DVec3) -> Light {
    Light { specular: given.vector("lamps.lights[0].specular"), ..point(given, position) }
}

fn sun(given: &Given, _: DVec3) -> Light {
    let color = given.lamp_vector(0, "color");
    let incident = -given.lamp_vector(0, "axis").normalize();
    Light { incident, atten: 1.0, color, specular: color }
}

fn spot(given: &Given, position: DVec3) -> Light {
    let light = point(given, position);
    let cosine = (-light.incident).dot(given.lamp_vector(0, "axis"));
    let inside = cosine > given.lamp(0, "cutoff");
    Light { atten: if inside { light.atten } else { 0.0 }, ..light }
}

/// PerPixelFragment: the part that the texture multiplies, and the highlight.
fn lit(given: &Given, light: &Light, normal: DVec3, position: DVec3) -> (DVec3, DVec3) {
    let lambert = light.incident.dot(normal).max(0.0);
    let view = (camera(given) - position).normalize();
    let half = (light.incident + view).normalize();
    let s = half.dot(normal).max(0.0).powf(50.0);
    let scattered = light.color * light.atten * lambert + light.color * 0.1;
    (scattered, light.specular * s * 0.33 * light.atten * lambert)
}

/// `diffuse` of PerPixelFragment, which does not read `IN.colour`.
fn diffuse(given: &Given, passed: &[DVec4]) -> Option<DVec3> {
    let uv = DVec2::new(passed[1].x, passed[1].y);
    Some(repeated(given.texture("base_map")?, uv).truncate())
}

fn one_light(given: &Given, passed: &[DVec4], light: fn(&Given, DVec3) -> Light) -> Option<DVec3> {
    let [normal, position] = [2, 3].map(|index| passed[index].truncate());
    let (scattered, reflected) = lit(given, &light(given, position), normal, position);
    Some(diffuse(given, passed)? * scattered + reflected)
}

fn four_lights(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    let [normal, position] = [2, 3].map(|index| passed[index].truncate());
    let base = diffuse(given, passed)?;
    let one = |index| {
        let light = point_light(given, index, position);
        let (scattered, reflected) = lit(given, &light, normal, position);
        base * scattered + reflected
    };
    Some((0..given.lamps()).map(one).sum())
}

fn lightmap(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    let baked = repeated(given.texture("light_map")?, DVec2::new(passed[1].z, passed[1].w));
    Some(passed[0].truncate() * diffuse(given, passed)? * baked.truncate())
}

/// Gouraud shading: the light of the vertex.
fn gouraud(given: &Given, corner: &Corner) -> Passed {
    light_at(given, corner, corner.position)
}

/// Flat shading: the light of the middle of the face.
fn flat(given: &Given, corner: &Corner) -> Passed {
    light_at(given, corner, corner.middle)
}

fn light_at(given: &Given, corner: &Corner, place: DVec3) -> Passed {
    let passed = per_pixel(given, corner);
    let position = given.model().transform_point3(place);
    let (scattered, reflected) =
        lit(given, &point(given, position), passed[2].truncate(), position);
    vec![passed[0], passed[1], scattered.extend(0.0), reflected.extend(0.0)]
}

fn per_vertex(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    Some(diffuse(given, passed)? * passed[2].truncate() + passed[3].truncate())
}

/// The colour, the normal, the world's position and the direction to the viewer; with a flat map, the
/// place in the light's clip space.
fn igalia(given: &Given, corner: &Corner) -> Passed {
    let world = given.model() * corner.position.extend(1.0);
    let normal = (Given::normal_matrix(given.model()) * corner.normal).normalize();
    let view = (camera(given) - world.truncate()).normalize();
    let mut passed = vec![base_color(given, corner), normal.extend(0.0), world, view.extend(0.0)];
    if given.texture("shadow_map").is_some() {
        passed.push(given.matrix("caster.clip_from_world") * world);
    }
    passed
}

fn all_lights(given: &Given, passed: &[DVec4], visible: f64) -> DVec3 {
    (0..given.lamps()).map(|index| igalia_light(given, passed, index, visible)).sum()
}

/// The three terms of part I, for a light of any kind.
fn igalia_light(given: &Given, passed: &[DVec4], index: usize, visible: f64) -> DVec3 {
    let [base, surface_normal, position, view] = [0, 1, 2, 3].map(|k| passed[k].truncate());
    let vector = |field: &str| given.vector(&format!("materials.items[0].{field}"));
    let kind = given.lamp(index, "kind");
    let light_dir = given.lamp_vector(index, "axis").normalize();
    let offset = given.lamp_vector(index, "position") - position;
    let pos_to_light = if kind == 1.0 { -light_dir } else { offset.normalize() };
    let normal = surface_normal.normalize();
    let dp_reflection = normal.dot(pos_to_light).max(0.0);
    let mut diffuse = vector("diffuse") * base * given.lamp_vector(index, "color") * dp_reflection;
    let mut ambient = vector("ambient") * base * given.lamp_vector(index, "ambient");
    // A point light has no direction of its own.
    let light_dir = if kind == 2.0 { -pos_to_light } else { light_dir };
    let mut specular = DVec3::ZERO;
    if normal.dot(-light_dir) >= 0.0 {
        let reflection = light_dir - 2.0 * normal.dot(light_dir) * normal;
        let shine = reflection.dot(view.normalize()).max(0.0);
        let shininess = given.number("materials.items[0].shininess");
        specular = given.vector(&format!("lamps.lights[{index}].specular"))
            * vector("specular")
            * shine.powf(shininess);
    }
    if kind != 1.0 {
        let (d, k) = (offset.length(), given.lamp_vector(index, "attenuation"));
        let attenuation = 1.0 / (k.x + k.y * d + k.z * d * d);
        diffuse *= attenuation;
        ambient *= attenuation;
        specular *= attenuation;
    }
    if kind == 3.0 && (-pos_to_light).dot(light_dir) <= given.lamp(index, "cutoff") {
        diffuse = DVec3::ZERO;
        specular = DVec3::ZERO;
    }
    ambient + (diffuse + specular) * visible
}

/// Part II ends before the lookup: a fragment farther from the light than the map has it is in shade.
fn flat_shadow(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    let at = passed[4].truncate() / passed[4].w;
    let place = DVec2::new(0.5 + 0.5 * at.x, 0.5 - 0.5 * at.y);
    let map = given.texture("shadow_map")?;
    let depth = at.z - given.number("caster.bias");
    let on_map = place.min_element() >= 0.0 && place.max_element() <= 1.0;
    let seen = on_map && (0.0..=1.0).contains(&at.z) && passed[4].w > 0.0;
    let visible =
        if seen { filtered(map, place, |_, _, texel| compared(depth, texel)).x } else { 1.0 };
    Some(all_lights(given, passed, visible))
}

/// The depth of a face of the cube: that of a perspective of 90 degrees along its axis.
fn cube_shadow(given: &Given, passed: &[DVec4], _: &Fragment) -> Option<DVec3> {
    let offset = passed[2].truncate() - given.lamp_vector(0, "position");
    let along = offset.abs().max_element();
    let (near, far) = (given.number("caster.near"), given.number("caster.far"));
    let depth = far * (along - near) / ((far - near) * along) - given.number("caster.bias");
    let map = given.texture("shadow_cube")?;
    let visible = if (0.0..=1.0).contains(&depth) {
        around(map, offset, |texel| compared(depth, texel)).x
    } else {
        1.0
    };
    Some(all_lights(given, passed, visible))
}

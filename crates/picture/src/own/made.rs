//! The vertex stage that is made for a fragment stage alone.

use std::collections::BTreeMap;

use lamplight_bundle::{Reflection, Varying};
use lamplight_diagnostic::Diagnostics;

use super::inputs::{Source, chosen_source, input_source};
use super::shape::NumberType;
use crate::frame::ReadyStage;
use crate::sketch::{given_inputs, vertex_stage};

/// The group of the buffers of the made stage: one that the fragment stage does not use.
fn free_group(fragment: &Reflection) -> u32 {
    (0..4).find(|group| fragment.bindings.iter().all(|one| one.group != *group)).unwrap_or(0)
}

/// Where the buffers of a made stage are bound.
fn free_places(fragment: &Reflection) -> (u32, [u32; 3]) {
    let group = free_group(fragment);
    let taken = |place: &u32| {
        fragment.bindings.iter().any(|one| one.group == group && one.binding == *place)
    };
    let mut free = (0..).filter(|place| !taken(place));
    (group, [(); 3].map(|()| free.next().unwrap_or_default()))
}

/// Whether a fragment stage shows as much on a rectangle as on a model: it asks for nothing but places
/// in the picture.
pub fn is_flat(fragment: &Reflection) -> bool {
    let located = fragment.inputs.iter().filter(|input| input.location.is_some());
    located.map(|input| (input_source(input).0, NumberType::of(&input.ty))).all(|(source, ty)| {
        matches!(source, Source::Uv | Source::Zero) || source == Source::Position && ty.rows == 2
    })
}

/// The vertex stage that gives a fragment stage what it asks for, on a model or on a triangle over the
/// whole picture.
///
/// # Errors
/// Those of naga, for an input whose type no vertex stage can give.
pub fn made_vertex(
    fragment: &Reflection,
    flat: bool,
    inputs: &BTreeMap<String, String>,
) -> Result<ReadyStage, Diagnostics> {
    vertex_stage(if flat { flat_text(fragment) } else { model_text(fragment, inputs) })
}

/// The stage of a triangle that covers the picture. `uv` counts from its upper left. Words in capitals
/// are replaced.
const FLAT: &str = "struct Given {
    @builtin(position) clip: vec4f,
OUTPUTS}
@vertex
fn vs_main(@builtin(vertex_index) index: u32) -> Given {
    let corner = vec2f(vec2u((index << 1u) & 2u, index & 2u));
    let position = vec4f(corner * 2.0 - 1.0, 0.0, 1.0);
    let uv = vec4f(corner.x, 1.0 - corner.y, 0.0, 1.0);
    var given: Given;
    given.clip = position;
LINES    return given;
}
";

/// The stage of a model.
const MODEL: &str = "struct Camera {
    clip_from_world: mat4x4f,
    world_from_view: mat4x4f,
}
struct Object {
    world_from_object: mat4x4f,
    normal_from_object: mat4x4f,
    color: vec4f,
}
struct Around {
    view_from_world: mat4x4f,
    light_from_world: mat4x4f,
    lamp: vec4f,
    eye: vec4f,
}
@group(GROUP) @binding(CAMERA) var<uniform> camera: Camera;
@group(GROUP) @binding(OBJECT) var<uniform> object: Object;
@group(GROUP) @binding(AROUND) var<uniform> around: Around;
struct Given {
    @builtin(position) clip: vec4f,
OUTPUTS}
@vertex
fn vs_main(
    @location(0) place: vec3f,
    @location(1) outwards: vec3f,
    @location(2) tint: vec3f,
    @location(3) st: vec2f,
    @location(5) along: vec4f,
) -> Given {
    let position = object.world_from_object * vec4f(place, 1.0);
    let normal = vec4f(normalize((object.normal_from_object * vec4f(outwards, 0.0)).xyz), 0.0);
    let turned = object.world_from_object * vec4f(along.xyz, 0.0);
    let tangent = vec4f(turned.xyz, along.w);
    let bitangent = vec4f(cross(normal.xyz, tangent.xyz) * along.w, 0.0);
    let uv = vec4f(st, 0.0, 1.0);
    let color = vec4f(tint, 1.0) * object.color;
    let to_light = vec4f(around.lamp.xyz - position.xyz, 0.0);
    let to_eye = vec4f(around.eye.xyz - position.xyz, 0.0);
    let between = normalize(to_light.xyz) + normalize(to_eye.xyz);
    let half_way = vec4f(normalize(between), 0.0);
    let seen_position = around.view_from_world * position;
    let seen_normal = around.view_from_world * normal;
    let light_position = around.light_from_world * position;
    let light_place = light_position.xyz / light_position.w;
    let light_texel = vec4f(light_place.xy * vec2f(0.5, -0.5) + 0.5, light_place.z, 1.0);
    let depth = vec4f(-seen_position.z);
    var given: Given;
    given.clip = camera.clip_from_world * position;
LINES    return given;
}
";

fn flat_text(fragment: &Reflection) -> String {
    let (outputs, lines) = given_inputs(fragment, &|input| given_value(input, &BTreeMap::new()));
    FLAT.replace("OUTPUTS", &outputs).replace("LINES", &lines)
}

fn model_text(fragment: &Reflection, inputs: &BTreeMap<String, String>) -> String {
    let (group, [camera, object, around]) = free_places(fragment);
    let (outputs, lines) = given_inputs(fragment, &|input| given_value(input, inputs));
    MODEL
        .replace("GROUP", &group.to_string())
        .replace("CAMERA", &camera.to_string())
        .replace("OBJECT", &object.to_string())
        .replace("AROUND", &around.to_string())
        .replace("OUTPUTS", &outputs)
        .replace("LINES", &lines)
}

fn given_value(input: &Varying, inputs: &BTreeMap<String, String>) -> String {
    let ty = &input.ty;
    let value = match chosen_source(input, inputs).0 {
        Source::Position => "position",
        Source::Normal => "normal",
        Source::Tangent => "tangent",
        Source::Bitangent => "bitangent",
        Source::Uv => "uv",
        Source::Color => "color",
        Source::ToLight => "to_light",
        Source::ToEye => "to_eye",
        Source::HalfWay => "half_way",
        // three.js gives its lit materials the way from the point to the viewer under this name.
        Source::SeenPosition if input.name.as_deref() == Some("vViewPosition") => "-seen_position",
        Source::SeenPosition => "seen_position",
        Source::SeenNormal => "seen_normal",
        // Three numbers are a place in the shadow map, four are still to be divided.
        Source::LightPosition if NumberType::of(ty).rows < 4 => "light_texel",
        Source::LightPosition => "light_position",
        Source::Depth => "depth",
        Source::Zero => return format!("{ty}()"),
    };
    match NumberType::of(ty).rows {
        1 => format!("{ty}(({value}).x)"),
        2 => format!("{ty}(({value}).xy)"),
        3 => format!("{ty}(({value}).xyz)"),
        _ => format!("{ty}({value})"),
    }
}

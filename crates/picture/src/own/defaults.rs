//! Values of uniforms that nobody gave: the name says what is meant, and the type how many numbers.
//!
//! The names are those of WebGPU's samples, three.js, Shadertoy, LearnOpenGL and this library.

use glam::{DVec3, DVec4};

use super::around::Around;
use super::matrices::matrix_numbers;
use super::shape::NumberType;
use super::table::numbers_text;
use super::words::{has_word, name_words};

/// What a uniform means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Meaning {
    Time,
    Frame,
    /// Width and height of the picture, then 1 and 1.
    Size,
    /// Width and height of a texture of Shadertoy's, then 1.
    ChannelSize,
    Aspect,
    /// Width and height of a pixel, where the picture has the size 1.
    PixelSize,
    EyePosition,
    /// The direction in which the viewer looks, unit.
    EyeDirection,
    Near,
    Far,
    FieldOfView,
    LightPosition,
    /// Towards the light, unit; or from it, where the shader negates it.
    LightDirection,
    /// What makes the nearest parts of the model white, where the light falls off with the square of
    /// the distance.
    LightPower,
    /// One number for each component, and alpha 1.
    Number(f64),
    Color([f64; 3]),
}

/// Words that have one meaning here.
const LIGHT: &[&str] = &["light", "lights", "lamp", "lamps", "sun", "moon", "spotlight", "l"];
const EYE: &[&str] = &["eye", "camera", "cam", "view", "viewer"];
const PLACE: &[&str] = &["position", "pos", "place", "location", "origin", "world"];
const DIRECTION: &[&str] = &["direction", "dir", "to", "axis", "vector", "vec", "forward", "front"];
const COLOR: &[&str] =
    &["color", "colour", "col", "rgb", "rgba", "tint", "albedo", "base", "diffuse"];
const SIZE: &[&str] = &["size", "resolution", "dimensions", "dims", "extent"];
const STRENGTH: &[&str] =
    &["strength", "intensity", "brightness", "amount", "factor", "weight", "k"];
const SCREEN: &[&str] =
    &["screen", "viewport", "canvas", "window", "framebuffer", "image", "target"];
const FOG: &[&str] = &["fog", "haze", "mist"];

/// The colour of LearnOpenGL's toy, which is neither grey nor a primary.
const CORAL: Meaning = Meaning::Color([1.0, 0.5, 0.31]);
const WHITE: Meaning = Meaning::Color([1.0; 3]);

/// A name has the meaning if it has a word of each list. The first line that fits counts.
const RULES: &[(&[&[&str]], Meaning)] = &[
    (&[&["time", "t"], &["delta", "step", "d"]], Meaning::Number(1.0 / 60.0)),
    (&[&["dt"]], Meaning::Number(1.0 / 60.0)),
    (&[&["time", "seconds", "elapsed", "clock", "now"]], Meaning::Time),
    (&[&["frame"], &["rate"]], Meaning::Number(60.0)),
    (&[&["frame", "frames"], &["index", "count", "number", "frame"]], Meaning::Frame),
    (&[&["sample"], &["rate"]], Meaning::Number(44_100.0)),
    (&[&["channel", "texture", "tex"], SIZE], Meaning::ChannelSize),
    (&[&["pixel", "texel"], SIZE], Meaning::PixelSize),
    (&[SCREEN, SIZE], Meaning::Size),
    (&[&["resolution", "viewport"]], Meaning::Size),
    (&[&["aspect"]], Meaning::Aspect),
    (&[&["mouse", "cursor", "pointer", "date"]], Meaning::Number(0.0)),
    (&[LIGHT, &["count", "num", "number"]], Meaning::Number(1.0)),
    (&[LIGHT, &["ambient"]], Meaning::Number(0.2)),
    (&[LIGHT, COLOR], WHITE),
    (&[LIGHT, &["specular", "radiance", "energy"]], WHITE),
    (&[LIGHT, PLACE], Meaning::LightPosition),
    (&[LIGHT, &["cut", "cutoff", "cone", "angle"], &["outer"]], Meaning::Number(0.953_717)),
    (&[LIGHT, &["cut", "cutoff", "inner"]], Meaning::Number(0.976_296)),
    (&[LIGHT, &["constant"]], Meaning::Number(1.0)),
    (&[LIGHT, &["linear"]], Meaning::Number(0.09)),
    (&[LIGHT, &["quadratic"]], Meaning::Number(0.032)),
    (&[LIGHT, &["range", "radius", "reach"]], Meaning::Number(20.0)),
    (&[LIGHT, &["power", "flux", "watts", "lumens", "candela"]], Meaning::LightPower),
    (&[LIGHT, STRENGTH], Meaning::Number(1.0)),
    (&[LIGHT, DIRECTION], Meaning::LightDirection),
    (&[FOG, COLOR], Meaning::Color([0.5, 0.6, 0.7])),
    (&[FOG, &["density"]], Meaning::Number(0.1)),
    (&[FOG, &["near", "start", "begin"]], Meaning::Number(2.0)),
    (&[FOG, &["far", "end"]], Meaning::Number(10.0)),
    (&[EYE, PLACE], Meaning::EyePosition),
    (&[EYE, DIRECTION], Meaning::EyeDirection),
    (&[&["near"]], Meaning::Near),
    (&[&["far"]], Meaning::Far),
    (&[&["fov"]], Meaning::FieldOfView),
    (&[&["sky"], COLOR], Meaning::Color([0.5, 0.7, 1.0])),
    (&[&["ground"], COLOR], Meaning::Color([0.2, 0.15, 0.1])),
    (&[&["rim", "specular", "outline"], &["color", "colour"]], WHITE),
    (&[&["ambient", "specular", "diffuse"], STRENGTH], Meaning::Number(0.5)),
    (&[&["material", "mat", "surface", "object"], &["ambient"]], CORAL),
    (&[&["ambient"]], Meaning::Number(0.1)),
    (&[&["specular", "ks"]], Meaning::Number(0.5)),
    (&[&["emission", "emissive", "glow"]], Meaning::Number(0.0)),
    (&[&["shininess", "gloss", "glossiness", "shiny"]], Meaning::Number(32.0)),
    (&[&["roughness", "rough"]], Meaning::Number(0.4)),
    (&[&["metallic", "metalness", "metal"]], Meaning::Number(0.0)),
    (&[&["occlusion", "ao", "opacity", "alpha"]], Meaning::Number(1.0)),
    (&[&["ior", "eta"]], Meaning::Number(1.5)),
    (&[&["f0", "reflectance"]], Meaning::Number(0.04)),
    (&[&["exposure"]], Meaning::Number(1.0)),
    (&[&["gamma"]], Meaning::Number(2.2)),
    (&[&["bias", "epsilon", "eps"]], Meaning::Number(0.005)),
    (&[COLOR], CORAL),
    (
        &[&["bands", "levels", "steps", "cells", "octaves", "iterations", "samples"]],
        Meaning::Number(4.0),
    ),
    (&[&["power", "exponent", "sharpness"]], Meaning::Number(4.0)),
    (
        &[&["scale", "frequency", "tiling", "zoom", "speed", "gain", "contrast"]],
        Meaning::Number(1.0),
    ),
    (&[&["threshold", "mix", "blend", "softness", "smoothness"]], Meaning::Number(0.5)),
    (&[STRENGTH], Meaning::Number(1.0)),
    (&[&["r", "g", "b", "red", "green", "blue"]], Meaning::Number(0.8)),
];

/// What a vector means whose only word is this one.
const ALONE: &[(&[&str], Meaning)] = &[
    (LIGHT, Meaning::LightDirection),
    (EYE, Meaning::EyePosition),
    (&["v"], Meaning::EyePosition),
    (&["up"], Meaning::Color([0.0, 1.0, 0.0])),
    (&["kd", "ka"], CORAL),
];

/// The meaning of a uniform: `block` is the name of what it is a member of, if of anything.
pub fn uniform_meaning(block: &str, name: &str, ty: NumberType) -> Option<Meaning> {
    let (outer, own) = (name_words(block), name_words(name));
    let both: Vec<String> = outer.iter().chain(&own).cloned().collect();
    // In a block of a light, a camera or fog, the words of block and name together count first.
    let is_part = [LIGHT, EYE, FOG].iter().any(|words| has_word(&outer, words));
    let order = if is_part { [&both, &own] } else { [&own, &both] };
    let ruled = order.into_iter().find_map(|words| {
        let fits = |groups: &&[&[&str]]| groups.iter().all(|group| has_word(words, group));
        RULES.iter().find(|(groups, _)| fits(groups)).map(|(_, meaning)| *meaning)
    });
    let alone = || {
        let word = own.first().filter(|_| own.len() == 1 && ty.rows >= 3)?;
        let found = ALONE.iter().find(|(words, _)| words.contains(&word.as_str()));
        found.map(|(_, meaning)| *meaning)
    };
    ruled.or_else(alone)
}

/// What a control for a uniform has to know of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UniformRole {
    /// Seconds.
    Time,
    /// Three or four numbers that a person sees as a colour.
    Color,
}

/// The role of a uniform by its path and its type in WGSL, where its name says one.
pub fn uniform_role(path: &str, ty: &str) -> Option<UniformRole> {
    let ty = NumberType::of(ty);
    let (block, name) = path.rsplit_once('.').unwrap_or(("", path));
    let is_color =
        !ty.is_integer && !ty.is_matrix() && ty.rows >= 3 && has_word(&name_words(name), COLOR);
    match uniform_meaning(block, name, ty) {
        Some(Meaning::Time) => Some(UniformRole::Time),
        Some(Meaning::Color(_)) if ty.rows >= 3 && !ty.is_matrix() => Some(UniformRole::Color),
        _ => is_color.then_some(UniformRole::Color),
    }
}

/// The numbers of a uniform by its path, such as `lights[1].color`, and what they are. `is_negated`
/// says whether the shader writes a minus before a name. `None` if nothing suggests any.
pub fn default_numbers(
    path: &str,
    ty: NumberType,
    around: &Around<'_>,
    is_negated: &dyn Fn(&str) -> bool,
) -> Option<(Vec<f64>, String)> {
    let (block, name) = path.rsplit_once('.').unwrap_or(("", path));
    if ty.is_matrix() {
        return matrix_numbers(block, name, ty, around);
    }
    let meaning = uniform_meaning(block, name, ty)?;
    let index = path.split(['[', ']']).nth(1).and_then(|index| index.parse().ok()).unwrap_or(0);
    let numbers = meaning_numbers(meaning, ty, index, around, &|| is_negated(path));
    let numbers: Vec<f64> =
        numbers.into_iter().map(|one| if ty.is_integer { one.floor() } else { one }).collect();
    let text = numbers_text(&numbers);
    Some((numbers, text))
}

fn meaning_numbers(
    meaning: Meaning,
    ty: NumberType,
    index: usize,
    around: &Around<'_>,
    is_negated: &dyn Fn() -> bool,
) -> Vec<f64> {
    let [width, height] = around.size.map(f64::from);
    let one = |number: f64| [number; 4];
    let place = |vector: DVec3| vector.extend(1.0).to_array();
    let direction = |vector: DVec3| vector.extend(0.0).to_array();
    let lamp = around.lamp(index);
    let all = match meaning {
        Meaning::Time => one(around.time),
        Meaning::Frame => one((around.time * 60.0).floor()),
        Meaning::Size => DVec4::new(width, height, 1.0, 1.0).to_array(),
        Meaning::ChannelSize => {
            let side = f64::from(super::textures::SIDE);
            DVec4::new(side, side, 1.0, 1.0).to_array()
        }
        Meaning::Aspect => one(width / height.max(1.0)),
        Meaning::PixelSize => DVec4::new(1.0 / width, 1.0 / height, 1.0, 1.0).to_array(),
        Meaning::EyePosition => place(around.eye.position),
        Meaning::EyeDirection => {
            direction((around.eye.target - around.eye.position).normalize_or(DVec3::NEG_Z))
        }
        Meaning::Near => one(around.eye.near),
        Meaning::Far => one(around.eye.far),
        Meaning::FieldOfView => one(around.eye.fov_y),
        Meaning::LightPosition => place(lamp.position),
        Meaning::LightDirection => direction(if is_negated() { lamp.axis() } else { -lamp.axis() }),
        Meaning::LightPower => one(0.6 * lamp.reach().powi(2)),
        Meaning::Number(number) => {
            DVec3::splat(number).extend(if number == 0.0 { 0.0 } else { 1.0 }).to_array()
        }
        Meaning::Color(color) => DVec3::from_array(color).extend(1.0).to_array(),
    };
    // The strength of a colour, for a single number.
    let all = match meaning {
        Meaning::Color(_) if ty.rows == 1 => one(0.8),
        _ => all,
    };
    all[..ty.rows.min(4)].to_vec()
}

#[cfg(test)]
mod tests {
    use super::{Meaning, UniformRole, uniform_meaning, uniform_role};
    use crate::own::shape::NumberType;

    #[test]
    fn roles_of_uniforms() {
        for (path, ty, expected) in [
            ("iTime", "f32", Some(UniformRole::Time)),
            ("frame.time", "f32", Some(UniformRole::Time)),
            ("tint", "vec4<f32>", Some(UniformRole::Color)),
            ("light.ambient_colour", "vec3<f32>", Some(UniformRole::Color)),
            ("material.diffuse", "vec3<f32>", Some(UniformRole::Color)),
            ("color_count", "u32", None),
            ("light.position", "vec3<f32>", None),
            ("color_from_world", "mat4x4<f32>", None),
        ] {
            assert_eq!(uniform_role(path, ty), expected, "{path}");
        }
    }

    /// Names of LearnOpenGL, three.js, Shadertoy, WebGPU's samples and of this library's guide.
    #[test]
    fn meanings_of_names() {
        let cases = [
            ("", "lightPos", "vec3<f32>", Some(Meaning::LightPosition)),
            ("", "viewPos", "vec3<f32>", Some(Meaning::EyePosition)),
            ("light", "direction", "vec3<f32>", Some(Meaning::LightDirection)),
            ("pointLights[2]", "position", "vec3<f32>", Some(Meaning::LightPosition)),
            ("light", "diffuse", "vec3<f32>", Some(super::WHITE)),
            ("dirLight", "specular", "vec3<f32>", Some(super::WHITE)),
            ("dirLight", "direction", "vec3<f32>", Some(Meaning::LightDirection)),
            ("spotLight", "cutOff", "f32", Some(Meaning::Number(0.976_296))),
            ("light", "ambient", "vec3<f32>", Some(Meaning::Number(0.2))),
            ("light", "quadratic", "f32", Some(Meaning::Number(0.032))),
            ("material", "shininess", "f32", Some(Meaning::Number(32.0))),
            ("material", "diffuse", "vec3<f32>", Some(super::CORAL)),
            ("", "objectColor", "vec3<f32>", Some(super::CORAL)),
            ("", "lightColor", "vec3<f32>", Some(super::WHITE)),
            ("", "cameraPosition", "vec3<f32>", Some(Meaning::EyePosition)),
            ("camera", "position", "vec3<f32>", Some(Meaning::EyePosition)),
            ("camera", "time", "f32", Some(Meaning::Time)),
            ("frame", "eye_position", "vec3<f32>", Some(Meaning::EyePosition)),
            ("", "iResolution", "vec3<f32>", Some(Meaning::Size)),
            ("", "iTime", "f32", Some(Meaning::Time)),
            ("", "iTimeDelta", "f32", Some(Meaning::Number(1.0 / 60.0))),
            ("", "iChannelResolution[1]", "vec3<f32>", Some(Meaning::ChannelSize)),
            ("", "iMouse", "vec4<f32>", Some(Meaning::Number(0.0))),
            ("", "u_resolution", "vec2<f32>", Some(Meaning::Size)),
            ("lamp", "power", "f32", Some(Meaning::LightPower)),
            ("lamp", "position", "vec3<f32>", Some(Meaning::LightPosition)),
            ("", "sun", "vec3<f32>", Some(Meaning::LightDirection)),
            ("", "eye", "vec3<f32>", Some(Meaning::EyePosition)),
            ("", "l", "vec3<f32>", Some(Meaning::LightDirection)),
            ("", "bands", "f32", Some(Meaning::Number(4.0))),
            ("", "whatever", "vec3<f32>", None),
        ];
        for (block, name, ty, expected) in cases {
            assert_eq!(
                uniform_meaning(block, name, NumberType::of(ty)),
                expected,
                "{block}.{name}"
            );
        }
    }
}

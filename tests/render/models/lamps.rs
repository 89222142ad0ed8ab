//! Lamps of KHR_lights_punctual: as bright at each place as the extension's formulas say.

use std::f64::consts::PI;

use glam::DVec3;
use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};

use super::sides::{seen, seen_with};
use super::{BEFORE, demand, drawn, glb, is_near, pixel, square};

const FRONT: &str = BEFORE[1];

pub fn tests() -> impl Iterator<Item = Trial> {
    let cases: [(_, fn() -> _); 7] = [
        ("inverse_square", inverse_square),
        ("range_ends", range_ends),
        ("cone_between_its_angles", cone_between),
        ("second_sun_is_whole", second_sun_is_whole),
        ("eleventh_is_noted", eleventh_is_noted),
        ("daylight_is_exposed", daylight_is_exposed),
        ("large_models_are_lit", large_models_are_lit),
    ];
    cases.into_iter().map(|(name, run)| Trial::test(format!("render/model/lamp/{name}"), run))
}

/// A white matt square with nodes that have one lamp each. A lamp of pi candela at distance 1, or of pi
/// lux, gives it the colour 1 where it faces the lamp.
fn lit_square(lamps: &[(Value, Value)]) -> (Value, Vec<u8>) {
    let (mut document, buffer) = square(&[]);
    document["materials"] = json!([{
        "pbrMetallicRoughness": { "metallicFactor": 0.0 },
        "extensions": { "KHR_materials_specular": { "specularFactor": 0.0 } },
    }]);
    document["extensionsUsed"] = json!(["KHR_lights_punctual", "KHR_materials_specular"]);
    let lights: Vec<&Value> = lamps.iter().map(|lamp| &lamp.0).collect();
    document["extensions"] = json!({ "KHR_lights_punctual": { "lights": lights } });
    let mut nodes = vec![json!({ "mesh": 0 })];
    for (index, (_, place)) in lamps.iter().enumerate() {
        let mut node = place.clone();
        node["extensions"] = json!({ "KHR_lights_punctual": { "light": index } });
        nodes.push(node);
    }
    document["scenes"] = json!([{ "nodes": (0..nodes.len()).collect::<Vec<_>>() }]);
    document["nodes"] = nodes.into();
    (document, buffer)
}

fn at(place: [f64; 3]) -> Value {
    json!({ "translation": place })
}

fn is_light(found: f64, expected: f64, what: &str) -> Result<(), Failed> {
    demand((found - expected).abs() < 0.01, || format!("{what}: {found}, expected {expected}"))
}

/// A lamp of pi/4 candela at distance 1 and one of pi/2 at distance 2: 1/4 and 1/8.
fn inverse_square() -> Result<(), Failed> {
    for (candela, distance, expected) in [(0.25 * PI, 1.0, 0.25), (0.5 * PI, 2.0, 0.125)] {
        let lamp = json!({ "type": "point", "intensity": candela });
        let (document, buffer) = lit_square(&[(lamp, at([0.0, 0.0, distance]))]);
        is_light(seen(&document, &buffer, FRONT)?, expected, &format!("distance {distance}"))?;
    }
    Ok(())
}

/// "attenuation = max(min(1.0 - (current_distance / range)^4, 1), 0) / current_distance^2".
fn range_ends() -> Result<(), Failed> {
    for (range, expected) in [(2.0, 15.0 / 16.0), (1.25, 1.0 - 0.8_f64.powi(4)), (0.5, 0.0)] {
        let lamp = json!({ "type": "point", "intensity": PI, "range": range });
        let (document, buffer) = lit_square(&[(lamp, at([0.0, 0.0, 1.0]))]);
        is_light(seen(&document, &buffer, FRONT)?, expected, &format!("range {range}"))?;
    }
    Ok(())
}

/// The extension's "Inner and Outer Cone Angles": the square of a ramp in the cosine, from the outer
/// angle to the inner one. The lamp is turned away from the middle of the square by 0.6 radians.
fn cone_between() -> Result<(), Failed> {
    // The pixel in the middle is half of a pixel off it: a pixel of 48 in 0.7 radians.
    let off = 5.5 * 0.35_f64.tan() / 48.0;
    let away = DVec3::new(off, -off, -1.0);
    let axis = DVec3::new(0.0, 0.6_f64.sin(), -0.6_f64.cos());
    let cosine = away.normalize().dot(axis);
    let arriving = away.normalize().z.abs() / away.length_squared();
    let ramp = |inner: f64, outer: f64| {
        let scale = 1.0 / (inner.cos() - outer.cos()).max(0.001);
        arriving * (cosine * scale - outer.cos() * scale).clamp(0.0, 1.0).powi(2)
    };
    let turn = [0.3_f64.sin(), 0.0, 0.0, 0.3_f64.cos()];
    for (inner, outer) in [(0.0, 0.8), (0.4, 0.8), (0.75, 0.8), (0.4, 0.5)] {
        let lamp = json!({ "type": "spot", "intensity": PI,
            "spot": { "innerConeAngle": inner, "outerConeAngle": outer } });
        let place = json!({ "translation": [0.0, 0.0, 1.0], "rotation": turn });
        let (document, buffer) = lit_square(&[(lamp, place)]);
        let what = format!("angles {inner} and {outer}");
        is_light(seen(&document, &buffer, FRONT)?, ramp(inner, outer), &what)?;
    }
    Ok(())
}

/// Two lamps of one direction, the first of which is dark: half of pi lux is one half.
fn second_sun_is_whole() -> Result<(), Failed> {
    let sun = |lux: f64| (json!({ "type": "directional", "intensity": lux }), json!({}));
    let (document, buffer) = lit_square(&[sun(0.0), sun(0.5 * PI)]);
    is_light(seen(&document, &buffer, FRONT)?, 0.5, "second")
}

fn eleventh_is_noted() -> Result<(), Failed> {
    let sun = (json!({ "type": "directional", "intensity": 0.05 * PI }), json!({}));
    let (document, buffer) = lit_square(&vec![sun; 11]);
    let (_, stderr) = drawn(&glb(&document, &buffer), &[])?;
    let note = "of 11 lamps, the first 10 are drawn";
    demand(stderr.contains(note), || format!("expected `{note}` in `{stderr}`"))
}

/// A sun of 256 pi lux gives a white surface 256 times the colour 1, which is eight stops too much. The
/// note says so, and the picture is then right: half of it where the lamp is at 60 degrees.
fn daylight_is_exposed() -> Result<(), Failed> {
    let turn = [0.0, (PI / 6.0).sin(), 0.0, (PI / 6.0).cos()];
    let sun =
        (json!({ "type": "directional", "intensity": 256.0 * PI }), json!({ "rotation": turn }));
    let (document, buffer) = lit_square(&[sun]);
    let alone = ["--set", "ambient=none,shadow=none,shadow_light=spot"];
    let arguments = [&BEFORE[..], &alone, &["--exposure", "-8"]].concat();
    let (picture, stderr) = drawn(&glb(&document, &buffer), &arguments)?;
    demand(stderr.contains("256 times what a picture shows: try --exposure -8"), || stderr)?;
    let found = pixel(&picture, 0.5, 0.5);
    demand(is_near(found, [188; 3], 2), || format!("found {found:?}, expected 188, one half"))
}

/// A model without lamps looks the same at any size.
fn large_models_are_lit() -> Result<(), Failed> {
    let lit = |scale: f64| {
        let (mut document, buffer) = square(&[]);
        document["nodes"] = json!([{ "mesh": 0, "scale": [scale, scale, scale] }]);
        let camera = format!("0,0,{},0,0,0", 5.5 * scale);
        seen_with(&document, &buffer, &camera, "shadow=none")
    };
    let expected = lit(1.0)?;
    demand(expected > 0.1, || format!("{expected} of the lamp"))?;
    for scale in [1e3, 1e5] {
        is_light(lit(scale)?, expected, &format!("scale {scale}"))?;
    }
    Ok(())
}

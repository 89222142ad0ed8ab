//! Backs and mirrored meshes: normal maps and brushes are on them as the definition says, which the
//! light of one lamp shows.

use lamplight::scene::linear_from_srgb;
use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};

use super::{demand, drawn, glb, image, pixel, square};

/// Cameras in front of the square and behind it.
const FRONT: &str = "0,0,5.5,0,0,0";
const BACK: &str = "0,0,-5.5,0,0,0";

pub fn tests() -> impl Iterator<Item = Trial> {
    let cases: [(_, fn() -> _); 6] = [
        ("bent_behind", bent_behind),
        ("brushed_behind", brushed_behind),
        ("bent_by_a_scale", bent_by_a_scale),
        ("bent_when_mirrored", bent_when_mirrored),
        ("bent_by_tangents_that_are_mirrored", bent_by_given_tangents),
        ("leaf_is_not_its_own_shadow", leaf_is_lit),
    ];
    cases.into_iter().map(|(name, run)| Trial::test(format!("render/model/side/{name}"), run))
}

/// A white matt surface whose map bends its normal to 0.6 of the tangent or of the bitangent, and 0.8
/// of the normal.
fn matt(texel: [u8; 3]) -> Result<(Value, Vec<u8>), Failed> {
    let (mut document, buffer) = square(&[image([texel; 4])?]);
    document["materials"] = json!([{
        "doubleSided": true,
        "normalTexture": { "index": 0 },
        "pbrMetallicRoughness": { "metallicFactor": 0.0 },
        "extensions": { "KHR_materials_specular": { "specularFactor": 0.0 } },
    }]);
    Ok((document, buffer))
}

const ALONG_TANGENT: [u8; 3] = [204, 128, 230];
const ALONG_BITANGENT: [u8; 3] = [128, 204, 230];

/// A lamp of pi lux in the direction `to`, in the place of all others of the document. It gives a
/// white matt surface that faces it the colour 1.
pub fn light_from(document: &mut Value, to: [f64; 3]) {
    let turn = glam::DQuat::from_rotation_arc(glam::DVec3::Z, glam::DVec3::from(to).normalize());
    document["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    document["extensions"] = json!({ "KHR_lights_punctual": { "lights": [
        { "type": "directional", "intensity": std::f64::consts::PI },
    ] } });
    let mesh = document["nodes"][0].clone();
    document["nodes"] = json!([
        mesh,
        { "rotation": turn.to_array(), "extensions": { "KHR_lights_punctual": { "light": 0 } } },
    ]);
    document["scenes"] = json!([{ "nodes": [0, 1] }]);
}

/// The light in the middle of the picture, without that of the surroundings.
pub fn seen(document: &Value, buffer: &[u8], camera: &str) -> Result<f64, Failed> {
    seen_with(document, buffer, camera, "shadow=none,shadow_light=spot")
}

pub fn seen_with(document: &Value, buffer: &[u8], camera: &str, set: &str) -> Result<f64, Failed> {
    let alone = ["--camera", camera, "--set", "ambient=none", "--set", set];
    let (picture, _) = drawn(&glb(document, buffer), &alone)?;
    Ok(linear_from_srgb(f64::from(pixel(&picture, 0.5, 0.5)[0]) / 255.0))
}

/// Fails if the light is not the cosine between a lamp and the normal.
fn demand_light(found: f64, cosine: f64, what: &str) -> Result<(), Failed> {
    demand((found - cosine).abs() < 0.02, || format!("{what}: found {found}, expected {cosine}"))
}

/// The bent normal of the back is the opposite of that of the front. So the lamp opposite to the
/// front's gives the back the same light.
fn bent_behind() -> Result<(), Failed> {
    for texel in [ALONG_TANGENT, ALONG_BITANGENT] {
        let (mut document, buffer) = matt(texel)?;
        let [x, y] = if texel == ALONG_TANGENT { [0.6, 0.0] } else { [0.0, 0.6] };
        for (camera, to, cosine) in [
            (FRONT, [x, y, 0.8], 1.0),
            (FRONT, [-x, -y, 0.8], 0.28),
            (BACK, [-x, -y, -0.8], 1.0),
            (BACK, [x, y, -0.8], 0.28),
        ] {
            light_from(&mut document, to);
            let found = seen(&document, &buffer, camera)?;
            demand_light(found, cosine, &format!("{texel:?} from {camera}, lamp at {to:?}"))?;
        }
    }
    Ok(())
}

/// `normalTexture.scale` multiplies the parts along the tangent and the bitangent.
fn bent_by_a_scale() -> Result<(), Failed> {
    let (mut document, buffer) = matt(ALONG_TANGENT)?;
    for scale in [0.0_f64, 0.5, 1.0, 2.0] {
        document["materials"][0]["normalTexture"]["scale"] = json!(scale);
        light_from(&mut document, [0.0, 0.0, 1.0]);
        let cosine = 0.8 / (0.6 * scale).hypot(0.8);
        let found = seen(&document, &buffer, FRONT)?;
        demand_light(found, cosine, &format!("scale {scale}"))?;
    }
    Ok(())
}

/// A mesh that is mirrored along x has the mirrored normals.
fn bent_when_mirrored() -> Result<(), Failed> {
    mirrored(|_, _| Ok(()))
}

/// The same, if the file has the tangents.
fn bent_by_given_tangents() -> Result<(), Failed> {
    mirrored(|document, buffer| {
        super::add_attribute(document, buffer, "NORMAL", &[[0.0, 0.0, 1.0]; 4])?;
        super::add_attribute(document, buffer, "TANGENT", &[[1.0, 0.0, 0.0, 1.0]; 4])
    })
}

fn mirrored(change: fn(&mut Value, &mut Vec<u8>) -> Result<(), Failed>) -> Result<(), Failed> {
    for (texel, to) in [(ALONG_TANGENT, [-0.6, 0.0, 0.8]), (ALONG_BITANGENT, [0.0, 0.6, 0.8])] {
        let (mut document, mut buffer) = matt(texel)?;
        change(&mut document, &mut buffer)?;
        document["nodes"] = json!([{ "mesh": 0, "scale": [-1.0, 1.0, 1.0] }]);
        light_from(&mut document, to);
        demand_light(seen(&document, &buffer, FRONT)?, 1.0, &format!("{texel:?}"))?;
    }
    Ok(())
}

/// A brush in a direction between tangent and bitangent is the same line on both sides. So the back
/// looks as the front does, if the lamp and the viewer are mirrored in the surface.
fn brushed_behind() -> Result<(), Failed> {
    let (mut document, buffer) = square(&[]);
    document["materials"] = json!([{
        "doubleSided": true,
        "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.5, 0.5, 1.0], "roughnessFactor": 0.5 },
        "extensions": { "KHR_materials_anisotropy": {
            "anisotropyStrength": 0.9, "anisotropyRotation": std::f64::consts::FRAC_PI_4 } },
    }]);
    let mut light = |camera, to| {
        light_from(&mut document, to);
        seen(&document, &buffer, camera)
    };
    let front = light(FRONT, [0.4, 0.4, 0.8])?;
    let back = light(BACK, [0.4, 0.4, -0.8])?;
    let across = light(FRONT, [0.4, -0.4, 0.8])?;
    demand((front - across).abs() > 0.1, || format!("{front} and {across} do not differ"))?;
    demand((front - back).abs() < 0.01, || format!("front {front}, back {back}"))
}

/// A leaf that scatters all light to its other side has half of a lamp's light at 60 degrees from
/// behind, and casts no shadow onto itself.
fn leaf_is_lit() -> Result<(), Failed> {
    let (mut document, buffer) = square(&[]);
    document["materials"] = json!([{
        "doubleSided": true,
        "pbrMetallicRoughness": { "metallicFactor": 0.0 },
        "extensions": {
            "KHR_materials_specular": { "specularFactor": 0.0 },
            "KHR_materials_diffuse_transmission": { "diffuseTransmissionFactor": 1.0 },
        },
    }]);
    light_from(&mut document, [0.75_f64.sqrt(), 0.0, -0.5]);
    for shadow in ["hard", "pcf_3x3", "pcf_vogel"] {
        let set = format!("shadow={shadow},shadow_light=directional");
        let found = seen_with(&document, &buffer, "0.5,0.2,4,0,0,0", &set)?;
        demand_light(found, 0.5, shadow)?;
    }
    Ok(())
}

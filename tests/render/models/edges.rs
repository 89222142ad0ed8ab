//! Factors at the ends of their ranges: a coat without roughness, a film without thickness, a volume
//! without thickness, and normals that point away from the viewer.

use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};

use super::sides::{light_from, seen, seen_with};
use super::{BEFORE, add_attribute, demand, drawn, glb, is_near, pixel, square};

const FRONT: &str = BEFORE[1];

pub fn tests() -> impl Iterator<Item = Trial> {
    let cases: [(_, fn() -> _); 6] = [
        ("deferred_has_the_materials", deferred_is_the_same),
        ("units_of_both_models", units_agree),
        ("smooth_coat_has_a_highlight", coat_is_seen),
        ("film_without_thickness", film_is_absent),
        ("volume_without_thickness", thin_wall_is_thin),
        ("normals_beyond_the_outline", outline_is_lit),
    ];
    cases.into_iter().map(|(name, run)| Trial::test(format!("render/model/edge/{name}"), run))
}

fn of_material(material: &Value) -> (Value, Vec<u8>) {
    let (mut document, buffer) = square(&[]);
    document["materials"] = json!([material]);
    (document, buffer)
}

/// glTF's default for the roughness of a coat is 0. A lamp that it mirrors to the viewer is as bright
/// as the picture can show, though it has no size.
fn coat_is_seen() -> Result<(), Failed> {
    let lit = |coat: f64| {
        let (mut document, buffer) = of_material(&json!({
            "pbrMetallicRoughness": { "baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0.0 },
            "extensions": { "KHR_materials_clearcoat": { "clearcoatFactor": coat } },
        }));
        light_from(&mut document, [0.0, 0.0, 1.0]);
        seen(&document, &buffer, FRONT)
    };
    let (with, without) = (lit(1.0)?, lit(0.0)?);
    demand(with > 0.99 && without < 0.1, || format!("found {with}, without a coat {without}"))
}

/// A film of no thickness leaves what is without a film.
fn film_is_absent() -> Result<(), Failed> {
    let with = |set: &str| {
        let (mut document, buffer) = of_material(&json!({
            "pbrMetallicRoughness": { "baseColorFactor": [0.1, 0.2, 0.3, 1], "metallicFactor": 0.5,
                "roughnessFactor": 0.3 },
            "extensions": { "KHR_materials_iridescence":
                { "iridescenceFactor": 1.0, "iridescenceThicknessMaximum": 0.0 } },
        }));
        document["nodes"] = json!([{ "mesh": 0, "rotation": [0.0, 0.5, 0.0, 0.75_f64.sqrt()] }]);
        drawn(&glb(&document, &buffer), &[&BEFORE[..], &["--set", set]].concat())
    };
    let ((film, _), (none, _)) = (with("iridescence=true")?, with("iridescence=false")?);
    let most = film.pixels.iter().zip(&none.pixels).map(|(a, b)| a.abs_diff(*b)).max();
    demand(most <= Some(1), || format!("a byte differs by {most:?}"))
}

/// KHR_materials_volume: "if the value is 0 the material is thin-walled", and light goes straight on.
fn thin_wall_is_thin() -> Result<(), Failed> {
    let seen_through = |thickness: f64, set: &str| {
        let (document, buffer) = of_material(&json!({
            "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": 0.2 },
            "extensions": {
                "KHR_materials_transmission": { "transmissionFactor": 1.0 },
                "KHR_materials_volume": { "thicknessFactor": thickness },
            },
        }));
        let checks = ["--environment", "checks", "--camera", "3,1,4,0,0,0", "--set", set];
        drawn(&glb(&document, &buffer), &checks)
    };
    let (thin, _) = seen_through(0.0, "volume=false")?;
    let (as_volume, _) = seen_through(0.0, "volume=true")?;
    let (thick, _) = seen_through(1.0, "volume=true")?;
    demand(thin.pixels == as_volume.pixels, || "`volume` bends light at thickness 0".to_owned())?;
    demand(thin.pixels != thick.pixels, || "a thickness of 1 does not bend light".to_owned())
}

/// A normal two degrees beyond the outline reflects nearly what one just before it does.
fn outline_is_lit() -> Result<(), Failed> {
    let lit = |degrees: f64| {
        let (mut document, mut buffer) = of_material(&json!({
            "pbrMetallicRoughness": { "metallicFactor": 1.0, "roughnessFactor": 0.6 } }));
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let normal = [sine as f32, 0.0, cosine as f32];
        add_attribute(&mut document, &mut buffer, "NORMAL", &[normal; 4])?;
        light_from(&mut document, [0.8, 0.0, 0.6]);
        seen(&document, &buffer, FRONT)
    };
    let (before, beyond) = (lit(89.0)?, lit(91.0)?);
    demand(before > 0.1 && (before - beyond).abs() < 0.15 * before, || {
        format!("89 degrees: {before}, 91 degrees: {beyond}")
    })
}

/// A white metal of roughness 1 reflects pi*D*V = 1/4 of a lamp of pi lux, straight back. With glTF's
/// model, what facets reflect several times is added.
fn units_agree() -> Result<(), Failed> {
    let (mut document, buffer) = of_material(&json!({
        "pbrMetallicRoughness": { "metallicFactor": 1.0, "roughnessFactor": 1.0 } }));
    light_from(&mut document, [0.0, 0.0, 1.0]);
    let lit = |set: &str| {
        seen_with(&document, &buffer, FRONT, &format!("shadow=none,shadow_light=spot,{set}"))
    };
    let (plain, of_gltf) = (lit("metallic_roughness=false")?, lit("metallic_roughness=true")?);
    demand((plain - 0.25).abs() < 0.01, || format!("found {plain}, expected 0.25"))?;
    demand(of_gltf > 0.7 && of_gltf < 1.0, || format!("found {of_gltf} with glTF's model"))
}

/// `deferred` lights a model as `forward` does, without any choice of the user.
fn deferred_is_the_same() -> Result<(), Failed> {
    let (mut document, buffer) = of_material(&json!({
        "pbrMetallicRoughness": { "metallicFactor": 1.0, "roughnessFactor": 1.0 } }));
    light_from(&mut document, [0.0, 0.0, 1.0]);
    let lit = |program: &str| {
        drawn(&glb(&document, &buffer), &[&BEFORE[..], &["--program", program]].concat())
    };
    let ((one, _), (other, _)) = (lit("forward")?, lit("deferred")?);
    let [found, expected] = [&other, &one].map(|picture| pixel(picture, 0.5, 0.5));
    demand(is_near(found, expected, 3), || format!("deferred {found:?}, forward {expected:?}"))
}

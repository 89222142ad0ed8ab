//! Textures of models that multiply factors: each quarter of a square looks as if the factors of the
//! whole square were those of the texture's pixel.

use lamplight::scene::linear_from_srgb;
use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};

use super::{BEFORE, demand, drawn, glb, image, is_near, pixel, square};

type Pixel = [u8; 3];

/// A name, the material with its texture, the pixels of two quarters, and the material that has the
/// factors of a pixel instead.
struct Row {
    name: &'static str,
    textured: fn() -> Value,
    pixels: [Pixel; 2],
    factors: fn([f64; 3]) -> Value,
}

const ROWS: [Row; 9] = [
    Row {
        name: "metal_and_roughness",
        textured: || {
            json!({ "pbrMetallicRoughness": {
            "baseColorFactor": COLOR, "metallicRoughnessTexture": TEXTURE } })
        },
        pixels: [[0, 102, 255], [255, 204, 0]],
        factors: |[_, rough, metal]| {
            json!({ "pbrMetallicRoughness": { "baseColorFactor": COLOR,
            "roughnessFactor": rough, "metallicFactor": metal } })
        },
    },
    Row {
        name: "emission",
        textured: || {
            json!({ "emissiveFactor": [1, 1, 1], "emissiveTexture": TEXTURE,
            "pbrMetallicRoughness": { "baseColorFactor": BLACK, "metallicFactor": 0.0 } })
        },
        pixels: [[90, 0, 130], [10, 120, 20]],
        factors: |color| {
            json!({ "emissiveFactor": color.map(linear_from_srgb),
            "pbrMetallicRoughness": { "baseColorFactor": BLACK, "metallicFactor": 0.0 } })
        },
    },
    Row {
        name: "specular_color",
        textured: || extended("KHR_materials_specular", json!({ "specularColorTexture": TEXTURE })),
        pixels: [[255, 60, 0], [0, 0, 255]],
        factors: |color| {
            extended(
                "KHR_materials_specular",
                json!({ "specularColorFactor": color.map(linear_from_srgb) }),
            )
        },
    },
    Row {
        name: "clearcoat",
        textured: || {
            extended(
                "KHR_materials_clearcoat",
                json!({ "clearcoatFactor": 1.0,
            "clearcoatRoughnessFactor": 1.0, "clearcoatTexture": TEXTURE,
            "clearcoatRoughnessTexture": TEXTURE }),
            )
        },
        pixels: [[255, 51, 0], [102, 204, 0]],
        factors: |[coat, rough, _]| {
            extended(
                "KHR_materials_clearcoat",
                json!({ "clearcoatFactor": coat, "clearcoatRoughnessFactor": rough }),
            )
        },
    },
    Row {
        name: "sheen",
        textured: || {
            extended(
                "KHR_materials_sheen",
                json!({ "sheenColorFactor": [1, 1, 1],
            "sheenRoughnessFactor": 1.0, "sheenColorTexture": TEXTURE }),
            )
        },
        pixels: [[255, 60, 0], [0, 160, 255]],
        factors: |color| {
            extended(
                "KHR_materials_sheen",
                json!({ "sheenColorFactor": color.map(linear_from_srgb), "sheenRoughnessFactor": 1.0 }),
            )
        },
    },
    Row {
        name: "iridescence",
        textured: || {
            extended(
                "KHR_materials_iridescence",
                json!({ "iridescenceFactor": 1.0,
            "iridescenceThicknessMinimum": 200.0, "iridescenceThicknessMaximum": 600.0,
            "iridescenceTexture": TEXTURE, "iridescenceThicknessTexture": TEXTURE }),
            )
        },
        pixels: [[255, 51, 0], [204, 204, 0]],
        factors: |[film, share, _]| {
            extended(
                "KHR_materials_iridescence",
                json!({ "iridescenceFactor": film, "iridescenceThicknessMaximum": 200.0 + 400.0 * share }),
            )
        },
    },
    Row {
        name: "anisotropy",
        textured: || {
            extended(
                "KHR_materials_anisotropy",
                json!({ "anisotropyStrength": 1.0,
            "anisotropyRotation": 0.3, "anisotropyTexture": TEXTURE }),
            )
        },
        pixels: [[128, 255, 230], [255, 128, 128]],
        factors: |[x, y, strength]| {
            extended(
                "KHR_materials_anisotropy",
                json!({ "anisotropyStrength": strength,
                "anisotropyRotation": 0.3 + (2.0 * y - 1.0).atan2(2.0 * x - 1.0) }),
            )
        },
    },
    Row {
        name: "transmission_and_thickness",
        textured: || {
            let mut own = extended(
                "KHR_materials_volume",
                json!({ "thicknessFactor": 2.0,
                "attenuationDistance": 0.5, "attenuationColor": [0.2, 0.9, 0.2],
                "thicknessTexture": TEXTURE }),
            );
            own["extensions"]["KHR_materials_transmission"] =
                json!({ "transmissionFactor": 1.0, "transmissionTexture": TEXTURE });
            own
        },
        pixels: [[230, 128, 0], [128, 26, 0]],
        factors: |[passing, thickness, _]| {
            let mut own = extended(
                "KHR_materials_volume",
                json!({ "thicknessFactor": 2.0 * thickness,
                "attenuationDistance": 0.5, "attenuationColor": [0.2, 0.9, 0.2] }),
            );
            own["extensions"]["KHR_materials_transmission"] =
                json!({ "transmissionFactor": passing });
            own
        },
    },
    Row {
        name: "diffuse_transmission",
        textured: || {
            extended(
                "KHR_materials_diffuse_transmission",
                json!({ "diffuseTransmissionFactor": 0.8, "diffuseTransmissionColorTexture": TEXTURE }),
            )
        },
        pixels: [[60, 255, 0], [255, 0, 200]],
        factors: |color| {
            extended(
                "KHR_materials_diffuse_transmission",
                json!({ "diffuseTransmissionFactor": 0.8,
                "diffuseTransmissionColorFactor": color.map(linear_from_srgb) }),
            )
        },
    },
];

const COLOR: [f64; 4] = [0.2, 0.1, 0.06, 1.0];
const BLACK: [f64; 4] = [0.0, 0.0, 0.0, 1.0];
const TEXTURE: Texture = Texture { index: 0 };

#[derive(serde::Serialize)]
struct Texture {
    index: u32,
}

pub fn tests() -> impl Iterator<Item = Trial> {
    let each = ROWS
        .iter()
        .map(|row| Trial::test(format!("render/model/map/{}", row.name), || agrees(row)));
    let others: [(_, fn() -> _); 2] =
        [("occlusion", occlusion_is_mapped), ("none_there", none_there)];
    each.chain(others.map(|(name, run)| Trial::test(format!("render/model/map/{name}"), run)))
}

/// A half metal with one extension.
fn extended(name: &str, values: Value) -> Value {
    json!({ "extensions": { name: values }, "pbrMetallicRoughness":
        { "baseColorFactor": COLOR, "metallicFactor": 0.2, "roughnessFactor": 0.5 } })
}

/// The square, tilted so that the viewer sees highlights.
fn tilted(image_bytes: &[Vec<u8>], material: Value) -> Vec<u8> {
    let (mut document, buffer) = square(image_bytes);
    document["materials"] = json!([material]);
    document["nodes"] = json!([{ "mesh": 0, "rotation": [-0.12, -0.1, 0.0, 0.98] }]);
    glb(&document, &buffer)
}

/// The left and the right half of the square, which have different pixels, look like the same
/// places of squares without a texture, whose factors are those of the pixel.
fn agrees(row: &Row) -> Result<(), Failed> {
    let arguments = [BEFORE.as_slice(), &["--set", "ambient=ibl"]].concat();
    let [one, other] = row.pixels;
    let picture = image([one, other, one, other])?;
    let (textured, _) = drawn(&tilted(&[picture], (row.textured)()), &arguments)?;
    let mut seen = Vec::new();
    for (own, x) in row.pixels.into_iter().zip([0.4, 0.6]) {
        let factors = (row.factors)(own.map(|byte| f64::from(byte) / 255.0));
        let (by_factors, _) = drawn(&tilted(&[], factors), &arguments)?;
        let (found, expected) = (pixel(&textured, x, 0.5), pixel(&by_factors, x, 0.5));
        demand(is_near(found, expected, 2), || {
            format!("{own:?}: found {found:?}, by factors {expected:?}")
        })?;
        // What the other pixel would give at this place.
        seen.push(by_factors);
    }
    let [left, right] = [0, 1].map(|at: usize| pixel(&seen[at], 0.4, 0.5));
    demand(!is_near(left, right, 3), || format!("both pixels give {left:?} and {right:?}"))
}

/// Occlusion hides the surroundings where its red is 0, as strongly as the material says.
fn occlusion_is_mapped() -> Result<(), Failed> {
    let picture = image([[0; 3], [255; 3], [0; 3], [255; 3]])?;
    let shown = |strength: f64| -> Result<[Pixel; 2], Failed> {
        let material = json!({ "occlusionTexture": { "index": 0, "strength": strength },
            "pbrMetallicRoughness": { "baseColorFactor": COLOR, "metallicFactor": 0.0 } });
        let arguments = [BEFORE.as_slice(), &["--set", "ambient=constant"]].concat();
        let (drawn, _) = drawn(&tilted(std::slice::from_ref(&picture), material), &arguments)?;
        Ok([0.4, 0.6].map(|x| pixel(&drawn, x, 0.5)))
    };
    let [full, half, none] = [shown(1.0)?, shown(0.5)?, shown(0.0)?];
    let is_ordered = full[0][0] + 2 < half[0][0] && half[0][0] + 2 < none[0][0];
    demand(is_ordered && full[1] == none[1], || {
        format!("by strength: 1 {full:?}, 0.5 {half:?}, 0 {none:?}")
    })
}

/// A texture of an extension that is not in the file is an error that names its place.
fn none_there() -> Result<(), Failed> {
    let coat = |texture: Value| {
        let own = extended("KHR_materials_clearcoat", json!({ "clearcoatTexture": texture }));
        drawn(&tilted(&[], own), &BEFORE)
            .err()
            .map(|error| error.message().unwrap_or("").to_owned())
    };
    for texture in [json!({ "index": 7 }), json!({ "index": "0" }), json!(3)] {
        let place = "materials[0].extensions.KHR_materials_clearcoat.clearcoatTexture: ";
        let message = coat(texture).unwrap_or_default();
        demand(message.contains(place), || format!("expected `{place}` in `{message}`"))?;
    }
    Ok(())
}

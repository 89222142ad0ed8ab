//! Materials of models: the extensions that choose the permutation, and what they do in the picture.

use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};
use tempfile::TempDir;

use super::{
    BEFORE, BLUE, GREEN, RED, WHITE, demand, drawn, glb, has_quarters, image, is_near, pixel,
    render, square,
};

/// An axis, and the extensions of a material that needs it.
type Layer = (&'static str, fn() -> Value);

const LAYERS: [Layer; 8] = [
    ("clearcoat", || json!({ "KHR_materials_clearcoat": { "clearcoatFactor": 1.0 } })),
    ("sheen", || {
        json!({ "KHR_materials_sheen":
            { "sheenColorFactor": [0.9, 0.9, 0.9], "sheenRoughnessFactor": 0.5 } })
    }),
    ("iridescence", || {
        json!({ "KHR_materials_iridescence":
            { "iridescenceFactor": 1.0, "iridescenceIor": 2.0 }, "KHR_materials_ior": { "ior": 2.4 } })
    }),
    ("anisotropy", || {
        json!({ "KHR_materials_anisotropy":
            { "anisotropyStrength": 0.9, "anisotropyRotation": 0.5 }, "KHR_materials_ior": { "ior": 2.4 } })
    }),
    ("transmission", || json!({ "KHR_materials_transmission": { "transmissionFactor": 1.0 } })),
    ("volume", || {
        json!({ "KHR_materials_transmission": { "transmissionFactor": 1.0 },
            "KHR_materials_volume": { "thicknessFactor": 2.0, "attenuationDistance": 0.5,
                "attenuationColor": [0.2, 0.9, 0.2] } })
    }),
    ("dispersion", || {
        json!({ "KHR_materials_transmission": { "transmissionFactor": 1.0 },
            "KHR_materials_volume": { "thicknessFactor": 1.0 },
            "KHR_materials_dispersion": { "dispersion": 20.0 } })
    }),
    ("diffuse_transmission", || {
        json!({ "KHR_materials_diffuse_transmission":
            { "diffuseTransmissionFactor": 0.8, "diffuseTransmissionColorFactor": [0.1, 1.0, 0.1] } })
    }),
];

pub fn tests() -> impl Iterator<Item = Trial> {
    let each = LAYERS
        .iter()
        .map(|layer| Trial::test(format!("render/model/layer/{}", layer.0), || is_drawn(layer)));
    let others: [(_, fn() -> _); 6] = [
        ("none_is_chosen_for_nothing", nothing_is_chosen),
        ("emission_has_its_strength", emission_has_its_strength),
        ("unlit_beside_lit", unlit_beside_lit),
        ("unlit_image_beside_lit", unlit_image_beside_lit),
        ("omissions_are_reported", omissions_are_reported),
        ("exclusions_are_reported", exclusions_are_reported),
    ];
    each.chain(others.map(|(name, run)| Trial::test(format!("render/model/layer/{name}"), run)))
}

/// A tilted square of one material, half metal, so that the viewer sees highlights of the lamp.
fn surface(extensions: &Value) -> Vec<u8> {
    let (mut document, buffer) = square(&[]);
    document["materials"] = json!([{
        "pbrMetallicRoughness":
            { "baseColorFactor": [0.6, 0.3, 0.3, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.4 },
        "extensions": extensions,
    }]);
    document["nodes"] = json!([{ "mesh": 0, "rotation": [-0.25, -0.2, 0.0, 0.95] }]);
    glb(&document, &buffer)
}

/// The key of the permutation has the axis, and the picture is another one without it.
fn is_drawn((axis, extensions): &Layer) -> Result<(), Failed> {
    let (file, folder) = (surface(&extensions()), TempDir::new()?);
    let output = render(folder.path(), &file, &BEFORE)?;
    let stdout = String::from_utf8_lossy(&output.stdout).into_owned();
    demand(stdout.split([',', ' ', '`', '\n']).any(|part| part == *axis), || {
        format!("expected `{axis}`: {stdout}{}", String::from_utf8_lossy(&output.stderr))
    })?;
    let without = format!("{axis}=false");
    let set = [BEFORE.as_slice(), &["--set", &without]].concat();
    let (with, without) = (drawn(&file, &BEFORE)?.0, drawn(&file, &set)?.0);
    let differing = with.pixels.iter().zip(&without.pixels).filter(|(a, b)| a.abs_diff(**b) > 2);
    let differing = differing.count();
    demand(differing > 60, || format!("{differing} values differ, expected more than 60"))
}

/// A plain material has no layers but its base, and factors of 0 need none.
fn nothing_is_chosen() -> Result<(), Failed> {
    let idle = json!({ "KHR_materials_clearcoat": {}, "KHR_materials_sheen": {},
        "KHR_materials_volume": { "thicknessFactor": 1.0 } });
    for extensions in [json!({}), idle] {
        let folder = TempDir::new()?;
        let output = render(folder.path(), &surface(&extensions), &[])?;
        let stdout = String::from_utf8_lossy(&output.stdout).into_owned();
        let has = |axis: &str| stdout.contains(axis);
        let is_plain = has("metallic_roughness") && !LAYERS.iter().any(|(axis, _)| has(axis));
        demand(is_plain, || format!("expected `metallic_roughness` and no layer: {stdout}"))?;
    }
    Ok(())
}

/// A black surface of emission 0.05 and strength 5 has 0.25, which is 137 of 255 in sRGB.
fn emission_has_its_strength() -> Result<(), Failed> {
    let (mut document, buffer) = square(&[]);
    document["materials"] = json!([{
        "pbrMetallicRoughness": { "baseColorFactor": [0.0, 0.0, 0.0, 1.0], "metallicFactor": 0.0 },
        "emissiveFactor": [0.05, 0.05, 0.05],
        "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 5.0 },
            "KHR_materials_specular": { "specularFactor": 0.0 } },
    }]);
    let (picture, _) = drawn(&glb(&document, &buffer), &BEFORE)?;
    let found = pixel(&picture, 0.5, 0.5);
    demand(found.iter().all(|part| part.abs_diff(137) <= 1), || {
        format!("expected 137 in the middle, found {found:?}")
    })
}

/// An unlit material has its colour although the other one is lit and has a coat.
fn unlit_beside_lit() -> Result<(), Failed> {
    let (mut document, buffer) = square(&[]);
    document["materials"] = json!([
        { "pbrMetallicRoughness": { "baseColorFactor": [0.25, 0.5, 1.0, 1.0] },
          "extensions": { "KHR_materials_unlit": {} } },
        { "extensions": { "KHR_materials_clearcoat": { "clearcoatFactor": 1.0 } } },
    ]);
    let mut part = document["meshes"][0]["primitives"][0].clone();
    part["material"] = json!(1);
    document["meshes"] = json!([document["meshes"][0], { "primitives": [part] }]);
    document["nodes"] = json!([{ "mesh": 0 }, { "mesh": 1, "translation": [5.0, 0.0, 0.0] }]);
    document["scenes"] = json!([{ "nodes": [0, 1] }]);
    let (picture, _) = drawn(&glb(&document, &buffer), &BEFORE)?;
    let found = pixel(&picture, 0.5, 0.5);
    let expected = [137_u8, 188, 255];
    demand(found.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 1), || {
        format!("expected {expected:?} in the middle, found {found:?}")
    })
}

/// The image of an unlit surface beside a lit one is there as it is, and without `material_maps` its
/// mean: of red, green, blue and white, linear, a half of each channel, which is 188.
fn unlit_image_beside_lit() -> Result<(), Failed> {
    let (mut document, buffer) = square(&[image([RED, GREEN, BLUE, WHITE])?]);
    document["materials"] = json!([
        { "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } },
          "extensions": { "KHR_materials_unlit": {} } },
        {},
    ]);
    let mut part = document["meshes"][0]["primitives"][0].clone();
    part["material"] = json!(1);
    document["meshes"] = json!([document["meshes"][0], { "primitives": [part] }]);
    document["nodes"] = json!([{ "mesh": 0 }, { "mesh": 1, "translation": [5.0, 0.0, 0.0] }]);
    document["scenes"] = json!([{ "nodes": [0, 1] }]);
    let file = glb(&document, &buffer);
    let (picture, _) = drawn(&file, &BEFORE)?;
    has_quarters(&picture, [RED, GREEN, BLUE, WHITE])?;
    let (mean, _) = drawn(&file, &[&BEFORE[..], &["--set", "material_maps=false"]].concat())?;
    let found = pixel(&mean, 0.35, 0.35);
    demand(is_near(found, [188; 3], 2), || format!("expected the mean, 188, found {found:?}"))
}

/// The texture of the coat's normals and unknown extensions are named.
fn omissions_are_reported() -> Result<(), Failed> {
    let extensions = json!({ "KHR_materials_clearcoat":
        { "clearcoatFactor": 1.0, "clearcoatNormalTexture": { "index": 0 } }, "EXT_materials_fur": {} });
    let (_, stderr) = drawn(&surface(&extensions), &[])?;
    for part in ["clearcoatNormalTexture of KHR_materials_clearcoat", "EXT_materials_fur"] {
        demand(stderr.contains(part), || format!("expected `{part}` in `{stderr}`"))?;
    }
    Ok(())
}

/// Extensions, arguments, what standard error names, and what it does not name.
type Excluded<'a> = (&'a Value, &'a [&'a str], &'a [&'a str], &'a [&'a str]);

/// Values of axes that the user's choice excludes are named, and only those.
fn exclusions_are_reported() -> Result<(), Failed> {
    let coat = json!({ "KHR_materials_clearcoat": { "clearcoatFactor": 1.0 } });
    let colors = json!({ "KHR_materials_transmission": { "transmissionFactor": 1.0 },
        "KHR_materials_volume": { "thicknessFactor": 1.0 },
        "KHR_materials_dispersion": { "dispersion": 20.0 } });
    let tried: [Excluded<'_>; 3] = [
        (
            &coat,
            &["--set", "frequency=vertex"],
            &["metallic_roughness=true", "clearcoat=true"],
            &[],
        ),
        (&colors, &["--set", "ambient=constant"], &["dispersion=true"], &["volume=true"]),
        (&coat, &[], &[], &["cannot have"]),
    ];
    for (extensions, arguments, named, unnamed) in tried {
        let (_, stderr) = drawn(&surface(extensions), arguments)?;
        let is_right = named.iter().all(|part| stderr.contains(part))
            && !unnamed.iter().any(|part| stderr.contains(part));
        demand(is_right, || format!("expected {named:?} and not {unnamed:?} in `{stderr}`"))?;
    }
    Ok(())
}

//! Normal maps, coordinates and samplers.

use serde_json::{Value, json};

use super::{Choices, Row, SUGGESTED, beside, bulging, pattern, plain, row, textured, textured_by};
use crate::gltf::model::{Mesh, Model, Pixels};

fn rows_first() -> Vec<Row> {
    vec![
        row("normal_texture", "3.9.3", "with tangents that are given", || {
            bumpy(flat().with_tangents(), 1.0, plain(json!({})))
        }),
        row("normal_scale", "3.9.3", "red and green times the scale", || {
            bumpy(flat().with_tangents(), 0.5, plain(json!({})))
        }),
        row(
            "normal_texture_bulging",
            "3.9.3",
            "with normals that differ between vertices; bitangents are those of each point, and in the reference those of the vertices, which the text leaves open",
            || bumpy(Mesh::bulging(0.1).with_tangents(), 1.0, plain(json!({}))),
        ),
        row("normal_texture_behind", "3.9.5", "a back has the opposite of the bent normal", || {
            bumpy(flat().turned().with_tangents(), 1.0, plain(json!({ "doubleSided": true })))
        }),
        row("texture_transform", "KHR_texture_transform", "offset, rotation and scale", || {
            colored(json!({}), |info| {
                info["extensions"] = json!({ "KHR_texture_transform":
                    { "offset": [0.2, 0.1], "rotation": 0.4, "scale": [0.7, 0.9] } });
            })
        }),
        row("second_set", "3.9.2", "`TEXCOORD_1`", || {
            colored(json!({}), |info| {
                info["texCoord"] = json!(1);
            })
        }),
    ]
}

fn rows_of_tangents() -> Vec<Row> {
    const TEXT: &str = "3.7.2.1";
    vec![
        row("tangents_absent", TEXT, "MikkTSpace: means of the faces around a vertex", || {
            bumpy(folded(false), 1.0, plain(json!({})))
        }),
        row("tangents_mirrored", TEXT, "MikkTSpace where the image is mirrored", || {
            bumpy(folded(true), 1.0, plain(json!({})))
        }),
        row("tangents_second_set", TEXT, "by the coordinates of the normal map", || {
            let mut mesh = folded(false);
            let first = mesh.uvs[0].iter().flatten().map(|[u, v]| [0.4 * u + 0.9 * v, 0.8 * v - u]);
            mesh.uvs = [Some(first.collect()), mesh.uvs[0].clone()];
            let mut model = bumpy(mesh, 1.0, plain(json!({})));
            model.document["materials"][0]["normalTexture"]["texCoord"] = json!(1);
            model
        }),
        row(
            "tangents_transformed",
            TEXT,
            "by the coordinates after KHR_texture_transform, as the glTF Sample Renderer",
            transformed,
        )
        .with(Choices { transformed_tangents: true, ..SUGGESTED }),
        row("tangents_untransformed", TEXT, "by those before it", transformed)
            .differs("tangents follow the image"),
    ]
}

fn rows_second() -> Vec<Row> {
    vec![
        row(
            "two_sets",
            "3.9.2",
            "textures of one material with a set each: drawn into the first",
            || {
                let mut mesh = bulging();
                let turned = mesh.uvs[0].iter().flatten().map(|[u, v]| [*v, 0.3 + 0.5 * *u]);
                mesh.uvs[1] = Some(turned.collect());
                textured(mesh, |index| {
                    let emission = json!({ "index": index, "texCoord": 1 });
                    let mut material = plain(
                        json!({ "emissiveFactor": [0.6, 0.5, 0.4], "emissiveTexture": emission }),
                    );
                    material["pbrMetallicRoughness"]["baseColorTexture"] =
                        json!({ "index": index });
                    material
                })
            },
        ),
        row("wrap_repeat", "3.8.4.3", "the image again", || {
            colored(json!({ "wrapS": 10497, "wrapT": 10497 }), larger)
        }),
        row("wrap_mirror", "3.8.4.3", "the image mirrored", || {
            colored(json!({ "wrapS": 33648, "wrapT": 33648 }), larger)
        }),
        row("wrap_clamp", "3.8.4.3", "its edge", || {
            colored(json!({ "wrapS": 33071, "wrapT": 33071 }), larger)
        }),
        row("filter_nearest", "3.8.4.2", "the nearest texel, where it is enlarged", || {
            colored(json!({ "magFilter": 9728 }), |_| ())
        }),
        row("filter_linear", "3.8.4.2", "between four texels, in linear light", || {
            colored(json!({ "magFilter": 9729 }), |_| ())
        }),
        row("webp", "EXT_texture_webp", "its image, and not the one for other readers", || {
            let mut model = Model::new();
            let texture = model.add_webp_texture(pattern(), reversed());
            let mut material = plain(json!({}));
            material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": texture });
            model.add_material(material);
            model.add(bulging(), json!({}));
            model.add_usual_lamps();
            model
        }),
        row("several_materials", "3.9", "each with its own textures and sampler", several),
    ]
}

fn rows_third() -> Vec<Row> {
    vec![
        row(
            "specular_glossiness",
            "KHR_materials_pbrSpecularGlossiness",
            "converted without a loss, as KHR_materials_specular says",
            || textured(bulging(), |index| gloss(&json!({ "index": index }))),
        ),
        row(
            "specular_glossiness_factors",
            "KHR_materials_pbrSpecularGlossiness",
            "by its factors",
            || Model::of(bulging(), gloss(&Value::Null)),
        ),
    ]
}

pub fn rows() -> Vec<Row> {
    [rows_first(), rows_of_tangents(), rows_second(), rows_third()].concat()
}

/// A mesh without bulge: all of its angles are those of the texture.
fn flat() -> Mesh {
    Mesh::bulging(0.0)
}

/// A material with a normal map.
fn bumpy(mesh: Mesh, scale: f64, material: Value) -> Model {
    let mut pixels = pattern();
    for [red, green, blue, _] in &mut pixels.texels {
        (*red, *green, *blue) = (64 + *red / 2, 64 + *green / 2, 220);
    }
    textured_by(mesh, pixels, json!({}), move |index| {
        let mut material = material.clone();
        material["normalTexture"] = json!({ "index": index, "scale": scale });
        material
    })
}

/// A surface whose colour is a texture with a sampler and other changes.
fn colored(sampler: Value, change: fn(&mut Value)) -> Model {
    let mut mesh = bulging();
    let turned = mesh.uvs[0].iter().flatten().map(|[u, v]| [*v, 0.3 + 0.5 * *u]);
    mesh.uvs[1] = Some(turned.collect());
    textured_by(mesh, pattern(), sampler, |index| {
        let mut material = plain(json!({}));
        let mut info = json!({ "index": index });
        change(&mut info);
        material["pbrMetallicRoughness"]["baseColorTexture"] = info;
        material
    })
}

/// Coordinates from -0.75 to 1.75.
fn larger(info: &mut Value) {
    info["extensions"] = json!({ "KHR_texture_transform":
        { "offset": [-0.75, -0.75], "scale": [2.5, 2.5] } });
}

/// Two surfaces beside each other, with an image and a sampler each.
fn several() -> Model {
    let mut model = colored(json!({ "magFilter": 9728 }), |_| ());
    let texture = model.add_texture(reversed(), json!({ "wrapS": 33071 }));
    let mut material = plain(json!({}));
    material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": texture });
    let material = model.add_material(material);
    model.add(Mesh { material, ..bulging() }, beside());
    model
}

/// The pattern from its last texel to its first.
fn reversed() -> Pixels {
    Pixels { texels: pattern().texels.into_iter().rev().collect(), ..pattern() }
}

/// Five faces around a vertex at the lower edge of the picture, whose angles and areas in the image differ.
/// Two of them are seen beside each other. The image of the two faces to the left is mirrored or not.
fn folded(is_mirrored: bool) -> Mesh {
    let positions = vec![
        [0.05, -0.95, 0.2],
        [0.0, 4.0, 0.0],
        [-3.0, -1.6, 0.1],
        [0.1, -3.0, -0.3],
        [1.6, -2.4, 0.2],
        [3.0, -1.2, -0.1_f32],
    ];
    let normals = positions
        .iter()
        .map(|[x, y, z]| glam::Vec3::new(0.08 * x, 0.06 * y, 1.0 + 0.3 * z).normalize().to_array());
    let normals = Some(normals.collect());
    let left = if is_mirrored { 2.1 } else { -0.9 };
    let uvs = vec![[0.52, 0.95], [0.6, -1.7], [left, 1.6], [0.45, 2.3], [1.1, 1.9], [2.4, 0.8]];
    let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5], [0, 5, 1]];
    Mesh {
        positions,
        normals,
        uvs: [Some(uvs), None],
        indices: Some(faces.concat()),
        ..Mesh::default()
    }
}

/// A normal map that is turned, on a mesh without tangents.
fn transformed() -> Model {
    let mut model = bumpy(folded(false), 1.0, plain(json!({})));
    model.document["materials"][0]["normalTexture"]["extensions"] = json!({
        "KHR_texture_transform":
            { "offset": [0.2, 0.1], "rotation": 0.6, "scale": [0.7, 0.9] } });
    model
}

fn gloss(texture: &Value) -> Value {
    let mut own = json!({ "diffuseFactor": [0.5, 0.4, 0.3, 1.0],
        "specularFactor": [0.3, 0.2, 0.1], "glossinessFactor": 0.6 });
    if !texture.is_null() {
        own["diffuseTexture"] = texture.clone();
        own["specularGlossinessTexture"] = texture.clone();
    }
    json!({ "extensions": { "KHR_materials_pbrSpecularGlossiness": own } })
}

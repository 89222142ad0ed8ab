//! Files that are broken, too large, or not a model. Each gives an error with its place, and no
//! picture is written.

use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};
use tempfile::TempDir;

use super::{demand, glb, render, square};

pub fn tests() -> impl Iterator<Item = Trial> {
    let wrong = WRONG.iter().map(|(name, file, words)| {
        Trial::test(format!("render/model/wrong/{name}"), || refused(&file(), words))
    });
    wrong.chain([Trial::test("render/model/wrong/far_away", far_away)])
}

/// A model or a viewer at places of which numbers of 32 bits cannot say the square: a note says why
/// the picture may be empty.
fn far_away() -> Result<(), Failed> {
    let large = changed(|document| document["nodes"][0]["scale"] = json!([1e38, 1e38, 1e38]));
    let far = ["--camera", "1e39,0,0,0,0,0"];
    for (file, arguments) in [(large, &[][..]), (changed(|_| ()), &far[..])] {
        let folder = TempDir::new()?;
        let stderr = render(folder.path(), &file, arguments)?.stderr;
        let stderr = String::from_utf8_lossy(&stderr);
        demand(stderr.contains("the picture may be empty"), || format!("no note: {stderr}"))?;
    }
    Ok(())
}

/// A name, a file, and a part of the error.
type Wrong = (&'static str, fn() -> Vec<u8>, &'static str);

const WRONG: &[Wrong] = &[
    ("text", || b"solid cube".to_vec(), "not a binary glTF file"),
    ("version", || [b"glTF".as_slice(), &[1, 0, 0, 0]].concat(), "version 1"),
    ("cut_short", || changed(|_| ())[..40].to_vec(), "more than the file"),
    ("no_document", || glb(&json!([1]), &[]), "model.glb"),
    (
        "no_scene",
        || {
            changed(|document| {
                document["scenes"] = json!([]);
                document["nodes"] = json!([]);
            })
        },
        "scene",
    ),
    ("index", || changed(|document| document["accessors"][0]["count"] = json!(2)), "is beyond"),
    (
        "view_beyond_the_buffer",
        || changed(|document| document["bufferViews"][0]["byteLength"] = json!(4000)),
        "buffer view 0 ends beyond",
    ),
    (
        "view_beyond_all_numbers",
        || changed(|document| document["bufferViews"][0]["byteOffset"] = json!(u64::MAX)),
        "model.glb",
    ),
    (
        "rows_beyond_the_view",
        || changed(|document| document["accessors"][1]["count"] = json!(5)),
        "TEXCOORD_0: accessor 1 ends beyond",
    ),
    (
        "many_rows",
        || changed(|document| document["accessors"][0]["count"] = json!(4_000_000_000_u32)),
        "vertices",
    ),
    (
        "sparse",
        || {
            changed(|document| {
                document["accessors"][0]["sparse"] = json!({ "count": 5,
                    "indices": { "bufferView": 1, "componentType": 5123 },
                    "values": { "bufferView": 0 } });
            })
        },
        "sparse",
    ),
    (
        "sparse_row_beyond",
        || {
            changed(|document| {
                document["accessors"][1]["sparse"] = json!({ "count": 1,
                    "indices": { "bufferView": 1, "componentType": 5123, "byteOffset": 10 },
                    "values": { "bufferView": 0 } });
                document["accessors"][1]["count"] = json!(3);
            })
        },
        "a sparse one at 3",
    ),
    (
        "targets_without_an_end",
        || {
            changed(|document| {
                document["accessors"][2]["count"] = json!(4_000_000_000_u32);
                document["meshes"][0]["weights"] = json!([1.0]);
                let primitive = &mut document["meshes"][0]["primitives"][0];
                primitive["targets"] = json!([{ "NORMAL": 2 }]);
                primitive["indices"] = json!(3);
                let accessors = document["accessors"].as_array_mut();
                let indices = json!({ "bufferView": 1, "componentType": 5123, "count": 6,
                    "type": "SCALAR" });
                accessors.into_iter().for_each(|all| all.push(indices.clone()));
            })
        },
        "morph targets and joints move more than",
    ),
    (
        "joints_without_matrices",
        || {
            changed(|document| {
                document["skins"] = json!([{ "joints": [0, 0], "inverseBindMatrices": 3 }]);
                document["nodes"][0]["skin"] = json!(0);
                let accessors = document["accessors"].as_array_mut();
                let one = json!({ "bufferView": 0, "componentType": 5126, "count": 1,
                    "type": "MAT4" });
                accessors.into_iter().for_each(|all| all.push(one.clone()));
            })
        },
        "skins[0].inverseBindMatrices: 1 matrices for 2 joints",
    ),
    (
        "needs_draco",
        || {
            changed(|document| {
                document["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
                document["accessors"][0]["bufferView"] = json!(99);
            })
        },
        "`KHR_draco_mesh_compression` is not read: its meshes are compressed",
    ),
    (
        "needs_a_newer_version",
        || changed(|document| document["asset"]["minVersion"] = json!("2.1")),
        "asset.minVersion: it needs glTF 2.1",
    ),
    (
        "another_file",
        || changed(|document| document["buffers"][0]["uri"] = json!("/etc/passwd")),
        "in another file",
    ),
    (
        "loop_of_nodes",
        || changed(|document| document["nodes"][0]["children"] = json!([0])),
        "nodes[0]: the node is its own descendant",
    ),
    ("tower_of_nodes", tower, "more than 100000 nodes"),
    ("no_number", || with_first(f32::NAN), "not finite"),
    (
        "infinite_place",
        || {
            changed(|document| {
                document["nodes"] = json!([{ "children": [1], "scale": [1e38, 1e38, 1e38] },
            { "children": [2], "scale": [1e38, 1e38, 1e38] }, { "mesh": 0, "scale": [1e308, 1.0, 1.0] }]);
            })
        },
        "model.glb",
    ),
    (
        "share_beyond_one",
        || layered(json!({ "KHR_materials_clearcoat": { "clearcoatFactor": 2.5 } })),
        "materials[0].extensions.KHR_materials_clearcoat.clearcoatFactor: expected a number from 0 to 1, found 2.5",
    ),
    (
        "word_for_a_number",
        || layered(json!({ "KHR_materials_sheen": { "sheenRoughnessFactor": "rough" } })),
        "KHR_materials_sheen.sheenRoughnessFactor: expected a number, found \"rough\"",
    ),
    (
        "color_of_two_channels",
        || layered(json!({ "KHR_materials_sheen": { "sheenColorFactor": [1.0, 0.5] } })),
        "KHR_materials_sheen.sheenColorFactor: expected three numbers",
    ),
    (
        "dark_color",
        || layered(json!({ "KHR_materials_sheen": { "sheenColorFactor": [1.0, -0.5, 0.0] } })),
        "KHR_materials_sheen.sheenColorFactor: expected a number of 0 or more, found -0.5",
    ),
    (
        "film_thinner_than_nothing",
        || layered(json!({ "KHR_materials_iridescence": { "iridescenceThicknessMaximum": -1 } })),
        "KHR_materials_iridescence.iridescenceThicknessMaximum: expected a number of 0 or more",
    ),
    (
        "no_distance",
        || layered(json!({ "KHR_materials_volume": { "attenuationDistance": 0.0 } })),
        "KHR_materials_volume.attenuationDistance: expected a number above 0, found 0",
    ),
    (
        "thin_index",
        || layered(json!({ "KHR_materials_ior": { "ior": 0.5 } })),
        "KHR_materials_ior.ior: expected a number of 1 or more, found 0.5",
    ),
    (
        "extension_that_is_a_number",
        || layered(json!({ "KHR_materials_anisotropy": 3 })),
        "materials[0].extensions.KHR_materials_anisotropy: expected an object, found 3",
    ),
    ("image_of_gigapixels", huge_image, "images[0]"),
    (
        "offset_of_one_number",
        || moved(json!({ "offset": [1.0] })),
        "materials[0].normalTexture.extensions.KHR_texture_transform.offset: expected two numbers",
    ),
    (
        "turn_by_a_word",
        || moved(json!({ "rotation": "left" })),
        "KHR_texture_transform.rotation: expected a number, found \"left\"",
    ),
];

fn refused(file: &[u8], words: &str) -> Result<(), Failed> {
    let folder = TempDir::new()?;
    let output = render(folder.path(), file, &[])?;
    let stderr = String::from_utf8_lossy(&output.stderr);
    let is_reported = output.status.code() == Some(1)
        && stderr.contains(words)
        && stderr.contains("model.glb")
        && !stderr.contains("panicked");
    demand(is_reported, || {
        format!("expected exit code 1, `{words}` and model.glb, {}: {stderr}", output.status)
    })?;
    demand(!folder.path().join("out.png").exists(), || {
        format!("a picture was written, expected only the error `{words}`")
    })
}

fn changed(change: impl FnOnce(&mut Value)) -> Vec<u8> {
    let (mut document, buffer) = square(&[]);
    change(&mut document);
    glb(&document, &buffer)
}

fn layered(extensions: Value) -> Vec<u8> {
    changed(|document| document["materials"][0]["extensions"] = extensions)
}

/// Thirty nodes that each have the next node as two children: 2^30 nodes when they are followed.
fn tower() -> Vec<u8> {
    changed(|document| {
        let node = |index: usize| json!({ "children": [index + 1, index + 1] });
        let nodes = (0..30).map(node).chain([json!({ "mesh": 0 })]);
        document["nodes"] = nodes.collect();
    })
}

fn with_first(number: f32) -> Vec<u8> {
    let (document, mut buffer) = square(&[]);
    buffer[..4].copy_from_slice(&number.to_le_bytes());
    glb(&document, &buffer)
}

fn pictured(image: Vec<u8>) -> Vec<u8> {
    let (mut document, buffer) = square(&[image]);
    document["materials"] =
        json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    glb(&document, &buffer)
}

/// A texture of normals with a transformation.
fn moved(transform: Value) -> Vec<u8> {
    let (mut document, buffer) = square(&[Vec::new()]);
    document["materials"] = json!([{ "normalTexture": {
        "index": 0, "extensions": { "KHR_texture_transform": transform },
    } }]);
    glb(&document, &buffer)
}

/// A PNG whose header claims 65,535 by 65,535 pixels.
fn huge_image() -> Vec<u8> {
    let mut png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\xff\xff\0\0\xff\xff\x08\x06\0\0\0".to_vec();
    png.extend([0xb6, 0x05, 0xd9, 0x50]);
    png.extend(b"\0\0\0\x10IDAT\x78\x9c");
    png.extend([0; 18]);
    pictured(png)
}

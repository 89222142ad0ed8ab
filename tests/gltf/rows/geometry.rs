//! Meshes, nodes, skins and morph targets.

use glam::{DMat4, DQuat, DVec3};
use serde_json::{Value, json};

use super::{Row, bulging, metal, pattern, plain, row};
use crate::gltf::model::{Drawn, Mesh, Model, local};

fn rows_first() -> Vec<Row> {
    vec![
        row("normals_absent", "3.7.2.1", "each triangle is flat", || {
            Model::of(pyramid(), plain(json!({})))
        }),
        row("nodes", "3.5.3", "translation, rotation, scale and matrix in a hierarchy", hierarchy),
        row("scale_uneven", "3.5.3", "normals by the inverse transpose", || {
            let mut model = Model::new();
            model.add_material(plain(json!({})));
            let turn = DQuat::from_rotation_x(0.3).to_array();
            model.add(bulging(), json!({ "scale": [1.0, 1.8, 0.4], "rotation": turn }));
            model.add_usual_lamps();
            model
        }),
        row(
            "mirrored",
            "3.5.3, 3.7.4",
            "a negative determinant turns winding and bitangents",
            || {
                let mut model = Model::new();
                let mut pixels = pattern();
                for [red, green, blue, _] in &mut pixels.texels {
                    (*red, *green, *blue) = (64 + *red / 2, 64 + *green / 2, 220);
                }
                let texture = model.add_texture(pixels, json!({}));
                model.add_material(plain(json!({ "normalTexture": { "index": texture } })));
                model.add(Mesh::bulging(0.0).with_tangents(), json!({ "scale": [-1.0, 1.0, 1.0] }));
                model.add_usual_lamps();
                model
            },
        ),
        row("strip", "3.7.2.1", "triangle strips", strip),
        row("quantized", "KHR_mesh_quantization", "small integers, normalised or not", quantized),
        row("sparse", "3.6.2.3", "some rows of an accessor are replaced", sparse),
        row("morph_targets", "3.7.2.2", "by the weights of the node, where it has some", || {
            let mut model = morphed();
            model.document["meshes"][0]["weights"] = json!([9.0, 9.0]);
            let nodes = model.document["nodes"].as_array_mut().expect("nodes");
            let node = nodes.iter_mut().find(|node| !node["mesh"].is_null()).expect("a node");
            node["weights"] = json!(WEIGHTS);
            model
        }),
        row("morph_weights", "3.7.2.2", "by those of the mesh otherwise", || {
            let mut model = morphed();
            model.document["meshes"][0]["weights"] = json!(WEIGHTS);
            model
        }),
    ]
}

fn rows_second() -> Vec<Row> {
    vec![
        row("skin", "3.7.3", "by the joints at rest", skinned),
        row("instances", "EXT_mesh_gpu_instancing", "at each place of the attributes", instanced),
        row("invisible", "KHR_node_visibility", "hidden nodes are not drawn", || {
            let mut model = Model::of(bulging(), plain(json!({})));
            let mesh = model.add_mesh(&bulging());
            model.add_node(json!({ "mesh": mesh, "translation": [0.0, 0.0, 0.5],
                "extensions": { "KHR_node_visibility": { "visible": false } } }));
            model
        }),
        row("default_material", "3.9.6", "a white metal of roughness 1", || {
            let mut model = Model::of(bulging(), json!({}));
            let primitive = &mut model.document["meshes"][0]["primitives"][0];
            primitive.as_object_mut().expect("a primitive").remove("material");
            model
        }),
    ]
}

pub fn rows() -> Vec<Row> {
    [rows_first(), rows_second()].concat()
}

/// Three faces around a point before the middle, without normals.
fn pyramid() -> Mesh {
    let positions = vec![[-3.0, -2.0, 0.0], [3.0, -2.0, 0.0], [0.0, 4.0, 0.0], [0.05, -0.95, 0.6]];
    Mesh { positions, indices: Some(vec![0, 1, 3, 1, 2, 3, 2, 0, 3]), ..Mesh::default() }
}

fn hierarchy() -> Model {
    let mut model = Model::new();
    model.add_material(metal(0.5));
    let mesh = model.add_mesh(&wide());
    let turn = DQuat::from_rotation_z(0.4).to_array();
    let child = json!({ "mesh": mesh, "translation": [0.1, 0.2, -0.2], "rotation": turn,
        "scale": [0.9, 1.1, 0.8] });
    let matrix = DMat4::from_rotation_y(0.3) * DMat4::from_scale(DVec3::new(1.2, 1.0, 1.4));
    let inner = model.push("nodes", child.clone());
    let outer = json!({ "children": [inner], "matrix": matrix.to_cols_array() });
    model.drawn.push(Drawn { mesh: wide(), world: local(&outer) * local(&child) });
    model.add_node(outer);
    model.add_usual_lamps();
    model
}

/// Two triangles in a strip, whose common edge is upright.
fn strip() -> Model {
    let positions = vec![[-9.0, 0.0, 0.0], [0.0, -6.0, 0.0], [0.0, 6.0, 0.0], [9.0, 0.0, 0.0_f32]];
    let normals = positions
        .iter()
        .map(|[x, y, _]| glam::Vec3::new(0.3 * x, 0.3 * y, 1.0).normalize().to_array());
    let normals = Some(normals.collect());
    let mut model = Model::new();
    model.add_material(plain(json!({})));
    let mesh = Mesh { positions, normals, ..Mesh::default() };
    let index = model.add_mesh(&mesh);
    model.document["meshes"][index]["primitives"][0]["mode"] = json!(5);
    model.add_node(json!({ "mesh": index }));
    // 3.7.2.1: the second triangle of a strip has its first two vertices in the other order.
    let drawn = Mesh { indices: Some(vec![0, 1, 2, 1, 3, 2]), ..mesh };
    model.drawn.push(Drawn { mesh: drawn, world: DMat4::IDENTITY });
    model.add_usual_lamps();
    model
}

/// The usual mesh, large enough that it fills the picture when it is moved and turned.
fn wide() -> Mesh {
    let mut mesh = Mesh::bulging(0.3);
    for part in mesh.positions.iter_mut().flatten() {
        *part *= 2.0;
    }
    mesh
}

/// Positions in 16 bits, scaled by the node, normals in 8 normalised bits.
fn quantized() -> Model {
    let mut model = Model::new();
    model.add_material(plain(json!({})));
    let positions: [[i16; 4]; 3] = [[-3000, -2000, 0, 0], [3000, -2000, 0, 0], [0, 4000, 0, 0]];
    let normals: [[i8; 4]; 3] = [[-80, -40, 90, 0], [70, -50, 100, 0], [0, 90, 90, 0]];
    let bytes: Vec<u8> = positions.iter().flatten().flat_map(|part| part.to_le_bytes()).collect();
    let places = model.add_view(&bytes);
    let bytes: Vec<u8> = normals.iter().flatten().flat_map(|part| part.to_le_bytes()).collect();
    let turns = model.add_view(&bytes);
    model.document["bufferViews"][places]["byteStride"] = json!(8);
    model.document["bufferViews"][turns]["byteStride"] = json!(4);
    let position = model.push(
        "accessors",
        json!({ "bufferView": places, "componentType": 5122,
        "count": 3, "type": "VEC3", "min": [-3000, -2000, 0], "max": [3000, 4000, 0] }),
    );
    let normal = model.push(
        "accessors",
        json!({ "bufferView": turns, "componentType": 5120,
        "normalized": true, "count": 3, "type": "VEC3" }),
    );
    model.document["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
    model.document["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let mesh = model.push(
        "meshes",
        json!({ "primitives": [{ "material": 0,
        "attributes": { "POSITION": position, "NORMAL": normal } }] }),
    );
    let node = json!({ "mesh": mesh, "scale": [0.001, 0.001, 0.001] });
    // 3.6.2.2: max(c/127, -1).
    let number = |part: i8| (f32::from(part) / 127.0).max(-1.0);
    let mesh = Mesh {
        positions: positions.map(|[x, y, z, _]| [x, y, z].map(f32::from)).to_vec(),
        normals: Some(normals.map(|[x, y, z, _]| [x, y, z].map(number)).to_vec()),
        ..Mesh::default()
    };
    model.drawn.push(Drawn { mesh, world: local(&node) });
    model.add_node(node);
    model.add_usual_lamps();
    model
}

/// Normals of which one is replaced, and positions that are zeros but for the sparse rows.
fn sparse() -> Model {
    let mut model = Model::of(bulging(), plain(json!({})));
    let attributes = model.document["meshes"][0]["primitives"][0]["attributes"].clone();
    let own = [0.2_f32, 0.5, 0.9];
    let replace = |model: &mut Model, name: &str, rows: &[[f32; 3]], at: &[u8]| {
        let bytes: Vec<u8> = rows.iter().flatten().flat_map(|part| part.to_le_bytes()).collect();
        let values = model.add_view(&bytes);
        let indices = model.add_view(at);
        let accessor = attributes[name].as_u64().expect("an accessor") as usize;
        model.document["accessors"][accessor]["sparse"] = json!({ "count": at.len(),
            "indices": { "bufferView": indices, "componentType": 5121 },
            "values": { "bufferView": values } });
        accessor
    };
    replace(&mut model, "NORMAL", &[own], &[1]);
    let positions = bulging().positions;
    let at = replace(&mut model, "POSITION", &positions, &[0, 1, 2]);
    model.document["accessors"][at].as_object_mut().expect("an accessor").remove("bufferView");
    if let Some(normals) = &mut model.drawn[0].mesh.normals {
        normals[1] = glam::Vec3::from_array(own).normalize().to_array();
    }
    model
}

const WEIGHTS: [f32; 2] = [0.25, 0.5];

/// What is drawn is moved by `WEIGHTS`. The second target moves positions, both turn normals.
fn morphed() -> Model {
    let mut model = Model::of(wide(), plain(json!({})));
    let moves = [[0.1, 0.0, 0.2], [0.0, 0.3, -0.3], [0.2, 0.0, 0.4]];
    let turns = [[0.3, 0.0, 0.0], [0.0, 0.5, 0.0], [-0.4, 0.0, 0.1]];
    let [first, second] = [model.add_floats(&moves), model.add_floats(&turns)];
    let primitive = &mut model.document["meshes"][0]["primitives"][0];
    primitive["targets"] = json!([{ "NORMAL": second }, { "POSITION": first, "NORMAL": second }]);
    let mesh = &mut model.drawn[0].mesh;
    for (position, moved) in mesh.positions.iter_mut().zip(moves) {
        (0..3).for_each(|part| position[part] += WEIGHTS[1] * moved[part]);
    }
    for (normal, moved) in mesh.normals.iter_mut().flatten().zip(turns) {
        (0..3).for_each(|part| normal[part] += (WEIGHTS[0] + WEIGHTS[1]) * moved[part]);
        *normal = glam::Vec3::from_array(*normal).normalize().to_array();
    }
    model
}

/// 3.7.3: vertices of two joints. The node of the mesh has a place that counts for nothing.
fn skinned() -> Model {
    let mut model = Model::new();
    model.add_material(plain(json!({})));
    let mesh = wide();
    let index = model.add_mesh(&mesh);
    let weights = [[1.0, 0.0, 0.0, 0.0], [0.25, 0.75, 0.0, 0.0], [0.5, 0.5, 0.0, 0.0_f32]];
    let weights_at = model.add_floats(&weights);
    let view = model.add_view(&[0, 1, 0, 0].repeat(3));
    let joints = model.push(
        "accessors",
        json!({ "bufferView": view, "componentType": 5121,
        "count": 3, "type": "VEC4" }),
    );
    let attributes = &mut model.document["meshes"][index]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = json!(joints);
    attributes["WEIGHTS_0"] = json!(weights_at);
    let places: [Value; 2] = [
        json!({ "translation": [0.2, 0.0, 0.1], "scale": [1.0, 1.3, 1.0] }),
        json!({ "translation": [0.0, 0.1, -0.2],
            "rotation": DQuat::from_rotation_y(0.3).to_array() }),
    ];
    let bound = [DMat4::from_translation(DVec3::new(-0.1, 0.0, 0.0)), DMat4::from_rotation_z(0.1)];
    let inverse: Vec<[f32; 16]> =
        bound.iter().map(|matrix| matrix.as_mat4().to_cols_array()).collect();
    let inverse_at = model.add_floats(&inverse);
    let nodes = places.clone().map(|place| model.add_node(place));
    model.push("skins", json!({ "joints": nodes, "inverseBindMatrices": inverse_at }));
    model.add_node(json!({ "mesh": index, "skin": 0, "translation": [7.0, 7.0, 7.0] }));
    let joint: Vec<DMat4> =
        places.iter().zip(&bound).map(|(place, bound)| local(place) * *bound).collect();
    let mut drawn = mesh;
    for at in 0..3 {
        let matrix = joint[0] * f64::from(weights[at][0]) + joint[1] * f64::from(weights[at][1]);
        let place = DVec3::from_array(drawn.positions[at].map(f64::from));
        drawn.positions[at] = matrix.transform_point3(place).as_vec3().to_array();
        let normals = drawn.normals.as_mut().expect("normals");
        let turn = glam::DMat3::from_mat4(matrix).inverse().transpose();
        let normal = turn * DVec3::from_array(normals[at].map(f64::from));
        normals[at] = normal.normalize().as_vec3().to_array();
    }
    model.drawn.push(Drawn { mesh: drawn, world: DMat4::IDENTITY });
    model.add_usual_lamps();
    model
}

/// Three small copies before a large one.
fn instanced() -> Model {
    let mut model = Model::of(bulging(), plain(json!({})));
    let other = model.add_material(metal(0.4));
    let small = Mesh { material: other, ..bulging() };
    let mesh = model.add_mesh(&small);
    let places = [[-0.5, -0.4, 0.3], [0.4, -0.3, 0.2], [0.0, 0.5, 0.1_f32]];
    let turns =
        [[0.0, 0.0, 0.0, 1.0], [0.0, 0.247_404, 0.0, 0.968_912_4], [0.0, 0.0, 1.0, 0.0_f32]];
    let sizes = [[0.03, 0.03, 0.06], [0.05, 0.025, 0.1], [0.04, 0.04, 0.04_f32]];
    let [translation, scale] = [model.add_floats(&places), model.add_floats(&sizes)];
    let rotation = model.add_floats(&turns);
    let node = json!({ "mesh": mesh, "translation": [0.05, 0.0, 0.0], "extensions": {
        "EXT_mesh_gpu_instancing": { "attributes":
            { "TRANSLATION": translation, "ROTATION": rotation, "SCALE": scale } } } });
    for at in 0..3 {
        let own = json!({ "translation": places[at], "rotation": turns[at], "scale": sizes[at] });
        let world = local(&node) * local(&own);
        model.drawn.push(Drawn { mesh: small.clone(), world });
    }
    model.add_node(node);
    model
}

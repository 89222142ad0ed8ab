//! Where numbers come from: sparse accessors, small integers, data URIs and other files; and what moves
//! vertices at rest: morph targets and skins.

use std::fs;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};
use tempfile::TempDir;

use super::{BEFORE, WHITE, add_attribute, demand, drawn, glb, pixel, render, square};

pub fn tests() -> impl Iterator<Item = Trial> {
    let cases: [(_, fn() -> _); 6] = [
        ("sparse", sparse),
        ("quantized", quantized),
        ("data_uri", data_uri),
        ("file_beside", file_beside),
        ("morph_weights", morph_weights),
        ("skin_at_rest", skin_at_rest),
    ];
    cases.into_iter().map(|(name, run)| Trial::test(format!("render/model/read/{name}"), run))
}

/// A white square that needs no light.
fn unlit() -> (Value, Vec<u8>) {
    let (mut document, buffer) = square(&[]);
    document["materials"] = json!([{ "extensions": { "KHR_materials_unlit": {} } }]);
    (document, buffer)
}

/// Adds bytes to the buffer, and the view of them, whose number is the result.
fn add_view(document: &mut Value, buffer: &mut Vec<u8>, bytes: &[u8]) -> Result<usize, Failed> {
    let view = json!({ "buffer": 0, "byteOffset": buffer.len(), "byteLength": bytes.len() });
    buffer.extend(bytes);
    buffer.resize(buffer.len().next_multiple_of(4), 0);
    document["buffers"][0]["byteLength"] = json!(buffer.len());
    let views = document["bufferViews"].as_array_mut().ok_or("no views")?;
    views.push(view);
    Ok(views.len() - 1)
}

/// Whether a file shows the square from `left` to `right`, in units of its half width, around x = 0.
fn spans(file: &[u8], left: f64, right: f64) -> Result<(), Failed> {
    let (picture, _) = drawn(file, &BEFORE)?;
    // A unit is a quarter of the picture.
    for (at, is_white) in
        [(left - 0.2, false), (left + 0.2, true), (right - 0.2, true), (right + 0.2, false)]
    {
        let found = pixel(&picture, 0.5 + 0.25 * at, 0.5);
        demand((found == WHITE) == is_white, || format!("at {at}: {found:?}"))?;
    }
    Ok(())
}

/// glTF 2.0, 3.6.2.3: without a view all rows are zeros, of which the sparse part replaces some.
fn sparse() -> Result<(), Failed> {
    let (mut document, mut buffer) = unlit();
    // The corners without the one at the origin of the square's width: 1 is the lower left.
    let rows: Vec<u8> = [[-1.0_f32, 1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0]]
        .iter()
        .flatten()
        .flat_map(|number| number.to_le_bytes())
        .collect();
    let values = add_view(&mut document, &mut buffer, &rows)?;
    let indices = add_view(&mut document, &mut buffer, &[0, 2, 3])?;
    let accessor = &mut document["accessors"][0];
    accessor.as_object_mut().ok_or("no object")?.remove("bufferView");
    accessor["sparse"] = json!({ "count": 3,
        "indices": { "bufferView": indices, "componentType": 5121 },
        "values": { "bufferView": values } });
    let file = glb(&document, &buffer);
    let (picture, _) = drawn(&file, &BEFORE)?;
    // The lower left corner is at the origin now, so only the upper right half is there.
    let [there, not] = [(0.6, 0.4), (0.4, 0.6)].map(|(x, y)| pixel(&picture, x, y) == WHITE);
    demand(there && !not, || format!("upper right {there}, lower left {not}"))
}

/// KHR_mesh_quantization: positions in normalised bytes, of which 127 is 1.
fn quantized() -> Result<(), Failed> {
    let (mut document, mut buffer) = unlit();
    let rows = [[-127_i8, 127], [-127, -127], [127, -127], [127, 127]];
    let bytes: Vec<u8> = rows.iter().flat_map(|[x, y]| [*x as u8, *y as u8, 0, 0]).collect();
    let view = add_view(&mut document, &mut buffer, &bytes)?;
    document["bufferViews"][view]["byteStride"] = json!(4);
    document["accessors"][0] = json!({ "bufferView": view, "componentType": 5120, "count": 4,
        "type": "VEC3", "normalized": true, "min": [-1, -1, 0], "max": [1, 1, 0] });
    document["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
    document["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    spans(&glb(&document, &buffer), -1.0, 1.0)
}

/// A document whose buffer is in it.
fn data_uri() -> Result<(), Failed> {
    let (mut document, buffer) = unlit();
    let data = BASE64_STANDARD.encode(&buffer);
    document["buffers"][0]["uri"] = json!(format!("data:application/octet-stream;base64,{data}"));
    spans(document.to_string().as_bytes(), -1.0, 1.0)
}

/// A document whose buffer is in a file beside it, and one whose file is not there.
fn file_beside() -> Result<(), Failed> {
    let (mut document, buffer) = unlit();
    document["buffers"][0]["uri"] = json!("the%20buffer.bin");
    let text = document.to_string();
    let folder = TempDir::new()?;
    let missing = render(folder.path(), text.as_bytes(), &BEFORE)?;
    let printed = String::from_utf8_lossy(&missing.stderr).into_owned();
    let is_printed = !missing.status.success() && printed.contains("cannot read `the buffer.bin`");
    demand(is_printed, || format!("{}: {printed}", missing.status))?;
    fs::write(folder.path().join("the buffer.bin"), &buffer)?;
    let found = render(folder.path(), text.as_bytes(), &BEFORE)?;
    let printed = String::from_utf8_lossy(&found.stderr).into_owned();
    demand(found.status.success(), || format!("{}: {printed}", found.status))
}

/// 3.7.2.2: the weights of the node, or else those of the mesh, say how far the targets move vertices.
fn morph_weights() -> Result<(), Failed> {
    let (mut document, mut buffer) = unlit();
    add_attribute(&mut document, &mut buffer, "_MOVED", &[[1.0, 0.0, 0.0]; 4])?;
    document["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": 3 }]);
    document["meshes"][0]["weights"] = json!([0.5]);
    spans(&glb(&document, &buffer), -0.5, 1.5)?;
    document["nodes"][0]["weights"] = json!([-0.25]);
    spans(&glb(&document, &buffer), -1.25, 0.75)
}

/// 3.7.3: vertices are where the joints carry them, whatever the place of the mesh's node is: half of
/// the way of one joint, and half of that of another, whose matrix takes a part of it back.
fn skin_at_rest() -> Result<(), Failed> {
    let (mut document, mut buffer) = unlit();
    let moved = |x: f32| {
        let mut matrix = [0.0_f32; 16];
        (0..4).for_each(|at| matrix[5 * at] = 1.0);
        matrix[12] = x;
        matrix
    };
    let matrices: Vec<u8> = [moved(0.0), moved(-1.0)]
        .iter()
        .flatten()
        .flat_map(|number| number.to_le_bytes())
        .collect();
    let matrices = add_view(&mut document, &mut buffer, &matrices)?;
    let joints = add_view(&mut document, &mut buffer, &[0, 1, 0, 0].repeat(4))?;
    add_attribute(&mut document, &mut buffer, "WEIGHTS_0", &[[0.5, 0.5, 0.0, 0.0]; 4])?;
    let accessors = document["accessors"].as_array_mut().ok_or("no accessors")?;
    accessors
        .push(json!({ "bufferView": joints, "componentType": 5121, "count": 4, "type": "VEC4" }));
    accessors
        .push(json!({ "bufferView": matrices, "componentType": 5126, "count": 2, "type": "MAT4" }));
    let count = accessors.len();
    document["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = json!(count - 2);
    document["skins"] = json!([{ "joints": [1, 2], "inverseBindMatrices": count - 1 }]);
    document["nodes"] = json!([
        { "mesh": 0, "skin": 0, "translation": [9.0, 9.0, 9.0] },
        { "translation": [0.5, 0.0, 0.0], "children": [2] },
        { "translation": [1.0, 0.0, 0.0] },
    ]);
    document["scenes"] = json!([{ "nodes": [0, 1] }]);
    // (0.5 + (0.5 + 1 - 1)) / 2
    spans(&glb(&document, &buffer), -0.5, 1.5)
}

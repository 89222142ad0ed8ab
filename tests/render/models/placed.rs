//! Nodes: instances of a mesh, hidden nodes, and the numbers of cameras.

use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};

use super::{BEFORE, add_attribute, demand, drawn, glb, is_near, pixel, square};

pub fn tests() -> impl Iterator<Item = Trial> {
    let cases: [(_, fn() -> _); 5] = [
        ("instances", instances),
        ("hidden", hidden),
        ("camera_by_its_number", camera_by_its_number),
        ("camera_that_is_far", camera_that_is_far),
        ("camera_that_is_wide", camera_that_is_wide),
    ];
    cases.into_iter().map(|(name, run)| Trial::test(format!("render/model/placed/{name}"), run))
}

/// A white square that needs no light.
fn unlit() -> (Value, Vec<u8>) {
    let (mut document, buffer) = square(&[]);
    document["materials"] = json!([{ "extensions": { "KHR_materials_unlit": {} } }]);
    (document, buffer)
}

/// EXT_mesh_gpu_instancing: squares of a quarter of the size, one unit to the left and to the right
/// of the node, which is itself moved up by a half. Nothing is at the node.
fn instances() -> Result<(), Failed> {
    let (mut document, mut buffer) = unlit();
    add_attribute(&mut document, &mut buffer, "_AT", &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]])?;
    add_attribute(&mut document, &mut buffer, "_SIZE", &[[0.25, 0.25, 1.0]; 2])?;
    document["nodes"] = json!([{ "mesh": 0, "translation": [0.0, 0.5, 0.0],
        "extensions": { "EXT_mesh_gpu_instancing":
            { "attributes": { "TRANSLATION": 3, "SCALE": 4 } } } }]);
    let (picture, _) = drawn(&glb(&document, &buffer), &BEFORE)?;
    // A unit is a quarter of the picture.
    for (x, y, is_there) in
        [(0.25, 0.375, true), (0.75, 0.375, true), (0.5, 0.375, false), (0.25, 0.5, false)]
    {
        let found = pixel(&picture, x, y);
        demand(is_near(found, [255; 3], 0) == is_there, || format!("({x}, {y}): {found:?}"))?;
    }
    document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] = json!(0);
    let refused = drawn(&glb(&document, &buffer), &BEFORE);
    let message = refused.err().map(|error| format!("{error:?}")).unwrap_or_default();
    demand(message.contains("have not the same number of rows"), || format!("found {message}"))
}

/// KHR_node_visibility: "visible: false" hides the node and all of its descendants.
fn hidden() -> Result<(), Failed> {
    let (mut document, buffer) = unlit();
    let hidden = json!({ "KHR_node_visibility": { "visible": false } });
    document["nodes"] = json!([
        { "mesh": 0, "scale": [0.25, 0.25, 1.0], "translation": [-1.0, 0.0, 0.0] },
        { "children": [2], "extensions": hidden },
        { "mesh": 0, "extensions": { "KHR_node_visibility": { "visible": true } } },
    ]);
    document["scenes"] = json!([{ "nodes": [0, 1] }]);
    let (picture, _) = drawn(&glb(&document, &buffer), &BEFORE)?;
    let [shown, not] = [(0.25, 0.5), (0.5, 0.5)].map(|(x, y)| pixel(&picture, x, y));
    demand(is_near(shown, [255; 3], 0) && !is_near(not, [255; 3], 0), || {
        format!("shown {shown:?}, hidden {not:?}")
    })
}

/// Cameras have their numbers of the document. An orthographic one sees two units to each side: the square is
/// the middle half of the picture.
fn camera_by_its_number() -> Result<(), Failed> {
    let (mut document, buffer) = unlit();
    document["cameras"] = json!([
        { "type": "orthographic",
          "orthographic": { "xmag": 2.0, "ymag": 2.0, "znear": 0.1, "zfar": 10.0 } },
        { "type": "perspective", "perspective": { "yfov": 0.7, "znear": 0.1 } },
    ]);
    document["nodes"] = json!([
        { "mesh": 0 }, { "camera": 0, "translation": [0.0, 0.0, 7.0] }, { "camera": 1, "translation": [0.0, 0.0, 2.0] },
    ]);
    document["scenes"] = json!([{ "nodes": [0, 1, 2] }]);
    let file = glb(&document, &buffer);
    let (picture, _) = drawn(&file, &["--camera", "1"])?;
    let corner = pixel(&picture, 0.1, 0.1);
    demand(is_near(corner, [255; 3], 0), || format!("expected the near view, found {corner:?}"))?;
    let (picture, _) = drawn(&file, &["--camera", "0"])?;
    for (at, is_there) in [(0.22, false), (0.28, true), (0.72, true), (0.78, false)] {
        let found = pixel(&picture, at, 0.5);
        demand((found == [255; 3]) == is_there, || format!("at {at}: {found:?}"))?;
    }
    let refused = drawn(&file, &["--camera", "2"]);
    let message = refused.err().map(|error| format!("{error:?}")).unwrap_or_default();
    demand(message.contains("no camera 2 in its scene, only 0, 1"), || format!("found {message}"))
}

/// An orthographic camera shows the same whatever its distance, between its two planes.
fn camera_that_is_far() -> Result<(), Failed> {
    let (mut document, buffer) = unlit();
    for (distance, near, far, is_seen) in [
        (0.5, 0.1, 1.0, true),
        (200.0, 0.1, 201.0, true),
        (5000.0, 4999.0, 5001.0, true),
        (5000.0, 0.1, 4999.0, false),
        (200.0, 201.0, 300.0, false),
    ] {
        document["cameras"] = json!([{ "type": "orthographic",
            "orthographic": { "xmag": 2.0, "ymag": 2.0, "znear": near, "zfar": far } }]);
        document["nodes"] =
            json!([{ "mesh": 0 }, { "camera": 0, "translation": [0.0, 0.0, distance] }]);
        document["scenes"] = json!([{ "nodes": [0, 1] }]);
        let (picture, _) = drawn(&glb(&document, &buffer), &[])?;
        for (at, is_inside) in [(0.24, false), (0.26, true), (0.74, true), (0.76, false)] {
            let found = pixel(&picture, at, 0.5);
            demand((found == [255; 3]) == (is_inside && is_seen), || {
                format!("from {distance}, {near} to {far}, at {at}: {found:?}")
            })?;
        }
    }
    Ok(())
}

/// glTF 2.0, 3.10.2: a picture of another form shows all that the camera does. The camera sees two units to
/// the sides and one up and down, so that a square picture shows two everywhere: the square, whose
/// half width is one, is its middle half.
fn camera_that_is_wide() -> Result<(), Failed> {
    let (mut document, buffer) = unlit();
    document["cameras"] = json!([{ "type": "perspective", "perspective":
        { "yfov": 2.0 * 0.5_f64.atan(), "aspectRatio": 2.0, "znear": 0.1 } }]);
    document["nodes"] = json!([{ "mesh": 0 }, { "camera": 0, "translation": [0.0, 0.0, 2.0] }]);
    document["scenes"] = json!([{ "nodes": [0, 1] }]);
    let (picture, _) = drawn(&glb(&document, &buffer), &[])?;
    for (x, y, is_there) in
        [(0.22, 0.5, false), (0.28, 0.5, true), (0.5, 0.22, false), (0.5, 0.28, true)]
    {
        let found = pixel(&picture, x, y);
        demand(is_near(found, [255; 3], 0) == is_there, || format!("({x}, {y}): {found:?}"))?;
    }
    Ok(())
}

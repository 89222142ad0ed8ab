//! Coordinates of textures: moved, turned, scaled, repeated, of another set; and images that cannot be
//! decoded.

use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};

use super::{
    BEFORE, BLUE, GREEN, RED, WHITE, add_attribute, demand, drawn, glb, has_quarters, image,
    is_near, pixel, square,
};

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("render/model/coordinates/turned", turned_quarter),
        Trial::test("render/model/coordinates/each_its_own", each_its_own),
        Trial::test("render/model/cells_of_textures", cells_of_textures),
        Trial::test("render/model/coordinates/repeated_in_cells", repeated_in_cells),
        Trial::test("render/model/coordinates/second_set", second_set),
        Trial::test("render/model/coordinates/sets_beside_each_other", sets_beside_each_other),
        Trial::test("render/model/image_that_is_none", image_that_is_none),
    ]
}

/// A material that is not lit, with a texture that is moved.
fn unlit(index: usize, transform: &Value) -> Value {
    json!({
        "pbrMetallicRoughness": { "baseColorTexture": {
            "index": index, "extensions": { "KHR_texture_transform": transform },
        } },
        "extensions": { "KHR_materials_unlit": {} },
    })
}

/// An image of four by four pixels that are red, green, blue and white by rows, apart from its lower
/// left quarter, which has one of each.
fn quartered() -> Result<Vec<u8>, Failed> {
    let row = |left: [[u8; 3]; 2], right| [left[0], left[1], right, right].concat();
    let black = [[0; 3]; 2];
    let pixels = [
        row(black, [9; 3]),
        row(black, [9; 3]),
        row([RED, GREEN], [9; 3]),
        row([BLUE, WHITE], [9; 3]),
    ];
    Ok(lamplight::picture::Picture { width: 4, height: 4, pixels: pixels.concat() }.png()?)
}

/// The example of the extension: only the lower left quarter of the image, turned clockwise by 90
/// degrees.
fn turned_quarter() -> Result<(), Failed> {
    let (mut document, buffer) = square(&[quartered()?]);
    let transform =
        json!({ "offset": [0, 1], "rotation": std::f64::consts::FRAC_PI_2, "scale": [0.5, 0.5] });
    document["extensionsUsed"] = json!(["KHR_materials_unlit", "KHR_texture_transform"]);
    document["extensionsRequired"] = json!(["KHR_texture_transform"]);
    document["materials"] = json!([unlit(0, &transform)]);
    let (picture, _) = drawn(&glb(&document, &buffer), &BEFORE)?;
    has_quarters(&picture, [BLUE, RED, WHITE, GREEN])
}

/// Two textures of a material with transformations of their own are where each of them says: the
/// colour is not moved, and the emission is moved by half of its image.
fn each_its_own() -> Result<(), Failed> {
    let color = image([[40, 0, 0], [0, 40, 0], [0, 0, 40], [40; 3]])?;
    let glow = image([WHITE, [0; 3], [0; 3], [0; 3]])?;
    let (mut document, buffer) = square(&[color, glow]);
    document["extensionsUsed"] = json!(["KHR_texture_transform"]);
    let moved = json!({ "KHR_texture_transform": { "offset": [0.5, 0.0] } });
    document["materials"] = json!([{
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 }, "metallicFactor": 0.0 },
        "emissiveFactor": [1, 1, 1],
        "emissiveTexture": { "index": 1, "extensions": moved },
    }]);
    let (picture, _) = drawn(&glb(&document, &buffer), &BEFORE)?;
    let [left, right] = [0.4, 0.6].map(|x| pixel(&picture, x, 0.4));
    demand(right == WHITE && left[0] < 200, || {
        format!("the upper right quarter should glow, and not the left: {left:?}, {right:?}")
    })
}

/// The images of several materials are packed into one texture. Each square still shows only its own
/// image.
fn cells_of_textures() -> Result<(), Failed> {
    let images = [image([RED; 4])?, image([GREEN; 4])?, image([BLUE; 4])?, image([WHITE; 4])?];
    let (mut document, buffer) = square(&images);
    let material =
        |index| json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": index } } });
    document["materials"] = (0..4).map(material).collect();
    let part = document["meshes"][0]["primitives"][0].clone();
    let mesh = |index| {
        let mut part = part.clone();
        part["material"] = json!(index);
        json!({ "primitives": [part] })
    };
    document["meshes"] = (0..4).map(mesh).collect();
    let places = [[-0.5, 0.5], [0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]];
    let node = |(mesh, [x, y]): (usize, [f64; 2])| json!({ "mesh": mesh, "translation": [x, y, 0.0], "scale": [0.5, 0.5, 1.0] });
    document["nodes"] = places.into_iter().enumerate().map(node).collect();
    document["scenes"] = json!([{ "nodes": [0, 1, 2, 3] }]);
    let (picture, _) = drawn(&glb(&document, &buffer), &BEFORE)?;
    has_quarters(&picture, [RED, GREEN, BLUE, WHITE])
}

/// Where several materials share a texture of the renderer, each still repeats its own image.
fn repeated_in_cells() -> Result<(), Failed> {
    let images = [image([RED, GREEN, BLUE, WHITE])?, image([WHITE; 4])?];
    let (mut document, buffer) = square(&images);
    let plain = json!({});
    // Three repetitions across, so that the upper row has red and green in turn.
    let thrice = json!({ "scale": [3, 3] });
    document["extensionsUsed"] = json!(["KHR_materials_unlit", "KHR_texture_transform"]);
    document["materials"] = json!([unlit(0, &thrice), unlit(1, &plain)]);
    let mut other = document["meshes"][0]["primitives"][0].clone();
    other["material"] = json!(1);
    document["meshes"] = json!([document["meshes"][0], { "primitives": [other] }]);
    document["nodes"] = json!([{ "mesh": 0 }, { "mesh": 1, "translation": [5, 0, 0] }]);
    document["scenes"] = json!([{ "nodes": [0, 1] }]);
    let (picture, _) = drawn(&glb(&document, &buffer), &BEFORE)?;
    // The square covers the middle half of the picture, and each repetition a sixth of it.
    let expected = [RED, GREEN];
    for (index, x) in (0..6).map(|index| (index, 0.25 + (f64::from(index) + 0.5) / 12.0)) {
        let (found, expected) = (pixel(&picture, x, 0.29), expected[index as usize % 2]);
        demand(is_near(found, expected, 60), || {
            format!("pixel {index} of the row: found {found:?}, expected {expected:?}")
        })?;
    }
    Ok(())
}

/// A document with a second set of coordinates, which turns the image by half a turn.
fn with_second_set(images: &[Vec<u8>]) -> Result<(Value, Vec<u8>), Failed> {
    let (mut document, mut buffer) = square(images);
    let turned = [[1.0, 1.0], [1.0, 0.0], [0.0, 0.0], [0.0, 1.0]];
    add_attribute(&mut document, &mut buffer, "TEXCOORD_1", &turned)?;
    Ok((document, buffer))
}

/// A texture with the second set of coordinates is drawn with that set.
fn second_set() -> Result<(), Failed> {
    let (mut document, buffer) = with_second_set(&[image([RED, GREEN, BLUE, WHITE])?])?;
    document["extensionsUsed"] = json!(["KHR_materials_unlit"]);
    document["materials"] = json!([{
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 0, "texCoord": 1 } },
        "extensions": { "KHR_materials_unlit": {} },
    }]);
    let (picture, stderr) = drawn(&glb(&document, &buffer), &BEFORE)?;
    demand(!stderr.contains("other coordinates"), || format!("expected no note, found: {stderr}"))?;
    has_quarters(&picture, [WHITE, BLUE, GREEN, RED])
}

/// A second texture with another set than the first is drawn with that set: the second set turns the image by
/// half a turn. Where all of the first set is one point, it counts with its mean, and a note says so.
fn sets_beside_each_other() -> Result<(), Failed> {
    let images = [image([[0; 3]; 4])?, image([RED, GREEN, BLUE, WHITE])?];
    let (mut document, buffer) = with_second_set(&images)?;
    document["materials"] = json!([{
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 }, "metallicFactor": 0.0 },
        "emissiveFactor": [1, 1, 1],
        "emissiveTexture": { "index": 1, "texCoord": 1 },
    }]);
    let (picture, stderr) = drawn(&glb(&document, &buffer), &BEFORE)?;
    demand(!stderr.contains("with their mean"), || format!("expected no note: {stderr}"))?;
    has_quarters(&picture, [WHITE, BLUE, GREEN, RED])?;
    let twice =
        json!([document["meshes"][0]["primitives"][0], document["meshes"][0]["primitives"][0]]);
    document["meshes"][0]["primitives"] = twice;
    let attributes = &mut document["meshes"][0]["primitives"][1]["attributes"];
    attributes["TEXCOORD_1"] = attributes["TEXCOORD_0"].clone();
    let (_, stderr) = drawn(&glb(&document, &buffer), &BEFORE)?;
    demand(
        stderr.contains("counts with its mean: its triangles share places of the first set"),
        || format!("expected a note: {stderr}"),
    )
}

/// An image that cannot be decoded is left out with a note, and the factor remains.
fn image_that_is_none() -> Result<(), Failed> {
    let (mut document, buffer) = square(&[b"no image".to_vec()]);
    document["extensionsUsed"] = json!(["KHR_materials_unlit"]);
    document["materials"] = json!([{
        "pbrMetallicRoughness": {
            "baseColorFactor": [0.25, 0.5, 1.0, 1.0], "baseColorTexture": { "index": 0 },
        },
        "extensions": { "KHR_materials_unlit": {} },
    }]);
    let (picture, stderr) = drawn(&glb(&document, &buffer), &BEFORE)?;
    demand(stderr.contains("images[0] is ignored"), || {
        format!("expected a note, found: {stderr}")
    })?;
    let found = pixel(&picture, 0.5, 0.5);
    demand(is_near(found, [137, 188, 255], 1), || {
        format!("expected the factor, [137, 188, 255], found {found:?}")
    })
}

//! Models of users. The tests write binary glTF files, and `lamplight render --model` draws them.

mod coordinates;
mod edges;
mod faces;
mod lamps;
mod layers;
mod maps;
mod placed;
mod read;
mod sides;
mod wrong;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use lamplight::picture::Picture;
use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};
use tempfile::TempDir;

pub fn tests() -> Vec<Trial> {
    let drawn = [
        Trial::test("render/model/unlit_colour_is_exact", unlit_color_is_exact),
        Trial::test("render/model/unlit_colours_are_multiplied", unlit_colors_are_multiplied),
        Trial::test("render/model/all_of_it_is_seen", all_of_it_is_seen),
        Trial::test("render/model/textures_stand_upright", textures_stand_upright),
        Trial::test("render/model/mirrored_is_the_same", mirrored_is_the_same),
        Trial::test("render/model/bumps_rise", bumps_rise),
        Trial::test("render/model/lamp_and_camera", lamp_and_camera),
        Trial::test("render/model/omissions_are_reported", omissions_are_reported),
        Trial::test("render/model/means_of_textures", means_of_textures),
        Trial::test("render/model/choices_of_the_user", choices_of_the_user),
    ];
    drawn
        .into_iter()
        .chain(coordinates::tests())
        .chain(edges::tests())
        .chain(faces::tests())
        .chain(lamps::tests())
        .chain(layers::tests())
        .chain(maps::tests())
        .chain(placed::tests())
        .chain(read::tests())
        .chain(sides::tests())
        .chain(wrong::tests())
        .collect()
}

/// A binary glTF file.
fn glb(document: &Value, buffer: &[u8]) -> Vec<u8> {
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut data = buffer.to_vec();
    data.resize(data.len().next_multiple_of(4), 0);
    let chunk =
        |kind: &[u8], bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes(), kind, bytes].concat();
    let body = [chunk(b"JSON", &text), chunk(b"BIN\0", &data)].concat();
    let length = (body.len() as u32 + 12).to_le_bytes();
    [b"glTF".as_slice(), &2_u32.to_le_bytes(), &length, &body].concat()
}

/// A square in the plane of x and y that faces along z. The upper left corner of its image is at
/// (-1, 1). The numbers are the position and the coordinates in the image.
const CORNERS: [[f32; 5]; 4] = [
    [-1.0, 1.0, 0.0, 0.0, 0.0],
    [-1.0, -1.0, 0.0, 0.0, 1.0],
    [1.0, -1.0, 0.0, 1.0, 1.0],
    [1.0, 1.0, 0.0, 1.0, 0.0],
];
const TRIANGLES: [u16; 6] = [0, 1, 2, 0, 2, 3];

/// Pixels of images are squares, so that each has its colour.
const NEAREST: u32 = 9728;

/// The document and the buffer of a square. The images come after the square in the buffer.
fn square(images: &[Vec<u8>]) -> (Value, Vec<u8>) {
    let mut buffer: Vec<u8> =
        CORNERS.iter().flatten().flat_map(|number| number.to_le_bytes()).collect();
    buffer.extend(TRIANGLES.iter().flat_map(|index| index.to_le_bytes()));
    let mut views = vec![
        json!({ "buffer": 0, "byteLength": 80, "byteStride": 20 }),
        json!({ "buffer": 0, "byteOffset": 80, "byteLength": 12 }),
    ];
    let mut listed = Vec::new();
    for image in images {
        views.push(json!({ "buffer": 0, "byteOffset": buffer.len(), "byteLength": image.len() }));
        listed.push(json!({ "bufferView": views.len() - 1, "mimeType": "image/png" }));
        buffer.extend(image);
        buffer.resize(buffer.len().next_multiple_of(4), 0);
    }
    let textures: Vec<Value> =
        (0..images.len()).map(|index| json!({ "source": index, "sampler": 0 })).collect();
    let mut document = json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{
            "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "indices": 2, "material": 0,
        }] }],
        "materials": [{}],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
              "min": [-1, -1, 0], "max": [1, 1, 0] },
            { "bufferView": 0, "byteOffset": 12, "componentType": 5126, "count": 4, "type": "VEC2" },
            { "bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR" },
        ],
        "bufferViews": views,
        "buffers": [{ "byteLength": buffer.len() }],
    });
    if !listed.is_empty() {
        document["images"] = listed.into();
        document["textures"] = textures.into();
        document["samplers"] = json!([{ "magFilter": NEAREST }]);
    }
    (document, buffer)
}

/// An image of two by two pixels, the upper row first.
fn image(pixels: [[u8; 3]; 4]) -> Result<Vec<u8>, Failed> {
    Ok(Picture { width: 2, height: 2, pixels: pixels.concat() }.png()?)
}

fn render(folder: &Path, file: &[u8], arguments: &[&str]) -> Result<Output, Failed> {
    fs::write(folder.join("model.glb"), file)?;
    let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
    command.current_dir(folder).args(["render", "--model", "model.glb", "--executor", "eval"]);
    command.args(["--size", "48x48", "--force", "-o", "out.png"]).args(arguments);
    Ok(command.output()?)
}

/// The picture of a model, and the text on standard error.
fn drawn(file: &[u8], arguments: &[&str]) -> Result<(Picture, String), Failed> {
    let folder = TempDir::new()?;
    let output = render(folder.path(), file, arguments)?;
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    if !output.status.success() {
        return Err(format!("{}: {stderr}", output.status).into());
    }
    Ok((super::read(&folder.path().join("out.png"))?, stderr))
}

/// A camera in front of the square, which then fills the middle half of the picture.
const BEFORE: [&str; 2] = ["--camera", "0,0,5.5,0,0,0"];

fn pixel(picture: &Picture, x: f64, y: f64) -> [u8; 3] {
    let at = |share: f64, size: u32| (share * f64::from(size)) as u32;
    let index = at(y, picture.height) * picture.width + at(x, picture.width);
    let start = 3 * index as usize;
    [0, 1, 2].map(|part| picture.pixels[start + part])
}

fn is_near(found: [u8; 3], expected: [u8; 3], most: u8) -> bool {
    found.iter().zip(expected).all(|(found, expected)| found.abs_diff(expected) <= most)
}

fn demand(holds: bool, otherwise: impl FnOnce() -> String) -> Result<(), Failed> {
    if holds { Ok(()) } else { Err(otherwise().into()) }
}

/// An unlit surface has exactly the colour in the file: in sRGB 0.25 is 137 of 255, 0.5 is 188, and
/// 1 is 255.
fn unlit_color_is_exact() -> Result<(), Failed> {
    let (mut document, buffer) = square(&[]);
    document["extensionsUsed"] = json!(["KHR_materials_unlit"]);
    document["materials"] = json!([{
        "pbrMetallicRoughness": { "baseColorFactor": [0.25, 0.5, 1.0, 1.0] },
        "extensions": { "KHR_materials_unlit": {} },
    }]);
    let (picture, _) = drawn(&glb(&document, &buffer), &BEFORE)?;
    let found = pixel(&picture, 0.5, 0.5);
    demand(is_near(found, [137, 188, 255], 1), || {
        format!("expected [137, 188, 255] in the middle, found {found:?}")
    })
}

/// Adds an attribute of vectors, one for each corner, to the mesh of a document.
fn add_attribute<const N: usize>(
    document: &mut Value,
    buffer: &mut Vec<u8>,
    name: &str,
    corners: &[[f32; N]],
) -> Result<(), Failed> {
    let (start, count) = (buffer.len(), corners.len());
    buffer.extend(corners.iter().flatten().flat_map(|number| number.to_le_bytes()));
    let views = document["bufferViews"].as_array_mut().ok_or("no views")?;
    views.push(json!({ "buffer": 0, "byteOffset": start, "byteLength": 4 * N * count }));
    let view = views.len() - 1;
    let accessors = document["accessors"].as_array_mut().ok_or("no accessors")?;
    accessors.push(json!({
        "bufferView": view, "componentType": 5126, "count": count, "type": format!("VEC{N}"),
    }));
    let accessor = accessors.len() - 1;
    document["meshes"][0]["primitives"][0]["attributes"][name] = json!(accessor);
    document["buffers"][0]["byteLength"] = json!(buffer.len());
    Ok(())
}

/// The colour of an unlit surface is that of its factor, its texture and its corners, multiplied, and
/// nothing else, in the permutation that the command says.
fn unlit_colors_are_multiplied() -> Result<(), Failed> {
    // In sRGB 188 is a half.
    let (mut document, mut buffer) = square(&[image([[188, 255, 188]; 4])?]);
    add_attribute(&mut document, &mut buffer, "COLOR_0", &[[0.5, 0.5, 1.0]; 4])?;
    document["extensionsUsed"] = json!(["KHR_materials_unlit"]);
    document["materials"] = json!([{
        "pbrMetallicRoughness": {
            "baseColorFactor": [1.0, 0.5, 0.5, 1.0], "baseColorTexture": { "index": 0 },
        },
        "extensions": { "KHR_materials_unlit": {} },
    }]);
    let file = glb(&document, &buffer);
    let (picture, _) = drawn(&file, &BEFORE)?;
    let found = pixel(&picture, 0.5, 0.5);
    demand(is_near(found, [137, 137, 137], 1), || {
        format!("expected a quarter of the light, [137, 137, 137], found {found:?}")
    })?;
    let key = "`ambient=none,base_map,lights=none`";
    let output = render(TempDir::new()?.path(), &file, &BEFORE)?;
    let stdout = String::from_utf8_lossy(&output.stdout);
    demand(stdout.contains(key), || format!("expected {key}, found: {stdout}"))
}

/// The view that is chosen for a model shows all of it, and fills a good part of the picture,
/// wherever the model is and however large it is.
fn all_of_it_is_seen() -> Result<(), Failed> {
    for (scale, place) in [(1.0, [0.0; 3]), (250.0, [1e4, -300.0, 77.0]), (1e-3, [0.0, 2.0, 0.0])] {
        let (mut document, buffer) = square(&[]);
        document["nodes"] =
            json!([{ "mesh": 0, "scale": [scale, scale, scale], "translation": place }]);
        let file = glb(&document, &buffer);
        let constant = ["--set", "ambient=constant"];
        let (picture, _) = drawn(&file, &constant)?;
        let away = [constant.as_slice(), &["--camera", "9e6,0,0,9e7,0,0"]].concat();
        let (ground, _) = drawn(&file, &away)?;
        let differs = |x: u32, y: u32| {
            let start = 3 * (y * picture.width + x) as usize;
            picture.pixels[start..start + 3] != ground.pixels[start..start + 3]
        };
        let covered = (0..48).flat_map(|y| (0..48).map(move |x| (x, y)));
        let covered: Vec<(u32, u32)> = covered.filter(|(x, y)| differs(*x, *y)).collect();
        let cut = covered.iter().filter(|(x, y)| [*x, *y].iter().any(|at| *at == 0 || *at == 47));
        let (all, cut) = (covered.len(), cut.count());
        demand(cut == 0 && all > 350, || {
            let found = format!("{all} pixels, {cut} of them at the edge");
            format!("scale {scale}: {found}; expected more than 350, none at the edge")
        })?;
    }
    Ok(())
}

const RED: [u8; 3] = [255, 0, 0];
const GREEN: [u8; 3] = [0, 255, 0];
const BLUE: [u8; 3] = [0, 0, 255];
const WHITE: [u8; 3] = [255; 3];

/// Which of red, green and blue a pixel has. A channel far below the largest is a highlight's white.
fn hue(pixel: [u8; 3]) -> [bool; 3] {
    let most = pixel.into_iter().max().unwrap_or(0);
    pixel.map(|part| u32::from(part) * 4 > u32::from(most) * 3)
}

fn has_quarters(picture: &Picture, quarters: [[u8; 3]; 4]) -> Result<(), Failed> {
    let places = [(0.4, 0.4), (0.6, 0.4), (0.4, 0.6), (0.6, 0.6)];
    for ((x, y), expected) in places.into_iter().zip(quarters) {
        let found = pixel(picture, x, y);
        demand(hue(found) == hue(expected), || {
            format!("at ({x}, {y}): found {found:?}, expected the hue of {expected:?}")
        })?;
    }
    Ok(())
}

/// An image is neither turned nor mirrored on the square.
fn textures_stand_upright() -> Result<(), Failed> {
    let (mut document, buffer) = square(&[image([RED, GREEN, BLUE, WHITE])?]);
    document["materials"] =
        json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    let (picture, _) = drawn(&glb(&document, &buffer), &BEFORE)?;
    has_quarters(&picture, [RED, GREEN, BLUE, WHITE])
}

/// A square that a negative scale mirrors still faces the viewer, with its image mirrored.
fn mirrored_is_the_same() -> Result<(), Failed> {
    let (mut document, buffer) = square(&[image([RED, GREEN, BLUE, WHITE])?]);
    document["materials"] =
        json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    document["nodes"] = json!([{ "mesh": 0, "scale": [-1.0, 1.0, 1.0] }]);
    let (picture, _) = drawn(&glb(&document, &buffer), &BEFORE)?;
    has_quarters(&picture, [GREEN, RED, WHITE, BLUE])
}

/// The green channel of a normal map points up in its image. So under light from above, a normal
/// that leans up is brighter than one that leans down. The file has no tangents.
fn bumps_rise() -> Result<(), Failed> {
    let (up, down) = ([128, 218, 218], [128, 37, 218]);
    let (mut document, buffer) = square(&[image([up, up, down, down])?]);
    document["materials"] = json!([{ "normalTexture": { "index": 0 } }]);
    document["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    document["extensions"] = json!({ "KHR_lights_punctual": { "lights": [
        { "type": "directional", "intensity": 3.0 },
    ] } });
    // The light is turned about x by -45 degrees, so it shines down and away from the viewer.
    let (sin, cos) = (std::f64::consts::PI / 8.0).sin_cos();
    let turn = [-sin, 0.0, 0.0, cos];
    document["nodes"] = json!([
        { "mesh": 0 },
        { "rotation": turn, "extensions": { "KHR_lights_punctual": { "light": 0 } } },
    ]);
    document["scenes"] = json!([{ "nodes": [0, 1] }]);
    let (picture, _) = drawn(&glb(&document, &buffer), &BEFORE)?;
    let (above, below) = (pixel(&picture, 0.5, 0.4), pixel(&picture, 0.5, 0.6));
    demand(above[1] > below[1] + 40, || {
        format!("{above:?} above should be brighter than {below:?} below, by more than 40")
    })
}

/// The lamp and the camera of the file are used. A lamp in front of the square lights it, and one
/// behind it does not.
fn lamp_and_camera() -> Result<(), Failed> {
    let lit = |z: f64| -> Result<[u8; 3], Failed> {
        let (mut document, buffer) = square(&[]);
        document["extensionsUsed"] = json!(["KHR_lights_punctual"]);
        document["extensions"] = json!({ "KHR_lights_punctual": { "lights": [
            { "type": "point", "intensity": 40.0, "color": [1.0, 0.0, 0.0] },
        ] } });
        document["cameras"] = json!([{
            "type": "perspective", "perspective": { "yfov": 0.7, "znear": 0.1 },
        }]);
        document["nodes"] = json!([
            { "mesh": 0 },
            { "translation": [0.0, 0.0, z], "extensions": { "KHR_lights_punctual": { "light": 0 } } },
            { "translation": [0.0, 0.0, 6.0], "camera": 0 },
        ]);
        document["scenes"] = json!([{ "nodes": [0, 1, 2] }]);
        let (picture, _) = drawn(&glb(&document, &buffer), &["--set", "ambient=none"])?;
        Ok(pixel(&picture, 0.5, 0.5))
    };
    let (before, behind) = (lit(3.0)?, lit(-3.0)?);
    demand(before[0] > 60 && before[1] < 20, || {
        format!("a red lamp in front should light the square red, found {before:?}")
    })?;
    demand(behind.iter().all(|part| *part < 20), || {
        format!("a lamp behind should leave the square dark, found {behind:?}")
    })
}

/// A note names the parts of the file that are not drawn.
fn omissions_are_reported() -> Result<(), Failed> {
    let (mut document, buffer) = square(&[image([WHITE; 4])?]);
    document["materials"] = json!([{
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } },
        "emissiveTexture": { "index": 0, "texCoord": 1 },
        "alphaMode": "BLEND",
    }]);
    let (_, stderr) = drawn(&glb(&document, &buffer), &[])?;
    for part in ["note: `model.glb`: ", "no `TEXCOORD_1`", "have no shadows"] {
        demand(stderr.contains(part), || format!("expected `{part}` in `{stderr}`"))?;
    }
    Ok(())
}

/// Textures that the permutation does not have count with their mean. So a half that shines and a half
/// that does not give the picture of a factor of 0.5, and the same for metal, roughness and
/// occlusion.
fn means_of_textures() -> Result<(), Failed> {
    let emitted = image([WHITE, [0; 3], [0; 3], WHITE])?;
    let rough = image([[255, 128, 0]; 4])?;
    let open = image([[0; 3], [255; 3], [255; 3], [0; 3]])?;
    let (mut document, buffer) = square(&[emitted, rough, open]);
    let own = json!({ "baseColorFactor": [0.6, 0.3, 0.2, 1.0] });
    let mut textured = json!({ "pbrMetallicRoughness": own, "emissiveFactor": [0.2, 0.4, 0.0] });
    let mut factors = textured.clone();
    textured["emissiveTexture"] = json!({ "index": 0 });
    textured["pbrMetallicRoughness"]["metallicRoughnessTexture"] = json!({ "index": 1 });
    factors["emissiveFactor"] = json!([0.1, 0.2, 0.0]);
    factors["pbrMetallicRoughness"]["metallicFactor"] = json!(0.0);
    factors["pbrMetallicRoughness"]["roughnessFactor"] = json!(128.0 / 255.0);
    let without = ["--set", "material_maps=false,occlusion=none,ambient=hemisphere"];
    let arguments = [BEFORE, without].concat();
    let mut taken = |material: &Value| {
        document["materials"] = json!([material]);
        drawn(&glb(&document, &buffer), &arguments)
    };
    let ((one, stderr), (other, _)) = (taken(&textured)?, taken(&factors)?);
    let note = "count with their mean, and those of extensions not at all: emission_map, \
        metallic_roughness_map";
    demand(stderr.contains(note), || format!("expected `{note}` in `{stderr}`"))?;
    let (found, expected) = (pixel(&one, 0.5, 0.5), pixel(&other, 0.5, 0.5));
    demand(is_near(found, expected, 1), || format!("found {found:?}, by factors {expected:?}"))?;
    textured["occlusionTexture"] = json!({ "index": 2 });
    let (dim, _) = taken(&textured)?;
    let darker = pixel(&dim, 0.5, 0.5);
    demand(darker[0] + 5 < found[0], || format!("{darker:?} should be darker than {found:?}"))
}

/// The user's settings override those that the model asks for, even if they rule these out.
fn choices_of_the_user() -> Result<(), Failed> {
    let (document, buffer) = square(&[]);
    let folder = TempDir::new()?;
    for (set, key) in [("diffuse=wrap", "diffuse=wrap"), ("lights=none", "lights=none")] {
        let output = render(folder.path(), &glb(&document, &buffer), &["--set", set])?;
        let stdout = String::from_utf8_lossy(&output.stdout).into_owned();
        let is_taken = output.status.success() && stdout.contains(key);
        demand(is_taken, || {
            let found = format!("{stdout}{}", String::from_utf8_lossy(&output.stderr));
            format!("expected success and `{key}`, {}: {found}", output.status)
        })?;
    }
    Ok(())
}

//! What glTF 2.0 says of faces and of the images on them: normals that are absent, sides, metals, and
//! what is beyond the edges of an image and between its pixels.

use std::io::Cursor;

use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};

use super::sides::light_from;
use super::{
    BEFORE, BLUE, GREEN, NEAREST, RED, WHITE, demand, drawn, glb, hue, image, is_near, pixel,
    render, square,
};
use tempfile::TempDir;

pub fn tests() -> impl Iterator<Item = Trial> {
    let cases: [(_, fn() -> _); 6] = [
        ("flat_without_normals", flat_without_normals),
        ("backs_are_not_drawn", backs_are_not_drawn),
        ("metals_mirror_the_surroundings", metals_mirror),
        ("beyond_the_edges_of_images", beyond_edges),
        ("between_pixels", between_pixels),
        ("alpha_below_the_cutoff", alpha_below_the_cutoff),
    ];
    cases.into_iter().map(|(name, run)| Trial::test(format!("render/model/face/{name}"), run))
}

/// 3.7.2.1: without normals, faces are flat. Of a roof whose halves share their ridge, one half faces
/// the lamp and the other does not, up to the ridge.
fn flat_without_normals() -> Result<(), Failed> {
    let (mut document, mut buffer) = square(&[]);
    // The ridge is in the place of the square's diagonal, at a height of the root of 2.
    for corner in [0, 2] {
        buffer[20 * corner + 8..20 * corner + 12]
            .copy_from_slice(&std::f32::consts::SQRT_2.to_le_bytes());
    }
    document["materials"] = json!([{
        "pbrMetallicRoughness": { "metallicFactor": 0.0 },
        "extensions": { "KHR_materials_specular": { "specularFactor": 0.0 } },
    }]);
    // The half at the upper right has the normal (1, 1, 1.414) / 2, and that of the other half,
    // (-1, -1, 1.414) / 2, is at 90 degrees to it.
    light_from(&mut document, [1.0, 1.0, 2.0_f64.sqrt()]);
    let alone = ["--set", "ambient=none,shadow=none,shadow_light=spot"];
    let (picture, _) = drawn(&glb(&document, &buffer), &[&BEFORE[..], &alone].concat())?;
    for ((x, y), expected) in
        [((0.6, 0.4), 255), ((0.7, 0.3), 255), ((0.4, 0.6), 0), ((0.48, 0.56), 0)]
    {
        let found = pixel(&picture, x, y);
        demand(is_near(found, [expected; 3], 3), || {
            format!("({x}, {y}): found {found:?}, expected {expected}")
        })?;
    }
    Ok(())
}

/// 3.9.5: "when this value is false, back-face culling is enabled".
fn backs_are_not_drawn() -> Result<(), Failed> {
    let (mut document, buffer) = square(&[]);
    for (camera, double, is_seen) in [
        ("0,0,5.5,0,0,0", false, true),
        ("0,0,-5.5,0,0,0", false, false),
        ("0,0,-5.5,0,0,0", true, true),
    ] {
        document["materials"] =
            json!([{ "doubleSided": double, "extensions": { "KHR_materials_unlit": {} } }]);
        let (picture, stderr) = drawn(&glb(&document, &buffer), &["--camera", camera])?;
        let found = pixel(&picture, 0.5, 0.5);
        demand(is_near(found, WHITE, 0) == is_seen, || {
            format!("from {camera}, doubleSided {double}: {found:?}")
        })?;
        demand(stderr.contains("nothing is seen") != is_seen, || format!("notes: {stderr}"))?;
    }
    Ok(())
}

/// A surface without a material is metal by glTF's defaults, and mirrors the surroundings.
fn metals_mirror() -> Result<(), Failed> {
    let (document, buffer) = square(&[]);
    let output = render(TempDir::new()?.path(), &glb(&document, &buffer), &BEFORE)?;
    let stdout = String::from_utf8_lossy(&output.stdout);
    demand(stdout.contains("ambient=ibl"), || format!("expected `ambient=ibl`: {stdout}"))
}

/// A square with an unlit image whose coordinates go from `low` to `high` in both directions.
fn papered(pixels: [[u8; 3]; 4], (low, high): (f32, f32)) -> Result<(Value, Vec<u8>), Failed> {
    let (mut document, mut buffer) = square(&[image(pixels)?]);
    for at in (0..4).flat_map(|corner| [20 * corner + 12, 20 * corner + 16]) {
        let is_low = buffer[at..at + 4] == 0_f32.to_le_bytes();
        let number = if is_low { low } else { high };
        buffer[at..at + 4].copy_from_slice(&number.to_le_bytes());
    }
    document["materials"] = json!([{
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } },
        "extensions": { "KHR_materials_unlit": {} },
    }]);
    Ok((document, buffer))
}

/// 3.8.4.3: the columns of an image of two that are shown at -0.75, -0.25, 1.25 and 1.75.
fn beyond_edges() -> Result<(), Failed> {
    for (mode, columns) in [(10497, [0, 1, 0, 1]), (33071, [0, 0, 1, 1]), (33648, [1, 0, 1, 0])] {
        let (mut document, buffer) = papered([RED, GREEN, BLUE, WHITE], (-1.0, 2.0))?;
        document["samplers"] = json!([{ "magFilter": NEAREST, "wrapS": mode, "wrapT": mode }]);
        let (picture, _) = drawn(&glb(&document, &buffer), &BEFORE)?;
        // The square is the middle half of the picture.
        let place = |at: f64| 0.25 + 0.5 * (at + 1.0) / 3.0;
        for (at, column) in [-0.75, -0.25, 1.25, 1.75].into_iter().zip(columns) {
            let across = pixel(&picture, place(at), place(0.25));
            let down = pixel(&picture, place(0.25), place(at));
            let expected = ([RED, GREEN][column], [RED, BLUE][column]);
            demand((hue(across), hue(down)) == (hue(expected.0), hue(expected.1)), || {
                format!("wrap {mode} at {at}: found {across:?} and {down:?}, expected {expected:?}")
            })?;
        }
    }
    Ok(())
}

/// 3.8.4.3 and 3.9.2: an image is linear light before its pixels are interpolated. From black to white,
/// the middle of the square is half of the light, and a little more half of a pixel beside it.
fn between_pixels() -> Result<(), Failed> {
    const BLACK: [u8; 3] = [0; 3];
    let shown = |filter: u32| -> Result<[[u8; 3]; 2], Failed> {
        let (mut document, buffer) = papered([BLACK, WHITE, BLACK, WHITE], (0.0, 1.0))?;
        document["samplers"] = json!([{ "magFilter": filter }]);
        let (picture, _) = drawn(&glb(&document, &buffer), &BEFORE)?;
        Ok([pixel(&picture, 0.5, 0.5), pixel(&picture, 0.56, 0.5)])
    };
    // Half of a pixel of the picture is 1/48 of the square, and 2/48 of a pixel of the image. A
    // share of 0.542 is 194 in sRGB.
    let ([linear, _], [_, nearest]) = (shown(9729)?, shown(NEAREST)?);
    demand(is_near(linear, [194; 3], 3), || format!("linear: found {linear:?}, expected 194"))?;
    demand(nearest == WHITE, || format!("nearest: found {nearest:?}, expected white"))
}

/// A PNG of two by two pixels with alpha.
fn image_with_alpha(pixels: [[u8; 4]; 4]) -> Result<Vec<u8>, Failed> {
    let pixels = image::RgbaImage::from_raw(2, 2, pixels.concat()).ok_or("not two by two")?;
    let mut file = Cursor::new(Vec::new());
    pixels.write_to(&mut file, image::ImageFormat::Png)?;
    Ok(file.into_inner())
}

/// 3.9.4: with MASK, alpha of the cutoff and more is opaque, and less is not drawn. The alpha is that of
/// the factor and of the texture, multiplied; the cutoff is 0.5 where it is not given.
fn alpha_below_the_cutoff() -> Result<(), Failed> {
    // Quarters with alpha 0, 0.2, 0.6 and 1; the factor is one half.
    let alphas = [0, 51, 153, 255].map(|alpha| [255, 255, 255, alpha]);
    let (mut document, buffer) = square(&[image_with_alpha(alphas)?]);
    for (mode, cutoff, seen) in [
        ("MASK", None, [false, false, false, true]),
        ("MASK", Some(0.2), [false, false, true, true]),
        ("MASK", Some(0.09), [false, true, true, true]),
        ("OPAQUE", None, [true; 4]),
    ] {
        document["materials"] = json!([{
            "alphaMode": mode,
            "pbrMetallicRoughness": {
                "baseColorFactor": [1, 1, 1, 0.5], "baseColorTexture": { "index": 0 },
            },
            "extensions": { "KHR_materials_unlit": {} },
        }]);
        if let Some(cutoff) = cutoff {
            document["materials"][0]["alphaCutoff"] = json!(cutoff);
        }
        let (picture, _) = drawn(&glb(&document, &buffer), &BEFORE)?;
        let places = [(0.35, 0.35), (0.65, 0.35), (0.35, 0.65), (0.65, 0.65)];
        let found = places.map(|(x, y)| is_near(pixel(&picture, x, y), WHITE, 0));
        demand(found == seen, || format!("{mode} {cutoff:?}: {found:?}, expected {seen:?}"))?;
    }
    Ok(())
}

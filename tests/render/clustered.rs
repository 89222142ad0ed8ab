//! Clustered lists of lamps do not change the picture: `clustered` gives the same colours as a loop
//! over all lamps.

use lamplight::bundle::Language;
use lamplight::execute::Session;
use libtest_mimic::Trial;

use super::{BACKENDS, linear_picture, on_device, surface_pixels};

/// A name, a program, and a key without `clustered`. With the falloff of the second one, lamps have
/// no range, so every list has all of them.
const KEYS: [(&str, &str, &str); 3] = [
    (
        "short",
        "forward",
        "ambient_attenuated,attenuation=inverse_square_window,max_lights=10,specular=ggx",
    ),
    ("endless", "forward", "ambient_attenuated,max_lights=10"),
    (
        "deferred",
        "deferred",
        "ambient_attenuated,attenuation=inverse_square_window,max_lights=10,specular=ggx",
    ),
];

const SIZE: [u32; 2] = [160, 96];
/// The largest difference of a channel. Lamps are summed up in the same order, but compilers may
/// contract the sums of one of the loops.
const TOLERANCE: f64 = 1e-5;
/// The least share of the pixels that show a surface.
const SEEN: f64 = 0.3;

pub fn tests() -> Vec<Trial> {
    let on = |(backend, language): (&'static str, Language)| {
        KEYS.map(|(name, program, key)| {
            Trial::test(format!("render/clustered_is_all/{name}/{backend}"), move || {
                on_device(backend, |painter| same(painter, language, program, key))
            })
        })
    };
    BACKENDS.into_iter().flat_map(on).collect()
}

fn same(painter: &dyn Session, language: Language, program: &str, key: &str) -> Result<(), String> {
    let drawn = |key: &str| linear_picture(painter, language, (program, key), "fair", SIZE);
    let wanted = drawn(key)?;
    let found = drawn(&format!("{key},clustered"))?;
    let (mut seen, mut largest) = (0_u32, 0.0_f64);
    for ([x, y], [found, wanted]) in surface_pixels(&found, &wanted, SIZE)? {
        let error = (found - wanted).abs().max_element();
        if error.is_nan() || error > TOLERANCE * wanted.abs().max_element().max(1.0) {
            return Err(format!("{found} at {x}, {y}, without lists {wanted}"));
        }
        (seen, largest) = (seen + 1, largest.max(error));
    }
    println!("{program} [{key}]: {seen} pixels, the largest difference is {largest:e}");
    let least = (SEEN * f64::from(SIZE[0] * SIZE[1])) as u32;
    if seen >= least { Ok(()) } else { Err(format!("{seen} pixels show a surface")) }
}

//! Deferred shading gives the colours of forward shading: `gbuffer` and `deferred` are drawn after
//! each other, and compared with `forward` pixel by pixel. Moments of shadows are not compared: their
//! map has levels, and at the edges of things the level depends on neighbouring pixels.

use lamplight::execute::Session;
use libtest_mimic::Trial;

use super::{BACKENDS, linear_picture, on_device, surface_pixels};
use lamplight::bundle::Language;

/// Keys of `deferred`, and of `forward` for the same picture.
const KEYS: &[(&str, &str, &str)] = &[
    ("classic", "default", "material=array"),
    ("two_sided", "max_lights=10,two_sided", "material=array,max_lights=10,two_sided"),
    (
        "shadowed",
        "ambient=ibl,shadow=pcf_vogel,specular=ggx",
        "ambient=ibl,material=array,shadow=pcf_vogel,specular=ggx",
    ),
    (
        "rough",
        "ambient=hemisphere,diffuse=oren_nayar,shadow=pcf_5x5",
        "ambient=hemisphere,diffuse=oren_nayar,material=array,shadow=pcf_5x5",
    ),
    (
        "occluded",
        "ambient=ibl,occlusion=screen,specular=ggx",
        "ambient=ibl,material=array,occlusion=screen,specular=ggx",
    ),
    ("unlit", "ambient=sh9,lights=none", "ambient=sh9,lights=none"),
];

/// The size of the frames.
const SIZE: [u32; 2] = [128, 96];
/// The largest difference of a channel: positions and normals pass through textures of f32, which
/// moves them by some parts in a million, and highlights and edges of shadows enlarge this.
const TOLERANCE: f64 = 1e-3;
/// The share of the pixels that may differ by more. A point on the edge of a shadow or of a lamp's
/// cone may be on either side of it.
const BEYOND: f64 = 0.002;
/// The least share of the pixels that show a surface.
const SEEN: f64 = 0.3;

pub fn trials() -> Vec<Trial> {
    let on = |(backend, language): (&'static str, Language)| {
        KEYS.iter().map(move |(name, deferred, forward)| {
            Trial::test(format!("render/deferred_is_forward/{name}/{backend}"), move || {
                on_device(backend, |painter| same(painter, language, deferred, forward))
            })
        })
    };
    BACKENDS.into_iter().flat_map(on).collect()
}

fn same(
    painter: &dyn Session,
    language: Language,
    deferred: &str,
    forward: &str,
) -> Result<(), String> {
    let drawn = |program: &str, key: &str| {
        linear_picture(painter, language, (program, key), "casters", SIZE)
    };
    let found = drawn("deferred", deferred)?;
    let wanted = drawn("forward", forward)?;
    let (mut seen, mut beyond, mut largest) = (0, 0, 0.0_f64);
    for (_, [found, wanted]) in surface_pixels(&found, &wanted, SIZE)? {
        let error = (found - wanted).abs().max_element();
        // A number that is none is no small error.
        let is_near = error <= TOLERANCE * wanted.abs().max_element().max(1.0);
        (seen, beyond) = (seen + 1, beyond + usize::from(!is_near));
        largest = largest.max(error);
    }
    let pixels = f64::from(SIZE[0] * SIZE[1]);
    println!("{deferred}: {beyond} of {seen} pixels differ, the largest difference is {largest:e}");
    if (seen as f64) < SEEN * pixels || beyond as f64 > BEYOND * seen as f64 {
        let what = format!("{beyond} of {seen} pixels differ by more than {TOLERANCE:e}");
        return Err(format!("{what}, at most {BEYOND} of them may; the largest is {largest:e}"));
    }
    Ok(())
}

//! Ambient occlusion: the drivers' frames of `gtao` are those of the evaluator, and a plane without
//! occluders is hardly darkened.
//!
//! Fragments are not computed again with error bounds: the formula for an arc takes the cosine of
//! an angle beyond pi, for which WGSL promises no accuracy.

use lamplight::bundle::Language;
use lamplight::execute::Session;
use lamplight::picture::{Linear, Plan, prepare_passes};
use libtest_mimic::Trial;

use super::{BACKENDS, library, on_device, rendered, shot, start};

/// Permutations with every value of every axis.
const KEYS: &[&str] =
    &["default", "normals=gbuffer,slices=4,steps=8", "slices=1", "normals=gbuffer"];
const SIZE: [u32; 2] = [96, 72];
/// The largest difference of a driver from the evaluator: the error of an arc cosine and of sines.
const TOLERANCE: f64 = 0.01;
/// The share of the pixels that may differ by more. A texel is found by rounding, so that drivers
/// may read the one beside it.
const BEYOND: f64 = 0.02;
/// The least mean visibility of a plane without occluders. It is below 1, since depths in f32 give
/// its horizons errors.
const OPEN: f64 = 0.97;
/// The scene has a place under an object, whose visibility must be below this. The mean must be
/// above.
const CLOSED: f64 = 0.6;

pub fn tests() -> Vec<Trial> {
    let on = |(backend, language): (&'static str, Language)| {
        let each = KEYS.iter().map(move |key| {
            Trial::test(format!("render/gtao/{key}/{backend}"), move || {
                on_device(backend, |painter| same(painter, language, key))
            })
        });
        each.chain([Trial::test(format!("render/gtao/open_plane/{backend}"), move || {
            on_device(backend, |painter| open_plane(painter, language))
        })])
    };
    BACKENDS.into_iter().flat_map(on).collect()
}

fn drawn(
    painter: &dyn Session,
    language: Language,
    key: &str,
    scene: &str,
) -> Result<Vec<Option<f64>>, String> {
    let programs = &library().programs;
    let mut plan = Plan::of_key(programs, "gtao", key).map_err(rendered)?;
    plan.scene = scene.to_owned();
    let shot = shot(SIZE, 1, language);
    let prepared = prepare_passes(painter, programs, &plan, &shot).map_err(rendered)?;
    let frame: Linear = prepared.photograph(painter, &shot).map_err(rendered)?;
    let places = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)));
    Ok(places.map(|(x, y)| frame.drawn(x, y).map(|color| color.x)).collect())
}

fn same(painter: &dyn Session, language: Language, key: &str) -> Result<(), String> {
    let found = drawn(painter, language, key, "casters")?;
    let evaluator = start("eval")?;
    let wanted = drawn(evaluator.as_ref(), language, key, "casters")?;
    // A NaN is not near.
    let is_near = |(found, wanted): &(&Option<f64>, &Option<f64>)| match (found, wanted) {
        (Some(found), Some(wanted)) => (found - wanted).abs() <= TOLERANCE,
        (found, wanted) => found.is_some() == wanted.is_some(),
    };
    let far = found.len() - found.iter().zip(&wanted).filter(is_near).count();
    let seen: Vec<f64> = found.iter().flatten().copied().collect();
    let least = seen.iter().copied().fold(f64::INFINITY, f64::min);
    let mean = seen.iter().sum::<f64>() / seen.len() as f64;
    println!("{key}: {far} of {} pixels differ, mean {mean:.3}, least {least:.3}", seen.len());
    match far as f64 <= BEYOND * found.len() as f64 && least < CLOSED && mean > CLOSED {
        true => Ok(()),
        false => Err(format!("{far} pixels differ, the mean is {mean}, the least {least}")),
    }
}

fn open_plane(painter: &dyn Session, language: Language) -> Result<(), String> {
    // The visibility of a single slice may exceed 1 and is clamped, so its mean is lower.
    for key in KEYS.iter().filter(|key| !key.contains("slices=1")) {
        let seen: Vec<f64> =
            drawn(painter, language, key, "floor")?.into_iter().flatten().collect();
        let mean = seen.iter().sum::<f64>() / seen.len() as f64;
        println!("{key}: the mean of a plane is {mean:.4}");
        if !(OPEN..=1.0001).contains(&mean) {
            return Err(format!("{key}: the mean of a plane is {mean}, expected at least {OPEN}"));
        }
    }
    Ok(())
}

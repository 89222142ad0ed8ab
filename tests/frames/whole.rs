//! Draws `gtao` from the bytes that a bundle holds for each target, and compares whole frames with
//! those of the evaluator.
//!
//! Its fragments are not computed again with error bounds, as those of other programs are: WGSL
//! promises no accuracy for the cosine of an angle beyond pi, and the formula for an arc takes such
//! cosines.

use lamplight::bundle::{Bundle, Language};
use lamplight::execute::frame::{DrawItem, Drawing, EntryPoint};
use lamplight::execute::kernel::SENTINEL;
use lamplight::execute::{Session, executors, on_thread};
use lamplight::picture::frame::probe;
use libtest_mimic::{Failed, Trial};

use super::shipped::{self, Driver, SIZE};
use super::{Scene, Sources, bundle, covering};

const PROGRAM: &str = "gtao";
/// The largest difference from the evaluator: the error of an arc cosine and of sines.
const TOLERANCE: f32 = 0.01;
/// The share of the pixels that may differ by more. A texel is found by rounding, so that drivers
/// may read the one beside it.
const BEYOND: f64 = 0.02;
/// The least and the largest value of a frame differ by this, or the comparison would prove little.
const SPREAD: f32 = 0.2;

pub fn tests() -> Vec<Trial> {
    let languages = [("wesl", Language::Wesl), ("glsl", Language::Glsl)];
    let test = |(name, language): (&str, Language)| {
        Trial::test(format!("frames/shipped/{PROGRAM}/{name}"), move || {
            on_thread(|| drawn(language)).ok_or("panicked")?.map_err(Failed::from)
        })
    };
    languages.map(test).into()
}

fn drawn(language: Language) -> Result<(), String> {
    let (targets, sources) = (shipped::targets()?, Sources::load(PROGRAM, language)?);
    let points = covering(&sources.space);
    let bundle = bundle(&sources, &points, &targets)?;
    let mut drivers = shipped::drivers(&targets)?;
    let evaluator = executors::find_executor("eval").ok_or("no evaluator")?.start()?;
    let mut failures = Vec::new();
    for point in &points {
        let (key, scene) = (sources.space.key(point).to_string(), sources.scene(point)?);
        let wanted = evaluated(evaluator.as_ref(), &scene)?;
        let seen = || wanted.iter().flatten().copied();
        let spread = seen().fold(f32::MIN, f32::max) - seen().fold(f32::MAX, f32::min);
        if spread < SPREAD {
            failures.push(format!("[{key}] all values are within {spread}"));
        }
        for driver in &mut drivers {
            let far = differing(driver, &bundle, (language, &key), &scene, &wanted)?;
            let name = driver.heading();
            println!("{name} [{key}]: {far} of {} pixels differ", wanted.len());
            if far as f64 > BEYOND * wanted.len() as f64 {
                failures.push(format!("{name} [{key}]: {far} pixels differ"));
            }
        }
    }
    if failures.is_empty() { Ok(()) } else { Err(failures.join("\n")) }
}

/// The first component of each pixel; `None` where the fragment was discarded.
fn colors(target: &[u32]) -> Vec<Option<f32>> {
    let first = |pixel: &[u32]| pixel.first().copied().filter(|word| *word != SENTINEL);
    target.chunks(4).map(|pixel| first(pixel).map(f32::from_bits)).collect()
}

fn evaluated(evaluator: &dyn Session, scene: &Scene) -> Result<Vec<Option<f32>>, String> {
    let watched = probe::watch_entry(&scene.fragment.validated.module, scene.fragment.entry);
    let watched = watched.ok_or("no colour")?;
    let vertex = EntryPoint { module: &scene.vertex.validated.module, entry: scene.vertex.entry };
    let fragment = EntryPoint { module: &watched.module, entry: scene.fragment.entry };
    let items = [DrawItem { mesh: &scene.mesh, buffers: &scene.buffers }];
    let drawing = Drawing {
        targets: watched.targets,
        ..Drawing::of_items([vertex, fragment], &items, &scene.fixtures, SIZE)
    };
    let mut frames = evaluator.draw_frames(&drawing).map_err(|problem| problem.message)?;
    Ok(colors(frames.remove(0).targets.first().ok_or("no target")?))
}

fn differing(
    driver: &mut Driver,
    bundle: &Bundle,
    (language, key): (Language, &str),
    scene: &Scene,
    wanted: &[Option<f32>],
) -> Result<usize, String> {
    let targets = driver.frame(bundle, (PROGRAM, language), key, scene);
    let targets = targets.map_err(|error| error.message)?;
    let found = colors(targets.first().ok_or("no target")?);
    // A NaN is not near.
    let is_near = |(found, wanted): &(&Option<f32>, &Option<f32>)| match (found, wanted) {
        (Some(found), Some(wanted)) => (found - wanted).abs() <= TOLERANCE,
        (found, wanted) => found.is_some() == wanted.is_some(),
    };
    Ok(wanted.len() - found.iter().zip(wanted).filter(is_near).count())
}

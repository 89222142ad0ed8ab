//! Draws permutations of programs on the CPU from the MSL that a bundle holds, and computes a
//! sample of the fragments again with the evaluator, from the composed text.

use std::collections::BTreeMap;

use lamplight::bundle::{Bundle, Language, Target};
use lamplight::eval::Program;
use lamplight::execute::frame::{DrawItem, Drawing, EntryPoint};
use lamplight::execute::kernel::SENTINEL;
use lamplight::execute::raster::CompiledStages;
use lamplight::execute::shipped::Shipped;
use lamplight::picture::frame::ReadyStage;
use libtest_mimic::{Failed, Trial};
use naga::{Binding, BuiltIn};

use crate::fragments::{self, Tally, Watched, entry_function};
use crate::frames::{LISTINGS, PROGRAMS, Scene, Sources, bundle, most_open, most_points, points};
use crate::is_whole;

/// The number of permutations of `forward` in each language. All pairs of values are among them, as
/// they are of the other programs.
const LEAST_POINTS: usize = 200;
/// How many permutations of each program and language the tests draw by day, and at night. `cargo
/// xtask frames` draws all.
const DRAWN_POINTS: [usize; 2] = [24, 64];
/// The size of a frame in pixels.
const SIZE: [u32; 2] = [128, 64];
/// Every 29th quad is computed again. The objects of the listings are small, so there it is every
/// 17th.
const STEP: usize = 29;
const STEP_OF_LISTINGS: usize = 17;
/// The least number of fragments of a permutation that must be compared.
const LEAST: usize = 200;
/// The number of permutations whose stages are compiled together.
const BATCH: usize = 64;

pub fn tests() -> Vec<Trial> {
    let languages = [("wesl", Language::Wesl), ("glsl", Language::Glsl)];
    let of = |program: &'static str| {
        languages.map(|(name, language)| {
            Trial::test(format!("metal::frames::{program}::{name}"), move || {
                drawn(program, language).map_err(Failed::from)
            })
        })
    };
    PROGRAMS.into_iter().flat_map(of).collect()
}

fn drawn(program: &'static str, language: Language) -> Result<(), String> {
    let sources = Sources::load(program, language)?;
    let mut points = points(&sources.space, if program == "forward" { LEAST_POINTS } else { 1 });
    points.truncate(most_points(DRAWN_POINTS[usize::from(is_whole())])?);
    let bundle = bundle(&sources, &points, &[Target::MSL])?;
    let (mut total, mut failures) = (Tally::default(), Vec::new());
    let step = if program == LISTINGS { STEP_OF_LISTINGS } else { STEP };
    for points in points.chunks(BATCH) {
        let scenes =
            points.iter().map(|point| sources.scene(point)).collect::<Result<Vec<_>, _>>()?;
        let keys: Vec<String> =
            points.iter().map(|point| sources.space.key(point).to_string()).collect();
        let mut stages = Stages::default();
        let pairs = scenes
            .iter()
            .zip(&keys)
            .map(|(scene, key)| stages.pair(&bundle, (program, language), scene, key))
            .collect::<Result<Vec<_>, _>>()?;
        let compiled = CompiledStages::new(stages.shipped).map_err(|missing| missing.reason)?;
        for ((scene, key), pair) in scenes.iter().zip(&keys).zip(pairs) {
            match agrees(&compiled, pair, scene, (step, most_open(program))) {
                Ok(tally) => total.add(&tally),
                Err(error) => failures.push(format!("[{key}] {error}")),
            }
        }
    }
    println!("{program}, {language:?} as MSL on the CPU: {} permutations, {total}", points.len());
    if failures.is_empty() { Ok(()) } else { Err(failures.join("\n")) }
}

/// The distinct stages of some permutations.
#[derive(Default)]
struct Stages {
    shipped: Vec<Shipped>,
}

impl Stages {
    /// The indices of both stages of a permutation.
    fn pair(
        &mut self,
        bundle: &Bundle,
        (program, language): (&str, Language),
        scene: &Scene,
        key: &str,
    ) -> Result<[usize; 2], String> {
        let mut index = |entry: &str| -> Result<usize, String> {
            let found = bundle
                .program(program)
                .and_then(|program| program.entry(language, entry)?.get(key, Target::MSL))
                .map_err(|error| error.to_string())?;
            let bytes = found.bytes;
            if let Some(known) = self.shipped.iter().position(|stage| stage.bytes == bytes) {
                return Ok(known);
            }
            let (native, reflection) = ((*found.native).clone(), (*found.reflection).clone());
            self.shipped.push(Shipped { target: Target::MSL, bytes, native, reflection });
            Ok(self.shipped.len() - 1)
        };
        // Entry points of GLSL are all called `main`, so a bundle names them by their stage.
        match language {
            Language::Wesl => Ok([index(scene.vertex.entry)?, index(scene.fragment.entry)?]),
            Language::Glsl => Ok([index("vertex")?, index("fragment")?]),
        }
    }
}

fn agrees(
    compiled: &CompiledStages,
    pair: [usize; 2],
    scene: &Scene,
    (step, most): (usize, f64),
) -> Result<Tally, String> {
    let Scene { vertex, fragment, mesh, buffers, fixtures, .. } = scene;
    let items = [DrawItem { mesh, buffers }];
    let drawing = Drawing::of_items([stage(vertex), stage(fragment)], &items, fixtures, SIZE);
    let [first, second] = pair;
    let frames = compiled.draw_watched(first, second, &drawing);
    let frame = frames.map_err(|problem| problem.message)?.remove(0);
    let targets = in_order(fragment, &frame.targets)?;
    let resources = fragments::resources(buffers.clone(), fixtures, &BTreeMap::new());
    let watched = Watched { size: SIZE, targets: &targets };
    let mut tally = Tally::default();
    fragments::recompute(fragment, resources, &watched, step, &mut tally)?;
    tally.checked(LEAST, most)
}

fn stage(composed: &ReadyStage) -> EntryPoint<'_> {
    EntryPoint { module: &composed.validated.module, entry: composed.entry }
}

/// The colour, and then the inputs in the order of the evaluator's function, four words a target.
fn in_order(stage: &ReadyStage, targets: &[Vec<u32>]) -> Result<Vec<Vec<u32>>, String> {
    let (Some(color), Some((front, rest))) = (targets.first(), targets.split_last()) else {
        return Err("there are no targets".to_owned());
    };
    let (position, locations) = rest[1..].split_last().ok_or("there is no position")?;
    let program = Program::new(&stage.validated.module, &stage.validated.info)
        .map_err(|error| error.to_string())?;
    let (_, function) = entry_function(&program, stage.entry)?;
    let (mut inputs, mut seen) = (Vec::new(), Vec::new());
    for binding in &function.inputs {
        let component = seen.iter().filter(|other| *other == binding).count();
        seen.push(binding.clone());
        let target = match binding {
            Some(Binding::Location { location, .. }) => {
                locations.get(*location as usize).ok_or("a location is not taken")?
            }
            Some(Binding::BuiltIn(BuiltIn::Position { .. })) => position,
            Some(Binding::BuiltIn(BuiltIn::FrontFacing)) => front,
            other => return Err(format!("the drawn frame has no values for {other:?}")),
        };
        inputs.push((target, component));
    }
    let mut ordered = vec![color.clone()];
    for four in inputs.chunks(4) {
        let pixels = 0..color.len() / 4;
        let word = |pixel: usize, i: usize| {
            // What is left of four words tells nothing of whether the fragment was run.
            four.get(i).map_or(SENTINEL, |(target, component)| target[4 * pixel + component])
        };
        ordered.push(pixels.flat_map(|pixel| (0..4).map(move |i| word(pixel, i))).collect());
    }
    Ok(ordered)
}

//! Draws permutations of programs from exactly the bytes that a bundle holds for each target, and
//! computes a sample of the fragments again with the evaluator, from the composed text.
//!
//! Each permutation is drawn twice with its vertex stage: with its own fragment stage, and with one
//! that only writes its inputs. The evaluator starts from these inputs, so a wrong vertex stage is
//! noticed only if it leaves too few fragments covered, or too many open. `metal::frames` does the
//! same for MSL, with many stages in one compilation.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use lamplight::bundle::{Bundle, Convention, Language, SpirvForm, Target};
use lamplight::diagnostic::Diagnostic;
use lamplight::execute::executors::{self, ExecutorEntry, Shipping};
use lamplight::execute::frame::{DrawItem, Drawing, EntryPoint};
use lamplight::execute::shipped::Shipped;
use lamplight::execute::{Session, ShippedPair, on_thread};
use lamplight::permute::axis::ValueSet;
use lamplight::picture::frame::probe;
use libtest_mimic::{Failed, Trial};

use super::{PROGRAMS, Scene, Sources, bundle, bundle_of, most_open, points};
use crate::fragments::{self, Tally, Watched};
use crate::is_whole;

/// The number of permutations of each language. All pairs of values are among them.
const LEAST_POINTS: usize = 200;
/// How many of them the tests draw by day, and at night. `cargo xtask frames` draws all.
const DRAWN_POINTS: [usize; 2] = [8, 12];
/// How many of programs that are smaller than `forward`.
const DRAWN_OF_SMALL: [usize; 2] = [3, 4];
/// How many permutations of each program are drawn in each form of SPIR-V.
const FORM_POINTS: usize = 3;
/// The size of a frame in pixels.
pub const SIZE: [u32; 2] = [96, 48];
/// Every 29th quad is computed again.
const STEP: usize = 29;
/// The least number of fragments of a permutation that must be compared.
const LEAST: usize = 80;
/// How many failures of a driver are printed.
const MOST_FAILURES: usize = 20;

pub fn tests() -> Vec<Trial> {
    let languages = [("wesl", Language::Wesl), ("glsl", Language::Glsl)];
    let drawn = PROGRAMS.into_iter().flat_map(|program| {
        languages.map(|(name, language)| {
            let of = if program == "forward" { String::new() } else { format!("{program}/") };
            Trial::test(format!("frames/shipped/{of}{name}"), move || {
                on_thread(|| drawn(program, language)).ok_or("panicked")?.map_err(Failed::from)
            })
        })
    });
    let others = Trial::test("frames/shipped/others_are_noticed", || {
        on_thread(others_are_noticed).ok_or("panicked")?.map_err(Failed::from)
    });
    let forms = Trial::test("frames/shipped/spirv_forms", || {
        on_thread(spirv_forms).ok_or("panicked")?.map_err(Failed::from)
    });
    drawn.chain([others, forms]).collect()
}

/// Stripped and optimised SPIR-V draws what the evaluator computes.
fn spirv_forms() -> Result<(), String> {
    for program in PROGRAMS {
        let sources = Sources::load(program, Language::Wesl)?;
        let mut points = points(&sources.space, FORM_POINTS);
        points.truncate(FORM_POINTS);
        for (name, form) in SpirvForm::ALL {
            let bundle = bundle_of(&sources, points.clone(), &[Target::SPIRV], *form)?;
            let mut drivers = drivers(&[Target::SPIRV])?;
            for point in &points {
                let (key, scene) = (sources.space.key(point).to_string(), sources.scene(point)?);
                permutation(&bundle, (program, Language::Wesl), &key, &scene, &mut drivers)?;
            }
            for driver in &drivers {
                println!("{program}, {name} {driver}");
                let lacks = driver.lacks.keys().chain(&driver.failures);
                if let Some(failure) = lacks.into_iter().next() {
                    return Err(format!("{program}, {name}: {failure}"));
                }
            }
        }
    }
    Ok(())
}

/// The targets that the environment names, or all except MSL.
pub fn targets() -> Result<Vec<Target>, String> {
    let Ok(names) = std::env::var("LAMPLIGHT_FRAMES_TARGETS") else {
        return Ok(Target::ALL.iter().copied().filter(|one| *one != Target::MSL).collect());
    };
    let target = |name: &str| Target::find(name).ok_or_else(|| format!("no target `{name}`"));
    names.split(',').map(target).collect()
}

/// Every driver and browser that draws the files of some targets.
pub fn drivers(targets: &[Target]) -> Result<Vec<Driver>, String> {
    let mut drivers = Vec::new();
    for target in targets {
        let mut found = executors::shipping(*target).peekable();
        found.peek().ok_or_else(|| format!("nothing draws {target}"))?;
        for (entry, shipping) in found {
            drivers.push(Driver::open(entry, shipping)?);
        }
    }
    Ok(drivers)
}

/// The variable with the number of permutations that are drawn.
pub const PERMUTATIONS: &str = "LAMPLIGHT_FRAMES_PERMUTATIONS";

/// How many permutations are drawn: the number in the environment, or the usual one.
pub fn most_points(usual: usize) -> Result<usize, String> {
    match std::env::var(PERMUTATIONS) {
        Ok(text) => text.parse().map_err(|_| format!("`{text}` is not a number")),
        Err(_) => Ok(usual),
    }
}

fn drawn(program: &'static str, language: Language) -> Result<(), String> {
    let (targets, sources) = (targets()?, Sources::load(program, language)?);
    let mut points = points(&sources.space, LEAST_POINTS);
    let drawn = if program == "forward" { DRAWN_POINTS } else { DRAWN_OF_SMALL };
    points.truncate(most_points(drawn[usize::from(is_whole())])?);
    let start = Instant::now();
    let bundle = bundle(&sources, &points, &targets)?;
    let mut drivers = drivers(&targets)?;
    for point in &points {
        let (key, scene) = (sources.space.key(point).to_string(), sources.scene(point)?);
        permutation(&bundle, (program, language), &key, &scene, &mut drivers)?;
    }
    println!("{program}, {language:?}: all in {:.1} s", start.elapsed().as_secs_f64());
    let mut failures = Vec::new();
    for driver in &drivers {
        println!("{program}, {language:?} {driver}");
        failures.extend(driver.failures.iter().take(MOST_FAILURES).cloned());
        // A permutation that cannot be drawn is a failure, since today all can be.
        failures.extend(driver.lacks.keys().map(|reason| format!("{}: {reason}", driver.name)));
    }
    if failures.is_empty() { Ok(()) } else { Err(failures.join("\n")) }
}

/// The comparison fails if the bytes of another permutation, with another diffuse term, are drawn.
/// Otherwise it would prove nothing.
fn others_are_noticed() -> Result<(), String> {
    let sources = Sources::load("forward", Language::Wesl)?;
    let space = &sources.space;
    let usual = space.default_assignment();
    let axis = space.axes().iter().position(|axis| axis.name == "diffuse").ok_or("no axis")?;
    let choose = |axis: usize, allowed: ValueSet| {
        let own = allowed.iter().find(|ordinal| *ordinal == usual.ordinal(axis));
        own.or_else(|| allowed.iter().next()).unwrap_or_default()
    };
    let other = space.pick_valid(&[(axis, 1)], choose).ok_or("no other permutation")?;
    let bundle = bundle(&sources, &[usual.clone(), other.clone()], &[Target::GLSL330])?;
    let mut driver = drivers(&[Target::GLSL330])?.remove(0);
    let scene = sources.scene(&usual)?;
    for (point, is_right) in [(&usual, true), (&other, false)] {
        let key = space.key(point).to_string();
        let targets = driver.frame(&bundle, ("forward", Language::Wesl), &key, &scene);
        let targets = targets.map_err(|error| error.message)?;
        let watched = [Watched { size: SIZE, targets: &targets }];
        let resources =
            fragments::resources(scene.buffers.clone(), &scene.fixtures, &BTreeMap::new());
        let found = fragments::recompute_each(&scene.fragment, resources, &watched, STEP)?;
        if found.iter().any(|found| found.is_ok() != is_right) {
            let [found, expected] = if is_right { ["wrong", "right"] } else { ["right", "wrong"] };
            return Err(format!("[{key}] gives {found}, expected {expected}"));
        }
    }
    Ok(())
}

/// A driver that draws the files of a target, with the results so far.
pub struct Driver {
    /// The name of the executor.
    name: &'static str,
    target: Target,
    session: Box<dyn Session>,
    drawn: usize,
    tally: Tally,
    failures: Vec<String>,
    /// How many permutations could not be drawn, for each reason.
    lacks: BTreeMap<String, usize>,
    /// Fragment stages that write their inputs, by these inputs. Most permutations share one.
    input_stages: BTreeMap<String, Shipped>,
    time: Duration,
}

impl Driver {
    fn open(entry: &'static ExecutorEntry, shipping: &'static Shipping) -> Result<Self, String> {
        let session = (shipping.open)().map_err(|missing| entry.missing(&missing))?;
        let (name, target) = (entry.name, shipping.target);
        let (tally, failures, lacks, input_stages, time) = Default::default();
        Ok(Self { name, target, session, drawn: 0, tally, failures, lacks, input_stages, time })
    }

    /// What is drawn on what.
    pub fn heading(&self) -> String {
        format!("as {} on {}", self.target, self.session.adapter())
    }

    /// The targets of both draws: the colours first, then the inputs.
    pub fn frame(
        &mut self,
        bundle: &Bundle,
        of: (&str, Language),
        key: &str,
        scene: &Scene,
    ) -> Result<Vec<Vec<u32>>, Diagnostic> {
        let stages = ["vertex", "fragment"].map(|stage| {
            let entry = match (of.1, stage) {
                // Entry points of GLSL are all called `main`, so a bundle names them by their
                // stage.
                (Language::Glsl, _) => stage,
                (_, "vertex") => scene.vertex.entry,
                _ => scene.fragment.entry,
            };
            shipped(bundle, of, entry, key, self.target)
        });
        let [vertex, fragment] = stages;
        let (vertex, fragment) = (vertex.map_err(lost)?, fragment.map_err(lost)?);
        let input_stage = self.input_stage(scene)?;
        let mut targets = self.draw(&vertex, &fragment, scene)?;
        // Of several colour targets, the first one is compared.
        targets.truncate(1);
        targets.extend(self.draw(&vertex, &input_stage, scene)?);
        Ok(targets)
    }

    /// The fragment stage that writes its inputs.
    fn input_stage(&mut self, scene: &Scene) -> Result<Shipped, Diagnostic> {
        let stage = &scene.fragment;
        let inputs = format!("{:?}", stage.reflection.inputs);
        if let Some(known) = self.input_stages.get(&inputs) {
            return Ok(known.clone());
        }
        let watched = probe::inputs_module(&stage.validated.module, stage.entry)
            .ok_or_else(|| lost(format!("`{}` is not a fragment stage", stage.entry)))?;
        let point = EntryPoint { module: &watched.module, entry: probe::INPUTS_ENTRY };
        let made = Shipped::of(point, self.target)?;
        self.input_stages.insert(inputs, made.clone());
        Ok(made)
    }

    fn draw(
        &self,
        vertex: &Shipped,
        fragment: &Shipped,
        scene: &Scene,
    ) -> Result<Vec<Vec<u32>>, Diagnostic> {
        let stage = |of: &'_ super::ReadyStage| of.validated.clone();
        let modules = [stage(&scene.vertex), stage(&scene.fragment)];
        let vertex_point = EntryPoint { module: &modules[0].module, entry: scene.vertex.entry };
        let point = EntryPoint { module: &modules[1].module, entry: scene.fragment.entry };
        let items = [DrawItem { mesh: &scene.mesh, buffers: &scene.buffers }];
        let drawing = Drawing::of_items([vertex_point, point], &items, &scene.fixtures, SIZE);
        Ok(self.session.draw_shipped(ShippedPair { vertex, fragment }, &drawing)?.remove(0).targets)
    }

    fn count(&mut self, program: &str, key: &str, found: Result<Tally, String>) {
        match found {
            Ok(tally) if tally.tried < LEAST => {
                let what = format!("{} fragments, expected at least {LEAST}", tally.tried);
                let text = format!("{} [{key}] compared {what}", self.name);
                self.failures.push(text);
            }
            Ok(tally) if tally.open as f64 > most_open(program) * tally.tried as f64 => {
                let Tally { tried, open, .. } = tally;
                let text = format!("{} [{key}] {open} of {tried} fragments are open", self.name);
                self.failures.push(text);
            }
            Ok(tally) => self.tally.add(&tally),
            Err(error) => self.failures.push(format!("{} [{key}] {error}", self.name)),
        }
    }
}

impl std::fmt::Display for Driver {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { drawn, tally, lacks, .. } = self;
        let (heading, seconds) = (self.heading(), self.time.as_secs_f64());
        write!(f, "{heading}: {drawn} permutations in {seconds:.1} s, {tally}")?;
        lacks.iter().try_for_each(|(reason, count)| write!(f, "; {count} not drawn: {reason}"))
    }
}

/// Draws one permutation on every driver. The evaluator computes quads with the same inputs once
/// for all drivers.
fn permutation(
    bundle: &Bundle,
    of: (&str, Language),
    key: &str,
    scene: &Scene,
    drivers: &mut [Driver],
) -> Result<(), String> {
    let (mut frames, mut owners) = (Vec::new(), Vec::new());
    for (index, driver) in drivers.iter_mut().enumerate() {
        let start = Instant::now();
        let found = driver.frame(bundle, of, key, scene);
        driver.time += start.elapsed();
        match found {
            Ok(targets) => {
                driver.drawn += 1;
                frames.push(targets);
                owners.push(index);
            }
            Err(error) if error.code.name == "executor-lacks" => {
                *driver.lacks.entry(error.message).or_default() += 1;
            }
            Err(error) => {
                driver.failures.push(format!("{} [{key}] {}", driver.name, error.message))
            }
        }
    }
    let watched: Vec<Watched<'_>> =
        frames.iter().map(|targets| Watched { size: SIZE, targets }).collect();
    let resources = fragments::resources(scene.buffers.clone(), &scene.fixtures, &BTreeMap::new());
    let tallies = fragments::recompute_each(&scene.fragment, resources, &watched, STEP)?;
    for (owner, tally) in owners.into_iter().zip(tallies) {
        drivers[owner].count(of.0, key, tally);
    }
    Ok(())
}

/// One stage, with the bytes that the bundle holds for a target.
fn shipped(
    bundle: &Bundle,
    (program, language): (&str, Language),
    entry: &str,
    key: &str,
    target: Target,
) -> Result<Shipped, String> {
    let found = bundle
        .program(program)
        .and_then(|program| program.entry(language, entry)?.get(key, target))
        .map_err(|error| error.to_string())?;
    let (native, reflection) = ((*found.native).clone(), (*found.reflection).clone());
    Ok(Shipped { target, bytes: found.bytes.to_vec(), native, reflection })
}

fn lost(message: String) -> Diagnostic {
    Diagnostic::error(lamplight::diagnostic::codes::EXECUTOR_FAILED, message)
}

//! Runs stages of random programs from their outputs, on an executor for each target, and computes
//! them again with the evaluator from the composed text.
//!
//! `unit + partner -> one or two draws for each target: inputs of fragments, outputs -> comparison`
//!
//! A stage is drawn with a partner that is made for it. The partner of a fragment stage is a vertex
//! stage that gives its inputs ordinary numbers. The partner of a vertex stage is a fragment stage
//! that writes its inputs.

mod evaluated;
mod fragment;
mod metal;
mod vertex;

use std::collections::BTreeMap;
use std::sync::Arc;

use lamplight::bundle::{BindingKind, Language, Stage, Target, Unit, Varying};
use lamplight::compose::{Composed, lean};
use lamplight::diagnostic::{Diagnostic, codes};
use lamplight::emit::reflect;
use lamplight::execute::executors;
use lamplight::execute::fixture::Fixture;
use lamplight::execute::frame::{Buffers, DrawItem, Drawing, EntryPoint, Mesh};
use lamplight::execute::shipped::Shipped;
use lamplight::execute::{Session, ShippedPair};
use lamplight::picture::frame::{pack_buffer, probe};
use lamplight::validate::{Validated, validate};

use super::same::Finding;
use crate::frames::fixture;
use crate::random::Random;

use evaluated::Evaluator;
use metal::Metal;

/// The size of a frame in pixels.
const SIZE: [u32; 2] = [4, 4];

type Place = (u32, u32);

/// A fragment stage with its outputs.
#[derive(Debug, Clone)]
pub struct Runnable {
    pub seed: u64,
    pub composed: Composed,
    pub entry: String,
    pub unit: Unit,
}

impl Runnable {
    pub fn is_fragment(&self) -> bool {
        self.unit.reflection.stage == Stage::Fragment
    }

    /// The stage, if its text is valid with the functions that the entry point does not need. WESL was
    /// validated with all of them before.
    pub fn as_a_whole(self) -> Option<Self> {
        let is_valid = || validate(&lean(&self.composed)).is_ok();
        (self.composed.language == Language::Wesl || is_valid()).then_some(self)
    }
}

/// The results of the stages on one executor.
#[derive(Debug, Default, Clone)]
pub struct Ran {
    pub stages: usize,
    pub numbers: usize,
    /// How many numbers are neither right nor wrong: the evaluator has no bound for them, or a
    /// comparison in the stage was within the error of either result.
    pub open: usize,
    /// How many stages were not run, for each reason.
    pub lacks: BTreeMap<String, usize>,
}

impl std::fmt::Display for Ran {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { stages, numbers, open, lacks } = self;
        write!(f, "{stages} stages run, {numbers} numbers, {open} open")?;
        lacks.iter().try_for_each(|(reason, count)| write!(f, "; {count} not run: {reason}"))
    }
}

/// All executors that run outputs.
pub struct Runner {
    sessions: Vec<Opened>,
}

/// A target, with the name and the session of an executor that runs it.
type Opened = (Target, &'static str, Box<dyn Session>);

/// A stage, with everything that is needed to draw it.
struct Ready<'r> {
    runnable: &'r Runnable,
    validated: Validated,
    partner: Partner,
    mesh: Mesh,
    buffers: Buffers,
    fixtures: BTreeMap<Place, Arc<Fixture>>,
    stages: BTreeMap<Target, Result<Stages, Diagnostic>>,
}

/// The stage that a stage is drawn with.
struct Partner {
    validated: Validated,
    entry: &'static str,
    /// A fragment stage that writes its inputs; `None` if there are no inputs.
    input_stage: Option<probe::Watched>,
}

/// Items with the indices of their stages in a list.
type Placed<T> = Vec<(usize, T)>;

/// The stages that are drawn in one target.
#[derive(Clone)]
struct Stages {
    vertex: Shipped,
    /// The fragment stage that is tried; `None` if it is the vertex stage.
    fragment: Option<Shipped>,
    input_stage: Option<Shipped>,
}

/// The words that both draws gave.
struct Drawn {
    target: Target,
    /// The name of the executor.
    name: &'static str,
    outputs: Targets,
    inputs: Targets,
}

/// The words of each render target.
type Targets = Vec<Vec<u32>>;

/// Fails if a frame differs from what the evaluator computes.
type FrameCheck<'p> = dyn FnMut(&Drawn, &mut Ran) -> Result<(), String> + 'p;

impl Runner {
    /// Opens every driver and browser that runs a target.
    ///
    /// # Errors
    /// The driver or browser that is missing.
    pub fn open() -> Result<Self, String> {
        let session = |(target, (entry, shipping)): (
            Target,
            (&'static executors::ExecutorEntry, &executors::Shipping),
        )| {
            let session = (shipping.open)().map_err(|missing| entry.missing(&missing))?;
            Ok((target, entry.name, session))
        };
        let all =
            Target::ALL.iter().flat_map(|one| executors::shipping(*one).map(|ran| (*one, ran)));
        Ok(Self { sessions: all.map(session).collect::<Result<_, String>>()? })
    }

    /// Runs stages. Each finding has the index of its stage.
    pub fn run(
        &self,
        runnables: &[Runnable],
        ran: &mut BTreeMap<&'static str, Ran>,
    ) -> Result<Placed<Finding>, String> {
        let (ready, mut findings) = made_ready(runnables);
        let (owners, ready): (Vec<usize>, Vec<Ready<'_>>) = ready.into_iter().unzip();
        let metal = Metal::new(&ready)?;
        for (index, ready) in ready.iter().enumerate() {
            let mut frames = Vec::new();
            for (target, name, session) in &self.sessions {
                let Some(stages) = ready.stages.get(target) else { continue };
                let drawn = match (stages, *target == Target::MSL) {
                    (Err(error), _) => Err(error.clone()),
                    (Ok(_), true) => metal.draw(index, ready),
                    (Ok(stages), false) => ready.draw(stages, session.as_ref()),
                };
                let tally = ran.entry(name).or_default();
                match drawn {
                    Ok((outputs, inputs)) => {
                        tally.stages += 1;
                        frames.push(Drawn { target: *target, name, outputs, inputs });
                    }
                    Err(error) if error.code.name == codes::EXECUTOR_LACKS.name => {
                        *tally.lacks.entry(error.message).or_default() += 1;
                    }
                    Err(error) => {
                        let first = error.message.lines().next().unwrap_or_default().to_owned();
                        let kind = format!("{target} does not run on {name}: {first}");
                        findings
                            .push((owners[index], ready.finding(kind, *target, &error.message)));
                    }
                }
            }
            let found = ready.compare(&frames, ran).into_iter();
            findings.extend(found.map(|finding| (owners[index], finding)));
        }
        Ok(findings)
    }
}

/// The stages that can be run, and a finding for each of the others.
fn made_ready(runnables: &[Runnable]) -> (Placed<Ready<'_>>, Placed<Finding>) {
    let (mut ready, mut findings) = (Vec::new(), Vec::new());
    for (index, runnable) in runnables.iter().enumerate() {
        match Ready::new(runnable) {
            Ok(one) => ready.push((index, one)),
            Err(error) => findings.push((index, Finding::new("it cannot be run", error))),
        }
    }
    (ready, findings)
}

impl<'r> Ready<'r> {
    fn new(runnable: &'r Runnable) -> Result<Self, String> {
        let Runnable { seed, composed, entry, unit } = runnable;
        let with_seed = |problems: Vec<Diagnostic>| format!("seed {seed}: {problems:?}");
        // The crate validates the lean text too, since naga refuses some texts with aliases.
        let validated = validate(&lean(composed)).map_err(with_seed)?;
        let mut random = Random(seed ^ 0xfeed);
        // The reflection is that of the whole text. An output leaves out what it does not need.
        let whole = reflect(&validated, entry).map_err(|problem| with_seed(vec![problem]))?;
        let (partner, mesh) = match runnable.is_fragment() {
            true => (fragment::partner(&validated, entry, &whole, &mut random), Mesh::default()),
            false => (vertex::partner(&whole), vertex::mesh(&mut random)),
        };
        let partner = partner.map_err(with_seed)?;
        let (mut buffers, mut fixtures) = (Buffers::new(), BTreeMap::new());
        for binding in &unit.reflection.bindings {
            let place = (binding.group, binding.binding);
            if binding.kind == BindingKind::Uniform {
                let start = random.next();
                let numbers = |path: &str| Some(numbers(start, path));
                let bytes = pack_buffer(binding, &numbers).map_err(|problem| problem.message)?;
                buffers.insert(place, bytes);
            } else {
                let made = fixture(binding.kind, &binding.name, &binding.ty, "");
                fixtures.insert(place, Arc::new(made));
            }
        }
        let stages = BTreeMap::new();
        let mut ready = Self { runnable, validated, partner, mesh, buffers, fixtures, stages };
        let own = Target::ALL.iter().filter(|one| unit.targets.contains_key(one.name()));
        ready.stages = own.map(|target| (*target, ready.shipped(*target))).collect();
        Ok(ready)
    }

    fn shipped(&self, target: Target) -> Result<Stages, Diagnostic> {
        let Runnable { unit, .. } = self.runnable;
        let Partner { validated, entry, input_stage } = &self.partner;
        let input_stage = input_stage.as_ref().map(|input_stage| {
            Shipped::of(
                EntryPoint { module: &input_stage.module, entry: probe::INPUTS_ENTRY },
                target,
            )
        });
        let artifact = &unit.targets[target.name()];
        let own = Shipped {
            target,
            bytes: artifact.bytes.to_vec(),
            native: (*artifact.native).clone(),
            reflection: (*unit.reflection).clone(),
        };
        let (vertex, fragment) = match self.runnable.is_fragment() {
            true => {
                let feeder = EntryPoint { module: &validated.module, entry };
                (Shipped::of(feeder, target)?, Some(own))
            }
            false => (own, None),
        };
        Ok(Stages { vertex, fragment, input_stage: input_stage.transpose()? })
    }

    /// Draws the stage and the one that writes its inputs. Gives the outputs and the inputs.
    fn draw(
        &self,
        stages: &Stages,
        session: &dyn Session,
    ) -> Result<(Targets, Targets), Diagnostic> {
        self.drawing(|drawing| {
            let draw = |fragment| {
                let pair = ShippedPair { vertex: &stages.vertex, fragment };
                let frames = session.draw_shipped(pair, drawing);
                frames.map(|mut frames| frames.remove(0).targets)
            };
            let inputs = stages.input_stage.as_ref().map(draw).transpose()?;
            let outputs = stages.fragment.as_ref().map(draw).transpose()?;
            Ok((outputs.unwrap_or_default(), inputs.unwrap_or_default()))
        })
    }

    fn drawing<T>(&self, draw: impl FnOnce(&Drawing<'_>) -> T) -> T {
        let own = EntryPoint { module: &self.validated.module, entry: &self.runnable.entry };
        let partner =
            EntryPoint { module: &self.partner.validated.module, entry: self.partner.entry };
        let pair = match self.runnable.is_fragment() {
            true => [partner, own],
            false => [own, partner],
        };
        let items = [DrawItem { mesh: &self.mesh, buffers: &self.buffers }];
        draw(&Drawing::of_items(pair, &items, &self.fixtures, SIZE))
    }

    /// A finding for each target whose numbers differ from the evaluator's.
    fn compare(&self, frames: &[Drawn], ran: &mut BTreeMap<&'static str, Ran>) -> Vec<Finding> {
        let made = match self.runnable.is_fragment() {
            true => Evaluator::new(self).map(|mut made| -> Box<FrameCheck<'_>> {
                Box::new(move |frame, tally| made.frame(frame, tally))
            }),
            false => vertex::Corners::new(self).map(|made| -> Box<FrameCheck<'_>> {
                Box::new(move |frame, tally| made.frame(frame, tally))
            }),
        };
        let mut check = match made {
            Ok(check) => check,
            Err(error) => return vec![Finding::new(format!("evaluator: {error}"), error)],
        };
        let mut findings = Vec::new();
        for frame in frames {
            let tally = ran.entry(frame.name).or_default();
            if let Err(error) = check(frame, tally) {
                let kind = format!("{} computes something else on {}", frame.target, frame.name);
                findings.push(self.finding(kind, frame.target, &error));
            }
        }
        findings
    }

    fn finding(&self, kind: String, target: Target, about: &str) -> Finding {
        let bytes = &self.runnable.unit.targets[target.name()].bytes;
        let output = match target == Target::SPIRV {
            true => String::new(),
            false => String::from_utf8_lossy(bytes).into_owned(),
        };
        Finding::new(kind, format!("{about}\n{}\n{output}", self.runnable.composed.text))
    }
}

fn interpolated(input: &Varying) -> String {
    match (&input.interpolation, &input.sampling) {
        (Some(interpolation), Some(sampling)) if interpolation != "flat" => {
            format!("@interpolate({interpolation}, {sampling})")
        }
        (Some(interpolation), _) => format!("@interpolate({interpolation})"),
        _ => String::new(),
    }
}

/// A multiple of 1/16 from -2 to 2, which is exact in f32.
fn number(random: &mut Random) -> f64 {
    random.below(65) as f64 / 16.0 - 2.0
}

/// The numbers of a uniform. For integers they are truncated later.
fn numbers(start: u64, path: &str) -> Vec<f64> {
    let mut random = path.bytes().fold(Random(start), |mut random, byte| {
        random.0 ^= u64::from(byte);
        Random(random.next())
    });
    (0..16).map(|_| number(&mut random)).collect()
}

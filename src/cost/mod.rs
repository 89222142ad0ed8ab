//! What a shader costs on GPUs that are not there: instructions, registers, waves, latency.
//!
//! Mesa's driver for AMD GPUs compiles for any chip it knows, with or without the hardware, and
//! tells figures of the machine code. They depend on the SPIR-V, the GPU and Mesa's version alone,
//! so that they can be recorded and compared. Nothing is run.
//!
//! `subject -> pipeline -> device -> statistics`

pub mod baseline;
pub mod device;
pub mod gpu;
pub mod permutations;
pub mod pipeline;
pub mod statistics;

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use naga::valid::{ValidationFlags, Validator};
use rayon::prelude::*;

use crate::bundle::{Language, Stage};
use crate::diagnostic::{Diagnostic, codes};
use crate::execute::kernel::{ENTRY, varying};
use crate::validate::{CAPABILITIES, Validated, on_large_stack};
use device::Device;
use gpu::Gpu;
use pipeline::{Known, Pipeline};
use statistics::Statistics;

/// Something whose cost is asked for.
pub struct Subject {
    /// A function's path, a permutation's key or a file.
    pub name: String,
    /// The stages that are told.
    pub stages: Vec<Stage>,
    pub pipeline: Pipeline,
    /// The same stage without the function; its figures are subtracted.
    pub empty: Option<Pipeline>,
}

/// The cost of one stage on one GPU.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cost {
    pub name: String,
    pub gpu: &'static Gpu,
    pub stage: Stage,
    /// Figures of the whole stage.
    pub stage_figures: Statistics,
    /// Of a function: those less the empty stage's.
    pub net: Option<Statistics>,
}

impl Cost {
    /// What is compared: of a function its own figures, else those of the stage.
    pub fn figures(&self) -> &Statistics {
        self.net.as_ref().unwrap_or(&self.stage_figures)
    }
}

/// The subject of a function of a module.
///
/// # Errors
/// There is no such function, or it has parameters that no fragment stage can take.
pub fn function(name: &str, module: &naga::Module, function: &str) -> Result<Subject, Diagnostic> {
    let [called, empty] = varying(module, function)?;
    let pipeline = |module| stage_alone(module).ok_or_else(|| cannot(name));
    Ok(Subject {
        name: name.to_owned(),
        stages: vec![Stage::Fragment],
        pipeline: pipeline(called)?,
        empty: Some(pipeline(empty)?),
    })
}

fn stage_alone(module: naga::Module) -> Option<Pipeline> {
    let info = Validator::new(ValidationFlags::all(), CAPABILITIES).validate(&module).ok()?;
    let validated = Validated { language: Language::Wesl, module, info };
    Pipeline::new(Known::of_module(&validated, ENTRY)?, None)
}

fn cannot(name: &str) -> Diagnostic {
    Diagnostic::error(
        codes::UNTESTABLE_FUNCTION,
        format!("`{name}` could not be put into a fragment stage"),
    )
}

/// The subject of stages that belong together: a vertex and a fragment stage, or one of them.
pub fn stages(name: &str, mut known: Vec<Known>) -> Option<Subject> {
    let stages = known.iter().map(|known| known.words.stage).collect();
    let first = known.pop()?;
    let pipeline = Pipeline::new(first, known.pop())?;
    Some(Subject { name: name.to_owned(), stages, pipeline, empty: None })
}

/// The cost of every subject on every device, in their order. Equal pipelines are compiled once.
///
/// # Errors
/// What a driver says where it refuses a pipeline, with the subject's name.
pub fn measure(
    devices: &[Device],
    subjects: &[Subject],
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Vec<Cost>, String> {
    let mut names: BTreeMap<usize, &str> = BTreeMap::new();
    let mut distinct: std::collections::HashMap<&Pipeline, usize> = Default::default();
    for subject in subjects {
        for pipeline in [Some(&subject.pipeline), subject.empty.as_ref()].into_iter().flatten() {
            let next = distinct.len();
            let index = *distinct.entry(pipeline).or_insert(next);
            names.entry(index).or_insert(&subject.name);
        }
    }
    let mut pipelines: Vec<(&Pipeline, usize)> =
        distinct.iter().map(|(pipeline, index)| (*pipeline, *index)).collect();
    pipelines.sort_by_key(|(_, index)| *index);
    let (done, total) = (AtomicUsize::new(0), pipelines.len() * devices.len());
    let one = |device: &Device, pipeline: &Pipeline, index: usize| {
        let name = names.get(&index).copied().unwrap_or_default();
        let figures = device.measure(pipeline);
        progress(done.fetch_add(1, Ordering::Relaxed) + 1, total);
        figures.map_err(|reason| format!("`{name}` on {}: {reason}", device.gpu.name))
    };
    let jobs: Vec<(&Device, &Pipeline, usize)> = devices
        .iter()
        .flat_map(|device| {
            pipelines.iter().map(move |(pipeline, index)| (device, *pipeline, *index))
        })
        .collect();
    let all = || jobs.par_iter().map(|(device, pipeline, index)| one(device, pipeline, *index));
    let figures: Vec<Vec<(Stage, Statistics)>> =
        on_large_stack(|| all().collect::<Result<_, String>>())?;
    let mut costs = Vec::new();
    for subject in subjects {
        for (number, device) in devices.iter().enumerate() {
            let of = |pipeline: &Pipeline, stage: Stage| {
                let index = *distinct.get(pipeline)?;
                let figures = figures.get(number * pipelines.len() + index)?;
                figures.iter().find(|(found, _)| *found == stage).map(|(_, figures)| *figures)
            };
            for stage in subject.stages.iter().copied() {
                let Some(stage_figures) = of(&subject.pipeline, stage) else { continue };
                let empty = subject.empty.as_ref().and_then(|empty| of(empty, stage));
                let net = empty.map(|empty| stage_figures.less(&empty));
                let name = subject.name.clone();
                costs.push(Cost { name, gpu: device.gpu, stage, stage_figures, net });
            }
        }
    }
    Ok(costs)
}

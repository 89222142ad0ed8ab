//! What a shader costs on GPUs that are not installed: instructions, registers, waves, latency.
//!
//! Mesa's driver for AMD GPUs compiles for any chip that it knows, with or without the hardware,
//! and reports figures of the machine code. They depend only on the SPIR-V, the GPU and Mesa's
//! version, so they can be recorded and compared. Nothing is run.
//!
//! `subject -> pipeline -> device -> statistics`
//!
//! Two more compilers are programs of their own: `subject -> stages -> counts` asks `spirv-opt`,
//! and `subject -> stages -> mali` asks Arm's compiler.

pub mod baseline;
pub mod counts;
pub mod device;
pub mod foreign;
pub mod gpu;
pub mod machine;
pub mod mali;
pub mod permutations;
pub mod pipeline;
pub mod stages;
pub mod statistics;

use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use device::Device;
use gpu::Gpu;
use lamplight_bundle::{Conventions, Stage};
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_execute::kernel::{ENTRY, varying_modules};
use lamplight_generate::cache::Cache;
use lamplight_validate::{Validated, info_of, on_large_stack};
use pipeline::{Pipeline, ReflectedStage};
use statistics::Statistics;

/// Something whose cost is asked for.
pub struct CostSubject {
    /// A function's path, a permutation's key or a file.
    pub name: String,
    /// The stages whose figures are reported.
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
    /// For a function, the figures less those of the stage without it.
    pub net: Option<Statistics>,
}

impl Cost {
    /// The figures that are compared: a function's own, or else those of the stage.
    pub fn figures(&self) -> &Statistics {
        self.net.as_ref().unwrap_or(&self.stage_figures)
    }
}

/// The subject of a function of a module.
///
/// # Errors
/// There is no such function, or it has parameters that no fragment stage can take.
pub fn function_subject(
    name: &str,
    module: &naga::Module,
    function: &str,
    conventions: Conventions,
) -> Result<CostSubject, Diagnostic> {
    let [called, empty] = varying_modules(module, function)?;
    let pipeline =
        |module| stage_alone(module, conventions).map_err(|reason| cannot_measure(name, &reason));
    Ok(CostSubject {
        name: name.to_owned(),
        stages: vec![Stage::Fragment],
        pipeline: pipeline(called)?,
        empty: Some(pipeline(empty)?),
    })
}

fn stage_alone(module: naga::Module, conventions: Conventions) -> Result<Pipeline, String> {
    let info = info_of(&module).map_err(|error| error.to_string())?;
    let validated = Validated { module, info, portable: true };
    Pipeline::new(ReflectedStage::of_module(&validated, ENTRY, conventions)?, None)
}

fn cannot_measure(name: &str, reason: &str) -> Diagnostic {
    Diagnostic::error(
        codes::UNTESTABLE_FUNCTION,
        format!("`{name}` could not be put into a fragment stage: {reason}"),
    )
}

/// The subject of stages that belong together: a vertex and a fragment stage, or one of them.
///
/// # Errors
/// No pipeline can be made of them: there is none of them, or a stage to go with it cannot be
/// written.
pub fn stages_subject(name: &str, mut known: Vec<ReflectedStage>) -> Result<CostSubject, String> {
    let stages = known.iter().map(|known| known.words.stage).collect();
    let first = known.pop().ok_or("there is no stage")?;
    let pipeline = Pipeline::new(first, known.pop())?;
    Ok(CostSubject { name: name.to_owned(), stages, pipeline, empty: None })
}

/// What subjects are measured with.
#[derive(Clone, Copy)]
pub struct Meter<'a> {
    /// The GPUs.
    pub devices: &'a [Device],
    /// What was measured before.
    pub cache: Option<&'a Cache>,
    /// How often loops run whose code does not say it, see [`Device::measure`].
    pub iterations: &'a [u32],
}

/// Measures every subject on every device, in their order. Equal pipelines are compiled once.
///
/// # Errors
/// The driver's message where it refuses a pipeline, with the subject's name.
pub fn measure_subjects(
    meter: Meter<'_>,
    subjects: &[CostSubject],
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Vec<Cost>, String> {
    let Meter { devices, cache, iterations } = meter;
    let distinct = Distinct::of(subjects);
    let jobs: Vec<(&Device, &Pipeline, &str)> = devices
        .iter()
        .flat_map(|device| distinct.pipelines.iter().map(move |(of, name)| (device, *of, *name)))
        .collect();
    let (done, total) = (AtomicUsize::new(0), jobs.len());
    let one = |(device, pipeline, name): &(&Device, &Pipeline, &str)| {
        let figures = baseline::known_figures(device, pipeline, iterations, cache);
        progress(done.fetch_add(1, Ordering::Relaxed) + 1, total);
        figures.map_err(|reason| format!("`{name}` on {}: {reason}", device.gpu.name))
    };
    let figures: Vec<StageFigures> =
        on_large_stack(|| jobs.par_iter().map(one).collect::<Result<_, String>>())?;
    let mut costs = Vec::new();
    for subject in subjects {
        for (device, figures) in devices.iter().zip(figures.chunks(distinct.pipelines.len())) {
            for stage in subject.stages.iter().copied() {
                let of = |pipeline: &Pipeline| distinct.figures(figures, pipeline, stage);
                let with_context =
                    |reason| format!("`{}` on {}: {reason}", subject.name, device.gpu.name);
                let stage_figures = of(&subject.pipeline).map_err(with_context)?;
                let empty = subject.empty.as_ref().map(of).transpose().map_err(with_context)?;
                let net = empty.map(|empty| stage_figures.less(&empty));
                let name = subject.name.clone();
                costs.push(Cost { name, gpu: device.gpu, stage, stage_figures, net });
            }
        }
    }
    Ok(costs)
}

/// The figures of a pipeline's stages on one GPU.
type StageFigures = Vec<(Stage, Statistics)>;

/// The pipelines of subjects, each once.
struct Distinct<'s> {
    /// In the order of the subjects, with the first subject's name.
    pipelines: Vec<(&'s Pipeline, &'s str)>,
    /// Indices into `pipelines`.
    places: HashMap<&'s Pipeline, usize>,
}

impl<'s> Distinct<'s> {
    fn of(subjects: &'s [CostSubject]) -> Self {
        let mut distinct = Self { pipelines: Vec::new(), places: HashMap::new() };
        for subject in subjects {
            for pipeline in [Some(&subject.pipeline), subject.empty.as_ref()].into_iter().flatten()
            {
                let next = distinct.pipelines.len();
                if *distinct.places.entry(pipeline).or_insert(next) == next {
                    distinct.pipelines.push((pipeline, &subject.name));
                }
            }
        }
        distinct
    }

    /// The figures of a pipeline's stage, from those of all pipelines on one GPU.
    fn figures(
        &self,
        figures: &[StageFigures],
        pipeline: &Pipeline,
        stage: Stage,
    ) -> Result<Statistics, String> {
        let place = self.places.get(pipeline).copied();
        let stages = place.and_then(|place| figures.get(place)).into_iter().flatten();
        let found = stages.into_iter().find(|(found, _)| *found == stage);
        let missing = || format!("the driver reports no figures of the {stage:?} stage");
        found.map(|(_, figures)| *figures).ok_or_else(missing)
    }
}

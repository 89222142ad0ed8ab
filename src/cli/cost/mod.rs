//! `lamplight cost`: what functions and permutations cost on GPUs that the machine need not have.

mod axes;
mod offline;
mod record;
mod subjects;

pub use axes::{axis_changes, changes_table};
pub use record::{axis_record, record_costs};

use std::collections::BTreeSet;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;

use super::cached::Cached;
use super::compile::ConventionArguments;
use super::failure::{DiagnosticForm, Failure};
use super::input::InputArguments;
use super::overwrite::Overwrite;
use super::progress::Bar;
use super::terminal::stdout;
use super::text;
use crate::bundle::Stage;
use crate::cost::baseline::{Baseline, Rise};
use crate::cost::device::Device;
use crate::cost::gpu::{self, GPUS, Gpu};
use crate::cost::statistics::{CostFigure, FIGURES, Statistics};
use crate::cost::{self, Cost, CostSubject, Meter};
use crate::diagnostic::nearest_name;
use crate::generate::Progress;
use crate::input::read_file;
use crate::output;

/// The most bytes of a file of recorded costs.
const MOST_BYTES: u64 = 64 << 20;

/// Estimate the cost of functions, permutations and shaders on GPUs that the machine need not have.
///
/// Mesa's driver compiles them for AMD GPUs, and the cycles of each unit are counted in the machine
/// code, on the cheapest and on the dearest path. A function is called by a fragment stage whose
/// inputs vary and whose result is used. The figures of the same stage without the function are
/// subtracted.
#[derive(Args)]
pub struct Arguments {
    /// A function (`brdf::specular::blinn_phong`), a module (`brdf::specular`), a folder (`brdf`),
    /// a permutation's key (`lights=spot,shadow=vsm`), or the file of a shader of your own,
    /// or of a module, whose functions are measured, or of SPIR-V (`shader.spv`); `-` is standard
    /// input [default: every function].
    #[arg(value_name = "PATH|KEY|FILE")]
    subjects: Vec<String>,
    #[command(flatten)]
    gpus: Gpus,
    /// Instead, count the instructions of SPIR-V by kind, after `spirv-opt -O`. This needs no
    /// driver.
    #[arg(long, conflicts_with_all = ["gpu", "mali", "baseline"])]
    spirv: bool,
    /// Instead, compile whole stages for these Mali GPUs, such as `Mali-G78`, with Arm's `malioc`,
    /// which must be on PATH.
    #[arg(long, value_name = "CORE,...", value_delimiter = ',', conflicts_with_all = ["gpu", "baseline", "whole"])]
    mali: Vec<String>,
    #[command(flatten)]
    input: InputArguments,
    #[command(flatten)]
    conventions: ConventionArguments,
    /// Instead, a covering set of the permutations of each program, or of the one that `--program`
    /// names: few permutations in which every pair of values occurs.
    #[arg(long, conflicts_with = "subjects")]
    cover: bool,
    /// The manifest of a key's program [default: `lamplight.toml` here or in the nearest folder
    /// above, else that of the library].
    #[arg(long, value_name = "FILE")]
    manifest: Option<PathBuf>,
    /// The program of a key [default: the manifest's only one, or `forward`].
    #[arg(long, value_name = "P")]
    program: Option<String>,
    /// Compare with the figures in this file; the exit code is 3 if one rose by more than `--rise`.
    /// If the file does not exist, record the figures in it.
    #[arg(long, value_name = "FILE")]
    baseline: Option<PathBuf>,
    /// Record the figures in the file of `--baseline`.
    #[arg(long, requires = "baseline")]
    record: bool,
    /// The share by which a figure may rise, such as 0.02.
    #[arg(long, value_name = "SHARE", default_value_t = 0.02, value_parser = parse_share)]
    rise: f64,
    /// How often loops run whose machine code does not say it, in the order of the code; the last
    /// number holds for all further ones [default: they count once, and are listed].
    #[arg(long, value_name = "N,...", value_delimiter = ',')]
    iterations: Vec<u32>,
    /// Print the figures of whole stages, instead of those that the functions add.
    #[arg(long)]
    whole: bool,
    /// Print a JSON array of objects with both.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    cached: Cached,
    #[command(flatten)]
    overwrite: Overwrite,
}

fn gpu_name(name: &str) -> Result<&'static Gpu, String> {
    gpu::find_gpu(name).ok_or_else(|| {
        let names: Vec<&str> = GPUS.iter().map(|gpu| gpu.name).collect();
        let hint = nearest_name(name, names.iter().copied())
            .map_or(String::new(), |near| format!("; did you mean `{near}`?"));
        format!("no such GPU{hint} (GPUs: {})", names.join(", "))
    })
}

fn parse_share(text: &str) -> Result<f64, String> {
    let share = text.parse::<f64>().ok().filter(|share| share.is_finite() && *share >= 0.0);
    share.ok_or_else(|| "expected a number from 0, such as 0.02".to_owned())
}

/// GPUs as an option names them.
#[derive(Args)]
pub struct Gpus {
    /// GPUs: fiji, polaris10, vega10, raven, navi10, navi21, navi24, vangogh, gfx1100
    /// [default: one of each generation].
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', value_parser = gpu_name)]
    gpu: Vec<&'static Gpu>,
}

/// GPUs to compile for, or why there are none.
pub type OpenedGpus = Result<Vec<Device>, String>;

impl Gpus {
    /// Whether any is named.
    pub fn are_named(&self) -> bool {
        !self.gpu.is_empty()
    }

    /// One GPU of each generation.
    pub fn of_each_generation() -> OpenedGpus {
        Self { gpu: Vec::new() }.open()
    }

    /// Opens the GPUs. Call this while the process has only one thread.
    pub fn open(&self) -> OpenedGpus {
        let named: BTreeSet<&Gpu> = self.gpu.iter().copied().collect();
        let is_wanted = |gpu: &&Gpu| match named.is_empty() {
            true => gpu.is_default,
            false => named.contains(gpu),
        };
        GPUS.iter().filter(is_wanted).map(Device::open).collect()
    }
}

impl Arguments {
    /// Opens the GPUs that are asked for. Call this while the process has only one thread.
    pub fn open_gpus(&self) -> OpenedGpus {
        if self.spirv || !self.mali.is_empty() { Ok(Vec::new()) } else { self.gpus.open() }
    }
}

pub fn run_cost(
    arguments: Arguments,
    opened: OpenedGpus,
    form: DiagnosticForm,
) -> Result<(), Failure> {
    if arguments.spirv || !arguments.mali.is_empty() {
        return offline::run_offline(&arguments, form);
    }
    let recorded = arguments.baseline.as_deref().filter(|_| !arguments.record);
    let recorded = recorded.map(recorded_in).transpose()?.flatten();
    let cache = arguments.cached.open(arguments.manifest.as_deref())?;
    let subjects = subjects::requested_subjects(&arguments, form)?;
    let devices = opened.map_err(Failure::environment)?;
    let meter =
        Meter { devices: &devices, cache: cache.as_ref(), iterations: &arguments.iterations };
    let costs = measure_costs(meter, &subjects)?;
    let driver = devices.first().map_or("", |device| &device.driver);
    print_costs(&arguments, driver, &costs)?;
    let Some(path) = &arguments.baseline else { return Ok(()) };
    match recorded {
        Some(recorded) => compare_costs(&recorded, driver, &costs, arguments.rise),
        None => {
            let text = Baseline::of(driver, &costs).text();
            let replace = arguments.overwrite.replace();
            output::write_file(path, text.as_bytes(), Baseline::is_at, replace)?;
            Ok(())
        }
    }
}

fn measure_costs(meter: Meter<'_>, subjects: &[CostSubject]) -> Result<Vec<Cost>, Failure> {
    let bar = Bar::new();
    let progress = |done, total| bar.show(Progress { stage: "compiling".to_owned(), done, total });
    let costs = cost::measure_subjects(meter, subjects, &progress);
    bar.clear();
    costs.map_err(Failure::input)
}

/// The figures of a file; `None` where there is none.
fn recorded_in(path: &Path) -> Result<Option<Baseline>, Failure> {
    if !path.exists() {
        return Ok(None);
    }
    let with_path = |reason: String| Failure::input(format!("{}: {reason}", path.display()));
    let bytes = read_file(path, MOST_BYTES).map_err(|error| with_path(error.to_string()))?;
    Baseline::parse(&bytes)
        .map(Some)
        .map_err(|reason| with_path(format!("this is not a file of recorded costs: {reason}")))
}

fn compare_costs(
    recorded: &Baseline,
    driver: &str,
    costs: &[Cost],
    share: f64,
) -> Result<(), Failure> {
    if recorded.driver != driver {
        return Err(Failure::environment(format!(
            "the costs were recorded with `{}`, and this is `{driver}`: figures of two versions of \
             the driver are not comparable; record them again with `--record`",
            recorded.driver
        )));
    }
    let rises = recorded.rises(costs, share);
    if rises.is_empty() {
        return Ok(());
    }
    let line = |rise: &Rise| {
        let Rise { key, figure, before, after } = rise;
        format!("  {key}: {figure} {before} -> {after}")
    };
    let lines: Vec<String> = rises.iter().map(line).collect();
    Err(Failure::check(format!(
        "{} figures are worse by more than {} %:\n{}",
        lines.len(),
        share * 100.0,
        lines.join("\n")
    )))
}

fn print_costs(arguments: &Arguments, driver: &str, costs: &[Cost]) -> Result<(), Failure> {
    if arguments.json {
        let objects: Vec<_> = costs.iter().map(|cost| cost_object(driver, cost)).collect();
        return Ok(writeln!(stdout(), "{:#}", json!(objects))?);
    }
    let several_stages = costs.iter().any(|cost| cost.stage != Stage::Fragment);
    let mut columns = vec!["gpu"];
    columns.extend(several_stages.then_some("stage"));
    let shown: Vec<&CostFigure> =
        FIGURES.iter().filter(|figure| is_shown(figure, arguments, costs)).collect();
    columns.extend(shown.iter().map(|figure| figure.heading));
    columns.push("of");
    let rows: Vec<Vec<String>> = costs
        .iter()
        .map(|cost| {
            let figures = table_figures(arguments, cost);
            let mut row = vec![cost.gpu.name.to_owned()];
            row.extend(several_stages.then(|| cost.stage.name().to_owned()));
            row.extend(shown.iter().map(|figure| figure.of(figures).to_string()));
            row.push(cost.name.clone());
            row
        })
        .collect();
    writeln!(stdout(), "{driver}\n")?;
    stdout().write_all(text::table_text(&columns, &rows).as_bytes())?;
    print_open_loops(costs)
}

/// The figures of a row.
fn table_figures<'c>(arguments: &Arguments, cost: &'c Cost) -> &'c Statistics {
    if arguments.whole { &cost.stage_figures } else { cost.figures() }
}

/// The columns that are left out where they are 0 in every row.
const RARE: [&str; 9] = [
    "memory",
    "scalar_memory",
    "local",
    "export",
    "open_loops",
    "spilled_vgprs",
    "spilled_sgprs",
    "scratch",
    "texture",
];

/// Whether the table has a column for a figure.
fn is_shown(figure: &CostFigure, arguments: &Arguments, costs: &[Cost]) -> bool {
    let is_rare = RARE.contains(&figure.key);
    let is_there = || costs.iter().any(|cost| figure.of(table_figures(arguments, cost)) != 0);
    !figure.heading.is_empty() && (!is_rare || is_there())
}

/// Says which subjects have loops of unknown length, which no figure shows.
fn print_open_loops(costs: &[Cost]) -> Result<(), Failure> {
    let open = costs.iter().filter(|cost| cost.stage_figures.open_loops > 0);
    let names: BTreeSet<&str> = open.map(|cost| cost.name.as_str()).collect();
    if names.is_empty() {
        return Ok(());
    }
    let names: Vec<&str> = names.into_iter().collect();
    Ok(writeln!(
        stdout(),
        "\nLoops of unknown length count once; `--iterations` says how often they run: {}",
        names.join(", ")
    )?)
}

fn cost_object(driver: &str, cost: &Cost) -> serde_json::Value {
    json!({
        "name": cost.name,
        "gpu": cost.gpu.name,
        "generation": cost.gpu.generation,
        "driver": driver,
        "stage": cost.stage,
        "figures": cost.stage_figures,
        "net": cost.net,
    })
}

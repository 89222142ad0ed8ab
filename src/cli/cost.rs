//! `lamplight cost`: what functions and permutations cost on GPUs that are not there.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use clap::Args;
use serde_json::json;

use super::failure::Failure;
use super::input::LanguageName;
use super::overwrite::Overwrite;
use super::progress::Bar;
use super::terminal::stdout;
use super::{text, variants};
use crate::bundle::{Axis, Language, Stage, Target};
use crate::catalogue::{self, Kind};
use crate::cost::baseline::{Baseline, Rise};
use crate::cost::device::Device;
use crate::cost::gpu::{self, GPUS, Gpu};
use crate::cost::permutations::{self, Change, Spread};
use crate::cost::statistics::FIGURES;
use crate::cost::{self, Cost, Subject};
use crate::diagnostic::nearest;
use crate::generate::{Memory, Progress, Request, Tools, generate};
use crate::input::read;
use crate::output;
use crate::permute::{Manifest, Quoted};
use crate::proof::library::Library;
use crate::resolve::Packages;
use crate::source::SourceSet;

/// Bytes of a file of recorded costs.
const MOST_BYTES: u64 = 64 << 20;

/// Tell what functions and permutations cost on GPUs: instructions, registers, latency.
///
/// Mesa compiles for AMD GPUs that need not be there. A function is put into a fragment stage whose
/// inputs vary and whose result is used; the figures of the same stage without the function are
/// subtracted.
#[derive(Args)]
pub struct Arguments {
    /// A function (`brdf::specular::blinn_phong`), a module (`brdf::specular`), a folder (`brdf`),
    /// or a permutation's key (`lights=2,shadow=pcf`) [default: every function].
    #[arg(value_name = "PATH|KEY")]
    subjects: Vec<String>,
    #[command(flatten)]
    pub gpus: Gpus,
    /// The language whose functions or programs are measured.
    #[arg(long, value_enum, default_value = "wesl")]
    lang: LanguageName,
    /// The manifest of a key's program [default: that of the library].
    #[arg(long, value_name = "FILE")]
    manifest: Option<PathBuf>,
    /// The program of a key [default: the manifest's only one, or `forward`].
    #[arg(long, value_name = "P")]
    program: Option<String>,
    /// Compare with recorded figures: what rose by more than `--rise` fails (exit code 3). Where
    /// there is no such file, the figures are recorded.
    #[arg(long, value_name = "FILE")]
    baseline: Option<PathBuf>,
    /// Record the figures in the file of `--baseline`.
    #[arg(long, requires = "baseline")]
    record: bool,
    /// The share by which a figure may rise, such as 0.02.
    #[arg(long, value_name = "SHARE", default_value_t = 0.02, value_parser = share)]
    rise: f64,
    /// Figures of whole stages, instead of what the functions add to them.
    #[arg(long)]
    whole: bool,
    /// As a JSON array of objects with both.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    overwrite: Overwrite,
}

fn gpu_name(name: &str) -> Result<&'static Gpu, String> {
    gpu::find(name).ok_or_else(|| {
        let names: Vec<&str> = GPUS.iter().map(|gpu| gpu.name).collect();
        let hint = nearest(name, names.iter().copied())
            .map_or(String::new(), |near| format!("; did you mean `{near}`?"));
        format!("no such GPU{hint} (GPUs: {})", names.join(", "))
    })
}

fn share(text: &str) -> Result<f64, String> {
    let share = text.parse::<f64>().ok().filter(|share| share.is_finite() && *share >= 0.0);
    share.ok_or_else(|| "expected a number from 0, such as 0.02".to_owned())
}

/// GPUs as an option names them.
#[derive(Args)]
pub struct Gpus {
    /// GPUs: tahiti, fiji, polaris10, vega10, raven, navi10, navi21, navi24, vangogh, gfx1100
    /// [default: one of each generation].
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', value_parser = gpu_name)]
    gpu: Vec<&'static Gpu>,
}

/// GPUs to compile for, or why there are none.
pub type Opened = Result<Vec<Device>, String>;

impl Gpus {
    /// The GPUs, opened. To be called while the process has one thread.
    pub fn open(&self) -> Opened {
        let named = self.gpu.iter().copied();
        let mut wanted: Vec<&Gpu> =
            if self.gpu.is_empty() { gpu::defaults().collect() } else { named.collect() };
        wanted.dedup();
        wanted.into_iter().map(Device::open).collect()
    }
}

pub fn run(arguments: Arguments, opened: Opened) -> Result<(), Failure> {
    let recorded = arguments.baseline.as_deref().filter(|_| !arguments.record);
    let recorded = recorded.map(recorded_in).transpose()?.flatten();
    let subjects = subjects(&arguments)?;
    let devices = opened.map_err(Failure::environment)?;
    let costs = measured(&devices, &subjects)?;
    let driver = devices.first().map_or("", |device| &device.driver);
    print(&arguments, driver, &costs)?;
    let Some(path) = &arguments.baseline else { return Ok(()) };
    match recorded {
        Some(recorded) => compare(&recorded, driver, &costs, arguments.rise),
        None => {
            let text = Baseline::of(driver, &costs).text();
            let replace = arguments.overwrite.replace();
            output::write_file(path, text.as_bytes(), Baseline::is_at, replace)?;
            Ok(())
        }
    }
}

fn measured(devices: &[Device], subjects: &[Subject]) -> Result<Vec<Cost>, Failure> {
    let bar = Bar::new();
    let progress = |done, total| bar.show(Progress { stage: "compiling".to_owned(), done, total });
    let costs = cost::measure(devices, subjects, &progress);
    bar.clear();
    costs.map_err(Failure::input)
}

/// What each value of each axis of a program changes, over all its permutations.
pub fn changes(
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &Manifest,
    program: &str,
    devices: &[Device],
) -> Result<Vec<Change>, Failure> {
    let request = Request {
        program: Some(program.to_owned()),
        targets: vec![Target::SPIRV],
        ..Request::default()
    };
    let (axes, subjects) = permutations_of(sources, packages, manifest, &request, Language::Wesl)?;
    Ok(permutations::changes(&axes, &measured(devices, &subjects)?))
}

/// The table of changes: medians, and the range of the instructions.
pub fn changes_table(changes: &[Change]) -> String {
    let columns =
        ["gpu", "stage", "pairs", "instr", "range", "VGPRs", "waves", "inv.thr.", "axis and value"];
    let row = |change: &Change| {
        let of = |key: &str| change.figures.get(key).copied().unwrap_or_default();
        let signed = |key: &str| format!("{:+}", of(key).median);
        let Spread { least, most, .. } = of("instructions");
        let waves = of("subgroups_per_simd");
        vec![
            change.gpu.to_owned(),
            format!("{:?}", change.stage).to_lowercase(),
            change.pairs.to_string(),
            signed("instructions"),
            format!("{least:+} to {most:+}"),
            signed("vgprs"),
            format!("{} to {}", waves.before, waves.after),
            signed("inverse_throughput"),
            format!("{}={}", change.axis, change.value),
        ]
    };
    text::table(&columns, &changes.iter().map(row).collect::<Vec<_>>())
}

/// The figures of a file; `None` where there is none.
fn recorded_in(path: &Path) -> Result<Option<Baseline>, Failure> {
    if !path.exists() {
        return Ok(None);
    }
    let told = |reason: String| Failure::input(format!("{}: {reason}", path.display()));
    let bytes = read(path, MOST_BYTES).map_err(|error| told(error.to_string()))?;
    Baseline::parse(&bytes)
        .map(Some)
        .map_err(|reason| told(format!("these are no recorded costs: {reason}")))
}

fn compare(recorded: &Baseline, driver: &str, costs: &[Cost], share: f64) -> Result<(), Failure> {
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

/// What was asked for, in order.
fn subjects(arguments: &Arguments) -> Result<Vec<Subject>, Failure> {
    let mut subjects = Vec::new();
    let keys: Vec<&String> = arguments.subjects.iter().filter(|name| name.contains('=')).collect();
    let paths: Vec<&String> =
        arguments.subjects.iter().filter(|name| !name.contains('=')).collect();
    if keys.is_empty() || !paths.is_empty() {
        functions(&paths, arguments.lang.into(), &mut subjects)?;
    }
    for key in keys {
        subjects.push(permutation(arguments, key)?);
    }
    Ok(subjects)
}

/// The subjects of functions, modules and folders; of all functions where none is named.
fn functions(
    paths: &[&String],
    language: Language,
    subjects: &mut Vec<Subject>,
) -> Result<(), Failure> {
    let library = Library::embedded();
    let modules = catalogue::library();
    let items = || modules.iter().flat_map(|module| &module.items);
    let functions: Vec<_> = items().filter(|item| item.kind == Kind::Function).collect();
    let is_below = |path: &str, named: &str| {
        path == named || path.strip_prefix(named).is_some_and(|rest| rest.starts_with("::"))
    };
    for named in paths {
        let named = named.strip_prefix("lamplight::").unwrap_or(named);
        if !functions.iter().any(|item| is_below(&item.path(), named)) {
            let known: Vec<String> = functions.iter().map(|item| item.path()).collect();
            let hint = nearest(named, known.iter().map(String::as_str))
                .map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            return Err(Failure::input(format!("the library has no `{named}`{hint}")));
        }
    }
    let is_wanted = |path: &str| {
        let named = |named: &&String| is_below(path, named.trim_start_matches("lamplight::"));
        paths.is_empty() || paths.iter().any(named)
    };
    let sources = Mutex::new(SourceSet::default());
    for item in functions.iter().filter(|item| is_wanted(&item.path())) {
        let path = item.path();
        let Some((module, name)) = path.rsplit_once("::") else { continue };
        let of_sources = |diagnostics| {
            Failure::Input(
                sources.lock().map(|sources| sources.clone()).unwrap_or_default(),
                diagnostics,
            )
        };
        let composed =
            library.module(&sources, module, language, &[name.to_owned()]).map_err(of_sources)?;
        let subject = cost::function(&path, &composed, name);
        subjects.push(subject.map_err(|diagnostic| of_sources(vec![diagnostic]))?);
    }
    Ok(())
}

/// The subject of one permutation: its stages in SPIR-V, as a bundle has them.
fn permutation(arguments: &Arguments, key: &str) -> Result<Subject, Failure> {
    let mut sources = SourceSet::default();
    let (manifest, packages) = variants::open(arguments.manifest.as_deref(), &mut sources)
        .map_err(|diagnostics| Failure::Input(sources.clone(), diagnostics))?;
    let program = program(arguments, &manifest)?;
    let id = sources.add("KEY", key);
    let request = Request {
        program: Some(program),
        only: Some(Quoted::whole(&sources, id)),
        targets: vec![Target::SPIRV],
        shard: None,
    };
    let subjects =
        permutations_of(&mut sources, &packages, &manifest, &request, arguments.lang.into());
    subjects?.1.pop().ok_or_else(|| {
        Failure::input(format!("the permutation `{key}` has no stages in this language"))
    })
}

/// The permutations that a request chooses of a program, with the program's axes.
fn permutations_of(
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &Manifest,
    request: &Request,
    language: Language,
) -> Result<(Vec<Axis>, Vec<Subject>), Failure> {
    let (memory, bar) = (Memory::default(), Bar::new());
    let progress = |progress| bar.show(progress);
    let tools = Tools { sink: &memory, cache: None, progress: &progress };
    let generated = generate(sources, packages, manifest, request, &tools);
    bar.clear();
    let generated =
        generated.map_err(|diagnostics| Failure::Input(sources.clone(), diagnostics))?;
    let mut contents = generated.contents;
    memory.fill(&mut contents);
    let program = contents.programs.into_values().next();
    Ok(program.map_or_else(Default::default, |program| {
        let subjects = permutations::subjects(&program, language);
        (program.axes, subjects)
    }))
}

/// The program that a key is of.
fn program(arguments: &Arguments, manifest: &Manifest) -> Result<String, Failure> {
    if let Some(program) = &arguments.program {
        return Ok(program.clone());
    }
    match manifest.programs.as_slice() {
        [only] => Ok(only.name.clone()),
        programs if programs.iter().any(|program| program.name == "forward") => {
            Ok("forward".to_owned())
        }
        _ => Err(Failure::usage("the manifest has several programs: choose one with `--program`")),
    }
}

fn print(arguments: &Arguments, driver: &str, costs: &[Cost]) -> Result<(), Failure> {
    if arguments.json {
        let objects: Vec<_> = costs.iter().map(|cost| object(driver, cost)).collect();
        return Ok(writeln!(stdout(), "{:#}", json!(objects))?);
    }
    let several_stages = costs.iter().any(|cost| cost.stage != Stage::Fragment);
    let mut columns = vec!["gpu"];
    columns.extend(several_stages.then_some("stage"));
    columns.extend(FIGURES.iter().map(|figure| figure.heading));
    columns.push("of");
    let rows: Vec<Vec<String>> = costs
        .iter()
        .map(|cost| {
            let figures = if arguments.whole { &cost.stage_figures } else { cost.figures() };
            let mut row = vec![cost.gpu.name.to_owned()];
            row.extend(several_stages.then(|| format!("{:?}", cost.stage).to_lowercase()));
            row.extend(FIGURES.iter().map(|figure| figure.of(figures).to_string()));
            row.push(cost.name.clone());
            row
        })
        .collect();
    writeln!(stdout(), "{driver}\n")?;
    Ok(stdout().write_all(text::table(&columns, &rows).as_bytes())?)
}

fn object(driver: &str, cost: &Cost) -> serde_json::Value {
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

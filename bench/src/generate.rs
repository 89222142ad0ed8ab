//! Generation: the permutations of `forward`, all targets, beside a plain loop over naga.
//!
//! Both sides use one thread for each core, the same permutations, the same composer and, in this
//! process, the same allocator. The loop composes, parses, validates and writes each permutation
//! separately, as one would with naga alone. Neither side writes to disk.

use std::hint::black_box;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use lamplight::bundle::{Language, Stage, Target, pack};
use lamplight::compose::{Composed, Options, compose};
use lamplight::emit::emit;
use lamplight::generate::{Discard, Request, Tools, generate, in_memory};
use lamplight::permute::{Assignment, Manifest, Program};
use lamplight::project;
use lamplight::resolve::{self, Graph};
use lamplight::source::SourceSet;
use lamplight::validate::{CAPABILITIES, Validated, on_large_stack};
use naga::valid::{ValidationFlags, Validator};
use rayon::prelude::*;

use crate::Outcome;

/// The allocator of the `lamplight` command, for both sides.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const PROGRAM: &str = "forward";

const LANGUAGES: [Language; 2] = [Language::Wesl, Language::Glsl];

/// How often our run and the plain loop are repeated at most. The best time of each counts.
const ROUNDS: usize = 3;

/// How many shaders are compiled with a tool that must be started once for each.
const SAMPLE: usize = 40;

/// Prints every figure; the last line is the rate and the ratio.
pub fn run() -> Outcome {
    let (_, manifest) =
        project::library_manifest().map_err(|(_, diagnostics)| format!("{diagnostics:?}"))?;
    let program = manifest.program(PROGRAM).ok_or("the library has no such program")?;
    let points = program.space.enumerate();
    println!(
        "{PROGRAM}: {} permutations, {} targets, {} threads",
        points.len(),
        program.targets.len(),
        rayon::current_num_threads()
    );
    let mut ours = [Spent::MOST; 2];
    let mut theirs = [Spent::MOST; 2];
    for _ in 0..ROUNDS {
        for (index, language) in LANGUAGES.into_iter().enumerate() {
            let alone = only(&manifest, language)?;
            ours[index] = ours[index].least(spent(|| generated(&alone))?);
            theirs[index] = theirs[index].least(spent(|| plain(program, &points, language))?);
        }
    }
    for (index, language) in LANGUAGES.into_iter().enumerate() {
        println!("lamplight, {language:?}: {}", ours[index].summary(points.len()));
        println!("plain loop over naga, {language:?}: {}", theirs[index].summary(points.len()));
        println!("{language:?}: {:.1}x plain naga loop", theirs[index].wall_over(ours[index]));
    }
    let (ours, theirs) = (ours[0].and(ours[1]), theirs[0].and(theirs[1]));
    packed(&manifest)?;
    crate::load::run()?;
    tools(program, &points)?;
    // Processor time is shown too, since others may have used the machine.
    println!(
        "by processor time: {:.1}x plain naga loop",
        theirs.processors.as_secs_f64() / ours.processors.as_secs_f64()
    );
    // Each permutation counts once for each language.
    let rate = (LANGUAGES.len() * points.len()) as f64 / ours.wall.as_secs_f64();
    println!("gen: {rate:.0} permutations/s, {:.1}x plain naga loop", theirs.wall_over(ours));
    Ok(())
}

/// The time of a run. Where other programs use the machine too, processor time says more.
#[derive(Clone, Copy)]
struct Spent {
    wall: Duration,
    processors: Duration,
}

impl Spent {
    const MOST: Self = Self { wall: Duration::MAX, processors: Duration::MAX };

    fn least(self, other: Self) -> Self {
        Self { wall: self.wall.min(other.wall), processors: self.processors.min(other.processors) }
    }

    fn and(self, other: Self) -> Self {
        Self { wall: self.wall + other.wall, processors: self.processors + other.processors }
    }

    fn wall_over(self, other: Self) -> f64 {
        self.wall.as_secs_f64() / other.wall.as_secs_f64()
    }

    fn summary(self, permutations: usize) -> String {
        let rate = |elapsed: Duration| permutations as f64 / elapsed.as_secs_f64();
        format!(
            "{:.2} s, {:.0} permutations/s; {:.2} s of processor time, {:.0} permutations/s a core",
            self.wall.as_secs_f64(),
            rate(self.wall),
            self.processors.as_secs_f64(),
            rate(self.processors)
        )
    }
}

fn spent(work: impl FnOnce() -> Result<(), String>) -> Result<Spent, String> {
    let (start, before) = (Instant::now(), processors());
    work()?;
    Ok(Spent { wall: start.elapsed(), processors: processors() - before })
}

/// Processor time of all threads of this process. The kernel counts a hundred ticks a second.
fn processors() -> Duration {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = text.rsplit_once(')').map_or("", |(_, rest)| rest).split_whitespace();
    Duration::from_millis(
        10 * fields.skip(11).take(2).filter_map(|ticks| ticks.parse::<u64>().ok()).sum::<u64>(),
    )
}

/// The manifest with `forward` in one language.
fn only(manifest: &Manifest, language: Language) -> Result<Manifest, String> {
    let mut manifest = manifest.clone();
    manifest.programs.retain(|program| program.name == PROGRAM);
    let program = manifest.programs.first_mut().ok_or("the library has no such program")?;
    match language {
        Language::Wesl => program.glsl = None,
        Language::Glsl => program.wesl = None,
    }
    Ok(manifest)
}

fn generated(manifest: &Manifest) -> Result<(), String> {
    let request = Request { program: Some(PROGRAM.to_owned()), ..Request::default() };
    let generated = generate(
        &mut SourceSet::default(),
        &project::library_packages(),
        manifest,
        &request,
        &Tools {
            sink: &Discard::default(),
            cache: None,
            tool: "test",
            optimiser: None,
            progress: &|_| {},
        },
    );
    black_box(generated.map_err(|diagnostics| format!("{diagnostics:?}"))?);
    Ok(())
}

/// The size of the single file, compared with the raw outputs in it, each distinct one counted
/// once.
fn packed(manifest: &Manifest) -> Outcome {
    let request = Request { program: Some(PROGRAM.to_owned()), ..Request::default() };
    let generated = in_memory(
        &mut SourceSet::default(),
        &project::library_packages(),
        manifest,
        &request,
        &|_| {},
    );
    let generated = generated.map_err(|diagnostics| format!("{diagnostics:?}"))?;
    let raw: u64 = generated.summary.targets.iter().map(|target| target.bytes).sum();
    let start = Instant::now();
    let file = pack(&generated.contents)?.len();
    let (raw, file) = (raw as f64 / 1e6, file as f64 / 1e6);
    println!(
        "the single file: {file:.2} MB of {raw:.2} MB, {:.1} to one, {:.2} s",
        raw / file,
        start.elapsed().as_secs_f64()
    );
    Ok(())
}

/// Compiles every permutation separately. In WGSL one text has both entry points, in GLSL there is
/// a text for each. Each text becomes one module, and each entry point is written for each target.
fn plain(program: &Program, points: &[Assignment], language: Language) -> Result<(), String> {
    let graphs = graphs(program, language)?;
    let one = |point: &Assignment| {
        graphs.iter().map(|graph| permutation(graph, program, point)).sum::<Result<usize, String>>()
    };
    let bytes = on_large_stack(|| points.par_iter().map(one).sum::<Result<usize, String>>())?;
    black_box(bytes);
    Ok(())
}

/// The roots of a program: one in WESL, one for each stage in GLSL.
fn graphs(program: &Program, language: Language) -> Result<Vec<Graph>, String> {
    let glsl = program.glsl.iter().flat_map(|glsl| [&glsl.vertex, &glsl.fragment]).flatten();
    let roots: Vec<_> = match language {
        Language::Wesl => program.wesl.iter().collect(),
        Language::Glsl => glsl.collect(),
    };
    let load = |path: &str| {
        resolve::load(&mut SourceSet::default(), &project::library_packages(), path, language)
            .map_err(|diagnostics| format!("{diagnostics:?}"))
    };
    roots.into_iter().map(|root| load(&root.path)).collect()
}

fn graph(program: &Program) -> Result<Graph, String> {
    graphs(program, Language::Wesl)?.pop().ok_or_else(|| "the program has no WESL".to_owned())
}

fn composed(graph: &Graph, program: &Program, point: &Assignment) -> Result<Composed, String> {
    compose(graph, &program.space.settings(point), &Options::default())
        .map_err(|diagnostics| format!("{diagnostics:?}"))
}

fn parsed(composed: &Composed) -> Result<naga::Module, String> {
    match (composed.language, composed.stage) {
        (Language::Glsl, Some(stage)) => {
            let stage = match stage {
                Stage::Vertex => naga::ShaderStage::Vertex,
                Stage::Fragment => naga::ShaderStage::Fragment,
                Stage::Compute => naga::ShaderStage::Compute,
            };
            naga::front::glsl::Frontend::default()
                .parse(&naga::front::glsl::Options::from(stage), &composed.text)
                .map_err(|errors| format!("{errors:?}"))
        }
        _ => naga::front::wgsl::parse_str(&composed.text)
            .map_err(|error| error.emit_to_string(&composed.text)),
    }
}

fn permutation(graph: &Graph, program: &Program, point: &Assignment) -> Result<usize, String> {
    let composed = composed(graph, program, point)?;
    let module = parsed(&composed)?;
    let info = Validator::new(ValidationFlags::all(), CAPABILITIES)
        .validate(&module)
        .map_err(|error| error.to_string())?;
    let validated = Validated { module, info, portable: true };
    let entries = validated.module.entry_points.iter();
    let outputs = entries
        .flat_map(|entry| program.targets.iter().map(|target| (entry.name.as_str(), *target)));
    outputs
        .map(|(entry, target)| {
            Ok(emit(&validated, entry, target).map_err(|error| error.message)?.bytes.len())
        })
        .sum()
}

/// A compiler that must be started for each shader.
struct Tool {
    name: &'static str,
    /// What it does, so that figures are not compared with those of other work.
    does: &'static str,
    input: Target,
    extension: &'static str,
    arguments: &'static [&'static str],
}

const TOOLS: &[Tool] = &[
    Tool {
        name: "naga",
        does: "WGSL to SPIR-V; optimises nothing",
        input: Target::WGSL,
        extension: "wgsl",
        arguments: &["IN", "OUT.spv"],
    },
    Tool {
        name: "glslangValidator",
        does: "GLSL to SPIR-V; optimises nothing",
        input: Target::GLSL450,
        extension: "frag",
        arguments: &["-V", "--auto-map-locations", "--auto-map-bindings", "IN", "-o", "OUT.spv"],
    },
    Tool {
        name: "glslc",
        does: "GLSL to SPIR-V, optimised for speed (-O)",
        input: Target::GLSL450,
        extension: "frag",
        arguments: &["-O", "-fauto-map-locations", "-fauto-bind-uniforms", "IN", "-o", "OUT.spv"],
    },
    Tool {
        name: "slangc",
        does: "GLSL to SPIR-V; optimises by default",
        input: Target::GLSL450,
        extension: "frag",
        arguments: &[
            "-lang", "glsl", "-stage", "fragment", "-entry", "main", "-target", "spirv", "IN",
            "-o", "OUT.spv",
        ],
    },
    Tool {
        name: "matc",
        does: "its own material language only: started and timed without input",
        input: Target::WGSL,
        extension: "wgsl",
        arguments: &["--version"],
    },
];

/// Compiles the fragment shaders of some permutations with each tool that is installed.
fn tools(program: &Program, points: &[Assignment]) -> Outcome {
    let folder = std::env::temp_dir().join(format!("lamplight-bench-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let graph = graph(program)?;
    for tool in TOOLS {
        let line = match installed(tool) {
            true => measured(tool, &folder, &graph, program, points)?,
            false => "not installed".to_owned(),
        };
        println!("{}: {line} ({})", tool.name, tool.does);
    }
    Ok(std::fs::remove_dir_all(&folder)?)
}

fn installed(tool: &Tool) -> bool {
    Command::new(tool.name)
        .arg("--version")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok()
}

fn measured(
    tool: &Tool,
    folder: &std::path::Path,
    graph: &Graph,
    program: &Program,
    points: &[Assignment],
) -> Result<String, Box<dyn std::error::Error>> {
    let step = (points.len() / SAMPLE).max(1);
    let mut inputs = Vec::new();
    for (index, point) in points.iter().step_by(step).take(SAMPLE).enumerate() {
        let validated = lamplight::validate::validate(&composed(graph, program, point)?)
            .map_err(|diagnostics| format!("{diagnostics:?}"))?;
        let emitted = emit(&validated, "fs_main", tool.input).map_err(|error| error.message)?;
        let path = folder.join(format!("{}-{index}.{}", tool.name, tool.extension));
        std::fs::write(&path, emitted.bytes)?;
        inputs.push(path);
    }
    let start = Instant::now();
    let accepted = inputs.par_iter().filter(|input| started(tool, input)).count();
    let rate = inputs.len() as f64 / start.elapsed().as_secs_f64();
    Ok(format!("{rate:.0} shaders/s to one target, {accepted} of {} accepted", inputs.len()))
}

fn started(tool: &Tool, input: &std::path::Path) -> bool {
    let output = input.with_extension("spv");
    let arguments = tool.arguments.iter().map(|argument| match *argument {
        "IN" => input.as_os_str().to_owned(),
        "OUT.spv" => output.as_os_str().to_owned(),
        other => other.into(),
    });
    let status = Command::new(tool.name)
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    status.is_ok_and(|status| status.success())
}

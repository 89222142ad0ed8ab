//! Draws permutations of `forward`, and of programs that are drawn over the screen, on each driver,
//! and computes a sample of the fragments again with the evaluator. Tests named `shipped` draw the
//! WGSL of a bundle, which was linked from functions of many permutations. Their fragments too are
//! computed from the composed text.

mod given;
mod shipped;
mod whole;

use std::collections::BTreeMap;
use std::sync::Arc;

use lamplight::LIBRARY_FILES;
use lamplight::bundle::{
    BindingKind, Bundle, Language, Reflection, SpirvForm, Target, pack as pack_bundle,
};
use lamplight::diagnostic::render::{Form, render};
use lamplight::execute::fixture::Fixture;
use lamplight::execute::frame::{
    Buffers, DrawItem, Drawing, EntryPoint, Mesh, PipelineState, VertexAttribute, VertexFormat,
};
use lamplight::execute::{Session, executors, on_thread};
use lamplight::generate::{MemorySink, Request, Tools, generate};
use lamplight::permute::axis::ValueSet;
use lamplight::permute::space::{Slice, SliceLists};
use lamplight::permute::{Assignment, Space, cover};
use lamplight::picture::frame::{Programs, ReadyStage, Stages, pack_buffer, probe};
use lamplight::project;
use lamplight::spirv_opt::SpirvOpt;
use lamplight::validate::{Validated, validate};
use libtest_mimic::{Failed, Trial};

use crate::fragments::{self, Tally, Watched};
use crate::is_whole;
use crate::metal::scrambled;
pub use given::fixture;
use given::number;
pub use shipped::most_points;

/// The size of a frame in pixels.
const WIDTH: u32 = 256;
const HEIGHT: u32 = 64;
/// Every 29th quad is computed again.
const STEP: usize = 29;
/// The least number of fragments of a permutation that must be compared.
const LEAST: usize = 200;
/// The largest share of a permutation's fragments that may be open (see [`crate::fragments`]).
/// Values from textures have wider error bounds, so `deferred`, which reads its surface from
/// textures, has more open fragments.
pub fn most_open(program: &str) -> f64 {
    if program == "deferred" { 0.03 } else { 0.01 }
}

/// Its permutations are listings that have little in common, so that covering all values takes all of
/// them. By day, every seventh is drawn; `render` and `published` draw pictures of all.
pub const LISTINGS: &str = "published";
const STEP_OF_LISTINGS: usize = 7;

const BACKENDS: [&str; 2] = ["vulkan", "gl"];
const LANGUAGES: [(&str, Language); 3] =
    [("wesl", Language::Wesl), ("glsl", Language::Glsl), (SHIPPED, Language::Wesl)];
const SHIPPED: &str = "shipped";

type Place = (u32, u32);

/// The programs whose frames are compared.
pub const PROGRAMS: [&str; 7] =
    ["forward", "tonemap", "prefilter", "gbuffer", "deferred", "contact_shadows", "published"];

/// Both languages on both backends, if the environment asks for more than a few permutations. Else
/// GLSL is drawn on one backend, and the outputs in bundles are left to `frames/shipped`, which draws
/// them of every target.
fn is_drawn(language: &str, backend: &str) -> bool {
    let whole = std::env::var_os(shipped::PERMUTATIONS).is_some();
    whole || language == "wesl" || (language, backend) == ("glsl", "gl")
}

pub fn tests() -> Vec<Trial> {
    let pairs = || LANGUAGES.iter().flat_map(|one| BACKENDS.iter().map(move |on| (one, *on)));
    let on = |program: &'static str| {
        pairs().filter(|(language, backend)| is_drawn(language.0, backend)).map(
            move |(language, backend)| {
                Trial::test(format!("frames/{program}/{}/{backend}", language.0), move || {
                    run(program, language, backend)
                })
            },
        )
    };
    PROGRAMS.into_iter().flat_map(on).chain(shipped::tests()).chain(whole::tests()).collect()
}

fn run(
    program: &'static str,
    (name, language): &(&str, Language),
    backend: &'static str,
) -> Result<(), Failed> {
    let outcome = on_thread(|| {
        let renderer = executors::find_executor(backend).ok_or("no such executor")?.start()?;
        let mut sources = Sources::load(program, *language)?;
        let mut points = covering(&sources.space);
        if program == LISTINGS && !is_whole() {
            points = points.into_iter().step_by(STEP_OF_LISTINGS).collect();
        }
        if *name == SHIPPED {
            sources.bundle = Some(bundle(&sources, &points, &[Target::WGSL])?);
        }
        let (mut total, mut failures) = (Tally::default(), Vec::new());
        for point in &points {
            let key = sources.space.key(point).to_string();
            let most = most_open(program);
            let scene = sources.scene(point);
            match scene.and_then(|scene| agrees(renderer.as_ref(), &scene, most)) {
                Ok(tally) => total.add(&tally),
                Err(error) => failures.push(format!("[{key}] {error}")),
            }
        }
        println!("{program}, {name} on {backend}: {} permutations, {total}", points.len());
        if failures.is_empty() { Ok(()) } else { Err(failures.join("\n")) }
    });
    outcome.ok_or("panicked")?.map_err(Failed::from)
}

/// The default permutation, and more until every value of every axis is in one of them.
pub fn covering(space: &Space) -> Vec<Assignment> {
    let mut missing = space.valid_values();
    let mut points = Vec::new();
    let mut next = Some(space.default_assignment());
    while let Some(point) = next {
        let seen = |axis: usize| ValueSet::single(point.ordinal(axis));
        missing
            .iter_mut()
            .enumerate()
            .for_each(|(axis, values)| *values = values.without(seen(axis)));
        points.push(point);
        let pin = missing
            .iter()
            .enumerate()
            .find_map(|(axis, values)| Some((axis, values.iter().next()?)));
        // The other axes take a value that is missing too, or else each value in turn.
        let turn = points.len();
        let choose = |axis: usize, allowed: ValueSet| {
            let new = missing[axis].and(allowed).iter().next();
            new.or_else(|| allowed.iter().nth(turn % allowed.len())).unwrap_or_default()
        };
        next = pin.and_then(|pin| space.pick_valid(&[pin], choose));
    }
    points.retain(|point| is_comparable(space, point));
    points
}

/// Whether drivers promise some digits of a permutation: not of the listing that takes its noise from
/// a large sine. `published::hpg_6_pcf_random` compares what does not depend on it.
fn is_comparable(space: &Space, point: &Assignment) -> bool {
    space.key(point).to_string() != "example=hpg_6_random"
}

/// How many random permutations are tried for each that is wanted.
const TRIES: usize = 8;

/// Permutations that cover all pairs of values, and random ones until there are `least`, or until
/// most of the space is among them.
pub fn points(space: &Space, least: usize) -> Vec<Assignment> {
    let mut points = cover::pairwise(space).points;
    let mut seed = 1;
    // A small space has fewer, so that most of the tries give a permutation again.
    for _ in 0..TRIES * least {
        if points.len() >= least {
            break;
        }
        let choose = |axis: usize, allowed: ValueSet| {
            seed += 1;
            let turn = scrambled(seed + axis as u32) as usize % allowed.len();
            allowed.iter().nth(turn).unwrap_or_default()
        };
        match space.pick_valid(&[], choose) {
            Some(point) if !points.contains(&point) => points.push(point),
            Some(_) => {}
            None => break,
        }
    }
    points.retain(|point| is_comparable(space, point));
    points
}

/// The library's programs, in one language.
pub struct Sources {
    programs: Programs,
    pub program: &'static str,
    language: Language,
    pub space: Space,
    /// The bundle whose outputs are drawn; without one, the composed texts are drawn.
    bundle: Option<Bundle>,
}

/// A permutation, with everything that is needed to draw it.
pub struct Scene {
    pub vertex: ReadyStage,
    pub fragment: ReadyStage,
    /// The modules that are drawn, of both stages.
    drawn: [Arc<Validated>; 2],
    pub mesh: Mesh,
    pub buffers: Buffers,
    pub fixtures: BTreeMap<Place, Arc<Fixture>>,
}

impl Sources {
    pub fn load(program: &'static str, language: Language) -> Result<Self, String> {
        let programs = Programs::load(LIBRARY_FILES)
            .map_err(|(sources, problems)| render(&sources, &problems, Form::Human))?;
        let space = programs.manifest().program(program).ok_or("no such program")?.space.clone();
        Ok(Self { programs, program, language, space, bundle: None })
    }

    pub fn scene(&self, point: &Assignment) -> Result<Scene, String> {
        let program = self.programs.manifest().program(self.program).ok_or("no such program")?;
        let stages = self.programs.stages(program, &self.space.settings(point), self.language);
        let Stages { vertex, fragment } =
            stages.map_err(|problems| render(&self.programs.texts(), &problems, Form::Human))?;
        let fragment = fragment.ok_or("no fragment stage")?;
        let key = self.space.key(point).to_string();
        let (mut buffers, mut fixtures) = (Buffers::new(), BTreeMap::new());
        for binding in vertex.reflection.bindings.iter().chain(&fragment.reflection.bindings) {
            let place = (binding.group, binding.binding);
            match binding.kind {
                BindingKind::Uniform => {
                    let bytes = pack_buffer(binding, &|path| Some(number(path)));
                    buffers.insert(place, bytes.map_err(|problem| problem.message)?);
                }
                _ => {
                    let made = fixture(binding.kind, &binding.name, &binding.ty, &key);
                    fixtures.insert(place, Arc::new(made));
                }
            }
        }
        let drawn = match &self.bundle {
            None => [vertex.validated.clone(), fragment.validated.clone()],
            Some(bundle) => {
                let stage = |entry| shipped(bundle, self.program, entry, &key);
                [stage(vertex.entry)?, stage(fragment.entry)?]
            }
        };
        Ok(Scene { mesh: mesh(&vertex.reflection), vertex, fragment, drawn, buffers, fixtures })
    }
}

/// A bundle with some targets of `points`, and of permutations that cover all pairs of values.
pub fn bundle(
    sources: &Sources,
    points: &[Assignment],
    targets: &[Target],
) -> Result<Bundle, String> {
    let mut include = cover::pairwise(&sources.space).points;
    include.extend(
        points.iter().filter(|point| !include.contains(point)).cloned().collect::<Vec<_>>(),
    );
    bundle_of(sources, include, targets, SpirvForm::Names)
}

/// A bundle with some targets of permutations, in a form of SPIR-V.
pub fn bundle_of(
    sources: &Sources,
    include: Vec<Assignment>,
    targets: &[Target],
    form: SpirvForm,
) -> Result<Bundle, String> {
    let mut manifest = sources.programs.manifest().clone();
    let program = manifest
        .programs
        .iter_mut()
        .find(|program| program.name == sources.program)
        .ok_or("no such program")?;
    program.targets = targets.to_vec();
    program.conventions.spirv = form;
    match sources.language {
        Language::Wesl => program.glsl = None,
        Language::Glsl => program.wesl = None,
    }
    let all = sources.space.axes().iter().map(|axis| ValueSet::full(axis.values.len())).collect();
    let exclude = vec![Slice { values: all, span: program.span }];
    let lists = SliceLists { only: Vec::new(), exclude, include };
    program.space =
        Space::new(sources.space.axes().to_vec(), sources.space.constraints().to_vec(), lists)
            .map_err(|_| "no space")?;
    program.space.undeclared = sources.space.undeclared;
    let request = Request { program: Some(sources.program.to_owned()), ..Request::default() };
    let mut texts = sources.programs.texts();
    let sink = MemorySink::default();
    let tools = Tools {
        sink: &sink,
        cache: None,
        tool: "test",
        optimiser: Some(&SpirvOpt),
        progress: &|_| (),
    };
    let packages = project::library_packages();
    let mut made = generate(&mut texts, &packages, &manifest, &request, &tools)
        .map_err(|problems| render(&texts, &problems, Form::Human))?;
    sink.fill(&mut made.contents);
    if let Some(whole) = made.summary.whole.first() {
        return Err(format!("expected every text to be linked; as a whole: {whole:?}"));
    }
    Bundle::from_bytes(pack_bundle(&made.contents).map_err(|error| error.to_string())?)
        .map_err(|error| error.to_string())
}

/// One stage, from the WGSL in the bundle.
fn shipped(
    bundle: &Bundle,
    program: &str,
    entry: &str,
    key: &str,
) -> Result<Arc<Validated>, String> {
    let found = || bundle.program(program)?.entry(Language::Wesl, entry)?.get(key, Target::WGSL);
    let found = found().map_err(|error: lamplight::bundle::Error| error.to_string())?;
    let text = String::from_utf8(found.bytes.to_vec()).map_err(|error| error.to_string())?;
    let composed = lamplight::compose::Composed::of_text(Language::Wesl, None, text);
    validate(&composed).map(Arc::new).map_err(|problems| format!("{problems:?}"))
}

/// A bumpy sheet of 8 x 8 squares in front of the viewer, from -1 to 1.
fn mesh(vertex: &Reflection) -> Mesh {
    let mut attributes = Vec::new();
    for input in &vertex.inputs {
        let Some(location) = input.location else { continue };
        let format = match input.ty.as_str() {
            "u32" => VertexFormat::Uint32,
            ty if ty.starts_with("vec2") => VertexFormat::Float32x2,
            ty if ty.starts_with("vec3") => VertexFormat::Float32x3,
            _ => VertexFormat::Float32x4,
        };
        attributes.push(VertexAttribute { location, format });
    }
    let corner = |x: u32, y: u32| {
        let (u, v) = (f64::from(x) / 8.0, f64::from(y) / 8.0);
        let (px, py) = (2.0 * u - 1.0, 2.0 * v - 1.0);
        let bump = 0.3 * (3.0 * px).sin() * (2.0 * py).cos();
        let attribute = |attribute: &VertexAttribute| -> Vec<u32> {
            let values = match attribute.location {
                0 => vec![px, py, bump],
                1 => vec![
                    -0.9 * (3.0 * px).cos() * (2.0 * py).cos(),
                    0.6 * (3.0 * px).sin() * (2.0 * py).sin(),
                    1.0,
                ],
                2 => vec![0.9, 0.5 + 0.4 * u, 0.9 - 0.4 * v, 1.0],
                5 => vec![1.0, 0.0, 0.9 * (3.0 * px).cos(), 1.0],
                6 => return vec![x % 3],
                _ => vec![0.1 + 0.8 * u, 0.1 + 0.8 * v],
            };
            values.iter().map(|value| (*value as f32).to_bits()).collect()
        };
        attributes.iter().flat_map(attribute).collect::<Vec<u32>>()
    };
    let squares = (0..64).flat_map(|square| {
        [(0, 0), (1, 0), (0, 1), (0, 1), (1, 0), (1, 1)]
            .map(|(x, y)| (square % 8 + x, square / 8 + y))
    });
    let words = squares.flat_map(|(x, y)| corner(x, y)).collect();
    Mesh { attributes, words, indices: Vec::new() }
}

fn agrees(renderer: &dyn Session, scene: &Scene, most: f64) -> Result<Tally, String> {
    let Scene { vertex, fragment, drawn: [drawn_vertex, drawn_fragment], mesh, buffers, .. } =
        scene;
    let watched = probe::watch_entry(&drawn_fragment.module, fragment.entry).ok_or("no colour")?;
    let vertex = EntryPoint { module: &drawn_vertex.module, entry: vertex.entry };
    let point = EntryPoint { module: &watched.module, entry: fragment.entry };
    let items = [DrawItem { mesh, buffers }];
    let drawing = Drawing {
        targets: watched.targets,
        // As engines draw. It hides nothing, since there is one layer. llvmpipe compiles a shader
        // once for it, and twice without.
        state: PipelineState { depth_test: true, ..PipelineState::default() },
        ..Drawing::of_items([vertex, point], &items, &scene.fixtures, [WIDTH, HEIGHT])
    };
    let frame = renderer.draw_frames(&drawing).map_err(|problem| problem.message)?.remove(0);
    let mut tally = Tally {
        detours: frame.detour.map(|detour| (detour, 1)).into_iter().collect(),
        ..Tally::default()
    };
    let resources = fragments::resources(buffers.clone(), &scene.fixtures, &BTreeMap::new());
    let watched = Watched { size: [WIDTH, HEIGHT], targets: &frame.targets };
    fragments::recompute(fragment, resources, &watched, STEP, &mut tally)?;
    tally.checked(LEAST, most)
}

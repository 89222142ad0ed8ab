//! Pictures. Every preset, drawn on each driver, looks like its reviewed picture, and a sample of its
//! fragments has the colours that the evaluator computes. Whole frames are compared with closed
//! forms.

mod accounted;
mod cascades;
mod closed_forms;
mod clustered;
mod command;
mod compared;
mod deferred;
mod difference;
mod frames;
mod models;
mod needs;
mod occlusion;
mod pages;
mod prefiltered;
mod probes;
mod shadows;

use std::path::PathBuf;
use std::sync::OnceLock;

use glam::DVec3;
use lamplight::LIBRARY_FILES;
use lamplight::bundle::Language;
use lamplight::catalogue::preset::{self, Preset};
use lamplight::catalogue::probe::{self, Probe};
use lamplight::diagnostic::Diagnostics;
use lamplight::diagnostic::render::{Form, render};
use lamplight::execute::frame::{Buffers, EntryPoint};
use lamplight::execute::{Session, executors, on_thread};
use lamplight::picture::frame::{Programs, probe as watch};
use lamplight::picture::{Linear, Picture, Plan, PreparedPass, Shot, Surroundings, prepare_passes};
use libtest_mimic::{Failed, Trial};

use crate::fragments::{self, Tally, Watched};
use crate::is_whole;
pub use pages::gallery_cards;

/// The drivers. Each draws in another language, so that both languages are drawn. By day, a preset is
/// drawn by one of them, in turn.
const BACKENDS: [(&str, Language); 2] = [("vulkan", Language::Wesl), ("gl", Language::Glsl)];
/// The folder of the reviewed pictures. They are small, so that drawing them is quick.
const REVIEWED: &str = "tests/render/reviewed";
const SIZE: [u32; 2] = [160, 120];
const SAMPLES: u32 = 4;
/// The size of the frames whose fragments are computed again.
const SMALL: [u32; 2] = [96, 96];
/// About how many quads of each frame are computed again.
const QUADS: usize = 130;
/// The least number of fragments that must be compared.
const LEAST: usize = 500;
/// The largest share of fragments that may be open (see [`crate::fragments`]).
const OPEN: f64 = 0.05;

pub fn tests() -> Vec<Trial> {
    let library = library();
    let on_each = |(index, preset): (usize, &'static Preset)| {
        let backends = BACKENDS.into_iter().enumerate();
        let drawn = backends.filter(move |(turn, _)| is_whole() || index % BACKENDS.len() == *turn);
        drawn.map(move |(_, (backend, language))| {
            Trial::test(format!("render/{}/{backend}", preset.name), move || {
                on_device(backend, |painter| shown(painter, preset, language, backend))
            })
        })
    };
    let presets = library.presets.iter().enumerate().flat_map(on_each);
    let forms = closed_forms::FORMS
        .iter()
        .chain(shadows::FORMS)
        .chain(cascades::FORMS)
        .chain(probes::FORMS);
    let forms = forms.flat_map(|(name, form)| {
        BACKENDS.map(|(backend, language)| {
            Trial::test(format!("render/{name}/{backend}"), move || {
                on_device(backend, |painter| form(&frames::Bench { painter, language }))
            })
        })
    });
    presets
        .chain(forms)
        .chain(accounted::tests())
        .chain(clustered::tests())
        .chain(compared::tests())
        .chain(deferred::tests())
        .chain(occlusion::tests())
        .chain(prefiltered::tests())
        .chain(pages::tests())
        .chain(command::tests())
        .chain(models::tests())
        .chain(needs::tests())
        .collect()
}

/// The library's programs and presets, read once.
pub struct Library {
    pub programs: Programs,
    pub presets: Vec<Preset>,
    pub probes: Vec<Probe>,
}

pub fn library() -> &'static Library {
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    LIBRARY.get_or_init(|| {
        let programs = Programs::load(LIBRARY_FILES)
            .map_err(|(texts, problems)| render(&texts, &problems, Form::Human))
            .unwrap();
        let probes =
            programs.with_texts(|texts| probe::library_probes(LIBRARY_FILES, texts)).unwrap();
        let presets = programs
            .with_texts(|texts| {
                preset::library_presets(LIBRARY_FILES, texts, programs.manifest(), &probes)
            })
            .unwrap();
        Library { programs, presets, probes }
    })
}

/// Runs a test with an executor, on a thread of its own. Drivers drop their state when it ends.
pub fn on_device(
    name: &str,
    run: impl FnOnce(&dyn Session) -> Result<(), String> + Send,
) -> Result<(), Failed> {
    let outcome = on_thread(|| run(start(name)?.as_ref()));
    outcome.ok_or("panicked")?.map_err(Failed::from)
}

/// Opens an executor by name.
pub fn start(name: &str) -> Result<Box<dyn Session>, String> {
    executors::find_executor(name).ok_or("no such executor")?.start()
}

/// A pixel, and its colours in two pictures.
type Compared = ([u32; 2], [DVec3; 2]);

/// The pixels where two pictures show a surface. Where only one of them does, they differ.
fn surface_pixels(
    found: &Linear,
    wanted: &Linear,
    [width, height]: [u32; 2],
) -> Result<Vec<Compared>, String> {
    let places = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let both = |[x, y]: [u32; 2]| match (found.drawn(x, y), wanted.drawn(x, y)) {
        (Some(found), Some(wanted)) => Some(Ok(([x, y], [found, wanted]))),
        (None, None) => None,
        _ => Some(Err(format!("only one of them shows a surface at {x}, {y}"))),
    };
    places.filter_map(both).collect()
}

/// The colours of a permutation of a program, neither clamped nor encoded.
fn linear_picture(
    painter: &dyn Session,
    language: Language,
    (program, key): (&str, &str),
    scene: &str,
    size: [u32; 2],
) -> Result<Linear, String> {
    let mut plan = Plan::of_key(&library().programs, program, key).map_err(rendered)?;
    plan.scene = scene.to_owned();
    linear_plan(painter, language, &plan, size)
}

/// The colours of a plan, before they become those of a picture.
fn linear_plan(
    painter: &dyn Session,
    language: Language,
    plan: &Plan,
    size: [u32; 2],
) -> Result<Linear, String> {
    let shot = shot(size, 1, language);
    let prepared = prepare_passes(painter, &library().programs, plan, &shot).map_err(rendered)?;
    prepared.photograph(painter, &shot).map_err(rendered)
}

pub fn shot(size: [u32; 2], samples: u32, language: Language) -> Shot {
    Shot { size, samples, exposure: 0.0, cascades: 1, language, surroundings: Surroundings::Usual }
}

pub fn rendered(problems: Diagnostics) -> String {
    render(&library().programs.texts(), &problems, Form::Short)
}

pub fn plan(preset: &Preset) -> Result<Plan, String> {
    Plan::of_preset(&library().programs, preset, &library().probes).map_err(rendered)
}

/// A preset looks like its reviewed picture, and its fragments have the evaluator's colours.
fn shown(
    painter: &dyn Session,
    preset: &Preset,
    language: Language,
    backend: &str,
) -> Result<(), String> {
    let plan = plan(preset)?;
    let shot = shot(SIZE, SAMPLES, language);
    let picture = lamplight::picture::render_plan(painter, &library().programs, &plan, &shot)
        .map_err(rendered)?;
    difference::reviewed(&picture, &preset.name, backend)?;
    // WGSL promises no accuracy for the angles of `gtao`. `frames/shipped/gtao` compares whole frames.
    if preset.program == "gtao" {
        println!("{} on {backend}: its fragments are those of frames/shipped/gtao", preset.name);
        return Ok(());
    }
    // The listing takes its noise from a large sine, of which no driver promises a digit.
    // `published::hpg_6_pcf_random` compares what does not depend on it.
    if preset.key == "example=hpg_6_random" {
        println!("{} on {backend}: its noise is another one on each driver", preset.name);
        return Ok(());
    }
    let tally = recomputed(painter, &plan, language)?;
    println!("{} on {backend}: {tally}", preset.name);
    Ok(())
}

/// Computes a sample of the fragments again, of the objects of one material after the other, until
/// there are enough.
fn recomputed(painter: &dyn Session, plan: &Plan, language: Language) -> Result<Tally, String> {
    let small = shot(SMALL, 1, language);
    let mut prepared =
        prepare_passes(painter, &library().programs, plan, &small).map_err(rendered)?;
    // Drivers may choose how they blend two mip levels, so the textures have only one here.
    prepared.levels.clear();
    let (items, own) = (prepared.items.clone(), fragment_buffers(&prepared));
    let mut tally = Tally::default();
    for (index, material) in own.iter().enumerate() {
        if tally.tried >= LEAST || own[..index].contains(material) {
            continue;
        }
        let of_material = items.iter().zip(&own).filter(|(_, buffers)| *buffers == material);
        prepared.items = of_material.map(|(item, _)| item.clone()).collect();
        recomputed_of(painter, &prepared, material, &mut tally)?;
    }
    match tally {
        Tally { tried, .. } if tried < LEAST => {
            Err(format!("{tried} fragments were compared, expected at least {LEAST}"))
        }
        Tally { tried, open, .. } if open as f64 > OPEN * tried as f64 => {
            Err(format!("{open} of {tried} fragments are open, at most {OPEN} of them may be"))
        }
        tally => Ok(tally),
    }
}

/// Computes a sample of the fragments of a frame again. Its objects share the material's buffers.
fn recomputed_of(
    painter: &dyn Session,
    prepared: &PreparedPass,
    material: &Buffers,
    tally: &mut Tally,
) -> Result<(), String> {
    let frame = watched(painter, prepared, SMALL)?;
    let stage = prepared.stages.fragment.as_ref().ok_or("no fragment stage")?;
    let mut buffers = prepared.buffers.clone();
    let view = prepared.eye_view([0.0; 2], SMALL).map_err(|problem| problem.message)?;
    buffers.extend(view);
    buffers.extend(material.clone());
    let resources = fragments::resources(buffers, &prepared.fixtures, &prepared.levels);
    let watched = Watched { size: SMALL, targets: &frame };
    let step = (watched.whole_quads() / QUADS).max(1);
    fragments::recompute(stage, resources, &watched, step, tally)
}

/// The buffers of each object that the fragment stage reads.
fn fragment_buffers(prepared: &PreparedPass) -> Vec<Buffers> {
    let bindings = prepared.stages.fragment.iter().flat_map(|stage| &stage.reflection.bindings);
    let used: Vec<_> = bindings.map(|binding| (binding.group, binding.binding)).collect();
    let of = |buffers: &Buffers| {
        buffers
            .iter()
            .filter(|(place, _)| used.contains(place))
            .map(|(p, b)| (*p, b.clone()))
            .collect()
    };
    prepared.items.iter().map(|(_, buffers)| of(buffers)).collect()
}

/// The targets of one frame: the colours, then the inputs of each fragment.
pub fn watched(
    painter: &dyn Session,
    prepared: &PreparedPass,
    size: [u32; 2],
) -> Result<Vec<Vec<u32>>, String> {
    let stage = prepared.stages.fragment.as_ref().ok_or("no fragment stage")?;
    let watched = watch::watch_entry(&stage.validated.module, stage.entry).ok_or("no colour")?;
    let views = [prepared.eye_view([0.0; 2], size).map_err(|problem| problem.message)?];
    let fragment = EntryPoint { module: &watched.module, entry: stage.entry };
    let frames = prepared
        .draw(painter, &views, size, Some((fragment, watched.targets)))
        .map_err(rendered)?;
    Ok(frames.into_iter().next().ok_or("no frame")?.targets)
}

/// The path of a preset's reviewed picture.
pub fn reviewed_path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(REVIEWED).join(format!("{name}.png"))
}

/// Reads a picture.
pub fn read(path: &std::path::Path) -> Result<Picture, String> {
    let bytes = std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
    Picture::from_png(&bytes).map_err(|error| format!("{}: {error}", path.display()))
}

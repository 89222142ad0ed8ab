//! `lamplight render`: pictures.

mod gallery;
mod heat;
mod model;
mod own;
mod several;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use clap::Args;

use super::executor;
use super::failure::{DiagnosticForm, Failure};
use super::input::InputArguments;
use super::overwrite::Overwrite;
use super::terminal::{self, stdout};
use crate::LIBRARY_FILES;
use crate::bundle::Language;
use crate::catalogue::preset::{self, Preset};
use crate::catalogue::probe;
use crate::diagnostic::{Diagnostics, nearest_name, stopped_message};
use crate::execute::executors::ExecutorEntry;
use crate::execute::on_thread;
use crate::limits::ENVIRONMENT_BYTES;
use crate::model::View;
use crate::output;
use crate::permute::manifest::Program;
use crate::permute::{Assignment, Quoted, key};
use crate::picture::beside;
use crate::picture::frame::Programs;
use crate::picture::gallery::SAMPLES;
use crate::picture::strip::{self, Comparison};
use crate::picture::{self, Picture, PictureFragment, Plan, Shot, Surroundings, is_own_png};
use crate::scene::{ENVIRONMENTS, Equirect, sets};
use crate::source::SourceSet;

/// Draw a shader of your own, a preset, a permutation or your own model.
#[derive(Args, Clone)]
pub struct Arguments {
    /// A shader of your own, in WESL, WGSL or GLSL; or a preset: one published example (`lamplight
    /// list presets`); or a comparison, such as `shadow_filters`.
    #[arg(value_name = "FILE|PRESET")]
    preset: Option<String>,
    /// The program that draws the picture [default: that of the preset, or `forward`].
    #[arg(long, value_name = "NAME")]
    program: Option<String>,
    /// The scene (`lamplight list scenes`) [default: the scene of the preset, or `casters`].
    #[arg(long, value_name = "NAME")]
    scene: Option<String>,
    /// Draw this model instead of a scene: a glTF file (`.glb`, or `.gltf` with the files beside it).
    /// A shader of your own is also drawn on `sphere`, `torus`, `cube`, `vase`, `plane`, or a scene.
    #[arg(long, value_name = "FILE|NAME", conflicts_with_all = ["scene", "all"])]
    model: Option<PathBuf>,
    /// The view of the model: the number of one of its cameras, or the positions of the eye and of
    /// the point that it looks at [default: its first camera, or a position that shows all of it].
    #[arg(long, value_name = "N|X,Y,Z,X,Y,Z", value_parser = model::parse_view,
        allow_hyphen_values = true)]
    camera: Option<View>,
    /// Draw every preset, with pages that show them.
    #[arg(long, conflicts_with_all = ["preset", "set", "program", "scene", "cascades"])]
    all: bool,
    /// Draw every comparison.
    #[arg(long, conflicts_with_all = ["preset", "set", "program", "scene", "cascades", "all"])]
    comparisons: bool,
    /// Draw a listing as it is printed, beside its safe form and the difference of the two.
    #[arg(long, requires = "preset", conflicts_with_all = ["set", "program", "scene", "model", "camera",
        "all", "comparisons", "cascades"])]
    beside: bool,
    /// The file of the picture [default: the name of the preset or the shader, or `render.png`];
    /// with `--all` and `--comparisons`, a folder [default: `gallery`].
    #[arg(short, long = "out", alias = "output", value_name = "FILE")]
    output: Option<PathBuf>,
    /// Width and height in pixels [default: 512x512; 960x720 with `--all` or `--comparisons`].
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<[u32; 2]>,
    /// Samples of each pixel, which are averaged [default: 4; 16 with `--all` or `--comparisons`; 1
    /// on `eval`]. A picture that reads earlier passes of the viewer has at most nine: all passes
    /// are drawn finer.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=64))]
    samples: Option<u32>,
    /// Exposure in stops: each stop doubles all light.
    #[arg(long, value_name = "STOPS", default_value_t = 0.0, value_parser = parse_stops,
        allow_negative_numbers = true)]
    exposure: f64,
    /// The number of cascades, the shadow maps of a directional light.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=8))]
    cascades: u32,
    /// The executor that draws; `eval` needs no driver [default: `vulkan`; where there is none, a
    /// shader of your own is drawn by `eval`].
    #[arg(long, value_name = "E")]
    pub executor: Option<String>,
    /// The environment: `studio`, `daylight`, `dusk`, `parlour`, `checks`, `constant`, or a
    /// Radiance file (`.hdr`) [default: that of the scene, else `studio`].
    #[arg(long, value_name = "NAME|FILE")]
    environment: Option<String>,
    /// Show a number of each pixel, with a scale, in the place of its colour: `nan`, `error` (the bound
    /// that WGSL allows), `iterations` of loops, `cost` in steps of `eval`, `branches`, or the last
    /// value of a variable such as `n` or `n.x`.
    #[arg(long, value_name = "WHAT", conflicts_with_all = ["all", "comparisons", "beside", "samples",
        "exposure"])]
    show: Option<String>,
    #[command(flatten)]
    overwrite: Overwrite,
    #[command(flatten)]
    own: own::OwnArguments,
    #[command(flatten, next_help_heading = "How sources are read")]
    input: InputArguments,
}

/// A picture that is ready to be drawn, of which one fragment is looked at.
pub struct ReadyFragments {
    /// The fragments of the pixel, the visible one first.
    pub fragments: Vec<PictureFragment>,
    /// The texts that the picture is made of.
    pub sources: SourceSet,
}

/// The fragments of a pixel of the picture that `render` draws with the same arguments.
pub fn fragments_at(
    arguments: &Arguments,
    pixel: [u32; 2],
    form: DiagnosticForm,
) -> Result<ReadyFragments, Failure> {
    let entry = executor::find_drawing(arguments.executor.as_deref().unwrap_or("eval"))?;
    let shot = make_shot(arguments, entry)?;
    if let Some(file) = own::own_file(arguments) {
        let (ready, sources) = own::prepare_file(arguments, file, &shot, form)?;
        let found = ready.prepared.fragments_at(pixel, &ready.shot);
        return match found {
            Ok(fragments) => Ok(ReadyFragments { fragments, sources }),
            Err(errors) => Err(Failure::Input(sources, errors)),
        };
    }
    refuse_own(arguments)?;
    let programs = Programs::outline(LIBRARY_FILES)
        .map_err(|(sources, problems)| Failure::Input(sources, problems))?;
    let plan = make_plan(&programs, arguments)?;
    let painter = executor::open_executor(entry)?;
    let prepared = picture::prepare_passes(painter.as_ref(), &programs, &plan, &shot);
    let found = prepared.and_then(|prepared| prepared.fragments_at(pixel, &shot));
    let fragments = found.map_err(|problems| input_failure(&programs, problems))?;
    Ok(ReadyFragments { fragments, sources: programs.texts() })
}

impl Arguments {
    /// The file, the preset, or what else is named.
    pub fn subject(&self) -> Option<&str> {
        self.preset.as_deref()
    }

    /// The root directory of the user's package, if it is given.
    pub fn root(&self) -> Option<PathBuf> {
        self.input.root().map(Path::to_owned)
    }

    /// An option that was given and is about files of pictures.
    pub fn option_about_files(&self) -> Option<&'static str> {
        let given = [
            (self.all, "--all"),
            (self.comparisons, "--comparisons"),
            (self.beside, "--beside"),
            (self.show.is_some(), "--show"),
            (self.output.is_some(), "--out"),
            (self.samples.is_some(), "--samples"),
            (self.overwrite.replace() == output::Replace::Any, "--force"),
            (self.own.watch, "--watch"),
            (self.own.terminal.is_some(), "--terminal"),
        ];
        given.into_iter().find(|(is_given, _)| *is_given).map(|(_, name)| name)
    }

    /// Whether what is printed is for a program.
    pub fn is_json(&self) -> bool {
        self.own.json
    }
}

/// The executor that draws where nothing else is asked for.
pub const EXECUTOR: &str = "vulkan";

fn chosen_executor(arguments: &Arguments) -> Result<&'static ExecutorEntry, Failure> {
    executor::find_drawing(arguments.executor.as_deref().unwrap_or(EXECUTOR))
}

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    const LARGEST: u32 = 4096;
    let (width, height) = text.split_once('x').ok_or("expected WxH, such as 512x512")?;
    let number =
        |text: &str| text.parse::<u32>().ok().filter(|number| (1..=LARGEST).contains(number));
    match (number(width), number(height)) {
        (Some(width), Some(height)) => Ok([width, height]),
        _ => Err(format!("expected two numbers from 1 to {LARGEST}")),
    }
}

/// A number of stops. `nan` parses as a number and is refused here.
fn parse_stops(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| "expected a number".to_owned())
}

pub fn run_render(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    on_thread(|| draw_picture(&arguments, form))
        .unwrap_or_else(|| Err(Failure::environment(stopped_message("the renderer"))))
}

fn draw_picture(arguments: &Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    if let Some(show) = &arguments.show {
        return heat::draw_heat(arguments, show, form);
    }
    let entry = chosen_executor(arguments)?;
    let shot = make_shot(arguments, entry)?;
    if let Some(file) = own::own_file(arguments) {
        return own::draw_own(arguments, file, &shot, form);
    }
    refuse_own(arguments)?;
    let programs = Programs::outline(LIBRARY_FILES)
        .map_err(|(sources, problems)| Failure::Input(sources, problems))?;
    if arguments.all || arguments.comparisons {
        let folder = arguments.output.clone().unwrap_or_else(|| PathBuf::from("gallery"));
        let folder = output::OutputFolder::open(&folder, arguments.overwrite.replace())?;
        return match arguments.all {
            true => gallery::draw_gallery(entry, &programs, &shot, folder),
            false => gallery::draw_comparisons(entry, &programs, &shot, folder),
        };
    }
    if arguments.beside {
        return draw_beside(&programs, arguments, &shot, entry);
    }
    if let Some(comparison) = named_comparison(&programs, arguments)? {
        return draw_comparison(&programs, arguments, &comparison, &shot, entry);
    }
    let plan = make_plan(&programs, arguments)?;
    let painter = executor::open_executor(entry)?;
    let start = Instant::now();
    let picture = picture::render_plan(painter.as_ref(), &programs, &plan, &shot)
        .map_err(|problems| input_failure(&programs, problems))?;
    let path = write_picture(arguments, &picture)?;
    let last = plan.last().map_or("", |pass| pass.key.as_str());
    let [width, height] = shot.size;
    let own = arguments.model.as_ref().map(|model| model.display().to_string());
    let scene = own.as_ref().unwrap_or(&plan.scene);
    let (path, adapter, seconds) =
        (path.display(), painter.adapter(), start.elapsed().as_secs_f64());
    Ok(writeln!(
        stdout(),
        "{path}: {width} x {height} of {scene}, `{last}`, in {seconds:.2} s, {adapter}"
    )?)
}

/// Refuses what only a shader of the user's own can have.
fn refuse_own(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.camera.is_some() && arguments.model.is_none() {
        return Err(Failure::usage("`--camera` needs `--model`, or a shader of your own"));
    }
    let given = arguments.own.given().map(str::to_owned);
    let given = given
        .or_else(|| arguments.input.is_about_file().then(|| "an option for sources".to_owned()));
    match given {
        Some(option) => {
            Err(Failure::usage(format!("`{option}` is for a shader of your own: name its file")))
        }
        None => Ok(()),
    }
}

/// What is drawn: a model, or a scene of ours.
fn make_plan(programs: &Programs, arguments: &Arguments) -> Result<Plan, Failure> {
    let Some(mut own) = model::read_model(arguments)? else {
        return permutation_plan(programs, arguments);
    };
    let [width, height] = arguments.size.unwrap_or([1, 1]).map(f64::from);
    own.fit(width / height);
    let plan = model::model_plan(programs, arguments, &own)?;
    let scene = model::model_scene(own, &plan)?;
    Ok(Plan { model: Some(Arc::new(scene)), ..plan })
}

/// Writes the picture where it is asked for.
fn write_picture(arguments: &Arguments, picture: &Picture) -> Result<PathBuf, Failure> {
    write_named(arguments, arguments.preset.as_deref().unwrap_or("render"), picture)
}

/// Writes the picture where it is asked for, or else to a file of this name.
fn write_named(arguments: &Arguments, name: &str, picture: &Picture) -> Result<PathBuf, Failure> {
    let path = arguments.output.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.png")));
    warn_of_ending(&path);
    let png = picture.png().map_err(Failure::environment)?;
    output::write_file(&path, &png, is_own_png, arguments.overwrite.replace())?;
    Ok(path)
}

/// The comparison that is named, if it is one.
fn named_comparison(
    programs: &Programs,
    arguments: &Arguments,
) -> Result<Option<Comparison>, Failure> {
    let Some(name) = &arguments.preset else { return Ok(None) };
    let found =
        library_comparisons(programs)?.into_iter().find(|comparison| comparison.name == *name);
    let is_changed = !arguments.input.chosen_axes().is_empty()
        || arguments.program.is_some()
        || arguments.scene.is_some()
        || arguments.cascades > 1;
    if found.is_some() && is_changed {
        return Err(Failure::usage(format!(
            "`{name}` is a comparison, whose panels have their own permutations and scene"
        )));
    }
    Ok(found)
}

/// Draws a comparison.
fn draw_comparison(
    programs: &Programs,
    arguments: &Arguments,
    comparison: &Comparison,
    shot: &Shot,
    entry: &ExecutorEntry,
) -> Result<(), Failure> {
    let mut painter = executor::open_executor(entry)?;
    let start = Instant::now();
    let picture = strip::draw_strip(painter.as_mut(), programs, comparison, shot)
        .map_err(|problems| input_failure(programs, problems))?;
    let path = write_picture(arguments, &picture)?;
    let (path, seconds) = (path.display(), start.elapsed().as_secs_f64());
    let (count, adapter) = (comparison.panels.len(), painter.adapter());
    Ok(writeln!(stdout(), "{path}: {count} panels in {seconds:.2} s, {adapter}")?)
}

/// Draws a listing beside its safe form.
fn draw_beside(
    programs: &Programs,
    arguments: &Arguments,
    shot: &Shot,
    entry: &ExecutorEntry,
) -> Result<(), Failure> {
    let name = arguments.preset.as_deref().unwrap_or_default();
    let (presets, probes) = library_examples(programs)?;
    let Some(preset) = presets.iter().find(|preset| preset.name == name) else {
        return Err(unknown_name("preset", name, presets.iter().map(|one| one.name.as_str())));
    };
    let painter = executor::open_executor(entry)?;
    let start = Instant::now();
    let picture = beside::draw_beside(painter.as_ref(), programs, preset, &probes, shot)
        .map_err(|problems| input_failure(programs, problems))?;
    let path = write_picture(arguments, &picture)?;
    let (path, seconds) = (path.display(), start.elapsed().as_secs_f64());
    Ok(writeln!(stdout(), "{path}: {name} in {seconds:.2} s, {}", painter.adapter())?)
}

fn input_failure(programs: &Programs, problems: Diagnostics) -> Failure {
    Failure::Input(programs.texts(), problems)
}

fn permutation_plan(programs: &Programs, arguments: &Arguments) -> Result<Plan, Failure> {
    let mut plan = match &arguments.preset {
        Some(name) => of_preset(programs, arguments, name)?,
        None if arguments.input.chosen_axes().is_empty()
            && arguments.program.is_none()
            && arguments.scene.is_none()
            && arguments.model.is_none() =>
        {
            return Err(Failure::usage(
                "name a preset (`lamplight list presets`), or a permutation with `--set`",
            ));
        }
        None => of_point(
            programs,
            arguments,
            find_program(programs, arguments.program.as_deref().unwrap_or("forward"))?,
            None,
        )?,
    };
    if let Some(scene) = &arguments.scene {
        let known = sets::ALL.iter().map(|set| set.name);
        if !known.clone().any(|name| name == scene) {
            return Err(unknown_name("scene", scene, known));
        }
        plan.scene.clone_from(scene);
    }
    Ok(plan)
}

fn of_preset(programs: &Programs, arguments: &Arguments, name: &str) -> Result<Plan, Failure> {
    let (presets, probes) = library_examples(programs)?;
    let Some(preset) = presets.iter().find(|preset| preset.name == name) else {
        let comparisons = library_comparisons(programs)?;
        let compared = comparisons.iter().map(|comparison| comparison.name.as_str());
        let known = presets.iter().map(|preset| preset.name.as_str()).chain(compared);
        return Err(unknown_name("preset", name, known));
    };
    let preset = &chosen_form(programs, arguments, preset);
    let plan = Plan::of_preset(programs, preset, &probes)
        .map_err(|problems| input_failure(programs, problems))?;
    if arguments.input.chosen_axes().is_empty() && arguments.program.is_none() {
        return Ok(plan);
    }
    let program = find_program(programs, arguments.program.as_deref().unwrap_or(&preset.program))?;
    // Another permutation needs other passes. Numbers and scene are still the preset's.
    let changed = of_point(
        programs,
        arguments,
        program,
        (program.name == preset.program).then_some(preset.key.as_str()),
    )?;
    Ok(Plan { passes: changed.passes, ..plan })
}

/// The preset, or its safe form if that has the axes or the program that are chosen, and the form as
/// it is printed has not.
fn chosen_form(programs: &Programs, arguments: &Arguments, preset: &Preset) -> Preset {
    let name = arguments.program.as_deref().unwrap_or(&preset.program);
    let has_axis = |program: &Program, axis: &str| program.space.axis(axis).is_some();
    let own = programs.manifest().program(name).filter(|own| own.name == preset.program);
    let fits = own.is_some_and(|own| {
        arguments.input.chosen_axes().iter().all(|(axis, _)| has_axis(own, axis))
    });
    let is_asked = |safe: &Preset| arguments.program.is_none() || safe.program == name;
    let safe = preset.safe_form().filter(|safe| !fits && is_asked(safe));
    safe.unwrap_or_else(|| preset.clone())
}

/// Presets and light probes of the library.
pub fn library_examples(programs: &Programs) -> Result<(Vec<Preset>, Vec<probe::Probe>), Failure> {
    let read = programs.with_texts(|texts| {
        let probes = probe::library_probes(LIBRARY_FILES, texts)?;
        Ok((preset::library_presets(LIBRARY_FILES, texts, programs.manifest(), &probes)?, probes))
    });
    read.map_err(|problems| input_failure(programs, problems))
}

/// Comparisons of the library.
pub fn library_comparisons(programs: &Programs) -> Result<Vec<Comparison>, Failure> {
    programs
        .with_texts(|texts| strip::library_comparisons(LIBRARY_FILES, texts))
        .map_err(|problems| input_failure(programs, problems))
}

fn find_program<'p>(programs: &'p Programs, name: &str) -> Result<&'p Program, Failure> {
    let known = programs.manifest().programs.iter().map(|program| program.name.as_str());
    programs.manifest().program(name).ok_or_else(|| unknown_name("program", name, known))
}

/// The error about an unknown name, with the nearest name, with all names if there are few, or with
/// the command that lists them.
fn unknown_name<'a>(
    what: &str,
    name: &str,
    known: impl Iterator<Item = &'a str> + Clone,
) -> Failure {
    const FEW: usize = 12;
    let hint = match nearest_name(name, known.clone()) {
        Some(nearest) => format!("\nhelp: did you mean `{nearest}`?"),
        None if known.clone().count() <= FEW => {
            format!("\nhelp: there are {}", known.collect::<Vec<_>>().join(", "))
        }
        None => match what {
            "preset" | "program" => format!("\nhelp: `lamplight list {what}s` lists them"),
            _ => "\nhelp: `lamplight list scenes` lists scenes".to_owned(),
        },
    };
    Failure::input(format!("there is no {what} `{name}`{hint}"))
}

fn of_point(
    programs: &Programs,
    arguments: &Arguments,
    program: &Program,
    base: Option<&str>,
) -> Result<Plan, Failure> {
    let point = chosen_point(programs, arguments, program, base)?;
    Plan::of_point(programs, program, &point).map_err(|problems| input_failure(programs, problems))
}

/// The permutation that `--set` chooses. Axes that it leaves out have their values from the key
/// `base`, or else their defaults.
fn chosen_point(
    programs: &Programs,
    arguments: &Arguments,
    program: &Program,
    base: Option<&str>,
) -> Result<Assignment, Failure> {
    let chosen: Vec<String> = arguments
        .input
        .chosen_axes()
        .iter()
        .map(|(axis, value)| format!("{axis}={value}"))
        .collect();
    let mut texts = programs.texts();
    let base = texts.add("preset", base.unwrap_or_default());
    let id = texts.add("--set", chosen.join(","));
    let (base, chosen) = (Quoted::whole(&texts, base), Quoted::whole(&texts, id));
    let point = key::parse(&program.space, &base)
        .and_then(|base| key::parse_over(&program.space, base, &chosen));
    let checked = point.and_then(|point| {
        let problems = super::input::broken_constraint(program, &point, &texts, id);
        if problems.is_empty() { Ok(point) } else { Err(problems) }
    });
    checked.map_err(|problems| Failure::Input(texts, problems))
}

fn make_shot(arguments: &Arguments, executor: &ExecutorEntry) -> Result<Shot, Failure> {
    let (size, samples) = if arguments.all || arguments.comparisons {
        (picture::gallery::SIZE, executor.samples.map(|few| if few > 1 { SAMPLES } else { few }))
    } else {
        ([512; 2], executor.samples)
    };
    Ok(Shot {
        size: arguments.size.unwrap_or(size),
        samples: arguments.samples.or(samples).unwrap_or(1),
        cascades: arguments.cascades,
        exposure: arguments.exposure.clamp(-32.0, 32.0),
        language: arguments.input.chosen_language().unwrap_or(Language::Wesl),
        surroundings: find_surroundings(arguments.environment.as_deref())?,
    })
}

/// What is around a scene, by name or from a file.
pub fn find_surroundings(name: Option<&str>) -> Result<Surroundings, Failure> {
    let Some(name) = name else {
        return Ok(Surroundings::Usual);
    };
    if let Some(named) = Surroundings::named(name) {
        return Ok(named);
    }
    let image = Equirect::from_radiance(&read_environment(name)?)
        .map_err(|error| Failure::input(format!("`{name}`: {error}")))?;
    Ok(Surroundings::Image(Arc::new(image)))
}

/// The bytes of a file with an environment.
pub fn read_environment(name: &str) -> Result<Vec<u8>, Failure> {
    crate::input::read_file(Path::new(name), ENVIRONMENT_BYTES).map_err(|error| {
        if error.kind() == std::io::ErrorKind::NotFound {
            let known = ENVIRONMENTS.iter().map(|(name, _, _)| *name);
            return unknown_name("environment or file", name, known);
        }
        Failure::input(format!("cannot read `{name}`: {error}"))
    })
}

/// Warns of a file name that promises another format. That is not an error.
fn warn_of_ending(path: &std::path::Path) {
    const OTHERS: [&str; 6] = ["jpg", "jpeg", "webp", "gif", "bmp", "hdr"];
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    if ending.is_some_and(|ending| OTHERS.contains(&ending.as_str())) {
        let _ = writeln!(terminal::stderr(), "warning: `{}` will hold a PNG", path.display());
    }
}

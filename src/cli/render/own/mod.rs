//! `lamplight render FILE`: a shader of the user's own.
//!
//! `files -> texts -> stages -> prepared -> picture`; what was read is remembered for `--watch`.

mod arguments;
mod content;
mod report;
mod watch;

pub use arguments::{Colors, OwnArguments};

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use super::{Arguments, Failure};
use crate::bundle::{Language, SourceClip};
use crate::cli::executor;
use crate::cli::failure::{DiagnosticForm, print_warnings};
use crate::cli::input::{ComposedInput, InputArguments};
use crate::compose;
use crate::diagnostic::Diagnostics;
use crate::execute::Session;
use crate::generate::add_numbers;
use crate::picture::own::table::Row;
use crate::picture::own::{
    OwnPicture, OwnRequest, OwnSettings, OwnStages, OwnText, choose_stages, prepare_own,
};
use crate::picture::{Picture, Shot};
use crate::source::{LIMITS, SourceSet};
use watch::Seen;

/// The file, if the argument is one: it is there, or its name is that of a shader.
pub fn own_file(arguments: &Arguments) -> Option<&Path> {
    const WESL: [&str; 2] = ["wesl", "wgsl"];
    let path = Path::new(arguments.preset.as_deref()?);
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    let is_shader = WESL.contains(&&*ending)
        || ending == "glsl"
        || compose::glsl::named_stage(&path.to_string_lossy()).is_some();
    (is_shader || path.is_file() || path.as_os_str() == "-").then_some(path)
}

/// A picture, with what a person wants to know of it.
struct Drawn {
    picture: Picture,
    rows: Vec<Row>,
    notes: Vec<String>,
    /// What it shows: `on sphere`, or `over the whole picture`.
    model: String,
    colors: Colors,
    seconds: f64,
}

/// Draws the file, once or whenever it changes.
pub fn draw_own(
    arguments: &Arguments,
    file: &Path,
    shot: &Shot,
    form: DiagnosticForm,
) -> Result<(), Failure> {
    check_usage(arguments, file)?;
    let painter = open_painter(arguments)?;
    let reader = Reader { arguments, file, shot, form };
    let job = Job { reader, painter: painter.as_ref() };
    if arguments.own.watch {
        return watch::draw_again(&job);
    }
    let mut seen = Seen::default();
    let drawn = job.draw(&mut seen)?;
    report::report_drawn(&job, &drawn, true)
}

/// The file, ready to be drawn, with the texts that it was made of.
///
/// # Errors
/// Those of the file, of its values and of its model.
pub fn prepare_file(
    arguments: &Arguments,
    file: &Path,
    shot: &Shot,
    form: DiagnosticForm,
) -> Result<(Ready, SourceSet), Failure> {
    check_usage(arguments, file)?;
    let reader = Reader { arguments, file, shot, form };
    let mut seen = Seen::default();
    let (texts, mut sources) = reader.texts(&mut seen)?;
    let settings = content::read_settings(file, &mut sources, &mut seen)?;
    let ready = reader.prepare_texts(&texts, &settings, &sources, &mut seen)?;
    Ok((ready, sources))
}

/// A file that is ready to be drawn.
pub struct Ready {
    pub prepared: OwnPicture,
    /// How the picture is taken.
    pub shot: Shot,
    /// The model's name.
    name: Option<String>,
    colors: Colors,
}

/// What every reading of the file has in common.
struct Reader<'a> {
    arguments: &'a Arguments,
    file: &'a Path,
    shot: &'a Shot,
    form: DiagnosticForm,
}

/// What every drawing of the file has in common.
struct Job<'a> {
    reader: Reader<'a>,
    painter: &'a dyn Session,
}

impl<'a> std::ops::Deref for Job<'a> {
    type Target = Reader<'a>;

    fn deref(&self) -> &Reader<'a> {
        &self.reader
    }
}

fn check_usage(arguments: &Arguments, file: &Path) -> Result<(), Failure> {
    let given = [
        (arguments.program.is_some(), "--program"),
        (arguments.scene.is_some(), "--scene"),
        (arguments.beside, "--beside"),
        (arguments.cascades > 1, "--cascades"),
    ];
    if let Some((_, option)) = given.iter().find(|(is_given, _)| *is_given) {
        let help =
            if *option == "--scene" { "\nhelp: `--model NAME` takes scenes too" } else { "" };
        return Err(Failure::usage(format!(
            "`{option}` is for presets, and `{}` is a file{help}",
            file.display()
        )));
    }
    let ending = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    if matches!(ending.as_str(), "glb" | "gltf") {
        let file = file.display();
        return Err(Failure::usage(format!(
            "`{file}` is a model, not a shader\nhelp: `lamplight render --model {file}`"
        )));
    }
    if arguments.own.watch && file.as_os_str() == "-" {
        return Err(Failure::usage("standard input cannot be watched"));
    }
    Ok(())
}

/// The executor that is asked for; else Vulkan, or the evaluator where there is no driver.
fn open_painter(arguments: &Arguments) -> Result<Box<dyn Session>, Failure> {
    if arguments.executor.is_some() {
        return executor::open_executor(super::chosen_executor(arguments)?);
    }
    match executor::open_executor(super::chosen_executor(arguments)?) {
        Ok(painter) => Ok(painter),
        Err(_) => {
            report::say_note("there is no Vulkan driver: `eval` draws, on the CPU")?;
            executor::open_executor(executor::find_drawing("eval")?)
        }
    }
}

impl Job<'_> {
    /// Reads all files and draws. `seen` gets what was read, also where something is wrong.
    fn draw(&self, seen: &mut Seen) -> Result<Drawn, Failure> {
        let start = Instant::now();
        let (texts, mut sources) = self.texts(seen)?;
        let settings = content::read_settings(self.file, &mut sources, seen)?;
        let result = self.draw_texts(&texts, &settings, &sources, seen, start);
        seen.add_sources(&sources);
        result
    }

    fn draw_texts(
        &self,
        texts: &[OwnText],
        settings: &OwnSettings,
        sources: &SourceSet,
        seen: &mut Seen,
        start: Instant,
    ) -> Result<Drawn, Failure> {
        let failed = |errors: Diagnostics| Failure::Input(sources.clone(), errors);
        let Ready { prepared, shot, name, colors } =
            self.prepare_texts(texts, settings, sources, seen)?;
        let picture = prepared.take(self.painter, &shot).map_err(failed)?;
        let model = match (prepared.is_flat, name) {
            (true, _) => "over the whole picture".to_owned(),
            (false, name) => format!("on {}", name.unwrap_or_else(|| "sphere".to_owned())),
        };
        let (rows, mut notes) = (prepared.rows, prepared.notes);
        notes.extend(report::plain_picture(&picture));
        notes.extend(self.unused_partner().filter(|_| texts.len() == 1));
        let seconds = start.elapsed().as_secs_f64();
        Ok(Drawn { picture, rows, notes, model, colors, seconds })
    }
}

impl Reader<'_> {
    fn prepare_texts(
        &self,
        texts: &[OwnText],
        settings: &OwnSettings,
        sources: &SourceSet,
        seen: &mut Seen,
    ) -> Result<Ready, Failure> {
        let failed = |errors: Diagnostics| Failure::Input(sources.clone(), errors);
        let own = &self.arguments.own;
        let stages = choose_stages(texts, &own.entry).map_err(failed)?;
        let colors = own.colors.unwrap_or(self.usual_colors(&stages));
        let linear = colors == Colors::Linear;
        let model = content::read_scene(self.arguments, settings, self.file, self.shot, seen)?;
        let textures = content::read_textures(self.arguments, settings, self.file, linear, seen)?;
        let (scene, name) = model.unzip();
        let time = own.time.or(settings.time).unwrap_or(1.0);
        let given = content::given_values(self.arguments, settings);
        let vertices = own.vertices;
        let inputs = BTreeMap::new();
        let request = OwnRequest { scene, given, textures, time, linear, vertices, inputs };
        let prepared = prepare_own(&stages, &request, self.shot).map_err(failed)?;
        let shot = match prepared.is_flat && self.arguments.samples.is_none() {
            // There are no edges that several samples would smooth.
            true => Shot { samples: 1, ..self.shot.clone() },
            false => self.shot.clone(),
        };
        Ok(Ready { prepared, shot, name, colors })
    }

    /// Shaders for OpenGL and for Shadertoy write what the display shows.
    fn usual_colors(&self, stages: &OwnStages) -> Colors {
        let is_display = self.arguments.input.wraps() || stages.is_for_opengl();
        if is_display { Colors::Srgb } else { Colors::Linear }
    }

    /// The texts of the file, and of that with the other stage.
    fn texts(&self, seen: &mut Seen) -> Result<(Vec<OwnText>, SourceSet), Failure> {
        let input = &self.arguments.input;
        let is_wesl = input.language(self.file)? == Language::Wesl;
        let first = if is_wesl { input.for_file() } else { input.clone() };
        let (text, sources, partner) = self.text(&first, self.file, SourceSet::default(), seen)?;
        let partner = match input.partner() {
            Some(partner) => Some(partner.to_owned()),
            None => partner.map(|path| input.package_root(self.file).join(path)),
        };
        let Some(partner) = partner else { return Ok((vec![text], sources)) };
        let other = input.for_partner((!is_wesl).then_some(self.file));
        let (other, sources, _) = self.text(&other, &partner, sources, seen)?;
        Ok((vec![text, other], sources))
    }

    /// The text of a file, and the path of its partner in the package.
    fn text(
        &self,
        input: &InputArguments,
        file: &Path,
        sources: SourceSet,
        seen: &mut Seen,
    ) -> Result<(OwnText, SourceSet, Option<String>), Failure> {
        seen.add_file(file);
        let ready = input.compose(file, sources, self.form).map_err(|failure| match failure {
            Failure::Input(sources, errors) => {
                seen.add_sources(&sources);
                Failure::Input(sources, self.with_wrap(file, errors))
            }
            failure => failure,
        })?;
        let ComposedInput { sources, mut composed, context } = ready;
        add_numbers(&mut composed, &context.numbers);
        let clip = if input.wraps() { SourceClip::WebGpu } else { self.arguments.own.source_clip };
        match OwnText::read(&composed, clip) {
            Ok((text, warnings)) => {
                print_warnings(&sources, &context.own(warnings), self.form);
                Ok((text, sources, context.partner))
            }
            Err(errors) => {
                seen.add_sources(&sources);
                Err(Failure::Input(sources, self.with_wrap(file, context.explain(errors))))
            }
        }
    }

    /// Adds how a shader of Shadertoy is drawn, if the file may be one.
    fn with_wrap(&self, file: &Path, mut errors: Diagnostics) -> Diagnostics {
        if self.arguments.input.wraps() {
            return errors;
        }
        let text = crate::input::read_file(file, LIMITS.file_bytes as u64).unwrap_or_default();
        let text = String::from_utf8_lossy(&text);
        let is_part = text.contains("mainImage") && !text.contains("void main(");
        if is_part && let Some(last) = errors.pop() {
            errors.push(last.note("help: `--wrap shadertoy` makes a shader of `mainImage`"));
        }
        errors
    }

    /// A note about a file that may be the other stage and was not read.
    fn unused_partner(&self) -> Option<String> {
        const PAIRS: [(&str, &str); 2] = [("frag", "vert"), ("fs", "vs")];
        if self.arguments.input.partner().is_some() {
            return None;
        }
        let ending = self.file.extension()?.to_string_lossy();
        let (_, other) = PAIRS.iter().find(|(fragment, _)| *fragment == ending)?;
        let partner: PathBuf = self.file.with_extension(other);
        let partner = partner.is_file().then(|| partner.display().to_string())?;
        Some(format!("`{partner}` is not read: `--with {partner}` draws with both stages"))
    }
}

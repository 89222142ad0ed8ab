//! The entry points of a program in each language, ready to be composed.

use std::sync::Arc;

use super::shader;
use lamplight_bundle::Language;
use lamplight_compose::resolve::{self, Graph, Packages};
use lamplight_compose::{self as compose, Options};
use lamplight_diagnostic::source::SourceSet;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_permute::manifest::ManifestFile;
use lamplight_permute::{Assignment, Program};

/// One entry point of one language.
pub struct ShaderEntry {
    pub program: String,
    pub language: Language,
    /// Name in the source: `main` in GLSL.
    pub name: String,
    /// Name in the bundle. A GLSL stage has the name of its WESL twin, so that engines can change
    /// the language; without a twin it has the name of its stage.
    pub label: String,
    pub stage: naga::ShaderStage,
    /// The graph that has it. GLSL has one entry point in a file, so one graph for each.
    pub graph: Arc<Graph>,
    pub options: Options,
    /// Lines for the end of its texts, with the numbers that GLSL leaves open.
    pub numbers: String,
}

/// Every entry point of a program: those of the WESL root, then one for each GLSL stage.
///
/// The entry points of the WESL root are those that its composition for `point` has.
pub fn entries(
    sources: &mut SourceSet,
    packages: &Packages,
    program: &Program,
    point: Option<&Assignment>,
) -> Result<Vec<ShaderEntry>, Diagnostics> {
    let Some(point) = point else { return Ok(Vec::new()) };
    let (mut entries, mut errors) = (Vec::new(), Diagnostics::new());
    for (file, language) in root_files(program) {
        let found = of_file(sources, packages, program, point, (file, language), &mut entries);
        errors.extend(found.err().into_iter().flatten());
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    number_stages(&mut entries);
    Ok(entries)
}

/// Gives the two stages of a program in GLSL numbers that fit each other.
fn number_stages(entries: &mut [ShaderEntry]) {
    let is_glsl = |entry: &&ShaderEntry| entry.language == Language::Glsl;
    let graph_of = |stage: naga::ShaderStage| {
        let mut found = entries.iter().filter(is_glsl);
        found.find(|entry| entry.stage == stage).map(|entry| entry.graph.clone())
    };
    let stages = [naga::ShaderStage::Vertex, naga::ShaderStage::Fragment];
    let graphs = stages.map(graph_of);
    let [vertex, fragment] = graphs.each_ref().map(Option::as_deref);
    let numbers = shader::program_numbers(vertex, fragment);
    for entry in entries.iter_mut().filter(|entry| entry.language == Language::Glsl) {
        if let Some(at) = stages.iter().position(|stage| *stage == entry.stage) {
            entry.numbers.clone_from(&numbers[at]);
        }
    }
}

/// Adds the entry points of one root file.
fn of_file(
    sources: &mut SourceSet,
    packages: &Packages,
    program: &Program,
    point: &Assignment,
    (file, language): (&ManifestFile, Language),
    entries: &mut Vec<ShaderEntry>,
) -> Result<(), Diagnostics> {
    let graph = resolve::load(sources, packages, &file.path, language)
        .map_err(|errors| named_by(errors, file))?;
    let graph = Arc::new(graph);
    let here = |errors| of_permutation(graph.traced(errors), program, point);
    // Errors of the composer have their chain of imports already.
    let composed = compose::compose(&graph, &program.space.settings(point), &Options::default())
        .map_err(|errors| of_permutation(errors, program, point))?;
    let points = shader::entry_points(&composed).map_err(here)?;
    if points.is_empty() {
        let message = format!("`{}` has no entry point", file.path);
        let error = Diagnostic::error(codes::NO_ENTRY_POINT, message).at(file.span, "named here");
        return Err(of_permutation(vec![error], program, point));
    }
    for (name, stage) in points {
        let keep = shader::kept_items(&graph, &Options::default(), &name);
        let options = Options { keep, ..Options::default() };
        let label = entry_label(entries, language, &name, stage);
        let (program, graph) = (program.name.clone(), graph.clone());
        let numbers = String::new();
        entries.push(ShaderEntry {
            program,
            language,
            name,
            label,
            stage,
            graph,
            options,
            numbers,
        });
    }
    Ok(())
}

impl ShaderEntry {
    /// For people: `forward fs_main (glsl)`.
    pub fn title(&self) -> String {
        format!("{} {} ({})", self.program, self.label, self.language.name())
    }
}

/// Adds the manifest's place to the error about a root that cannot be found, since the manifest
/// names it.
fn named_by(errors: Diagnostics, file: &ManifestFile) -> Diagnostics {
    let one = |error: Diagnostic| {
        if error.labels.is_empty() { error.at(file.span, "named here") } else { error }
    };
    errors.into_iter().map(one).collect()
}

fn of_permutation(errors: Diagnostics, program: &Program, point: &Assignment) -> Diagnostics {
    let note =
        format!("in permutation `{}` of program `{}`", program.space.key(point), program.name);
    errors.into_iter().map(|error| error.note(note.as_str())).collect()
}

fn entry_label(
    before: &[ShaderEntry],
    language: Language,
    name: &str,
    stage: naga::ShaderStage,
) -> String {
    let twin = before.iter().find(|entry| entry.language != language && entry.stage == stage);
    match (language, twin) {
        (Language::Wesl, _) => name.to_owned(),
        (Language::Glsl, Some(twin)) => twin.label.clone(),
        (Language::Glsl, None) => format!("{stage:?}").to_lowercase(),
    }
}

fn root_files(program: &Program) -> Vec<(&ManifestFile, Language)> {
    let glsl = program.glsl.iter().flat_map(|glsl| [&glsl.vertex, &glsl.fragment]).flatten();
    let wesl = program.wesl.iter().map(|file| (file, Language::Wesl));
    wesl.chain(glsl.map(|file| (file, Language::Glsl))).collect()
}

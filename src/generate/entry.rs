//! The entry points of a program, in each language, ready to be composed.

use std::sync::Arc;

use crate::compose::{self, Keep, Language, Options};
use crate::diagnostic::Diagnostics;
use crate::permute::{Assignment, Program};
use crate::resolve::{self, Graph, Packages};
use crate::source::SourceSet;
use crate::validate::validate;

/// One entry point of one language.
pub struct Entry {
    pub program: String,
    pub language: Language,
    /// Name in the source: `main` in GLSL.
    pub name: String,
    /// Name in the bundle: a GLSL stage is called as its WESL twin, so that languages can be
    /// exchanged; without a twin, as its stage.
    pub label: String,
    pub stage: naga::ShaderStage,
    /// The graph that has it; languages with an entry point a file have one graph for each.
    pub graph: Arc<Graph>,
    pub options: Options,
}

/// Every entry point of a program: those of the WESL root, then one for each GLSL stage.
///
/// Entry points are those that the composition of `point` has.
pub fn entries(
    sources: &mut SourceSet,
    packages: &Packages,
    program: &Program,
    point: Option<&Assignment>,
) -> Result<Vec<Entry>, Diagnostics> {
    let Some(point) = point else { return Ok(Vec::new()) };
    let mut entries = Vec::new();
    for (file, language) in roots(program) {
        let graph = Arc::new(resolve::load(sources, packages, file, language)?);
        let composed = compose::compose(&graph, &program.space.settings(point), &Options::default())?;
        for found in validate(&composed)?.module.entry_points {
            let keep = match language {
                Language::Wesl => Keep::Items(vec![found.name.clone()]),
                Language::Glsl => Keep::EntryPoints,
            };
            let options = Options { keep, ..Options::default() };
            let label = label(&entries, language, &found);
            let (program, graph) = (program.name.clone(), graph.clone());
            entries.push(Entry { program, language, name: found.name, label, stage: found.stage, graph, options });
        }
    }
    Ok(entries)
}

impl Entry {
    /// For people: `forward fs_main (glsl)`.
    pub fn title(&self) -> String {
        let language = match self.language {
            Language::Wesl => "wesl",
            Language::Glsl => "glsl",
        };
        format!("{} {} ({language})", self.program, self.label)
    }
}

fn label(before: &[Entry], language: Language, point: &naga::EntryPoint) -> String {
    let twin = before.iter().find(|entry| entry.language != language && entry.stage == point.stage);
    match (language, twin) {
        (Language::Wesl, _) => point.name.clone(),
        (Language::Glsl, Some(twin)) => twin.label.clone(),
        (Language::Glsl, None) => format!("{:?}", point.stage).to_lowercase(),
    }
}

fn roots(program: &Program) -> Vec<(&str, Language)> {
    let glsl = program.glsl.iter().flat_map(|glsl| [&glsl.vertex, &glsl.fragment]).flatten();
    let wesl = program.wesl.iter().map(|file| (file.path.as_str(), Language::Wesl));
    wesl.chain(glsl.map(|file| (file.path.as_str(), Language::Glsl))).collect()
}

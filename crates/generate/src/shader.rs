//! Compiles one root file for one choice of settings, without a manifest. The bytes are those that
//! a run over a manifest gives for the same settings.

use super::spirv_form::{Optimiser, SpirvShaper};
use lamplight_bundle::{Conventions, Language, Target};
use lamplight_compose::resolve::Graph;
use lamplight_compose::{self as compose, Composed, Keep, Options, lean};
use lamplight_diagnostic::Diagnostics;
use lamplight_link::{self as link, CompiledUnit, Linker};
use lamplight_permute::Settings;
use lamplight_validate::{naga_stage, on_large_stack, validate_every, validate_for_some};

/// The entry point of every GLSL text.
const GLSL_ENTRY: &str = "main";

/// An entry point in every target asked for.
#[derive(Debug)]
pub struct CompiledShader {
    /// Its name in the source.
    pub entry: String,
    /// Its outputs.
    pub made: CompiledUnit,
}

/// A root file with all that its entry points are composed from.
#[derive(Debug)]
pub struct Root<'a> {
    /// The modules that its file reaches.
    pub graph: &'a Graph,
    /// The settings of the permutation.
    pub settings: &'a Settings,
    /// How it is composed.
    pub options: &'a Options,
    /// The clip space and the checks of its outputs.
    pub conventions: Conventions,
    /// What optimises SPIR-V. An output that needs it and has none is an error.
    pub optimiser: Option<&'a dyn Optimiser>,
    /// What [`program_numbers`] gives for its stage; empty for a file alone.
    pub numbers: &'a str,
}

/// Lines for the end of the texts of a vertex and of a fragment shader in GLSL, with the numbers
/// that their files leave open.
pub fn program_numbers(vertex: Option<&Graph>, fragment: Option<&Graph>) -> [String; 2] {
    let [vertex, fragment] = [vertex, fragment].map(module_texts);
    lamplight_glsl::number_program(&vertex, &fragment)
}

/// Name and stage of each entry point of a composed root.
///
/// # Errors
/// What naga finds wrong with the text.
pub fn entry_points(composed: &Composed) -> Result<Vec<(String, naga::ShaderStage)>, Diagnostics> {
    // A GLSL text has one entry point, whose stage is known. Its text is not validated here: it may
    // have functions that no output needs, and what naga refuses about those is no error of
    // another permutation either.
    if let (Some(stage), Some(_)) = (composed.stage, composed.function(GLSL_ENTRY)) {
        return Ok(vec![(GLSL_ENTRY.to_owned(), naga_stage(stage))]);
    }
    // The lean text is what will be compiled. If it is not valid, the author's text shows what is
    // wrong.
    let validated = validate_for_some(&lean(composed)).or_else(|_| validate_every(composed))?;
    let points = validated.module.entry_points.into_iter();
    Ok(points.map(|point| (point.name, point.stage)).collect())
}

impl Root<'_> {
    /// Compiles entry points, each from a text of its own, as `gen` does.
    ///
    /// # Errors
    /// What is wrong with any of them, each mistake once.
    pub fn compile(
        &self,
        entries: &[(String, naga::ShaderStage)],
        targets: &[Target],
    ) -> Result<Vec<CompiledShader>, Diagnostics> {
        self.compile_with(entries, &Linker::with(targets, self.conventions))
    }

    /// As [`Self::compile`], with a linker that may have translated some functions before. The
    /// bytes are the same.
    ///
    /// # Errors
    /// What is wrong with any of them, each mistake once.
    pub fn compile_with(
        &self,
        entries: &[(String, naga::ShaderStage)],
        linker: &Linker<'_>,
    ) -> Result<Vec<CompiledShader>, Diagnostics> {
        let (mut shaders, mut errors) = (Vec::new(), Diagnostics::new());
        let shaper = SpirvShaper::new(self.conventions.spirv, linker.targets(), self.optimiser)?;
        for (entry, _) in entries {
            let made = on_large_stack(|| self.one(entry, linker)).and_then(|mut made| {
                shaper.shape(&mut made.unit)?;
                Ok(made)
            });
            match made {
                Ok(made) => shaders.push(CompiledShader { entry: entry.clone(), made }),
                Err(found) => errors.extend(found),
            }
        }
        errors.sort_by_key(|error| error.labels.first().map(|label| label.span));
        errors.dedup_by(|one, other| {
            (one.code, &one.message, &one.labels) == (other.code, &other.message, &other.labels)
        });
        if errors.is_empty() { Ok(shaders) } else { Err(errors) }
    }

    fn one(&self, entry: &str, linker: &Linker<'_>) -> Result<CompiledUnit, Diagnostics> {
        let options = Options {
            mangle: self.options.mangle,
            keep: kept_items(self.graph, self.options, entry),
            stage: self.options.stage,
        };
        let mut composed = compose::compose(self.graph, self.settings, &options)?;
        let mut lean = lean(&composed);
        add_numbers(&mut composed, self.numbers);
        add_numbers(&mut lean, self.numbers);
        link::compile(
            &link::TextForms { composed: &composed, lean: &lean },
            entry,
            linker.targets(),
            linker,
        )
    }
}

/// The texts of the files of a graph, the root first.
fn module_texts(graph: Option<&Graph>) -> Vec<&str> {
    match graph {
        Some(Graph::Glsl(graph)) => graph.modules.iter().map(|module| &*module.text).collect(),
        _ => Vec::new(),
    }
}

/// Adds lines to the end of a text.
pub fn add_numbers(composed: &mut Composed, numbers: &str) {
    if !numbers.is_empty() && !composed.text.ends_with('\n') {
        composed.text.push('\n');
    }
    composed.text.push_str(numbers);
}

/// What the text of one entry point keeps. A GLSL file has only one entry point, which needs no
/// name.
pub fn kept_items(graph: &Graph, options: &Options, entry: &str) -> Keep {
    match (graph_language(graph), &options.keep) {
        (_, Keep::All) => Keep::All,
        (Language::Wesl, _) => Keep::Items(vec![entry.to_owned()]),
        (Language::Glsl, _) => Keep::EntryPoints,
    }
}

fn graph_language(graph: &Graph) -> Language {
    match graph {
        Graph::Wesl(_) => Language::Wesl,
        Graph::Glsl(_) => Language::Glsl,
    }
}

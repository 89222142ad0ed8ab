//! Programs of the library's manifest, composed into the stages of one permutation.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::bundle::{Language, Reflection};
use crate::compose::{self, Options};
use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use crate::emit::reflect;
use crate::permute::manifest::{File, Program};
use crate::permute::{Manifest, Settings};
use crate::picture::needs::Table;
use crate::project;
use crate::resolve::{self, Graph};
use crate::source::SourceSet;
use crate::validate::{Validated, validate};

/// The library's programs; each graph is read once.
pub struct Programs {
    manifest: Manifest,
    pictures: Table,
    kept: Mutex<Kept>,
}

/// The texts, and the graph of each file.
struct Kept {
    texts: SourceSet,
    graphs: BTreeMap<String, Arc<Graph>>,
}

/// The stages of one permutation; without a fragment stage it gives depth alone.
#[derive(Debug, Clone)]
pub struct Stages {
    pub vertex: Composed,
    pub fragment: Option<Composed>,
}

/// An entry point, ready to run.
#[derive(Debug, Clone)]
pub struct Composed {
    pub validated: Arc<Validated>,
    pub entry: &'static str,
    pub reflection: Reflection,
    /// Of both stages in WESL.
    pub text: Arc<str>,
}

impl Programs {
    /// Reads the manifest of the embedded library.
    ///
    /// # Errors
    /// The manifest's, with the texts to show them in.
    pub fn load() -> Result<Self, (SourceSet, Diagnostics)> {
        let (mut texts, manifest) = project::library_manifest()?;
        match Table::load(&mut texts, &manifest) {
            Ok(pictures) => {
                let kept = Mutex::new(Kept { texts, graphs: BTreeMap::new() });
                Ok(Self { manifest, pictures, kept })
            }
            Err(problems) => Err((texts, problems)),
        }
    }

    /// What pictures take from the programs.
    pub fn pictures(&self) -> &Table {
        &self.pictures
    }

    /// The manifest.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// The texts that were read so far.
    pub fn texts(&self) -> SourceSet {
        self.kept().texts.clone()
    }

    /// Runs something on the texts that were read so far.
    pub fn with_texts<T>(&self, run: impl FnOnce(&mut SourceSet) -> T) -> T {
        run(&mut self.kept().texts)
    }

    /// Composes both stages of a program.
    ///
    /// # Errors
    /// Those of the composition; a program that is not there in the language.
    pub fn stages(
        &self,
        program: &Program,
        settings: &Settings,
        language: Language,
    ) -> Result<Stages, Diagnostics> {
        match (language, &program.wesl, &program.glsl) {
            (Language::Wesl, Some(file), _) => self.of_wesl(file, settings),
            (Language::Glsl, _, Some(glsl)) => {
                let vertex = glsl.vertex.as_ref().ok_or_else(|| absent(program, language))?;
                let stage = |file: &File| {
                    self.composed(file, settings, language)
                        .and_then(|(text, module)| ready(module, "main", text))
                };
                Ok(Stages {
                    vertex: stage(vertex)?,
                    fragment: glsl.fragment.as_ref().map(stage).transpose()?,
                })
            }
            _ => Err(absent(program, language)),
        }
    }

    fn of_wesl(&self, file: &File, settings: &Settings) -> Result<Stages, Diagnostics> {
        let (text, module) = self.composed(file, settings, Language::Wesl)?;
        let has_fragment = module.module.entry_points.iter().any(|point| point.name == "fs_main");
        let vertex = ready(module.clone(), "vs_main", text.clone())?;
        let fragment = if has_fragment { Some(ready(module, "fs_main", text)?) } else { None };
        Ok(Stages { vertex, fragment })
    }

    fn composed(
        &self,
        file: &File,
        settings: &Settings,
        language: Language,
    ) -> Result<(Arc<str>, Arc<Validated>), Diagnostics> {
        let composed =
            compose::compose(&*self.graph(file, language)?, settings, &Options::default())?;
        let validated = validate(&composed)?;
        Ok((composed.text.into(), Arc::new(validated)))
    }

    fn graph(&self, file: &File, language: Language) -> Result<Arc<Graph>, Diagnostics> {
        let mut kept = self.kept();
        if let Some(graph) = kept.graphs.get(&file.path) {
            return Ok(graph.clone());
        }
        let graph =
            Arc::new(resolve::load(&mut kept.texts, &project::library(), &file.path, language)?);
        kept.graphs.insert(file.path.clone(), graph.clone());
        Ok(graph)
    }

    fn kept(&self) -> MutexGuard<'_, Kept> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn ready(
    validated: Arc<Validated>,
    entry: &'static str,
    text: Arc<str>,
) -> Result<Composed, Diagnostics> {
    let reflection = reflect(&validated, entry).map_err(|problem| vec![problem])?;
    Ok(Composed { validated, entry, reflection, text })
}

fn absent(program: &Program, language: Language) -> Diagnostics {
    let name = match language {
        Language::Wesl => "WESL",
        Language::Glsl => "GLSL",
    };
    vec![Diagnostic::error(
        codes::UNKNOWN_PROGRAM,
        format!("there is no program `{}` in {name}", program.name),
    )]
}

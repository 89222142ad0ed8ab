//! Programs of the library's manifest, composed into the stages of one permutation.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::needs::NeedsTable;
use lamplight_bundle::{Language, Reflection};
use lamplight_compose::project;
use lamplight_compose::resolve::{self, Graph};
use lamplight_compose::{self as compose, Options, PartKind};
use lamplight_diagnostic::source::{Embedded, SourceSet};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_emit::reflect;
use lamplight_permute::manifest::{ManifestFile, Program};
use lamplight_permute::{Manifest, Settings};
use lamplight_validate::{Validated, validate};

/// The library's programs. Each graph is read once.
pub struct Programs {
    library: Embedded,
    manifest: Manifest,
    pictures: NeedsTable,
    kept: Mutex<KeptPrograms>,
}

/// The texts, and the graph of each file.
struct KeptPrograms {
    texts: SourceSet,
    graphs: BTreeMap<String, Arc<Graph>>,
    /// The permutations that were asked for last, the latest at the end. Pictures of the same one
    /// follow each other while somebody moves a lamp.
    stages: VecDeque<(StagesKey, Stages)>,
}

impl KeptPrograms {
    /// Stages that are kept. They become the most recently used ones.
    fn again(&mut self, asked: &StagesKey) -> Option<Stages> {
        let at = self.stages.iter().position(|(known, _)| known == asked)?;
        let found = self.stages.remove(at)?;
        let stages = found.1.clone();
        self.stages.push_back(found);
        Some(stages)
    }
}

/// The program, settings and language of stages.
type StagesKey = (String, Settings, Language);

/// How many permutations are kept: as many as the passes of a picture.
const KEPT_STAGES: usize = 8;

/// The stages of one permutation. Without a fragment stage it draws only depth.
#[derive(Debug, Clone)]
pub struct Stages {
    pub vertex: ReadyStage,
    pub fragment: Option<ReadyStage>,
}

/// An entry point, ready to run.
#[derive(Debug, Clone)]
pub struct ReadyStage {
    pub validated: Arc<Validated>,
    pub entry: &'static str,
    pub reflection: Reflection,
    /// The composed text; for WESL, that of both stages.
    pub text: Arc<str>,
    /// Paths of the library's functions that the text has, such as `lighting::spot::cone_hard`.
    pub functions: Arc<[String]>,
}

impl Programs {
    /// Reads the manifest of the library.
    ///
    /// # Errors
    /// The manifest's, with the texts to show them in.
    pub fn load(library: Embedded) -> Result<Self, (SourceSet, Diagnostics)> {
        let (mut texts, manifest) = project::library_manifest(library)?;
        match NeedsTable::load(library, &mut texts, &manifest) {
            Ok(pictures) => {
                let (graphs, stages) = Default::default();
                let kept = Mutex::new(KeptPrograms { texts, graphs, stages });
                Ok(Self { library, manifest, pictures, kept })
            }
            Err(problems) => Err((texts, problems)),
        }
    }

    /// The library that has the programs.
    pub fn library(&self) -> Embedded {
        self.library
    }

    /// What pictures need from the programs.
    pub fn pictures(&self) -> &NeedsTable {
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

    /// Calls a function with the texts that were read so far.
    pub fn with_texts<T>(&self, run: impl FnOnce(&mut SourceSet) -> T) -> T {
        run(&mut self.kept().texts)
    }

    /// Composes both stages of a program.
    ///
    /// # Errors
    /// Those of the composition, and a program that does not exist in the language.
    pub fn stages(
        &self,
        program: &Program,
        settings: &Settings,
        language: Language,
    ) -> Result<Stages, Diagnostics> {
        let asked = (program.name.clone(), settings.clone(), language);
        if let Some(stages) = self.kept().again(&asked) {
            return Ok(stages);
        }
        let stages = self.composed_stages(program, settings, language)?;
        let mut kept = self.kept();
        kept.stages.push_back((asked, stages.clone()));
        if kept.stages.len() > KEPT_STAGES {
            kept.stages.pop_front();
        }
        Ok(stages)
    }

    fn composed_stages(
        &self,
        program: &Program,
        settings: &Settings,
        language: Language,
    ) -> Result<Stages, Diagnostics> {
        match (language, &program.wesl, &program.glsl) {
            (Language::Wesl, Some(file), _) => self.of_wesl(file, settings),
            (Language::Glsl, _, Some(glsl)) => {
                let vertex =
                    glsl.vertex.as_ref().ok_or_else(|| absent_language(program, language))?;
                let stage = |file: &ManifestFile| {
                    self.composed(file, settings, language)
                        .and_then(|text| ready_text(&text, "main"))
                };
                Ok(Stages {
                    vertex: stage(vertex)?,
                    fragment: glsl.fragment.as_ref().map(stage).transpose()?,
                })
            }
            _ => Err(absent_language(program, language)),
        }
    }

    fn of_wesl(&self, file: &ManifestFile, settings: &Settings) -> Result<Stages, Diagnostics> {
        let text = self.composed(file, settings, Language::Wesl)?;
        let mut points = text.validated.module.entry_points.iter();
        let has_fragment = points.any(|point| point.name == "fs_main");
        let fragment = if has_fragment { Some(ready_text(&text, "fs_main")?) } else { None };
        Ok(Stages { vertex: ready_text(&text, "vs_main")?, fragment })
    }

    fn composed(
        &self,
        file: &ManifestFile,
        settings: &Settings,
        language: Language,
    ) -> Result<CompiledText, Diagnostics> {
        let composed =
            compose::compose(&*self.graph(file, language)?, settings, &Options::default())?;
        let validated = Arc::new(validate(&composed)?);
        let functions = library_functions(&composed, &self.kept().texts);
        Ok(CompiledText { text: composed.text.into(), functions, validated })
    }

    fn graph(&self, file: &ManifestFile, language: Language) -> Result<Arc<Graph>, Diagnostics> {
        let mut kept = self.kept();
        if let Some(graph) = kept.graphs.get(&file.path) {
            return Ok(graph.clone());
        }
        let graph = Arc::new(resolve::load(
            &mut kept.texts,
            &project::library_packages(self.library),
            &file.path,
            language,
        )?);
        kept.graphs.insert(file.path.clone(), graph.clone());
        Ok(graph)
    }

    fn kept(&self) -> MutexGuard<'_, KeptPrograms> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A composed text, compiled.
struct CompiledText {
    text: Arc<str>,
    functions: Arc<[String]>,
    validated: Arc<Validated>,
}

/// The functions of a text that are in modules of the library, in the order of their paths.
fn library_functions(composed: &compose::Composed, texts: &SourceSet) -> Arc<[String]> {
    let functions = composed.parts.iter().filter(|part| part.kind == PartKind::Function);
    let path = |part: &compose::Part| {
        let file = &texts.get(composed.place_of(part)?.source).path;
        let (module, _) = file.rsplit_once('.')?;
        let is_module = !module.contains("programs/");
        let name = part.names.first().filter(|_| is_module)?;
        Some(format!("{}::{name}", module.trim_start_matches("lamplight/").replace('/', "::")))
    };
    functions.filter_map(path).collect::<BTreeSet<_>>().into_iter().collect()
}

fn ready_text(text: &CompiledText, entry: &'static str) -> Result<ReadyStage, Diagnostics> {
    let reflection = reflect(&text.validated, entry).map_err(|problem| vec![problem])?;
    Ok(ReadyStage {
        validated: text.validated.clone(),
        entry,
        reflection,
        text: text.text.clone(),
        functions: text.functions.clone(),
    })
}

fn absent_language(program: &Program, language: Language) -> Diagnostics {
    let name = match language {
        Language::Wesl => "WESL",
        Language::Glsl => "GLSL",
    };
    vec![Diagnostic::error(
        codes::UNKNOWN_PROGRAM,
        format!("there is no program `{}` in {name}", program.name),
    )]
}

//! What `compose` and `compile` share: a root module, its package, its settings.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::failure::{DiagnosticForm, Failure, warn};
use crate::compose::{self, Composed, Keep, Language, Mangle, Options};
use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use crate::permute::{Program, Quoted, Setting, Settings, key};
use crate::project::{self, Project};
use crate::resolve;
use crate::source::{SourceSet, Span};

/// A root module with its settings.
#[derive(Args)]
pub struct Input {
    /// Path to the root module.
    pub file: PathBuf,
    /// The package's root directory [default: from the nearest wesl.toml, else the file's folder].
    #[arg(long, value_name = "DIR")]
    root: Option<PathBuf>,
    /// The source language [default: by the file's extension].
    #[arg(long, value_enum)]
    lang: Option<LanguageName>,
    /// Choose an axis's value.
    #[arg(long, value_name = "AXIS=VALUE", value_parser = axis_value)]
    set: Vec<(String, Setting)>,
    /// Turn a feature on, or off with `=false`.
    #[arg(long, value_name = "NAME[=BOOL]", value_parser = feature)]
    feature: Vec<(String, Setting)>,
    /// How imported items are named.
    #[arg(long, value_enum, default_value_t)]
    mangle: MangleName,
    /// Keep items that no entry point reaches.
    #[arg(long)]
    keep_all: bool,
}

/// [`Language`] as an option's value.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum LanguageName {
    Wesl,
    Glsl,
}

impl From<LanguageName> for Language {
    fn from(name: LanguageName) -> Self {
        match name {
            LanguageName::Wesl => Self::Wesl,
            LanguageName::Glsl => Self::Glsl,
        }
    }
}

#[derive(Clone, Copy, Default, ValueEnum)]
enum MangleName {
    /// Only names that collide change.
    #[default]
    Collisions,
    /// The underscore-count form of the WESL specification.
    Underscore,
}

fn axis_value(text: &str) -> Result<(String, Setting), String> {
    let (name, value) = text.split_once('=').ok_or("expected AXIS=VALUE")?;
    Ok((name.to_owned(), Setting::parse(value)))
}

fn feature(text: &str) -> Result<(String, Setting), String> {
    let (name, value) = text.split_once('=').unwrap_or((text, "true"));
    match Setting::parse(value) {
        value @ Setting::Bool(_) => Ok((name.to_owned(), value)),
        _ => Err(format!("a feature is `true` or `false`, not `{value}`")),
    }
}

/// A composed root module with what diagnostics need.
pub struct Ready {
    pub project: Project,
    pub composed: Composed,
}

impl Input {
    /// Opens the package, chooses the settings and composes.
    pub fn compose(&self, form: DiagnosticForm) -> Result<Ready, Failure> {
        let root = self.root.clone().unwrap_or_else(|| project::root_of(&self.file));
        let mut project =
            project::open(&root, SourceSet::default()).map_err(|(sources, diagnostics)| Failure::Input(sources, diagnostics))?;
        match self.compose_in(&mut project, &root) {
            Ok(composed) => {
                warn(&project.sources, &composed.warnings, form);
                Ok(Ready { project, composed })
            }
            Err(diagnostics) => Err(Failure::Input(project.sources, diagnostics)),
        }
    }

    fn compose_in(&self, project: &mut Project, root: &Path) -> Result<Composed, Diagnostics> {
        let path = project::relative(&self.file, root).map_err(|diagnostic| vec![diagnostic])?;
        let (settings, mut warnings) = self.settings(project, root, &path)?;
        let graph = resolve::load(&mut project.sources, &project.packages, &path, self.language())?;
        let mut composed = compose::compose(&graph, &settings, &self.options())?;
        warnings.append(&mut composed.warnings);
        composed.warnings = warnings;
        Ok(composed)
    }

    /// The language asked for, or else what the extension says.
    pub fn language(&self) -> Language {
        let glsl = self.file.extension().is_some_and(|extension| ["glsl", "vert", "frag", "comp"].iter().any(|known| extension == *known));
        match (self.lang, glsl) {
            (Some(name), _) => name.into(),
            (None, true) => Language::Glsl,
            (None, false) => Language::Wesl,
        }
    }

    fn options(&self) -> Options {
        let mangle = match self.mangle {
            MangleName::Collisions => Mangle::Collisions,
            MangleName::Underscore => Mangle::Underscore,
        };
        Options { mangle, keep: if self.keep_all { Keep::All } else { Keep::EntryPoints } }
    }

    /// What the command line chooses, over the defaults of the program that the file belongs to
    /// where the package's manifest has one.
    fn settings(&self, project: &mut Project, root: &Path, path: &str) -> Result<(Settings, Diagnostics), Diagnostics> {
        let manifest = project::manifest(root, &mut project.sources)?;
        let program =
            manifest.as_ref().and_then(|manifest| manifest.programs.iter().find(|program| program.files().any(|file| file.path == path)));
        let (mut settings, warnings) = match program {
            Some(program) => self.assignment(program, &mut project.sources)?,
            None => (Settings { values: self.set.iter().cloned().collect(), ..Settings::default() }, Vec::new()),
        };
        settings.values.extend(self.feature.iter().cloned());
        Ok((settings, warnings))
    }

    /// The point of the program's space that `--set` names; broken constraints are warnings, since
    /// the composition has a meaning all the same.
    fn assignment(&self, program: &Program, sources: &mut SourceSet) -> Result<(Settings, Diagnostics), Diagnostics> {
        let parts: Vec<String> = self.set.iter().map(|(axis, value)| format!("{axis}={value}")).collect();
        let id = sources.add("--set", parts.join(","));
        let point = key::parse(&program.space, &Quoted::whole(sources, id))?;
        let span = Span::new(id, 0..sources.get(id).text.len());
        let broken = program.space.broken(&point).map(|constraint| {
            let warning = Diagnostic::warning(codes::INVALID_KEY, format!("program `{}` has no such permutation", program.name));
            warning.at(span, "these values").at(constraint.span, "break this constraint")
        });
        Ok((program.space.settings(&point), broken.collect()))
    }
}

//! What `compose` and `compile` share: a root module, its package, its settings.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::failure::{DiagnosticForm, Failure, print_warnings};
use super::{features, includes, stream};
use crate::bundle::{Conventions, Language, Stage};
use crate::compose::{self, Composed, Keep, Mangle, Options};
use crate::diagnostic::{Diagnostic, Diagnostics, Severity, codes};
use crate::generate;
use crate::parse::words::is_word;
use crate::permute::manifest::Features;
use crate::permute::{Assignment, Manifest, Program, Quoted, Setting, Settings, key};
use crate::project::{self, Project};
use crate::resolve::{self, Graph};
use crate::source::{SourceId, SourceSet, Span};

/// How a root module is read and what is chosen of it.
#[derive(Args, Clone)]
pub struct InputArguments {
    /// The package's root directory [default: from the nearest wesl.toml or lamplight.toml, else
    /// the file's folder].
    #[arg(long, value_name = "DIR")]
    root: Option<PathBuf>,
    /// The source language [default: by the file's extension].
    #[arg(long, value_enum)]
    lang: Option<LanguageName>,
    /// The stage of GLSL from standard input, or from a file whose name does not say it.
    #[arg(long, value_enum)]
    stage: Option<StageName>,
    /// The other stage of the program, in GLSL: locations and bindings that the two files leave open
    /// are counted over both [default: that of the program in the manifest].
    #[arg(long, value_name = "FILE")]
    with: Option<PathBuf>,
    /// Choose an axis's value.
    #[arg(long, value_name = "AXIS=VALUE", value_delimiter = ',', value_parser = axis_value)]
    set: Vec<(String, Setting)>,
    /// Turn a feature on, or turn it off with `=false`.
    #[arg(long, value_name = "NAME[=BOOL]", value_delimiter = ',', value_parser = parse_feature)]
    feature: Vec<(String, Setting)>,
    #[command(flatten)]
    features: features::Arguments,
    #[command(flatten)]
    includes: includes::Arguments,
    /// How imported items are named.
    #[arg(long, value_enum, default_value_t)]
    mangle: MangleName,
    /// Keep items that no entry point reaches.
    #[arg(long)]
    keep_all: bool,
}

/// [`Stage`] as an option's value.
#[derive(Clone, Copy, ValueEnum)]
enum StageName {
    Vertex,
    Fragment,
    Compute,
}

impl From<StageName> for Stage {
    fn from(name: StageName) -> Self {
        match name {
            StageName::Vertex => Self::Vertex,
            StageName::Fragment => Self::Fragment,
            StageName::Compute => Self::Compute,
        }
    }
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
    /// Rename items only if their names collide.
    #[default]
    Collisions,
    /// Give every imported item the name that the WESL specification suggests.
    Underscore,
}

/// Parses an option's `AXIS=VALUE`.
pub fn axis_value(text: &str) -> Result<(String, Setting), String> {
    let (name, value) = text.split_once('=').ok_or("expected AXIS=VALUE")?;
    Ok((plain_name(name)?, Setting::parse(value)))
}

/// The names of the settings that `--set` gives a number: these are integers.
pub fn numbered(set: &[(String, Setting)]) -> BTreeSet<String> {
    let is_integer = |setting: &&(String, Setting)| matches!(setting.1, Setting::Int(_));
    set.iter().filter(is_integer).map(|(name, _)| name.clone()).collect()
}

/// Checks that text from an option can name a feature, an axis or a constant.
pub fn plain_name(name: &str) -> Result<String, String> {
    if name.is_ascii() && is_word(name) {
        Ok(name.to_owned())
    } else {
        Err(format!("`{name}` is not a name of letters, digits and `_`"))
    }
}

/// Parses the value of `--feature`: `NAME` turns a feature on, `NAME=BOOL` chooses its value.
pub fn parse_feature(text: &str) -> Result<(String, Setting), String> {
    let (name, value) = text.split_once('=').unwrap_or((text, "true"));
    match Setting::parse(value) {
        value @ Setting::Bool(_) => Ok((plain_name(name)?, value)),
        _ => Err(format!("a feature is `true` or `false`, not `{value}`")),
    }
}

/// An error for each constraint that a permutation breaks. Its label is the whole source `id`,
/// which holds the permutation's key.
pub fn broken_constraint(
    program: &Program,
    point: &Assignment,
    sources: &SourceSet,
    id: SourceId,
) -> Diagnostics {
    let span = Span::new(id, 0..sources.get(id).text.len());
    let broken = program.space.broken(point).map(|constraint| {
        let error = Diagnostic::error(
            codes::INVALID_PERMUTATION,
            format!("program `{}` has no such permutation", program.name),
        );
        error.at(span, "these values").at(constraint.span, "break this constraint")
    });
    broken.collect()
}

/// A composed root module with what diagnostics need.
pub struct ComposedInput {
    pub sources: SourceSet,
    pub composed: Composed,
    pub context: ErrorContext,
}

/// What a composed text was made from, for reporting its errors.
pub struct ErrorContext {
    pub graph: Graph,
    pub settings: Settings,
    pub options: Options,
    /// The conventions of the program that the file belongs to, or else the defaults.
    pub conventions: Conventions,
    /// Lines with the numbers that GLSL leaves open, if the other stage is known.
    pub numbers: String,
    /// The file of the other stage, by its path in the package, if it is known.
    pub partner: Option<String>,
    permutation: Option<String>,
}

impl ErrorContext {
    /// Adds the permutation to warnings as a note, and drops those that only the author of a
    /// dependency can mend.
    pub fn own(&self, warnings: Diagnostics) -> Diagnostics {
        of_permutation(self.graph.own(warnings), self.permutation.as_deref())
    }

    /// Adds the chain of imports and the permutation as notes.
    pub fn explain(&self, diagnostics: Diagnostics) -> Diagnostics {
        of_permutation(self.graph.traced(diagnostics), self.permutation.as_deref())
    }
}

fn of_permutation(diagnostics: Diagnostics, permutation: Option<&str>) -> Diagnostics {
    let one = |diagnostic: Diagnostic| permutation.into_iter().fold(diagnostic, Diagnostic::note);
    diagnostics.into_iter().map(one).collect()
}

/// The path of the stage of a program in GLSL that a file is not.
fn partner_of(program: &Program, path: &str) -> Option<String> {
    let glsl = program.glsl.as_ref()?;
    let stages = [&glsl.vertex, &glsl.fragment].map(|file| file.as_ref().map(|file| &file.path));
    match stages {
        [Some(vertex), Some(fragment)] if vertex == path => Some(fragment.clone()),
        [Some(vertex), Some(fragment)] if fragment == path => Some(vertex.clone()),
        _ => None,
    }
}

/// The settings of a composition, as chosen.
struct ChosenSettings {
    settings: Settings,
    conventions: Conventions,
    /// The path of the other stage in GLSL.
    partner: Option<String>,
    /// The text of a note that names the chosen settings.
    permutation: Option<String>,
    /// Whether the axes come from a manifest.
    declared: bool,
    /// Names of the axes.
    axes: Vec<String>,
    warnings: Diagnostics,
}

impl InputArguments {
    /// Opens the package of a root module, chooses the settings and composes.
    pub fn compose(
        &self,
        file: &Path,
        sources: SourceSet,
        form: DiagnosticForm,
    ) -> Result<ComposedInput, Failure> {
        self.check_usage()?;
        let language = self.language(file)?;
        let root = self.root_of(file);
        let opened = project::open(&root, sources);
        let mut project =
            opened.map_err(|(sources, diagnostics)| Failure::Input(sources, diagnostics))?;
        let path = if stream::is_stream(file) {
            let name = stream::stream_name(language, self.stage());
            let text = stream::read_stream(file)?;
            let below = project.packages.root.files;
            project.packages.root.files =
                Box::new(stream::StreamOverlay { below, name: name.clone(), text });
            Ok(name)
        } else {
            project::relative(file, &root)
        };
        let composed = path
            .map_err(|diagnostic| vec![diagnostic])
            .and_then(|path| self.compose_in(&mut project, &root, &path, language));
        match composed {
            Ok((composed, context)) => {
                print_warnings(&project.sources, &composed.warnings, form);
                Ok(ComposedInput { sources: project.sources, composed, context })
            }
            Err(diagnostics) => Err(Failure::Input(project.sources, diagnostics)),
        }
    }

    /// The root that was asked for, or that the file belongs to; a stream is in the current folder.
    fn root_of(&self, file: &Path) -> PathBuf {
        let found = || {
            if stream::is_stream(file) {
                project::package_above(Path::new(".")).unwrap_or_else(|| PathBuf::from("."))
            } else {
                project::root_of(file)
            }
        };
        self.root.clone().unwrap_or_else(found)
    }

    fn compose_in(
        &self,
        project: &mut Project,
        root: &Path,
        path: &str,
        language: Language,
    ) -> Result<(Composed, ErrorContext), Diagnostics> {
        self.includes.apply(&mut project.packages)?;
        let mut chosen = self.settings(project, root, path)?;
        let graph = resolve::load(&mut project.sources, &project.packages, path, language)?;
        let options = self.options();
        let partner = match &self.with {
            Some(file) => Some(project::relative(file, root).map_err(|error| vec![error])?),
            None => chosen.partner.take(),
        };
        let numbers = match &partner {
            Some(partner) => self.numbers(project, &graph, path, partner)?,
            None => String::new(),
        };
        let mut composed = compose::compose(&graph, &chosen.settings, &options)
            .map_err(|errors| of_permutation(errors, chosen.permutation.as_deref()))?;
        chosen.warnings.extend(self.unused(&graph, &chosen.axes));
        if chosen.declared {
            chosen.warnings.extend(graph.undeclared(&chosen.settings));
        }
        chosen.warnings.append(&mut composed.warnings);
        composed.warnings = project.packages.warnings.clone();
        composed.warnings.append(&mut chosen.warnings);
        let ChosenSettings { settings, conventions, permutation, .. } = chosen;
        let context =
            ErrorContext { graph, settings, options, conventions, numbers, partner, permutation };
        Ok((composed, context))
    }

    /// The numbers of a file that it leaves open, counted over it and the other stage.
    fn numbers(
        &self,
        project: &mut Project,
        graph: &Graph,
        path: &str,
        partner: &str,
    ) -> Result<String, Diagnostics> {
        let refuse = |message: String| Err(vec![Diagnostic::error(codes::UNKNOWN_STAGE, message)]);
        let stage = self.stage().or_else(|| compose::glsl::named_stage(path));
        let other = match (graph, stage) {
            (Graph::Glsl(_), Some(Stage::Vertex)) => Stage::Fragment,
            (Graph::Glsl(_), Some(Stage::Fragment)) => Stage::Vertex,
            _ => {
                return refuse(format!(
                    "`{path}` is no vertex or fragment shader in GLSL, and has no other stage"
                ));
            }
        };
        if compose::glsl::named_stage(partner).is_some_and(|stage| stage != other) {
            return refuse(format!("`{partner}` has the same stage as `{path}`"));
        }
        let partner =
            resolve::load(&mut project.sources, &project.packages, partner, Language::Glsl)?;
        let [vertex, fragment] = match other {
            Stage::Fragment => generate::program_numbers(Some(graph), Some(&partner)),
            _ => generate::program_numbers(Some(&partner), Some(graph)),
        };
        Ok(if other == Stage::Fragment { vertex } else { fragment })
    }

    /// The package's root directory, if it is given.
    pub fn root(&self) -> Option<&Path> {
        self.root.as_deref()
    }

    /// The file of the other stage that is asked for.
    pub fn partner(&self) -> Option<&Path> {
        self.with.as_deref()
    }

    /// The same choices for a module that has all its stages.
    pub fn for_file(&self) -> Self {
        Self { with: None, ..self.clone() }
    }

    /// Whether files are wrapped, so that they are shaders of a site.
    pub fn wraps(&self) -> bool {
        self.includes.wraps()
    }

    /// The same choices for the file of the other stage. `partner` is the first file, which is no
    /// partner of a module in WESL: that has all stages.
    pub fn for_partner(&self, partner: Option<&Path>) -> Self {
        Self { with: partner.map(Path::to_owned), stage: None, ..self.clone() }
    }

    /// The permutation that `--set` chooses.
    pub fn chosen_axes(&self) -> &[(String, Setting)] {
        &self.set
    }

    /// The same choices with another permutation.
    pub fn with_axes(&self, set: Vec<(String, Setting)>) -> Self {
        Self { set, ..self.clone() }
    }

    /// Whether something is asked for that only a file of the user's has.
    pub fn is_about_file(&self) -> bool {
        self.root.is_some()
            || self.stage.is_some()
            || self.with.is_some()
            || !self.feature.is_empty()
            || self.includes.wraps()
    }

    /// The root of the package that a file belongs to.
    pub fn package_root(&self, file: &Path) -> PathBuf {
        self.root_of(file)
    }

    /// The stage that is asked for.
    fn stage(&self) -> Option<Stage> {
        let wrapped = self.includes.wraps().then_some(Stage::Fragment);
        self.stage.map(Stage::from).or(wrapped)
    }

    /// Whether the language of a text is chosen.
    pub fn names_language(&self) -> bool {
        self.lang.is_some() || self.stage().is_some()
    }

    /// The language asked for.
    pub fn chosen_language(&self) -> Option<Language> {
        self.lang.map(Language::from)
    }

    /// The language asked for, or else what the extension says.
    pub fn language(&self, file: &Path) -> Result<Language, Failure> {
        let extension = file.extension().unwrap_or_default().to_string_lossy();
        match (self.lang, &*extension) {
            (Some(name), _) => Ok(name.into()),
            (None, _) if self.stage().is_some() => Ok(Language::Glsl),
            (None, "glsl") => Ok(Language::Glsl),
            (None, _) if compose::glsl::named_stage(&file.to_string_lossy()).is_some() => {
                Ok(Language::Glsl)
            }
            (None, "wesl" | "wgsl") => Ok(Language::Wesl),
            (None, _) if file.is_dir() => Ok(Language::Wesl),
            (None, _) => Err(Failure::usage(format!(
                "cannot tell the language of `{}` from its name: add `--lang`",
                file.display()
            ))),
        }
    }

    /// A setting that is chosen twice is a mistake, so neither value is taken.
    fn check_usage(&self) -> Result<(), Failure> {
        let mut names: Vec<&str> = self.chosen().map(|(name, _)| name.as_str()).collect();
        names.sort_unstable();
        match names.windows(2).find(|pair| pair[0] == pair[1]) {
            Some(pair) => Err(Failure::usage(format!("`{}` is set twice", pair[0]))),
            None => Ok(()),
        }
    }

    fn chosen(&self) -> impl Iterator<Item = &(String, Setting)> {
        self.set.iter().chain(&self.feature)
    }

    /// Warns of settings on the command line that are not axes and that nothing can ask for.
    fn unused(&self, graph: &Graph, axes: &[String]) -> Diagnostics {
        let unused = self.chosen().map(|(name, _)| name);
        let unused = unused.filter(|name| !axes.contains(name) && !graph.may_ask(name)).cloned();
        let constants = self.features.constants().into_keys();
        let constants = constants.filter(|name| !graph.has_constant(name));
        let warning = |name: String| {
            Diagnostic::warning(codes::UNUSED_SETTING, format!("nothing asks for `{name}`"))
        };
        unused.chain(constants).map(warning).collect()
    }

    fn options(&self) -> Options {
        let mangle = match self.mangle {
            MangleName::Collisions => Mangle::Collisions,
            MangleName::Underscore => Mangle::Underscore,
        };
        let keep = if self.keep_all { Keep::All } else { Keep::EntryPoints };
        Options { mangle, keep, stage: self.stage() }
    }

    /// The settings from the command line, and the defaults of the program that the file belongs
    /// to, if the package's manifest has one.
    fn settings(
        &self,
        project: &mut Project,
        root: &Path,
        path: &str,
    ) -> Result<ChosenSettings, Diagnostics> {
        let manifest = project::manifest_outline(root, &mut project.sources)?;
        let program = manifest.as_ref().and_then(|manifest| {
            manifest.programs.iter().find(|program| program.files().any(|file| file.path == path))
        });
        match program {
            Some(program) => {
                let features = manifest.as_ref().map(|manifest| &manifest.features);
                let mut chosen = self.of_program(program, features, &mut project.sources)?;
                chosen.partner = partner_of(program, path);
                Ok(chosen)
            }
            None => self.free(root, manifest, &mut project.sources),
        }
    }

    fn free(
        &self,
        root: &Path,
        manifest: Option<Manifest>,
        sources: &mut SourceSet,
    ) -> Result<ChosenSettings, Diagnostics> {
        let mut settings = Settings {
            values: self.chosen().cloned().collect(),
            integers: numbered(&self.set),
            undeclared: self.features.undeclared(None),
            constants: self.features.constants(),
            ..Settings::default()
        };
        let parts: Vec<String> =
            settings.values.iter().map(|(name, value)| format!("{name}={value}")).collect();
        let declared = match manifest {
            Some(manifest) => manifest.features,
            None => project::features(root, sources)?,
        };
        declared.complete(&mut settings);
        let warnings = declared.broken(&settings);
        let permutation =
            (!parts.is_empty()).then(|| format!("with the settings `{}`", parts.join(",")));
        Ok(ChosenSettings {
            settings,
            conventions: Conventions::default(),
            partner: None,
            permutation,
            declared: false,
            axes: Vec::new(),
            warnings,
        })
    }

    /// The point of the program's space that the options name. A broken constraint is a warning,
    /// since the composition has a meaning all the same. A feature that is not an axis is one more
    /// flag.
    fn of_program(
        &self,
        program: &Program,
        features: Option<&Features>,
        sources: &mut SourceSet,
    ) -> Result<ChosenSettings, Diagnostics> {
        let is_axis = |name: &str| program.space.axis(name).is_some();
        let of_axes = self.feature.iter().filter(|(name, _)| is_axis(name));
        let parts: Vec<String> =
            self.set.iter().chain(of_axes).map(|(axis, value)| format!("{axis}={value}")).collect();
        let id = sources.add("--set", parts.join(","));
        let point = key::parse(&program.space, &Quoted::whole(sources, id))?;
        let broken = broken_constraint(program, &point, sources, id)
            .into_iter()
            .map(|error| Diagnostic { severity: Severity::Warning, ..error });
        let mut settings = program.space.settings(&point);
        settings.undeclared = self.features.undeclared(settings.undeclared);
        settings.values.extend(self.feature.iter().filter(|(name, _)| !is_axis(name)).cloned());
        settings.constants = self.features.constants();
        let both = features.map(|features| features.broken(&settings)).unwrap_or_default();
        let permutation = Some(format!(
            "in permutation `{}` of program `{}`",
            program.space.key(&point),
            program.name
        ));
        let axes = program.space.axes().iter().map(|axis| axis.name.clone()).collect();
        let (conventions, warnings) = (program.conventions, broken.chain(both).collect());
        let partner = None;
        Ok(ChosenSettings {
            settings,
            conventions,
            partner,
            permutation,
            declared: true,
            axes,
            warnings,
        })
    }
}

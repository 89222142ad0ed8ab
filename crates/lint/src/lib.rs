//! Checks a whole package, whether or not anything reaches a declaration: every module is composed
//! with everything that it declares, and validated by naga.

mod case;
mod documented;
mod flags;
mod settings;
mod stages;

pub use case::alike_entry_points;
pub use documented::{DocumentedParameter, documented_parameters};

use std::collections::{BTreeMap, BTreeSet};

use lamplight_bundle::Language;
use lamplight_compose::glsl::named_stage;
use lamplight_compose::resolve::wesl::{self, Reductions};
use lamplight_compose::resolve::{self, Graph, Packages};
use lamplight_compose::{self as compose, Composed, Keep, Options};
use lamplight_diagnostic::source::SourceSet;
use lamplight_diagnostic::{Diagnostic, Diagnostics, Severity, codes};
use lamplight_files::limits::{LINT_FILES, LINT_WHOLE_FILES};
use lamplight_permute::{Manifest, Settings};
use lamplight_validate as validate;

/// What to check, and with which settings.
pub struct Request<'a> {
    /// The package and what it may import.
    pub packages: &'a Packages,
    /// The package's manifest, whose axes have values.
    pub manifest: Option<&'a Manifest>,
    /// The settings that are chosen in addition to the manifest's axes.
    pub settings: &'a Settings,
    /// Paths below the package's root.
    pub paths: &'a [String],
}

/// What was found.
#[derive(Debug, Default)]
pub struct Linted {
    /// Each once, by place.
    pub diagnostics: Diagnostics,
    /// Modules that were looked at.
    pub modules: usize,
}

/// The language of a file by its name, if it is a module.
pub fn language(path: &str) -> Option<Language> {
    match path.rsplit_once('.')?.1 {
        "wesl" | "wgsl" => Some(Language::Wesl),
        "glsl" => Some(Language::Glsl),
        _ => named_stage(path).map(|_| Language::Glsl),
    }
}

/// Extensions of the modules that are looked for in folders. Files that end in `.cs` and `.fs` are
/// often something else, so they are modules only where they are named.
pub const EXTENSIONS: &[&str] = &["wesl", "wgsl", "glsl", "vert", "frag", "comp"];

/// Looks at modules of the root package.
///
/// Modules of a small package are checked with everything that they reach. If many reach much, the
/// time would grow with the square of the package, so the rest are checked with reduced forms of
/// what is far from them ([`Reductions`]).
pub fn lint(sources: &mut SourceSet, request: &Request<'_>) -> Linted {
    lint_within(sources, request, LINT_WHOLE_FILES)
}

/// As [`lint`], with another number of files, counted at each reading, after which what is far from
/// a module is reduced.
pub fn lint_within(sources: &mut SourceSet, request: &Request<'_>, whole: u64) -> Linted {
    let mut graphs = BTreeMap::new();
    let mut reductions = Reductions::default();
    let mut linted = Linted::default();
    for path in request.paths {
        let Some(language) = language(path) else { continue };
        if reductions.files_read() > whole.saturating_add(LINT_FILES) {
            linted.diagnostics.push(too_many_files(path));
            break;
        }
        linted.modules += 1;
        reductions.begin(reductions.files_read() >= whole);
        match load(sources, request.packages, path, language, &mut reductions) {
            Ok(graph) => {
                graphs.insert(path.clone(), graph);
            }
            Err(errors) => linted.diagnostics.extend(reductions.visible(errors)),
        }
    }
    linted.diagnostics.extend(case::alike_modules(graphs.iter()));
    let included = included_files(sources, &graphs);
    for (path, graph) in &graphs {
        linted.diagnostics.extend(case::alike_entry_points(graph));
        linted.diagnostics.extend(reductions.visible(flags::undeclared_flags(graph, request)));
        // A GLSL file that others include is checked where it is included.
        if !included.contains(&request.packages.root.files.display(path)) {
            let found = lint_module(graph, request, path);
            linted.diagnostics.extend(reductions.visible(found));
        }
    }
    Linted { diagnostics: distinct_in_order(sources, linted.diagnostics), ..linted }
}

fn load(
    sources: &mut SourceSet,
    packages: &Packages,
    path: &str,
    language: Language,
    reductions: &mut Reductions,
) -> Result<Graph, Diagnostics> {
    match language {
        Language::Wesl => wesl::load_reduced(sources, packages, path, reductions).map(Graph::Wesl),
        Language::Glsl => resolve::load(sources, packages, path, language),
    }
}

fn too_many_files(path: &str) -> Diagnostic {
    let most = LINT_WHOLE_FILES + LINT_FILES;
    let message = format!("the modules of this package reach more than {most} files in total");
    Diagnostic::error(codes::LIMIT_EXCEEDED, message)
        .note(format!("`{path}` and the modules after it were not checked"))
        .note("help: name folders or modules, to check a part of the package at a time")
}

/// Names of the GLSL files that others of the package include.
fn included_files(sources: &SourceSet, graphs: &BTreeMap<String, Graph>) -> BTreeSet<String> {
    let of = |graph: &Graph| match graph {
        Graph::Glsl(graph) => graph
            .modules
            .iter()
            .skip(1)
            .map(|module| sources.get(module.source).path.clone())
            .collect(),
        Graph::Wesl(_) => Vec::new(),
    };
    graphs.values().flat_map(of).collect()
}

/// Checks a module with each of the settings that matter to it.
fn lint_module(graph: &Graph, request: &Request<'_>, path: &str) -> Diagnostics {
    let mut found = Diagnostics::new();
    let mut texts = BTreeSet::new();
    for settings in settings::candidate_settings(graph, request, path) {
        let composed = compose::compose(graph, &settings, &lint_options(graph, path));
        match composed {
            Ok(composed) => {
                if texts.insert(composed.text.clone()) {
                    found.extend(graph.traced(lint_text(graph, &composed)));
                }
            }
            Err(errors) => {
                found.extend(errors);
                found.extend(one_by_one(graph, &settings));
            }
        }
    }
    found
}

/// Checks the items of a module one by one, if it cannot be composed as a whole.
pub fn one_by_one(graph: &Graph, settings: &Settings) -> Diagnostics {
    let mut found = Diagnostics::new();
    for name in graph.root_items() {
        let options = Options { keep: Keep::Items(vec![name]), ..Options::default() };
        match compose::compose(graph, settings, &options) {
            Ok(composed) => found.extend(graph.traced(lint_text(graph, &composed))),
            // An item that was asked for by name has no place if it is missing.
            Err(errors) => {
                found.extend(errors.into_iter().filter(|error| !error.labels.is_empty()))
            }
        }
    }
    found
}

/// Options that keep everything that a module declares. For a GLSL file with a stage in its name
/// they also keep what it includes.
pub fn lint_options(graph: &Graph, path: &str) -> Options {
    let keep = match graph {
        Graph::Glsl(_) if named_stage(path).is_some() => Keep::All,
        _ => Keep::Root,
    };
    Options { keep, ..Options::default() }
}

/// The warnings from composing a text, then what naga finds in it.
pub fn lint_text(graph: &Graph, composed: &Composed) -> Diagnostics {
    let mut warnings = graph.own(composed.warnings.clone());
    if let Graph::Glsl(graph) = graph
        && named_stage(&graph.root).is_some()
    {
        warnings.extend(stages::mistakes_of_stage(composed));
    }
    let found = match composed.language {
        Language::Wesl => lint_wgsl(graph, composed),
        Language::Glsl => lint_glsl(graph, composed),
    };
    warnings.extend(found.unwrap_or_else(|errors| errors));
    warnings
}

fn lint_wgsl(graph: &Graph, composed: &Composed) -> Result<Diagnostics, Diagnostics> {
    let validated = validate::validate_every(composed)?;
    let mut found = graph.own(documented::contradictions(composed));
    found.extend(graph.own(validate::lint_wgsl(composed, false)));
    let lacking = validate::lacking(composed, &validated, validate::CAPABILITIES);
    // A target that is asked for and lacks it is an error of `compile`.
    found.extend(lacking.map(|error| Diagnostic { severity: Severity::Warning, ..error }));
    Ok(found)
}

fn lint_glsl(graph: &Graph, composed: &Composed) -> Result<Diagnostics, Diagnostics> {
    let mut wgsl = validate::glsl_as_plain_wgsl(composed, Default::default())?.wgsl;
    let warnings = std::mem::take(&mut wgsl.warnings);
    let found = validate::validate_translation(&wgsl)?;
    let own = documented::contradictions(&wgsl).into_iter().chain(warnings).chain(found);
    Ok(graph.own(own.collect()))
}

/// Each diagnostic once, in the order of places. A module is read again for each one that reaches
/// it.
fn distinct_in_order(sources: &SourceSet, found: Diagnostics) -> Diagnostics {
    let key = |diagnostic: &Diagnostic| {
        let place = diagnostic.labels.first().map(|label| {
            (sources.get(label.span.source).path.clone(), label.span.start, label.span.end)
        });
        (place, diagnostic.code.name, diagnostic.message.clone())
    };
    let mut known = BTreeSet::new();
    let mut kept: Diagnostics =
        found.into_iter().filter(|diagnostic| known.insert(key(diagnostic))).collect();
    kept.sort_by_cached_key(key);
    kept
}

//! A module under the permutation that the editor shows: its diagnostics, and its inactive parts.

use std::collections::BTreeMap;
use std::ops::Range;

use super::package::OpenedPackage;

use lamplight_bundle::Language;
use lamplight_compose::resolve::wesl::{self, KeptModules};
use lamplight_compose::resolve::{self, Graph};
use lamplight_compose::{self as compose, Options};
use lamplight_diagnostic::Diagnostics;
use lamplight_lint as lint;
use lamplight_permute::{Program, Setting, Settings};
use lamplight_syntax::wesl::Event;

/// What was chosen for a package, by axis or feature.
pub type ChosenValues = BTreeMap<String, Setting>;

/// The settings of a module, and a note that names the permutation. They are those of the program
/// that has the module as a root, or else of the manifest's first program.
pub fn module_settings(
    opened: &OpenedPackage,
    path: &str,
    choice: &ChosenValues,
) -> (Settings, String) {
    let programs = || opened.manifest.iter().flat_map(|manifest| &manifest.programs);
    let is_root = |program: &&Program| program.files().any(|file| file.path == path);
    let program = programs().find(is_root).or_else(|| programs().next());
    let (mut settings, what) = match program {
        Some(program) => {
            let point = program.space.default_assignment();
            (program.space.settings(&point), format!("program `{}`", program.name))
        }
        None => (Settings::default(), "the package".to_owned()),
    };
    opened.features.complete(&mut settings);
    for (name, value) in choice {
        match (name.strip_prefix("constants::"), value) {
            (Some(constant), value) => {
                settings.constants.insert(constant.to_owned(), value.to_string());
            }
            (None, value) => drop(settings.values.insert(name.clone(), value.clone())),
        }
    }
    let chosen: Vec<String> =
        choice.iter().map(|(name, value)| format!("{name}={value}")).collect();
    let chosen = if chosen.is_empty() { "default".to_owned() } else { chosen.join(",") };
    (settings, format!("in permutation `{chosen}` of {what}"))
}

/// A graph with the module as its root, or the diagnostics of loading it.
pub fn module_graph(
    opened: &mut OpenedPackage,
    path: &str,
    kept: &mut KeptModules,
) -> Result<Graph, Diagnostics> {
    let (sources, packages) = (&mut opened.sources, &opened.packages);
    match lint::language(path) {
        Some(Language::Wesl) => wesl::load_kept(sources, packages, path, kept).map(Graph::Wesl),
        Some(language) => resolve::load(sources, packages, path, language),
        None => Err(Vec::new()),
    }
}

/// What is wrong with a module under the settings: names, conditions, then what naga says.
pub fn module_problems(graph: &Graph, settings: &Settings, path: &str) -> Diagnostics {
    let mut found = graph.undeclared(settings);
    found.extend(lint::alike_entry_points(graph));
    // Undeclared features are reported above. For the other checks they count as off.
    let settings = Settings { undeclared: settings.undeclared.or(Some(false)), ..settings.clone() };
    match compose::compose(graph, &settings, &lint::lint_options(graph, path)) {
        Ok(composed) => found.extend(lint::lint_text(graph, &composed)),
        Err(errors) => {
            found.extend(errors);
            for error in lint::one_by_one(graph, &settings) {
                if !found.contains(&error) {
                    found.push(error);
                }
            }
        }
    }
    found
}

/// The composed text of a module, as an entry point's lens opens it.
pub fn composed_text(graph: &Graph, settings: &Settings) -> Result<String, Diagnostics> {
    let settings = Settings { undeclared: settings.undeclared.or(Some(false)), ..settings.clone() };
    compose::compose(graph, &settings, &Options::default()).map(|composed| composed.text)
}

/// The parts of a WESL module that the settings take away, by place.
pub fn inactive_ranges(graph: &Graph, settings: &Settings) -> Vec<Range<u32>> {
    let Graph::Wesl(graph) = graph else { return Vec::new() };
    let Some(root) = graph.nodes.first() else { return Vec::new() };
    let settings = Settings { undeclared: settings.undeclared.or(Some(false)), ..settings.clone() };
    let mut answers = compose::wesl::Conditions::new(graph, &settings);
    let mut found = Vec::new();
    for item in &root.module.items {
        if item.condition.is_some_and(|condition| !answers.holds(0, condition)) {
            found.push(item.range.clone());
            continue;
        }
        let mut at = 0;
        while let Some(event) = item.events.get(at) {
            at += 1;
            if let Event::Node { condition, start, end, next } = *event
                && !answers.holds(0, condition)
            {
                found.push(start..end);
                at = next as usize;
            }
        }
    }
    let imports = root.module.imports.iter();
    found.extend(imports.filter_map(|import| {
        let holds = import.condition.is_none_or(|condition| answers.holds(0, condition));
        (!holds).then_some(import.path.range.start..import.alias_range.end)
    }));
    found.sort_by_key(|range| range.start);
    found
}

/// Whether a path names a WESL or GLSL file, by its extension.
pub fn is_module(path: &str) -> bool {
    lint::language(path).is_some()
}

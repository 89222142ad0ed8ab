//! Warns of imports without effect, and reports names that are declared or imported twice.

use std::collections::BTreeMap;

use rustc_hash::{FxHashMap, FxHashSet};

use super::graph::{Candidate, Graph, ModuleNode, PathTarget};
use super::load::Loader;
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_permute::Settings;
use lamplight_syntax::wesl::{ConditionId, Expression, Name, Origin, Path, UsedName};

/// Warnings about a module: those of the parser, and those about its imports. Modules of
/// dependencies have none, since their users cannot change them.
pub fn import_lints(loader: &Loader<'_>, node: &ModuleNode) -> Vec<Diagnostic> {
    if node.package != 0 {
        return Vec::new();
    }
    let names = &loader.names;
    let mut found = node.module.warnings.clone();
    let used = used_names(node);
    for import in &node.module.imports {
        let (text, span) = (names.text(import.alias), node.module.span(import.alias_range.clone()));
        let own = node
            .sets
            .get(&import.alias)
            .and_then(|set| set.first())
            .map(|index| &node.module.items[*index as usize]);
        match own {
            Some(item) if item.condition.is_none() && import.condition.is_none() => found.push(
                Diagnostic::warning(
                    codes::SHADOWED_IMPORT,
                    format!("`{text}` is both imported and declared"),
                )
                .at(span, "this import has no effect")
                .at(node.module.span(item.name_range.clone()), "the declaration wins"),
            ),
            _ if !used.contains(&import.alias) => {
                let message = format!("`{text}` is imported but never used");
                let warning =
                    Diagnostic::warning(codes::UNUSED_IMPORT, message).at(span, "not used");
                found.push(match absent_package(loader, node, &import.path) {
                    Some(package) => warning.note(format!("there is no package `{package}`")),
                    None => warning,
                });
            }
            _ => {}
        }
    }
    found
}

/// The name of the package that an import's path starts with, if there is no such package.
fn absent_package<'l>(loader: &'l Loader<'_>, node: &ModuleNode, path: &Path) -> Option<&'l str> {
    let is_there = |name: Name| {
        let text = loader.names.text(name);
        name == Name::CONSTANTS
            || loader.packages.find(node.package, text).is_some()
            || node.aliases.contains_key(&name)
    };
    let first = path.segments.first().copied().filter(|_| path.origin == Origin::Scope)?;
    (!is_there(first)).then(|| loader.names.text(first))
}

/// Whether an import that leads nowhere is not an error: nothing uses it, and its package is not
/// installed. The warning about unused imports covers that.
pub fn is_harmless(loader: &mut Loader<'_>, node: u32, alias: Name, failure: u32) -> bool {
    loader.failures[failure as usize].code == codes::UNKNOWN_PACKAGE && !loader.is_used(node, alias)
}

/// Reports declarations of one name that the same settings keep, whether or not anything reaches
/// them: those without a condition, and those of one block.
pub fn report_duplicates(loader: &mut Loader<'_>, node: u32) {
    let here = &loader.nodes[node as usize];
    let mut first: FxHashMap<(Name, Option<ConditionId>), usize> = FxHashMap::default();
    let mut found = Vec::new();
    for (index, item) in here.module.items.iter().enumerate() {
        let earlier = *first.entry((item.name, item.condition)).or_insert(index);
        if earlier != index && item.name != Name::UNDERSCORE {
            let error = here.declared_twice(&loader.names, index, earlier);
            found.push((item.condition, error));
        }
    }
    for (condition, error) in found {
        if let PathTarget::Failed(index) = loader.fail(error) {
            loader.nodes[node as usize].duplicates.push((condition, index));
        }
    }
}

/// Reports unconditional imports of different things under one name.
pub fn report_clashes(
    loader: &mut Loader<'_>,
    node: u32,
    imported: &FxHashMap<Name, Vec<Candidate>>,
) {
    let mut failures = Vec::new();
    let here = &loader.nodes[node as usize];
    let clashing: FxHashSet<Name> = imported
        .iter()
        .filter(|(_, candidates)| candidates_differ(candidates))
        .map(|(alias, _)| *alias)
        .collect();
    let mut first: FxHashMap<Name, usize> = FxHashMap::default();
    for (index, import) in
        here.module.imports.iter().enumerate().filter(|(_, import)| import.condition.is_none())
    {
        let earlier = *first.entry(import.alias).or_insert(index);
        if earlier != index && clashing.contains(&import.alias) {
            let message = format!(
                "`{}` is imported twice, from different places",
                loader.names.text(import.alias)
            );
            failures.push(
                Diagnostic::error(codes::DUPLICATE_ITEM, message)
                    .at(here.module.span(import.alias_range.clone()), "imported again")
                    .at(
                        here.module.span(here.module.imports[earlier].alias_range.clone()),
                        "imported first",
                    )
                    .note("help: give one another name with `as`"),
            );
        }
    }
    for failure in failures {
        if let PathTarget::Failed(index) = loader.fail(failure) {
            loader.nodes[node as usize].broken_imports.push((Vec::new(), index));
        }
    }
}

/// Whether candidates lead to different things. Those that lead nowhere do not count.
fn candidates_differ(candidates: &[Candidate]) -> bool {
    let mut targets = candidates
        .iter()
        .map(|candidate| candidate.target)
        .filter(|target| !matches!(target, PathTarget::Failed(_)));
    let first = targets.next();
    targets.any(|target| Some(target) != first)
}

/// The names with which references and paths of imports start. If an import's own path starts with
/// the name that it imports, that means a package.
pub fn used_names(node: &ModuleNode) -> FxHashSet<Name> {
    let start =
        |path: &Path| path.segments.first().copied().filter(|_| path.origin == Origin::Scope);
    let named = node.module.references.iter().filter_map(|reference| match reference {
        UsedName::Name(name) => Some(*name),
        UsedName::Path(path) => start(path),
    });
    let passed = node
        .module
        .imports
        .iter()
        .filter_map(|import| start(&import.path).filter(|name| *name != import.alias));
    named.chain(passed).collect()
}

/// The most places that one diagnostic shows. The others are counted.
pub const PLACES: usize = 12;

/// Every place of a condition that names a flag, by flag, dependencies' included.
pub fn flag_places(graph: &Graph) -> FxHashMap<Name, Vec<Span>> {
    let mut places: FxHashMap<Name, Vec<Span>> = FxHashMap::default();
    for node in &graph.nodes {
        for expression in &node.module.expressions {
            if let Expression::Flag(name, range) = expression {
                places.entry(*name).or_default().push(node.module.span(range.clone()));
            }
        }
    }
    places
}

/// The diagnostic with labels at the first places, and a note that counts the others.
pub fn shown_at(error: Diagnostic, mut places: Vec<Span>, label: &str) -> Diagnostic {
    places.sort_unstable();
    places.dedup();
    let hidden = places.len().saturating_sub(PLACES);
    let error = places.into_iter().take(PLACES).fold(error, |error, span| error.at(span, label));
    match hidden {
        0 => error,
        more => error.note(format!("and at {more} more places")),
    }
}

/// Warnings about flags in conditions of the root package that no axis declares: one for each flag,
/// with its places. Asking for such a flag is an error of the composition; these were not reached,
/// since another condition was decided first.
pub fn undeclared_flags(graph: &Graph, settings: &Settings) -> Diagnostics {
    let mut found: BTreeMap<&str, Vec<Span>> = BTreeMap::new();
    for node in graph.nodes.iter().filter(|node| node.package == 0) {
        for expression in &node.module.expressions {
            let Expression::Flag(name, range) = expression else { continue };
            let text = graph.names.text(*name);
            if settings.value(text).is_none() {
                found.entry(text).or_default().push(node.module.span(range.clone()));
            }
        }
    }
    let warning = |(text, places): (&str, Vec<Span>)| {
        let message = format!("no axis declares the flag `{text}`");
        let warning = Diagnostic::warning(codes::UNDECLARED_FLAG, message);
        let warning = shown_at(warning, places, "no permutation has asked for it");
        warning.suggest(text, settings.values.keys().map(String::as_str))
    };
    found.into_iter().map(warning).collect()
}

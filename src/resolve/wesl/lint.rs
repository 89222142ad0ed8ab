//! Imports that do nothing, or nothing good.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::graph::{Candidate, Graph, Node, Target};
use super::load::Loader;
use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use crate::parse::wesl::{Expression, Name, Names, Origin, Path, Reference};
use crate::permute::Settings;

/// Warnings about a module's imports. Modules of dependencies have none: their users cannot mend them.
pub fn lints(names: &Names, node: &Node) -> Vec<Diagnostic> {
    if node.package != 0 {
        return Vec::new();
    }
    let mut found = Vec::new();
    let used = used(node);
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
                found.push(
                    Diagnostic::warning(
                        codes::UNUSED_IMPORT,
                        format!("`{text}` is imported but never used"),
                    )
                    .at(span, "not used"),
                );
            }
            _ => {}
        }
    }
    found
}

/// Fails unconditional imports of different things under one name.
pub fn clashes(loader: &mut Loader<'_>, node: u32, imported: &HashMap<Name, Vec<Candidate>>) {
    let mut failures = Vec::new();
    let here = &loader.nodes[node as usize];
    let clashing: HashSet<Name> = imported
        .iter()
        .filter(|(_, candidates)| differ(candidates))
        .map(|(alias, _)| *alias)
        .collect();
    let mut first: HashMap<Name, usize> = HashMap::new();
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
        if let Target::Failed(index) = loader.fail(failure) {
            loader.nodes[node as usize].broken_imports.push((Vec::new(), index));
        }
    }
}

/// Whether candidates lead to different things, those aside that lead nowhere.
fn differ(candidates: &[Candidate]) -> bool {
    let mut targets = candidates
        .iter()
        .map(|candidate| candidate.target)
        .filter(|target| !matches!(target, Target::Failed(_)));
    let first = targets.next();
    targets.any(|target| Some(target) != first)
}

/// The names that references and the paths of imports start with. An import whose own path starts
/// with its name means a package by it.
fn used(node: &Node) -> HashSet<Name> {
    let start =
        |path: &Path| path.segments.first().copied().filter(|_| path.origin == Origin::Scope);
    let named = node.module.references.iter().filter_map(|reference| match reference {
        Reference::Name(name) => Some(*name),
        Reference::Path(path) => start(path),
    });
    let passed = node
        .module
        .imports
        .iter()
        .filter_map(|import| start(&import.path).filter(|name| *name != import.alias));
    named.chain(passed).collect()
}

/// Warnings about flags of the root package's conditions that no axis declares, each once. Where
/// one is asked for, that is an error of the composition; these are hidden behind other conditions.
pub fn undeclared(graph: &Graph, settings: &Settings) -> Diagnostics {
    let mut found: BTreeMap<&str, Diagnostic> = BTreeMap::new();
    for node in graph.nodes.iter().filter(|node| node.package == 0) {
        for expression in &node.module.expressions {
            let Expression::Flag(name, range) = expression else { continue };
            let text = graph.names.text(*name);
            if settings.value(text).is_none() {
                let warning = Diagnostic::warning(
                    codes::UNDECLARED_FLAG,
                    format!("no axis declares the flag `{text}`"),
                );
                let warning =
                    warning.at(node.module.span(range.clone()), "no permutation has asked for it");
                found.entry(text).or_insert_with(|| {
                    warning.suggest(text, settings.values.keys().map(String::as_str))
                });
            }
        }
    }
    found.into_values().collect()
}

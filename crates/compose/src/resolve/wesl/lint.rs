//! Warns of imports without effect, and reports names that are declared or imported twice.

use std::collections::BTreeMap;

use rustc_hash::{FxHashMap, FxHashSet};

use super::graph::{Candidate, Graph, ModuleNode, PathTarget};
use super::load::Loader;
use super::wildcard::WildcardModule;
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_permute::Settings;
use lamplight_syntax::wesl::{ConditionId, Expression, ItemKind, Name, Origin, Path, UsedName};

/// Warnings about a module: those of the parser, and those about its imports. Modules of
/// dependencies have none, since their users cannot change them.
pub fn import_lints(loader: &Loader<'_>, node: &ModuleNode) -> Vec<Diagnostic> {
    if node.package != 0 {
        return Vec::new();
    }
    let names = &loader.names;
    let mut found = node.module.warnings.clone();
    let used = used_names(node);
    for (import, targets) in node.module.imports.iter().zip(node.imports.iter()) {
        if import.is_public || used.contains(&import.alias) {
            continue;
        }
        let (text, span) = (names.text(import.alias), node.module.span(import.alias_range.clone()));
        // Nothing uses it, so it is no error if it leads nowhere.
        let failure = targets.iter().find_map(|target| match target {
            PathTarget::Failed(failure) => Some(&loader.failures[*failure as usize].message),
            _ => None,
        });
        let message = format!("`{text}` is imported but never used");
        let warning = Diagnostic::warning(codes::UNUSED_IMPORT, message).at(span, "not used");
        found.push(match failure {
            Some(failure) => warning.note(failure.clone()),
            None => warning,
        });
    }
    found
}

/// Warnings about names that a wildcard brings, and that the module has another way. As with
/// [`import_lints`], modules of dependencies have none.
pub fn shadowed_wildcards(
    loader: &mut Loader<'_>,
    node: u32,
    wildcards: &[WildcardModule],
) -> Vec<Diagnostic> {
    if loader.nodes[node as usize].package != 0 || is_off(loader, node, "wildcard_shadow") {
        return Vec::new();
    }
    let module = loader.nodes[node as usize].module.shared();
    let items = module.items.iter().map(|item| (item.name, item.name_range.clone()));
    let imports = module.imports.iter().map(|import| (import.alias, import.alias_range.clone()));
    let mut found = Vec::new();
    for (name, range) in items.chain(imports).filter(|(name, _)| *name != Name::UNDERSCORE) {
        let brought =
            wildcards.iter().find(|module| !loader.brought(node, module, name).is_empty());
        if let Some(from) = brought {
            let (text, from) = (loader.names.text(name), &loader.nodes[from.node as usize].label);
            let message = format!("the wildcard of `{from}` brings `{text}` too");
            let place = loader.nodes[node as usize].module.span(range);
            found.push(
                Diagnostic::warning(codes::SHADOWED_IMPORT, message).at(place, "this one is used"),
            );
        }
    }
    found
}

/// Warnings about built-ins of WGSL that a module for wildcards hides from those that import it.
pub fn hidden_builtins(loader: &Loader<'_>, node: u32) -> Vec<Diagnostic> {
    let ModuleNode { package, module, .. } = &loader.nodes[node as usize];
    if *package != 0 || !module.is_wildcardable || is_off(loader, node, "builtin_shadow") {
        return Vec::new();
    }
    let named = module.items.iter().filter(|item| item.kind != ItemKind::ConstAssert);
    let hiding = named.filter_map(|item| {
        let text = loader.names.text(item.name);
        let is_hidden = naga::keywords::wgsl::BUILTIN_IDENTIFIERS.contains(&text);
        is_hidden.then(|| {
            let message = format!("`{text}` hides a built-in of WGSL where it is imported by `*`");
            let place = module.span(item.name_range.clone());
            Diagnostic::warning(codes::BUILTIN_SHADOW, message).at(place, "declared here")
        })
    });
    hiding.collect()
}

/// Whether a `diagnostic(off, ...)` of the module names a rule.
pub fn is_off(loader: &Loader<'_>, node: u32, rule: &str) -> bool {
    let directives = &loader.nodes[node as usize].module.directives;
    let mut filters = directives.iter().filter(|directive| directive.keyword == Name::DIAGNOSTIC);
    filters.any(|filter| filter.names.iter().map(|name| loader.names.text(*name)).eq(["off", rule]))
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
    failures.extend(declared_imports(loader, node));
    for failure in failures {
        if let PathTarget::Failed(index) = loader.fail(failure) {
            loader.nodes[node as usize].broken_imports.push((Vec::new(), index));
        }
    }
}

/// Errors about imports of items that have the name of a declaration, where neither has a condition.
/// Modules have a namespace of their own.
fn declared_imports(loader: &Loader<'_>, node: u32) -> Vec<Diagnostic> {
    let here = &loader.nodes[node as usize];
    let mut found = Vec::new();
    for (import, targets) in here.module.imports.iter().zip(here.imports.iter()) {
        let brings = targets
            .iter()
            .any(|target| matches!(target, PathTarget::Items { .. } | PathTarget::Constant(_)));
        let own = here.sets.get(&import.alias).and_then(|set| set.first());
        let own = own.map(|index| &here.module.items[*index as usize]);
        let is_certain = import.condition.is_none() && brings;
        let Some(item) = own.filter(|item| is_certain && item.condition.is_none()) else {
            continue;
        };
        let text = loader.names.text(import.alias);
        let message = format!("`{text}` is both imported and declared");
        found.push(
            Diagnostic::error(codes::DUPLICATE_ITEM, message)
                .at(here.module.span(import.alias_range.clone()), "imported here")
                .at(here.module.span(item.name_range.clone()), "declared here")
                .note("help: remove the import, or give it another name with `as`"),
        );
    }
    found
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

//! Imports that do nothing, or nothing good.

use std::collections::HashMap;

use super::graph::{Candidate, Node, Target};
use super::load::Loader;
use crate::diagnostic::{Diagnostic, codes};
use crate::parse::wesl::{Name, Names, Origin, Path, Reference};

/// Warnings about a module's imports. Modules of dependencies have none: their users cannot mend them.
pub fn lints(names: &Names, node: &Node) -> Vec<Diagnostic> {
    if node.package != 0 {
        return Vec::new();
    }
    let mut found = Vec::new();
    for import in &node.module.imports {
        let (text, span) = (names.text(import.alias), node.module.span(import.alias_range.clone()));
        let own = node.sets.get(&import.alias).and_then(|set| set.first()).map(|index| &node.module.items[*index as usize]);
        match own {
            Some(item) if item.condition.is_none() && import.condition.is_none() => found.push(
                Diagnostic::warning(codes::SHADOWED_IMPORT, format!("`{text}` is both imported and declared"))
                    .at(span, "this import has no effect")
                    .at(node.module.span(item.name_range.clone()), "the declaration wins"),
            ),
            _ if !is_used(node, import.alias) => {
                found.push(Diagnostic::warning(codes::UNUSED_IMPORT, format!("`{text}` is imported but never used")).at(span, "not used"));
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
    let mut first: HashMap<Name, usize> = HashMap::new();
    for (index, import) in here.module.imports.iter().enumerate().filter(|(_, import)| import.condition.is_none()) {
        let earlier = *first.entry(import.alias).or_insert(index);
        let targets = imported.get(&import.alias).into_iter().flatten().map(|candidate| candidate.target);
        let targets: Vec<Target> = targets.filter(|target| !matches!(target, Target::Failed(_))).collect();
        if earlier != index && targets.windows(2).any(|pair| pair[0] != pair[1]) {
            let message = format!("`{}` is imported twice, from different places", loader.names.text(import.alias));
            failures.push(
                Diagnostic::error(codes::DUPLICATE_ITEM, message)
                    .at(here.module.span(import.alias_range.clone()), "imported again")
                    .at(here.module.span(here.module.imports[earlier].alias_range.clone()), "imported first")
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

fn is_used(node: &Node, alias: Name) -> bool {
    let starts = |path: &Path| path.origin == Origin::Scope && path.segments.first() == Some(&alias);
    let named = node.module.references.iter().any(|reference| match reference {
        Reference::Name(name) => *name == alias,
        Reference::Path(path) => starts(path),
    });
    // An import whose own path starts with its name means a package by it.
    named || node.module.imports.iter().any(|import| import.alias != alias && starts(&import.path))
}

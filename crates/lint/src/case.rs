//! Finds names that are one name on a file system that ignores case.

use std::collections::BTreeMap;

use lamplight_compose::resolve::Graph;
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_syntax::wesl::Item;

/// A warning for each module whose path is that of another but for the case of letters.
pub fn alike_modules<'a>(modules: impl Iterator<Item = (&'a String, &'a Graph)>) -> Diagnostics {
    let mut known: BTreeMap<String, &str> = BTreeMap::new();
    let mut found = Diagnostics::new();
    for (path, graph) in modules {
        if let Some(other) = known.insert(path.to_lowercase(), path) {
            let message = format!("the modules `{other}` and `{path}` differ only in case");
            let warning = Diagnostic::warning(codes::CASE_COLLISION, message);
            let source = match graph {
                Graph::Wesl(graph) => graph.nodes.first().map(|node| node.module.source),
                Graph::Glsl(graph) => graph.modules.first().map(|module| module.source),
            };
            let start = source.map(|source| Span { source, start: 0, end: 0 });
            found.push(noted(match start {
                Some(start) => warning.at(start, "this module"),
                None => warning,
            }));
        }
    }
    found
}

/// A warning for each entry point of a module whose name is that of another but for the case of
/// letters. Names are in the names of outputs.
pub fn alike_entry_points(graph: &Graph) -> Diagnostics {
    let Graph::Wesl(graph) = graph else { return Diagnostics::new() };
    let Some(root) = graph.nodes.first() else { return Diagnostics::new() };
    let mut known: BTreeMap<String, &Item> = BTreeMap::new();
    let mut found = Diagnostics::new();
    for item in root.module.items.iter().filter(|item| item.entry) {
        let name = graph.names.text(item.name);
        let Some(other) = known.insert(name.to_lowercase(), item) else { continue };
        let other_name = graph.names.text(other.name);
        if other_name == name {
            continue;
        }
        let message = format!("the entry points `{other_name}` and `{name}` differ only in case");
        let warning = Diagnostic::warning(codes::CASE_COLLISION, message)
            .at(root.module.span(item.name_range.clone()), "this one")
            .at(root.module.span(other.name_range.clone()), "and this one");
        found.push(noted(warning));
    }
    found
}

fn noted(warning: Diagnostic) -> Diagnostic {
    warning.note("a file system that ignores case has one file for both")
}

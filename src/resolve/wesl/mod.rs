//! WESL modules to a graph: every module that is reached under any condition, every use resolved
//! to the items it may mean.

mod graph;
mod lint;
mod load;
mod locate;

pub use graph::{Candidate, Constant, Graph, Node, Target};
pub use lint::{PLACES, places, shown_at, undeclared};

use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use crate::source::SourceSet;

use super::Packages;

/// Reads the module `root`, a path relative to the root package, and all it may import.
///
/// Errors that only some settings meet (in a module that is imported under a condition, say) are
/// kept in the graph, and composing reports them.
pub fn load(
    sources: &mut SourceSet,
    packages: &Packages,
    root: &str,
) -> Result<Graph, Diagnostics> {
    let mut loader = load::Loader::new(sources, packages);
    match loader.root(root) {
        Ok(true) => loader.finish(),
        Ok(false) => Err(vec![missing_root(packages, root)]),
        Err(error) => Err(vec![error]),
    }
}

/// Every module of the root package at one of the paths, and all that they lead to: for editors,
/// which ask who uses what. What is wrong is in the graph; nothing where no module can be read.
pub fn load_all(sources: &mut SourceSet, packages: &Packages, paths: &[String]) -> Option<Graph> {
    load::Loader::new(sources, packages).every(paths)
}

fn missing_root(packages: &Packages, root: &str) -> Diagnostic {
    let known = packages.root.files.list(&["wesl", "wgsl"]);
    Diagnostic::error(
        codes::MISSING_MODULE,
        format!("there is no file `{}`", packages.root.files.display(root)),
    )
    .suggest(root, known.iter().map(String::as_str))
}

//! Builds the graph of WESL modules: every module that is reached under any condition, with every
//! use resolved to the items that it may mean.

mod cache;
mod graph;
mod lint;
mod load;
mod locate;
mod reduce;
mod replay;
mod wildcard;

pub use cache::KeptModules;
pub use graph::{Candidate, ConstantUse, Graph, ModuleNode, NodeCondition, PathTarget};
pub use lint::{PLACES, flag_places, shown_at, undeclared_flags};
pub use reduce::Reductions;

use lamplight_diagnostic::source::SourceSet;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};

use super::Packages;

/// Reads the module `root`, a path relative to the root package, and all it may import.
///
/// Some errors concern only some settings, such as one in a module that is imported under a
/// condition. They are kept in the graph, and composing reports them.
pub fn load(
    sources: &mut SourceSet,
    packages: &Packages,
    root: &str,
) -> Result<Graph, Diagnostics> {
    load_with(load::Loader::new(sources, packages), root)
}

/// As [`load`], with the parsed texts of an earlier reading.
pub fn load_kept(
    sources: &mut SourceSet,
    packages: &Packages,
    root: &str,
    kept: &mut KeptModules,
) -> Result<Graph, Diagnostics> {
    load_with(load::Loader::new(sources, packages).with_kept(kept, root), root)
}

/// As [`load`], with the modules far from the root as the reductions make them.
pub fn load_reduced(
    sources: &mut SourceSet,
    packages: &Packages,
    root: &str,
    reductions: &mut Reductions,
) -> Result<Graph, Diagnostics> {
    load_with(load::Loader::new(sources, packages).with_reductions(reductions), root)
}

fn load_with(mut loader: load::Loader<'_>, root: &str) -> Result<Graph, Diagnostics> {
    match loader.root(root) {
        Ok(true) => loader.finish(),
        Ok(false) => Err(vec![missing_root(loader.packages, root)]),
        Err(error) => Err(vec![error]),
    }
}

/// Reads every module of the root package at one of the paths, and all that they lead to. This is
/// for editors, which ask who uses what. Errors are in the graph. `None` where no module can be
/// read, or where names take more steps than are allowed: some would have no meaning.
pub fn load_all(
    sources: &mut SourceSet,
    packages: &Packages,
    paths: &[String],
    kept: &mut KeptModules,
) -> Option<Graph> {
    load::Loader::new(sources, packages).with_kept(kept, "").every(paths)
}

fn missing_root(packages: &Packages, root: &str) -> Diagnostic {
    let known = packages.root.files.list(&["wesl", "wgsl"]);
    Diagnostic::error(
        codes::MISSING_MODULE,
        format!("there is no file `{}`", packages.root.files.display(root)),
    )
    .suggest(root, known.iter().map(String::as_str))
}

//! Where a package lies on disk: its root, its dependencies, its manifest.
//!
//! This is the input end of the pipeline; the stages after it read through [`Packages`] only.

mod wesl_toml;

use std::path::{Component, Path, PathBuf};

use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use crate::resolve::Packages;
use crate::source::{Disk, Embedded, Package, SourceSet};

/// Import name of the shader library, which every package may use without declaring it.
pub const LIBRARY: &str = "lamplight";

/// A package on disk and the texts read so far.
pub struct Project {
    /// Root folder of the package, as the user wrote it.
    pub root: PathBuf,
    /// The package and its dependencies.
    pub packages: Packages,
    /// Everything read, for diagnostics.
    pub sources: SourceSet,
}

/// Opens the package whose root folder is `root`.
///
/// A `wesl.toml` in the folder, or beside it and naming it as its root, declares dependencies.
pub fn open(root: &Path, sources: SourceSet) -> Result<Project, (SourceSet, Diagnostics)> {
    let mut sources = sources;
    match packages(root, &mut sources) {
        Ok(packages) => Ok(Project { root: root.to_owned(), packages, sources }),
        Err(diagnostics) => Err((sources, diagnostics)),
    }
}

fn packages(root: &Path, sources: &mut SourceSet) -> Result<Packages, Diagnostics> {
    let disk = Disk::new(root).map_err(|error| vec![unreadable(root, &error)])?;
    let mut dependencies = wesl_toml::dependencies(root, sources)?;
    if !dependencies.iter().any(|package| package.name == LIBRARY) {
        dependencies.push(Package { name: LIBRARY.to_owned(), files: Box::new(Embedded) });
    }
    Ok(Packages { root: Package { name: "package".to_owned(), files: Box::new(disk) }, dependencies })
}

/// The shader library itself as a package, from the binary.
pub fn library() -> Packages {
    Packages { root: Package { name: "package".to_owned(), files: Box::new(Embedded) }, dependencies: Vec::new() }
}

/// The package root that a file belongs to when none is given: what the nearest `wesl.toml`
/// above it declares, or else its folder.
pub fn root_of(file: &Path) -> PathBuf {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    folder
        .ancestors()
        .find_map(|ancestor| wesl_toml::declared_root(ancestor).filter(|root| is_below(file, root)))
        .unwrap_or_else(|| folder.to_owned())
}

/// The path of `file` relative to `root`, `/`-separated.
pub fn relative(file: &Path, root: &Path) -> Result<String, Diagnostic> {
    let real = |path: &Path| if path.as_os_str().is_empty() { Path::new(".").canonicalize() } else { path.canonicalize() };
    let real_root = real(root).map_err(|error| unreadable(root, &error))?;
    let real_file = real(file).map_err(|error| unreadable(file, &error))?;
    match real_file.strip_prefix(&real_root) {
        Ok(below) => Ok(slashed(below)),
        Err(_) => {
            Err(Diagnostic::error(codes::OUTSIDE_ROOT, format!("`{}` is not below the package root `{}`", file.display(), root.display())))
        }
    }
}

fn is_below(file: &Path, root: &Path) -> bool {
    relative(file, root).is_ok()
}

fn slashed(path: &Path) -> String {
    let parts = path.components().filter_map(|component| match component {
        Component::Normal(part) => Some(part.to_string_lossy()),
        _ => None,
    });
    parts.collect::<Vec<_>>().join("/")
}

fn unreadable(path: &Path, error: &std::io::Error) -> Diagnostic {
    Diagnostic::error(codes::UNREADABLE, format!("cannot read `{}`: {error}", path.display()))
}

//! Packages and manifests on disk, with the shader library that this crate carries.

use std::path::Path;

use lamplight_compose::project as disk;
pub use lamplight_compose::project::*;

use crate::LIBRARY_FILES;
use crate::diagnostic::Diagnostics;
use crate::permute::Manifest;
use crate::resolve::Packages;
use crate::source::{Package, SourceSet};

/// Opens the package whose root folder is `root`.
///
/// A `wesl.toml` in the folder, or beside it and naming it as its root, declares dependencies.
///
/// # Errors
/// Those of [`packages`], with the texts to show them in.
pub fn open(root: &Path, sources: SourceSet) -> Result<Project, (SourceSet, Diagnostics)> {
    disk::open(root, sources, LIBRARY_FILES)
}

/// The package of a root folder and what it may import, which includes the library.
///
/// # Errors
/// The folder or a file that declares packages cannot be read or has mistakes.
pub fn packages(root: &Path, sources: &mut SourceSet) -> Result<Packages, Diagnostics> {
    disk::packages(root, sources, LIBRARY_FILES)
}

/// A manifest by its path, and the package that it belongs to: the one whose root the `wesl.toml`
/// beside the manifest declares, or else the manifest's folder.
///
/// # Errors
/// Those of the manifest and of [`packages`].
pub fn declared(path: &Path, sources: &mut SourceSet) -> Result<(Manifest, Packages), Diagnostics> {
    disk::declared(path, sources, LIBRARY_FILES)
}

/// The shader library as a package that others import.
pub fn library_package() -> Package {
    disk::library_package(LIBRARY_FILES)
}

/// The shader library itself as a package.
pub fn library_packages() -> Packages {
    disk::library_packages(LIBRARY_FILES)
}

/// The manifest of the library.
///
/// # Errors
/// Those of the manifest, with the texts to show them in.
pub fn library_manifest() -> Result<(SourceSet, Manifest), (SourceSet, Diagnostics)> {
    disk::library_manifest(LIBRARY_FILES)
}

//! Finds a package on disk: its root, its dependencies, its manifest.
//!
//! This is the input end of the pipeline. The stages after it read through [`Packages`] only.

mod dependencies;
mod listed;
mod managers;
mod names;
mod place;
mod wesl_toml;

pub use place::{
    manifest_above, manifest_of, package_above, package_at, relative_folder, root_beside, root_of,
};
pub use wesl_toml::{NAME as WESL_MANIFEST, declared_name, home as wesl_home};

use std::path::{Component, Path, PathBuf};

use crate::resolve::Packages;
use lamplight_diagnostic::source::{
    self, Disk, Embedded, Files, Memory, Package, SourceId, SourceSet,
};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_permute::manifest::Features;
use lamplight_permute::{Lock, Manifest, lock, manifest, usage};

/// Import name of the shader library, which every package may use without declaring it. Only the
/// `wesl.toml` of the root package may give the name to another package.
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
pub fn open(
    root: &Path,
    sources: SourceSet,
    library: Embedded,
) -> Result<Project, (SourceSet, Diagnostics)> {
    let mut sources = sources;
    match packages(root, &mut sources, library) {
        Ok(packages) => Ok(Project { root: root.to_owned(), packages, sources }),
        Err(diagnostics) => Err((sources, diagnostics)),
    }
}

/// The package of a root folder and what it may import, which includes the library.
pub fn packages(
    root: &Path,
    sources: &mut SourceSet,
    library: Embedded,
) -> Result<Packages, Diagnostics> {
    let manifest = place::manifest_of(root);
    packages_with(root, manifest.as_deref(), sources, library)
}

/// As [`packages`], for another manifest than that of the root.
fn packages_with(
    root: &Path,
    manifest: Option<&Path>,
    sources: &mut SourceSet,
    library: Embedded,
) -> Result<Packages, Diagnostics> {
    if root.is_file() {
        return Err(vec![Diagnostic::error(
            codes::UNREADABLE,
            format!("`{}` is a file, not a package's root folder", root.display()),
        )]);
    }
    let disk = Disk::new(root).map_err(|error| vec![unreadable_file(root, &error)])?;
    let files = listed::ListedFiles::new(root, Box::new(disk));
    let package = root_package(Box::new(files));
    let mut packages = dependencies::packages(root, package, sources, library)?;
    if let Some(manifest) = manifest {
        add_glsl(&mut packages, manifest, sources)?;
    }
    Ok(packages)
}

/// Adds what the table `glsl` of a manifest lists: folders of `#include`, and macros.
fn add_glsl(
    packages: &mut Packages,
    manifest: &Path,
    sources: &mut SourceSet,
) -> Result<(), Diagnostics> {
    let folder = manifest.parent().unwrap_or(Path::new(""));
    let Ok(disk) = Disk::new(folder) else { return Ok(()) };
    let package = Package { name: String::new(), files: Box::new(disk) };
    let name = manifest.file_name().unwrap_or_default().to_string_lossy();
    // A manifest that cannot be read is reported where the whole of it is.
    let Ok(Some(id)) = source::read(sources, &package, &name) else { return Ok(()) };
    let glsl = manifest::read_glsl(sources, id);
    for listed in glsl.include {
        let place = PathBuf::from(source::shown_path(&folder.join(&listed.text)));
        let disk = Disk::new(&place)
            .map_err(|error| vec![unreadable_file(&place, &error).at(listed.span, "named here")])?;
        packages.add_includes(Package { name: place.display().to_string(), files: Box::new(disk) });
    }
    for (name, value) in glsl.define {
        packages.definitions.push_str(&format!("#define {name} {value}\n"));
    }
    Ok(())
}

/// A package that has no folder yet, together with the library. Its files come from elsewhere,
/// such as an editor.
pub fn packages_without_folder(library: Embedded) -> Packages {
    Packages::new(root_package(Box::new(Memory::default())), vec![library_package(library)])
}

fn root_package(files: Box<dyn Files>) -> Package {
    Package { name: "package".to_owned(), files }
}

/// The shader library as a package that others import.
pub fn library_package(library: Embedded) -> Package {
    Package { name: LIBRARY.to_owned(), files: Box::new(library) }
}

/// The shader library itself as a package.
pub fn library_packages(library: Embedded) -> Packages {
    Packages::new(root_package(Box::new(library)), Vec::new())
}

/// The path of `file` relative to `root`, `/`-separated.
pub fn relative(file: &Path, root: &Path) -> Result<String, Diagnostic> {
    let real = |path: &Path| {
        if path.as_os_str().is_empty() {
            Path::new(".").canonicalize()
        } else {
            path.canonicalize()
        }
    };
    let real_root = real(root).map_err(|error| unreadable_file(root, &error))?;
    let real_file = real(file).map_err(|error| unreadable_file(file, &error))?;
    if real_file.is_dir() {
        return Err(Diagnostic::error(
            codes::UNREADABLE,
            format!("`{}` is a folder, not a file", file.display()),
        ));
    }
    match real_file.strip_prefix(&real_root) {
        Ok(below) => Ok(with_slashes(below)),
        Err(_) => Err(Diagnostic::error(
            codes::OUTSIDE_ROOT,
            format!("`{}` is not below the package root `{}`", file.display(), root.display()),
        )),
    }
}

fn with_slashes(path: &Path) -> String {
    let parts = path.components().filter_map(|component| match component {
        Component::Normal(part) => Some(part.to_string_lossy()),
        _ => None,
    });
    parts.collect::<Vec<_>>().join("/")
}

fn unreadable_file(path: &Path, error: &std::io::Error) -> Diagnostic {
    let shown = path.display();
    let message = match error.kind() {
        std::io::ErrorKind::NotFound => format!("there is no file or folder `{shown}`"),
        _ => format!("cannot read `{shown}`: {error}"),
    };
    Diagnostic::error(codes::UNREADABLE, message)
}

/// File name of a manifest.
pub const MANIFEST: &str = "lamplight.toml";

/// The manifest of the package with that root folder, if there is one: in the root, or beside the
/// `wesl.toml` that declares the root.
pub fn manifest(root: &Path, sources: &mut SourceSet) -> Result<Option<Manifest>, Diagnostics> {
    let Some(path) = place::manifest_of(root) else { return Ok(None) };
    let mut manifest = read_manifest(&path, sources)?;
    manifest.adopt(features(root, sources)?);
    Ok(Some(manifest))
}

/// As [`manifest`], without the lists that decide which permutations there are: for callers that
/// choose one themselves. Mistakes in these lists are not found.
pub fn manifest_outline(
    root: &Path,
    sources: &mut SourceSet,
) -> Result<Option<Manifest>, Diagnostics> {
    let Some(path) = place::manifest_of(root) else { return Ok(None) };
    let mut manifest = read_with(&path, sources, &|package, name, sources| {
        let id = manifest_text(package, name, sources)?;
        manifest::parse_outline(sources, id)
    })?;
    manifest.adopt(features(root, sources)?);
    Ok(Some(manifest))
}

/// The features that the package's `wesl.toml` declares, and those of its dependencies.
pub fn features(root: &Path, sources: &mut SourceSet) -> Result<Features, Diagnostics> {
    dependencies::features(root, sources)
}

/// Reads a manifest by its path. Its files are named from the package's root.
pub fn read_manifest(path: &Path, sources: &mut SourceSet) -> Result<Manifest, Diagnostics> {
    read_with(path, sources, &parse_manifest)
}

/// How a manifest of a package is read.
type Parse<'p> = dyn Fn(&Package, &str, &mut SourceSet) -> Result<Manifest, Diagnostics> + 'p;

fn read_with(
    path: &Path,
    sources: &mut SourceSet,
    parse: &Parse<'_>,
) -> Result<Manifest, Diagnostics> {
    if path.is_dir() {
        return Err(vec![Diagnostic::error(
            codes::UNREADABLE,
            format!("`{}` is a folder, not a manifest", path.display()),
        )]);
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let disk = Disk::new(folder).map_err(|error| vec![unreadable_file(path, &error)])?;
    let package = Package { name: String::new(), files: Box::new(disk) };
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let mut manifest = parse(&package, &name, sources)?;
    place::below_root(&mut manifest.programs, folder)?;
    Ok(manifest)
}

/// A manifest by its path, and the package that it belongs to: the one whose root the `wesl.toml`
/// beside the manifest declares, or else the manifest's folder.
pub fn declared(
    path: &Path,
    sources: &mut SourceSet,
    library: Embedded,
) -> Result<(Manifest, Packages), Diagnostics> {
    let mut manifest = read_manifest(path, sources)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let root = place::root_beside(folder);
    manifest.adopt(features(&root, sources)?);
    let packages = packages_with(&root, Some(path), sources, library)?;
    manifest.warnings.extend(packages.warnings.iter().cloned());
    Ok((manifest, packages))
}

/// The lock of a manifest lies beside it and has its name: `lamplight.lock` is that of
/// `lamplight.toml`.
pub fn lock_path(manifest: &Path) -> PathBuf {
    manifest.with_extension("lock")
}

/// The lock of the other manifest in the folder, where this one has none. Manifests of any name
/// used to have this one.
pub fn shared_lock(manifest: &Path) -> Option<PathBuf> {
    let shared = lock_path(&manifest.with_file_name(MANIFEST));
    let own = lock_path(manifest);
    (own != shared && !own.exists() && shared.is_file()).then_some(shared)
}

/// The lock of dense keys beside a manifest; an empty one where there is no file.
pub fn lock(manifest: &Path, sources: &mut SourceSet) -> Result<Lock, Diagnostics> {
    let folder =
        manifest.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let disk = Disk::new(folder).map_err(|error| vec![unreadable_file(folder, &error)])?;
    let package = Package { name: String::new(), files: Box::new(disk) };
    let name = lock_path(manifest);
    let name = name.file_name().unwrap_or_default().to_string_lossy();
    match source::read(sources, &package, &name).map_err(|error| vec![error.into()])? {
        Some(id) => lock::parse(sources, id),
        None => Ok(Lock::default()),
    }
}

/// The manifest of the library.
pub fn library_manifest(
    library: Embedded,
) -> Result<(SourceSet, Manifest), (SourceSet, Diagnostics)> {
    let mut sources = SourceSet::default();
    match parse_manifest(&library_packages(library).root, MANIFEST, &mut sources) {
        Ok(manifest) => Ok((sources, manifest)),
        Err(diagnostics) => Err((sources, diagnostics)),
    }
}

/// As [`library_manifest`], without the lists that decide which permutations there are: for callers that
/// choose one themselves.
pub fn library_outline(
    library: Embedded,
) -> Result<(SourceSet, Manifest), (SourceSet, Diagnostics)> {
    let mut sources = SourceSet::default();
    let id = manifest_text(&library_packages(library).root, MANIFEST, &mut sources);
    match id.and_then(|id| manifest::parse_outline(&sources, id)) {
        Ok(manifest) => Ok((sources, manifest)),
        Err(diagnostics) => Err((sources, diagnostics)),
    }
}

/// Where results for a manifest are kept when nobody says where: in the `target` folder of the
/// cargo package it is in, or else in the user's cache folder. `None` where there is neither.
pub fn cache_folder(manifest: &Path) -> Option<PathBuf> {
    const NAME: &str = "lamplight-cache";
    let real = manifest.canonicalize().ok()?;
    let packages = real.ancestors().filter(|folder| folder.join("Cargo.toml").is_file());
    if let Some(target) =
        packages.map(|folder| folder.join("target")).find(|target| target.is_dir())
    {
        return Some(target.join(NAME));
    }
    let variable =
        |name| std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    Some(variable("XDG_CACHE_HOME").or_else(|| Some(variable("HOME")?.join(".cache")))?.join(NAME))
}

/// The text of a manifest.
fn manifest_text(
    package: &Package,
    name: &str,
    sources: &mut SourceSet,
) -> Result<SourceId, Diagnostics> {
    let id = source::read(sources, package, name).map_err(|error| vec![error.into()])?;
    id.ok_or_else(|| {
        vec![
            Diagnostic::error(
                codes::UNREADABLE,
                format!("there is no manifest `{}`", package.files.display(name)),
            )
            .note("help: `lamplight init` writes a package that has one"),
        ]
    })
}

fn parse_manifest(
    package: &Package,
    name: &str,
    sources: &mut SourceSet,
) -> Result<Manifest, Diagnostics> {
    let id = manifest_text(package, name, sources)?;
    let mut manifest = manifest::parse(sources, id)?;
    let mut lists: Vec<(String, SourceId)> = Vec::new();
    for program in &mut manifest.programs {
        let Some(file) = program.usage.clone() else { continue };
        let list = source::read(sources, package, &file.path)
            .map_err(|error| vec![Diagnostic::from(error).at(file.span, "named here")])?;
        let list = list.ok_or_else(|| vec![no_list(&file)])?;
        let warnings = usage::narrow_to_list(program, sources, list)?;
        manifest.warnings.extend(warnings);
        if lists.iter().all(|(path, _)| *path != file.path) {
            lists.push((file.path, list));
        }
    }
    for (_, list) in lists {
        manifest.warnings.extend(usage::unknown_programs(&manifest.programs, sources, list));
    }
    Ok(manifest)
}

fn no_list(file: &manifest::ManifestFile) -> Diagnostic {
    Diagnostic::error(codes::UNREADABLE, format!("there is no usage list `{}`", file.path))
        .at(file.span, "named here")
}

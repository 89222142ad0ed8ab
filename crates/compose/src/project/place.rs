//! Finds the package that a file or a manifest belongs to. Every command asks here, so that they
//! agree.

use std::path::{Component, Path, PathBuf};

use super::{MANIFEST, relative, unreadable_file, wesl_toml, with_slashes};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_permute::manifest::{ManifestFile, Program};

/// The root folder of the package that a file belongs to, where none is given: what the nearest
/// `wesl.toml` above the file declares, or the folder of the nearest manifest, whichever is
/// nearer, or else the file's own folder.
pub fn root_of(file: &Path) -> PathBuf {
    let folder =
        file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    folders_above(folder)
        .iter()
        .find_map(|ancestor| declared_root(ancestor).filter(|root| relative(file, root).is_ok()))
        .unwrap_or_else(|| folder.to_owned())
}

/// The root of the package whose `wesl.toml` or manifest is in the folder or above it.
pub fn package_above(folder: &Path) -> Option<PathBuf> {
    let root = folders_above(folder).iter().find_map(|ancestor| declared_root(ancestor))?;
    Some(if root.as_os_str().is_empty() { PathBuf::from(".") } else { root })
}

/// The root of the package that a folder belongs to: one that starts there or above it.
pub fn package_at(folder: &Path) -> Option<PathBuf> {
    declared_root(folder).or_else(|| {
        let below = |root: &PathBuf| relative_folder(folder, root).is_ok();
        folders_above(folder).iter().find_map(|ancestor| declared_root(ancestor).filter(below))
    })
}

/// The path of a folder below a root, empty or with a `/` at its end.
pub fn relative_folder(folder: &Path, root: &Path) -> Result<String, Diagnostic> {
    let real = |path: &Path| {
        let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
        path.canonicalize().map_err(|error| unreadable_file(path, &error))
    };
    let (folder_real, root_real) = (real(folder)?, real(root)?);
    let outside = || {
        let message =
            format!("`{}` is not below the package root `{}`", folder.display(), root.display());
        Diagnostic::error(codes::OUTSIDE_ROOT, message)
    };
    let below = folder_real.strip_prefix(&root_real).map_err(|_| outside())?;
    let below = with_slashes(below);
    Ok(if below.is_empty() { below } else { below + "/" })
}

/// The nearest manifest in a folder or above it.
pub fn manifest_above(folder: &Path) -> Option<PathBuf> {
    folders_above(folder)
        .into_iter()
        .map(|ancestor| ancestor.join(MANIFEST))
        .find(|path| path.is_file())
}

/// The root that a folder's `wesl.toml` declares, or the folder itself if it has a manifest.
fn declared_root(folder: &Path) -> Option<PathBuf> {
    let declared = wesl_toml::declared_root(folder).filter(|root| root.is_dir());
    declared.or_else(|| folder.join(MANIFEST).is_file().then(|| folder.to_owned()))
}

/// The root of the package whose manifest is in the folder.
pub fn root_beside(folder: &Path) -> PathBuf {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let declared = wesl_toml::declared_root(folder).filter(|root| root.is_dir());
    declared.map_or_else(|| folder.to_owned(), |root| tidy_path(&root))
}

/// The manifest of a package: in its root, or beside the `wesl.toml` that declares the root.
pub fn manifest_of(root: &Path) -> Option<PathBuf> {
    let inside = root.join(MANIFEST);
    if inside.is_file() {
        return Some(inside);
    }
    let beside = wesl_toml::shown_home(root, &wesl_toml::home(root)?).join(MANIFEST);
    beside.is_file().then_some(beside)
}

/// Changes the paths of a manifest's files, which are relative to its folder, into paths from the
/// package's root.
pub fn below_root(programs: &mut [Program], folder: &Path) -> Result<(), Diagnostics> {
    let root = root_beside(folder);
    let prefix = tidy_path(tidy_path(&root).strip_prefix(tidy_path(folder)).unwrap_or(&root));
    let mut errors = Vec::new();
    for file in programs.iter_mut().flat_map(Program::files_mut) {
        match tidy_path(Path::new(&file.path)).strip_prefix(&prefix) {
            Ok(path) => file.path = path.to_string_lossy().replace('\\', "/"),
            Err(_) => errors.push(outside_package(file, &prefix)),
        }
    }
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

fn outside_package(file: &ManifestFile, root: &Path) -> Diagnostic {
    let root = root.display();
    let message = format!("`{}` is not below the package root `{root}`", file.path);
    Diagnostic::error(codes::OUTSIDE_ROOT, message).at(file.span, "named here").note(format!(
        "a manifest names files from its own folder, such as `{root}/main.wesl`; `wesl.toml` \
             beside it says that the root is `{root}`"
    ))
}

/// The path without `.` components.
fn tidy_path(path: &Path) -> PathBuf {
    path.components().filter(|component| *component != Component::CurDir).collect()
}

/// A folder and all above it, by the names that were given as far as they reach and by `..` from
/// there on.
fn folders_above(folder: &Path) -> Vec<PathBuf> {
    let is_up = |path: &Path| path.components().next_back() == Some(Component::ParentDir);
    let mut found: Vec<PathBuf> = Vec::new();
    for ancestor in folder.ancestors() {
        found.push(ancestor.to_owned());
        if is_up(ancestor) {
            break;
        }
    }
    let mut last = found.last().cloned().unwrap_or_default();
    let here = if last.as_os_str().is_empty() { Path::new(".") } else { &last };
    let levels = here.canonicalize().map_or(0, |real| real.components().count());
    for _ in 1..levels {
        last = tidy_path(&last).join("..");
        found.push(last.clone());
    }
    found
}

//! Finds the files that the path of an `#include` may name.

use super::PackagePath;
use crate::resolve::Packages;
use lamplight_diagnostic::source::Package;
use lamplight_diagnostic::{Diagnostic, codes};

/// Number of the root package; dependency `i` has the number `i + 1`.
pub const ROOT: usize = 0;

/// Extensions of the files that are worth suggesting.
pub const EXTENSIONS: &[&str] = &["glsl", "vert", "frag", "comp", "h"];

/// The package of that number.
pub fn package_at(packages: &Packages, number: usize) -> &Package {
    number
        .checked_sub(1)
        .and_then(|index| packages.dependencies.get(index))
        .unwrap_or(&packages.root)
}

/// The places to look at, in order: `"path"` is relative to the includer, then to its package's
/// root; `<name/path>` is in the package of that name, then relative to the root package's root.
pub fn include_candidates(
    packages: &Packages,
    includer: &PackagePath,
    path: &str,
    angled: bool,
) -> Result<Vec<PackagePath>, Diagnostic> {
    let mut places = Vec::new();
    if angled {
        if let Some((name, rest)) = path.split_once('/')
            && let Some(number) = named_package(packages, name)
        {
            places.push((number, normalize_path("", rest).ok_or_else(|| outside_package(path))?));
        }
        places.push((ROOT, normalize_path("", path).ok_or_else(|| outside_package(path))?));
    } else {
        places.push((
            includer.0,
            normalize_path(folder_of(&includer.1), path).ok_or_else(|| outside_package(path))?,
        ));
        places.extend(normalize_path("", path).map(|path| (includer.0, path)));
    }
    Ok(places)
}

/// The packages whose files an `#include` can name.
pub fn searched_packages(packages: &Packages, includer: usize, angled: bool) -> Vec<usize> {
    if angled { (0..=packages.dependencies.len()).collect() } else { vec![includer] }
}

/// The path by which an `#include` of the includer would name a file.
pub fn include_spelling(
    packages: &Packages,
    includer: &PackagePath,
    (number, file): (usize, &str),
    angled: bool,
) -> String {
    match (angled, number) {
        (true, ROOT) => file.to_owned(),
        (true, _) => format!("{}/{file}", package_at(packages, number).name),
        (false, _) => relative_path(folder_of(&includer.1), file),
    }
}

/// The error for a path that leaves its package.
pub fn outside_package(path: &str) -> Diagnostic {
    Diagnostic::error(codes::OUTSIDE_ROOT, format!("`{path}` leads out of its package's root"))
}

/// `path` seen from `folder`, without `.` and `..`; `None` if it is absolute or leaves the root.
pub fn normalize_path(folder: &str, path: &str) -> Option<String> {
    if path.starts_with('/') || path.contains(['\\', ':']) {
        return None;
    }
    let mut parts = Vec::new();
    for part in folder.split('/').chain(path.split('/')) {
        match part {
            "" | "." => {}
            ".." => drop(parts.pop()?),
            _ => parts.push(part),
        }
    }
    Some(parts.join("/"))
}

fn named_package(packages: &Packages, name: &str) -> Option<usize> {
    let dependency = packages
        .dependencies
        .iter()
        .position(|package| package.name == name)
        .map(|index| index + 1);
    dependency.or((packages.root.name == name).then_some(ROOT))
}

fn folder_of(path: &str) -> &str {
    path.rsplit_once('/').map_or("", |(folder, _)| folder)
}

fn relative_path(folder: &str, file: &str) -> String {
    let (mut from, mut to) =
        (folder.split('/').filter(|part| !part.is_empty()).peekable(), file.split('/').peekable());
    while from.peek().is_some() && from.peek() == to.peek() {
        from.next();
        to.next();
    }
    let up: String = from.map(|_| "../").collect();
    up + &to.collect::<Vec<_>>().join("/")
}

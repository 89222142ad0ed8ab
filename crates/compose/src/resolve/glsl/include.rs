//! Finds the files that the path of an `#include` may name.

use super::PackagePath;
use crate::resolve::{Packages, ROOT};
use lamplight_diagnostic::{Diagnostic, codes};

/// Extensions of the files that are worth suggesting.
pub const EXTENSIONS: &[&str] = &["glsl", "vert", "frag", "comp", "h"];

/// The places to look at, in order: `"path"` is relative to the includer, then to its package's
/// root; `<name/path>` is in the package that the includer's package calls by that name, then
/// relative to the root package's root. Both are looked for last in the folders of
/// [`Packages::includes`].
pub fn include_candidates(
    packages: &Packages,
    includer: &PackagePath,
    path: &str,
    angled: bool,
) -> Result<Vec<PackagePath>, Diagnostic> {
    let mut places = Vec::new();
    if angled {
        if let Some((name, rest)) = path.split_once('/')
            && let Some(number) = packages.find(includer.0, name)
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
    let found = normalize_path("", path);
    let further = packages.includes().iter().zip(std::iter::repeat(found));
    places.extend(further.filter_map(|(number, path)| Some((*number, path?))));
    Ok(places)
}

/// A package whose files an `#include` can name, with the name that stands before their paths.
pub type SearchedPackage<'p> = (usize, Option<&'p str>);

/// The packages whose files an `#include` can name.
pub fn searched_packages(
    packages: &Packages,
    includer: usize,
    angled: bool,
) -> Vec<SearchedPackage<'_>> {
    if !angled {
        return vec![(includer, None)];
    }
    let named = packages.scope(includer).names.iter().filter(|(_, number)| **number != ROOT);
    let named = named.map(|(name, number)| (*number, Some(name.as_str())));
    std::iter::once((ROOT, None)).chain(named).collect()
}

/// The path by which an `#include` of the includer would name a file of a searched package.
pub fn include_spelling(
    includer: &PackagePath,
    (_, name): SearchedPackage<'_>,
    file: &str,
    angled: bool,
) -> String {
    match (angled, name) {
        (true, None) => file.to_owned(),
        (true, Some(name)) => format!("{name}/{file}"),
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

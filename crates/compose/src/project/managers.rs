//! Packages that npm or Cargo installed. Their own files say where a package is. No program is
//! run, since the folder may be untrusted.

use std::path::{Path, PathBuf};

use toml::Table;

use lamplight_diagnostic::source::LIMITS;
use lamplight_files::input;

/// Who installs the packages that a `wesl.toml` lists by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Manager {
    Npm,
    Cargo,
}

impl Manager {
    /// Each manager, with its name in `package-manager` and the file that shows its use.
    pub const ALL: [(&'static str, Self, &'static str); 2] =
        [("npm", Self::Npm, "package.json"), ("cargo", Self::Cargo, "Cargo.toml")];

    /// The manager that a `wesl.toml` names. Without a name, the one whose file is in its folder
    /// or, if there is none, in the nearest folder above.
    pub fn of(folder: &Path, declared: Option<&str>) -> Result<Self, String> {
        if let Some(name) = declared {
            let found = Self::ALL.iter().find(|(known, ..)| *known == name);
            let unknown = || format!("`package-manager` is `npm` or `cargo`, not `{name}`");
            return found.map(|(_, manager, _)| *manager).ok_or_else(unknown);
        }
        for above in folders_upwards(folder) {
            let is_here = |(_, _, file): &&(&str, Self, &str)| above.join(file).is_file();
            let mut here = Self::ALL.iter().filter(is_here);
            match (here.next(), here.next()) {
                (Some((_, manager, _)), None) => return Ok(*manager),
                (Some(_), Some(_)) => {
                    return Err("both `package.json` and `Cargo.toml` are there: say \
                                `package-manager` in `wesl.toml`"
                        .to_owned());
                }
                _ => {}
            }
        }
        Err("neither `package.json` nor `Cargo.toml` is there to say where it is installed"
            .to_owned())
    }

    /// The folder of an installed package.
    pub fn find(self, folder: &Path, package: &str) -> Result<PathBuf, String> {
        match self {
            Self::Npm => npm_package(folder, package),
            Self::Cargo => cargo_package(folder, package),
        }
    }

    /// The name that the manager's file in the folder gives its package, as WESL can spell it.
    pub fn own_name(self, folder: &Path) -> Option<String> {
        let name = match self {
            Self::Npm => {
                let path = folder.join("package.json");
                let bytes = input::read_file(&path, LIMITS.file_bytes as u64).ok()?;
                let document: serde_json::Value = serde_json::from_slice(&bytes).ok()?;
                document.get("name")?.as_str()?.to_owned()
            }
            Self::Cargo => {
                let table = read_table(&folder.join("Cargo.toml"))?;
                table.get("package")?.get("name")?.as_str()?.to_owned()
            }
        };
        Some(spelled_name(&name))
    }

    /// The packages that the manager's nearest file lists, with the names that WESL can spell. A
    /// file further above is another package's.
    pub fn listed(self, folder: &Path) -> Vec<(String, String)> {
        let nearest = |file: &str| {
            folders_upwards(folder).map(|above| above.join(file)).find(|path| path.is_file())
        };
        let names = match self {
            Self::Npm => nearest("package.json").and_then(|path| listed_by_npm(&path)),
            Self::Cargo => nearest("Cargo.toml").and_then(|path| {
                let table = read_table(&path)?;
                Some(table.get("dependencies")?.as_table()?.keys().cloned().collect())
            }),
        };
        names.unwrap_or_default().into_iter().map(|name| (spelled_name(&name), name)).collect()
    }
}

/// A package's name as WESL can spell it: `@lorem/fun-shaders` is `lorem__fun_shaders`.
fn spelled_name(name: &str) -> String {
    name.trim_start_matches('@').replace('/', "__").replace('-', "_")
}

fn listed_by_npm(path: &Path) -> Option<Vec<String>> {
    let bytes = input::read_file(path, LIMITS.file_bytes as u64).ok()?;
    let document: serde_json::Value = serde_json::from_slice(&bytes).ok()?;
    Some(document.get("dependencies")?.as_object()?.keys().cloned().collect())
}

/// A folder and those above it, by the name that was given.
fn folders_upwards(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let levels = folder.canonicalize().map_or(1, |real| real.components().count());
    std::iter::successors(Some(folder.to_owned()), |last| Some(last.join(".."))).take(levels)
}

/// `name` or `@scope/name`, and nothing that leads elsewhere.
fn is_name(package: &str) -> bool {
    let part = |part: &str| {
        let fits = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
        !part.is_empty() && !part.starts_with('.') && part.chars().all(fits)
    };
    match package.strip_prefix('@').map(|scoped| scoped.split_once('/')) {
        None => part(package),
        Some(Some((scope, name))) => part(scope) && part(name),
        Some(None) => false,
    }
}

fn npm_package(folder: &Path, package: &str) -> Result<PathBuf, String> {
    if !is_name(package) {
        return Err(format!("`{package}` is not the name of an npm package"));
    }
    let mut places = folders_upwards(folder).map(|above| above.join("node_modules").join(package));
    places
        .find(|place| place.is_dir())
        .ok_or_else(|| format!("`{package}` is not installed: run `npm install {package}`"))
}

fn cargo_package(folder: &Path, package: &str) -> Result<PathBuf, String> {
    if !is_name(package) || package.contains(['@', '/']) {
        return Err(format!("`{package}` is not the name of a Cargo package"));
    }
    let above: Vec<PathBuf> = folders_upwards(folder).collect();
    let declared = above.iter().find_map(|above| declared_folder(above, package));
    if let Some(path) = declared {
        return Ok(path);
    }
    let vendored = above.iter().map(|above| above.join("vendor").join(package));
    if let Some(place) = vendored.into_iter().find(|place| place.is_dir()) {
        return Ok(place);
    }
    let version =
        above.iter().find_map(|above| locked_version(above, package)).ok_or_else(|| {
            format!(
                "no `Cargo.lock` names `{package}`: add it to `Cargo.toml` and run `cargo fetch`"
            )
        })?;
    let missing = || format!("`{package}` {version} is not there yet: run `cargo fetch`");
    registry_folder(&format!("{package}-{version}")).ok_or_else(missing)
}

fn read_table(path: &Path) -> Option<Table> {
    let bytes = input::read_file(path, LIMITS.file_bytes as u64).ok()?;
    String::from_utf8(bytes).ok()?.parse().ok()
}

/// The folder that a `Cargo.toml` names for a dependency, of its own or of its workspace.
fn declared_folder(folder: &Path, package: &str) -> Option<PathBuf> {
    let table = read_table(&folder.join("Cargo.toml"))?;
    let workspace = table.get("workspace").and_then(|found| found.get("dependencies"));
    let tables = [table.get("dependencies"), workspace];
    let paths = tables.into_iter().flatten().filter_map(|dependencies| {
        let entries = dependencies.as_table()?;
        let named = |(key, entry): &(&String, &toml::Value)| {
            let name = entry.get("package").and_then(|name| name.as_str());
            name.unwrap_or(key) == package
        };
        entries.iter().find(named)?.1.get("path")?.as_str().map(|path| folder.join(path))
    });
    paths.into_iter().find(|path| path.is_dir())
}

/// The version that a folder's `Cargo.lock` has of a package; the greatest, where it has several.
fn locked_version(folder: &Path, package: &str) -> Option<String> {
    let table = read_table(&folder.join("Cargo.lock"))?;
    let versions = table.get("package")?.as_array()?.iter().filter_map(|entry| {
        let is_it = entry.get("name")?.as_str()? == package;
        entry.get("version")?.as_str().filter(|_| is_it).map(str::to_owned)
    });
    let number = |version: &String| -> Vec<u64> {
        version.split(['.', '-', '+']).map(|part| part.parse().unwrap_or(0)).collect()
    };
    versions.max_by_key(number).filter(|version| is_name(version))
}

/// Where Cargo unpacked a package of a registry.
fn registry_folder(name: &str) -> Option<PathBuf> {
    let home = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    let home = home.or_else(|| Some(PathBuf::from(std::env::var_os("HOME")?).join(".cargo")))?;
    let registries = std::fs::read_dir(home.join("registry/src")).ok()?;
    let mut places: Vec<PathBuf> =
        registries.flatten().map(|registry| registry.path().join(name)).collect();
    places.sort();
    places.into_iter().find(|place| place.is_dir())
}

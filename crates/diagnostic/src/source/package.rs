//! Packages: a name and a root that no path leaves.

use std::fs;
use std::path::{Component, Path, PathBuf};

use lamplight_files::input;
use lamplight_files::limits;

/// Bounds on what is read; each has its own error.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// Bytes of one file.
    pub file_bytes: usize,
    /// Tokens of one file.
    pub tokens: usize,
    /// Nesting of brackets, blocks and conditions.
    pub nesting: usize,
    /// Depth of `#include`.
    pub include_depth: usize,
    /// Bytes of one composed text.
    pub expansion_bytes: usize,
    /// Files of one composition.
    pub files: usize,
    /// Permutations of one program.
    pub permutations: usize,
}

/// The limits every command uses.
pub const LIMITS: Limits = Limits {
    file_bytes: limits::FILE_BYTES,
    tokens: limits::FILE_TOKENS,
    nesting: limits::NESTING,
    include_depth: limits::INCLUDE_DEPTH,
    expansion_bytes: limits::EXPANSION_BYTES,
    files: limits::FILES,
    permutations: limits::PERMUTATIONS,
};

/// Why a file of a package could not be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ReadError {
    /// `..` or a symbolic link leads out of the root.
    OutsideRoot,
    /// The bytes are not UTF-8: the lossy text and the offset of the first bad byte in it.
    NotUtf8 {
        /// The text with replacement characters.
        lossy: String,
        /// Where the first of those is.
        offset: usize,
    },
    /// More bytes than [`Limits::file_bytes`].
    TooLarge {
        /// Size of the file.
        bytes: u64,
    },
    /// The operating system's message.
    Io(String),
}

/// Where a package's files come from. Paths are relative to the root, `/`-separated.
pub trait Files: Send + Sync {
    /// The text of a file; `None` where there is none.
    fn read(&self, path: &str) -> Result<Option<String>, ReadError>;

    /// Every file with one of the extensions, sorted by bytes. Modules are looked up in it, so the
    /// order matters. [`Disk`] leaves out hidden files and folders, `target` and `node_modules`,
    /// and lists at most [`Limits::files`] files.
    fn list(&self, extensions: &[&str]) -> Vec<String>;

    /// How diagnostics name a file of this package.
    fn display(&self, path: &str) -> String {
        path.to_owned()
    }

    /// Whether other programs find a file of this package under the name that is shown.
    fn on_disk(&self, _path: &str) -> bool {
        false
    }

    /// The files themselves, if the program carries them.
    fn embedded(&self) -> Option<Embedded> {
        None
    }
}

/// A named set of files. The name is what other packages import it by.
pub struct Package {
    /// Name in import paths.
    pub name: String,
    /// Its files.
    pub files: Box<dyn Files>,
}

/// A folder on disk.
pub struct Disk {
    root: PathBuf,
    shown: PathBuf,
}

impl Disk {
    /// The folder `root`. Diagnostics name files as `root` was written.
    pub fn new(root: impl Into<PathBuf>) -> std::io::Result<Self> {
        let shown = root.into();
        let folder = if shown.as_os_str().is_empty() { Path::new(".") } else { &shown };
        Ok(Self { root: folder.canonicalize()?, shown })
    }

    /// Whether this folder is `real` or below it. `real` is a path in which links were followed.
    pub fn is_below(&self, real: &Path) -> bool {
        self.root.starts_with(real)
    }
}

impl Files for Disk {
    fn read(&self, path: &str) -> Result<Option<String>, ReadError> {
        if !is_inside(path) {
            return Err(ReadError::OutsideRoot);
        }
        let joined = self.root.join(path);
        let real = match joined.canonicalize() {
            Ok(real) => real,
            Err(error)
                if error.kind() == std::io::ErrorKind::NotFound
                    || error.kind() == std::io::ErrorKind::NotADirectory =>
            {
                return Ok(None);
            }
            Err(error) => return Err(ReadError::Io(error.to_string())),
        };
        if !real.starts_with(&self.root) {
            return Err(ReadError::OutsideRoot);
        }
        let io = |error: std::io::Error| ReadError::Io(error.to_string());
        let metadata = fs::metadata(&real).map_err(io)?;
        if !metadata.is_file() {
            return Ok(None);
        }
        if metadata.len() > LIMITS.file_bytes as u64 {
            return Err(ReadError::TooLarge { bytes: metadata.len() });
        }
        decode_text(input::read_file(&real, LIMITS.file_bytes as u64).map_err(io)?).map(Some)
    }

    fn list(&self, extensions: &[&str]) -> Vec<String> {
        let mut found = Vec::new();
        let mut folders = vec![(self.root.clone(), String::new())];
        while let Some((folder, prefix)) = folders.pop() {
            for entry in fs::read_dir(&folder).into_iter().flatten().flatten() {
                let Ok(name) = entry.file_name().into_string() else { continue };
                let Ok(kind) = entry.file_type() else { continue };
                if name.starts_with('.') || found.len() >= LIMITS.files {
                    continue;
                }
                if kind.is_dir() && name != "target" && name != "node_modules" {
                    folders.push((entry.path(), format!("{prefix}{name}/")));
                } else if kind.is_file() && has_extension(&name, extensions) {
                    found.push(format!("{prefix}{name}"));
                }
            }
        }
        found.sort();
        found
    }

    fn display(&self, path: &str) -> String {
        shown_path(&self.shown.join(path))
    }

    fn on_disk(&self, _path: &str) -> bool {
        true
    }
}

/// A path as its author would write it: without `.`, and without `..` if the file is below the
/// current folder.
pub fn shown_path(path: &Path) -> String {
    let tidy: PathBuf =
        path.components().filter(|component| *component != Component::CurDir).collect();
    let short = if tidy.components().any(|component| component == Component::ParentDir) {
        below_here(&tidy).unwrap_or(tidy)
    } else {
        tidy
    };
    let shown = short.to_string_lossy();
    // Elsewhere, a backslash is a letter of a name.
    if cfg!(windows) { shown.replace('\\', "/") } else { shown.into_owned() }
}

/// The name of a file from the current folder, if it is below that.
fn below_here(path: &Path) -> Option<PathBuf> {
    let here = Path::new(".").canonicalize().ok()?;
    let (folder, name) = (path.parent()?, path.file_name()?);
    let real =
        if folder.as_os_str().is_empty() { here.clone() } else { folder.canonicalize().ok()? };
    Some(real.strip_prefix(&here).ok()?.join(name))
}

/// Files that a program carries in itself, such as those of the shader library. Both lists are
/// sorted by path.
#[derive(Debug, Clone, Copy)]
pub struct Embedded {
    /// Path and text of each file that is text.
    pub texts: &'static [(&'static str, &'static str)],
    /// Path and bytes of each precomputed table.
    pub tables: &'static [(&'static str, &'static [u8])],
}

impl Embedded {
    /// The bytes of a precomputed table, if there is one of that path.
    pub fn table(self, path: &str) -> Option<&'static [u8]> {
        find_file(self.tables, path)
    }
}

fn find_file<T: Copy>(files: &[(&str, T)], path: &str) -> Option<T> {
    let index = files.binary_search_by(|(name, _)| (*name).cmp(path)).ok()?;
    files.get(index).map(|(_, content)| *content)
}

impl Files for Embedded {
    fn read(&self, path: &str) -> Result<Option<String>, ReadError> {
        Ok(find_file(self.texts, path).map(str::to_owned))
    }

    fn list(&self, extensions: &[&str]) -> Vec<String> {
        self.texts
            .iter()
            .filter(|(name, _)| has_extension(name, extensions))
            .map(|(name, _)| (*name).to_owned())
            .collect()
    }

    fn display(&self, path: &str) -> String {
        format!("lamplight/{path}")
    }

    fn embedded(&self) -> Option<Embedded> {
        Some(*self)
    }
}

/// Files held in memory: tests, generated modules, editors' unsaved text.
#[derive(Default)]
pub struct Memory(pub std::collections::BTreeMap<String, String>);

impl Files for Memory {
    fn read(&self, path: &str) -> Result<Option<String>, ReadError> {
        if !is_inside(path) {
            return Err(ReadError::OutsideRoot);
        }
        match self.0.get(path) {
            Some(text) if text.len() > LIMITS.file_bytes => {
                Err(ReadError::TooLarge { bytes: text.len() as u64 })
            }
            found => Ok(found.cloned()),
        }
    }

    fn list(&self, extensions: &[&str]) -> Vec<String> {
        self.0.keys().filter(|name| has_extension(name, extensions)).cloned().collect()
    }
}

fn has_extension(name: &str, extensions: &[&str]) -> bool {
    name.rsplit_once('.').is_some_and(|(_, extension)| extensions.contains(&extension))
}

/// Whether a relative path stays below its root. Links are not considered.
pub fn is_inside(path: &str) -> bool {
    let mut depth = 0i32;
    Path::new(path).components().all(|component| {
        match component {
            Component::Normal(_) => depth += 1,
            Component::CurDir => {}
            Component::ParentDir => depth -= 1,
            Component::RootDir | Component::Prefix(_) => return false,
        }
        depth >= 0
    })
}

/// The text of a file, without the byte-order mark that some editors write.
fn decode_text(mut bytes: Vec<u8>) -> Result<String, ReadError> {
    if bytes.starts_with("\u{feff}".as_bytes()) {
        bytes.drain(..'\u{feff}'.len_utf8());
    }
    String::from_utf8(bytes).map_err(|error| {
        let offset = error.utf8_error().valid_up_to();
        ReadError::NotUtf8 { lossy: String::from_utf8_lossy(error.as_bytes()).into_owned(), offset }
    })
}

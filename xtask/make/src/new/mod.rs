//! What `cargo xtask new` writes: one file of this folder for each kind of thing.
//!
//! The files are incomplete on purpose. A test fails until they are completed, and
//! [`NewFiles::next`] names it.

mod axis_places;
mod axis_value;
mod change;
mod compiled;
mod diagnostic;
mod executor;
mod formula;
pub mod function;
pub mod parameter;
mod reason;
mod renumber;
mod scene;
mod target;

use std::path::Path;

/// A kind of thing that is added by adding or extending files.
pub struct TaskKind {
    /// As written on the command line.
    pub name: &'static str,
    /// Its name, and further arguments that it must have.
    pub example: &'static [&'static str],
    /// Arguments that it may have, for the usage.
    pub rest: &'static str,
    /// Makes the texts of new and of extended files for a name. It only reads the repository.
    pub make: MakeTask,
}

/// Makes one thing from its name and the arguments that follow it.
pub type MakeTask = fn(&Repository<'_>, &str, &[&str]) -> Result<NewFiles, String>;

/// Every kind.
pub const KINDS: &[TaskKind] = &[
    function::KIND,
    reason::KIND,
    axis_value::KIND,
    target::KIND,
    executor::KIND,
    scene::KIND,
    diagnostic::KIND,
    change::KIND,
];

/// What to write, and what to do afterwards.
#[derive(Debug, Default)]
pub struct NewFiles {
    /// Paths below the repository's root, each with the file's whole new text.
    pub files: Vec<(String, String)>,
    /// Steps that complete the work, each with the test that demands it.
    pub next: Vec<String>,
}

/// The repository that is extended.
pub struct Repository<'r> {
    /// Its folder.
    pub root: &'r Path,
}

impl Repository<'_> {
    /// The text of a file; `None` if there is no such file.
    fn find(&self, path: &str) -> Option<String> {
        std::fs::read_to_string(self.root.join(path)).ok()
    }

    /// The text of a file that must exist.
    fn read(&self, path: &str) -> Result<String, String> {
        self.find(path).ok_or_else(|| format!("cannot read `{path}`"))
    }

    /// The names of the Rust files of a folder, without their ending, in order.
    fn stems(&self, folder: &str) -> Result<Vec<String>, String> {
        let entries = std::fs::read_dir(self.root.join(folder));
        let entries = entries.map_err(|_| format!("cannot read `{folder}`"))?;
        let names = entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned());
        let mut stems: Vec<String> =
            names.filter_map(|name| name.strip_suffix(".rs").map(str::to_owned)).collect();
        stems.sort();
        Ok(stems)
    }

    /// Fails if the file exists.
    fn refuse_existing(&self, path: &str) -> Result<(), String> {
        match self.root.join(path).exists() {
            true => Err(format!("`{path}` exists already")),
            false => Ok(()),
        }
    }
}

/// The files for one thing of a kind.
pub fn make(root: &Path, kind: &str, name: &str, rest: &[&str]) -> Result<NewFiles, String> {
    let known: Vec<&str> = KINDS.iter().map(|kind| kind.name).collect();
    let kind = KINDS
        .iter()
        .find(|known| known.name == kind)
        .ok_or_else(|| format!("there is no kind `{kind}`; kinds: {}", known.join(", ")))?;
    (kind.make)(&Repository { root }, name, rest)
}

/// Fails if there are arguments that a kind does not take.
fn refuse_rest(rest: &[&str]) -> Result<(), String> {
    match rest.first() {
        Some(word) => Err(format!("nothing may follow the name, found `{word}`")),
        None => Ok(()),
    }
}

/// Fails unless the name consists of lower-case letters, digits and `joint`, and begins with a
/// letter.
fn check_name(name: &str, joint: char) -> Result<(), String> {
    let is_part = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit();
    let begins = name.starts_with(|first: char| first.is_ascii_lowercase());
    match begins && name.chars().all(|letter| is_part(letter) || letter == joint) {
        true => Ok(()),
        false => Err(format!("`{name}` must be small letters, digits and `{joint}`")),
    }
}

//! The permutations a program asked for while it ran, as a list that a manifest can name.
//!
//! ```text
//! # Permutations asked for: a program and a key, one a line.
//! forward default
//! forward shadow=hard,two_sided
//! ```
//!
//! Lines are written sorted, but any order is read. So `sort -u` merges the lists of several runs.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::fmt;
use std::path::Path;
use std::sync::{PoisonError, RwLock};

use super::Error;
use lamplight_files::input;
use lamplight_files::output;

const HEADER: &str = "# Permutations asked for: a program and a key, one a line.";

/// The most bytes that a list in a file may have.
const MOST_BYTES: u64 = 256 << 20;

/// The lines of a list that are neither blank nor comments, without the spaces around them. Before
/// each line come its number, from 1, and the offset of its first byte in the text.
pub fn usage_lines(text: &str) -> impl Iterator<Item = (usize, usize, &str)> {
    let mut start = 0;
    text.split_inclusive('\n').enumerate().filter_map(move |(index, line)| {
        let content = line.trim();
        let at = start + line.len() - line.trim_start().len();
        start += line.len();
        let is_entry = !content.is_empty() && !content.starts_with('#');
        is_entry.then_some((index + 1, at, content))
    })
}

/// Keys by program, in canonical form.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Usage {
    /// Keys that were asked for, by program.
    pub keys: BTreeMap<String, BTreeSet<String>>,
}

impl Usage {
    /// Reads a list. The error is the number, from 1, of a line that is not an entry.
    pub fn parse(text: &str) -> Result<Self, usize> {
        let mut usage = Self::default();
        for (number, _, line) in usage_lines(text) {
            let (program, key) = line.split_once(char::is_whitespace).ok_or(number)?;
            usage.keys.entry(program.to_owned()).or_default().insert(key.trim().to_owned());
        }
        Ok(usage)
    }

    /// Adds to the list in a file. The file is made if it does not exist, and is replaced as a
    /// whole.
    ///
    /// # Errors
    /// [`Error::Corrupt`] where the file is not a list; it is not changed then.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let path = path.as_ref();
        let mut all = match input::read_file(path, MOST_BYTES) {
            Ok(text) => Self::parse(&String::from_utf8_lossy(&text)).map_err(|line| {
                Error::corrupt("usage list", format!("line {line} is not a program and a key"))
            })?,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Self::default(),
            Err(error) => return Err(error.into()),
        };
        for (program, keys) in &self.keys {
            all.keys.entry(program.clone()).or_default().extend(keys.iter().cloned());
        }
        Ok(output::write(path, all.to_string().as_bytes())?)
    }
}

impl fmt::Display for Usage {
    /// The list.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{HEADER}")?;
        self.keys.iter().try_for_each(|(program, keys)| {
            keys.iter().try_for_each(|key| writeln!(f, "{program} {key}"))
        })
    }
}

/// Collects keys from many threads. A key that was seen before costs only a shared lock and a
/// lookup.
#[derive(Default)]
pub struct Recorder(RwLock<BTreeMap<String, HashSet<String>>>);

impl Recorder {
    pub fn note(&self, program: &str, key: &str) {
        let known = self
            .0
            .read()
            .unwrap_or_else(PoisonError::into_inner)
            .get(program)
            .is_some_and(|keys| keys.contains(key));
        if !known {
            let mut all = self.0.write().unwrap_or_else(PoisonError::into_inner);
            all.entry(program.to_owned()).or_default().insert(key.to_owned());
        }
    }

    /// What was asked for so far.
    pub fn usage(&self) -> Usage {
        let seen = self.0.read().unwrap_or_else(PoisonError::into_inner);
        Usage {
            keys: seen
                .iter()
                .map(|(program, keys)| (program.clone(), keys.iter().cloned().collect()))
                .collect(),
        }
    }
}

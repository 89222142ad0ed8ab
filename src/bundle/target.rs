//! Output languages.

use std::fmt;

/// An output language, by name. Each file of `src/emit/targets/` is one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Target(&'static str);

include!(concat!(env!("OUT_DIR"), "/target_names.rs"));

impl Target {
    /// Lower-case name, as in manifests and on the command line.
    pub const fn name(self) -> &'static str {
        self.0
    }

    /// The target of that name.
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|target| target.0 == name)
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }
}

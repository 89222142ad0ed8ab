//! From parsed modules to a graph of items and what each refers to.

pub mod wesl;
pub mod glsl;

use crate::source::Package;

/// The packages a composition may read.
pub struct Packages {
    /// The author's own; `package::` in WESL.
    pub root: Package,
    /// Those it may import by name.
    pub dependencies: Vec<Package>,
}

impl Packages {
    /// The dependency of that name.
    pub fn dependency(&self, name: &str) -> Option<&Package> {
        self.dependencies.iter().find(|package| package.name == name)
    }
}

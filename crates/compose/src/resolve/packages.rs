//! The packages that a composition may read, and what a name means in each of them.

use std::collections::BTreeMap;

use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::{Embedded, Memory, Package};

/// Number of the root package; dependency `i` has the number `i + 1`.
pub const ROOT: usize = 0;

/// The packages a composition may read. Each has a number: [`ROOT`], or one more than its index
/// among the dependencies.
///
/// Which package a name means is decided by the package that uses the name, not by the composition:
/// two packages may give one name to different packages.
pub struct Packages {
    /// The author's own; `package::` in WESL.
    pub root: Package,
    /// Warnings about the files that declare the packages.
    pub warnings: Diagnostics,
    /// What is read before every root file in GLSL: `#define` lines, and declarations.
    pub definitions: String,
    /// What is read after every root file in GLSL.
    pub ending: String,
    /// Numbers of the packages where an `#include` is looked for last.
    includes: Vec<usize>,
    dependencies: Vec<Package>,
    /// By the number of the package that imports.
    scopes: Vec<Scope>,
}

/// What one package may import.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Scope {
    /// Numbers of packages, by the names with which paths start. A package may have its own name
    /// here.
    pub names: BTreeMap<String, usize>,
    /// The file that declares the names, as diagnostics show it; `None` for packages in memory.
    pub manifest: Option<String>,
}

impl Packages {
    /// Packages in memory. Each of them may import every dependency by the name that it has, and
    /// itself.
    pub fn new(root: Package, dependencies: Vec<Package>) -> Self {
        let mut names: BTreeMap<String, usize> = BTreeMap::new();
        for (index, package) in dependencies.iter().enumerate() {
            names.entry(package.name.clone()).or_insert(index + 1);
        }
        names.entry(root.name.clone()).or_insert(ROOT);
        let scopes = vec![Scope { names, manifest: None }; dependencies.len() + 1];
        Self::scoped(root, dependencies, scopes)
    }

    /// Packages with what each of them declares, the root first. The names of the packages must
    /// differ, since they appear in outputs.
    pub fn scoped(root: Package, dependencies: Vec<Package>, mut scopes: Vec<Scope>) -> Self {
        scopes.resize(dependencies.len() + 1, Scope::default());
        Self {
            root,
            warnings: Vec::new(),
            definitions: String::new(),
            ending: String::new(),
            includes: Vec::new(),
            dependencies,
            scopes,
        }
    }

    /// A package with nothing but one text, which imports nothing.
    pub fn of_text(path: &str, text: String) -> Self {
        let files = Box::new(Memory([(path.to_owned(), text)].into()));
        Self::new(Package { name: "package".to_owned(), files }, Vec::new())
    }

    /// Adds a package that every package may import.
    pub fn add(&mut self, package: Package) {
        self.dependencies.push(package);
        let number = self.dependencies.len();
        let name = &self.dependencies[number - 1].name;
        self.scopes.push(self.scopes[ROOT].clone());
        for scope in &mut self.scopes {
            scope.names.entry(name.clone()).or_insert(number);
        }
    }

    /// Adds files that an `#include` finds by their paths where nothing else has them.
    pub fn add_includes(&mut self, package: Package) {
        self.dependencies.push(package);
        self.scopes.push(self.scopes[ROOT].clone());
        self.includes.push(self.dependencies.len());
    }

    /// The numbers of the packages that [`Self::add_includes`] added, in their order.
    pub fn includes(&self) -> &[usize] {
        &self.includes
    }

    /// The package of a number; the root if there is none.
    pub fn package(&self, number: usize) -> &Package {
        number.checked_sub(1).and_then(|index| self.dependencies.get(index)).unwrap_or(&self.root)
    }

    /// All packages, the root first.
    pub fn all(&self) -> impl Iterator<Item = &Package> {
        std::iter::once(&self.root).chain(&self.dependencies)
    }

    /// What each package may import, the root first.
    pub fn scopes(&self) -> &[Scope] {
        &self.scopes
    }

    /// What a package may import.
    pub fn scope(&self, number: usize) -> &Scope {
        self.scopes.get(number).unwrap_or(&self.scopes[ROOT])
    }

    /// The number of the package that a name means in another package.
    pub fn find(&self, importer: usize, name: &str) -> Option<usize> {
        self.scope(importer).names.get(name).copied()
    }

    /// The library that may be imported, if it is the one that the program carries.
    pub fn library(&self) -> Option<Embedded> {
        self.dependencies.iter().find_map(|package| package.files.embedded())
    }

    /// The dependency of that name in the root package.
    pub fn dependency(&self, name: &str) -> Option<&Package> {
        self.find(ROOT, name).filter(|number| *number != ROOT).map(|number| self.package(number))
    }

    /// Notes for an error about a name that another package declares, and the importer does not;
    /// `None` if no package declares it.
    pub fn undeclared_notes(&self, importer: usize, name: &str) -> Option<[String; 2]> {
        let declares = |number: &usize| {
            *number != importer && self.find(*number, name).is_some_and(|found| found != *number)
        };
        let declarer = (0..self.scopes.len()).find(declares)?;
        let declarer = match declarer {
            ROOT => "the package that is compiled",
            number => &format!("`{}`", self.package(number).name),
        };
        let manifest = match &self.scope(importer).manifest {
            Some(manifest) => format!("`{manifest}`"),
            None => "the `wesl.toml` of this package".to_owned(),
        };
        Some([
            format!("`{name}` is a dependency of {declarer}, not of this package"),
            format!("help: declare it below `[dependencies]` in {manifest} too"),
        ])
    }

    /// The same packages with other files.
    pub fn map(self, mut change: impl FnMut(Package) -> Package) -> Self {
        let root = change(self.root);
        let dependencies = self.dependencies.into_iter().map(change).collect();
        Self { root, dependencies, ..self }
    }

    /// The root, the dependencies, and what each of them may import.
    pub fn into_parts(self) -> (Package, Vec<Package>, Vec<Scope>) {
        (self.root, self.dependencies, self.scopes)
    }
}

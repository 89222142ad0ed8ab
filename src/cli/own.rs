//! The user's own package, for commands that are about the library and also about that package.

use std::path::{Path, PathBuf};

use clap::Args;

use super::failure::Failure;
use crate::LIBRARY_FILES;
use crate::check::library::Library;
use crate::permute::Manifest;
use crate::project::{self, LIBRARY};
use crate::resolve::Packages;
use crate::source::SourceSet;

/// Where it is.
#[derive(Args)]
pub struct OwnPackage {
    /// The root directory of your own package [default: the package here, if there is one].
    #[arg(long, value_name = "DIR")]
    root: Option<PathBuf>,
}

impl OwnPackage {
    /// That at a root directory, or else the package here.
    pub fn at(root: Option<PathBuf>) -> Self {
        Self { root }
    }

    /// Its root folder; `None` for the library's own sources, which are not a second package.
    pub fn root(&self) -> Option<PathBuf> {
        let found = || {
            project::package_above(Path::new(""))
                .filter(|root| project::declared_name(root).as_deref() != Some(LIBRARY))
        };
        self.root.clone().or_else(found)
    }

    /// It and what it may import.
    pub fn packages(&self) -> Result<Option<Packages>, Failure> {
        let mut sources = SourceSet::default();
        let opened = self.root().map(|root| project::packages(&root, &mut sources)).transpose();
        opened.map_err(|diagnostics| Failure::Input(sources, diagnostics))
    }

    /// Its manifest.
    pub fn manifest(&self) -> Result<Option<Manifest>, Failure> {
        let mut sources = SourceSet::default();
        let found = self.root().map(|root| project::manifest(&root, &mut sources)).transpose();
        Ok(found.map_err(|diagnostics| Failure::Input(sources, diagnostics))?.flatten())
    }

    /// The functions that expressions may call: those of the library, and its own.
    pub fn library(&self) -> Result<Library, Failure> {
        let Some(packages) = self.packages()? else { return Ok(Library::shipped(LIBRARY_FILES)) };
        Ok(Library::of_packages(NAME, packages))
    }
}

/// The name of the package in expressions. Those are a package of their own, in which `package::`
/// means this name.
const NAME: &str = "lamplight_own";

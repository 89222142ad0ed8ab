//! Composes the same tree with our composer and with the `wesl` crate.

use std::borrow::Cow;
use std::collections::BTreeMap;

use lamplight::compose::{Mangle, Options, wesl as ours};
use lamplight::diagnostic::render::{Form, render};
use lamplight::permute::{Setting, Settings};
use lamplight::resolve::{self, Packages};
use lamplight::source::{Memory, Package, SourceSet};
use wesl::ModulePath;
use wesl::syntax::PathOrigin;

/// Files by package and path. The name of the author's own package is empty.
pub type Files = BTreeMap<(String, String), String>;

/// Feature flags of a permutation.
pub type Flags = BTreeMap<String, bool>;

/// Our text, or our diagnostics as users see them.
pub fn lamplight(
    files: &Files,
    root: &str,
    flags: &Flags,
    mangle: Mangle,
) -> Result<String, String> {
    let values = flags.iter().map(|(name, on)| (name.clone(), Setting::Bool(*on))).collect();
    lamplight_with(files, root, &Settings { values, ..Settings::default() }, mangle)
}

/// The same with settings of any kind.
pub fn lamplight_with(
    files: &Files,
    root: &str,
    settings: &Settings,
    mangle: Mangle,
) -> Result<String, String> {
    let mut packages: BTreeMap<&str, Memory> = BTreeMap::new();
    for ((package, path), text) in files {
        packages.entry(package).or_default().0.insert(path.clone(), text.clone());
    }
    let package =
        |name: &str, files: Memory| Package { name: name.to_owned(), files: Box::new(files) };
    let own = package("package", packages.remove("").unwrap_or_default());
    let dependencies = packages.into_iter().map(|(name, files)| package(name, files)).collect();
    let packages = Packages::new(own, dependencies);
    let mut sources = SourceSet::default();
    let options = Options { mangle, ..Options::default() };
    let composed = resolve::wesl::load(&mut sources, &packages, root)
        .and_then(|graph| ours::compose(&graph, settings, &options));
    composed
        .map(|composed| composed.text)
        .map_err(|problems| render(&sources, &problems, Form::Human))
}

/// The composer of the `wesl` crate, set up once for a tree.
pub struct Peer {
    compiler: wesl::Wesl<wesl::VirtualResolver<'static>>,
}

impl Peer {
    /// With the features that its documentation calls standard: imports, conditions, removal of
    /// unused declarations, escaped names.
    pub fn new(files: &Files) -> Self {
        Self::with(files, wesl::CompileOptions::default())
    }

    /// Keeps every declaration of the root, for modules without entry points.
    pub fn keeping_root(files: &Files) -> Self {
        Self::with(
            files,
            wesl::CompileOptions { keep_root: true, ..wesl::CompileOptions::default() },
        )
    }

    fn with(files: &Files, options: wesl::CompileOptions) -> Self {
        let mut resolver = wesl::VirtualResolver::new();
        for ((package, path), text) in files {
            resolver.add_module(module_path(package, path), Cow::Owned(text.clone()));
        }
        let mut compiler = wesl::Wesl::new_barebones().set_custom_resolver(resolver);
        compiler.set_options(wesl::CompileOptions { validate: false, ..options });
        compiler.set_missing_feature_behavior(wesl::Feature::Error);
        compiler.set_mangler(wesl::ManglerKind::Escape);
        Self { compiler }
    }

    /// The crate's text, or its error.
    pub fn compose(&mut self, root: &str, flags: &Flags) -> Result<String, String> {
        for (name, on) in flags {
            self.compiler.set_feature(name, *on);
        }
        let compiled =
            self.compiler.compile(&module_path("", root)).map_err(|error| error.to_string())?;
        Ok(compiled.to_string())
    }
}

fn module_path(package: &str, path: &str) -> ModulePath {
    let origin = if package.is_empty() {
        PathOrigin::Absolute
    } else {
        PathOrigin::Package(package.to_owned())
    };
    let path = path.trim_end_matches(".wesl").trim_end_matches(".wgsl");
    ModulePath::new(
        origin,
        path.split('/').filter(|part| !part.is_empty()).map(str::to_owned).collect(),
    )
}

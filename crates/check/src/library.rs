//! Composes the modules of a package for numeric tests: the shipped library, or a user's own package.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::cases::{self, CaseFile};
use super::check::values::{MeasuredCase, ValueRecord, measure_values};
use super::check::{self, CheckReport, CheckedModule, OpenExecutor};
use super::ratchet::{self, Ratchet};
use super::untested;
use lamplight_bundle::Language;
use lamplight_compose::project::LIBRARY;
use lamplight_compose::resolve::{self, Packages, ROOT, Scope};
use lamplight_compose::{self as compose, Composed, Keep, Options};
use lamplight_diagnostic::source::{self, Embedded, Files, Memory, Package, ReadError, SourceSet};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_execute::Session;
use lamplight_permute::Settings;
use lamplight_validate::{self as validate, Validated};

/// A package and those it may import, shared by threads.
#[derive(Clone)]
pub struct Library {
    name: String,
    files: Arc<dyn Files>,
    dependencies: Vec<(String, Arc<dyn Files>)>,
    /// What each may import, the package itself first.
    scopes: Vec<Scope>,
    /// The settings for which its modules are composed.
    settings: Settings,
}

impl Library {
    /// The library that the program carries.
    pub fn shipped(files: Embedded) -> Self {
        Self::new(LIBRARY, Arc::new(files), Vec::new())
    }

    /// A package with its dependencies, by name.
    pub fn new(
        name: &str,
        files: Arc<dyn Files>,
        dependencies: Vec<(String, Arc<dyn Files>)>,
    ) -> Self {
        let shared = |(name, files): &(String, Arc<dyn Files>)| shared_package(name, files);
        let all = dependencies.iter().map(shared).collect();
        let (_, _, scopes) = Packages::new(shared_package(name, &files), all).into_parts();
        Self { name: name.to_owned(), files, dependencies, scopes, settings: Settings::default() }
    }

    /// The root of the packages, by a name that it has among them from now on.
    pub fn of_packages(name: &str, packages: Packages) -> Self {
        let (root, dependencies, mut scopes) = packages.into_parts();
        scopes[ROOT].names.insert(name.to_owned(), ROOT);
        let shared = |package: Package| (package.name, Arc::from(package.files));
        Self {
            name: name.to_owned(),
            files: Arc::from(root.files),
            dependencies: dependencies.into_iter().map(shared).collect(),
            scopes,
            settings: Settings::default(),
        }
    }

    /// The same package, composed under other settings.
    pub fn with_settings(self, settings: Settings) -> Self {
        Self { settings, ..self }
    }

    /// Name in import paths.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Paths of all case files: TOML files beside a module of the same name.
    pub fn case_files(&self) -> Vec<String> {
        let modules = self.files.list(&["wesl", "wgsl", "glsl"]);
        let has_module = |path: &str| {
            let stem = path.trim_end_matches("toml");
            modules.iter().any(|module| {
                module.strip_prefix(stem).is_some_and(|rest| !rest.contains(['.', '/']))
            })
        };
        self.files.list(&["toml"]).into_iter().filter(|path| has_module(path)).collect()
    }

    /// Paths of all modules that are not programs, such as `lighting::spot`.
    pub fn modules(&self) -> Vec<String> {
        let paths =
            self.files.list(&["wesl"]).into_iter().filter(|path| !path.starts_with("programs/"));
        paths.map(|path| path.trim_end_matches(".wesl").replace('/', "::")).collect()
    }

    /// The text of a file of the package, if it is there.
    pub fn text(&self, path: &str) -> Option<String> {
        self.files.read(path).ok().flatten()
    }

    /// The first path components of the modules, such as `lighting` and `brdf`.
    pub fn folders(&self) -> Vec<String> {
        module_folders(&*self.files)
    }

    /// The same of a package that it may import; none if there is no such package.
    pub fn folders_of_dependency(&self, name: &str) -> Vec<String> {
        let mut named = self.dependencies.iter().filter(|(known, _)| known == name);
        named.next().map_or_else(Vec::new, |(_, files)| module_folders(&**files))
    }

    /// Checks case files (paths below the package) in the languages on the open executors, which
    /// must not need more than was recorded for them.
    pub fn check(
        &self,
        sources: &Mutex<SourceSet>,
        paths: &[String],
        languages: &[Language],
        open: &mut [OpenExecutor],
    ) -> Result<CheckReport, Diagnostics> {
        let ratchet = self.ratchet(sources)?;
        let options = check::CheckOptions {
            references: self.has_references(),
            ratchet: ratchet.as_ref(),
            ..check::CheckOptions::default()
        };
        self.check_with(sources, paths, languages, open, &options)
    }

    /// Whether the references in `crates/check/src/references/` are about this package.
    pub fn has_references(&self) -> bool {
        self.name == LIBRARY
    }

    /// What drivers were measured to need for the package's tolerances, if that is recorded.
    pub fn ratchet(&self, sources: &Mutex<SourceSet>) -> Result<Option<Ratchet>, Diagnostics> {
        let mut sources = lock_sources(sources);
        let id = source::read(&mut sources, &self.package(), ratchet::FILE)
            .map_err(|error| vec![error.into()])?;
        id.map(|id| Ratchet::parse(&sources.get(id).text, id))
            .transpose()
            .map_err(|error| vec![error])
    }

    /// As [`Self::check`], with options.
    pub fn check_with(
        &self,
        sources: &Mutex<SourceSet>,
        paths: &[String],
        languages: &[Language],
        open: &mut [OpenExecutor],
        options: &check::CheckOptions<'_>,
    ) -> Result<CheckReport, Diagnostics> {
        let files = self.read(sources, paths)?;
        let subjects = |module: &str, language: Language, functions: &[String]| {
            self.checked_module(sources, module, language, functions)
        };
        let mut report = check::check_with(&files, languages, &subjects, open, options)?;
        for (module, file) in &files {
            let text = |ending| self.text(&format!("{}.{ending}", module.replace("::", "/")));
            report.untested.extend(match (text("wesl"), text("glsl")) {
                (Some(text), _) => untested::untested_functions(module, &text, file),
                (None, Some(text)) => untested::of_glsl(module, &text, file),
                (None, None) => Vec::new(),
            });
        }
        Ok(report)
    }

    /// What the functions of case files return: for the inputs of an older record, or else for inputs
    /// that the cases have.
    pub fn measure_values(
        &self,
        sources: &Mutex<SourceSet>,
        paths: &[String],
        languages: &[Language],
        session: &mut dyn Session,
        old: Option<&ValueRecord>,
    ) -> Result<Vec<MeasuredCase>, Diagnostics> {
        let files = self.read(sources, paths)?;
        let subjects = |module: &str, language: Language, functions: &[String]| {
            self.checked_module(sources, module, language, functions)
        };
        let options = check::CheckOptions {
            references: self.has_references(),
            partners: false,
            ..check::CheckOptions::default()
        };
        let (mut measured, mut errors) = (Vec::new(), Vec::new());
        for (module, file) in &files {
            match check::job::prepare_jobs(module, file, languages, &subjects, &options) {
                Ok(jobs) => measured.extend(measure_values(&jobs, session, old)?),
                Err(found) => errors.extend(found),
            }
        }
        if errors.is_empty() { Ok(measured) } else { Err(errors) }
    }

    /// The case files of these paths, each with its module's path.
    pub fn read(
        &self,
        sources: &Mutex<SourceSet>,
        paths: &[String],
    ) -> Result<Vec<(String, CaseFile)>, Diagnostics> {
        let mut sources = lock_sources(sources);
        let package = self.package();
        let mut files = Vec::new();
        for path in paths {
            let id =
                source::read(&mut sources, &package, path).map_err(|error| vec![error.into()])?;
            let id = id.ok_or_else(|| {
                vec![Diagnostic::error(
                    codes::UNREADABLE,
                    format!("there is no case file `{path}`"),
                )]
            })?;
            let mut file = cases::parse_cases(&sources, id)?;
            if self.has_references() {
                file.promise_finite();
            }
            files.push((path.trim_end_matches(".toml").replace('/', "::"), file));
        }
        Ok(files)
    }

    /// A WESL module with everything that it declares, and the map back to its text.
    pub fn whole(
        &self,
        sources: &Mutex<SourceSet>,
        module: &str,
    ) -> Result<(Composed, Validated), Diagnostics> {
        let packages = self.packages(self.package());
        let root = format!("{}.wesl", module.replace("::", "/"));
        let graph = resolve::wesl::load(&mut lock_sources(sources), &packages, &root)?;
        let composed = compose::wesl::compose(&graph, &self.settings, &Options::default())?;
        let validated = validate::validate(&composed)?;
        Ok((composed, validated))
    }

    /// Composes a module of the package, with only the named functions and what they need.
    pub fn module(
        &self,
        sources: &Mutex<SourceSet>,
        module: &str,
        language: Language,
        functions: &[String],
    ) -> Result<Arc<naga::Module>, Diagnostics> {
        let (root, text) = self.root_of(module, language, "");
        let packages = self.with_root(&root, text);
        self.compose_module(sources, &packages, &root, language, functions)
            .map(|validated| Arc::new(validated.module))
    }

    /// The same, with the text itself where that is GLSL.
    pub fn checked_module(
        &self,
        sources: &Mutex<SourceSet>,
        module: &str,
        language: Language,
        functions: &[String],
    ) -> Result<CheckedModule, Diagnostics> {
        let found = self.module(sources, module, language, functions)?;
        if language == Language::Wesl {
            return Ok(CheckedModule::without_text(found));
        }
        let (root, text) = self.root_of(module, language, "#define LAMPLIGHT_COMBINED_SAMPLERS\n");
        let packages = self.with_root(&root, text);
        let composed = composed(sources, &packages, &root, language, functions, &self.settings)?;
        let text = composed.text.split_once('\n').map_or("", |(_, text)| text);
        let source = Some(text.replace(EMPTY_MAIN, "").into());
        Ok(CheckedModule { module: found, source })
    }

    /// The file that a module is composed from, and its text if the package does not have it.
    fn root_of(&self, module: &str, language: Language, head: &str) -> (String, Option<String>) {
        let path = module.replace("::", "/");
        match language {
            Language::Wesl => {
                let wesl = format!("{path}.wesl");
                let exists = self.files.read(&wesl).is_ok_and(|found| found.is_some());
                (if exists { wesl } else { format!("{path}.wgsl") }, None)
            }
            Language::Glsl => {
                let text = format!("#version 450\n{head}#include \"{path}.glsl\"\n{EMPTY_MAIN}\n");
                ("lamplight_check.frag.glsl".to_owned(), Some(text))
            }
        }
    }

    /// The package with one more file.
    fn with_root(&self, root: &str, text: Option<String>) -> Packages {
        let files = LibraryOverlay {
            base: self.files.clone(),
            extra: text.map(|text| (root.to_owned(), text)).into_iter().collect(),
        };
        self.packages(Package { name: self.name.clone(), files: Box::new(files) })
    }

    /// Composes a root file (its path and its text) in a package of its own, which imports this
    /// package by name. Only `function` and what it needs are kept.
    pub fn importing(
        &self,
        sources: &Mutex<SourceSet>,
        root: (&str, &str),
        language: Language,
        function: &str,
    ) -> Result<Validated, Diagnostics> {
        self.importing_text(sources, root, language, function).map(|(_, validated)| validated)
    }

    /// The same, with the composed text.
    pub fn importing_text(
        &self,
        sources: &Mutex<SourceSet>,
        root: (&str, &str),
        language: Language,
        function: &str,
    ) -> Result<(Composed, Validated), Diagnostics> {
        let files = Memory(BTreeMap::from([(root.0.to_owned(), root.1.to_owned())]));
        let caller = Package { name: "expression".to_owned(), files: Box::new(files) };
        let packages = self.packages_of_caller(caller);
        let functions = [function.to_owned()];
        let composed = composed(sources, &packages, root.0, language, &functions, &self.settings)?;
        let validated = validate::validate(&composed)?;
        Ok((composed, validated))
    }

    fn compose_module(
        &self,
        sources: &Mutex<SourceSet>,
        packages: &Packages,
        root: &str,
        language: Language,
        functions: &[String],
    ) -> Result<Validated, Diagnostics> {
        let composed = composed(sources, packages, root, language, functions, &self.settings)?;
        validate::validate(&composed)
    }

    fn package(&self) -> Package {
        shared_package(&self.name, &self.files)
    }

    /// The package, as the root of the packages that it may import.
    fn packages(&self, root: Package) -> Packages {
        Packages::scoped(root, self.dependencies(), self.scopes.clone())
    }

    /// A package that may import this one by its name, and all that this one may import.
    fn packages_of_caller(&self, caller: Package) -> Packages {
        let mut dependencies = self.dependencies();
        dependencies.push(self.package());
        let own = dependencies.len();
        let mut scopes = self.scopes.clone();
        // A package that imports the root by a name means the same package under its new number.
        let numbers = scopes.iter_mut().flat_map(|scope| scope.names.values_mut());
        numbers.filter(|number| **number == ROOT).for_each(|number| *number = own);
        scopes.push(scopes[ROOT].clone());
        scopes[ROOT].names.insert(self.name.clone(), own);
        Packages::scoped(caller, dependencies, scopes)
    }

    fn dependencies(&self) -> Vec<Package> {
        self.dependencies.iter().map(|(name, files)| shared_package(name, files)).collect()
    }
}

/// The entry point of a text that needs one.
const EMPTY_MAIN: &str = "void main() {}";

fn shared_package(name: &str, files: &Arc<dyn Files>) -> Package {
    Package {
        name: name.to_owned(),
        files: Box::new(LibraryOverlay { base: files.clone(), extra: BTreeMap::new() }),
    }
}

fn composed(
    sources: &Mutex<SourceSet>,
    packages: &Packages,
    root: &str,
    language: Language,
    functions: &[String],
    settings: &Settings,
) -> Result<Composed, Diagnostics> {
    let mut keep = functions.to_vec();
    match language {
        Language::Wesl => {
            let graph = resolve::wesl::load(&mut lock_sources(sources), packages, root)?;
            compose::wesl::compose(
                &graph,
                settings,
                &Options { keep: Keep::Items(keep), ..Options::default() },
            )
        }
        Language::Glsl => {
            let graph = resolve::glsl::load(&mut lock_sources(sources), packages, root)?;
            keep.push("main".to_owned());
            compose::glsl::compose(
                &graph,
                &relevant_settings(&graph, settings),
                &Options { keep: Keep::Items(keep), ..Options::default() },
            )
        }
    }
}

/// The settings that the files of a GLSL graph may test. Other settings belong to other programs of
/// the package, and their macros could replace names that this module declares.
fn relevant_settings(graph: &resolve::glsl::Graph, settings: &Settings) -> Settings {
    let mut relevant = settings.clone();
    relevant.values.retain(|name, _| graph.may_ask(name));
    Arc::make_mut(&mut relevant.enums).retain(|name, _| graph.may_ask(name));
    relevant
}

/// The files of a package, and texts that are added to them here.
struct LibraryOverlay {
    base: Arc<dyn Files>,
    extra: BTreeMap<String, String>,
}

impl Files for LibraryOverlay {
    fn read(&self, path: &str) -> Result<Option<String>, ReadError> {
        match self.extra.get(path) {
            Some(text) => Ok(Some(text.clone())),
            None => self.base.read(path),
        }
    }

    fn list(&self, extensions: &[&str]) -> Vec<String> {
        self.base.list(extensions)
    }

    fn display(&self, path: &str) -> String {
        self.base.display(path)
    }
}

pub fn lock_sources(sources: &Mutex<SourceSet>) -> std::sync::MutexGuard<'_, SourceSet> {
    sources.lock().unwrap_or_else(PoisonError::into_inner)
}

fn module_folders(files: &dyn Files) -> Vec<String> {
    let paths = files.list(&["wesl", "wgsl"]);
    let first = |path: &String| Some(path.split_once(['/', '.'])?.0.to_owned());
    let mut folders: Vec<_> = paths.iter().filter_map(first).collect();
    folders.dedup();
    folders
}

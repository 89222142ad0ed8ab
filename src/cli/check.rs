//! `lamplight check`: numeric cases of the library or of the user's own modules.

use std::io::{Write, stdout};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use clap::Args;

use super::failure::Failure;
use super::input::LanguageName;
use crate::compose::Language;
use crate::harness::check::{Open, Report, failures, table};
use crate::harness::executors;
use crate::harness::library::Library;
use crate::harness::on_thread;
use crate::project::{self, LIBRARY};
use crate::source::{Disk, Embedded, SourceSet};

/// Run numeric cases and compare with their references.
#[derive(Args)]
pub struct Arguments {
    /// Modules of the library (`lighting::spot`, `lighting`), or case files and folders of your
    /// own [default: the whole library].
    path: Vec<String>,
    /// What runs the cases; may be given several times.
    #[arg(long, value_name = "E", default_value = "eval")]
    executor: Vec<String>,
    /// Only one language [default: both].
    #[arg(long, value_enum)]
    lang: Option<LanguageName>,
}

/// Case files of one package.
struct Selection {
    library: Library,
    files: Vec<String>,
    languages: Vec<Language>,
}

pub fn run(arguments: Arguments) -> Result<(), Failure> {
    let selections = selections(&arguments)?;
    on_thread(|| check(&selections, &arguments)).unwrap_or_else(|| Err(Failure::environment("the check stopped with an internal error")))
}

/// Opens an executor by name.
pub fn open(name: &str) -> Result<Open, Failure> {
    let Some(entry) = executors::find(name) else {
        let names: Vec<&str> = executors::ALL.iter().map(|entry| entry.name).collect();
        return Err(Failure::usage(format!("there is no executor `{name}` (executors: {})", names.join(", "))));
    };
    let session = (entry.open)().map_err(|unavailable| Failure::environment(entry.missing(&unavailable)))?;
    Ok(Open { executor: entry.name, session })
}

fn check(selections: &[Selection], arguments: &Arguments) -> Result<(), Failure> {
    let mut sessions = arguments.executor.iter().map(|name| open(name)).collect::<Result<Vec<_>, _>>()?;
    let mut report = Report::default();
    for selection in selections {
        let sources = Mutex::new(SourceSet::default());
        let found = selection.library.check(&sources, &selection.files, &selection.languages, &mut sessions);
        let found = found.map_err(|diagnostics| Failure::Input(sources.into_inner().unwrap_or_default(), diagnostics))?;
        report.outcomes.extend(found.outcomes);
    }
    write!(stdout(), "{}", table(&report))?;
    let passed = report.outcomes.iter().filter(|outcome| outcome.passed()).count();
    writeln!(stdout(), "{passed} of {} pass", report.outcomes.len())?;
    if report.passed() { Ok(()) } else { Err(Failure::check(failures(&report))) }
}

fn selections(arguments: &Arguments) -> Result<Vec<Selection>, Failure> {
    let languages = |files: &[String], has: &dyn Fn(&str) -> bool| match arguments.lang {
        Some(language) => vec![language.into()],
        None => [(Language::Wesl, "wesl"), (Language::Glsl, "glsl")]
            .into_iter()
            .filter(|(_, extension)| {
                files.iter().all(|file| {
                    has(&file.replace(".toml", &format!(".{extension}"))) || (*extension == "wesl" && has(&file.replace(".toml", ".wgsl")))
                })
            })
            .map(|(language, _)| language)
            .collect(),
    };
    let (own, of_library): (Vec<&String>, Vec<&String>) = arguments.path.iter().partition(|path| Path::new(path).exists());
    let mut selections = Vec::new();
    if own.is_empty() {
        let library = Library::embedded();
        let files = library_files(&library, &of_library)?;
        let both = languages(&files, &|_| true);
        selections.push(Selection { library, files, languages: both });
    }
    for path in own {
        let (root, library) = package(Path::new(path))?;
        for file in own_files(&library, Path::new(path), &root)? {
            let present = languages(std::slice::from_ref(&file), &|name| root.join(name).is_file());
            selections.push(Selection { library: library.clone(), files: vec![file], languages: present });
        }
    }
    Ok(selections)
}

fn library_files(library: &Library, asked: &[&String]) -> Result<Vec<String>, Failure> {
    let files = library.case_files();
    if asked.is_empty() {
        return Ok(files);
    }
    let mut found = Vec::new();
    for path in asked {
        let wanted = path.trim_start_matches("lamplight::").replace("::", "/");
        let stem = |file: &str| file.trim_end_matches(".toml").to_owned();
        let matching: Vec<String> =
            files.iter().filter(|file| stem(file) == wanted || file.starts_with(&format!("{wanted}/"))).cloned().collect();
        if matching.is_empty() {
            return Err(Failure::input(format!("`{path}` is no file, and no module of the library with numeric cases")));
        }
        found.extend(matching);
    }
    Ok(found)
}

/// The package that a file or folder of the user's belongs to.
fn package(path: &Path) -> Result<(PathBuf, Library), Failure> {
    let root = if path.is_dir() { path.to_owned() } else { project::root_of(path) };
    let disk = Disk::new(&root).map_err(|error| Failure::input(format!("cannot read `{}`: {error}", root.display())))?;
    let dependencies = vec![(LIBRARY.to_owned(), Arc::new(Embedded) as Arc<dyn crate::source::Files>)];
    Ok((root, Library::new("package", Arc::new(disk), dependencies)))
}

fn own_files(library: &Library, path: &Path, root: &Path) -> Result<Vec<String>, Failure> {
    let files = library.case_files();
    if path.is_dir() {
        return Ok(files);
    }
    let name = project::relative(path, root).map_err(|diagnostic| Failure::input(diagnostic.message))?;
    if !name.ends_with(".toml") {
        return Err(Failure::input(format!("`{}` is no case file: cases are in the `.toml` beside a module", path.display())));
    }
    Ok(vec![name])
}

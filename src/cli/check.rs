//! `lamplight check`: numeric cases of the library or of the user's own modules.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use clap::Args;

use super::executor;
use super::failure::Failure;
use super::features;
use super::input::{self, LanguageName};
use super::values;
use crate::LIBRARY_FILES;
use crate::bundle::Language;
use crate::check::check::{
    CheckOptions, CheckReport, OpenExecutor, lacking_text, report_failures, report_table,
    stricter_cases,
};
use crate::check::library::Library;
use crate::check::ratchet::{FILE, Ratchet};
use crate::cli::terminal::stdout;
use crate::diagnostic::{Diagnostics, nearest_name, stopped_message};
use crate::execute::on_thread;
use crate::output::{self, Replace};
use crate::permute::{Setting, Settings};
use crate::project::{self, LIBRARY};
use crate::report;
use crate::source::{Disk, SourceSet};

/// Run numeric cases, and compare the results with the expected values.
#[derive(Args)]
pub struct Arguments {
    /// Modules of the library (`lighting::spot`, `lighting`; `lamplight` for all of it), or case
    /// files and folders of your own [default: the package here, else the whole library].
    path: Vec<String>,
    /// The executor that runs the cases; may be given several times.
    #[arg(long, value_name = "E", default_value = "eval")]
    pub executor: Vec<String>,
    /// Run only one language [default: both].
    #[arg(long, value_enum)]
    lang: Option<LanguageName>,
    /// Write an HTML page with plots, a JSON file, a JUnit file and a table of errors into this
    /// folder.
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    /// Record the measured errors in the package's `tolerances.toml`, where they are lower than
    /// those that it has.
    #[arg(long)]
    bless: bool,
    /// With `--bless`, also record errors that are higher. With `--report` and `--record`, replace
    /// files that Lamplight did not write.
    #[arg(long)]
    force: bool,
    /// Choose the value of a setting that your modules ask for.
    #[arg(long, value_name = "AXIS=VALUE", value_delimiter = ',', value_parser = input::axis_value)]
    set: Vec<(String, Setting)>,
    /// Turn a feature on, or turn it off with `=false`.
    #[arg(long, value_name = "NAME[=BOOL]", value_delimiter = ',', value_parser = input::parse_feature)]
    feature: Vec<(String, Setting)>,
    #[command(flatten)]
    features: features::Arguments,
    /// Instead of the check, write the values of the functions into this file, for `--against` of
    /// later versions.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["executor", "report", "bless", "spec"])]
    record: Option<PathBuf>,
    /// Instead of the check, compare the values of the functions with a file that `--record` has
    /// written.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["record", "executor", "report", "bless", "spec"])]
    against: Option<PathBuf>,
    /// List the cases whose tolerance is smaller than the error that WGSL allows.
    #[arg(long)]
    spec: bool,
}

/// How many functions without a case are listed by name.
const UNTESTED: usize = 10;

/// Case files of one package.
pub(super) struct Selection {
    pub library: Library,
    /// Its root folder, unless it is the embedded library.
    pub root: Option<PathBuf>,
    pub files: Vec<String>,
    pub languages: Vec<Language>,
}

pub fn run_check(arguments: Arguments) -> Result<(), Failure> {
    let selections = parse_selections(&arguments)?;
    on_thread(|| match (&arguments.record, &arguments.against) {
        (Some(file), _) => values::record_values(&selections, file, arguments.replace()),
        (None, Some(file)) => {
            let requested = |language| is_requested(&arguments, language);
            values::compare_with_record(&selections, file, requested)
        }
        (None, None) => check_selections(&selections, &arguments),
    })
    .unwrap_or_else(|| Err(Failure::environment(stopped_message("the check"))))
}

impl Arguments {
    /// What is chosen. Enum axes that the package's manifest declares can be compared.
    fn settings(&self, root: &Path) -> Result<Settings, Failure> {
        let mut sources = SourceSet::default();
        let manifest = project::manifest(root, &mut sources)
            .map_err(|diagnostics| Failure::Input(sources, diagnostics))?;
        let mut settings = Settings::default();
        for program in manifest.iter().flat_map(|manifest| &manifest.programs) {
            let of_program = program.space.settings(&program.space.default_assignment());
            settings.values.extend(of_program.values);
            let of_enums = of_program.enums.iter();
            let of_enums = of_enums.map(|(axis, values)| (axis.clone(), values.clone()));
            Arc::make_mut(&mut settings.enums).extend(of_enums);
            settings.integers.extend(of_program.integers);
            settings.undeclared = settings.undeclared.or(of_program.undeclared);
        }
        settings.values.extend(self.set.iter().chain(&self.feature).cloned());
        settings.undeclared = self.features.undeclared(settings.undeclared);
        settings.constants = self.features.constants();
        Ok(settings)
    }

    fn replace(&self) -> Replace {
        if self.force { Replace::Any } else { Replace::Ours }
    }
}

fn open_executor(name: &str) -> Result<OpenExecutor, Failure> {
    let entry = executor::find_executor(name)?;
    Ok(OpenExecutor { executor: entry.name, session: executor::open_executor(entry)? })
}

fn check_selections(selections: &[Selection], arguments: &Arguments) -> Result<(), Failure> {
    let mut sessions =
        arguments.executor.iter().map(|name| open_executor(name)).collect::<Result<Vec<_>, _>>()?;
    let mut report = CheckReport::default();
    let sources = Mutex::new(SourceSet::default());
    for selection in selections {
        match check_one(selection, &sources, arguments, &mut sessions) {
            Ok(found) => report.append(found?),
            Err(diagnostics) => {
                return Err(Failure::Input(sources.into_inner().unwrap_or_default(), diagnostics));
            }
        }
    }
    let sources = sources.into_inner().unwrap_or_default();
    write!(stdout(), "{}", report_table(&report))?;
    print_spec(&report, arguments.spec)?;
    print_untested(&report)?;
    let passed = report.outcomes.iter().filter(|outcome| outcome.passed()).count();
    write!(stdout(), "{passed} of {} pass", report.outcomes.len())?;
    let lacking = lacking_text(&report);
    match lacking.lines().count() {
        0 => writeln!(stdout())?,
        count => write!(stdout(), ", {count} cannot run on their executor:\n{lacking}")?,
    }
    if let Some(folder) = &arguments.report {
        let origin = report::ReportOrigin { sources: &sources, command: command_line() };
        let texts: Vec<(&str, String)> =
            report::ALL.iter().map(|form| (form.file, (form.text)(&report, &origin))).collect();
        let files = texts.iter().map(|(name, text)| (*name, text.as_bytes()));
        output::write_folder(folder, files, arguments.replace())?;
    }
    if report.passed() { Ok(()) } else { Err(Failure::Check(sources, report_failures(&report))) }
}

/// The command line, to be typed again.
fn command_line() -> String {
    let quoted =
        |word: String| match word.chars().all(|c| c.is_alphanumeric() || "-_./:=,".contains(c)) {
            true => word,
            false => format!("'{}'", word.replace('\'', "'\\''")),
        };
    let words = std::env::args_os().skip(1).map(|word| quoted(word.to_string_lossy().into_owned()));
    std::iter::once("lamplight".to_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

/// Functions that no case calls.
fn print_untested(report: &CheckReport) -> Result<(), Failure> {
    let (few, all) = (report.untested.iter().take(UNTESTED), report.untested.len());
    let names = few.map(String::as_str).collect::<Vec<_>>().join(", ");
    match all {
        0 => {}
        1 => writeln!(stdout(), "1 function has no case: {names}")?,
        _ if all > UNTESTED => writeln!(stdout(), "{all} functions have no case: {names}, ...")?,
        _ => writeln!(stdout(), "{all} functions have no case: {names}")?,
    }
    Ok(())
}

/// Checks one selection. With `--bless`, the recorded shares of its package are lowered afterwards.
fn check_one(
    selection: &Selection,
    sources: &Mutex<SourceSet>,
    arguments: &Arguments,
    sessions: &mut [OpenExecutor],
) -> Result<Result<CheckReport, Failure>, Diagnostics> {
    let library = &selection.library;
    let ratchet = library.ratchet(sources)?;
    let held =
        if arguments.bless { ratchet.as_ref().map(Ratchet::waivers_only) } else { ratchet.clone() };
    let options = CheckOptions {
        references: library.has_references(),
        profile: arguments.report.is_some(),
        prove: !arguments.bless,
        partners: true,
        ratchet: held.as_ref(),
    };
    let report =
        library.check_with(sources, &selection.files, &selection.languages, sessions, &options)?;
    if !arguments.bless {
        return Ok(Ok(report));
    }
    let Some(root) = &selection.root else {
        return Ok(Err(Failure::usage(
            "`--bless` needs the package on disk, such as `lamplight check shaderlib --bless`",
        )));
    };
    let mut ratchet = ratchet.unwrap_or_default();
    ratchet.bless(&report, arguments.force);
    Ok(output::write(&root.join(FILE), ratchet.text().as_bytes())
        .map(|()| report)
        .map_err(Failure::from))
}

/// Tolerances below WGSL's own bounds. This is not a failure, since a backend may well be more
/// exact.
fn print_spec(report: &CheckReport, all: bool) -> Result<(), Failure> {
    let lines = stricter_cases(report);
    match (all, lines.lines().count()) {
        (_, 0) => {}
        (true, _) => write!(stdout(), "{lines}")?,
        (false, 1) => writeln!(
            stdout(),
            "1 case states less than WGSL allows for some input (`--spec` lists it)"
        )?,
        (false, count) => writeln!(
            stdout(),
            "{count} cases state less than WGSL allows for some input (`--spec` lists them)"
        )?,
    }
    Ok(())
}

fn parse_selections(arguments: &Arguments) -> Result<Vec<Selection>, Failure> {
    let here =
        project::package_above(Path::new("")).map(|root| root.to_string_lossy().into_owned());
    let default: Vec<String> = here.into_iter().filter(|_| arguments.path.is_empty()).collect();
    let (own, of_library): (Vec<&String>, Vec<&String>) =
        arguments.path.iter().chain(&default).partition(|path| Path::new(path).exists());
    let mut selections = Vec::new();
    if own.is_empty() || !of_library.is_empty() {
        let library = Library::shipped(LIBRARY_FILES);
        let files = library_files(&library, &of_library)?;
        let languages = LANGUAGES
            .iter()
            .map(|(language, _)| *language)
            .filter(|language| is_requested(arguments, *language))
            .collect();
        selections.push(Selection { library, root: None, files, languages });
    }
    for path in own {
        for file in case_files(Path::new(path))? {
            add_own(&mut selections, &file, arguments)?;
        }
    }
    Ok(selections)
}

/// Each language with the extensions of its modules.
const LANGUAGES: [(Language, &[&str]); 2] =
    [(Language::Wesl, &["wesl", "wgsl"]), (Language::Glsl, &["glsl"])];

fn is_requested(arguments: &Arguments, language: Language) -> bool {
    arguments.lang.is_none_or(|name| Language::from(name) == language)
}

/// The user's case files: the file itself, that of a module, or all below a folder.
fn case_files(path: &Path) -> Result<Vec<PathBuf>, Failure> {
    if path.is_dir() {
        let disk = Disk::new(path).map_err(|error| unreadable_file(path, &error))?;
        let found: Vec<PathBuf> = Library::new("", Arc::new(disk), Vec::new())
            .case_files()
            .iter()
            .map(|file| path.join(file))
            .collect();
        let none = || {
            Failure::input(format!(
                "there is no case file in `{}`: cases are in a `.toml` next to a module (guide: Numeric cases)",
                path.display()
            ))
        };
        return if found.is_empty() { Err(none()) } else { Ok(found) };
    }
    let file = path.with_extension("toml");
    if file.is_file() {
        Ok(vec![file])
    } else {
        Err(Failure::input(format!(
            "`{}` has no cases: they are in `{}`, next to the module",
            path.display(),
            file.display()
        )))
    }
}

/// Adds a case file to the selection for its package and its languages.
fn add_own(
    selections: &mut Vec<Selection>,
    file: &Path,
    arguments: &Arguments,
) -> Result<(), Failure> {
    let root = project::root_of(file);
    let path =
        project::relative(file, &root).map_err(|diagnostic| Failure::input(diagnostic.message))?;
    let present = |extensions: &[&str]| {
        extensions.iter().any(|extension| file.with_extension(extension).is_file())
    };
    let languages: Vec<Language> = LANGUAGES
        .iter()
        .filter(|(language, extensions)| is_requested(arguments, *language) && present(extensions))
        .map(|(language, _)| *language)
        .collect();
    if languages.is_empty() {
        return Err(no_module(file, arguments));
    }
    let same = |selection: &&mut Selection| {
        selection.root.as_ref() == Some(&root) && selection.languages == languages
    };
    match selections.iter_mut().find(same) {
        Some(selection) => selection.files.push(path),
        None => selections.push(Selection {
            library: open_package(&root)?.with_settings(arguments.settings(&root)?),
            root: Some(root),
            files: vec![path],
            languages,
        }),
    }
    Ok(())
}

/// A case file without a module in the languages that are asked for.
fn no_module(file: &Path, arguments: &Arguments) -> Failure {
    let requested = LANGUAGES.iter().filter(|(language, _)| is_requested(arguments, *language));
    let name = |extension: &&str| format!("`{}`", file.with_extension(extension).display());
    let names: Vec<String> =
        requested.filter_map(|(_, extensions)| extensions.first()).map(name).collect();
    Failure::input(format!("there is no {} next to `{}`", names.join(" or "), file.display()))
}

fn library_files(library: &Library, requested: &[&String]) -> Result<Vec<String>, Failure> {
    let files = library.case_files();
    if requested.is_empty() {
        return Ok(files);
    }
    let mut found = Vec::new();
    for path in requested {
        let wanted = path.trim_start_matches("lamplight::").replace("::", "/");
        let stem = |file: &str| file.trim_end_matches(".toml").to_owned();
        let matching: Vec<String> = files
            .iter()
            .filter(|file| {
                wanted == LIBRARY || stem(file) == wanted || file.starts_with(&format!("{wanted}/"))
            })
            .cloned()
            .collect();
        if matching.is_empty() {
            let known: Vec<String> =
                files.iter().map(|file| stem(file).replace('/', "::")).collect();
            let requested = wanted.replace('/', "::");
            let near = nearest_name(&requested, known.iter().map(String::as_str));
            let near = near.map_or(String::new(), |near| format!("\nhelp: did you mean `{near}`?"));
            return Err(Failure::input(format!(
                "`{path}` is neither a file nor a module of the library with numeric cases{near}"
            )));
        }
        found.extend(matching);
    }
    Ok(found)
}

/// The user's package with what it may import.
fn open_package(root: &Path) -> Result<Library, Failure> {
    let mut sources = SourceSet::default();
    let packages = project::packages(root, &mut sources)
        .map_err(|diagnostics| Failure::Input(sources, diagnostics))?;
    let name = project::declared_name(root).unwrap_or_else(|| packages.root.name.clone());
    Ok(Library::of_packages(&name, packages))
}

fn unreadable_file(path: &Path, error: &std::io::Error) -> Failure {
    Failure::input(format!("cannot read `{}`: {error}", path.display()))
}

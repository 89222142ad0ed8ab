//! `lamplight check --record` and `--against`: the values of an older version.

use std::io::Write;
use std::path::Path;
use std::sync::Mutex;

use super::check::Selection;
use super::executor;
use super::failure::Failure;
use crate::bundle::Language;
use crate::check::check::values::{
    MeasuredCase, RecordedCase, ValueRecord, compare_values, is_record, parse_record, record_text,
};
use crate::check::library::lock_sources;
use crate::cli::terminal::stdout;
use crate::input;
use crate::output::{self, Replace};
use crate::project::{self, LIBRARY};
use crate::source::SourceSet;

/// The largest record that is read.
const RECORD_BYTES: u64 = 256 << 20;
/// Values are always those of the evaluator: they depend on no GPU and no driver.
const EXECUTOR: &str = "eval";

/// Writes what the functions of the selected cases return.
pub fn record_values(
    selections: &[Selection],
    file: &Path,
    replace: Replace,
) -> Result<(), Failure> {
    let sources = Mutex::new(SourceSet::default());
    let package = package_name(selections)?;
    let measured = measure_selections(selections, &sources, None)?;
    let record = ValueRecord {
        tool: env!("CARGO_PKG_VERSION").to_owned(),
        library: lamplight_shaderlib::VERSION.to_owned(),
        package,
        cases: measured.into_iter().map(|measured| measured.case).collect(),
    };
    output::write_file(file, record_text(&record).as_bytes(), is_record, replace)?;
    let (cases, place) = (record.cases.len(), file.display());
    writeln!(stdout(), "recorded the values of {cases} cases in `{place}`")?;
    Ok(())
}

/// Compares the functions of the selected cases with a record. `has_language` says which languages the
/// user chose.
pub fn compare_with_record(
    selections: &[Selection],
    file: &Path,
    has_language: impl Fn(Language) -> bool,
) -> Result<(), Failure> {
    let sources = Mutex::new(SourceSet::default());
    let old = read_record(&sources, file)?;
    let package = package_name(selections)?;
    if old.package != package {
        let (place, named) = (file.display(), named_package(old.package.as_deref()));
        let this = named_package(package.as_deref());
        return Err(Failure::input(format!(
            "`{place}` is the record of {named}, and the cases are those of {this}"
        )));
    }
    let measured = measure_selections(selections, &sources, Some(&old))?;
    let is_requested =
        |case: &RecordedCase| has_language(case.language) && is_selected(selections, case);
    let compared = compare_values(&old, &measured, is_requested);
    let sources = sources.into_inner().unwrap_or_default();
    let comparison = match compared {
        Ok(comparison) => comparison,
        Err(error) => return Err(Failure::Input(sources, vec![error])),
    };
    writeln!(stdout(), "recorded by Lamplight {}, library {}", old.tool, old.library)?;
    write!(stdout(), "{}", comparison.text())?;
    let failures = comparison.failures();
    if failures.is_empty() { Ok(()) } else { Err(Failure::Check(sources, failures)) }
}

fn read_record(sources: &Mutex<SourceSet>, file: &Path) -> Result<ValueRecord, Failure> {
    let place = file.display();
    let unreadable = |why: &dyn std::fmt::Display| {
        Failure::input(format!("cannot read the record `{place}`: {why}"))
    };
    let bytes = input::read_file(file, RECORD_BYTES).map_err(|error| unreadable(&error))?;
    let text = String::from_utf8(bytes).map_err(|_| unreadable(&"it is not UTF-8"))?;
    let mut held = lock_sources(sources);
    let id = held.add(file.to_string_lossy(), text);
    let parsed = parse_record(&held.get(id).text, id);
    parsed.map_err(|error| Failure::Input(held.clone(), vec![error]))
}

/// The name that the selected package declares. All selections must be of one package.
fn package_name(selections: &[Selection]) -> Result<Option<String>, Failure> {
    let first = selections.first().and_then(|selection| selection.root.as_ref());
    if selections.iter().any(|selection| selection.root.as_ref() != first) {
        return Err(Failure::usage("a record has the values of one package"));
    }
    Ok(match first {
        Some(root) => project::declared_name(root),
        None => Some(LIBRARY.to_owned()),
    })
}

fn named_package(name: Option<&str>) -> String {
    name.map_or_else(|| "a package without a name".to_owned(), |name| format!("`{name}`"))
}

fn measure_selections(
    selections: &[Selection],
    sources: &Mutex<SourceSet>,
    old: Option<&ValueRecord>,
) -> Result<Vec<MeasuredCase>, Failure> {
    let mut session = executor::open_executor(executor::find_executor(EXECUTOR)?)?;
    let mut all = Vec::new();
    for selection in selections {
        let Selection { library, root: _, files, languages } = selection;
        let found = library.measure_values(sources, files, languages, session.as_mut(), old);
        all.extend(found.map_err(|errors| Failure::Input(lock_sources(sources).clone(), errors))?);
    }
    Ok(all)
}

/// Whether a recorded case belongs to the selected modules. Those of modules that no longer exist
/// do if the whole package is selected.
fn is_selected(selections: &[Selection], case: &RecordedCase) -> bool {
    let files = || selections.iter().flat_map(|selection| &selection.files);
    let module = format!("{}.toml", case.module().replace("::", "/"));
    let is_whole = || {
        let all = selections.first().map(|selection| selection.library.case_files());
        all.is_some_and(|all| all.iter().all(|file| files().any(|found| found == file)))
    };
    files().any(|file| *file == module) || is_whole()
}

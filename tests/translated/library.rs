//! The library's functions, translated to HLSL and MSL: other compilers read the text, and all
//! numeric cases hold.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::sync::Mutex;

use lamplight::LIBRARY_FILES;
use lamplight::bundle::{Language, Target};
use lamplight::catalogue::translated::module_files;
use lamplight::check::check::{self, CheckOptions, CheckedModule, OpenExecutor};
use lamplight::check::library::Library;
use lamplight::diagnostic::Diagnostics;
use lamplight::diagnostic::render::{Form, render};
use lamplight::execute::on_thread;
use lamplight::execute::written::open_written;
use lamplight::source::SourceSet;
use lamplight_translate::print::Dialect;
use libtest_mimic::{Failed, Trial};

use crate::examples::run;
use crate::is_whole;

/// Functions with cases that must have been run in each language, at night and by day.
const LEAST: [usize; 2] = [270, 20];
/// By day, the modules of every twelfth case file.
const STEP: usize = 12;

pub fn tests() -> Vec<Trial> {
    let test = |dialect: Dialect, name: &'static str, target: Target| {
        Trial::test(format!("translated::library::{name}"), move || {
            on_thread(move || checked(dialect, name, target))
                .ok_or("a thread ended")?
                .map_err(Failed::from)
        })
    };
    vec![
        test(Dialect::Hlsl, "hlsl", Target::HLSL),
        test(Dialect::Msl, "msl", Target::MSL),
        Trial::test("translated::library::exported", exported),
    ]
}

/// `lamplight export` writes the same files, and a compiler of HLSL finds what each of them includes.
fn exported() -> Result<(), Failed> {
    for (form, dialect) in [("hlsl", Dialect::Hlsl), ("metal", Dialect::Msl)] {
        let folder = tempfile::tempdir()?;
        run(Command::new(env!("CARGO_BIN_EXE_lamplight"))
            .args(["export", "--form", form])
            .arg(folder.path()))?;
        let package = folder.path().join("lamplight");
        let files = module_files(&LIBRARY_FILES, dialect, &mut SourceSet::default())
            .map_err(|problems| format!("{problems:?}"))?;
        for (path, text) in &files {
            assert_eq!(&std::fs::read_to_string(package.join(path))?, text, "{path}");
            if dialect == Dialect::Hlsl {
                is_read(&package, path)?;
            }
        }
    }
    Ok(())
}

/// Compiles a stage that includes a file.
fn is_read(package: &Path, path: &str) -> Result<(), Failed> {
    let stage = package.join("stage.hlsl");
    let text = format!(
        "#extension GL_GOOGLE_include_directive : enable\n#include \"{path}\"\n\
         float4 main() : SV_Target {{ return float4(0.0, 0.0, 0.0, 1.0); }}\n"
    );
    std::fs::write(&stage, text)?;
    let arguments = ["-D", "-V", "--quiet", "-S", "frag", "-e", "main", "-o", "stage.spv"];
    run(Command::new("glslangValidator").args(arguments).arg(&stage).current_dir(package)).map(drop)
}

fn checked(dialect: Dialect, name: &'static str, target: Target) -> Result<(), String> {
    let mut written = SourceSet::default();
    let files = module_files(&LIBRARY_FILES, dialect, &mut written)
        .map_err(|problems| render(&written, &problems, Form::Human))?;
    let library = Library::shipped(LIBRARY_FILES);
    let sources = Mutex::new(SourceSet::default());
    let rendered = |problems: Diagnostics| {
        render(&sources.lock().unwrap_or_else(|held| held.into_inner()), &problems, Form::Human)
    };
    let only = std::env::var("LAMPLIGHT_CASES").unwrap_or_default();
    let is_whole = is_whole() || !only.is_empty();
    let paths = library.case_files().into_iter().filter(|path| path.contains(&only));
    let paths: Vec<String> = paths.step_by(if is_whole { 1 } else { STEP }).collect();
    let cases = library.read(&sources, &paths).map_err(rendered)?;
    // The names and types of a kernel are those that the text has.
    let subjects = |module: &str, language: Language, functions: &[String]| {
        let found = library.module(&sources, module, language, functions)?;
        let path = format!("{}.{}", module.replace("::", "/"), dialect.ending());
        let mut checked = CheckedModule::without_text(found);
        checked.source = Some(included(&path, &files).into());
        Ok(checked)
    };
    let mut open = [OpenExecutor { executor: name, session: open_written(target)? }];
    let options = CheckOptions { references: true, ..CheckOptions::default() };
    let report = check::check_with(&cases, &[Language::Glsl], &subjects, &mut open, &options)
        .map_err(rendered)?;
    let mut failures: Vec<String> = Vec::new();
    let mut functions: Vec<String> = Vec::new();
    for outcome in &report.outcomes {
        match &outcome.verdict {
            Err(error) => failures.push(format!("{}: {}", outcome.path(), error.message)),
            Ok(_) if !outcome.passed() => failures.push(format!("{}: fails", outcome.path())),
            Ok(_) => functions.push(outcome.path()),
        }
    }
    functions.sort();
    functions.dedup();
    println!("{}: {} functions", open[0].session.adapter(), functions.len());
    if functions.len() < LEAST[usize::from(!is_whole)] && only.is_empty() {
        failures.push(format!("only {} functions were run", functions.len()));
    }
    if failures.is_empty() { Ok(()) } else { Err(failures.join("\n")) }
}

/// The text of a file with those that it includes in their places.
fn included(path: &str, files: &BTreeMap<String, String>) -> String {
    let mut text = String::new();
    let Some(file) = files.get(path) else { return text };
    for line in file.lines() {
        match line.strip_prefix("#include \"").and_then(|rest| rest.strip_suffix('"')) {
            Some(target) => text += &included(&resolved(path, target), files),
            None => {
                text += line;
                text.push('\n');
            }
        }
    }
    text
}

/// The path that a file includes, from the root.
fn resolved(from: &str, path: &str) -> String {
    let mut parts: Vec<&str> = from.split('/').collect();
    parts.pop();
    for part in path.split('/') {
        match part {
            ".." => drop(parts.pop()),
            part => parts.push(part),
        }
    }
    parts.join("/")
}

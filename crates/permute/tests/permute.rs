//! Spaces of permutations. Each folder of `tests/permute/` is a case with `manifest.toml` and the
//! expected report `expected.txt`, which `UPDATE_EXPECT=1` rewrites. It may have `keys.txt`, with
//! keys of the first program, one a line, and `lock.txt`, a lock file to extend. The modules below
//! are laws that hold for every space.

mod key_laws;
mod laws;
mod outlines;
mod random;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::render::{Form, render};
use lamplight_diagnostic::source::SourceSet;
use lamplight_permute::{Manifest, Program, Quoted, key, lock, manifest, report};
use libtest_mimic::{Failed, Trial};

pub fn tests() -> Vec<Trial> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/permute");
    let entries = fs::read_dir(folder).expect("the folder of cases");
    let mut cases: Vec<PathBuf> =
        entries.map(|entry| entry.expect("a case").path()).filter(|path| path.is_dir()).collect();
    cases.sort();
    let mut tests: Vec<Trial> = cases.into_iter().map(test).collect();
    tests.extend(laws::tests());
    tests
}

fn test(case: PathBuf) -> Trial {
    let name = case.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Trial::test(format!("permute::{name}"), move || check(&case))
}

fn check(case: &Path) -> Result<(), Failed> {
    let found = outcome(case)?;
    let path = case.join("expected.txt");
    if env::var_os("UPDATE_EXPECT").is_some() {
        return Ok(fs::write(&path, found)?);
    }
    let expected = fs::read_to_string(&path).unwrap_or_default();
    if found == expected {
        Ok(())
    } else {
        Err(format!("--- expected\n{expected}\n--- found\n{found}\n(`cargo xtask record permute` accepts this)")
            .into())
    }
}

fn outcome(case: &Path) -> Result<String, Failed> {
    let mut sources = SourceSet::default();
    let id = sources.add("lamplight.toml", fs::read_to_string(case.join("manifest.toml"))?);
    match manifest::parse(&sources, id) {
        Err(problems) => Ok(rendered(&sources, &problems)),
        Ok(manifest) => describe(case, &mut sources, &manifest),
    }
}

fn rendered(sources: &SourceSet, problems: &[Diagnostic]) -> String {
    let text = render(sources, problems, Form::Human);
    text.lines().map(|line| line.trim_end().to_owned() + "\n").collect()
}

fn describe(case: &Path, sources: &mut SourceSet, manifest: &Manifest) -> Result<String, Failed> {
    let mut text = rendered(sources, &manifest.warnings);
    for program in &manifest.programs {
        write!(text, "{}\n{}", report::report(&program.name, &program.space), keys(program))?;
    }
    let first = manifest.programs.first().ok_or("no program")?;
    if let Ok(keys) = fs::read_to_string(case.join("keys.txt")) {
        keys.lines().for_each(|line| text += &read_key(sources, first, line));
    }
    if let Ok(before) = fs::read_to_string(case.join("lock.txt")) {
        text += &extended_lock(sources, first, before);
    }
    Ok(text)
}

fn keys(program: &Program) -> String {
    const SHOWN: usize = 24;
    let points = program.space.enumerate();
    let shown: String = points
        .iter()
        .take(SHOWN)
        .map(|point| format!("  {}\n", program.space.key(point)))
        .collect();
    if points.len() <= SHOWN {
        shown
    } else {
        format!("{shown}  and {} more\n", points.len() - SHOWN)
    }
}

fn read_key(sources: &mut SourceSet, program: &Program, line: &str) -> String {
    let id = sources.add("key", line);
    match key::parse(&program.space, &Quoted::whole(sources, id)) {
        Ok(point) => format!(
            "`{line}` is {}, wanted: {}\n",
            program.space.key(&point),
            program.space.contains(&point)
        ),
        Err(problems) => rendered(sources, &problems),
    }
}

fn extended_lock(sources: &mut SourceSet, program: &Program, before: String) -> String {
    let id = sources.add("lamplight.lock", before);
    let lock = match lock::parse(sources, id) {
        Err(problems) => return rendered(sources, &problems),
        Ok(lock) => lock.extended(&program.name, &program.space),
    };
    let dense =
        |point| (lock.dense(&program.name, &program.space, point), program.space.key(point));
    let numbers: Vec<_> = program.space.enumerate().iter().map(dense).collect();
    let numbers: String = numbers
        .iter()
        .map(|(dense, key)| {
            format!("  {} {key}\n", dense.map_or("-".to_owned(), |dense| dense.to_string()))
        })
        .collect();
    format!("{lock}{numbers}")
}

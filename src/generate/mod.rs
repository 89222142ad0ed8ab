//! All permutations of a manifest, from its programs' sources to the contents of a bundle.
//!
//! Work is done once, however many permutations ask for it. An entry point composes only for
//! settings whose answers it has not seen ([`ReadTree`]), compiles only texts it has not seen,
//! and stores only bytes that are new.
//!
//! [`ReadTree`]: crate::permute::ReadTree

mod compile;
mod entry;
mod lint;
mod summary;
mod weave;

pub use summary::{EntrySummary, ProgramSummary, Summary};

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use crate::bundle::{Axis, Contents, EntryContents, ProgramContents, Target};
use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use crate::permute::{Assignment, Key, Manifest, Program, Quoted, key};
use crate::resolve::Packages;
use crate::source::SourceSet;
use crate::validate::on_large_stack;
use lint::Lints;

/// Diagnostics of one entry point after which no more are looked for.
const REPORTED: usize = 20;

/// What to generate of a manifest; the default is all of it.
#[derive(Debug, Clone, Default)]
pub struct Request {
    /// Only this program.
    pub program: Option<String>,
    /// Only this permutation, by its key.
    pub only: Option<Quoted>,
    /// Only these targets; those of each program where there are none.
    pub targets: Vec<Target>,
}

/// How far a run is.
#[derive(Debug, Clone)]
pub struct Progress {
    /// The program and the entry point at work.
    pub stage: String,
    /// Permutations done, of how many.
    pub done: usize,
    pub total: usize,
}

/// A bundle's contents and the account of how they came about.
#[derive(Debug)]
pub struct Generated {
    pub contents: Contents,
    pub summary: Summary,
    pub warnings: Vec<Diagnostic>,
}

/// Composes, validates and emits every permutation asked for.
///
/// # Errors
/// Diagnostics of the permutations that fail, each once, with the key of the first permutation
/// that shows it in a note.
pub fn generate(
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &Manifest,
    request: &Request,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Generated, Diagnostics> {
    let start = Instant::now();
    let mut done = Vec::new();
    let mut lints = Lints::default();
    for program in chosen(manifest, request)? {
        let points = points(program, request)?;
        let entries = entry::entries(sources, packages, program, points.first().map(|(_, point)| point))?;
        let targets = if request.targets.is_empty() { &program.targets } else { &request.targets };
        let woven = on_large_stack(|| {
            let woven = entries.iter().map(|entry| weave::weave(entry, &program.space, &points, targets, progress));
            woven.collect::<Result<Vec<_>, _>>()
        })?;
        // One permutation says nothing about the others.
        if request.only.is_none() {
            lints.see(sources, program, &entries, &points);
            lints.see_reads(program, &woven);
        }
        done.push(Done { program, keys: points.into_iter().map(|(key, _)| key).collect(), woven });
    }
    let mut generated = finish(done, start.elapsed())?;
    generated.warnings.extend(lints.finish());
    generated.warnings = lint::distinct(sources, generated.warnings);
    Ok(generated)
}

/// A program with every entry point compiled.
struct Done<'a> {
    program: &'a Program,
    keys: Vec<Key>,
    woven: Vec<weave::Woven>,
}

fn finish(done: Vec<Done<'_>>, elapsed: Duration) -> Result<Generated, Diagnostics> {
    let programs = done.iter().map(|done| summary::program(&done.program.name, done.keys.len(), &done.woven)).collect();
    let warnings = done.iter().flat_map(|done| &done.woven).flat_map(|woven| woven.warnings.iter().cloned()).collect();
    let mut contents = Contents::default();
    for Done { program, keys, woven } in done {
        contents.programs.insert(program.name.clone(), program_contents(program, &keys, woven)?);
    }
    Ok(Generated { summary: summary::summarise(programs, &contents, elapsed), contents, warnings })
}

fn program_contents(program: &Program, keys: &[Key], woven: Vec<weave::Woven>) -> Result<ProgramContents, Diagnostics> {
    let axes = program.space.axes().iter().map(|axis| Axis {
        name: axis.name.clone(),
        values: axis.value_names(),
        default: axis.values[axis.default].to_string(),
        mode: axis.mode.name().to_owned(),
    });
    let mut contents = ProgramContents { axes: axes.collect(), languages: BTreeMap::new() };
    for woven in woven {
        let (language, label) = (woven.language.into(), woven.label.clone());
        contents.languages.entry(language).or_default().insert(label, entry_contents(keys, woven)?);
    }
    Ok(contents)
}

fn entry_contents(keys: &[Key], woven: weave::Woven) -> Result<EntryContents, Diagnostics> {
    let mut contents = EntryContents::default();
    let failed = |error: crate::bundle::Error| vec![Diagnostic::error(codes::BUNDLE_FAILED, error.to_string())];
    let hashes = woven.units.into_iter().map(|unit| contents.add(unit)).collect::<Result<Vec<_>, _>>().map_err(failed)?;
    contents.keys = keys.iter().zip(&woven.unit_of).map(|(key, unit)| (key.to_string(), hashes[*unit as usize])).collect();
    Ok(contents)
}

fn chosen<'a>(manifest: &'a Manifest, request: &Request) -> Result<Vec<&'a Program>, Diagnostics> {
    let Some(name) = &request.program else { return Ok(manifest.programs.iter().collect()) };
    let known = manifest.programs.iter().map(|program| program.name.as_str());
    manifest.program(name).map(|program| vec![program]).ok_or_else(|| {
        vec![Diagnostic::error(codes::UNKNOWN_PROGRAM, format!("the manifest declares no program `{name}`")).suggest(name, known)]
    })
}

fn points(program: &Program, request: &Request) -> Result<Vec<(Key, Assignment)>, Diagnostics> {
    let points = match &request.only {
        Some(text) => vec![asked(program, text)?],
        None => program.space.enumerate(),
    };
    Ok(points.into_iter().map(|point| (program.space.key(&point), point)).collect())
}

/// The point of a key that was asked for by name: it must satisfy the constraints.
fn asked(program: &Program, text: &Quoted) -> Result<Assignment, Diagnostics> {
    let point = key::parse(&program.space, text)?;
    let broken: Diagnostics = program
        .space
        .broken(&point)
        .map(|constraint| {
            let error = Diagnostic::error(codes::INVALID_KEY, format!("no permutation `{}` of program `{}`", text.text, program.name));
            error.at(text.span, "asked for here").at(constraint.span, "breaks this constraint")
        })
        .collect();
    if broken.is_empty() { Ok(point) } else { Err(broken) }
}

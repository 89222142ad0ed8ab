//! The debugger shows the values that executors compute, on every line.
//!
//! A random program notes each value that it stores. Executors return the note at an index; the
//! debugger shows the statements that stored the values, without the notes.

mod draft;

use std::collections::BTreeMap;

use lamplight::bundle::Language;
use lamplight::compose::{self, Composed, Options as ComposeOptions};
use lamplight::debug::{Call, Change, Event, Options, Scalar, Subject, SubjectText, record};
use lamplight::eval::Resources;
use lamplight::execute::executors;
use lamplight::execute::kernel::build_kernel;
use lamplight::permute::Settings;
use lamplight::resolve::{self, Packages};
use lamplight::source::SourceSet;
use lamplight::validate::{Validated, validate};
use libtest_mimic::{Failed, Trial};

use draft::{NOTES, draft_program};

/// How many programs each executor runs at night, and which part of these by day.
const PROGRAMS: u32 = 200;
const DAILY: u32 = 10;

/// The executors that run the module itself, and those of the outputs that ship.
const MODULES: [&str; 3] = ["eval", "vulkan", "gl"];
const SHIPPED: [&str; 6] = ["spirv", "hlsl", "msl", "glsl", "glsl330", "essl300"];

pub fn tests() -> Vec<Trial> {
    let test = |name: &'static str, step: u32| {
        Trial::test(format!("debug::values::{name}"), move || {
            values(name, if crate::is_whole() { 1 } else { step })
        })
    };
    let modules = MODULES.into_iter().map(|name| test(name, PROGRAMS / DAILY));
    // By day, these run a fourth of that.
    let shipped = SHIPPED.into_iter().map(|name| test(name, 4 * PROGRAMS / DAILY));
    modules.chain(shipped).collect()
}

/// A program with the author's text.
struct Program {
    sources: SourceSet,
    composed: Composed,
    validated: Validated,
}

fn program(seed: u32) -> Result<Program, Failed> {
    let mut sources = SourceSet::default();
    let packages = Packages::of_text("drafted.wesl", draft_program(seed));
    let composed = resolve::load(&mut sources, &packages, "drafted.wesl", Language::Wesl)
        .and_then(|graph| {
            let keep = compose::Keep::Items(vec!["f".to_owned()]);
            let options = ComposeOptions { keep, ..ComposeOptions::default() };
            compose::compose(&graph, &Settings::default(), &options)
        })
        .and_then(|composed| validate(&composed).map(|validated| (composed, validated)));
    match composed {
        Ok((composed, validated)) => Ok(Program { sources, composed, validated }),
        Err(errors) => Err(format!("program {seed}: {errors:?}\n{}", draft_program(seed)).into()),
    }
}

/// The words of the arguments of a seed, without the index.
fn arguments(seed: u32) -> [u32; 3] {
    let quarter = |number: u32| (f32::from((number % 37) as u16) / 4.0 - 4.0).to_bits();
    [quarter(seed.wrapping_mul(7)), quarter(seed.wrapping_mul(11) + 5), seed % 4]
}

/// What a debugged run shows: the values that statements stored and that were noted after these.
struct Shown {
    stored: Vec<f32>,
    steps: usize,
}

/// The numbers of a variable by their paths.
fn scalars(change: &Change) -> Vec<(String, Scalar)> {
    let mut found = Vec::new();
    for (name, value) in change.value.leaves(&change.name) {
        let parts = value.parts();
        if parts.is_empty() {
            found.extend(value.scalars.iter().map(|scalar| (name.clone(), *scalar)));
        }
        for (part, value) in parts {
            found.extend(value.scalars.iter().map(|scalar| (format!("{name}.{part}"), *scalar)));
        }
    }
    found
}

fn shown(program: &Program, seed: u32) -> Result<Shown, Failed> {
    let text = SubjectText {
        module: &program.validated.module,
        text: &program.composed.text,
        map: &program.composed.map,
        sources: &program.sources,
    };
    let words = arguments(seed).into_iter().chain([0]).map(f32::from_bits).collect();
    let subject = Subject::new(text, "f", Call::Alone(words), Resources::default())
        .map_err(|error| error.message)?;
    let mut shown = Shown { stored: Vec::new(), steps: 0 };
    // The last value of each part of a variable, by the depth of its function.
    let mut last: BTreeMap<(usize, String), f32> = BTreeMap::new();
    let mut wrong = None;
    let options = Options { turns: u64::MAX, ..Options::default() };
    let ended = record(&subject, options, &mut |event| {
        let Event::Step(step) = event else { return };
        shown.steps += 1;
        for (name, scalar) in step.changes.iter().flat_map(scalars) {
            let number = match scalar.exact() {
                Some(_) => f32::from_bits(scalar.word()),
                None => scalar.word() as i32 as f32,
            };
            if scalar.exact().is_some_and(|exact| exact != f64::from(number)) {
                wrong = Some(format!("`{name}` is {number}, and {scalar:?} in f64"));
            }
            last.insert((step.depth, name), number);
        }
        let statement = step.statement.and_then(|id| subject.statements.get(id));
        let text = statement.map_or("", |statement| program.sources.text(statement.span));
        if let Some(noted) = text.strip_prefix("note(").and_then(|rest| rest.strip_suffix(')')) {
            let noted = noted.trim_start_matches("f32(").trim_end_matches(')');
            let name = noted.trim_start_matches('*').to_owned();
            match last.get(&(step.depth, name)) {
                Some(value) => shown.stored.push(*value),
                None => wrong = Some(format!("no statement is shown that gave `{noted}` a value")),
            }
        }
    });
    ended.map_err(|error| error.message)?;
    match wrong {
        None => Ok(shown),
        Some(wrong) => Err(wrong.into()),
    }
}

/// Compares what the debugger shows of programs with what an executor notes.
fn values(name: &str, step: u32) -> Result<(), Failed> {
    let entry = executors::find_executor(name).ok_or("no such executor")?;
    let mut session = entry.start()?;
    let (mut compared, mut steps) = (0, 0);
    for seed in (0..PROGRAMS).step_by(step as usize) {
        let program = program(seed)?;
        let failed = |what: String| format!("program {seed}: {what}\n{}", draft_program(seed));
        let shown = shown(&program, seed)
            .map_err(|error| failed(error.message().unwrap_or_default().to_owned()))?;
        let kernel = build_kernel(&program.validated.module, "f", &BTreeMap::new())
            .map_err(|error| failed(error.message))?;
        let count = (shown.stored.len() as u32).min(NOTES);
        let rows: Vec<u32> = (0..count)
            .chain([NOTES])
            .flat_map(|index| arguments(seed).into_iter().chain([index]))
            .collect();
        let found = session.run(&kernel, &rows).map_err(|error| failed(error.message))?;
        let found: Vec<f32> = found.into_iter().map(f32::from_bits).collect();
        let (all, noted) = found.split_last().ok_or("no words")?;
        if *all != shown.stored.len() as f32 {
            let what = format!("{name} notes {all} values, {} are shown", shown.stored.len());
            return Err(failed(what).into());
        }
        for (at, (noted, stored)) in noted.iter().zip(&shown.stored).enumerate() {
            if noted != stored {
                let what = format!("value {at} is {noted} on {name}, and {stored} is shown");
                return Err(failed(what).into());
            }
        }
        (compared, steps) = (compared + noted.len(), steps + shown.steps);
    }
    // Programs that do nothing would compare nothing.
    let programs = PROGRAMS.div_ceil(step) as usize;
    if compared < 10 * programs || steps < 20 * programs {
        return Err(format!("{compared} values of {steps} steps were compared: too few").into());
    }
    Ok(())
}

//! The shader library of dEQP (KhronosGroup/VK-GL-CTS): programs in GLSL that must compile, or must
//! not, and the values that they compute.

mod known;
mod parse;
mod stage;
mod values;

use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use lamplight::bundle::{Language, Stage, Target, Unit};
use lamplight::compose::{self, Composed, Keep, Options};
use lamplight::diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight::glsl::number_program;
use lamplight::link::{CompiledUnit, Linker, TextForms, compile};
use lamplight::permute::Settings;
use lamplight::resolve::{self, Packages};
use lamplight::source::SourceSet;

use super::folder::files_below;
use super::table::{Table, general};
use super::{Program, in_parallel};
use parse::{Case, Expect, parse_cases};
use stage::{Shaders, shaders_of};
use xtask::CommandFailure;

/// The folders of a checkout that have shaders without a language of their own for each target.
pub const FOLDERS: [&str; 4] = [
    "data/gles2/shaders",
    "data/gles3/shaders",
    "data/gles31/shaders",
    "external/openglcts/data/gl_cts/data",
];

/// How many threads compile.
const THREADS: usize = 2;

/// What became of a program.
enum Verdict {
    /// Accepted, with how many rows of values were right.
    Right(usize),
    Refused(Diagnostic),
    /// Another value than the case says.
    Wrong(String),
    /// Accepted, and not run for this reason.
    NotRun(String),
}

/// Runs every case of a checkout.
pub fn tabulate(checkout: &Path) -> Result<Table, CommandFailure> {
    let mut table = Table::default();
    let cases = read_cases(checkout, &mut table)?;
    let programs = programs_of(&cases, &mut table);
    let verdicts = in_parallel(&programs, THREADS, |(case, shaders)| judge(case, shaders));
    for ((case, shaders), verdict) in programs.iter().zip(verdicts) {
        add_verdict(&mut table, case, shaders, verdict);
    }
    Ok(table)
}

/// The outputs of the programs that must compile, with their names.
pub fn units_of_valid(checkout: &Path) -> Result<Vec<(String, Vec<Unit>)>, CommandFailure> {
    let mut table = Table::default();
    let cases = read_cases(checkout, &mut table)?;
    let mut programs = programs_of(&cases, &mut table);
    programs.retain(|(case, _)| case.expect != Expect::CompileFail);
    let units = in_parallel(&programs, THREADS, |(_, shaders)| {
        let units = compiled_stages(shaders).unwrap_or_default();
        units.into_iter().map(|made| made.unit).collect::<Vec<Unit>>()
    });
    let names = programs.iter().map(|(case, shaders)| name_of(case, shaders));
    Ok(names.zip(units).collect())
}

fn programs_of<'c>(cases: &'c [Case], table: &mut Table) -> Vec<(&'c Case, Shaders)> {
    let mut programs = Vec::new();
    for case in cases {
        if case.expect == Expect::LinkFail {
            table.leave_out("stages that do not fit together: links are the driver's");
            continue;
        }
        match shaders_of(case) {
            Ok(found) => programs.extend(found.into_iter().map(|shaders| (case, shaders))),
            Err(reason) => table.leave_out(reason),
        }
    }
    programs
}

fn name_of(case: &Case, shaders: &Shaders) -> String {
    let stages: Vec<&str> = shaders.stages.iter().map(|(stage, _)| stage.suffix()).collect();
    format!("{}:{}", case.name, stages.join("+"))
}

fn read_cases(checkout: &Path, table: &mut Table) -> Result<Vec<Case>, CommandFailure> {
    let mut cases = Vec::new();
    for folder in FOLDERS {
        for path in files_below(&checkout.join(folder), "test")? {
            let bytes = std::fs::read(&path)
                .map_err(|error| CommandFailure::input(format!("`{}`: {error}", path.display())))?;
            // Comments and pragmas of some have bytes that are no UTF-8 on purpose.
            let text = String::from_utf8_lossy(&bytes);
            let name = path.strip_prefix(checkout).unwrap_or(&path).with_extension("");
            let name = name.to_string_lossy().replace(['/', '\\'], ".");
            if text.trim_start().starts_with('<') {
                table.leave_out("a file that is XML");
                continue;
            }
            let found = parse_cases(&name, &text)
                .map_err(|error| CommandFailure::input(format!("`{}`: {error}", path.display())))?;
            cases.extend(found);
        }
    }
    Ok(cases)
}

fn add_verdict(table: &mut Table, case: &Case, shaders: &Shaders, verdict: Verdict) {
    let name = name_of(case, shaders);
    let expected = case.expect != Expect::CompileFail;
    let program = Program { name: name.clone(), text: String::new(), expected };
    let refusal = match verdict {
        Verdict::Refused(refusal) => Some(refusal),
        _ if !expected => {
            let known = known::reason_of(&name).or_else(|| accepted_by_glslang(shaders));
            if let Some(reason) = known {
                return table.add_choice(reason);
            }
            None
        }
        Verdict::Right(rows) => {
            table.add_rows(rows);
            None
        }
        Verdict::Wrong(message) => {
            table.add_wrong_value(&name, &message);
            None
        }
        Verdict::NotRun(reason) => {
            table.add_not_run(&general(&reason));
            None
        }
    };
    table.add(&program, refusal.as_ref());
}

/// The reason that another compiler accepts the stages too. They are compiled for OpenGL, as they are
/// written, and not linked.
fn accepted_by_glslang(shaders: &Shaders) -> Option<&'static str> {
    let accepts = |(stage, text): &(Stage, String)| {
        let mut command = Command::new("glslangValidator");
        command.args(["--stdin", "-S", stage.suffix()]);
        output_of(command, text).is_some_and(|output| output.status.success())
    };
    let is_accepted = shaders.stages.iter().all(accepts);
    is_accepted.then_some("glslang accepts it too, which does not check every rule of GLSL ES")
}

/// Runs a command with a text as its standard input.
pub fn output_of(mut command: Command, text: &str) -> Option<Output> {
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
    let mut running = command.spawn().ok()?;
    // A command that ends before it has read all has its verdict already.
    let _ = running.stdin.take()?.write_all(text.as_bytes());
    running.wait_with_output().ok()
}

fn judge(case: &Case, shaders: &Shaders) -> Verdict {
    let units = match compiled_stages(shaders) {
        Ok(units) => units,
        Err(error) => return Verdict::Refused(error),
    };
    match case.expect {
        Expect::Pass if !case.values.is_empty() => match values::run(case, &units) {
            Ok(rows) => Verdict::Right(rows),
            Err(values::Stop::Wrong(message)) => Verdict::Wrong(message),
            Err(values::Stop::NotRun(reason)) => Verdict::NotRun(reason),
        },
        _ => Verdict::Right(0),
    }
}

/// Compiles the stages, numbered together.
fn compiled_stages(shaders: &Shaders) -> Result<Vec<CompiledUnit>, Diagnostic> {
    let numbers = match shaders.stages.as_slice() {
        [(Stage::Vertex, vertex), (Stage::Fragment, fragment)] => {
            number_program(&[vertex], &[fragment]).map(Some)
        }
        _ => [None, None],
    };
    let stages = shaders.stages.iter().zip(&numbers);
    let numbered = |numbers: &Option<String>| numbers.clone().unwrap_or_default();
    stages.map(|((stage, text), found)| compiled(text, *stage, &numbered(found))).collect()
}

/// Compiles a text for every target that has what it needs. The error is the author's, or what the last
/// target lacks if there is none that has it.
fn compiled(text: &str, stage: Stage, numbers: &str) -> Result<CompiledUnit, Diagnostic> {
    let mut composed = composed(text, stage).map_err(first)?;
    composed.text.push_str(numbers);
    let text = TextForms { composed: &composed, lean: &composed };
    let made = |targets: &[Target]| compile(&text, "main", targets, &Linker::new(targets));
    let all = match made(Target::ALL) {
        Ok(unit) => return Ok(unit),
        Err(errors) => first(errors),
    };
    let mut some: Option<CompiledUnit> = None;
    for target in Target::ALL {
        match (made(&[*target]), &mut some) {
            (Ok(unit), Some(some)) => some.unit.targets.extend(unit.unit.targets),
            (Ok(unit), None) => some = Some(unit),
            (Err(errors), _) if is_lack(&errors) => {}
            (Err(errors), _) => return Err(first(errors)),
        }
    }
    some.ok_or(all)
}

fn is_lack(errors: &[Diagnostic]) -> bool {
    let lacks = [codes::EMIT_FAILED, codes::NOT_PORTABLE, codes::NON_UNIFORM_BARRIER];
    errors.first().is_some_and(|error| lacks.contains(&error.code))
}

/// The whole text, preprocessed: the command leaves out what no entry point reaches.
fn composed(text: &str, stage: Stage) -> Result<Composed, Diagnostics> {
    let path = format!("case.{}", stage.suffix());
    let packages = Packages::of_text(&path, text.to_owned());
    let graph = resolve::load(&mut SourceSet::default(), &packages, &path, Language::Glsl)?;
    let options = Options { keep: Keep::All, ..Options::default() };
    compose::compose(&graph, &Settings::default(), &options)
}

fn first(errors: Diagnostics) -> Diagnostic {
    let none = || Diagnostic::error(codes::GLSL_ERROR, "refused without an error");
    errors.into_iter().next().unwrap_or_else(none)
}

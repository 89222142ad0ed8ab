//! The shader library of dEQP (KhronosGroup/VK-GL-CTS): programs in GLSL that must compile, or must
//! not, and the values that they compute.

mod known;
mod parse;
mod stage;
mod values;

use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use lamplight::bundle::{Stage, Unit};
use lamplight::diagnostic::Diagnostic;
use lamplight::glsl::number_program;
use lamplight::link::CompiledUnit;
use lamplight_validate::on_large_stack;
use rayon::prelude::*;

use super::Program;
use super::compiled::{composed_glsl, first, for_targets_that_can};
use super::folder::files_below;
use super::table::{Table, general};
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
    let verdicts: Vec<Verdict> = on_large_stack(|| {
        programs.par_iter().map(|(case, shaders)| verdict(case, shaders)).collect()
    });
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
    let units_of = |(_, shaders): &(&Case, Shaders)| -> Vec<Unit> {
        let units = compiled_stages(shaders).unwrap_or_default();
        units.into_iter().map(|made| made.unit).collect()
    };
    let units: Vec<Vec<Unit>> = on_large_stack(|| programs.par_iter().map(units_of).collect());
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

fn verdict(case: &Case, shaders: &Shaders) -> Verdict {
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

/// Compiles a text for every target that has what it needs.
fn compiled(text: &str, stage: Stage, numbers: &str) -> Result<CompiledUnit, Diagnostic> {
    let mut composed = composed_glsl(text, stage).map_err(first)?;
    composed.text.push_str(numbers);
    for_targets_that_can(&composed, "main")
}

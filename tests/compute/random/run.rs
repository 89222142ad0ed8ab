//! Compiles random programs, runs them on all executors, and compares what buffers hold with what
//! they hold after the evaluator.

use lamplight::bundle::{Conventions, Target};
use lamplight::diagnostic::{Diagnostic, codes};
use lamplight::execute::dispatch::{ComputeForm, DispatchResult};
use lamplight::execute::frame::Buffers;
use rayon::prelude::*;

use super::Tally;
use super::program::Program;
use crate::compute::run::{self, Compiled, Opened};

/// A mistake that was found: its kind, and the details.
#[derive(Debug, Clone)]
pub struct Finding {
    pub kind: String,
    pub about: String,
}

/// How wgpu fails for WGSL with overrides that Tint and the other targets take: where it puts values in
/// their place, its naga emits an element of a constant list twice, or before it is computed.
const FAULTS_OF_WGPU: [&str; 2] = ["Pipeline constant error", "wgpu or naga panicked"];

pub struct Runner {
    sessions: Vec<Opened>,
    /// Another driver for our SPIR-V, opened when it is needed.
    second: Option<Opened>,
}

type Refused = Vec<Diagnostic>;

impl Runner {
    /// Opens every executor, or those that the environment names.
    ///
    /// # Errors
    /// One of them is missing.
    pub fn open() -> Result<Self, String> {
        let mut sessions = run::opened()?;
        if let Ok(only) = std::env::var("LAMPLIGHT_COMPUTE_ON") {
            let names: Vec<&str> = only.split(',').collect();
            let is_wanted =
                |one: &Opened| one.form == ComputeForm::Module || names.contains(&one.entry.name);
            sessions.retain(is_wanted);
        }
        Ok(Self { sessions, second: None })
    }

    /// Runs programs. Each finding has the index of its program.
    pub fn run(&mut self, made: &[(u64, Program)], tally: &mut Tally) -> Vec<(usize, Finding)> {
        let (compiled, owners) = self.compiled(made, tally);
        let mut findings = Vec::new();
        let mut wanted: Vec<Option<Buffers>> = vec![None; compiled.len()];
        let Self { sessions, second } = self;
        for executor in sessions {
            let name = executor.entry.name;
            for (index, result) in executor.run(&compiled).into_iter().enumerate() {
                let owner = owners[index];
                if executor.form == ComputeForm::Module {
                    wanted[index] = match result {
                        Some(Err(error)) => {
                            findings.push((owner, finding(name, &error.message, "")));
                            None
                        }
                        result => result.and_then(Result::ok),
                    };
                    continue;
                }
                let Some(wanted) = &wanted[index] else { continue };
                let (compiled, program) = (&compiled[index], &made[owner].1);
                if let Some(what) = tally.compare(executor, compiled, program, wanted, result) {
                    if is_right_elsewhere(second, executor, compiled, program, wanted) {
                        tally.drivers.entry(name).or_default().push(made[owner].0);
                        continue;
                    }
                    let output = compiled.output_text(executor.form);
                    findings.push((owner, finding(name, &what, &output)));
                }
            }
        }
        for (owner, Finding { about, .. }) in &mut findings {
            *about = format!("seed {}: {about}\n{}", made[*owner].0, made[*owner].1.text);
        }
        findings
    }

    /// The outputs of programs, with the index of the program of each.
    fn compiled(&self, made: &[(u64, Program)], tally: &mut Tally) -> (Vec<Compiled>, Vec<usize>) {
        let compile = |(_, program): &(u64, Program)| {
            let conventions = Conventions { bounds: program.bounds, ..Conventions::default() };
            let mut compiled = run::compiled(program.text.clone(), "main", conventions)?;
            compiled.buffers = program.buffers.clone();
            compiled.groups = program.groups;
            Ok(compiled)
        };
        let all: Vec<Result<Compiled, Refused>> =
            lamplight::validate::on_large_stack(|| made.par_iter().map(compile).collect());
        let (mut compiled, mut owners) = (Vec::new(), Vec::new());
        for (index, one) in all.into_iter().enumerate() {
            match one {
                Ok(one) => {
                    compiled.push(one);
                    owners.push(index);
                }
                Err(errors) => {
                    let first = errors.first().map_or("", |error| &error.message);
                    tally.refused.entry(first.to_owned()).or_insert((0, made[index].0)).0 += 1;
                }
            }
        }
        (compiled, owners)
    }

    /// The executors of outputs.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        let outputs = self.sessions.iter().filter(|one| one.form != ComputeForm::Module);
        outputs.map(|one| one.entry.name)
    }

    /// Whether a program has a finding of a kind.
    pub fn has(&mut self, program: &Program, kind: &str) -> bool {
        let found = self.run(&[(0, program.clone())], &mut Tally::default());
        found.iter().any(|(_, finding)| finding.kind == kind)
    }
}

/// Whether the same output gives what the evaluator gives on another driver: SPIR-V on SwiftShader, and
/// GLSL there too, compiled by glslang.
fn is_right_elsewhere(
    second: &mut Option<Opened>,
    executor: &Opened,
    compiled: &Compiled,
    program: &Program,
    wanted: &Buffers,
) -> bool {
    let all = match executor.entry.name {
        "spirv" => compiled.as_spirv(Target::SPIRV),
        "glsl" => compiled.as_spirv(Target::GLSL450),
        _ => return false,
    };
    let opened = match second {
        Some(opened) => Ok(opened),
        None => Opened::second("spirv").map(|opened| second.insert(opened)),
    };
    let (Ok(compiled), Ok(opened)) = (all, opened) else { return false };
    let result = opened.run(std::slice::from_ref(&compiled)).pop().flatten();
    let ran = matches!(result, Some(Ok(_)));
    ran && Tally::default().compare(opened, &compiled, program, wanted, result).is_none()
}

fn finding(name: &str, what: &str, output: &str) -> Finding {
    let first = what.lines().next().unwrap_or_default();
    let kind: String = first.chars().take_while(|letter| !letter.is_ascii_digit()).collect();
    let kind = format!("{name} {}", kind.chars().take(60).collect::<String>());
    Finding { kind, about: format!("{name}: {what}\n\n{output}") }
}

impl Tally {
    /// What is wrong with a run, if something is.
    fn compare(
        &mut self,
        executor: &Opened,
        compiled: &Compiled,
        program: &Program,
        wanted: &Buffers,
        result: Option<DispatchResult>,
    ) -> Option<String> {
        let name = executor.entry.name;
        let lack = |message: &str| format!("{name}: {message}");
        match result {
            None => {
                let ComputeForm::Output(target) = executor.form else { return None };
                let errors = compiled.outputs[&target].as_ref().err()?;
                let first = errors.first().map_or("", |error| &error.message);
                if errors.iter().any(|error| error.code.name == codes::NAGA_INTERNAL.name) {
                    return Some(format!("is not written: {first}"));
                }
                *self.lacks.entry(lack(first)).or_default() += 1;
                None
            }
            Some(Err(error)) if run::is_lack(&error) => {
                *self.lacks.entry(lack(&error.message)).or_default() += 1;
                None
            }
            Some(Err(error))
                if program.text.contains("override ")
                    && FAULTS_OF_WGPU.iter().any(|one| error.message.contains(one)) =>
            {
                *self.lacks.entry(lack("wgpu's own naga fails")).or_default() += 1;
                None
            }
            Some(Err(error)) => Some(format!("does not run: {}", error.message)),
            Some(Ok(found)) => {
                *self.ran.entry(name).or_default() += 1;
                let bound = |place: &(u32, u32)| compiled.binds(executor.form, *place);
                self.difference(program, wanted, &found, &bound)
            }
        }
    }

    /// The first number that differs.
    fn difference(
        &mut self,
        program: &Program,
        wanted: &Buffers,
        found: &Buffers,
        is_bound: &dyn Fn(&(u32, u32)) -> bool,
    ) -> Option<String> {
        for (place, offsets) in &program.numbers {
            let (wanted, found) = match (wanted.get(place), found.get(place)) {
                (Some(wanted), Some(found)) => (wanted, found),
                (Some(_), None) if is_bound(place) => return Some(format!("{place:?} is missing")),
                // An output leaves out a buffer that the entry point does not use.
                _ => continue,
            };
            for offset in offsets {
                self.numbers += 1;
                let [wanted, found] = [wanted, found].map(|bytes| word(bytes, *offset));
                if wanted != found {
                    let words = format!("wanted {wanted:x?}, found {found:x?}");
                    return Some(format!("differs: {place:?}, byte {offset}: {words}"));
                }
            }
        }
        None
    }
}

/// A word of a buffer. The sign of a zero is open, so -0.0 is 0.
fn word(bytes: &[u8], offset: u32) -> Option<u32> {
    let at = offset as usize;
    let four = bytes.get(at..at + 4)?;
    let word = u32::from_le_bytes([four[0], four[1], four[2], four[3]]);
    Some(if word == 1 << 31 { 0 } else { word })
}

//! The CPU evaluator: how many calls of the library's `blinn_phong` one core makes in a second.

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use lamplight::compose::{Keep, Options, wesl as composer};
use lamplight::diagnostic::Diagnostics;
use lamplight::eval::{Bounded, Machine, Number, Program};
use lamplight::permute::Settings;
use lamplight::resolve;
use lamplight::source::SourceSet;
use lamplight::validate::validate;

use crate::Outcome;

const MODULE: &str = "brdf/specular.wesl";
const FUNCTION: &str = "blinn_phong";
const CALLS: u32 = 1_000_000;

/// Prints the rate with each type of number that the evaluator can compute with. The last line is
/// that of `f64`.
pub fn run() -> Outcome {
    let program = program()?;
    println!("f32: {:.0} calls/s", rate(&mut Machine::<f32>::new(&program)?)?);
    println!("value plus error: {:.0} calls/s", rate(&mut Machine::<Bounded>::new(&program)?)?);
    println!("eval: {:.0} calls/s", rate(&mut Machine::<f64>::new(&program)?)?);
    Ok(())
}

fn program() -> Result<Program, Box<dyn Error>> {
    let message_of = |problems: Diagnostics| format!("{problems:?}");
    let graph = resolve::wesl::load(
        &mut SourceSet::default(),
        &lamplight::project::library_packages(),
        MODULE,
    )
    .map_err(message_of)?;
    let options = Options { keep: Keep::Items(vec![FUNCTION.to_owned()]), ..Options::default() };
    let composed = composer::compose(&graph, &Settings::default(), &options).map_err(message_of)?;
    let validated = validate(&composed).map_err(message_of)?;
    Ok(Program::new(&validated.module, &validated.info)?)
}

/// The light moves across the highlight, so that no call repeats the last one.
fn rate<N: Number>(machine: &mut Machine<N>) -> Result<f64, Box<dyn Error>> {
    let function =
        machine.program().function(FUNCTION).ok_or("the library has no such function")?;
    let mut arguments: [N; 10] =
        [0.0, 0.0, 1.0, 0.0, 0.6, 0.8, 0.0, 0.0, 1.0, 32.0].map(N::from_f64);
    let start = Instant::now();
    for step in 0..CALLS {
        arguments[3] = N::from_f64(f64::from(step) / f64::from(CALLS));
        black_box(machine.call(function, &arguments)?);
    }
    Ok(f64::from(CALLS) / start.elapsed().as_secs_f64())
}

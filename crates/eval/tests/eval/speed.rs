//! Measures how many calls a second the evaluator makes. This is not a test: `--ignored eval/speed`
//! runs it.

use super::program;
use lamplight_eval::{Bounded, Machine, Number};
use libtest_mimic::{Failed, Trial};
use std::time::Instant;

const CALLS: u32 = 1_000_000;

pub fn tests() -> Vec<Trial> {
    vec![Trial::test("eval/speed", measure).with_ignored_flag(true)]
}

fn measure() -> Result<(), Failed> {
    let text =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/eval/lighting.wgsl"))?;
    let start = Instant::now();
    let program = program(&text)?;
    println!("parse, validate, lower: {:?}", start.elapsed());
    println!("f64: {:.0} calls/s", rate(&mut Machine::<f64>::new(&program)?)?);
    println!("f32: {:.0} calls/s", rate(&mut Machine::<f32>::new(&program)?)?);
    println!("value plus error: {:.0} calls/s", rate(&mut Machine::<Bounded>::new(&program)?)?);
    let mut watched = Machine::<f64>::new(&program)?;
    watched.sanitize(true);
    println!("f64, sanitized: {:.0} calls/s", rate(&mut watched)?);
    Ok(())
}

fn rate<N: Number>(machine: &mut Machine<N>) -> Result<f64, Failed> {
    let blinn_phong = machine.program().function("blinn_phong").ok_or("blinn_phong")?;
    let mut arguments: [N; 10] =
        [0.0, 0.0, 1.0, 0.0, 0.6, 0.8, 0.0, 0.0, 1.0, 32.0].map(N::from_f64);
    let start = Instant::now();
    let mut sum = 0.0;
    for step in 0..CALLS {
        arguments[3] = N::from_f64(f64::from(step) / f64::from(CALLS));
        sum += machine.call(blinn_phong, &arguments)?[0].value();
    }
    assert!(sum > 0.0, "`blinn_phong` gave nothing but zeros");
    Ok(f64::from(CALLS) / start.elapsed().as_secs_f64())
}

//! Compares built-in functions with Rust's own over a sweep of arguments. The f32 result must lie
//! within the evaluator's error bound.

use super::built_ins::{ONE, One};
use super::program;
use lamplight_eval::{Bounded, Machine, Number};
use libtest_mimic::{Failed, Trial};

pub fn tests() -> Vec<Trial> {
    ONE.iter().map(|case| Trial::test(format!("eval/sweep/{}", case.0), || sweep(case))).collect()
}

fn sweep((expression, meaning, low, high): &One) -> Result<(), Failed> {
    let program = program(&format!("fn f(x: f32) -> f32 {{ return {expression}; }}"))?;
    let f = program.function("f").ok_or("f")?;
    let mut double = Machine::<f64>::new(&program)?;
    let mut single = Machine::<f32>::new(&program)?;
    let mut bounded = Machine::<Bounded>::new(&program)?;
    for step in 0..=200 {
        let x = (low + (high - low) * f64::from(step) / 200.0) as f32;
        let wanted = meaning(f64::from(x));
        let found = double.call(f, &[f64::from(x)])?[0];
        if found != wanted
            && (found - wanted).abs() > 1e-13 * wanted.abs().max(1.0)
            && !(found.is_nan() && wanted.is_nan())
        {
            return Err(format!("at {x}: f64 gives {found}, wanted {wanted}").into());
        }
        let found = f64::from(single.call(f, &[x])?[0]);
        let bound = bounded.call(f, &[Bounded::from_f64(f64::from(x))])?[0];
        if (found - wanted).abs() > bound.error()
            || bound.value() != double.call(f, &[f64::from(x)])?[0] && !wanted.is_nan()
        {
            return Err(format!(
                "at {x}: f32 gives {found}, wanted {} within {:e}",
                bound.value(),
                bound.error()
            )
            .into());
        }
    }
    Ok(())
}

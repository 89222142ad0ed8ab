//! The translation of GLSL computes what the original computes.
//!
//! `GLSL -> glslang -> SPIR-V -> lavapipe` gives the words that are right, and
//! `GLSL -> our WGSL -> naga -> lavapipe` those that are compared with them. Each program is a
//! compute shader that writes words to a buffer.

mod cases;
pub mod device;
mod program;

use device::Device;
use lamplight_diagnostic::source::SourceId;
use lamplight_glsl::translate;
use lamplight_glsl::tree::Stage;
use lamplight_testing::random::{Random, asked_number};
use libtest_mimic::{Failed, Trial};
use rayon::prelude::*;

/// How many random programs the tests make; `LAMPLIGHT_GLSL_PROGRAMS` asks for another number.
const PROGRAMS: u64 = 200;
/// How many programs one device runs.
const PART: u64 = 100;
/// The seed of the first program; `LAMPLIGHT_GLSL_SEED` chooses another one.
const SEED: u64 = 1;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("glsl_values::random", random_programs),
        Trial::test("glsl_values::cases", written_cases),
        Trial::test("glsl_values::specified", specified_cases),
        Trial::test("glsl_values::functions", functions_of_the_language),
    ]
}

/// Random programs without undefined behaviour.
fn random_programs() -> Result<(), Failed> {
    let first = asked_number("LAMPLIGHT_GLSL_SEED", SEED);
    let count = asked_number("LAMPLIGHT_GLSL_PROGRAMS", PROGRAMS);
    println!("seed {first}: {count} programs");
    // Each thread has a device, so that no error is another one's.
    let compared = |(from, until): (u64, u64)| -> Result<Vec<String>, String> {
        let device = Device::open()?;
        let mut wrong = Vec::new();
        for seed in from..until {
            let text = program::write_program(&mut Random(seed.wrapping_mul(0x9e37_79b9)));
            if let Err(message) = compare(&device, &text) {
                wrong.push(format!("seed {seed}: {message}\n{text}"));
            }
        }
        Ok(wrong)
    };
    let parts: Vec<(u64, u64)> = (0..count.div_ceil(PART))
        .map(|part| (first + part * PART, first + count.min((part + 1) * PART)))
        .collect();
    let wrong: Vec<Vec<String>> = parts.into_par_iter().map(compared).collect::<Result<_, _>>()?;
    report(&wrong.concat(), count as usize)
}

/// Programs that were written for one construct each.
fn written_cases() -> Result<(), Failed> {
    let device = Device::open()?;
    let mut wrong = Vec::new();
    for (name, body) in cases::CASES {
        let text = cases::whole_text(body);
        if let Err(message) = compare(&device, &text) {
            wrong.push(format!("{name}: {message}\n{text}"));
        }
    }
    report(&wrong, cases::CASES.len())
}

/// Programs in whose order of evaluation glslang differs from the specification.
fn specified_cases() -> Result<(), Failed> {
    let device = Device::open()?;
    let mut wrong = Vec::new();
    for (name, body, words) in cases::SPECIFIED {
        let text = cases::whole_text(body);
        let found = translated(&text).and_then(|written| device.run_wgsl(&written));
        match found {
            Ok(found) if found.starts_with(words) => {}
            Ok(found) => {
                let found = &found[..words.len()];
                wrong.push(format!("{name}: {found:?}, and should be {words:?}"));
            }
            Err(message) => wrong.push(format!("{name}: {message}")),
        }
    }
    report(&wrong, cases::SPECIFIED.len())
}

/// Every function of the language over a few values.
fn functions_of_the_language() -> Result<(), Failed> {
    let device = Device::open()?;
    let mut wrong = Vec::new();
    for call in cases::CALLS {
        let text = cases::text_of_call(call);
        if let Err(message) = compare_within(&device, &text, 1e-4) {
            wrong.push(format!("{call}: {message}\n{text}"));
        }
    }
    report(&wrong, cases::CALLS.len())
}

fn report(wrong: &[String], count: usize) -> Result<(), Failed> {
    let Some(first) = wrong.first() else { return Ok(()) };
    let heads: Vec<&str> = wrong.iter().filter_map(|message| message.lines().next()).collect();
    let list = heads.join("\n");
    Err(format!("{} of {count} are wrong:\n{list}\n\nthe first: {first}", wrong.len()).into())
}

/// Both ways of a program give the same words.
fn compare(device: &Device, text: &str) -> Result<(), String> {
    compare_within(device, text, 0.0)
}

/// Both ways give the same words, or floats that differ by so much of their size.
fn compare_within(device: &Device, text: &str, tolerance: f32) -> Result<(), String> {
    let written = translated(text)?;
    let right = device.run_original(text)?;
    let found = device.run_wgsl(&written).map_err(|message| format!("{message}\n{written}"))?;
    let differs = |(a, b): (&u32, &u32)| !is_near(*a, *b, tolerance);
    match right.iter().zip(&found).position(differs) {
        None => Ok(()),
        Some(at) => Err(format!(
            "word {at} is {:#x} ({}) and should be {:#x} ({})\n{written}",
            found[at],
            f32::from_bits(found[at]),
            right[at],
            f32::from_bits(right[at]),
        )),
    }
}

/// The translation of a compute shader.
fn translated(text: &str) -> Result<String, String> {
    let translated = translate(text, Stage::Compute, SourceId(0), Default::default());
    let written = translated.map_err(|problems| {
        let first = &problems[0];
        let place = first.labels.first().map(|label| &text[label.span.range()]);
        format!("refused: {} at `{}`", first.message, place.unwrap_or_default())
    })?;
    Ok(written.text)
}

/// Words are the same; with a tolerance, they are floats.
fn is_near(a: u32, b: u32, tolerance: f32) -> bool {
    if a == b || tolerance == 0.0 {
        return a == b;
    }
    let (a, b) = (f32::from_bits(a), f32::from_bits(b));
    a.is_nan() && b.is_nan()
        || a == b
        || (a - b).abs() <= tolerance * a.abs().max(b.abs()).max(1e-3)
}

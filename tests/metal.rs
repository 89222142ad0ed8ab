//! Metal's language on the CPU, with clang and our own header for it: what the validator refuses
//! and accepts, and whether functions and textures give the right results.
//!
//! - `metal/refused/*.metal` begin with the line and the message of their mistake.
//! - `metal/functions/*.metal` are compared with `metal/references.rs`.
//! - `metal/lookups/*.wgsl` are compared with the evaluator.
//! - `metal/accepted/*.wgsl` are emitted as MSL, which the validator must accept.
//! - `frames` draws permutations of `forward` from the MSL of a bundle.

mod accepted;
mod expectations;
mod frames;
mod lookups;
mod references;

use std::fs;
use std::path::{Path, PathBuf};

use lamplight::execute::compiled::CompiledProgram;
use lamplight::execute::compiled::request::{FragmentInput, MetalResources};
use lamplight::metal::{Clang, ClangMissing, MslRefusal, validate_batch};
use libtest_mimic::{Failed, Trial};
use rayon::prelude::*;
use references::{REFERENCES, Reference};

type Outcome = Result<(), Failed>;

pub fn tests() -> Vec<Trial> {
    let mut tests = frames::tests();
    tests.extend([
        Trial::test("metal::mistakes_are_refused", mistakes),
        Trial::test("metal::outputs_are_accepted", accepted::outputs),
        Trial::test("metal::expectations", expectations::hold),
        Trial::test("metal::functions", functions),
        Trial::test("metal::lookups", || lookups::compare(&files("lookups"))),
        Trial::test("metal::crashes_are_reported", crashes),
    ]);
    tests
}

fn files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/metal").join(folder);
    let mut files: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

fn fail_with(wrong: &[String]) -> Outcome {
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n").into()) }
}

/// What the validator refuses. Each refusal has the index of its text.
fn refusals_of(texts: &[String]) -> Result<Vec<MslRefusal>, String> {
    let reason = |missing: ClangMissing| missing.reason;
    let clang = Clang::open().map_err(reason)?;
    let views: Vec<(usize, &str)> = texts.iter().map(String::as_str).enumerate().collect();
    let refused = views.par_chunks(64).map(|batch| validate_batch(&clang, batch));
    Ok(refused.collect::<Result<Vec<_>, _>>().map_err(reason)?.concat())
}

/// The validator refuses every text with a mistake, at its line and with its message.
fn mistakes() -> Outcome {
    let files = files("refused");
    let texts: Vec<String> = files.iter().map(|file| fs::read_to_string(file).unwrap()).collect();
    let refusals = refusals_of(&texts)?;
    let mut wrong = Vec::new();
    for (index, text) in texts.iter().enumerate() {
        let expected = text.lines().next().unwrap().strip_prefix("// mistake in line ").unwrap();
        let (line, words) = expected.split_once(": ").unwrap();
        let found = refusals.iter().find(|refusal| refusal.index == index);
        let errors = found.map_or("accepted", |refusal| &refusal.errors);
        if !errors.starts_with(&format!("{line}:")) || !errors.contains(words) {
            let expected = format!("expected `{words}` in line {line}");
            wrong.push(format!("{}: {expected}, found {errors}", files[index].display()));
        }
    }
    fail_with(&wrong)
}

/// The number of quads for each text.
const QUADS: u32 = 64;

/// The functions of our header give the results that Metal's specification defines.
fn functions() -> Outcome {
    let files = files("functions");
    let texts: Vec<String> = files.iter().map(|file| fs::read_to_string(file).unwrap()).collect();
    let views: Vec<&str> = texts.iter().map(String::as_str).collect();
    let mut program = CompiledProgram::build(&views).map_err(|missing| missing.reason)?;
    let mut wrong = Vec::new();
    for (index, file) in files.iter().enumerate() {
        let name = file.file_stem().unwrap().to_str().unwrap();
        let known = REFERENCES.iter().find(|(known, _)| *known == name);
        let (_, reference) = known.ok_or_else(|| format!("no reference for {name}"))?;
        match tried(&mut program, index, reference) {
            Ok(()) => {}
            Err(error) => wrong.push(format!("{name}: {error}")),
        }
    }
    if files.len() != REFERENCES.len() {
        let counts = format!("{} texts, {} references", files.len(), REFERENCES.len());
        wrong.push(format!("each text needs one reference: {counts}"));
    }
    fail_with(&wrong)
}

fn tried(program: &mut CompiledProgram, text: usize, reference: &Reference) -> Result<(), String> {
    let quads: Vec<[FragmentInput; 4]> = (0..QUADS)
        .map(|quad| [0, 1, 2, 3].map(|lane| fragment(reference, 4 * quad + lane)))
        .collect();
    let shaded = program.quads(text, &MetalResources::default(), &quads)?;
    for (fragment, shaded) in quads.iter().flatten().zip(shaded.iter().flatten()) {
        let words: [u32; 12] = std::array::from_fn(|i| fragment.locations[i / 4][i % 4]);
        compare(reference, &words, &shaded.targets.concat())?;
    }
    Ok(())
}

fn fragment(reference: &Reference, row: u32) -> FragmentInput {
    let word = |place: u32| {
        let bits = scrambled(12 * row + place);
        match reference {
            Reference::Words(_) => bits,
            Reference::Numbers { from, to, .. } => {
                let share = f64::from(bits) / f64::from(u32::MAX);
                ((from + (to - from) * share) as f32).to_bits()
            }
        }
    };
    let location = |first: u32| std::array::from_fn(|i| word(first + i as u32));
    FragmentInput {
        locations: vec![location(0), location(4), location(8)],
        ..FragmentInput::default()
    }
}

/// A pseudo-random word for an index.
pub fn scrambled(index: u32) -> u32 {
    let mut word = index.wrapping_mul(0x9e37_79b9) ^ 0x5bd1_e995;
    for step in [(16, 0x85eb_ca6bu32), (13, 0xc2b2_ae35), (16, 1)] {
        word = (word ^ word >> step.0).wrapping_mul(step.1);
    }
    word
}

fn compare(reference: &Reference, words: &[u32; 12], found: &[u32]) -> Result<(), String> {
    match reference {
        Reference::Words(expected) => {
            let expected = expected(words);
            if expected == found {
                return Ok(());
            }
            Err(format!("{words:08x?} gives {found:08x?}, expected {expected:08x?}"))
        }
        Reference::Numbers { share, least, expected, .. } => {
            let numbers = words.map(|word| f64::from(f32::from_bits(word)));
            let expected = expected(&numbers);
            let found: Vec<f64> =
                found.iter().map(|word| f64::from(f32::from_bits(*word))).collect();
            let is_off = |(found, expected): (&f64, &f64)| {
                let off = (found - expected).abs();
                off.is_nan() || off > share * expected.abs() + least
            };
            match found.iter().zip(&expected).position(is_off) {
                None if found.len() == expected.len() => Ok(()),
                place => {
                    let what = format!("the first wrong number is {place:?}");
                    Err(format!("{numbers:?} gives {found:?}, expected {expected:?}; {what}"))
                }
            }
        }
    }
}

/// A shader that crashes gives an error, and the next one runs.
fn crashes() -> Outcome {
    let text = |body: &str| {
        format!(
            "#include <metal_stdlib>\nstruct Output {{ metal::float4 to [[color(0)]]; }};\n\
             fragment Output main_(metal::float4 at [[position]]) {{\n{body}\n}}\n"
        )
    };
    let crash = text(
        "int zero = static_cast<int>(at.x); metal::float4 list[4]; volatile int* p = nullptr; *p = zero; return Output { list[zero] };",
    );
    let sound = text("return Output { at };");
    let mut program =
        CompiledProgram::build(&[&crash, &sound]).map_err(|missing| missing.reason)?;
    let quads =
        [std::array::from_fn(|_| FragmentInput { position: [1.0; 4], ..FragmentInput::default() })];
    let Err(error) = program.quads(0, &MetalResources::default(), &quads) else {
        return Err("a shader that writes through a null pointer gave no error".into());
    };
    if !error.contains("the program ended") {
        return Err(format!("expected `the program ended`, found {error}").into());
    }
    let shaded = program.quads(1, &MetalResources::default(), &quads)?;
    if shaded[0][3].targets[0] != [1.0f32.to_bits(); 4] {
        return Err(format!("the shader after the crash should give 1, found {shaded:?}").into());
    }
    Ok(())
}

//! The evaluator can run every function of the shader library, and the f32 result lies within the
//! evaluator's error bound.

use super::program;
use crate::LIBRARY_FILES;
use lamplight_compose::resolve::{Packages, wesl::load};
use lamplight_compose::{Keep, Options, wesl::compose};
use lamplight_diagnostic::source::{Files as _, Package, SourceSet};
use lamplight_eval::{Bounded, FindingKind, FunctionId, Machine, Number, Program, SlotKind};
use lamplight_permute::Settings;
use lamplight_testing::random::Random;
use libtest_mimic::{Failed, Trial};

/// The number of inputs for each function.
const INPUTS: u32 = 200;

pub fn tests() -> Vec<Trial> {
    let modules = LIBRARY_FILES
        .list(&["wesl"])
        .into_iter()
        .filter(|path| path.contains('/') && !path.starts_with("programs/"));
    modules.map(|path| Trial::test(format!("eval/library/{path}"), move || check(&path))).collect()
}

/// The program of all functions of a module.
pub fn library_program(path: &str) -> Result<Program, Failed> {
    let root = Package { name: "lamplight".into(), files: Box::new(LIBRARY_FILES) };
    let packages = Packages::new(root, Vec::new());
    let message_of = |errors| Failed::from(format!("{errors:?}"));
    let graph = load(&mut SourceSet::default(), &packages, path).map_err(message_of)?;
    let composed =
        compose(&graph, &Settings::default(), &Options { keep: Keep::All, ..Options::default() })
            .map_err(message_of)?;
    program(&composed.text)
}

fn check(path: &str) -> Result<(), Failed> {
    let program = library_program(path)?;
    let mut failures = String::new();
    for (id, function) in program.functions() {
        let outcome = match &function.error {
            Some(error) => Err(error.to_string().into()),
            None if function.arguments.contains(&SlotKind::Handle) => Ok(()),
            None => bounded(&program, id),
        };
        if let Err(failure) = outcome {
            failures += &format!("{}: {}\n", function.name, failure.message().unwrap_or_default());
        }
    }
    if failures.is_empty() { Ok(()) } else { Err(failures.into()) }
}

/// Runs a function on pseudo-random inputs, in f32 and with error bounds, and compares.
fn bounded(program: &Program, id: FunctionId) -> Result<(), Failed> {
    let function = program.signature(id).ok_or("no function")?;
    let (mut single, mut bound) =
        (Machine::<f32>::new(program)?, Machine::<Bounded>::new(program)?);
    let mut random = Random(1);
    for _ in 0..INPUTS {
        let words: Vec<u32> =
            function.arguments.iter().map(|kind| random_word(*kind, &mut random)).collect();
        let mut result = Vec::new();
        single.call_words(id, &words, &mut result)?;
        let slots: Vec<Bounded> =
            words.iter().zip(&function.arguments).map(|(word, kind)| slot(*kind, *word)).collect();
        bound.forget();
        let wanted = bound.call(id, &slots)?.to_vec();
        if bound.findings().iter().any(|finding| finding.kind == FindingKind::Ambiguous) {
            continue;
        }
        for ((kind, found), wanted) in function.result.iter().zip(&result).zip(&wanted) {
            let inside = match kind {
                SlotKind::Float => {
                    let found = f64::from(f32::from_bits(*found));
                    wanted.error().is_infinite() || (found - wanted.value()).abs() <= wanted.error()
                }
                _ => *found == wanted.word(),
            };
            if !inside {
                let inputs: Vec<f32> = words.iter().map(|word| f32::from_bits(*word)).collect();
                return Err(format!(
                    "{inputs:?} gives {} in f32, outside of the bound {wanted:?}",
                    f32::from_bits(*found)
                )
                .into());
            }
        }
    }
    Ok(())
}

/// A number from -1 to 1, or a small integer.
pub fn random_word(kind: SlotKind, random: &mut Random) -> u32 {
    match kind {
        SlotKind::Float => (random.between(-1.0, 1.0) as f32).to_bits(),
        SlotKind::Bool => random.below(2) as u32,
        _ => random.below(4) as u32,
    }
}

fn slot(kind: SlotKind, word: u32) -> Bounded {
    match kind {
        SlotKind::Float => Bounded::from_f64(f64::from(f32::from_bits(word))),
        _ => Bounded::from_word(word),
    }
}

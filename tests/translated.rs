//! Random functions of WESL, translated to GLSL: Mesa's own front end compiles the text, and the
//! results are those of the evaluator to the bit.

mod library;
mod program;

use std::collections::BTreeMap;

use lamplight::diagnostic::render::{Form, render};
use lamplight::execute::kernel::{self, Kernel};
use lamplight::execute::{Session, executors, on_thread};
use lamplight::source::SourceSet;
use lamplight_translate::print::{Dialect, Style};
use lamplight_translate::{SourceModule, translate_wesl};
use libtest_mimic::{Failed, Trial};

use crate::random::Random;
use program::{FLAGS, Program, program};

/// The number of programs. Some are refused: they have statements that no setting reaches, in which
/// a name has several meanings.
const PROGRAMS: u64 = 240;
/// The executors, and how many of the programs from the first seed on are refused.
const REFUSED: [(&str, usize); 2] = [("glsl_source", 2), ("essl_source", 2)];
/// Rows of arguments for each.
const ROWS: usize = 24;

const STYLE: Style<'static> =
    Style { dialect: Dialect::Glsl, command: None, guard: "RANDOM", sampling: None, prefix: None };

pub fn tests() -> Vec<Trial> {
    REFUSED
        .map(|(executor, refused)| {
            Trial::test(format!("translated::random::{executor}"), move || {
                values_agree(executor, refused)
            })
        })
        .into_iter()
        .chain(library::tests())
        .collect()
}

fn values_agree(executor: &'static str, expected: usize) -> Result<(), Failed> {
    let first: u64 = match std::env::var("LAMPLIGHT_SEED") {
        Ok(text) => text.parse().map_err(|_| "LAMPLIGHT_SEED is not a number")?,
        Err(_) => 0,
    };
    let run = on_thread(move || {
        let open = |name| executors::find_executor(name).ok_or("no such executor")?.start();
        let (mut eval, mut other) = (open("eval")?, open(executor)?);
        let mut refused = Vec::new();
        for seed in first..first + PROGRAMS {
            let made = program(seed, executor == "glsl_source");
            refused.extend(compare(&made, seed, &mut *eval, &mut *other)?);
        }
        match refused.len() == expected || first != 0 {
            true => Ok(()),
            false => Err(format!(
                "{} of {PROGRAMS} are refused, and not {expected}: {}",
                refused.len(),
                refused.join("\n")
            )),
        }
    });
    run.ok_or("a thread ended")?.map_err(Failed::from)
}

/// Compares a program's results; the reason if it is not translated.
fn compare(
    made: &Program,
    seed: u64,
    eval: &mut dyn Session,
    other: &mut dyn Session,
) -> Result<Option<String>, String> {
    let fail = |what: &str| format!("program {seed}: {what}\n{}", made.chosen);
    let glsl = match translated(made) {
        Ok(glsl) => glsl,
        Err(reason) if reason.contains("error[not-translated]") => return Ok(Some(reason)),
        Err(reason) => return Err(fail(&reason)),
    };
    let mut kernel = kernel_of(made).map_err(|reason| fail(&reason))?;
    kernel.source = Some(glsl.as_str().into());
    let mut random = Random(seed ^ 0x5eed);
    let mut words = Vec::new();
    for _ in 0..ROWS {
        let float = (random.below(257) as f32 - 128.0) * 0.5;
        let small = random.below(40) as u32;
        let [a, b] =
            [random.next() as u32, if random.chance(30) { small } else { random.next() as u32 }];
        words.extend([a, b, (random.below(2001) as i32 - 1000) as u32, float.to_bits()]);
    }
    let expected = eval.run(&kernel, &words).map_err(|error| fail(&error.message))?;
    let found = other
        .run(&kernel, &words)
        .map_err(|error| format!("program {seed}: {}\n{}\n{glsl}", error.message, made.text))?;
    match expected.iter().zip(&found).position(|(left, right)| left != right) {
        None => Ok(None),
        Some(row) => Err(format!(
            "program {seed}, row {row}: {:?} gives {} and not {}\n{}\n{glsl}",
            &words[4 * row..4 * row + 4],
            found[row],
            expected[row],
            made.chosen
        )),
    }
}

fn kernel_of(made: &Program) -> Result<Kernel, String> {
    let module = naga::front::wgsl::parse_str(&made.chosen)
        .map_err(|error| error.emit_to_string(&made.chosen))?;
    kernel::build_kernel(&module, "f", &BTreeMap::new()).map_err(|error| error.message)
}

/// The program in GLSL, with its flags.
fn translated(made: &Program) -> Result<String, String> {
    let mut sources = SourceSet::default();
    let source = sources.add("random.wesl", made.text.as_str());
    let module = SourceModule { path: vec!["random".to_owned()], source, text: &made.text };
    let files = translate_wesl(&[module], &[], &STYLE)
        .map_err(|problems| render(&sources, &problems, Form::Human))?;
    let flags: String = FLAGS
        .iter()
        .zip(made.flags)
        .map(|(name, value)| format!("#define {} {}\n", name.to_uppercase(), u8::from(value)))
        .collect();
    Ok(flags + &files.iter().map(|file| file.text.as_str()).collect::<String>())
}

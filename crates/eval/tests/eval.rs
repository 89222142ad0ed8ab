//! The evaluator, which runs shaders on the CPU. Cases are comments in
//! `tests/eval/*.wgsl` and `*.glsl`:
//!
//! - `// expect: f(1, 2.5) = 3`: arguments and result, flattened to scalars. The result is checked
//!   in f64 and in f32, and the f32 result must lie within the error bound of the evaluator.
//! - `// error: f(1) = loop-code`: the code of the expected error.
//! - `// finding: f(0) = Domain`: what the sanitizer notices; `none` for nothing.
//! - `// quad: f(0 | 1 | 0 | 1) = 1 | 1 | 1 | 1`: the four fragments of a quad.

mod built_ins;
mod constants;
mod dispatch;
mod filters;
mod library;
mod lockstep;
mod machine;
mod speed;
mod sweeps;
mod textures;

use lamplight_bundle::{Language, Stage};
use lamplight_compose::Composed;
use lamplight_eval::{Bounded, Function, FunctionId, Machine, Number, Program, SlotKind};
use lamplight_validate::validate;
use libtest_mimic::{Failed, Trial};

pub fn tests() -> Vec<Trial> {
    let mut tests = Vec::new();
    let mut files: Vec<_> = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/eval"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    files.retain(|path| {
        path.extension().is_some_and(|extension| extension == "wgsl" || extension == "glsl")
    });
    files.sort();
    for path in files {
        let name = format!("eval/{}", path.file_stem().unwrap().to_string_lossy());
        let is_glsl = path.extension().is_some_and(|extension| extension == "glsl");
        let program = if is_glsl { program_of_glsl } else { program };
        tests.push(Trial::test(name, move || {
            check(&std::fs::read_to_string(&path).unwrap(), program)
        }));
    }
    tests.extend(constants::tests());
    tests.extend(filters::tests());
    tests.extend(library::tests());
    tests.extend(lockstep::tests());
    tests.extend(dispatch::tests());
    tests.extend(machine::tests());
    tests.extend(speed::tests());
    tests.extend(sweeps::tests());
    tests.extend(textures::tests());
    tests
}

/// Parses and validates a text, and lowers it to the evaluator's program.
pub fn program(text: &str) -> Result<Program, Failed> {
    let module = naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?;
    let capabilities = naga::valid::Capabilities::all();
    let info = naga::valid::Validator::new(naga::valid::ValidationFlags::all(), capabilities)
        .validate(&module);
    let info = info.map_err(|error| error.emit_to_string(text))?;
    Ok(Program::new(&module, &info)?)
}

/// The same for a fragment stage in GLSL.
fn program_of_glsl(text: &str) -> Result<Program, Failed> {
    let stage = Some(Stage::Fragment);
    let composed = Composed::of_text(Language::Glsl, stage, text.to_owned());
    let validated = validate(&composed).map_err(|errors| errors[0].message.clone())?;
    Ok(Program::new(&validated.module, &validated.info)?)
}

fn check(text: &str, program: fn(&str) -> Result<Program, Failed>) -> Result<(), Failed> {
    let program = program(text)?;
    let mut failures = String::new();
    let mut cases = 0;
    for (number, line) in text.lines().enumerate() {
        let Some((kind, case)) =
            line.trim().strip_prefix("// ").and_then(|line| line.split_once(": "))
        else {
            continue;
        };
        let outcome = match kind {
            "expect" => expect(&program, case),
            "error" => error(&program, case),
            "finding" => finding(&program, case),
            "quad" => quad(&program, case),
            _ => continue,
        };
        cases += 1;
        if let Err(failure) = outcome {
            failures += &format!(
                "line {}: {case}: {}\n",
                number + 1,
                failure.message().unwrap_or_default()
            );
        }
    }
    match (failures.is_empty(), cases) {
        (true, 0) => Err("the file has no case, which is a comment like `// expect: ...`".into()),
        (true, _) => Ok(()),
        _ => Err(failures.into()),
    }
}

/// A case `name(arguments) = wanted`. The arguments are those of one call, or of four for a quad.
struct Call<'c> {
    id: FunctionId,
    arguments: Vec<&'c str>,
    wanted: &'c str,
}

fn call<'c>(program: &Program, case: &'c str) -> Result<Call<'c>, Failed> {
    let (call, wanted) = case.split_once(" = ").ok_or("no ` = `")?;
    let (name, arguments) =
        call.trim().strip_suffix(')').and_then(|call| call.split_once('(')).ok_or("not a call")?;
    let id = program.function(name).ok_or("no such function")?;
    Ok(Call { id, arguments: arguments.split('|').collect(), wanted: wanted.trim() })
}

/// Parses scalars as numbers of the kinds that a function takes or returns.
pub fn slots<N: Number>(text: &str, kinds: &[SlotKind]) -> Result<Vec<N>, Failed> {
    let scalars = text.split([',', ' ']).filter(|scalar| !scalar.is_empty());
    scalars
        .enumerate()
        .map(|(index, scalar)| slot(scalar, *kinds.get(index).ok_or("too many scalars")?))
        .collect()
}

fn slot<N: Number>(text: &str, kind: SlotKind) -> Result<N, Failed> {
    Ok(match (kind, text) {
        (SlotKind::Float, _) => N::from_f64(text.parse::<f64>()?),
        (_, "true") => N::from_word(1),
        (_, "false") => N::from_word(0),
        _ if text.starts_with("0x") => N::from_word(u32::from_str_radix(&text[2..], 16)?),
        _ => N::from_word(text.parse::<i64>()? as u32),
    })
}

fn expect(program: &Program, case: &str) -> Result<(), Failed> {
    let call = call(program, case)?;
    let function = program.signature(call.id).unwrap();
    let wanted = slots::<f64>(call.wanted, &function.result)?;
    let double = run::<f64>(program, &call)?;
    near(function, &double, &wanted, 1e-6)?;
    let single = run::<f32>(program, &call)?;
    let widened: Vec<f64> =
        single.iter().zip(&function.result).map(|(slot, kind)| widen(*slot, *kind)).collect();
    near(function, &widened, &wanted, 1e-4)?;
    within(function, &run::<Bounded>(program, &call)?, &double, &single)
}

fn widen(slot: f32, kind: SlotKind) -> f64 {
    if kind == SlotKind::Float { f64::from(slot) } else { f64::from_word(slot.word()) }
}

fn run<N: Number>(program: &Program, call: &Call) -> Result<Vec<N>, Failed> {
    let function = program.signature(call.id).unwrap();
    let mut machine = Machine::<N>::new(program)?;
    let arguments = slots::<N>(call.arguments[0], &function.arguments)?;
    let result = machine.call(call.id, &arguments)?.to_vec();
    // The first call must leave nothing behind that a second call sees.
    let again = machine.call(call.id, &arguments)?;
    if again
        .iter()
        .zip(&result)
        .any(|(a, b)| a.value().to_bits() != b.value().to_bits() && !a.value().is_nan())
    {
        return Err("a second call gives another result".into());
    }
    Ok(result)
}

/// Fails unless the results are the wanted ones: floats within a tolerance that is relative above 1
/// and absolute below, integers and booleans exactly.
pub fn near(
    function: &Function,
    found: &[f64],
    wanted: &[f64],
    tolerance: f64,
) -> Result<(), Failed> {
    let close = |kind: SlotKind, found: f64, wanted: f64| match kind {
        SlotKind::Float => {
            found == wanted
                || found.is_nan() && wanted.is_nan()
                || (found - wanted).abs() <= tolerance * wanted.abs().max(1.0)
        }
        _ => found.word() == wanted.word(),
    };
    let good = found.len() == wanted.len()
        && function.result.iter().enumerate().all(|(i, kind)| close(*kind, found[i], wanted[i]));
    if good {
        Ok(())
    } else {
        Err(format!("got {}, wanted {}", show(function, found), show(function, wanted)).into())
    }
}

fn show(function: &Function, slots: &[f64]) -> String {
    let scalars = slots.iter().zip(&function.result).map(|(slot, kind)| match kind {
        SlotKind::Float => slot.to_string(),
        SlotKind::Sint => (slot.word() as i32).to_string(),
        _ => slot.word().to_string(),
    });
    scalars.collect::<Vec<_>>().join(" ")
}

/// The run with error bounds must have the values of the f64 run, and the f32 run must lie within
/// the bounds.
fn within(
    function: &Function,
    bounded: &[Bounded],
    double: &[f64],
    single: &[f32],
) -> Result<(), Failed> {
    for (i, kind) in function.result.iter().enumerate() {
        if *kind != SlotKind::Float {
            let same =
                bounded[i].word() == double[i].word() && single[i].word() == double[i].word();
            same.then_some(()).ok_or_else(|| {
                format!(
                    "word {i} is {} with bounds, {} in f64, {} in f32",
                    bounded[i].word(),
                    double[i].word(),
                    single[i].word()
                )
            })?;
            continue;
        }
        let same = bounded[i].value() == double[i] || double[i].is_nan();
        same.then_some(()).ok_or_else(|| {
            format!("the run with bounds gives {}, f64 gives {}", bounded[i].value(), double[i])
        })?;
        let distance = (f64::from(single[i]) - double[i]).abs();
        if distance > bounded[i].error() {
            return Err(format!(
                "f32 is off by {distance:e}, the bound is {:e}",
                bounded[i].error()
            )
            .into());
        }
    }
    Ok(())
}

fn error(program: &Program, case: &str) -> Result<(), Failed> {
    let call = call(program, case)?;
    let function = program.signature(call.id).unwrap();
    // A function that could not be lowered has no known arguments, so none are given.
    let arguments = if function.error.is_some() {
        Vec::new()
    } else {
        slots::<f64>(call.arguments[0], &function.arguments)?
    };
    match Machine::<f64>::new(program)?.call(call.id, &arguments) {
        Ok(result) => Err(format!("expected `{}`, found {result:?}", call.wanted).into()),
        Err(error) if error.code.name == call.wanted => Ok(()),
        Err(error) => Err(format!("expected `{}`, found {error}", call.wanted).into()),
    }
}

fn finding(program: &Program, case: &str) -> Result<(), Failed> {
    let call = call(program, case)?;
    let function = program.signature(call.id).unwrap();
    let mut machine = Machine::<Bounded>::new(program)?;
    machine.sanitize(true);
    machine.call(call.id, &slots::<Bounded>(call.arguments[0], &function.arguments)?)?;
    let found: Vec<String> =
        machine.findings().iter().map(|finding| format!("{:?}", finding.kind)).collect();
    let found = if found.is_empty() { "none".to_string() } else { found.join(" ") };
    match found == call.wanted {
        true => Ok(()),
        false => Err(format!("expected the findings `{}`, found `{found}`", call.wanted).into()),
    }
}

fn quad(program: &Program, case: &str) -> Result<(), Failed> {
    let call = call(program, case)?;
    let function = program.signature(call.id).unwrap();
    let arguments: Vec<Vec<f64>> = call
        .arguments
        .iter()
        .map(|lane| slots(lane, &function.arguments))
        .collect::<Result<_, _>>()?;
    let lanes = [0, 1, 2, 3].map(|lane| arguments[lane].as_slice());
    let results = Machine::<f64>::new(program)?.quad(call.id, lanes)?;
    for (found, wanted) in results.iter().zip(call.wanted.split('|')) {
        near(function, found, &slots::<f64>(wanted, &function.result)?, 1e-9)?;
    }
    Ok(())
}

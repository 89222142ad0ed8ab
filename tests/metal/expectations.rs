//! Runs the cases of `crates/eval/tests/eval/*.wgsl`, such as `// expect: f(1, 2.5) = 3`, as emitted MSL on the
//! CPU.

use std::collections::BTreeMap;
use std::path::Path;

use lamplight::execute::kernel::{self, Kernel};
use lamplight::execute::{executors, on_thread};
use naga::ScalarKind;

use super::{Outcome, fail_with};

/// The start of cases that cannot be run, and the reason.
const OPEN: &[(&str, &str)] = &[
    ("column(9)", OUTSIDE),
    ("from_half(", HALF),
    ("overridden(", "an override whose default depends on another is refused"),
    ("table(-1)", OUTSIDE),
    ("table(100)", OUTSIDE),
    ("to_half(", HALF),
];
const OUTSIDE: &str = "the index is out of bounds, which MSL does not define";
const HALF: &str = "16-bit floats are not a capability of modules that ship";

/// The largest error of a number, relative to the number or to 1.
const SHARE: f64 = 1e-4;

struct Case {
    file: String,
    text: String,
    kernel: Kernel,
    arguments: Vec<String>,
    wanted: Vec<String>,
}

pub fn hold() -> Outcome {
    let outcome = on_thread(|| {
        let (mut cases, mut wrong) = (Vec::new(), Vec::new());
        for name in ["control_flow", "lighting", "packing", "values"] {
            read(name, &mut cases, &mut wrong)?;
        }
        let mut session = executors::find_executor("msl").ok_or("no such executor")?.start()?;
        session.prepare(&cases.iter().map(|case| &case.kernel).collect::<Vec<_>>());
        for case in &cases {
            let found = words(case)
                .and_then(|words| session.run(&case.kernel, &words).map_err(|error| error.message));
            let outcome = found.and_then(|found| agrees(case, &found));
            wrong.extend(
                outcome.err().map(|error| format!("{}: {}: {error}", case.file, case.text)),
            );
        }
        println!("{} cases", cases.len());
        fail_with(&wrong).map_err(|failed| failed.message().unwrap_or_default().to_owned())
    });
    Ok(outcome.ok_or("panicked")??)
}

fn read(name: &str, cases: &mut Vec<Case>, wrong: &mut Vec<String>) -> Result<(), String> {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("crates/eval/tests/eval/{name}.wgsl"));
    let text = std::fs::read_to_string(path).map_err(|error| error.to_string())?;
    let module = naga::front::wgsl::parse_str(&text).map_err(|error| error.to_string())?;
    for line in text.lines() {
        let Some(case) = line.trim().strip_prefix("// expect: ") else { continue };
        if let Some((_, reason)) = OPEN.iter().find(|(open, _)| case.starts_with(open)) {
            println!("not run: {case}: {reason}");
            continue;
        }
        let (call, wanted) = case.split_once(" = ").ok_or("no ` = `")?;
        let (function, arguments) =
            call.trim_end_matches(')').split_once('(').ok_or("not a call")?;
        let list = |text: &str| -> Vec<String> {
            let words = text.split([',', ' ']).filter(|word| !word.is_empty());
            words.map(str::to_owned).collect()
        };
        match kernel::build_kernel(&module, function, &BTreeMap::new()) {
            Ok(kernel) => cases.push(Case {
                file: name.to_owned(),
                text: case.to_owned(),
                kernel,
                arguments: list(arguments),
                wanted: list(wanted),
            }),
            Err(error) => wrong.push(format!("{name}: {case}: {}", error.message)),
        }
    }
    Ok(())
}

fn words(case: &Case) -> Result<Vec<u32>, String> {
    let kinds = case.kernel.words().flat_map(|(_, shape)| shape.kinds());
    case.arguments.iter().zip(kinds).map(|(text, kind)| Ok(word(text, kind)?.0)).collect()
}

/// A scalar as a word, and as a number.
fn word(text: &str, kind: ScalarKind) -> Result<(u32, f64), String> {
    let whole = |text: &str| -> Result<u32, String> {
        match text {
            "true" => Ok(1),
            "false" => Ok(0),
            _ if text.starts_with("0x") => {
                u32::from_str_radix(&text[2..], 16).map_err(|error| error.to_string())
            }
            _ => text.parse::<i64>().map(|value| value as u32).map_err(|error| error.to_string()),
        }
    };
    if kind == ScalarKind::Float {
        let value: f64 = text.parse().map_err(|_| format!("`{text}` is not a number"))?;
        return Ok(((value as f32).to_bits(), value));
    }
    let word = whole(text)?;
    Ok((word, f64::from(word)))
}

fn agrees(case: &Case, found: &[u32]) -> Result<(), String> {
    let kinds = case.kernel.result_kinds();
    for ((text, kind), found) in case.wanted.iter().zip(&kinds).zip(found) {
        let (bits, wanted) = word(text, *kind)?;
        let is_right = if *kind == ScalarKind::Float {
            let value = f64::from(f32::from_bits(*found));
            (value - wanted).abs() <= SHARE * wanted.abs().max(1.0)
        } else {
            *found == bits
        };
        if !is_right {
            let number = f32::from_bits(*found);
            return Err(format!("expected {text}, found {found:08x}, which is {number} in f32"));
        }
    }
    Ok(())
}

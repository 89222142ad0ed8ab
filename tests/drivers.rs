//! Compares the drivers with the evaluator. For a sweep of arguments of every built-in function, the
//! driver's result must lie within the evaluator's error bound. If it does not, the bounds are wrong,
//! and with them every verdict of `check`; or the driver is.

#[path = "../crates/eval/tests/eval/built_ins.rs"]
mod built_ins;

use std::collections::BTreeMap;

use built_ins::{ONE, One};
use lamplight::eval::{Bounded, Machine, Number, Program};
use lamplight::execute::kernel::{self, Kernel};
use lamplight::execute::{Session, executors, on_thread};
use libtest_mimic::{Failed, Trial};

/// Parses and validates a text, and lowers it to the evaluator's program.
pub fn program(text: &str) -> Result<Program, Failed> {
    let module = naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?;
    let capabilities = naga::valid::Capabilities::all();
    let info = naga::valid::Validator::new(naga::valid::ValidationFlags::all(), capabilities)
        .validate(&module);
    let info = info.map_err(|error| error.emit_to_string(text))?;
    Ok(Program::new(&module, &info)?)
}

/// Steps of a sweep.
const STEPS: u32 = 200;

/// Further expressions of x. They are only compared with the evaluator, so their Rust functions are
/// placeholders.
const MORE: &[One] = &[
    ("cross(vec3f(x, 1.0, 2.0), vec3f(2.0, x, -1.0)).z", |_| 0.0, -5.0, 5.0),
    ("reflect(vec2f(x, -1.0), vec2f(0.6, 0.8)).x", |_| 0.0, -5.0, 5.0),
    ("refract(vec2f(0.6, -0.8), vec2f(0.0, 1.0), x).x", |_| 0.0, 0.1, 1.2),
    ("faceForward(vec2f(x, 1.0), vec2f(x, 2.0), vec2f(1.0, 0.0)).x", |_| 0.0, 0.1, 5.0),
    ("select(x, -x, x < 0.5)", |_| 0.0, -5.0, 5.0),
    // Drivers compute `x + (b - x) * 1.0`, whose difference is rounded, so that this is not `b`.
    ("mix(x, -1.8125, 1.0)", |_| 0.0, -5.0, 5.0),
    ("(mat2x2f(x, 1.0, 2.0, x) * vec2f(x, 3.0)).x", |_| 0.0, -5.0, 5.0),
    ("(vec2f(x, 3.0) * mat2x2f(x, 1.0, 2.0, x)).y", |_| 0.0, -5.0, 5.0),
    ("(mat2x2f(x, 1.0, 2.0, x) * mat2x2f(1.0, x, 0.5, 2.0))[1].x", |_| 0.0, -5.0, 5.0),
    ("transpose(mat2x3f(x, 1.0, 2.0, 3.0, x, 4.0))[2].y", |_| 0.0, -5.0, 5.0),
    ("f32(i32(x)) + f32(u32(x + 9.0))", |_| 0.0, -5.0, 5.0),
    ("f32(bitcast<u32>(x) >> 20u)", |_| 0.0, -5.0, 5.0),
    (
        "f32(countOneBits(u32(x)) + countLeadingZeros(u32(x)) + countTrailingZeros(u32(x)))",
        |_| 0.0,
        0.0,
        500.0,
    ),
    (
        "f32(firstLeadingBit(u32(x)) + firstTrailingBit(u32(x) | 8u) + reverseBits(u32(x)) % 97u)",
        |_| 0.0,
        1.0,
        500.0,
    ),
    ("f32(extractBits(u32(x), 2u, 5u) + insertBits(u32(x), 9u, 3u, 4u))", |_| 0.0, 0.0, 500.0),
    ("f32(i32(x) / 3 + (i32(x) << 2u) + (i32(x) >> 1u))", |_| 0.0, -500.0, 500.0),
    // GLSL does not define the remainder of negative numbers, and naga writes the operator as it is.
    ("f32(i32(x) % 4)", |_| 0.0, 0.0, 500.0),
    ("unpack2x16float(pack2x16float(vec2f(x, 1.0))).x", |_| 0.0, -5.0, 5.0),
    ("f32(pack4x8unorm(vec4f(x, 0.0, 0.0, 0.0)))", |_| 0.0, -0.5, 1.5),
    ("unpack4x8snorm(u32(x)).x", |_| 0.0, 0.0, 255.0),
    ("unpack2x16unorm(u32(x) * 99u).x", |_| 0.0, 0.0, 600.0),
    ("unpack4x8unorm(u32(x)).x", |_| 0.0, 0.0, 255.0),
    ("unpack2x16snorm(u32(x) * 99u).x", |_| 0.0, 0.0, 600.0),
    ("f32(pack4x8snorm(vec4f(x, 0.0, 0.0, 0.0)) & 255u)", |_| 0.0, -1.5, 1.5),
    ("f32(pack2x16snorm(vec2f(x, 0.0)) & 65535u)", |_| 0.0, -1.5, 1.5),
    ("f32(pack2x16unorm(vec2f(x, 0.0)))", |_| 0.0, -0.5, 1.5),
    ("determinant(mat3x3f(x, 1.0, 2.0, 0.5, x, 1.0, 3.0, 0.0, x))", |_| 0.0, -5.0, 5.0),
    (
        "f32(any(vec2<bool>(x > 1.0, x < -1.0))) + 2.0 * f32(all(vec2<bool>(x > 0.0, x < 2.0)))",
        |_| 0.0,
        -5.0,
        5.0,
    ),
    ("f32(dot4U8Packed(u32(x) * 9999u, 67305985u))", |_| 0.0, 0.0, 500.0),
    ("f32(dot4I8Packed(u32(x) * 9999u, 67305985u))", |_| 0.0, 0.0, 500.0),
];

/// The numeric built-in functions of WGSL. Each must be in a sweep.
const BUILT_INS: &[&str] = &[
    "abs",
    "acos",
    "acosh",
    "all",
    "any",
    "asin",
    "asinh",
    "atan",
    "atan2",
    "atanh",
    "bitcast",
    "ceil",
    "clamp",
    "cos",
    "cosh",
    "countLeadingZeros",
    "countOneBits",
    "countTrailingZeros",
    "cross",
    "degrees",
    "determinant",
    "distance",
    "dot",
    "dot4I8Packed",
    "dot4U8Packed",
    "exp",
    "exp2",
    "extractBits",
    "faceForward",
    "firstLeadingBit",
    "firstTrailingBit",
    "floor",
    "fma",
    "fract",
    "frexp",
    "insertBits",
    "inverseSqrt",
    "ldexp",
    "length",
    "log",
    "log2",
    "max",
    "min",
    "mix",
    "modf",
    "normalize",
    "pack2x16float",
    "pack2x16snorm",
    "pack2x16unorm",
    "pack4x8snorm",
    "pack4x8unorm",
    "pow",
    "quantizeToF16",
    "radians",
    "reflect",
    "refract",
    "reverseBits",
    "round",
    "saturate",
    "select",
    "sign",
    "sin",
    "sinh",
    "smoothstep",
    "sqrt",
    "step",
    "tan",
    "tanh",
    "transpose",
    "trunc",
    "unpack2x16float",
    "unpack2x16snorm",
    "unpack2x16unorm",
    "unpack4x8snorm",
    "unpack4x8unorm",
];

/// Drivers with larger errors than the specification allows: expression, executor, and the absolute
/// error that is allowed in addition. Mesa's arc sine is one polynomial over the whole range.
const WAIVERS: &[(&str, &str, f64)] = &[("asin(x)", "gl", 4e-4)];

/// What an executor cannot run: the start of the expression, the executor, and the reason.
const LACKING: &[(&str, &str, &str)] =
    &[("quantizeToF16(x)", "msl", HALF), ("unpack2x16float(pack2x16float", "msl", HALF)];
const HALF: &str = "16-bit floats are not a capability of modules that ship";

pub fn tests() -> Vec<Trial> {
    let drivers = executors::ALL
        .iter()
        .filter(|executor| executor.samples.is_some() && executor.name != "eval");
    let sweeps = drivers.map(|executor| {
        Trial::test(format!("eval/drivers/{}", executor.name), move || run(executor))
    });
    sweeps.chain([Trial::test("eval/drivers/every_built_in", every_built_in)]).collect()
}

fn every_built_in() -> Result<(), Failed> {
    let is_called = |name: &str, text: &str| {
        text.split(|c: char| !c.is_alphanumeric()).any(|word| word == name)
    };
    let is_swept =
        |name: &&&str| ONE.iter().chain(MORE).any(|(expression, ..)| is_called(name, expression));
    let missing: Vec<&str> = BUILT_INS.iter().filter(|name| !is_swept(name)).copied().collect();
    if missing.is_empty() {
        Ok(())
    } else {
        Err(format!("no sweep calls {}", missing.join(", ")).into())
    }
}

/// Runs all sweeps on an executor. Its session is opened, used and dropped on a thread of its own.
fn run(executor: &'static executors::ExecutorEntry) -> Result<(), Failed> {
    let outcome = on_thread(|| {
        let mut session = executor.start()?;
        let cases: Vec<(&One, Kernel)> = ONE
            .iter()
            .chain(MORE)
            .filter(|case| !is_lacking(case, executor.name))
            .map(|case| Ok((case, kernel(case)?)))
            .collect::<Result<_, String>>()?;
        session.prepare(&cases.iter().map(|(_, kernel)| kernel).collect::<Vec<_>>());
        let failures: Vec<String> = cases
            .iter()
            .filter_map(|(case, kernel)| sweep(case, kernel, executor.name, session.as_mut()).err())
            .collect();
        if failures.is_empty() { Ok(()) } else { Err(failures.join("\n")) }
    });
    outcome.ok_or("panicked")?.map_err(Failed::from)
}

fn is_lacking((expression, ..): &One, executor: &str) -> bool {
    let found =
        LACKING.iter().find(|(start, on, _)| *on == executor && expression.starts_with(start));
    if let Some((_, _, reason)) = found {
        println!("not run on {executor}: {expression}: {reason}");
    }
    found.is_some()
}

fn text((expression, ..): &One) -> String {
    format!("fn f(x: f32) -> f32 {{ return {expression}; }}")
}

fn kernel(case: &One) -> Result<Kernel, String> {
    let fail = |text: String| format!("{}: {text}", case.0);
    let parsed = naga::front::wgsl::parse_str(&text(case));
    let module = parsed.map_err(|error| fail(error.to_string()))?;
    kernel::build_kernel(&module, "f", &BTreeMap::new()).map_err(|error| fail(error.message))
}

fn sweep(
    case: &One,
    kernel: &Kernel,
    executor: &str,
    session: &mut dyn Session,
) -> Result<(), String> {
    let (expression, _, low, high) = case;
    let fail = |text: String| format!("{expression}: {text}");
    let inputs: Vec<f32> = (0..=STEPS)
        .map(|step| (low + (high - low) * f64::from(step) / f64::from(STEPS)) as f32)
        .collect();
    let words: Vec<u32> = inputs.iter().map(|x| x.to_bits()).collect();
    let found = session.run(kernel, &words).map_err(|error| fail(error.message))?;
    let program = program(&text(case))
        .map_err(|error| fail(error.message().unwrap_or_default().to_owned()))?;
    let f = program.function("f").ok_or("f")?;
    let mut machine = Machine::<Bounded>::new(&program).map_err(|error| fail(error.message))?;
    let waived = WAIVERS
        .iter()
        .find(|(waived, on, _)| waived == expression && *on == executor)
        .map_or(0.0, |waiver| waiver.2);
    for (x, word) in inputs.iter().zip(found) {
        machine.forget();
        let wanted = machine
            .call(f, &[Bounded::from_f64(f64::from(*x))])
            .map_err(|error| fail(error.message))?[0];
        let off = (f64::from(f32::from_bits(word)) - wanted.value()).abs();
        let doubtful = !machine.findings().is_empty();
        let is_off = off.is_nan() || off > wanted.error() + waived;
        if is_off && !wanted.value().is_nan() && !doubtful {
            return Err(fail(format!(
                "at {x} (0x{:08x}) {executor} gives {}, wanted {} within {:e}, off by {off:e}",
                x.to_bits(),
                f32::from_bits(word),
                wanted.value(),
                wanted.error() + waived
            )));
        }
    }
    Ok(())
}

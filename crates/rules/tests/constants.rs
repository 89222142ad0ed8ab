//! Values of built-in functions of random constants, judged by Tint, which computes them itself.

use libtest_mimic::{Failed, Trial};

use crate::random::{Random, asked_number};
use crate::verdicts::{accepts, tint};

/// How many texts Tint is asked about, and how many calls each has.
const TEXTS: u64 = 20;
const CALLS: usize = 100;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("rules::values_of_constants", values)
            .with_ignored_flag(tint("--help").is_err()),
    ]
}

/// Every call is folded, and Tint finds the same value for it.
fn values() -> Result<(), Failed> {
    let seed = asked_number("LAMPLIGHT_RULES_SEED", 0);
    let folder = tempfile::tempdir()?;
    for seed in seed..seed + asked_number("LAMPLIGHT_RULES_PROGRAMS", TEXTS) {
        let mut random = Random(seed);
        let calls: Vec<String> = (0..CALLS).map(|_| call(&mut random)).collect();
        let declared = |(at, call): (usize, &String)| format!("const x{at} = {call};\n");
        let text: String = calls.iter().enumerate().map(declared).collect();
        let folded = lamplight_rules::fold(&text).ok_or("nothing is folded")?;
        let count = folded.lines().filter(|line| line.starts_with("const c")).count();
        if count != CALLS {
            return Err(format!("{count} of {CALLS} calls are folded\n{folded}").into());
        }
        // The last constant belongs to the first call.
        let asserted: String = calls.iter().enumerate().map(assertion).collect();
        let file = folder.path().join(format!("{seed}.wgsl"));
        std::fs::write(&file, format!("enable f16;\n{folded}\n{asserted}"))?;
        if !accepts(&file)? {
            let output = std::process::Command::new("tint").arg(&file).output()?;
            let message = String::from_utf8_lossy(&output.stderr).into_owned();
            return Err(format!("seed {seed}: {message}").into());
        }
    }
    Ok(())
}

/// That the value of a call is the folded one, but for rounding.
fn assertion((at, call): (usize, &String)) -> String {
    const EXACT: [&str; 5] = ["pack", "unpack", "insert", "extract", "ldexp"];
    let is_exact = EXACT.iter().any(|name| call.starts_with(name)) || call.contains(".exp");
    let assert = |condition: String| format!("const_assert {condition};\n");
    match call.strip_prefix("transpose(mat").and_then(|rest| rest.split_once('x')) {
        // Matrices are compared by their columns, of which there are as many as there were rows.
        Some((_, rest)) => {
            let columns = rest.chars().next().and_then(|digit| digit.to_digit(10)).unwrap_or(0);
            (0..columns)
                .map(|one| assert(format!("all(({call})[{one}] == x{at}[{one}])")))
                .collect()
        }
        None if is_exact => assert(format!("all(({call}) == x{at})")),
        // The limit has the shape of the value.
        None => assert(format!("all(abs({call} - x{at}) <= x{at} * 0 + 0.001)")),
    }
}

/// A number that f16 holds exactly.
fn float(random: &mut Random) -> String {
    format!("{:?}", f64::from(random.below(65) as i32 - 32) / 8.0)
}

fn floats(random: &mut Random, count: usize) -> String {
    let parts: Vec<String> = (0..count).map(|_| float(random)).collect();
    parts.join(", ")
}

fn word(random: &mut Random) -> u32 {
    (random.below(1 << 16) as u32) << 16 | random.below(1 << 16) as u32
}

/// A call of a random function that naga does not compute.
fn call(random: &mut Random) -> String {
    let size = 2 + random.below(3);
    let suffix = ["f", ""][random.below(2)];
    let vector = |random: &mut Random| {
        let parts = floats(random, size);
        if suffix.is_empty() {
            format!("vec{size}({parts})")
        } else {
            format!("vec{size}f({parts})")
        }
    };
    match random.below(14) {
        0 => format!("mix({}, {}, {})", vector(random), vector(random), float(random)),
        1 => {
            let (low, x) = (float(random), float(random));
            format!("smoothstep({low}, {low} + 2.5, {x})")
        }
        2 => format!("ldexp({}f, {})", float(random), random.below(20) as i32 - 10),
        3 => format!("frexp({}).{}", vector(random), ["fract", "exp"][random.below(2)]),
        4 => format!("modf({}).{}", vector(random), ["fract", "whole"][random.below(2)]),
        5 => {
            let (offset, count) = (random.below(20), random.below(12));
            format!("insertBits({}u, {}u, {offset}, {count})", word(random), word(random))
        }
        6 => {
            let (offset, count) = (random.below(20), random.below(12));
            format!("extractBits({}i, {offset}, {count})", word(random) / 2)
        }
        7 => {
            let other = 2 + random.below(3);
            format!("transpose(mat{size}x{other}f({}))", floats(random, size * other))
        }
        8 => format!("determinant(mat{size}x{size}f({}))", floats(random, size * size)),
        9 => format!("reflect({}, {})", vector(random), vector(random)),
        10 => format!("faceForward({}, {}, {})", vector(random), vector(random), vector(random)),
        11 => format!("quantizeToF16({}f / 7.0)", float(random)),
        12 => match random.below(4) {
            0 => format!("pack4x8snorm(vec4f({}) / 4.0)", floats(random, 4)),
            1 => format!("pack2x16unorm(vec2f({}) / 4.0)", floats(random, 2)),
            2 => format!("pack2x16float(vec2f({}))", floats(random, 2)),
            _ => format!("pack4xI8Clamp(vec4i({}, -200, 5, 200))", random.below(300) as i32 - 150),
        },
        _ => {
            let names = ["4x8snorm", "4x8unorm", "2x16snorm", "2x16unorm", "4xI8", "4xU8"];
            format!("unpack{}({}u)", names[random.below(names.len())], word(random))
        }
    }
}

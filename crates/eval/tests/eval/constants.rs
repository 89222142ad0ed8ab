//! Compares the evaluator with naga's constant evaluator. Each expression is written as a constant,
//! which naga computes, and as a function, which the evaluator computes.

use super::{near, program};
use lamplight_eval::Machine;
use libtest_mimic::{Failed, Trial};

/// The result's type, the parameter, an expression of it, and arguments.
const CASES: &[(&str, &str, &str, &[&str])] = &[
    ("u32", "x: u32", "countOneBits(x)", &["0xf0f0u", "0u", "4294967295u"]),
    ("u32", "x: u32", "countLeadingZeros(x)", &["0xf0f0u", "0u", "1u"]),
    ("u32", "x: u32", "countTrailingZeros(x)", &["0xf0f0u", "0u", "1u"]),
    ("u32", "x: u32", "reverseBits(x)", &["0xf0f0u", "1u"]),
    ("u32", "x: u32", "firstLeadingBit(x)", &["0u", "1u", "0x80000000u", "77u"]),
    ("i32", "x: i32", "firstLeadingBit(x)", &["0i", "-1i", "77i", "-77i"]),
    ("u32", "x: u32", "firstTrailingBit(x)", &["0u", "8u", "0x80000000u"]),
    ("i32", "x: i32", "abs(x) * 3 + sign(x)", &["-4i", "0i", "9i"]),
    ("i32", "x: i32", "clamp(x, -3, 5) ^ min(x, 2) | max(x, 7)", &["-4i", "0i", "9i"]),
    ("i32", "x: vec3i", "dot(x, vec3i(2, -3, 4))", &["vec3i(1, 2, 3)", "vec3i(-5, 0, 7)"]),
    ("vec3f", "x: vec3f", "cross(x, vec3f(1, 2, 3))", &["vec3f(4, 5, 6)"]),
    (
        "f32",
        "x: vec3f",
        "length(x) + dot(x, vec3f(1, 2, 3)) + distance(x, vec3f(1))",
        &["vec3f(4, 5, 6)"],
    ),
    ("vec2f", "x: vec2f", "normalize(x)", &["vec2f(3, 4)", "vec2f(-1e-3, 7)"]),
    (
        "vec3f",
        "x: vec3f",
        "round(x) + fract(x) * trunc(x) - ceil(x) / floor(x)",
        &["vec3f(2.5, 3.5, -1.25)"],
    ),
    (
        "f32",
        "x: f32",
        "pow(abs(x), 2.5) + exp(x) - exp2(x) + log(abs(x)) * log2(abs(x))",
        &["1.75f", "-0.3f"],
    ),
    ("f32", "x: f32", "sin(x) + cos(x) * tan(x) - atan(x)", &["1.75f", "-0.3f"]),
    ("f32", "x: f32", "sinh(x) + cosh(x) * tanh(x) - asinh(x)", &["1.75f", "-0.3f"]),
    ("f32", "x: f32", "asin(x) + acos(x) * atanh(x) + acosh(x + 2)", &["0.75f", "-0.3f"]),
    (
        "f32",
        "x: f32",
        "saturate(x) + step(0.5, x) + sign(x) + inverseSqrt(abs(x)) - sqrt(abs(x))",
        &["0.75f", "-0.3f", "4f"],
    ),
    ("f32", "x: f32", "degrees(x) - radians(x) + fma(x, 2, 3) + x % 0.7", &["0.75f", "-4.3f"]),
    ("i32", "x: f32", "i32(x) + i32(u32(abs(x)))", &["2.75f", "-4.3f"]),
    (
        "vec2<bool>",
        "x: vec2f",
        "!(x < vec2f(1)) & (x != vec2f(3))",
        &["vec2f(0, 3)", "vec2f(2, 1)"],
    ),
    ("i32", "x: i32", "(x << 3u) - (x >> 1u) * (x % 5) / 3", &["-17i", "1000i"]),
];

pub fn tests() -> Vec<Trial> {
    CASES
        .iter()
        .map(|case| Trial::test(format!("eval/constants/{}", case.2), || check(case)))
        .collect()
}

fn check(
    (ty, parameters, expression, arguments): &(&str, &str, &str, &[&str]),
) -> Result<(), Failed> {
    for argument in *arguments {
        let text = format!(
            "const x = {argument};\nconst WANTED: {ty} = {expression};\nfn wanted() -> {ty} {{ return WANTED; }}\n\
             fn inner({parameters}) -> {ty} {{ return {expression}; }}\nfn found() -> {ty} {{ return inner({argument}); }}"
        );
        let program = match program(&text) {
            Ok(program) => program,
            Err(error) => {
                return Err(format!("{text}\n{}", error.message().unwrap_or_default()).into());
            }
        };
        let wanted = program.function("wanted").ok_or("wanted")?;
        let found = program.function("found").ok_or("found")?;
        let mut machine = Machine::<f64>::new(&program)?;
        let wanted = machine.call(wanted, &[])?.to_vec();
        near(program.signature(found).ok_or("found")?, machine.call(found, &[])?, &wanted, 2e-6)?;
    }
    Ok(())
}

//! The evaluator's machine: coverage, places of findings, error bounds, GLSL, and calls that it
//! refuses.

use super::program;
use lamplight_bundle::{Language, Stage};
use lamplight_compose::Composed;
use lamplight_eval::{Bounded, Branch, FindingKind, Machine, Number, Program};
use lamplight_testing::random::Random;
use lamplight_validate::{Validated, validate};
use libtest_mimic::{Failed, Trial};

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("eval/machine/coverage", coverage),
        Trial::test("eval/machine/places", places),
        Trial::test("eval/machine/bounds", bounds),
        Trial::test("eval/machine/powers_near_zero", powers_near_zero),
        Trial::test("eval/machine/glsl", glsl),
        Trial::test("eval/machine/refusals", refusals),
        Trial::test("eval/machine/loop_trips", loop_trips),
    ]
}

/// Each branch counts how often it was taken, and has its place in the text.
fn coverage() -> Result<(), Failed> {
    let text = "fn f(x: f32) -> f32 {\n if x > 0.0 {\n return 1.0;\n } else {\n return 2.0;\n }\n }\nfn g() {}";
    let program = program(text)?;
    let mut machine = Machine::<f64>::new(&program)?;
    let f = program.function("f").ok_or("f")?;
    let reached = |machine: &Machine<f64>| -> Vec<(Branch, u64)> {
        let points =
            program.points().iter().zip(machine.hits()).filter(|(point, _)| point.function == f);
        points.map(|(point, hits)| (point.branch, *hits)).collect()
    };
    machine.call(f, &[1.0])?;
    machine.call(f, &[2.0])?;
    assert_eq!(
        reached(&machine)[..3],
        [(Branch::Entry, 2), (Branch::Accept, 2), (Branch::Reject, 0)]
    );
    machine.call(f, &[-1.0])?;
    assert_eq!(
        reached(&machine)[..3],
        [(Branch::Entry, 3), (Branch::Accept, 2), (Branch::Reject, 1)]
    );
    let accept =
        program.points().iter().find(|point| point.branch == Branch::Accept).ok_or("accept")?;
    assert_eq!(&text[accept.span.to_range().ok_or("span")?], "return 1.0;");
    machine.forget();
    assert!(machine.hits().iter().all(|hits| *hits == 0), "`forget` left {:?}", machine.hits());
    Ok(())
}

/// The sanitizer finds nothing until it is turned on, and then gives each finding once, with its
/// place and how often it happened.
fn places() -> Result<(), Failed> {
    let text = "fn f(x: f32) -> f32 { let y = x + 1.0; return 1.0 / (y - 1.0) + sqrt(y - 2.0); }";
    let program = program(text)?;
    let mut machine = Machine::<f64>::new(&program)?;
    let f = program.function("f").ok_or("f")?;
    machine.call(f, &[0.0])?;
    assert!(machine.findings().is_empty(), "the sanitizer is off: {:?}", machine.findings());
    machine.sanitize(true);
    machine.call(f, &[0.0])?;
    machine.call(f, &[0.0])?;
    let found: Vec<_> = machine
        .findings()
        .iter()
        .map(|finding| (finding.kind, &text[finding.span.to_range().unwrap()], finding.count))
        .collect();
    // naga gives a call of a built-in the place of its name.
    assert_eq!(
        found,
        [(FindingKind::DivisionByZero, "1.0 / (y - 1.0)", 2), (FindingKind::Domain, "sqrt", 2)]
    );
    Ok(())
}

/// The bound of `pow` is the one that the specification allows, worked out by hand from its formula.
/// Results without an error have the bound zero.
fn bounds() -> Result<(), Failed> {
    let program = program(
        "fn f(x: f32, s: f32) -> f32 { return pow(x, s); }\nfn g(a: f32, b: f32) -> f32 { return a + b; }",
    )?;
    let mut machine = Machine::<Bounded>::new(&program)?;
    let f = program.function("f").ok_or("f")?;
    let mut relative = |x: f64, s: f64| -> Result<f64, Failed> {
        let result = machine.call(f, &[Bounded::from_f64(x), Bounded::from_f64(s)])?[0];
        Ok(result.error() / result.value())
    };
    let unit = 2f64.powi(-23);
    let by_hand = |x: f64, s: f64| {
        let t: f64 = s * x.log2();
        s * std::f64::consts::LN_2 * 2f64.powi(-21)
            + t.abs() * std::f64::consts::LN_2 * unit
            + (3.0 + 2.0 * t.abs()) * unit
    };
    for (x, s) in [(0.99, 32.0), (0.9999, 4096.0), (0.7, 5.0)] {
        let found = relative(x, s)?;
        assert!(
            (found / by_hand(x, s) - 1.0).abs() < 2e-3,
            "pow({x}, {s}): {found:e}, by hand {:e}",
            by_hand(x, s)
        );
    }
    let large = relative(0.9999, 4096.0)?;
    assert!(large > 1e-3, "pow(0.9999, 4096): the relative bound {large:e} is too small");
    let g = program.function("g").ok_or("g")?;
    let sum = machine.call(g, &[Bounded::from_f64(0.5), Bounded::from_f64(0.25)])?[0];
    assert_eq!((sum.value(), sum.error()), (0.75, 0.0));
    Ok(())
}

/// Powers of bases with small and large errors have a finite bound, and every base within
/// the error gives a power within it, computed as drivers do.
fn powers_near_zero() -> Result<(), Failed> {
    let program = program("fn f(x: f32, s: f32) -> f32 { return pow(x, s); }")?;
    let mut machine = Machine::<Bounded>::new(&program)?;
    let f = program.function("f").ok_or("f")?;
    let mut random = Random(1);
    let mut share = || random.fraction();
    for _ in 0..2000 {
        let base = (-40.0 * share()).exp2();
        let error = base * (18.0 * share() - 16.0).exp2();
        let exponent = 0.05 + 8.0 * share();
        let given = [Bounded::with_error(base, error), Bounded::from_f64(exponent)];
        let bound = machine.call(f, &given)?[0];
        assert!(bound.error().is_finite(), "pow({base:e} +- {error:e}, {exponent})");
        for part in [0.0, 0.001, share(), share(), 0.999, 1.0] {
            let least = (base - error).max(0.0);
            let x = (least + (base + error - least) * part) as f32;
            let found = f64::from((exponent as f32 * x.log2()).exp2());
            assert!(
                (found - bound.value()).abs() <= bound.error(),
                "pow({x:e}, {exponent}) is {found:e}, {:e} +- {:e}",
                bound.value(),
                bound.error()
            );
        }
    }
    Ok(())
}

/// A GLSL shader runs: functions, `inout` parameters, and `main` once its uniform is bound.
fn glsl() -> Result<(), Failed> {
    let text = "#version 450
        layout(set = 0, binding = 0) uniform Block { vec4 tint; } block;
        layout(location = 0) in vec2 uv;
        layout(location = 0) out vec4 color;
        void twice(inout float x) { x *= 2.0; }
        float shade(vec3 n, vec3 l) {
            float d = max(dot(n, l), 0.0);
            twice(d);
            return mod(d, 0.75) + inverse(mat2(2.0, 0.0, 0.0, 4.0))[1][1];
        }
        void main() { color = block.tint * shade(vec3(0, 0, 1), vec3(uv, 0.5)); }";
    let composed = Composed::of_text(Language::Glsl, Some(Stage::Fragment), text.to_owned());
    let Validated { module, info, portable: _ } =
        validate(&composed).map_err(|errors| format!("{errors:?}"))?;
    let program = Program::new(&module, &info)?;
    let mut machine = Machine::<f64>::new(&program)?;
    let shade = program.function("shade").ok_or("shade")?;
    assert_eq!(machine.call(shade, &[0.0, 0.0, 1.0, 0.0, 0.0, 0.5])?, &[0.5]);
    let (id, _) =
        program.functions().filter(|(_, function)| function.name == "main").last().ok_or("main")?;
    let unbound =
        machine.call(id, &[0.0, 0.0]).map(<[f64]>::to_vec).map_err(|error| error.code.name);
    assert_eq!(unbound, Err("eval-unbound"));
    let bytes = [1f32, 2.0, 3.0, 4.0].iter().flat_map(|value| value.to_le_bytes()).collect();
    machine.bind(lamplight_eval::Resources {
        buffers: [((0, 0), bytes)].into(),
        ..Default::default()
    })?;
    assert_eq!(machine.call(id, &[0.0, 0.0])?, &[0.5, 1.0, 1.5, 2.0]);
    Ok(())
}

/// Calls with the wrong number of arguments, without a resource that is read, or with arrays that
/// are too large each give an error and no panic.
fn refusals() -> Result<(), Failed> {
    let program = program(
        "@group(0) @binding(0) var<uniform> u: vec4f;
        fn f(x: f32) -> f32 { return x; }
        fn reads() -> f32 { return u.x; }
        fn calls() -> f32 { return reads(); }
        fn huge(i: u32) -> f32 { var a: array<array<f32, 65536>, 4096>; return a[i][i]; }
        fn unused(a: ptr<function, array<f32, 16777216>>) -> f32 { return (*a)[16777215]; }",
    )?;
    let mut machine = Machine::<f64>::new(&program)?;
    let mut code = |name: &str, arguments: &[f64]| {
        machine
            .call(program.function(name).unwrap(), arguments)
            .map_err(|error| error.code.name)
            .err()
    };
    assert_eq!(code("f", &[1.0]), None);
    assert_eq!(code("f", &[]), Some("eval-arguments"));
    assert_eq!(code("f", &[1.0, 2.0]), Some("eval-arguments"));
    assert_eq!(code("reads", &[]), Some("eval-unbound"));
    assert_eq!(code("calls", &[]), Some("eval-unbound"));
    assert_eq!(code("huge", &[0.0]), Some("eval-too-large"));
    assert_eq!(code("unused", &[]), Some("eval-too-large"));
    let short =
        lamplight_eval::Resources { buffers: [((0, 0), vec![0; 12])].into(), ..Default::default() };
    machine.bind(short)?;
    assert_eq!(
        machine
            .call(program.function("reads").unwrap(), &[])
            .map_err(|error| error.code.name)
            .err(),
        Some("eval-unbound")
    );
    Ok(())
}

/// The trips of loops are counted, and a call that exceeds the limit is stopped. The next call is
/// not affected.
fn loop_trips() -> Result<(), Failed> {
    let program = program(
        "fn f(n: i32) -> i32 { var s = 0; for (var i = 0; i < n; i++) { for (var j = 0; j < 3; j++) { s++; } } return s; }",
    )?;
    let mut machine = Machine::<f32>::new(&program)?;
    let f = program.function("f").ok_or("f")?;
    let mut result = Vec::new();
    machine.call_words(f, &[5], &mut result)?;
    // The outer loop has five trips and the one that ends it. Each of the five inner loops has four.
    assert_eq!((result.as_slice(), machine.trips()), ([15].as_slice(), 26));
    machine.loop_limit = 20;
    let stopped = machine.call_words(f, &[5], &mut result).map_err(|error| error.code.name);
    assert_eq!(stopped, Err("eval-loop-limit"));
    machine.call_words(f, &[2], &mut result)?;
    assert_eq!(result, [6]);
    Ok(())
}

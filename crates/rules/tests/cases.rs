//! Small texts, each of which breaks one rule, and its neighbour that breaks none. Tint gives the
//! same verdicts.

use lamplight_rules::Rule;
use libtest_mimic::{Failed, Trial};

use crate::errors;
use crate::programs::program;
use crate::random::Random;

const MODULE: &str = "
@group(0) @binding(0) var t: texture_2d<f32>;
@group(0) @binding(1) var s: sampler;
@group(0) @binding(2) var<uniform> same: vec4i;
@group(0) @binding(3) var<storage, read_write> changing: array<i32, 8>;
var<workgroup> own: i32;
fn two(x: ptr<function, i32>, y: i32, p: vec4f) { if *x > 0 { _ = dpdx(p); } }
fn set(x: ptr<function, i32>, y: i32) -> i32 { *x = y; return 0; }
";

/// The body of a fragment or compute shader, the rule that it breaks, and what must be at the place.
const FRAGMENT: &[(&str, Option<(Rule, &str)>)] = &[
    ("if p.x > 1.0 { _ = dpdx(p); }", Some((Rule::Derivative, "dpdx(p)"))),
    ("if same.x > 1 { _ = dpdx(p); }", None),
    ("@diagnostic(off, derivative_uniformity) if p.x > 1.0 { _ = dpdx(p); }", None),
    ("if p.x > 1.0 { @diagnostic(off, derivative_uniformity) { _ = dpdx(p); } }", None),
    ("if p.x > 1.0 { return; } _ = fwidth(p);", Some((Rule::Derivative, "fwidth(p)"))),
    ("if p.x > 1.0 { discard; } _ = fwidth(p);", None),
    (
        "while same.x > 0 { if p.x > 1.0 { return; } break; } _ = dpdx(p);",
        Some((Rule::Derivative, "dpdx(p)")),
    ),
    ("while same.x > 0 { if same.y > 1 { return; } break; } _ = dpdx(p);", None),
    (
        "for (var i = 0; i < 2; i++) { if p.x > 1.0 { return; } break; } _ = dpdx(p);",
        Some((Rule::Derivative, "dpdx(p)")),
    ),
    (
        "loop { var i = 0; if same.x > 0 { i = i32(p.x); continue; } i = 0; \
         continuing { if i > 0 { _ = dpdx(p); } break if same.y > 0; } }",
        Some((Rule::Derivative, "dpdx(p)")),
    ),
    (
        "loop { var i = 0; if same.x > 0 { i = same.z; continue; } i = 0; \
         continuing { if i > 0 { _ = dpdx(p); } break if same.y > 0; } }",
        None,
    ),
    ("var x = same.x; two(&x, set(&x, i32(p.x)), p);", Some((Rule::Derivative, "dpdx(p)"))),
    ("var x = same.x; two(&x, set(&x, same.y), p);", None),
    (
        "@diagnostic(off, derivative_uniformity.other) if p.x > 1.0 { _ = dpdx(p); }",
        Some((Rule::Derivative, "dpdx(p)")),
    ),
    ("if p.x > 1.0 { loop { loop { } } }", Some((Rule::Behaviour, "loop { loop { } }"))),
    ("if p.x > 1.0 { _ = textureSampleLevel(t, s, p.xy, 0.0); }", None),
    (
        "loop { _ = textureSample(t, s, p.xy); continuing { break if p.x == 0.0; } }",
        Some((Rule::Derivative, "textureSample(t, s, p.xy)")),
    ),
    ("var i = 0; if p.x > 1.0 { i = 1; } i = 2; if i == 2 { _ = dpdx(p); }", None),
    ("let a = same.x & 1 == 1;", Some((Rule::Precedence, "same.x & 1 == 1"))),
    ("let a = (same.x & 1) == 1;", None),
    ("let a = true && false || true;", Some((Rule::Precedence, "true && false || true"))),
    ("let a = 1u * 2u << 1u;", Some((Rule::Precedence, "1u * 2u << 1u"))),
    ("let a = 1u << 2u * 1u;", Some((Rule::Precedence, "1u << 2u * 1u"))),
    ("loop { }", Some((Rule::Behaviour, "loop { }"))),
    ("for (;;) { }", Some((Rule::Behaviour, "for (;;) { }"))),
    ("loop { return; }", None),
    (
        "let one = 1; switch same.x { case 0, one + 1: { } default: { } }",
        Some((Rule::Constant, "one")),
    ),
    ("const one = 1; switch same.x { case 0, one + 1: { } default: { } }", None),
    (
        "loop { if p.x > 0.0 { continue; } let end = true; continuing { break if end; } }",
        Some((Rule::Behaviour, "continue;")),
    ),
    ("let a = 4294967295;", Some((Rule::Constant, "4294967295"))),
    ("let a = 4294967295u;", None),
    ("let a = (-2147483647 - 1) - 7;", Some((Rule::Constant, "(-2147483647 - 1) - 7"))),
    ("const big = 65536 * 65536; var a = big;", Some((Rule::Constant, "big"))),
    ("let a = vec2(1, 3000000000);", Some((Rule::Constant, "vec2(1, 3000000000)"))),
    ("const big = 65536 * 65536; let a = f32(big); let b: f32 = big;", None),
    ("let a = 65535 * 32768;", None),
    ("let a = clamp(p.x, 3.0, 1.0);", Some((Rule::Constant, "clamp(p.x, 3.0, 1.0)"))),
    ("let a = clamp(p.x, 1.0, 1.0);", None),
    ("const a = false && 1;", Some((Rule::Constant, "false && 1"))),
    ("let a = true || same.x == 1;", None),
    (
        "const a = true || all(vec2f(1) == vec3f(1));",
        Some((Rule::Constant, "vec2f(1) == vec3f(1)")),
    ),
    ("let a = inverseSqrt(-2.0);", Some((Rule::Constant, "inverseSqrt(-2.0)"))),
    (
        "_ = textureSample(t, s, p.xy, vec2i(8, 0));",
        Some((Rule::Constant, "textureSample(t, s, p.xy, vec2i(8, 0))")),
    ),
    ("_ = textureSample(t, s, p.xy, vec2i(7, -8));", None),
];

const COMPUTE: &[(&str, Option<(Rule, &str)>)] = &[
    ("if i < 32 { workgroupBarrier(); }", Some((Rule::Barrier, "workgroupBarrier()"))),
    ("if g.x < 32 { workgroupBarrier(); }", None),
    ("if own == 1 { storageBarrier(); }", Some((Rule::Barrier, "storageBarrier()"))),
    ("if workgroupUniformLoad(&own) == 1 { workgroupBarrier(); }", None),
    ("if changing[0] == 1 { workgroupBarrier(); }", Some((Rule::Barrier, "workgroupBarrier()"))),
    (
        "@diagnostic(off, derivative_uniformity) if i < 3 { workgroupBarrier(); }",
        Some((Rule::Barrier, "workgroupBarrier()")),
    ),
];

/// Whole texts.
const TEXTS: &[(&str, Option<Rule>)] = &[
    ("fn f(x: i32) -> i32 { if x > 0 { return 1; } }", Some(Rule::Behaviour)),
    ("fn f(x: i32) -> i32 { loop { return 1; } }", None),
    ("var<private> a: atomic<i32>;", Some(Rule::Memory)),
    ("var<workgroup> a: atomic<u64>;", Some(Rule::Memory)),
    ("@early_depth_test(force) @fragment fn f() { }", Some(Rule::Attribute)),
    ("@fragment fn f() { _ = quadBroadcast(1, 1u); }", Some(Rule::Grammar)),
    ("enable subgroups;\n@fragment fn f() { _ = quadBroadcast(1, 1u); }", None),
    ("@group(0) @binding(0) var<storage> a: atomic<i32>;", Some(Rule::Memory)),
    ("var<workgroup> a: array<atomic<u32>, 4>;", None),
    ("@workgroup_size(1) fn f() { }", Some(Rule::Attribute)),
    ("@compute @workgroup_size(1i, 1u) fn f() { }", Some(Rule::Attribute)),
    ("@id(1) const a = 1;", Some(Rule::Attribute)),
    ("var<workgroup> a: atomic<u32>;\nfn f() { a = 1u; }", Some(Rule::Memory)),
    ("var<workgroup> a: atomic<u32>;\nfn f() { atomicStore(&(a), 1u); }", None),
    (
        "struct S { a: atomic<u32> }\nvar<workgroup> s: S;\nfn f() { let b = (s); }",
        Some(Rule::Memory),
    ),
    ("struct S { a: atomic<u32> }\nvar<workgroup> s: S;\nfn f() { s.a = 1u; }", Some(Rule::Memory)),
    (
        "struct S { a: atomic<u32>, b: u32 }\nvar<workgroup> s: array<S, 2>;\n\
         fn f() { s[1].b = 1u; let c = &s[0].a; atomicStore(c, s[0].b); }",
        None,
    ),
    (
        "struct S { a: atomic<u32> }\nfn f(s: ptr<workgroup, array<S, 2>>) { (*s)[0].a = 1u; }",
        Some(Rule::Memory),
    ),
    (
        "struct S { a: atomic<u32> }\n\
         fn f(s: ptr<workgroup, S>) -> u32 { return atomicLoad(&(*s).a) + atomicLoad(&s.a); }",
        None,
    ),
    ("var<workgroup> a: i32;\n@fragment fn f() { _ = a; }", Some(Rule::Memory)),
    (
        "@group(0) @binding(4) var<storage, read_write> a: i32;\n\
         @vertex fn f() -> @builtin(position) vec4f { let b = a; let a = 1; return vec4f(); }",
        Some(Rule::Memory),
    ),
    (
        "@group(0) @binding(4) var<storage, read_write> a: i32;\n\
         @vertex fn f() -> @builtin(position) vec4f { let a = 1; _ = a; return vec4f(); }",
        None,
    ),
    ("const a = 0.0;\nfn f(x: f32) -> f32 { let a = x; return inverseSqrt(a); }", None),
    ("const a = 0.0;\nfn f(x: f32) -> f32 { return inverseSqrt(a); }", Some(Rule::Constant)),
    (
        "const a = 1.0;\nfn f() -> f32 { const a = 0.0; return inverseSqrt(a); }",
        Some(Rule::Constant),
    ),
    ("struct A { x: array<vec4f, 2> }\nvar<immediate> a: A;", Some(Rule::Memory)),
    ("struct A { x: mat4x4f }\nvar<immediate> a: A;", None),
    (
        "const a: i32 = 4;\nconst b: u32 = 2;\n@compute @workgroup_size(a, b) fn f() { }",
        Some(Rule::Attribute),
    ),
    ("override a = 4;\n@compute @workgroup_size(a, 2u) fn f() { }", Some(Rule::Attribute)),
    ("override a: u32;\n@compute @workgroup_size(a * 2, 2i) fn f() { }", Some(Rule::Attribute)),
    ("override a: u32;\n@compute @workgroup_size(a, 2, a + 1) fn f() { }", None),
    ("const a = 4;\n@compute @workgroup_size(a, 2u) fn f() { }", None),
    ("struct A { @align(32) x: vec3f }\nstruct B { @align(16) a: A }", Some(Rule::Attribute)),
    ("struct A { @align(32) x: vec3f }\nstruct B { @align(64) a: A }", None),
    (
        "@group(0) @binding(0) var<storage, read_write> a: i32;\n\
         @vertex fn f() -> @builtin(position) vec4f { a = 1; return vec4f(); }",
        Some(Rule::Memory),
    ),
];

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("rules::fragments", || {
            bodies(FRAGMENT, "@fragment fn main(@builtin(position) p: vec4f)")
        }),
        Trial::test("rules::computes", || {
            bodies(
                COMPUTE,
                "@compute @workgroup_size(64) fn main(@builtin(local_invocation_index) i: u32, \
                 @builtin(workgroup_id) g: vec3u)",
            )
        }),
        Trial::test("rules::texts", texts),
        Trial::test("rules::high_locations", high_locations),
        Trial::test("rules::deep_texts", deep_texts),
        Trial::test("rules::large_functions", large_functions),
        Trial::test("rules::damaged_texts", damaged_texts),
    ]
}

fn bodies(cases: &[(&str, Option<(Rule, &str)>)], head: &str) -> Result<(), Failed> {
    for (body, expected) in cases {
        let text = format!("{MODULE}{head} {{ {body} }}");
        let found = errors(&text);
        let first = found.first().map(|problem| (problem.rule, &text[problem.place.range()]));
        if first != *expected {
            return Err(format!("`{body}` gives {first:?}").into());
        }
    }
    Ok(())
}

fn texts() -> Result<(), Failed> {
    for (text, expected) in TEXTS {
        let found = errors(text).first().map(|problem| problem.rule);
        if found != *expected {
            return Err(format!("`{text}` gives {found:?}").into());
        }
    }
    Ok(())
}

/// Locations that WebGPU gives on request only, each with whether it is warned of.
const LOCATIONS: &[(&str, bool)] = &[
    ("@fragment fn f(@location(15) a: f32) -> @location(7) vec4f { return vec4f(a); }", false),
    ("@fragment fn f(@location(16) a: f32) -> @location(7) vec4f { return vec4f(a); }", true),
    ("@fragment fn f() -> @location(8) vec4f { return vec4f(); }", true),
    ("struct S { @location(40u) a: f32 }\n@fragment fn f(s: S) { _ = s.a; }", true),
    ("@vertex fn f(@location(8) a: vec4f) -> @builtin(position) vec4f { return a; }", false),
];

fn high_locations() -> Result<(), Failed> {
    for (text, is_warned) in LOCATIONS {
        let found = lamplight_rules::check(text);
        let is_warning = |one: &lamplight_rules::Problem| {
            one.rule == Rule::Attribute && one.severity == lamplight_rules::Severity::Warning
        };
        if found.iter().any(is_warning) != *is_warned || found.len() != usize::from(*is_warned) {
            return Err(format!("`{text}` gives {found:?}").into());
        }
    }
    Ok(())
}

/// What nests deeper than the analysis goes is told, whatever nests.
fn deep_texts() -> Result<(), Failed> {
    let many = |text: &str| text.repeat(5000);
    let deep = [
        format!("const a = {}1{};", many("("), many(")")),
        format!("const a = {}1;", many("-")),
        format!("const a = 1{};", many(" + 1")),
        format!("fn f() {{ {}{} }}", many("{"), many("}")),
        format!("fn f() {{ if true {{ }} {} }}", many("else if true { } ")),
        format!("alias a = {}i32{};", many("array<"), many(">")),
    ];
    for text in deep {
        let found = errors(&text).first().map(|problem| problem.rule);
        if !matches!(found, Some(Rule::Depth | Rule::Grammar)) {
            return Err(format!("{} gives {found:?}", &text[..40]).into());
        }
    }
    Ok(())
}

/// The effort depends on what loops and branches name, and not on all variables around them. Where
/// that is much, the analysis ends with a message.
fn large_functions() -> Result<(), Failed> {
    let numbered =
        |text: &str| -> String { (0..4000).map(|at| text.replace('#', &at.to_string())).collect() };
    let variables = numbered("var v# = 0; ");
    let loops = numbered("for (; v# < 2; v#++) { if v# > 1 { break; } } ");
    let text = format!("fn f() {{ {variables} {loops} }}");
    let found = errors(&text);
    if !found.is_empty() {
        return Err(format!("loops give {found:?}").into());
    }
    let (uses, breaks) = (numbered("v# = v0; "), numbered("if v# > 1 { break; } "));
    let text = format!("fn f() {{ {variables} loop {{ {uses} {breaks} }} }}");
    let found: Vec<Rule> = errors(&text).iter().map(|problem| problem.rule).collect();
    match found == [Rule::Depth] {
        true => Ok(()),
        false => Err(format!("breaks give {found:?}").into()),
    }
}

/// Texts that are no programs any more get an answer too. naga has not read the text by then.
fn damaged_texts() -> Result<(), Failed> {
    let mut random = Random(7);
    for seed in 0..400 {
        let mut text = program(seed) + " \u{e9} @diagnostic(off, é) { }";
        for _ in 0..1 + random.below(8) {
            let (from, length) = (random.below(text.len()), random.below(12));
            let from = text.floor_char_boundary(from);
            let to = text.floor_char_boundary((from + length).min(text.len()));
            let moved = text[from..to.max(from)].to_owned();
            text.replace_range(from..to.max(from), "");
            if random.chance(50) {
                let at = text.floor_char_boundary(random.below(text.len()));
                text.insert_str(at, &moved);
            }
        }
        // What it finds does not matter: it must not panic.
        let _ = errors(&text);
        let _ = lamplight_rules::without_unread(&text);
    }
    Ok(())
}

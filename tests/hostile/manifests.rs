//! Manifests that ask for too much, and a dependency that claims files outside of its folder.

use super::Hostile;

type Files = Vec<(&'static str, String)>;

const SHADER: &str = "@fragment fn m() -> @location(0) vec4f { return vec4f(); }\n";

/// A program with `axes` axes of `values` values each, and constraints.
fn program(axes: usize, values: usize, constraints: impl Iterator<Item = String>) -> Files {
    let values: Vec<String> = (0..values).map(|value| value.to_string()).collect();
    let axis = |axis| format!("a{axis} = {{ values = [{}] }}\n", values.join(","));
    let axes: String = (0..axes).map(axis).collect();
    let constraint = |text: String| format!("[[program.p.constraint]]\nrequire = \"{text}\"\n");
    let constraints: String = constraints.map(constraint).collect();
    let head = "[program.p]\nwesl = \"s.wesl\"\n[program.p.axis]";
    let manifest = format!("{head}\n{axes}{constraints}");
    vec![("lamplight.toml", manifest), ("s.wesl", SHADER.to_owned())]
}

/// Constraints that each connect three of many axes, so that no part of the axes can be counted by
/// itself.
fn entangled(count: usize) -> impl Iterator<Item = String> {
    (0..count).map(|i| {
        let (a, b, c) = (i % 120, (i * 7 + 3) % 120, (i * 13 + 1) % 120);
        format!("a{a} != 1 || a{b} != 1 || a{c} == 0")
    })
}

/// Constraints of which each alone takes more steps to count than are allowed. Together they are
/// simple, since the last of them fix most of the axes.
fn costly_in_turn(count: usize) -> impl Iterator<Item = String> {
    let pair = |i: usize| format!("a{i} == 1 && a{} == 1", i + 60);
    let costly = move |skipped: usize| {
        let pairs: Vec<String> = (0..60).filter(|i| *i != skipped % 60).map(pair).collect();
        format!("a0 == 0 || {}", pairs.join(" || "))
    };
    (0..count).map(costly).chain((0..110).map(|i| format!("a{i} == 0")))
}

/// A dependency that declares a root outside of its own folder.
fn foreign_root() -> Files {
    let declared = |name: &str, rest: &str| {
        format!("[package]\nname = \"{name}\"\nedition = \"unstable_2025\"\n{rest}")
    };
    let dependencies = "root = \"src\"\n[dependencies]\nevil = { path = \"evil\" }\n";
    vec![
        ("wesl.toml", declared("own", dependencies)),
        ("src/m.wesl", "import evil::hosts::f;\nfn g() { f(); }\n".to_owned()),
        ("evil/wesl.toml", declared("evil", "root = \"/etc\"\n")),
    ]
}

const fn gen_of(name: &'static str, words: &'static str, files: fn() -> Files) -> Hostile {
    Hostile { name, files, arguments: "gen --no-cache -o out", code: 1, words }
}

const fn only_of(name: &'static str, words: &'static str, files: fn() -> Files) -> Hostile {
    let arguments = "gen --no-cache -o out --only a0=1";
    Hostile { name, files, arguments, code: 1, words }
}

pub const CASES: &[Hostile] = &[
    gen_of("many_constraints", "may have 4096 constraints", || program(120, 60, entangled(50_000))),
    gen_of("one_constraint_many_times", "may have 4096 constraints", || {
        program(100, 2, (0..20_000).map(|_| "a1 != 1 || a2 != 1".to_owned()))
    }),
    gen_of("entangled_constraints", "too complex", || program(120, 2, entangled(3000))),
    Hostile {
        name: "constraints_that_are_costly_in_turn",
        files: || program(120, 2, costly_in_turn(400)),
        arguments: "variants --manifest lamplight.toml",
        code: 0,
        words: "1,024",
    },
    gen_of("long_constraint", "its limit is 1,000,000", || {
        let terms: Vec<String> = (0..20_000).map(|i| format!("a{} == 1", i % 20)).collect();
        program(20, 2, [terms.join(" || ")].into_iter())
    }),
    only_of("only_of_many_axes", "its limit is 1,000,000", || program(120, 100, [].into_iter())),
    only_of("only_of_entangled_axes", "too complex", || program(120, 2, entangled(3000))),
    Hostile {
        name: "package_with_a_root_elsewhere",
        files: foreign_root,
        arguments: "compose src/m.wesl",
        code: 1,
        words: "is not a path below the file's folder",
    },
];

//! Case files that ask for too much, or for nothing.

use super::Hostile;

const MODULE: &str = "
    fn one(x: f32) -> f32 { return x; }
    fn four(v: vec4f) -> f32 { return v.x; }
    fn pair(a: vec3f, b: vec2f) -> f32 { return a.x + b.x; }
    fn three(a: vec3f, b: vec3f) -> f32 { return a.x + b.x; }
    fn matrix(m: mat4x4f) -> f32 { return m[0].x; }
    fn long(x: f32) -> f32 { var s = x; for (var i = 0; i < 200000; i++) { s += x; } return s; }
    fn nothing() -> f32 { return 1.0; }
";

fn over(case: &str) -> Vec<(&'static str, String)> {
    vec![("m.wesl", MODULE.to_owned()), ("m.toml", format!("[[case]]\n{case}\n"))]
}

/// Functions that each call the next one twice: 2^60 calls without a loop.
fn call_tree() -> Vec<(&'static str, String)> {
    let mut module = "fn g0(x: f32) -> f32 { return x + 1.0; }\n".to_owned();
    for level in 1..=60 {
        let below = level - 1;
        module +=
            &format!("fn g{level}(x: f32) -> f32 {{ return g{below}(x) + g{below}(x + 1.0); }}\n");
    }
    let cases = "[[case]]\nfunction = \"g60\"\ninputs = { x = 1.0 }\n";
    vec![("m.wesl", module), ("m.toml", cases.to_owned())]
}

const fn case(
    name: &'static str,
    words: &'static str,
    files: fn() -> Vec<(&'static str, String)>,
) -> Hostile {
    Hostile { name, files, arguments: "check m.toml", code: 1, words }
}

pub const CASES: &[Hostile] = &[
    case("case_without_values", "the domain has no values", || {
        over("function = \"one\"\ninputs = { x = { values = [] } }")
    }),
    case("case_empty_union", "the domain has no values", || {
        over("function = \"one\"\ninputs = { x = [] }")
    }),
    case("case_empty_zip", "the domain has no values", || {
        over("function = \"pair\"\nmode = \"zip\"\ninputs = { a = { unit = 4 }, b = [] }")
    }),
    case("case_empty_table", "no row is left", || over("function = \"one\"\nrows = []")),
    case("case_grid_of_vectors", "multiply to more than", || {
        over("function = \"four\"\ninputs = { v = { grid = [0, 1], count = 1000 } }")
    }),
    case("case_product", "multiply to more than", || {
        over(
            "function = \"pair\"\ninputs = { a = { random = [0, 1], count = 1000000 }, \
             b = { random = [0, 1], count = 1000000 } }",
        )
    }),
    case("case_components", "expected 4 values, found 3", || {
        over("function = \"four\"\ninputs = { v = { values = [[1, 2, 3]] } }")
    }),
    case("case_components_around", "expected 4 values, found 2", || {
        over("function = \"four\"\ninputs = { v = { around = [1, 2], ulps = 1 } }")
    }),
    case("case_components_same", "and `a` has 3", || {
        over("function = \"pair\"\ninputs = { a = { unit = 3 }, b = { same = \"a\" } }")
    }),
    case("formula_of_signs", "signs and operands", || {
        let signs = "-".repeat(20_000);
        over(&format!("function = \"one\"\nformula = \"{signs}x\"\ninputs = {{ x = 1.0 }}"))
    }),
    case("formula_of_sums", "signs and operands", || {
        let sums = "+1".repeat(20_000);
        over(&format!("function = \"one\"\nformula = \"x{sums}\"\ninputs = {{ x = 1.0 }}"))
    }),
    case("case_zip_made_anew_for_each_row", "more than 2147483648", || {
        over(
            "function = \"three\"\nmode = \"zip\"\ninputs = { a = { unit = 1000000 }, \
             b = { hemisphere = \"a\", count = 1000000 } }",
        )
    }),
    case("case_laws", "scalars with those of their laws", || {
        let laws = "{ range = [0, 1] }, ".repeat(2000);
        over(&format!(
            "function = \"one\"\ninputs = {{ x = {{ random = [0, 1], count = 1000000 }} }}\n\
             laws = [{laws}]"
        ))
    }),
    case("case_tolerances", "more than 2147483648", || {
        let terms = "{ abs = 1 }, ".repeat(4000);
        over(&format!(
            "function = \"one\"\ninputs = {{ x = {{ random = [0, 1], count = 1000000 }} }}\n\
             tolerance = [{terms}]"
        ))
    }),
    case("case_direction_of_many_dimensions", "a direction has 1 to 4 values", || {
        over("function = \"matrix\"\ninputs = { m = { unit = 1000 } }")
    }),
    case("cases", "a file may have 4096 cases", || {
        over(&"function = \"one\"\ninputs = { x = 1 }\n[[case]]\n".repeat(5000))
    }),
    case("cases_with_many_rows", "rows together", || {
        let one = "function = \"one\"\ninputs = { x = { random = [0, 1], count = 400000 } }";
        over(&[one, one, one].join("\n[[case]]\n"))
    }),
    case("case_calls", "all calls together take more than", || {
        let short = "function = \"one\"\ninputs = { x = 1 }\n[[case]]\n".repeat(99);
        over(&(short + "function = \"long\"\ninputs = { x = { random = [0, 1], count = 100 } }"))
    }),
    case("call_tree", "takes more than", call_tree),
    Hostile {
        name: "case_without_parameters",
        files: || over("function = \"nothing\"\nformula = \"2\""),
        arguments: "check m.toml",
        code: 3,
        words: "expected [2.0]",
    },
];

//! Shaders that are small and make naga or a driver need much memory or time.

use super::Hostile;

type Files = Vec<(&'static str, String)>;

fn shader(declarations: &str, value: &str) -> Files {
    let main = format!("@fragment fn m() -> @location(0) vec4f {{ return vec4f({value}); }}\n");
    vec![("m.wgsl", format!("{declarations}\n{main}"))]
}

fn repeated(count: usize, one: impl Fn(usize) -> String) -> String {
    (0..count).map(one).collect()
}

/// A shader with the declarations `n0`, `n1` and so on, all of which it uses.
fn summed(count: usize, one: impl Fn(usize) -> String) -> Files {
    let sum = repeated(count, |i| format!("s += n{i};\n"));
    let main = format!(
        "@fragment fn m() -> @location(0) vec4f {{ var s = 0.0;\n{sum}return vec4f(s); }}\n"
    );
    vec![("m.wgsl", repeated(count, one) + &main)]
}

/// Constants that each contain the previous one twice.
fn doubling_constants() -> Files {
    let more = repeated(24, |i| format!("const c{} = array(c{i}, c{i});\n", i + 1));
    let main = format!(
        "@fragment fn m(@location(0) @interpolate(flat) i: i32) -> @location(0) vec4f {{
            let x = c24{}; return vec4f(x[0]);
        }}",
        "[i]".repeat(24)
    );
    vec![("m.wgsl", format!("const c0 = array(1.0f, 2.0f);\n{more}{main}"))]
}

fn doubling_structures() -> Files {
    let more = repeated(25, |i| format!("struct S{} {{ a: S{i}, b: S{i} }}\n", i + 1));
    let path = ".a".repeat(26);
    shader(
        &format!("struct S0 {{ a: vec4f, b: vec4f }}\n{more}var<private> s: S25;"),
        &format!("s{path}.x"),
    )
}

/// Each function passes pointers to both members on, so the last would be made for each of many
/// places.
fn doubling_pointers() -> Files {
    const DEPTH: usize = 16;
    let types = repeated(DEPTH, |i| format!("struct S{} {{ a: S{i}, b: S{i} }}\n", i + 1));
    let one = |i| {
        let (next, parts) = (i + 1, format!("f{i}(&(*p).a); f{i}(&(*p).b);"));
        format!("fn f{next}(p: ptr<function, S{next}>) {{ {parts} }}\n")
    };
    let main = format!(
        "struct S0 {{ a: f32, b: f32 }}\nfn f0(p: ptr<function, S0>) {{ (*p).a += 1.0; }}\n\
         {types}{}@fragment fn m() -> @location(0) vec4f {{ var s: S{DEPTH}; f{DEPTH}(&s);\n\
         return vec4f(s{}); }}\n",
        repeated(DEPTH, one),
        ".a".repeat(DEPTH + 1)
    );
    vec![("m.wgsl", main)]
}

fn remainders() -> Files {
    let main = format!(
        "@fragment fn m(@location(0) x: f32) -> @location(0) vec4f {{ return vec4f({}x{}); }}",
        "(x%".repeat(30),
        ")".repeat(30)
    );
    vec![("m.wgsl", main)]
}

const fn compile(name: &'static str, words: &'static str, files: fn() -> Files) -> Hostile {
    Hostile {
        name,
        files,
        arguments: "compile m.wgsl --target glsl450 --target hlsl",
        code: 1,
        words,
    }
}

pub const CASES: &[Hostile] = &[
    compile("private_array", "m.wgsl:1:", || {
        shader("var<private> a: array<f32, 200000000>;", "a[3]")
    }),
    compile("two_private_arrays", "m.wgsl:1:", || {
        shader(
            "var<private> a: array<f32, 200000000>; var<private> b: array<f32, 200000000>;",
            "a[3] + b[4]",
        )
    }),
    compile("nested_arrays", "m.wgsl:1:", || {
        shader("var<private> a: array<array<array<f32, 4000>, 4000>, 4000>;", "a[1][2][3]")
    }),
    compile("constant_array", "m.wgsl:1:", || shader("const a = array<f32, 200000000>();", "a[3]")),
    compile("workgroup_array", "m.wgsl:1:", || {
        vec![("m.wgsl", "var<workgroup> a: array<f32, 200000000>;\n@compute @workgroup_size(1) fn m() { a[1] = 2.0; }".to_owned())]
    }),
    compile("huge_member", "m.wgsl:1:", || {
        shader(
            "struct S { @size(1 << 30) a: f32, b: f32 }\n@group(0) @binding(0) var<uniform> s: S;",
            "s.b",
        )
    }),
    compile("compute_with_inputs", "m.wgsl:1:", || {
        let main = "@compute @workgroup_size(1) fn m(@location(0) x: f32) {}\n";
        vec![("m.wgsl", main.to_owned())]
    }),
    Hostile {
        arguments: "compile m.wgsl --target essl300",
        ..compile("line_textures", "m.wgsl:2:", || {
            let texture = "@group(0) @binding(0) var t: texture_1d<f32>;";
            shader(texture, "f32(textureDimensions(t))")
        })
    },
    compile("overrides", "more than 256 overrides", || {
        summed(300, |i| format!("override n{i}: f32 = 1.0;\n"))
    }),
    compile("constants", "more than 4096 variables, constants", || {
        summed(5000, |i| format!("const n{i} = 1.0f;\n"))
    }),
    compile("variables", "more than 4096 variables, constants", || {
        summed(5000, |i| format!("var<private> n{i}: f32;\n"))
    }),
    compile("entry_points", "more than 128 entry points", || {
        let one = |i| format!("@fragment fn m{i}() -> @location(0) vec4f {{ return vec4f(); }}\n");
        vec![("m.wgsl", repeated(200, one))]
    }),
    compile("statements", "statements and values of cases", || {
        let lets = repeated(9000, |i| format!("let l{i} = x * 2.0;\n"));
        let head = "@fragment fn m(@location(0) x: f32) -> @location(0) vec4f {";
        vec![("m.wgsl", format!("{head}\n{lets}return vec4f(x); }}"))]
    }),
    compile("case_lists", "statements and values of cases", || {
        let list: Vec<String> = (0..9000).map(|i| i.to_string()).collect();
        let head = "@fragment fn m(@location(0) @interpolate(flat) i: i32) -> @location(0) vec4f {";
        let case = format!("case {}: {{ return vec4f(1.0); }}", list.join(", "));
        vec![("m.wgsl", format!("{head} switch i {{\n{case} default: {{ return vec4f(); }} }} }}"))]
    }),
    compile("cases", "statements and values of cases", || {
        let cases = repeated(9000, |i| format!("case {i}: {{ return vec4f(1.0); }}\n"));
        let head = "@fragment fn m(@location(0) @interpolate(flat) i: i32) -> @location(0) vec4f {";
        vec![("m.wgsl", format!("{head} switch i {{\n{cases}default: {{ return vec4f(); }} }} }}"))]
    }),
    compile("doubling_constants", "m.wgsl:", doubling_constants),
    compile("doubling_structures", "m.wgsl:", doubling_structures),
    compile("doubling_pointers", "more than 262144 expressions", doubling_pointers),
    compile("remainders", "m.wgsl:1:", remainders),
];

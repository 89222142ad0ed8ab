//! A generated module tree with the density of imports and conditions of a real engine, in the
//! dialects of each composer. The same number always gives the same text.

use std::fmt::Write as _;

/// Number of modules; 28,000 lines in all.
pub const MODULES: usize = 200;
/// Flags that conditions read.
pub const FLAGS: usize = 32;
/// Root shaders, each with one entry point.
pub const ROOTS: usize = 16;

const FUNCTIONS: usize = 7;

/// How imports and conditions are written.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Dialect {
    Wesl,
    NagaOil,
}

/// Path segments of a module.
pub fn path(module: usize) -> Vec<String> {
    vec![format!("group_{}", letters(module / 40)), format!("part_{}", letters(module / 8 % 5)), format!("unit_{}", letters(module))]
}

/// The text of a module.
pub fn module(module: usize, dialect: Dialect) -> String {
    let mut random = Random::new(module as u64 + 1);
    let imports = imports(module, &mut random);
    let mut text = String::new();
    if dialect == Dialect::NagaOil {
        let _ = writeln!(text, "#define_import_path {}\n", path(module).join("::"));
    }
    for (imported, function) in &imports {
        import(&mut text, *imported, *function, dialect);
    }
    preamble(&mut text, module);
    for function in 0..FUNCTIONS {
        write_function(&mut text, module, function, &imports, &mut random, dialect);
    }
    text
}

/// The text of a root shader.
pub fn root(root: usize, dialect: Dialect) -> String {
    let mut random = Random::new(root as u64 + 7_001);
    let mut text = String::new();
    let used: Vec<(usize, usize)> = (0..6).map(|k| (20 + (root * 11 + k * 29) % (MODULES - 20), random.below(FUNCTIONS))).collect();
    for (imported, function) in &used {
        import(&mut text, *imported, *function, dialect);
    }
    text.push_str("\n@fragment\nfn fs_main(@location(0) normal: vec3<f32>, @location(1) light: vec3<f32>) -> @location(0) vec4<f32> {\n    var sum = 0.0;\n");
    for (imported, function) in &used {
        let _ = writeln!(text, "    sum += {}(normal, light, 2.0);", name(*imported, *function));
    }
    text.push_str("    return vec4<f32>(sum);\n}\n");
    text
}

/// Whether a flag is on in a permutation.
pub fn flag(permutation: usize, flag: usize) -> bool {
    Random::new((permutation * FLAGS + flag) as u64 + 99).below(2) == 1
}

/// A flag's name in a dialect.
pub fn flag_name(flag: usize, dialect: Dialect) -> String {
    let name = format!("flag_{}", letters(flag));
    if dialect == Dialect::Wesl { name } else { name.to_uppercase() }
}

/// Lines of the whole corpus.
pub fn lines(dialect: Dialect) -> usize {
    (0..MODULES).map(|index| module(index, dialect).lines().count()).sum()
}

fn imports(module: usize, random: &mut Random) -> Vec<(usize, usize)> {
    let mut found: Vec<(usize, usize)> =
        (0..module.min(4)).map(|_| (module - 1 - random.below(module.min(24)), random.below(FUNCTIONS))).collect();
    found.sort_unstable();
    found.dedup_by_key(|(imported, _)| *imported);
    found
}

fn import(text: &mut String, module: usize, function: usize, dialect: Dialect) {
    let path = path(module).join("::");
    let name = name(module, function);
    let _ = match dialect {
        Dialect::Wesl => writeln!(text, "import package::{path}::{name};"),
        Dialect::NagaOil => writeln!(text, "#import {path}::{name}"),
    };
}

fn preamble(text: &mut String, module: usize) {
    let unit = letters(module);
    let _ = write!(
        text,
        "\n// Coefficients of unit {unit}: each in [0, 1], without a unit.\nconst GAIN_{unit}: f32 = 0.{module:03}5;\nconst BIAS_{unit}: f32 = 0.25;\n\n\
         /* What one evaluation\n   carries between its steps. */\nstruct State_{unit} {{\n    weight: f32,\n    // The direction so far, unit length.\n    direction: vec3<f32>,\n    taps: array<vec4<f32>, 4>,\n}}\n"
    );
}

fn write_function(text: &mut String, module: usize, function: usize, imports: &[(usize, usize)], random: &mut Random, dialect: Dialect) {
    let unit = letters(module);
    let _ = write!(
        text,
        "\n// A weighted response to light from `l` on a surface with normal `n`.\nfn {}(n: vec3<f32>, l: vec3<f32>, s: f32) -> f32 {{\n    let n_dot_l = max(dot(n, l), 0.0);\n    \
         var state: State_{unit};\n    state.weight = GAIN_{unit} * s;\n    state.direction = normalize(n + l);\n    var sum = BIAS_{unit};\n    for (var i = 0u; i < 4u; i++) {{\n        \
         let w = f32(i) * 0.25 + state.weight;\n        state.taps[i] = vec4<f32>(w, w * w, n_dot_l, 1.0);\n        sum += w * pow(n_dot_l, s + w);\n    }}\n",
        name(module, function)
    );
    if random.below(10) < 7 {
        condition(text, random.below(FLAGS), dialect);
    }
    if let Some((imported, other)) = imports.get(function) {
        let _ = writeln!(text, "    sum += {}(state.direction, l, s * 0.5);", name(*imported, *other));
    }
    text.push_str("    return sum * clamp(dot(state.direction, n), 0.0, 1.0);\n}\n");
}

fn condition(text: &mut String, flag: usize, dialect: Dialect) {
    let flag = flag_name(flag, dialect);
    let _ = match dialect {
        Dialect::Wesl => writeln!(
            text,
            "    @if({flag}) {{\n        sum = sum * 0.5 + state.taps[1].y;\n    }} @else {{\n        sum = sum + 0.125;\n    }}"
        ),
        Dialect::NagaOil => writeln!(
            text,
            "#ifdef {flag}\n    {{\n        sum = sum * 0.5 + state.taps[1].y;\n    }}\n#else\n    {{\n        sum = sum + 0.125;\n    }}\n#endif"
        ),
    };
}

fn name(module: usize, function: usize) -> String {
    format!("respond_{}_{}", letters(module), letters(function))
}

/// Names without digits: naga_oil renames those that end in one.
fn letters(number: usize) -> String {
    let digit = |value: usize| char::from(b'a' + value as u8);
    [digit(number / 26 % 26), digit(number % 26)].iter().collect()
}

/// A small linear congruential generator: only its sequence must stay the same.
struct Random(u64);

impl Random {
    fn new(seed: u64) -> Self {
        let mut random = Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        random.below(2);
        random
    }

    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % bound
    }
}

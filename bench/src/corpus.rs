//! A generated module tree of an engine's shape, in the dialects of each composer. The same
//! number always gives the same text.
//!
//! It resembles Bevy's shaders. There are some 200 modules of 140 lines in layers, each of which
//! imports from four or five others. Eight lines in a hundred are directives, including imports. A
//! root reaches a quarter of the modules.

use std::fmt::Write as _;

/// Number of modules; 28,000 lines in all.
pub const MODULES: usize = LAYERS * PARTS * UNITS;
/// Flags that conditions read.
pub const FLAGS: usize = 32;
/// Root shaders, each with one entry point.
pub const ROOTS: usize = 16;

/// Modules import from layers below their own.
const LAYERS: usize = 10;
/// Parts of the engine. Three of four imports stay within a part.
const PARTS: usize = 4;
/// Modules of one part in one layer.
const UNITS: usize = 5;
const FUNCTIONS: usize = 7;

/// How imports and conditions are written.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Dialect {
    Wesl,
    NagaOil,
}

/// Path segments of a module.
pub fn path(module: usize) -> Vec<String> {
    vec![
        format!("part_{}", letters(part(module))),
        format!("layer_{}", letters(layer(module))),
        format!("unit_{}", letters(module)),
    ]
}

/// The text of a module.
pub fn module(module: usize, dialect: Dialect) -> String {
    let mut random = Random::new(module as u64 + 1);
    let imports = imports(module, &mut random);
    let mut text = String::new();
    if dialect == Dialect::NagaOil {
        let _ = writeln!(text, "#define_import_path {}\n", path(module).join("::"));
    }
    import(&mut text, &imports, &mut random, dialect);
    preamble(&mut text, module, random.below(FLAGS), dialect);
    for function in 0..FUNCTIONS {
        write_function(&mut text, module, function, &imports, &mut random, dialect);
    }
    text
}

/// The text of a root shader.
pub fn root(root: usize, dialect: Dialect) -> String {
    let mut random = Random::new(root as u64 + 7_001);
    let top = (LAYERS - 1) * PARTS * UNITS;
    let used: Vec<Import> = (0..UNITS)
        .map(|unit| Import {
            module: top + root % PARTS * UNITS + unit,
            function: random.below(FUNCTIONS),
            instead: None,
        })
        .collect();
    let mut text = String::new();
    import(&mut text, &used, &mut random, dialect);
    text.push_str("\n@fragment\nfn fs_main(@location(0) normal: vec3<f32>, @location(1) light: vec3<f32>) -> @location(0) vec4<f32> {\n    var sum = 0.0;\n");
    for import in &used {
        let _ = writeln!(text, "    sum += {}(normal, light, 2.0);", import.local());
    }
    text.push_str("    return vec4<f32>(sum);\n}\n");
    text
}

/// A root that imports from every module.
pub fn everything() -> String {
    let mut text = String::new();
    for module in 0..MODULES {
        let _ = writeln!(text, "import package::{}::{};", path(module).join("::"), name(module, 0));
    }
    text + "\n@compute @workgroup_size(1)\nfn main() {}\n"
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

/// A function of another module. Where a flag chooses between two functions, the import has an
/// alias.
struct Import {
    module: usize,
    function: usize,
    /// The module whose function of that number is imported where the flag is off.
    instead: Option<usize>,
}

impl Import {
    fn local(&self) -> String {
        match self.instead {
            Some(_) => format!("chosen_{}", letters(self.module)),
            None => name(self.module, self.function),
        }
    }
}

fn layer(module: usize) -> usize {
    module / (PARTS * UNITS)
}

fn part(module: usize) -> usize {
    module / UNITS % PARTS
}

/// The imports of a module: from the two layers below it, one of four from any part.
fn imports(module: usize, random: &mut Random) -> Vec<Import> {
    let below = |random: &mut Random| {
        let layer = layer(module) - 1 - random.below(layer(module).min(2));
        let part = if random.below(4) == 0 { random.below(PARTS) } else { part(module) };
        (layer * PARTS + part) * UNITS + random.below(UNITS)
    };
    let mut found: Vec<Import> = Vec::new();
    for index in 0..if layer(module) == 0 { 0 } else { 6 } {
        let (imported, function) = (below(random), random.below(FUNCTIONS));
        let instead = (index == 0).then(|| below(random)).filter(|other| *other != imported);
        if !found.iter().any(|known| known.module == imported || known.instead == Some(imported)) {
            found.push(Import { module: imported, function, instead });
        }
    }
    found
}

fn import(text: &mut String, imports: &[Import], random: &mut Random, dialect: Dialect) {
    let path = |module: usize| path(module).join("::");
    for Import { module, function, instead } in imports {
        let (here, name_here) = (path(*module), name(*module, *function));
        let unit = letters(*module);
        let Some(other) = instead else {
            let _ = match dialect {
                Dialect::Wesl => {
                    writeln!(text, "import package::{here}::{{{name_here}, GAIN_{unit}}};")
                }
                Dialect::NagaOil => writeln!(text, "#import {here}::{{{name_here}, GAIN_{unit}}}"),
            };
            continue;
        };
        let (there, name_there, flag) =
            (path(*other), name(*other, *function), flag_name(random.below(FLAGS), dialect));
        let _ = match dialect {
            Dialect::Wesl => writeln!(
                text,
                "@if({flag}) import package::{here}::{name_here} as chosen_{unit};\n@else import package::{there}::{name_there} as chosen_{unit};"
            ),
            Dialect::NagaOil => writeln!(
                text,
                "#ifdef {flag}\n#import {here}::{name_here} as chosen_{unit}\n#else\n#import {there}::{name_there} as chosen_{unit}\n#endif"
            ),
        };
    }
}

fn preamble(text: &mut String, module: usize, flag: usize, dialect: Dialect) {
    let (unit, flag) = (letters(module), flag_name(flag, dialect));
    let member = match dialect {
        Dialect::Wesl => format!("    @if({flag}) bent: vec3<f32>,\n"),
        Dialect::NagaOil => format!("#ifdef {flag}\n    bent: vec3<f32>,\n#endif\n"),
    };
    let _ = write!(
        text,
        "\n// Coefficients of unit {unit}: each in [0, 1], without a unit.\nconst GAIN_{unit}: f32 = 0.{module:03}5;\nconst BIAS_{unit}: f32 = 0.25;\n\n\
         /* What one evaluation\n   carries between its steps. */\nstruct State_{unit} {{\n    weight: f32,\n    // The direction so far, unit length.\n    direction: vec3<f32>,\n    taps: array<vec4<f32>, 4>,\n{member}}}\n"
    );
}

fn write_function(
    text: &mut String,
    module: usize,
    function: usize,
    imports: &[Import],
    random: &mut Random,
    dialect: Dialect,
) {
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
    if let Some(import) = imports.get(function) {
        let gain = if import.instead.is_some() {
            "0.5".to_owned()
        } else {
            format!("GAIN_{}", letters(import.module))
        };
        let _ = writeln!(text, "    sum += {}(state.direction, l, s * {gain});", import.local());
    }
    if function % 3 == 1 {
        let _ = writeln!(text, "    sum *= 1.0 + 0.01 * {}(l, n, s);", name(module, function - 1));
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

/// Names without digits, since naga_oil renames those that end in a digit.
pub fn letters(number: usize) -> String {
    let digit = |value: usize| char::from(b'a' + value as u8);
    [digit(number / 26 % 26), digit(number % 26)].iter().collect()
}

/// A small linear congruential generator. Its quality does not matter, only that its sequence never
/// changes.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        let mut random = Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        random.below(2);
        random
    }

    pub fn below(&mut self, bound: usize) -> usize {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % bound
    }
}

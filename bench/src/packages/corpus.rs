//! A second generated corpus: packages that import one another, and blocks of declarations under
//! conditions. The same number always gives the same text.
//!
//! It resembles the shaders of an engine that is written in WESL. There are 200 modules in eleven
//! packages, and 200 features. A third of the imports stay within a package. Most modules have a
//! group of declarations that exists in several variants, and imports that only some variants use.

use std::fmt::Write as _;

use crate::corpus::{Random, letters};

/// Modules of all packages.
pub const FILES: usize = LAYERS * UNITS;
/// Packages besides the one of the roots.
pub const PACKAGES: usize = 11;
pub const FEATURES: usize = 200;
/// Root shaders, each with one entry point.
pub const ROOTS: usize = 16;

/// Modules import from layers below their own.
const LAYERS: usize = 10;
const UNITS: usize = 20;
const FUNCTIONS: usize = 7;

/// How packages and conditions over several declarations are written.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// Packages are imported by name, and one condition covers a block of declarations.
    Blocks,
    /// Packages are folders of one package, and each declaration has its own condition.
    Each,
}

/// Declarations, some of them under conditions.
enum Part {
    /// One declaration or import.
    One(String),
    /// Alternatives, as in `@if`, `@elif` and `@else`: the first one whose condition holds is used.
    /// `None` always holds.
    Variants(Vec<(Option<String>, Vec<Part>)>),
}

/// The name of a package.
pub fn package(index: usize) -> String {
    format!("pack_{}", letters(index))
}

/// The package of a module, and the names of its path there.
pub fn place(module: usize) -> (usize, [String; 2]) {
    let folder = ["render", "light", "surface"][module % 3];
    (module % PACKAGES, [folder.to_owned(), format!("unit_{}", letters(module))])
}

/// The name of a feature.
pub fn feature(index: usize) -> String {
    format!("FEATURE_{}", letters(index).to_uppercase())
}

/// Whether a feature is on in a permutation: one of three is.
pub fn is_on(permutation: usize, feature: usize) -> bool {
    Random::new((permutation * FEATURES + feature) as u64 + 41).below(3) == 0
}

/// Lines of all modules.
pub fn lines() -> usize {
    (0..FILES).map(|index| module(index, Style::Blocks).lines().count()).sum()
}

/// The text of a root shader.
pub fn root(root: usize, style: Style) -> String {
    let mut random = Random::new(root as u64 + 9_001);
    let mut text = String::new();
    let mut sum = String::new();
    for unit in 0..3 {
        let module = (LAYERS - 1) * UNITS + (root * 3 + unit) % UNITS;
        let name = function_name(module, random.below(FUNCTIONS));
        let _ = writeln!(text, "import {}::{name};", path_from(None, module, style));
        let _ = writeln!(sum, "    sum += {name}(normal, light, 2.0);");
    }
    let _ = write!(
        text,
        "\n@fragment\nfn fs_main(@location(0) normal: vec3<f32>, @location(1) light: vec3<f32>) -> @location(0) vec4<f32> {{\n    var sum = 0.0;\n{sum}    return vec4<f32>(sum);\n}}\n"
    );
    text
}

/// The text of a module.
pub fn module(module: usize, style: Style) -> String {
    let mut random = Random::new(module as u64 + 3_001);
    let imported = imported(module, &mut random);
    let mut parts = imports(module, &imported, &mut random, style);
    parts.extend(group(module, &mut random));
    parts.extend((0..FUNCTIONS).map(|index| function(module, index, &imported, &mut random)));
    let mut text = String::new();
    write_parts(&mut text, &parts, style, &[]);
    text
}

/// The modules that a module imports: up to five, from the two layers below it.
fn imported(module: usize, random: &mut Random) -> Vec<usize> {
    let layer = module / UNITS;
    let mut found = Vec::new();
    while layer > 0 && found.len() < 5 {
        let below = layer - 1 - random.below(layer.min(2));
        let units = below * UNITS..(below + 1) * UNITS;
        let near = units.clone().find(|other| other % PACKAGES == module % PACKAGES);
        let any = units.start + random.below(UNITS);
        let other = near.filter(|_| random.below(3) == 0).unwrap_or(any);
        if !found.contains(&other) {
            found.push(other);
        }
    }
    found
}

/// The path of a module in an import of another module, or of a root.
fn path_from(here: Option<usize>, module: usize, style: Style) -> String {
    let (own, names) = place(module);
    let package = match (here, style) {
        (Some(here), Style::Blocks) if here % PACKAGES == own => "package".to_owned(),
        (_, Style::Blocks) => package(own),
        (_, Style::Each) => format!("package::{}", package(own)),
    };
    format!("{package}::{}", names.join("::"))
}

/// The imports of the modules in `imported`. Where a feature is off, another module replaces the
/// first one. The second is imported only where a feature is on, with a constant.
fn imports(module: usize, imported: &[usize], random: &mut Random, style: Style) -> Vec<Part> {
    let unit = letters(module);
    let path = |other: usize| path_from(Some(module), other, style);
    let one = |other: usize, index: usize| {
        let name = function_name(other, index);
        Part::One(format!("import {}::{{{name}, GAIN_{}}};\n", path(other), letters(other)))
    };
    let chosen = |other: usize, index: usize| {
        let name = function_name(other, index);
        Part::One(format!("import {}::{name} as chosen_{unit};\n", path(other)))
    };
    let mut parts = Vec::new();
    for (index, other) in imported.iter().enumerate() {
        let next = imported[(index + 1) % imported.len()];
        parts.push(match index {
            0 => Part::Variants(vec![
                (Some(condition(random)), vec![chosen(*other, index)]),
                (None, vec![chosen(next, index + 1)]),
            ]),
            1 => Part::Variants(vec![(Some(use_condition(module)), vec![one(*other, index)])]),
            _ => one(*other, index),
        });
    }
    parts
}

/// The condition of a module's second import, and of what uses it.
fn use_condition(module: usize) -> String {
    feature(module * 7 % FEATURES)
}

/// A feature, its absence, or two features.
fn condition(random: &mut Random) -> String {
    let (one, other) = (feature(random.below(FEATURES)), feature(random.below(FEATURES)));
    match random.below(5) {
        0 => format!("!{one}"),
        1 => format!("{one} && {other}"),
        2 => format!("{one} || !{other}"),
        _ => one,
    }
}

/// Constants, a struct and a function in three variants, with a block in the first block.
fn group(module: usize, random: &mut Random) -> Vec<Part> {
    let unit = letters(module);
    let gain = format!("// The gain of unit {unit}.\nconst GAIN_{unit}: f32 = 0.{module:03}5;\n");
    let bias = |value: f32| {
        Part::One(format!("// In [0, 1], without a unit.\nconst BIAS_{unit}: f32 = {value:?};\n"))
    };
    let state = |more: &str| {
        Part::One(format!(
            "/* What one evaluation\n   carries between its steps. */\nstruct State_{unit} {{\n    weight: f32,\n    direction: vec3<f32>,\n    taps: array<vec4<f32>, 4>,\n{more}}}\n"
        ))
    };
    let spread = |body: &str| {
        Part::One(format!(
            "fn spread_{unit}(w: f32, s: f32) -> f32 {{\n    let wide = w * s + BIAS_{unit};\n    {body}\n}}\n"
        ))
    };
    let inner =
        Part::Variants(vec![(Some(condition(random)), vec![bias(0.5)]), (None, vec![bias(0.25)])]);
    let first = vec![inner, state("    bent: vec3<f32>,\n"), spread("return wide * wide;")];
    let second = vec![bias(0.75), state(""), spread("return sqrt(abs(wide));")];
    let third = vec![bias(0.0), state("    age: u32,\n"), spread("return wide;")];
    let variants =
        vec![(Some(condition(random)), first), (Some(condition(random)), second), (None, third)];
    vec![Part::One(gain), Part::Variants(variants)]
}

fn function(module: usize, index: usize, imported: &[usize], random: &mut Random) -> Part {
    let unit = letters(module);
    let mut text = format!(
        "// A weighted response to light from `l` on a surface with normal `n`.\nfn {}(n: vec3<f32>, l: vec3<f32>, s: f32) -> f32 {{\n    let n_dot_l = max(dot(n, l), 0.0);\n    \
         var state: State_{unit};\n    state.weight = GAIN_{unit} * s;\n    state.direction = normalize(n + l);\n    var sum = BIAS_{unit};\n    for (var i = 0u; i < 4u; i++) {{\n        \
         let w = spread_{unit}(f32(i) * 0.25, state.weight);\n        state.taps[i] = vec4<f32>(w, w * w, n_dot_l, 1.0);\n        sum += w * pow(n_dot_l, s + w);\n    }}\n",
        function_name(module, index)
    );
    if random.below(10) < 7 {
        let _ = writeln!(
            text,
            "    @if({}) {{\n        sum = sum * 0.5 + state.taps[1].y;\n    }} @else {{\n        sum = sum + 0.125;\n    }}",
            condition(random)
        );
    }
    if let Some(other) = imported.get(index) {
        let (name, gain) = (function_name(*other, index), letters(*other));
        let _ = match index {
            0 => writeln!(text, "    sum += chosen_{unit}(state.direction, l, s * 0.5);"),
            1 => writeln!(
                text,
                "    @if({}) {{\n        sum += {name}(state.direction, l, s * GAIN_{gain});\n    }}",
                use_condition(module)
            ),
            _ => writeln!(text, "    sum += {name}(state.direction, l, s * GAIN_{gain});"),
        };
    }
    text.push_str("    return sum * clamp(dot(state.direction, n), 0.0, 1.0);\n}\n");
    Part::One(text)
}

fn function_name(module: usize, function: usize) -> String {
    format!("reply_{}_{}", letters(module), letters(function))
}

/// Writes declarations below the conditions of all blocks around them.
fn write_parts(text: &mut String, parts: &[Part], style: Style, around: &[String]) {
    for part in parts {
        match part {
            Part::One(one) if around.is_empty() => {
                text.push_str(one);
                text.push('\n');
            }
            Part::One(one) => {
                let _ = write!(text, "@if({})\n{one}\n", around.join(" && "));
            }
            Part::Variants(variants) if style == Style::Blocks => write_blocks(text, variants),
            Part::Variants(variants) => {
                let mut before = around.to_vec();
                for (condition, parts) in variants {
                    let own = condition.iter().map(|condition| format!("({condition})"));
                    let all: Vec<String> = before.iter().cloned().chain(own).collect();
                    write_parts(text, parts, style, &all);
                    before.extend(condition.iter().map(|condition| format!("!({condition})")));
                }
            }
        }
    }
}

fn write_blocks(text: &mut String, variants: &[(Option<String>, Vec<Part>)]) {
    for (index, (condition, parts)) in variants.iter().enumerate() {
        let _ = match (index, condition) {
            (0, Some(condition)) => writeln!(text, "@if({condition}) {{"),
            (_, Some(condition)) => writeln!(text, " @elif({condition}) {{"),
            (_, None) => writeln!(text, " @else {{"),
        };
        write_parts(text, parts, Style::Blocks, &[]);
        text.push('}');
    }
    text.push('\n');
}

//! Suggests what an unknown name may mean: an item of the library, or a similar name.

use std::collections::BTreeMap;

use lamplight_bundle::Language;
use lamplight_compose::{Composed, PartKind};
use lamplight_diagnostic::{Diagnostic, nearest_name};
use lamplight_syntax::words::leading_word;

/// Functions and types of both languages that are often misspelt.
const SHARED: &[&str] = &[
    "abs",
    "acos",
    "all",
    "any",
    "asin",
    "atan",
    "ceil",
    "clamp",
    "cos",
    "cross",
    "degrees",
    "determinant",
    "distance",
    "dot",
    "exp",
    "exp2",
    "floor",
    "fract",
    "fwidth",
    "length",
    "log",
    "log2",
    "max",
    "min",
    "mix",
    "normalize",
    "pow",
    "radians",
    "reflect",
    "refract",
    "round",
    "sign",
    "sin",
    "smoothstep",
    "sqrt",
    "step",
    "tan",
    "transpose",
    "trunc",
    "bool",
    "vec2",
    "vec3",
    "vec4",
];

/// Those that only WGSL has.
const WGSL: &[&str] = &[
    "array",
    "atan2",
    "f32",
    "faceForward",
    "fma",
    "i32",
    "inverseSqrt",
    "mat2x2f",
    "mat3x3f",
    "mat4x4f",
    "saturate",
    "select",
    "textureLoad",
    "textureSample",
    "textureSampleCompare",
    "textureSampleLevel",
    "u32",
    "vec2f",
    "vec2i",
    "vec2u",
    "vec3f",
    "vec3i",
    "vec3u",
    "vec4f",
    "vec4i",
    "vec4u",
];

/// Those that only GLSL has.
const GLSL: &[&str] = &[
    "float",
    "int",
    "inversesqrt",
    "ivec2",
    "ivec3",
    "ivec4",
    "mat2",
    "mat3",
    "mat4",
    "mod",
    "texelFetch",
    "texture",
    "textureLod",
    "uint",
    "uvec2",
    "uvec3",
    "uvec4",
];

/// Functions and types of GLSL that are used often.
pub fn glsl_words() -> impl Iterator<Item = &'static str> {
    SHARED.iter().chain(GLSL).copied()
}

/// Adds the import that is missing, or the nearest name.
pub fn hint_unknown(error: Diagnostic, composed: &Composed, name: &str) -> Diagnostic {
    let names = library_names(composed);
    if let Some(modules) = names.get(name) {
        return modules.iter().fold(error, |error, module| {
            error.note(format!(
                "help: the library has it: `{}`",
                missing_import(composed, module, name)
            ))
        });
    }
    let own = match composed.language {
        Language::Wesl => WGSL,
        Language::Glsl => GLSL,
    };
    let declared = composed.parts.iter().flat_map(|part| part.names.iter().map(String::as_str));
    let here: Vec<&str> =
        declared.chain(SHARED.iter().copied()).chain(own.iter().copied()).collect();
    let of_library = names.keys().map(String::as_str);
    // All names are searched together, so that the nearest one is suggested wherever it comes from.
    match nearest_name(name, here.iter().copied().chain(of_library)) {
        Some(near) if here.contains(&near) => error.note(format!("help: did you mean `{near}`?")),
        Some(near) => names[near].iter().fold(error, |error, module| {
            let import = missing_import(composed, module, near);
            error.note(format!("help: did you mean the library's `{near}`? `{import}`"))
        }),
        None => error,
    }
}

fn missing_import(composed: &Composed, module: &str, name: &str) -> String {
    match composed.language {
        Language::Wesl => format!("import lamplight::{}::{name};", module.replace('/', "::")),
        Language::Glsl => format!("#include \"lamplight/{module}.glsl\""),
    }
}

/// The modules of the library, by the names that they declare.
fn library_names(composed: &Composed) -> BTreeMap<String, Vec<String>> {
    let mut items: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let texts = composed.library.map_or(&[][..], |library| library.texts);
    for (path, text) in texts {
        let Some(module) = path.strip_suffix(".wesl") else { continue };
        if module.starts_with("programs/") {
            continue;
        }
        for name in text.lines().filter_map(declared_name) {
            items.entry(name.to_owned()).or_default().push(module.to_owned());
        }
    }
    items
}

/// The name that a line at the top of a module declares.
fn declared_name(line: &str) -> Option<&str> {
    let rest = ["fn ", "const ", "struct "].iter().find_map(|word| line.strip_prefix(word))?;
    Some(leading_word(rest))
}

/// Adds a note with each declaration of a function, for a call whose arguments fit none of them.
pub fn note_signatures(error: Diagnostic, composed: &Composed, name: &str) -> Diagnostic {
    let declares = |part: &&lamplight_compose::Part| {
        matches!(part.kind, PartKind::Function | PartKind::Prototype)
            && part.names.iter().any(|found| found == name)
    };
    composed.parts.iter().filter(declares).fold(error, |error, part| {
        let text = composed.text.get(part.range.clone()).unwrap_or_default();
        let code: Vec<&str> =
            text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
        let code = code.join(" ");
        let head = code.split(['{', ';']).next().unwrap_or_default();
        let head = head.split_whitespace().collect::<Vec<_>>().join(" ");
        error.note(format!("declared: `{head}`"))
    })
}

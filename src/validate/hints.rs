//! What an unknown name may have meant: an item of the library, or something close.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use crate::bundle::Language;
use crate::compose::{Composed, PartKind};
use crate::diagnostic::{Diagnostic, nearest};
use crate::source::{Embedded, Files};

/// Functions and types of both languages that are often misspelt.
const PREDECLARED: &[&str] = &[
    "abs",
    "acos",
    "all",
    "any",
    "asin",
    "atan",
    "atan2",
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
    "faceForward",
    "floor",
    "fma",
    "fract",
    "fwidth",
    "inverseSqrt",
    "inversesqrt",
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
    "saturate",
    "select",
    "sign",
    "sin",
    "smoothstep",
    "sqrt",
    "step",
    "tan",
    "textureLoad",
    "textureSample",
    "textureSampleCompare",
    "textureSampleLevel",
    "texture",
    "textureLod",
    "transpose",
    "trunc",
    "bool",
    "f32",
    "i32",
    "u32",
    "float",
    "int",
    "uint",
    "vec2",
    "vec3",
    "vec4",
    "vec2f",
    "vec3f",
    "vec4f",
    "vec2i",
    "vec3i",
    "vec4i",
    "vec2u",
    "vec3u",
    "vec4u",
    "mat2x2f",
    "mat3x3f",
    "mat4x4f",
    "mat2",
    "mat3",
    "mat4",
    "array",
];

/// Adds what to import, or the nearest name.
pub fn unknown(error: Diagnostic, composed: &Composed, name: &str) -> Diagnostic {
    if let Some(modules) = library().get(name) {
        return modules.iter().fold(error, |error, module| {
            error.note(format!("help: the library has it: `{}`", import(composed, module, name)))
        });
    }
    let declared = composed.parts.iter().flat_map(|part| part.names.iter().map(String::as_str));
    let known = declared.chain(PREDECLARED.iter().copied());
    if let Some(near) = nearest(name, known) {
        return error.note(format!("help: did you mean `{near}`?"));
    }
    match nearest(name, library().keys().map(String::as_str)) {
        Some(near) => library()[near].iter().fold(error, |error, module| {
            let import = import(composed, module, near);
            error.note(format!("help: did you mean the library's `{near}`? `{import}`"))
        }),
        None => error,
    }
}

fn import(composed: &Composed, module: &str, name: &str) -> String {
    match composed.language {
        Language::Wesl => format!("import lamplight::{}::{name};", module.replace('/', "::")),
        Language::Glsl => format!("#include \"lamplight/{module}.glsl\""),
    }
}

/// The modules of the library by what they declare.
fn library() -> &'static BTreeMap<String, Vec<String>> {
    static ITEMS: OnceLock<BTreeMap<String, Vec<String>>> = OnceLock::new();
    ITEMS.get_or_init(|| {
        let mut items: BTreeMap<String, Vec<String>> = BTreeMap::new();
        let paths =
            Embedded.list(&["wesl"]).into_iter().filter(|path| !path.starts_with("programs/"));
        for path in paths {
            let text = Embedded.read(&path).ok().flatten().unwrap_or_default();
            let module = path.trim_end_matches(".wesl");
            for name in text.lines().filter_map(declared) {
                items.entry(name.to_owned()).or_default().push(module.to_owned());
            }
        }
        items
    })
}

/// The name that a line at the top of a module declares.
fn declared(line: &str) -> Option<&str> {
    let rest = ["fn ", "const ", "struct "].iter().find_map(|word| line.strip_prefix(word))?;
    rest.split(|letter: char| !(letter.is_alphanumeric() || letter == '_')).next()
}

/// A note with each declaration of a function of the text, for a call that none of them takes.
pub fn signatures(error: Diagnostic, composed: &Composed, name: &str) -> Diagnostic {
    let declares = |part: &&crate::compose::Part| {
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

//! The files that random edits begin with, and what edits put into them.

/// Modules of WESL, then those of GLSL, of which the last is a stage.
pub const MODULES: usize = 6;
pub const FILES: usize = MODULES + 3;

pub const MANIFEST: &str = r#"[program.lamp]
wesl = "module_5.wesl"

[program.lamp.axis]
fog = { values = [false, true] }
cone = { values = ["hard", "soft"] }

[features]
TINT = {}
"#;

/// What edits put into texts: parts of programs, whole and broken.
pub const PIECES: &[&str] = &[
    "x",
    ";",
    "{",
    "}",
    "(",
    "\n",
    "// note\n",
    "/*",
    "*/",
    "@if(fog) ",
    "@if(cone == soft) {\n",
    "} @else {\n",
    "@if(MIST) ",
    "let y = 2.0;\n",
    "term_1(x)",
    "import package::module_0::term_0;\n",
    "import package::none::term;\n",
    "import lamplight::brdf::diffuse::lambert;\n",
    "fn extra(x: f32) -> f32 { return x; }\n",
    "const LIMIT: f32 = 3.0;\n",
    "struct Share { a: f32 }\n",
    "import super::module_2::{Share_2 as Part, term_2};\n",
    "constants::fog",
    "public ",
    "private ",
    "public import package::module_0::term_0;\n",
    "@if(fog) public import package::module_0::term_0 as term_1;\n",
    "import package::module_1::*;\n",
    "@!wildcardable;\n",
    "@if(TINT) ",
    "é",
    "\"",
    "super",
    "#if FOG\n",
    "#ifdef CONE_SOFT\n",
    "#else\n",
    "#endif\n",
    "#include \"part_0.glsl\"\n",
    "#include <lamplight/brdf/diffuse.glsl>\n",
    "#include \"none.glsl\"\n",
    "#define TWICE(x) (2.0 * x)\n",
    "float extra(float x) { return x; }\n",
    "Share_0 share;\n",
    "share.value",
    "TWICE(sum)",
];

/// What the manifest may be changed to while the server runs.
pub const MANIFESTS: [&str; 4] = [
    MANIFEST,
    "[program.lamp]\nwesl = \"module_4.wesl\"\n[program.lamp.axis]\nfog = { values = [true, false] }\n",
    "[features]\nTINT = true\nMIST = {}\n",
    "[program.lamp",
];

pub fn file_name(index: usize) -> String {
    match index {
        ..MODULES => format!("module_{index}.wesl"),
        MODULES => "part_0.glsl".to_owned(),
        index if index + 1 == FILES => "stage.frag".to_owned(),
        index => format!("part_{}.glsl", index - MODULES),
    }
}

pub fn source(index: usize) -> String {
    if index >= MODULES { glsl_source(index - MODULES) } else { wesl_source(index) }
}

fn glsl_source(index: usize) -> String {
    let before = index.checked_sub(1);
    let include = before.map_or("#version 450\n".to_owned(), |other| {
        format!("#version 450\n#include \"part_{other}.glsl\"\n")
    });
    let body = before.map_or("x".to_owned(), |other| format!("term_{other}(x)"));
    let text = format!(
        "{include}struct Share_{index} {{\n    float value;\n}};\n\n#if FOG\n\
         const float GAIN_{index} = 2.0;\n#else\nconst float GAIN_{index} = 1.0;\n#endif\n\n\
         // What file {index} hands on.\nfloat term_{index}(float x) {{\n    \
         Share_{index} share = Share_{index}(x);\n    float sum = {body} * GAIN_{index};\n    \
         return sum + share.value;\n}}\n"
    );
    match index + MODULES + 1 == FILES {
        false => text,
        true => format!(
            "{text}layout(location = 0) out vec4 colour;\nvoid main() {{\n    \
             colour = vec4(term_{index}(1.0));\n}}\n"
        ),
    }
}

fn wesl_source(index: usize) -> String {
    let mut text = String::new();
    let used: Vec<usize> = [1, 2].iter().filter_map(|back| index.checked_sub(*back)).collect();
    for other in &used {
        text += &format!("import package::module_{other}::{{term_{other}, Share_{other}}};\n");
    }
    text += &format!(
        "\n/// What module {index} hands on.\nstruct Share_{index} {{\n    value: f32,\n}}\n\n\
         @if(fog) {{\nconst GAIN_{index}: f32 = 2.0;\n}} @else {{\nconst GAIN_{index}: f32 = 1.0;\n}}\n\n\
         fn term_{index}(x: f32) -> f32 {{\n    var sum = x * GAIN_{index};\n"
    );
    for other in &used {
        text += &format!(
            "    let part_{other} = Share_{other}(sum);\n    sum += term_{other}(part_{other}.value);\n"
        );
    }
    text += "    @if(TINT) {\n        sum *= 0.5;\n    }\n    return sum;\n}\n";
    if index == MODULES - 1 {
        text += &format!(
            "\n@fragment\nfn main() -> @location(0) vec4f {{\n    return vec4f(term_{index}(1.0));\n}}\n"
        );
    }
    text
}

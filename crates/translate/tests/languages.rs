//! The library's functions in HLSL and MSL, read by compilers of these languages.

use std::path::Path;

use lamplight_diagnostic::render::{Form, render};
use lamplight_diagnostic::source::SourceSet;
use lamplight_tools::GLSLANG;
use lamplight_tools::metal::Clang;
use lamplight_translate::print::{Dialect, MadeFile, Style};
use lamplight_translate::{SourceModule, translate_wesl};
use libtest_mimic::{Failed, Trial};

use crate::compiler::included;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("translate::languages/hlsl", hlsl),
        Trial::test("translate::languages/msl", msl),
        Trial::test("translate::languages/forms", forms),
        Trial::test("translate::languages/refused", refused),
    ]
}

const LIBRARY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shaderlib");

/// The least number of modules: those of the library.
const LEAST: usize = 40;

/// The library's modules in a language.
fn library(dialect: Dialect) -> Result<Vec<MadeFile>, Failed> {
    let mut sources = SourceSet::default();
    let mut texts: Vec<(String, String)> = Vec::new();
    collect(Path::new(LIBRARY), "", &mut texts)?;
    texts.sort();
    let modules: Vec<SourceModule<'_>> = texts
        .iter()
        .map(|(path, text)| SourceModule {
            path: path.split('/').map(str::to_owned).collect(),
            source: sources.add(format!("{path}.wesl"), text.as_str()),
            text,
        })
        .collect();
    let style = Style { dialect, command: None, guard: "TEST", sampling: None, prefix: None };
    let files = translate_wesl(&modules, &[], &style)
        .map_err(|problems| render(&sources, &problems, Form::Human))?;
    if files.len() < LEAST {
        return Err(format!("only {} files", files.len()).into());
    }
    Ok(files)
}

fn collect(folder: &Path, path: &str, texts: &mut Vec<(String, String)>) -> Result<(), Failed> {
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name().into_string().map_err(|_| "a name that is no text")?;
        let below = if path.is_empty() { name.clone() } else { format!("{path}/{name}") };
        if entry.file_type()?.is_dir() && name != "programs" {
            collect(&entry.path(), &below, texts)?;
        } else if let Some(stem) = below.strip_suffix(".wesl") {
            texts.push((stem.to_owned(), std::fs::read_to_string(entry.path())?));
        }
    }
    Ok(())
}

/// A text in one language, or the message.
fn translated(text: &str, dialect: Dialect) -> String {
    let mut sources = SourceSet::default();
    let source = sources.add("one.wesl", text);
    let style = Style { dialect, command: None, guard: "", sampling: None, prefix: None };
    let module = SourceModule { path: vec!["one".to_owned()], source, text };
    match translate_wesl(&[module], &[], &style) {
        Ok(files) => files.into_iter().map(|file| file.text).collect(),
        Err(problems) => problems[0].message.clone(),
    }
}

/// Statements and a line of what becomes of each in HLSL and in MSL.
const FORMS: &[(&str, &str, &str)] = &[
    ("var x = vec2f(a);", "float2 x = (float2)a;", "float2 x = float2(a);"),
    ("let x = m * v;", "float2 x = mul(v, m);", "float2 x = m * v;"),
    ("let x = m * m * v;", "float2 x = mul(v, mul(m, m));", "float2 x = m * m * v;"),
    ("var x = m; x *= m;", "x = mul(m, x);", "x *= m;"),
    ("let x = all(v == v);", "bool x = all(v == v);", "bool x = all(v == v);"),
    ("let x = !(v < v);", "bool2 x = !(v < v);", "bool2 x = !(v < v);"),
    (
        "let x = select(v, v, v < v);",
        "float2 x = v < v ? v : v;",
        "float2 x = select(v, v, v < v);",
    ),
    ("let x = bitcast<u32>(a);", "uint x = asuint(a);", "uint x = as_type<uint>(a);"),
    (
        "let x = u32(a);",
        "uint x = uint(clamp(a, 0.0, 4294967040.0));",
        "uint x = uint(clamp(a, 0.0, 4294967040.0));",
    ),
    ("let x = sign(v);", "float2 x = float2(sign(v));", "float2 x = sign(v);"),
    ("let x = radians(a);", "float x = radians(a);", "float x = a * 0.01745329252;"),
    ("let x = length(a);", "float x = length(a);", "float x = abs(a);"),
    (
        "let x = array<f32, 2>(a, a);",
        "float x[2] = {a, a};",
        "array<float, 2> x = array<float, 2>{a, a};",
    ),
    ("var x: array<f32, 2>;", "float x[2] = {0.0, 0.0};", "array<float, 2> x = array<float, 2>{};"),
    ("let x = S(a, v);", "S x = make_s(a, v);", "S x = S{a, v};"),
    ("let half = a;", "float half_ = a;", "float half_ = a;"),
    ("discard;", "discard;", "discard_fragment();"),
];

fn forms() -> Result<(), Failed> {
    for (statement, hlsl, msl) in FORMS {
        let text = format!(
            "struct S {{ one: f32, two: vec2f }}\n\
             fn f(a: f32, v: vec2f, m: mat2x2f) {{\n    {statement}\n}}\n"
        );
        for (dialect, line) in [(Dialect::Hlsl, hlsl), (Dialect::Msl, msl)] {
            let found = translated(&text, dialect);
            if !found.lines().any(|one| one.trim() == *line) {
                return Err(format!("`{statement}` should be `{line}`:\n{found}").into());
            }
        }
    }
    Ok(())
}

/// Items that are refused in both, and words of the message.
const REFUSED: &[(&str, &str)] = &[
    ("@fragment fn f() -> @location(0) vec4f { return vec4f(1.0); }", "an entry point"),
    (
        "@group(0) @binding(0) var<uniform> a: vec4f; fn f() -> f32 { return a.x; }",
        "a variable of a module",
    ),
    ("var<private> a: f32 = 1.0; fn f() -> f32 { return a; }", "a variable of a module"),
    ("@id(1) override a = 1.0; fn f() -> f32 { return a; }", "an `override`"),
    ("fn f(a: u32) -> u32 { return insertBits(a, a, 0u, 4u); }", "the function `insertBits`"),
];

fn refused() -> Result<(), Failed> {
    for (text, words) in REFUSED {
        for dialect in [Dialect::Hlsl, Dialect::Msl] {
            let found = translated(text, dialect);
            if !found.contains(words) || found.contains('{') {
                return Err(format!("`{text}` should be refused as {words}: {found}").into());
            }
        }
    }
    let text = "fn g(a: ptr<function, f32>) -> bool { *a += 1.0; return *a > 1.0; }\n\
                fn f(b: bool) -> f32 { var a = 0.0; if b && g(&a) { a = 0.0; } return a; }";
    let found = translated(text, Dialect::Hlsl);
    match found.contains("behind `&&`") {
        true => Ok(()),
        false => Err(format!("HLSL would always call `g`: {found}").into()),
    }
}

fn hlsl() -> Result<(), Failed> {
    let files = library(Dialect::Hlsl)?;
    let mut failures = Vec::new();
    for file in &files {
        let text = included(file, &files)? + "\nfloat4 main() : SV_Target { return 0; }\n";
        let options = ["--stdin", "-D", "-V", "-S", "frag", "-e", "main", "-o", "/dev/null"];
        if let Err(message) = GLSLANG.pipe(&options, text.as_bytes()) {
            failures.push(format!("{}: {message}", file.path));
        }
    }
    if failures.is_empty() { Ok(()) } else { Err(failures.join("\n").into()) }
}

fn msl() -> Result<(), Failed> {
    let files = library(Dialect::Msl)?;
    let clang = Clang::open().map_err(|missing| missing.reason)?;
    let mut failures = Vec::new();
    for file in &files {
        let text = included(file, &files)?;
        let output = clang.compile(&text, &["-fsyntax-only"]).map_err(|missing| missing.reason)?;
        if !output.status.success() {
            let words = String::from_utf8_lossy(&output.stderr).into_owned();
            failures.push(format!("{}: {words}", file.path));
        }
    }
    if failures.is_empty() { Ok(()) } else { Err(failures.join("\n").into()) }
}

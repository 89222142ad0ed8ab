//! Which import or include led to each text, as the map of a composed text has it.

use lamplight_bundle::Language;
use lamplight_compose::resolve::{self, Packages};
use lamplight_compose::{self as compose, Options};
use lamplight_diagnostic::source::{Memory, Package, SourceSet};
use lamplight_permute::Settings;
use libtest_mimic::{Failed, Trial};

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("imports::of_wesl", of_wesl as fn() -> Result<(), Failed>),
        Trial::test("imports::of_glsl", of_glsl as fn() -> Result<(), Failed>),
    ]
}

/// For each text but the first its path, that of the text that led to it, and the words there.
fn found(files: &[(&str, &str)], language: Language) -> Vec<[String; 3]> {
    let memory = files.iter().map(|(path, text)| ((*path).to_owned(), (*text).to_owned()));
    let files_of = Box::new(Memory(memory.collect()));
    let packages = Packages::new(Package { name: "own".to_owned(), files: files_of }, Vec::new());
    let mut sources = SourceSet::default();
    let graph = resolve::load(&mut sources, &packages, files[0].0, language).unwrap();
    let composed = compose::compose(&graph, &Settings::default(), &Options::default()).unwrap();
    let path = |id| sources.get(id).path.clone();
    let row = |(id, span): &(_, lamplight_diagnostic::source::Span)| {
        [path(*id), path(span.source), sources.text(*span).to_owned()]
    };
    let mut rows: Vec<[String; 3]> = composed.map.imports.iter().map(row).collect();
    rows.sort();
    rows
}

/// Names of modules in comments, and names of items that modules have too, lead nowhere.
fn of_wesl() -> Result<(), Failed> {
    let files = [
        (
            "main.wesl",
            "// import package::b::g;\nimport package::a::{\n  f,\n};\nfn b() -> f32 { return f(); }\n\
             @fragment fn main() -> @location(0) vec4f { return vec4f(b()); }\n",
        ),
        ("a.wesl", "import package::b::g;\nfn f() -> f32 { return g(); }\n"),
        ("b.wesl", "fn g() -> f32 { return 1.0; }\n"),
        ("c.wesl", "fn h() -> f32 { return 1.0; }\n"),
    ];
    let expected = [["a.wesl", "main.wesl", "f"], ["b.wesl", "a.wesl", "package::b::g"]];
    assert_eq!(found(&files, Language::Wesl), expected);
    Ok(())
}

fn of_glsl() -> Result<(), Failed> {
    let files = [
        (
            "main.frag",
            "#version 450\n// #include \"b.glsl\"\n#include \"a.glsl\"\n#include \"parts/b.glsl\"\n\
             layout(location = 0) out vec4 color;\nvoid main() { color = vec4(f()); }\n",
        ),
        ("a.glsl", "#include \"parts/c.glsl\"\nfloat f() { return g(); }\n"),
        ("parts/b.glsl", "float unused() { return 2.0; }\n"),
        ("parts/c.glsl", "float g() { return 1.0; }\n"),
    ];
    let expected = [
        ["a.glsl", "main.frag", "\"a.glsl\""],
        ["parts/b.glsl", "main.frag", "\"parts/b.glsl\""],
        ["parts/c.glsl", "a.glsl", "\"parts/c.glsl\""],
    ];
    assert_eq!(found(&files, Language::Glsl), expected);
    Ok(())
}

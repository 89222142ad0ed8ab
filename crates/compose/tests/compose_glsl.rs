//! GLSL composition: one folder of `tests/compose_glsl/` for each case. A folder has the files of
//! the root package, the packages that it depends on in `deps/`, and the expected result.
//! `cargo xtask record compose_` writes the result that was found: read it before committing.
//!
//! A file `settings` has one entry a line: `axis = value`; `enum axis = value value`; `root = FILE`;
//! `keep = all` or `keep = name name`. `locate = text` adds to the result the place in the sources
//! of the first such text in the output. `invalid = reason` says that validators need not accept
//! the output, and why.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::{env, fs};

use lamplight_bundle::Stage;
use lamplight_compose::resolve::{Packages, glsl::load};
use lamplight_compose::{Composed, Keep, Options, glsl::compose};
use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::render::{Form, render};
use lamplight_diagnostic::source::{Memory, Package, SourceId, SourceSet};
use lamplight_permute::{Setting, Settings};
use libtest_mimic::{Failed, Trial};

use lamplight_testing::folders::packages_in;

/// How a failing case is accepted.
const ACCEPT: &str = "\n(`cargo xtask record compose_` accepts this)";

pub fn tests() -> Vec<Trial> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/compose_glsl");
    let mut cases: Vec<PathBuf> =
        fs::read_dir(root).unwrap().map(|entry| entry.unwrap().path()).collect();
    cases.sort();
    let files = cases.into_iter().map(|case| {
        let name = case.file_name().unwrap().to_string_lossy().into_owned();
        Trial::test(format!("compose_glsl::{name}"), move || check(&case))
    });
    let generated = GENERATED.iter().map(|(name, code, make)| {
        Trial::test(format!("compose_glsl::generated::{name}"), move || check_limit(code, make()))
    });
    files.chain(generated).collect()
}

#[derive(Default)]
struct Case {
    root: String,
    settings: Settings,
    options: Options,
    locate: Vec<String>,
    invalid: bool,
}

fn check(folder: &Path) -> Result<(), Failed> {
    let case = read_case(folder);
    let mut sources = SourceSet::default();
    let is_source = |name: &str| name != "settings" && !name.starts_with("expected.");
    let packages = packages_in(folder, "root", is_source);
    let result = load(&mut sources, &packages, &case.root).and_then(|graph| {
        let first = compose(&graph, &case.settings, &case.options);
        let second = compose(&graph, &case.settings, &case.options);
        assert_eq!(
            first.as_ref().map(|it| &it.text).ok(),
            second.as_ref().map(|it| &it.text).ok(),
            "two runs differ"
        );
        first
    });
    match result {
        Ok(composed) => {
            expect(folder, "expected.glsl", "expected.err", &shown(&sources, &case, &composed))?;
            check_map(&sources, &composed)?;
            if composed.text.contains("void main") && !case.invalid {
                validate(&composed)
            } else {
                Ok(())
            }
        }
        Err(errors) => {
            expect(folder, "expected.err", "expected.glsl", &render(&sources, &errors, Form::Human))
        }
    }
}

fn read_case(folder: &Path) -> Case {
    let mut case = Case { root: "main.frag.glsl".into(), ..Case::default() };
    for line in fs::read_to_string(folder.join("settings")).unwrap_or_default().lines() {
        let (key, value) =
            line.split_once('=').map(|(key, value)| (key.trim(), value.trim())).unwrap();
        let words = || value.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        match key.split_once(' ').unwrap_or(("", key)) {
            ("enum", axis) => {
                drop(Arc::make_mut(&mut case.settings.enums).insert(axis.into(), words()));
            }
            ("", "root") => case.root = value.into(),
            ("", "keep") if value == "all" => case.options.keep = Keep::All,
            ("", "keep") => case.options.keep = Keep::Items(words()),
            ("", "locate") => case.locate.push(value.into()),
            ("", "invalid") => case.invalid = true,
            ("", axis) => drop(case.settings.values.insert(axis.into(), Setting::parse(value))),
            (word, _) => panic!("unknown word {word}"),
        }
    }
    case
}

fn shown(sources: &SourceSet, case: &Case, composed: &Composed) -> String {
    let mut text = composed.text.clone();
    let reads: Vec<String> =
        composed.reads.iter().map(|(name, value)| format!("{name}={value}")).collect();
    writeln!(text, "// ---- {:?}; reads: {}", composed.stage.unwrap(), reads.join(" ")).unwrap();
    for wanted in &case.locate {
        let at = composed
            .text
            .find(wanted)
            .unwrap_or_else(|| panic!("`{wanted}` is not in the output:\n{text}"));
        let span = composed.map.lookup(at..at + wanted.len());
        let place = span.map_or("nowhere".into(), |span| {
            let (line, column) = sources.position(span.source, span.start as usize);
            format!("{}:{line}:{column} `{}`", sources.get(span.source).path, sources.text(span))
        });
        writeln!(text, "// `{wanted}` from {place}").unwrap();
    }
    text
}

fn expect(folder: &Path, name: &str, other: &str, found: &str) -> Result<(), Failed> {
    let path = folder.join(name);
    if env::var_os("UPDATE_EXPECT").is_some() {
        let _ = fs::remove_file(folder.join(other));
        fs::write(&path, found)?;
    }
    let expected = fs::read_to_string(&path).unwrap_or_default();
    if expected == found {
        Ok(())
    } else {
        Err(format!("--- expected\n{expected}\n+++ found\n{found}{ACCEPT}").into())
    }
}

/// A segment of the source map that claims to be a verbatim copy is equal to its source, and the
/// segments are in order.
fn check_map(sources: &SourceSet, composed: &Composed) -> Result<(), Failed> {
    let segments = composed.map.segments();
    for (index, segment) in segments.iter().enumerate() {
        let end = segments.get(index + 1).map_or(composed.text.len(), |next| next.start as usize);
        let output = &composed.text[segment.start as usize..end];
        if let (Some(span), true) = (segment.span, segment.verbatim)
            && !sources.text(span).starts_with(output)
        {
            return Err(format!(
                "the map says that `{output}` is a copy of `{}`",
                sources.text(span)
            )
            .into());
        }
    }
    Ok(())
}

fn validate(composed: &Composed) -> Result<(), Failed> {
    let stage = match composed.stage.unwrap() {
        Stage::Vertex => lamplight_glsl::tree::Stage::Vertex,
        Stage::Fragment => lamplight_glsl::tree::Stage::Fragment,
        Stage::Compute => lamplight_glsl::tree::Stage::Compute,
    };
    let (text, id) = (&composed.text, SourceId(u32::MAX));
    let checked =
        lamplight_glsl::check::check(text, &lamplight_glsl::parse::parse(text), stage, id);
    checked.map(drop).map_err(|errors| format!("{errors:?}\n{text}").into())
}

/// A name, the code of the expected error (empty for none), and the files.
type Generated = (&'static str, &'static str, fn() -> Vec<(String, String)>);

/// Hostile inputs that are too large to be committed. The first file is the root.
const GENERATED: &[Generated] = &[
    ("object_bomb", "expansion-too-large", || {
        one((0..64).map(|n| format!("#define M{n} M{0} M{0}\n", n + 1)).collect::<String>()
            + "int x = M0;\n")
    }),
    ("silent_bomb", "expansion-too-large", || {
        one((0..63).map(|n| format!("#define M{n} M{0} M{0}\n", n + 1)).collect::<String>()
            + "#define M63\nint x = M0 1;\n")
    }),
    ("argument_bomb", "expansion-too-large", || {
        one((0..64).map(|n| format!("#define F{n}(x) F{0}(x x)\n", n + 1)).collect::<String>()
            + "int x = F0(1);\n")
    }),
    ("nested_calls", "nesting-too-deep", || {
        one(format!("#define F(x) x\nint x = {}1{};\n", "F(".repeat(100_000), ")".repeat(100_000)))
    }),
    ("nested_condition", "nesting-too-deep", || {
        one(format!("#if {}1{}\n#endif\n", "(".repeat(100_000), ")".repeat(100_000)))
    }),
    ("unary_chain", "nesting-too-deep", || one(format!("#if {}1\n#endif\n", "!".repeat(100_000)))),
    ("nested_ifs", "nesting-too-deep", || {
        one("#if 1\n".repeat(100_000) + &"#endif\n".repeat(100_000))
    }),
    ("nested_brackets", "nesting-too-deep", || {
        one(format!("int x = {}1{};\n", "(".repeat(100_000), ")".repeat(100_000)))
    }),
    ("long_elif", "", || {
        one("#if 0\n".to_owned() + &"#elif 0\n".repeat(100_000) + "#endif\nvoid main() {}\n")
    }),
    ("long_sum", "", || {
        one(format!("#if {}1\n#endif\nvoid main() {{}}\n", "1 + ".repeat(100_000)))
    }),
    ("long_chain", "", || {
        one((0..50_000).map(|n| format!("#define M{n} M{}\n", n + 1)).collect::<String>()
            + "const int x = M0;\nvoid main() { int y = x; }\n")
    }),
    ("many_tokens", "too-many-tokens", || one("; ".repeat((1 << 20) + 1))),
    ("many_lines", "", || {
        one("const int a = __LINE__;\n".repeat(50_000) + "void main() { int b = a; }\n")
    }),
    ("deep_includes", "include-too-deep", || {
        (0..100).map(|n| (name(n), format!("#include \"{}\"\n", name(n + 1)))).collect()
    }),
    ("include_bomb", "expansion-too-large", || {
        let twice = |n: usize| format!("#include \"{0}\"\n#include \"{0}\"\n", name(n + 1));
        (0..40).map(|n| (name(n), twice(n))).chain([(name(40), String::new())]).collect()
    }),
    ("many_parameters", "malformed-directive", || {
        let names: Vec<String> = (0..5_000).map(|n| format!("p{n}")).collect();
        one(format!("#define F({}) {}\nvoid main() {{}}\n", names.join(", "), names.join(" ")))
    }),
];

fn one(text: String) -> Vec<(String, String)> {
    vec![(name(0), text)]
}

fn name(number: usize) -> String {
    format!("f{number}.frag.glsl")
}

/// Composing ends within seconds on a small stack, with the expected error, or without one.
fn check_limit(code: &str, files: Vec<(String, String)>) -> Result<(), Failed> {
    let root = files[0].0.clone();
    let files = Box::new(Memory(files.into_iter().collect()));
    let packages = Packages::new(Package { name: "root".into(), files }, Vec::new());
    let run = move || {
        let start = std::time::Instant::now();
        let result = load(&mut SourceSet::default(), &packages, &root)
            .and_then(|graph| compose(&graph, &Settings::default(), &Options::default()));
        (result.err(), start.elapsed())
    };
    let (errors, time) = std::thread::Builder::new()
        .stack_size(1 << 20)
        .spawn(run)?
        .join()
        .map_err(|_| "panicked")?;
    let codes: Vec<&str> =
        errors.iter().flatten().map(|error: &Diagnostic| error.code.name).collect();
    let expected: &[&str] = if code.is_empty() { &[] } else { &[code] };
    if codes != expected || time.as_secs() > 5 {
        return Err(format!("expected {expected:?}, found {codes:?} after {time:?}").into());
    }
    Ok(())
}

//! WESL composition: one folder of `tests/compose_wesl/` for each case.
//!
//! A case has a root module (`main.wesl`, or the one that its settings name), the other files of the
//! root package, dependencies in `deps/NAME/`, and possibly `settings.txt`. The expected result is
//! `expected.wgsl`, or `expected.err` with the diagnostics as users see them. `expected.warnings`
//! has warnings if there are any, and `expected.reads` the settings that were read if the case asks
//! for them. `cargo xtask record compose_` writes the result that was found: read it before committing.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use lamplight_compose::resolve::Packages;
use lamplight_compose::resolve::wesl::{Graph, load};
use lamplight_compose::wesl::compose;
use lamplight_compose::{Composed, Keep, Mangle, Options};
use lamplight_diagnostic::render::{Form, render};
use lamplight_diagnostic::source::{Memory, Package, SourceSet};
use lamplight_permute::{Setting, Settings};
use libtest_mimic::{Failed, Trial};

use lamplight_testing::folders::packages_in;

/// How a failing case is accepted.
const ACCEPT: &str = "\n(`cargo xtask record compose_` accepts this)";

pub fn tests() -> Vec<Trial> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/compose_wesl");
    let mut cases: Vec<PathBuf> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_dir())
        .collect();
    cases.sort();
    let named = |case: PathBuf| {
        let name = case.file_name().unwrap().to_string_lossy().into_owned();
        Trial::test(format!("compose_wesl::{name}"), move || check(&case))
    };
    let mut tests: Vec<Trial> = cases.into_iter().map(named).collect();
    tests.push(Trial::test("compose_wesl permutations are deterministic", permutations));
    tests.push(Trial::test("compose_wesl names unreadable files", unreadable));
    tests.push(Trial::test("compose_wesl survives mutilated text", mutilated));
    tests
}

/// `settings.txt`: `set NAME = VALUE`, `constant NAME = LITERAL`, `enum NAME = A, B`, `integer
/// NAME`, `keep all|A,B`, `mangle underscore`, `root FILE`, `reads`, `unparsed` (naga need not
/// accept the text).
#[derive(Default)]
struct Case {
    settings: Settings,
    options: Options,
    root: Option<String>,
    reads: bool,
    unparsed: bool,
}

impl Case {
    fn read(folder: &Path) -> Self {
        let mut case = Self::default();
        for line in fs::read_to_string(folder.join("settings.txt")).unwrap_or_default().lines() {
            let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
            let (name, value) = rest
                .split_once('=')
                .map_or((rest.trim(), ""), |(name, value)| (name.trim(), value.trim()));
            let list = |text: &str| text.split(',').map(|part| part.trim().to_owned()).collect();
            match word {
                "constant" => {
                    let literal = lamplight_permute::constant::parse(value).unwrap();
                    drop(case.settings.constants.insert(name.to_owned(), literal));
                }
                "set" => drop(case.settings.values.insert(name.to_owned(), Setting::parse(value))),
                "enum" => {
                    Arc::make_mut(&mut case.settings.enums).insert(name.to_owned(), list(value));
                }
                "integer" => drop(case.settings.integers.insert(name.to_owned())),
                "keep" if name == "all" => case.options.keep = Keep::All,
                "keep" => case.options.keep = Keep::Items(list(name)),
                "mangle" => case.options.mangle = Mangle::Underscore,
                "root" => case.root = Some(name.to_owned()),
                "reads" => case.reads = true,
                "unparsed" => case.unparsed = true,
                _ => panic!("{}: unknown line `{line}`", folder.display()),
            }
        }
        case
    }
}

fn check(folder: &Path) -> Result<(), Failed> {
    let case = Case::read(folder);
    let packages = packages_in(folder, "app", is_source);
    let mut sources = SourceSet::default();
    let root = case.root.as_deref().unwrap_or("main.wesl");
    let outcome = load(&mut sources, &packages, root)
        .and_then(|graph| compose(&graph, &case.settings, &case.options));
    let human = |diagnostics: &[_]| render(&sources, diagnostics, Form::Human);
    let mut found =
        BTreeMap::from([("wgsl", None), ("err", None), ("warnings", None), ("reads", None)]);
    match &outcome {
        Ok(composed) => {
            found.insert("wgsl", Some(composed.text.clone()));
            found.insert(
                "warnings",
                Some(human(&composed.warnings)).filter(|text| !text.is_empty()),
            );
            found.insert(
                "reads",
                case.reads.then(|| {
                    composed
                        .reads
                        .iter()
                        .map(|(name, value)| format!("{name} = {value}\n"))
                        .collect()
                }),
            );
        }
        Err(errors) => drop(found.insert("err", Some(human(errors)))),
    }
    let mut differences = String::new();
    for (kind, text) in found {
        differences += &compare(&folder.join(format!("expected.{kind}")), text);
    }
    if let Ok(composed) = &outcome {
        differences += &map_errors(&sources, composed);
        if !case.unparsed
            && let Err(error) = naga::front::wgsl::parse_str(&composed.text)
        {
            differences += &error.emit_to_string(&composed.text);
        }
    }
    if differences.is_empty() { Ok(()) } else { Err(differences.into()) }
}

/// The difference from a file with an expected result; empty if they agree or the file is updated.
fn compare(path: &Path, found: Option<String>) -> String {
    let expected = fs::read_to_string(path).ok();
    if expected == found {
        return String::new();
    }
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        match found {
            Some(text) => fs::write(path, text).unwrap(),
            None => fs::remove_file(path).unwrap(),
        }
        return String::new();
    }
    let shown = |text: Option<String>| text.unwrap_or_else(|| "(no such file)\n".to_owned());
    let (expected, found) = (shown(expected), shown(found));
    format!("--- {}\n{expected}--- found\n{found}{ACCEPT}", path.display())
}

/// What is wrong with the source map: a segment that claims to be a verbatim copy and is not.
fn map_errors(sources: &SourceSet, composed: &Composed) -> String {
    let segments = composed.map.segments();
    let mut errors = String::new();
    for (index, segment) in segments.iter().enumerate() {
        let end = segments.get(index + 1).map_or(composed.text.len(), |next| next.start as usize);
        let output = &composed.text[segment.start as usize..end];
        if let Some(span) = segment.span.filter(|_| segment.verbatim)
            && !sources.text(span).starts_with(output)
        {
            errors +=
                &format!("the map says that {output:?} is a copy of {:?}\n", sources.text(span));
        }
    }
    errors
}

/// Whether a file of a case belongs to a package.
fn is_source(name: &str) -> bool {
    name.ends_with(".wesl") || (name.ends_with(".wgsl") && name != "expected.wgsl")
}

/// Files on disk that cannot be read: not UTF-8, a link out of the package, and a folder named like
/// a module. Each gives a diagnostic of its own.
fn unreadable() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let outside = tempfile::NamedTempFile::new()?;
    fs::write(
        folder.path().join("main.wesl"),
        "import package::latin1::a;\nimport package::link::b;\nimport package::folder::c;\nconst d = a + b + c;",
    )?;
    fs::write(folder.path().join("latin1.wesl"), b"const a = 1; // caf\xe9")?;
    fs::create_dir(folder.path().join("folder.wesl"))?;
    #[cfg(unix)]
    std::os::unix::fs::symlink(outside.path(), folder.path().join("link.wesl"))?;
    let root = Package {
        name: "app".to_owned(),
        files: Box::new(lamplight_diagnostic::source::Disk::new(folder.path())?),
    };
    let mut sources = SourceSet::default();
    let errors = load(&mut sources, &Packages::new(root, Vec::new()), "main.wesl")
        .expect_err("none of the three files can be read, but loading succeeded");
    let mut found: Vec<&str> = errors.iter().map(|error| error.code.name).collect();
    found.sort_unstable();
    let expected = if cfg!(unix) {
        vec!["missing-module", "not-utf8", "outside-root"]
    } else {
        vec!["missing-module", "missing-module", "not-utf8"]
    };
    if found == expected { Ok(()) } else { Err(render(&sources, &errors, Form::Human).into()) }
}

const LIGHTS: &str = "
import package::shade::{lambert, gloss as shine};
@if(fog) import package::mist::fade;
@if(shadow == soft) import package::shade::soft as visibility;
@elif(shadow == hard) import package::shade::hard as visibility;
@fragment fn main() -> @location(0) vec4f {
    var c = lambert(0.5);
    @if(gloss) c += shine(c);
    @if(fog) c *= fade(c);
    @if(shadow != none) c *= visibility(c);
    @if(lights >= 2) { c += lambert(0.25); }
    @else { c -= lambert(0.125); }
    return vec4f(c * f32(constants::lights));
}
";

const SHADE: &str = "
fn lambert(x: f32) -> f32 { return max(x, 0.0); }
fn gloss(x: f32) -> f32 { @if(gloss && fog) return x; return x * x; }
fn hard(x: f32) -> f32 { return step(0.5, x); }
fn soft(x: f32) -> f32 { return lambert(x) * hard(x); }
";

const MIST: &str =
    "fn fade(x: f32) -> f32 { return lambert(x); } fn lambert(x: f32) -> f32 { return x; }";

fn lights() -> (SourceSet, Graph) {
    let texts = [("main.wesl", LIGHTS), ("shade.wesl", SHADE), ("mist.wesl", MIST)];
    let files = texts.map(|(path, text)| (path.to_owned(), text.to_owned()));
    let root = Package { name: "app".to_owned(), files: Box::new(Memory(files.into())) };
    let mut sources = SourceSet::default();
    let graph = load(&mut sources, &Packages::new(root, Vec::new()), "main.wesl")
        .expect("the modules of this test have no errors");
    (sources, graph)
}

/// Does not compile unless a graph can be shared between threads.
const _: fn() = || {
    fn shared<T: Send + Sync>() {}
    shared::<Graph>();
};

/// Every choice of settings is composed from two graphs, with the settings inserted in two orders.
/// Both give the same bytes and the same reads. Choices with equal reads have equal texts, which the
/// cache relies on: a setting that was not read makes no difference.
fn permutations() -> Result<(), Failed> {
    let ((_, graph), (_, again)) = (lights(), lights());
    let mut by_reads: BTreeMap<Vec<(String, Setting)>, String> = BTreeMap::new();
    let mut count = 0;
    for choice in 0..480u32 {
        let flag = |bit: u32| Setting::Bool(choice >> bit & 1 == 1);
        let shadow = ["none", "hard", "soft"][(choice / 32 % 3) as usize];
        let mut values = vec![
            ("fog", flag(0)),
            ("gloss", flag(1)),
            ("unread", flag(2)),
            ("other", flag(3)),
            ("spare", flag(4)),
            ("shadow", Setting::Name(shadow.to_owned())),
            ("lights", Setting::Int(i64::from(choice / 96))),
        ];
        let forward = compose(&graph, &settings(&values), &Options::default()).expect("composes");
        values.rotate_left(choice as usize % 7);
        values.reverse();
        let backward = compose(&again, &settings(&values), &Options::default()).expect("composes");
        if forward.text != backward.text
            || forward.reads != backward.reads
            || forward.map.segments() != backward.map.segments()
        {
            return Err(format!("choice {choice} composed twice gives two results").into());
        }
        naga::front::wgsl::parse_str(&forward.text)
            .map_err(|error| error.emit_to_string(&forward.text))?;
        if by_reads.entry(forward.reads).or_insert_with(|| forward.text.clone()) != &forward.text {
            let what = "has the reads of an earlier choice, but another text";
            return Err(format!("choice {choice} {what}").into());
        }
        count += 1;
    }
    let distinct = by_reads.len();
    if distinct == 60 {
        Ok(())
    } else {
        Err(format!("{distinct} distinct texts of {count} choices, expected 60").into())
    }
}

fn settings(values: &[(&str, Setting)]) -> Settings {
    let shadow = ["none", "hard", "soft"].map(str::to_owned).to_vec();
    Settings {
        values: values.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect(),
        enums: Arc::new([("shadow".to_owned(), shadow)].into()),
        integers: ["lights".to_owned()].into(),
        ..Settings::default()
    }
}

/// Texts that are cut off, have a piece removed or inserted, or are hostile: each gives a text or
/// diagnostics, never a panic.
fn mutilated() -> Result<(), Failed> {
    let mut texts: Vec<String> = Vec::new();
    for at in 0..LIGHTS.len() {
        texts.push(LIGHTS[..at].to_owned());
        texts.push(format!("{}{}", &LIGHTS[..at], &LIGHTS[(at + 3).min(LIGHTS.len())..]));
        texts.push(format!("{}@if({}", &LIGHTS[..at], &LIGHTS[at..]));
    }
    texts.extend(
        ["(", "{", "@if(", "!", "/*", "fn f() {", "@if(a) ", "import a::", "a::"]
            .map(|piece| piece.repeat(100_000)),
    );
    texts.push(format!("@if({}a) fn f() {{}}", "!".repeat(300_000)));
    texts.push(format!("@if({}a) fn f() {{}}", "a && ".repeat(200_000)));
    texts.push(format!("fn f() {{ {} }}", "if a {} else ".repeat(100_000) + "{}"));
    texts.push(format!("@if(a) const a = 1; {}", "@elif(a) const a = 1; ".repeat(50_000)));
    texts.push(
        (0..2000)
            .map(|index| format!("import a{}::b as a{index};\n", index + 1))
            .collect::<String>()
            + "const c = a0::x;",
    );
    for text in texts {
        let files = [
            ("main.wesl".to_owned(), text),
            ("shade.wesl".to_owned(), SHADE.to_owned()),
            ("mist.wesl".to_owned(), MIST.to_owned()),
        ];
        let root = Package { name: "app".to_owned(), files: Box::new(Memory(files.into())) };
        let mut sources = SourceSet::default();
        let settings = settings(&[
            ("fog", Setting::Bool(true)),
            ("gloss", Setting::Bool(true)),
            ("a", Setting::Bool(false)),
        ]);
        let options = Options { keep: Keep::All, ..Options::default() };
        let outcome = load(&mut sources, &Packages::new(root, Vec::new()), "main.wesl")
            .and_then(|graph| compose(&graph, &settings, &options));
        if let Err(errors) = outcome {
            let rendered = render(&sources, &errors, Form::Short);
            assert!(!errors.is_empty() && !rendered.is_empty(), "a failure without a diagnostic");
        }
    }
    Ok(())
}

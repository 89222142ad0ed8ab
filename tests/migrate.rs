//! Sources of `naga_oil` that are rewritten to WESL. naga must read the same modules from them as
//! from what `naga_oil` composes, and no input may cause a panic.

#[path = "../bench/src/alike.rs"]
mod alike;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use lamplight::migrate::{self, Migrated};
use lamplight::source::{Disk, Files as _, SourceSet};
use libtest_mimic::{Failed, Trial};

use crate::snapshot;

type Outcome = Result<(), Failed>;

type Run = fn() -> Outcome;

const TESTS: &[(&str, Run)] = &[
    ("text", text),
    ("addresses", addresses),
    ("blocks", blocks),
    ("same_modules", same_modules),
    ("mutants", mutants),
    ("next_to_originals", next_to_originals),
    ("many_values_in_one_line", one_line),
];

pub fn tests() -> Vec<Trial> {
    let test = |(name, run): &(&str, Run)| Trial::test(format!("migrate::{name}"), *run);
    TESTS.iter().map(test).collect()
}

/// Ten times the values in one line take ten times the steps.
fn one_line() -> Outcome {
    let steps = |count: usize| {
        let before = lamplight::limits::steps_taken();
        let text = format!("fn f() -> i32 {{ return {}0; }}\n", "#{A}+".repeat(count));
        migrated(&[("a.wgsl".to_owned(), text)].into());
        lamplight::limits::steps_taken() - before
    };
    let (one, ten) = (steps(1_000), steps(10_000));
    match one >= 1_000 && ten <= 12 * one {
        true => Ok(()),
        false => Err(format!("{one} steps for 1,000 values, {ten} for 10,000").into()),
    }
}

fn engine() -> Result<BTreeMap<String, String>, Failed> {
    let disk = Disk::new(snapshot::root().join("tests/migrate/engine"))?;
    let read = |path: String| match disk.read(&path) {
        Ok(Some(text)) => Ok((path, text)),
        found => Err(format!("{path}: {found:?}").into()),
    };
    disk.list(&["wgsl"]).into_iter().map(read).collect()
}

fn migrated(files: &BTreeMap<String, String>) -> Migrated {
    let mut sources = SourceSet::default();
    let added: Vec<_> = files
        .iter()
        .map(|(path, text)| (path.clone(), sources.add(path.as_str(), text.as_str())))
        .collect();
    migrate::naga_oil(&sources, &added)
}

/// The rewritten files are those of the snapshot, with their comments and layout.
fn text() -> Outcome {
    let found = migrated(&engine()?);
    let messages: Vec<&str> = found.diagnostics.iter().map(|one| one.message.as_str()).collect();
    let mut text = format!(
        "features {:?}\nnumbers {:?}\nconstants {:?}\ndiagnostics {messages:?}\n",
        found.features, found.numbers, found.constants
    );
    for (path, file) in &found.files {
        text += &format!("\n=== {path}\n{file}");
    }
    snapshot::check("migrate", "engine", &text)
}

/// Files that are imported by the address that they have in Bevy; the slashes begin no comment.
fn addresses() -> Outcome {
    let main = "#import \"embedded://lib/u.wgsl\"::foo // why\n#import \"w.wgsl\" as w\n\
                fn fs() -> f32 { return foo() + w::bar(); }\n";
    let files = [
        ("main.wgsl", main),
        ("src/lib/u.wgsl", "fn foo() -> f32 { return 1.0; }\n"),
        ("w.wgsl", "fn bar() -> f32 { return 1.0; }\n"),
    ];
    let found = migrated(&files.map(|(path, text)| (path.to_owned(), text.to_owned())).into());
    let expected = "import package::src::lib::u::foo; // why\nimport package::w;\n\
                    fn fs() -> f32 { return foo() + w::bar(); }\n";
    match found.files.get("main.wgsl") {
        Some(text) if text == expected && found.diagnostics.is_empty() => Ok(()),
        text => Err(format!("{text:?}, {:?}", found.diagnostics).into()),
    }
}

/// `wesl` 0.4, which Bevy has, reads no braces around declarations under a condition, and ends the
/// scope of locals at braces around statements.
fn blocks() -> Outcome {
    let main = "#ifdef A\nconst X = 1.0;\nconst Y = 2.0;\n#else\nconst X = 3.0;\n#endif\n\
                fn f() -> f32 {\n    var sum = X;\n#ifdef A\n    sum += Y;\n    sum *= 2.0;\n#endif\n\
                #ifdef A\n#ifdef B\n    let k = 1.0;\n    sum += k;\n#else\n    let k = 2.0;\n#endif\n    \
                sum -= k;\n#endif\n    return sum;\n}\n";
    let found = migrated(&[("main.wgsl".to_owned(), main.to_owned())].into());
    let expected = "@if(A) const X = 1.0;\n@if(A) const Y = 2.0;\n@if(!A) const X = 3.0;\n\
                    fn f() -> f32 {\n    var sum = X;\n@if(A) {\n    sum += Y;\n    sum *= 2.0;\n}\n    \
                    @if(A && B) let k = 1.0;\n    @if(A && B) sum += k;\n    \
                    @if(A && !B) let k = 2.0;\n    @if(A) sum -= k;\n    return sum;\n}\n";
    match found.files.get("main.wgsl") {
        Some(text) if text == expected => Ok(()),
        text => {
            Err(format!("{}\n{:?}", text.cloned().unwrap_or_default(), found.diagnostics).into())
        }
    }
}

/// Every choice of shader defs gives the module that `naga_oil` composes from the original files.
/// `cargo xtask bench migrate tests/migrate/engine tests/migrate/naga_oil.txt` recorded these modules
/// as fingerprints.
fn same_modules() -> Outcome {
    let files = engine()?;
    let found = migrated(&files);
    let (packages, prefixes) = (alike::packages(&found), alike::prefixes(&found));
    let recorded = fs::read_to_string(snapshot::root().join("tests/migrate/naga_oil.txt"))?;
    let choices = alike::choices(&found);
    if choices.len() != 32 || recorded.lines().count() != choices.len() {
        return Err(format!(
            "{} choices, {} recorded, expected 32",
            choices.len(),
            recorded.lines().count()
        )
        .into());
    }
    for (defs, theirs) in choices.iter().zip(recorded.lines()) {
        let ours = alike::ours(&packages, "main.wgsl", &found, &files["main.wgsl"], defs)
            .map_err(|why| format!("{defs:?}: {why}"))?;
        let ours = alike::normalised(ours, &prefixes);
        if !theirs.starts_with(&alike::fingerprint(&ours)) {
            return Err(format!("{defs:?}: recorded is {theirs}, found:\n{ours:#?}").into());
        }
    }
    Ok(())
}

/// Files in which lines were removed, repeated or swapped. For each file there is a rewritten file or
/// a diagnostic, and no panic.
fn mutants() -> Outcome {
    let files = engine()?;
    let mut state = 7_u64;
    let mut random = |bound: usize| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % bound.max(1)
    };
    let mut whole = 0;
    for _ in 0..400 {
        let mut mutant = files.clone();
        let path = files.keys().nth(random(files.len())).ok_or("no file")?;
        let mut lines: Vec<&str> = files[path].lines().collect();
        for _ in 0..1 + random(3) {
            let (at, to) = (random(lines.len()), random(lines.len()));
            match random(3) {
                0 => drop(lines.remove(at)),
                1 => lines.insert(to, lines[at]),
                _ => lines.swap(at, to),
            }
        }
        mutant.insert(path.clone(), lines.join("\n"));
        let found = migrated(&mutant);
        let refused =
            found.diagnostics.iter().filter(|one| one.code.name == "not-migrated").count();
        if found.files.len() + refused < files.len() {
            let what = "has neither a rewritten file nor a diagnostic";
            return Err(format!("a file {what}, with this {path}:\n{}", mutant[path]).into());
        }
        whole += usize::from(refused == 0);
    }
    match whole {
        100..=390 => Ok(()),
        _ => {
            let what = "expected 100 to 390, so that both cases are tried";
            Err(format!("{whole} of 400 changed packages are migrated, {what}").into())
        }
    }
}

/// The command writes new files beside the originals. A second run replaces the files of the first,
/// and no others.
fn next_to_originals() -> Outcome {
    let folder = tempfile::tempdir()?;
    let files = engine()?;
    for (path, text) in &files {
        let path = folder.path().join(path);
        fs::create_dir_all(path.parent().ok_or("no folder")?)?;
        fs::write(path, text)?;
    }
    expect(&run(folder.path())?, 0, "4 of 4 files migrated")?;
    expect(&run(folder.path())?, 0, "4 of 4 files migrated")?;
    for (path, text) in &files {
        if fs::read_to_string(folder.path().join(path))? != *text {
            return Err(format!("the original file {path} was changed").into());
        }
    }
    let arguments = ["compose", "main.wesl", "--set", "LIGHTS=3", "--feature", "SPOT"];
    let constants = ["--constant", "GROUP=1,TAPS=4,GAIN=2"];
    let composed = lamplight(folder.path(), &[&arguments[..], &constants[..]].concat())?;
    expect(&composed, 0, "const COUNT: u32 = 3u;")?;
    fs::write(folder.path().join("main.wesl"), "// mine")?;
    expect(&run(folder.path())?, 1, "")?;
    match fs::read_to_string(folder.path().join("main.wesl"))?.as_str() {
        "// mine" => Ok(()),
        _ => Err("main.wesl was edited by the user, and `migrate` replaced it".into()),
    }
}

fn run(folder: &Path) -> Result<Output, Failed> {
    lamplight(folder, &["migrate", "--from", "naga_oil", "."])
}

fn lamplight(folder: &Path, arguments: &[&str]) -> Result<Output, Failed> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
    Ok(command.args(arguments).current_dir(folder).output()?)
}

/// Fails, with the place of the call, unless a command ended with a code and printed some words.
#[track_caller]
fn expect(output: &Output, code: i32, expected: &str) -> Outcome {
    let place = std::panic::Location::caller();
    let out = String::from_utf8_lossy(&output.stdout);
    match output.status.code() == Some(code) && out.contains(expected) {
        true => Ok(()),
        false => {
            let expected = format!("{place}: expected exit code {code} and `{expected}`");
            let found = format!("{:?}: {out}", output.status);
            Err(format!("{expected}, found {found}{}", String::from_utf8_lossy(&output.stderr))
                .into())
        }
    }
}

//! The typed keys that `lamplight keys` writes. They compile, and give the same keys and numbers as
//! `permute`. A key's number never changes, because engines store it.

mod documentation;
mod programs;

use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

use lamplight::diagnostic::render::{Form, render};
use lamplight::keys;
use lamplight::permute::{Lock, Manifest, Mode, lock, manifest};
use lamplight::project;
use lamplight::source::SourceSet;
use libtest_mimic::{Failed, Trial};

use programs::{c_main, rust_main, typescript_main};

type Outcome = Result<(), Failed>;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("keys::rust", || in_language(&RUST)),
        Trial::test("keys::c", || in_language(&C)),
        Trial::test("keys::typescript", || in_language(&TYPESCRIPT)),
        Trial::test("keys::awkward_names_in_rust", || {
            awkward(
                "rust",
                "keys.rs",
                &["rustc", "--edition", "2024", "--crate-type", "lib", "--emit", "metadata"],
            )
        }),
        Trial::test("keys::awkward_names_in_c", || {
            awkward(
                "c",
                "keys.h",
                &["cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-fsyntax-only"],
            )
        }),
        Trial::test("keys::documentation_is_no_code", documentation::is_no_code),
        Trial::test("keys::lock_is_up_to_date", up_to_date),
        Trial::test("keys::growth_changes_no_key", growth),
        Trial::test("keys::incomplete_lock_gives_no_numbers", incomplete),
    ]
}

/// How the keys of a language are tried: a program that uses them. It reads a line of ordinals for
/// each key and prints the key and its number.
struct Harness {
    language: &'static str,
    file: &'static str,
    main: fn(&Manifest) -> String,
    source: &'static str,
    /// The command that compiles the program. `{}` stands for the folder.
    compile: &'static [&'static str],
    /// The command that runs the program. `{}` stands for the folder.
    run: &'static [&'static str],
    /// A change of the written keys before they are compiled.
    edit: fn(String) -> String,
}

const RUST: Harness = Harness {
    language: "rust",
    file: "keys.rs",
    main: rust_main,
    source: "main.rs",
    compile: &[
        "rustc",
        "--edition",
        "2024",
        "-Dwarnings",
        "-Cdebuginfo=0",
        "-o",
        "{}/main",
        "{}/main.rs",
    ],
    run: &["{}/main"],
    edit: |text| text,
};

const C: Harness = Harness {
    language: "c",
    file: "keys.h",
    main: c_main,
    source: "main.c",
    compile: &[
        "cc",
        "-std=c99",
        "-Wall",
        "-Wextra",
        "-Werror",
        "-pedantic",
        "-o",
        "{}/main",
        "{}/main.c",
    ],
    run: &["{}/main"],
    edit: |text| text,
};

/// The test strips the types, because node does so itself only since version 22.
const TYPESCRIPT: Harness = Harness {
    language: "ts",
    file: "keys.mjs",
    main: typescript_main,
    source: "main.mjs",
    compile: &["node", "--check", "{}/keys.mjs"],
    run: &["node", "{}/main.mjs"],
    edit: stripped,
};

/// A lock file to which values were added later. It has values and an axis that the manifest no
/// longer has.
const OLDER_LOCK: &str = "p gone no yes\np lamp none point old\np lit false true\np moving off on\n\
    p lamp + spot\np count 4 1\np lamp + area sky\n";
const NEWER: &str = "[program.p]\nwesl = \"a.wesl\"\n[program.p.axis]\n\
    lamp = { values = [\"sky\", \"none\", \"spot\", \"area\", \"point\"], default = \"spot\" }\n\
    lit = { values = [true, false] }\ncount = { values = [1, 4, 10] }\n\
    moving = { values = [\"on\", \"off\"], mode = \"dynamic\" }\n";

/// With a lock file that lacks a value, here `count=10`, two keys would have the same number. So
/// the written keys have no numbers.
fn incomplete() -> Outcome {
    let mut sources = SourceSet::default();
    let id = sources.add("lamplight.lock", OLDER_LOCK);
    let older =
        lock::parse(&sources, id).map_err(|problems| render(&sources, &problems, Form::Human))?;
    let newer = parsed(NEWER)?;
    for name in ["rust", "c", "ts"] {
        let language = keys::find(name).ok_or("no such language")?;
        let with = |lock: Option<&Lock>| keys::write(&newer, lock, language);
        if with(Some(&older)) != with(None) || with(Some(&extended(&older, &newer))) == with(None) {
            return Err(format!("{name}: only a complete lock should give numbers").into());
        }
    }
    Ok(())
}

/// The keys of a language agree with `permute`, for the library and for a manifest that has changed
/// since its lock file was begun.
fn in_language(harness: &Harness) -> Outcome {
    let (manifest, lock) = (library()?, read_lock()?);
    of_manifest(harness, &manifest, &lock)?;
    let mut sources = SourceSet::default();
    let id = sources.add("lamplight.lock", OLDER_LOCK);
    let older =
        lock::parse(&sources, id).map_err(|problems| render(&sources, &problems, Form::Human))?;
    let newer = parsed(NEWER)?;
    of_manifest(harness, &newer, &extended(&older, &newer))
}

/// The program of a language gives the key and the number of every permutation as `permute` does, and
/// gets the key back from the number.
fn of_manifest(harness: &Harness, manifest: &Manifest, lock: &Lock) -> Outcome {
    let folder = tempfile::tempdir()?;
    let language = keys::find(harness.language).ok_or("no such language")?;
    std::fs::write(
        folder.path().join(harness.file),
        (harness.edit)(keys::write(manifest, Some(lock), language)),
    )?;
    std::fs::write(folder.path().join(harness.source), (harness.main)(manifest))?;
    execute(folder.path(), harness.compile, "")?;
    let (mut input, mut expected) = (String::new(), String::new());
    for (index, program) in manifest.programs.iter().enumerate() {
        for point in program.space.enumerate() {
            let ordinals: Vec<String> = point.ordinals().iter().map(ToString::to_string).collect();
            input += &format!("{index} {}\n", ordinals.join(" "));
            let number = lock.dense(&program.name, &program.space, &point).ok_or("no number")?;
            expected += &format!("{} {number} true\n", program.space.key(&point));
        }
    }
    let found = execute(folder.path(), harness.run, &input)?;
    if found.lines().eq(expected.lines()) {
        println!("{}: {} keys", harness.language, expected.lines().count());
        return Ok(());
    }
    let differing = found.lines().zip(expected.lines()).find(|(found, expected)| found != expected);
    let counts = format!("{} of {} lines", found.lines().count(), expected.lines().count());
    let what = format!("the first that differ (found, expected): {differing:?}");
    Err(format!("{}: {counts}; {what}", harness.language).into())
}

fn execute(folder: &Path, command: &[&str], input: &str) -> Result<String, Failed> {
    let words: Vec<String> =
        command.iter().map(|word| word.replace("{}", &folder.to_string_lossy())).collect();
    let mut child = Command::new(&words[0])
        .args(&words[1..])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| format!("{}: {error}", words[0]))?;
    let mut stdin = child.stdin.take().ok_or("no input")?;
    let input = input.to_owned();
    let writer = std::thread::spawn(move || stdin.write_all(input.as_bytes()));
    let output = child.wait_with_output()?;
    let _ = writer.join();
    if output.status.success() {
        return Ok(String::from_utf8(output.stdout)?);
    }
    Err(format!(
        "{}: {}{}",
        words[0],
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    )
    .into())
}

fn library() -> Result<Manifest, Failed> {
    let found = project::library_manifest()
        .map_err(|(sources, problems)| render(&sources, &problems, Form::Human))?;
    Ok(found.1)
}

/// Removes the types from TypeScript, as a runtime does: interfaces, aliases and annotations.
fn stripped(text: String) -> String {
    // Numbers that only a `bigint` holds have the same annotations otherwise.
    let same = [("bigint", "number"), ("BigField[]", "Field[]"), ("BigDigit[]", "Digit[]")];
    let text = same.iter().fold(text, |text, (big, small)| text.replace(big, small));
    let mut out = String::new();
    let mut inside = false;
    for line in text.lines() {
        inside |= line.starts_with("export interface");
        if !inside && !line.starts_with("type ") {
            let line = line.replace(
                "(key: object, axes: readonly (readonly [string, Value])[]): string",
                "(key, axes)",
            );
            let line = line.replace(" as Record<string, Value | undefined>", "");
            let line = line.replace(
                "(key: object, start: number, fields: readonly Field[]): number",
                "(key, start, fields)",
            );
            let line = line.replace(
                "(number: number, digits: readonly Digit[]): Record<string, Value> | undefined",
                "(number, digits)",
            );
            let line =
                line.replace("reduce<number>", "reduce").replace(": Record<string, Value> =", " =");
            let line = match line.split_once("FromOrdinal(number: number): ") {
                Some((start, _)) => format!("{start}FromOrdinal(number) {{"),
                None => line,
            };
            let line = match (line.find("const key: "), line.find(" | undefined = ")) {
                (Some(start), Some(end)) => {
                    format!("{}const key{}", &line[..start], &line[end + " | undefined".len()..])
                }
                _ => line,
            };
            let end = line.find(" = {}): string").or_else(|| line.find(" = {}): number"));
            let line = match (line.find("(key: "), end) {
                (Some(start), Some(end)) => {
                    let rest = line[end..].replace("): string", ")").replace("): number", ")");
                    format!("{}(key{rest}", &line[..start])
                }
                _ => line,
            };
            out += &format!("{line}\n");
        }
        inside &= line != "}";
    }
    out
}

const AWKWARD: &str = r#"
[program.type]
wesl = "a.wesl"
[program.type.axis]
key = { values = ["self", "Key", "a_b", "ab", "n1"], doc = "Ends */ here.\rAnd \u2028here." }
constructor = { values = ["x", "y"] }
int = { values = [false, true], default = true }
key_bytes = { values = [-1, 1, 9223372036854775807] }
string = { values = ["i3", "none"] }
dyn = { values = ["match", "crate"] }
option = { values = ["some", "ok"] }
moving = { values = ["on", "off"], mode = "dynamic" }
[program.type_key]
wesl = "a.wesl"
[program.type_key.axis.bytes]
values = ["x"]
"#;

fn parsed(text: &str) -> Result<Manifest, Failed> {
    let mut sources = SourceSet::default();
    let id = sources.add("lamplight.toml", text);
    Ok(manifest::parse(&sources, id)
        .map_err(|problems| render(&sources, &problems, Form::Human))?)
}

/// Keys compile even if axes and values have names that are keywords, or that collide.
fn awkward(language: &str, file: &str, command: &[&str]) -> Outcome {
    let manifest = parsed(AWKWARD)?;
    let folder = tempfile::tempdir()?;
    let path = folder.path().join(file);
    std::fs::write(
        &path,
        keys::write(
            &manifest,
            Some(&extended(&Lock::default(), &manifest)),
            keys::find(language).ok_or("no such language")?,
        ),
    )?;
    let path = path.to_string_lossy().into_owned();
    let mut command = command.to_vec();
    let metadata = folder.path().join("out").to_string_lossy().into_owned();
    if language == "rust" {
        command.extend(["-o", &metadata]);
    }
    command.push(&path);
    execute(folder.path(), &command, "").map(|_| ())
}

const MANIFEST: &str = include_str!("../shaderlib/lamplight.toml");
const LOCK: &str = include_str!("../shaderlib/lamplight.lock");

fn read_lock() -> Result<Lock, Failed> {
    let mut sources = SourceSet::default();
    let id = sources.add("lamplight.lock", LOCK);
    Ok(lock::parse(&sources, id).map_err(|problems| render(&sources, &problems, Form::Human))?)
}

fn extended(lock: &Lock, manifest: &Manifest) -> Lock {
    manifest
        .programs
        .iter()
        .fold(lock.clone(), |lock, program| lock.extended(&program.name, &program.space))
}

/// The library's lock file has every axis and value of its manifest.
fn up_to_date() -> Outcome {
    let text = extended(&read_lock()?, &library()?).to_string();
    if text == LOCK {
        Ok(())
    } else {
        let command = "lamplight keys --lock --manifest shaderlib/lamplight.toml";
        Err(format!("shaderlib/lamplight.lock is out of date: run `{command}` and commit it")
            .into())
    }
}

/// Every shipped key keeps its text and its number when an axis and values are added. Otherwise an
/// engine with stored keys would load other shaders.
fn growth() -> Outcome {
    let (old, lock) = (parsed(MANIFEST)?, read_lock()?);
    let grown = MANIFEST
        .replace("values = [\"lambert\", \"half_lambert\"", "values = [\"burley\", \"lambert\", \"half_lambert\"")
        .replace("values = [1, 4, 10]", "values = [1, 2, 4, 10, 32]")
        .replace(
            "[program.forward.axis.cone]",
            "[program.forward.axis.strands]\nvalues = [\"none\", \"hair\"]\n\n[program.forward.axis.cone]",
        );
    let new = parsed(&grown)?;
    let new_lock = extended(&lock, &new);
    let mut count = 0;
    for program in &old.programs {
        let after = new.program(&program.name).ok_or("a program is gone")?;
        for point in program.space.enumerate() {
            let (key, dense) =
                (program.space.key(&point), lock.dense(&program.name, &program.space, &point));
            let mut sources = SourceSet::default();
            let id = sources.add("key", key.as_str());
            let text = lamplight::permute::Quoted::whole(&sources, id);
            let same = lamplight::permute::key::parse(&after.space, &text)
                .map_err(|problems| render(&sources, &problems, Form::Human))?;
            if after.space.key(&same) != key
                || new_lock.dense(&program.name, &after.space, &same) != dense
                || dense.is_none()
            {
                let what = format!("its text or its number {dense:?} changed");
                return Err(format!("{} {key}: {what}", program.name).into());
            }
            count += 1;
        }
    }
    let dynamic = old
        .programs
        .iter()
        .flat_map(|program| program.space.axes())
        .filter(|axis| axis.mode == Mode::Dynamic)
        .count();
    println!("{count} keys kept, {dynamic} dynamic axes");
    Ok(())
}

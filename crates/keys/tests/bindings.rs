//! Bindings compile in each language, and their compilers confirm the offsets of the reflection.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

use lamplight_bundle::{Binding, Bundle, EntryContents, Error, Language};
use lamplight_keys::bindings::{self, Request};
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;

/// A language, the file that includes its bindings, and the command that compiles this file.
struct Harness {
    name: &'static str,
    language: &'static str,
    file: &'static str,
    main: (&'static str, &'static str),
    command: &'static [&'static str],
}

const C_MAIN: &str = "#include \"lit.h\"
#include <stdio.h>
int main(void)
{
    lit_camera camera = {{{0}}, {{0}}};
    lit_lamps lamps = {{{{0}, 0}}};
    lamps.all[1].kind = LIT_LAMPS_BINDING;
    printf(\"%d %d %d\\n\", (int)(sizeof camera + sizeof lamps), LIT_INPUT_POSITION,
           (int)(sizeof good_bundle > 1000));
    return 0;
}
";

const CPP_MAIN: &str = "#include \"lit.h\"
#include <cstdio>
int main()
{
    lit::camera camera{};
    lit::lamps lamps{};
    lamps.all[1].kind = lit::LAMPS_BINDING;
    std::printf(\"%d %d %d\\n\", int(sizeof camera + sizeof lamps), int(lit::INPUT_POSITION),
                int(sizeof good_bundle > 1000));
}
";

const RUST_MAIN: &str = "mod made { include!(\"lit.rs\"); }
fn main() {
    let camera = made::lit::Camera::default();
    let mut lamps = made::lit::Lamps::ZERO;
    lamps.all[1].kind = made::lit::LAMPS.1;
    let bytes = camera.as_bytes().len() + lamps.as_bytes().len();
    println!(\"{bytes} {} {}\", made::lit::INPUT_POSITION, (made::GOOD_BUNDLE.len() > 1000) as u32);
}
";

const WARNINGS: &[&str] = &["-Wall", "-Wextra", "-Wpedantic", "-Werror"];

const RUSTC: [&str; 5] = ["rustc", "--edition", "2024", "-Dwarnings", "-Cdebuginfo=0"];

const HARNESSES: [Harness; 5] = [
    c_harness("gcc_c99", &["gcc", "-std=c99"]),
    c_harness("clang_c11", &["clang", "-std=c11"]),
    cpp_harness("gcc_cpp11", &["g++", "-std=c++11"]),
    cpp_harness("clang_cpp17", &["clang++", "-std=c++17"]),
    Harness {
        name: "rust",
        language: "rust",
        file: "lit.rs",
        main: ("main.rs", RUST_MAIN),
        command: &RUSTC,
    },
];

const fn c_harness(name: &'static str, command: &'static [&'static str]) -> Harness {
    Harness { name, language: "c", file: "lit.h", main: ("main.c", C_MAIN), command }
}

const fn cpp_harness(name: &'static str, command: &'static [&'static str]) -> Harness {
    Harness { name, language: "cpp", file: "lit.h", main: ("main.cpp", CPP_MAIN), command }
}

pub fn tests() -> Vec<Trial> {
    let mut tests: Vec<Trial> = HARNESSES
        .iter()
        .map(|harness| {
            Trial::test(format!("bindings::compile::{}", harness.name), || compiles(harness))
        })
        .collect();
    tests.extend(HARNESSES.iter().map(|harness| {
        let name = format!("bindings::other_layouts_do_not_compile::{}", harness.name);
        Trial::test(name, || refuses(harness))
    }));
    tests.extend(HARNESSES.iter().map(|harness| {
        let name = format!("bindings::hard_names_compile::{}", harness.name);
        Trial::test(name, || compiles_hard_names(harness))
    }));
    tests.push(Trial::test("bindings::typescript", typescript));
    tests.push(
        Trial::test("bindings::typescript_compiles", typescript_compiles)
            .with_ignored_flag(!root().join(TSC).exists()),
    );
    tests.push(Trial::test("bindings::unknown_names_are_errors", unknown));
    tests.push(Trial::test("bindings::members_out_of_range", members_out_of_range));
    tests
}

fn bundle() -> Result<Bundle, Error> {
    Bundle::open(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/bundles/good"))
}

fn written(language: &str) -> Result<String, Failed> {
    let language = bindings::find(language).ok_or("no such language")?;
    let bytes = [7; 2000];
    let programs = ["lit".to_owned()];
    let request =
        Request { programs: &programs, source: None, embedded: Some(("good_bundle", &bytes)) };
    Ok(bindings::write(&bundle()?, &request, language)?)
}

/// Compiles the file of a harness with these bindings, and returns what the program prints.
fn compiled(harness: &Harness, text: &str) -> Result<String, Failed> {
    let folder = tempfile::tempdir()?;
    let at = |name: &str| -> PathBuf { folder.path().join(name) };
    std::fs::write(at(harness.file), text)?;
    std::fs::write(at(harness.main.0), harness.main.1)?;
    let mut command = Command::new(harness.command[0]);
    command.args(&harness.command[1..]).arg(at(harness.main.0)).arg("-o").arg(at("main"));
    if harness.language != "rust" {
        command.args(WARNINGS);
    }
    let output = command.output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    let output = Command::new(at("main")).output()?;
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// 112 bytes of `camera` and the 80 of the larger of both `lamps`; the location 0; a bundle.
fn compiles(harness: &Harness) -> Outcome {
    let said = compiled(harness, &written(harness.language)?)?;
    if said.trim() == "192 0 1" { Ok(()) } else { Err(format!("it prints `{said}`").into()) }
}

/// Without the padding of a matrix's columns, or with a field of another size, it does not compile.
fn refuses(harness: &Harness) -> Outcome {
    let text = written(harness.language)?;
    let changes = match harness.language {
        "rust" => [("[[f32; 4]; 3]", "[[f32; 3]; 3]"), ("kind: u32", "kind: u64")],
        _ => [("normal[3][4]", "normal[3][3]"), ("uint32_t kind", "uint64_t kind")],
    };
    for (right, wrong) in changes {
        if !text.contains(right) {
            return Err(format!("there is no `{right}` in {text}").into());
        }
        if compiled(harness, &text.replace(right, wrong)).is_ok() {
            return Err(format!("`{wrong}` compiles").into());
        }
    }
    Ok(())
}

/// The compiler that the site installs. Without it, its test is ignored.
const TSC: &str = "site/node_modules/.bin/tsc";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn typescript() -> Outcome {
    let text = written("ts")?;
    for part in
        ["export type LitCamera = {", "\"normal\": ArrayLike<number>;", "Partial<LitLamp>[]"]
    {
        if !text.contains(part) {
            return Err(format!("there is no `{part}` in {text}").into());
        }
    }
    Ok(())
}

fn typescript_compiles() -> Outcome {
    let (text, root) = (written("ts")?, root());
    let folder = tempfile::tempdir()?;
    let place = folder.path().join("node_modules/@lamplight");
    std::fs::create_dir_all(&place)?;
    let package = root.join("packages/bundle").canonicalize()?;
    std::os::unix::fs::symlink(package, place.join("bundle"))?;
    let main = "import { litCameraBytes } from \"./lit.js\";
export const bytes: ArrayBuffer = litCameraBytes({ normal: [1, 2, 3, 4, 5, 6, 7, 8, 9] });\n";
    std::fs::write(folder.path().join("lit.ts"), &text)?;
    std::fs::write(folder.path().join("main.ts"), main)?;
    let mut command = Command::new(root.join(TSC));
    command.current_dir(folder.path()).args(["--strict", "--noEmit", "--target", "es2022"]);
    command.args(["--module", "nodenext", "--moduleResolution", "nodenext", "main.ts"]);
    let output = command.output()?;
    if output.status.success() {
        return Ok(());
    }
    Err(String::from_utf8_lossy(&output.stdout).into_owned().into())
}

fn unknown() -> Outcome {
    let cases = [
        ("lot", None, "no program `lot`; it has: blank, lit, write"),
        ("write", Some(Language::Glsl), "no source language `glsl`; it has: wesl"),
    ];
    let language = bindings::find("c").ok_or("no such language")?;
    for (program, source, part) in cases {
        let programs = [program.to_owned()];
        let request = Request { programs: &programs, source, ..Request::default() };
        match bindings::write(&bundle()?, &request, language) {
            Err(error) if error.to_string().contains(part) => {}
            other => return Err(format!("{program}: {other:?}").into()),
        }
    }
    Ok(())
}

/// Members at the end of what 32 bits can say give a text in every language.
fn members_out_of_range() -> Outcome {
    let changed = changed_bundle(|binding| {
        binding.members.iter_mut().for_each(|member| member.offset = u32::MAX - 3);
    })?;
    for language in bindings::LANGUAGES {
        let text = bindings::write(&changed, &Request::default(), language)?;
        if !text.contains("clip_from_world") {
            return Err(format!("{}: {text}", language.name).into());
        }
    }
    Ok(())
}

/// Names of shaders that mean something else in the language of an engine, or have another style.
fn compiles_hard_names(harness: &Harness) -> Outcome {
    let changed = changed_bundle(|binding| {
        for member in &mut binding.members {
            let name = match member.name.as_str() {
                "clip_from_world" => "clipFromWorld",
                "normal" => "compl",
                _ => "fn",
            };
            member.name = name.to_owned();
        }
        binding.name = if binding.name == "camera" { "not_eq" } else { "loop" }.to_owned();
    })?;
    let language = bindings::find(harness.language).ok_or("no such language")?;
    let text = bindings::write(&changed, &Request::default(), language)?;
    let main = match harness.language {
        "rust" => "mod made { include!(\"lit.rs\"); }\nfn main() {}\n",
        _ => "#include \"lit.h\"\nint main(void) { return 0; }\n",
    };
    compiled(&Harness { main: (harness.main.0, main), ..*harness }, &text).map(drop)
}

/// The bundle with other bindings, and its program `lit` by the name `new`.
fn changed_bundle(change: impl Fn(&mut Binding)) -> Result<Bundle, Failed> {
    let mut contents = bundle()?.contents()?;
    let lit = contents.programs.remove("lit").ok_or("no program `lit`")?;
    contents.programs.insert("new".to_owned(), lit);
    for entries in contents.programs.values_mut().flat_map(|found| found.languages.values_mut()) {
        for entry in entries.values_mut() {
            let mut changed = EntryContents::default();
            for (key, hash) in &entry.keys {
                let mut unit = entry.units.get(hash).ok_or("no unit")?.clone();
                Arc::make_mut(&mut unit.reflection).bindings.iter_mut().for_each(&change);
                let hash = changed.add(unit)?;
                changed.keys.insert(key.clone(), hash);
            }
            *entry = changed;
        }
    }
    let folder = tempfile::tempdir()?;
    lamplight_bundle::write_directory(&contents, folder.path())?;
    // Everything but the shaders is read at once.
    Ok(Bundle::open(folder.path())?)
}

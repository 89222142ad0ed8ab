//! Diagnostics as users meet them: one folder of `tests/diagnostics/` for each case.
//!
//! A case has the files of a package and `command`, whose lines are command lines of `lamplight`,
//! run one after the other in the folder (a line that starts with `#` says what is shown). What
//! they print on standard error, and how they exit, is a snapshot. `hostile` cases are made when
//! they are run, since they are large.

mod hostile;

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use lamplight::diagnostic::codes;
use libtest_mimic::{Failed, Trial};

use crate::snapshot;

pub fn trials() -> Vec<Trial> {
    let case = |(name, path): (String, PathBuf)| {
        Trial::test(format!("diagnostics::{name}"), move || check(&name, &path))
    };
    let mut trials: Vec<Trial> = snapshot::cases("diagnostics").into_iter().map(case).collect();
    trials.push(Trial::test("diagnostics every code has a case", every_code));
    trials.push(Trial::test("diagnostics every code is explained", explained));
    trials.push(Trial::test("diagnostics limits have codes", limits));
    trials.push(Trial::test("diagnostics links and odd bytes", odd_files));
    trials.extend(hostile::trials());
    trials
}

fn check(name: &str, case: &Path) -> Result<(), Failed> {
    // Outputs must not land in the sources, and hidden files above must not matter.
    let folder = tempfile::tempdir()?;
    copy(case, folder.path())?;
    let mut text = String::new();
    for line in
        fs::read_to_string(case.join("command"))?.lines().filter(|line| !line.trim().is_empty())
    {
        writeln!(text, "{line}")?;
        if !line.starts_with('#') {
            let output = run(folder.path(), line)?;
            text += &String::from_utf8(output.stderr)?.replace("lamplight.exe", "lamplight");
            writeln!(text, "=> {}\n", output.status.code().ok_or("killed")?)?;
        }
    }
    snapshot::check(
        "diagnostics",
        name,
        text.lines().map(|line| line.trim_end().to_owned() + "\n").collect::<String>().trim_end(),
    )
}

fn run(folder: &Path, line: &str) -> Result<Output, Failed> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
    command.current_dir(folder).env("COLUMNS", "100").args(line.split_whitespace());
    Ok(command.output()?)
}

fn copy(from: &Path, to: &Path) -> Result<(), Failed> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let (path, name) = (entry.path(), entry.file_name());
        if path.is_dir() {
            copy(&path, &to.join(name))?;
        } else {
            fs::copy(&path, to.join(name))?;
        }
    }
    Ok(())
}

/// What stands between stages that are right, and is told rather than a panic: no input is known
/// that leads to it. The last of them needs a device that fails, the first a space beyond counting.
const INTERNAL: &[&str] = &[
    // No kernel of the library has what a target lacks.
    "executor-lacks",
    // Shown by `render/needs/numbers_are_demanded`.
    "picture-invalid",
    "space-too-complex",
    "unknown-function",
    "untestable-function",
    "bundle-failed",
    "eval-internal",
    "eval-unsupported",
    "fixture-mismatch",
    "executor-failed",
];

/// Codes that are shown in some file of expectations, or that a test of another kind names.
fn every_code() -> Result<(), Failed> {
    let mut shown = String::new();
    for folder in ["snapshots", "tests"] {
        gather(&snapshot::root().join(folder), &mut shown)?;
    }
    let has = |name: &str| {
        [format!("[{name}]"), format!("\"{name}\"")].iter().any(|form| shown.contains(form))
    };
    let missing: BTreeSet<&str> = codes::ALL
        .iter()
        .map(|code| code.name)
        .filter(|name| !has(name) && !INTERNAL.contains(name))
        .collect();
    if missing.is_empty() { Ok(()) } else { Err(format!("no case shows {missing:?}").into()) }
}

/// Limits that files of the repository would be too large to reach.
fn limits() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let write = |name: &str, text: String| fs::write(folder.path().join(name), text);
    write("large.wesl", "/".repeat(5 << 20))?;
    write("many.wesl", (0..500).map(|i| format!("@if(x{i}) fn f{i}() {{}}\n")).collect())?;
    let modules = (0..5).map(|i| {
        write(&format!("m{i}.wesl"), format!("const a = /*{}*/ 1;\n", "x".repeat(4_000_000)))
    });
    modules.collect::<Result<(), _>>()?;
    write("output.wesl", (0..5).map(|i| format!("const a{i} = package::m{i}::a;\n")).collect())?;
    write(
        "functions.wesl",
        (0..4100).map(|i| format!("fn f{i}() {{ f{}(); }}\n", i + 1)).collect::<String>()
            + "fn f4100() {}\n@fragment fn m() { f0(); }",
    )?;
    write("entry.wesl", "@fragment fn f() {}\n".to_owned())?;
    for (line, code) in [
        ("large.wesl", "file-too-large"),
        ("many.wesl", "not-shown"),
        ("output.wesl", "output-too-large"),
    ] {
        let told =
            told(folder.path(), &format!("compose {line} --feature a,b --diagnostics short"))?;
        if !told.contains(&format!("error[{code}]")) || !told.ends_with("=> 1\n\n") {
            return Err(format!("{code}: {told}").into());
        }
    }
    let told =
        told(folder.path(), "compile functions.wesl --target wgsl -o out --diagnostics short")?;
    if told.lines().nth(1)
        != Some(
            "functions.wesl:4097:12: error[limit-exceeded]: more than 4096 functions and structures",
        )
    {
        return Err(format!("functions: {told}").into());
    }
    too_many_files()?;
    unknown_entry_point()
}

fn too_many_files() -> Result<(), Failed> {
    let count = lamplight::source::LIMITS.files + 1;
    let root =
        (0..count).map(|i| format!("import package::m{i}::a as a{i};\n")).collect::<String>();
    let modules = (0..count).map(|i| (format!("m{i}.wesl"), "const a = 1;".to_owned()));
    let files =
        lamplight::source::Memory(modules.chain([("main.wesl".to_owned(), root)]).collect());
    let root = lamplight::source::Package { name: "app".to_owned(), files: Box::new(files) };
    let packages = lamplight::resolve::Packages { root, dependencies: Vec::new() };
    let outcome = lamplight::resolve::wesl::load(
        &mut lamplight::source::SourceSet::default(),
        &packages,
        "main.wesl",
    );
    let errors = outcome.err().ok_or("too many files were accepted")?;
    if errors[0].code.name == "too-many-files" {
        Ok(())
    } else {
        Err(errors[0].message.clone().into())
    }
}

fn unknown_entry_point() -> Result<(), Failed> {
    let (_, composed) = crate::emit::wrap(
        "a.wgsl",
        "@fragment fn f() {}".to_owned(),
        lamplight::bundle::Language::Wesl,
        None,
    );
    let validated =
        lamplight::validate::validate(&composed).map_err(|errors| errors[0].message.clone())?;
    let error = lamplight::emit::emit(&validated, "g", lamplight::bundle::Target::WGSL)
        .err()
        .ok_or("`g` was found")?;
    if error.code.name == "unknown-entry-point" { Ok(()) } else { Err(error.message.into()) }
}

fn gather(folder: &Path, text: &mut String) -> Result<(), Failed> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            gather(&path, text)?;
        } else if path.extension().is_some_and(|extension| {
            ["snap", "err", "txt", "warnings", "rs"].iter().any(|known| extension == *known)
        }) {
            text.push_str(&fs::read_to_string(&path).unwrap_or_default());
        }
    }
    Ok(())
}

/// A title of one line, and something to say.
fn explained() -> Result<(), Failed> {
    let poor = codes::ALL.iter().filter(|code| {
        code.title.is_empty() || code.explanation.len() < 40 || code.title.ends_with('.')
    });
    let poor: Vec<&str> = poor.map(|code| code.name).collect();
    if poor.is_empty() { Ok(()) } else { Err(format!("poorly explained: {poor:?}").into()) }
}

/// What cannot be a file of the repository: links that lead out, bytes that are not UTF-8.
fn odd_files() -> Result<(), Failed> {
    let (folder, outside) = (tempfile::tempdir()?, tempfile::tempdir()?);
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes);
    fs::write(outside.path().join("a.wesl"), "fn a() {}")?;
    write("latin.wesl", b"fn a() {} // caf\xe9\n")?;
    write("latin.frag.glsl", b"#include \"bytes.glsl\"\nvoid main() {}\n")?;
    write("bytes.glsl", &[0xff, 0xfe, 0, 1, 2])?;
    write("link.wesl", b"import package::out::a;\nfn b() { a(); }\n")?;
    write("linked.frag.glsl", b"#include \"out.wesl\"\nvoid main() {}\n")?;
    write("fine.wesl", b"fn a() {}\n")?;
    #[cfg(unix)]
    std::os::unix::fs::symlink(outside.path().join("a.wesl"), folder.path().join("out.wesl"))?;
    let mut lines = vec!["compose latin.wesl", "compose latin.frag.glsl"];
    if cfg!(unix) {
        lines.extend([
            "compose link.wesl",
            "compose linked.frag.glsl",
            "compose out.wesl --root .",
        ]);
    }
    let mut text = String::new();
    for line in lines {
        text += &told(folder.path(), line)?;
    }
    for name in ["wesl.toml", "lamplight.toml"] {
        write(name, &[0xff, 0, b'[', 0x80, b'\n'])?;
        text += &told(folder.path(), "compose fine.wesl")?;
        fs::remove_file(folder.path().join(name))?;
    }
    if cfg!(unix) { snapshot::check("diagnostics", "odd_files", text.trim_end()) } else { Ok(()) }
}

fn told(folder: &Path, line: &str) -> Result<String, Failed> {
    let output = run(folder, line)?;
    Ok(format!(
        "{line}\n{}=> {}\n\n",
        String::from_utf8(output.stderr)?,
        output.status.code().ok_or("killed")?
    ))
}

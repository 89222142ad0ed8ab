//! Runs every command that writes files, where something that Lamplight did not make is in the way.
//! A foreign file, folder or link must stay as it is, and the exit code must say that the command
//! wrote nothing. A pipe or a device is written to. Nothing is ever deleted.
//!
//! A new command that writes is one line in [`FOLDERS`] or [`FILES`]. If it is a top-level command
//! with `--force`, a test fails until it is there. A new trap is one line in [`FOLDER_TRAPS`] or
//! [`FILE_TRAPS`].

mod file;
mod folder;

use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use libtest_mimic::{Failed, Trial};
use tempfile::TempDir;

type Outcome = Result<(), Failed>;

/// A command that writes. `OUT` in its arguments stands for the place that it writes to. `--force` is
/// not among them: it is added where it is tried.
struct Writer {
    name: &'static str,
    arguments: &'static [&'static str],
    /// Names of files that it writes. If there are none, a run of the command finds them; for a
    /// slow command they are listed here.
    files: &'static [&'static str],
    /// Whether the command does not end by itself. Its first line then says that it wrote.
    endless: bool,
}

const fn writer(name: &'static str, arguments: &'static [&'static str]) -> Writer {
    Writer { name, arguments, files: &[], endless: false }
}

/// Commands that write into a folder.
const FOLDERS: &[Writer] = &[
    writer("gen", &["gen", "--no-cache", "-o", "OUT"]),
    Writer { endless: true, ..writer("watch", &["watch", "--no-cache", "-o", "OUT"]) },
    writer("merge", &["merge", "OUT", "ready"]),
    writer(
        "compile",
        &["compile", "main.wesl", "--set", "tint=red", "--target", "wgsl", "-o", "OUT"],
    ),
    writer("export", &["export", "OUT"]),
    writer("migrate", &["migrate", "--from", "naga_oil", "oil", "-o", "OUT"]),
    writer("man", &["man", "-o", "OUT"]),
    writer("export_npm", &["export", "OUT", "--form", "npm"]),
    writer("export_c", &["export", "OUT", "--form", "c"]),
    writer("catalogue", &["catalogue", "-o", "OUT", "--without-pictures"]),
    writer("report", &["check", "half.toml", "--report", "OUT"]),
    Writer {
        files: &["index.html", "hpg_4_spot.png"],
        ..writer(
            "gallery",
            &["render", "--all", "--executor", "eval", "--size", "8x8", "-o", "OUT"],
        )
    },
    writer("cache", &["gen", "--cache", "OUT", "-o", "other"]),
];

/// Commands that write one file.
const FILES: &[Writer] = &[
    writer("gen", &["gen", "--no-cache", "-o", "OUT.lamplight"]),
    writer("merge", &["merge", "OUT.lamplight", "ready"]),
    writer("pack", &["bundle", "pack", "ready", "-o", "OUT"]),
    writer(
        "get",
        &["bundle", "get", "ready", "small", "fs_main", "default", "--target", "wgsl", "-o", "OUT"],
    ),
    writer("render", &["render", "hpg_4_spot", "--executor", "eval", "--size", "8x8", "-o", "OUT"]),
    writer("keys_rust", &["keys", "--manifest", "lamplight.toml", "--lang", "rust", "-o", "OUT"]),
    writer("keys_c", &["keys", "--manifest", "lamplight.toml", "--lang", "c", "-o", "OUT"]),
    writer("bindings", &["bindings", "ready", "--lang", "c", "-o", "OUT"]),
    writer("variants", &["variants", "--cost", "--gpu", "navi21", "--record", "OUT"]),
    writer("cost", &["cost", "half.wesl", "--gpu", "navi21", "--record", "--baseline", "OUT"]),
    writer("values", &["check", "half.toml", "--record", "OUT"]),
    writer("keys_ts", &["keys", "--manifest", "lamplight.toml", "--lang", "ts", "-o", "OUT"]),
];

/// The name of a trap, and a test of it with a command and a file that the command writes.
type FolderTrap = (&'static str, fn(&Writer, &str) -> Outcome);
/// The name of a trap, and a test of it with a command.
type FileTrap = (&'static str, fn(&Writer) -> Outcome);

/// Things that are in the place of a file that a command writes into its folder.
const FOLDER_TRAPS: &[FolderTrap] = &[
    ("foreign_file", folder::foreign_file),
    ("link_to_a_file", folder::link_to_file),
    ("link_to_a_folder", folder::link_to_folder),
    ("pipe", folder::a_pipe),
    ("folder_in_the_way", folder::in_the_way),
];

/// Things that are in the place of the file that the user names.
const FILE_TRAPS: &[FileTrap] = &[
    ("foreign_file", file::foreign),
    ("own_file", file::own),
    ("link_to_a_foreign_file", file::link_to_foreign),
    ("link_to_an_own_file", file::link_to_own),
    ("link_to_nowhere", file::link_to_nowhere),
    ("pipe", file::a_pipe),
    ("device", file::device),
    ("folder", file::folder),
];

pub fn tests() -> Vec<Trial> {
    let mut tests = Vec::new();
    for writer in FOLDERS {
        for (trap, run) in FOLDER_TRAPS {
            let name = format!("traps::folder::{}::{trap}", writer.name);
            tests.push(Trial::test(name, move || each_place(writer, *run)));
        }
        if writer.files.is_empty() {
            let name = format!("traps::folder::{}::neighbours", writer.name);
            tests.push(Trial::test(name, move || folder::neighbours(writer)));
        }
    }
    for writer in FILES {
        for (trap, run) in FILE_TRAPS {
            let name = format!("traps::file::{}::{trap}", writer.name);
            tests.push(Trial::test(name, move || run(writer)));
        }
    }
    tests.push(Trial::test("traps::every_writer_is_listed", every_writer_is_listed));
    tests.push(Trial::test("traps::standard_output", standard_output));
    tests.push(Trial::test("traps::blobs_of_a_foreign_folder", foreign_blobs));
    tests.push(Trial::test("traps::parts_of_a_bundle", parts));
    tests.push(Trial::test("traps::incomplete_merge", incomplete_merge));
    tests
}

const MANIFEST: &str = "[program.small]\nwesl = \"main.wesl\"\ntargets = [\"wgsl\", \"glsl330\"]\n\
    [program.small.axis]\ntint = { values = [\"none\", \"red\", \"green\"] }\n";
const MAIN: &str = "@fragment fn fs_main(@location(0) x: f32) -> @location(0) vec4f {
    @if(tint == red) { return vec4f(x, 0.0, 0.0, 1.0); }
    @elif(tint == green) { return vec4f(0.0, x, 0.0, 1.0); }
    @else { return vec4f(x); }
}\n";
const HALF: &str = "fn half(x: f32) -> f32 { return 0.5 * x; }\n";
const CASES: &str = "[[case]]\nfunction = \"half\"\nformula = \"0.5 * x\"\n\
    [case.inputs]\nx = [1.0, 2.0]\n";
/// The bytes of a user's file, which no command may change without `--force`.
const MINE: &[u8] = b"{ \"mine\": true }\n";

/// A new folder with a package, and with a bundle of it if the command reads one.
struct Place(TempDir);

impl Place {
    fn new(writer: &Writer) -> Result<Self, Failed> {
        let place = Self(tempfile::tempdir()?);
        fs::create_dir(place.at("oil"))?;
        for (name, text) in [
            ("lamplight.toml", MANIFEST),
            ("main.wesl", MAIN),
            ("half.wesl", HALF),
            ("half.toml", CASES),
            ("oil/old.wgsl", "#ifdef FOG\nconst FAR: f32 = 9.0;\n#endif\n"),
        ] {
            fs::write(place.at(name), text)?;
        }
        if writer.arguments.contains(&"ready") {
            place.succeeds(&Self::command_line(&FOLDERS[0], "ready", false), false)?;
        }
        Ok(place)
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The arguments of a command that writes to `out`.
    fn command_line(writer: &Writer, out: &str, force: bool) -> Vec<String> {
        let words = writer.arguments.iter().map(|word| word.replace("OUT", out));
        words.chain(force.then(|| "--force".to_owned())).collect()
    }

    /// The exit code of a command and what it stderr on standard error. An endless command is stopped
    /// after its first line on standard output.
    fn run(&self, words: &[String], endless: bool) -> Result<(i32, String), Failed> {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
        command.args(words).current_dir(self.0.path()).stdin(Stdio::null());
        if !endless {
            let output = command.output()?;
            let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
            return Ok((output.status.code().unwrap_or(-1), stderr));
        }
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?;
        let mut line = String::new();
        BufReader::new(child.stdout.take().ok_or("no output")?).read_line(&mut line)?;
        if !line.is_empty() {
            child.kill()?;
            child.wait()?;
            return Ok((0, line));
        }
        let output = child.wait_with_output()?;
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        Ok((output.status.code().unwrap_or(-1), stderr))
    }

    /// Fails unless the command ends with exit code 0.
    fn succeeds(&self, words: &[String], endless: bool) -> Outcome {
        match self.run(words, endless)? {
            (0, _) => Ok(()),
            (code, stderr) => {
                Err(format!("{words:?} should succeed: exit {code}: {stderr}").into())
            }
        }
    }

    /// Fails unless the command ends with exit code 1, says that it cannot write, and gives help.
    fn refuses(&self, words: &[String], endless: bool) -> Outcome {
        match self.run(words, endless)? {
            (1, stderr) if stderr.contains("cannot write") && stderr.contains("help: ") => Ok(()),
            (code, stderr) => Err(format!("{words:?} should refuse: exit {code}: {stderr}").into()),
        }
    }
}

/// Everything below a folder by its name: files with their bytes, and folders, links and pipes
/// without any. Links are not followed.
fn listed(folder: &Path) -> Result<BTreeMap<String, Vec<u8>>, Failed> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next)? {
            let entry = entry?;
            let name = entry.path().strip_prefix(folder)?.to_string_lossy().into_owned();
            let kind = entry.file_type()?;
            if kind.is_dir() {
                folders.push(entry.path());
            }
            let bytes = if kind.is_file() { fs::read(entry.path())? } else { Vec::new() };
            found.insert(name, bytes);
        }
    }
    Ok(found)
}

/// Fails with the message unless the condition holds.
fn ensure(holds: bool, message: impl Into<String>) -> Outcome {
    if holds { Ok(()) } else { Err(message.into().into()) }
}

/// A few files that the command writes: the first and the last of each of up to three folders.
fn places(writer: &Writer) -> Result<Vec<String>, Failed> {
    if !writer.files.is_empty() {
        return Ok(writer.files.iter().map(|name| (*name).to_owned()).collect());
    }
    let place = Place::new(writer)?;
    place.succeeds(&Place::command_line(writer, "out", false), writer.endless)?;
    let out = place.at("out");
    let mut by_folder: BTreeMap<PathBuf, Vec<String>> = BTreeMap::new();
    for (name, _) in listed(&out)? {
        let is_own = name.starts_with(".lamplight") || name.contains("CACHEDIR");
        if out.join(&name).is_file() && !is_own {
            let folder = Path::new(&name).parent().unwrap_or(Path::new("")).to_owned();
            by_folder.entry(folder).or_default().push(name);
        }
    }
    ensure(!by_folder.is_empty(), format!("`{}` wrote no file", writer.name))?;
    let mut places: Vec<String> = Vec::new();
    for (_, names) in by_folder.into_iter().take(3) {
        places.extend(names.first().cloned());
        places.extend(names.last().filter(|_| names.len() > 1).cloned());
    }
    Ok(places)
}

/// Sets the trap at a few of the files that the command writes, one after the other.
fn each_place(writer: &Writer, trap: fn(&Writer, &str) -> Outcome) -> Outcome {
    for name in places(writer)? {
        trap(writer, &name).map_err(|failed| format!("`{name}`: {failed:?}"))?;
    }
    Ok(())
}

/// Whether the folder is a cache. A command that cannot write to its cache succeeds nevertheless and
/// only takes longer the next time.
fn is_cache(writer: &Writer) -> bool {
    writer.name == "cache"
}

/// Fails unless the command refuses to write to `out`, or succeeds if `out` is its cache.
fn refused(place: &Place, writer: &Writer, force: bool) -> Outcome {
    let words = Place::command_line(writer, "out", force);
    match is_cache(writer) {
        true => place.succeeds(&words, writer.endless),
        false => place.refuses(&words, writer.endless),
    }
}

fn pipe(path: &Path) -> Outcome {
    let made = Command::new("mkfifo").arg(path).status()?;
    ensure(made.success(), "mkfifo failed")
}

/// Each command that can replace files, which is one that takes `--force`, is in a table above.
fn every_writer_is_listed() -> Outcome {
    let help = |words: &[&str]| -> Result<String, Failed> {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
        Ok(String::from_utf8(command.args(words).arg("--help").output()?.stdout)?)
    };
    let listed: Vec<&str> = FOLDERS
        .iter()
        .chain(FILES)
        .filter_map(|writer| writer.arguments.first().copied())
        .collect();
    let all = help(&[])?;
    let names = all.lines().filter_map(|line| line.strip_prefix("  ")?.split(' ').next());
    let names = names.filter(|name| name.starts_with(|letter: char| letter.is_ascii_lowercase()));
    let (mut writers, mut missing) = (0, Vec::new());
    for name in names.filter(|name| *name != "help") {
        if help(&[name])?.contains("--force") {
            writers += 1;
            if !listed.contains(&name) {
                missing.push(name);
            }
        }
    }
    ensure(writers > 5, format!("only {writers} commands have `--force`: is the help read?"))?;
    let what = "a line in FOLDERS or in FILES of tests/traps.rs";
    ensure(missing.is_empty(), format!("{missing:?} replace files, and each needs {what}"))
}

/// `-o /dev/stdout` writes to standard output, also if that is redirected to the end of a file.
fn standard_output() -> Outcome {
    let writer = FILES.iter().find(|writer| writer.name == "get").ok_or("no such command")?;
    let place = Place::new(writer)?;
    let words = Place::command_line(writer, "/dev/stdout", false);
    let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
    command.args(&words).current_dir(place.0.path());
    let piped = command.output()?;
    let stderr = String::from_utf8_lossy(&piped.stderr);
    let wrote = piped.status.success() && !piped.stdout.is_empty();
    ensure(wrote, format!("nothing came through standard output: {stderr}"))?;
    let file = place.at("redirected");
    fs::write(&file, "before\n")?;
    let status = command.stdout(fs::OpenOptions::new().append(true).open(&file)?).status()?;
    let found = fs::read(&file)?;
    let appended = status.success() && found == [b"before\n".as_slice(), &piped.stdout].concat();
    ensure(appended, format!("{status}; the output should follow `before` in the file"))
}

/// A folder of another program that has a folder `blobs` and a file `manifest.json`, which are also
/// names in a bundle. `gen` refuses to write there; with `--force` it keeps the files in `blobs`.
fn foreign_blobs() -> Outcome {
    let place = Place::new(&FOLDERS[0])?;
    fs::create_dir_all(place.at("app/blobs"))?;
    fs::write(place.at("app/blobs/picture.png"), MINE)?;
    fs::write(place.at("app/manifest.json"), "{ \"name\": \"An app\", \"icons\": [] }")?;
    let before = listed(&place.at("app"))?;
    place.refuses(&Place::command_line(&FOLDERS[0], "app", false), false)?;
    ensure(listed(&place.at("app"))? == before, "the refusing command changed `app`")?;
    place.succeeds(&Place::command_line(&FOLDERS[0], "app", true), false)?;
    let kept = fs::read(place.at("app/blobs/picture.png"))? == MINE;
    ensure(kept, "`--force` changed `app/blobs/picture.png`")
}

/// A run that makes only a part of a bundle does not replace the whole bundle without `--force`.
fn parts() -> Outcome {
    let place = Place::new(&FOLDERS[0])?;
    place.succeeds(&Place::command_line(&FOLDERS[0], "out", false), false)?;
    let before = listed(&place.at("out"))?;
    for part in [&["--only", "tint=red"][..], &["--shard", "1/2"], &["--target", "wgsl"]] {
        let words = |force| {
            let mut words = Place::command_line(&FOLDERS[0], "out", force);
            words.extend(part.iter().map(|word| (*word).to_owned()));
            words
        };
        let (code, stderr) = place.run(&words(false), false)?;
        let message =
            format!("{part:?} should refuse with `this run would`: exit {code}: {stderr}");
        ensure(code == 1 && stderr.contains("this run would"), message)?;
        ensure(listed(&place.at("out"))? == before, format!("{part:?} changed the bundle"))?;
    }
    Ok(())
}

/// `merge --manifest` finds that a shard is missing before it writes anything.
fn incomplete_merge() -> Outcome {
    let place = Place::new(&FOLDERS[0])?;
    place.succeeds(&Place::command_line(&FOLDERS[0], "whole", false), false)?;
    let shard = ["gen", "--no-cache", "--shard", "1/3", "-o", "part"].map(str::to_owned);
    place.succeeds(&shard, false)?;
    let before = listed(&place.at("whole"))?;
    let merge = ["merge", "whole", "part", "--manifest", "lamplight.toml"].map(str::to_owned);
    let (code, stderr) = place.run(&merge, false)?;
    let message = format!("expected exit 3 and `parts are missing`, found {code}: {stderr}");
    ensure(code == 3 && stderr.contains("parts are missing"), message)?;
    ensure(listed(&place.at("whole"))? == before, "the failing merge changed the folder `whole`")
}

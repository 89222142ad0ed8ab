//! The recorded outputs of all permutations of the library. A snapshot has one hash for each program,
//! stage and target. If the recorded outputs themselves can be made again, a difference is shown.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use lamplight::bundle::{Bundle, Contents, EntryContents, Language, Target, Unit, write_file};
use lamplight::generate::{Request, in_memory};
use lamplight::project;
use lamplight::source::SourceSet;
use libtest_mimic::Failed;
use similar::TextDiff;

use super::readable;
use crate::snapshot;

/// The number of keys whose texts are shown.
const SHOWN: usize = 3;
/// The most lines of each difference.
const LINES: usize = 40;

/// The folder of the snapshot.
const FOLDER: &str = "shaderlib/programs";
/// The name of the snapshot.
const NAME: &str = "hashes";

/// Compares the outputs with the recorded table. The message of a difference has the first keys, with
/// their texts.
pub fn check(contents: &Contents) -> Result<(), Failed> {
    let (found, recorded) = (table(contents)?, recorded());
    if found == recorded {
        return Ok(keep(contents, &found)?);
    }
    // Accepts the table if the environment asks for that. Otherwise it is left for `cargo insta`.
    if snapshot::check(FOLDER, NAME, &found).is_ok() {
        return Ok(keep(contents, &found)?);
    }
    let rows = differing_rows(&recorded, &found);
    let texts = match accepted(&recorded)? {
        Some(accepted) => difference(&accepted, contents)?,
        None => format!(
            "The recorded outputs are not available, since not only `shaderlib/` has changed. To see \
             the differences, run this test at the commit that recorded them: it keeps them in `{}`.",
            folder().display()
        ),
    };
    Err(format!("outputs differ from snapshots/{FOLDER}/{NAME}.snap:\n{rows}\n{texts}").into())
}

/// The recorded table; empty if there is none.
fn recorded() -> String {
    let path = snapshot::root().join(format!("snapshots/{FOLDER}/{NAME}.snap"));
    let text = std::fs::read_to_string(path).unwrap_or_default();
    // The table is after insta's header.
    text.splitn(3, "---\n").last().unwrap_or_default().to_owned()
}

/// One line for each entry point, with a hash over the outputs of all its keys for each target.
fn table(contents: &Contents) -> Result<String, Failed> {
    let targets: BTreeSet<&str> =
        entries(contents).values().flat_map(|entry| targets(entry)).collect();
    let mut text = format!("{:32}", "program, language, stage");
    targets.iter().try_for_each(|target| write!(text, " {target:12}"))?;
    text = text.trim_end().to_owned() + "\n";
    for ((program, language, stage), entry) in entries(contents) {
        let name = format!("{program} {} {stage}", language.name());
        write!(text, "{name:32}")?;
        for target in &targets {
            write!(text, " {:12}", hash(entry, target))?;
        }
        text = text.trim_end().to_owned() + "\n";
    }
    Ok(text)
}

/// Program, language and entry point.
type Name<'c> = (&'c str, Language, &'c str);

fn entries<'c>(contents: &'c Contents) -> BTreeMap<Name<'c>, &'c EntryContents> {
    let programs = contents.programs.iter();
    programs
        .flat_map(|(program, found)| {
            found.languages.iter().flat_map(move |(language, entries)| {
                let named = move |(stage, entry): (&'c String, &'c EntryContents)| {
                    ((program.as_str(), *language, stage.as_str()), entry)
                };
                entries.iter().map(named)
            })
        })
        .collect()
}

fn targets(entry: &EntryContents) -> Vec<&str> {
    let unit = entry.units.values().next();
    unit.map(|unit| unit.targets.keys().map(String::as_str).collect()).unwrap_or_default()
}

fn unit<'c>(entry: &'c EntryContents, key: &str) -> Option<&'c Unit> {
    entry.units.get(entry.keys.get(key)?)
}

fn hash(entry: &EntryContents, target: &str) -> String {
    let mut hasher = blake3::Hasher::new();
    for key in entry.keys.keys() {
        hasher.update(key.as_bytes());
        let artifact = unit(entry, key).and_then(|unit| unit.targets.get(target));
        let bytes = artifact.map(|artifact| blake3::hash(&artifact.bytes));
        hasher.update(bytes.as_ref().map_or(&[], |hash| hash.as_bytes().as_slice()));
    }
    hasher.finalize().to_hex()[..12].to_owned()
}

/// The header and the lines of the new table that the old one does not have.
fn differing_rows(old: &str, new: &str) -> String {
    let old: BTreeSet<&str> = old.lines().collect();
    let header = new.lines().next().unwrap_or_default();
    let rows = new.lines().filter(|line| !old.contains(line) || *line == header);
    rows.map(|line| format!("{line}\n")).collect()
}

/// The folder in which accepted outputs are kept.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("accepted")
}

fn file(table: &str) -> PathBuf {
    let hash = blake3::hash(table.as_bytes()).to_hex();
    folder().join(format!("{}.lamplight", &hash[..16]))
}

/// Keeps accepted outputs, in place of older ones, so that the next difference can be shown.
fn keep(contents: &Contents, table: &str) -> Result<(), String> {
    let file = file(table);
    if file.is_file() {
        return Ok(());
    }
    // It is no error if the folder does not exist.
    let _ = std::fs::remove_dir_all(folder());
    std::fs::create_dir_all(folder()).map_err(|error| error.to_string())?;
    write_file(contents, &file).map_err(|error| error.to_string())
}

/// The outputs from which a table was recorded: those that were kept, or those of the committed
/// library if they have that table.
fn accepted(recorded: &str) -> Result<Option<Contents>, Failed> {
    if let Ok(bundle) = Bundle::open(file(recorded)) {
        return Ok(Some(bundle.contents()?));
    }
    let committed = committed_library();
    Ok(committed.filter(|contents| table(contents).is_ok_and(|table| table == recorded)))
}

/// The outputs of the library in the last commit. `None` if git cannot give it.
fn committed_library() -> Option<Contents> {
    let folder = tempfile::tempdir().ok()?;
    let mut archive = Command::new("git")
        .args(["archive", "HEAD", "shaderlib"])
        .current_dir(snapshot::root())
        .stdout(Stdio::piped())
        .spawn()
        .ok()?;
    let unpacked = Command::new("tar")
        .args(["-x", "-C"])
        .arg(folder.path())
        .stdin(archive.stdout.take()?)
        .status()
        .ok()?;
    if !archive.wait().ok()?.success() || !unpacked.success() {
        return None;
    }
    let mut sources = SourceSet::default();
    let path = folder.path().join("shaderlib/lamplight.toml");
    let (manifest, packages) = project::declared(&path, &mut sources).ok()?;
    let made = in_memory(&mut sources, &packages, &manifest, &Request::default(), &|_| {});
    made.ok().map(|made| made.contents)
}

/// How many keys of each entry point differ, with the texts of the first ones.
pub fn difference(old: &Contents, new: &Contents) -> Result<String, Failed> {
    let (old, new) = (entries(old), entries(new));
    let names: BTreeSet<&Name<'_>> = old.keys().chain(new.keys()).collect();
    let (mut text, mut shown) = (String::new(), 0);
    let empty = EntryContents::default();
    for name @ (program, language, stage) in names {
        let (old, new) =
            (old.get(name).copied().unwrap_or(&empty), new.get(name).copied().unwrap_or(&empty));
        let keys: BTreeSet<&String> = old.keys.keys().chain(new.keys.keys()).collect();
        let all = keys.len();
        let differing: Vec<(&String, Difference<'_>)> = keys
            .into_iter()
            .filter_map(|key| Some((key, Difference::new(unit(old, key), unit(new, key))?)))
            .collect();
        if differing.is_empty() {
            continue;
        }
        writeln!(text, "{program} {} {stage}: {} of {all} keys", language.name(), differing.len())?;
        for (key, difference) in differing.iter().take(SHOWN - shown.min(SHOWN)) {
            shown += 1;
            writeln!(
                text,
                "\n{program} [{key}] {} {stage}: {}",
                language.name(),
                difference.text()?
            )?;
        }
    }
    Ok(text)
}

/// How the outputs of one key differ.
enum Difference<'c> {
    New,
    Gone,
    /// The targets that differ: name, bytes before, bytes now.
    Changed(Vec<(&'c str, &'c [u8], &'c [u8])>),
}

impl<'c> Difference<'c> {
    /// `None` if nothing differs.
    fn new(old: Option<&'c Unit>, new: Option<&'c Unit>) -> Option<Self> {
        let (old, new) = match (old, new) {
            (Some(old), Some(new)) => (old, new),
            (None, Some(_)) => return Some(Self::New),
            (Some(_), None) => return Some(Self::Gone),
            (None, None) => return None,
        };
        let changed = new.targets.iter().filter_map(|(target, now)| {
            let before = old.targets.get(target).map_or(&[][..], |artifact| &artifact.bytes);
            (before != &*now.bytes).then_some((target.as_str(), before, &*now.bytes))
        });
        let changed: Vec<_> = changed.collect();
        (!changed.is_empty()).then_some(Self::Changed(changed))
    }

    /// The names of the targets that differ, and the difference of the first that is a text.
    fn text(&self) -> Result<String, Failed> {
        let changed = match self {
            Self::New => return Ok("the key is new".to_owned()),
            Self::Gone => return Ok("the key is gone".to_owned()),
            Self::Changed(changed) => changed,
        };
        let names: Vec<&str> = changed.iter().map(|(target, ..)| *target).collect();
        let is_text = |(target, ..): &&(&str, _, _)| *target != Target::SPIRV.name();
        let (target, before, now) =
            changed.iter().find(is_text).or(changed.first()).ok_or("nothing differs")?;
        let target = *Target::ALL
            .iter()
            .find(|known| known.name() == *target)
            .ok_or_else(|| format!("the crate has no target `{target}`"))?;
        let (before, now) = (readable(target, before)?, readable(target, now)?);
        let diff = TextDiff::from_lines(&before, &now);
        let diff = diff.unified_diff().context_radius(2).header("recorded", "now").to_string();
        let lines: Vec<&str> = diff.lines().take(LINES).collect();
        Ok(format!("{} differ; {target}:\n{}", names.join(" "), lines.join("\n")))
    }
}

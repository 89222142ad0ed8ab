//! Formats the shaders of folders, and counts what changes: those of this repository, or those in
//! `LAMPLIGHT_FORMAT_DIRS`. `LAMPLIGHT_FORMAT_OPTIONS` has the content of a table `[format]`, and
//! `LAMPLIGHT_FORMAT_DIFF` a file for the differences.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use lamplight_diagnostic::source::SourceSet;
use lamplight_format::{Language, Options, format_text, read_options};
use libtest_mimic::{Failed, Trial};
use similar::{ChangeTag, TextDiff};

use super::lexer::tokens_of;

const GLSL: [&str; 15] = [
    "glsl", "vert", "frag", "comp", "geom", "tesc", "tese", "mesh", "task", "rgen", "rmiss",
    "rchit", "rahit", "rint", "rcall",
];

#[derive(Default)]
struct Counts {
    files: usize,
    lines: usize,
    /// Lines of the text before that are not in the one after.
    changed: usize,
    /// Files that change.
    touched: usize,
    kept: usize,
    /// Files that are not UTF-8.
    unread: usize,
    bytes: usize,
    seconds: f64,
}

/// The folders of this repository that have shaders.
const OWN: [&str; 4] = ["shaderlib", "crates", "tests", "examples"];

pub fn tests() -> Vec<Trial> {
    vec![Trial::test("others_code", others_code)]
}

/// The folders to format.
fn folders(asked: Option<&str>) -> Vec<PathBuf> {
    match asked {
        Some(folders) => folders.split(':').map(PathBuf::from).collect(),
        None => {
            let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
            OWN.map(|folder| root.join(folder)).to_vec()
        }
    }
}

fn others_code() -> Result<(), Failed> {
    let mut sources = SourceSet::default();
    let table = std::env::var("LAMPLIGHT_FORMAT_OPTIONS").unwrap_or_default();
    let id = sources.add("options", format!("[format]\n{table}"));
    let options = read_options(&sources.get(id).text, id, Options::default())
        .map_err(|found| format!("{found:?}"))?;
    let (mut mistakes, mut differences) = (Vec::new(), String::new());
    let asked = std::env::var("LAMPLIGHT_FORMAT_DIRS").ok();
    for folder in folders(asked.as_deref()) {
        let mut counts = Counts::default();
        for file in shaders_below(&folder) {
            let Ok(text) = String::from_utf8(fs::read(&file)?) else {
                counts.unread += 1;
                continue;
            };
            mistakes.extend(try_file(
                &file,
                &text,
                &options.unwrap_or_default(),
                &mut counts,
                &mut differences,
            ));
        }
        if counts.files == 0 {
            return Err(format!("no shaders are below {}", folder.display()).into());
        }
        if asked.is_some() {
            print_counts(&folder, &counts);
        }
    }
    if let Ok(file) = std::env::var("LAMPLIGHT_FORMAT_DIFF") {
        fs::write(file, differences)?;
    }
    if mistakes.is_empty() { Ok(()) } else { Err(mistakes.join("\n").into()) }
}

fn print_counts(folder: &Path, counts: &Counts) {
    println!(
        "{}: {} files, {} lines; {} lines of {} files differ ({:.2} %), {} items kept, {} \
         files are not UTF-8; {:.1} MB/s",
        folder.display(),
        counts.files,
        counts.lines,
        counts.changed,
        counts.touched,
        100.0 * counts.changed as f64 / counts.lines.max(1) as f64,
        counts.kept,
        counts.unread,
        counts.bytes as f64 / 1e6 / counts.seconds.max(1e-9),
    );
}

fn try_file(
    file: &Path,
    text: &str,
    options: &Options,
    counts: &mut Counts,
    differences: &mut String,
) -> Option<String> {
    let is_wesl = matches!(file.extension()?.to_str()?, "wesl" | "wgsl");
    let language = if is_wesl { Language::Wesl } else { Language::Glsl };
    let mut sources = SourceSet::default();
    let id = sources.add("text", text.to_owned());
    let start = Instant::now();
    let once = format_text(text, id, language, options);
    counts.seconds += start.elapsed().as_secs_f64();
    let changed = show_changes(file, text, &once.text, differences);
    counts.files += 1;
    counts.bytes += text.len();
    counts.lines += text.lines().count();
    counts.kept += once.diagnostics.len();
    counts.changed += changed;
    counts.touched += usize::from(text != once.text);
    let (before, after) = (tokens_of(text, language), tokens_of(&once.text, language));
    if let Some((old, new)) = before.iter().zip(&after).find(|(old, new)| old != new) {
        return Some(format!("{}: `{old}` became `{new}`", file.display()));
    }
    if before.len() != after.len() {
        return Some(format!("{}: {} tokens of {}", file.display(), after.len(), before.len()));
    }
    let twice = format_text(&once.text, id, language, options).text;
    let differs = once.text.lines().zip(twice.lines()).find(|(one, other)| one != other);
    (twice != once.text).then(|| format!("{}: the second time, {differs:?}", file.display()))
}

fn show_changes(file: &Path, old: &str, new: &str, differences: &mut String) -> usize {
    if old == new {
        return 0;
    }
    let diff = TextDiff::from_lines(old, new);
    let name = file.display().to_string();
    *differences += &diff.unified_diff().context_radius(1).header(&name, &name).to_string();
    diff.iter_all_changes().filter(|change| change.tag() == ChangeTag::Delete).count()
}

fn shaders_below(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for path in entries.map(|entry| entry.path()) {
        let extension = path.extension().and_then(|name| name.to_str()).unwrap_or_default();
        if path.is_dir() {
            found.extend(shaders_below(&path));
        } else if matches!(extension, "wesl" | "wgsl") || GLSL.contains(&extension) {
            found.push(path);
        }
    }
    found.sort();
    found
}

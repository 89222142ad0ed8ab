//! Fixed cases. Their tables say what the buffers hold before and after.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use lamplight::bundle::{BoundsChecks, Conventions};
use lamplight::execute::frame::Buffers;

use super::Outcome;
use super::run::{self, Compiled};

/// What buffers hold afterwards: their words, and `None` for those that may be anything.
type Wanted = BTreeMap<(u32, u32), Vec<Option<u32>>>;

struct Case {
    name: String,
    compiled: Compiled,
    wanted: Wanted,
    /// The targets that have no output, as the table says.
    refused: Vec<String>,
    /// The executors whose driver is wrong, as the table says.
    skipped: Vec<String>,
}

/// Every executor gives what the tables say.
pub fn all() -> Outcome {
    let mut cases = Vec::new();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/compute/cases");
    let mut files: Vec<_> = fs::read_dir(folder)?.collect::<Result<_, _>>()?;
    files.sort_by_key(fs::DirEntry::path);
    for file in files {
        let path = file.path();
        if path.extension().is_some_and(|extension| extension == "wesl") {
            cases.push(read_case(&path)?);
        }
    }
    let names: Vec<String> = cases.iter().map(|case| case.name.clone()).collect();
    let mut wrong = String::new();
    for case in &cases {
        for (target, output) in &case.compiled.outputs {
            let is_refused = case.refused.iter().any(|name| name == target.name());
            if output.is_err() != is_refused {
                let _ = writeln!(wrong, "{}: {target}: {:?}", case.name, output.as_ref().err());
            }
        }
    }
    let (compiled, expected): (Vec<Compiled>, Vec<_>) =
        cases.into_iter().map(|case| (case.compiled, (case.wanted, case.skipped))).unzip();
    let mut ran = 0;
    for mut executor in run::opened()? {
        let results = executor.run(&compiled);
        for (index, result) in results.into_iter().enumerate() {
            let (wanted, skipped) = &expected[index];
            let name = executor.entry.name;
            let what = match result {
                None => continue,
                Some(Err(error)) if run::is_lack(&error) => continue,
                _ if skipped.iter().any(|one| one == name) => continue,
                Some(Err(error)) => error.message,
                Some(Ok(found)) => difference(wanted, &found),
            };
            ran += 1;
            if !what.is_empty() {
                let text = compiled[index].output_text(executor.form);
                let _ = writeln!(wrong, "{} on {name}: {what}\n{text}", names[index]);
            }
        }
    }
    println!("{} cases, {ran} runs", names.len());
    match wrong.is_empty() {
        true => Ok(()),
        false => Err(wrong.into()),
    }
}

/// What differs, in words; nothing if all is as wanted.
fn difference(wanted: &Wanted, found: &Buffers) -> String {
    for (place, wanted) in wanted {
        let Some(bytes) = found.get(place) else { return format!("{place:?} is missing") };
        let words: Vec<u32> =
            bytes.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
        if words.len() != wanted.len() {
            return format!("{place:?}: {} words, wanted {}", words.len(), wanted.len());
        }
        let is_wrong = |at: &usize| wanted[*at].is_some_and(|wanted| wanted != words[*at]);
        if let Some(at) = (0..words.len()).find(is_wrong) {
            return format!("{place:?}: word {at} is wrong in {words:?}");
        }
    }
    String::new()
}

fn read_case(path: &Path) -> Result<Case, String> {
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let read = |path: &Path| fs::read_to_string(path).map_err(|error| format!("{name}: {error}"));
    let table: toml::Table = toml::from_str(&read(&path.with_extension("toml"))?)
        .map_err(|error| format!("{name}: {error}"))?;
    let list = |key: &str| -> Vec<String> {
        let list = table.get(key).and_then(toml::Value::as_array);
        list.into_iter().flatten().filter_map(|one| Some(one.as_str()?.to_owned())).collect()
    };
    let conventions = match table.get("bounds").and_then(toml::Value::as_str) {
        Some("restrict") => {
            Conventions { bounds: BoundsChecks::Restrict, ..Conventions::default() }
        }
        _ => Conventions::default(),
    };
    let mut compiled = run::compiled(read(path)?, "main", conventions)
        .map_err(|errors| format!("{name}: {errors:?}"))?;
    let groups = words_of(table.get("groups"));
    compiled.groups = std::array::from_fn(|i| groups.get(i).copied().flatten().unwrap_or(1));
    let mut wanted = Wanted::new();
    for buffer in table.get("buffer").and_then(toml::Value::as_array).into_iter().flatten() {
        let place = words_of(buffer.get("place"));
        let [Some(group), Some(binding)] = place[..] else { return Err(format!("{name}: place")) };
        let given = words_of(buffer.get("words")).into_iter();
        let bytes = given.flat_map(|word| word.unwrap_or(0).to_le_bytes()).collect();
        compiled.buffers.insert((group, binding), bytes);
        if buffer.get("expect").is_some() {
            wanted.insert((group, binding), words_of(buffer.get("expect")));
        }
    }
    if wanted.is_empty() {
        return Err(format!("{name}: nothing is expected"));
    }
    Ok(Case {
        name: name.clone(),
        compiled,
        wanted,
        refused: list("refused"),
        skipped: list("skipped"),
    })
}

/// The words of numbers. Floats are `f32`, and integers 32 bits of either sign. The text `?` stands
/// for any word, and a table `{ times, of }` for a repeated list.
fn words_of(value: Option<&toml::Value>) -> Vec<Option<u32>> {
    match value {
        Some(toml::Value::Array(list)) => list.iter().flat_map(|one| words_of(Some(one))).collect(),
        Some(toml::Value::Integer(number)) => vec![Some(*number as u32)],
        Some(toml::Value::Float(number)) => vec![Some((*number as f32).to_bits())],
        Some(toml::Value::Table(repeated)) => {
            let times = repeated.get("times").and_then(toml::Value::as_integer).unwrap_or(0);
            words_of(repeated.get("of")).repeat(times as usize)
        }
        Some(_) => vec![None],
        None => Vec::new(),
    }
}

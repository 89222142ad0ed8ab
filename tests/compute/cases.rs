//! Fixed cases. Their tables say what the buffers hold before and after.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use lamplight::bundle::{BoundsChecks, Conventions};
use lamplight::execute::dispatch::DispatchResult;
use lamplight::execute::frame::Buffers;
use libtest_mimic::Failed;

use super::Outcome;
use super::run::{self, Compiled};

/// What buffers hold afterwards: their words, and `None` for those that may be anything.
type Wanted = BTreeMap<(u32, u32), Vec<Option<u32>>>;

struct Case {
    name: String,
    compiled: Compiled,
    expected: Expected,
    /// The targets that have no output, as the table says.
    refused: Vec<String>,
}

/// What the table says of the runs of a case.
struct Expected {
    wanted: Wanted,
    /// The executors whose driver is wrong.
    skipped: Vec<String>,
    /// The executors that lack something.
    lacking: Vec<String>,
}

/// Every executor gives what the tables say.
pub fn all() -> Outcome {
    let mut wrong = String::new();
    let (mut compiled, mut expected) = (Vec::new(), Vec::new());
    for Case { name, compiled: one, expected: of, refused } in read_cases()? {
        for (target, output) in &one.outputs {
            let is_refused = refused.iter().any(|name| name == target.name());
            if output.is_err() != is_refused {
                let _ = writeln!(wrong, "{name}: {target}: {:?}", output.as_ref().err());
            }
        }
        compiled.push(one);
        expected.push((name, of));
    }
    let mut ran = 0;
    for mut executor in run::opened()? {
        let results = executor.run(&compiled);
        for ((result, (case, of)), one) in results.into_iter().zip(&expected).zip(&compiled) {
            let Some(what) = result.and_then(|result| of.compare(executor.entry.name, result))
            else {
                continue;
            };
            ran += 1;
            if !what.is_empty() {
                let (name, text) = (executor.entry.name, one.output_text(executor.form));
                let _ = writeln!(wrong, "{case} on {name}: {what}\n{text}");
            }
        }
    }
    println!("{} cases, {ran} runs", expected.len());
    match wrong.is_empty() {
        true => Ok(()),
        false => Err(wrong.into()),
    }
}

fn read_cases() -> Result<Vec<Case>, Failed> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/compute/cases");
    let mut files: Vec<_> = fs::read_dir(folder)?.collect::<Result<_, _>>()?;
    files.sort_by_key(fs::DirEntry::path);
    let paths = files.iter().map(fs::DirEntry::path);
    let cases = paths.filter(|path| path.extension().is_some_and(|end| end == "wesl"));
    Ok(cases.map(|path| read_case(&path)).collect::<Result<_, String>>()?)
}

impl Expected {
    /// What is wrong with a run; nothing if all is as wanted. `None` for a run that does not count.
    fn compare(&self, executor: &str, result: DispatchResult) -> Option<String> {
        let is_in = |list: &[String]| list.iter().any(|one| one == executor);
        match result {
            Err(error) if run::is_lack(&error) && is_in(&self.lacking) => None,
            Ok(_) if is_in(&self.lacking) => Some("the executor lacks nothing any more".to_owned()),
            _ if is_in(&self.skipped) => None,
            Err(error) => Some(error.message),
            Ok(found) => Some(difference(&self.wanted, &found)),
        }
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
    let expected = Expected { wanted, skipped: list("skipped"), lacking: list("lacking") };
    Ok(Case { refused: list("refused"), name, compiled, expected })
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

//! Composes a migrated root with Lamplight, and normalises modules so that those of two composers
//! can be compared. The tests of `lamplight migrate` use this file too.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use lamplight::compose::{Options, wesl as composer};
use lamplight::migrate::Migrated;
use lamplight::permute::{Setting, Settings};
use lamplight::resolve::{self, Packages};
use lamplight::source::{Memory, Package, SourceSet};

/// The value of every shader def whose value a text reads. Any number will do.
pub const VALUE: u32 = 4;

pub fn packages(migrated: &Migrated) -> Packages {
    let wesl = |path: &String| path.replace(".wgsl", ".wesl");
    let files = migrated.files.iter().map(|(path, text)| (wesl(path), text.clone())).collect();
    let files = Box::new(Memory(files));
    Packages::new(Package { name: "package".to_owned(), files }, Vec::new())
}

pub fn ours(
    packages: &Packages,
    path: &str,
    migrated: &Migrated,
    text: &str,
    defs: &BTreeMap<String, bool>,
) -> Result<naga::Module, String> {
    let given = text.lines().filter_map(|line| line.strip_prefix("#define "));
    let given: BTreeSet<&str> = given.map(str::trim).collect();
    let mut sources = SourceSet::default();
    let path = path.replace(".wgsl", ".wesl");
    let messages_of = |found: lamplight::diagnostic::Diagnostics| {
        found.iter().map(|one| one.message.clone()).collect::<Vec<_>>().join("; ")
    };
    let graph = resolve::wesl::load(&mut sources, packages, &path).map_err(messages_of)?;
    let flags = defs
        .iter()
        .map(|(name, on)| (name.clone(), Setting::Bool(*on || given.contains(name.as_str()))));
    let numbers =
        migrated.numbers.iter().map(|name| (name.clone(), Setting::Int(i64::from(VALUE))));
    let values = |name: &String| (name.clone(), VALUE.to_string());
    let settings = Settings {
        values: flags.chain(numbers).collect(),
        integers: migrated.numbers.clone(),
        constants: migrated.constants.iter().map(values).collect(),
        ..Settings::default()
    };
    let composed =
        composer::compose(&graph, &settings, &Options::default()).map_err(messages_of)?;
    let module = naga::front::wgsl::parse_str(&composed.text)
        .map_err(|error| error.emit_to_string(&composed.text))?;
    validator().validate(&module).map_err(|error| format!("{:?}", error.as_inner()))?;
    Ok(module)
}

pub fn validator() -> naga::valid::Validator {
    naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        naga::valid::Capabilities::all(),
    )
}

/// Declarations of a module that entry points reach, in any order, with the values of constants
/// and without the names that a composer or a writer gives.
pub fn normalised(mut module: naga::Module, prefixes: &[String]) -> BTreeSet<String> {
    naga::compact::compact(&mut module, naga::compact::KeepUnused::No);
    let info = validator().validate(&module);
    let text = info.ok().and_then(|info| {
        let flags = naga::back::wgsl::WriterFlags::empty();
        naga::back::wgsl::write_string(&module, &info, flags).ok()
    });
    let text = text.unwrap_or_else(|| "cannot be written".to_owned());
    let mut constants: HashMap<String, String> = HashMap::new();
    let (mut found, mut one) = (BTreeSet::new(), String::new());
    for line in text.lines() {
        let constant = line.strip_prefix("const ").and_then(|line| line.split_once(':'));
        if let Some((name, (_, value))) =
            constant.and_then(|(name, rest)| Some((name, rest.split_once(" = ")?)))
        {
            let value = named(value.trim_end_matches(';'), &constants, prefixes);
            constants.insert(name.to_owned(), value);
            continue;
        }
        one.push_str(line);
        one.push('\n');
        if line.starts_with('}') || (line.ends_with(';') && !one.contains('{')) {
            found.insert(named(one.trim(), &constants, prefixes));
            one.clear();
        }
    }
    found
}

/// The text with values for constants, with `name` for `nameX_naga_oil_mod_X...X`, for
/// `package_folder_file_name` and for `name_1`, and with the writer's temporaries numbered as they
/// appear.
fn named(text: &str, constants: &HashMap<String, String>, prefixes: &[String]) -> String {
    let mut out = String::with_capacity(text.len());
    let mut temporaries: HashMap<String, usize> = HashMap::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let fits = |letter: char| letter == '_' || letter.is_alphanumeric();
        let end = rest.find(|letter| !fits(letter)).unwrap_or(rest.len());
        let word = &rest[..end.max(first.len_utf8())];
        rest = &rest[word.len()..];
        if end == 0 || first.is_ascii_digit() {
            out.push_str(word);
        } else if let Some(value) = constants.get(word) {
            out.push_str(value);
        } else if word.starts_with("_e") {
            let next = temporaries.len();
            let number = temporaries.entry(word.to_owned()).or_insert(next);
            out.push_str(&format!("_e{number}"));
        } else {
            out.push_str(bare(word, prefixes));
        }
    }
    out
}

fn bare<'a>(word: &'a str, prefixes: &[String]) -> &'a str {
    let mut bare = word.split("X_naga_oil_").next().unwrap_or(word);
    if let Some(own) = prefixes.iter().find_map(|prefix| bare.strip_prefix(prefix.as_str())) {
        bare = own;
    }
    loop {
        let shorter = bare.trim_end_matches('_');
        let letters = shorter.trim_end_matches(|letter: char| letter.is_ascii_digit());
        let shorter = if letters.ends_with('_') { letters } else { shorter };
        if shorter.len() == bare.len() || shorter.is_empty() {
            return bare;
        }
        bare = shorter;
    }
}

/// How names of each module begin where two modules have the same name, longest first.
pub fn prefixes(migrated: &Migrated) -> Vec<String> {
    let one = |path: &String| format!("package_{}_", path.replace(".wgsl", "").replace('/', "_"));
    let mut prefixes: Vec<String> = migrated.files.keys().map(one).collect();
    prefixes.sort_by_key(|prefix| std::cmp::Reverse(prefix.len()));
    prefixes
}

/// A hash of a normalised root, to record what a choice of shader defs makes of it.
pub fn fingerprint(found: &BTreeSet<String>) -> String {
    let text: Vec<&str> = found.iter().map(String::as_str).collect();
    let mix = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    format!("{:016x}", text.join("\n").bytes().fold(0xcbf2_9ce4_8422_2325, mix))
}

/// Every combination of features that are on and off.
pub fn choices(migrated: &Migrated) -> Vec<BTreeMap<String, bool>> {
    let names: Vec<&String> = migrated.features.iter().collect();
    let one = |choice: u32| {
        let on = |(bit, name): (usize, &&String)| ((*name).clone(), choice >> bit & 1 == 1);
        names.iter().enumerate().map(on).collect()
    };
    (0..1_u32 << names.len()).map(one).collect()
}

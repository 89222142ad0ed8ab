//! A compiler that knows nothing of the translation reads what it makes: glslangValidator, under
//! every setting of the axes.

use std::collections::{BTreeMap, BTreeSet};

use lamplight_tools::GLSLANG;
use lamplight_translate::print::MadeFile;
use libtest_mimic::Failed;

/// The most settings of a file's axes.
const SETTINGS: usize = 600;

/// Has a file compiled under every setting of its axes, with the files that it includes.
pub fn compiles(file: &MadeFile, files: &[MadeFile]) -> Result<(), Failed> {
    let text = included(file, files)?;
    let axes = axes_of(&text);
    let count: usize = axes.iter().map(|axis| axis.values.len()).product();
    if count > SETTINGS {
        return Err(format!("{}: {count} settings are too many", file.path).into());
    }
    let (stage, end) = match file.path.rsplit('.').nth(1) {
        Some(stage @ ("vert" | "frag" | "comp")) => (stage, ""),
        _ => ("frag", "\nvoid main() {\n}\n"),
    };
    for number in 0..count {
        let head = definitions(&axes, number);
        let body = text.strip_prefix("#version 450\n").unwrap_or(&text);
        let whole = format!("#version 450\n{head}{body}{end}");
        let options = ["--stdin", "-V", "-S", stage, "-o", "/dev/null"];
        GLSLANG
            .pipe(&options, whole.as_bytes())
            .map_err(|message| format!("{}: {message}\n{head}", file.path))?;
    }
    Ok(())
}

/// The text with those that it includes in their places.
pub fn included(file: &MadeFile, files: &[MadeFile]) -> Result<String, Failed> {
    let mut text = String::new();
    for line in file.text.lines() {
        match line.strip_prefix("#include \"").and_then(|rest| rest.strip_suffix('"')) {
            None => text += line,
            Some("sampling.glsl") => text += SAMPLING,
            Some(path) => {
                let below = resolved(&file.path, path);
                let found = files.iter().find(|other| other.path == below);
                text += &included(found.ok_or_else(|| format!("there is no `{path}`"))?, files)?;
            }
        }
        text.push('\n');
    }
    Ok(text)
}

/// The path that a file includes, from the root.
fn resolved(from: &str, path: &str) -> String {
    let mut parts: Vec<&str> = from.split('/').collect();
    parts.pop();
    for part in path.split('/') {
        match part {
            ".." => drop(parts.pop()),
            part => parts.push(part),
        }
    }
    parts.join("/")
}

/// The library's macros for textures.
const SAMPLING: &str =
    include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shaderlib/filter/sampling.glsl"));

/// A macro that a text compares, and the values that make a difference.
struct Axis {
    name: String,
    values: Vec<String>,
}

/// The macros of a text: flags, those with named values, and numbers.
fn axes_of(text: &str) -> Vec<Axis> {
    let mut found: BTreeMap<&str, BTreeSet<String>> = BTreeMap::new();
    let mut values = BTreeSet::new();
    let mut needs_length = BTreeSet::new();
    for line in text.lines().filter(|line| line.starts_with("#if ") || line.starts_with("#elif ")) {
        let words: Vec<&str> = line
            .split(|one: char| {
                !one.is_alphanumeric() && !matches!(one, '_' | '=' | '<' | '>' | '!')
            })
            .filter(|word| !word.is_empty())
            .collect();
        for three in words.windows(3).filter(|three| is_comparison(three[1])) {
            let with = match three[2].parse::<i64>() {
                Ok(number) => vec![number.to_string(), (number + 1).to_string()],
                Err(_) => {
                    values.insert(three[2]);
                    vec![three[2].to_owned(), OTHER.to_owned()]
                }
            };
            found.entry(three[0]).or_default().extend(with);
            needs_length.insert(three[0]);
        }
        let names = words.into_iter().map(|word| word.trim_start_matches('!'));
        let is_name = |word: &&str| word.starts_with(|one: char| one.is_ascii_uppercase());
        for name in names.filter(is_name) {
            if !values.contains(name) && !needs_length.contains(name) {
                found.entry(name).or_default().extend(["0", "1"].map(str::to_owned));
            }
        }
    }
    let axes = found.into_iter().filter(|(name, _)| !name.starts_with("LAMPLIGHT_"));
    axes.map(|(name, values)| Axis { name: name.to_owned(), values: values.into_iter().collect() })
        .collect()
}

/// A value that no condition names.
const OTHER: &str = "99";

fn is_comparison(word: &str) -> bool {
    matches!(word, "==" | "!=" | "<" | "<=" | ">" | ">=")
}

/// The macros of one of the settings.
fn definitions(axes: &[Axis], mut number: usize) -> String {
    let mut text = String::new();
    for Axis { name, values } in axes {
        for (index, value) in values.iter().enumerate() {
            if value.starts_with(|one: char| one.is_ascii_uppercase()) {
                text += &format!("#define {value} {index}\n");
            }
        }
        text += &format!("#define {name} {}\n", values[number % values.len()]);
        number /= values.len();
    }
    // The axis that the constructs use as a number of elements.
    if !axes.iter().any(|axis| axis.name == "STEPS") {
        text += "#define STEPS 4\n";
    }
    text
}

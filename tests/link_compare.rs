//! Compares linked outputs with those that naga writes for the whole text.

use std::collections::BTreeSet;

use lamplight::bundle::{BoundsChecks, Conventions, Language, Target};
use lamplight::compose::{Composed, Keep, Options, PartKind, compose, lean};
use lamplight::emit::emit_for;
use lamplight::link::{Linker, TextForms, compile};
use lamplight::permute::Manifest;
use lamplight::resolve::{self, Packages};
use lamplight::source::SourceSet;
use lamplight::validate::validate;
use libtest_mimic::Failed;

/// Compares every `step`-th permutation of every program, in both languages, with checks of bounds
/// and without them.
pub fn all(
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &Manifest,
    step: usize,
) -> Result<(), Failed> {
    for bounds in [BoundsChecks::Unchecked, BoundsChecks::Restrict] {
        let conventions = Conventions { bounds, ..Conventions::default() };
        all_with(conventions, sources, packages, manifest, step)
            .map_err(|error| format!("{bounds:?}: {}", error.message().unwrap_or_default()))?;
    }
    Ok(())
}

fn all_with(
    conventions: Conventions,
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &Manifest,
    step: usize,
) -> Result<(), Failed> {
    for program in &manifest.programs {
        let linker = Linker::with(&program.targets, conventions);
        let glsl = program.glsl.iter().flat_map(|glsl| [&glsl.vertex, &glsl.fragment]).flatten();
        let glsl = glsl.map(|file| (file, Language::Glsl));
        let wesl = program.wesl.iter().map(|file| (file, Language::Wesl));
        let points = program.space.enumerate();
        for (root, language) in wesl.chain(glsl) {
            let graph = resolve::load(sources, packages, &root.path, language)
                .map_err(|errors| format!("{errors:?}"))?;
            for point in points.iter().step_by(step) {
                let settings = program.space.settings(point);
                let names = match language {
                    Language::Wesl => vec!["vs_main", "fs_main"],
                    Language::Glsl => vec!["main"],
                };
                for entry in names {
                    let keep = match entry {
                        "main" => Keep::EntryPoints,
                        _ => Keep::Items(vec![entry.to_owned()]),
                    };
                    let options = Options { keep, ..Options::default() };
                    let composed = compose(&graph, &settings, &options)
                        .map_err(|errors| format!("{errors:?}"))?;
                    one(&composed, entry, &linker, conventions)
                        .map_err(|error| format!("[{}] {error}", program.space.key(point)))?;
                }
            }
        }
    }
    Ok(())
}

fn one(
    composed: &Composed,
    entry: &str,
    linker: &Linker<'_>,
    conventions: Conventions,
) -> Result<(), String> {
    let lean = lean(composed);
    let text = TextForms { composed, lean: &lean };
    let targets = linker.targets();
    let made = compile(&text, entry, targets, linker).map_err(|errors| format!("{errors:?}"))?;
    if let Some(whole) = made.whole.first() {
        return Err(format!("{entry} is compiled as a whole: {whole:?}"));
    }
    let functions = lean.parts.iter().filter(|part| part.kind == PartKind::Function);
    let names = functions.flat_map(|part| &part.names);
    let functions: Vec<String> = names.map(|name| plain(name)).collect();
    let validated = validate(&lean).map_err(|errors| format!("{errors:?}"))?;
    for target in targets {
        let whole = emit_for(&validated, entry, *target, conventions);
        let whole = whole.map_err(|error| error.message)?.bytes;
        let linked = &made.unit.targets[target.name()].bytes;
        let (whole, linked) = match *target {
            Target::SPIRV => (opcodes(&whole), opcodes(linked)),
            // These two depend on the order of variables in the module: Metal passes variables to
            // functions in that order, and the entry point that naga wraps around a GLSL `main`
            // copies them in that order.
            _ if *target == Target::MSL || composed.language == Language::Glsl => {
                (sorted(declarations(&whole)), sorted(declarations(linked)))
            }
            _ => (declarations(&whole), declarations(linked)),
        };
        // Only functions of the whole text must be in the linked one. The whole text may have types,
        // constants and helpers that no function needs.
        let is_function = |text: &&String| {
            let head = text.split(" {").next().unwrap_or_default();
            let is_sorted = *target == Target::MSL || composed.language == Language::Glsl;
            let is_sorted = is_sorted && text.contains(" return");
            is_sorted || functions.iter().any(|name| head.contains(&format!(" {name} (")))
        };
        let missing = whole.difference(&linked).find(is_function);
        let more = linked.difference(&whole).next();
        if let Some(found) = missing.or(more) {
            let which = if missing.is_some() { "lacking" } else { "only" };
            return Err(format!("{entry} in {target}: {which} in the linked output: {found}"));
        }
    }
    Ok(())
}

/// The declarations of a text, with names without the numbers that writers add.
fn declarations(bytes: &[u8]) -> BTreeSet<String> {
    let text = String::from_utf8_lossy(bytes);
    let mut found = BTreeSet::new();
    let (mut depth, mut one) = (0_i32, String::new());
    for token in tokens(&text) {
        depth += i32::from(matches!(token, "{" | "(" | "["))
            - i32::from(matches!(token, "}" | ")" | "]"));
        one.push_str(&plain(token));
        one.push(' ');
        if depth == 0 && matches!(token, ";" | "}") {
            found.insert(std::mem::take(&mut one));
        }
    }
    found
}

/// The declarations, each with its words sorted.
fn sorted(declarations: BTreeSet<String>) -> BTreeSet<String> {
    let one = |text: String| {
        // If statements have another order, the writer numbers values in another way.
        let unnumbered = |word: &str| {
            let (value, rest) = word.split_at(word.find('.').unwrap_or(word.len()));
            let digits = value.strip_prefix("_e").unwrap_or("x");
            let is_value = digits.bytes().all(|digit| digit.is_ascii_digit());
            if is_value { format!("_e{rest}") } else { word.to_owned() }
        };
        let mut words: Vec<String> = text.split(' ').map(unnumbered).collect();
        words.sort_unstable();
        words.join(" ")
    };
    declarations.into_iter().map(one).collect()
}

/// The words, numbers and other characters of a text, without comments and directives.
fn tokens(text: &str) -> Vec<&str> {
    let starts = ["#", "//", "precision ", "using "];
    let lines = text.lines().filter(|line| !starts.iter().any(|start| line.starts_with(start)));
    let mut tokens = Vec::new();
    for line in lines {
        let is_word =
            |character: char| character.is_ascii_alphanumeric() || "_.".contains(character);
        let mut rest = line.trim_start();
        while let Some(first) = rest.chars().next() {
            let length = match is_word(first) {
                true => rest.find(|character| !is_word(character)).unwrap_or(rest.len()),
                false => first.len_utf8(),
            };
            tokens.push(&rest[..length]);
            rest = rest[length..].trim_start();
        }
    }
    tokens
}

/// A word without the numbers and underscores that writers add to make names unique. All of Metal's
/// wrappers of arrays become one word.
fn plain(token: &str) -> String {
    let is_name = token.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_');
    if !is_name {
        return token.to_owned();
    }
    let one = |part: &str| {
        // The names of blocks contain the name of their type.
        if part.contains("_block_") {
            return "BLOCK".to_owned();
        }
        let is_array = part.starts_with("array") && part.contains("_stride")
            || part
                .strip_prefix("type_")
                .is_some_and(|rest| rest.bytes().all(|b| b.is_ascii_digit()));
        if is_array {
            return "ARRAY".to_owned();
        }
        if part.starts_with("_e") {
            return part.to_owned();
        }
        let stem = part.trim_end_matches(|end: char| end.is_ascii_digit() || end == '_');
        if stem.is_empty() { part.to_owned() } else { stem.to_owned() }
    };
    token.split('.').map(one).collect::<Vec<String>>().join(".")
}

/// How often each instruction occurs that is part of a function's computation. Constants, types,
/// names, and the loads that the writer adds for callees depend on the module and are left out.
fn opcodes(bytes: &[u8]) -> BTreeSet<String> {
    const MODULE: [u16; 24] = [
        5, 6, 11, 14, 15, 16, 17, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 32, 33, 59, 61,
        65,
    ];
    let words: Vec<u32> =
        bytes.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
    let mut counts = std::collections::BTreeMap::<u16, usize>::new();
    let mut at = 5;
    while let Some(word) = words.get(at) {
        let (length, op) = ((word >> 16) as usize, *word as u16);
        *counts.entry(op).or_default() += 1;
        at += length.max(1);
    }
    let is_constant = |op: &u16| (41..=46).contains(op) || matches!(op, 71 | 72);
    let kept = counts.into_iter().filter(|(op, _)| !MODULE.contains(op) && !is_constant(op));
    kept.map(|(op, count)| format!("instruction {op}: {count} times")).collect()
}

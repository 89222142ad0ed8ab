//! Texts that are cut off, changed or nested: they end in files or in errors, never in a panic.

use lamplight_diagnostic::source::SourceSet;
use lamplight_testing::random::Random;
use lamplight_translate::print::LIBRARY_STYLE;
use lamplight_translate::{SourceModule, translate_wesl};
use libtest_mimic::{Failed, Trial};

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("translate::hostile::changed", changed_texts_are_errors),
        Trial::test("translate::hostile::nested", nested_texts_are_errors),
    ]
}

/// The constructs, with a token removed, doubled or exchanged.
fn changed_texts_are_errors() -> Result<(), Failed> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/constructs");
    let mut names: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    names.sort();
    let (mut translated, mut refused) = (0, 0);
    for (index, path) in names.iter().enumerate() {
        let text = std::fs::read_to_string(path).unwrap();
        let words: Vec<&str> = text.split_inclusive(|one: char| !one.is_alphanumeric()).collect();
        let mut random = Random(index as u64);
        for _ in 0..120 {
            let mut changed = words.clone();
            let (from, to) = (random.below(words.len()), random.below(words.len()));
            match random.below(4) {
                0 => drop(changed.remove(from)),
                1 => changed.insert(to, words[from]),
                2 => changed.swap(from, to),
                _ => changed.truncate(from),
            }
            match translate(&changed.concat()) {
                true => translated += 1,
                false => refused += 1,
            }
        }
    }
    match translated > 50 && refused > 50 {
        true => Ok(()),
        false => Err(format!("{translated} were translated, {refused} refused").into()),
    }
}

fn nested_texts_are_errors() -> Result<(), Failed> {
    for (open, close) in [("(", ")"), ("-", ""), ("!", ""), ("f(", ")"), ("a[", "]")] {
        for depth in [10, 5_000] {
            let inner = format!("{}x{}", open.repeat(depth), close.repeat(depth));
            translate(&format!("fn g(x: f32) -> f32 {{ return {inner}; }}"));
        }
    }
    for depth in [10, 5_000] {
        let blocks = format!("{}{}", "if (true) {".repeat(depth), "}".repeat(depth));
        translate(&format!("fn g() {{ {blocks} }}"));
        let sums = format!("x{}", " + x".repeat(depth));
        translate(&format!("fn g(x: f32) -> f32 {{ return {sums}; }}"));
        let elses = "if (x > 1.0) { } else ".repeat(depth);
        translate(&format!("fn g(x: f32) {{ {elses} {{ }} }}"));
    }
    Ok(())
}

/// Whether a text is translated.
fn translate(text: &str) -> bool {
    let mut sources = SourceSet::default();
    let source = sources.add("hostile.wesl", text);
    let module = SourceModule { path: vec!["hostile".to_owned()], source, text };
    translate_wesl(&[module], &[], &LIBRARY_STYLE).is_ok()
}

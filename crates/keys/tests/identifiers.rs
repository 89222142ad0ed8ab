//! The identifiers and the keys in what is written for each language.

use lamplight_diagnostic::source::SourceSet;
use lamplight_keys::{LANGUAGES, find, is_written, write};
use lamplight_permute::{Manifest, manifest};
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("identifiers::follow_each_language", follow_each_language),
        Trial::test("identifiers::are_given_once", are_given_once),
        Trial::test("identifiers::dynamic_axes_have_none", dynamic_axes_have_none),
        Trial::test("identifiers::written_files_are_known", written_files_are_known),
    ]
}

fn parsed(axes: &str) -> Result<Manifest, Failed> {
    let text =
        format!("[program.forward]\nwesl = \"forward.wesl\"\n[program.forward.axis]\n{axes}");
    let mut sources = SourceSet::default();
    let id = sources.add("lamplight.toml", text);
    manifest::parse(&sources, id).map_err(|errors| format!("{errors:?}").into())
}

fn written(axes: &str, language: &str) -> Result<String, Failed> {
    Ok(write(&parsed(axes)?, None, find(language).ok_or("no such language")?))
}

fn has(text: &str, part: &str) -> Outcome {
    match text.contains(part) {
        true => Ok(()),
        false => Err(format!("`{part}` is not in\n{text}").into()),
    }
}

/// The name of a value follows the rules of its language.
fn follow_each_language() -> Outcome {
    let axes = "depth_view = { values = [\"pcf_3x3\", \"none\"], default = \"none\" }\n";
    for (language, name) in [
        ("rust", "Pcf3x3 => \"pcf_3x3\""),
        ("c", "LAMPLIGHT_FORWARD_DEPTH_VIEW_PCF_3X3,"),
        ("ts", "depth_view?: \"pcf_3x3\" | \"none\";"),
    ] {
        has(&written(axes, language)?, name)?;
    }
    Ok(())
}

/// Two values whose names become one identifier get different ones.
fn are_given_once() -> Outcome {
    let axes = "mode = { values = [\"pcf_3\", \"pcf3\"], default = \"pcf_3\" }\n";
    let text = written(axes, "rust")?;
    has(&text, "Pcf3 => \"pcf_3\"")?;
    has(&text, "Pcf3_ => \"pcf3\"")
}

/// A dynamic axis is a uniform, which no key names.
fn dynamic_axes_have_none() -> Outcome {
    let axes =
        "fixed = { values = [false, true] }\nmoving = { values = [1, 2], mode = \"dynamic\" }\n";
    for language in LANGUAGES {
        let text = written(axes, language.name)?;
        has(&text, "fixed")?;
        if has(&text, "moving").is_ok() {
            return Err(format!("{} has keys for a dynamic axis", language.name).into());
        }
    }
    Ok(())
}

/// A written file is recognised by its beginning, in every language; another is not.
fn written_files_are_known() -> Outcome {
    for language in LANGUAGES {
        let text = written("fixed = { values = [false, true] }\n", language.name)?;
        if !is_written(text.as_bytes()) {
            return Err(format!("a file for {} is not recognised", language.name).into());
        }
    }
    match is_written(b"// Written by hand") {
        true => Err("a file that was written by hand is taken for ours".into()),
        false => Ok(()),
    }
}

//! `cargo xtask new axis-value`.

use lamplight::bundle::key;
use lamplight::permute::{lock, manifest};
use lamplight::picture::needs::NeedsTable;

use super::{Outcome, made, make, parsed, text};
use crate::snapshot::root;

/// Each line that tests the axis is told with its place. A sentence goes to the end of the
/// description.
pub fn is_told() -> Outcome {
    let sentence = "`unheard_of` is new.";
    let made = made::make(&root(), "axis-value", "forward::specular=unheard_of", &[sentence])?;
    let (steps, files) = (made.next.join("\n"), made.files.into_iter().collect());
    let path = "shaderlib/programs/forward.wesl";
    for (number, line) in std::fs::read_to_string(root().join(path))?.lines().enumerate() {
        let tests = line.contains("@if(specular ");
        let place = format!("  {path}:{}: {}", number + 1, line.trim());
        if tests && !steps.contains(&place) {
            return Err(format!("the steps lack `{place}`:\n{steps}").into());
        }
    }
    for part in ["  shaderlib/programs/forward.wesl:", "new axis-value deferred::specular="] {
        if !steps.contains(part) {
            return Err(format!("the steps lack `{part}`:\n{steps}").into());
        }
    }
    let listed = text(&files, "shaderlib/lamplight.toml")?;
    let (_, axis) = listed.split_once("[program.forward.axis.specular]\n").ok_or("no axis")?;
    match axis.lines().next() {
        Some(doc) if doc.ends_with(&format!(" {sentence}\"")) => Ok(()),
        found => Err(format!("the description should end with `{sentence}`: {found:?}").into()),
    }
}

/// A new value of an axis is in the manifest, in the lock file and in the table of pictures.
pub fn is_listed() -> Outcome {
    let files = make("axis-value", "forward::fog=unheard_of", &[])?;
    let manifest = parsed(text(&files, "shaderlib/lamplight.toml")?, manifest::parse)?;
    let program = manifest.program("forward").ok_or("no program `forward`")?;
    let axis = program.space.axis("fog").ok_or("no axis `fog`")?;
    if axis.value_names().last().map(String::as_str) != Some("unheard_of") {
        let values = axis.value_names();
        return Err(format!("the last value of `fog` should be `unheard_of`: {values:?}").into());
    }
    let known =
        parsed(&std::fs::read_to_string(root().join("shaderlib/lamplight.lock"))?, lock::parse)?;
    let extended = manifest
        .programs
        .iter()
        .fold(known, |lock, program| lock.extended(&program.name, &program.space));
    if extended.to_string() != text(&files, "shaderlib/lamplight.lock")? {
        return Err("the lock file differs from what `lamplight keys --lock` would write".into());
    }
    ships("forward", "fog", "unheard_of")?;
    ships("tonemap", "exposure", "automatic")?;
    let pictures = text(&files, "shaderlib/pictures.toml")?;
    parsed(pictures, |sources, id| NeedsTable::parse(sources, id, &manifest))?;
    let without = pictures.replace("unheard_of = { background = \"haze\" }\n", "");
    match parsed(&without, |sources, id| NeedsTable::parse(sources, id, &manifest)) {
        Err(problem) if problem.message().unwrap_or_default().contains("`fog=unheard_of`") => {
            Ok(())
        }
        Err(problem) => {
            let found = problem.message().unwrap_or_default();
            Err(format!("without a row, expected an error for `fog=unheard_of`, found {found}")
                .into())
        }
        Ok(_) => Err("a table of pictures without a row for `fog=unheard_of` is accepted".into()),
    }
}

/// Some permutation with a new value ships, by a slice or by a key that is added.
fn ships(program: &str, axis: &str, value: &str) -> Outcome {
    let files = make("axis-value", &format!("{program}::{axis}={value}"), &[])?;
    let manifest = parsed(text(&files, "shaderlib/lamplight.toml")?, manifest::parse)?;
    let space = &manifest.program(program).ok_or("the program is lost")?.space;
    let has = |key: &str| key::has_value(key, axis, value);
    match space.enumerate().iter().any(|point| has(&space.key(point).to_string())) {
        true => Ok(()),
        false => Err(format!("no permutation of {program} with {axis}={value} ships").into()),
    }
}

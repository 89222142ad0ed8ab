//! Emitted MSL that the validator must accept: stages of every kind, and the shaders of
//! `tests/emit`. Each is emitted as a whole and as it ships, which is linked from functions.

use std::fs;
use std::path::{Path, PathBuf};

use lamplight::bundle::{Language, Stage, Target};
use lamplight::compose::Composed;
use lamplight::link::Linker;
use lamplight::validate::{Validated, validate};
use lamplight::{emit, link};

use super::{Outcome, fail_with, files, refusals_of};

pub fn outputs() -> Outcome {
    let mut paths = files("accepted");
    let emitted = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/emit/valid");
    let others = fs::read_dir(emitted)?.map(|entry| entry.map(|entry| entry.path()));
    paths.extend(others.collect::<Result<Vec<_>, _>>()?);
    paths.sort();
    let (mut names, mut texts) = (Vec::new(), Vec::new());
    let linker = Linker::new(&[Target::MSL]);
    for path in &paths {
        let validated = read(path)?;
        for point in &validated.module.entry_points {
            let name = format!("{}, {}", path.display(), point.name);
            let alone = emit::isolate(&validated, &point.name)
                .map_err(|errors| format!("{name}: {errors:?}"))?;
            let whole = emit::emit(&alone, &point.name, Target::MSL)
                .map_err(|error| format!("{name}: {}", error.message))?;
            texts.push(String::from_utf8(whole.bytes)?);
            names.push(name.clone());
            let linked = link::module_linked(&alone, &point.name, Target::MSL, &linker)
                .map_err(|errors| format!("{name}: {errors:?}"))?;
            texts.push(String::from_utf8(linked.bytes.to_vec())?);
            names.push(format!("{name}, as it ships"));
        }
    }
    let refusals = refusals_of(&texts)?;
    let wrong: Vec<String> = refusals
        .iter()
        .map(|refusal| {
            let (name, text) = (&names[refusal.index], &texts[refusal.index]);
            let line = refusal.errors.split(':').next().and_then(|line| line.parse::<usize>().ok());
            let line = line.and_then(|line| text.lines().nth(line - 1)).unwrap_or_default();
            format!("{name}: {}\n{line}", refusal.errors)
        })
        .collect();
    println!("{} outputs", texts.len());
    fail_with(&wrong)
}

fn read(path: &PathBuf) -> Result<Validated, String> {
    let text = fs::read_to_string(path).map_err(|error| error.to_string())?;
    let name = path.to_string_lossy();
    let composed = match name.split_once('.').map_or("", |(_, extension)| extension) {
        "vert.glsl" => Composed::of_text(Language::Glsl, Some(Stage::Vertex), text),
        "frag.glsl" => Composed::of_text(Language::Glsl, Some(Stage::Fragment), text),
        _ => Composed::of_text(Language::Wesl, None, text),
    };
    validate(&composed).map_err(|errors| format!("{name}: {errors:?}"))
}

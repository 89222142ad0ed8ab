//! Texts of GLSL: what becomes of them, and what is said about mistakes.

mod damaged;
mod interface;
mod messages;
mod programs;

use std::path::Path;

use lamplight_diagnostic::source::SourceId;
use lamplight_glsl::translate;
use lamplight_glsl::tree::Stage;
use lamplight_testing::{run_tests, snapshot};
use libtest_mimic::{Failed, Trial};

fn main() -> std::process::ExitCode {
    run_tests(&[translated, messages::tests, interface::tests, damaged::tests, programs::tests])
}

/// The folder of texts whose translation is recorded.
const TEXTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/translated");

/// The names and contents of the texts.
fn texts() -> Vec<(String, String)> {
    let files = std::fs::read_dir(TEXTS).into_iter().flatten().flatten();
    let mut found: Vec<(String, String)> = files
        .filter_map(|file| {
            let text = std::fs::read_to_string(file.path()).ok()?;
            Some((file.file_name().to_string_lossy().into_owned(), text))
        })
        .collect();
    found.sort();
    found
}

fn stage_of(name: &str) -> Stage {
    match Path::new(name).extension().and_then(|extension| extension.to_str()) {
        Some("vert") => Stage::Vertex,
        Some("comp") => Stage::Compute,
        _ => Stage::Fragment,
    }
}

fn translated() -> Vec<Trial> {
    let test = |(name, text): (String, String)| {
        Trial::test(format!("glsl::translated/{name}"), move || check(&name, &text))
    };
    texts().into_iter().map(test).collect()
}

/// The translation is as recorded, and naga accepts it.
fn check(name: &str, text: &str) -> Result<(), Failed> {
    let translated = translate(text, stage_of(name), SourceId(0), Default::default());
    let written = translated.map_err(|problems| format!("refused: {problems:?}"))?;
    let mut shown = written.text.clone();
    for resource in &written.facts.names.resources {
        shown.push_str(&format!("// {resource:?}\n"));
    }
    for (fact, _) in &written.facts.list {
        shown.push_str(&format!("// {fact:?}\n"));
    }
    snapshot::check("glsl", name, &shown)?;
    let module = naga::front::wgsl::parse_str(&written.text)
        .map_err(|error| error.emit_to_string(&written.text))?;
    let flags = naga::valid::ValidationFlags::all();
    let mut validator = naga::valid::Validator::new(flags, naga::valid::Capabilities::all());
    validator.validate(&module).map_err(|error| error.emit_to_string(&written.text))?;
    Ok(())
}

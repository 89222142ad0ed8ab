//! The reader of GLSL: how many megabytes of preprocessed text one core parses in a second, and how
//! many it checks and translates to WGSL, beside naga's front end, which makes a module of them.
//!
//! The texts are the library's programs in GLSL, composed with the defaults of their axes.

use std::error::Error;
use std::hint::black_box;
use std::time::{Duration, Instant};

use lamplight::compose::{self, glsl as composer};
use lamplight::diagnostic::Diagnostics;
use lamplight::glsl::tree::Stage;
use lamplight::glsl::{check, parse, translate};
use lamplight::project::{library_manifest, library_packages};
use lamplight::resolve;
use lamplight::source::SourceId;
use naga::ShaderStage;
use naga::front::glsl::{Frontend, Options};

use crate::Outcome;

/// How long each step is repeated.
const PATIENCE: Duration = Duration::from_secs(3);

/// Prints the rates. The last line has those that the project promises.
pub fn run() -> Outcome {
    let texts = texts()?;
    let bytes: usize = texts.iter().map(|(text, _)| text.len()).sum();
    println!("{} texts, {:.2} MB", texts.len(), bytes as f64 / 1e6);
    let parsed = rate(bytes, || {
        for (text, _) in &texts {
            black_box(parse::parse(text));
        }
    });
    let mut problems = 0;
    let checked = rate(bytes, || {
        for (text, stage) in &texts {
            let parsed = parse::parse(text);
            problems += check::check(text, &parsed, *stage, SourceId(0)).err().map_or(0, |_| 1);
        }
    });
    let translated = rate(bytes, || {
        for (text, stage) in &texts {
            let written = translate(text, *stage, SourceId(0), Default::default());
            problems += black_box(&written).as_ref().err().map_or(0, |_| 1);
        }
    });
    let naga = rate(bytes, || {
        for (text, stage) in &texts {
            let options = Options::from(naga_stage(*stage));
            problems += Frontend::default().parse(&options, text).err().map_or(0, |_| 1);
        }
    });
    if problems > 0 {
        return Err("a text of the library is refused".into());
    }
    println!("with types: {checked:.1} MB/s");
    println!("naga's front end: {naga:.1} MB/s, {:.2} of that with types", naga / checked);
    println!("parsed: {parsed:.1} MB/s, with types and translation: {translated:.1} MB/s");
    Ok(())
}

fn naga_stage(stage: Stage) -> ShaderStage {
    match stage {
        Stage::Vertex => ShaderStage::Vertex,
        Stage::Fragment => ShaderStage::Fragment,
        Stage::Compute => ShaderStage::Compute,
    }
}

/// Megabytes of text in a second.
fn rate(bytes: usize, mut step: impl FnMut()) -> f64 {
    let (started, mut rounds) = (Instant::now(), 0_u32);
    while started.elapsed() < PATIENCE {
        step();
        rounds += 1;
    }
    bytes as f64 * f64::from(rounds) / 1e6 / started.elapsed().as_secs_f64()
}

fn texts() -> Result<Vec<(String, Stage)>, Box<dyn Error>> {
    let message = |problems: Diagnostics| format!("{problems:?}");
    let (mut sources, manifest) = library_manifest().map_err(|(_, problems)| message(problems))?;
    let packages = library_packages();
    let mut texts = Vec::new();
    for program in &manifest.programs {
        let settings = program.space.settings(&program.space.default_assignment());
        let Some(glsl) = &program.glsl else { continue };
        for (file, stage) in [(&glsl.vertex, Stage::Vertex), (&glsl.fragment, Stage::Fragment)] {
            let Some(file) = file else { continue };
            let graph = resolve::glsl::load(&mut sources, &packages, &file.path);
            let composed = composer::compose(
                &graph.map_err(message)?,
                &settings,
                &compose::Options::default(),
            );
            texts.push((composed.map_err(message)?.text, stage));
        }
    }
    Ok(texts)
}

//! GLSL and HLSL: glslangValidator.
//!
//! Starting it takes longer than reading a text, so it gets many texts at once. When it makes
//! SPIR-V it links all of them, which makes no sense here, so its messages about linking are
//! ignored. Outputs with something new in them ([`novel_outputs`]) are compiled to SPIR-V one by one.

use std::path::Path;
use std::process::Output as Said;

use super::novel::novel_outputs;
use super::{Found, Output, Refusal, Work, divide_group};
use crate::bundle::Stage;
use crate::emit::GlslRules;
use crate::output::Scratch;
use crate::tools::{GLSLANG, printed_words};

const BATCH: usize = 64;

const NAME: &str = "glslangValidator";

/// A stage as glslangValidator calls it.
fn stage_name(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vert",
        Stage::Fragment => "frag",
        Stage::Compute => "comp",
    }
}

/// The work for texts of GLSL of one stage.
pub fn plan_glsl<'w>(
    group: &'w [&'w Output],
    rules: &[GlslRules],
    scratch: &'w Scratch,
) -> Result<Vec<Work<'w>>, String> {
    let Some(first) = group.first() else { return Ok(Vec::new()) };
    let own = vec!["-S", stage_name(first.stage)];
    let mut works = Vec::new();
    for rules in rules {
        match rules {
            GlslRules::Own => {
                let arguments = own.clone();
                works.extend(divide_group(group, BATCH, move |outputs| {
                    judge_together(&arguments, outputs)
                }));
            }
            GlslRules::Later(version) => {
                let (arguments, version) = (own.clone(), *version);
                works.extend(divide_group(group, BATCH, move |outputs| {
                    judge_later_version(&arguments, outputs, version, scratch)
                }));
            }
            GlslRules::Vulkan => {
                // The relaxed rules accept OpenGL's names of built-in variables. They also accept
                // uniforms outside of blocks, which get bindings.
                let more = ["-V", "-R", "--amb", "-o", "/dev/null"];
                works.extend(plan_compiled(group, [&own[..], &more].concat())?);
            }
        }
    }
    Ok(works)
}

/// The work for texts of HLSL of one stage and entry point.
pub fn plan_hlsl<'w>(group: &'w [&'w Output]) -> Result<Vec<Work<'w>>, String> {
    let Some(first) = group.first() else { return Ok(Vec::new()) };
    let stage = stage_name(first.stage);
    plan_compiled(group, vec!["-D", "-V", "-S", stage, "-e", &first.entry, "-o", "/dev/null"])
}

/// Reads each text, and compiles those with something new in them.
fn plan_compiled<'w>(
    group: &'w [&'w Output],
    arguments: Vec<&'w str>,
) -> Result<Vec<Work<'w>>, String> {
    let alone = arguments.clone();
    let mut works = divide_group(group, BATCH, move |outputs| judge_parse(&arguments, outputs));
    let each = novel_outputs(group)?.into_iter().map(|output| {
        let arguments = alone.clone();
        Work { outputs: 1, run: Box::new(move || judge_one(&arguments, output)) }
    });
    works.extend(each);
    Ok(works)
}

/// Judges texts as the files they are.
fn judge_together(arguments: &[&str], outputs: &[&Output]) -> Found {
    if run_glslang(arguments, outputs.iter().map(|output| &*output.file))?.status.success() {
        return Ok(Vec::new());
    }
    judge_each(arguments, outputs)
}

fn judge_each(arguments: &[&str], outputs: &[&Output]) -> Found {
    let found = outputs.iter().map(|output| judge_one(arguments, output));
    Ok(found.collect::<Result<Vec<_>, _>>()?.concat())
}

fn judge_one(arguments: &[&str], output: &Output) -> Found {
    Ok(make_refusal(output, &output.file, &run_glslang(arguments, [&*output.file])?)
        .into_iter()
        .collect())
}

/// Judges texts with another version in their first line.
fn judge_later_version(
    arguments: &[&str],
    outputs: &[&Output],
    version: &str,
    scratch: &Scratch,
) -> Found {
    let mut files = Vec::new();
    for output in outputs {
        let text = output.text()?;
        let rest = text.find('\n').map_or("", |end| &text[end..]);
        let text = format!("#version {version}{rest}");
        files.push(scratch.write_unsynced(text.as_bytes()).map_err(|error| error.to_string())?);
    }
    let said = run_glslang(arguments, files.iter().map(|file| &**file))?;
    let mut refusals = Vec::new();
    for (output, file) in outputs.iter().zip(&files) {
        if !said.status.success() {
            refusals.extend(make_refusal(output, file, &run_glslang(arguments, [&**file])?));
        }
        // A file that cannot be removed now is removed with the folder.
        let _ = std::fs::remove_file(file);
    }
    Ok(refusals)
}

/// Reads texts by the rules of Vulkan. Linking always fails, and that is ignored.
fn judge_parse(arguments: &[&str], outputs: &[&Output]) -> Found {
    let said = run_glslang(arguments, outputs.iter().map(|output| &*output.file))?;
    let of_a_text = |line: &str| line.starts_with("ERROR: ") && !line.contains(" Linking ");
    if said.status.code().is_some() && !printed_words(&said).lines().any(of_a_text) {
        return Ok(Vec::new());
    }
    judge_each(arguments, outputs)
}

fn run_glslang<'f>(
    arguments: &[&str],
    files: impl IntoIterator<Item = &'f Path>,
) -> Result<Said, String> {
    GLSLANG.run(arguments, files).map_err(|error| error.to_string())
}

fn make_refusal(output: &Output, file: &Path, said: &Said) -> Option<Refusal> {
    let path = file.display().to_string();
    let said = (!said.status.success()).then(|| printed_words(said))?;
    let lines = said.lines().map(str::trim).filter(|line| !line.is_empty() && *line != path);
    let words = lines.collect::<Vec<_>>().join("\n").replace(&path, "0");
    let line = words.lines().find_map(line_of);
    Some(Refusal { output: output.clone(), judge: NAME, line, words })
}

/// The number in `ERROR: 0:12: ...`.
fn line_of(words: &str) -> Option<u32> {
    words.strip_prefix("ERROR: 0:")?.split(':').next()?.parse().ok()
}

//! GLSL and HLSL: glslangValidator, and glslc, which has the same compiler in it.
//!
//! Starting either of them takes longer than reading a text, so they get many texts at once. When
//! glslangValidator makes SPIR-V it links all texts, which makes no sense here, so it only reads
//! them, and its messages about linking are ignored. glslc compiles each text by itself. Compiling
//! HLSL takes twice as long as reading it, so only outputs with something new in them
//! ([`novel_outputs`]) are compiled. If glslc refuses a text, glslangValidator decides.
//!
//! | rule | validated are |
//! |---|---|
//! | `own` | texts of GLSL or GLSL ES, of the version that they name |
//! | `310 es`, `330 core` | the same, with this later version in the place of their own |
//! | `vulkan` | texts for OpenGL by the rules of Vulkan, as far as they can keep them |
//! | `hlsl` | texts of HLSL, compiled for Vulkan |

use std::io;
use std::path::{Path, PathBuf};
use std::process::Output as ProcessOutput;

use crate::novel::novel_outputs;
use crate::{
    Output, OutputGroup, Refusal, Tint, ValidatorEntry, ValidatorResult, ValidatorWork,
    divide_group,
};
use lamplight_files::output::Scratch;
use lamplight_tools::{GLSLANG, GLSLC, halve_refused, output_text};

/// The validator, for the table of all.
pub const VALIDATOR: ValidatorEntry = ValidatorEntry {
    name: "glslang",
    tools: &[GLSLANG, GLSLC],
    lacks: |_| None,
    version: |_| String::new(),
    validators,
    goes_on: false,
    plan,
};

const BATCH: usize = 64;

const NAME: &str = "glslangValidator";

/// glslc compiles to SPIR-V.
fn validators(rules: &[&str], _: &Tint) -> Vec<String> {
    let compiles = rules.iter().any(|rule| ["vulkan", "hlsl"].contains(rule));
    [GLSLANG.described()].into_iter().chain(compiles.then(|| GLSLC.described())).collect()
}

fn plan<'w>(group: &OutputGroup<'w>) -> Result<Vec<ValidatorWork<'w>>, String> {
    let Some(first) = group.outputs.first() else { return Ok(Vec::new()) };
    let mut works = Vec::new();
    for rule in group.rules {
        works.extend(plan_rule(group, first, rule)?);
    }
    Ok(works)
}

/// The work for one rule. All outputs have the stage and the entry point of the first one.
fn plan_rule<'w>(
    group: &OutputGroup<'w>,
    first: &'w Output,
    rule: &'static str,
) -> Result<Vec<ValidatorWork<'w>>, String> {
    let (outputs, scratch) = (group.outputs, group.scratch);
    let own = vec!["-S", first.stage.suffix()];
    let stage = format!("-fshader-stage={}", first.stage.suffix());
    match rule {
        "own" => Ok(divide_group(outputs, BATCH, move |outputs| validate_together(&own, outputs))),
        // The relaxed rules accept OpenGL's names of built-in variables. They also accept uniforms
        // outside of blocks, which get bindings. glslc has no such option, but few texts need them.
        "vulkan" => {
            let options = vec![stage, "-fauto-bind-uniforms".into(), "-fauto-map-locations".into()];
            let alone = [&own[..], &["-V", "-R", "--amb", "-o", "/dev/null"]].concat();
            Ok(divide_group(outputs, BATCH, move |outputs| {
                validate_compiled(&options, &alone, outputs)
            }))
        }
        "hlsl" => {
            let entry = format!("-fentry-point={}", first.entry);
            let options = vec![stage, "-x".into(), "hlsl".into(), entry];
            let alone = [&own[..], &["-D", "-V", "-e", &first.entry, "-o", "/dev/null"]].concat();
            plan_hlsl(outputs, options, alone)
        }
        version if version.starts_with(|first: char| first.is_ascii_digit()) => {
            Ok(divide_group(outputs, BATCH, move |outputs| {
                validate_later_version(&own, outputs, version, scratch)
            }))
        }
        _ => Err(format!("glslangValidator has no rule `{rule}`")),
    }
}

/// Reads each text, and compiles those with something new in them.
fn plan_hlsl<'w>(
    group: &'w [&'w Output],
    options: Vec<String>,
    alone: Vec<&'w str>,
) -> Result<Vec<ValidatorWork<'w>>, String> {
    let read = alone.clone();
    let mut works = divide_group(group, BATCH, move |outputs| validate_parse(&read, outputs));
    let novel = novel_outputs(group)?;
    works.extend(novel.chunks(BATCH).map(|part| {
        let outputs = part.len();
        let (part, options, alone) = (part.to_vec(), options.clone(), alone.clone());
        ValidatorWork { outputs, run: Box::new(move || validate_compiled(&options, &alone, &part)) }
    }));
    Ok(works)
}

/// Has glslc compile texts to SPIR-V in one run. glslangValidator validates each text that glslc
/// refuses.
///
/// Parameters: `options` of glslc; those of glslangValidator, `alone`.
fn validate_compiled(options: &[String], alone: &[&str], outputs: &[&Output]) -> ValidatorResult {
    // glslc writes the SPIR-V to the current folder. It is removed after each batch, since that of
    // a whole bundle takes hundreds of megabytes.
    let scratch = Scratch::new(&std::env::temp_dir()).map_err(|error| error.to_string())?;
    let together = |outputs: &[&Output]| {
        let given = options.iter().map(String::as_str);
        let options: Vec<&str> = given.chain(["-Werror", "-c"]).collect();
        let files = outputs.iter().map(|output| std::path::absolute(&output.file));
        let files = files.collect::<io::Result<Vec<PathBuf>>>();
        let result = files.and_then(|files| GLSLC.run_in(&scratch.path(""), &options, files));
        Ok(result.map_err(|error| error.to_string())?.status.success().then(Vec::new))
    };
    halve_refused(outputs, &together, &|output| validate_one(alone, output))
}

/// Validates texts in one run if it accepts them all.
fn validate_together(arguments: &[&str], outputs: &[&Output]) -> ValidatorResult {
    let together = |outputs: &[&Output]| {
        let result = run_glslang(arguments, outputs.iter().map(|output| &*output.file))?;
        Ok(result.status.success().then(Vec::new))
    };
    halve_refused(outputs, &together, &|output| validate_one(arguments, output))
}

fn validate_one(arguments: &[&str], output: &Output) -> ValidatorResult {
    Ok(make_refusal(output, &output.file, &run_glslang(arguments, [&*output.file])?)
        .into_iter()
        .collect())
}

/// Validates texts with another version in their first line.
fn validate_later_version(
    arguments: &[&str],
    outputs: &[&Output],
    version: &str,
    scratch: &Scratch,
) -> ValidatorResult {
    let mut files = Vec::new();
    for output in outputs {
        let text = output.text()?;
        let rest = text.find('\n').map_or("", |end| &text[end..]);
        let text = format!("#version {version}{rest}");
        files.push(scratch.write_unsynced(text.as_bytes()).map_err(|error| error.to_string())?);
    }
    let texts: Vec<(&Output, &Path)> =
        outputs.iter().copied().zip(files.iter().map(|file| &**file)).collect();
    let together = |texts: &[(&Output, &Path)]| {
        let result = run_glslang(arguments, texts.iter().map(|(_, file)| *file))?;
        Ok(result.status.success().then(Vec::new))
    };
    let alone = |(output, file): &(&Output, &Path)| {
        Ok(make_refusal(output, file, &run_glslang(arguments, [*file])?).into_iter().collect())
    };
    let refusals = halve_refused(&texts, &together, &alone);
    for file in &files {
        // A file that cannot be removed now is removed with the folder.
        let _ = std::fs::remove_file(file);
    }
    refusals
}

/// Parses texts in one run, which also tries to link them. Linking always fails, and that is
/// ignored.
fn validate_parse(arguments: &[&str], outputs: &[&Output]) -> ValidatorResult {
    let together = |outputs: &[&Output]| {
        let result = run_glslang(arguments, outputs.iter().map(|output| &*output.file))?;
        let of_a_text = |line: &str| line.starts_with("ERROR: ") && !line.contains(" Linking ");
        let accepts =
            result.status.code().is_some() && !output_text(&result).lines().any(of_a_text);
        Ok(accepts.then(Vec::new))
    };
    halve_refused(outputs, &together, &|output| validate_one(arguments, output))
}

fn run_glslang<'f>(
    arguments: &[&str],
    files: impl IntoIterator<Item = &'f Path>,
) -> Result<ProcessOutput, String> {
    GLSLANG.run(arguments, files).map_err(|error| error.to_string())
}

fn make_refusal(output: &Output, file: &Path, result: &ProcessOutput) -> Option<Refusal> {
    let path = file.display().to_string();
    let printed = (!result.status.success()).then(|| output_text(result))?;
    let lines = printed.lines().map(str::trim).filter(|line| !line.is_empty() && *line != path);
    let message = lines.collect::<Vec<_>>().join("\n").replace(&path, "0");
    let line = message.lines().find_map(line_of);
    Some(Refusal { output: output.clone(), validator: NAME, line, message })
}

/// The number in `ERROR: 0:12: ...`.
fn line_of(message: &str) -> Option<u32> {
    message.strip_prefix("ERROR: 0:")?.split(':').next()?.parse().ok()
}

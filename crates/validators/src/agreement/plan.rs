//! Which outputs are read again, and by how many starts of programs.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use lamplight_bundle::{Binding, Reflection, Stage, Target};
use lamplight_files::output::Scratch;
use lamplight_generate::cache::hash_parts;
use lamplight_tools::metal::{Clang, MslRefusal, validate_declarations};
use lamplight_tools::{GLSLC, halve_refused, output_text};

use super::described::Described;
use super::{glsl, msl, output_differences, unread};
use crate::{Output, Refusal, ValidatorResult, ValidatorWork, divide_group, read_bytes};

/// What refuses an output that differs from its reflection, in the place of a validator.
pub const AGREEMENT: &str = "reflection";

const BATCH: usize = 64;

impl Output {
    /// What the bundle says of it.
    pub(crate) fn described(&self) -> Described<'_> {
        Described { reflection: &self.reflection, native: &self.native }
    }

    /// The refusal for differences, if there are any.
    pub(crate) fn disagreement(&self, differences: &[String]) -> Option<Refusal> {
        (!differences.is_empty()).then(|| Refusal {
            output: self.clone(),
            validator: AGREEMENT,
            line: None,
            message: differences.join("\n"),
        })
    }
}

/// The work of reading a group of outputs again, all of one target and stage.
pub fn plan_agreement<'w>(group: &'w [&'w Output]) -> Result<Vec<ValidatorWork<'w>>, String> {
    let Some(first) = group.first() else { return Ok(Vec::new()) };
    match first.target {
        Target::MSL => {
            let clang = Arc::new(Clang::open().map_err(|missing| missing.reason)?);
            let check = move |texts: &[&Declarations<'_>]| assert_declarations(&clang, texts);
            Ok(plan_declarations(group, msl::asserted_declarations, check))
        }
        Target::SPIRV | Target::HLSL | Target::WGSL => Ok(divide_group(group, BATCH, read_outputs)),
        _ => {
            let declarations =
                |text: &str, described: Described<'_>| Ok(glsl::declarations(text, described));
            Ok(plan_declarations(group, declarations, compile_declarations))
        }
    }
}

fn read_outputs(outputs: &[&Output]) -> ValidatorResult {
    let mut refusals = Vec::new();
    for output in outputs {
        refusals.extend(output.disagreement(&plain_differences(output)?));
    }
    Ok(refusals)
}

/// What can be seen without another program.
fn plain_differences(output: &Output) -> Result<Vec<String>, String> {
    let Described { reflection, native } = output.described();
    Ok(output_differences(output.target, &read_bytes(&output.file)?, reflection, native))
}

/// The declarations of a text, and an output that has them.
struct Declarations<'w> {
    output: &'w Output,
    text: String,
}

/// Reads each text; has `check` read the declarations, many at once. Those that have the same
/// declarations and bindings are read once.
fn plan_declarations<'w>(
    group: &'w [&'w Output],
    declarations: impl Fn(&str, Described<'_>) -> Result<String, String> + Clone + Send + Sync + 'w,
    check: impl Fn(&[&Declarations<'_>]) -> ValidatorResult + Clone + Send + Sync + 'w,
) -> Vec<ValidatorWork<'w>> {
    divide_group(group, group.len().max(1), move |outputs: &[&Output]| {
        let mut refusals = read_outputs(outputs)?;
        let (mut seen, mut distinct) = (BTreeSet::new(), Vec::new());
        for output in outputs {
            match declarations(&output.text()?, output.described()) {
                Ok(text) => {
                    let Reflection { workgroup_size, bindings, .. } = &*output.reflection;
                    let kind = (hash_parts(&[&text]), *workgroup_size, bindings, &output.native);
                    if seen.insert(kind) {
                        distinct.push(Declarations { output, text });
                    }
                }
                Err(reason) => refusals.extend(output.disagreement(&[reason])),
            }
        }
        let distinct: Vec<&Declarations<'_>> = distinct.iter().collect();
        for batch in distinct.chunks(BATCH) {
            refusals.extend(check(batch)?);
        }
        Ok(refusals)
    })
}

/// Has clang check the assertions behind declarations in MSL.
fn assert_declarations(clang: &Clang, batch: &[&Declarations<'_>]) -> ValidatorResult {
    let texts: Vec<(usize, &str)> =
        batch.iter().enumerate().map(|(index, one)| (index, one.text.as_str())).collect();
    let refused = validate_declarations(clang, &texts).map_err(|missing| missing.reason)?;
    let one = |MslRefusal { index, errors }: MslRefusal| {
        batch.get(index).and_then(|one| one.output.disagreement(&[errors]))
    };
    Ok(refused.into_iter().filter_map(one).collect())
}

/// Has glslc compile declarations in GLSL, and reads what it makes of them.
fn compile_declarations(batch: &[&Declarations<'_>]) -> ValidatorResult {
    let scratch = Scratch::new(&std::env::temp_dir()).map_err(|error| error.to_string())?;
    let Some(first) = batch.first() else { return Ok(Vec::new()) };
    let stage = format!("-fshader-stage={}", first.output.stage.suffix());
    let options = [&stage, "-fauto-bind-uniforms", "-fauto-map-locations", "-c"];
    let write = |(number, one): (usize, &&Declarations<'_>)| {
        scratch.stage(&format!("{number}.glsl"), one.text.as_bytes())
    };
    let files = batch.iter().enumerate().map(write).collect::<Result<Vec<_>, _>>();
    let files = files.map_err(|error| error.to_string())?;
    let texts: Vec<(&Output, &Path)> =
        batch.iter().map(|one| one.output).zip(files.iter().map(PathBuf::as_path)).collect();
    let together = |texts: &[(&Output, &Path)]| match run_glslc(&scratch, &options, texts)? {
        Some(_) => Ok(None),
        None => read_all(texts).map(Some),
    };
    let alone = |one: &(&Output, &Path)| match run_glslc(&scratch, &options, &[*one])? {
        Some(message) => {
            let words = format!("its declarations cannot be read again: {message}");
            Ok(one.0.disagreement(&[words]).into_iter().collect())
        }
        None => read_all(&[*one]),
    };
    halve_refused(&texts, &together, &alone)
}

/// Compiles files in one run. Returns the compiler's message if it refuses them.
fn run_glslc(
    scratch: &Scratch,
    options: &[&str],
    texts: &[(&Output, &Path)],
) -> Result<Option<String>, String> {
    let result = GLSLC.run_in(&scratch.path(""), options, texts.iter().map(|(_, file)| file));
    let result = result.map_err(|error| error.to_string())?;
    Ok((!result.status.success()).then(|| output_text(&result)))
}

/// Reads the SPIR-V that is there for each text.
fn read_all(texts: &[(&Output, &Path)]) -> ValidatorResult {
    let mut refusals = Vec::new();
    for (output, file) in texts {
        let bytes = read_bytes(&file.with_extension("spv"))?;
        let found = glsl::compiled_differences(&bytes, output.described());
        let found = found.unwrap_or_else(|reason| vec![unread(&reason)]);
        refusals.extend(output.disagreement(&found));
    }
    Ok(refusals)
}

/// For each different set of buffers and size of a workgroup, one output that is not chosen, unless
/// one is: lines alone do not decide a layout, since a member moves those behind it.
pub fn sample_of_lines<'o>(outputs: &[&'o Output], chosen: &[&Output]) -> Vec<&'o Output> {
    let mut seen: BTreeSet<BufferSet<'_>> =
        chosen.iter().map(|output| buffer_set(output)).collect();
    outputs.iter().copied().filter(|output| seen.insert(buffer_set(output))).collect()
}

/// Stage, size of a workgroup and buffers.
type BufferSet<'o> = (Stage, Option<[u32; 3]>, Vec<&'o Binding>);

fn buffer_set(output: &Output) -> BufferSet<'_> {
    let Reflection { stage, workgroup_size, bindings, .. } = &*output.reflection;
    let is_buffer = |one: &&Binding| one.kind.is_buffer();
    (*stage, *workgroup_size, bindings.iter().filter(is_buffer).collect())
}

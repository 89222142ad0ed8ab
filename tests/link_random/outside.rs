//! Compilers that are not ours over the outputs of random programs.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use lamplight::bundle::{Stage, Target};
use lamplight::metal;

use super::judge::Output;
use crate::external::{self, Job};

/// Something that a judge refuses: the place of the output, and the judge's words.
pub type Refusal = (usize, String);

/// What the judges refuse of some outputs.
///
/// # Errors
/// Why a judge could not be run.
pub fn refused(outputs: &[&Output]) -> Result<Vec<Refusal>, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let mut files = Vec::new();
    for (index, output) in outputs.iter().enumerate() {
        let file = folder.path().join(format!("{index}.{}", output.artifact.extension));
        std::fs::write(&file, &output.artifact.bytes).map_err(|error| error.to_string())?;
        files.push(file);
    }
    let mut found = plain(outputs, &files)?;
    found.extend(metal(outputs)?);
    for (index, output) in outputs.iter().enumerate() {
        if output.target == Target::HLSL
            && let Some(words) = hlsl(output, &files[index])?
        {
            found.push((index, words));
        }
    }
    Ok(found)
}

/// SPIR-V and GLSL.
fn plain(outputs: &[&Output], files: &[PathBuf]) -> Result<Vec<Refusal>, String> {
    let job = |(output, file): (&&Output, &PathBuf)| Job {
        target: output.target.name().to_owned(),
        stage: external::stage(output.reflection.stage),
        file: file.clone(),
    };
    let jobs: Vec<Job> = outputs.iter().zip(files).map(job).collect();
    let (_, words) = external::validate(jobs, &|_| {}).map_err(|error| error.to_string())?;
    let index = |words: &String| {
        let (path, _) = words.split_once(" (")?;
        files.iter().position(|file| file.as_path() == Path::new(path))
    };
    Ok(words.into_iter().map(|words| (index(&words).unwrap_or_default(), words)).collect())
}

fn metal(outputs: &[&Output]) -> Result<Vec<Refusal>, String> {
    let own = |(_, output): &(usize, &&Output)| output.target == Target::MSL;
    let places: Vec<usize> = outputs.iter().enumerate().filter(own).map(|(at, _)| at).collect();
    let texts: Vec<String> = places
        .iter()
        .map(|place| String::from_utf8_lossy(&outputs[*place].artifact.bytes).into_owned())
        .collect();
    let views: Vec<&str> = texts.iter().map(String::as_str).collect();
    let refusals = metal::judge(&views, &|_| ()).map_err(|missing| missing.reason)?;
    Ok(refusals.into_iter().map(|one| (places[one.index], one.errors)).collect())
}

fn hlsl(output: &Output, file: &Path) -> Result<Option<String>, String> {
    let stage = match output.reflection.stage {
        Stage::Vertex => "vert",
        Stage::Fragment => "frag",
        Stage::Compute => "comp",
    };
    let entry = &output.artifact.native.entry_name;
    let said = Command::new("glslangValidator")
        .args(["-D", "-V", "-S", stage, "-e", entry, "-o", "/dev/null"])
        .arg(file)
        .stdin(Stdio::null())
        .output()
        .map_err(|error| error.to_string())?;
    let words = String::from_utf8_lossy(&said.stdout).into_owned();
    Ok((!said.status.success()).then_some(words))
}

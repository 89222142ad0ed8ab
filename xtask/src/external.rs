//! The external validators: spirv-val over SPIR-V, glslangValidator over GLSL and GLSL ES.

use std::path::PathBuf;
use std::process::{Command, Output, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use lamplight::bundle::Stage;

/// A stage as glslangValidator names it.
pub fn stage(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vert",
        Stage::Fragment => "frag",
        Stage::Compute => "comp",
    }
}

/// Files that one call of glslangValidator takes; spirv-val takes one.
const BATCH: usize = 64;

/// One output file and what must accept it.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Job {
    /// Its target's name.
    pub target: String,
    /// `vert`, `frag` or `comp`.
    pub stage: &'static str,
    /// The file.
    pub file: PathBuf,
}

impl Job {
    /// Whether a validator covers its target. MSL and HLSL have none on Linux.
    pub fn is_covered(&self) -> bool {
        command(self).is_some()
    }
}

/// The command that judges a job, without the file's name.
///
/// SPIR-V is checked for Vulkan 1.1; GLSL as the OpenGL or OpenGL ES it is written for.
fn command(job: &Job) -> Option<Command> {
    let (program, arguments) = match job.target.as_str() {
        "spirv" => ("spirv-val", ["--target-env", "vulkan1.1"]),
        "glsl450" | "glsl330" | "essl300" => ("glslangValidator", ["-S", job.stage]),
        _ => return None,
    };
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null());
    Some(command)
}

/// Judges every covered job, on all cores. Returns how many were judged, and each refusal.
pub fn validate(
    mut jobs: Vec<Job>,
    progress: &(dyn Fn(usize) + Sync),
) -> std::io::Result<(usize, Vec<String>)> {
    jobs.retain(Job::is_covered);
    jobs.sort();
    let batches: Vec<&[Job]> = jobs
        .chunk_by(|a, b| (&a.target, a.stage) == (&b.target, b.stage))
        .flat_map(|alike| alike.chunks(if alike[0].target == "spirv" { 1 } else { BATCH }))
        .collect();
    let (next, judged) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let outcome = Mutex::new(Ok(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some(batch) = batches.get(next.fetch_add(1, Ordering::Relaxed)) {
                    add(&outcome, judge(batch));
                    progress(judged.fetch_add(batch.len(), Ordering::Relaxed) + batch.len());
                }
            });
        }
    });
    let mut refusals = outcome.into_inner().unwrap_or_else(PoisonError::into_inner)?;
    refusals.sort();
    Ok((jobs.len(), refusals))
}

type Refusals = std::io::Result<Vec<String>>;

fn add(outcome: &Mutex<Refusals>, found: Refusals) {
    let mut outcome = outcome.lock().unwrap_or_else(PoisonError::into_inner);
    match (outcome.as_mut(), found) {
        (Ok(refusals), Ok(found)) => refusals.extend(found),
        (Ok(_), Err(error)) => *outcome = Err(error),
        (Err(_), _) => {}
    }
}

/// A batch that is refused is judged again file by file, to say which and why.
fn judge(batch: &[Job]) -> Refusals {
    if run(batch)?.status.success() {
        return Ok(Vec::new());
    }
    let mut refusals = Vec::new();
    for job in batch {
        let output = run(std::slice::from_ref(job))?;
        if !output.status.success() {
            let words =
                String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).trim().to_owned();
            refusals.push(format!("{} ({}): {words}", job.file.display(), job.target));
        }
    }
    Ok(refusals)
}

fn run(batch: &[Job]) -> std::io::Result<Output> {
    let mut command = batch.first().and_then(command).ok_or(std::io::ErrorKind::InvalidInput)?;
    command.args(batch.iter().map(|job| &job.file)).output()
}

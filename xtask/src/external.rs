//! The external validators: spirv-val over SPIR-V, glslangValidator over GLSL and GLSL ES.

use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Programs that judge outputs, with the Debian package that brings each.
pub const VALIDATORS: &[(&str, &str)] = &[("spirv-val", "spirv-tools"), ("glslangValidator", "glslang-tools")];

/// One output file and what must accept it.
pub struct Job {
    /// The file.
    pub file: PathBuf,
    /// Its target's name.
    pub target: String,
    /// `vert`, `frag` or `comp`.
    pub stage: &'static str,
}

/// The command line for a job, if any validator covers its target.
///
/// SPIR-V is checked for Vulkan 1.1; GLSL as the OpenGL or OpenGL ES it is written for.
fn command(job: &Job) -> Option<Command> {
    let mut command = match job.target.as_str() {
        "spirv" => {
            let mut command = Command::new("spirv-val");
            command.args(["--target-env", "vulkan1.1"]);
            command
        }
        "glsl450" | "glsl330" | "essl300" => {
            let mut command = Command::new("glslangValidator");
            command.args(["-S", job.stage]);
            command
        }
        _ => return None,
    };
    command.arg(&job.file).stdin(Stdio::null());
    Some(command)
}

/// Runs every job on all cores. Returns how many were judged, and each refusal.
pub fn validate(jobs: &[Job], progress: &(dyn Fn(usize) + Sync)) -> std::io::Result<(usize, Vec<String>)> {
    let next = AtomicUsize::new(0);
    let judged = AtomicUsize::new(0);
    let refusals = Mutex::new(Vec::new());
    let failure = Mutex::new(None);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(job) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let Some(mut command) = command(job) else { continue };
                    match command.output() {
                        Ok(output) if output.status.success() => {}
                        Ok(output) => keep(&refusals, refusal(job, &output)),
                        Err(error) => *failure.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = Some(error),
                    }
                    progress(judged.fetch_add(1, Ordering::Relaxed) + 1);
                }
            });
        }
    });
    match failure.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner) {
        Some(error) => Err(error),
        None => {
            let mut refusals = refusals.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
            refusals.sort();
            Ok((judged.into_inner(), refusals))
        }
    }
}

fn keep(refusals: &Mutex<Vec<String>>, refusal: String) {
    refusals.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(refusal);
}

fn refusal(job: &Job, output: &std::process::Output) -> String {
    let words = [output.stdout.as_slice(), output.stderr.as_slice()].concat();
    format!("{} ({}): {}", job.file.display(), job.target, String::from_utf8_lossy(&words).trim())
}

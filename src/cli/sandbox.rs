//! `lamplight sandbox`: does work that might crash its process, in a process with limits on memory
//! and time. This program calls itself in this way when input is near a limit; nobody else does.

use std::io::{Read, Write};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use clap::Args;

use super::failure::Failure;
use crate::limits::SANDBOX_SECONDS;
use crate::sandbox::{SandboxFailure, run_by};
use crate::scene::{self, Equirect};
use crate::{link, validate};

/// Do a job in a process that may have little memory and time.
#[derive(Args)]
pub struct Arguments {
    /// Which code does the job.
    stage: String,
}

/// The limit in wall-clock time. The main limit is in processor time, which does not advance while
/// a process waits.
const LONGEST: Duration = Duration::from_secs(12 * SANDBOX_SECONDS);
/// How many bytes of a process's error output are read.
const WORDS: u64 = 64 << 10;

/// Makes [`run_in_sandbox`] in another process the sandbox of this one.
pub fn install_sandbox() {
    run_by(in_a_child);
}

/// Runs in the other process: the job is on standard input.
pub fn run_in_sandbox(arguments: Arguments) -> Result<(), Failure> {
    limit_process()?;
    let mut job = Vec::new();
    std::io::stdin().lock().read_to_end(&mut job)?;
    match arguments.stage.as_str() {
        validate::STAGE => {
            let job = serde_json::from_slice(&job);
            link::perform_job(&job.map_err(|error| Failure::usage(error.to_string()))?);
        }
        scene::DECODER => drop(Equirect::from_radiance(&job)),
        other => return Err(Failure::usage(format!("there is no stage `{other}`"))),
    }
    Ok(())
}

/// Limits the resources of this process. On systems other than Linux only its time is limited, by
/// the caller.
#[cfg(target_os = "linux")]
fn limit_process() -> Result<(), Failure> {
    use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};

    // No limit is raised above what the user allows. The job gets at most half of the memory that
    // the user allows, since the process that starts it has threads and files of its own.
    let limits = [
        (Resource::As, crate::limits::SANDBOX_BYTES, 2),
        (Resource::Cpu, SANDBOX_SECONDS, 1),
        (Resource::Core, 0, 1),
    ];
    for (resource, most, part) in limits {
        let allowed = getrlimit(resource).maximum;
        let most = allowed.map_or(most, |allowed| most.min(allowed / part));
        let limit = Rlimit { current: Some(most), maximum: Some(most) };
        setrlimit(resource, limit).map_err(|error| Failure::environment(error.to_string()))?;
    }
    Ok(())
}

#[cfg(not(target_os = "linux"))]
fn limit_process() -> Result<(), Failure> {
    Ok(())
}

/// Runs a job in a child process. Where no process can be started, the job is done here without a
/// sandbox, as a library does.
fn in_a_child(stage: &str, job: &[u8]) -> Result<(), SandboxFailure> {
    let Ok(program) = std::env::current_exe() else { return Ok(()) };
    let child = Command::new(program)
        .args(["sandbox", stage])
        // One thread, since each would reserve a large stack.
        .env("RAYON_NUM_THREADS", "1")
        // The allocator must not reserve address space in advance: it would take so much that
        // a job which fits was refused in one run of eight.
        .env("MIMALLOC_ARENA_RESERVE", "0")
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn();
    let Ok(mut child) = child else { return Ok(()) };
    let (stdin, stderr) = (child.stdin.take(), child.stderr.take());
    std::thread::scope(|scope| {
        scope.spawn(|| stdin.map(|mut stdin| stdin.write_all(job)));
        let words = scope.spawn(|| {
            let mut words = Vec::new();
            // The rest of the output is read and dropped, so that the process does not wait.
            if let Some(mut stderr) = stderr {
                let _ = stderr.by_ref().take(WORDS).read_to_end(&mut words);
                let _ = std::io::copy(&mut stderr, &mut std::io::sink());
            }
            String::from_utf8_lossy(&words).into_owned()
        });
        let status = exit_status(&mut child);
        failure_of(status, &words.join().unwrap_or_default())
    })
}

/// The exit status of a process; `None` if it had to be killed after [`LONGEST`].
fn exit_status(child: &mut Child) -> Option<ExitStatus> {
    let started = Instant::now();
    while started.elapsed() < LONGEST {
        match child.try_wait() {
            Ok(Some(status)) => return Some(status),
            Ok(None) => std::thread::sleep(Duration::from_millis(2)),
            Err(_) => break,
        }
    }
    let _ = child.kill();
    let _ = child.wait();
    None
}

fn failure_of(status: Option<ExitStatus>, words: &str) -> Result<(), SandboxFailure> {
    match status {
        Some(status) if status.success() => Ok(()),
        None => Err(SandboxFailure::Time),
        Some(status) if is_out_of_time(status) => Err(SandboxFailure::Time),
        Some(_) if words.contains("overflowed its stack") => Err(SandboxFailure::Stack),
        Some(_) if words.contains("memory allocation") => Err(SandboxFailure::Memory),
        Some(status) => {
            let last = words.lines().next().unwrap_or_default();
            Err(SandboxFailure::Stopped(format!("{status} {last}").trim().to_owned()))
        }
    }
}

/// Whether a process used up its time: Linux then sends it one of two signals.
#[cfg(unix)]
fn is_out_of_time(status: ExitStatus) -> bool {
    use std::os::unix::process::ExitStatusExt as _;

    const KILLED: i32 = 9;
    const OUT_OF_TIME: i32 = 24;
    matches!(status.signal(), Some(KILLED | OUT_OF_TIME))
}

#[cfg(not(unix))]
fn is_out_of_time(_: ExitStatus) -> bool {
    false
}

//! `lamplight rehearse`: work that might end its process, done in one that may have little memory
//! and time. This program calls itself so, where input is near a limit; nobody else does.

use std::io::{Read, Write};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use clap::Args;

use super::failure::Failure;
use crate::limits::REHEARSAL_SECONDS;
use crate::rehearse::{Exhausted, run_by};
use crate::scene::{self, Equirect};
use crate::{link, validate};

/// Do a job in a process that may have little memory and time.
#[derive(Args)]
pub struct Arguments {
    /// Whose code it is.
    stage: String,
}

/// Waiting for a processor is no work, but it has an end too.
const LONGEST: Duration = Duration::from_secs(12 * REHEARSAL_SECONDS);
/// Bytes of a process' last words.
const WORDS: u64 = 64 << 10;

/// Rehearsals of this process are done by [`run`] in another.
pub fn install() {
    run_by(in_a_child);
}

/// The other process: the job is on standard input.
pub fn run(arguments: Arguments) -> Result<(), Failure> {
    limited()?;
    let mut job = Vec::new();
    std::io::stdin().lock().read_to_end(&mut job)?;
    match arguments.stage.as_str() {
        validate::STAGE => {
            let job = serde_json::from_slice(&job);
            link::perform(&job.map_err(|error| Failure::usage(error.to_string()))?);
        }
        scene::DECODER => drop(Equirect::from_radiance(&job)),
        other => return Err(Failure::usage(format!("there is no stage `{other}`"))),
    }
    Ok(())
}

/// Takes away what a job might exhaust. Elsewhere than on Linux only its time has an end, and the
/// caller sees to that.
#[cfg(target_os = "linux")]
fn limited() -> Result<(), Failure> {
    use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};

    // Nobody may have more than the user allowed from the start. Of memory it is half of that,
    // since the process that starts this one has threads and files beside what is done here.
    let limits = [
        (Resource::As, crate::limits::REHEARSAL_BYTES, 2),
        (Resource::Cpu, REHEARSAL_SECONDS, 1),
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
fn limited() -> Result<(), Failure> {
    Ok(())
}

/// Where no process can be started, the job is done here without a rehearsal, as a library does.
fn in_a_child(stage: &str, job: &[u8]) -> Result<(), Exhausted> {
    let Ok(program) = std::env::current_exe() else { return Ok(()) };
    let child = Command::new(program)
        .args(["rehearse", stage])
        // A large stack for each thread is address space too.
        .env("RAYON_NUM_THREADS", "1")
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
            // What comes after is read and forgotten, so that the process does not wait.
            if let Some(mut stderr) = stderr {
                let _ = stderr.by_ref().take(WORDS).read_to_end(&mut words);
                let _ = std::io::copy(&mut stderr, &mut std::io::sink());
            }
            String::from_utf8_lossy(&words).into_owned()
        });
        let status = ended(&mut child);
        judged(status, &words.join().unwrap_or_default())
    })
}

/// How a process ended by itself.
fn ended(child: &mut Child) -> Option<ExitStatus> {
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

fn judged(status: Option<ExitStatus>, words: &str) -> Result<(), Exhausted> {
    match status {
        Some(status) if status.success() => Ok(()),
        None => Err(Exhausted::Time),
        Some(status) if is_out_of_time(status) => Err(Exhausted::Time),
        Some(_) if words.contains("overflowed its stack") => Err(Exhausted::Stack),
        Some(_) if words.contains("memory allocation") => Err(Exhausted::Memory),
        Some(status) => {
            let last = words.lines().next().unwrap_or_default();
            Err(Exhausted::Stopped(format!("{status} {last}").trim().to_owned()))
        }
    }
}

/// Linux sends one of two signals to a process that has had its time.
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

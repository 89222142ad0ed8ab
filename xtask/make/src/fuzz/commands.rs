//! Fuzzes commands from outside: what a command does with a file, in a separate process with little
//! memory and time.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::mutate::{self, FuzzRandom};
use xtask::process::{beside_this, root};
use xtask::{CommandFailure, CommandResult};

/// A command that reads a file.
pub struct Surface {
    pub name: &'static str,
    file: &'static str,
    arguments: &'static [&'static str],
    /// Files that must be beside it.
    companions: &'static [(&'static str, &'static str)],
    /// A folder of the repository with valid files, and how their names end.
    corpus: (&'static str, &'static str),
    words: &'static str,
}

const MODULE: &str = "fn one(x: f32) -> f32 { return x; }\n\
    fn four(v: vec4f) -> f32 { return v.x; }\nfn nothing() -> f32 { return 1.0; }\n";

/// Every surface.
pub const SURFACES: &[Surface] = &[
    Surface {
        name: "cases",
        file: "m.toml",
        arguments: &["check", "m.toml"],
        companions: &[("m.wesl", MODULE)],
        corpus: ("tests/regressions/cases", ""),
        words: "[[case]] function inputs values grid log random unit hemisphere grazing same around \
            special count ulps seed formula rows expect oracle laws range rising where near margin \
            mode \"zip\" \"x\" \"v\" { } [ ] = , 0 1 -1 1e30 nan inf 1000 1048576 4294967295",
    },
    Surface {
        name: "picture",
        file: "e.hdr",
        arguments: &[
            "render",
            "hpg_4_spot",
            "--executor",
            "eval",
            "--size",
            "4x4",
            "--environment",
            "e.hdr",
            "--force",
            "-o",
            "out.png",
        ],
        companions: &[],
        corpus: ("tests/regressions/picture", ""),
        words: "#?RADIANCE FORMAT=32-bit_rle_rgbe -Y +X 0 1 8 4294967295 \n EXPOSURE=",
    },
    Surface {
        name: "package",
        file: "wesl.toml",
        arguments: &["compose", "m.wesl"],
        companions: &[("m.wesl", MODULE)],
        corpus: ("tests/regressions/package", ""),
        words: "[package] name root edition [dependencies] path = \"..\" \"/etc\" \".\" \"m\" { }",
    },
];

/// The address space of a command in KiB: 1 GiB, and the stacks that it reserves.
const MEMORY_KIB: u64 = 2 << 20;
/// How many seconds of processor time a command may take. Others may use the machine too, so real
/// time does not count.
const MOST_SECONDS: u64 = 5;
/// A command that has not ended after this real time never will.
const LONGEST: Duration = Duration::from_secs(60);

/// Fuzzes a command for its share of the time; returns the number of findings.
pub fn fuzz(surface: &Surface, seed: u64, seconds: u64) -> Result<usize, CommandFailure> {
    let program = beside_this()?;
    let folder = root().join("target/fuzz/commands").join(surface.name);
    fs::create_dir_all(&folder).map_err(environment)?;
    for (name, text) in surface.companions {
        fs::write(folder.join(name), text).map_err(environment)?;
    }
    let corpus = mutate::corpus_of(&root(), &[surface.corpus]);
    let words: Vec<&str> = surface.words.split(' ').filter(|word| !word.is_empty()).collect();
    let (mut random, started) = (FuzzRandom(seed), Instant::now());
    let (mut inputs, mut findings) = (0u64, 0);
    while started.elapsed().as_secs() < seconds {
        let input = mutate::mutated(&mut random, &corpus, &words);
        fs::write(folder.join(surface.file), &input).map_err(environment)?;
        inputs += 1;
        if let Some(reason) = problem_with(&program, &folder, surface.arguments)? {
            findings += 1;
            keep(surface, &input, &reason)?;
        }
    }
    println!("{}: {inputs} inputs, {findings} findings", surface.name);
    Ok(findings)
}

/// What is wrong with a run.
fn problem_with(
    program: &Path,
    folder: &Path,
    arguments: &[&str],
) -> Result<Option<String>, CommandFailure> {
    let limited = format!("ulimit -v {MEMORY_KIB}; ulimit -t {MOST_SECONDS}; exec \"$@\"");
    let stderr = fs::File::create(folder.join("stderr")).map_err(environment)?;
    let mut child = Command::new("sh")
        .args(["-c", &limited, "sh"])
        .arg(program)
        .args(arguments)
        .current_dir(folder)
        .env("RAYON_NUM_THREADS", "1")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(stderr)
        .spawn()
        .map_err(environment)?;
    let started = Instant::now();
    let status = loop {
        match child.try_wait().map_err(environment)? {
            Some(status) => break status,
            None if started.elapsed() > LONGEST => {
                let _ = child.kill();
                let _ = child.wait();
                return Ok(Some(format!("takes more than {LONGEST:?}")));
            }
            None => std::thread::sleep(Duration::from_millis(2)),
        }
    };
    let stderr = fs::read(folder.join("stderr")).map_err(environment)?;
    let stderr = String::from_utf8_lossy(&stderr);
    let is_bad = stderr.contains("panicked") || stderr.contains("internal error");
    Ok(match status.code() {
        None => Some(format!("aborts ({status})")),
        Some(code) if code > 128 => Some(format!("aborts ({status})")),
        Some(_) if is_bad => Some(format!("panics: {}", stderr.lines().next().unwrap_or_default())),
        Some(_) => None,
    })
}

fn keep(surface: &Surface, input: &[u8], reason: &str) -> CommandResult {
    println!("{}: {reason} ({} bytes)", surface.name, input.len());
    let folder = root().join("target/fuzz/findings").join(surface.name);
    fs::create_dir_all(&folder).map_err(environment)?;
    let name: String =
        reason.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).take(80).collect();
    fs::write(folder.join(name), input).map_err(environment)
}

fn environment(error: std::io::Error) -> CommandFailure {
    CommandFailure::environment(error.to_string())
}

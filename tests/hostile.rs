//! Small inputs that ask for much memory, time or stack. Each gives an error with a place and the
//! exit code of wrong input, in a process whose memory is limited.

mod bundles;
mod cases;
mod concurrent;
mod edits;
mod isolated;
mod linear;
mod manifests;
mod pictures;
mod printed;
mod shaders;
mod starved;
mod stores;

use std::fs;
use std::process::{Command, Output, Stdio};

use libtest_mimic::{Failed, Trial};
use tempfile::TempDir;

pub type Outcome = Result<(), Failed>;

/// The address space that a command may use, in KiB. The large stacks of idle threads count too.
const MEMORY_KIB: u64 = 4 << 20;

pub fn tests() -> Vec<Trial> {
    let tables = [cases::CASES, manifests::CASES, pictures::CASES, shaders::CASES];
    let rows = tables
        .into_iter()
        .flatten()
        .map(|case| Trial::test(format!("hostile::{}", case.name), move || case.check()));
    let others = [
        concurrent::tests(),
        bundles::tests(),
        edits::tests(),
        isolated::tests(),
        linear::tests(),
        printed::tests(),
        starved::tests(),
        stores::tests(),
    ];
    rows.chain(others.into_iter().flatten()).collect()
}

/// Files, a command over them, the exit code, and a part of what the command prints.
pub struct Hostile {
    pub name: &'static str,
    pub files: fn() -> Vec<(&'static str, String)>,
    pub arguments: &'static str,
    pub code: i32,
    pub words: &'static str,
}

impl Hostile {
    fn check(&self) -> Outcome {
        let folder = tempfile::tempdir()?;
        for (name, text) in (self.files)() {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap_or(folder.path()))?;
            fs::write(path, text)?;
        }
        let arguments: Vec<&str> = self.arguments.split(' ').collect();
        fails(&run(&folder, &arguments)?, self.code, self.words)
    }
}

/// Runs the command in a folder, with limited memory.
pub fn run(folder: &TempDir, arguments: &[&str]) -> Result<Output, Failed> {
    run_within(MEMORY_KIB, folder, arguments)
}

/// The same with another limit of the address space, in KiB.
pub fn run_within(kib: u64, folder: &TempDir, arguments: &[&str]) -> Result<Output, Failed> {
    let limited = format!("ulimit -v {kib}; exec \"$@\"");
    Ok(Command::new("sh")
        .args(["-c", &limited, "sh", env!("CARGO_BIN_EXE_lamplight")])
        .args(arguments)
        .current_dir(folder.path())
        .env("RAYON_NUM_THREADS", "2")
        .stdin(Stdio::null())
        .output()?)
}

/// Fails unless the command ended with the code, printed the words on either stream, and neither
/// panicked nor reported an internal error.
#[track_caller]
pub fn fails(output: &Output, code: i32, words: &str) -> Outcome {
    let output_text =
        String::from_utf8_lossy(&output.stderr) + String::from_utf8_lossy(&output.stdout);
    let has_no_panic = !output_text.contains("panicked") && !output_text.contains("internal error");
    if output.status.code() == Some(code) && output_text.contains(words) && has_no_panic {
        return Ok(());
    }
    let start: String = output_text.chars().take(2000).collect();
    let place = std::panic::Location::caller();
    let expected = format!("expected exit code {code} and `{words}`");
    Err(format!("{place}: {expected}, found {:?}: {start}", output.status).into())
}

//! A bundle that `gen` wrote, such as the library's: its size as a single file, packing it, and one
//! shader out of either form.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use lamplight::bundle::{Bundle, Target};

use crate::Outcome;
use crate::scale::peak;

const USAGE: &str = "usage: cargo xtask bench bundle DIR, where DIR is a bundle of `lamplight gen`";

/// Runs each step in a process of its own, so that each has its own peak of memory. `DIR` is the
/// second argument of the process, and the step the third.
pub fn run() -> Outcome {
    let mut arguments = std::env::args().skip(2);
    let directory = arguments.next().ok_or(USAGE)?;
    if let Some(step) = arguments.next() {
        return run_step(&step, Path::new(&directory));
    }
    for step in ["pack", "verify", "directory", "file"] {
        let mut command = Command::new(std::env::current_exe()?);
        if !command.args(["bundle", &directory, step]).status()?.success() {
            return Err(format!("the step `{step}` failed").into());
        }
    }
    Ok(std::fs::remove_file(single_file())?)
}

/// The single file that the steps share.
fn single_file() -> PathBuf {
    std::env::temp_dir().join("lamplight-bench-bundle.lamplight")
}

fn run_step(step: &str, directory: &Path) -> Outcome {
    let file = single_file();
    let start = Instant::now();
    let done = match step {
        "pack" => {
            let bytes = Bundle::open(directory)?.pack()?;
            std::fs::write(&file, &bytes)?;
            format!("{:.2} MB as a single file, packed", bytes.len() as f64 / 1e6)
        }
        "verify" => {
            Bundle::open(&file)?.verify()?;
            "the single file verified".to_owned()
        }
        "directory" => format!("{} from the directory", fetch(directory)?),
        _ => format!("{} from the single file", fetch(&file)?),
    };
    let elapsed = start.elapsed().as_secs_f64() * 1e3;
    println!("bundle: {done} in {elapsed:.1} ms, at most {:.0} MB of memory", peak()? / 1e6);
    Ok(())
}

/// Opens a bundle and reads one shader.
fn fetch(path: &Path) -> Result<String, Box<dyn std::error::Error>> {
    let bundle = Bundle::open(path)?;
    let name = bundle.programs().next().ok_or("the bundle has no programs")?.to_owned();
    let program = bundle.program(&name)?;
    let (language, entry) = program.entries().next().ok_or("the program has no entry points")?;
    let found = program.entry(language, entry)?.get("default", Target::WGSL)?;
    Ok(format!("a shader of {} bytes", found.bytes.len()))
}

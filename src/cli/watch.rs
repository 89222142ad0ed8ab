//! `lamplight watch`: the bundle, kept up to date.

use std::io::Write;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

use clap::Args;

use super::failure::{DiagnosticForm, Failure};
use super::terminal::stdout;
use super::work::{PathArguments, Work};
use crate::generate::summary::counted_words;
use crate::generate::{Look, Request};
use crate::input;
use crate::permute::Quoted;
use crate::source::LIMITS;

/// The time between looks at the files. They are compared by content: no service of the operating
/// system is needed, and it does not matter how editors write.
const PAUSE: Duration = Duration::from_millis(100);

/// Compose, compile and bundle again whenever a file changes, until interrupted.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    places: PathArguments,
    /// The permutation in use, which is compiled and written before the others.
    #[arg(long, value_name = "KEY", requires = "program")]
    key: Option<String>,
    /// The program of that permutation.
    #[arg(long, value_name = "P", requires = "key")]
    program: Option<String>,
}

pub fn run_watch(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    loop {
        match Work::open(&arguments.places) {
            Ok(mut work) => {
                report_outcome(update_bundle(&arguments, &mut work, form), form)?;
                while work.is_current() {
                    sleep(PAUSE);
                }
            }
            Err(failure) => {
                let manifest = arguments.places.manifest();
                let before = file_bytes(&manifest);
                report_outcome(Err(failure), form)?;
                while file_bytes(&manifest) == before {
                    sleep(PAUSE);
                }
            }
        }
    }
}

/// An error in the input is printed, and the command waits for the next change. Any other error
/// ends it.
fn report_outcome(outcome: Result<(), Failure>, form: DiagnosticForm) -> Result<(), Failure> {
    match outcome {
        Err(failure @ Failure::Input(..)) => {
            let _ = failure.report(form);
            Ok(())
        }
        outcome => outcome,
    }
}

fn file_bytes(path: &Path) -> Option<Vec<u8>> {
    input::read_file(path, LIMITS.file_bytes as u64).ok()
}

fn update_bundle(
    arguments: &Arguments,
    work: &mut Work,
    form: DiagnosticForm,
) -> Result<(), Failure> {
    let start = Instant::now();
    let all = Request::default();
    if work.up_to_date(&all, Look::Cheap, form).is_some() {
        return say_line(&format!("up to date, {:.2} s", start.elapsed().as_secs_f64()));
    }
    if let (Some(key), true) = (&arguments.key, work.out.is_dir()) {
        let id = work.sources.add("--key", key.as_str());
        let only = Some(Quoted::whole(&work.sources, id));
        work.patch(&Request { program: arguments.program.clone(), only, ..Request::default() })?;
        say_line(&format!("`{key}` ready, {:.2} s", start.elapsed().as_secs_f64()))?;
    }
    let summary = work.run(&all, false, form)?;
    let compiled = summary.texts().saturating_sub(summary.cached);
    say_line(&format!(
        "{}, {} compiled, {:.2} s",
        counted_words(summary.permutations(), "permutation"),
        counted_words(compiled, "text"),
        start.elapsed().as_secs_f64()
    ))
}

fn say_line(line: &str) -> Result<(), Failure> {
    let mut out = stdout();
    writeln!(out, "{line}")?;
    Ok(out.flush()?)
}

//! `lamplight bundle`: lists, reads, verifies, packs and compares bundles.

use std::io::Write;
use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::compile::parse_target;
use super::failure::Failure;
use super::input::LanguageName;
use super::overwrite::{Overwrite, write_failure};
use super::terminal::{is_terminal, stdout, write_data};
use crate::bundle::{self, Bundle, Error, Shader, Target};
use crate::limits::MANIFEST_BYTES;
use crate::{input, output};

/// List, fetch, verify, pack or compare bundles.
#[derive(Args)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// List programs, entry points and the numbers of their permutations, or the keys of one
    /// program.
    List {
        bundle: PathBuf,
        #[arg(long, value_name = "P")]
        program: Option<String>,
    },
    /// Print or write one shader, or its reflection.
    Get(Get),
    /// Check every byte and every reference.
    Verify { bundle: PathBuf },
    /// Write the single-file form of a bundle.
    Pack {
        bundle: PathBuf,
        #[arg(short, long, value_name = "FILE")]
        out: PathBuf,
        #[command(flatten)]
        overwrite: Overwrite,
    },
    /// List the differences between two bundles; the exit code is 3 if there are any.
    Diff {
        old: PathBuf,
        new: PathBuf,
        #[arg(long)]
        json: bool,
    },
}

#[derive(Args)]
struct Get {
    bundle: PathBuf,
    program: String,
    /// The entry point: `fs_main`.
    entry: String,
    /// `shadow=hard`; `default` for the permutation of all defaults.
    key: String,
    #[arg(long, value_name = "T", value_parser = parse_target)]
    target: Target,
    /// The source language [default: WESL where the bundle has both].
    #[arg(long, value_enum)]
    lang: Option<LanguageName>,
    /// Print the reflection, as JSON.
    #[arg(long)]
    reflection: bool,
    /// The file to write [default: standard output].
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    overwrite: Overwrite,
}

pub fn run_bundle(arguments: Arguments) -> Result<(), Failure> {
    match arguments.command {
        Command::List { bundle, program } => list_keys(&open_bundle(&bundle)?, program.as_deref()),
        Command::Get(get) => fetch_file(&get),
        Command::Verify { bundle } => {
            verify_bundle(&bundle)?;
            Ok(writeln!(stdout(), "`{}` is intact", bundle.display())?)
        }
        Command::Pack { bundle, out, overwrite } => {
            let opened = open_bundle(&bundle)?;
            let wrong = |error| Failure::input(format!("`{}`: {error}", bundle.display()));
            opened.verify().map_err(wrong)?;
            bundle::replace_packed(&opened, &out, overwrite.replace())
                .map_err(|error| write_failure(&out, error))
        }
        Command::Diff { old, new, json } => {
            compare_bundles(&open_bundle(&old)?, &open_bundle(&new)?, json)
        }
    }
}

fn open_bundle(path: &PathBuf) -> Result<Bundle, Failure> {
    Bundle::open(path).map_err(|error| Failure::input(format!("`{}`: {error}", path.display())))
}

/// Checks every byte. If a directory is written at the same time, it is checked again, since old
/// blobs are kept for only one more run.
fn verify_bundle(path: &PathBuf) -> Result<(), Failure> {
    const MOST_LOOKS: u32 = 16;
    let state = || {
        ["index.bin", "manifest.json"]
            .map(|name| input::read_file(&path.join(name), MANIFEST_BYTES).ok())
    };
    for look in 1.. {
        let before = state();
        match open_bundle(path)?.verify() {
            Ok(()) => return Ok(()),
            Err(_) if path.is_dir() && look < MOST_LOOKS && state() != before => {}
            Err(error) => {
                return Err(Failure::check(format!("`{}`: {error}", path.display())));
            }
        }
    }
    Ok(())
}

fn bundle_failure(error: Error) -> Failure {
    Failure::input(error.to_string())
}

fn list_keys(bundle: &Bundle, program: Option<&str>) -> Result<(), Failure> {
    let mut out = std::io::BufWriter::new(stdout());
    if let Some(name) = program {
        let program = bundle.program(name).map_err(bundle_failure)?;
        let Some((language, entry)) = program.entries().next() else { return Ok(()) };
        for key in program
            .entry(language, entry)
            .and_then(|shader| shader.keys())
            .map_err(bundle_failure)?
        {
            writeln!(out, "{key}")?;
        }
        return Ok(out.flush()?);
    }
    for name in bundle.programs() {
        let program = bundle.program(name).map_err(bundle_failure)?;
        for (language, entry) in program.entries() {
            let keys = program
                .entry(language, entry)
                .and_then(|shader| shader.keys())
                .map_err(bundle_failure)?;
            let targets = match keys.first() {
                Some(key) => program
                    .entry(language, entry)
                    .and_then(|shader| shader.targets(key))
                    .map_err(bundle_failure)?,
                None => Vec::new(),
            };
            let language = format!("{language:?}").to_lowercase();
            writeln!(
                out,
                "{name:12} {entry:12} {language}  {:6} {:12}  {}",
                keys.len(),
                if keys.len() == 1 { "permutation" } else { "permutations" },
                targets.join(" ")
            )?;
        }
    }
    Ok(out.flush()?)
}

fn fetch_file(get: &Get) -> Result<(), Failure> {
    let bundle = open_bundle(&get.bundle)?;
    let program = bundle.program(&get.program).map_err(bundle_failure)?;
    let shader: Shader<'_> = match get.lang {
        Some(language) => program.entry(language.into(), &get.entry),
        None => program.shader(&get.entry),
    }
    .map_err(bundle_failure)?;
    let found = shader.get(&get.key, get.target).map_err(bundle_failure)?;
    if get.reflection {
        return Ok(writeln!(
            stdout(),
            "{:#}",
            serde_json::json!({
                "reflection": &*found.reflection,
                "native": &*found.native,
                "constants": found.constants,
            })
        )?);
    }
    match &get.out {
        Some(path) => {
            let replace = get.overwrite.replace();
            Ok(output::write_file(path, &found.bytes, |_| false, replace)?)
        }
        None if get.target == Target::SPIRV && is_terminal() => {
            Err(Failure::usage("SPIR-V is binary: name a file with `-o`"))
        }
        None => Ok(write_data(&found.bytes)?),
    }
}

fn compare_bundles(old: &Bundle, new: &Bundle, json: bool) -> Result<(), Failure> {
    [old, new].into_iter().try_for_each(Bundle::verify).map_err(bundle_failure)?;
    let difference = bundle::diff(
        &old.contents().map_err(bundle_failure)?,
        &new.contents().map_err(bundle_failure)?,
    );
    if json {
        writeln!(stdout(), "{:#}", serde_json::json!(difference))?;
    } else {
        for change in &difference.permutations {
            let language = format!("{:?}", change.language).to_lowercase();
            writeln!(
                stdout(),
                "{} {} {} {language} {} {}",
                change.kind,
                change.program,
                change.entry,
                change.key,
                change.parts.join(",")
            )?;
        }
    }
    if difference.is_empty() { Ok(()) } else { Err(Failure::check("the bundles differ")) }
}

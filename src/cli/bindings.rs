//! `lamplight bindings`: what a bundle's programs bind, as source of an engine's language.

use std::path::{Path, PathBuf};

use clap::Args;

use super::failure::Failure;
use super::input::LanguageName;
use super::overwrite::{Overwrite, compare_file};
use super::terminal::write_data;
use crate::bundle::{self, Bundle};
use crate::keys::bindings::{self, BindingLanguage, LANGUAGES, Request};
use crate::output;

/// Write structures of uniform blocks, numbers of bindings and locations of inputs for C, C++, Rust
/// or TypeScript.
#[derive(Args)]
pub struct Arguments {
    /// The bundle: a folder or a single file.
    bundle: PathBuf,
    /// The language of the bindings.
    #[arg(long, value_name = "c|cpp|rust|ts", value_parser = find_language)]
    lang: &'static BindingLanguage,
    /// Only these programs.
    #[arg(long, value_name = "P")]
    program: Vec<String>,
    /// The source language of the shaders [default: WESL where a program has both].
    #[arg(long, value_name = "LANG")]
    source: Option<LanguageName>,
    /// Add the bundle itself, as an array of bytes.
    #[arg(long)]
    embed: bool,
    /// The file to write [default: standard output].
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Write nothing; the exit code is 3 if the file is not up to date.
    #[arg(long, requires = "out")]
    check: bool,
    #[command(flatten)]
    overwrite: Overwrite,
}

fn find_language(name: &str) -> Result<&'static BindingLanguage, String> {
    let names: Vec<&str> = LANGUAGES.iter().map(|language| language.name).collect();
    bindings::find(name).ok_or_else(|| format!("there are: {}", names.join(", ")))
}

pub fn run_bindings(arguments: &Arguments) -> Result<(), Failure> {
    let path = &arguments.bundle;
    let failed = |error: bundle::Error| Failure::input(format!("`{}`: {error}", path.display()));
    let opened = Bundle::open(path).map_err(failed)?;
    let bytes = match arguments.embed {
        true => Some(opened.pack().map_err(failed)?),
        false => None,
    };
    let name = embedded_name(path);
    let request = Request {
        programs: &arguments.program,
        source: arguments.source.map(Into::into),
        embedded: bytes.as_deref().map(|bytes| (name.as_str(), bytes)),
    };
    let text = bindings::write(&opened, &request, arguments.lang).map_err(failed)?;
    match &arguments.out {
        Some(out) if arguments.check => compare_file(out, &text),
        Some(out) => {
            let replace = arguments.overwrite.replace();
            Ok(output::write_file(out, text.as_bytes(), bindings::is_written, replace)?)
        }
        None => Ok(write_data(text.as_bytes())?),
    }
}

/// `post_bundle` for `out/post.lamplight`.
fn embedded_name(path: &Path) -> String {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    match stem.as_deref() {
        None | Some("bundle") => "lamplight_bundle".to_owned(),
        Some(stem) => format!("{stem}_bundle"),
    }
}

//! `lamplight compose FILE`: the composed text.

use std::path::PathBuf;

use clap::Args;

use super::failure::{DiagnosticForm, Failure};
use super::input::InputArguments;
use super::terminal::write_data;
use crate::source::SourceSet;

/// Print a root module and everything that it uses as one text.
#[derive(Args)]
pub struct Arguments {
    /// Path to the root module; `-` is standard input.
    file: PathBuf,
    #[command(flatten)]
    input: InputArguments,
}

pub fn run_compose(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    let ready = arguments.input.compose(&arguments.file, SourceSet::default(), form)?;
    Ok(write_data(ready.composed.text.as_bytes())?)
}

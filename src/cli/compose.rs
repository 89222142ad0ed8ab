//! `lamplight compose FILE`: the composed text.

use clap::Args;

use super::failure::{DiagnosticForm, Failure};
use super::input::Input;
use super::terminal::data;

/// Print a root module with all it reaches as one text.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    input: Input,
}

pub fn run(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    let ready = arguments.input.compose(form)?;
    Ok(data(ready.composed.text.as_bytes())?)
}

//! `lamplight explain CODE`: a diagnostic explained.

use std::io::Write;

use clap::Args;

use super::failure::Failure;
use super::terminal::stdout;
use crate::diagnostic::{codes, guide, nearest_name};

/// Explain the code of a diagnostic, or list all codes.
#[derive(Args)]
pub struct Arguments {
    /// The code, as printed in brackets: `unknown-axis`.
    code: Option<String>,
}

pub fn run_explain(arguments: Arguments) -> Result<(), Failure> {
    match arguments.code {
        Some(name) => explain_code(&name),
        None => list_codes(),
    }
}

fn explain_code(name: &str) -> Result<(), Failure> {
    let Some(code) = codes::find(name) else {
        let hint = nearest_name(name, codes::ALL.iter().map(|code| code.name))
            .map_or(String::new(), |near| format!("; did you mean `{near}`?"));
        return Err(Failure::input(format!("no diagnostic has the code `{name}`{hint}")));
    };
    writeln!(stdout(), "{}: {}\n\n{}", code.name, code.title, code.explanation)?;
    match guide::page_of(code) {
        Some(page) => Ok(writeln!(stdout(), "\nGuide: {}", page.title)?),
        None => Ok(()),
    }
}

fn list_codes() -> Result<(), Failure> {
    let width = codes::ALL.iter().map(|code| code.name.len()).max().unwrap_or(0);
    for code in codes::ALL {
        writeln!(stdout(), "{:width$}  {}", code.name, code.title)?;
    }
    Ok(())
}

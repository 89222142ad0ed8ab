//! What all of the maintainer's commands share: exit codes, the start of other programs, and what the
//! machine must have.

#![allow(clippy::print_stdout, clippy::print_stderr)]

pub mod machine;
pub mod process;

use std::process::ExitCode;

/// A command: its name, one line of help, and what it does with its arguments.
pub type XtaskCommand = (&'static str, &'static str, fn(&[String]) -> CommandResult);

/// Exit code 0, or another with its reason on standard error.
pub type CommandResult = Result<(), CommandFailure>;

/// Why a command failed, with the documented exit code.
pub struct CommandFailure {
    code: u8,
    message: String,
}

impl CommandFailure {
    /// The input is wrong (1).
    pub fn input(message: impl Into<String>) -> Self {
        Self { code: 1, message: message.into() }
    }

    /// Wrong usage (2).
    pub fn usage(message: impl Into<String>) -> Self {
        Self { code: 2, message: message.into() }
    }

    /// A check or a comparison failed (3).
    pub fn check(message: impl Into<String>) -> Self {
        Self { code: 3, message: message.into() }
    }

    /// The environment lacks something (4).
    pub fn environment(message: impl Into<String>) -> Self {
        Self { code: 4, message: message.into() }
    }

    /// Another program failed with this exit code, and has printed the reason.
    pub fn printed(code: u8) -> Self {
        Self { code, message: String::new() }
    }
}

/// Runs the command that the first argument of the process names.
pub fn run(commands: &[XtaskCommand]) -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let command =
        arguments.first().and_then(|name| commands.iter().find(|(known, ..)| known == name));
    let outcome = match command {
        Some((.., run)) => run(&arguments[1..]),
        None => Err(CommandFailure::usage(usage(commands))),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(CommandFailure { code, message }) => {
            if !message.is_empty() {
                eprintln!("{message}");
            }
            ExitCode::from(code)
        }
    }
}

fn usage(commands: &[XtaskCommand]) -> String {
    let mut text = String::from("usage: cargo xtask COMMAND\n");
    for (name, about, _) in commands {
        text.push_str(&format!("\n  {name:10} {about}"));
    }
    text
}

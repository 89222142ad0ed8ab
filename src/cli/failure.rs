//! How a command fails, and how that is reported.

use std::io::{self, Write};
use std::process::ExitCode;

use clap::ValueEnum;

use super::guide;
use crate::cli::terminal::{colored_stderr, is_person, stderr};
use crate::diagnostic::render::{Form, render};
use crate::diagnostic::{Diagnostic, Diagnostics, codes, escape_controls};
use crate::source::SourceSet;

/// Why a command did not succeed.
pub enum Failure {
    /// The input is wrong: exit code 1. Each diagnostic points into the input's text.
    Input(SourceSet, Diagnostics),
    /// A check failed: exit code 3. Each diagnostic points to the numeric case that failed.
    Check(SourceSet, Diagnostics),
    /// A sentence, with its exit code.
    Message(u8, String),
}

impl Failure {
    /// The input is wrong, but there is no place in a text to point to.
    pub fn input(message: impl Into<String>) -> Self {
        Self::Message(1, message.into())
    }

    /// Wrong usage.
    pub fn usage(message: impl Into<String>) -> Self {
        Self::Message(2, message.into())
    }

    /// A check or a comparison failed.
    pub fn check(message: impl Into<String>) -> Self {
        Self::Message(3, message.into())
    }

    /// The environment lacks something.
    pub fn environment(message: impl Into<String>) -> Self {
        Self::Message(4, message.into())
    }

    /// Prints on standard error what went wrong, and returns the exit code.
    pub fn report(self, form: DiagnosticForm) -> ExitCode {
        match self {
            // If a bundle cannot be written, this is not the author's mistake but a problem of the
            // machine.
            Self::Input(sources, diagnostics)
                if diagnostics.iter().any(|error| error.code == codes::BUNDLE_FAILED) =>
            {
                print_warnings(&sources, &diagnostics, form);
                let _ = writeln!(stderr(), "error: cannot write the bundle");
                ExitCode::from(4)
            }
            // So is a program that is missing.
            Self::Input(sources, diagnostics)
                if diagnostics.iter().any(|error| error.code == codes::OPTIMISER_FAILED) =>
            {
                print_warnings(&sources, &diagnostics, form);
                ExitCode::from(4)
            }
            Self::Input(sources, diagnostics) => {
                explain_diagnostics(&sources, &diagnostics, form);
                ExitCode::from(1)
            }
            Self::Check(sources, diagnostics) => {
                explain_diagnostics(&sources, &diagnostics, form);
                ExitCode::from(3)
            }
            Self::Message(code, message) => {
                let _ = match form {
                    DiagnosticForm::Json => writeln!(stderr(), "{}", message_as_json(&message)),
                    DiagnosticForm::Human | DiagnosticForm::Short => {
                        writeln!(stderr(), "error: {message}")
                    }
                    DiagnosticForm::Colored => {
                        let message = escape_controls(&message);
                        writeln!(colored_stderr(), "\x1b[1;31merror\x1b[0m: {message}")
                    }
                };
                ExitCode::from(code)
            }
        }
    }
}

/// Prints diagnostics, and for people where to read on.
fn explain_diagnostics(sources: &SourceSet, diagnostics: &[Diagnostic], form: DiagnosticForm) {
    print_warnings(sources, diagnostics, form);
    let reading = guide::after_errors(diagnostics);
    if let (Some(reading), DiagnosticForm::Human | DiagnosticForm::Colored) = (reading, form) {
        let _ = stderr().write_all(reading.as_bytes());
    }
}

/// An error without code and place, in the form of one that has both.
fn message_as_json(message: &str) -> serde_json::Value {
    serde_json::json!({ "severity": "error", "code": null, "message": message, "labels": [], "notes": [] })
}

/// A pipe that its reader closed ends the command without an error. Any other failure is reported.
impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => std::process::exit(0),
            _ => Self::environment(error.to_string()),
        }
    }
}

/// Prints diagnostics, whether or not they stop the command.
pub fn print_warnings(sources: &SourceSet, diagnostics: &[Diagnostic], form: DiagnosticForm) {
    let text = render(sources, diagnostics, form.into());
    let _ = match form {
        // Control characters were removed from quoted text before.
        DiagnosticForm::Colored => colored_stderr().write_all(text.as_bytes()),
        _ => stderr().write_all(text.as_bytes()),
    };
}

/// [`Form`] as an option's value.
#[derive(Clone, Copy, Default, ValueEnum)]
pub enum DiagnosticForm {
    /// With excerpts of the text.
    #[default]
    Human,
    /// The same in colours: what [`ColorChoice`] makes of it.
    #[value(skip)]
    Colored,
    /// One line each.
    Short,
    /// One JSON object a line.
    Json,
}

impl From<DiagnosticForm> for Form {
    fn from(form: DiagnosticForm) -> Self {
        match form {
            DiagnosticForm::Human => Self::Human,
            DiagnosticForm::Colored => Self::Colored,
            DiagnosticForm::Short => Self::Short,
            DiagnosticForm::Json => Self::Json,
        }
    }
}

/// When to write colours.
#[derive(Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum ColorChoice {
    /// On a terminal, unless `NO_COLOR` is set.
    #[default]
    Auto,
    Always,
    Never,
}

impl ColorChoice {
    /// The form in colours, where they are wanted.
    pub fn of(self, form: DiagnosticForm) -> DiagnosticForm {
        match (form, self.is_wanted()) {
            (DiagnosticForm::Human, true) => DiagnosticForm::Colored,
            (form, _) => form,
        }
    }

    fn is_wanted(self) -> bool {
        let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
        let is_dumb = std::env::var_os("TERM").is_some_and(|value| value == "dumb");
        match self {
            Self::Always => true,
            Self::Never => false,
            Self::Auto => is_person() && !is_set("NO_COLOR") && !is_dumb,
        }
    }
}

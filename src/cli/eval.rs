//! `lamplight eval EXPR`: values of expressions over the library's functions.

use std::io::{BufRead, Write, stdin};
use std::sync::Mutex;

use clap::Args;

use super::executor;
use super::failure::{DiagnosticForm, Failure, print_warnings};
use super::input::LanguageName;
use super::own::OwnPackage;
use crate::check::expression::evaluate_expression;
use crate::check::library::Library;
use crate::cli::terminal::stdout;
use crate::diagnostic::stopped_message;
use crate::execute::{Session, on_thread};
use crate::source::SourceSet;

/// Evaluate WGSL expressions that call functions of the library and of your own package.
#[derive(Args)]
pub struct Arguments {
    /// The language whose modules are called.
    #[arg(long, value_enum, default_value = "wesl")]
    lang: LanguageName,
    /// The executor that runs it; `lamplight list executors` lists all.
    #[arg(long, value_name = "E", default_value = "eval")]
    pub executor: String,
    #[command(flatten)]
    own: OwnPackage,
    /// Expressions [default: one a line from standard input].
    #[arg(value_name = "EXPR", allow_hyphen_values = true)]
    expressions: Vec<String>,
}

pub fn run_eval(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    on_thread(|| evaluate_all(&arguments, form))
        .unwrap_or_else(|| Err(Failure::environment(stopped_message("the evaluation"))))
}

fn evaluate_all(arguments: &Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    let mut session = executor::open_executor(executor::find_executor(&arguments.executor)?)?;
    let library = arguments.own.library()?;
    let (mut failed, mut all) = (0_usize, 0_usize);
    let mut one = |text: &str, session: &mut dyn Session| -> Result<(), Failure> {
        all += 1;
        failed += usize::from(!print_value(&library, text, arguments.lang, session, form)?);
        Ok(())
    };
    if arguments.expressions.is_empty() {
        for line in stdin().lock().lines() {
            let line = line?;
            if !line.trim().is_empty() {
                one(&line, session.as_mut())?;
            }
        }
    }
    for expression in &arguments.expressions {
        one(expression, session.as_mut())?;
    }
    match (failed, all) {
        (0, _) => Ok(()),
        // Its diagnostics, which are printed, say everything.
        (_, 1) => Err(Failure::Input(SourceSet::default(), Vec::new())),
        _ => Err(Failure::input(format!("{failed} of {all} expressions failed"))),
    }
}

/// Prints one line for each expression. An expression without a value gives an empty line, and
/// diagnostics.
fn print_value(
    library: &Library,
    text: &str,
    language: LanguageName,
    session: &mut dyn Session,
    form: DiagnosticForm,
) -> Result<bool, Failure> {
    let sources = Mutex::new(SourceSet::default());
    match evaluate_expression(library, &sources, text.trim(), language.into(), session) {
        Ok(value) => {
            writeln!(stdout(), "{value}")?;
            Ok(true)
        }
        Err(diagnostics) => {
            writeln!(stdout())?;
            print_warnings(&sources.into_inner().unwrap_or_default(), &diagnostics, form);
            Ok(false)
        }
    }
}

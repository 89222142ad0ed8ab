//! `lamplight eval EXPR`: values of expressions over the library's functions.

use std::ffi::OsString;
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

/// The options of `eval` that take a value.
const VALUED: [&str; 5] = ["--lang", "--executor", "--root", "--diagnostics", "--color"];

/// The arguments with those options first that follow an expression. Expressions may begin with a
/// minus, so nothing after the first one would be read as an option. None begins with two: WGSL has no
/// such operator, and what follows `--` stays where it is.
pub fn options_first(arguments: Vec<OsString>) -> Vec<OsString> {
    if arguments.get(1).is_none_or(|command| command != "eval") {
        return arguments;
    }
    let (mut options, mut rest) = (Vec::new(), Vec::new());
    let mut left = arguments.into_iter();
    let head: Vec<OsString> = left.by_ref().take(2).collect();
    while let Some(argument) = left.next() {
        let text = argument.to_string_lossy().into_owned();
        if text == "--" {
            rest.push(argument);
            break;
        }
        if !text.starts_with("--") {
            rest.push(argument);
            continue;
        }
        options.push(argument);
        options.extend(VALUED.contains(&text.as_str()).then(|| left.next()).flatten());
    }
    head.into_iter().chain(options).chain(rest).chain(left).collect()
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use clap::CommandFactory;

    use super::{VALUED, options_first};
    use crate::cli::Cli;

    /// The value of an option that is missing in the list would be read as an expression.
    #[test]
    fn options_with_values() {
        let mut command = Cli::command();
        command.build();
        let eval = command.find_subcommand("eval").into_iter();
        let valued = eval
            .flat_map(|eval| eval.get_arguments())
            .filter(|argument| argument.get_action().takes_values())
            .filter_map(|argument| argument.get_long().map(|name| format!("--{name}")));
        assert_eq!(valued.collect::<BTreeSet<_>>(), VALUED.map(str::to_owned).into());
    }

    #[test]
    fn options_after_expressions() {
        let ordered = |line: &str| {
            let all = options_first(line.split(' ').map(Into::into).collect());
            all.iter().map(|one| one.to_string_lossy().into_owned()).collect::<Vec<_>>().join(" ")
        };
        for (line, expected) in [
            ("lamplight eval 1+1 --executor vulkan", "lamplight eval --executor vulkan 1+1"),
            ("lamplight eval -1 --lang=glsl -2", "lamplight eval --lang=glsl -1 -2"),
            ("lamplight eval --help", "lamplight eval --help"),
            ("lamplight eval -- --1 --lang glsl", "lamplight eval -- --1 --lang glsl"),
            ("lamplight list scenes --json", "lamplight list scenes --json"),
        ] {
            assert_eq!(ordered(line), expected);
        }
    }
}

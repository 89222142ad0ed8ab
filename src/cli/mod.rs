//! The command line: reads what was asked, calls the stages, prints what they return.
//!
//! One file a command. Exit codes: 0 fine, 1 the input is wrong, 2 wrong usage, 3 a check or a
//! comparison failed, 4 the environment lacks something.

mod bundle;
mod catalogue;
mod check;
mod compile;
mod compose;
mod cost;
mod eval;
mod executor;
mod explain;
mod export;
mod failure;
mod features;
mod generate;
mod guide;
mod input;
mod keys;
mod list;
mod merge;
mod mutate;
mod overwrite;
mod partial;
mod progress;
mod render;
mod show;
mod stream;
mod terminal;
mod text;
mod variants;
mod watch;
mod work;

use std::io::Write;
use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::execute::executors;
use failure::Failure;

/// Lighting and shadow functions in WGSL and GLSL: composed, compiled, bundled, proven.
#[derive(Parser)]
#[command(name = "lamplight", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// How diagnostics are printed on standard error.
    #[arg(long, global = true, value_enum, default_value_t)]
    diagnostics: failure::DiagnosticForm,
}

#[derive(Subcommand)]
enum Command {
    List(list::Arguments),
    Show(show::Arguments),
    Compose(compose::Arguments),
    Compile(compile::Arguments),
    Gen(generate::Arguments),
    Merge(merge::Arguments),
    Variants(variants::Arguments),
    Watch(watch::Arguments),
    Bundle(bundle::Arguments),
    Keys(keys::Arguments),
    Eval(eval::Arguments),
    Check(check::Arguments),
    Catalogue(catalogue::Arguments),
    Render(render::Arguments),
    Cost(cost::Arguments),
    #[command(hide = true)]
    Mutate(mutate::Arguments),
    Export(export::Arguments),
    Explain(explain::Arguments),
}

impl Command {
    /// The executors that it asks for.
    fn executors(&self) -> Vec<&'static executors::Entry> {
        let names = match self {
            Self::Check(arguments) => arguments.executor.as_slice(),
            Self::Eval(arguments) => std::slice::from_ref(&arguments.executor),
            Self::Render(arguments) => std::slice::from_ref(&arguments.executor),
            _ => &[],
        };
        names.iter().filter_map(|name| executors::find(name)).collect()
    }

    /// The GPUs that it asks for, opened while there is one thread.
    fn gpus(&self) -> cost::Opened {
        match self {
            Self::Cost(arguments) => arguments.gpus.open(),
            Self::Variants(arguments) if arguments.cost => arguments.gpus.open(),
            _ => Ok(Vec::new()),
        }
    }
}

/// Runs the command line of this process.
pub fn main() -> ExitCode {
    let matches = guide::in_help(Cli::command()).try_get_matches().unwrap_or_else(wrong_usage);
    let cli = Cli::from_arg_matches(&matches).unwrap_or_else(wrong_usage);
    // While there is one thread.
    executors::prepare(&cli.command.executors());
    let gpus = cli.command.gpus();
    match dispatch(cli.command, gpus, cli.diagnostics) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(cli.diagnostics),
    }
}

/// Says what is wrong with the arguments, which are quoted and may hold anything; help as it is.
fn wrong_usage<T>(error: clap::Error) -> T {
    if !error.use_stderr() {
        error.exit();
    }
    let _ = write!(terminal::stderr(), "{}", error.render());
    std::process::exit(error.exit_code())
}

fn dispatch(
    command: Command,
    gpus: cost::Opened,
    form: failure::DiagnosticForm,
) -> Result<(), Failure> {
    match command {
        Command::List(arguments) => list::run(arguments),
        Command::Show(arguments) => show::run(arguments),
        Command::Compose(arguments) => compose::run(arguments, form),
        Command::Compile(arguments) => compile::run(arguments, form),
        Command::Gen(arguments) => generate::run(arguments, form),
        Command::Merge(arguments) => merge::run(arguments),
        Command::Variants(arguments) => variants::run(arguments, gpus, form),
        Command::Watch(arguments) => watch::run(arguments, form),
        Command::Bundle(arguments) => bundle::run(arguments),
        Command::Keys(arguments) => keys::run(arguments, form),
        Command::Eval(arguments) => eval::run(arguments, form),
        Command::Check(arguments) => check::run(arguments),
        Command::Catalogue(arguments) => catalogue::run(arguments),
        Command::Render(arguments) => render::run(arguments, form),
        Command::Cost(arguments) => cost::run(arguments, gpus),
        Command::Mutate(arguments) => mutate::run(arguments),
        Command::Export(arguments) => export::run(arguments),
        Command::Explain(arguments) => explain::run(arguments),
    }
}

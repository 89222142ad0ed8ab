//! The command line: reads what was asked, calls the stages, prints what they return.
//!
//! One file a command. Exit codes: 0 fine, 1 the input is wrong, 2 wrong usage, 3 a check or a
//! comparison failed, 4 the environment lacks something.

mod bindings;
mod bundle;
mod cached;
mod catalogue;
mod check;
mod compile;
mod completions;
mod compose;
mod cost;
mod dap;
mod debug;
mod eval;
mod executor;
mod explain;
mod export;
mod failure;
mod features;
mod fmt;
mod generate;
mod guide;
mod includes;
mod init;
mod input;
mod keys;
mod lint;
mod list;
mod lsp;
mod merge;
mod migrate;
mod mutate;
mod overwrite;
mod own;
mod partial;
mod probe;
mod progress;
mod render;
mod sandbox;
mod show;
mod stream;
mod terminal;
mod text;
mod translate;
mod validated;
mod values;
mod variants;
mod watch;
mod work;

use std::io::Write;
use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::execute::executors;
use failure::Failure;

/// Compose, compile, bundle and check shaders in WGSL and GLSL, with a library of lighting
/// functions.
#[derive(Parser)]
#[command(name = "lamplight", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// How diagnostics are printed on standard error.
    #[arg(long, global = true, value_enum, default_value_t)]
    diagnostics: failure::DiagnosticForm,
    /// When to print colours.
    #[arg(long, global = true, value_enum, default_value_t)]
    color: failure::ColorChoice,
}

#[derive(Subcommand)]
enum Command {
    Init(init::Arguments),
    List(list::Arguments),
    Show(show::Arguments),
    Compose(compose::Arguments),
    Compile(compile::Arguments),
    Translate(translate::Arguments),
    Lint(lint::Arguments),
    Fmt(fmt::Arguments),
    Migrate(migrate::Arguments),
    Gen(generate::Arguments),
    Merge(merge::Arguments),
    Variants(variants::Arguments),
    Watch(watch::Arguments),
    Bundle(bundle::Arguments),
    Keys(keys::Arguments),
    Bindings(bindings::Arguments),
    Eval(eval::Arguments),
    Dap(dap::Arguments),
    Debug(debug::Arguments),
    Check(check::Arguments),
    Catalogue(catalogue::Arguments),
    Render(render::Arguments),
    Probe(probe::Arguments),
    Cost(cost::Arguments),
    #[command(hide = true)]
    Mutate(mutate::Arguments),
    #[command(hide = true)]
    Sandbox(sandbox::Arguments),
    Export(export::Arguments),
    Explain(explain::Arguments),
    Lsp(lsp::Arguments),
    Completions(completions::Completions),
    Man(completions::Manual),
}

impl Command {
    /// The executors that the command names.
    fn executors(&self) -> Vec<&'static executors::ExecutorEntry> {
        let names: Vec<&str> = match self {
            Self::Check(arguments) => arguments.executor.iter().map(String::as_str).collect(),
            Self::Eval(arguments) => vec![&arguments.executor],
            // A shader of one's own is drawn there if there is a driver.
            Self::Render(arguments) => {
                vec![arguments.executor.as_deref().unwrap_or(render::EXECUTOR)]
            }
            _ => Vec::new(),
        };
        names.into_iter().filter_map(executors::find_executor).collect()
    }

    /// The GPUs that the command names. They are opened here, before other threads have work.
    fn gpus(&self) -> cost::OpenedGpus {
        match self {
            Self::Cost(arguments) => arguments.open_gpus(),
            Self::Variants(arguments) if arguments.cost => arguments.gpus.open(),
            Self::Catalogue(arguments) if arguments.costs.is_some() => {
                cost::Gpus::of_each_generation()
            }
            _ => Ok(Vec::new()),
        }
    }
}

/// The command line with examples and pages in its help.
fn described_command() -> clap::Command {
    guide::in_help(debug::without_files(Cli::command())).color(color_choice())
}

/// What `--color` says, read before the other options: help and wrong usage are printed before
/// those are read.
fn color_choice() -> clap::ColorChoice {
    // Arguments need not be UTF-8, and those that matter here are.
    let arguments = std::env::args_os().skip(1);
    let arguments: Vec<String> =
        arguments.map(|argument| argument.to_string_lossy().into_owned()).collect();
    let value = |index: usize| match arguments[index].strip_prefix("--color") {
        Some("") => arguments.get(index + 1).map(String::as_str),
        Some(rest) => rest.strip_prefix('='),
        None => None,
    };
    match (0..arguments.len()).find_map(value) {
        Some("always") => clap::ColorChoice::Always,
        Some("never") => clap::ColorChoice::Never,
        _ => clap::ColorChoice::Auto,
    }
}

/// The stack of the command line in bytes. That of the main thread is what the user's shell allows,
/// which may be too little to read the arguments.
const STACK: usize = 8 << 20;

/// Runs the command line of this process.
pub fn main() -> ExitCode {
    let worker = std::thread::Builder::new().stack_size(STACK).spawn(run_arguments);
    match worker.map(std::thread::JoinHandle::join) {
        Ok(Ok(code)) => code,
        Ok(Err(panic)) => std::panic::resume_unwind(panic),
        Err(error) => {
            let reason = format!("no memory for a stack of {} MiB: {error}", STACK >> 20);
            Failure::environment(reason).report(failure::DiagnosticForm::default())
        }
    }
}

/// Starts the threads that share work. Where the system has no memory for their stacks, this thread
/// does all the work: rayon would panic at its first use.
fn start_threads() {
    if rayon::ThreadPoolBuilder::new().build_global().is_err() {
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread();
        // An error says that the pool is there already.
        drop(alone.build_global());
    }
}

fn run_arguments() -> ExitCode {
    let arguments = eval::options_first(std::env::args_os().collect());
    let matches = described_command().try_get_matches_from(arguments);
    let cli = match matches.and_then(|matches| Cli::from_arg_matches(&matches)) {
        Ok(cli) => cli,
        Err(error) => return print_usage(&error),
    };
    // Done before other threads have work: the main thread only waits for this one.
    executors::prepare_process(&cli.command.executors());
    start_threads();
    let gpus = cli.command.gpus();
    let form = cli.color.of(cli.diagnostics);
    if !matches!(cli.command, Command::Sandbox(_)) {
        sandbox::install_sandbox();
    }
    match dispatch_command(cli.command, gpus, form) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(form),
    }
}

/// Prints help, or what is wrong with the arguments. They are quoted and may contain anything, so
/// they are escaped; help is not.
fn print_usage(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        return match error.print().and_then(|()| terminal::flush_stdout()) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => Failure::from(error).report(failure::DiagnosticForm::default()),
        };
    }
    let in_color = match color_choice() {
        clap::ColorChoice::Always => true,
        clap::ColorChoice::Never => false,
        clap::ColorChoice::Auto => {
            terminal::is_person() && std::env::var_os("NO_COLOR").is_none_or(|set| set.is_empty())
        }
    };
    let text = error.render();
    let _ = match in_color {
        true => write!(terminal::colored_stderr(), "{}", text.ansi()),
        false => write!(terminal::stderr(), "{text}"),
    };
    ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2))
}

fn dispatch_command(
    command: Command,
    gpus: cost::OpenedGpus,
    form: failure::DiagnosticForm,
) -> Result<(), Failure> {
    match command {
        Command::Init(arguments) => init::run_init(arguments),
        Command::List(arguments) => list::run_list(arguments),
        Command::Show(arguments) => show::run_show(arguments),
        Command::Compose(arguments) => compose::run_compose(arguments, form),
        Command::Compile(arguments) => compile::run_compile(arguments, form),
        Command::Translate(arguments) => translate::run_translate(arguments, form),
        Command::Lint(arguments) => lint::run_lint(arguments, form),
        Command::Fmt(arguments) => fmt::run_fmt(arguments, form),
        Command::Migrate(arguments) => migrate::run_migrate(arguments, form),
        Command::Gen(arguments) => generate::run_generate(arguments, form),
        Command::Merge(arguments) => merge::run_merge(arguments),
        Command::Variants(arguments) => variants::run_variants(arguments, gpus, form),
        Command::Watch(arguments) => watch::run_watch(arguments, form),
        Command::Bundle(arguments) => bundle::run_bundle(arguments),
        Command::Keys(arguments) => keys::run_keys(arguments, form),
        Command::Bindings(arguments) => bindings::run_bindings(&arguments),
        Command::Dap(arguments) => dap::run_dap(arguments, form),
        Command::Debug(arguments) => debug::run_debug(arguments, form),
        Command::Eval(arguments) => eval::run_eval(arguments, form),
        Command::Check(arguments) => check::run_check(arguments),
        Command::Catalogue(arguments) => catalogue::run_catalogue(arguments, gpus),
        Command::Render(arguments) => render::run_render(arguments, form),
        Command::Probe(arguments) => probe::run_probe(arguments),
        Command::Cost(arguments) => cost::run_cost(arguments, gpus, form),
        Command::Mutate(arguments) => mutate::run_mutate(arguments),
        Command::Sandbox(arguments) => sandbox::run_in_sandbox(arguments),
        Command::Export(arguments) => export::run_export(arguments),
        Command::Explain(arguments) => explain::run_explain(arguments),
        Command::Lsp(arguments) => lsp::run_lsp(arguments),
        Command::Completions(arguments) => {
            completions::write_completions(&arguments, described_command())
        }
        Command::Man(arguments) => completions::write_manual(&arguments, described_command()),
    }
}

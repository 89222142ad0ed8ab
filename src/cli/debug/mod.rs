//! `lamplight debug`: a fragment, or a call of a function, line by line.

mod call;
mod pixel;
mod report;
mod why;

use clap::Args;
use lamplight_debug::{Subject, SubjectText};

use super::failure::{DiagnosticForm, Failure};
use super::render;
use crate::diagnostic::stopped_message;
use crate::execute::on_thread;

/// Run one fragment of a picture, or a call of a function, line by line of your file.
///
/// Each line shows what it gave a name, in f32, in f64, and the bound of the error that WGSL allows.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    render: render::Arguments,
    /// The pixel: its column and its row, from the upper left.
    #[arg(long, value_name = "X,Y", value_parser = parse_pixel, help_heading = "What is shown")]
    pixel: Option<[u32; 2]>,
    /// List what made a value instead: `color.r` of what the stage returns, or the last value of a
    /// variable, such as `sum` or `lamp.position.x`.
    #[arg(long, value_name = "NAME", help_heading = "What is shown")]
    why: Option<String>,
    /// How many turns of each loop are shown.
    #[arg(long, value_name = "N", default_value_t = 2, help_heading = "What is shown")]
    turns: u64,
    /// The share of a value that its error may have before its digits count as lost, in percent.
    #[arg(long, value_name = "PERCENT", default_value_t = 1.0, value_parser = parse_percent,
        help_heading = "What is shown")]
    lost: f64,
}

fn parse_pixel(text: &str) -> Result<[u32; 2], String> {
    let numbers = text
        .split_once(',')
        .and_then(|(x, y)| Some([x.trim().parse::<u32>().ok()?, y.trim().parse::<u32>().ok()?]));
    numbers.ok_or_else(|| "expected X,Y, such as 256,256".to_owned())
}

fn parse_percent(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite() && *number >= 0.0);
    number.ok_or_else(|| "expected a number of percent".to_owned())
}

/// The options of `render` that are about files of pictures.
const ABOUT_FILES: [&str; 10] = [
    "all",
    "comparisons",
    "beside",
    "show",
    "output",
    "samples",
    "force",
    "watch",
    "terminal",
    "exposure",
];

/// The command line, in whose help `debug` has no options about files of pictures.
pub fn without_files(command: clap::Command) -> clap::Command {
    command.mut_subcommand("debug", hide_files)
}

fn hide_files(debug: clap::Command) -> clap::Command {
    debug.mut_args(|argument| {
        let is_hidden = ABOUT_FILES.contains(&argument.get_id().as_str());
        argument.hide(is_hidden)
    })
}

/// The options by themselves, as a debug adapter reads them.
pub fn launch_command() -> clap::Command {
    hide_files(Arguments::augment_args(clap::Command::new("launch")))
}

pub fn run_debug(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    on_thread(|| debug(&arguments, form))
        .unwrap_or_else(|| Err(Failure::environment(stopped_message("the debugger"))))
}

/// Refuses the options that are about files of pictures.
fn refuse_files(arguments: &Arguments) -> Result<(), Failure> {
    match arguments.render.option_about_files() {
        Some(option) => {
            Err(Failure::usage(format!("`{option}` is for pictures: `lamplight render`")))
        }
        None => Ok(()),
    }
}

fn debug(arguments: &Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    with_subject(arguments, form, &mut |text, subject| {
        report::report_run(arguments, text, &subject)
    })
}

/// What is done with a fragment or a call that is ready to run.
pub type Ready<'a> = &'a mut dyn FnMut(SubjectText<'_>, Subject) -> Result<(), Failure>;

/// Calls `then` with what the arguments name.
pub fn with_subject(
    arguments: &Arguments,
    form: DiagnosticForm,
    then: Ready<'_>,
) -> Result<(), Failure> {
    refuse_files(arguments)?;
    let subject = arguments.render.subject().unwrap_or_default();
    if subject.contains('(') && !std::path::Path::new(subject).is_file() {
        return call::with_call(arguments, subject, then);
    }
    let Some(at) = arguments.pixel else {
        return Err(Failure::usage(
            "`--pixel X,Y` says which pixel; a call such as `lighting::spot::cone_hard(0.9, 0.8)` \
             needs none",
        ));
    };
    pixel::with_pixel(arguments, at, form, then)
}

impl Arguments {
    /// What is run, in words.
    pub fn title(&self) -> String {
        match self.pixel {
            Some([x, y]) => format!("pixel {x},{y}"),
            None => self.render.subject().unwrap_or_default().to_owned(),
        }
    }

    /// The share of a value that its error may have before its digits count as lost.
    pub fn lost_share(&self) -> f64 {
        self.lost / 100.0
    }
}

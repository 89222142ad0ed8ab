//! `lamplight gen`: the bundle of a manifest.

use std::io::Write;
use std::time::Instant;

use clap::Args;

use super::compile::{ConventionArguments, TargetChoice, wanted_one, wanted_targets};
use super::failure::{DiagnosticForm, Failure};
use super::terminal::stdout;
use super::work::{PathArguments, Work};
use crate::generate::{Look, Request, Shard, Summary};
use crate::permute::Quoted;
use crate::source::SourceSet;

/// Compose, compile and bundle every permutation of a manifest.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    places: PathArguments,
    /// Compile only this program.
    #[arg(long, value_name = "P")]
    program: Option<String>,
    /// Compile only this permutation.
    #[arg(long, value_name = "KEY")]
    only: Option<String>,
    /// Compile only for these targets.
    #[arg(long, value_name = "T,...|all", value_delimiter = ',', value_parser = wanted_one)]
    target: Vec<TargetChoice>,
    #[command(flatten)]
    conventions: ConventionArguments,
    /// Compile only the k-th of n parts, which `lamplight merge` puts together.
    #[arg(long, value_name = "K/N")]
    shard: Option<Shard>,
    /// Write nothing; compare with the existing bundle, and end with exit code 3 if they differ.
    #[arg(long)]
    check: bool,
    /// Check every output with an independent validator of its target before the bundle is
    /// replaced.
    #[arg(long)]
    validate: bool,
    /// Print the summary as JSON.
    #[arg(long)]
    json: bool,
}

pub fn run_generate(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    let start = Instant::now();
    let mut work = Work::open(&arguments.places)?;
    let request = make_request(&arguments, &mut work.sources);
    if arguments.validate {
        work.judge(&request)?;
    }
    let look = if arguments.check { Look::Whole } else { Look::Cheap };
    let mut summary = match work.up_to_date(&request, look, form) {
        Some(summary) => Summary { judged: work.judge_bundle()?, ..summary },
        None => work.run(&request, arguments.check, form)?,
    };
    summary.seconds = start.elapsed().as_secs_f64();
    if arguments.json {
        return Ok(writeln!(stdout(), "{:#}", serde_json::json!(summary))?);
    }
    Ok(write!(stdout(), "{summary}")?)
}

fn make_request(arguments: &Arguments, sources: &mut SourceSet) -> Request {
    let only = arguments.only.as_ref().map(|key| {
        let id = sources.add("--only", key.as_str());
        Quoted::whole(sources, id)
    });
    Request {
        program: arguments.program.clone(),
        only,
        targets: wanted_targets(&arguments.target),
        conventions: arguments.conventions.chosen(),
        shard: arguments.shard,
    }
}

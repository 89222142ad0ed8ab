//! `lamplight gen`: the bundle of a manifest.

use std::io::Write;
use std::time::Instant;

use clap::Args;

use super::compile::{Wanted, wanted, wanted_one};
use super::failure::{DiagnosticForm, Failure};
use super::terminal::stdout;
use super::work::{Places, Work};
use crate::generate::{Request, Shard};
use crate::permute::Quoted;
use crate::source::SourceSet;

/// Compose, compile and bundle every permutation of a manifest.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    places: Places,
    /// Only this program.
    #[arg(long, value_name = "P")]
    program: Option<String>,
    /// Only this permutation.
    #[arg(long, value_name = "KEY")]
    only: Option<String>,
    /// Only these targets.
    #[arg(long, value_name = "T,...|all", value_delimiter = ',', value_parser = wanted_one)]
    target: Vec<Wanted>,
    /// Only the k-th of n parts, for `lamplight merge`.
    #[arg(long, value_name = "K/N")]
    shard: Option<Shard>,
    /// Write nothing; compare with the bundle that is there.
    #[arg(long)]
    check: bool,
    /// The summary as JSON.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    let start = Instant::now();
    let mut work = Work::open(&arguments.places)?;
    let request = request(&arguments, &mut work.sources);
    let mut summary = match work.up_to_date(&request, form) {
        Some(summary) => summary,
        None => work.run(&request, arguments.check, form)?,
    };
    summary.seconds = start.elapsed().as_secs_f64();
    if arguments.json {
        return Ok(writeln!(stdout(), "{:#}", serde_json::json!(summary))?);
    }
    Ok(write!(stdout(), "{summary}")?)
}

fn request(arguments: &Arguments, sources: &mut SourceSet) -> Request {
    let only = arguments.only.as_ref().map(|key| {
        let id = sources.add("--only", key.as_str());
        Quoted::whole(sources, id)
    });
    Request {
        program: arguments.program.clone(),
        only,
        targets: wanted(&arguments.target),
        shard: arguments.shard,
    }
}

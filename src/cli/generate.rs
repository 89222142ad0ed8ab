//! `lamplight gen`: the bundle of a manifest.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;

use super::compile::{
    ConventionArguments, SpirvArguments, TargetChoice, wanted_one, wanted_targets,
};
use super::failure::{DiagnosticForm, Failure};
use super::terminal::stdout;
use super::validated::{ValidatedOutputs, refuse_missing};
use super::work::{PathArguments, Work};
use crate::generate::{Look, Request, Shard};
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
    #[command(flatten)]
    spirv: SpirvArguments,
    /// Compile only the k-th of n parts, which `lamplight merge` puts together.
    #[arg(long, value_name = "K/N")]
    shard: Option<Shard>,
    /// Write nothing; compare with the existing bundle, and end with exit code 3 if they differ.
    #[arg(long)]
    check: bool,
    /// Have independent validators of the targets check outputs before the bundle is replaced: all
    /// of them, or a selection that has each distinct line.
    #[arg(long, value_enum, num_args = 0..=1, default_value = "none", default_missing_value = "all")]
    validate: ValidatedOutputs,
    /// Also write a rule for make or ninja: the bundle, and every file that was read.
    #[arg(long, value_name = "FILE", conflicts_with = "check")]
    depfile: Option<PathBuf>,
    /// Print the summary as JSON.
    #[arg(long)]
    json: bool,
}

pub fn run_generate(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    let start = Instant::now();
    let mut work = Work::open(&arguments.places)?;
    let request = make_request(&arguments, &mut work.sources);
    work.validate(arguments.validate.into());
    let look = if arguments.check { Look::Whole } else { Look::Cheap };
    // Only a run knows what it reads. A rule that is there is still right if nothing changed.
    let has_rule = arguments.depfile.as_deref().is_none_or(Path::exists);
    let known = if has_rule { work.up_to_date(&request, look, form) } else { None };
    let mut summary = match known {
        Some(trace) => work.validate_bundle(trace)?,
        None => {
            let summary = work.run(&request, arguments.check, form)?;
            if let Some(path) = &arguments.depfile {
                work.write_rule(path)?;
            }
            summary
        }
    };
    summary.seconds = start.elapsed().as_secs_f64();
    match arguments.json {
        true => writeln!(stdout(), "{:#}", serde_json::json!(summary))?,
        false => write!(stdout(), "{summary}")?,
    }
    refuse_missing(summary.validated.as_ref())
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
        conventions: arguments.spirv.with(arguments.conventions),
        shard: arguments.shard,
    }
}

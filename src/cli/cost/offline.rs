//! Costs from compilers that run as external programs: `lamplight cost --spirv` and `--mali`.

use std::io::Write;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use serde_json::json;

use super::super::failure::{DiagnosticForm, Failure};
use super::super::terminal::stdout;
use super::super::text;
use super::{Arguments, subjects};
use crate::cost::CostSubject;
use crate::cost::counts::{Counts, KINDS, count_optimised};
use crate::cost::mali::{self, MALIOC, MaliVariant};
use crate::cost::pipeline::SpirvStage;
use crate::cost::stages::{StageReport, ask_stages};
use crate::output::Scratch;
use crate::tools::{SPIRV_OPT, output_text};

/// Runs the compiler that the arguments choose on all subjects, and prints its figures.
pub fn run_offline(arguments: &Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    let missing = match arguments.spirv {
        true => SPIRV_OPT.path().is_none().then(|| SPIRV_OPT.missing()),
        false => MALIOC.path().is_none().then(|| mali::MISSING.to_owned()),
    };
    if let Some(missing) = missing {
        return Err(Failure::environment(missing));
    }
    let subjects = subjects::requested_subjects(arguments, form)?;
    if arguments.spirv {
        let found = ask_stages(&subjects, count_optimised).map_err(Failure::input)?;
        return print_counts(arguments, &found);
    }
    print_mali(arguments, &ask_mali(&arguments.mali, &subjects)?)
}

/// The version of the optimiser, which it prints on standard error.
fn optimiser_version() -> String {
    let output = SPIRV_OPT.run(&["--version"], std::iter::empty::<&Path>());
    output.map_or_else(|_| String::new(), |output| output_text(&output))
}

fn print_counts(arguments: &Arguments, found: &[StageReport<'_, Counts>]) -> Result<(), Failure> {
    let optimiser = optimiser_version();
    let net =
        |found: &StageReport<'_, Counts>| found.empty.as_ref().map(|empty| found.whole.less(empty));
    if arguments.json {
        let object = |found: &StageReport<'_, Counts>| {
            json!({
                "name": found.subject.name,
                "stage": found.stage,
                "optimiser": optimiser,
                "counts": found.whole,
                "net": net(found),
            })
        };
        let objects: Vec<_> = found.iter().map(object).collect();
        return Ok(writeln!(stdout(), "{:#}", json!(objects))?);
    }
    let mut columns = vec!["stage", "total"];
    columns.extend(KINDS.iter().map(|kind| kind.heading));
    columns.push("of");
    let row = |found: &StageReport<'_, Counts>| {
        let counts = net(found).filter(|_| !arguments.whole).unwrap_or(found.whole);
        let numbers = std::iter::once(counts.total()).chain(counts.0);
        let mut row = vec![found.stage.name().to_owned()];
        row.extend(numbers.map(|number| number.to_string()));
        row.push(found.subject.name.clone());
        row
    };
    let rows: Vec<Vec<String>> = found.iter().map(row).collect();
    writeln!(stdout(), "{}\n", optimiser)?;
    Ok(stdout().write_all(text::table_text(&columns, &rows).as_bytes())?)
}

/// Compiles every stage for every core.
fn ask_mali<'s>(
    cores: &[String],
    subjects: &'s [CostSubject],
) -> Result<Vec<StageReport<'s, Vec<MaliVariant>>>, Failure> {
    let scratch = Scratch::new(&std::env::temp_dir()).map_err(|error| {
        Failure::environment(format!("there is no room for temporary files: {error}"))
    })?;
    let next = AtomicUsize::new(0);
    let ask = |words: &SpirvStage| {
        let number = next.fetch_add(1, Ordering::Relaxed);
        let name = format!("{number}.{}.spv", words.stage.suffix());
        let file = scratch.stage(&name, &mali::file_bytes(words));
        let file = file.map_err(|error| error.to_string())?;
        let entry = words.entry.to_string_lossy();
        let each = cores.iter().map(|core| mali::compile_stage(&file, &entry, core));
        Ok(each.collect::<Result<Vec<_>, String>>()?.concat())
    };
    ask_stages(subjects, ask).map_err(Failure::input)
}

fn print_mali(
    arguments: &Arguments,
    found: &[StageReport<'_, Vec<MaliVariant>>],
) -> Result<(), Failure> {
    if arguments.json {
        let object = |found: &StageReport<'_, Vec<MaliVariant>>| {
            json!({
                "name": found.subject.name,
                "stage": found.stage,
                "variants": found.whole,
                "empty": found.empty,
            })
        };
        let objects: Vec<_> = found.iter().map(object).collect();
        return Ok(writeln!(stdout(), "{:#}", json!(objects))?);
    }
    let columns = [
        "core", "stage", "variant", "total", "shortest", "longest", "bound by", "work", "uniform",
        "threads", "spill", "of",
    ];
    let rows = found.iter().flat_map(|found| {
        found.whole.iter().map(move |variant| {
            let stage = found.stage.name().to_owned();
            mali_row(variant, stage, found.subject.name.clone())
        })
    });
    let table = text::table_text(&columns, &rows.collect::<Vec<_>>());
    Ok(stdout().write_all(table.as_bytes())?)
}

fn mali_row(variant: &MaliVariant, stage: String, name: String) -> Vec<String> {
    let number = |value: Option<f64>| value.map_or("?".to_owned(), |value| value.to_string());
    let bound: Vec<&str> = variant.total.bound.iter().flatten().map(String::as_str).collect();
    let cycles = [&variant.total, &variant.shortest, &variant.longest];
    let mut row = vec![variant.core.clone(), stage, variant.name.clone()];
    row.extend(cycles.map(|cycles| number(cycles.most())));
    row.push(bound.join(" "));
    row.push(number(variant.work_registers));
    row.push(number(variant.uniform_registers));
    row.push(variant.occupancy.map_or("?".to_owned(), |share| format!("{share} %")));
    row.push(number(variant.spilled_bytes));
    row.push(name);
    row
}

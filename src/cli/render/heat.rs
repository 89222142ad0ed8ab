//! `lamplight render --show`: a number of each pixel in the place of its colour.

use std::io::Write as _;
use std::time::Instant;

use serde_json::json;

use super::{Arguments, executor, input_failure, make_plan, make_shot, own, refuse_own};
use crate::LIBRARY_FILES;
use crate::cli::failure::{DiagnosticForm, Failure};
use crate::cli::terminal::stdout;
use crate::execute::raster::Measure;
use crate::picture::frame::Programs;
use crate::picture::{self, HeatMap, Scale, short_number};

/// Draws what `show` names, of a file, a preset or a permutation.
pub fn draw_heat(arguments: &Arguments, show: &str, form: DiagnosticForm) -> Result<(), Failure> {
    refuse_watching(arguments)?;
    let (start, measure) = (Instant::now(), Measure::named(show));
    let entry = executor::find_drawing(arguments.executor.as_deref().unwrap_or("eval"))?;
    let shot = make_shot(arguments, entry)?;
    let (map, stem) = match own::own_file(arguments) {
        Some(file) => {
            let (ready, sources) = own::prepare_file(arguments, file, &shot, form)?;
            let map = ready.prepared.measure(&measure, &ready.shot);
            let map = map.map_err(|errors| Failure::Input(sources, errors))?;
            let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            (map, if stem == "-" { "render".to_owned() } else { stem })
        }
        None => {
            refuse_own(&Arguments { own: without_json(arguments), ..arguments.clone() })?;
            let programs = Programs::outline(LIBRARY_FILES)
                .map_err(|(sources, problems)| Failure::Input(sources, problems))?;
            let plan = make_plan(&programs, arguments)?;
            let painter = executor::open_executor(entry)?;
            let prepared = picture::prepare_passes(painter.as_ref(), &programs, &plan, &shot);
            let map = prepared.and_then(|prepared| prepared.measure(&measure, &shot));
            let map = map.map_err(|problems| input_failure(&programs, problems))?;
            (map, arguments.preset.clone().unwrap_or_else(|| "render".to_owned()))
        }
    };
    let name = format!("{stem}.{}", show.replace('.', "_"));
    let path = super::write_named(arguments, &name, &map.picture(show))?;
    let (path, seconds) = (path.display().to_string(), start.elapsed().as_secs_f64());
    report(arguments, show, &map, &path, seconds)
}

fn refuse_watching(arguments: &Arguments) -> Result<(), Failure> {
    let given =
        [(arguments.own.watch, "--watch"), (arguments.own.terminal.is_some(), "--terminal")];
    match given.into_iter().find(|(is_given, _)| *is_given) {
        Some((_, option)) => Err(Failure::usage(format!("`--show` has no `{option}`"))),
        None => Ok(()),
    }
}

/// The options for a shader of the user's own without `--json`, which every heat map has.
fn without_json(arguments: &Arguments) -> own::OwnArguments {
    own::OwnArguments { json: false, ..arguments.own.clone() }
}

fn report(
    arguments: &Arguments,
    show: &str,
    map: &HeatMap,
    path: &str,
    seconds: f64,
) -> Result<(), Failure> {
    let Scale { lowest, highest, pixels, at_highest, nan, infinite, missing } = map.scale();
    if arguments.is_json() {
        let value = json!({
            "file": path, "show": show, "lowest": lowest, "highest": highest, "pixels": pixels,
            "at_highest": at_highest, "nan": nan, "infinite": infinite, "missing": missing,
        });
        return Ok(writeln!(stdout(), "{value}")?);
    }
    let mut text = format!(
        "{path}: `{show}` is {} to {} in {pixels} pixels, {at_highest} of them at the highest",
        short_number(lowest),
        short_number(highest)
    );
    let others = [(nan, "NaN"), (infinite, "infinite"), (missing, "without a value")];
    for (count, words) in others.into_iter().filter(|(count, _)| *count > 0) {
        text += &format!(", {count} {words}");
    }
    Ok(writeln!(stdout(), "{text}; {seconds:.2} s")?)
}

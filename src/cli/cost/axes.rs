//! What values of axes cost: `lamplight variants --cost`.

use super::super::failure::Failure;
use super::super::text;
use super::measure_costs;
use super::subjects::permutations_of;
use crate::bundle::{Language, Target};
use crate::cost::Meter;
use crate::cost::permutations::{self, CostChange, Spread};
use crate::generate::Request;
use crate::permute::Manifest;
use crate::resolve::Packages;
use crate::source::SourceSet;

/// What each value of each axis of a program changes, over all its permutations: in WESL,
/// or in GLSL if the program has no WESL. Nothing where no GPU is asked for.
pub fn axis_changes(
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &Manifest,
    program: &str,
    meter: Meter<'_>,
) -> Result<Vec<CostChange>, Failure> {
    if meter.devices.is_empty() {
        return Ok(Vec::new());
    }
    let request = Request {
        program: Some(program.to_owned()),
        targets: vec![Target::SPIRV],
        ..Request::default()
    };
    let found = manifest.programs.iter().find(|known| known.name == program);
    let language = match found.is_some_and(|program| program.wesl.is_none()) {
        true => Language::Glsl,
        false => Language::Wesl,
    };
    let (axes, subjects) =
        permutations_of(sources, packages, manifest, &request, language, meter.cache)?;
    Ok(permutations::value_changes(&axes, &measure_costs(meter, &subjects)?))
}

/// The table of changes: medians, and the range of the cycles.
pub fn changes_table(changes: &[CostChange]) -> String {
    let columns =
        ["gpu", "stage", "pairs", "cycles", "range", "texture", "VGPRs", "waves", "axis and value"];
    let row = |change: &CostChange| {
        let of = |key: &str| change.figures.get(key).copied().unwrap_or_default();
        let signed = |key: &str| format!("{:+}", of(key).median);
        let Spread { least, most, .. } = of("cycles");
        let waves = of("subgroups_per_simd");
        vec![
            change.gpu.to_owned(),
            change.stage.name().to_owned(),
            change.pairs.to_string(),
            signed("cycles"),
            format!("{least:+} to {most:+}"),
            signed("texture"),
            signed("vgprs"),
            format!("{} to {}", waves.before, waves.after),
            format!("{}={}", change.axis, change.value),
        ]
    };
    text::table_text(&columns, &changes.iter().map(row).collect::<Vec<_>>())
}

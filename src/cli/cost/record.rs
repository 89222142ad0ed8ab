//! Measures what the catalogue shows of costs: every function on every generation, every value of
//! every axis on one GPU.

use std::collections::BTreeMap;

use super::super::failure::Failure;
use super::{Opened, axis_changes, measure_costs, subjects};
use crate::bundle::Language;
use crate::catalogue::cost::{AxisCost, Chip, Costs, FIGURES, SHOWN};
use crate::catalogue::{self, Item};
use crate::cost::Cost;
use crate::cost::device::Device;
use crate::cost::permutations::Change;
use crate::project;
use crate::source::SourceSet;

/// Measures all of it, of the library.
pub fn record_costs(opened: Opened) -> Result<Costs, Failure> {
    let devices = opened.map_err(Failure::environment)?;
    let modules = catalogue::library_modules();
    let items: Vec<&Item> = modules.iter().flat_map(|module| &module.items).collect();
    let mut functions = Vec::new();
    subjects::function_subjects(&items, &[], Language::Wesl, &mut functions)?;
    let measured = measure_costs(&devices, &functions)?;
    let chip = |device: &Device| Chip {
        name: device.gpu.name.to_owned(),
        generation: device.gpu.generation.to_owned(),
    };
    Ok(Costs {
        driver: devices.first().map_or_else(String::new, |device| device.driver.clone()),
        gpus: devices.iter().map(chip).collect(),
        functions: by_function(&devices, &measured),
        axes: of_axes(&devices)?,
    })
}

/// The rows of each function, in the order of the GPUs.
fn by_function(devices: &[Device], costs: &[Cost]) -> BTreeMap<String, Vec<[i64; FIGURES.len()]>> {
    let mut functions: BTreeMap<String, Vec<[i64; FIGURES.len()]>> = BTreeMap::new();
    for device in devices {
        for cost in costs.iter().filter(|cost| cost.gpu == device.gpu) {
            let net = cost.figures();
            let row = [net.instructions, net.vgprs, net.latency, net.inverse_throughput];
            functions.entry(cost.name.clone()).or_default().push(row);
        }
    }
    functions
}

/// What values of the axes of the library's programs change.
fn of_axes(devices: &[Device]) -> Result<Vec<AxisCost>, Failure> {
    let Some(at) = devices.iter().position(|device| device.gpu.name == SHOWN) else {
        return Ok(Vec::new());
    };
    let shown = &devices[at..=at];
    let library = project::library_manifest();
    let (mut sources, manifest): (SourceSet, _) =
        library.map_err(|(sources, diagnostics)| Failure::Input(sources, diagnostics))?;
    let packages = project::library();
    let mut axes = Vec::new();
    for program in &manifest.programs {
        let name = &program.name;
        let changes = axis_changes(&mut sources, &packages, &manifest, name, shown)?;
        axes.extend(changes.into_iter().map(|change| axis_cost(name, change)));
    }
    Ok(axes)
}

fn axis_cost(program: &str, change: Change) -> AxisCost {
    let of = |key: &str| change.figures.get(key).copied().unwrap_or_default();
    let (instructions, waves) = (of("instructions"), of("subgroups_per_simd"));
    AxisCost {
        program: program.to_owned(),
        stage: change.stage,
        pairs: change.pairs,
        instructions: [instructions.least, instructions.median, instructions.most],
        vgprs: of("vgprs").median,
        waves: [waves.before, waves.after],
        inverse_throughput: of("inverse_throughput").median,
        axis: change.axis,
        value: change.value,
    }
}

//! Measures what the catalogue shows of costs: every function on every generation, every value of
//! every axis on one GPU.

use std::collections::BTreeMap;
use std::sync::Mutex;

use super::super::failure::Failure;
use super::{OpenedGpus, axis_changes, measure_costs, subjects};
use crate::LIBRARY_FILES;
use crate::bundle::{Conventions, Language};
use crate::catalogue::cost::{AxisCost, Chip, Costs, FIGURES, SHOWN};
use crate::catalogue::{self, CatalogueItem, quality};
use crate::check::library::{Library, lock_sources};
use crate::check::quality::{FUNCTION, quality_module};
use crate::cost::device::Device;
use crate::cost::permutations::CostChange;
use crate::cost::{self, Cost, Meter};
use crate::project;
use crate::source::SourceSet;

/// Measures every cost that the catalogue shows of the library.
pub fn record_costs(opened: OpenedGpus) -> Result<Costs, Failure> {
    let devices = opened.map_err(Failure::environment)?;
    let modules = catalogue::library_modules(LIBRARY_FILES);
    let items: Vec<&CatalogueItem> = modules.iter().flat_map(|module| &module.items).collect();
    let plain = Conventions::default();
    let functions = subjects::function_subjects(&items, &[], Language::Wesl, plain)?;
    let measured = measure_costs(uncached(&devices), &functions)?;
    Ok(Costs {
        driver: devices.first().map_or_else(String::new, |device| device.driver.clone()),
        gpus: devices.iter().map(chip_of).collect(),
        functions: by_function(&devices, &measured),
        axes: of_axes(&devices)?,
        expressions: of_expressions(&devices)?,
    })
}

/// A meter without a cache: costs that are recorded are always measured anew.
fn uncached(devices: &[Device]) -> Meter<'_> {
    Meter { devices, cache: None, iterations: &[] }
}

fn chip_of(device: &Device) -> Chip {
    Chip { name: device.gpu.name.to_owned(), generation: device.gpu.generation.to_owned() }
}

/// The record of a package's axes, from the changes by program. Nothing where the GPU that is
/// recorded is not one of those that were measured.
pub fn axis_record<'c>(
    devices: &[Device],
    changes: impl Iterator<Item = (&'c str, &'c [CostChange])>,
) -> Option<Costs> {
    let shown = shown_device(devices).first()?;
    let of_program = |(program, changes): (&'c str, &'c [CostChange])| {
        let recorded = changes.iter().filter(|change| change.gpu == SHOWN);
        recorded.map(|change| axis_cost(program, change.clone())).collect::<Vec<_>>()
    };
    Some(Costs {
        driver: shown.driver.clone(),
        gpus: vec![chip_of(shown)],
        axes: changes.flat_map(of_program).collect(),
        ..Costs::default()
    })
}

/// The rows of each function, in the order of the GPUs.
fn by_function(devices: &[Device], costs: &[Cost]) -> BTreeMap<String, Vec<[i64; FIGURES.len()]>> {
    let mut functions: BTreeMap<String, Vec<[i64; FIGURES.len()]>> = BTreeMap::new();
    for device in devices {
        for cost in costs.iter().filter(|cost| cost.gpu == device.gpu) {
            functions.entry(cost.name.clone()).or_default().push(figures_row(cost));
        }
    }
    functions
}

/// Measures the expressions that the catalogue plots.
fn of_expressions(devices: &[Device]) -> Result<BTreeMap<String, [i64; FIGURES.len()]>, Failure> {
    let (library, sources) = (Library::shipped(LIBRARY_FILES), Mutex::new(SourceSet::default()));
    let failure_of = |problems| Failure::Input(lock_sources(&sources).clone(), problems);
    let groups =
        quality::library_groups(LIBRARY_FILES, &mut lock_sources(&sources)).map_err(failure_of)?;
    let mut subjects = Vec::new();
    for (group, entry) in
        groups.iter().flat_map(|group| group.entries.iter().map(move |entry| (group, entry)))
    {
        let module = quality_module(&library, &sources, group, &entry.value).map_err(failure_of)?;
        let subject =
            cost::function_subject(&group.key(entry), &module, FUNCTION, Conventions::default());
        subjects.push(subject.map_err(|error| failure_of(vec![error]))?);
    }
    let costs = measure_costs(uncached(shown_device(devices)), &subjects)?;
    Ok(costs.iter().map(|cost| (cost.name.clone(), figures_row(cost))).collect())
}

/// The device of the GPU that tables show.
fn shown_device(devices: &[Device]) -> &[Device] {
    let at = devices.iter().position(|device| device.gpu.name == SHOWN);
    at.map_or(&[], |at| &devices[at..=at])
}

fn figures_row(cost: &Cost) -> [i64; FIGURES.len()] {
    let net = cost.figures();
    [
        net.cycles,
        net.least_cycles,
        net.transcendental,
        net.texture,
        net.vgprs,
        net.instructions,
        net.open_loops,
    ]
}

/// What values of the axes of the library's programs change.
fn of_axes(devices: &[Device]) -> Result<Vec<AxisCost>, Failure> {
    let shown = shown_device(devices);
    if shown.is_empty() {
        return Ok(Vec::new());
    }
    let library = project::library_manifest();
    let (mut sources, manifest): (SourceSet, _) =
        library.map_err(|(sources, diagnostics)| Failure::Input(sources, diagnostics))?;
    let packages = project::library_packages();
    let mut axes = Vec::new();
    for program in &manifest.programs {
        let name = &program.name;
        let changes = axis_changes(&mut sources, &packages, &manifest, name, uncached(shown))?;
        axes.extend(changes.into_iter().map(|change| axis_cost(name, change)));
    }
    Ok(axes)
}

fn axis_cost(program: &str, change: CostChange) -> AxisCost {
    let of = |key: &str| change.figures.get(key).copied().unwrap_or_default();
    let (cycles, waves) = (of("cycles"), of("subgroups_per_simd"));
    AxisCost {
        program: program.to_owned(),
        stage: change.stage,
        pairs: change.pairs,
        cycles: [cycles.least, cycles.median, cycles.most],
        texture: of("texture").median,
        instructions: of("instructions").median,
        vgprs: of("vgprs").median,
        waves: [waves.before, waves.after],
        axis: change.axis,
        value: change.value,
    }
}

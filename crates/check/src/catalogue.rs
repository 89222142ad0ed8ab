//! Makes the catalogue of the embedded library. The evaluator computes its plots.

use std::collections::BTreeMap;
use std::sync::Mutex;

use super::library::{Library, lock_sources};
use super::{plots, quality};
use lamplight_catalogue::pages::{CatalogueContents, DrawnPlot, catalogue_pages};
use lamplight_catalogue::quality::{self as groups, Measured};
use lamplight_catalogue::translated::translated_files;
use lamplight_catalogue::{
    self as catalogue, CatalogueModule, cost, figure, plot, prefix, preset, probe, reader,
};
use lamplight_compose::project;
use lamplight_diagnostic::source::{Embedded, SourceSet};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes, stopped_message};
use lamplight_execute::{Session, executors, on_thread};
use lamplight_permute::Manifest;

/// The texts of files, by their paths below a folder.
pub type CatalogueFiles = BTreeMap<String, String>;

/// Makes the files of the catalogue. Errors come with the sources of the library, which they point
/// into.
pub fn catalogue_files(library: Embedded) -> Result<CatalogueFiles, (SourceSet, Diagnostics)> {
    let (sources, manifest) = project::library_manifest(library)?;
    let sources = Mutex::new(sources);
    let made = on_thread(|| read_contents(library, &sources, &manifest))
        .unwrap_or_else(|| Err(vec![drawing_stopped()]));
    made.map_err(|problems| (sources.into_inner().unwrap_or_default(), problems))
}

/// The files of the library that are generated, by path below the library: the module of the
/// ambient probes with its cases, everything in GLSL, and the file of prefixed names.
pub fn made_modules(library: Embedded) -> Result<CatalogueFiles, (SourceSet, Diagnostics)> {
    let mut sources = SourceSet::default();
    let probes = match probe::library_probes(library, &mut sources) {
        Ok(probes) => probes,
        Err(problems) => return Err((sources, problems)),
    };
    let mut made = CatalogueFiles::from([
        ("ambient/probes.wesl".to_owned(), probe::wesl_module(&probes)),
        ("ambient/probes.toml".to_owned(), probe::numeric_cases(&probes)),
    ]);
    let glsl = match translated_files(&library, &made, &mut sources) {
        Ok(glsl) => glsl,
        Err(problems) => return Err((sources, problems)),
    };
    made.insert(prefix::PATH.to_owned(), prefix::prefix_file(&glsl));
    made.extend(glsl);
    Ok(made)
}

fn read_contents(
    library: Embedded,
    sources: &Mutex<SourceSet>,
    manifest: &Manifest,
) -> Result<CatalogueFiles, Diagnostics> {
    let modules = catalogue::library_modules(library);
    let plots = draw_plots(library, sources, &modules)?;
    let probes = probe::library_probes(library, &mut lock_sources(sources))?;
    let presets = preset::library_presets(library, &mut lock_sources(sources), manifest, &probes)?;
    let costs = cost::library_costs(library, &mut lock_sources(sources))?;
    let quality = measure_quality(library, sources)?;
    let kinds = figure::library_kinds(library, &mut lock_sources(sources))?;
    let figures = figure::library_figures(library, &mut lock_sources(sources), &modules, &kinds)?;
    Ok(catalogue_pages(&CatalogueContents {
        modules: &modules,
        plots: &plots,
        kinds: &kinds,
        figures: &figures,
        manifest,
        presets: &presets,
        probes: &probes,
        costs: &costs,
        quality: &quality,
    }))
}

/// Measures the errors of every group in `quality.toml`.
fn measure_quality(
    files: Embedded,
    sources: &Mutex<SourceSet>,
) -> Result<Vec<Measured>, Diagnostics> {
    let (executor, library) = (executors::eval::EXECUTOR, Library::shipped(files));
    let mut session = executor.start().map_err(|_| vec![drawing_stopped()])?;
    let found = groups::library_groups(files, &mut lock_sources(sources))?;
    let measure = |group| quality::measure_group(&library, sources, group, session.as_mut());
    found.into_iter().map(measure).collect()
}

/// Draws every plot, by the path of its function.
fn draw_plots(
    files: Embedded,
    sources: &Mutex<SourceSet>,
    modules: &[CatalogueModule],
) -> Result<BTreeMap<String, DrawnPlot>, Diagnostics> {
    let (executor, library) = (executors::eval::EXECUTOR, Library::shipped(files));
    let mut session = executor.start().map_err(|_| vec![drawing_stopped()])?;
    let mut found = BTreeMap::new();
    for module in modules {
        let file = plot::plot_path(&module.path);
        let plots: Option<plot::Plots> =
            reader::find_own(files, &mut lock_sources(sources), &file)?;
        for (name, plot) in plots.unwrap_or_default() {
            let path = format!("{}::{name}", module.path);
            if !module.items.iter().any(|item| item.name == name) {
                return Err(vec![Diagnostic::error(
                    codes::UNKNOWN_FUNCTION,
                    format!("`{file}` plots `{path}`, which does not exist"),
                )]);
            }
            found.insert(
                path.clone(),
                draw_plot(&library, sources, &path, &plot, session.as_mut())?,
            );
        }
    }
    Ok(found)
}

fn draw_plot(
    library: &Library,
    sources: &Mutex<SourceSet>,
    path: &str,
    plot: &plot::Plot,
    session: &mut dyn Session,
) -> Result<DrawnPlot, Diagnostics> {
    let curves = plots::plot_curves(library, sources, path, plot, session)?;
    let svg = plot::draw_plot(path.rsplit("::").next().unwrap_or(path), plot, &curves);
    Ok(DrawnPlot { svg, caption: plot.caption() })
}

fn drawing_stopped() -> Diagnostic {
    Diagnostic::error(codes::EVAL_INTERNAL, stopped_message("the plots"))
}

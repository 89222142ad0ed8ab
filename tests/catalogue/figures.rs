//! Every function has a plot or a picture, and the pictures show what the functions compute.

use lamplight::LIBRARY_FILES;
use lamplight::catalogue::figure::{Figures, Kinds, library_figures, library_kinds, picture_path};
use lamplight::catalogue::plot::{parse_plots, plot_path};
use lamplight::catalogue::{self, CatalogueItemKind};
use lamplight::picture::figure::stale_figures;
use lamplight::source::{Files as _, SourceSet};
use libtest_mimic::{Failed, Trial};

use crate::snapshot::root;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("catalogue::every_function_is_drawn", every_function_is_drawn),
        Trial::test("catalogue::figures_are_up_to_date", figures_are_up_to_date),
    ]
}

fn figures() -> Result<(Kinds, Figures), Failed> {
    let mut sources = SourceSet::default();
    let mut read = || {
        let kinds = library_kinds(LIBRARY_FILES, &mut sources)?;
        let figures = library_figures(
            LIBRARY_FILES,
            &mut sources,
            &catalogue::library_modules(LIBRARY_FILES),
            &kinds,
        )?;
        Ok((kinds, figures))
    };
    read().map_err(|problems: Vec<_>| format!("{problems:?}").into())
}

/// Paths of all pictures below the catalogue's folder.
pub fn pictures() -> Result<Vec<String>, Failed> {
    let (_, figures) = figures()?;
    let drawn = figures.iter().filter(|(_, figure)| figure.none.is_none());
    Ok(drawn.map(|(path, _)| picture_path(path)).collect())
}

/// A function without a plot and without a picture has the reason for it.
fn every_function_is_drawn() -> Result<(), Failed> {
    let (_, figures) = figures()?;
    let mut missing = Vec::new();
    for module in catalogue::library_modules(LIBRARY_FILES) {
        let mut sources = SourceSet::default();
        let path = plot_path(&module.path);
        let text = LIBRARY_FILES.read(&path).ok().flatten().unwrap_or_default();
        let id = sources.add(path, text);
        let plots = parse_plots(&sources, id).map_err(|problems| format!("{problems:?}"))?;
        let functions = module.items.iter().filter(|item| item.kind == CatalogueItemKind::Function);
        let bare = functions
            .filter(|item| !plots.contains_key(&item.name) && !figures.contains_key(&item.path()));
        missing.extend(bare.map(|item| item.path()));
    }
    match missing.is_empty() {
        true => Ok(()),
        false => Err(format!(
            "without a plot in NAME.plot.toml, and without a figure or a reason in NAME.figure.toml: {missing:?}"
        )
        .into()),
    }
}

/// Some pixels of every picture are computed again.
fn figures_are_up_to_date() -> Result<(), Failed> {
    let (kinds, figures) = figures()?;
    let folder = root().join("docs/catalogue");
    let existing = |path: &str| std::fs::read(folder.join(picture_path(path))).ok();
    let stale = stale_figures(LIBRARY_FILES, &kinds, &figures, &existing);
    let stale = stale.map_err(|problems| format!("{problems:?}"))?;
    match stale.is_empty() {
        true => Ok(()),
        false => Err(format!(
            "these pictures are not of their functions: {stale:?}\nrun: cargo xtask docs"
        )
        .into()),
    }
}

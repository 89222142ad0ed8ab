//! `lamplight show PATH`: everything about one thing of the library.

mod item;
mod preset;
mod program;
mod search;

pub use preset::{preset_json, probe_json};
pub use program::axis_json;

use std::io::Write;

use clap::Args;
use serde_json::Value;

use super::failure::Failure;
use super::list::known_modules;
use super::own::OwnPackage;
use crate::LIBRARY_FILES;
use crate::catalogue::preset::Preset;
use crate::catalogue::probe::Probe;
use crate::catalogue::{self, CatalogueItem, CatalogueModule};
use crate::cli::terminal::stdout;
use crate::diagnostic::nearest_name;
use crate::permute::Manifest;
use crate::project::{self, LIBRARY};

/// Show the documentation, signatures, source and error model of a function, or search for a word.
#[derive(Args)]
pub struct Arguments {
    /// An item (`brdf::specular::blinn_phong`), a module (`brdf::specular`), a program
    /// (`forward`), an axis (`forward.shadow`), a preset (`hpg_5_shadow`) or a light probe; your
    /// own items are below `package`. The name of an item is enough where no other has it. Any other
    /// word is searched for.
    path: String,
    /// Print a JSON object.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    own: OwnPackage,
}

/// One thing, as text and as JSON.
struct ShownItem {
    text: String,
    json: Value,
}

/// What there is to show.
struct ShowIndex {
    modules: Vec<CatalogueModule>,
    /// The user's own, if there is one, then the library's.
    manifests: Vec<Manifest>,
    presets: Vec<Preset>,
    probes: Vec<Probe>,
}

pub fn run_show(arguments: Arguments) -> Result<(), Failure> {
    let path = arguments
        .path
        .strip_prefix(LIBRARY)
        .and_then(|rest| rest.strip_prefix("::"))
        .unwrap_or(&arguments.path);
    let library = open_library(&arguments.own)?;
    let shown = find_shown(&library, path)
        .or_else(|| search::search_library(&library, path))
        .ok_or_else(|| missing_path(path, &library))?;
    let text = if arguments.json { format!("{:#}\n", shown.json) } else { shown.text };
    Ok(stdout().write_all(text.as_bytes())?)
}

fn open_library(own: &OwnPackage) -> Result<ShowIndex, Failure> {
    let (mut sources, manifest) = project::library_manifest()
        .map_err(|(sources, problems)| Failure::Input(sources, problems))?;
    match catalogue::library_examples(LIBRARY_FILES, &mut sources, &manifest) {
        Ok((presets, probes)) => {
            let manifests = own.manifest()?.into_iter().chain([manifest]).collect();
            Ok(ShowIndex { modules: known_modules(own)?, manifests, presets, probes })
        }
        Err(problems) => Err(Failure::Input(sources, problems)),
    }
}

fn find_shown(library: &ShowIndex, path: &str) -> Option<ShownItem> {
    let item = || {
        library
            .modules
            .iter()
            .flat_map(|module| &module.items)
            .find(|item| item.path() == path)
            .map(item::show_item)
    };
    let module =
        || library.modules.iter().find(|module| module.path == path).map(item::show_module);
    let program = || {
        library
            .manifests
            .iter()
            .find_map(|manifest| manifest.program(path))
            .map(program::show_program)
    };
    let preset =
        || library.presets.iter().find(|preset| preset.name == path).map(preset::show_preset);
    let probe = || library.probes.iter().find(|probe| probe.name == path).map(preset::show_probe);
    item()
        .or_else(module)
        .or_else(program)
        .or_else(|| find_axis(library, path))
        .or_else(preset)
        .or_else(probe)
        .or_else(|| find_named(library, path))
}

/// The only item of this name, whatever its module is.
fn find_named(library: &ShowIndex, name: &str) -> Option<ShownItem> {
    let items = library.modules.iter().flat_map(|module| &module.items);
    let mut found = items.filter(|item| item.path().rsplit("::").next() == Some(name));
    let item = found.next()?;
    found.next().is_none().then(|| item::show_item(item))
}

/// `PROGRAM.AXIS`, or the axis alone where one program has it.
fn find_axis(library: &ShowIndex, path: &str) -> Option<ShownItem> {
    let (wanted, name) =
        path.split_once('.').map_or((None, path), |(program, name)| (Some(program), name));
    let programs = library
        .manifests
        .iter()
        .flat_map(|manifest| &manifest.programs)
        .filter(|program| wanted.is_none_or(|wanted| wanted == program.name));
    let mut found = programs.filter_map(|program| Some((program, program.space.axis(name)?)));
    let (program, axis) = found.next()?;
    found.next().is_none().then(|| program::show_axis(program, axis))
}

fn missing_path(path: &str, library: &ShowIndex) -> Failure {
    let items: Vec<String> = library
        .modules
        .iter()
        .flat_map(|module| module.items.iter().map(CatalogueItem::path))
        .collect();
    let axes: Vec<String> = library
        .manifests
        .iter()
        .flat_map(|manifest| &manifest.programs)
        .flat_map(|program| {
            program.space.axes().iter().map(|axis| format!("{}.{}", program.name, axis.name))
        })
        .collect();
    let programs = library.manifests.iter().flat_map(|manifest| &manifest.programs);
    let others = library
        .modules
        .iter()
        .map(|module| module.path.as_str())
        .chain(programs.map(|program| program.name.as_str()));
    let others = others
        .chain(library.presets.iter().map(|preset| preset.name.as_str()))
        .chain(library.probes.iter().map(|probe| probe.name.as_str()));
    let known = items.iter().chain(&axes).map(String::as_str).chain(others);
    let same_name = items
        .iter()
        .find(|item| item.rsplit("::").next() == path.rsplit("::").next())
        .map(String::as_str);
    let hint = same_name.or_else(|| nearest_name(path, known)).map_or_else(
        || "\nhelp: `lamplight list functions` lists all functions".to_owned(),
        |near| format!("; did you mean `{near}`?"),
    );
    Failure::input(format!("the library has no `{path}`{hint}"))
}

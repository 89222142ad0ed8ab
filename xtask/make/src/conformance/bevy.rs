//! Bevy's shaders: the modules of its crates, each composed with the definitions that it needs, and
//! validated.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use lamplight::compose::{self, Keep, Options};
use lamplight::diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight::permute::{Setting, Settings};
use lamplight::resolve::{Packages, wesl};
use lamplight::source::{Memory, Package, SourceSet};
use lamplight::validate::validate_for_some;

use lamplight_validate::on_large_stack;
use rayon::prelude::*;

use super::Program;
use super::folder::files_below;
use super::table::Table;
use xtask::CommandFailure;

/// The folder of the crates.
pub const CRATES: &str = "crates/bevy_pbr/src";

/// What the shaders need.
const NEEDS: &str = include_str!("bevy.txt");

/// What `bevy.txt` says.
#[derive(Default)]
struct Needs {
    constants: BTreeMap<String, String>,
    definitions: BTreeMap<&'static str, Vec<&'static str>>,
    templates: Vec<&'static str>,
}

/// The modules of a crate, by their paths.
type Modules = Arc<BTreeMap<String, String>>;

/// Composes every module of every crate in a checkout.
pub fn tabulate(checkout: &Path) -> Result<Table, CommandFailure> {
    let needs = read_needs()?;
    let crates = read_crates(&checkout.join("crates"))?;
    let mut table = Table::default();
    let mut programs = Vec::new();
    for (name, modules) in &crates {
        for path in modules.keys() {
            let module = format!("{name}/{}", path.trim_end_matches(".wesl"));
            match needs.templates.contains(&module.as_str()) {
                true => table.leave_out("a template that the host fills"),
                false => programs.push((name, path, module)),
            }
        }
    }
    let mut unknown: Vec<&str> = needs.definitions.keys().copied().collect();
    unknown.retain(|known| !programs.iter().any(|(.., module)| module == known));
    if !unknown.is_empty() {
        let unknown = unknown.join(", ");
        return Err(CommandFailure::input(format!(
            "`bevy.txt` names what is not there: {unknown}"
        )));
    }
    let outcome_of = |(name, path, module): &(&String, &String, String)| {
        composed(&crates, name, path, &needs.settings(module)).err()
    };
    let outcomes: Vec<Option<Diagnostic>> =
        on_large_stack(|| programs.par_iter().map(outcome_of).collect());
    for ((.., module), outcome) in programs.into_iter().zip(outcomes) {
        let program = Program { name: module, text: String::new(), expected: true };
        match outcome {
            Some(error) if error.code == codes::NOT_PORTABLE => {
                table.add_not_run("composed, with what no target has");
                table.add(&program, None);
            }
            outcome => table.add(&program, outcome.as_ref()),
        }
    }
    Ok(table)
}

fn read_needs() -> Result<Needs, CommandFailure> {
    let mut needs = Needs::default();
    for line in NEEDS.lines().filter(|line| !line.starts_with('#')) {
        match *line.split_whitespace().collect::<Vec<_>>() {
            ["constant", name, value] => {
                needs.constants.insert(name.to_owned(), value.to_owned());
            }
            ["template", module] => needs.templates.push(module),
            [module, ref definitions @ ..] if !definitions.is_empty() => {
                needs.definitions.insert(module, definitions.to_vec());
            }
            _ => return Err(CommandFailure::input(format!("`bevy.txt`: `{line}`"))),
        }
    }
    Ok(needs)
}

impl Needs {
    fn settings(&self, module: &str) -> Settings {
        let definitions = self.definitions.get(module).into_iter().flatten();
        let values = definitions.map(|name| ((*name).to_owned(), Setting::Bool(true)));
        Settings {
            values: values.collect(),
            undeclared: Some(false),
            constants: self.constants.clone(),
            ..Settings::default()
        }
    }
}

/// The crates that have modules.
fn read_crates(folder: &Path) -> Result<BTreeMap<String, Modules>, CommandFailure> {
    let mut crates: BTreeMap<String, BTreeMap<String, String>> = BTreeMap::new();
    for file in files_below(folder, "wesl")? {
        let path = file.strip_prefix(folder).unwrap_or(&file).to_string_lossy().replace('\\', "/");
        let Some((name, path)) = path.split_once("/src/") else { continue };
        let text = std::fs::read_to_string(&file)
            .map_err(|error| CommandFailure::input(format!("`{}`: {error}", file.display())))?;
        crates.entry(name.to_owned()).or_default().insert(path.to_owned(), text);
    }
    Ok(crates.into_iter().map(|(name, modules)| (name, Arc::new(modules))).collect())
}

/// Composes a module with all that it declares, and validates the text.
fn composed(
    crates: &BTreeMap<String, Modules>,
    name: &str,
    path: &str,
    settings: &Settings,
) -> Result<(), Diagnostic> {
    let package = |name: &String, modules: &Modules| Package {
        name: name.clone(),
        files: Box::new(Memory(modules.as_ref().clone())),
    };
    let (own, others): (Vec<_>, Vec<_>) = crates.iter().partition(|(found, _)| *found == name);
    let others = others.into_iter().map(|(name, modules)| package(name, modules)).collect();
    let none = || Diagnostic::error(codes::CHECK_FAILED, "the crate is not found");
    let (name, modules) = own.first().ok_or_else(none)?;
    let packages = Packages::new(package(name, modules), others);
    let options = Options { keep: Keep::Root, ..Options::default() };
    let composed = wesl::load(&mut SourceSet::default(), &packages, path)
        .and_then(|graph| compose::wesl::compose(&graph, settings, &options))
        .map_err(first)?;
    validate_for_some(&composed).map(drop).map_err(first)
}

fn first(errors: Diagnostics) -> Diagnostic {
    let none = || Diagnostic::error(codes::CHECK_FAILED, "refused without an error");
    errors.into_iter().next().unwrap_or_else(none)
}

//! `lamplight list [WHAT]`: tables of what there is.

use std::io::Write;

use clap::{Args, ValueEnum};
use serde_json::{Value, json};

use super::compile;
use super::failure::Failure;
use super::own::OwnPackage;
use super::text;
use crate::LIBRARY_FILES;
use crate::catalogue::{self, CatalogueItemKind, probe};
use crate::cli::terminal::stdout;
use crate::emit::targets;
use crate::execute::executors;
use crate::permute::{Manifest, Program, Setting};
use crate::project;
use crate::scene::sets;
use crate::source::SourceSet;

/// List functions, programs, presets, targets and more, of the library and of your own package.
#[derive(Args)]
pub struct Arguments {
    /// What to list.
    #[arg(value_enum, default_value_t)]
    what: What,
    /// Print a JSON array of objects, which have more fields than the table.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    own: OwnPackage,
}

#[derive(Clone, Copy, Default, ValueEnum)]
enum What {
    Modules,
    #[default]
    Functions,
    Structs,
    Constants,
    Programs,
    Axes,
    Presets,
    Scenes,
    Probes,
    Targets,
    Executors,
}

/// Rows as JSON objects. The table shows the fields in `shown`, and wraps the last one.
struct ListTable {
    shown: &'static [&'static str],
    things: Vec<Value>,
}

pub fn run_list(arguments: Arguments) -> Result<(), Failure> {
    let table = match arguments.what {
        What::Modules => module_table(known_modules(&arguments.own)?),
        What::Functions => item_table(
            known_modules(&arguments.own)?,
            CatalogueItemKind::Function,
            &["function", "summary"],
        ),
        What::Structs => item_table(
            known_modules(&arguments.own)?,
            CatalogueItemKind::Struct,
            &["struct", "summary"],
        ),
        What::Constants => item_table(
            known_modules(&arguments.own)?,
            CatalogueItemKind::Constant,
            &["constant", "wesl", "summary"],
        ),
        What::Programs => program_table(all_programs(&arguments.own)?),
        What::Axes => axis_table(&all_programs(&arguments.own)?),
        What::Presets => preset_table()?,
        What::Scenes => scene_table(),
        What::Probes => probe_table()?,
        What::Targets => target_table(),
        What::Executors => executor_table(),
    };
    let text = if arguments.json {
        format!("{:#}\n", Value::Array(table.things))
    } else {
        as_text(&table)
    };
    Ok(stdout().write_all(text.as_bytes())?)
}

/// The modules of the user's own package, then those of the library.
pub fn known_modules(own: &OwnPackage) -> Result<Vec<catalogue::CatalogueModule>, Failure> {
    let own = own.packages()?.map(|packages| catalogue::own_modules(&*packages.root.files));
    Ok(own.into_iter().flatten().chain(catalogue::library_modules(LIBRARY_FILES)).collect())
}

/// The programs of the user's own manifest, then those of the library.
fn all_programs(own: &OwnPackage) -> Result<Vec<Program>, Failure> {
    let own = own.manifest()?.map_or(Vec::new(), |manifest| manifest.programs);
    Ok(own.into_iter().chain(own_manifest()?.1.programs).collect())
}

fn module_table(known: Vec<catalogue::CatalogueModule>) -> ListTable {
    let thing = |module: catalogue::CatalogueModule| {
        json!({
            "module": module.path,
            "functions": module.count(CatalogueItemKind::Function),
            "structs": module.count(CatalogueItemKind::Struct),
            "constants": module.count(CatalogueItemKind::Constant),
            "summary": module.summary(),
        })
    };
    ListTable {
        shown: &["module", "functions", "structs", "summary"],
        things: known.into_iter().map(thing).collect(),
    }
}

fn item_table(
    known: Vec<catalogue::CatalogueModule>,
    kind: CatalogueItemKind,
    shown: &'static [&'static str],
) -> ListTable {
    let items = known.into_iter().flat_map(|module| module.items).filter(|item| item.kind == kind);
    let thing = |item: catalogue::CatalogueItem| {
        json!({
            kind.name(): item.path(),
            "summary": item.summary(),
            "wesl": item.wesl,
            "glsl": item.glsl,
            "import": item.import(),
            "include": item.include(),
        })
    };
    ListTable { shown, things: items.map(thing).collect() }
}

fn program_table(programs: Vec<Program>) -> ListTable {
    let things = programs.into_iter().map(|program| {
        json!({
            "program": program.name,
            "axes": program.space.axes().len(),
            "permutations": count_json(program.space.count()),
            "targets": program.targets.iter().map(|target| target.name()).collect::<Vec<_>>(),
            "files": program.files().map(|file| file.path.clone()).collect::<Vec<_>>(),
            "summary": program.doc,
        })
    });
    ListTable { shown: &["program", "axes", "permutations", "targets"], things: things.collect() }
}

fn axis_table(programs: &[Program]) -> ListTable {
    let things = programs.iter().flat_map(|program| {
        program.space.axes().iter().map(|axis| super::show::axis_json(&program.name, axis))
    });
    ListTable { shown: &["program", "axis", "mode", "default", "values"], things: things.collect() }
}

fn preset_table() -> Result<ListTable, Failure> {
    let (mut sources, manifest) = own_manifest()?;
    let (presets, _) = catalogue::library_examples(LIBRARY_FILES, &mut sources, &manifest)
        .map_err(|problems| Failure::Input(sources, problems))?;
    let things = presets.iter().map(super::show::preset_json).collect();
    Ok(ListTable { shown: &["preset", "program", "scene", "key"], things })
}

fn scene_table() -> ListTable {
    let things = sets::ALL.iter().map(|set| json!({ "scene": set.name, "summary": set.about }));
    ListTable { shown: &["scene", "summary"], things: things.collect() }
}

fn probe_table() -> Result<ListTable, Failure> {
    let mut sources = SourceSet::default();
    let probes = probe::library_probes(LIBRARY_FILES, &mut sources)
        .map_err(|problems| Failure::Input(sources, problems))?;
    Ok(ListTable {
        shown: &["probe", "title"],
        things: probes.iter().map(super::show::probe_json).collect(),
    })
}

fn own_manifest() -> Result<(SourceSet, Manifest), Failure> {
    project::library_manifest()
        .map_err(|(sources, diagnostics)| Failure::Input(sources, diagnostics))
}

fn target_table() -> ListTable {
    let things = targets::ALL.iter().map(|entry| {
        json!({
            "target": entry.target.name(),
            "extension": entry.extension,
            "compiled": format!("*.{}", compile::file_ending(entry, "frag")),
            "summary": entry.about,
        })
    });
    ListTable { shown: &["target", "extension", "compiled", "summary"], things: things.collect() }
}

fn executor_table() -> ListTable {
    let things = executors::ALL.iter().map(
        |entry| json!({ "executor": entry.name, "needs": entry.needs, "draws": entry.samples.is_some(), "summary": entry.about }),
    );
    ListTable { shown: &["executor", "summary", "needs"], things: things.collect() }
}

/// A count as a number, or as text if it does not fit into 64 bits.
pub fn count_json(count: u128) -> Value {
    u64::try_from(count).map_or_else(|_| json!(count.to_string()), |count| json!(count))
}

/// A value of an axis as a boolean, a number or a string.
pub fn setting_json(setting: &Setting) -> Value {
    match setting {
        Setting::Bool(value) => json!(value),
        Setting::Int(value) => json!(value),
        Setting::Name(name) => json!(name),
    }
}

fn as_text(table: &ListTable) -> String {
    let rows: Vec<Vec<String>> = table
        .things
        .iter()
        .map(|thing| table.shown.iter().map(|key| cell_text(&thing[key])).collect())
        .collect();
    text::table_text(table.shown, &rows)
}

fn cell_text(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        Value::Array(values) => values.iter().map(cell_text).collect::<Vec<_>>().join(" "),
        other => other.to_string(),
    }
}

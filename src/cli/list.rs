//! `lamplight list [WHAT]`: tables of what there is.

use std::io::{Write, stdout};

use clap::{Args, ValueEnum};
use serde_json::{Value, json};

use super::failure::Failure;
use crate::catalogue::{self, Item};
use crate::emit::targets;
use crate::harness::executors;
use crate::project;

/// List what the library and the tools offer.
#[derive(Args)]
pub struct Arguments {
    /// What to list.
    #[arg(value_enum, default_value_t)]
    what: What,
    /// As a JSON array of objects.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Default, ValueEnum)]
enum What {
    Modules,
    #[default]
    Functions,
    Programs,
    Axes,
    Targets,
    Executors,
}

/// A table: its columns, and a row of texts for each thing.
struct Table {
    columns: &'static [&'static str],
    rows: Vec<Vec<String>>,
}

pub fn run(arguments: Arguments) -> Result<(), Failure> {
    let table = match arguments.what {
        What::Modules => modules(),
        What::Functions => functions(),
        What::Programs => programs()?,
        What::Axes => axes()?,
        What::Targets => targets(),
        What::Executors => executors(),
    };
    let text = if arguments.json { as_json(&table) } else { as_text(&table) };
    Ok(stdout().write_all(text.as_bytes())?)
}

fn modules() -> Table {
    let rows = catalogue::library().into_iter().map(|module| vec![module.path, module.items.len().to_string(), module.summary]);
    Table { columns: &["module", "items", "summary"], rows: rows.collect() }
}

fn functions() -> Table {
    let rows = catalogue::library().into_iter().flat_map(|module| module.items).filter(|item| item.kind == catalogue::Kind::Function);
    Table { columns: &["function", "summary"], rows: rows.map(|item: Item| vec![item.path(), item.summary().to_owned()]).collect() }
}

fn programs() -> Result<Table, Failure> {
    let rows = manifest()?.programs.into_iter().map(|program| {
        let targets: Vec<&str> = program.targets.iter().map(|target| target.name()).collect();
        vec![program.name.clone(), program.space.axes().len().to_string(), targets.join(" "), program.doc.clone().unwrap_or_default()]
    });
    Ok(Table { columns: &["program", "axes", "targets", "summary"], rows: rows.collect() })
}

fn axes() -> Result<Table, Failure> {
    let mut rows = Vec::new();
    for program in manifest()?.programs {
        for axis in program.space.axes() {
            let default = axis.values[axis.default].to_string();
            let cells = [program.name.clone(), axis.name.clone(), axis.mode.name().to_owned(), default, axis.value_names().join(" ")];
            rows.push(cells.into_iter().chain([axis.doc.clone().unwrap_or_default()]).collect());
        }
    }
    Ok(Table { columns: &["program", "axis", "mode", "default", "values", "summary"], rows })
}

fn manifest() -> Result<crate::permute::Manifest, Failure> {
    let library = project::library_manifest();
    library.map(|(_, manifest)| manifest).map_err(|(sources, diagnostics)| Failure::Input(sources, diagnostics))
}

fn targets() -> Table {
    let rows = targets::ALL.iter().map(|entry| vec![entry.target.name().to_owned(), entry.extension.to_owned(), entry.about.to_owned()]);
    Table { columns: &["target", "extension", "summary"], rows: rows.collect() }
}

fn executors() -> Table {
    let rows = executors::ALL.iter().map(|entry| vec![entry.name.to_owned(), entry.needs.join(" "), entry.about.to_owned()]);
    Table { columns: &["executor", "needs", "summary"], rows: rows.collect() }
}

fn as_json(table: &Table) -> String {
    let row = |row: &Vec<String>| table.columns.iter().zip(row).map(|(column, cell)| ((*column).to_owned(), json!(cell))).collect();
    let rows: Vec<Value> = table.rows.iter().map(|cells| Value::Object(row(cells))).collect();
    format!("{:#}\n", Value::Array(rows))
}

fn as_text(table: &Table) -> String {
    let width =
        |column: usize| table.rows.iter().map(|row| row[column].chars().count()).chain([table.columns[column].len()]).max().unwrap_or(0);
    let widths: Vec<usize> = (0..table.columns.len()).map(width).collect();
    let line = |cells: Vec<&str>| {
        let padded = cells.iter().zip(&widths).map(|(cell, width)| format!("{cell:width$}"));
        padded.collect::<Vec<_>>().join("  ").trim_end().to_owned() + "\n"
    };
    std::iter::once(table.columns.to_vec()).chain(table.rows.iter().map(|row| row.iter().map(String::as_str).collect())).map(line).collect()
}

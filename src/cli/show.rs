//! `lamplight show PATH`: everything about one module, function or struct of the library.

use std::io::{Write, stdout};

use clap::Args;

use super::failure::Failure;
use crate::catalogue::{self, Item, Module, SECTIONS};
use crate::diagnostic::nearest;
use crate::project::LIBRARY;

/// Show a function's documentation, signatures, source and error model.
#[derive(Args)]
pub struct Arguments {
    /// `brdf::specular::blinn_phong`, or a module: `brdf::specular`.
    path: String,
}

pub fn run(arguments: Arguments) -> Result<(), Failure> {
    let path = arguments.path.strip_prefix(LIBRARY).and_then(|rest| rest.strip_prefix("::")).unwrap_or(&arguments.path);
    let modules = catalogue::library();
    if let Some(item) = modules.iter().flat_map(|module| &module.items).find(|item| item.path() == path) {
        return show_item(item);
    }
    match modules.iter().find(|module| module.path == path) {
        Some(module) => show_module(module),
        None => Err(missing(path, &modules)),
    }
}

fn missing(path: &str, modules: &[Module]) -> Failure {
    let items: Vec<String> = modules.iter().flat_map(|module| module.items.iter().map(Item::path)).collect();
    let known = items.iter().map(String::as_str).chain(modules.iter().map(|module| module.path.as_str()));
    let same_name = items.iter().find(|item| item.rsplit("::").next() == path.rsplit("::").next()).map(String::as_str);
    let hint = same_name.or_else(|| nearest(path, known)).map_or(String::new(), |near| format!("; did you mean `{near}`?"));
    Failure::input(format!("the library has no `{path}`{hint}"))
}

fn show_item(item: &Item) -> Result<(), Failure> {
    let mut out = stdout().lock();
    writeln!(out, "{LIBRARY}::{}\n", item.path())?;
    for line in item.doc.iter().take_while(|line| !SECTIONS.iter().any(|section| line.starts_with(&format!("{section}:")))) {
        writeln!(out, "{}", format!("  {line}").trim_end())?;
    }
    for section in SECTIONS {
        if let Some(text) = item.section(section) {
            writeln!(out, "\n{section}\n  {text}")?;
        }
    }
    writeln!(out, "\nWESL\n{}\n  import {LIBRARY}::{};", indent(&item.wesl), item.path())?;
    if let Some(glsl) = &item.glsl {
        writeln!(out, "\nGLSL\n{}\n  #include <{LIBRARY}/{}.glsl>", indent(glsl), item.module.replace("::", "/"))?;
    }
    Ok(())
}

fn show_module(module: &Module) -> Result<(), Failure> {
    let mut out = stdout().lock();
    writeln!(out, "{LIBRARY}::{}\n\n  {}\n", module.path, module.summary)?;
    for item in &module.items {
        writeln!(out, "{}\n      {}", indent(&item.wesl), item.summary())?;
    }
    Ok(())
}

fn indent(text: &str) -> String {
    text.lines().map(|line| format!("  {line}")).collect::<Vec<_>>().join("\n")
}

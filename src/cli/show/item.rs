//! Modules and their items.

use serde_json::{Value, json};

use super::ShownItem;
use crate::catalogue::{
    CatalogueItem, CatalogueItemKind, CatalogueMember, CatalogueModule, SECTIONS,
};
use crate::cli::text::{indent_lines, rows_text, wrap_words};
use crate::project::LIBRARY;

/// A function, a struct or a constant.
pub fn show_item(item: &CatalogueItem) -> ShownItem {
    ShownItem { text: item_text(item), json: item_json(item) }
}

/// A module with its items.
pub fn show_module(module: &CatalogueModule) -> ShownItem {
    let items = module.items.iter().map(item_json).collect::<Vec<_>>();
    let json = json!({ "module": module.path, "doc": module.doc, "items": items });
    ShownItem { text: module_text(module), json }
}

fn item_text(item: &CatalogueItem) -> String {
    let mut text = format!("{}\n", item.full_path());
    for paragraph in item.paragraphs() {
        text += &format!("\n{}", wrap_words(&paragraph, 2));
    }
    if item.members.iter().any(|member| !member.doc.is_empty()) {
        let heading = if item.kind == CatalogueItemKind::Struct { "Fields" } else { "Parameters" };
        text += &format!(
            "\n{heading}\n{}",
            rows_text(&item.members.iter().map(member_row).collect::<Vec<_>>(), 2)
        );
    }
    for section in SECTIONS.iter().skip(1) {
        if let Some(words) = item.section(section) {
            text += &format!("\n{section}\n{}", wrap_words(&words, 2));
        }
    }
    text += &format!("\nWESL\n{}  {}\n", indent_lines(&item.wesl, 2), item.import());
    if let Some(glsl) = &item.glsl {
        text += &format!("\nGLSL\n{}  {}\n", indent_lines(glsl, 2), item.include());
    }
    text
}

fn member_row(member: &CatalogueMember) -> Vec<String> {
    vec![member.name.clone(), member.ty.clone(), member.doc.clone()]
}

fn item_json(item: &CatalogueItem) -> Value {
    let members = item
        .members
        .iter()
        .map(|member| json!({ "name": member.name, "type": member.ty, "doc": member.doc }))
        .collect::<Vec<_>>();
    json!({
        item.kind.name(): item.path(),
        "doc": item.paragraphs(),
        if item.kind == CatalogueItemKind::Struct { "fields" } else { "parameters" }: members,
        "result": item.result,
        "returns": item.section("Returns"),
        "source": item.section("Source"),
        "edges": item.section("Edges"),
        "error_model": item.section("Error model"),
        "wesl": item.wesl,
        "glsl": item.glsl,
        "import": item.import(),
        "include": item.include(),
    })
}

fn module_text(module: &CatalogueModule) -> String {
    let path = match module.package.as_str() {
        LIBRARY => format!("{LIBRARY}::{}", module.path),
        _ => module.path.clone(),
    };
    let mut text = format!("{path}\n");
    for paragraph in &module.doc {
        text += &format!("\n{}", wrap_words(paragraph, 2));
    }
    for item in &module.items {
        let signature = item.wesl.lines().next().unwrap_or_default().trim_end_matches(['{', ' ']);
        text += &format!("\n{}{}", wrapped_code(signature), wrap_words(item.summary(), 6));
    }
    if let Some(item) = module.items.first() {
        text += &format!("\nWESL\n  import {path}::{{..}};\n\nGLSL\n  {}\n", item.include());
    }
    text
}

/// A signature, its later lines deeper than its first.
fn wrapped_code(code: &str) -> String {
    let text = wrap_words(code, 4);
    text.replacen("    ", "  ", 1)
}

//! The page of a module.

use std::fmt::Write as _;

use super::super::{CatalogueItem, CatalogueItemKind, CatalogueModule, SECTIONS};
use super::CatalogueContents;
use super::cost;
use super::markdown::{code_block, escaped_prose, table_cell};

/// The sections that are printed as paragraphs. The parameters are a table.
const PARAGRAPHS: std::ops::RangeFrom<usize> = 1..;

/// The page: the module's comment, a table of contents, every item.
pub fn module_page(module: &CatalogueModule, contents: &CatalogueContents) -> String {
    let mut text = format!("# {}\n", module.path);
    for paragraph in &module.doc {
        let _ = write!(text, "\n{}\n", escaped_prose(paragraph));
    }
    if let Some(item) = module.items.first() {
        let import = format!("import lamplight::{}::{{..}};", module.path);
        let _ =
            write!(text, "\n| WESL | GLSL |\n|---|---|\n| `{import}` | `{}` |\n", item.include());
    }
    write_contents(&mut text, module);
    for item in &module.items {
        write_item(&mut text, item, contents);
        cost::of_function(&mut text, item, contents.costs);
    }
    let up = "../".repeat(module.path.matches("::").count());
    let _ = write!(text, "\n---\n[Catalogue]({up}README.md)\n");
    text
}

fn write_contents(text: &mut String, module: &CatalogueModule) {
    text.push_str("\n| | |\n|---|---|\n");
    for item in &module.items {
        let kind = if item.kind == CatalogueItemKind::Function {
            String::new()
        } else {
            format!("{} ", item.kind.name())
        };
        let _ = writeln!(
            text,
            "| {kind}[`{}`](#{}) | {} |",
            item.name,
            item.name.to_lowercase(),
            table_cell(item.summary())
        );
    }
}

fn write_item(text: &mut String, item: &CatalogueItem, contents: &CatalogueContents) {
    let _ = write!(text, "\n## {}\n", escaped_prose(&item.name));
    for paragraph in item.paragraphs() {
        let _ = write!(text, "\n{}\n", escaped_prose(&paragraph));
    }
    let _ = write!(text, "\n{}", code_block("wgsl", &item.wesl));
    if let Some(glsl) = &item.glsl {
        let _ = write!(text, "\n{}", code_block("glsl", glsl));
    }
    write_pictures(text, item, contents);
    write_members(text, item);
    for section in &SECTIONS[PARAGRAPHS] {
        if let Some(words) = item.section(section) {
            let _ = write!(text, "\n**{section}.** {}\n", escaped_prose(&words));
        }
    }
}

/// The plot and the figure, each with what it shows.
fn write_pictures(text: &mut String, item: &CatalogueItem, contents: &CatalogueContents) {
    let (name, path) = (&item.name, item.path());
    let (_, module) = item.module.rsplit_once("::").unwrap_or(("", &item.module));
    if let Some(plot) = contents.plots.get(&path) {
        let caption = &plot.caption;
        let _ = write!(text, "\n![{name} plotted]({module}/{name}.svg)\n\nPlotted: {caption}\n");
    }
    let Some(figure) = contents.figures.get(&path) else { return };
    if let Some(reason) = &figure.none {
        let _ = write!(text, "\nNo picture: {}.\n", escaped_prose(reason));
    } else {
        let caption = figure.caption(contents.kinds);
        let _ = write!(text, "\n![{name} drawn]({module}/{name}.png)\n\n{caption}\n");
    }
}

fn write_members(text: &mut String, item: &CatalogueItem) {
    if item.members.is_empty() {
        return;
    }
    let heading = if item.kind == CatalogueItemKind::Struct { "field" } else { "parameter" };
    let _ = write!(text, "\n| {heading} | type | |\n|---|---|---|\n");
    for member in &item.members {
        let _ =
            writeln!(text, "| `{}` | `{}` | {} |", member.name, member.ty, table_cell(&member.doc));
    }
}

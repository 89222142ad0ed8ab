//! Writes the catalogue as Markdown: an index, a page for each module, one for programs, one for
//! presets.

pub mod cost;
mod markdown;
mod module;
mod preset;
mod program;

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::cost::Costs;
use super::figure::{Figures, Kinds};
use super::preset::Preset;
use super::probe::Probe;
use super::quality::Measured;
use super::{CatalogueItemKind, CatalogueModule};
use lamplight_permute::Manifest;
use markdown::{escaped_prose, table_cell};

/// A plot of a function.
pub struct DrawnPlot {
    pub svg: String,
    /// What is drawn, as Markdown.
    pub caption: String,
}

/// What the catalogue shows.
pub struct CatalogueContents<'c> {
    pub modules: &'c [CatalogueModule],
    /// By the path of the function: `lighting::spot::cone_hard`.
    pub plots: &'c BTreeMap<String, DrawnPlot>,
    pub kinds: &'c Kinds,
    /// By the path of the function; the pictures are drawn apart.
    pub figures: &'c Figures,
    pub manifest: &'c Manifest,
    pub presets: &'c [Preset],
    pub probes: &'c [Probe],
    pub costs: &'c Costs,
    pub quality: &'c [Measured],
}

/// The files of the catalogue: path below its folder and text.
pub fn catalogue_pages(contents: &CatalogueContents) -> BTreeMap<String, String> {
    let mut files = BTreeMap::from([
        ("README.md".to_owned(), index_page(contents)),
        ("programs.md".to_owned(), program::program_page(contents.manifest, contents.costs)),
        (
            "costs.md".to_owned(),
            cost::cost_page(contents.modules, contents.costs, contents.quality),
        ),
        ("presets.md".to_owned(), preset::preset_page(contents.presets, contents.probes)),
    ]);
    for module in contents.modules {
        files.insert(page_of(&module.path), module::module_page(module, contents));
    }
    for (path, plot) in contents.plots {
        files.insert(format!("{}.svg", path.replace("::", "/")), plot.svg.clone());
    }
    for measured in contents.quality {
        if let Some(svg) = cost::quality_picture(measured, contents.costs) {
            files.insert(cost::picture_path(measured), svg);
        }
    }
    files
}

/// Page of a module below the catalogue's folder.
fn page_of(module: &str) -> String {
    format!("{}.md", module.replace("::", "/"))
}

const INDEX: &str = "\
# Catalogue

Every module exists in WESL and in GLSL with the same functions, parameters and results. Import a
function in WESL, include its module in GLSL:

```wgsl
import lamplight::brdf::specular::blinn_phong;
```

```glsl
#include <lamplight/brdf/specular.glsl>
```

Vectors named `n`, `l`, `v` and `h` are unit vectors. `l` and `v` point away from the surface.
Colours are linear.
Visibility is a factor from 0 to 1, where 1 is fully lit. Attenuation is a factor of at least 0.
Depth is from 0 to 1, from near to far.

There are also pages of the [programs](programs.md) with their axes, of the [presets](presets.md),
one for each published example, and of the [costs](costs.md) of functions on GPUs, with pictures of
cost against quality.

`cargo xtask docs` generates this catalogue from the library.
";

fn index_page(contents: &CatalogueContents) -> String {
    let mut text = INDEX.to_owned();
    let mut folder = "";
    for module in contents.modules {
        let (here, _) = module.path.split_once("::").unwrap_or((&module.path, ""));
        if here != folder {
            let _ = writeln!(text, "\n## {here}\n\n| module | functions | |\n|---|---|---|");
            folder = here;
        }
        let link = format!("[`{}`]({})", module.path, page_of(&module.path));
        let functions = module.items.iter().filter(|item| item.kind == CatalogueItemKind::Function);
        let names: Vec<String> = functions
            .map(|item| {
                format!("[{}]({}#{})", escaped_prose(&item.name), page_of(&module.path), item.name)
            })
            .collect();
        let _ =
            writeln!(text, "| {link} | {} | {} |", names.join(", "), table_cell(module.summary()));
    }
    text
}

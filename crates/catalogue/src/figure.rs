//! Figures: small pictures that a function of the library draws itself, such as a lit ball or a
//! falloff on a wall.
//!
//! `figures.toml` has the kinds, and explains their form. `NAME.figure.toml` beside a module has
//! the figures of its functions:
//!
//! ```toml
//! [wrap]                                            # a function of the module
//! kind = "ball"                                     # of `figures.toml`
//! value = "wrap(n, l, w)"                           # WGSL over the variables of the kind
//! panels = { name = "w", values = [0, 0.5, 1] }     # one for each; one in all, without it
//! note = "w moves the edge of the light"            # what to look for
//!
//! [inverse3]
//! none = "a matrix has no look"                     # why there is no figure
//! ```

use std::collections::BTreeMap;

use serde::Deserialize;

use super::plot::Curves;
use super::reader;
use lamplight_diagnostic::source::{Embedded, SourceSet};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};

/// Path of the kinds below the library's root.
const KINDS: &str = "figures.toml";

/// The picture of a function.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Figure {
    #[serde(default)]
    pub kind: String,
    /// A WGSL expression over the variables of the kind and the panels' name.
    #[serde(default)]
    pub value: String,
    pub panels: Option<Curves>,
    pub note: Option<String>,
    /// Instead of all else, why there is no picture.
    pub none: Option<String>,
}

/// What a function is drawn on.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Kind")]
pub struct FigureKind {
    /// What is seen, as the start of a sentence.
    pub about: String,
    /// WGSL with a function `shown`. In it, `VALUE` stands for the value of a figure.
    pub code: String,
    #[serde(default)]
    pub textures: Textures,
}

/// What `shown` takes before the place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Textures {
    #[default]
    None,
    /// `map`, `smp`, `depths` and `depths_smp`: the shadow map of a fence.
    Depth,
    /// `cube` and `smp`: the shadow map of a point light.
    Cube,
    /// `map` and `smp`: a picture.
    Image,
}

/// The kinds, by name.
pub type Kinds = BTreeMap<String, FigureKind>;

/// The figures of a module, by function.
pub type Figures = BTreeMap<String, Figure>;

/// The library's kinds.
///
/// # Errors
/// Those of the file.
pub fn library_kinds(library: Embedded, sources: &mut SourceSet) -> Result<Kinds, Diagnostics> {
    reader::read_own(library, sources, KINDS)
}

/// The figures of all modules, by the path of the function.
///
/// # Errors
/// Those of the files; a function or a kind that does not exist; a figure with neither a kind nor a
/// reason, or with both.
pub fn library_figures(
    library: Embedded,
    sources: &mut SourceSet,
    modules: &[super::CatalogueModule],
    kinds: &Kinds,
) -> Result<Figures, Diagnostics> {
    let mut all = Figures::new();
    for module in modules {
        let file = figure_path(&module.path);
        let figures: Figures = reader::find_own(library, sources, &file)?.unwrap_or_default();
        for (name, figure) in figures {
            let refused = |reason: String| {
                let message = format!("`{name}` in `{file}` {reason}");
                Err(vec![Diagnostic::error(codes::DATA_SYNTAX, message)])
            };
            let is_function = |item: &super::CatalogueItem| {
                item.name == name && item.kind == super::CatalogueItemKind::Function
            };
            if !module.items.iter().any(is_function) {
                return refused("is not a function of the module".to_owned());
            }
            let is_drawn = !figure.kind.is_empty() && !figure.value.is_empty();
            let is_empty = figure.kind.is_empty() && figure.value.is_empty();
            if figure.none.is_some() != is_empty || is_drawn == is_empty {
                return refused("needs either a `kind` with a `value`, or `none`".to_owned());
            }
            if is_drawn && !kinds.contains_key(&figure.kind) {
                return refused(format!("has the kind `{}`, which does not exist", figure.kind));
            }
            all.insert(format!("{}::{name}", module.path), figure);
        }
    }
    Ok(all)
}

/// The path of a module's figures: `lighting/spot.figure.toml` for `lighting::spot`.
pub fn figure_path(module: &str) -> String {
    format!("{}.figure.toml", module.replace("::", "/"))
}

/// The path of a figure below the catalogue's folder: `lighting/spot/cone_hard.png`.
pub fn picture_path(function: &str) -> String {
    format!("{}.png", function.replace("::", "/"))
}

impl Figure {
    /// What is drawn, as Markdown.
    pub fn caption(&self, kinds: &Kinds) -> String {
        let about = kinds.get(&self.kind).map_or("", |kind| &kind.about);
        let panels = self.panels.as_ref().map_or(String::new(), |panels| {
            let labels: Vec<String> = (0..panels.values.len()).map(|at| panels.label(at)).collect();
            format!(", for `{}` = {}", panels.name, labels.join(", "))
        });
        let note = self.note.as_ref().map_or(String::new(), |note| format!(" {note}"));
        format!("{about}: `{}`{panels}.{note}", self.value)
    }

    /// The second parameter in each panel; 0 without one.
    pub fn panel_values(&self) -> Vec<f64> {
        self.panels.as_ref().map_or(vec![0.0], |panels| panels.values.clone())
    }
}

//! Reads comparisons from `comparisons.toml` of the library, which explains its own format.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use toml::Spanned;

use lamplight_catalogue::preset::PresetNumber;
use lamplight_catalogue::reader;
use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::{Embedded, SourceSet, Span};
use lamplight_scenes::sets;

/// Path below the library.
const PATH: &str = "comparisons.toml";

/// One thing, drawn in several ways.
#[derive(Debug, Clone, Serialize)]
pub struct Comparison {
    pub name: String,
    pub doc: String,
    /// What to look for in the picture.
    pub look: String,
    /// The scene that panels with a key draw.
    pub scene: String,
    /// WGSL that stands before the values of panels without a key.
    pub code: String,
    /// The upper left corner of the part that is enlarged, as shares of a panel.
    pub inset: [f64; 2],
    /// The smallest share of pixels that must differ visibly between neighbouring panels.
    pub differs: f64,
    pub panels: Vec<Panel>,
}

/// One way to draw it: a panel of the picture.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Panel {
    pub label: String,
    /// A permutation of `forward`.
    #[serde(default)]
    pub key: String,
    #[serde(default = "default_one")]
    pub cascades: u32,
    /// Numbers that replace those of the scene, by group and field, as in a preset.
    #[serde(default)]
    pub numbers: BTreeMap<String, BTreeMap<String, PresetNumber>>,
    /// Instead of a key, a WGSL expression for the colour at `at`, which goes from (-4/3, -1) to
    /// (4/3, 1).
    pub value: Option<String>,
}

fn default_one() -> u32 {
    1
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Entry")]
struct ComparisonEntry {
    doc: String,
    look: String,
    #[serde(default)]
    scene: Option<Spanned<String>>,
    #[serde(default)]
    code: String,
    inset: [f64; 2],
    differs: f64,
    panels: Vec<Panel>,
}

/// The library's comparisons, by name.
///
/// # Errors
/// Those of the file.
pub fn library_comparisons(
    library: Embedded,
    sources: &mut SourceSet,
) -> Result<Vec<Comparison>, Diagnostics> {
    let id = reader::add_own(library, sources, PATH)?;
    let entries: BTreeMap<String, ComparisonEntry> = reader::read_data(sources, id)?;
    let mut problems = Vec::new();
    let comparison = |(name, entry): (String, ComparisonEntry)| {
        if let Some(scene) = &entry.scene
            && !sets::ALL.iter().any(|set| set.name == scene.get_ref())
        {
            let message = format!("there is no scene `{}`", scene.get_ref());
            problems.push(reader::invalid_data(Span::new(id, scene.span()), message));
        }
        let ComparisonEntry { doc, look, scene, code, inset, differs, panels } = entry;
        let scene = scene.map_or_else(String::new, Spanned::into_inner);
        Comparison { name, doc, look, scene, code, inset, differs, panels }
    };
    let comparisons = entries.into_iter().map(comparison).collect();
    if problems.is_empty() { Ok(comparisons) } else { Err(problems) }
}

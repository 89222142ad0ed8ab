//! Ways to compute the same thing, with their errors and costs: `quality.toml`, which explains its
//! form. The package `check` computes the errors; the costs are recorded in `costs.toml`.

use serde::Deserialize;

use super::cost::FIGURES;
use super::reader;
use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::{Embedded, SourceSet};

/// Path of the file below the library's root.
pub const PATH: &str = "quality.toml";

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "File")]
struct QualityFile {
    group: Vec<QualityGroup>,
}

/// Functions that are compared with each other.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Group")]
pub struct QualityGroup {
    pub name: String,
    pub title: String,
    pub doc: String,
    /// What the error is.
    pub label: String,
    /// Whether the error is in percent of the exact value.
    #[serde(default)]
    pub relative: bool,
    /// Whether the expressions read a depth map with an edge in it.
    #[serde(default)]
    pub edge: bool,
    /// The reference for entries without one of their own.
    pub reference: Option<QualityReference>,
    /// Paths below the library's root, with lists in braces.
    pub imports: Vec<String>,
    pub setup: String,
    pub x: Samples,
    pub y: Samples,
    pub entries: Vec<QualityEntry>,
}

/// One way to compute it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Entry")]
pub struct QualityEntry {
    pub name: String,
    /// The path of the function in question.
    pub function: String,
    pub taps: Option<u32>,
    pub value: String,
    pub exact: Option<String>,
    pub reference: Option<QualityReference>,
}

/// What is computed in f64.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case", rename = "Reference")]
pub enum QualityReference {
    /// The mean of 1,024 comparisons over a disk of 4 texels.
    #[serde(rename = "disk_1024")]
    Disk,
    /// The albedo of a white lobe of GGX, `x` the cosine and `y` the roughness.
    GgxAlbedo,
}

/// Evenly spaced numbers.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Samples {
    pub from: f64,
    pub to: f64,
    pub count: u32,
}

impl Samples {
    pub fn values(self) -> impl Iterator<Item = f64> {
        let step = (self.to - self.from) / f64::from(self.count.max(2) - 1);
        (0..self.count).map(move |index| self.from + step * f64::from(index))
    }
}

impl QualityGroup {
    /// The key of an entry's figures among the recorded costs.
    pub fn key(&self, entry: &QualityEntry) -> String {
        format!("{}: {}", self.name, entry.name)
    }
}

/// A group with the errors of its entries, in their order.
pub struct Measured {
    pub group: QualityGroup,
    pub errors: Vec<f64>,
}

/// An entry with its error and its figures.
pub type QualityRow<'m> = (&'m QualityEntry, f64, &'m [i64; FIGURES.len()]);

pub fn library_groups(
    library: Embedded,
    sources: &mut SourceSet,
) -> Result<Vec<QualityGroup>, Diagnostics> {
    reader::read_own::<QualityFile>(library, sources, PATH).map(|file| file.group)
}

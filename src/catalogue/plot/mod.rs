//! Plots of the library's functions: what to draw, read from `NAME.plot.toml` beside a module.
//!
//! ```toml
//! [cone_exponent]                              # a function of the module
//! value = "cone_exponent(x, 0.5, e)"           # WGSL over `x`, and over the curves' name
//! x = { label = "c", from = -1, to = 1 }       # the main parameter
//! y = { from = 0, to = 1 }                     # fitted to the values, where it is left out
//! curves = { name = "e", values = [1, 8, 64] } # one curve for each; one in all, without it
//! note = "cutoff 0.5"                          # what was fixed
//! ```
//!
//! Functions of the module are called by name, others by their path from the library's root.
//! The values come from outside: `draw` takes them as curves and returns an SVG.

mod scale;
mod scatter;
mod svg;

pub use scatter::draw_scatter;
pub use svg::draw_plot;

use std::collections::BTreeMap;

use serde::Deserialize;

use super::reader;
use crate::diagnostic::Diagnostics;
use crate::source::{SourceId, SourceSet};

/// Points at which a curve is computed.
pub const SAMPLES: usize = 321;

/// One plot.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plot {
    /// A WGSL expression of type f32 over `x` and the curves' name.
    pub value: String,
    pub x: Axis,
    pub y: Option<Range>,
    pub curves: Option<Curves>,
    /// What the expression keeps fixed.
    pub note: Option<String>,
}

/// The horizontal axis.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// What is at it, with its unit.
    pub label: String,
    pub from: f64,
    pub to: f64,
}

/// The bounds of the vertical axis.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Range {
    pub from: f64,
    pub to: f64,
}

/// A second parameter.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Curves {
    /// A parameter of the expression.
    pub name: String,
    pub values: Vec<f64>,
}

impl Plot {
    /// The main parameter at each sample, from the left.
    pub fn inputs(&self) -> impl Iterator<Item = f64> {
        let (from, to) = (self.x.from, self.x.to);
        (0..SAMPLES).map(move |index| from + (to - from) * index as f64 / (SAMPLES - 1) as f64)
    }
}

/// The plots of a module, by function.
pub type Plots = BTreeMap<String, Plot>;

/// Reads a file of plots that is in the set.
pub fn parse_plots(sources: &SourceSet, id: SourceId) -> Result<Plots, Diagnostics> {
    reader::read_data(sources, id)
}

/// The path of a module's plots: `lighting/spot.plot.toml` for `lighting::spot`.
pub fn plot_path(module: &str) -> String {
    format!("{}.plot.toml", module.replace("::", "/"))
}

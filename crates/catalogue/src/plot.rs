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
//! `x`, `y` and `curves` may have a `unit`: `degrees`, or `integers` for `x`, whose values are
//! drawn as stems. `labels` of `curves` stand for their values; curves that are called red, green
//! and blue have these colours.
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
use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::{SourceId, SourceSet};

/// Points at which a curve over a continuous parameter is computed.
pub const SAMPLES: usize = 321;

/// The unit of the numbers on an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase", rename = "Unit")]
pub enum AxisUnit {
    #[default]
    Numbers,
    Degrees,
    /// Whole numbers, with nothing between them.
    Integers,
}

impl AxisUnit {
    /// One word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Numbers => "numbers",
            Self::Degrees => "degrees",
            Self::Integers => "integers",
        }
    }
}

/// One plot.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plot {
    /// A WGSL expression of type f32 over `x` and the curves' name.
    pub value: String,
    pub x: PlotAxis,
    pub y: Option<Range>,
    pub curves: Option<Curves>,
    /// What the expression keeps fixed.
    pub note: Option<String>,
}

/// The horizontal axis.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Axis")]
pub struct PlotAxis {
    /// The text beside the axis, with the unit unless `unit` gives it.
    pub label: String,
    pub from: f64,
    pub to: f64,
    #[serde(default)]
    pub unit: AxisUnit,
}

/// The bounds of the vertical axis.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Range {
    pub from: f64,
    pub to: f64,
    #[serde(default)]
    pub unit: AxisUnit,
}

/// A second parameter, with one curve for each of its values.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Curves {
    /// A parameter of the expression.
    pub name: String,
    pub values: Vec<f64>,
    #[serde(default)]
    pub unit: AxisUnit,
    /// Words for the values, in their order.
    #[serde(default)]
    pub labels: Vec<String>,
}

impl Curves {
    /// What a curve is called.
    pub fn label(&self, index: usize) -> String {
        let value = || scale::tick_label(*self.values.get(index)?, self.unit).into();
        self.labels.get(index).cloned().or_else(value).unwrap_or_default()
    }
}

impl PlotAxis {
    /// How many values it has, including both ends.
    fn samples(&self) -> usize {
        match self.unit {
            AxisUnit::Integers => (self.to - self.from).max(1.0) as usize + 1,
            AxisUnit::Numbers | AxisUnit::Degrees => SAMPLES,
        }
    }
}

impl Plot {
    /// The main parameter at each sample, from the left.
    pub fn inputs(&self) -> impl Iterator<Item = f64> {
        let (from, to, samples) = (self.x.from, self.x.to, self.x.samples());
        (0..samples).map(move |index| from + (to - from) * index as f64 / (samples - 1) as f64)
    }

    /// What is drawn, as Markdown: the expression, and what its variables are.
    pub fn caption(&self) -> String {
        let curves = self.curves.as_ref().map_or(String::new(), |curves| {
            let labels: Vec<String> = (0..curves.values.len()).map(|at| curves.label(at)).collect();
            format!(", for `{}` = {}", curves.name, labels.join(", "))
        });
        format!("`{}` over `x`{curves}", self.value)
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

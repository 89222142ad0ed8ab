//! Recorded costs of functions and of the values of axes, from `costs.toml`. `cargo xtask docs
//! --costs` measures and writes that of the library, `lamplight variants --cost --record` that of
//! another package; [`super::pages`] shows them.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::Deserialize;

use super::reader;
use lamplight_bundle::Stage;
use lamplight_compose::project::library_package;
use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::{self, Embedded, Package, SourceSet};

/// Path of the record below the library's root.
pub const PATH: &str = "costs.toml";

/// Headings of a function's figures, in the order of [`Costs::functions`].
pub const FIGURES: [&str; 7] =
    ["cycles", "at least", "transcendental", "textures", "VGPRs", "instructions", "open loops"];

/// The index of the figure by which functions are sorted.
pub const SORTED_BY: usize = 0;

/// The GPU that tables show if they have room for only one.
pub const SHOWN: &str = "navi21";

/// Everything that is recorded.
#[derive(Debug, Clone, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Costs {
    /// The driver that compiled. Figures of another version are not comparable.
    pub driver: String,
    /// The GPUs, in the order of each function's rows.
    pub gpus: Vec<Chip>,
    /// By path: for each GPU the [`FIGURES`] that the function adds to a fragment stage.
    pub functions: BTreeMap<String, Vec<[i64; FIGURES.len()]>>,
    /// What values of axes change on [`SHOWN`].
    #[serde(default)]
    pub axes: Vec<AxisCost>,
    /// The figures of expressions on [`SHOWN`], by the keys of [`super::quality`].
    #[serde(default)]
    pub expressions: BTreeMap<String, [i64; FIGURES.len()]>,
}

#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Chip {
    /// What Mesa calls it.
    pub name: String,
    pub generation: String,
}

/// What one value of an axis changes in a stage, against the axis's default.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AxisCost {
    pub program: String,
    pub axis: String,
    pub value: String,
    pub stage: Stage,
    /// Pairs of permutations that differ only in the axis.
    pub pairs: usize,
    /// The change of the cycles of vector instructions: the smallest, the median, and the largest.
    pub cycles: [i64; 3],
    /// The median change of the reads of textures.
    pub texture: i64,
    /// The median change of the number of instructions.
    pub instructions: i64,
    /// The median change.
    pub vgprs: i64,
    /// Waves on a SIMD with the default and with the value, of the median pair.
    pub waves: [i64; 2],
}

impl Costs {
    /// The index of the GPU [`SHOWN`] in rows.
    pub fn shown(&self) -> Option<usize> {
        self.gpus.iter().position(|gpu| gpu.name == SHOWN)
    }

    /// The text of the record, which names the command that wrote it: a line for each function and
    /// each value.
    pub fn text(&self, command: &str) -> String {
        let mut text = format!(
            "# What functions and axes cost. Measured by `{command}`: not edited by hand.\n\n\
             driver = {}\ngpus = [\n",
            toml_string(&self.driver)
        );
        for Chip { name, generation } in &self.gpus {
            let (name, generation) = (toml_string(name), toml_string(generation));
            let _ = writeln!(text, "    {{ name = {name}, generation = {generation} }},");
        }
        let _ = write!(text, "]\naxes = [\n");
        for axis in &self.axes {
            let _ = writeln!(text, "    {{ {} }},", axis.fields());
        }
        let _ = write!(text, "]\n\n# For each GPU: {}.\n[functions]\n", FIGURES.join(", "));
        for (path, rows) in &self.functions {
            let _ = writeln!(text, "{} = {rows:?}", toml_string(path));
        }
        if !self.expressions.is_empty() {
            let _ = write!(
                text,
                "\n# The same of expressions in `quality.toml`, on `{SHOWN}`.\n[expressions]\n"
            );
        }
        for (key, row) in &self.expressions {
            let _ = writeln!(text, "{} = {row:?}", toml_string(key));
        }
        text
    }
}

impl AxisCost {
    fn fields(&self) -> String {
        let Self { pairs, cycles, texture, instructions, vgprs, waves, .. } = self;
        let stage = self.stage.name();
        format!(
            "program = {}, axis = {}, value = {}, stage = {}, pairs = {pairs}, \
             cycles = {cycles:?}, texture = {texture}, instructions = {instructions}, \
             vgprs = {vgprs}, waves = {waves:?}",
            toml_string(&self.program),
            toml_string(&self.axis),
            toml_string(&self.value),
            toml_string(stage),
        )
    }
}

fn toml_string(text: &str) -> String {
    toml::Value::from(text).to_string()
}

/// Whether a file that begins like this is such a record.
pub fn is_record(head: &[u8]) -> bool {
    head.starts_with(b"# What functions and axes cost.")
}

/// The library's record; empty if there is none.
pub fn library_costs(library: Embedded, sources: &mut SourceSet) -> Result<Costs, Diagnostics> {
    package_costs(sources, &library_package(library))
}

/// The record of a package; empty if there is none.
pub fn package_costs(sources: &mut SourceSet, package: &Package) -> Result<Costs, Diagnostics> {
    match source::read(sources, package, PATH).map_err(|error| vec![error.into()])? {
        Some(id) => reader::read_data(sources, id),
        None => Ok(Costs::default()),
    }
}

//! Tells how many permutations a program has and why: the counts after each step, and what each
//! axis costs.

use std::fmt;

use serde::{Serialize, Serializer};

use super::axis::{Axis, Mode};
use super::space::Space;

/// The report of one program. Displays as text; serialises as data.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PermutationReport {
    /// Name of the program.
    pub program: String,
    /// Points of the full product.
    pub full: Count,
    /// Points that satisfy the constraints.
    pub valid: Count,
    /// Points that the lists want: the permutations.
    pub wanted: Count,
    /// Distinct compositions of each stage, once something was composed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stages: Option<Vec<StageCount>>,
    /// Distinct composed texts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unique_sources: Option<u64>,
    /// Distinct output files.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unique_outputs: Option<u64>,
    /// By name.
    pub axes: Vec<AxisReport>,
    /// Spec axes of a program that has a GLSL source: GLSL is composed for each of their values.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub static_in_glsl: Vec<String>,
}

/// Distinct compositions of one stage or entry point.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct StageCount {
    /// Name of the stage or entry point.
    pub stage: String,
    /// How many distinct compositions it has.
    pub unique: u64,
    /// Axes that never change it.
    pub unread: Vec<String>,
}

/// What one axis does to the number of permutations.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AxisReport {
    /// Name of the axis.
    pub name: String,
    /// What its values are.
    pub kind: &'static str,
    /// How they reach the shader.
    pub mode: &'static str,
    /// How many there are.
    pub values: usize,
    /// Values that occur in a valid permutation.
    pub valid_values: usize,
    /// Permutations left if the axis did not exist; absent where that is too hard to count.
    pub without: Option<Count>,
    /// Permutations divided by `without`.
    pub factor: Option<f64>,
}

/// A number of points. Beyond 64 bits it serialises as a string; `u128::MAX` means "at least".
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Count(pub u128);

/// Counts a program's space.
pub fn report(program: &str, space: &Space) -> PermutationReport {
    let wanted = space.count();
    let valid = space.valid_values();
    let axes = space.axes().iter().enumerate();
    PermutationReport {
        program: program.to_owned(),
        full: Count(space.full_count()),
        valid: Count(space.valid_count()),
        wanted: Count(wanted),
        stages: None,
        unique_sources: None,
        unique_outputs: None,
        axes: axes
            .map(|(index, axis)| {
                axis_cost(axis, valid[index].len(), wanted, space.count_without(index).ok())
            })
            .collect(),
        static_in_glsl: Vec::new(),
    }
}

fn axis_cost(axis: &Axis, valid_values: usize, wanted: u128, without: Option<u128>) -> AxisReport {
    AxisReport {
        name: axis.name.clone(),
        kind: axis.kind.name(),
        mode: axis.mode.name(),
        values: axis.values.len(),
        valid_values,
        without: without.map(Count),
        factor: without
            .map(|without| if without == 0 { 1.0 } else { wanted as f64 / without as f64 }),
    }
}

impl PermutationReport {
    /// The counts that are known, largest first.
    fn funnel(&self) -> Vec<(String, Count)> {
        let row = |name: &str, count: Count| (name.to_owned(), count);
        let mut rows = vec![
            row("full space", self.full),
            row("after constraints", self.valid),
            row("after lists", self.wanted),
        ];
        rows.extend(
            self.stages.iter().flatten().map(|stage| {
                row(&format!("unique in {}", stage.stage), Count(stage.unique.into()))
            }),
        );
        rows.extend(self.unique_sources.map(|count| row("unique sources", Count(count.into()))));
        rows.extend(self.unique_outputs.map(|count| row("unique outputs", Count(count.into()))));
        rows
    }
}

impl fmt::Display for PermutationReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "program {}", self.program)?;
        let funnel =
            self.funnel().into_iter().map(|(name, count)| vec![name, count.to_string()]).collect();
        write_table(f, &[Align::Left, Align::Right], funnel)?;
        for stage in self.stages.iter().flatten().filter(|stage| !stage.unread.is_empty()) {
            writeln!(f, "  {} does not read {}", stage.stage, stage.unread.join(", "))?;
        }
        if self.axes.is_empty() {
            return Ok(());
        }
        writeln!(f)?;
        let heading =
            ["axis", "kind", "mode", "values", "without it", "costs"].map(str::to_owned).to_vec();
        let rows = std::iter::once(heading).chain(self.axes.iter().map(AxisReport::row)).collect();
        write_table(
            f,
            &[Align::Left, Align::Left, Align::Left, Align::Right, Align::Right, Align::Right],
            rows,
        )?;
        match self.static_in_glsl.as_slice() {
            [] => Ok(()),
            names => writeln!(
                f,
                "  static in GLSL, which is composed for each value: {}",
                names.join(", ")
            ),
        }
    }
}

impl AxisReport {
    fn row(&self) -> Vec<String> {
        let values = if self.valid_values == self.values || self.mode == Mode::Dynamic.name() {
            self.values.to_string()
        } else {
            format!("{} of {}", self.valid_values, self.values)
        };
        let without = self.without.map_or("?".to_owned(), |count| count.to_string());
        let factor = self.factor.map_or("?".to_owned(), |factor| format!("x{factor:.2}"));
        vec![self.name.clone(), self.kind.to_owned(), self.mode.to_owned(), values, without, factor]
    }
}

#[derive(Debug, Clone, Copy)]
enum Align {
    Left,
    Right,
}

/// Rows of cells in columns as wide as their widest cell, indented by two.
fn write_table(
    f: &mut fmt::Formatter<'_>,
    columns: &[Align],
    rows: Vec<Vec<String>>,
) -> fmt::Result {
    let width = |column: usize| rows.iter().map(|row| row[column].len()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns.len()).map(width).collect();
    for row in &rows {
        let cells =
            row.iter().zip(columns).zip(&widths).map(|((cell, align), width)| match align {
                Align::Left => format!("{cell:<width$}"),
                Align::Right => format!("{cell:>width$}"),
            });
        writeln!(f, "  {}", cells.collect::<Vec<_>>().join("  ").trim_end())?;
    }
    Ok(())
}

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 == u128::MAX {
            return f.write_str("over 3.4e38");
        }
        let digits = self.0.to_string();
        let first = (digits.len() - 1) % 3 + 1;
        f.write_str(&digits[..first])?;
        (first..digits.len()).step_by(3).try_for_each(|at| write!(f, ",{}", &digits[at..at + 3]))
    }
}

impl Serialize for Count {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match u64::try_from(self.0) {
            Ok(count) => serializer.serialize_u64(count),
            Err(_) => serializer.serialize_str(&self.0.to_string()),
        }
    }
}

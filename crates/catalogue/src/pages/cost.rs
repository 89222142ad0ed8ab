//! Writes what functions and axes cost: a table for each function, a page of sorted tables, and a
//! table for each program.

use std::cmp::Reverse;
use std::fmt::Write as _;

use super::super::cost::{AxisCost, Costs, FIGURES, SHOWN, SORTED_BY};
use super::super::plot::draw_scatter;
use super::super::quality::{Measured, QualityEntry, QualityRow};
use super::super::{CatalogueItem, CatalogueModule};
use super::page_of;
use crate::pages::table_cell;

const HEAD: &str = "\
# Costs

The tables say what each function adds to a fragment stage. They are the figures of one vendor's
compiler: Mesa's driver for AMD GPUs. The arguments of the function are inputs, so the compiler knows
nothing about them. Cycles are those in which vector instructions issue, counted in the machine code
along the dearest path; `at least` is the cheapest path. `transcendental` is the part of the cycles
for roots, powers and sines, `textures` the reads of textures. Loops run as often as the code says; a
loop of unknown length, which `open loops` counts, runs once. Use the figures to compare functions on
one GPU; they do not predict milliseconds. `lamplight cost` measures the same, also for your own
shaders. The page *Cost on GPUs* of the guide explains the columns.
";

/// The table of one function: a column for each GPU.
pub fn of_function(text: &mut String, item: &CatalogueItem, costs: &Costs) {
    let Some(rows) = costs.functions.get(&item.path()) else { return };
    let headings: Vec<String> =
        costs.gpus.iter().map(|gpu| format!("{} ({})", gpu.name, gpu.generation)).collect();
    let _ = write!(
        text,
        "\n**Cost.** What the function adds to a fragment stage, by AMD GPU, compiled by {}:\n\n| | {} |\n|---|{}\n",
        costs.driver,
        headings.join(" | "),
        "---:|".repeat(headings.len())
    );
    for (index, figure) in FIGURES.iter().enumerate() {
        let values: Vec<String> = rows.iter().map(|row| row[index].to_string()).collect();
        let _ = writeln!(text, "| {figure} | {} |", values.join(" | "));
    }
}

/// The page: the functions of each module, the most expensive first.
pub fn cost_page(modules: &[CatalogueModule], costs: &Costs, quality: &[Measured]) -> String {
    let mut text = HEAD.to_owned();
    let Some(shown) = costs.shown() else { return text };
    let generation = &costs.gpus[shown].generation;
    let _ = write!(
        text,
        "\nThe figures here are those of `{SHOWN}` ({generation}), {}.\n",
        costs.driver
    );
    for measured in quality {
        write_quality(&mut text, measured, costs);
    }
    for module in modules {
        let mut rows: Vec<(&CatalogueItem, &[i64; FIGURES.len()])> = module
            .items
            .iter()
            .filter_map(|item| Some((item, costs.functions.get(&item.path())?.get(shown)?)))
            .collect();
        if rows.is_empty() {
            continue;
        }
        rows.sort_by_key(|(item, row)| (Reverse(row[SORTED_BY]), &item.name));
        let _ = write!(
            text,
            "\n## {}\n\n{}\n\n| function | {} |\n|---|{}\n",
            module.path,
            table_cell(module.summary()),
            FIGURES.join(" | "),
            "---:|".repeat(FIGURES.len())
        );
        for (item, row) in rows {
            let values = row.map(|value| value.to_string()).join(" | ");
            let link = format!("[`{}`]({}#{})", item.name, page_of(&module.path), item.name);
            let _ = writeln!(text, "| {link} | {values} |");
        }
    }
    text.push_str("\n---\n[Catalogue](README.md)\n");
    text
}

/// The entries whose cost is recorded, the cheapest first.
fn quality_rows<'m>(measured: &'m Measured, costs: &'m Costs) -> Vec<QualityRow<'m>> {
    let group = &measured.group;
    let row = |(entry, error): (&'m QualityEntry, &f64)| {
        Some((entry, *error, costs.expressions.get(&group.key(entry))?))
    };
    let mut rows: Vec<QualityRow<'_>> =
        group.entries.iter().zip(&measured.errors).filter_map(row).collect();
    rows.sort_by_key(|(entry, _, figures)| (figures[SORTED_BY], &entry.name));
    rows
}

/// Where the picture of a group is, below the catalogue's folder.
pub fn picture_path(measured: &Measured) -> String {
    format!("costs/{}.svg", measured.group.name)
}

/// The picture of a group: cost against error.
pub fn quality_picture(measured: &Measured, costs: &Costs) -> Option<String> {
    let rows = quality_rows(measured, costs);
    let point = |(entry, error, figures): &QualityRow<'_>| {
        (entry.name.clone(), figures[SORTED_BY] as f64, *error)
    };
    let points: Vec<(String, f64, f64)> = rows.iter().map(point).collect();
    let cost = format!("cycles of vector instructions on {SHOWN}");
    let group = &measured.group;
    (!points.is_empty()).then(|| draw_scatter(&group.title, [&cost, &group.label], &points))
}

/// A group: its picture, and its table sorted by cost.
fn write_quality(text: &mut String, measured: &Measured, costs: &Costs) {
    let (group, rows) = (&measured.group, quality_rows(measured, costs));
    if rows.is_empty() {
        return;
    }
    let has_taps = rows.iter().any(|(entry, ..)| entry.taps.is_some());
    let (taps, rule) = if has_taps { ("taps | ", "---:|") } else { ("", "") };
    let _ = write!(
        text,
        "\n## {title} by cost and quality\n\n{}\n\n![{title}: cost against error]({})\n\n\
         | | {taps}{} | {} |\n|---|{rule}{}---:|\n",
        group.doc,
        picture_path(measured),
        FIGURES.join(" | "),
        group.label,
        "---:|".repeat(FIGURES.len()),
        title = group.title,
    );
    for (entry, error, figures) in rows {
        let taps = entry.taps.map_or(String::new(), |taps| format!("{taps} | "));
        let (module, function) = entry.function.rsplit_once("::").unwrap_or_default();
        let link = format!("[{}]({}#{function})", entry.name, page_of(module));
        let values = figures.map(|value| value.to_string()).join(" | ");
        let _ = writeln!(text, "| {link} | {taps}{values} | {error:.3} |");
    }
}

/// What the values of a program's axes change.
pub fn of_program(text: &mut String, program: &str, costs: &Costs) {
    let rows: Vec<&AxisCost> =
        costs.axes.iter().filter(|row| row.program == program && !row.is_free()).collect();
    if rows.is_empty() {
        return;
    }
    let _ = write!(
        text,
        "\nHow each value changes a stage on `{SHOWN}`, compared with the default of its axis: the median over all\n\
         pairs of permutations that differ in that axis alone, and the range of the cycles, by {}.\n\
         Loops over lamps run for all lamps that the axis `max_lights` allows. Values that change\n\
         nothing are left out.\n\n",
        costs.driver
    );
    write_changes(text, &rows);
}

/// What the values of one axis change: a paragraph and a table, or that they change nothing.
/// Nothing where this was not measured.
pub fn of_axis(program: &str, axis: &str, costs: &Costs) -> Option<String> {
    let measured = costs.axes.iter().filter(|row| row.program == program && row.axis == axis);
    let (free, rows): (Vec<&AxisCost>, Vec<&AxisCost>) = measured.partition(|row| row.is_free());
    if rows.is_empty() {
        let words = format!("Its values cost nothing on `{SHOWN}`, by {}.\n", costs.driver);
        return (!free.is_empty()).then_some(words);
    }
    let mut text = format!(
        "What its values change on `{SHOWN}`, compared with the default, by {}. The other values \
         cost nothing.\n\n",
        costs.driver
    );
    write_changes(&mut text, &rows);
    Some(text)
}

fn write_changes(text: &mut String, rows: &[&AxisCost]) {
    let _ = write!(
        text,
        "| axis and value | stage | pairs | cycles | range | textures | instructions | VGPRs | waves |\n\
         |---|---|---:|---:|---:|---:|---:|---:|---:|\n"
    );
    for row in rows {
        let AxisCost { axis, value, pairs, cycles, texture, instructions, vgprs, waves, .. } = row;
        let stage = row.stage.name();
        let [least, median, most] = cycles;
        let [before, after] = waves;
        let _ = writeln!(
            text,
            "| `{axis}={value}` | {stage} | {pairs} | {median:+} | {least:+} to {most:+} | {texture:+} | \
             {instructions:+} | {vgprs:+} | {before} to {after} |"
        );
    }
}

impl AxisCost {
    /// Whether no pair shows a difference.
    fn is_free(&self) -> bool {
        let Self { cycles, texture, instructions, vgprs, .. } = self;
        *cycles == [0; 3] && (*texture, *instructions, *vgprs) == (0, 0, 0)
    }
}

//! The page of the white furnace: tables of numbers, and what they say.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::{ANGLES, CASES, Cell, Place, ROUGHNESS, places};

const HEAD: &str = "\
# The white furnace of `forward` with `metallic_roughness`

Light of radiance 1 comes from everywhere, and the base colour is white. A surface that neither loses
nor makes light then has the colour 1. The first number of a cell is for light of lamps, summed up
over all directions. The second one is for ambient light. Angles are those of the viewer to the
normal. The evaluator ran the fragment stage of `forward` once for each direction of the light. The
test `energy::white_furnace` computes a part of the cells again, and explains how. With four times as
many directions, no cell changed by more than 0.004.

Ambient light is conserved, since each layer takes from those below it what it reflects on average.
Only a film on a dielectric loses some: the largest channel of its reflectance is taken from what is
below in every channel. For lamps, metals and what a coat adds are conserved up to the error of the
fit `dfg_approx`, and brushed metals up to that of taking the albedo of an isotropic surface that is
as rough. The other deviations are those of glTF's formulas. A dielectric scatters `1 - max(F)` of
the light, with `F` at the half vector, which is too much if the viewer sees it at a grazing angle.
Sheen takes the larger albedo of the light and the viewer from what is below, and `v_neubelt` makes
light at grazing angles. The lobe that passes a rough sheet loses what is scattered more than once.

";

/// The page with these cells.
pub fn written(cells: &BTreeMap<Place, Cell>) -> String {
    let mut text = HEAD.to_owned();
    for (case, layers) in CASES.iter().enumerate() {
        let name = if layers.axes.is_empty() { "metallic_roughness" } else { layers.axes };
        write!(text, "## {name}\n\n{}.\n\n", capital(layers.about)).expect("a string");
        for metal in [false, true] {
            let own: BTreeMap<&Place, &Cell> =
                cells.iter().filter(|(place, _)| (place.0, place.1) == (case, metal)).collect();
            if !own.is_empty() {
                text += &table(metal, &own);
            }
        }
    }
    text.trim_end().to_owned() + "\n"
}

fn capital(text: &str) -> String {
    let (first, rest) = text.split_at(1);
    first.to_uppercase() + rest
}

fn table(metal: bool, cells: &BTreeMap<&Place, &Cell>) -> String {
    let base = if metal { "metal" } else { "dielectric" };
    let angles: String = ANGLES.iter().map(|angle| format!(" {angle}° |")).collect();
    let mut text = format!("| {base}, roughness |{angles}\n|---|{}\n", "---|".repeat(ANGLES.len()));
    for (row, roughness) in ROUGHNESS.iter().enumerate() {
        write!(text, "| {roughness:.1} |").expect("a string");
        for (_, cell) in cells.iter().filter(|(place, _)| place.2 == row) {
            write!(text, " {:.3}, {:.3} |", cell.lamps, cell.ambient).expect("a string");
        }
        text += "\n";
    }
    let lamps: Vec<f64> = cells.values().map(|cell| cell.lamps).collect();
    let ambient: Vec<f64> = cells.values().map(|cell| cell.ambient).collect();
    let verdicts = [verdict("lamps", &lamps), verdict("ambient light", &ambient)];
    format!("{text}\nLight of {}; {}.\n\n", verdicts[0], verdicts[1])
}

/// In how many cells the reflected radiance is 1 within 1 %, and the range of all cells if it is
/// not in every one.
fn verdict(kind: &str, values: &[f64]) -> String {
    // As the page shows them, so that the page can be made from its own numbers.
    let shown: Vec<f64> = values.iter().map(|value| (value * 1000.0).round() / 1000.0).collect();
    let within = shown.iter().filter(|value| (**value - 1.0).abs() < 0.0105).count();
    if within == shown.len() {
        return format!("{kind}: 1 within 1 % in all {within} cells");
    }
    let least = shown.iter().copied().fold(f64::MAX, f64::min);
    let most = shown.iter().copied().fold(f64::MIN, f64::max);
    format!(
        "{kind}: 1 within 1 % in {within} of {} cells, from {least:.3} to {most:.3}",
        shown.len()
    )
}

/// The cells of a page, in the order of its tables.
pub fn read_cells(text: &str) -> Result<BTreeMap<Place, Cell>, String> {
    let pairs = text
        .lines()
        .filter(|line| {
            line.starts_with("| ") && line.as_bytes().get(2).is_some_and(u8::is_ascii_digit)
        })
        .flat_map(|line| line.split('|').skip(2).filter(|cell| !cell.trim().is_empty()));
    let cell = |text: &str| {
        let (lamps, ambient) = text.trim().split_once(", ")?;
        Some(Cell { lamps: lamps.parse().ok()?, ambient: ambient.parse().ok()? })
    };
    let read: Option<Vec<Cell>> = pairs.map(cell).collect();
    let (read, places) = (read.ok_or("a cell has no two numbers")?, places());
    match read.len() == places.len() {
        true => Ok(places.into_iter().zip(read).collect()),
        false => Err(format!("the page has {} cells, expected {}", read.len(), places.len())),
    }
}

//! Draws comparisons: one thing drawn in several ways, side by side, with a part enlarged.
//!
//! `comparisons.toml -> panels -> one picture`

mod entry;
mod label;
pub(super) mod painted;

pub use entry::{Comparison, Panel, library_comparisons};
pub use painted::paint_expression;

use super::pixels::Picture;
use super::plan::Plan;
use super::{Shot, prepare_passes};
use crate::frame::Programs;
use lamplight_diagnostic::Diagnostics;
use lamplight_execute::Session;

/// A panel is drawn this many times larger than it is shown. Its inset is shown at the size at
/// which it was drawn.
pub const ZOOM: u32 = 3;
/// Panels in a row. More would be too narrow on a page to read their labels.
const ACROSS: u32 = 4;
/// Pixels between panels, and the height of a label.
const GAP: u32 = 6;
const LABEL: u32 = 28;
/// Pixels to the left and right of a label's words.
const MARGIN: u32 = 6;
/// The colour of the background.
const GROUND: [u8; 3] = [24, 26, 30];
/// The colour of the frame around the part that is enlarged.
const FRAME: [u8; 3] = [255, 208, 64];

/// Draws one panel at its large size.
///
/// # Errors
/// Those of compositions and of the painter.
pub fn draw_panel(
    painter: &mut dyn Session,
    programs: &Programs,
    comparison: &Comparison,
    panel: &Panel,
    shot: &Shot,
) -> Result<Picture, Diagnostics> {
    if let Some(value) = &panel.value {
        return Ok(
            paint_expression(programs.library(), painter, &comparison.code, value, shot)?.develop()
        );
    }
    let plan = panel_plan(programs, comparison, panel)?;
    let shot = Shot { cascades: panel.cascades, ..shot.clone() };
    Ok(prepare_passes(painter, programs, &plan, &shot)?.photograph(painter, &shot)?.develop())
}

/// The passes and numbers of a panel that is drawn with a permutation.
///
/// # Errors
/// A key that the program does not have.
pub fn panel_plan(
    programs: &Programs,
    comparison: &Comparison,
    panel: &Panel,
) -> Result<Plan, Diagnostics> {
    let plan = Plan::of_key(programs, "forward", &panel.key)?;
    Ok(Plan { scene: comparison.scene.clone(), numbers: panel.numbers.clone(), ..plan })
}

/// All panels in rows, each with its label above and a part of it enlarged below.
///
/// # Errors
/// Those of its panels.
pub fn draw_strip(
    painter: &mut dyn Session,
    programs: &Programs,
    comparison: &Comparison,
    shot: &Shot,
) -> Result<Picture, Diagnostics> {
    let panels = comparison.panels.iter();
    let large: Vec<Picture> = panels
        .map(|one| draw_panel(painter, programs, comparison, one, shot))
        .collect::<Result<_, _>>()?;
    let [width, height] = shot.size.map(|side| side / ZOOM);
    let count = large.len() as u32;
    // As many rows as are needed, and the panels spread evenly over them.
    let rows = count.div_ceil(ACROSS).max(1);
    let across = count.div_ceil(rows);
    let tall = LABEL + 2 * height + GAP;
    let extent = |count: u32, side: u32| count * side + count.saturating_sub(1) * GAP;
    let mut strip = Picture::filled(extent(across, width), extent(rows, tall), GROUND);
    let inset = [0, 1].map(|axis| {
        let free = shot.size[axis] - shot.size[axis] / ZOOM;
        ((comparison.inset[axis] * f64::from(shot.size[axis])) as u32).min(free)
    });
    for (index, (picture, panel)) in (0..).zip(large.iter().zip(&comparison.panels)) {
        let (left, top) = (index % across * (width + GAP), index / across * (tall + GAP));
        let mut small = picture.shrunk(ZOOM);
        small.outline(inset.map(|at| at / ZOOM), [width / ZOOM, height / ZOOM], FRAME);
        label::write_label(&mut strip, &panel.label, [left + MARGIN, top + 4], width - 2 * MARGIN);
        strip.place(&small, [left, top + LABEL]);
        strip.place(&picture.part(inset, [width, height]), [left, top + LABEL + height + GAP]);
    }
    Ok(strip)
}

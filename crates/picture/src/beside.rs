//! Draws an example as it is printed, beside its safe form and the difference of the two.

use crate::Shot;
use crate::frame::Programs;
use crate::passes::prepare_passes;
use crate::pixels::Picture;
use crate::plan::Plan;
use crate::strip::{GAP, GROUND, LABEL, MARGIN, write_label};
use lamplight_catalogue::preset::Preset;
use lamplight_catalogue::probe::Probe;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_execute::Session;

/// What stands above the panels.
const LABELS: [&str; 3] = ["as printed", "safe form", "difference"];

/// Three panels of the shot's size: the preset, its safe form, and how far the codes of a display
/// are from each other, channel by channel.
///
/// # Errors
/// The preset has no safe form; those of compositions and of the painter.
pub fn draw_beside(
    painter: &dyn Session,
    programs: &Programs,
    preset: &Preset,
    probes: &[Probe],
    shot: &Shot,
) -> Result<Picture, Diagnostics> {
    let safe = preset.safe_form().ok_or_else(|| {
        let message = format!("`{}` has no safe form to draw beside it", preset.name);
        let note = "help: presets with a field `safe` have one, such as `oglpg_7_6`";
        vec![Diagnostic::error(codes::PICTURE_INVALID, message).note(note)]
    })?;
    let drawn = |preset: &Preset| {
        let plan = Plan::of_preset(programs, preset, probes)?;
        Ok::<_, Diagnostics>(
            prepare_passes(painter, programs, &plan, shot)?.photograph(painter, shot)?.develop(),
        )
    };
    let (printed, safe) = (drawn(preset)?, drawn(&safe)?);
    let panels = [&printed, &safe, &difference(&printed, &safe)];
    let [width, height] = shot.size;
    let count = panels.len() as u32;
    let mut strip = Picture::filled(count * width + (count - 1) * GAP, LABEL + height, GROUND);
    for (index, (panel, label)) in (0..).zip(panels.into_iter().zip(LABELS)) {
        let left = index * (width + GAP);
        write_label(&mut strip, label, [left + MARGIN, 4], width.saturating_sub(2 * MARGIN));
        strip.place(panel, [left, LABEL]);
    }
    Ok(strip)
}

/// How far the codes of two pictures of one size are from each other.
fn difference(one: &Picture, other: &Picture) -> Picture {
    let pixels = one.pixels.iter().zip(&other.pixels).map(|(a, b)| a.abs_diff(*b)).collect();
    Picture { pixels, ..*one }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_have_no_sign() {
        let picture = |pixels: Vec<u8>| Picture { width: 1, height: 1, pixels };
        let (one, other) = (picture(vec![10, 200, 7]), picture(vec![20, 150, 7]));
        assert_eq!(difference(&one, &other).pixels, [10, 50, 0]);
        assert_eq!(difference(&other, &one), difference(&one, &other));
    }
}

//! Surfaces that are blended by their alpha over what is behind them. Each is drawn into frames of its own,
//! and each pixel sorts them by their depths. Of several triangles of one object that face the same way, a
//! pixel has the nearest.

use glam::{DVec3, Vec3};

use super::prepared::PreparedPass;
use lamplight_diagnostic::Diagnostics;
use lamplight_execute::Session;
use lamplight_execute::frame::{Buffers, DrawItem, Frame};

/// The most frames of blended surfaces. With more surfaces, several are drawn into one.
const MOST: usize = 64;

/// The frames of a pass for some views, and those of each blended surface.
pub struct Slice<'p> {
    pass: &'p PreparedPass,
    frames: Vec<Frame>,
    layers: Vec<Vec<Frame>>,
}

impl<'p> Slice<'p> {
    /// Draws a pass.
    ///
    /// # Errors
    /// The painter's.
    pub fn draw(
        pass: &'p PreparedPass,
        painter: &dyn Session,
        views: &[Buffers],
        size: [u32; 2],
    ) -> Result<Self, Diagnostics> {
        let frames = pass.draw_colors(painter, views, size, 0)?;
        let mut layers = Vec::new();
        if let Some(blended) = &pass.blended {
            let items: Vec<DrawItem<'_>> = blended.items().collect();
            let count = items.len().min(MOST);
            for first in 0..count {
                let own: Vec<DrawItem<'_>> =
                    items.iter().skip(first).step_by(MOST).copied().collect();
                layers.push(blended.draw_colors_of(&own, painter, views, size)?);
            }
        }
        Ok(Self { pass, frames, layers })
    }

    /// How many frames are drawn for each view.
    pub fn frames_of(pass: &PreparedPass) -> usize {
        1 + pass.blended.as_ref().map_or(0, |blended| blended.items.len().min(MOST))
    }

    /// The colour of a pixel of a view over what is behind this slice; `None` where nothing was drawn.
    fn color(
        &self,
        view: usize,
        pixel: usize,
        behind: Option<DVec3>,
        background: &dyn Fn() -> DVec3,
    ) -> Option<DVec3> {
        let rgb = |[r, g, b, _]: [f32; 4]| Vec3::new(r, g, b).as_dvec3();
        let frame = self.frames.get(view)?;
        let own = self.pass.color(frame, pixel);
        let depth = |frame: &Frame| frame.depth.get(pixel).copied().unwrap_or(1.0);
        let nearest = if own.is_some() { depth(frame) } else { f32::INFINITY };
        let mut over: Vec<(f32, [f32; 4])> = Vec::new();
        for frame in self.layers.iter().filter_map(|frames| frames.get(view)) {
            let seen = self.pass.color(frame, pixel).filter(|_| depth(frame) < nearest);
            over.extend(seen.map(|color| (depth(frame), color)));
        }
        over.sort_by(|one, other| other.0.total_cmp(&one.0));
        let start = own.map(rgb).or(behind);
        over.into_iter().fold(start, |below, (_, color)| {
            let share = f64::from(color[3]).clamp(0.0, 1.0);
            Some(below.unwrap_or_else(background).lerp(rgb(color), share))
        })
    }
}

/// The colour of a pixel of a view, of slices from the nearest to the farthest.
pub fn seen_color(
    slices: &[Slice<'_>],
    view: usize,
    pixel: usize,
    background: &dyn Fn() -> DVec3,
) -> Option<DVec3> {
    let farthest_first = slices.iter().rev();
    farthest_first.fold(None, |behind, slice| slice.color(view, pixel, behind, background))
}

//! Profiles and cookies of lamps, made by formulas.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3, DVec4};

use super::maps::TextureMap;

/// The intensity of a luminaire over that of its strongest direction: angles to the axis in
/// columns, from 0 to pi, and angles around it in rows, from 0 to 2 pi. Both ends of a range are
/// middles of texels.
pub fn luminaire() -> TextureMap {
    const SIDE: usize = 64;
    TextureMap::of(SIDE, |at| {
        let angle = (at * SIDE as f64 - 0.5) / (SIDE - 1) as f64;
        let (vertical, horizontal) = (angle.x * PI, angle.y * TAU);
        let lobe = |middle: f64, width: f64| (-((vertical - middle) / width).powi(2)).exp();
        // A narrow beam, a ring around it that louvres divide, and a glow to above.
        let rays = 0.55 + 0.45 * (6.0 * horizontal).cos();
        let light = lobe(0.0, 0.3) + 0.6 * rays * lobe(0.75, 0.14) + 0.3 * lobe(PI, 0.4);
        DVec3::splat(light.min(1.0)).extend(1.0)
    })
}

/// A window of twelve coloured panes with dark bars between them.
pub fn window() -> TextureMap {
    const PANES: DVec2 = DVec2::new(3.0, 4.0);
    TextureMap::of(256, |at| {
        let place = at * PANES;
        let pane = place.floor();
        // Distance from the next bar, in heights of a pane.
        let from_edge = DVec2::splat(0.5) - (place.fract() - 0.5).abs();
        let open = ((from_edge.x * PANES.y / PANES.x).min(from_edge.y) - 0.06) / 0.03;
        let turn = TAU * (0.29 * pane.x + 0.17 * pane.y);
        let tint = DVec3::new(turn.cos(), (turn - TAU / 3.0).cos(), (turn + TAU / 3.0).cos());
        ((0.58 + 0.42 * tint) * open.clamp(0.0, 1.0)).extend(1.0)
    })
}

/// The scale (xy) and the offset (zw) from coordinates in [0, 1] to those of a texture, so that
/// both ends are middles of texels.
pub fn between_middles(map: &TextureMap) -> DVec4 {
    let size = DVec2::new(map.width as f64, map.height as f64);
    let (scale, offset) = ((size - 1.0) / size, 0.5 / size);
    DVec4::new(scale.x, scale.y, offset.x, offset.y)
}

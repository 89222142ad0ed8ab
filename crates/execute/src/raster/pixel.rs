//! The fragments of one pixel, without running them.

use super::{
    CoveredQuad, Evaluated, Screen, Shading, assembled, bound_textures, item_buffers, middle,
    quad_pixels, wire_stages,
};
use crate::frame::{Buffers, Drawing};
use lamplight_diagnostic::Diagnostic;
use lamplight_eval::Resources;

/// A fragment that covers a pixel, as one of a quad.
#[derive(Debug, Clone)]
pub struct PixelFragment {
    /// The item of the drawing that it belongs to.
    pub item: usize,
    /// The scalars that the fragment stage is given for each fragment of the quad.
    pub arguments: [Vec<f32>; 4],
    /// Which of the four it is.
    pub lane: usize,
    /// What the fragment stage reads.
    pub resources: Resources,
    /// Its depth, by which nearer fragments hide others.
    pub depth: f32,
}

/// Four fragments of one triangle, of which at least one is visible.
#[derive(Debug, Clone)]
pub struct VisibleQuad {
    /// The item of the drawing that it belongs to.
    pub item: usize,
    /// Where its fragments are.
    pub pixels: [(u32, u32); 4],
    /// Which of them are visible.
    pub covered: [bool; 4],
    /// As in [`PixelFragment`].
    pub arguments: [Vec<f32>; 4],
}

/// Everything that a view shows, without running the fragment stage. So nothing is discarded, and
/// depths are those of the triangles.
#[derive(Debug, Clone, Default)]
pub struct VisibleFragments {
    /// In no order.
    pub quads: Vec<VisibleQuad>,
    /// What the fragment stage reads for each item of the drawing.
    pub resources: Vec<Resources>,
}

/// The visible fragments of a view.
///
/// # Errors
/// Those of the vertex stage.
pub fn visible_fragments(
    drawing: &Drawing<'_>,
    view: &Buffers,
) -> Result<VisibleFragments, Diagnostic> {
    let shading = Evaluated::new(drawing)?;
    let textures = bound_textures(drawing);
    let mut drawn = assembled(drawing, view, &shading, &textures)?;
    drawn.seen.draw(&drawn.triangles, drawing.state);
    let Some(taken) = shading.taken() else { return Ok(VisibleFragments::default()) };
    let wiring = wire_stages(&shading.given(), &taken);
    let screen = Screen { drawn: &drawn, size: drawing.size, wiring };
    let visible = screen.visible(drawing.items.len()).into_iter().flatten();
    let quads = visible.map(|quad| VisibleQuad {
        item: quad.triangle.item,
        pixels: quad.pixels,
        covered: quad.covered,
        arguments: screen.quad(&quad).arguments,
    });
    let resources = drawing
        .items
        .iter()
        .map(|item| Resources { buffers: item_buffers(drawing, view, item), ..textures.clone() });
    Ok(VisibleFragments { quads: quads.collect(), resources: resources.collect() })
}

/// The fragments that cover the middle of a pixel in a view. With the depth test the nearest one is
/// the first, otherwise the one that is drawn last.
///
/// # Errors
/// Those of the vertex stage.
pub fn fragments_at(
    drawing: &Drawing<'_>,
    view: &Buffers,
    [x, y]: [u32; 2],
) -> Result<Vec<PixelFragment>, Diagnostic> {
    let shading = Evaluated::new(drawing)?;
    let textures = bound_textures(drawing);
    let drawn = assembled(drawing, view, &shading, &textures)?;
    let Some(taken) = shading.taken() else { return Ok(Vec::new()) };
    let wiring = wire_stages(&shading.given(), &taken);
    let screen = Screen { drawn: &drawn, size: drawing.size, wiring };
    let place = (middle(x), middle(y));
    let covering = drawn.triangles.iter().filter(|one| one.covers(place.0, place.1));
    let mut found: Vec<_> = covering
        .map(|one| (one.depth(place.0, place.1, one.offset(drawing.state.offset)), one))
        .filter(|(depth, _)| !drawing.state.depth_test || *depth < 1.0)
        .collect();
    match drawing.state.depth_test {
        true => found.sort_by(|(one, _), (other, _)| one.total_cmp(other)),
        false => found.reverse(),
    }
    let lane = ((x & 1) + 2 * (y & 1)) as usize;
    let fragment = |(depth, triangle): (f32, _)| {
        let pixels = quad_pixels(x & !1, y & !1);
        let quad = CoveredQuad { triangle, pixels, covered: [true; 4] };
        let item = triangle.item;
        let buffers = item_buffers(drawing, view, &drawing.items[item]);
        let resources = Resources { buffers, ..textures.clone() };
        let arguments = screen.quad(&quad).arguments;
        PixelFragment { item, arguments, lane, resources, depth }
    };
    Ok(found.into_iter().map(fragment).collect())
}

//! Runs the fragment stage for visible fragments.

use naga::BuiltIn;
use rayon::prelude::*;

use super::corners::ScalarSource;
use super::triangles::{NONE, Triangle};
use super::{DrawnView, Quad, ShadedQuad, Shading, cleared_target, item_buffers};
use crate::diagnostic::Diagnostic;
use crate::eval::{Number, Resources};
use crate::execute::frame::{Buffers, Drawing};

/// How many quads are shaded at a time. This bounds the memory for the arguments of large frames.
const AT_ONCE: usize = 1 << 16;

/// The targets of a frame.
pub fn shade_frame(
    drawing: &Drawing<'_>,
    view: &Buffers,
    shading: &dyn Shading,
    drawn: &DrawnView,
    textures: &Resources,
) -> Result<Vec<Vec<u32>>, Diagnostic> {
    let Some(taken) = shading.taken() else { return Ok(Vec::new()) };
    let mut targets = vec![cleared_target(drawing.size); drawing.targets as usize];
    let wiring = wire_stages(&shading.given(), &taken);
    let screen = Screen { drawn, size: drawing.size, wiring };
    for (item, places) in drawing.items.iter().zip(screen.places(drawing.items.len())) {
        for places in places.chunks(AT_ONCE) {
            let quads: Vec<Quad> = places.par_iter().map(|place| screen.quad(place)).collect();
            let shaded = shading.shade(item_buffers(drawing, view, item), textures, &quads)?;
            for (quad, shaded) in quads.iter().zip(&shaded) {
                store_quad(&mut targets, drawing.size[0], quad, shaded);
            }
        }
    }
    Ok(targets)
}

/// The source of a scalar of the fragment stage.
#[derive(Debug, Clone, Copy)]
enum ScalarInput {
    /// A slot of the vertices, interpolated with correct perspective.
    Smooth(usize),
    /// A slot of the first vertex.
    Flat(usize),
    Position(usize),
    Front,
    Nothing,
}

fn wire_stages(given: &[(ScalarSource, bool)], taken: &[ScalarSource]) -> Vec<ScalarInput> {
    let wire = |source: &ScalarSource| match source {
        ScalarSource::Location(..) => match given.iter().position(|(other, _)| other == source) {
            Some(slot) if given[slot].1 => ScalarInput::Flat(slot),
            Some(slot) => ScalarInput::Smooth(slot),
            None => ScalarInput::Nothing,
        },
        ScalarSource::BuiltIn(BuiltIn::Position { .. }, component) => {
            ScalarInput::Position(*component)
        }
        ScalarSource::BuiltIn(BuiltIn::FrontFacing, _) => ScalarInput::Front,
        _ => ScalarInput::Nothing,
    };
    taken.iter().map(wire).collect()
}

/// What is visible, and how to look it up.
struct Screen<'a> {
    drawn: &'a DrawnView,
    size: [u32; 2],
    wiring: Vec<ScalarInput>,
}

/// A quad in which at least one pixel shows the triangle.
struct CoveredQuad<'a> {
    triangle: &'a Triangle,
    pixels: [(u32, u32); 4],
    covered: [bool; 4],
}

impl<'a> Screen<'a> {
    /// The quads of each item. Four pixels that show several triangles are one quad for each of
    /// these.
    fn places(&self, items: usize) -> Vec<Vec<CoveredQuad<'a>>> {
        let mut places: Vec<Vec<CoveredQuad<'a>>> = Vec::new();
        places.resize_with(items, Vec::new);
        let [columns, rows] = self.size.map(|size| (0..size).step_by(2));
        for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
            let pixels = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
            let shown = pixels.map(|(x, y)| self.shown(x, y));
            for lane in 0..4 {
                let id = shown[lane];
                let Some(triangle) = self.drawn.triangles.get(id as usize) else { continue };
                if shown[..lane].contains(&id) {
                    continue;
                }
                let covered = shown.map(|other| other == id);
                places[triangle.item].push(CoveredQuad { triangle, pixels, covered });
            }
        }
        places
    }

    fn quad(&self, place: &CoveredQuad<'_>) -> Quad {
        let middle = |x: u32| f64::from(x) + 0.5;
        let arguments =
            place.pixels.map(|(x, y)| self.arguments(place.triangle, middle(x), middle(y)));
        Quad { pixels: place.pixels, covered: place.covered, arguments }
    }

    fn shown(&self, x: u32, y: u32) -> u32 {
        let inside = x < self.size[0] && y < self.size[1];
        if inside { self.drawn.seen.triangle[(y * self.size[0] + x) as usize] } else { NONE }
    }

    fn arguments(&self, triangle: &Triangle, x: f64, y: f64) -> Vec<f32> {
        let (shares, depth, inverse_w) = triangle.at(x, y);
        let corners = &self.drawn.corners[triangle.item];
        let slot = |corner: u32, slot: usize| corners[corner as usize].slots[slot];
        let argument = |wire: &ScalarInput| match wire {
            ScalarInput::Smooth(index) => (0..3)
                .map(|corner| shares[corner] * f64::from(slot(triangle.corners[corner], *index)))
                .sum::<f64>() as f32,
            ScalarInput::Flat(index) => slot(triangle.first, *index),
            ScalarInput::Position(component) => [x, y, depth, inverse_w][*component & 3] as f32,
            ScalarInput::Front => f32::from_word(u32::from(triangle.front)),
            ScalarInput::Nothing => f32::from_word(0),
        };
        self.wiring.iter().map(argument).collect()
    }
}

/// Writes the results of fragments to their pixels.
fn store_quad(targets: &mut [Vec<u32>], width: u32, quad: &Quad, shaded: &ShadedQuad) {
    for lane in (0..4).filter(|lane| quad.covered[*lane]) {
        let (x, y) = quad.pixels[lane];
        let pixel = (y * width + x) as usize;
        for (target, words) in targets.iter_mut().zip(shaded[lane].iter().flatten()) {
            target[4 * pixel..4 * pixel + 4].copy_from_slice(words);
        }
    }
}

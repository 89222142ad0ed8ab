//! Runs the fragment stage for visible fragments.

use naga::BuiltIn;

use super::corners::Source;
use super::triangles::{NONE, Triangle};
use super::{Drawn, Quad, Shaded, Shading, cleared_target, item_buffers};
use crate::diagnostic::Diagnostic;
use crate::eval::{Number, Resources};
use crate::execute::frame::{Buffers, Drawing};

/// How many rows are shaded at a time, in whole quads. This bounds the memory for the arguments of
/// large frames.
const ROWS: u32 = 256;

/// The targets of a frame.
pub fn shade_frame(
    drawing: &Drawing<'_>,
    view: &Buffers,
    shading: &dyn Shading,
    drawn: &Drawn,
    textures: &Resources,
) -> Result<Vec<Vec<u32>>, Diagnostic> {
    let Some(taken) = shading.taken() else { return Ok(Vec::new()) };
    let mut targets = vec![cleared_target(drawing.size); drawing.targets as usize];
    let wiring = wire_stages(&shading.given(), &taken);
    let screen = Screen { drawn, size: drawing.size, wiring };
    for (index, item) in drawing.items.iter().enumerate() {
        for first in (0..drawing.size[1]).step_by(ROWS as usize) {
            let quads = screen.quads(index, first..drawing.size[1].min(first + ROWS));
            if quads.is_empty() {
                continue;
            }
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
enum Wire {
    /// A slot of the vertices, interpolated in perspective. A flat one is that of the first vertex.
    Smooth(usize),
    Flat(usize),
    Position(usize),
    Front,
    Nothing,
}

fn wire_stages(given: &[(Source, bool)], taken: &[Source]) -> Vec<Wire> {
    let wire = |source: &Source| match source {
        Source::Location(..) => match given.iter().position(|(other, _)| other == source) {
            Some(slot) if given[slot].1 => Wire::Flat(slot),
            Some(slot) => Wire::Smooth(slot),
            None => Wire::Nothing,
        },
        Source::BuiltIn(BuiltIn::Position { .. }, component) => Wire::Position(*component),
        Source::BuiltIn(BuiltIn::FrontFacing, _) => Wire::Front,
        _ => Wire::Nothing,
    };
    taken.iter().map(wire).collect()
}

/// What is visible, and how to look it up.
struct Screen<'a> {
    drawn: &'a Drawn,
    size: [u32; 2],
    wiring: Vec<Wire>,
}

impl Screen<'_> {
    /// The quads of some rows that show an item; each triangle in a quad is a quad of its own.
    fn quads(&self, item: usize, rows: std::ops::Range<u32>) -> Vec<Quad> {
        let mut quads = Vec::new();
        let places =
            rows.step_by(2).flat_map(|y| (0..self.size[0]).step_by(2).map(move |x| (x, y)));
        for (x, y) in places {
            let pixels = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
            let shown = pixels.map(|(x, y)| self.shown(x, y));
            for lane in 0..4 {
                let id = shown[lane];
                let triangle = self.drawn.triangles.get(id as usize);
                let Some(triangle) = triangle.filter(|triangle| triangle.item == item) else {
                    continue;
                };
                if shown[..lane].contains(&id) {
                    continue;
                }
                let arguments = pixels
                    .map(|(x, y)| self.arguments(triangle, f64::from(x) + 0.5, f64::from(y) + 0.5));
                quads.push(Quad { pixels, covered: shown.map(|other| other == id), arguments });
            }
        }
        quads
    }

    fn shown(&self, x: u32, y: u32) -> u32 {
        let inside = x < self.size[0] && y < self.size[1];
        if inside { self.drawn.seen.triangle[(y * self.size[0] + x) as usize] } else { NONE }
    }

    fn arguments(&self, triangle: &Triangle, x: f64, y: f64) -> Vec<f32> {
        let (shares, depth, inverse_w) = triangle.at(x, y);
        let corners = &self.drawn.corners[triangle.item];
        let slot = |corner: u32, slot: usize| corners[corner as usize].slots[slot];
        let argument = |wire: &Wire| match wire {
            Wire::Smooth(index) => (0..3)
                .map(|corner| shares[corner] * f64::from(slot(triangle.corners[corner], *index)))
                .sum::<f64>() as f32,
            Wire::Flat(index) => slot(triangle.first, *index),
            Wire::Position(component) => [x, y, depth, inverse_w][*component & 3] as f32,
            Wire::Front => f32::from_word(u32::from(triangle.front)),
            Wire::Nothing => f32::from_word(0),
        };
        self.wiring.iter().map(argument).collect()
    }
}

/// Writes the results of fragments to their pixels.
fn store_quad(targets: &mut [Vec<u32>], width: u32, quad: &Quad, shaded: &Shaded) {
    for lane in (0..4).filter(|lane| quad.covered[*lane]) {
        let (x, y) = quad.pixels[lane];
        let pixel = (y * width + x) as usize;
        for (target, words) in targets.iter_mut().zip(shaded[lane].iter().flatten()) {
            target[4 * pixel..4 * pixel + 4].copy_from_slice(words);
        }
    }
}

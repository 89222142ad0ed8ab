//! Runs the fragment stage.

use std::ops::Range;

use naga::BuiltIn;
use rayon::prelude::*;

use super::corners::ScalarSource;
use super::triangles::{NONE, Triangle};
use super::{DrawnView, FragmentOutput, Quad, Shading, cleared_target, item_buffers};
use crate::frame::{Buffers, Drawing};
use lamplight_diagnostic::Diagnostic;
use lamplight_eval::{Number, Resources};

/// How many quads are shaded at a time. This bounds the memory for the arguments of large frames.
const AT_ONCE: usize = 1 << 16;

/// Shades the fragments of a frame.
pub struct Shader<'a> {
    pub drawing: &'a Drawing<'a>,
    pub view: &'a Buffers,
    pub shading: &'a dyn Shading,
    /// The textures and the samplers.
    pub textures: &'a Resources,
}

/// The words of each target of a frame.
type Targets = Vec<Vec<u32>>;

impl Shader<'_> {
    /// The targets of a frame of which is known what each pixel shows.
    pub fn shade_visible(&self, drawn: &DrawnView) -> Result<Targets, Diagnostic> {
        let Some(screen) = self.screen(drawn) else { return Ok(Vec::new()) };
        let mut targets = self.cleared();
        for (item, places) in screen.visible(self.drawing.items.len()).into_iter().enumerate() {
            self.shade(&screen, item, places.into_iter(), |_, pixel, output| {
                store_output(&mut targets, self.index(pixel), output);
            })?;
        }
        Ok(targets)
    }

    /// The targets of a frame whose fragments are tested after they are shaded, and the depth of
    /// each pixel.
    pub fn shade_all(&self, drawn: &DrawnView) -> Result<(Targets, Vec<f32>), Diagnostic> {
        let mut depths = drawn.seen.depth.clone();
        let Some(screen) = self.screen(drawn) else { return Ok((Vec::new(), depths)) };
        let (mut targets, state) = (self.cleared(), self.drawing.state);
        for of_item in drawn.triangles.chunk_by(|one, next| one.item == next.item) {
            let places = of_item.iter().flat_map(|triangle| screen.covered(triangle));
            self.shade(&screen, of_item[0].item, places, |triangle, (x, y), output| {
                let own = || triangle.depth(middle(x), middle(y), triangle.offset(state.offset));
                let depth = output.depth.map_or_else(own, |depth| depth.clamp(0.0, 1.0));
                let index = self.index((x, y));
                if !state.depth_test || depth < depths[index] {
                    depths[index] = depth;
                    store_output(&mut targets, index, output);
                }
            })?;
        }
        Ok((targets, depths))
    }

    /// `None` if there is no fragment stage.
    fn screen<'d>(&self, drawn: &'d DrawnView) -> Option<Screen<'d>> {
        let wiring = wire_stages(&self.shading.given(), &self.shading.taken()?);
        Some(Screen { drawn, size: self.drawing.size, wiring })
    }

    fn cleared(&self) -> Targets {
        vec![cleared_target(self.drawing.size); self.drawing.targets as usize]
    }

    /// Shades quads of one item in order. Calls `store` for each covered pixel whose fragment was
    /// not discarded.
    fn shade<'d>(
        &self,
        screen: &Screen<'_>,
        item: usize,
        mut places: impl Iterator<Item = CoveredQuad<'d>>,
        mut store: impl FnMut(&Triangle, (u32, u32), &FragmentOutput),
    ) -> Result<(), Diagnostic> {
        loop {
            let some: Vec<CoveredQuad<'_>> = places.by_ref().take(AT_ONCE).collect();
            if some.is_empty() {
                return Ok(());
            }
            let quads: Vec<Quad> = some.par_iter().map(|place| screen.quad(place)).collect();
            let buffers = item_buffers(self.drawing, self.view, &self.drawing.items[item]);
            let shaded = self.shading.shade(buffers, self.textures, &quads)?;
            for (place, shaded) in some.iter().zip(&shaded) {
                for lane in (0..4).filter(|lane| place.covered[*lane]) {
                    if let Some(output) = &shaded[lane] {
                        store(place.triangle, place.pixels[lane], output);
                    }
                }
            }
        }
    }

    fn index(&self, (x, y): (u32, u32)) -> usize {
        (y * self.drawing.size[0] + x) as usize
    }
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

/// A quad in which at least one pixel is drawn with the triangle.
struct CoveredQuad<'a> {
    triangle: &'a Triangle,
    pixels: [(u32, u32); 4],
    /// Which of them are. The others are helper invocations.
    covered: [bool; 4],
}

impl<'a> Screen<'a> {
    /// The quads of each item. Four pixels that show several triangles are one quad for each of
    /// these.
    fn visible(&self, items: usize) -> Vec<Vec<CoveredQuad<'a>>> {
        let mut places: Vec<Vec<CoveredQuad<'a>>> = Vec::new();
        places.resize_with(items, Vec::new);
        let [columns, rows] = self.size.map(|size| (0..size).step_by(2));
        for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
            let pixels = quad_pixels(x, y);
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

    /// All quads of a triangle, visible or not.
    fn covered(&self, triangle: &'a Triangle) -> impl Iterator<Item = CoveredQuad<'a>> {
        let [width, height] = self.size;
        let [columns, rows] = triangle.bounds(self.size);
        let even = |range: Range<u32>| (range.start & !1..range.end).step_by(2);
        let corners = even(rows).flat_map(move |y| even(columns.clone()).map(move |x| (x, y)));
        corners.filter_map(move |(x, y)| {
            let pixels = quad_pixels(x, y);
            let covered = pixels
                .map(|(x, y)| x < width && y < height && triangle.covers(middle(x), middle(y)));
            covered.contains(&true).then_some(CoveredQuad { triangle, pixels, covered })
        })
    }

    fn quad(&self, place: &CoveredQuad<'_>) -> Quad {
        let arguments =
            place.pixels.map(|(x, y)| self.arguments(place.triangle, middle(x), middle(y)));
        Quad { arguments }
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

fn quad_pixels(x: u32, y: u32) -> [(u32, u32); 4] {
    [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)]
}

/// The middle of a pixel, along one axis.
fn middle(x: u32) -> f64 {
    f64::from(x) + 0.5
}

fn store_output(targets: &mut Targets, pixel: usize, output: &FragmentOutput) {
    for (target, words) in targets.iter_mut().zip(&output.targets) {
        target[4 * pixel..4 * pixel + 4].copy_from_slice(words);
    }
}

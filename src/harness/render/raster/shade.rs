//! The fragment stage, for what is visible.

use naga::{Binding, BuiltIn};
use rayon::prelude::*;

use super::super::super::interpreter::failed;
use super::corners::{Source, sources};
use super::triangles::{NONE, Triangle};
use super::{Drawn, Lowered, buffers, cleared};
use crate::diagnostic::Diagnostic;
use crate::eval::{Function, Kind, Machine, Number, Resources};
use crate::harness::frame::{Buffers, Drawing};

/// Rows that one thread takes at a time: whole quads.
const ROWS: u32 = 8;

/// The targets of a frame.
pub fn run(
    drawing: &Drawing<'_>,
    view: &Buffers,
    vertex: &Lowered,
    fragment: &Lowered,
    drawn: &Drawn,
    textures: &Resources,
) -> Result<Vec<Vec<u32>>, Diagnostic> {
    let mut targets = vec![cleared(drawing.size); drawing.targets as usize];
    let (Some(returned), Some(taken)) = (vertex.program.signature(vertex.function), fragment.program.signature(fragment.function)) else {
        return Ok(targets);
    };
    let shader = Shader { fragment, drawn, size: drawing.size, taken, wiring: wiring(returned, taken), outputs: sources(&taken.outputs) };
    let threads = rayon::current_num_threads().max(1) as u32;
    let rows = |thread: u32| (0..drawing.size[1].div_ceil(ROWS)).filter(move |band| band % threads == thread);
    let shaded: Vec<Shaded> = (0..threads)
        .into_par_iter()
        .map(|thread| {
            let bands: Vec<u32> = rows(thread).collect();
            let mut machine = Machine::<f32>::new(&fragment.program).map_err(failed)?;
            machine.bind(textures.clone()).map_err(failed)?;
            let mut found = Shaded::default();
            for (index, item) in drawing.items.iter().enumerate() {
                machine.bind_buffers(buffers(drawing, view, item)).map_err(failed)?;
                bands.iter().try_for_each(|band| shader.band(&mut machine, index, *band, &mut found))?;
            }
            Ok(found)
        })
        .collect::<Result<_, Diagnostic>>()?;
    for (pixel, target, words) in shaded.into_iter().flat_map(|shaded| shaded.0) {
        if let Some(target) = targets.get_mut(target as usize) {
            target[4 * pixel..4 * pixel + 4].copy_from_slice(&words);
        }
    }
    Ok(targets)
}

/// Pixel, target, words.
#[derive(Default)]
struct Shaded(Vec<(usize, u32, [u32; 4])>);

/// Where each scalar of the fragment stage comes from.
#[derive(Debug, Clone, Copy)]
enum Wire {
    /// A slot of the corners, in perspective or that of the first.
    Smooth(usize),
    Flat(usize),
    Position(usize),
    Front,
    Nothing,
}

fn wiring(returned: &Function, taken: &Function) -> Vec<Wire> {
    let from = sources(&returned.outputs);
    let flat = |slot: usize| {
        let interpolation = match &returned.outputs[slot] {
            Some(Binding::Location { interpolation, .. }) => *interpolation,
            _ => None,
        };
        interpolation == Some(naga::Interpolation::Flat) || returned.result.get(slot) != Some(&Kind::Float)
    };
    let wire = |source: &Source| match source {
        Source::Location(..) => match from.iter().position(|other| other == source) {
            Some(slot) if flat(slot) => Wire::Flat(slot),
            Some(slot) => Wire::Smooth(slot),
            None => Wire::Nothing,
        },
        Source::BuiltIn(BuiltIn::Position { .. }, component) => Wire::Position(*component),
        Source::BuiltIn(BuiltIn::FrontFacing, _) => Wire::Front,
        _ => Wire::Nothing,
    };
    sources(&taken.inputs).iter().map(wire).collect()
}

struct Shader<'a> {
    fragment: &'a Lowered,
    drawn: &'a Drawn,
    size: [u32; 2],
    taken: &'a Function,
    wiring: Vec<Wire>,
    outputs: Vec<Source>,
}

impl Shader<'_> {
    /// Shades the quads of a band of rows that show an item.
    fn band(&self, machine: &mut Machine<'_, f32>, item: usize, band: u32, to: &mut Shaded) -> Result<(), Diagnostic> {
        let rows = (band * ROWS..(band + 1) * ROWS).step_by(2).filter(|y| *y < self.size[1]);
        for (y, x) in rows.flat_map(|y| (0..self.size[0]).step_by(2).map(move |x| (y, x))) {
            let pixels = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
            let shown = pixels.map(|(x, y)| self.shown(x, y));
            for lane in 0..4 {
                let id = shown[lane];
                let Some(triangle) = self.drawn.triangles.get(id as usize).filter(|triangle| triangle.item == item) else { continue };
                // Each triangle of the quad once.
                if shown[..lane].contains(&id) {
                    continue;
                }
                self.quad(machine, triangle, pixels, shown.map(|other| other == id), to)?;
            }
        }
        Ok(())
    }

    fn shown(&self, x: u32, y: u32) -> u32 {
        let inside = x < self.size[0] && y < self.size[1];
        if inside { self.drawn.seen.triangle[(y * self.size[0] + x) as usize] } else { NONE }
    }

    fn quad(
        &self,
        machine: &mut Machine<'_, f32>,
        triangle: &Triangle,
        pixels: [(u32, u32); 4],
        covered: [bool; 4],
        to: &mut Shaded,
    ) -> Result<(), Diagnostic> {
        let arguments = pixels.map(|(x, y)| self.arguments(triangle, f64::from(x) + 0.5, f64::from(y) + 0.5));
        let results = machine.quad(self.fragment.function, arguments.each_ref().map(Vec::as_slice)).map_err(failed)?;
        let discarded = machine.quad_discarded();
        for lane in (0..4).filter(|lane| covered[*lane] && !discarded[*lane]) {
            let (x, y) = pixels[lane];
            self.store((y * self.size[0] + x) as usize, &results[lane], to);
        }
        Ok(())
    }

    fn arguments(&self, triangle: &Triangle, x: f64, y: f64) -> Vec<f32> {
        let (shares, depth, inverse_w) = triangle.at(x, y);
        let corners = &self.drawn.corners[triangle.item];
        let slot = |corner: u32, slot: usize| corners[corner as usize].slots[slot];
        let argument = |wire: &Wire| match wire {
            Wire::Smooth(index) => {
                (0..3).map(|corner| shares[corner] * f64::from(slot(triangle.corners[corner], *index))).sum::<f64>() as f32
            }
            Wire::Flat(index) => slot(triangle.first, *index),
            Wire::Position(component) => [x, y, depth, inverse_w][*component & 3] as f32,
            Wire::Front => f32::from_word(u32::from(triangle.front)),
            Wire::Nothing => f32::from_word(0),
        };
        self.wiring.iter().map(argument).collect()
    }

    /// What is returned at each location, as words.
    fn store(&self, pixel: usize, slots: &[f32], to: &mut Shaded) {
        let mut targets: Vec<[u32; 4]> = Vec::new();
        for ((source, kind), slot) in self.outputs.iter().zip(&self.taken.result).zip(slots) {
            let Source::Location(location, component) = *source else { continue };
            if targets.len() <= location as usize {
                targets.resize(location as usize + 1, [0; 4]);
            }
            targets[location as usize][component & 3] = if *kind == Kind::Float { slot.bits() } else { slot.word() };
        }
        to.0.extend(targets.into_iter().enumerate().map(|(target, words)| (pixel, target as u32, words)));
    }
}

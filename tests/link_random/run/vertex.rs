//! What a vertex stage is drawn with, and what its frames should hold.
//!
//! The stage places its three vertices at the corners of one triangle over the whole frame, and
//! computes the rest at random. So the barycentric coordinates of each pixel are known.

use std::fmt::Write as _;

use lamplight::bundle::{Language, Reflection};
use lamplight::compose::Composed;
use lamplight::diagnostic::Diagnostics;
use lamplight::eval::{Bounded, Machine, Number as _, SlotKind as Slot};
use lamplight::execute::frame::{Mesh, VertexAttribute, VertexFormat};
use lamplight::picture::frame::probe;
use lamplight::validate::validate;
use naga::{Binding, BuiltIn};

use super::evaluated::{agree, components, entry_point, four, resources};
use super::{Drawn, Partner, Ran, Ready, SIZE, interpolated, number};
use crate::random::Random;

/// The error of interpolation, as a share of the largest of the three values. Both the plane
/// equation of a software driver and the division by w round a few times.
const INTERPOLATION: f64 = 4e-6;

/// A fragment stage for a vertex stage.
pub fn partner(reflection: &Reflection) -> Result<Partner, Diagnostics> {
    let mut members = String::new();
    for (index, output) in reflection.outputs.iter().enumerate() {
        let Some(location) = output.location else { continue };
        let attribute = interpolated(output);
        let _ = writeln!(members, "@location({location}) {attribute} fed_{index}: {},", output.ty);
    }
    let text = format!(
        "struct Fed {{\n{members}}}\n\
         @fragment fn read(fed: Fed) -> @location(0) vec4f {{ return vec4f(); }}\n"
    );
    let validated = validate(&Composed::of_text(Language::Wesl, None, text))?;
    let input_stage = probe::inputs_module(&validated.module, "read");
    Ok(Partner { validated, entry: "read", input_stage })
}

/// One triangle with the attributes that all vertex stages have.
pub fn mesh(random: &mut Random) -> Mesh {
    let attribute = |location, format| VertexAttribute { location, format };
    let attributes =
        vec![attribute(0, VertexFormat::Float32x3), attribute(1, VertexFormat::Float32x4)];
    let words = (0..3 * (3 + 4)).map(|_| (number(random) as f32).to_bits()).collect();
    Mesh { attributes, words, indices: Vec::new() }
}

/// A component of an attribute; 0 where the mesh has no such attribute.
fn attribute_word(mesh: &Mesh, vertex: u32, location: u32, component: usize) -> u32 {
    let layout = mesh.layout();
    let found = layout.iter().find(|(attribute, _)| attribute.location == location);
    let offset = found.map(|(_, offset)| (u64::from(vertex) * mesh.stride() + offset) / 4);
    let word = offset.and_then(|offset| mesh.words.get(offset as usize + component));
    word.copied().unwrap_or(0)
}

/// The evaluator's results at the three corners.
pub struct Corners {
    vertices: [Vec<Bounded>; 3],
    /// The location and the component of each result.
    places: Vec<Option<(u32, usize)>>,
    /// Which results are integers.
    is_integer: Vec<bool>,
    /// Whether a comparison in the stage was within the error of either result.
    doubt: bool,
}

impl Corners {
    pub fn new(ready: &Ready<'_>) -> Result<Self, String> {
        let message_of = |error: lamplight::eval::Error| error.to_string();
        let (program, id, function) = entry_point(ready)?;
        let sources = components(&function.inputs);
        let mut doubt = false;
        let mut vertex = |index: u32| -> Result<Vec<Bounded>, String> {
            let mut machine = Machine::<Bounded>::new(&program).map_err(message_of)?;
            machine.bind(resources(ready)).map_err(message_of)?;
            let mut given = Vec::new();
            for ((binding, place), kind) in
                function.inputs.iter().zip(&sources).zip(&function.arguments)
            {
                let word = match (binding, place) {
                    (Some(Binding::BuiltIn(BuiltIn::VertexIndex)), _) => index,
                    (Some(Binding::BuiltIn(BuiltIn::InstanceIndex)), _) => 0,
                    (_, Some((location, component))) => {
                        attribute_word(&ready.mesh, index, *location, *component)
                    }
                    _ => return Err(format!("a vertex stage has {binding:?} as an input")),
                };
                given.push(match kind {
                    Slot::Float => Bounded::from_f64(f64::from(f32::from_bits(word))),
                    _ => Bounded::from_word(word),
                });
            }
            let results = machine.call(id, &given).map_err(message_of)?.to_vec();
            doubt |= !machine.findings().is_empty();
            Ok(results)
        };
        let vertices = [vertex(0)?, vertex(1)?, vertex(2)?];
        let is_integer = function.result.iter().map(|kind| *kind != Slot::Float).collect();
        Ok(Self { vertices, places: components(&function.outputs), is_integer, doubt })
    }

    /// Fails if the inputs of the fragments are not the interpolated results. Integers are not
    /// interpolated: they come from the provoking vertex, which is the first in WebGPU and Vulkan,
    /// and the last in OpenGL. Either is accepted.
    pub fn frame(&self, drawn: &Drawn, tally: &mut Ran) -> Result<(), String> {
        let mut first = tally.clone();
        let Err(error) = self.provoked(0, drawn, &mut first) else {
            *tally = first;
            return Ok(());
        };
        let mut last = tally.clone();
        let tried = self.provoked(2, drawn, &mut last);
        *tally = last;
        tried.map_err(|other| format!("{error}; or {other}"))
    }

    /// The same, with `flat` as the index of the provoking vertex.
    fn provoked(&self, flat: usize, drawn: &Drawn, tally: &mut Ran) -> Result<(), String> {
        let Some(first) = drawn.inputs.first() else { return Ok(()) };
        for pixel in 0..first.len() / 4 {
            let words: Vec<u32> =
                drawn.inputs.iter().flat_map(|target| four(target, pixel)).collect();
            let mut words = words.into_iter();
            for (result, place) in self.places.iter().enumerate() {
                let Some((location, component)) = place else { continue };
                let word = words.next().ok_or("an input is missing")?;
                let compared = match self.is_integer[result] {
                    true => self.integer(result, flat, word, tally),
                    false => self.float(result, pixel, word, tally),
                };
                compared.map_err(|what| {
                    format!("pixel {pixel}, location {location}, component {component}: {what}")
                })?;
            }
        }
        Ok(())
    }

    fn float(&self, result: usize, pixel: usize, word: u32, tally: &mut Ran) -> Result<(), String> {
        let values = self.vertices.each_ref().map(|vertex| vertex[result]);
        let shares = shares(pixel);
        let sum = |of: &dyn Fn(Bounded) -> f64| -> f64 {
            values.iter().zip(shares).map(|(value, share)| of(*value) * share).sum()
        };
        let largest = values.iter().fold(0.0, |most: f64, value| most.max(value.value().abs()));
        let error = sum(&Bounded::error) + INTERPOLATION * largest;
        let found = f64::from(f32::from_bits(word));
        agree(found, (sum(&Bounded::value), error), self.doubt, tally)
    }

    fn integer(
        &self,
        result: usize,
        vertex: usize,
        word: u32,
        tally: &mut Ran,
    ) -> Result<(), String> {
        tally.numbers += 1;
        let wanted = self.vertices[vertex][result].word();
        match word == wanted {
            true => Ok(()),
            false if self.doubt => {
                tally.open += 1;
                Ok(())
            }
            false => Err(format!("found {word}, wanted {wanted}")),
        }
    }
}

/// The barycentric coordinates of a pixel: the weight of each vertex.
fn shares(pixel: usize) -> [f64; 3] {
    let [width, height] = SIZE.map(f64::from);
    let (x, y) = (pixel as u32 % SIZE[0], pixel as u32 / SIZE[0]);
    let (second, third) =
        ((f64::from(x) + 0.5) / width / 2.0, (height - f64::from(y) - 0.5) / height / 2.0);
    [1.0 - second - third, second, third]
}

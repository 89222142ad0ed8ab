//! Computes a stage with the evaluator, and compares what was drawn.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use lamplight::eval::{
    Bounded, Function, FunctionId, Machine, Number as _, Program, Resources, SlotKind as Slot,
};
use naga::Binding;

use super::{Drawn, Ran, Ready, SIZE};
use crate::fragments;

/// The evaluator of one fragment stage. Quads with the same inputs are computed once.
pub struct Evaluator<'p> {
    machine: Box<Compute<'p>>,
    known: BTreeMap<Vec<u32>, Wanted>,
}

/// Computes a quad from the input words of its fragments.
type Compute<'p> = dyn FnMut(&[Vec<u32>; 4]) -> Result<Wanted, String> + 'p;

/// The evaluator's results for a quad.
#[derive(Clone)]
struct Wanted {
    /// The results of each fragment, by location and component.
    results: [BTreeMap<(u32, usize), Bounded>; 4],
    /// Whether a comparison in the stage was within the error of either result.
    doubt: bool,
}

impl<'p> Evaluator<'p> {
    pub fn new(ready: &'p Ready<'_>) -> Result<Self, String> {
        let (program, id, function) = entry_point(ready)?;
        let resources = resources(ready);
        let places = components(&function.outputs);
        let machine =
            move |given: &[Vec<u32>; 4]| quad(&program, id, &function, &places, &resources, given);
        Ok(Self { machine: Box::new(machine), known: BTreeMap::new() })
    }

    pub fn frame(&mut self, drawn: &Drawn, tally: &mut Ran) -> Result<(), String> {
        let [width, height] = SIZE;
        for (y, x) in (0..height / 2).flat_map(|y| (0..width / 2).map(move |x| (2 * y, 2 * x))) {
            let pixels =
                [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| ((y + j) * width + x + i) as usize);
            let given = pixels.map(|pixel| {
                drawn.inputs.iter().flat_map(|target| four(target, pixel)).collect::<Vec<u32>>()
            });
            let wanted = match self.known.entry(given.concat()) {
                Entry::Occupied(known) => known.into_mut(),
                Entry::Vacant(new) => new.insert((self.machine)(&given)?),
            };
            for (lane, pixel) in pixels.into_iter().enumerate() {
                compare(drawn, pixel, &wanted.results[lane], wanted.doubt, tally)?;
            }
        }
        Ok(())
    }
}

/// The stage as the evaluator has it.
pub fn entry_point(ready: &Ready<'_>) -> Result<(Program, FunctionId, Function), String> {
    let module = &ready.validated;
    let program = Program::new(&module.module, &module.info).map_err(|error| error.to_string())?;
    let found = program.functions().filter(|(_, one)| one.name == ready.runnable.entry).last();
    let (id, function) = found.map(|(id, one)| (id, one.clone())).ok_or("no entry point")?;
    Ok((program, id, function))
}

pub fn resources(ready: &Ready<'_>) -> Resources {
    fragments::resources(ready.buffers.clone(), &ready.fixtures, &BTreeMap::new())
}

pub fn four(target: &[u32], pixel: usize) -> [u32; 4] {
    std::array::from_fn(|word| target[4 * pixel + word])
}

/// The location and the component of each slot; `None` for a built-in.
pub fn components(bindings: &[Option<Binding>]) -> Vec<Option<(u32, usize)>> {
    let mut places: Vec<Option<(u32, usize)>> = Vec::new();
    for binding in bindings {
        places.push(match binding {
            Some(Binding::Location { location, .. }) => {
                let is_it = |place: &&Option<(u32, usize)>| {
                    place.is_some_and(|(other, _)| other == *location)
                };
                Some((*location, places.iter().filter(is_it).count()))
            }
            _ => None,
        });
    }
    places
}

fn quad(
    program: &Program,
    id: FunctionId,
    function: &Function,
    places: &[Option<(u32, usize)>],
    resources: &Resources,
    given: &[Vec<u32>; 4],
) -> Result<Wanted, String> {
    let message_of = |error: lamplight::eval::Error| error.to_string();
    let mut machine = Machine::<Bounded>::new(program).map_err(message_of)?;
    machine.bind(resources.clone()).map_err(message_of)?;
    let slot = |(kind, word): (&Slot, &u32)| match kind {
        Slot::Float => Bounded::from_f64(f64::from(f32::from_bits(*word))),
        _ => Bounded::from_word(*word),
    };
    let arguments: [Vec<Bounded>; 4] =
        std::array::from_fn(|lane| function.arguments.iter().zip(&given[lane]).map(slot).collect());
    let results = machine.quad(id, arguments.each_ref().map(Vec::as_slice)).map_err(message_of)?;
    let placed = |values: Vec<Bounded>| {
        places.iter().zip(values).filter_map(|(place, value)| Some(((*place)?, value))).collect()
    };
    Ok(Wanted { results: results.map(placed), doubt: !machine.findings().is_empty() })
}

fn compare(
    drawn: &Drawn,
    pixel: usize,
    wanted: &BTreeMap<(u32, usize), Bounded>,
    doubt: bool,
    tally: &mut Ran,
) -> Result<(), String> {
    for ((location, component), wanted) in wanted {
        let target = drawn.outputs.get(*location as usize);
        let target = target.ok_or_else(|| format!("there is no target {location}"))?;
        let found = f64::from(f32::from_bits(four(target, pixel)[*component]));
        let place = || format!("pixel {pixel}, location {location}, component {component}");
        agree(found, (wanted.value(), wanted.error()), doubt, tally)
            .map_err(|what| format!("{}: {what}", place()))?;
    }
    Ok(())
}

/// Fails unless a number is the wanted one within its error.
pub fn agree(
    found: f64,
    (value, error): (f64, f64),
    doubt: bool,
    tally: &mut Ran,
) -> Result<(), String> {
    tally.numbers += 1;
    let is_known = value.is_finite() && error.is_finite() && value.abs() < f64::from(f32::MAX);
    if found == value || is_known && (found - value).abs() <= error {
        return Ok(());
    }
    if !is_known || doubt {
        tally.open += 1;
        return Ok(());
    }
    Err(format!("found {found}, wanted {value} within {error:e}"))
}

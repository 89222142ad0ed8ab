//! Fragments of a frame computed again by the evaluator, from the very inputs the driver gave them.
//!
//! A fragment agrees where each component of its colour lies within the bound of value plus error.
//! It is open where it does not, but a comparison on the way was too close to call, or where the
//! specification gives no bound.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::sync::Arc;

use lamplight::eval::{self, Bounded, Filter, Function, Kind, Machine, Number, Program, Resources};
use lamplight::execute::fixture::{Fixture, Texture};
use lamplight::execute::frame::Buffers;
use lamplight::execute::kernel::SENTINEL;
use lamplight::picture::frame::Composed;

type Place = (u32, u32);

/// What became of the fragments.
#[derive(Default)]
pub struct Tally {
    pub tried: usize,
    pub open: usize,
    /// Largest error over its bound.
    pub share: f64,
    pub detours: BTreeMap<&'static str, usize>,
}

impl Tally {
    pub fn add(&mut self, other: &Self) {
        self.tried += other.tried;
        self.open += other.open;
        self.share = self.share.max(other.share);
        other
            .detours
            .iter()
            .for_each(|(detour, count)| *self.detours.entry(detour).or_default() += count);
    }
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{} fragments, {} open, at most {:.0} % of the bound",
            self.tried,
            self.open,
            100.0 * self.share
        )?;
        self.detours.iter().try_for_each(|(detour, count)| write!(f, "; {count} times {detour}"))
    }
}

/// The targets of a frame drawn with a watched fragment stage: the colour, then the inputs.
pub struct Watched<'a> {
    pub size: [u32; 2],
    pub targets: &'a [Vec<u32>],
}

impl Watched<'_> {
    /// Quads that are drawn to all four fragments.
    pub fn whole_quads(&self) -> usize {
        self.quads().count()
    }

    /// Whole quads all over the frame, in the order the evaluator takes them.
    fn quads(&self) -> impl Iterator<Item = [usize; 4]> + '_ {
        let [width, height] = self.size;
        let quads = (0..height / 2).flat_map(move |y| (0..width / 2).map(move |x| (2 * x, 2 * y)));
        let pixels = quads.map(move |(x, y)| {
            [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| ((y + j) * width + x + i) as usize)
        });
        pixels.filter(|quad| quad.iter().all(|pixel| self.is_covered(*pixel)))
    }

    /// Whether the fragment was given something, even if it was discarded then.
    fn is_covered(&self, pixel: usize) -> bool {
        let told = self.targets.get(1).unwrap_or(&self.targets[0]);
        four(told, pixel) != [SENTINEL; 4]
    }

    pub fn is_drawn(&self, pixel: usize) -> bool {
        four(&self.targets[0], pixel) != [SENTINEL; 4]
    }

    pub fn colour(&self, pixel: usize) -> [f64; 4] {
        four(&self.targets[0], pixel).map(|word| f64::from(f32::from_bits(word)))
    }

    /// The words of a fragment's inputs, behind the colour.
    pub fn inputs(&self, pixel: usize) -> impl Iterator<Item = u32> {
        self.targets[1..].iter().flat_map(move |target| four(target, pixel))
    }
}

fn four(target: &[u32], pixel: usize) -> [u32; 4] {
    std::array::from_fn(|word| target[4 * pixel + word])
}

/// Computes fragments of a frame again, one whole quad in `step`.
pub fn recompute(
    stage: &Composed,
    resources: Resources,
    watched: &Watched<'_>,
    step: usize,
    tally: &mut Tally,
) -> Result<(), String> {
    let frames = std::slice::from_ref(watched);
    for found in recompute_each(stage, resources, frames, step)? {
        tally.add(&found?);
    }
    Ok(())
}

/// [`recompute`] for frames of several drivers: what was given the same is computed once.
pub fn recompute_each(
    stage: &Composed,
    resources: Resources,
    frames: &[Watched<'_>],
    step: usize,
) -> Result<Vec<Result<Tally, String>>, String> {
    let program = Program::new(&stage.validated.module, &stage.validated.info)
        .map_err(|error| error.to_string())?;
    // GLSL has a plain function of that name too; entry points come after functions.
    let (id, _) = program
        .functions()
        .filter(|(_, function)| function.name == stage.entry)
        .last()
        .ok_or("no entry point")?;
    let signature = program.signature(id).ok_or("no entry point")?;
    let mut machine = Machine::<Bounded>::new(&program).map_err(|error| error.to_string())?;
    machine.bind(resources).map_err(|error| error.to_string())?;
    let mut known: BTreeMap<Vec<u32>, Wanted> = BTreeMap::new();
    let mut tallies = Vec::new();
    for watched in frames {
        let mut tally = Ok(Tally::default());
        for quad in watched.quads().step_by(step) {
            let given = quad.into_iter().flat_map(|pixel| watched.inputs(pixel)).collect();
            let wanted = match known.entry(given) {
                Entry::Occupied(entry) => entry.into_mut(),
                Entry::Vacant(entry) => {
                    let arguments = quad.map(|pixel| slots(signature, watched, pixel));
                    machine.forget();
                    let results = machine
                        .quad(id, [0, 1, 2, 3].map(|lane| arguments[lane].as_slice()))
                        .map_err(|error| error.to_string())?;
                    let discarded = machine.quad_discarded();
                    let doubt = !machine.findings().is_empty();
                    entry.insert(Wanted { results, discarded, doubt })
                }
            };
            tally = tally.and_then(|tally| judge(watched, quad, wanted, tally));
        }
        tallies.push(tally);
    }
    Ok(tallies)
}

/// What the evaluator says of a quad.
struct Wanted {
    results: [Vec<Bounded>; 4],
    discarded: [bool; 4],
    /// Whether a comparison on the way was too close to call.
    doubt: bool,
}

fn judge(
    watched: &Watched<'_>,
    quad: [usize; 4],
    wanted: &Wanted,
    mut tally: Tally,
) -> Result<Tally, String> {
    for (lane, pixel) in quad.into_iter().enumerate() {
        let is_discarded = wanted.discarded[lane];
        if is_discarded == watched.is_drawn(pixel) {
            tally.tried += 1;
            match wanted.doubt {
                true => tally.open += 1,
                false if is_discarded => return Err(format!("pixel {pixel}: was not discarded")),
                false => return Err(format!("pixel {pixel}: was discarded")),
            }
        } else if is_discarded {
            tally.tried += 1;
        } else {
            judge_colour(watched, pixel, &wanted.results[lane], wanted.doubt, &mut tally)?;
        }
    }
    Ok(tally)
}

fn judge_colour(
    watched: &Watched<'_>,
    pixel: usize,
    wanted: &[Bounded],
    doubt: bool,
    tally: &mut Tally,
) -> Result<(), String> {
    let found = watched.colour(pixel);
    let share = |(found, wanted): (f64, &Bounded)| {
        if found == wanted.value() { 0.0 } else { (found - wanted.value()).abs() / wanted.error() }
    };
    let shares: Vec<f64> = found.into_iter().zip(wanted).map(share).collect();
    if shares.len() != 4 {
        return Err(format!("{} numbers in place of a colour", shares.len()));
    }
    let far = shares.iter().position(|share| share.is_nan() || *share > 1.0);
    tally.tried += 1;
    if wanted.iter().any(|value| !value.error().is_finite()) || far.is_some() && doubt {
        tally.open += 1;
    } else if let Some(i) = far {
        let (x, y) = (pixel as u32 % watched.size[0], pixel as u32 / watched.size[0]);
        let (value, error) = (wanted[i].value(), wanted[i].error());
        return Err(format!(
            "pixel ({x}, {y}): found {}, wanted {value} within {error:e}",
            found[i]
        ));
    } else {
        tally.share = shares.into_iter().fold(tally.share, f64::max);
    }
    Ok(())
}

/// What a fragment was given.
fn slots(signature: &Function, watched: &Watched<'_>, pixel: usize) -> Vec<Bounded> {
    let slot = |(kind, word): (&Kind, u32)| match kind {
        Kind::Float => Bounded::from_f64(f64::from(f32::from_bits(word))),
        _ => Bounded::from_word(word),
    };
    signature.arguments.iter().zip(watched.inputs(pixel)).map(slot).collect()
}

/// What the evaluator binds in the place of the device.
pub fn resources(
    buffers: Buffers,
    fixtures: &BTreeMap<Place, Arc<Fixture>>,
    levels: &BTreeMap<Place, Vec<Texture>>,
) -> Resources {
    let mut resources = Resources { buffers, ..Resources::default() };
    for (place, fixture) in fixtures {
        match &**fixture {
            Fixture::Texture(texture) => {
                let mut texture = eval::Texture::from(texture);
                let smaller = levels.get(place).map_or(&[][..], Vec::as_slice);
                texture
                    .levels
                    .extend(smaller.iter().flat_map(|level| eval::Texture::from(level).levels));
                resources.textures.insert(*place, texture);
            }
            Fixture::Sampler(sampler) => {
                let mut sampler = eval::Sampler::from(*sampler);
                if sampler.min == Filter::Linear && sampler.compare.is_none() {
                    (sampler.mipmap, sampler.levels) = (Filter::Linear, (0.0, 32.0));
                }
                resources.samplers.insert(*place, sampler);
            }
        }
    }
    resources
}

/// For each component of what is at a location, the index of the fragment's input word.
pub fn places(stage: &Composed) -> Result<BTreeMap<(u32, usize), usize>, String> {
    let program = Program::new(&stage.validated.module, &stage.validated.info)
        .map_err(|error| error.to_string())?;
    let (_, function) = program
        .functions()
        .filter(|(_, function)| function.name == stage.entry)
        .last()
        .ok_or("no entry point")?;
    let mut places = BTreeMap::new();
    for (index, binding) in function.inputs.iter().enumerate() {
        if let Some(naga::Binding::Location { location, .. }) = binding {
            let component = places.keys().filter(|(other, _)| other == location).count();
            places.insert((*location, component), index);
        }
    }
    Ok(places)
}

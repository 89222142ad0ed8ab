//! Computes fragments of a frame again with the evaluator, from exactly the inputs that the driver
//! gave them.
//!
//! A fragment agrees if each component of its colour lies within the evaluator's error bound. It is
//! open, which means neither right nor wrong, in two cases: the specification gives no bound; or
//! the fragment does not agree, and a comparison in the shader was within the error of either
//! result.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::sync::Arc;

use lamplight::eval::{
    self, Bounded, Filter, Function, FunctionId, Machine, Number, Program, Resources, SlotKind,
};
use lamplight::execute::fixture::{Fixture, FixtureTexture};
use lamplight::execute::frame::Buffers;
use lamplight::execute::kernel::SENTINEL;
use lamplight::picture::frame::ReadyStage;

type Place = (u32, u32);

/// Counts of the fragments that were compared.
#[derive(Default)]
pub struct Tally {
    pub tried: usize,
    pub open: usize,
    /// The largest error, as a share of its bound.
    pub share: f64,
    /// Ways around a defect of a driver, with how often each was taken.
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

impl Tally {
    /// The counts, if enough fragments were compared, and at most a share `most` of them is open.
    pub fn checked(self, least: usize, most: f64) -> Result<Self, String> {
        match self {
            Self { tried, .. } if tried < least => {
                Err(format!("{tried} fragments were compared, expected at least {least}"))
            }
            Self { tried, open, .. } if open as f64 > most * tried as f64 => {
                Err(format!("{open} of {tried} fragments are open, at most {most} of them may be"))
            }
            tally => Ok(tally),
        }
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

/// A frame whose fragment stage also wrote its inputs. The first target is the colour, and the
/// others are the inputs.
pub struct Watched<'a> {
    pub size: [u32; 2],
    pub targets: &'a [Vec<u32>],
}

impl Watched<'_> {
    /// How many quads have all four fragments covered.
    pub fn whole_quads(&self) -> usize {
        self.quads().count()
    }

    /// The quads of the frame with all four fragments covered. The pixels of each are in the order
    /// of the evaluator's lanes.
    fn quads(&self) -> impl Iterator<Item = [usize; 4]> + '_ {
        let [width, height] = self.size;
        let quads = (0..height / 2).flat_map(move |y| (0..width / 2).map(move |x| (2 * x, 2 * y)));
        let pixels = quads.map(move |(x, y)| {
            [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| ((y + j) * width + x + i) as usize)
        });
        pixels.filter(|quad| quad.iter().all(|pixel| self.is_covered(*pixel)))
    }

    /// Whether the driver ran the fragment, even if the fragment was then discarded.
    fn is_covered(&self, pixel: usize) -> bool {
        let target = self.targets.get(1).unwrap_or(&self.targets[0]);
        four(target, pixel) != [SENTINEL; 4]
    }

    pub fn is_drawn(&self, pixel: usize) -> bool {
        four(&self.targets[0], pixel) != [SENTINEL; 4]
    }

    pub fn color(&self, pixel: usize) -> [f64; 4] {
        four(&self.targets[0], pixel).map(|word| f64::from(f32::from_bits(word)))
    }

    /// The words of a fragment's inputs.
    pub fn inputs(&self, pixel: usize) -> impl Iterator<Item = u32> {
        self.targets[1..].iter().flat_map(move |target| four(target, pixel))
    }
}

fn four(target: &[u32], pixel: usize) -> [u32; 4] {
    std::array::from_fn(|word| target[4 * pixel + word])
}

/// Computes every `step`-th whole quad of a frame again, and compares.
pub fn recompute(
    stage: &ReadyStage,
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

/// The function of an entry point. A module from GLSL has a plain function of the same name; entry
/// points come after functions.
pub fn entry_function<'a>(
    program: &'a Program,
    entry: &str,
) -> Result<(FunctionId, &'a Function), String> {
    let named = program.functions().filter(|(_, function)| function.name == entry);
    named.last().ok_or_else(|| "no entry point".to_owned())
}

/// [`recompute`] for frames of several drivers. Quads with the same inputs are computed once.
pub fn recompute_each(
    stage: &ReadyStage,
    resources: Resources,
    frames: &[Watched<'_>],
    step: usize,
) -> Result<Vec<Result<Tally, String>>, String> {
    let program = Program::new(&stage.validated.module, &stage.validated.info)
        .map_err(|error| error.to_string())?;
    let (id, _) = entry_function(&program, stage.entry)?;
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
            tally = tally.and_then(|tally| check_quad(watched, quad, wanted, tally));
        }
        tallies.push(tally);
    }
    Ok(tallies)
}

/// The evaluator's results for a quad.
struct Wanted {
    results: [Vec<Bounded>; 4],
    discarded: [bool; 4],
    /// Whether a comparison in the shader was within the error of either result.
    doubt: bool,
}

fn check_quad(
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
                false if is_discarded => {
                    return Err(format!("pixel {pixel} is drawn, but should be discarded"));
                }
                false => return Err(format!("pixel {pixel} is discarded, but should be drawn")),
            }
        } else if is_discarded {
            tally.tried += 1;
        } else {
            check_color(watched, pixel, &wanted.results[lane], wanted.doubt, &mut tally)?;
        }
    }
    Ok(tally)
}

fn check_color(
    watched: &Watched<'_>,
    pixel: usize,
    wanted: &[Bounded],
    doubt: bool,
    tally: &mut Tally,
) -> Result<(), String> {
    let found = watched.color(pixel);
    let share = |(found, wanted): (f64, &Bounded)| {
        if found == wanted.value() { 0.0 } else { (found - wanted.value()).abs() / wanted.error() }
    };
    let shares: Vec<f64> = found.into_iter().zip(wanted).map(share).collect();
    if shares.len() != 4 {
        return Err(format!("a colour should have 4 numbers, found {}", shares.len()));
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

/// The inputs of a fragment, as the evaluator takes them.
fn slots(signature: &Function, watched: &Watched<'_>, pixel: usize) -> Vec<Bounded> {
    let slot = |(kind, word): (&SlotKind, u32)| match kind {
        SlotKind::Float => Bounded::from_f64(f64::from(f32::from_bits(word))),
        _ => Bounded::from_word(word),
    };
    signature.arguments.iter().zip(watched.inputs(pixel)).map(slot).collect()
}

/// The buffers, textures and samplers of a device, as the evaluator takes them.
pub fn resources(
    buffers: Buffers,
    fixtures: &BTreeMap<Place, Arc<Fixture>>,
    levels: &BTreeMap<Place, Vec<FixtureTexture>>,
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

/// The index of a fragment's input word, for each location and component.
pub fn places(stage: &ReadyStage) -> Result<BTreeMap<(u32, usize), usize>, String> {
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

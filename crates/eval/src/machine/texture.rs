//! Runs accesses to textures: finds what is bound, chooses the level, and stores the result.

use super::super::code::{Access, DerivativeDirection, Lod, TextureOp};
use super::super::error::{Error, FindingKind};
use super::super::number::Number;
use super::super::resources::{Filter, Sampler, Texture, TextureDimension};
use super::filter::{Footprint, TexturePoint, combine, gathered_component, project};
use super::lane::{Env, Lane};
use super::quad::derivative_lanes;
use super::watch::Watch;
use lamplight_diagnostic::codes;

/// The precision to which devices agree on the level of detail.
const LEVEL_STEP: f64 = 1.0 / 64.0;

/// The difference of the coordinate to the neighbour in x and to the one in y.
type Gradient = [[f64; 3]; 2];

/// The instruction, and where to report what happens there.
type WatchNotes<'w> = (u32, &'w mut Watch);

/// The memory of one lane. In a batch it is a part of the memory of many lanes.
pub trait Slots<N> {
    fn get(&self, slot: u32) -> N;
    fn set(&mut self, slot: u32, value: N);
}

impl<N: Copy> Slots<N> for [N] {
    #[inline(always)]
    fn get(&self, slot: u32) -> N {
        self[slot as usize]
    }

    #[inline(always)]
    fn set(&mut self, slot: u32, value: N) {
        self[slot as usize] = value;
    }
}

/// Runs an access whose level of detail comes from the gradients within a quad, for the lanes that
/// reached it.
pub(super) fn run_quad<N: Number>(
    env: Env,
    index: u32,
    lanes: &mut [Lane<N>],
    group: &[usize],
    watch: &mut Watch,
) -> Result<(), Error> {
    let access = &env.program.images[index as usize];
    let coordinates: [Option<[f64; 3]>; 4] = std::array::from_fn(|lane| {
        group.contains(&lane).then(|| coordinate_of(access, &lanes[lane].memory[..]))
    });
    for &lane in group {
        let gradient = gradient_of(&coordinates, lane);
        let pc = lanes[lane].pc;
        apply_access(env, access, &mut lanes[lane].memory[..], Some(gradient), (pc, watch))?;
    }
    Ok(())
}

/// The coordinate of an access.
pub fn coordinate_of<N: Number>(access: &Access, m: &(impl Slots<N> + ?Sized)) -> [f64; 3] {
    values_at(m, access.coordinate, access.dimensions)
}

/// How the coordinate changes around a lane of a quad; 0 along an axis where a neighbour did not
/// reach the access.
pub fn gradient_of(coordinates: &[Option<[f64; 3]>; 4], lane: usize) -> Gradient {
    [DerivativeDirection::X, DerivativeDirection::Y].map(|axis| {
        let (low, high) = derivative_lanes(lane, axis, false);
        coordinates[low]
            .zip(coordinates[high])
            .map_or([0.0; 3], |(low, high)| std::array::from_fn(|i| high[i] - low[i]))
    })
}

/// Runs an access on the memory of a lane.
pub fn apply_access<N: Number>(
    env: Env,
    access: &Access,
    m: &mut (impl Slots<N> + ?Sized),
    gradient: Option<Gradient>,
    notes: WatchNotes,
) -> Result<(), Error> {
    let pc = notes.0;
    access_texture(env, access, m, gradient, notes).map_err(|error| error.or_at(env.span(pc)))
}

fn access_texture<N: Number>(
    env: Env,
    access: &Access,
    m: &mut (impl Slots<N> + ?Sized),
    gradient: Option<Gradient>,
    notes: WatchNotes,
) -> Result<(), Error> {
    let texture = bound_texture(env, m.get(access.image).word())?;
    let size = |level: Option<u32>| {
        let level =
            level.map_or(0, |slot| m.get(slot).word() as usize).min(texture.levels.len() - 1);
        let level = &texture.levels[level];
        [level.width, level.height, level.layers, 0]
    };
    match access.ask {
        TextureOp::Sample { .. } => {
            return sample_texture(env, access, texture, m, gradient, notes);
        }
        TextureOp::Load { level } => load_texel(access, texture, m, level, notes),
        TextureOp::Size { level } => {
            let size = size(level);
            store_result(m, access, size.map(|size| (f64::from(size), 0.0)));
        }
        TextureOp::Levels => store_result(m, access, [(texture.levels.len() as f64, 0.0); 4]),
        TextureOp::Layers => store_result(
            m,
            access,
            [(
                f64::from(
                    size(None)[2] / if texture.shape == TextureDimension::Cube { 6 } else { 1 },
                ),
                0.0,
            ); 4],
        ),
        TextureOp::Samples => store_result(m, access, [(1.0, 0.0); 4]),
    }
    Ok(())
}

fn bound_texture<'e>(env: Env<'e>, global: u32) -> Result<&'e Texture, Error> {
    let bound = env.bound.textures.get(global as usize).and_then(Option::as_ref);
    bound.ok_or_else(|| unbound_resource(env, global))
}

fn bound_sampler<'e>(env: Env<'e>, global: u32) -> Result<&'e Sampler, Error> {
    let bound = env.bound.samplers.get(global as usize).and_then(Option::as_ref);
    bound.ok_or_else(|| unbound_resource(env, global))
}

#[cold]
fn unbound_resource(env: Env, global: u32) -> Error {
    let name = env.program.globals.get(global as usize).map_or("?", |variable| &*variable.name);
    Error::new(codes::EVAL_UNBOUND, format!("no complete texture or sampler is given for `{name}`"))
}

/// Reads one texel. Outside the texture it is zero, which is reported.
fn load_texel<N: Number>(
    access: &Access,
    texture: &Texture,
    m: &mut (impl Slots<N> + ?Sized),
    level: Option<u32>,
    (pc, watch): WatchNotes,
) {
    let word = |slot: u32| i64::from(m.get(slot).word() as i32);
    let mut at = [0i64; 3];
    (0..usize::from(access.dimensions)).for_each(|i| at[i] = word(access.coordinate + i as u32));
    if let Some(layer) = access.layer {
        at[2] = word(layer);
    }
    let level =
        usize::try_from(level.map_or(0, word)).ok().and_then(|level| texture.levels.get(level));
    let texel = level.and_then(|level| level.texel(at));
    if texel.is_none() {
        watch.note(FindingKind::OutOfBounds, pc);
    }
    store_result(m, access, texel.unwrap_or_default().map(|value| (value, 0.0)));
}

fn sample_texture<N: Number>(
    env: Env,
    access: &Access,
    texture: &Texture,
    m: &mut (impl Slots<N> + ?Sized),
    gradient: Option<Gradient>,
    notes: WatchNotes,
) -> Result<(), Error> {
    let TextureOp::Sample { sampler: slot, gather, level, offset, reference, clamp_to_edge } =
        access.ask
    else {
        return Ok(());
    };
    let sampler = bound_sampler(env, m.get(slot).word())?;
    let sampler =
        if clamp_to_edge { Sampler { address: Default::default(), ..*sampler } } else { *sampler };
    let coordinate = values_at(m, access.coordinate, access.dimensions);
    let footprint = Footprint {
        texture,
        sampler: &sampler,
        level: 0,
        filter: Filter::Linear,
        point: sample_point(access, texture, m, coordinate),
        shift: texel_offset(access, m, offset),
        reference: reference.map(|slot| m.get(slot)),
    };
    let mut doubt = false;
    let result = if let Some(component) = gather {
        gathered_component(&footprint, usize::from(component), &mut doubt)
    } else {
        let slopes = match level {
            Lod::Gradient(x, y) => Some([x, y].map(|slot| values_at(m, slot, access.dimensions))),
            _ => gradient,
        };
        let level = match level {
            Lod::Zero => 0.0,
            _ if clamp_to_edge => 0.0,
            Lod::Exact(slot) => m.get(slot).value(),
            Lod::Bias(slot) => detail_level(texture, coordinate, slopes) + m.get(slot).value(),
            Lod::Auto | Lod::Gradient(..) => detail_level(texture, coordinate, slopes),
        };
        between_levels(&footprint, level, &mut doubt)
    };
    if doubt {
        notes.1.note(FindingKind::Ambiguous, notes.0);
    }
    store_result(m, access, result);
    Ok(())
}

/// The place that the coordinate and the layer of an access name.
fn sample_point<N: Number>(
    access: &Access,
    texture: &Texture,
    m: &(impl Slots<N> + ?Sized),
    coordinate: [f64; 3],
) -> TexturePoint {
    let errors: [f64; 3] = std::array::from_fn(|i| {
        if i < usize::from(access.dimensions) {
            m.get(access.coordinate + i as u32).error()
        } else {
            0.0
        }
    });
    let layer = access.layer.map_or(0, |slot| (m.get(slot).word() as i32).max(0) as u32);
    project(texture.shape, coordinate, errors, layer)
}

/// The offset of an access, in texels.
fn texel_offset<N: Number>(
    access: &Access,
    m: &(impl Slots<N> + ?Sized),
    offset: Option<u32>,
) -> [i64; 3] {
    std::array::from_fn(|i| match offset {
        Some(slot) if i < usize::from(access.dimensions) => {
            i64::from(m.get(slot + i as u32).word() as i32)
        }
        _ => 0,
    })
}

/// The level of detail: log2 of the longer step in texels; 0 without neighbours.
fn detail_level(texture: &Texture, coordinate: [f64; 3], slopes: Option<Gradient>) -> f64 {
    let Some(slopes) = slopes else { return 0.0 };
    let first = &texture.levels[0];
    let depth = if texture.shape == TextureDimension::D3 { first.layers } else { 0 };
    let size = [first.width, first.height, depth].map(f64::from);
    let origin = project(texture.shape, coordinate, [0.0; 3], 0);
    let longest = slopes.map(|slope| {
        let moved: [f64; 3] = match texture.shape {
            TextureDimension::Cube => origin.slope(coordinate, slope),
            _ => slope,
        };
        (0..3).map(|i| (moved[i] * size[i]).powi(2)).sum::<f64>().sqrt()
    });
    longest[0].max(longest[1]).log2()
}

/// The result of a lookup at a level that may lie between two of the texture's.
fn between_levels<N: Number>(
    footprint: &Footprint<'_, N>,
    level: f64,
    doubt: &mut bool,
) -> [(f64, f64); 4] {
    let sampler = footprint.sampler;
    let last = (footprint.texture.levels.len() - 1) as f64;
    let level = if level.is_nan() {
        0.0
    } else {
        level.clamp(sampler.levels.0, sampler.levels.1.max(sampler.levels.0))
    };
    let filter = if level <= 0.0 { sampler.mag } else { sampler.min };
    let level = level.clamp(0.0, last);
    let mut at =
        |level: f64| combine(&Footprint { level: level as usize, filter, ..*footprint }, doubt);
    if sampler.mipmap == Filter::Nearest || level.fract() == 0.0 {
        let chosen = (level + 0.5).floor().min(last);
        let found = at(chosen);
        // If the level of detail is close to the threshold between two levels, a device may choose
        // either.
        let others = [level - LEVEL_STEP, level + LEVEL_STEP]
            .map(|level| (level + 0.5).floor().clamp(0.0, last));
        if N::BOUNDED
            && sampler.mipmap == Filter::Nearest
            && others.iter().any(|other| *other != chosen && at(*other) != found)
        {
            *doubt = true;
        }
        return found;
    }
    let (fine, coarse, share) = (at(level.floor()), at(level.floor() + 1.0), level.fract());
    std::array::from_fn(|i| {
        (
            fine[i].0 * (1.0 - share) + coarse[i].0 * share,
            fine[i].1.max(coarse[i].1) + (fine[i].0 - coarse[i].0).abs() * LEVEL_STEP,
        )
    })
}

fn values_at<N: Number>(m: &(impl Slots<N> + ?Sized), slot: u32, dimensions: u8) -> [f64; 3] {
    std::array::from_fn(|i| {
        if i < usize::from(dimensions) { m.get(slot + i as u32).value() } else { 0.0 }
    })
}

fn store_result<N: Number>(
    m: &mut (impl Slots<N> + ?Sized),
    access: &Access,
    result: [(f64, f64); 4],
) {
    for (i, (value, error)) in result.into_iter().take(usize::from(access.n)).enumerate() {
        let value = if access.words {
            N::from_word(value as i64 as u32)
        } else {
            N::with_error(value, error)
        };
        m.set(access.to + i as u32, value);
    }
}

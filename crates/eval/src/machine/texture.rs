//! Runs accesses to textures: finds what is bound, chooses the level, filters its texels, and stores
//! the result.
//!
//! [`combine`] filters the texels of one level. [`filter_image`] is a fast path with the same
//! arithmetic, for lookups whose texels are all in one image: a layer of a 2D texture, or the inside
//! of a face of a cube. `shim/runtime.cpp` of the package `tools` reads textures in the same way:
//! change both or none.

mod described;

pub(super) use described::describe;
pub use described::{TexelRead, TextureRead};

use crate::code::{Access, DerivativeDirection, Lod, TextureOp};
use crate::error::{Error, FindingKind};
use crate::machine::watch::Watch;
use crate::machine::{Env, Lane, derivative_lanes};
use crate::number::Number;
use crate::resources::{Address, Filter, MipLevel, Sampler, Texels, Texture, TextureDimension};
use lamplight_diagnostic::codes;

/// The precision to which devices agree on the level of detail.
const LEVEL_STEP: f64 = 1.0 / 64.0;

/// The difference of the coordinate to the neighbour in x and to the one in y.
pub type Gradient = [[f64; 3]; 2];

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
/// reached it. Gives the gradients of these.
pub(super) fn run_quad<N: Number>(
    env: Env,
    index: u32,
    lanes: &mut [Lane<N>],
    group: &[usize],
    watch: &mut Watch,
) -> Result<[Option<Gradient>; 4], Error> {
    let access = &env.program.images[index as usize];
    let coordinates: [Option<[f64; 3]>; 4] = std::array::from_fn(|lane| {
        group.contains(&lane).then(|| coordinate_of(access, &lanes[lane].memory[..]))
    });
    let mut gradients = [None; 4];
    for &lane in group {
        let gradient = Some(gradient_of(&coordinates, lane));
        let pc = lanes[lane].pc;
        apply_access(env, access, &mut lanes[lane].memory[..], gradient, (pc, watch))?;
        gradients[lane] = gradient;
    }
    Ok(gradients)
}

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
    let TextureOp::Sample { gather, .. } = access.ask else { return Ok(()) };
    let sampler = chosen_sampler(env, access, m)?;
    let footprint = footprint_of(access, texture, &sampler, m);
    let mut doubt = false;
    let result = if let Some(component) = gather {
        gathered_component(&footprint, usize::from(component), &mut doubt)
    } else {
        let level = asked_level(access, texture, m, gradient);
        between_levels(&footprint, level, &mut doubt)
    };
    if doubt {
        notes.1.note(FindingKind::Ambiguous, notes.0);
    }
    store_result(m, access, result);
    Ok(())
}

/// The sampler of an access, as the access uses it.
fn chosen_sampler<N: Number>(
    env: Env,
    access: &Access,
    m: &(impl Slots<N> + ?Sized),
) -> Result<Sampler, Error> {
    let TextureOp::Sample { sampler, clamp_to_edge, .. } = access.ask else {
        return Ok(Sampler::default());
    };
    let sampler = *bound_sampler(env, m.get(sampler).word())?;
    Ok(if clamp_to_edge { Sampler { address: Default::default(), ..sampler } } else { sampler })
}

/// What a sample depends on beside its level.
fn footprint_of<'t, N: Number>(
    access: &Access,
    texture: &'t Texture,
    sampler: &'t Sampler,
    m: &(impl Slots<N> + ?Sized),
) -> Footprint<'t, N> {
    let (offset, reference) = match access.ask {
        TextureOp::Sample { offset, reference, .. } => (offset, reference),
        _ => (None, None),
    };
    Footprint {
        texture,
        sampler,
        level: 0,
        filter: Filter::Linear,
        point: sample_point(access, texture, m, coordinate_of(access, m)),
        shift: texel_offset(access, m, offset),
        reference: reference.map(|slot| m.get(slot)),
    }
}

/// The level that a sample asks for.
fn asked_level<N: Number>(
    access: &Access,
    texture: &Texture,
    m: &(impl Slots<N> + ?Sized),
    gradient: Option<Gradient>,
) -> f64 {
    let TextureOp::Sample { level, clamp_to_edge, .. } = access.ask else { return 0.0 };
    let coordinate = coordinate_of(access, m);
    let slopes = match level {
        Lod::Gradient(x, y) => Some([x, y].map(|slot| values_at(m, slot, access.dimensions))),
        _ => gradient,
    };
    match level {
        Lod::Zero => 0.0,
        _ if clamp_to_edge => 0.0,
        Lod::Exact(slot) => m.get(slot).value(),
        Lod::Bias(slot) => detail_level(texture, coordinate, slopes) + m.get(slot).value(),
        Lod::Auto | Lod::Gradient(..) => detail_level(texture, coordinate, slopes),
    }
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

/// The precision that hardware must have for the position between two texels, which gives the
/// weights of a linear filter.
///
/// Eight bits, as Direct3D asks for and Mesa's drivers have; Vulkan alone would allow four.
const SUBTEXEL: f64 = 1.0 / 256.0;
/// The largest distance, in texels, within which texels are compared for the error of a linear
/// filter. A larger error of a coordinate does not widen this range.
const WIDEST: f64 = 2.0;

/// A place in a texture: normalised coordinates on a layer, with a bound of their errors.
#[derive(Debug, Clone, Copy)]
struct TexturePoint {
    pub shape: TextureDimension,
    pub at: [f64; 3],
    error: [f64; 3],
    pub layer: u32,
    pub face: usize,
}

/// Everything that one lookup depends on.
struct Footprint<'t, N> {
    pub texture: &'t Texture,
    pub sampler: &'t Sampler,
    pub level: usize,
    pub filter: Filter,
    pub point: TexturePoint,
    pub shift: [i64; 3],
    /// The reference that is compared with each texel before filtering. It is the left operand.
    pub reference: Option<N>,
}

/// A texel of the footprint and its weight.
struct Tap {
    weight: f64,
    texel: [f64; 4],
}

/// An axis and its sign.
type Signed = (usize, f64);

/// For each face, +x, -x, +y, -y, +z, -z: the major axis, its sign, and the axes and signs of s and
/// t.
const FACES: [(usize, f64, Signed, Signed); 6] = [
    (0, 1.0, (2, -1.0), (1, -1.0)),
    (0, -1.0, (2, 1.0), (1, -1.0)),
    (1, 1.0, (0, 1.0), (2, 1.0)),
    (1, -1.0, (0, 1.0), (2, -1.0)),
    (2, 1.0, (0, 1.0), (1, -1.0)),
    (2, -1.0, (0, -1.0), (1, -1.0)),
];

/// The place that a coordinate stands for. A direction becomes a face and a place on it.
fn project(
    shape: TextureDimension,
    coordinate: [f64; 3],
    error: [f64; 3],
    layer: u32,
) -> TexturePoint {
    if shape != TextureDimension::Cube {
        return TexturePoint { shape, at: coordinate, error, layer, face: 0 };
    }
    let size = coordinate.map(f64::abs);
    let major =
        if size[2] >= size[0] && size[2] >= size[1] { 2 } else { usize::from(size[1] >= size[0]) };
    let face = 2 * major + usize::from(coordinate[major] < 0.0);
    let (_, _, s, t) = FACES[face];
    let along = |(axis, sign): Signed| 0.5 * (sign * coordinate[axis] / size[major] + 1.0);
    let off = |(axis, _): Signed| {
        0.5 * (error[axis] + size[axis] / size[major] * error[major]) / size[major]
    };
    TexturePoint { shape, at: [along(s), along(t), 0.0], error: [off(s), off(t), 0.0], layer, face }
}

impl TexturePoint {
    /// How the place on the face changes, to first order, when the direction changes by `step`.
    pub fn slope(&self, direction: [f64; 3], step: [f64; 3]) -> [f64; 3] {
        let (major, sign, s, t) = FACES[self.face];
        let size = direction[major].abs();
        let along = |(axis, side): Signed| {
            0.5 * side * (step[axis] * size - direction[axis] * step[major] * sign) / (size * size)
        };
        [along(s), along(t), 0.0]
    }
}

/// The filtered value of each component, with its error.
///
/// A device may sample any place within the coordinate's error, and it rounds the position between
/// texels to [`SUBTEXEL`]. The sum of both is the reach. A linear filter is a continuous surface.
/// Its slope along an axis is at most the difference of two neighbouring texels. So the error is at
/// most the reach, in texels, times the largest difference of the texels within reach. These are
/// one row or column more than the filter uses, since the place may cross the centre of a texel or
/// the seam of a cube.
fn combine<N: Number>(footprint: &Footprint<N>, doubt: &mut bool) -> [(f64, f64); 4] {
    let level = &footprint.texture.levels[footprint.level];
    if !N::BOUNDED
        && let Some(values) = filter_image(footprint, level)
    {
        return values.map(|value| (value, 0.0));
    }
    let mut values = [0.0; 4];
    let mut add = |tap: Tap| {
        let Tap { weight, texel } = footprint.compared(tap, doubt);
        (0..4).for_each(|i| values[i] += weight * texel[i]);
    };
    match footprint.filter {
        Filter::Linear => add_linear(footprint, level, &mut add),
        Filter::Nearest => {
            let (texel, is_open) = nearest_texel(footprint, level);
            add(Tap { weight: 1.0, texel });
            *doubt |= is_open;
        }
    }
    if !N::BOUNDED || footprint.filter == Filter::Nearest {
        return values.map(|value| (value, 0.0));
    }
    let reach = reach_of(footprint, level);
    let slack = reach.iter().sum::<f64>().min(1.0);
    let spread = spread_within(footprint, level, reach, doubt);
    std::array::from_fn(|i| {
        let error = if spread[i] == 0.0 {
            0.0
        } else {
            spread[i] * slack + values[i].abs() * f64::from(f32::EPSILON)
        };
        (values[i], error)
    })
}

/// How far from the place a device may sample along each axis, in texels.
fn reach_of<N>(footprint: &Footprint<N>, level: &MipLevel) -> [f64; 3] {
    let (size, point) = (sizes_of(footprint, level), &footprint.point);
    std::array::from_fn(|i| if size[i] == 0.0 { 0.0 } else { point.error[i] * size[i] + SUBTEXEL })
}

/// The largest difference of two texels within reach, for each component.
fn spread_within<N: Number>(
    footprint: &Footprint<N>,
    level: &MipLevel,
    reach: [f64; 3],
    doubt: &mut bool,
) -> [f64; 4] {
    let (size, at) = (sizes_of(footprint, level), footprint.point.at);
    let side = |i: usize, reach: f64| {
        if size[i] == 0.0 { 0 } else { (at[i] * size[i] - 0.5 + reach).floor() as i64 }
    };
    let [first, last]: [[i64; 3]; 2] = [
        std::array::from_fn(|i| side(i, -reach[i].min(WIDEST))),
        std::array::from_fn(|i| {
            side(i, reach[i].min(WIDEST)).saturating_add(i64::from(size[i] > 0.0))
        }),
    ];
    let (mut low, mut high) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
    for z in first[2]..=last[2] {
        for (y, x) in (first[1]..=last[1]).flat_map(|y| (first[0]..=last[0]).map(move |x| (y, x))) {
            footprint.taps(level, [x, y, z], 1.0, &mut |tap| {
                let texel = footprint.compared(tap, doubt).texel;
                (0..4).for_each(|i| {
                    (low[i], high[i]) = (low[i].min(texel[i]), high[i].max(texel[i]))
                });
            });
        }
    }
    std::array::from_fn(|i| high[i] - low[i])
}

/// One component of the four texels that are gathered: (0, 1), (1, 1), (1, 0), (0, 0).
fn gathered_component<N: Number>(
    footprint: &Footprint<N>,
    component: usize,
    doubt: &mut bool,
) -> [(f64, f64); 4] {
    let level = &footprint.texture.levels[footprint.level];
    let base = lowest_texel(footprint, level);
    [[0, 1], [1, 1], [1, 0], [0, 0]].map(|[x, y]| {
        let texel =
            footprint.texel(level, [base[0].saturating_add(x), base[1].saturating_add(y), base[2]]);
        (footprint.compared(Tap { weight: 1.0, texel }, doubt).texel[component], 0.0)
    })
}

/// The size of the level along each axis that is filtered; 0 for the other axes.
fn sizes_of<N>(footprint: &Footprint<N>, level: &MipLevel) -> [f64; 3] {
    let depth = if footprint.point.shape == TextureDimension::D3 { level.layers } else { 0 };
    let height = if footprint.point.shape == TextureDimension::D1 { 0 } else { level.height };
    [level.width, height, depth].map(f64::from)
}

/// The texel of the footprint with the lowest coordinates.
fn lowest_texel<N>(footprint: &Footprint<N>, level: &MipLevel) -> [i64; 3] {
    let size = sizes_of(footprint, level);
    std::array::from_fn(|i| {
        if size[i] == 0.0 { 0 } else { (footprint.point.at[i] * size[i] - 0.5).floor() as i64 }
    })
}

fn add_linear<N>(footprint: &Footprint<N>, level: &MipLevel, add: &mut impl FnMut(Tap)) {
    let (size, base) = (sizes_of(footprint, level), lowest_texel(footprint, level));
    let share: [f64; 3] = std::array::from_fn(|i| {
        if size[i] == 0.0 { 0.0 } else { footprint.point.at[i] * size[i] - 0.5 - base[i] as f64 }
    });
    let corners = (0..8usize).map(|corner| [corner & 1, corner >> 1 & 1, corner >> 2]);
    for corner in corners.filter(|corner| (0..3).all(|i| corner[i] == 0 || size[i] > 0.0)) {
        let weight: f64 =
            (0..3).map(|i| if corner[i] == 1 { share[i] } else { 1.0 - share[i] }).product();
        if weight != 0.0 {
            footprint.taps(
                level,
                std::array::from_fn(|i| base[i].saturating_add(corner[i] as i64)),
                weight,
                add,
            );
        }
    }
}

/// The nearest texel, and whether the error reaches a texel that differs from it.
fn nearest_texel<N: Number>(footprint: &Footprint<N>, level: &MipLevel) -> ([f64; 4], bool) {
    let (size, point) = (sizes_of(footprint, level), &footprint.point);
    let at = |sides: [f64; 3]| {
        let coordinate = |i: usize| {
            let place = point.at[i] * size[i];
            (place + sides[i] * (point.error[i] * size[i] + place.abs() * f64::from(f32::EPSILON)))
                .floor() as i64
        };
        footprint.texel(level, std::array::from_fn(coordinate))
    };
    let texel = at([0.0; 3]);
    let side = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
    let is_open = N::BOUNDED
        && point.error != [0.0; 3]
        && (0..8).any(|corner| at([corner & 1, corner & 2, corner & 4].map(side)) != texel);
    (texel, is_open)
}

impl<N: Number> Footprint<'_, N> {
    fn compared(&self, tap: Tap, doubt: &mut bool) -> Tap {
        let (Some(reference), Some(compare)) = (self.reference, self.sampler.compare) else {
            return tap;
        };
        let pass = N::compare(compare, reference, N::from_f64(tap.texel[0]), doubt);
        Tap { texel: [f64::from(u8::from(pass)); 4], ..tap }
    }
}

impl<N: Number> Footprint<'_, N> {
    /// A texel, or the result of its comparison in each component: 1 if it passes, else 0.
    pub fn shown(&self, texel: [f64; 4]) -> [f64; 4] {
        self.compared(Tap { weight: 1.0, texel }, &mut false).texel
    }
}

impl<N> Footprint<'_, N> {
    /// Calls `add` with the texel at a column and a row, and its weight. Beyond the corner of a
    /// cube's face there is no texel: the weight is divided among the three texels that meet there.
    fn taps(&self, level: &MipLevel, at: [i64; 3], weight: f64, add: &mut impl FnMut(Tap)) {
        let inside = |i: usize| at[i].clamp(0, i64::from(level.width) - 1);
        if self.point.shape != TextureDimension::Cube || inside(0) == at[0] || inside(1) == at[1] {
            return add(Tap { weight, texel: self.texel(level, at) });
        }
        for at in [[inside(0), inside(1), 0], [at[0], inside(1), 0], [inside(0), at[1], 0]] {
            add(Tap { weight: weight / 3.0, texel: self.texel(level, at) });
        }
    }

    /// The texel at column and row (and slice), addressed as the sampler says.
    fn texel(&self, level: &MipLevel, at: [i64; 3]) -> [f64; 4] {
        level.texel(self.addressed(level, at)).unwrap_or_default()
    }

    /// Where that texel is in its level.
    fn addressed(&self, level: &MipLevel, at: [i64; 3]) -> [i64; 3] {
        let moved: [i64; 3] = std::array::from_fn(|i| at[i].saturating_add(self.shift[i]));
        match self.point.shape {
            TextureDimension::Cube => self.around(level, moved),
            TextureDimension::D3 => [0, 1, 2].map(|i| {
                wrap_address(
                    self.sampler.address[i],
                    moved[i],
                    [level.width, level.height, level.layers][i],
                )
            }),
            _ => {
                let layer = i64::from(self.point.layer.min(level.layers - 1));
                [
                    wrap_address(self.sampler.address[0], moved[0], level.width),
                    wrap_address(self.sampler.address[1], moved[1], level.height),
                    layer,
                ]
            }
        }
    }

    /// The position of a texel of a cube. Beyond the edge of its face it is on the neighbouring
    /// face.
    fn around(&self, level: &MipLevel, [x, y, _]: [i64; 3]) -> [i64; 3] {
        let side = f64::from(level.width);
        let (major, sign, s, t) = FACES[self.point.face];
        let mut direction = [0.0; 3];
        direction[major] = sign;
        direction[s.0] = s.1 * (2.0 * (x as f64 + 0.5) / side - 1.0);
        direction[t.0] = t.1 * (2.0 * (y as f64 + 0.5) / side - 1.0);
        let place = project(TextureDimension::Cube, direction, [0.0; 3], 0);
        let texel = |at: f64| ((at * side).floor() as i64).clamp(0, i64::from(level.width) - 1);
        let cube = self.point.layer.min(level.layers / 6 - 1);
        [texel(place.at[0]), texel(place.at[1]), i64::from(6 * cube) + place.face as i64]
    }
}

fn wrap_address(address: Address, at: i64, size: u32) -> i64 {
    let size = i64::from(size);
    match address {
        Address::Clamp => at.clamp(0, size - 1),
        Address::Repeat => at.rem_euclid(size),
        Address::Mirror => {
            let folded = at.rem_euclid(2 * size);
            folded.min(2 * size - 1 - folded)
        }
    }
}

/// The layer or the cube's face that a place is on.
struct LayerImage<'l> {
    texels: &'l Texels,
    /// The index of its first texel.
    first: usize,
    size: [u32; 2],
}

/// The filtered value of each component. `None` if the texels are in several images, or the texture
/// is 1D or 3D.
fn filter_image<N: Number>(footprint: &Footprint<N>, level: &MipLevel) -> Option<[f64; 4]> {
    let layer = match footprint.point.shape {
        TextureDimension::D2 => footprint.point.layer.min(level.layers - 1) as usize,
        TextureDimension::Cube => {
            let cube = footprint.point.layer.min(level.layers / 6 - 1);
            6 * cube as usize + footprint.point.face
        }
        _ => return None,
    };
    let all = level.width as usize * level.height as usize;
    let image =
        LayerImage { texels: &level.texels, first: layer * all, size: [level.width, level.height] };
    match footprint.filter {
        Filter::Linear => linear(footprint, &image),
        Filter::Nearest => nearest(footprint, &image),
    }
}

fn linear<N: Number>(footprint: &Footprint<N>, image: &LayerImage<'_>) -> Option<[f64; 4]> {
    let mut share = [0.0; 2];
    let mut places = [[0; 2]; 2];
    for axis in 0..2 {
        let place = footprint.point.at[axis] * f64::from(image.size[axis]) - 0.5;
        let base = whole_part(place);
        share[axis] = place - base as f64;
        places[axis] = [
            place_along(footprint, image, axis, base)?,
            place_along(footprint, image, axis, base.saturating_add(1))?,
        ];
    }
    let mut values = [0.0; 4];
    for [x, y] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
        let of = |axis: usize, side: usize| if side == 1 { share[axis] } else { 1.0 - share[axis] };
        let weight = of(0, x) * of(1, y);
        if weight != 0.0 {
            let texel = footprint.shown(image.at(places[0][x], places[1][y])?);
            (0..4).for_each(|i| values[i] += weight * texel[i]);
        }
    }
    Some(values)
}

fn nearest<N: Number>(footprint: &Footprint<N>, image: &LayerImage<'_>) -> Option<[f64; 4]> {
    let along = |axis: usize| {
        let place = footprint.point.at[axis] * f64::from(image.size[axis]);
        // This makes an infinite place NaN, as `filter` does where it adds an error times 0.
        let place = place + 0.0 * place.abs();
        place_along(footprint, image, axis, whole_part(place))
    };
    let texel = footprint.shown(image.at(along(0)?, along(1)?)?);
    // `filter` adds the texel to a sum that starts at 0, which turns -0 into +0.
    Some(texel.map(|value| 0.0 + value))
}

/// A column or a row of the image, as the sampler addresses it; `None` beyond a cube's face.
fn place_along<N>(
    footprint: &Footprint<N>,
    image: &LayerImage<'_>,
    axis: usize,
    at: i64,
) -> Option<usize> {
    let moved = at.saturating_add(footprint.shift[axis]);
    let size = image.size[axis];
    if footprint.point.shape == TextureDimension::Cube {
        let is_inside = |at: i64| (0..i64::from(size)).contains(&at);
        return (is_inside(at) && is_inside(moved)).then_some(moved as usize);
    }
    usize::try_from(wrap_address(footprint.sampler.address[axis], moved, size)).ok()
}

impl LayerImage<'_> {
    #[inline(always)]
    fn at(&self, x: usize, y: usize) -> Option<[f64; 4]> {
        self.texels.get(self.first + y * self.size[0] as usize + x)
    }
}

/// The largest integer that is not above a number; 0 for NaN.
#[inline(always)]
fn whole_part(x: f64) -> i64 {
    let near = x as i64;
    if near as f64 > x { near.saturating_sub(1) } else { near }
}

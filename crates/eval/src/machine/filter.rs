//! Filters the texels of one level of a texture.

use super::super::number::Number;
use super::super::resources::{Address, Filter, MipLevel, Sampler, Texture, TextureDimension};
use super::quick::filter_image;

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
pub(super) struct TexturePoint {
    pub shape: TextureDimension,
    pub at: [f64; 3],
    error: [f64; 3],
    pub layer: u32,
    pub face: usize,
}

/// Everything that one lookup depends on.
pub(super) struct Footprint<'t, N> {
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
pub(super) fn project(
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
pub(super) fn combine<N: Number>(footprint: &Footprint<N>, doubt: &mut bool) -> [(f64, f64); 4] {
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
pub(super) fn gathered_component<N: Number>(
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
        let moved: [i64; 3] = std::array::from_fn(|i| at[i].saturating_add(self.shift[i]));
        let place = match self.point.shape {
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
        };
        level.texel(place).unwrap_or_default()
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

pub(super) fn wrap_address(address: Address, at: i64, size: u32) -> i64 {
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

//! A fast path of [`super::filter`], with the same arithmetic, for lookups whose texels are all in
//! one image: a layer of a 2D texture, or the inside of a face of a cube.

use super::super::number::Number;
use super::super::resources::{Filter, MipLevel, Texels, TextureDimension};
use super::filter::{Footprint, wrap_address};

/// The layer or the cube's face that a place is on.
struct LayerImage<'l> {
    texels: &'l Texels,
    /// The index of its first texel.
    first: usize,
    size: [u32; 2],
}

/// The filtered value of each component. `None` if the texels are in several images, or the texture
/// is 1D or 3D.
pub fn filter_image<N: Number>(footprint: &Footprint<N>, level: &MipLevel) -> Option<[f64; 4]> {
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
pub fn whole_part(x: f64) -> i64 {
    let near = x as i64;
    if near as f64 > x { near.saturating_sub(1) } else { near }
}

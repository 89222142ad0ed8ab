//! Fields of light probes with visibility, for `ambient=ddgi`: Majercik, Guertin, Nowrouzezahrai,
//! McGuire, "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance Fields", 2019.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::maps::TextureMap;
use super::rays::Surfaces;
use lamplight_scene::directions;

/// Probes at the points of a grid along the axes of the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProbeGrid {
    /// Where the first probe is.
    pub origin: DVec3,
    /// Distances of neighbours along the axes, scene units, above 0.
    pub spacing: DVec3,
    /// How many along each axis, at least 2.
    pub counts: [u32; 3],
    /// How far off a surface the field is looked up, along the normal, scene units.
    pub bias: f64,
}

/// The light and the distances that the probes of a grid see.
#[derive(Debug, Clone)]
pub struct ProbeField {
    /// Where the probes are.
    pub grid: ProbeGrid,
    light: Vec<Vec<DVec3>>,
    depths: Vec<Vec<DVec2>>,
}

/// Texels along an edge of a probe's tile: of light, then of distances. A border of one texel is
/// added.
pub const PROBE_SIDES: (usize, usize) = (6, 14);
/// The rows of the quadrature over the directions of a probe.
const ROWS: usize = 12;
/// The largest number of surfaces that scatter light on its way to a probe.
const BOUNCES: usize = 3;
/// The exponent of the lobe that distances are averaged over.
const SHARPNESS: i32 = 50;
/// Directions with a weight below this are left out.
const LEAST: f64 = 1e-6;

/// What a probe sees in a direction.
struct ProbeHit {
    distance: f64,
    /// The emission of what is seen, and the light of lamps that it scatters. The light of the
    /// field is not included.
    light: DVec3,
    /// The surface, where it scatters light: its place, normal and albedo.
    surface: Option<[DVec3; 3]>,
}

impl ProbeGrid {
    /// Probes in the middles of the cells of a box.
    pub fn within(low: DVec3, high: DVec3, counts: [u32; 3]) -> Self {
        let counts = counts.map(|count| count.max(2));
        let spacing = ((high - low) / counts_vector(counts)).max(DVec3::splat(1e-3));
        Self { origin: low + 0.5 * spacing, spacing, counts, bias: 0.15 * spacing.min_element() }
    }

    fn total(&self) -> usize {
        self.counts.iter().map(|count| *count as usize).product()
    }

    fn place(&self, index: usize) -> DVec3 {
        let [across, up, _] = self.counts.map(|count| count as usize);
        let at = [index % across, index / across % up, index / (across * up)];
        self.origin + self.spacing * DVec3::from_array(at.map(|at| at as f64))
    }
}

fn counts_vector(counts: [u32; 3]) -> DVec3 {
    DVec3::from_array(counts.map(f64::from))
}

impl ProbeField {
    /// Computes what the probes of a grid see between surfaces.
    ///
    /// Parameters: `direct` the light that falls from lamps onto a point with a unit normal, as a
    /// share of what a white surface shows; `beyond` what is seen where there is no surface.
    pub fn new(
        grid: ProbeGrid,
        surfaces: &Surfaces,
        direct: &(dyn Fn(DVec3, DVec3) -> DVec3 + Sync),
        beyond: DVec3,
    ) -> Self {
        let farthest = 1.5 * grid.spacing.length();
        let directions = directions(ROWS);
        let look = |index: usize| -> Vec<ProbeHit> {
            let from = grid.place(index);
            let see = |(towards, _): &(DVec3, f64)| {
                let towards = *towards;
                let seen = ProbeHit { distance: farthest, light: beyond, surface: None };
                let Some(hit) = surfaces.hit(from, towards) else { return seen };
                let distance = hit.distance.min(farthest);
                // A probe that sees the back of a surface is inside an object. It gets no light
                // from there, and a shorter distance, so that few points see it.
                if hit.normal.dot(towards) >= 0.0 {
                    return ProbeHit { distance: 0.2 * distance, light: DVec3::ZERO, ..seen };
                }
                let at = from + towards * hit.distance + hit.normal * 1e-4;
                let light = hit.emission + hit.albedo * direct(at, hit.normal);
                ProbeHit { distance, light, surface: Some([at, hit.normal, hit.albedo]) }
            };
            directions.iter().map(see).collect()
        };
        let seen: Vec<Vec<ProbeHit>> = (0..grid.total()).into_par_iter().map(look).collect();
        let lobes = Weights::new(&directions, PROBE_SIDES.1, SHARPNESS);
        let moments = |distance: f64| DVec2::new(distance, distance * distance);
        let depths = seen
            .par_iter()
            .map(|seen| lobes.means(|index| moments(seen[index].distance)))
            .collect();
        let cosines = Weights::new(&directions, PROBE_SIDES.0, 1);
        let first = |seen: &Vec<ProbeHit>| cosines.means(|index| seen[index].light);
        let mut field = Self { grid, light: seen.par_iter().map(first).collect(), depths };
        for _ in 1..BOUNCES {
            let light = seen.par_iter().map(|seen| light_texels(seen, &field, &cosines)).collect();
            field.light = light;
        }
        field
    }

    /// The light that falls onto a point with a unit normal, as a share of what a white surface
    /// shows.
    pub fn light_at(&self, position: DVec3, normal: DVec3) -> DVec3 {
        let grid = &self.grid;
        let point = position + normal * grid.bias;
        let last = counts_vector(grid.counts) - DVec3::ONE;
        let place = ((point - grid.origin) / grid.spacing).clamp(DVec3::ZERO, last);
        let base = place.floor().min(last - DVec3::ONE);
        let share = place - base;
        let (mut sum, mut total) = (DVec3::ZERO, 0.0);
        for corner in 0..8 {
            let step = DVec3::new(
                f64::from(corner & 1),
                f64::from((corner >> 1) & 1),
                f64::from(corner >> 2),
            );
            let probe = base + step;
            let at = grid.origin + probe * grid.spacing;
            let parts = (DVec3::ONE - share) * (DVec3::ONE - step) + share * step;
            let number = probe.x
                + f64::from(grid.counts[0]) * (probe.y + f64::from(grid.counts[1]) * probe.z);
            let index = number as usize;
            let offset = point - at;
            let moments = sampled_texel(&self.depths[index], PROBE_SIDES.1, offset);
            let towards = (at - position).normalize_or(normal);
            let tri = parts.x * parts.y * parts.z;
            let weight = probe_weight(normal.dot(towards), tri, moments, offset.length());
            sum += weight * sampled_texel(&self.light[index], PROBE_SIDES.0, normal);
            total += weight;
        }
        sum / total
    }

    /// The light of all probes as a texture. Each y of the grid is a row of tiles, which hold one
    /// probe each and have a border.
    pub fn light_map(&self) -> TextureMap {
        self.map(PROBE_SIDES.0, |probe, texel| self.light[probe][texel].extend(1.0))
    }

    /// The mean distances and their mean squares, as a texture of the same layout.
    pub fn depth_map(&self) -> TextureMap {
        self.map(PROBE_SIDES.1, |probe, texel| {
            let moments = self.depths[probe][texel];
            DVec3::new(moments.x, moments.y, 0.0).extend(1.0)
        })
    }

    fn map(&self, side: usize, texel: impl Fn(usize, usize) -> glam::DVec4) -> TextureMap {
        let [across, up, deep] = self.grid.counts.map(|count| count as usize);
        let square = side + 2;
        let (width, height) = (across * deep * square, up * square);
        let at = |index: usize| {
            let (x, y) = (index % width, index / width);
            let (column, row) = (x / square, y / square);
            let probe = column % across + across * (row + up * (column / across));
            let inner = |place: usize| place as i64 - 1;
            texel(probe, wrapped_texel(inner(x % square), inner(y % square), side))
        };
        TextureMap { width, height, texels: (0..width * height).map(at).collect() }
    }
}

/// The texel of an octahedral map at a place that may be one texel outside. Beyond an edge, the map
/// continues at the same edge, mirrored about the middle of the edge.
fn wrapped_texel(x: i64, y: i64, side: usize) -> usize {
    let last = side as i64 - 1;
    let (mut x, mut y) = (x, y);
    if x < 0 || x > last {
        (x, y) = (x.clamp(0, last), last - y);
    }
    if y < 0 || y > last {
        (x, y) = (last - x, y.clamp(0, last));
    }
    x as usize + side * y as usize
}

/// The value of an octahedral map in a direction, interpolated linearly between texels.
fn sampled_texel<T>(texels: &[T], side: usize, direction: DVec3) -> T
where
    T: Copy + std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
{
    let at = (octahedral_square(direction) * 0.5 + 0.5) * side as f64 - 0.5;
    let (low, share) = (at.floor(), at - at.floor());
    let texel =
        |dx: i64, dy: i64| texels[wrapped_texel(low.x as i64 + dx, low.y as i64 + dy, side)];
    let row = |dy| texel(0, dy) * (1.0 - share.x) + texel(1, dy) * share.x;
    row(0) * (1.0 - share.y) + row(1) * share.y
}

/// The point of an octahedral map for a direction, in [-1, 1]^2: Cigolle et al., "A Survey of
/// Efficient Representations for Independent Unit Vectors", 2014.
fn octahedral_square(direction: DVec3) -> DVec2 {
    let m = direction / direction.abs().element_sum().max(1e-30);
    let e = DVec2::new(m.x, m.y);
    if m.z >= 0.0 { e } else { (DVec2::ONE - DVec2::new(e.y, e.x).abs()) * side_of(e) }
}

/// The direction for a point of an octahedral map.
fn square_direction(at: DVec2) -> DVec3 {
    let height = 1.0 - at.x.abs() - at.y.abs();
    (at - side_of(at) * (-height).max(0.0)).extend(height).normalize_or(DVec3::Z)
}

fn side_of(at: DVec2) -> DVec2 {
    let sign = |x: f64| if x >= 0.0 { 1.0 } else { -1.0 };
    DVec2::new(sign(at.x), sign(at.y))
}

/// The directions of the texels of an octahedral map.
fn texel_directions(side: usize) -> impl Iterator<Item = DVec3> {
    (0..side * side).map(move |index| {
        let at = DVec2::new((index % side) as f64, (index / side) as f64) + 0.5;
        square_direction(2.0 * at / side as f64 - 1.0)
    })
}

/// For each texel of an octahedral map: the weights of the directions of a probe, by index, and
/// their sum. Directions with next to no weight are left out.
struct Weights(Vec<(Vec<(usize, f64)>, f64)>);

impl Weights {
    fn new(directions: &[(DVec3, f64)], side: usize, sharpness: i32) -> Self {
        let texel = |towards: DVec3| {
            let weight = |(direction, angle): &(DVec3, f64)| {
                angle * direction.dot(towards).max(0.0).powi(sharpness)
            };
            let all = directions.iter().map(weight).enumerate();
            let heavy: Vec<(usize, f64)> = all.filter(|(_, weight)| *weight > LEAST).collect();
            let total = heavy.iter().map(|(_, weight)| weight).sum();
            (heavy, total)
        };
        Self(texel_directions(side).map(texel).collect())
    }

    /// The weighted mean over the directions, for each texel.
    fn means<T>(&self, of: impl Fn(usize) -> T) -> Vec<T>
    where
        T: std::iter::Sum + std::ops::Mul<f64, Output = T> + std::ops::Div<f64, Output = T>,
    {
        let mean = |(heavy, total): &(Vec<(usize, f64)>, f64)| {
            heavy.iter().map(|(index, weight)| of(*index) * *weight).sum::<T>() / *total
        };
        self.0.iter().map(mean).collect()
    }
}

/// The texels of a probe's light: what it sees, and what the surfaces scatter of the light that the
/// field has so far.
fn light_texels(seen: &[ProbeHit], field: &ProbeField, weights: &Weights) -> Vec<DVec3> {
    let scattered = |one: &ProbeHit| {
        let [at, normal, albedo] = one.surface?;
        Some(albedo * field.light_at(at, normal))
    };
    let light: Vec<DVec3> =
        seen.iter().map(|one| one.light + scattered(one).unwrap_or(DVec3::ZERO)).collect();
    weights.means(|index| light[index])
}

/// The weight of a probe, as `ddgi_weight` of the library has it.
fn probe_weight(cosine: f64, tri: f64, moments: DVec2, distance: f64) -> f64 {
    let visibility = if distance > moments.x {
        let variance = (moments.x * moments.x - moments.y).abs();
        (variance / (variance + (distance - moments.x).powi(2)).max(1e-30)).powi(3)
    } else {
        1.0
    };
    let wrapped = 0.5 * cosine + 0.5;
    let weight = ((wrapped * wrapped + 0.2) * visibility).max(1e-6);
    let crushed = if weight < 0.2 { weight.powi(3) * 25.0 } else { weight };
    crushed * tri.max(0.001)
}

//! Environments made ready for shading: spherical harmonics and filtered cube maps.

use std::f64::consts::{FRAC_PI_4, PI, TAU};
use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::view::FACES;
use crate::quadrature::gauss_legendre;
use crate::sky::Sky;

/// The nine real spherical harmonics of bands 0 to 2, in the library's order: L00, L1m1, L10, L11,
/// L2m2, L2m1, L20, L21, L22.
///
/// Parameters: `n` unit direction.
/// Source: Ramamoorthi, Hanrahan, "An Efficient Representation for Irradiance Environment Maps",
/// 2001, equation 3, with the closed forms of its constants.
pub fn sh9_basis(n: DVec3) -> [f64; 9] {
    let constant = (1.0 / (4.0 * PI)).sqrt();
    let (first, second) = ((3.0 / (4.0 * PI)).sqrt(), (15.0 / (4.0 * PI)).sqrt());
    let (zonal, sectoral) = ((5.0 / (16.0 * PI)).sqrt(), (15.0 / (16.0 * PI)).sqrt());
    [
        constant,
        first * n.y,
        first * n.z,
        first * n.x,
        second * n.x * n.y,
        second * n.y * n.z,
        zonal * (3.0 * n.z * n.z - 1.0),
        second * n.x * n.z,
        sectoral * (n.x * n.x - n.y * n.y),
    ]
}

/// The nine coefficients of an environment: the integral of its radiance times each harmonic.
///
/// Parameters: `samples` directions, their solid angles in steradians, and their radiance: those of
/// an image ([`Equirect::samples`](super::Equirect::samples)) or of a sky ([`directions`]).
/// Returns: linear RGB coefficients for `sh9_irradiance`.
/// Source: as [`sh9_basis`], equation 2.
pub fn sh9_project(samples: impl Iterator<Item = (DVec3, f64, DVec3)>) -> [DVec3; 9] {
    let mut sums = [DVec3::ZERO; 9];
    for (direction, solid_angle, radiance) in samples {
        let basis = sh9_basis(direction);
        sums.iter_mut()
            .zip(basis)
            .for_each(|(sum, harmonic)| *sum += radiance * (harmonic * solid_angle));
    }
    sums
}

/// The irradiance on a surface of normal `n`, from nine coefficients of the radiance.
///
/// Source: as [`sh9_basis`], equation 13: each band times pi, 2 pi / 3 and pi / 4.
pub fn irradiance_sh9(n: DVec3, coefficients: &[DVec3; 9]) -> DVec3 {
    let band = |index: usize| match index {
        0 => PI,
        1..=3 => TAU / 3.0,
        _ => FRAC_PI_4,
    };
    let terms = coefficients.iter().zip(sh9_basis(n)).enumerate();
    terms.map(|(index, (coefficient, harmonic))| *coefficient * (harmonic * band(index))).sum()
}

/// Directions over the whole sphere with their solid angles. A sum with them integrates polynomials
/// of a degree below twice `rows` exactly.
///
/// Returns: `2 * rows * rows` of them; the solid angles add up to 4 pi.
pub fn directions(rows: usize) -> Vec<(DVec3, f64)> {
    let columns = 2 * rows;
    let row = |(height, weight): (f64, f64)| {
        let radius = (1.0 - height * height).sqrt();
        (0..columns).map(move |column| {
            let around = TAU * (column as f64 + 0.5) / columns as f64;
            (
                DVec3::new(radius * around.cos(), height, radius * around.sin()),
                weight * TAU / columns as f64,
            )
        })
    };
    gauss_legendre(rows).into_iter().flat_map(row).collect()
}

/// Six square images in the order of [`FACES`], rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct CubeMap {
    /// Texels along an edge.
    pub size: usize,
    /// Linear RGB, face by face, row by row.
    pub texels: Vec<DVec3>,
}

impl CubeMap {
    /// An environment without a filter. Each texel is a mean of several directions, so that edges
    /// are smooth.
    pub fn of(sky: &Sky<'_>, size: usize) -> Self {
        /// Samples in a texel along each side.
        const PLACES: usize = 4;
        let fine = size * PLACES;
        let texel = |index: usize| {
            let (face, row, column) = (index / (size * size), index / size % size, index % size);
            let place = |at: usize| {
                let (x, y) = (column * PLACES + at % PLACES, row * PLACES + at / PLACES);
                sky(Self::direction(fine, face, x, y))
            };
            (0..PLACES * PLACES).map(place).sum::<DVec3>() / (PLACES * PLACES) as f64
        };
        Self { size, texels: (0..6 * size * size).into_par_iter().map(texel).collect() }
    }

    /// The direction through the middle of a texel, as every graphics API reads cube maps.
    pub fn direction(size: usize, face: usize, column: usize, row: usize) -> DVec3 {
        let (forward, up) = FACES[face.min(5)];
        let place = |index: usize| 2.0 * (index as f64 + 0.5) / size as f64 - 1.0;
        // Left-handed: seen from inside, columns run to the other side of `forward x up`.
        (forward + up.cross(forward) * place(column) - up * place(row)).normalize()
    }
}

/// An environment filtered for a Phong lobe around each direction, as a cube map.
///
/// Parameters: `exponent` of the cosine: 1 is the diffuse map, 50 and above are shiny; `size`
/// texels along an edge; `rows` of the quadrature ([`directions`]), which must grow with the
/// exponent.
/// Returns: the mean radiance, weighted by `max(cos, 0)^exponent`: a constant sky stays as it is,
/// and the diffuse map times pi is the irradiance.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, "Image-Based
/// Lighting".
pub fn prefilter(sky: &Sky<'_>, exponent: f64, size: usize, rows: usize) -> CubeMap {
    let seen: Vec<(DVec3, f64, DVec3)> = directions(rows)
        .into_iter()
        .map(|(direction, weight)| (direction, weight, sky(direction)))
        .collect();
    // Directions with a cosine below this are left out: their weight is below a billionth of the
    // largest, or they are behind the lobe.
    let outside = if exponent > 0.0 { 1e-9_f64.powf(exponent.recip()) } else { 0.0 };
    let power = power_of(exponent);
    // Each row with the height of its directions and their distance from the axis.
    let chunks = seen.chunks((2 * rows).max(1));
    let rows: Vec<_> = chunks.map(|row| (row[0].0.y, off_axis(row[0].0), row)).collect();
    let texel = |index: usize| {
        let (face, row, column) = (index / (size * size), index / size % size, index % size);
        let n = CubeMap::direction(size, face, column, row);
        let (mut sum, mut all) = (DVec3::ZERO, 0.0);
        // Most directions are outside of the lobe: of a row, only its columns near it are looked at.
        let (side, middle) = (off_axis(n), n.z.atan2(n.x));
        for (height, radius, row) in &rows {
            let (along, round) = (n.y * height, side * radius);
            for columns in columns_near(middle, (along, round), outside, row.len()) {
                for (direction, solid_angle, radiance) in &row[columns] {
                    let cosine = n.dot(*direction).max(0.0);
                    if cosine < outside {
                        continue;
                    }
                    let weight = power(cosine) * solid_angle;
                    sum += *radiance * weight;
                    all += weight;
                }
            }
        }
        sum / all
    };
    CubeMap { size, texels: (0..6 * size * size).into_par_iter().map(texel).collect() }
}

/// The power of a cosine. A whole one is a few products, which take a fraction of the time.
fn power_of(exponent: f64) -> impl Fn(f64) -> f64 {
    let whole = exponent as u32;
    let is_whole = f64::from(whole) == exponent;
    move |cosine: f64| {
        if !is_whole {
            return cosine.powf(exponent);
        }
        let (mut product, mut square, mut rest) = (1.0, cosine, whole);
        while rest > 0 {
            if rest % 2 == 1 {
                product *= square;
            }
            square *= square;
            rest /= 2;
        }
        product
    }
}

/// How far a point is from the axis that rows of [`directions`] go round.
fn off_axis(direction: DVec3) -> f64 {
    (direction.x * direction.x + direction.z * direction.z).sqrt()
}

/// The columns of a row of [`directions`] whose cosine to a direction may be at least `least`, and a few
/// more: at most two ranges in order. The direction is in the column of the angle `middle`, and the
/// cosine is `along` plus `round` times that of the angle between the columns.
fn columns_near(
    middle: f64,
    (along, round): (f64, f64),
    least: f64,
    count: usize,
) -> [Range<usize>; 2] {
    let (all, none) = ([0..count, 0..0], [0..0, 0..0]);
    if along + round < least - 1e-9 {
        return none;
    }
    if along - round >= least || round < 1e-9 {
        return all;
    }
    let half = ((least - along) / round).clamp(-1.0, 1.0).acos();
    let step = TAU / count as f64;
    let place = |angle: f64| angle / step - 0.5;
    // One more on each side, since these are rounded.
    let from = place(middle - half).floor() as i64 - 1;
    let to = place(middle + half).ceil() as i64 + 2;
    let length = (to - from) as usize;
    if length >= count {
        return all;
    }
    let start = from.rem_euclid(count as i64) as usize;
    match (start + length).checked_sub(count) {
        Some(wrapped) => [0..wrapped, start..count],
        None => [start..start + length, 0..0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The columns that are left out are outside of the lobe, for directions all over the sphere.
    #[test]
    fn columns_of_a_lobe() {
        let poles = [DVec3::Y, DVec3::NEG_Y, DVec3::X, DVec3::new(1e-12, 1.0, 0.0)];
        let others = directions(9).into_iter().map(|(direction, _)| direction);
        for n in others.chain(poles) {
            for (rows, least) in [(1, 0.5), (4, 0.0), (8, 0.2), (40, 0.85), (40, 0.999)] {
                for row in directions(rows).chunks(2 * rows) {
                    let first = row[0].0;
                    let parts = (n.y * first.y, off_axis(n) * off_axis(first));
                    let near = columns_near(n.z.atan2(n.x), parts, least, row.len());
                    assert!(near[1].is_empty() || near[0].end <= near[1].start);
                    for (column, (direction, _)) in row.iter().enumerate() {
                        let is_near = near.iter().any(|part| part.contains(&column));
                        assert!(is_near || n.dot(*direction) < least, "{n} {direction} {least}");
                    }
                }
            }
        }
    }

    #[test]
    fn powers() {
        for exponent in [0.0, 1.0, 8.0, 60.0, 128.0, 1.58, 0.5] {
            for cosine in [0.0, 1e-3, 0.5, 0.999, 1.0] {
                let (found, expected) = (power_of(exponent)(cosine), cosine.powf(exponent));
                assert!((found - expected).abs() <= 1e-13 * expected, "{cosine}^{exponent}");
            }
        }
    }
}

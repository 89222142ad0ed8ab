//! Integrals over directions by a product rule: Gauss-Legendre in the cosine, evenly spaced
//! azimuths.
//!
//! With `p` steps the rule is exact for polynomials of degree `2p - 1` in the direction's
//! components; a lobe of exponent `s` wants about `sqrt(s)` times as many.

use std::f64::consts::PI;
use std::ops::Range;

use crate::cases::Rows;
use lamplight_scene::quadrature::gauss_legendre;

/// The most calls of one law, over all its rows.
pub const MOST_CALLS: usize = 1 << 17;
/// The most rows of a case that are integrated. They differ in more than the direction.
pub const MOST_ROWS: usize = 48;

/// What an integral is over, and what it must be.
#[derive(Debug, Clone)]
pub struct Integral {
    /// The parameter that the hemisphere is around. Without it, the integral is over the whole
    /// sphere.
    pub about: Option<String>,
    /// Whether the cosine to `about` is a factor.
    pub cosine: bool,
    /// Steps in the cosine; there are twice as many azimuths.
    pub steps: usize,
    /// The largest allowed error of the sum, which covers the error of the quadrature rule.
    pub within: f64,
    /// Whether the law's number is an upper bound, so that a smaller integral is right too.
    pub at_most: bool,
}

/// A direction of the rule and its weight. The z axis of its frame is `about`.
struct QuadratureNode {
    direction: [f64; 3],
    weight: f64,
}

impl Integral {
    fn nodes(&self) -> Vec<QuadratureNode> {
        let azimuths = 2 * self.steps;
        let (low, high) = if self.about.is_some() { (0.0, 1.0) } else { (-1.0, 1.0) };
        let rings = gauss_legendre(self.steps).into_iter().flat_map(|(x, weight)| {
            let z = low + (high - low) * (x + 1.0) / 2.0;
            let (radius, factor) = ((1.0 - z * z).sqrt(), if self.cosine { z } else { 1.0 });
            let weight = weight * (high - low) / 2.0 * factor * 2.0 * PI / azimuths as f64;
            (0..azimuths).map(move |step| {
                let (sin, cos) = (2.0 * PI * (step as f64 + 0.5) / azimuths as f64).sin_cos();
                QuadratureNode { direction: [radius * cos, radius * sin, z], weight }
            })
        });
        rings.collect()
    }

    /// The rows of a case, each repeated for every direction of the rule. The direction replaces
    /// the words `direction`.
    pub fn rows(&self, rows: &Rows, direction: Range<usize>, about: Option<Range<usize>>) -> Rows {
        let nodes = self.nodes();
        let chosen =
            distinct_rows(rows, &direction, &about, MOST_ROWS.min(MOST_CALLS / nodes.len()).max(1));
        let mut words = Vec::new();
        for row in chosen {
            let axis = about
                .clone()
                .map_or(Some([0.0, 0.0, 1.0]), |about| unit_vector(&rows.row(row)[about]));
            let Some(axis) = axis else { continue };
            let frame = frame_around(axis);
            for node in &nodes {
                let mut candidate = rows.row_words(row).to_vec();
                for (word, component) in direction.clone().zip(0..3) {
                    let value: f64 = (0..3)
                        .map(|column| frame[column][component] * node.direction[column])
                        .sum();
                    candidate[word] = (value as f32).to_bits();
                }
                words.extend(candidate);
            }
        }
        rows.with_words(words)
    }

    /// The sums of one component, for each row that was integrated.
    pub fn sums(&self, values: &[f64]) -> Vec<f64> {
        let nodes = self.nodes();
        values
            .chunks(nodes.len())
            .map(|values| values.iter().zip(&nodes).map(|(value, node)| value * node.weight).sum())
            .collect()
    }

    /// How many calls one row takes.
    pub fn calls(&self) -> usize {
        2 * self.steps * self.steps
    }

    /// How far a sum is from the right one; NaN for a sum of NaN, which `max` would make 0.
    pub fn off(&self, sum: f64, wanted: f64) -> f64 {
        match self.at_most && sum <= wanted {
            true => 0.0,
            false => (sum - wanted).abs(),
        }
    }
}

/// Rows that differ in more than the direction, at most `most` of them, spread over all rows.
fn distinct_rows(
    rows: &Rows,
    direction: &Range<usize>,
    about: &Option<Range<usize>>,
    most: usize,
) -> Vec<usize> {
    let mut seen = std::collections::BTreeSet::new();
    let differs = |row: &usize| {
        let mut words = rows.row_words(*row).to_vec();
        words[direction.clone()].fill(0);
        seen.insert(words)
    };
    let has_axis = |row: &usize| {
        about.clone().is_none_or(|about| unit_vector(&rows.row(*row)[about]).is_some())
    };
    let all: Vec<usize> = (0..rows.len()).filter(has_axis).filter(differs).collect();
    let count = all.len().min(most);
    (0..count).map(|index| all[index * all.len() / count]).collect()
}

fn unit_vector(vector: &[f64]) -> Option<[f64; 3]> {
    let &[x, y, z] = vector else { return None };
    let length = (x * x + y * y + z * z).sqrt();
    (length.is_finite() && (length - 1.0).abs() < 1e-3)
        .then(|| [x / length, y / length, z / length])
}

/// A right-handed orthonormal frame whose last axis is `z`.
fn frame_around(z: [f64; 3]) -> [[f64; 3]; 3] {
    let other = if z[0].abs() < 0.6 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let x = cross(other, z);
    let length = x.iter().map(|value| value * value).sum::<f64>().sqrt();
    let x = x.map(|value| value / length);
    [x, cross(z, x), z]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

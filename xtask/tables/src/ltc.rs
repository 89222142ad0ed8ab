//! Linearly transformed cosines: for each lobe of GGX, the matrix that transforms a cosine lobe
//! into it.
//!
//! Heitz, Dupuy, Hill, Neubelt, "Real-Time Polygonal-Light Shading with Linearly Transformed
//! Cosines", 2016, section 3: the cubed difference is minimised by the method of Nelder and Mead,
//! "A Simplex Method for Function Minimization", 1965.

use std::f64::consts::PI;

use crate::quadrature::{
    Direction, d_ggx, dot, ggx_lobe, ggx_normal, mirrored, normalized, polar, viewer,
};
use crate::{Cell, SIDE, dfg};

/// Samples along each side of the grids that sample the lobe and the fit.
const SAMPLES: usize = 32;
/// Edge of the first simplex.
const STEP: f64 = 0.05;
/// Steps of the search, at most, and the difference at which it ends.
const MOST_STEPS: usize = 120;
const ENOUGH: f64 = 1e-5;
/// The least scale along an axis.
const LEAST_SCALE: f64 = 1e-7;

/// The matrix of a lobe: a frame whose z is the mean direction, times scales and a shear.
#[derive(Debug, Clone, Copy)]
pub struct Lobe {
    mean: Direction,
    /// `m11`, `m22`, `m13`.
    shape: [f64; 3],
    albedo: f64,
}

impl Lobe {
    /// Rows of the matrix in the frame of the surface.
    fn matrix(&self) -> [Direction; 3] {
        let [x, _, z] = self.mean;
        let [m11, m22, m13] = self.shape;
        // The frame's axes are (z, 0, -x), (0, 1, 0) and the mean direction.
        [[z * m11, 0.0, z * m13 + x], [0.0, m22, 0.0], [-x * m11, 0.0, z - x * m13]]
    }

    /// Density of the lobe in a direction, times its albedo.
    pub fn value(&self, l: Direction) -> f64 {
        let [m11, m22, _] = self.shape;
        let original = self.original(l);
        let length2 = dot(original, original);
        let cosine = original[2].max(0.0) / length2.sqrt();
        let jacobian = 1.0 / (m11 * m22 * length2.powf(1.5));
        self.albedo * cosine / PI * jacobian
    }

    /// The inverse matrix times a direction.
    fn original(&self, l: Direction) -> Direction {
        let [x, _, z] = self.mean;
        let [m11, m22, m13] = self.shape;
        let (along, up) = (z * l[0] - x * l[2], x * l[0] + z * l[2]);
        [(along - m13 * up) / m11, l[1] / m22, up]
    }

    fn sample(&self, u: f64, azimuth: f64) -> Direction {
        let c = polar(u.sqrt(), (1.0 - u).sqrt(), azimuth);
        let rows = self.matrix();
        normalized([dot(rows[0], c), dot(rows[1], c), dot(rows[2], c)])
    }

    /// The four numbers that `ltc_matrix` reads. They are from the inverse, scaled so that its
    /// middle entry is 1.
    pub fn numbers(&self) -> [f64; 4] {
        let column = |l: Direction| {
            let found = self.original(l);
            [found[0] * self.shape[1], found[2] * self.shape[1]]
        };
        let ([a, b], [c, d]) = (column([1.0, 0.0, 0.0]), column([0.0, 0.0, 1.0]));
        [a, b, c, d]
    }

    /// The lobe of four numbers of a table, with an albedo.
    pub fn of_numbers([a, b, c, d]: [f64; 4], albedo: f64) -> impl Fn(Direction) -> f64 {
        let determinant = a * d - b * c;
        move |l| {
            let original = [a * l[0] + c * l[2], l[1], b * l[0] + d * l[2]];
            let length2 = dot(original, original);
            let cosine = original[2].max(0.0) / length2.sqrt();
            albedo * cosine / PI * determinant / length2.powf(1.5)
        }
    }
}

/// The table, row by row of the viewer's cosine. Columns go from rough to smooth. The fit of the
/// first row, at normal incidence, starts from that of the column before. Each other row starts
/// from the row before.
pub fn rows() -> Vec<Vec<f64>> {
    let mut cells = vec![Vec::new(); SIDE * SIDE];
    let mut first: Option<Lobe> = None;
    for column in (0..SIDE).rev() {
        let mut before = first;
        for row in 0..SIDE {
            let at = Cell { column, row };
            let lobe = fitted(at, before, row == 0);
            if row == 0 {
                first = Some(lobe);
            }
            before = Some(lobe);
            cells[row * SIDE + column] = lobe.numbers().to_vec();
        }
    }
    cells
}

/// Fits a lobe, beginning with the one of a neighbour.
fn fitted(at: Cell, before: Option<Lobe>, is_isotropic: bool) -> Lobe {
    let (alpha, v) = (at.alpha(), viewer(at.nv()));
    let [scale, offset] = dfg::albedo(v[2], alpha, 48);
    let mean = if is_isotropic { [0.0, 0.0, 1.0] } else { mean_direction(v, alpha) };
    let start = before.map_or([1.0, 1.0, 0.0], |lobe| lobe.shape);
    let lobe = |shape: [f64; 3]| {
        let [m11, m22, m13] = shape;
        // At normal incidence, the lobe is rotationally symmetric.
        let shape = match is_isotropic {
            true => [m11.max(LEAST_SCALE), m11.max(LEAST_SCALE), 0.0],
            false => [m11.max(LEAST_SCALE), m22.max(LEAST_SCALE), m13],
        };
        Lobe { mean, shape, albedo: scale + offset }
    };
    let start = if is_isotropic { [start[0], start[0], 0.0] } else { start };
    lobe(least(start, |shape| difference(&lobe(shape), v, alpha)))
}

/// The mean direction of the lobe, in the plane of the viewer.
fn mean_direction(v: Direction, alpha: f64) -> Direction {
    let mut sum = [0.0; 3];
    for (l, weight) in lobe_samples(v, alpha) {
        sum = [0, 1, 2].map(|i| sum[i] + weight * l[i]);
    }
    normalized([sum[0], 0.0, sum[2]])
}

/// Directions that GGX mirrors to the viewer, each with what it adds to the albedo.
fn lobe_samples(v: Direction, alpha: f64) -> impl Iterator<Item = (Direction, f64)> {
    grid().filter_map(move |(u, azimuth)| {
        let h = ggx_normal(u, azimuth, alpha);
        let (l, vh) = (mirrored(v, h), dot(v, h));
        let is_seen = l[2] > 0.0 && vh > 0.0;
        is_seen.then(|| (l, ggx_lobe(v, l, alpha) * 4.0 * vh / (d_ggx(h[2], alpha) * h[2])))
    })
}

/// Middles of the cells of a square, the second number as an azimuth.
fn grid() -> impl Iterator<Item = (f64, f64)> {
    let middle = |index: usize| (index as f64 + 0.5) / SAMPLES as f64;
    (0..SAMPLES * SAMPLES)
        .map(move |index| (middle(index % SAMPLES), 2.0 * PI * middle(index / SAMPLES)))
}

/// The cubed difference between the lobe and its fit, over samples of both.
fn difference(lobe: &Lobe, v: Direction, alpha: f64) -> f64 {
    let wrong = |l: Direction| {
        if l[2] <= 0.0 {
            return 0.0;
        }
        let (wanted, found) = (ggx_lobe(v, l, alpha), lobe.value(l));
        let h = normalized([v[0] + l[0], v[1] + l[1], v[2] + l[2]]);
        let density = d_ggx(h[2].min(1.0), alpha) * h[2] / (4.0 * dot(v, h)).max(1e-12);
        let density = density + found / lobe.albedo;
        if density > 0.0 { (wanted - found).abs().powi(3) / density } else { 0.0 }
    };
    let sum: f64 = grid()
        .map(|(u, azimuth)| {
            let mirrored = mirrored(v, ggx_normal(u, azimuth, alpha));
            wrong(lobe.sample(u, azimuth)) + wrong(mirrored)
        })
        .sum();
    sum / (SAMPLES * SAMPLES) as f64
}

/// The minimum of a function of three numbers, near a start.
fn least(start: [f64; 3], value: impl Fn([f64; 3]) -> f64) -> [f64; 3] {
    let mut corners: Vec<([f64; 3], f64)> = (0..4)
        .map(|corner| {
            let mut at = start;
            if corner > 0 {
                at[corner - 1] += STEP;
            }
            (at, value(at))
        })
        .collect();
    for _ in 0..MOST_STEPS {
        corners.sort_by(|a, b| a.1.total_cmp(&b.1));
        let (best, worst) = (corners[0].1, corners[3].1);
        if 2.0 * (worst - best).abs() < ENOUGH * (worst.abs() + best.abs()) {
            break;
        }
        let middle =
            [0, 1, 2].map(|i| corners[..3].iter().map(|corner| corner.0[i]).sum::<f64>() / 3.0);
        let moved = |by: f64| {
            let at = [0, 1, 2].map(|i| middle[i] + by * (corners[3].0[i] - middle[i]));
            (at, value(at))
        };
        let reflected = moved(-1.0);
        let next = if reflected.1 < best {
            let expanded = moved(-2.0);
            if expanded.1 < reflected.1 { Some(expanded) } else { Some(reflected) }
        } else if reflected.1 < corners[2].1 {
            Some(reflected)
        } else {
            let contracted = if reflected.1 < worst { moved(-0.5) } else { moved(0.5) };
            (contracted.1 < worst.min(reflected.1)).then_some(contracted)
        };
        match next {
            Some(corner) => corners[3] = corner,
            None => {
                let to = corners[0].0;
                for corner in &mut corners[1..] {
                    let at = [0, 1, 2].map(|i| to[i] + 0.5 * (corner.0[i] - to[i]));
                    *corner = (at, value(at));
                }
            }
        }
    }
    corners.iter().min_by(|a, b| a.1.total_cmp(&b.1)).map_or(start, |corner| corner.0)
}

/// The share of a lobe's light that is elsewhere in its fit: half of the integral of the absolute
/// difference, divided by the albedo. Its quadrature is independent of the samples of the fit.
pub fn misplaced(numbers: [f64; 4], albedo: f64, at: Cell) -> f64 {
    let (alpha, v) = (at.alpha(), viewer(at.nv()));
    let fit = Lobe::of_numbers(numbers, albedo);
    // Samples facets of a GGX of twice the width. The quadratic substitution `x (2 - x)` moves
    // nodes to the tail, which has light where a narrow lobe is seen at a grazing angle.
    let wide = (2.0 * alpha).min(1.0);
    let steps = 192;
    let mut sum = 0.0;
    for x in 0..steps {
        let x = (x as f64 + 0.5) / steps as f64;
        for y in 0..steps {
            let azimuth = PI * (y as f64 + 0.5) / steps as f64;
            let h = ggx_normal(x * (2.0 - x), azimuth, wide);
            let (l, vh) = (mirrored(v, h), dot(v, h));
            if l[2] > 0.0 && vh > 0.0 {
                let density = d_ggx(h[2], wide) * h[2] / (4.0 * vh);
                sum += 2.0 * (1.0 - x) * (ggx_lobe(v, l, alpha) - fit(l)).abs() / density;
            }
        }
    }
    0.5 * sum / (steps * steps) as f64 / albedo
}

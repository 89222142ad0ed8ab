//! Iridescence: the model adds up two orders of interference. All orders together are Airy's formula
//! (Born, Wolf, *Principles of Optics*, 7th edition, 1999, section 7.6.1), here integrated over the
//! eye's responses, which are Gaussians over the frequency.

use std::f64::consts::PI;

use super::Calls;

/// Response, height, mean and variance: Belcour and Barla, 2017, the coefficients of the supplement.
const RESPONSES: [(usize, f64, f64, f64); 4] = [
    (0, 5.4856e-13, 1.6810e6, 4.3278e9),
    (0, 9.7470e-14, 2.2399e6, 4.5282e9),
    (1, 4.4201e-13, 1.7953e6, 9.3046e9),
    (2, 5.2481e-13, 2.2084e6, 6.6121e9),
];

const RGB: [[f64; 3]; 3] = [
    [3.2404542, -1.5371385, -0.4985314],
    [-0.9692660, 1.8760108, 0.0415560],
    [0.0556434, -0.2040259, 1.0572252],
];

/// Points of the quadrature over a response, which ends at seven standard deviations.
const POINTS: usize = 600;

/// A film in air on a grey material.
#[derive(Debug, Clone, Copy)]
struct Film {
    eta: f64,
    f0: f64,
    nm: f64,
    mu: f64,
}

/// The reflectances of a film's upper and lower side, and the phases of the light between them.
struct Sides {
    upper: f64,
    lower: f64,
    /// 1 or -1: the cosine of the phase shift of both internal reflections together.
    sign: f64,
    /// Difference of the optical paths, metres.
    difference: f64,
}

impl Film {
    fn sides(&self) -> Sides {
        let schlick = |f0: f64, mu: f64| f0 + (1.0 - f0) * (1.0 - mu).powi(5);
        let facing = |eta: f64| ((eta - 1.0) / (eta + 1.0)).powi(2);
        let inner = (1.0 - (1.0 - self.mu * self.mu) / (self.eta * self.eta)).sqrt();
        let root = self.f0.sqrt();
        let base = (1.0 + root) / (1.0 - root);
        Sides {
            upper: schlick(facing(self.eta), self.mu),
            lower: schlick(facing(base / self.eta), inner),
            // Seen from within the film, the upper side leads to a lower index, so only the lower
            // side can shift the phase.
            sign: if base < self.eta { 1.0 } else { -1.0 },
            difference: 2.0 * self.eta * self.nm * 1e-9 * inner,
        }
    }

    /// The model with any number of orders.
    fn orders(&self, count: i32) -> Result<[f64; 3], String> {
        let Sides { upper, lower, sign, difference } = self.sides();
        let (both, through) = (upper * lower, 1.0 - upper);
        let steady = through * through * lower / (1.0 - both);
        let mut sum = [upper + steady; 3];
        for order in 1..=count {
            let seen = seen_difference(f64::from(order) * difference, sign.powi(order))?;
            let height = 2.0 * (steady - through) * both.sqrt().powi(order);
            sum = [0, 1, 2].map(|i| sum[i] + height * seen[i]);
        }
        Ok(sum)
    }

    /// The spectrum of Airy's formula, as the responses see it. The constant part is white, as in the
    /// model.
    fn airy(&self) -> [f64; 3] {
        let Sides { upper, lower, sign, difference } = self.sides();
        let steady = upper + (1.0 - upper).powi(2) * lower / (1.0 - upper * lower);
        let amplitude = 2.0 * (upper * lower).sqrt();
        let mut xyz = [0.0; 3];
        for (index, height, mean, variance) in RESPONSES {
            let deviation = (2.0 * variance).sqrt();
            let scale = height * (2.0 * PI * variance).sqrt() / 1.0685e-7;
            for point in 0..POINTS {
                let x = 14.0 * ((point as f64 + 0.5) / POINTS as f64 - 0.5);
                let turn = 2.0 * PI * difference * (mean + x * deviation);
                let wave = amplitude * turn.cos() * sign;
                let reflected = (upper + lower - wave) / (1.0 + upper * lower - wave);
                let weight = (-0.5 * x * x).exp() / (2.0 * PI).sqrt() * 14.0 / POINTS as f64;
                xyz[index] += scale * weight * (reflected - steady);
            }
        }
        RGB.map(|row| steady + (0..3).map(|i| row[i] * xyz[i]).sum::<f64>())
    }
}

/// The reference of `film_sensitivity`, for a path difference in metres.
fn seen_difference(difference: f64, sign: f64) -> Result<[f64; 3], String> {
    use lamplight::check::references::{CallArguments, find_reference};
    let reference = find_reference("brdf::film", "film_sensitivity").ok_or("no reference")?;
    let found = reference(&mut CallArguments::new(&[difference * 1e9, sign, sign, sign], &[]));
    <[f64; 3]>::try_from(found.value).map_err(|found| format!("not a colour: {found:?}"))
}

/// Films on materials of these reflectances, seen at these cosines.
fn all_films(f0: &[f64], mu: &[f64]) -> Vec<Film> {
    let mut films = Vec::new();
    for eta in [1.2, 1.33, 1.5, 2.0] {
        for nm in (100..=1200).step_by(50) {
            let one = |f0: &f64| mu.iter().map(move |mu| (*f0, *mu)).collect::<Vec<_>>();
            let film = |(f0, mu)| Film { eta, f0, nm: f64::from(nm), mu };
            films.extend(f0.iter().flat_map(one).map(film));
        }
    }
    films
}

/// 200 orders are Airy's formula.
pub fn orders_sum_up(_: &mut Calls<'_>) -> Result<(), String> {
    for film in all_films(&[0.04, 0.6], &[1.0, 0.3]) {
        let (sum, airy) = (film.orders(200)?, film.airy());
        if (0..3).any(|i| (sum[i] - airy[i]).abs() > 1e-9) {
            return Err(format!("{film:?}: the orders give {sum:?}, Airy's formula {airy:?}"));
        }
    }
    Ok(())
}

/// Reflectances, cosines, and the largest difference of two orders from all orders. The error is
/// that of the third order, whose height is the third power of both amplitudes: it grows with the
/// reflectance and towards the horizon. No material has the index of a film, where the phase jumps;
/// the first has nearly that of one of them, and the error is that of the least interference.
const ERRORS: [(&[f64], &[f64], f64); 9] = [
    (&[0.02], &[1.0, 0.8, 0.5], 0.0105),
    (&[0.05, 0.08, 0.17], &[1.0, 0.8, 0.5], 0.0010),
    (&[0.05, 0.08, 0.17], &[0.3, 0.15], 0.026),
    (&[0.3, 0.5], &[1.0, 0.8, 0.5], 0.012),
    (&[0.3, 0.5], &[0.3, 0.15], 0.12),
    (&[0.6, 0.8], &[1.0, 0.8, 0.5], 0.025),
    (&[0.6, 0.8], &[0.3, 0.15], 0.19),
    (&[0.9, 0.97], &[1.0, 0.8, 0.5], 0.020),
    (&[0.9, 0.97], &[0.3, 0.15], 0.15),
];

/// The function is within these errors of Airy's formula, and the errors are no larger than they are
/// stated.
pub fn two_orders(calls: &mut Calls<'_>) -> Result<(), String> {
    let kernel = calls.kernel("brdf::film", "iridescence")?;
    for (f0, mu, stated) in ERRORS {
        let films = all_films(f0, mu);
        let row = |film: &Film| vec![1.0, film.eta, film.f0, film.f0, film.f0, film.nm, film.mu];
        let rows: Vec<_> = films.iter().map(row).collect();
        let found = calls.run(&kernel, &rows)?;
        let (found, _) = found.as_chunks::<3>();
        let error = |(film, found): (&Film, &[f64; 3])| {
            let airy = film.airy().map(|value| value.clamp(0.0, 1.0));
            (0..3).map(|i| (found[i] - airy[i]).abs()).fold(0.0, f64::max)
        };
        let worst = films.iter().zip(found).map(error).fold(0.0, f64::max);
        if worst > stated || worst < 0.8 * stated {
            let what = format!("reflectances {f0:?}, cosines {mu:?}");
            return Err(format!("{what}: off by {worst} at most, stated is {stated}"));
        }
    }
    Ok(())
}

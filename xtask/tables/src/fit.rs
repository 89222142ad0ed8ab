//! The coefficients of `brdf::energy::dfg_approx`: quotients of polynomials, fitted to quadratures
//! of the albedo of GGX: `cargo xtask fit`.
//!
//! A quotient is fitted by linear least squares, again and again: its denominator, as it was in the
//! step before, divides the residuals (Sanathanan, Koerner, "Transfer Function Synthesis as a Ratio
//! of Two Complex Polynomials", 1963). Places with large errors get larger weights, so that the
//! largest error becomes small (Lawson, "Contributions to the Theory of Linear Least Maximum
//! Approximation", 1961).

use crate::dfg;

/// The grid over the perceptual roughness and the square root of the cosine: its first values, and
/// how many there are.
const FIRST: [f64; 2] = [0.05, 0.1];
const COUNT: [usize; 2] = [58, 55];
/// Steps of the quadrature.
const STEPS: usize = 160;
/// How many fits are made, each from the one before.
const ROUNDS: usize = 1000;
/// Fits before weights change: the denominators must converge first.
const FIRST_ROUNDS: usize = 5;

/// Powers of the root of the cosine and of the roughness.
type Term = (i32, i32);

/// The light that is lost, `1 - albedo`, as the quotient `LOST` over `OVER`, whose first term has
/// the coefficient 1. Where the cosine and alpha are small, only their quotient matters, so both
/// have a total degree of at least 4.
const LOST: &[Term] = &[(2, 2), (1, 3), (0, 4), (1, 7), (0, 8)];
const OVER: &[Term] = &[(4, 0), (0, 4), (0, 6), (0, 8), (2, 2), (2, 4), (4, 2), (1, 3), (5, 3)];
/// How much more of the albedo is at grazing incidence than the mirror's `(1 - nv)^5`, relative:
/// `RIM` over `BELOW`.
const RIM: &[Term] = &[(0, 2), (0, 4), (0, 3), (4, 2)];
const BELOW: &[Term] = &[(2, 0), (1, 1), (0, 2), (0, 4)];

/// A place of the grid.
struct Place {
    nv: f64,
    roughness: f64,
    /// The scale and the offset, by quadrature.
    scale: f64,
    offset: f64,
}

impl Place {
    fn term(&self, (root, power): Term) -> f64 {
        self.nv.sqrt().powi(root) * self.roughness.powi(power)
    }

    fn albedo(&self) -> f64 {
        self.scale + self.offset
    }

    /// Schlick's Fresnel weight of a mirror.
    fn rim(&self) -> f64 {
        (1.0 - self.nv).powi(5)
    }
}

/// A quotient of polynomials.
struct Quotient {
    above: &'static [Term],
    below: &'static [Term],
    /// Of `above`, then of `below` without its first term, whose coefficient is 1.
    coefficients: Vec<f64>,
}

impl Quotient {
    fn below(&self, at: &Place) -> f64 {
        let rest = self.below[1..].iter().zip(&self.coefficients[self.above.len()..]);
        at.term(self.below[0]) + rest.map(|(term, c)| c * at.term(*term)).sum::<f64>()
    }

    fn value(&self, at: &Place) -> f64 {
        let above = self.above.iter().zip(&self.coefficients);
        above.map(|(term, c)| c * at.term(*term)).sum::<f64>() / self.below(at)
    }

    /// With coefficients of six digits, as shaders have them.
    fn rounded(mut self) -> Self {
        for coefficient in &mut self.coefficients {
            *coefficient = format!("{coefficient:.5e}").parse().unwrap_or(*coefficient);
        }
        self
    }

    /// The coefficients by the powers of the cosine and the roughness.
    fn text(&self) -> String {
        let terms = self.above.iter().chain(&self.below[1..]).zip(&self.coefficients).enumerate();
        let line = |(index, ((root, power), c)): (usize, (&Term, &f64))| {
            let part = if index < self.above.len() { "above" } else { "below" };
            format!("  {part} nv^{:.1} roughness^{power}: {c}\n", 0.5 * f64::from(*root))
        };
        terms.map(line).collect()
    }
}

/// What is fitted at a place: `factor` times the quotient is `wanted`, and errors count `weight`
/// times.
struct Goal {
    factor: f64,
    wanted: f64,
    weight: f64,
}

/// Of all rounds, the fit whose largest weighted error is the smallest.
fn fitted(
    places: &[Place],
    above: &'static [Term],
    below: &'static [Term],
    goal: impl Fn(&Place) -> Goal,
) -> Quotient {
    let goals: Vec<Goal> = places.iter().map(goal).collect();
    let sum = |at: &Place| below.iter().map(|term| at.term(*term)).sum::<f64>();
    let mut denominators: Vec<f64> = places.iter().map(sum).collect();
    let mut weights = vec![1.0; places.len()];
    let mut best = (f64::MAX, Quotient { above, below, coefficients: Vec::new() });
    for round in 0..ROUNDS {
        let row = |(index, at): (usize, &Place)| {
            let goal = &goals[index];
            let share = f64::sqrt(weights[index]) * goal.weight / denominators[index];
            let numbers = above.iter().map(|term| goal.factor * at.term(*term));
            let others = below[1..].iter().map(|term| -goal.wanted * at.term(*term));
            let row = numbers.chain(others).chain([goal.wanted * at.term(below[0])]);
            row.map(|value| value * share).collect()
        };
        let rows: Vec<Vec<f64>> = places.iter().enumerate().map(row).collect();
        let quotient = Quotient { above, below, coefficients: least_squares(&rows) };
        for (known, at) in denominators.iter_mut().zip(places) {
            // A denominator that would become negative shrinks instead.
            *known = quotient.below(at).max(0.3 * *known);
        }
        let error = |(goal, at): (&Goal, &Place)| {
            (goal.factor * quotient.value(at) - goal.wanted).abs() * goal.weight
        };
        let errors: Vec<f64> = goals.iter().zip(places).map(error).collect();
        if round >= FIRST_ROUNDS {
            weights = changed(&weights, &errors);
        }
        let most = errors.iter().copied().fold(0.0, f64::max);
        if most < best.0 && places.iter().all(|at| quotient.below(at) > 0.0) {
            best = (most, quotient);
        }
    }
    best.1
}

/// Larger weights where errors are large, with a mean of 1.
fn changed(weights: &[f64], errors: &[f64]) -> Vec<f64> {
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let changed = weights.iter().zip(errors).map(|(w, error)| w * (error / mean + 1e-3).sqrt());
    let changed: Vec<f64> = changed.collect();
    let sum: f64 = changed.iter().sum();
    changed.iter().map(|weight| weight * errors.len() as f64 / sum).collect()
}

/// The solution of an overdetermined system, whose right side is the last column, by the
/// orthogonalisation of Gram and Schmidt.
fn least_squares(rows: &[Vec<f64>]) -> Vec<f64> {
    let count = rows.first().map_or(1, Vec::len) - 1;
    let mut columns: Vec<Vec<f64>> =
        (0..=count).map(|column| rows.iter().map(|row| row[column]).collect()).collect();
    let mut triangle = vec![vec![0.0; count + 1]; count];
    for step in 0..count {
        let (before, after) = columns.split_at_mut(step + 1);
        let axis = &mut before[step];
        let length = axis.iter().map(|value| value * value).sum::<f64>().sqrt();
        axis.iter_mut().for_each(|value| *value /= length);
        triangle[step][step] = length;
        for (other, column) in after.iter_mut().enumerate() {
            let along: f64 = axis.iter().zip(column.iter()).map(|(a, b)| a * b).sum();
            column.iter_mut().zip(axis.iter()).for_each(|(value, a)| *value -= along * a);
            triangle[step][step + 1 + other] = along;
        }
    }
    let mut found = vec![0.0; count];
    for step in (0..count).rev() {
        let known: f64 = (step + 1..count).map(|other| triangle[step][other] * found[other]).sum();
        found[step] = (triangle[step][count] - known) / triangle[step][step];
    }
    found
}

/// The grid, with quadratures.
fn grid() -> Vec<Place> {
    let at = |axis: usize, index: usize| {
        FIRST[axis] + (1.0 - FIRST[axis]) * index as f64 / (COUNT[axis] - 1) as f64
    };
    let place = |index: usize| {
        let (roughness, root) = (at(0, index / COUNT[1]), at(1, index % COUNT[1]));
        let nv = root * root;
        let [scale, offset] = dfg::albedo(nv, roughness * roughness, STEPS);
        Place { nv, roughness, scale, offset }
    };
    (0..COUNT[0] * COUNT[1]).map(place).collect()
}

/// Fits both quotients, and describes them and their largest errors.
pub fn report() -> String {
    let places = grid();
    let relative =
        |at: &Place| Goal { factor: 1.0, wanted: 1.0 - at.albedo(), weight: 1.0 / at.albedo() };
    let lost = fitted(&places, LOST, OVER, relative).rounded();
    let albedo = |at: &Place| (1.0 - lost.value(at)).clamp(0.0, 1.0);
    // The offset takes half of the albedo's error, and so the scale takes the other half.
    let shared = |at: &Place| {
        let factor = at.rim() * albedo(at);
        let wanted = at.offset + 0.5 * (albedo(at) - at.albedo()) - factor;
        Goal { factor, wanted, weight: 1.0 }
    };
    let rim = fitted(&places, RIM, BELOW, shared).rounded();
    let offset = |at: &Place| (at.rim() * albedo(at) * (1.0 + rim.value(at))).min(albedo(at));
    let most =
        |error: &dyn Fn(&Place) -> f64| places.iter().map(|at| error(at).abs()).fold(0.0, f64::max);
    format!(
        "share of the albedo that is lost\n{}offset over albedo*(1 - nv)^5, less 1\n{}\
         largest errors: scale {:.5}, offset {:.5}, sum {:.5}, sum relative {:.5}\n",
        lost.text(),
        rim.text(),
        most(&|at| albedo(at) - offset(at) - at.scale),
        most(&|at| offset(at) - at.offset),
        most(&|at| albedo(at) - at.albedo()),
        most(&|at| albedo(at) / at.albedo() - 1.0),
    )
}

//! Sources: Wenzel, 2006; Quilez, 2010: the integral of the density along the view.

use super::Source::{Integral, Published};
use super::{CallArguments, Expected, ReferenceEntry};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "fog::height",
    functions: &[
        ("fog_height", Integral, depth),
        ("fog_transmittance", Published, |a| (-a.f64().max(0.0)).exp().into()),
    ],
};

/// The density is `density * exp(-falloff * (h - base))` at the height `h`. Its integral along the
/// view is the difference of the integral's values at both ends. It has none of the shader's bounds
/// on exponents, only those of the inputs and of the result.
fn depth(a: &mut CallArguments<'_>) -> Expected {
    let (y0, dy, dist) = (a.f64(), a.f64(), a.f64().clamp(0.0, 1e6));
    let (density, falloff, base) = (a.f64().clamp(0.0, 1e6), a.f64().clamp(0.0, 1e6), a.f64());
    let (from, to) = (y0 - base, y0 + dy * dist - base);
    let rise = falloff * (to - from);
    let relative = if rise.abs() < 1e-7 {
        (-falloff * from).exp() * (1.0 - 0.5 * rise)
    } else {
        difference_of_exponentials(-falloff * from, -falloff * to) / rise
    };
    // Without fog, an infinite factor must not decide.
    if density * dist == 0.0 { 0.0.into() } else { (density * dist * relative).min(1e20).into() }
}

/// `exp(a) - exp(b)`, infinite with the sign of `a - b` where both are.
fn difference_of_exponentials(a: f64, b: f64) -> f64 {
    let difference = a.exp() - b.exp();
    if difference.is_nan() { (a - b) * f64::INFINITY } else { difference }
}

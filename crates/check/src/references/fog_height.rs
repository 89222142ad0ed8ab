//! Sources: Wenzel, 2006; Quilez, 2010: the integral of the density along the view.

use super::{CallArguments, Expected, ReferenceEntry};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "fog::height",
    functions: &[
        ("fog_height", depth),
        ("fog_transmittance", |a| (-a.f64().max(0.0)).exp().into()),
    ],
};

/// The density at the eye's height times the integral of exp(-falloff*dy*t) over the distance.
fn depth(a: &mut CallArguments<'_>) -> Expected {
    let (y0, dy, dist) = (a.f64(), a.f64(), a.f64().clamp(0.0, 1e6));
    let (density, falloff, base) = (a.f64().clamp(0.0, 1e6), a.f64().max(0.0), a.f64());
    let x = (falloff * dy * dist).clamp(-60.0, 60.0);
    let here = density * (-falloff * (y0 - base)).clamp(-60.0, 60.0).exp();
    let mean = if x == 0.0 { 1.0 } else { -(-x).exp_m1() / x };
    (here * dist * mean).min(1e30).into()
}

//! Sources: Lagarde and de Rousiers, 2014, sections 4.5, 4.7 and 5.1; ISO 2720:1974; ISO
//! 12232:2006; Guy and Agopian, 2018, section 5.2.2.2.

use super::Source::{Published, Specification};
use super::{CallArguments, Expected, ReferenceEntry};
use std::f64::consts::PI;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "lighting::units",
    functions: &[
        ("intensity_point", Published, |a| (a.f64() / (4.0 * PI)).into()),
        ("intensity_spot", Published, intensity_spot),
        ("intensity_spot_filament", Published, |a| (a.f64() / PI).into()),
        ("luminance_area", Published, |a| (a.f64() / (PI * a.f64().max(f64::from(1e-12f32)))).into()),
        ("ev100", Specification, ev100),
        ("ev100_from_luminance", Specification, |a| metered(a.f64() * 100.0 / 12.5).into()),
        ("ev100_from_illuminance", Specification, |a| metered(a.f64() * 100.0 / 250.0).into()),
        ("exposure", Specification, |a| (65.0 / 78.0 * (-a.f64().clamp(-120.0, 120.0)).exp2()).into()),
    ],
};

/// The power over the cone's solid angle, 2*pi*(1 - cos).
fn intensity_spot(a: &mut CallArguments<'_>) -> Expected {
    let (lm, cosine) = (a.f64(), a.f64());
    let open = (1.0 - cosine).clamp(f64::from(1e-6f32), 2.0);
    (lm / (2.0 * PI * open)).into()
}

/// 2^EV = N^2/t at a sensitivity of 100.
fn ev100(a: &mut CallArguments<'_>) -> Expected {
    let [n, t, iso] = [a.f64(), a.f64(), a.f64()].map(|x| x.max(f64::from(1e-6f32)));
    (2.0 * n.log2() - t.log2() - (iso / 100.0).log2()).into()
}

/// EV from `x` = L*S/K, since 2^EV = L*S/K.
fn metered(x: f64) -> f64 {
    x.max(f64::from(f32::MIN_POSITIVE)).log2()
}

//! Sources: Quilez, 2010; Aaltonen, 2018.

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};
use glam::DVec2;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "shadow::sdf",
    functions: &[("sdf_soft_step", Published, soft_step), ("sdf_soft_smooth", Published, |a| smooth(a.f64()).into())],
};

/// The circles of two steps, one `ph` behind the other, meet at a point beside the ray; its
/// distance from the ray over that along the ray is the cone's slope.
fn soft_step(a: &mut CallArguments<'_>) -> Expected {
    let (res, h, ph, t, k) =
        (a.f64().clamp(0.0, 1.0), a.f64().max(0.0), a.f64(), a.f64(), a.f64().max(0.0));
    let place = if ph > 0.0 && h < 2.0 * ph {
        // x^2 + y^2 = ph^2 and (x - ph)^2 + y^2 = h^2.
        let x = (2.0 * ph * ph - h * h) / (2.0 * ph);
        DVec2::new(t - ph + x, (ph * ph - x * x).max(0.0).sqrt())
    } else {
        DVec2::new(t, h)
    };
    let slope = if place.x > 0.0 { k * place.y / place.x } else { f64::INFINITY };
    DVec2::new(res.min(slope).max(0.0), h).into()
}

/// The integral of 3/4*(1 - x^2) from -1 to `share`.
fn smooth(share: f64) -> f64 {
    let x = share.clamp(-1.0, 1.0);
    0.5 + 0.75 * x - 0.25 * x.powi(3)
}

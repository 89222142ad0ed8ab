//! Sources: Lagarde and de Rousiers, 2014, section 4.10.2; Jimenez et al., 2016, equations 7 and
//! 10; Russell, 2015; Roberts, 2018; Chapman, 2013.

use super::Source::{Integral, Published};
use super::{CallArguments, Expected, ReferenceEntry};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, TAU};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "ambient::occlusion",
    functions: &[
        ("specular_occlusion", Published, specular),
        ("multibounce", Published, multibounce),
        ("horizon_occlusion", Published, horizon),
        ("gtao_arc", Integral, gtao_arc),
        ("gtso", Published, gtso),
        ("ssao_kernel", Published, |a| kernel(a.f64(), a.f64()).into()),
    ],
};

fn specular(a: &mut CallArguments<'_>) -> Expected {
    let [nv, ao, alpha] = [a.f64(), a.f64(), a.f64()].map(|x| x.clamp(0.0, 1.0));
    ((nv + ao).powf((-16.0 * alpha - 1.0).exp2()) - 1.0 + ao).clamp(0.0, 1.0).into()
}

/// The cubic polynomial of the visibility whose coefficients are linear in the albedo.
fn multibounce(a: &mut CallArguments<'_>) -> Expected {
    let (v, albedo) = (a.f64().clamp(0.0, 1.0), a.vec3().clamp(DVec3::ZERO, DVec3::ONE));
    Expected::words(albedo.to_array().map(|rho| {
        let cubic = (2.0404 * rho - 0.3324) * v.powi(3)
            + (-4.7951 * rho + 0.6417) * v.powi(2)
            + (2.7552 * rho + 0.6903) * v;
        cubic.clamp(v, 1.0)
    }))
}

fn horizon(a: &mut CallArguments<'_>) -> Expected {
    let (r, n, k) = (a.vec3(), a.vec3(), a.f64().max(0.0));
    (1.0 + k * r.dot(n)).clamp(0.0, 1.0).powi(2).into()
}

/// The integral of cos(t - gamma)*|sin(t)| from the viewer's direction, 0, to the horizon.
fn gtao_arc(a: &mut CallArguments<'_>) -> Expected {
    let (h, gamma) = (a.f64(), a.f64());
    let h = h.clamp(gamma - FRAC_PI_2, gamma + FRAC_PI_2);
    const STEPS: u32 = 500;
    // Simpson's rule: the integrand is smooth between the ends.
    let value = |t: f64| (t - gamma).cos() * t.sin();
    let width = h / f64::from(STEPS);
    let weight = |i: u32| {
        if i == 0 || i == STEPS {
            1.0
        } else if i % 2 == 1 {
            4.0
        } else {
            2.0
        }
    };
    let sum: f64 = (0..=STEPS).map(|i| weight(i) * value(width * f64::from(i))).sum();
    (sum * width / 3.0).into()
}

/// A cosine-distributed direction from point `i` of the sequence R2: fractional parts of 1/2 + i/p
/// and 1/2 + i/p^2, with the plastic number p. Its length grows from 0.1 to 1 with the square of
/// i/count.
fn kernel(i: f64, count: f64) -> DVec3 {
    let p = 1.324717957244746;
    let (x, y) = ((0.5 + i / p).rem_euclid(1.0), (0.5 + i / (p * p)).rem_euclid(1.0));
    let (radius, phi) = (x.sqrt(), TAU * y);
    let share = (i / count.max(1.0)).min(1.0);
    DVec3::new(radius * phi.cos(), radius * phi.sin(), (1.0 - x).sqrt())
        * (0.1 + 0.9 * share * share)
}

/// `log2(10)` with the digits that Filament publishes.
#[expect(clippy::approx_constant, reason = "the published digits are compared with")]
const LOG2_OF_10: f64 = 3.321928;

/// The share of the cone of the reflection lobe that lies in the cone of the unoccluded directions.
/// The area that both caps share is the smaller cap where one contains the other, 0 where they are
/// apart, and smoothly between otherwise. The effect fades out for small alpha.
fn gtso(a: &mut CallArguments<'_>) -> Expected {
    let (bent, r) = (a.vec3(), a.vec3());
    let [ao, alpha] = [a.f64(), a.f64()].map(|x| x.clamp(0.0, 1.0));
    let step = |from: f64, to: f64, x: f64| {
        let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    };
    let (open, lobe) = ((1.0 - ao).sqrt().acos(), (-LOG2_OF_10 * alpha * alpha).exp2().acos());
    let apart = bent.dot(r).clamp(-1.0, 1.0).acos();
    let cap = |angle: f64| 1.0 - angle.cos();
    let both = if apart <= (open - lobe).abs() {
        cap(open.min(lobe))
    } else if apart >= open + lobe {
        0.0
    } else {
        cap(open.min(lobe)) * (1.0 - step((open - lobe).abs(), open + lobe, apart))
    };
    let share = if lobe == 0.0 { 1.0 } else { both / cap(lobe) };
    (1.0 + (share - 1.0) * step(0.01, 0.09, alpha)).into()
}

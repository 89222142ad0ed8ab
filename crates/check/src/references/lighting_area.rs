//! Sources: Lambert, "Photometria", 1760; Heitz, Dupuy, Hill and Neubelt, "Real-Time
//! Polygonal-Light Shading with Linearly Transformed Cosines", 2016; Lagarde and de Rousiers,
//! "Moving Frostbite to Physically Based Rendering", 2014, section 4.7; Karis, "Real Shading in
//! Unreal Engine 4", 2013; Heitz and Hill, 2017 (lines and disks).

use super::Source::{Integral, Published};
use super::{CallArguments, Expected, ReferenceEntry};
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::PI;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "lighting::area",
    functions: &[
        ("ltc_edge", Published, |a| edge(a.vec3(), a.vec3()).into()),
        ("any_tangent", Published, |a| any_tangent(a.vec3()).into()),
        ("ltc_rect", Integral, ltc_rect),
        ("ltc_disk", Integral, ltc_disk),
        ("ltc_line", Integral, ltc_line),
        ("ltc_uv", Published, |a| ltc_uv(a.f64(), a.f64()).into()),
        ("ltc_matrix", Published, ltc_matrix),
        ("sphere_irradiance", Integral, |a| sphere(a.f64(), a.f64()).into()),
        ("disk_irradiance", Integral, disk),
        ("nearest_sphere", Published, |a| nearest_sphere(a.vec3(), a.vec3(), a.f64()).into()),
        ("nearest_tube", Published, nearest_tube),
        ("area_alpha", Published, area_alpha),
        ("area_energy", Published, |a| area_energy(a.f64(), a.f64()).into()),
    ],
};

/// The vector irradiance of an edge: the angle between both directions over 2 pi, along the normal
/// of their plane. `atan2` gives the angle from its tangent.
fn edge(a: DVec3, b: DVec3) -> DVec3 {
    let normal = a.cross(b);
    normal.normalize_or_zero() * normal.length().atan2(a.dot(b)) / (2.0 * PI)
}

/// A unit vector perpendicular to `n`: its cross product with x, or with y where `n` is too near to
/// x.
fn any_tangent(n: DVec3) -> DVec3 {
    let axis = if n.x.abs() > f64::from(0.6f32) { DVec3::Y } else { DVec3::X };
    n.cross(axis).normalize_or_zero()
}

/// The integral over a quadrilateral.
fn ltc_rect(a: &mut CallArguments<'_>) -> Expected {
    let (n, v, p, minv) = (a.vec3(), a.vec3(), a.vec3(), a.mat3());
    let frame = frame_of(n, v);
    let corners: Vec<DVec3> = (0..4).map(|_| frame * (a.vec3() - p)).collect();
    lobe_integral(&corners, minv).into()
}

/// The integral of a transformed cosine over a convex polygon of the frame of the normal. Below the
/// horizon of the surface there is no light, and below that of the lobe the lobe is 0, so the polygon
/// is cut at both. Of the rest, each edge has its part (Lambert).
fn lobe_integral(corners: &[DVec3], minv: DMat3) -> f64 {
    let transformed: Vec<DVec3> = above(corners).into_iter().map(|corner| minv * corner).collect();
    let unit: Vec<DVec3> =
        above(&transformed).into_iter().map(|corner| corner.normalize_or_zero()).collect();
    let around = unit.iter().zip(unit.iter().cycle().skip(1));
    let sum: f64 = around.map(|(a, b)| edge(*a, *b).z).sum();
    (-sum).clamp(0.0, 1.0)
}

/// The part of a polygon with a positive z, by Sutherland and Hodgman.
fn above(corners: &[DVec3]) -> Vec<DVec3> {
    let mut found = Vec::new();
    for (index, &corner) in corners.iter().enumerate() {
        let next = corners[(index + 1) % corners.len()];
        if corner.z >= 0.0 {
            found.push(corner);
        }
        if (corner.z > 0.0 && next.z < 0.0) || (corner.z < 0.0 && next.z > 0.0) {
            found.push(corner.lerp(next, corner.z / (corner.z - next.z)));
        }
    }
    found
}

/// Maps [0, 1] to the range between the centres of the first and the last of 64 texels.
fn ltc_uv(nv: f64, roughness: f64) -> DVec2 {
    let texel = |x: f64| (0.5 + 63.0 * x) / 64.0;
    DVec2::new(texel(roughness.clamp(0.0, 1.0)), texel((1.0 - nv.clamp(0.0, 1.0)).sqrt()))
}

fn ltc_matrix(a: &mut CallArguments<'_>) -> Expected {
    let t = a.vec4();
    DMat3::from_cols_array_2d(&[[t.x, 0.0, t.y], [0.0, 1.0, 0.0], [t.z, 0.0, t.w]]).into()
}

/// The integral of the cosine over the cap, ring by ring about its axis.
fn sphere(mu: f64, sin2: f64) -> f64 {
    let (mu, sine) = (mu.clamp(-1.0, 1.0), sin2.clamp(0.0, 1.0).sqrt());
    let (theta, cap) = (mu.acos(), sine.asin());
    // A ring at the angle t, all azimuths: the cosine is m + s*cos(azimuth), where it is positive.
    let ring = |t: f64| {
        let (m, s) = (mu * t.cos(), theta.sin() * t.sin());
        let half = if m >= s {
            PI
        } else if m <= -s {
            0.0
        } else {
            (-m / s).acos()
        };
        2.0 * (m * half + s * half.sin()) * t.sin()
    };
    // At one angle the rings begin to cross the horizon. The integrand is smooth on either side of
    // it.
    let border = (theta - PI / 2.0).abs().min(cap);
    smooth_integral(0.0, border, ring) + smooth_integral(border, cap, ring)
}

/// The midpoint rule after the substitution x = u - sin(2*pi*u)/(2*pi), which converges fast for
/// integrands with square roots at the ends.
fn smooth_integral(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    const STEPS: u32 = 128;
    let step = |index: u32| {
        let u = (f64::from(index) + 0.5) / f64::from(STEPS);
        let turn = 2.0 * PI * u;
        f(from + (to - from) * (u - turn.sin() / (2.0 * PI))) * (1.0 - turn.cos())
    };
    (to - from) * (0..STEPS).map(step).sum::<f64>() / f64::from(STEPS)
}

fn disk(a: &mut CallArguments<'_>) -> Expected {
    let (mu, facing, sin2) = (a.f64(), a.f64(), a.f64());
    (sphere(mu, sin2) * facing.clamp(0.0, 1.0)).into()
}

/// The point of the ray that is nearest to the centre `l`, or where that is outside the sphere, the
/// sphere's point towards it.
fn nearest_sphere(l: DVec3, r: DVec3, radius: f64) -> DVec3 {
    let to_ray = r * l.dot(r).max(0.0) - l;
    l + to_ray.clamp_length_max(radius.max(0.0))
}

/// The sphere around the point of the segment that is nearest to the ray, with the place t =
/// ((r.l0)*(r.d) - l0.d)/(|d|^2 - (r.d)^2) along the segment.
fn nearest_tube(a: &mut CallArguments<'_>) -> Expected {
    let (l0, l1, r, radius) = (a.vec3(), a.vec3(), a.vec3(), a.f64());
    let d = l1 - l0;
    let below = d.length_squared() * r.length_squared() - r.dot(d).powi(2);
    let along = (r.dot(l0) * r.dot(d) - l0.dot(d)) / below;
    let t = if below > 1e-9 * d.length_squared() { along.clamp(0.0, 1.0) } else { 0.0 };
    nearest_sphere(l0 + d * t, r, radius).into()
}

fn area_alpha(a: &mut CallArguments<'_>) -> Expected {
    let (alpha, radius, d) = (a.f64(), a.f64().max(0.0), a.f64());
    let added = if radius == 0.0 { 0.0 } else { radius / (2.0 * d.max(0.0)) };
    (alpha + added).clamp(0.0, 1.0).into()
}

/// (alpha/wide)^2, at most 1.
fn area_energy(alpha: f64, wide: f64) -> f64 {
    if wide <= alpha {
        1.0
    } else {
        (alpha.max(0.0) / wide.max(f64::from(f32::MIN_POSITIVE))).powi(2)
    }
}

/// The frame whose z is the normal and whose x is the viewer's direction along the surface.
fn frame_of(n: DVec3, v: DVec3) -> DMat3 {
    let t1 = (v - n * v.dot(n)).try_normalize().unwrap_or(any_tangent(n));
    DMat3::from_cols(t1, n.cross(t1), n).transpose()
}

/// The integral over a polygon of so many corners on the ellipse that it is one for f32.
fn ltc_disk(a: &mut CallArguments<'_>) -> Expected {
    const CORNERS: u32 = 4096;
    let (n, v, p, minv) = (a.vec3(), a.vec3(), a.vec3(), a.mat3());
    let frame = frame_of(n, v);
    let (c, x, y) = (frame * (a.vec3() - p), frame * a.vec3(), frame * a.vec3());
    if c.dot(x.cross(y)) >= 0.0 {
        return 0.0.into();
    }
    // Corners as far outside as the middles of the edges are inside: the area is that of the ellipse.
    let turn = 2.0 * PI / f64::from(CORNERS);
    let reach = (turn / turn.sin()).sqrt();
    let corner = |index| {
        let (sine, cosine) = (turn * f64::from(index)).sin_cos();
        c + (x * cosine + y * sine) * reach
    };
    let corners: Vec<DVec3> = (0..CORNERS).map(corner).collect();
    lobe_integral(&corners, minv).into()
}

/// The integral of the transformed lobe along the part of the line that is above the horizon of the
/// surface. Each point has the solid angle of a strip as wide as the diameter.
fn ltc_line(a: &mut CallArguments<'_>) -> Expected {
    let (n, v, p, minv) = (a.vec3(), a.vec3(), a.vec3(), a.mat3());
    let frame = frame_of(n, v);
    let (head, tail) = (frame * (a.vec3() - p), frame * (a.vec3() - p));
    let radius = a.f64().max(0.0);
    let [head, tail] = match above(&[head, tail])[..] {
        [head, tail] | [head, tail, _] => [head, tail],
        _ => return 0.0.into(),
    };
    const STEPS: u32 = 4096;
    let step = |index: u32| {
        let at = head.lerp(tail, (f64::from(index) + 0.5) / f64::from(STEPS));
        let inside = minv * at.normalize_or_zero();
        let lobe = inside.z.max(0.0) / inside.length_squared().powi(2);
        let width = 2.0 * radius * at.cross(tail - head).length() / at.length().powi(3);
        if lobe.is_finite() { lobe * width } else { 0.0 }
    };
    let sum = (0..STEPS).map(step).sum::<f64>() / f64::from(STEPS);
    (sum * minv.determinant() / PI).clamp(0.0, 1.0).into()
}

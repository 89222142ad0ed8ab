//! Sources: Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment
//! Maps", 2001, equations 3 and 13; OpenGL Programming Guide, equation 7.1.

use super::{Arguments, Entry, Expected};
use glam::DVec3;

pub const REFERENCES: Entry = Entry {
    module: "ambient::sh",
    functions: &[
        ("sh9_irradiance", |a| irradiance(a, 9).into()),
        ("sh9_irradiance_clamped", |a| irradiance(a, 9).max(DVec3::ZERO).into()),
        ("sh4_irradiance", |a| irradiance(a, 4).into()),
        ("sh9_basis", |a| Expected::words(basis(a.vec3()))),
    ],
};

/// Equation 3, in the order L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
fn basis(n: DVec3) -> [f64; 9] {
    let (x, y, z) = (n.x, n.y, n.z);
    [
        0.282095,
        0.488603 * y,
        0.488603 * z,
        0.488603 * x,
        1.092548 * x * y,
        1.092548 * y * z,
        0.315392 * (3.0 * z * z - 1.0),
        1.092548 * x * z,
        0.546274 * (x * x - y * y),
    ]
}

/// Equation 13, as printed with c1 to c5, over the first `count` coefficients.
fn irradiance(a: &mut Arguments<'_>, count: usize) -> DVec3 {
    let n = a.vec3();
    let mut sh = [DVec3::ZERO; 9];
    sh[..count].iter_mut().for_each(|coefficient| *coefficient = a.vec3());
    let [l00, l1m1, l10, l11, l2m2, l2m1, l20, l21, l22] = sh;
    let (x, y, z) = (n.x, n.y, n.z);
    let [c1, c2, c3, c4, c5] = [0.429043, 0.511664, 0.743125, 0.886227, 0.247708];
    c1 * l22 * (x * x - y * y) + c3 * l20 * z * z + c4 * l00 - c5 * l20
        + 2.0 * c1 * (l2m2 * x * y + l21 * x * z + l2m1 * y * z)
        + 2.0 * c2 * (l11 * x + l1m1 * y + l10 * z)
}

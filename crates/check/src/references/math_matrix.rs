//! Sources: the definition of the inverse; the normal matrix as all the books have it: the inverse
//! transpose of the upper 3x3 part.

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};
use glam::DMat3;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "math::matrix",
    functions: &[("inverse3", Published, |a| inverse(a.mat3()).into()), ("normal_matrix", Published, normal_matrix)],
};

/// The inverse; zero for a matrix whose determinant is below the normal numbers of f32.
fn inverse(m: DMat3) -> DMat3 {
    if is_singular(m) { DMat3::ZERO } else { m.inverse() }
}

/// The inverse transpose of the upper 3x3 part. For a singular one, the matrix of cofactors, which
/// still turns normals correctly.
fn normal_matrix(a: &mut CallArguments<'_>) -> Expected {
    let m = DMat3::from_mat4(a.mat4());
    if !is_singular(m) {
        return m.inverse().transpose().into();
    }
    let minor = |row: usize, column: usize| {
        let at = |r: usize, c: usize| m.col((column + c) % 3)[(row + r) % 3];
        at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)
    };
    Expected::words((0..9).map(|word| minor(word % 3, word / 3)))
}

fn is_singular(m: DMat3) -> bool {
    m.determinant().abs() < f64::from(f32::MIN_POSITIVE)
}

//! Views: from world space to the space of a camera or a light.

use glam::{DMat3, DMat4, DVec3};

/// The view of an eye that looks at a point.
///
/// Parameters: `eye`, `target` in world space, scene units; `up` any direction, world space.
/// Returns: world to view space. The identity's rotation where `eye` and `target` are one point.
/// Edges: an `up` along the line of sight is replaced by the axis farthest from it.
pub fn look_at(eye: DVec3, target: DVec3, up: DVec3) -> DMat4 {
    look_along(eye, target - eye, up)
}

/// [`look_at`] by a direction, which need not be of unit length: a directional light's view.
pub fn look_along(eye: DVec3, direction: DVec3, up: DVec3) -> DMat4 {
    let Some(forward) = direction.try_normalize() else { return DMat4::from_translation(-eye) };
    let side = forward
        .cross(up)
        .try_normalize()
        .filter(|_| forward.cross(up.normalize_or_zero()).length() > 1e-6);
    let right = side.unwrap_or_else(|| forward.cross(farthest_axis(forward)).normalize());
    let rotation = DMat3::from_cols(right, right.cross(forward), -forward).transpose();
    DMat4::from_mat3(rotation) * DMat4::from_translation(-eye)
}

fn farthest_axis(direction: DVec3) -> DVec3 {
    let size = direction.abs();
    if size.x <= size.y && size.x <= size.z {
        DVec3::X
    } else if size.y <= size.z {
        DVec3::Y
    } else {
        DVec3::Z
    }
}

/// The view of a light that stands at `origin`, turned by `angles` about x, then y, then z.
///
/// Parameters: `origin` in world space, scene units; `angles` in radians.
/// Returns: `Rx(-x) * Ry(-y) * Rz(-z) * T(-origin)`, world to view space.
/// Source: Igalia, "Working with lights and shadows", part II; the inverse of
/// `T(origin) * Rz(z) * Ry(y) * Rx(x)`.
pub fn from_angles(origin: DVec3, angles: DVec3) -> DMat4 {
    DMat4::from_rotation_x(-angles.x)
        * DMat4::from_rotation_y(-angles.y)
        * DMat4::from_rotation_z(-angles.z)
        * DMat4::from_translation(-origin)
}

/// The faces of a cube map in the order of all graphics APIs, each with its direction and the
/// direction in which its rows go up, in world space.
pub const FACES: [(DVec3, DVec3); 6] = [
    (DVec3::X, DVec3::Y),
    (DVec3::NEG_X, DVec3::Y),
    (DVec3::Y, DVec3::NEG_Z),
    (DVec3::NEG_Y, DVec3::Z),
    (DVec3::Z, DVec3::Y),
    (DVec3::NEG_Z, DVec3::Y),
];

/// The view of one face of a point light's cube, by its index in [`FACES`], from `origin`.
///
/// Cube maps are left-handed: seen from inside, a face's columns run to the left of this
/// right-handed view. What is drawn with it is therefore mirrored in x, and triangles wind the
/// other way round.
///
/// Returns: world to the face's view space, x mirrored; the sixth face for any index above 5.
pub fn cube_view(origin: DVec3, face: usize) -> DMat4 {
    let (direction, up) = FACES[face.min(5)];
    DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)) * look_along(origin, direction, up)
}

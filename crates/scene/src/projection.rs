//! Projections of cameras and lights, for each API's clip space.

use glam::{DMat4, DVec3, DVec4};

/// A clip space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Clip {
    /// WebGPU, Metal and Direct3D: y up, depth from 0 to 1, texture rows from the top.
    Wgpu,
    /// Vulkan without a flipped viewport: y down, depth from 0 to 1, texture rows from the top.
    Vulkan,
    /// OpenGL: y up, depth from -1 to 1, texture rows from the bottom.
    OpenGl,
}

/// Which end of the depth range is near.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Depth {
    /// The near plane has the lowest depth of the clip space: 0, or -1 in OpenGL. The far plane has
    /// 1.
    Normal,
    /// Near is 1: with floating-point depth buffers the precision is spread evenly.
    Reversed,
}

impl Clip {
    /// Depths in normalised device coordinates of the near and the far plane.
    pub(super) fn depths(self, depth: Depth) -> (f64, f64) {
        let low = if self == Self::OpenGl { -1.0 } else { 0.0 };
        match depth {
            Depth::Normal => (low, 1.0),
            Depth::Reversed => (1.0, low),
        }
    }

    fn up(self) -> f64 {
        if self == Self::Vulkan { -1.0 } else { 1.0 }
    }
}

/// A perspective projection: cameras, spot lights.
///
/// Parameters: `fov_y` the whole vertical angle, radians, in (0, pi); `aspect` width over height;
/// `near`, `far` distances along -z, scene units, `0 < near < far`.
/// Returns: view to clip space.
pub fn perspective(
    fov_y: f64,
    aspect: f64,
    near: f64,
    far: f64,
    clip: Clip,
    depth: Depth,
) -> DMat4 {
    let (at_near, at_far) = clip.depths(depth);
    let scale = 1.0 / (0.5 * fov_y).tan();
    let slope = (far * at_far - near * at_near) / (near - far);
    DMat4::from_cols(
        DVec4::new(scale / aspect, 0.0, 0.0, 0.0),
        DVec4::new(0.0, clip.up() * scale, 0.0, 0.0),
        DVec4::new(0.0, 0.0, slope, -1.0),
        DVec4::new(0.0, 0.0, near * (at_near + slope), 0.0),
    )
}

/// An orthographic projection of a box in view space: directional lights.
///
/// Parameters: `bounds` the box, scene units, no side of it zero.
/// Returns: view to clip space.
pub fn orthographic(bounds: &super::Bounds, clip: Clip, depth: Depth) -> DMat4 {
    let (at_near, at_far) = clip.depths(depth);
    let (width, height) = (bounds.right - bounds.left, bounds.top - bounds.bottom);
    let slope = (at_far - at_near) / (bounds.near - bounds.far);
    DMat4::from_cols(
        DVec4::new(2.0 / width, 0.0, 0.0, 0.0),
        DVec4::new(0.0, clip.up() * 2.0 / height, 0.0, 0.0),
        DVec4::new(0.0, 0.0, slope, 0.0),
        DVec4::new(
            -(bounds.right + bounds.left) / width,
            -clip.up() * (bounds.top + bounds.bottom) / height,
            at_near + bounds.near * slope,
            1.0,
        ),
    )
}

/// The projection of each face of a point light's cube: 90 degrees in both directions.
///
/// The source's 45 degrees are the half angle.
///
/// Source: Igalia, "Working with lights and shadows", part II, corrected.
pub fn cube_projection(near: f64, far: f64, clip: Clip, depth: Depth) -> DMat4 {
    perspective(std::f64::consts::FRAC_PI_2, 1.0, near, far, clip, depth)
}

/// From world space to a shadow map: texture coordinates and the depth that the map holds.
///
/// Parameters: `projection` for the same clip space, `view` of the light.
/// Returns: a matrix whose result, divided by w, is `(u, v, depth)`, each in [0, 1] on the map.
/// Source: Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th edition, 2016, examples 7.16
/// and 7.19; its bias matrix is OpenGL's alone.
pub fn shadow_matrix(projection: DMat4, view: DMat4, clip: Clip) -> DMat4 {
    let (scale, offset) = match clip {
        Clip::Wgpu => (DVec3::new(0.5, -0.5, 1.0), DVec3::new(0.5, 0.5, 0.0)),
        Clip::Vulkan => (DVec3::new(0.5, 0.5, 1.0), DVec3::new(0.5, 0.5, 0.0)),
        Clip::OpenGl => (DVec3::splat(0.5), DVec3::splat(0.5)),
    };
    DMat4::from_translation(offset) * DMat4::from_scale(scale) * projection * view
}

/// What polygon offset adds to a depth: `factor * slope + units * resolution`.
///
/// Parameters: `slope` the larger of |dz/dx| and |dz/dy| of the triangle, in window space;
/// `resolution` the smallest step of the depth format, `1 / (2^bits - 1)` for fixed point.
/// Returns: the offset, in window depth; the usual (2, 4) pushes away from the light.
/// Source: The Khronos Group, OpenGL 4.6 specification, section 14.6.5.
pub fn polygon_offset(factor: f64, units: f64, slope: f64, resolution: f64) -> f64 {
    factor * slope + units * resolution
}

//! What a listing is to the tests: what its vertex shader passes on, and the colour that its
//! fragment shader writes.

use glam::{DVec3, DVec4};

use super::geometry::Corner;
use super::numbers::Given;

/// What a vertex shader passes to the fragment shader: one entry for each `out`.
pub type Passed = Vec<DVec4>;

/// Where a fragment is.
#[derive(Debug, Clone, Copy)]
pub struct Fragment {
    /// Column and row of the pixel, from the upper left.
    pub pixel: [u32; 2],
    /// Whether the front of the triangle is seen.
    pub front: bool,
    /// Whether numbers of 32 bits are rounded as IEEE 754 says, sines included.
    pub exact: bool,
}

/// The two shaders of a listing.
#[derive(Clone, Copy)]
pub struct Listing {
    pub vertex: fn(&Given, &Corner) -> Passed,
    /// `None` where the source's language leaves the value undefined.
    pub fragment: fn(&Given, &[DVec4], &Fragment) -> Option<DVec3>,
}

/// The base colour of a vertex.
pub fn base_color(given: &Given, corner: &Corner) -> DVec4 {
    (corner.color * given.vector("object.color")).extend(1.0)
}

/// The smaller of a colour and white.
pub fn at_most_white(color: DVec3) -> DVec3 {
    color.min(DVec3::ONE)
}

/// `pow` of a number that may be negative, which GLSL leaves undefined. What is too small to be seen
/// with either sign counts as 0.
pub fn power(base: f64, exponent: f64) -> Option<f64> {
    if base >= 0.0 {
        return Some(base.powf(exponent));
    }
    // A negative number to a power has the size of the positive one, or is not a number, which the
    // maximum with 0 removes.
    (base.abs().powf(exponent) < 1e-4).then_some(0.0)
}

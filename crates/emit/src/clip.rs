//! The clip space of each target's outputs.

use lamplight_bundle::{ClipConvention, ClipSpace, FrontFace, RowOrder, Viewport, YAxis};

/// The clip space of a target for each choice of [`ClipConvention`].
#[derive(Debug)]
pub struct Spaces {
    /// Where WebGPU's conventions are asked for.
    pub wgpu: ClipSpace,
    /// Where the API's own are asked for.
    pub native: ClipSpace,
}

impl Spaces {
    /// The clip space for a choice.
    pub fn of(&self, clip: ClipConvention) -> ClipSpace {
        match clip {
            ClipConvention::Wgpu => self.wgpu,
            ClipConvention::Native => self.native,
        }
    }
}

const WEBGPU: ClipSpace = ClipSpace {
    y: YAxis::Up,
    near: 0,
    far: 1,
    is_converted: false,
    viewport: Viewport::Positive,
    rows: RowOrder::TopFirst,
    front_face: FrontFace::Same,
};

/// Metal, Direct3D and WebGPU have one clip space.
pub const SHARED: Spaces = Spaces { wgpu: WEBGPU, native: WEBGPU };

/// Vulkan's y axis points down, unless the viewport has a negative height.
pub const VULKAN: Spaces = Spaces {
    wgpu: ClipSpace { viewport: Viewport::Negative, ..WEBGPU },
    native: ClipSpace { y: YAxis::Down, ..WEBGPU },
};

/// OpenGL stores the lowest row first, and its depths go from -1 to 1. To store the top row first,
/// the output flips y. This reverses the winding of triangles too.
pub const OPENGL: Spaces = Spaces {
    wgpu: ClipSpace { is_converted: true, front_face: FrontFace::Reversed, ..WEBGPU },
    native: ClipSpace { near: -1, rows: RowOrder::BottomFirst, ..WEBGPU },
};

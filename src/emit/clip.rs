//! What each target makes of a clip space that is asked for.

use crate::bundle::{Clip, ClipSpace, FrontFace, Rows, Viewport, YAxis};

/// What a target makes of each.
#[derive(Debug)]
pub struct Spaces {
    /// For WebGPU's conventions.
    pub wgpu: ClipSpace,
    /// For the API's own.
    pub native: ClipSpace,
}

impl Spaces {
    /// The one that is asked for.
    pub fn of(&self, clip: Clip) -> ClipSpace {
        match clip {
            Clip::Wgpu => self.wgpu,
            Clip::Native => self.native,
        }
    }
}

const WEBGPU: ClipSpace = ClipSpace {
    y: YAxis::Up,
    near: 0,
    far: 1,
    is_converted: false,
    viewport: Viewport::Positive,
    rows: Rows::TopFirst,
    front_face: FrontFace::Same,
};

/// Metal, Direct3D and WebGPU have one clip space.
pub const SHARED: Spaces = Spaces { wgpu: WEBGPU, native: WEBGPU };

/// Vulkan's y axis points down, unless the viewport is turned over.
pub const VULKAN: Spaces = Spaces {
    wgpu: ClipSpace { viewport: Viewport::Negative, ..WEBGPU },
    native: ClipSpace { y: YAxis::Down, ..WEBGPU },
};

/// OpenGL stores the lowest row first and has depths from -1 to 1. To have the top row first, the
/// output turns the picture over, and with it the way that triangles wind.
pub const OPENGL: Spaces = Spaces {
    wgpu: ClipSpace { is_converted: true, front_face: FrontFace::Reversed, ..WEBGPU },
    native: ClipSpace { near: -1, rows: Rows::BottomFirst, ..WEBGPU },
};

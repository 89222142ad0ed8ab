//! Languages and stages of entry points, with their names.

use serde::{Deserialize, Serialize};

/// Source language of an entry point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Language {
    /// WESL, of which WGSL is a part.
    Wesl,
    /// GLSL for Vulkan.
    Glsl,
}

impl Language {
    /// One word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wesl => "wesl",
            Self::Glsl => "glsl",
        }
    }
}

/// Stage of an entry point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// Once for each vertex.
    Vertex,
    /// Once for each fragment.
    Fragment,
    /// Once for each invocation of a grid.
    Compute,
}

impl Stage {
    /// One word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Vertex => "vertex",
            Self::Fragment => "fragment",
            Self::Compute => "compute",
        }
    }

    /// The file extension from which glslang and Arm's compiler take the stage.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::Vertex => "vert",
            Self::Fragment => "frag",
            Self::Compute => "comp",
        }
    }
}

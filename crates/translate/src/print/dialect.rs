//! The languages that are written. What they share is in this folder, what HLSL and MSL write
//! otherwise in `hlsl/` and `msl/`.

use super::{hlsl, msl};
use crate::types::is_builtin;
use lamplight_syntax::glsl::words as glsl;

/// A language like C.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dialect {
    /// For Vulkan, with separate textures and samplers.
    Glsl,
    /// Shader model 5.0 and later.
    Hlsl,
    /// Metal 2.0 and later.
    Msl,
}

/// Functions that the printer writes where WGSL has another word, so that no local may hide them.
const WRITTEN: [&str; 6] = ["abs", "clamp", "max", "min", "mix", "trunc"];

impl Dialect {
    /// As messages name it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Glsl => "GLSL",
            Self::Hlsl => "HLSL",
            Self::Msl => "MSL",
        }
    }

    /// The ending of files.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Glsl => "glsl",
            Self::Hlsl => "hlsl",
            Self::Msl => "metal",
        }
    }

    /// Whether nothing that is global may have a word as its name.
    pub fn is_reserved(self, word: &str) -> bool {
        match self {
            Self::Glsl => glsl::is_reserved(word),
            Self::Hlsl => hlsl::is_keyword(word) || hlsl::is_function(word),
            Self::Msl => msl::is_keyword(word) || msl::is_function(word),
        }
    }

    /// Whether a local or a member may not have a word as its name: WGSL lets locals hide functions
    /// that both languages have.
    pub fn is_hidden(self, word: &str) -> bool {
        let (is_keyword, is_function) = match self {
            Self::Glsl => (glsl::is_keyword(word), glsl::is_function(word)),
            Self::Hlsl => (hlsl::is_keyword(word), hlsl::is_function(word)),
            Self::Msl => (msl::is_keyword(word), msl::is_function(word)),
        };
        is_keyword || WRITTEN.contains(&word) || is_function && !is_builtin(word)
    }
}

/// Whether a word is in a text of words.
pub fn is_listed(list: &str, word: &str) -> bool {
    list.split_whitespace().any(|known| known == word)
}

/// Whether a word is the name of a vector or a matrix, such as `float3` or `half2x2`.
pub fn is_shape(word: &str, scalars: &[&str], sizes: &[&str]) -> bool {
    let rest = scalars.iter().find_map(|scalar| word.strip_prefix(scalar));
    rest.is_some_and(|rest| match rest.split_once('x') {
        Some((columns, rows)) => sizes.contains(&columns) && sizes.contains(&rows),
        None => sizes.contains(&rest),
    })
}

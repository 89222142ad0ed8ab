//! What the version and the extensions of a text allow.

use crate::lexer::Lexed;
use crate::types::{Scalar, Type};

/// The version of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Version {
    /// The number after `#version`; 110 without one.
    pub number: u32,
    /// Whether it is OpenGL ES.
    pub es: bool,
    /// Whether an extension adds the conversions of later versions.
    pub converts: bool,
}

impl Version {
    /// Reads the directives of a text.
    pub fn read(text: &str, lexed: &Lexed) -> Self {
        let mut version = Self { number: 110, es: false, converts: false };
        for directive in &lexed.directives {
            let line = text[directive.range()].trim_start_matches('#').trim();
            let mut words = line.split_whitespace();
            match words.next() {
                Some("version") => {
                    let number = words.next().and_then(|word| word.parse().ok());
                    version.number = number.unwrap_or(110);
                    version.es = version.number == 100 || words.next() == Some("es");
                }
                Some("extension") => {
                    let name = words.next().unwrap_or_default().trim_end_matches(':');
                    version.converts |=
                        matches!(name, "GL_EXT_shader_implicit_conversions" | "GL_ARB_gpu_shader5");
                }
                _ => {}
            }
        }
        version
    }

    /// Whether a value becomes another type without a constructor.
    pub fn converts(&self, from: &Type, to: &Type) -> bool {
        if from == to {
            return true;
        }
        let (Some(source), Some(target)) = (from.scalar(), to.scalar()) else { return false };
        if from.with_scalar(target) != *to {
            return false;
        }
        let later = self.converts || (!self.es && self.number >= 400);
        let early = !self.es && self.number >= 120;
        match (source, target) {
            (Scalar::Int, Scalar::Uint) => later,
            (Scalar::Int | Scalar::Uint, Scalar::Float) => later || early,
            _ => false,
        }
    }
}

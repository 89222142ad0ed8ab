//! What stops the executor, and what it notices without stopping.

use crate::diagnostic::{Code, codes};
use naga::Span;

/// Why a module cannot be lowered or a call did not finish, with the place in naga's text.
#[derive(Debug, Clone, PartialEq)]
#[must_use]
pub struct Error {
    /// What kind of error it is.
    pub code: &'static Code,
    /// One line.
    pub message: String,
    /// The place in the text that naga parsed.
    pub span: Span,
}

impl Error {
    pub(super) fn new(code: &'static Code, message: impl Into<String>) -> Self {
        Self { code, message: message.into(), span: Span::UNDEFINED }
    }

    pub(super) fn unsupported(what: impl std::fmt::Display) -> Self {
        Self::new(codes::EVAL_UNSUPPORTED, format!("the CPU executor does not support {what}"))
    }

    pub(super) fn too_large(what: impl Into<String>) -> Self {
        Self::new(codes::EVAL_TOO_LARGE, what)
    }

    /// Sets the place unless it is known already.
    pub(super) fn or_at(mut self, span: Span) -> Self {
        if self.span == Span::UNDEFINED {
            self.span = span;
        }
        self
    }
}

impl std::fmt::Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} [{}]", self.message, self.code.name)
    }
}

impl std::error::Error for Error {}

/// What a watched run notices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A NaN came from numbers.
    NotANumber,
    /// An infinity came from finite numbers.
    Infinity,
    /// A division, of floats or integers, by zero.
    DivisionByZero,
    /// A function outside of its domain: a root of a negative, a normalised zero.
    Domain,
    /// A float converted to an integer type that cannot hold it.
    Conversion,
    /// An index outside of its array; it was clamped.
    OutOfBounds,
    /// A comparison or a jump nearer than the errors of its sides.
    Ambiguous,
    /// A derivative that not all lanes of the quad reached together.
    DivergentDerivative,
}

/// Something noticed, where and how often.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finding {
    /// What was computed.
    pub kind: Kind,
    /// The place in the text that naga parsed.
    pub span: Span,
    /// How often.
    pub count: u64,
}

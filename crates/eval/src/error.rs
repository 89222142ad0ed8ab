//! What stops the evaluator, and what it reports without stopping.

use lamplight_diagnostic::{Code, codes};
use naga::Span;

/// Why a module cannot be lowered or a call did not finish, with the place in naga's text.
#[derive(Debug, Clone, PartialEq)]
#[must_use]
pub struct Error {
    /// The diagnostic's code.
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

    /// What an observer ends a run with that has shown enough.
    pub fn stopped() -> Self {
        Self::new(codes::EVAL_INTERNAL, "the run was stopped")
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

/// What a run reports when it looks for numeric trouble.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FindingKind {
    /// The result is NaN, though all operands were finite.
    NotANumber,
    /// The result is infinite, though all operands were finite.
    Infinity,
    /// A division, of floats or integers, by zero.
    DivisionByZero,
    /// An argument outside the function's domain: the root of a negative number, a zero vector
    /// normalised.
    Domain,
    /// A float converted to an integer type that cannot hold it.
    Conversion,
    /// An index outside its array, which was clamped.
    OutOfBounds,
    /// The two sides of a comparison, or an argument and a jump of the function, are closer than
    /// their errors.
    Ambiguous,
    /// A derivative in non-uniform control flow, or a sample that takes its level of detail from
    /// one: not all lanes of the quad reached it together.
    DivergentDerivative,
}

/// Something that a run reported: where, and how often.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finding {
    /// What kind of trouble it is.
    pub kind: FindingKind,
    /// The place in the text that naga parsed.
    pub span: Span,
    /// How often.
    pub count: u64,
}

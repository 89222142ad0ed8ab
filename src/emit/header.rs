//! The lines that begin an emitted text, before its first declaration.

/// What such a line starts with in some target: a directive, a comment, a precision of GLSL ES, a
/// namespace of Metal, or an extension of WGSL.
const STARTS: [&str; 6] = ["#", "//", "precision ", "using ", "enable ", "requires "];

/// Whether a line may stand before all declarations. A blank line may.
pub fn is_header_line(line: &str) -> bool {
    line.trim().is_empty() || STARTS.iter().any(|start| line.starts_with(start))
}

//! The lines that begin an emitted text, before its first declaration.

/// What such a line starts with, in any of the targets: directives and comments, precisions of
/// GLSL ES, Metal's namespaces, WGSL's extensions.
const STARTS: [&str; 6] = ["#", "//", "precision ", "using ", "enable ", "requires "];

/// Whether a line stands before all declarations. Blank lines do.
pub fn is_header_line(line: &str) -> bool {
    line.trim().is_empty() || STARTS.iter().any(|start| line.starts_with(start))
}

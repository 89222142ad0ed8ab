//! The lines that begin an emitted text, before its first declaration.

use super::targets;

/// Whether a line may stand before all declarations, in some target. A blank line and a comment
/// may.
pub fn is_header_line(line: &str) -> bool {
    let mut starts = targets::ALL.iter().flat_map(|entry| entry.header);
    line.trim().is_empty() || line.starts_with("//") || starts.any(|start| line.starts_with(start))
}

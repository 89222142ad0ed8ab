//! Text that grows line by line.

use lamplight_syntax::wesl::blank::comment_length;

/// Lines with an indentation.
#[derive(Debug, Default)]
pub struct Indented {
    pub text: String,
    pub depth: usize,
}

impl Indented {
    /// A line, whose further lines are indented already.
    pub fn line(&mut self, text: &str) {
        self.text += &"    ".repeat(self.depth);
        self.text += text;
        self.text.push('\n');
    }

    /// Text that begins at the margin.
    pub fn raw(&mut self, text: &str) {
        self.text += text;
    }

    /// An empty line, unless there is one already.
    pub fn blank(&mut self) {
        if !self.text.is_empty() && !self.text.ends_with("\n\n") {
            self.text.push('\n');
        }
    }

    /// A comment behind the last line.
    pub fn trail(&mut self, comment: &str) {
        if self.text.ends_with('\n') {
            self.text.pop();
        }
        self.text += &format!(" {comment}\n");
    }
}

/// A comment of WGSL as one of GLSL, where block comments do not nest and a backslash at the end of a
/// line joins it with the next one.
pub fn comment_text(comment: &str) -> String {
    if comment.starts_with("//") {
        let text = comment.trim_end();
        return if text.ends_with('\\') { format!("{text} .") } else { text.to_owned() };
    }
    let inner = comment.strip_prefix("/*").and_then(|text| text.strip_suffix("*/"));
    let inner = inner.unwrap_or(comment);
    let nests = (0..inner.len())
        .any(|at| inner.is_char_boundary(at) && inner[at..].starts_with("/*"))
        || comment_length(comment) != comment.len();
    match nests {
        true => format!("/*{}*/", inner.replace("/*", "(").replace("*/", ")")),
        false => comment.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_end_where_they_ended() {
        assert_eq!(comment_text("// a\\"), "// a\\ .");
        assert_eq!(comment_text("/* a /* b */ c */"), "/* a ( b ) c */");
        assert_eq!(comment_text("/* a */"), "/* a */");
    }

    #[test]
    fn blank_lines_do_not_add_up() {
        let mut out = Indented::default();
        out.blank();
        out.line("a");
        out.blank();
        out.blank();
        out.line("b");
        assert_eq!(out.text, "a\n\nb\n");
    }
}

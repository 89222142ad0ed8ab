//! Layout of WESL: indentation by brackets, no blanks at line ends, no runs of empty lines. No
//! token changes, and lines stay lines.

use lamplight_syntax::wesl::blank;

/// The most empty lines in a row that are kept.
const EMPTY: usize = 1;
const INDENT: &str = "    ";

/// The formatted text; `None` where its brackets or comments do not close.
pub fn format_text(text: &str) -> Option<String> {
    let mut out = String::with_capacity(text.len());
    let (mut depth, mut empty, mut comment) = (0_usize, 0_usize, 0_usize);
    let mut before = ";".to_owned();
    // For each open bracket, the indentation of the line that opens it.
    let mut open: Vec<usize> = Vec::new();
    for line in text.lines() {
        if comment > 0 {
            // The inside of a block comment is its author's.
            out += line.trim_end();
            out.push('\n');
            scan_line(line, &mut comment, &mut |_| Some(()))?;
            continue;
        }
        let trimmed = line.trim();
        if trimmed.is_empty() {
            empty += 1;
            continue;
        }
        let closers = trimmed.chars().take_while(|c| matches!(c, ')' | ']' | '}')).count();
        // No empty line right behind an opening bracket, or right before a closing one.
        let is_tight = closers > 0 || before.ends_with(['{', '(', '[']);
        if empty > 0 && !out.is_empty() && !is_tight {
            out += &"\n".repeat(empty.min(EMPTY));
        }
        empty = 0;
        let level = match closers {
            0 => depth,
            // The line stands where the line of the last bracket that it closes begins.
            _ => *open.get(open.len().checked_sub(closers)?)?,
        };
        out += &INDENT.repeat(level + usize::from(closers == 0 && continues_statement(&before)));
        if !trimmed.starts_with("//") {
            before = code_of_line(trimmed).to_owned();
        }
        out += trimmed;
        out.push('\n');
        scan_line(trimmed, &mut comment, &mut |byte| {
            match byte {
                b'(' | b'[' | b'{' => open.push(level),
                _ => drop(open.pop()?),
            }
            Some(())
        })?;
        depth = open.last().map_or(0, |level| level + 1);
    }
    (open.is_empty() && comment == 0 && same_words(text, &out)).then_some(out)
}

/// A line without the comment at its end.
fn code_of_line(line: &str) -> &str {
    line.split("//").next().unwrap_or_default().trim_end()
}

/// Whether the next line continues the statement of a line. Attributes stand on lines of their own.
fn continues_statement(before: &str) -> bool {
    !before.is_empty()
        && !before.starts_with('@')
        && !before.ends_with([';', '{', '}', '(', '[', ',', ':', '/'])
}

/// Calls for each bracket of a line that is in no comment; counts block comments that stay open.
fn scan_line(
    line: &str,
    comment: &mut usize,
    bracket: &mut dyn FnMut(u8) -> Option<()>,
) -> Option<()> {
    let bytes = line.as_bytes();
    let mut at = 0;
    while at < bytes.len() {
        match (bytes[at], bytes.get(at + 1)) {
            (b'/', Some(b'*')) => {
                *comment += 1;
                at += 1;
            }
            (b'*', Some(b'/')) if *comment > 0 => {
                *comment -= 1;
                at += 1;
            }
            (b'/', Some(b'/')) if *comment == 0 => return Some(()),
            (byte @ (b'(' | b'[' | b'{' | b')' | b']' | b'}'), _) if *comment == 0 => {
                bracket(byte)?;
            }
            _ => {}
        }
        at += 1;
    }
    Some(())
}

/// Whether two texts have the same tokens and comments: what formatting must not change.
pub fn same_words(left: &str, right: &str) -> bool {
    let words = |text: &str| text.chars().filter(|c| !blank::is_blank(*c)).collect::<String>();
    words(left) == words(right)
}

//! Writes documentation as Markdown.

/// The text, with everything outside of backticks escaped.
pub fn escaped_prose(text: &str) -> String {
    let parts = text
        .split('`')
        .enumerate()
        .map(|(index, part)| if index % 2 == 0 { escape_markdown(part) } else { part.to_owned() });
    parts.collect::<Vec<_>>().join("`")
}

/// The same for a cell of a table, where a bar ends the cell even within backticks.
pub fn table_cell(text: &str) -> String {
    escaped_prose(text).replace('|', "\\|")
}

/// A block of code.
pub fn code_block(language: &str, code: &str) -> String {
    format!("```{language}\n{code}\n```\n")
}

fn escape_markdown(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        if "*_<[".contains(letter) {
            out.push('\\');
        }
        out.push(letter);
    }
    out
}

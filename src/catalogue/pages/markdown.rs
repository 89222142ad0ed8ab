//! Documentation text as Markdown.

/// Text with what is outside of backticks kept from meaning anything to Markdown.
pub fn prose(text: &str) -> String {
    let parts = text
        .split('`')
        .enumerate()
        .map(|(index, part)| if index % 2 == 0 { escaped(part) } else { part.to_owned() });
    parts.collect::<Vec<_>>().join("`")
}

/// The same in a table, where bars end a cell within backticks too.
pub fn cell(text: &str) -> String {
    prose(text).replace('|', "\\|")
}

/// A block of code.
pub fn block(language: &str, code: &str) -> String {
    format!("```{language}\n{code}\n```\n")
}

fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        if "*_<[".contains(letter) {
            out.push('\\');
        }
        out.push(letter);
    }
    out
}

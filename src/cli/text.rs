//! Formats text for a terminal: wrapped paragraphs and tables, at most [`WIDTH`] columns wide where
//! the words allow it.

/// Columns of a line.
pub const WIDTH: usize = 100;

/// Words in lines of at most [`WIDTH`] columns, each after `indent` blanks; ends with a newline.
pub fn wrap_words(text: &str, indent: usize) -> String {
    wrapped_lines(text, WIDTH - indent.min(WIDTH / 2))
        .into_iter()
        .map(|line| format!("{:indent$}{line}\n", ""))
        .collect()
}

/// Lines of code as they are, indented; ends with a newline.
pub fn indent_lines(text: &str, indent: usize) -> String {
    text.lines().map(|line| format!("{:indent$}{line}\n", "")).collect()
}

/// Rows under their columns; the last column is wrapped.
pub fn table_text(columns: &[&str], rows: &[Vec<String>]) -> String {
    let head = columns.iter().map(ToString::to_string).collect();
    std::iter::once(&head)
        .chain(rows)
        .map(|row| row_text(row, &column_widths(columns, rows)))
        .collect()
}

/// Rows without a heading, indented; the last column is wrapped.
pub fn rows_text(rows: &[Vec<String>], indent: usize) -> String {
    let mut widths = column_widths(&vec![""; rows.first().map_or(0, Vec::len)], rows);
    if let Some(first) = widths.first_mut() {
        *first += indent;
    }
    let indented = rows.iter().map(|row| {
        let mut row = row.clone();
        if let Some(first) = row.first_mut() {
            *first = format!("{:indent$}{first}", "");
        }
        row
    });
    indented.map(|row| row_text(&row, &widths)).collect()
}

fn column_widths(columns: &[&str], rows: &[Vec<String>]) -> Vec<usize> {
    let widest = |column: usize| {
        rows.iter()
            .map(|row| row[column].chars().count())
            .chain([columns[column].len()])
            .max()
            .unwrap_or(0)
    };
    (0..columns.len()).map(widest).collect()
}

fn row_text(row: &[String], widths: &[usize]) -> String {
    let Some((last, before)) = row.split_last() else { return String::new() };
    let start = before
        .iter()
        .zip(widths)
        .map(|(cell, width)| format!("{cell:width$}  "))
        .collect::<String>();
    let indent = start.chars().count();
    let wrapped = wrapped_lines(last, WIDTH.saturating_sub(indent).max(WIDTH / 3));
    if wrapped.is_empty() {
        return format!("{}\n", start.trim_end());
    }
    let lines = wrapped.iter().enumerate().map(|(index, line)| {
        if index == 0 { format!("{start}{line}\n") } else { format!("{:indent$}{line}\n", "") }
    });
    lines.collect()
}

fn wrapped_lines(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

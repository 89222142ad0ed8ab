//! The table of what a shader was given, and from where.

use serde::Serialize;

/// What a row is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RowKind {
    /// An attribute of a vertex stage of the author's.
    Attribute,
    /// An input of a fragment stage, from a vertex stage that was made for it.
    Input,
    Uniform,
    Texture,
}

/// Where a value comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Origin {
    Option,
    File,
    /// The name suggests it.
    Name,
    /// The type suggests it.
    Type,
    /// Nothing suggests anything.
    Zero,
}

impl Origin {
    fn text(self) -> &'static str {
        match self {
            Self::Option => "option",
            Self::File => "file",
            Self::Name => "default by name",
            Self::Type => "default by type",
            Self::Zero => "zero",
        }
    }
}

/// Something that the shader was given.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Row {
    pub kind: RowKind,
    /// As the author calls it.
    pub name: String,
    /// Type in WGSL, in its short form.
    #[serde(rename = "type")]
    pub ty: String,
    pub value: String,
    pub from: Origin,
}

/// The rows under a line of titles, in columns.
pub fn table_text(rows: &[Row]) -> String {
    let titles = ["input", "name", "type", "value", "from"];
    let cells = |row: &Row| {
        let kind = format!("{:?}", row.kind).to_lowercase();
        [kind, row.name.clone(), row.ty.clone(), row.value.clone(), row.from.text().to_owned()]
    };
    let lines = std::iter::once(titles.map(str::to_owned)).chain(rows.iter().map(cells));
    let lines: Vec<[String; 5]> = lines.collect();
    let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max();
    let widths: Vec<usize> = (0..4).map(|column| width(column).unwrap_or(0)).collect();
    let line = |cells: &[String; 5]| {
        let padded = cells.iter().zip(&widths).map(|(cell, width)| format!("{cell:width$}  "));
        format!("{}{}\n", padded.collect::<String>(), cells[4])
    };
    lines.iter().map(line).collect()
}

/// Numbers as a person writes them, with at most four decimals.
pub fn numbers_text(numbers: &[f64]) -> String {
    let number = |number: &f64| {
        let rounded = (number * 1e4).round() / 1e4;
        if rounded == 0.0 { "0".to_owned() } else { format!("{rounded}") }
    };
    numbers.iter().map(number).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::{Origin, Row, RowKind, numbers_text, table_text};

    #[test]
    fn rows_in_columns() {
        let row = |name: &str, from| Row {
            kind: RowKind::Uniform,
            name: name.to_owned(),
            ty: "vec3f".to_owned(),
            value: numbers_text(&[1.0, 0.333_333, -0.0]),
            from,
        };
        let text = table_text(&[row("eye", Origin::Name), row("lamp.position", Origin::Option)]);
        let expected = "input    name           type   value         from\n\
                        uniform  eye            vec3f  1, 0.3333, 0  default by name\n\
                        uniform  lamp.position  vec3f  1, 0.3333, 0  option\n";
        assert_eq!(text, expected);
    }
}

//! The description beside a table.

use crate::{Errors, SIDE, Table};

/// The factor by which an error may exceed the published one: mathematical functions round
/// differently on other machines.
const SLACK: f64 = 1.001;

/// The text of a description. `bytes` are those of the `.bin`.
pub fn header_text(table: &Table, errors: &Errors, bytes: &[u8]) -> String {
    let channels: Vec<String> =
        table.channels.iter().map(|channel| format!("    {channel:?},\n")).collect();
    let mut text = format!(
        "# Made by `cargo xtask tables`.\n\nname = {:?}\nabout = {:?}\nsource = {:?}\n\
         licence = \"MIT OR Apache-2.0\"\nsize = [{SIDE}, {SIDE}]\nformat = \"f32, little-endian, row by row\"\n\
         blake3 = \"{}\"\nchannels = [\n{}]\nerror = {:?}\n",
        table.name,
        table.about,
        table.source,
        blake3::hash(bytes),
        channels.concat(),
        errors.text
    );
    if let [_, _, ..] = errors.worst[..] {
        text += "# The worst of each column of roughness, and the last row.\n";
    }
    for (name, numbers) in [("worst", &errors.worst), ("horizon", &errors.horizon)] {
        if !numbers.is_empty() {
            text += &format!("{name} = [{}]\n", number_lines(numbers));
        }
    }
    text
}

/// Numbers in lines of sixteen.
fn number_lines(numbers: &[f64]) -> String {
    let line = |line: &[f64]| line.iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
    let rows: Vec<String> = numbers.chunks(16).map(line).collect();
    if let [row] = &rows[..] { row.clone() } else { format!("\n    {},\n", rows.join(",\n    ")) }
}

/// Whether the errors are no larger than the description says, and the file is the one that it
/// describes.
pub fn check_header(published: &str, errors: &Errors, bytes: &[u8]) -> Result<(), String> {
    let hash = format!("blake3 = \"{}\"\n", blake3::hash(bytes));
    if !published.contains(&hash) {
        return Err("the description is of another `.bin`".to_owned());
    }
    for (name, found) in [("worst", &errors.worst), ("horizon", &errors.horizon)] {
        let stated = numbers_of(published, name);
        if stated.len() != found.len() {
            return Err(format!("`{name}` has {} numbers, expected {}", stated.len(), found.len()));
        }
        // A NaN on either side is worse.
        let is_worse = |(found, stated): (&f64, &f64)| {
            found.partial_cmp(&(stated * SLACK)).is_none_or(std::cmp::Ordering::is_gt)
        };
        if let Some(index) = found.iter().zip(&stated).position(is_worse) {
            let (found, stated) = (found[index], stated[index]);
            return Err(format!("`{name}` of column {index} is {found}, published is {stated}"));
        }
    }
    Ok(())
}

/// The numbers of an array of a description.
fn numbers_of(text: &str, name: &str) -> Vec<f64> {
    let start = format!("\n{name} = [");
    let array = text.split_once(&start).and_then(|(_, rest)| rest.split_once(']'));
    let numbers = array.map_or("", |(numbers, _)| numbers).split(',');
    numbers.filter_map(|number| number.trim().parse().ok()).collect()
}

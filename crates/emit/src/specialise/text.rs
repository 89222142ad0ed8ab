//! Turns private variables into macros or function constants, in the text that naga wrote.

use naga::ScalarKind;

use super::{OpenOverride, choice_of};
use crate::{Overrides, TargetEntry, is_header_line};
use lamplight_bundle::OverrideChoice;

/// Opens the variables of overrides that the text declares; returns how each is chosen.
pub fn open_text(
    bytes: &mut Vec<u8>,
    opens: &[OpenOverride],
    writer: &TargetEntry,
) -> Result<Vec<OverrideChoice>, String> {
    let is_constant = writer.overrides == Overrides::FunctionConstants;
    let text = std::str::from_utf8(bytes).map_err(|error| error.to_string())?;
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let mut choices = Vec::new();
    let mut declared = Vec::new();
    for open in opens {
        let mut found = lines
            .iter_mut()
            .filter_map(|line| Some((initialiser_index(line, &open.variable)?, line)));
        let Some((start, line)) = found.next() else { continue };
        if found.next().is_some() {
            return Err(format!("`{}` is declared twice", open.variable));
        }
        let value = match is_constant {
            true => value_name(open),
            false => format!("{}({})", scalar_name(open.kind), open.symbol()),
        };
        *line = format!("{}= {value};", &line[..start]);
        declared.extend(match is_constant {
            true => function_constant(open),
            false => definition_lines(open),
        });
        choices.push(choice_of(open, is_constant));
    }
    if !declared.is_empty() {
        let at = first_line(&lines, writer);
        lines.splice(at..at, declared);
        *bytes = (lines.join("\n") + "\n").into_bytes();
    }
    Ok(choices)
}

/// The index of the `=`, if the line declares the variable.
fn initialiser_index(line: &str, variable: &str) -> Option<usize> {
    let (before, _) = line.split_once('=')?;
    let mut words = before.split_whitespace();
    let last = words.next_back()?;
    let typed =
        words.next_back().is_some_and(|word| ["bool", "int", "uint", "float"].contains(&word));
    (last == variable && typed && line.ends_with(';')).then_some(before.len())
}

/// The index of the first line after those that must come first: `#version`, extensions and
/// precisions, or Metal's headers.
fn first_line(lines: &[String], writer: &TargetEntry) -> usize {
    match writer.header {
        [] => 0,
        _ => lines.iter().take_while(|line| is_header_line(line)).count(),
    }
}

/// The lines that define the value: the host's macro if it is defined, the default otherwise.
fn definition_lines(open: &OpenOverride) -> Vec<String> {
    let symbol = open.symbol();
    vec![
        format!("#ifndef {symbol}"),
        format!("#define {symbol} {}", open.text),
        "#endif".to_owned(),
    ]
}

fn function_constant(open: &OpenOverride) -> Vec<String> {
    let (symbol, ty, value) = (open.symbol(), scalar_name(open.kind), value_name(open));
    vec![
        format!("constant {ty} {symbol} [[function_constant({})]];", open.id),
        format!(
            "constant {ty} {value} = is_function_constant_defined({symbol}) ? {symbol} : {};",
            open.text
        ),
    ]
}

fn value_name(open: &OpenOverride) -> String {
    format!("{}_VALUE", open.symbol())
}

fn scalar_name(kind: ScalarKind) -> &'static str {
    match kind {
        ScalarKind::Bool => "bool",
        ScalarKind::Uint => "uint",
        ScalarKind::Float => "float",
        _ => "int",
    }
}

//! Programs and their axes.

use serde_json::{Value, json};

use super::ShownItem;
use crate::cli::list::{count_json, setting_json};
use crate::cli::text::{rows_text, wrap_words};
use crate::parse::words::has_word;
use crate::permute::{Axis, Program};

/// A program with its axes and constraints.
pub fn show_program(program: &Program) -> ShownItem {
    ShownItem { text: program_text(program), json: program_json(program) }
}

/// An axis of a program.
pub fn show_axis(program: &Program, axis: &Axis) -> ShownItem {
    let mut json = axis_json(&program.name, axis);
    json["constraints"] = json!(constraints_on(program, axis));
    let mut text = format!("{}.{}\n", program.name, axis.name);
    text += &axis.doc.as_ref().map_or(String::new(), |doc| format!("\n{}", wrap_words(doc, 2)));
    let facts = [
        ["kind", axis.kind.name()].map(str::to_owned),
        ["mode", axis.mode.name()].map(str::to_owned),
        ["values".to_owned(), axis.value_names().join(" ")],
        ["default".to_owned(), axis.values[axis.default].to_string()],
        ["GLSL macros".to_owned(), axis.macros().join(" ")],
    ];
    text += &format!("\n{}", rows_text(&facts.map(Vec::from), 2));
    text += &heading_text("Constraints", &constraints_on(program, axis));
    ShownItem { text, json }
}

/// An axis as an object: its values are booleans, numbers or strings.
pub fn axis_json(program: &str, axis: &Axis) -> Value {
    json!({
        "program": program,
        "axis": axis.name,
        "kind": axis.kind.name(),
        "mode": axis.mode.name(),
        "default": setting_json(&axis.values[axis.default]),
        "values": axis.values.iter().map(setting_json).collect::<Vec<_>>(),
        "macros": axis.macros(),
        "summary": axis.doc,
    })
}

/// The constraints that name the axis.
fn constraints_on(program: &Program, axis: &Axis) -> Vec<String> {
    program
        .space
        .constraints()
        .iter()
        .map(|constraint| constraint.text.clone())
        .filter(|text| has_word(text, &axis.name))
        .collect()
}

fn program_text(program: &Program) -> String {
    let space = &program.space;
    let mut text = format!("{}\n", program.name);
    text += &program.doc.as_ref().map_or(String::new(), |doc| format!("\n{}", wrap_words(doc, 2)));
    let facts = [
        [
            "files".to_owned(),
            program.files().map(|file| file.path.as_str()).collect::<Vec<_>>().join(" "),
        ],
        [
            "targets".to_owned(),
            program.targets.iter().map(|target| target.name()).collect::<Vec<_>>().join(" "),
        ],
        ["full product".to_owned(), space.full_count().to_string()],
        ["valid".to_owned(), space.valid_count().to_string()],
        ["shipped".to_owned(), space.count().to_string()],
    ];
    text += &format!("\n{}", rows_text(&facts.map(Vec::from), 2));
    if !space.axes().is_empty() {
        let axes: Vec<Vec<String>> = space.axes().iter().map(axis_row).collect();
        text += &format!("\nAxes, defaults in brackets\n{}", rows_text(&axes, 2));
    }
    text + &heading_text(
        "Constraints",
        &space.constraints().iter().map(|constraint| constraint.text.clone()).collect::<Vec<_>>(),
    )
}

fn axis_row(axis: &Axis) -> Vec<String> {
    let value = |(ordinal, name): (usize, String)| {
        if ordinal == axis.default { format!("[{name}]") } else { name }
    };
    vec![
        axis.name.clone(),
        axis.value_names().into_iter().enumerate().map(value).collect::<Vec<_>>().join(" "),
    ]
}

fn heading_text(name: &str, lines: &[String]) -> String {
    if lines.is_empty() {
        String::new()
    } else {
        format!("\n{name}\n{}", lines.iter().map(|line| wrap_words(line, 2)).collect::<String>())
    }
}

fn program_json(program: &Program) -> Value {
    let space = &program.space;
    json!({
        "program": program.name,
        "summary": program.doc,
        "files": program.files().map(|file| file.path.as_str()).collect::<Vec<_>>(),
        "targets": program.targets.iter().map(|target| target.name()).collect::<Vec<_>>(),
        "full_product": count_json(space.full_count()),
        "valid": count_json(space.valid_count()),
        "shipped": count_json(space.count()),
        "axes": space.axes().iter().map(|axis| axis_json(&program.name, axis)).collect::<Vec<_>>(),
        "constraints": space.constraints().iter().map(|found| json!({ "require": found.text, "doc": found.doc })).collect::<Vec<_>>(),
    })
}

//! The page of programs: what each varies in.

use std::fmt::Write as _;

use super::super::cost::Costs;
use super::cost;
use super::markdown::{escaped_prose, table_cell};
use lamplight_permute::{Axis, Manifest, Program};

/// The page.
pub fn program_page(manifest: &Manifest, costs: &Costs) -> String {
    let mut text = "# Programs\n\nThe programs of the library have entry points in both languages. Axes multiply the permutations of a\n\
                    program, and constraints exclude some. `shaderlib/lamplight.toml` lists those that ship.\n"
        .to_owned();
    for program in &manifest.programs {
        write_program(&mut text, program, costs);
    }
    text.push_str("\n---\n[Catalogue](README.md)\n");
    text
}

fn write_program(text: &mut String, program: &Program, costs: &Costs) {
    let _ = write!(text, "\n## {}\n", escaped_prose(&program.name));
    if let Some(doc) = &program.doc {
        let _ = write!(text, "\n{}\n", escaped_prose(doc));
    }
    let files: Vec<String> = program.files().map(|file| format!("`{}`", file.path)).collect();
    let targets: Vec<&str> = program.targets.iter().map(|target| target.name()).collect();
    let space = &program.space;
    let _ = write!(
        text,
        "\n| | |\n|---|---|\n| files | {} |\n| targets | {} |\n",
        files.join(", "),
        targets.join(", ")
    );
    let _ = write!(
        text,
        "| full product | {} |\n| valid | {} |\n| shipped | {} |\n",
        space.full_count(),
        space.valid_count(),
        space.count()
    );
    write_axes(text, space.axes());
    cost::of_program(text, &program.name, costs);
    for (index, constraint) in space.constraints().iter().enumerate() {
        let start = if index == 0 { "\nConstraints:\n\n" } else { "" };
        let doc = constraint
            .doc
            .as_ref()
            .map_or(String::new(), |doc| format!("  \n  {}", escaped_prose(doc)));
        let _ = writeln!(text, "{start}- `{}`{doc}", constraint.text);
    }
}

fn write_axes(text: &mut String, axes: &[Axis]) {
    if axes.is_empty() {
        return;
    }
    text.push_str("\n| axis | values | mode | |\n|---|---|---|---|\n");
    for axis in axes {
        let value = |(ordinal, name): (usize, String)| {
            if ordinal == axis.default { format!("**`{name}`**") } else { format!("`{name}`") }
        };
        let values: Vec<String> = axis.value_names().into_iter().enumerate().map(value).collect();
        let doc = axis.doc.as_deref().unwrap_or_default();
        let _ = writeln!(
            text,
            "| `{}` | {} | {} | {} |",
            axis.name,
            values.join(", "),
            axis.mode.name(),
            table_cell(doc)
        );
    }
    text.push_str("\nThe default of each axis is bold.\n");
}

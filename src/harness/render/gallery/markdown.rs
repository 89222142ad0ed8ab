//! The gallery as Markdown, beside its pictures.

use std::fmt::Write as _;

use super::{Exhibit, first_alike};

/// Pictures in one row of the overview.
const COLUMNS: usize = 5;

/// The page. Pictures are beside it, `NAME.png`.
pub fn page(exhibits: &[Exhibit]) -> String {
    let mut text = "# Gallery\n\nEvery published example, drawn by `lamplight render --all`. Which driver drew which picture is in\n\
                    [adapters.txt](adapters.txt).\n\n"
        .to_owned();
    overview(&mut text, exhibits);
    let mut work = "";
    for (exhibit, first) in exhibits.iter().zip(first_alike(exhibits)) {
        let here = exhibit.preset.source.split(", ").next().unwrap_or_default();
        if here != work {
            let _ = write!(text, "\n## {here}\n");
            work = here;
        }
        section(&mut text, exhibit, &exhibits[first]);
    }
    text
}

fn overview(text: &mut String, exhibits: &[Exhibit]) {
    let _ = write!(text, "|{}\n|{}\n", " |".repeat(COLUMNS), "---|".repeat(COLUMNS));
    for row in exhibits.chunks(COLUMNS) {
        let cell = |exhibit: &Exhibit| format!(" [![{0}]({0}.png)](#{0}) |", exhibit.preset.name);
        let _ = writeln!(text, "|{}", row.iter().map(cell).collect::<String>());
    }
}

fn section(text: &mut String, exhibit: &Exhibit, first: &Exhibit) {
    let preset = &exhibit.preset;
    let name = &preset.name;
    let _ = write!(text, "\n### {name}\n\n![{name}]({name}.png)\n\n{}\n\n", preset.doc);
    let _ = writeln!(text, "- source: {}", preset.source);
    for pass in exhibit.passes() {
        let _ = writeln!(text, "- `{pass}`");
    }
    let _ = writeln!(text, "- scene: {}", preset.scene);
    for (group, fields) in &preset.numbers {
        for (field, value) in fields {
            let _ = writeln!(text, "- `{group}.{field}` = {value}");
        }
    }
    if let Some(probe) = &preset.probe {
        let _ = writeln!(text, "- light probe: {probe}");
    }
    for file in first.files() {
        let _ = writeln!(text, "- composed text: [{file}]({file})");
    }
}

//! The gallery as Markdown, beside its pictures.

use std::fmt::Write as _;

use super::{Card, first_alike};

/// Pictures in one row of the overview.
const COLUMNS: usize = 5;

/// The page. Pictures are beside it, `NAME.png`.
pub fn page(cards: &[&Card]) -> String {
    let mut text = "# Gallery\n\nEvery published example, drawn by `lamplight render --all`. Which driver drew which picture is in\n\
                    [adapters.txt](adapters.txt).\n\n"
        .to_owned();
    overview(&mut text, cards);
    let mut work = "";
    for (card, first) in cards.iter().zip(first_alike(cards)) {
        let here = card.preset.source.split(", ").next().unwrap_or_default();
        if here != work {
            let _ = write!(text, "\n## {here}\n");
            work = here;
        }
        section(&mut text, card, cards[first]);
    }
    text
}

fn overview(text: &mut String, cards: &[&Card]) {
    let _ = write!(text, "|{}\n|{}\n", " |".repeat(COLUMNS), "---|".repeat(COLUMNS));
    for row in cards.chunks(COLUMNS) {
        let cell = |card: &&Card| format!(" [![{0}]({0}.png)](#{0}) |", card.preset.name);
        let _ = writeln!(text, "|{}", row.iter().map(cell).collect::<String>());
    }
}

fn section(text: &mut String, card: &Card, first: &Card) {
    let preset = &card.preset;
    let name = &preset.name;
    let _ = write!(text, "\n### {name}\n\n![{name}]({name}.png)\n\n{}\n\n", preset.doc);
    for deviation in &preset.deviations {
        let _ = writeln!(text, "- differs from the source: {deviation}");
    }
    let _ = writeln!(text, "- source: {}", preset.source);
    for pass in card.passes() {
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

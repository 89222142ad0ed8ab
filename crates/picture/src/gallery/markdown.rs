//! The gallery as Markdown, beside its pictures.

use std::fmt::Write as _;

use super::{Card, StripCard, first_alike, picture_files, strip_file};

/// Pictures in one row of the overview.
const COLUMNS: usize = 4;

/// The page. Pictures and their smaller forms are beside it.
pub fn markdown_page(cards: &[&Card], strips: &[StripCard]) -> String {
    let mut text = "# Gallery\n\n`lamplight render --all` draws every published example and every \
                    comparison. Each picture here is a link to\nits large form. \
                    [adapters.txt](adapters.txt) says which driver drew which picture.\n"
        .to_owned();
    text.push_str("\n## Comparisons\n");
    strips.iter().for_each(|card| write_strip(&mut text, card));
    let firsts = first_alike(cards);
    let mut at = 0;
    for group in cards.chunk_by(|a, b| a.preset.work() == b.preset.work()) {
        let _ = write!(text, "\n## {}\n\n", group[0].preset.work());
        write_overview(&mut text, group);
        for card in group {
            write_section(&mut text, card, cards[firsts[at]]);
            at += 1;
        }
    }
    text
}

/// A comparison, and the permutations or expressions of its panels.
fn write_strip(text: &mut String, card: &StripCard) {
    let (name, file) = (&card.comparison.name, strip_file(&card.comparison.name));
    let (doc, look) = (&card.comparison.doc, &card.comparison.look);
    let _ = write!(
        text,
        "\n### {name}\n\n[![{name}]({file})]({file})\n\n{doc} **Look for:** {look}\n\n\
         ```sh\n{}\n```\n\n",
        card.command()
    );
    for panel in &card.comparison.panels {
        let made = panel.value.as_ref().unwrap_or(&panel.key).replace(',', ", ");
        let _ = write!(text, "- {}: `{}`", panel.label, made.replace(",  ", ", "));
        if panel.cascades > 1 {
            let _ = write!(text, ", `--cascades {}`", panel.cascades);
        }
        for (group, fields) in &panel.numbers {
            for (field, value) in fields {
                let _ = write!(text, ", `{group}.{field}` = {value}");
            }
        }
        text.push('\n');
    }
}

fn write_overview(text: &mut String, cards: &[&Card]) {
    let columns = COLUMNS.min(cards.len());
    let _ = write!(text, "|{}\n|{}\n", " |".repeat(columns), "---|".repeat(columns));
    for row in cards.chunks(columns) {
        let cell = |card: &&Card| {
            let name = &card.preset.name;
            let [_, thumb] = picture_files(name);
            format!(" [![{name}]({thumb})](#{name})<br>`{name}` |")
        };
        let _ = writeln!(text, "|{}", row.iter().map(cell).collect::<String>());
    }
}

fn write_section(text: &mut String, card: &Card, first: &Card) {
    let preset = &card.preset;
    let name = &preset.name;
    let [picture, thumb] = picture_files(name);
    let _ = write!(
        text,
        "\n### {name}\n\n[![{name}]({thumb})]({picture})\n\n{} **Look for:** {}\n\n",
        preset.doc, preset.look
    );
    let _ = write!(text, "```sh\n{}\n```\n\n", card.command());
    for deviation in &preset.deviations {
        let _ = writeln!(text, "- differs from the source: {deviation}");
    }
    let _ = writeln!(text, "- source: {}", preset.source);
    for (program, key) in card.passes() {
        let anchor = program.replace('_', "-");
        let _ = writeln!(text, "- [{program}](../catalogue/programs.md#{anchor}): `{key}`");
    }
    let functions: Vec<String> =
        card.functions().map(|(name, page)| format!("[{name}]({page})")).collect();
    if !functions.is_empty() {
        let _ = writeln!(text, "- functions: {}", functions.join(", "));
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

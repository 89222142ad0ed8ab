//! Writes the gallery as HTML, in light or dark colours as the reader prefers.

use std::fmt::Write as _;

use super::{Card, SIZE, StripCard, THUMB, first_alike, picture_files, strip_file};
use lamplight_diagnostic::escape_markup;

/// Its policy allows the pictures beside it and its own style, also where it is opened as a file.
const HEAD: &str = "<!doctype html>
<html lang=\"en\">
<head>
<meta charset=\"utf-8\">
<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; img-src 'self' file:; base-uri 'none'; form-action 'none'\">
<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">
<title>Lamplight: gallery</title>
<style>
:root { color-scheme: light dark; --page: light-dark(#fbfaf8, #15171b); --ink: light-dark(#1d2026, #e4e6ea);
  --quiet: light-dark(#5a616c, #9aa2ae); --edge: light-dark(#d9d6d0, #30343c); --link: light-dark(#1a5fb4, #7ab4ff); }
body { font: 15px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 74rem; padding: 0 1rem;
  background: var(--page); color: var(--ink); }
a { color: var(--link); }
nav { display: flex; flex-wrap: wrap; gap: .3rem .9rem; font-size: .9rem; }
section { border-top: 1px solid var(--edge); padding: 1rem 0; }
article { display: flex; gap: 1.5rem; flex-wrap: wrap; padding: 1.5rem 0; border-top: 1px solid var(--edge); }
article > div { flex: 1 1 24rem; min-width: 0; }
article > a { flex: 0 1 480px; align-self: flex-start; }
h3 { margin: 0 0 .3rem; font-size: 1.15rem; }
img { border-radius: 6px; width: 100%; height: auto; display: block; }
section img { width: auto; max-width: 100%; }
ul { padding-left: 1.1rem; margin: .5rem 0; color: var(--quiet); font-size: .92rem; }
code { overflow-wrap: anywhere; }
pre { overflow: auto; padding: .6rem .8rem; border: 1px solid var(--edge); border-radius: 6px; font-size: 12.5px; }
.look { border-left: 3px solid var(--link); padding-left: .7rem; }
</style>
</head>
<body>
<h1>Gallery</h1>
<p><code>lamplight render --all</code> draws every published example and every comparison. Each picture here is a link to its large form.</p>
";

/// The page.
pub fn html_page(cards: &[&Card], strips: &[StripCard]) -> String {
    let mut text = HEAD.to_owned();
    text.push_str("<nav>\n");
    let compared = strips.iter().map(|card| &card.comparison.name);
    for name in compared.chain(cards.iter().map(|card| &card.preset.name)) {
        let name = escape_markup(name);
        let _ = writeln!(text, "<a href=\"#{name}\">{name}</a>");
    }
    text.push_str("</nav>\n");
    text.push_str("<h2>Comparisons</h2>\n");
    strips.iter().for_each(|card| write_strip(&mut text, card));
    let firsts = first_alike(cards);
    let mut here = "";
    for (card, first) in cards.iter().zip(firsts) {
        if card.preset.work() != here {
            here = card.preset.work();
            let _ = writeln!(text, "<h2>{}</h2>", escape_markup(here));
        }
        write_article(&mut text, card, cards[first]);
    }
    text.push_str("</body>\n</html>\n");
    text
}

fn write_strip(text: &mut String, card: &StripCard) {
    let (name, file) = (escape_markup(&card.comparison.name), strip_file(&card.comparison.name));
    let _ = writeln!(
        text,
        "<section id=\"{name}\">\n<h3>{name}</h3>\n<p>{}</p>\n<p class=\"look\">{}</p>\n\
         <a href=\"{file}\"><img alt=\"{name}\" src=\"{file}\" loading=\"lazy\"></a>\n\
         <pre>{}</pre>\n</section>",
        html_prose(&card.comparison.doc),
        html_prose(&card.comparison.look),
        escape_markup(&card.command())
    );
}

fn write_article(text: &mut String, card: &Card, first: &Card) {
    let preset = &card.preset;
    let name = escape_markup(&preset.name);
    let [picture, thumb] = picture_files(&name);
    let [width, height] = SIZE.map(|side| side / THUMB);
    let _ = writeln!(
        text,
        "<article id=\"{name}\">\n<a href=\"{picture}\"><img alt=\"{name}\" src=\"{thumb}\" \
         width=\"{width}\" height=\"{height}\" loading=\"lazy\"></a>\n<div>\n<h3>{name}</h3>\n\
         <p>{}</p>\n<p class=\"look\">{}</p>\n<pre>{}</pre>\n<ul>",
        html_prose(&preset.doc),
        html_prose(&preset.look),
        escape_markup(&card.command())
    );
    for deviation in &preset.deviations {
        let _ = writeln!(text, "<li>differs from the source: {}</li>", html_prose(deviation));
    }
    let _ = writeln!(text, "<li>{}</li>", escape_markup(&preset.source));
    for (program, key) in card.passes() {
        let page =
            html_link(&format!("../catalogue/programs.md#{}", program.replace('_', "-")), program);
        let _ = writeln!(text, "<li>{page}: <code>{}</code></li>", escape_markup(&key));
    }
    let functions: Vec<String> =
        card.functions().map(|(name, page)| html_link(&page, name)).collect();
    if !functions.is_empty() {
        let _ = writeln!(text, "<li>functions: {}</li>", functions.join(", "));
    }
    write_facts(text, card);
    for file in first.files() {
        let _ = writeln!(text, "<li>composed text: {}</li>", html_link(&file, &file));
    }
    text.push_str("</ul>\n</div>\n</article>\n");
}

/// Scene, numbers, light probe.
fn write_facts(text: &mut String, card: &Card) {
    let preset = &card.preset;
    let _ = writeln!(text, "<li>scene: {}</li>", escape_markup(&preset.scene));
    for (group, fields) in &preset.numbers {
        for (field, value) in fields {
            let name = escape_markup(&format!("{group}.{field}"));
            let _ = writeln!(text, "<li><code>{name} = {value}</code></li>");
        }
    }
    if let Some(probe) = &preset.probe {
        let _ = writeln!(text, "<li>light probe: {}</li>", escape_markup(probe));
    }
}

fn html_link(page: &str, words: &str) -> String {
    format!("<a href=\"{}\">{}</a>", escape_markup(page), escape_markup(words))
}

/// Text as HTML. What is between backticks becomes code.
fn html_prose(text: &str) -> String {
    let part = |(index, part): (usize, &str)| match index % 2 {
        1 => format!("<code>{}</code>", escape_markup(part)),
        _ => escape_markup(part),
    };
    text.split('`').enumerate().map(part).collect()
}

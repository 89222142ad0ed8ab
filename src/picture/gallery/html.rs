//! The gallery as one HTML file that needs no other.

use std::fmt::Write as _;

use super::{Card, Exhibit, first_alike};

const HEAD: &str = "<!doctype html>
<html lang=\"en\">
<head>
<meta charset=\"utf-8\">
<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">
<title>Lamplight: gallery</title>
<style>
:root { color-scheme: light dark; --edge: #8884; }
body { font: 15px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 68rem; padding: 0 1rem; }
article { display: flex; gap: 1.5rem; flex-wrap: wrap; padding: 1.5rem 0; border-top: 1px solid var(--edge); }
article > div { flex: 1 1 24rem; min-width: 0; }
h2 { margin: 0 0 .3rem; font-size: 1.15rem; }
img { border-radius: 6px; width: min(20rem, 100%); height: auto; align-self: flex-start; }
ul { padding-left: 1.1rem; margin: .5rem 0; }
code { overflow-wrap: anywhere; }
pre { overflow: auto; max-height: 30rem; padding: .8rem; border: 1px solid var(--edge); border-radius: 6px; font-size: 12px; }
.quiet { opacity: .7; }
</style>
</head>
<body>
<h1>Gallery</h1>
<p>Every published example, drawn by <code>lamplight render --all</code>.</p>
";

/// The page, pictures inside.
///
/// # Errors
/// In words: a picture that cannot be written.
pub fn page(exhibits: &[Exhibit]) -> Result<String, String> {
    let mut text = HEAD.to_owned();
    let cards: Vec<&Card> = exhibits.iter().map(|exhibit| &exhibit.card).collect();
    for (exhibit, first) in exhibits.iter().zip(first_alike(&cards)) {
        article(&mut text, exhibit, cards[first])?;
    }
    text.push_str("</body>\n</html>\n");
    Ok(text)
}

fn article(text: &mut String, exhibit: &Exhibit, first: &Card) -> Result<(), String> {
    let preset = &exhibit.card.preset;
    let name = escaped(&preset.name);
    let (width, height) = (exhibit.picture.width, exhibit.picture.height);
    let picture = base64(&exhibit.picture.png()?);
    let _ = write!(
        text,
        "<article id=\"{name}\">\n<img alt=\"{name}\" width=\"{width}\" height=\"{height}\" "
    );
    let _ = write!(
        text,
        "src=\"data:image/png;base64,{picture}\">\n<div>\n<h2>{name}</h2>\n<p>{}</p>\n<ul>\n",
        prose(&preset.doc)
    );
    for deviation in &preset.deviations {
        let _ = writeln!(text, "<li>differs from the source: {}</li>", prose(deviation));
    }
    let _ = writeln!(text, "<li>{}</li>", escaped(&preset.source));
    for pass in exhibit.card.passes() {
        let _ = writeln!(text, "<li><code>{}</code></li>", escaped(&pass));
    }
    let _ = writeln!(text, "<li>scene: {}</li>", escaped(&preset.scene));
    for (group, fields) in &preset.numbers {
        for (field, value) in fields {
            let _ = writeln!(
                text,
                "<li><code>{}.{} = {value}</code></li>",
                escaped(group),
                escaped(field)
            );
        }
    }
    if let Some(probe) = &preset.probe {
        let _ = writeln!(text, "<li>light probe: {}</li>", escaped(probe));
    }
    let _ = writeln!(text, "<li><code>{}</code></li>\n</ul>", escaped(&exhibit.card.command()));
    composed(text, &exhibit.card, first);
    let _ =
        writeln!(text, "<p class=\"quiet\">{}</p>\n</div>\n</article>", escaped(&exhibit.adapter));
    Ok(())
}

fn composed(text: &mut String, card: &Card, first: &Card) {
    if first.preset.name != card.preset.name {
        let name = escaped(&first.preset.name);
        let _ =
            writeln!(text, "<p>The composed text is that of <a href=\"#{name}\">{name}</a>.</p>");
        return;
    }
    text.push_str("<details><summary>composed text</summary>\n");
    for composed in &card.texts {
        let _ = writeln!(text, "<pre>{}</pre>", escaped(composed));
    }
    text.push_str("</details>\n");
}

/// Text with its code marked as such.
fn prose(text: &str) -> String {
    let parts = text.split('`').enumerate();
    parts
        .map(
            |(index, part)| {
                if index % 2 == 1 {
                    format!("<code>{}</code>", escaped(part))
                } else {
                    escaped(part)
                }
            },
        )
        .collect()
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Bytes as data addresses have them (RFC 4648).
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let word = three
            .iter()
            .chain([0, 0].iter())
            .take(3)
            .fold(0u32, |word, byte| word << 8 | u32::from(*byte));
        let digits = (0..4).map(|index| DIGITS[(word >> (18 - 6 * index)) as usize & 63]);
        // A digit for each six bits that there are.
        text.extend(digits.take(three.len() + 1).map(char::from));
        text.extend(std::iter::repeat_n('=', 3 - three.len()));
    }
    text
}

//! The gallery: every preset as a picture, with everything that it was made from.
//!
//! The gallery is a page of HTML beside large pictures and composed texts. The repository has
//! another page, in Markdown, which shows the small pictures that the tests compare.

use crate::frame::{Programs, Stages};
use crate::passes::prepare_passes;
use crate::pixels::Picture;
use crate::plan::{Pass, Plan, known_program};
use crate::strip::Comparison;
use crate::{Shot, strip};
use lamplight_bundle::Language;
use lamplight_catalogue::preset::{Preset, SAFE};
use lamplight_diagnostic::{Diagnostics, escape_markup};
use lamplight_execute::Session;
use lamplight_scenes::sets;
use lamplight_scenes::sets::Scene;
use std::fmt::Write as _;
use std::sync::Arc;

/// The size of the gallery's pictures in pixels, and the samples for each pixel.
pub const SIZE: [u32; 2] = [960, 720];
pub const SAMPLES: u32 = 16;

/// One preset with its picture.
pub struct Exhibit {
    pub card: Card,
    pub picture: Picture,
    /// What drew it.
    pub adapter: String,
}

/// What the pages say about a preset.
pub struct Card {
    pub preset: Preset,
    /// The composed texts of the last pass: one, or one for each stage.
    texts: Vec<Arc<str>>,
    /// The library's functions in them, by path.
    functions: Vec<String>,
}

impl Exhibit {
    /// Draws a preset.
    ///
    /// # Errors
    /// Those of compositions and of the painter.
    pub fn new(
        painter: &dyn Session,
        programs: &Programs,
        preset: &Preset,
        plan: &Plan,
        shot: &Shot,
    ) -> Result<Self, Diagnostics> {
        let card = Card::new(programs, preset, shot.language)?;
        let picture =
            prepare_passes(painter, programs, plan, shot)?.photograph(painter, shot)?.develop();
        Ok(Self { card, picture, adapter: painter.adapter() })
    }
}

impl Card {
    /// What the pages say about a preset, without its picture.
    ///
    /// # Errors
    /// Those of the composition.
    pub fn new(
        programs: &Programs,
        preset: &Preset,
        language: Language,
    ) -> Result<Self, Diagnostics> {
        let plan = Plan::of_preset(programs, preset, &[])?;
        let last = plan.last().map(|pass| compiled_stages(programs, pass, language)).transpose()?;
        Ok(Self {
            preset: preset.clone(),
            texts: last.as_ref().map_or_else(Vec::new, stage_texts),
            functions: last.as_ref().map_or_else(Vec::new, named_functions),
        })
    }

    /// Programs and keys of all passes, in order.
    fn passes(&self) -> Vec<(&str, String)> {
        let earlier = self.preset.passes.iter().map(|pass| (&pass.program, &pass.key));
        let all = earlier.chain([(&self.preset.program, &self.preset.key)]);
        all.map(|(program, key)| (program.as_str(), key.replace(',', ", "))).collect()
    }

    /// Paths of the composed texts beside the page. They end in `.txt`, since they are for reading
    /// and not for compiling.
    fn files(&self) -> impl Iterator<Item = String> {
        let extensions: &[&str] =
            if self.texts.len() == 1 { &["wgsl"] } else { &["vert.glsl", "frag.glsl"] };
        extensions.iter().map(|extension| format!("composed/{}.{extension}.txt", self.preset.name))
    }

    /// The command that draws it.
    fn command(&self) -> String {
        render_command(&self.preset.name)
    }

    /// Each function of the library that its text has: the path, and its page below `docs`.
    fn functions(&self, docs: &str) -> impl Iterator<Item = (&str, String)> {
        self.functions.iter().filter_map(move |path| {
            let (module, name) = path.rsplit_once("::")?;
            Some((name, format!("{docs}/catalogue/{}.md#{name}", module.replace("::", "/"))))
        })
    }
}

/// What the pages say about a comparison.
pub struct StripCard {
    pub comparison: Comparison,
    fingerprint: String,
}

impl StripCard {
    /// What the pages say about a comparison, without its picture.
    ///
    /// # Errors
    /// Those of the compositions.
    pub fn new(
        programs: &Programs,
        comparison: Comparison,
        language: Language,
    ) -> Result<Self, Diagnostics> {
        let mut hasher = blake3::Hasher::new();
        let Comparison { scene, code, inset, panels, .. } = &comparison;
        hasher.update(serde_json::json!([scene, code, inset, panels]).to_string().as_bytes());
        hasher.update(geometry_text(scene).as_bytes());
        for panel in panels.iter().filter(|panel| panel.value.is_none()) {
            let plan = strip::panel_plan(programs, &comparison, panel)?;
            for text in composed_texts(programs, &plan, language)?.concat() {
                hasher.update(text.as_bytes());
            }
        }
        let fingerprint = hasher.finalize().to_hex()[..16].to_owned();
        Ok(Self { comparison, fingerprint })
    }

    /// How the line of `adapters.txt` begins if the picture is up to date.
    pub fn current(&self, shot: &Shot) -> String {
        let file = strip_file(&self.comparison.name);
        format!("{}, of {}", shot_words(&file, shot), self.fingerprint)
    }

    /// The command that draws it.
    fn command(&self) -> String {
        render_command(&self.comparison.name)
    }
}

/// The path of a comparison's picture beside the page.
pub fn strip_file(name: &str) -> String {
    format!("compared/{name}.png")
}

/// The file of a picture, its size and its samples.
fn shot_words(file: &str, shot: &Shot) -> String {
    let ([width, height], samples) = (shot.size, shot.samples);
    format!("{file}  {width}x{height}, {samples} samples")
}

fn render_command(name: &str) -> String {
    let [width, height] = SIZE;
    format!("lamplight render {name} --size {width}x{height} --samples {SAMPLES}")
}

/// The texts of every pass.
fn composed_texts(
    programs: &Programs,
    plan: &Plan,
    language: Language,
) -> Result<Vec<Vec<Arc<str>>>, Diagnostics> {
    let stages = |pass| Ok(stage_texts(&compiled_stages(programs, pass, language)?));
    plan.passes.iter().map(stages).collect()
}

fn compiled_stages(
    programs: &Programs,
    pass: &Pass,
    language: Language,
) -> Result<Stages, Diagnostics> {
    programs.stages(known_program(programs, &pass.program)?, &pass.settings, language)
}

/// Shapes, lamps and viewer of a scene as text, to the thousandth: the last digits of a sine differ
/// from machine to machine.
fn geometry_text(scene: &str) -> String {
    let Some(set) = sets::ALL.iter().find(|set| set.name == scene) else { return String::new() };
    let Scene {
        objects,
        eye,
        lamps,
        materials,
        ambient,
        sky,
        ground,
        haze,
        haze_range,
        map_size,
        shows_lamps,
        lamp_size,
        probes,
        around,
        room,
        maps: _,
        own_maps: _,
        lamp_numbers: _,
    } = (set.make)();
    let seen = (objects, eye, lamps, materials);
    let size = lamp_size.map(|size| format!(" {size}")).unwrap_or_default();
    let probes = probes.map(|probes| format!(" {probes:?}")).unwrap_or_default();
    let around = around.map(|around| format!(" {around}")).unwrap_or_default();
    let room = room.map(|room| format!(" {room:?}")).unwrap_or_default();
    format!(
        "{seen:.3?} {ambient} {sky} {ground} {haze} {haze_range:?} {map_size:?} {shows_lamps}{size}{probes}{around}{room}"
    )
}

fn stage_texts(stages: &Stages) -> Vec<Arc<str>> {
    let vertex = stages.vertex.text.clone();
    let fragment = stages.fragment.iter().map(|stage| stage.text.clone());
    let other: Vec<_> = fragment.filter(|text| *text != vertex).collect();
    std::iter::once(vertex).chain(other).collect()
}

fn named_functions(stages: &Stages) -> Vec<String> {
    let all = [Some(&stages.vertex), stages.fragment.as_ref()];
    let all = all.into_iter().flatten().flat_map(|stage| stage.functions.iter().cloned());
    all.collect::<std::collections::BTreeSet<_>>().into_iter().collect()
}

/// The path of a picture beside the page of HTML.
pub fn picture_file(name: &str) -> String {
    format!("{name}.png")
}

/// The path of a small picture from the page of Markdown.
fn thumb_file(name: &str) -> String {
    format!("../../tests/render/reviewed/{name}.png")
}

/// The composed texts, by path beside the page. Cards with the same texts share those of the first.
pub fn composed(cards: &[&Card]) -> Vec<(String, String)> {
    let first = first_alike(cards);
    let own = cards.iter().enumerate().filter(|(index, _)| first[*index] == *index);
    own.flat_map(|(_, card)| card.files().zip(card.texts.iter().map(ToString::to_string))).collect()
}

/// For each card, the first card with the same composed texts.
fn first_alike(cards: &[&Card]) -> Vec<usize> {
    let first =
        |card: &&Card| cards.iter().position(|other| other.texts == card.texts).unwrap_or(0);
    cards.iter().map(first).collect()
}

/// Which driver drew which picture: a line for each picture.
pub fn adapter_lines(exhibits: &[Exhibit], shot: &Shot) -> String {
    let line = |exhibit: &Exhibit| {
        let file = picture_file(&exhibit.card.preset.name);
        format!("{}, {}\n", shot_words(&file, shot), exhibit.adapter)
    };
    exhibits.iter().map(line).collect()
}

/// Pictures in one row of the overview.
const COLUMNS: usize = 4;

/// The page of the repository, `docs/gallery/README.md`. Small pictures are those of the tests.
pub fn markdown_page(cards: &[&Card], strips: &[StripCard]) -> String {
    let mut text =
        "# Gallery\n\nEvery published example and every comparison. `lamplight render --all` \
                    draws them large, beside a page that has the\ncomposed texts too. The site has \
                    that page under `gallery/`.\n\nPictures are coded as sRGB. The listings of the \
                    books write linear numbers to the frame buffer\nas they are: the first ball of \
                    `oglpg_7_1` has the colour (0.82, 0.26, 0.2), which is\n(209, 66, 51) in their \
                    frame buffers, and (234, 139, 124) here.\n\
                    [numbers_of_a_frame](#numbers_of_a_frame) shows both.\n\n\
                    [The listings](../published.md) has a row for each listing that is drawn as \
                    printed.\n"
            .to_owned();
    text.push_str("\n## Comparisons\n");
    strips.iter().for_each(|card| write_strip(&mut text, card));
    for group in cards.chunk_by(|a, b| a.preset.work() == b.preset.work()) {
        let _ = write!(text, "\n## {}\n\n", group[0].preset.work());
        write_overview(&mut text, group);
        group.iter().for_each(|card| write_section(&mut text, card));
    }
    text
}

/// A comparison, and the permutations or expressions of its panels.
fn write_strip(text: &mut String, card: &StripCard) {
    let (name, file) = (&card.comparison.name, strip_file(&card.comparison.name));
    let (doc, look) = (&card.comparison.doc, &card.comparison.look);
    let _ = write!(
        text,
        "\n### {name}\n\n![{name}]({file})\n\n{doc} **Look for:** {look}\n\n\
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
            format!(" [![{name}]({})](#{name})<br>`{name}` |", thumb_file(name))
        };
        let _ = writeln!(text, "|{}", row.iter().map(cell).collect::<String>());
    }
}

fn write_section(text: &mut String, card: &Card) {
    let preset = &card.preset;
    let name = &preset.name;
    let _ = write!(
        text,
        "\n### {name}\n\n![{name}]({})\n\n{} **Look for:** {}\n\n",
        thumb_file(name),
        preset.doc,
        preset.look
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
    if let Some(key) = &preset.safe {
        let key = key.replace(',', ", ");
        let lamps: String = preset
            .safe_light
            .iter()
            .map(|(field, value)| format!(", `light.{field}` = {value}"))
            .collect();
        let _ = writeln!(
            text,
            "- safe form: [{SAFE}](../catalogue/programs.md#{SAFE}): `{key}`{lamps}"
        );
        let _ = writeln!(
            text,
            "- as printed, in the safe form, and the difference: `lamplight render {name} --beside`"
        );
    }
    let functions: Vec<String> =
        card.functions("..").map(|(name, page)| format!("[{name}]({page})")).collect();
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
}

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
<p><code>lamplight render --all</code> draws every published example and every comparison. Each picture is a link to its large form. Pictures are coded as sRGB, where the listings of the books write linear numbers as they are: (0.82, 0.26, 0.2) is (209, 66, 51) there, and (234, 139, 124) here.</p>
";

/// Where the page of HTML finds the documentation, since it can be anywhere.
const DOCS: &str = concat!(env!("CARGO_PKG_REPOSITORY"), "/blob/main/docs");
/// The page shows pictures smaller by this factor.
const SHOWN: u32 = 2;

/// The page beside the large pictures.
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
    strips.iter().for_each(|card| write_html_strip(&mut text, card));
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

fn write_html_strip(text: &mut String, card: &StripCard) {
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
    let picture = picture_file(&name);
    let [width, height] = SIZE.map(|side| side / SHOWN);
    let _ = writeln!(
        text,
        "<article id=\"{name}\">\n<a href=\"{picture}\"><img alt=\"{name}\" src=\"{picture}\" \
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
        let page = format!("{DOCS}/catalogue/programs.md#{}", program.replace('_', "-"));
        let page = html_link(&page, program);
        let _ = writeln!(text, "<li>{page}: <code>{}</code></li>", escape_markup(&key));
    }
    let functions: Vec<String> =
        card.functions(DOCS).map(|(name, page)| html_link(&page, name)).collect();
    if !functions.is_empty() {
        let _ = writeln!(text, "<li>functions: {}</li>", functions.join(", "));
    }
    if let Some(key) = &preset.safe {
        let page = html_link(&format!("{DOCS}/catalogue/programs.md#{SAFE}"), SAFE);
        let key = escape_markup(&key.replace(',', ", "));
        let lamps: String = preset
            .safe_light
            .iter()
            .map(|(field, value)| format!(", <code>light.{field}</code> = {value}"))
            .collect();
        let _ = writeln!(text, "<li>safe form: {page}: <code>{key}</code>{lamps}</li>");
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pixels::srgb_code;

    /// The head of both pages names the colour of the first ball, linear and coded.
    #[test]
    fn the_first_ball_has_the_colours_of_the_pages() {
        let color = sets::scene("spheres").expect("a scene").objects[0].color.to_array();
        let codes = [color.map(|part| (part * 255.0).round() as u8), color.map(srgb_code)];
        let text = |codes: [u8; 3]| format!("({}, {}, {})", codes[0], codes[1], codes[2]);
        for page in [markdown_page(&[], &[]), HEAD.to_owned()] {
            assert!(page.contains(&format!("({}, {}, {})", color[0], color[1], color[2])));
            for code in codes.map(text) {
                assert!(page.contains(&code), "{code}");
            }
        }
    }
}

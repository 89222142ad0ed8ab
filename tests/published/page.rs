//! `docs/published.md`: for each listing whether it is drawn as printed, and how far its safe form is
//! from it.
//!
//! The evaluator draws the pictures, so the page is the same everywhere. By day, the test compares what
//! every row says without a picture, and draws the pictures of some; with `UPDATE_EXPECT=1` it writes all.

use std::fmt::Write as _;

use glam::DVec3;
use lamplight::bundle::Language;
use lamplight::catalogue::preset::Preset;
use lamplight::execute::Session;
use lamplight::picture::{Linear, prepare_passes};
use libtest_mimic::{Failed, Trial};

use super::compared::table;
use super::listings::{SIZE, agreement, is_published};
use super::quantities::{disagreements, published_tables};
use crate::render::{library, on_device, plan, rendered, shot};
use crate::{is_whole, snapshot};

const HEAD: &str = "\
# The published listings, as printed

The program `published` computes what four sources print, term by term, with their flaws. Each row is
a listing. Numbers that its text gives are in `shaderlib/published.toml`, and a test compares them with
the preset. A picture of 96 by 72 pixels was drawn by the evaluator. Of the pixels that show a surface,
at least 500 were compared with a model of the listing in f64, which was written from the text alone.
A pixel agrees if each channel is within 1 % of the model, or of a hundredth of white if that is more.
\"Undefined\" are pixels where the source's language leaves the value undefined.

The last columns say how far the safe form of the library is from the printed one, as the display shows
both: the share of the pixels that differ by more than 1 % of white, and the largest difference of a
channel. Lamps of Newcastle's listings fade to nothing at a radius, those of the safe form as light does:
they have 4.5 times the colour there, with which the ground below them is about as bright. `lamplight render
PRESET --beside` draws both and their difference.

| listing | section | numbers | agree | undefined | deviations | safe form: pixels | largest |
|---|---|---|---|---|---|---|---|
";

const EXECUTORS: &str = "
## Where they were compared

The same comparison on other executors: the share of the defined pixels that agree, in per cent, the
smaller one of both languages. `eval`, `vulkan` and `gl` draw the composed texts. The others draw the
outputs of a target as they are, which is the first part of their name where it has several executors
or another name: `webgpu` and `webgl2` in Chromium, `hlsl` by way of glslangValidator, `msl` compiled
for the CPU. `cargo xtask record published::compared published::page` draws all and writes the table.
Where a comparison is missing, a row has a red dot, and a test fails. As on the page above, 99.5 % have
to agree; of `hpg_6_pcf_random` on SwiftShader, which is also that of Chromium here, 99 %. SwiftShader
moves corners to sixteenths of a pixel: pixels whose middle is then on an edge are not compared.

";

/// By day, the pictures of every so many rows are drawn.
const STEP: usize = 12;
/// Differences that can be seen, of white.
const VISIBLE: f64 = 0.01;

pub fn tests() -> Vec<Trial> {
    vec![Trial::test("published::page", || on_page().map_err(Failed::from))]
}

fn on_page() -> Result<(), String> {
    let file = snapshot::root().join("docs/published.md");
    let presets: Vec<&Preset> =
        library().presets.iter().filter(|preset| is_published(preset)).collect();
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        let rows = presets.iter().map(|preset| row_of(preset)).collect::<Result<String, _>>()?;
        let text = format!("{HEAD}{rows}{EXECUTORS}{}", table()?);
        return std::fs::write(&file, text).map_err(|error| error.to_string());
    }
    let page = std::fs::read_to_string(&file).map_err(|error| error.to_string())?;
    let rows = page.strip_prefix(HEAD).ok_or("the head of docs/published.md is another one")?;
    let rest = format!("{EXECUTORS}{}", table()?);
    let rows = rows.strip_suffix(&rest).ok_or(
        "docs/published.md has another table of executors than tests/published/compared: \
         cargo xtask record published::page writes it",
    )?;
    let rows: Vec<&str> = rows.lines().collect();
    if rows.len() != presets.len() {
        return Err(format!("{} rows for {} listings", rows.len(), presets.len()));
    }
    for (row, preset) in rows.iter().zip(&presets) {
        let facts = Facts::of(preset)?;
        let found: Vec<&str> = row.split(" | ").collect();
        let expected = [&facts.link, &facts.section, &facts.numbers, &facts.deviations];
        let columns = [0, 1, 2, 5].map(|column| found.get(column).copied().unwrap_or_default());
        if columns.map(|one| one.trim_start_matches("| ")) != expected.map(String::as_str) {
            return Err(stale(row, &format!("{expected:?}\n")));
        }
    }
    let step = if is_whole() { 1 } else { STEP };
    for (row, preset) in rows.iter().zip(&presets).step_by(step) {
        let found = row_of(preset)?;
        if found.trim_end() != *row {
            return Err(stale(row, &found));
        }
    }
    Ok(())
}

fn stale(row: &str, found: &str) -> String {
    format!(
        "docs/published.md has\n{row}\nfound\n{found}cargo xtask record published::page writes it"
    )
}

/// What a row says without a picture.
struct Facts {
    link: String,
    section: String,
    numbers: String,
    deviations: String,
}

impl Facts {
    fn of(preset: &Preset) -> Result<Self, String> {
        let tables = published_tables()?;
        let table = tables.get(&preset.name).ok_or("a listing without numbers")?;
        let numbers = match disagreements(preset, table).len() {
            0 => format!("all {}", table.quantities.len()),
            wrong => format!("{wrong} of {} wrong", table.quantities.len()),
        };
        let name = &preset.name;
        Ok(Self {
            link: format!("[{name}](gallery/README.md#{name})"),
            section: table.section.clone(),
            numbers,
            deviations: preset.deviations.len().to_string(),
        })
    }
}

/// The row of a listing.
fn row_of(preset: &'static Preset) -> Result<String, String> {
    let Facts { link, section, numbers, deviations } = Facts::of(preset)?;
    let mut row = String::new();
    on_device("eval", |painter| {
        let found = agreement(painter, preset, Language::Wesl)?;
        let defined = found.compared - found.undefined;
        let [pixels, largest] = match preset.safe_form() {
            Some(safe) => distance(painter, preset, &safe)?,
            None => [String::new(), String::new()],
        };
        writeln!(
            row,
            "| {link} | {section} | {numbers} | {} of {defined} | {} | {deviations} | {pixels} | {largest} |",
            found.agreeing, found.undefined,
        )
        .map_err(|error| error.to_string())
    })
    .map_err(|failed| format!("{failed:?}"))?;
    Ok(row)
}

/// How far two forms are from each other: the share of pixels, and the largest difference.
fn distance(painter: &dyn Session, printed: &Preset, safe: &Preset) -> Result<[String; 2], String> {
    let (printed, safe) = (drawn(painter, printed)?, drawn(painter, safe)?);
    let [width, height] = SIZE;
    let (mut count, mut differing, mut largest) = (0, 0, 0.0_f64);
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let shown = |picture: &Linear| picture.drawn(x, y).map(visible);
        let Some((a, b)) = shown(&printed).zip(shown(&safe)) else { continue };
        let difference = (a - b).abs().max_element();
        count += 1;
        differing += usize::from(difference > VISIBLE);
        largest = largest.max(difference);
    }
    let share = 100.0 * f64::from(differing as u32) / f64::from(count.max(1));
    Ok([format!("{share:.1} %"), format!("{largest:.2}")])
}

/// What a display can show.
fn visible(color: DVec3) -> DVec3 {
    let parts = color.to_array().map(|part| if part.is_nan() { 0.0 } else { part });
    DVec3::from_array(parts).clamp(DVec3::ZERO, DVec3::ONE)
}

fn drawn(painter: &dyn Session, preset: &Preset) -> Result<Linear, String> {
    let (plan, shot) = (plan(preset)?, shot(SIZE, 1, Language::Wesl));
    let prepared = prepare_passes(painter, &library().programs, &plan, &shot).map_err(rendered)?;
    prepared.photograph(painter, &shot).map_err(rendered)
}

//! `lamplight render --all`: every preset, and the pages that show them.

use std::io::Write;
use std::time::Instant;

use super::super::terminal::stdout;
use super::several::draw_all;
use super::{Failure, input_failure, library_comparisons, library_examples};
use crate::catalogue::preset::Preset;
use crate::execute::Session;
use crate::execute::executors::ExecutorEntry;
use crate::output::OutputFolder;
use crate::picture::frame::Programs;
use crate::picture::gallery::{self, Card, Exhibit, StripCard};
use crate::picture::strip::{self, Comparison};
use crate::picture::{Picture, Plan, Shot};

/// Files of the gallery that are not named after a preset.
const PAGES: [&str; 3] = ["README.md", "index.html", "adapters.txt"];

/// Draws all presets into a folder, with a page in Markdown and one in HTML.
pub fn draw_gallery(
    entry: &ExecutorEntry,
    programs: &Programs,
    shot: &Shot,
    mut folder: OutputFolder,
) -> Result<(), Failure> {
    let start = Instant::now();
    let (presets, probes) = library_examples(programs)?;
    let compared = library_comparisons(programs)?;
    check_folder(&folder, &presets, &compared)?;
    let plans = presets
        .iter()
        .map(|preset| Ok((preset, Plan::of_preset(programs, preset, &probes)?)))
        .collect::<Result<Vec<_>, _>>()
        .map_err(|problems| input_failure(programs, problems))?;
    let draw_exhibit = |painter: &mut dyn Session, (preset, plan): &(&Preset, Plan)| {
        let exhibit = Exhibit::new(painter, programs, preset, plan, shot)
            .map_err(|problems| input_failure(programs, problems))?;
        let [picture, thumb] = gallery::picture_files(&preset.name);
        let small = exhibit.picture.shrunk(gallery::THUMB);
        Ok((vec![(picture, png_of(&exhibit.picture)?), (thumb, png_of(&small)?)], exhibit))
    };
    let exhibits = draw_all(entry, &plans, draw_exhibit, &mut folder)?;
    let draw_strip = |painter: &mut dyn Session, comparison: &Comparison| {
        let picture = strip::draw_strip(painter, programs, comparison, shot)
            .map_err(|problems| input_failure(programs, problems))?;
        let card = StripCard::new(programs, comparison.clone(), shot.language)
            .map_err(|problems| input_failure(programs, problems))?;
        let line = format!("{}, {}\n", card.current(shot), painter.adapter());
        Ok((vec![(gallery::strip_file(&comparison.name), png_of(&picture)?)], (card, line)))
    };
    let (strips, drawn): (Vec<_>, Vec<_>) =
        draw_all(entry, &compared, draw_strip, &mut folder)?.into_iter().unzip();
    let lines = gallery::adapter_lines(&exhibits, shot) + &drawn.concat();
    let cards: Vec<&Card> = exhibits.iter().map(|exhibit| &exhibit.card).collect();
    folder.write("README.md", gallery::markdown_page(&cards, &strips).as_bytes())?;
    for (path, text) in gallery::composed(&cards) {
        folder.write(&path, text.as_bytes())?;
    }
    folder.write("index.html", gallery::html_page(&cards, &strips).as_bytes())?;
    folder.write("adapters.txt", lines.as_bytes())?;
    let shown = folder.path().display().to_string();
    folder.finish()?;
    let seconds = start.elapsed().as_secs_f64();
    let adapter = exhibits.first().map_or("", |exhibit| exhibit.adapter.as_str());
    let count = exhibits.len() + strips.len();
    Ok(writeln!(stdout(), "{shown}: {count} pictures in {seconds:.1} s, {adapter}")?)
}

/// Fails if a file that would be replaced is not ours. This is checked first, since drawing takes
/// minutes.
fn check_folder(
    folder: &OutputFolder,
    presets: &[Preset],
    compared: &[Comparison],
) -> Result<(), Failure> {
    let drawn = presets.iter().flat_map(|preset| gallery::picture_files(&preset.name));
    let strips = compared.iter().map(|comparison| gallery::strip_file(&comparison.name));
    let pages = PAGES.iter().map(ToString::to_string);
    for file in pages.chain(drawn).chain(strips) {
        folder.check(&file, None)?;
    }
    Ok(())
}

fn png_of(picture: &Picture) -> Result<Vec<u8>, Failure> {
    picture.png().map_err(Failure::environment)
}

//! `lamplight render --all` and `lamplight render --comparisons`: every preset and every
//! comparison.

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

/// Which driver drew which picture.
const ADAPTERS: &str = "adapters.txt";
/// The page that shows all pictures.
const PAGE: &str = "index.html";

/// Draws all presets and comparisons into a folder, with a page that shows them.
pub fn draw_gallery(
    entry: &ExecutorEntry,
    programs: &Programs,
    shot: &Shot,
    mut folder: OutputFolder,
) -> Result<(), Failure> {
    let start = Instant::now();
    let (presets, probes) = library_examples(programs)?;
    let compared = library_comparisons(programs)?;
    let pictures = presets.iter().map(|preset| gallery::picture_file(&preset.name));
    check_files(&folder, pictures.chain(strip_files(&compared)).chain([PAGE.to_owned()]))?;
    let plans = presets
        .iter()
        .map(|preset| Ok((preset, Plan::of_preset(programs, preset, &probes)?)))
        .collect::<Result<Vec<_>, _>>()
        .map_err(|problems| input_failure(programs, problems))?;
    let draw_exhibit = |painter: &mut dyn Session, (preset, plan): &(&Preset, Plan)| {
        let exhibit = Exhibit::new(painter, programs, preset, plan, shot)
            .map_err(|problems| input_failure(programs, problems))?;
        let file = gallery::picture_file(&preset.name);
        Ok((vec![(file, png_of(&exhibit.picture)?)], exhibit))
    };
    let exhibits = draw_all(entry, &plans, draw_exhibit, &mut folder)?;
    let (strips, lines) = draw_strips(entry, programs, shot, &compared, &mut folder)?;
    let cards: Vec<&Card> = exhibits.iter().map(|exhibit| &exhibit.card).collect();
    for (path, text) in gallery::composed(&cards) {
        folder.write(&path, text.as_bytes())?;
    }
    folder.write(PAGE, gallery::html_page(&cards, &strips).as_bytes())?;
    let lines = gallery::adapter_lines(&exhibits, shot) + &lines;
    finish_folder(folder, &lines, exhibits.len() + strips.len(), start)
}

/// Draws all comparisons into a folder.
pub fn draw_comparisons(
    entry: &ExecutorEntry,
    programs: &Programs,
    shot: &Shot,
    mut folder: OutputFolder,
) -> Result<(), Failure> {
    let start = Instant::now();
    let compared = library_comparisons(programs)?;
    check_files(&folder, strip_files(&compared))?;
    let (strips, lines) = draw_strips(entry, programs, shot, &compared, &mut folder)?;
    finish_folder(folder, &lines, strips.len(), start)
}

/// Draws comparisons, and returns their lines for [`ADAPTERS`].
fn draw_strips(
    entry: &ExecutorEntry,
    programs: &Programs,
    shot: &Shot,
    compared: &[Comparison],
    folder: &mut OutputFolder,
) -> Result<(Vec<StripCard>, String), Failure> {
    let draw_strip = |painter: &mut dyn Session, comparison: &Comparison| {
        let picture = strip::draw_strip(painter, programs, comparison, shot)
            .map_err(|problems| input_failure(programs, problems))?;
        let card = StripCard::new(programs, comparison.clone(), shot.language)
            .map_err(|problems| input_failure(programs, problems))?;
        let line = format!("{}, {}\n", card.current(shot), painter.adapter());
        Ok((vec![(gallery::strip_file(&comparison.name), png_of(&picture)?)], (card, line)))
    };
    Ok(draw_all(entry, compared, draw_strip, folder)?.into_iter().unzip())
}

fn strip_files(compared: &[Comparison]) -> impl Iterator<Item = String> {
    compared.iter().map(|comparison| gallery::strip_file(&comparison.name))
}

/// Fails if a file that would be replaced is not ours. This is checked first, since drawing takes
/// minutes.
fn check_files(folder: &OutputFolder, files: impl Iterator<Item = String>) -> Result<(), Failure> {
    for file in files.chain([ADAPTERS.to_owned()]) {
        folder.check(&file, None)?;
    }
    Ok(())
}

fn finish_folder(
    mut folder: OutputFolder,
    lines: &str,
    count: usize,
    start: Instant,
) -> Result<(), Failure> {
    folder.write(ADAPTERS, lines.as_bytes())?;
    let shown = folder.path().display().to_string();
    folder.finish()?;
    let seconds = start.elapsed().as_secs_f64();
    Ok(writeln!(stdout(), "{shown}: {count} pictures in {seconds:.1} s")?)
}

fn png_of(picture: &Picture) -> Result<Vec<u8>, Failure> {
    picture.png().map_err(Failure::environment)
}

//! `lamplight render --all`: every preset, and the pages that show them.

use std::io::Write;
use std::time::Instant;

use super::super::terminal::stdout;
use super::{Failure, input_failure, library_comparisons, library_examples};
use crate::catalogue::preset::Preset;
use crate::execute::Session;
use crate::output::Folder;
use crate::picture::frame::Programs;
use crate::picture::gallery::{self, Card, Exhibit, StripCard};
use crate::picture::strip::{self, Comparison};
use crate::picture::{Plan, Shot};

/// Files of the gallery that are not named after a preset.
const PAGES: [&str; 3] = ["README.md", "index.html", "adapters.txt"];

/// Draws all presets into a folder, with a page in Markdown and one in HTML.
pub fn draw_gallery(
    painter: &mut dyn Session,
    programs: &Programs,
    shot: &Shot,
    mut folder: Folder,
) -> Result<(), Failure> {
    let start = Instant::now();
    let (presets, probes) = library_examples(programs)?;
    let compared = library_comparisons(programs)?;
    check_folder(&folder, &presets, &compared)?;
    let mut exhibits = Vec::new();
    for preset in &presets {
        let plan = Plan::of_preset(programs, preset, &probes)
            .map_err(|problems| input_failure(programs, problems))?;
        let exhibit = Exhibit::new(&*painter, programs, preset, &plan, shot)
            .map_err(|problems| input_failure(programs, problems))?;
        let [picture, thumb] = gallery::picture_files(&preset.name);
        let small = exhibit.picture.shrunk(gallery::THUMB);
        folder.write(&picture, &exhibit.picture.png().map_err(Failure::environment)?)?;
        folder.write(&thumb, &small.png().map_err(Failure::environment)?)?;
        exhibits.push(exhibit);
    }
    let mut lines = gallery::adapter_lines(&exhibits, shot);
    let (strips, drawn) = draw_strips(painter, programs, shot, &mut folder, compared)?;
    lines += &drawn;
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
    Ok(writeln!(
        stdout(),
        "{shown}: {} pictures in {seconds:.1} s, {}",
        exhibits.len() + strips.len(),
        painter.adapter()
    )?)
}

/// Fails if a file that would be replaced is not ours. This is checked first, since drawing takes
/// minutes.
fn check_folder(
    folder: &Folder,
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

/// Draws all comparisons into the folder. Returns a card for each, and the lines of `adapters.txt`
/// that name the adapter of each.
fn draw_strips(
    painter: &mut dyn Session,
    programs: &Programs,
    shot: &Shot,
    folder: &mut Folder,
    compared: Vec<Comparison>,
) -> Result<(Vec<StripCard>, String), Failure> {
    let (mut strips, mut lines) = (Vec::new(), String::new());
    for comparison in compared {
        let picture = strip::draw_strip(painter, programs, &comparison, shot)
            .map_err(|problems| input_failure(programs, problems))?;
        let file = gallery::strip_file(&comparison.name);
        folder.write(&file, &picture.png().map_err(Failure::environment)?)?;
        let card = StripCard::new(programs, comparison, shot.language)
            .map_err(|problems| input_failure(programs, problems))?;
        lines += &format!("{}, {}\n", card.current(shot), painter.adapter());
        strips.push(card);
    }
    Ok((strips, lines))
}

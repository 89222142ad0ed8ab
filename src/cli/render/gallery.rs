//! `lamplight render --all`: every preset, and the pages that show them.

use std::io::{Write, stdout};
use std::path::Path;
use std::time::Instant;

use super::{Failure, input, library, write};
use crate::harness::frame::{Painter, Programs};
use crate::harness::render::gallery::{self, Card, Exhibit};
use crate::harness::render::{Plan, Shot};

/// Draws all presets into a folder, with a page in Markdown and one in HTML.
pub fn run(painter: &dyn Painter, programs: &Programs, shot: &Shot, folder: &Path) -> Result<(), Failure> {
    let start = Instant::now();
    let (presets, probes) = library(programs)?;
    let mut exhibits = Vec::new();
    for preset in &presets {
        let plan = Plan::of_preset(programs, preset, &probes).map_err(|problems| input(programs, problems))?;
        let exhibit = Exhibit::new(painter, programs, preset, &plan, shot).map_err(|problems| input(programs, problems))?;
        let png = exhibit.picture.png().map_err(Failure::environment)?;
        write(&folder.join(format!("{}.png", preset.name)), &png)?;
        exhibits.push(exhibit);
    }
    let cards: Vec<&Card> = exhibits.iter().map(|exhibit| &exhibit.card).collect();
    write(&folder.join("README.md"), gallery::markdown(&cards).as_bytes())?;
    for (path, text) in gallery::composed(&cards) {
        write(&folder.join(path), text.as_bytes())?;
    }
    write(&folder.join("index.html"), gallery::html(&exhibits).map_err(Failure::environment)?.as_bytes())?;
    write(&folder.join("adapters.txt"), gallery::adapters(&exhibits, shot).as_bytes())?;
    let seconds = start.elapsed().as_secs_f64();
    Ok(writeln!(stdout(), "{}: {} pictures in {seconds:.1} s, {}", folder.display(), exhibits.len(), painter.adapter())?)
}

//! What runs for one pixel of a picture, statement by statement, and where marks are in all of it.
//!
//! `request -> prepared pass -> fragments of a pixel -> subject -> events`
//!
//! Sketches are prepared here. A picture of a program needs what the page drew, so it is asked about
//! while it is the last picture that the page began.

mod run;
mod survey;

use std::cell::RefCell;

use lamplight::diagnostic::Diagnostics;
use lamplight::source::SourceSet;
use lamplight_debug::{Call, Subject, SubjectText};
use lamplight_picture::{PictureFragment, PreparedPass, Shot};
use serde::Deserialize;
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::wasm_bindgen;

use crate::diagnostic::diagnostics;
use crate::picture::exchange::PictureRequest;
use crate::picture::sketch::{PreparedSketch, SketchRequest, prepared_sketch};
use crate::picture::{with_last_picture, with_texts};
use crate::{Answer, answer};
use run::{PixelRun, recorded};

/// How many turns all loops of a fragment may make. Pictures of sketches end loops much earlier.
const TRIPS: u64 = 1 << 16;

/// The share of a value that its bound may have before its digits count as lost.
const LOST_SHARE: f64 = 0.01;

/// A pixel, and what is shown of it.
#[derive(Clone, Copy, Deserialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct PixelChoice {
    /// The column, from the left.
    pub x: u32,
    /// The row, from the top.
    pub y: u32,
    /// Which fragment of its quad runs: 0 and 1 are the upper ones, 2 and 3 the lower ones. Without
    /// it, that of the pixel.
    #[serde(default)]
    #[tsify(optional)]
    pub lane: Option<u32>,
}

/// A sketch that was asked about, which is likely to be asked about again.
struct Kept {
    request: SketchRequest,
    sources: SourceSet,
    prepared: Box<PreparedSketch>,
}

thread_local! {
    static KEPT: RefCell<Option<Kept>> = const { RefCell::new(None) };
}

/// Runs the fragment that a pixel of a sketch shows.
#[wasm_bindgen(js_name = sketchPixel)]
pub fn sketch_pixel(request: Ts<SketchRequest>, pixel: Ts<PixelChoice>) -> Answer<PixelRun> {
    let (request, pixel) = (request.to_rust()?, pixel.to_rust()?);
    answer(
        &with_sketch(request, |sketch, sources| {
            let PreparedSketch { prepared, shot, is_upside_down } = sketch;
            let y = turned_row(pixel.y, shot, *is_upside_down);
            pixel_run(prepared, shot, sources, PixelChoice { y, ..pixel })
        })
        .unwrap_or_else(|(sources, problems)| PixelRun::failed(&sources, &problems)),
    )
}

/// The same for the picture of a program, which is to be the last one that was drawn; otherwise the
/// answer says that it is lacking.
#[wasm_bindgen(js_name = picturePixel)]
pub fn picture_pixel(request: Ts<PictureRequest>, pixel: Ts<PixelChoice>) -> Answer<PixelRun> {
    let (request, pixel) = (request.to_rust()?, pixel.to_rust()?);
    let found = with_last_picture(&request, |prepared, shot| {
        with_texts(|sources| pixel_run(prepared, shot, sources, pixel))
    });
    answer(&match found {
        Some(run) => run.unwrap_or_else(PixelRun::of_problems),
        None => PixelRun { lacking: true, ..PixelRun::default() },
    })
}

/// The row of a drawing that a row of its picture shows.
fn turned_row(row: u32, shot: &Shot, is_upside_down: bool) -> u32 {
    if is_upside_down { shot.size[1].saturating_sub(1 + row) } else { row }
}

/// What a request for a sketch is answered with if it has mistakes.
type Failed = (SourceSet, Diagnostics);

/// Calls a function with a prepared sketch: the one of the last call, if it is asked for again.
fn with_sketch<T>(
    request: SketchRequest,
    then: impl FnOnce(&PreparedSketch, &SourceSet) -> T,
) -> Result<T, Failed> {
    KEPT.with_borrow_mut(|kept| {
        if kept.as_ref().is_none_or(|kept| kept.request != request) {
            *kept = None;
            let mut sources = SourceSet::default();
            match prepared_sketch(&request, &mut sources) {
                Ok(prepared) => {
                    *kept = Some(Kept { request, sources, prepared: Box::new(prepared) });
                }
                Err(problems) => return Err((sources, problems)),
            }
        }
        let Kept { request: _, sources, prepared } =
            kept.as_ref().ok_or_else(|| (SourceSet::default(), Vec::new()))?;
        Ok(then(prepared, sources))
    })
}

fn pixel_run(
    prepared: &PreparedPass,
    shot: &Shot,
    sources: &SourceSet,
    pixel: PixelChoice,
) -> PixelRun {
    let found = prepared.fragments_at([pixel.x, pixel.y], shot);
    let (mut fragments, failed) = match found {
        Ok(fragments) => (fragments, Vec::new()),
        Err(problems) => (Vec::new(), problems),
    };
    if !failed.is_empty() {
        return PixelRun::failed(sources, &failed);
    }
    let covering = fragments.len() as u32;
    if fragments.is_empty() {
        return PixelRun::default();
    }
    let PictureFragment { fragment, stage } = fragments.swap_remove(0);
    let own = fragment.lane as u32;
    let lane = pixel.lane.map_or(own, |lane| lane & 3);
    let text =
        SubjectText { module: &stage.written.module, text: &stage.text, map: &stage.map, sources };
    let call = Call::Quad(fragment.arguments, lane as usize);
    let subject = Subject::new(text, stage.entry, call, fragment.resources)
        .map(|subject| subject.with_loop_limit(TRIPS));
    match subject {
        Ok(subject) => PixelRun { covering, lane, own, ..recorded(&subject, text, LOST_SHARE) },
        Err(problem) => PixelRun::failed(sources, &vec![problem]),
    }
}

impl PixelRun {
    fn failed(sources: &SourceSet, problems: &Diagnostics) -> Self {
        Self::of_problems(diagnostics(sources, problems))
    }
}

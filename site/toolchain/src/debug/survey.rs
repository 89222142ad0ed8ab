//! Where marks are in a picture. It is found in steps, between which the page asks for other things.

use std::cell::RefCell;

use lamplight::diagnostic::Diagnostics;
use lamplight::source::SourceSet;
use lamplight_debug::{Call, Mark, Subject, SubjectText, Survey, diagnosed};
use lamplight_eval::Resources;
use lamplight_execute::raster::VisibleQuad;
use lamplight_picture::{PreparedPass, Shot};
use serde::Serialize;
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::wasm_bindgen;

use super::{LOST_SHARE, with_sketch};
use crate::diagnostic::{Diagnostic, diagnostics};
use crate::picture::exchange::PictureRequest;
use crate::picture::sketch::SketchRequest;
use crate::picture::{with_last_picture, with_texts};
use crate::{Answer, answer};

/// How many turns all loops of a fragment may make.
const TRIPS: u64 = 1 << 12;

/// The bit of a fragment that did not run to its end.
const UNFINISHED: u32 = 1 << Mark::KINDS.len();

/// The edges of the squares of quads that are looked at from coarse to fine.
const SQUARE: u32 = 8;

/// What is begun.
#[derive(Default, Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct MarksBegun {
    pub width: u32,
    pub height: u32,
    /// How many quads there are to look at.
    pub quads: u32,
    /// Whether the picture is to be drawn first.
    pub lacking: bool,
    pub diagnostics: Vec<Diagnostic>,
}

/// What some quads have.
#[derive(Default, Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct MarksStep {
    /// How many quads are left.
    pub left: u32,
    /// Pixels, each as its number row by row.
    pub pixels: Vec<u32>,
    /// The marks of each: bits by the number of their kind in `markKinds`.
    pub marks: Vec<u32>,
}

/// A kind of marks.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct MarkKind {
    /// Such as `lost-digits`.
    pub name: String,
    pub title: String,
}

#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct MarkKinds {
    pub kinds: Vec<MarkKind>,
}

/// A picture whose fragments are looked at.
struct Looked {
    width: u32,
    slices: Vec<Slice>,
    /// The quads that are left, by their slice and number: the next one last.
    left: Vec<(usize, usize)>,
    /// The pixels that have an answer.
    is_known: Vec<bool>,
    /// Whether the rows of the picture come in the other order.
    is_upside_down: bool,
}

/// The fragments of one stage.
struct Slice {
    subject: Subject,
    /// One for each item.
    surveys: Vec<Survey>,
    quads: Vec<VisibleQuad>,
}

thread_local! {
    static LOOKED: RefCell<Option<Looked>> = const { RefCell::new(None) };
}

/// The kinds of marks, in the order of their bits.
#[wasm_bindgen(js_name = markKinds)]
pub fn mark_kinds() -> Answer<MarkKinds> {
    let named = |(name, title): &(&str, &str)| MarkKind {
        name: (*name).to_owned(),
        title: (*title).to_owned(),
    };
    let unfinished =
        MarkKind { name: "unfinished".to_owned(), title: "Run that does not end".to_owned() };
    answer(&MarkKinds { kinds: Mark::KINDS.iter().map(named).chain([unfinished]).collect() })
}

/// Begins to look for the marks of a sketch, and forgets the picture before it.
#[wasm_bindgen(js_name = sketchMarks)]
pub fn sketch_marks(request: Ts<SketchRequest>) -> Answer<MarksBegun> {
    let request = request.to_rust()?;
    let found = with_sketch(request, |sketch, sources| {
        begun(&sketch.prepared, &sketch.shot, sketch.is_upside_down, sources)
    });
    answer(&found.unwrap_or_else(|(sources, problems)| MarksBegun {
        diagnostics: diagnostics(&sources, &problems),
        ..MarksBegun::default()
    }))
}

/// The same for the picture of a program, which is to be the last one that was drawn.
#[wasm_bindgen(js_name = pictureMarks)]
pub fn picture_marks(request: Ts<PictureRequest>) -> Answer<MarksBegun> {
    let request = request.to_rust()?;
    let found = with_last_picture(&request, |prepared, shot| {
        with_texts(|sources| begun(prepared, shot, false, sources))
    });
    answer(&match found {
        Some(Ok(begun)) => begun,
        Some(Err(diagnostics)) => MarksBegun { diagnostics, ..MarksBegun::default() },
        None => MarksBegun { lacking: true, ..MarksBegun::default() },
    })
}

/// Looks at some more quads.
#[wasm_bindgen(js_name = marksStep)]
pub fn marks_step(quads: u32) -> Answer<MarksStep> {
    answer(&LOOKED.with_borrow_mut(|looked| {
        looked.as_mut().map_or_else(MarksStep::default, |looked| looked.step(quads as usize))
    }))
}

fn begun(
    prepared: &PreparedPass,
    shot: &Shot,
    is_upside_down: bool,
    sources: &SourceSet,
) -> MarksBegun {
    match looked(prepared, shot, sources) {
        Ok(looked) => {
            let looked = Looked { is_upside_down, ..looked };
            let [width, height] = shot.size;
            let quads = looked.left.len() as u32;
            LOOKED.set(Some(looked));
            MarksBegun { width, height, quads, ..MarksBegun::default() }
        }
        Err(problems) => {
            LOOKED.set(None);
            MarksBegun { diagnostics: diagnostics(sources, &problems), ..MarksBegun::default() }
        }
    }
}

fn looked(
    prepared: &PreparedPass,
    shot: &Shot,
    sources: &SourceSet,
) -> Result<Looked, Diagnostics> {
    let mut slices = Vec::new();
    for (stage, fragments) in prepared.visible_fragments(shot)? {
        let (module, map) = (&stage.written.module, &stage.map);
        let text = SubjectText { module, text: &stage.text, map, sources };
        let call = Call::Quad(Default::default(), 0);
        let subject = Subject::new(text, stage.entry, call, Resources::default())
            .map_err(|problem| vec![problem])?
            .with_loop_limit(TRIPS);
        let surveys = fragments
            .resources
            .into_iter()
            .map(|resources| Survey::new(&subject, resources, LOST_SHARE))
            .collect::<Result<Vec<_>, _>>()
            .map_err(|error| vec![diagnosed(&error, map)])?;
        slices.push(Slice { subject, surveys, quads: fragments.quads });
    }
    let mut left: Vec<(usize, usize)> = Vec::new();
    for (index, slice) in slices.iter().enumerate() {
        let mut own: Vec<usize> = (0..slice.quads.len()).collect();
        own.sort_by_key(|quad| turn_of(slice.quads[*quad].pixels[0]));
        left.extend(own.into_iter().map(|quad| (index, quad)));
    }
    left.reverse();
    let [width, height] = shot.size;
    let is_known = vec![false; width as usize * height as usize];
    Ok(Looked { width, slices, left, is_known, is_upside_down: false })
}

/// When a quad is looked at: first few that are far from each other, then those between.
fn turn_of((x, y): (u32, u32)) -> (u32, u32, u32) {
    let (column, row) = (x / 2 % SQUARE, y / 2 % SQUARE);
    let rank = (0..3).fold(0, |rank, bit| {
        let (a, b) = ((column ^ row) >> bit & 1, row >> bit & 1);
        rank << 2 | a << 1 | b
    });
    (rank, y, x)
}

impl Looked {
    /// The pixel of the picture that shows one of the drawing.
    fn shown_pixel(&self, pixel: u32) -> u32 {
        let (width, count) = (self.width.max(1), self.is_known.len() as u32);
        let (row, column) = (pixel / width, pixel % width);
        if self.is_upside_down { (count / width - 1 - row) * width + column } else { pixel }
    }

    fn step(&mut self, quads: usize) -> MarksStep {
        let mut step = MarksStep::default();
        for _ in 0..quads {
            let Some((slice, quad)) = self.left.pop() else { break };
            let Some(slice) = self.slices.get(slice) else { continue };
            let Some(quad) = slice.quads.get(quad) else { continue };
            for lane in (0..4).filter(|lane| quad.covered[*lane]) {
                let (x, y) = quad.pixels[lane];
                let pixel = y * self.width + x;
                // Where parts of the depth overlap, the nearest one is seen.
                match self.is_known.get_mut(pixel as usize) {
                    Some(is_known) if !*is_known => *is_known = true,
                    _ => continue,
                }
                step.pixels.push(self.shown_pixel(pixel));
                step.marks.push(slice.marks(quad, lane));
            }
        }
        step.left = self.left.len() as u32;
        step
    }
}

impl Slice {
    fn marks(&self, quad: &VisibleQuad, lane: usize) -> u32 {
        let Some(survey) = self.surveys.get(quad.item) else { return 0 };
        match survey.fragment(&self.subject, &quad.arguments, lane) {
            Ok(found) => {
                let bit = |(index, (name, _)): (usize, &(&str, &str))| {
                    u32::from(found.contains(name)) << index
                };
                Mark::KINDS.iter().enumerate().map(bit).sum()
            }
            Err(_) => UNFINISHED,
        }
    }
}

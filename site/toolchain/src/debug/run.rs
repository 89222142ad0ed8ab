//! A run in the form in which the page shows it.

use std::collections::{BTreeMap, VecDeque};

use lamplight::source::Span;
use lamplight_debug::{
    Change, Event, Mark, Options, Step, Subject, SubjectText, diagnosed, outcome_text, record,
    statement_text, texture_lines,
};
use serde::Serialize;
use tsify::Tsify;

use crate::diagnostic::{Diagnostic, diagnostics};

/// How many turns of each loop are tried, until a run has few enough events.
const TURNS: [u64; 4] = [16, 4, 2, 1];
/// How many events a page gets: of a longer run the first and the last ones.
const MOST: usize = 3000;
/// How many of these are the last ones.
const LAST: usize = 500;
/// How many rows a value that is made of parts has.
const PARTS: usize = 12;

/// The run of a fragment.
#[derive(Default, Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct PixelRun {
    /// How many fragments cover the pixel. The nearest one runs.
    pub covering: u32,
    /// The fragment of the quad that ran.
    pub lane: u32,
    /// The fragment of the quad that the pixel shows.
    pub own: u32,
    /// What the events name.
    pub places: Vec<RunPlace>,
    pub events: Vec<RunEvent>,
    /// How many turns of each loop have events.
    pub turns: u32,
    /// How many events are left out before the last ones.
    pub left_out: u32,
    pub discarded: bool,
    /// Whether the picture is to be drawn first.
    pub lacking: bool,
    /// Why it did not run, or not to its end.
    pub diagnostics: Vec<Diagnostic>,
}

/// A statement, or the head of a function.
#[derive(Clone, PartialEq, Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct RunPlace {
    pub file: String,
    /// From 1.
    pub line: u32,
    /// The line on which it ends.
    pub end: u32,
    /// On one line, cut where it is long.
    pub text: String,
}

/// What happened. A statement comes after the calls that it makes.
#[derive(Clone, Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct RunEvent {
    /// `call`, `step`, or `end` of a loop.
    pub kind: String,
    /// Its number among the places, unless nobody wrote it.
    pub place: Option<u32>,
    /// How many calls deep.
    pub depth: u32,
    /// The turns of all loops around it, the outermost first.
    pub turns: Vec<u32>,
    /// What it gave names or stored; the parameters of a call.
    pub values: Vec<RunValue>,
    /// What it decided: `true`, `case 2`, `returns`. For a loop, its turns.
    pub decided: Vec<String>,
    /// What it read of textures.
    pub textures: Vec<String>,
    pub marks: Vec<RunMark>,
}

/// A scalar or a vector, in f32, in f64 and with the bound of the error that WGSL allows.
#[derive(Clone, Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct RunValue {
    pub name: String,
    #[serde(rename = "type")]
    pub ty: String,
    pub text: String,
    /// Empty where the value is exact.
    pub exact: String,
    /// Empty where the value is exact.
    pub bound: String,
}

/// Something to look at.
#[derive(Clone, Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct RunMark {
    /// Such as `nan`.
    pub mark: String,
    pub text: String,
}

impl PixelRun {
    /// The answer for what did not run.
    pub fn of_problems(diagnostics: Vec<Diagnostic>) -> Self {
        Self { diagnostics, ..Self::default() }
    }
}

/// Runs a subject, with as many turns of loops as leave room for the rest.
pub fn recorded(subject: &Subject, text: SubjectText<'_>, share: f64) -> PixelRun {
    let mut run = PixelRun::default();
    for turns in TURNS {
        run = recorded_turns(subject, text, Options { share, turns });
        if run.left_out == 0 {
            break;
        }
    }
    run
}

fn recorded_turns(subject: &Subject, text: SubjectText<'_>, options: Options) -> PixelRun {
    let mut writer = Writer { subject, text, places: Vec::new(), known: BTreeMap::new() };
    let (mut first, mut last) = (Vec::new(), VecDeque::new());
    let mut left_out = 0;
    let ended = record(subject, options, &mut |event| {
        if !event.is_shown(options) {
            return;
        }
        if first.len() < MOST - LAST {
            first.push(writer.event(&event));
            return;
        }
        if last.len() == LAST {
            last.pop_front();
            left_out += 1;
        }
        last.push_back(event);
    });
    let rest: Vec<RunEvent> = last.iter().map(|event| writer.event(event)).collect();
    first.extend(rest);
    let mut run = PixelRun {
        places: writer.places,
        events: first,
        turns: options.turns as u32,
        left_out,
        ..PixelRun::default()
    };
    match ended {
        Ok(ended) => run.discarded = ended.is_discarded,
        Err(error) => {
            run.diagnostics = diagnostics(text.sources, &vec![diagnosed(&error, text.map)])
        }
    }
    run
}

/// Writes events, and collects the places that they name.
struct Writer<'a> {
    subject: &'a Subject,
    text: SubjectText<'a>,
    places: Vec<RunPlace>,
    known: BTreeMap<(u32, u32, u32), u32>,
}

impl Writer<'_> {
    fn event(&mut self, event: &Event) -> RunEvent {
        let numbers = |turns: &[u64]| turns.iter().map(|turn| *turn as u32).collect();
        match event {
            Event::Call { function, depth, turns, arguments, marks } => {
                let name = self.subject.name_of(*function);
                RunEvent {
                    kind: "call".to_owned(),
                    place: name.span.map(|span| self.head(span, &name.name)),
                    depth: *depth as u32,
                    turns: numbers(turns),
                    values: values(arguments),
                    decided: Vec::new(),
                    textures: Vec::new(),
                    marks: run_marks(marks),
                }
            }
            Event::Step(step) => self.step(step),
            Event::Left { statement, depth, turns, made } => RunEvent {
                kind: "end".to_owned(),
                place: statement.and_then(|id| self.statement(id)),
                depth: *depth as u32,
                turns: numbers(turns),
                values: Vec::new(),
                decided: vec![format!("ends in turn {made}")],
                textures: Vec::new(),
                marks: Vec::new(),
            },
        }
    }

    fn step(&mut self, step: &Step) -> RunEvent {
        let Step { statement, depth, function: _, turns, changes, outcomes, textures, marks } =
            step;
        RunEvent {
            kind: "step".to_owned(),
            place: statement.and_then(|id| self.statement(id)),
            depth: *depth as u32,
            turns: turns.iter().map(|turn| *turn as u32).collect(),
            values: values(changes),
            decided: outcomes.iter().map(|one| outcome_text(*one)).collect(),
            textures: textures.iter().flat_map(texture_lines).collect(),
            marks: run_marks(marks),
        }
    }

    fn statement(&mut self, id: u32) -> Option<u32> {
        let span = self.subject.statements.get(id)?.span;
        let shown = statement_text(self.text.sources.text(span));
        Some(self.place(span, shown))
    }

    /// The head of a function: that of an entry point is above its first statement.
    fn head(&mut self, span: Span, name: &str) -> u32 {
        let text = &self.text.sources.get(span.source).text;
        let start = span.start as usize;
        let (before, rest) = text.split_at_checked(start).unwrap_or((text, ""));
        let head = rest.split(['{', ';']).next().unwrap_or_default();
        let above = || {
            let heads = [format!("fn {name}("), format!("void {name}(")];
            heads.iter().filter_map(|head| before.rfind(head.as_str())).max()
        };
        let at = match head.find(&format!("{name}(")) {
            Some(at) => start + at,
            None => above().unwrap_or(start),
        };
        self.place(Span::new(span.source, at..at), name.to_owned())
    }

    fn place(&mut self, span: Span, shown: String) -> u32 {
        let key = (span.source.0, span.start, span.end);
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        let sources = self.text.sources;
        let line = |byte: u32| sources.position(span.source, byte as usize).0 as u32;
        let number = self.places.len() as u32;
        self.places.push(RunPlace {
            file: sources.get(span.source).path.clone(),
            line: line(span.start),
            end: line(span.end),
            text: shown,
        });
        self.known.insert(key, number);
        number
    }
}

fn values(changes: &[Change]) -> Vec<RunValue> {
    let mut found = Vec::new();
    for change in changes {
        let leaves = change.value.leaves(&change.name);
        let more = leaves.len().saturating_sub(PARTS);
        for (name, value) in leaves.iter().take(PARTS) {
            let bound = value.bound_text();
            let exact = if bound.is_empty() { String::new() } else { value.exact_text() };
            let (name, ty, text) = (name.clone(), value.type_text(), value.text());
            found.push(RunValue { name, ty, text, exact, bound });
        }
        if more > 0 {
            let (name, ty) = (change.name.clone(), change.value.type_text());
            let text = format!("... {more} more");
            found.push(RunValue { name, ty, text, exact: String::new(), bound: String::new() });
        }
    }
    found
}

fn run_marks(marks: &[Mark]) -> Vec<RunMark> {
    let one = |mark: &Mark| RunMark { mark: mark.name().to_owned(), text: mark.text() };
    marks.iter().map(one).collect()
}

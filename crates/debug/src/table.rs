//! Events as a table for a terminal.

use std::fmt::Write as _;

use lamplight_diagnostic::source::SourceSet;
use lamplight_eval::TextureRead;

use crate::mark::Mark;
use crate::record::{Change, Event, Options, Outcome, Step};
use crate::subject::Subject;
use crate::text::StatementId;
use crate::value::{Value, digits_text};

/// The widest text of a statement.
const STATEMENT: usize = 84;
/// The most rows of one value that is made of parts.
const PARTS: usize = 16;
/// The most texels of a read that are shown.
const TEXELS: usize = 4;

/// Writes events as rows. Turns after the first ones are left out.
pub struct Table<'a> {
    subject: &'a Subject,
    sources: &'a SourceSet,
    options: Options,
    path: String,
    /// Rows with marks, again: the table is long.
    marked: Vec<String>,
    is_leaving_out: bool,
}

impl<'a> Table<'a> {
    /// An empty table.
    pub fn new(subject: &'a Subject, sources: &'a SourceSet, options: Options) -> Self {
        let (path, marked) = (String::new(), Vec::new());
        Self { subject, sources, options, path, marked, is_leaving_out: false }
    }

    /// The rows of an event.
    pub fn rows(&mut self, event: &Event) -> String {
        let mut text = String::new();
        match event {
            Event::Call { function, depth, turns, arguments, marks } => {
                if self.is_shown(turns, marks, &mut text) {
                    let name = self.subject.name_of(*function);
                    let indent = "  ".repeat(*depth);
                    let _ = writeln!(text, "       {indent}> {}", name.name);
                    self.changes(&mut text, *depth, arguments);
                    let at = name.span.map(|span| {
                        let source = self.sources.get(span.source);
                        let line = self.sources.position(span.source, span.start as usize).0;
                        format!("{}:{line}", source.path)
                    });
                    self.marks(&mut text, &at.unwrap_or_default(), &name.name, marks);
                }
            }
            Event::Step(step) => {
                if self.is_shown(&step.turns, &step.marks, &mut text) {
                    self.step(&mut text, step);
                }
            }
            Event::Left { statement, depth, turns, made } => {
                if turns.iter().all(|turn| *turn <= self.options.turns) {
                    self.is_leaving_out = false;
                    let indent = "  ".repeat(*depth);
                    let of = statement.map_or(String::new(), |id| {
                        let line = self.subject.statements.get(id).map_or(0, |one| one.line);
                        format!(" of line {line}")
                    });
                    let shown = self.options.turns;
                    let hidden = match *made > shown {
                        true => format!("; turns after {shown} are left out (`--turns N`)"),
                        false => String::new(),
                    };
                    let _ =
                        writeln!(text, "       {indent}~ the loop{of} ends in turn {made}{hidden}");
                }
            }
        }
        text
    }

    /// All marks again, each with its place.
    pub fn summary(&self) -> String {
        if self.marked.is_empty() {
            return String::new();
        }
        let mut text = String::from("\nMarked:\n");
        self.marked.iter().for_each(|row| text += row);
        text
    }

    fn is_shown(&mut self, turns: &[u64], marks: &[Mark], text: &mut String) -> bool {
        let is_in_first = turns.iter().all(|turn| *turn <= self.options.turns);
        if is_in_first {
            self.is_leaving_out = false;
        } else if !std::mem::replace(&mut self.is_leaving_out, true) {
            text.push_str("       ...\n");
        }
        is_in_first || !marks.is_empty()
    }

    fn step(&mut self, text: &mut String, step: &Step) {
        let Step { statement, depth, function: _, turns, changes, outcomes, textures, marks } =
            step;
        let (at, line, shown) = self.statement(*statement, text);
        let indent = "  ".repeat(*depth);
        let turns =
            if turns.is_empty() { String::new() } else { format!("  [{}]", turn_text(turns)) };
        let decided = outcomes.iter().map(|one| outcome_text(*one)).collect::<Vec<_>>();
        let decided = match decided.is_empty() {
            true => String::new(),
            false => format!("  -> {}", decided.join(", ")),
        };
        let _ = writeln!(text, "{line:>5}  {indent}{shown}{decided}{turns}");
        textures.iter().for_each(|read| texture_rows(text, *depth, read));
        self.changes(text, *depth, changes);
        self.marks(text, &at, &shown, marks);
    }

    /// The place, the line and the text of a statement. Where the file changes, its path is a row.
    fn statement(
        &mut self,
        id: Option<StatementId>,
        text: &mut String,
    ) -> (String, String, String) {
        let Some(statement) = id.and_then(|id| self.subject.statements.get(id)) else {
            return (String::new(), String::new(), "(no line of yours)".to_owned());
        };
        let path = &self.sources.get(statement.span.source).path;
        if *path != self.path {
            self.path.clone_from(path);
            let _ = writeln!(text, "{path}");
        }
        let shown = statement_text(self.sources.text(statement.span));
        (format!("{path}:{}", statement.line), statement.line.to_string(), shown)
    }

    fn changes(&self, text: &mut String, depth: usize, changes: &[Change]) {
        for change in changes {
            let leaves = change.value.leaves(&change.name);
            let count = leaves.len();
            for (name, value) in leaves.iter().take(PARTS) {
                value_row(text, depth, name, value);
            }
            if count > PARTS {
                let _ = writeln!(text, "       {}  ... {} more", "  ".repeat(depth), count - PARTS);
            }
        }
    }

    fn marks(&mut self, text: &mut String, at: &str, shown: &str, marks: &[Mark]) {
        for mark in marks {
            let _ = writeln!(text, "     ! {}", mark.text());
            self.marked.push(format!("  {at}: `{shown}`\n      {}\n", mark.text()));
        }
    }
}

/// A statement on one line.
pub fn statement_text(text: &str) -> String {
    let lines = text.lines().map(|line| line.split("//").next().unwrap_or_default().trim());
    let one = lines.filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ");
    match one.char_indices().nth(STATEMENT) {
        Some((at, _)) => format!("{}...", &one[..at]),
        None => one,
    }
}

/// The turns of loops, the outermost first.
pub fn turn_text(turns: &[u64]) -> String {
    let turns = turns.iter().map(u64::to_string).collect::<Vec<_>>();
    format!("turn {}", turns.join("."))
}

/// What a statement decided.
pub fn outcome_text(outcome: Outcome) -> String {
    match outcome {
        Outcome::Condition(holds) => holds.to_string(),
        Outcome::Case(word) => format!("case {}", word as i32),
        Outcome::Return => "returns".to_owned(),
        Outcome::Discard => "discards".to_owned(),
    }
}

fn value_row(text: &mut String, depth: usize, name: &str, value: &Value) {
    let indent = "  ".repeat(depth);
    let (single, exact, bound) = (value.text(), value.exact_text(), value.bound_text());
    let row = match bound.is_empty() {
        true => format!("       {indent}  {name:<10} {single}"),
        false => format!("       {indent}  {name:<10} {single:<32} f64 {exact:<34} +- {bound}"),
    };
    let _ = writeln!(text, "{row}");
}

fn texture_rows(text: &mut String, depth: usize, read: &TextureRead) {
    let indent = "  ".repeat(depth);
    for line in texture_lines(read) {
        let _ = writeln!(text, "       {indent}  {line}");
    }
}

/// What was read of a texture: where, and below it the texels.
pub fn texture_lines(read: &TextureRead) -> Vec<String> {
    let list = |numbers: &[f64]| {
        let all = numbers.iter().map(|number| digits_text(*number, 6));
        all.collect::<Vec<_>>().join(" ")
    };
    let TextureRead { name, coordinate, level, reference, texels } = read;
    let level = level.map_or(String::new(), |level| format!(", level {}", digits_text(level, 4)));
    let reference =
        reference.map_or(String::new(), |one| format!(", compared with {}", digits_text(one, 6)));
    let mut lines = vec![format!("{name} at {}{level}{reference}", list(coordinate))];
    for one in texels.iter().take(TEXELS) {
        let [x, y, z] = one.at;
        let (level, texel) = (one.level, list(&one.texel));
        lines.push(format!("  texel {x} {y} {z} of level {level}: {texel}"));
    }
    if texels.len() > TEXELS {
        lines.push(format!("  ... {} more texels", texels.len() - TEXELS));
    }
    lines
}

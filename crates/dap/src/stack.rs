//! The stack: calls, and for frames of other texts how these came to be read.

use lamplight_debug::Frame;
use lamplight_diagnostic::source::{SourceId, Span};
use serde_json::{Value, json};

use crate::answer::{Failed, Host, Turn};
use crate::session::{Running, Session};

/// The number of the first row that is an import and no call. No stack is as deep.
const LABELS: usize = 1_000_000;

impl Session {
    pub fn stack_trace(&self, turn: &Turn<'_>) -> Result<Value, Failed> {
        let run = self.running()?;
        let rows = run.stack(self, turn.host);
        let start = turn.number("startFrame")?.unwrap_or(0) as usize;
        let levels = turn.number("levels")?.filter(|levels| *levels > 0);
        let levels = levels.map_or(rows.len(), |levels| levels as usize);
        let total = rows.len();
        let shown: Vec<Value> = rows.into_iter().skip(start).take(levels).collect();
        Ok(json!({ "stackFrames": shown, "totalFrames": total }))
    }
}

impl Running {
    /// Where a frame is: its statement, the loop that begins a turn, or the head of its function.
    fn span_of(&self, frame: &Frame) -> Option<Span> {
        let subject = self.replay.subject();
        let statement = frame.statement.or(frame.loops.last().and_then(|one| one.statement));
        let statement = statement.and_then(|id| subject.statements.get(id));
        statement.map(|one| one.span).or_else(|| subject.name_of(frame.function).span)
    }

    fn stack(&self, session: &Session, host: &dyn Host) -> Vec<Value> {
        let mut rows = Vec::new();
        let frames = self.replay.seen().place.frames();
        for (depth, frame) in frames.iter().enumerate().rev() {
            let span = self.span_of(frame);
            let mut row = json!({
                "id": depth + 1,
                "name": self.frame_name(frame),
                "line": 0, "column": 0,
            });
            if let Some(span) = span {
                self.place(&mut row, span, session, host);
            }
            rows.push(row);
            let caller = depth.checked_sub(1).and_then(|depth| self.span_of(frames.get(depth)?));
            if let Some((span, caller)) = span.zip(caller) {
                self.import_rows(&mut rows, (caller.source, span.source), session, host);
            }
        }
        rows
    }

    /// The name of a function, with the turns of the loops that it is in.
    fn frame_name(&self, frame: &Frame) -> String {
        let name = self.replay.subject().name_of(frame.function).name;
        let turns: Vec<u64> = frame.loops.iter().map(|one| one.turn).collect();
        match turns.is_empty() {
            true => name,
            false => format!("{name} [{}]", lamplight_debug::turn_text(&turns)),
        }
    }

    fn place(&self, row: &mut Value, span: Span, session: &Session, host: &dyn Host) {
        let position = |byte: u32| {
            let (line, column) = self.sources.position(span.source, byte as usize);
            let counting = session.counting;
            (counting.line(line as u32), counting.column(column as u32))
        };
        let ((line, column), (end, last)) = (position(span.start), position(span.end));
        row["line"] = json!(line);
        row["column"] = json!(column);
        row["endLine"] = json!(end);
        row["endColumn"] = json!(last);
        row["source"] = self.source_json(span.source, host);
    }

    /// The imports that lead from the text of a caller to that of what it calls, the nearest to the
    /// latter first. Where the caller is not among those that led there first, all are shown.
    fn import_rows(
        &self,
        rows: &mut Vec<Value>,
        (caller, called): (SourceId, SourceId),
        session: &Session,
        host: &dyn Host,
    ) {
        let mut last = called;
        while last != caller
            && let Some(import) = self.imports.get(&last)
        {
            let name = format!("{}, read by", self.sources.get(last).path);
            let id = LABELS + rows.len();
            let mut row = json!({ "id": id, "name": name, "presentationHint": "label" });
            self.place(&mut row, *import, session, host);
            rows.push(row);
            last = import.source;
        }
    }
}

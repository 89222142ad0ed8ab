//! Where the run goes, and the events that the client gets when it stops.

use lamplight_debug::{Found, Halt, Seen};
use serde_json::{Value, json};

use crate::answer::{Failed, Host};
use crate::breakpoints::Breakpoint;
use crate::session::{Running, Session, THREAD};

/// The ways in which a client moves the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Motion {
    /// To the first statement.
    Entry,
    /// To a breakpoint or a mark, or to the end.
    Continue,
    /// To the next statement of this function, or of one that called it.
    Next,
    /// To the next statement.
    In,
    /// To the function that called this one.
    Out,
    /// To the statement before in this function, or in one that called it.
    Back,
    /// Back to a breakpoint or a mark, or to the first statement.
    ContinueBack,
    /// Back to the first statement.
    Restart,
}

type Events = Vec<(&'static str, Value)>;

impl Motion {
    fn is_back(self) -> bool {
        matches!(self, Self::Back | Self::ContinueBack | Self::Restart)
    }

    /// Whether a run that was at a depth has arrived.
    fn has_arrived(self, from: usize, seen: &Seen<'_>) -> bool {
        let depth = seen.place.depth();
        let (is_statement, is_return) = match seen.place.halt() {
            Halt::Statement => (true, false),
            Halt::Returned(_) => (false, depth < from),
            _ => (false, false),
        };
        match self {
            Self::Entry => is_statement,
            Self::Continue | Self::ContinueBack | Self::Restart => false,
            Self::Next => is_return || (is_statement && depth <= from),
            Self::In => is_return || is_statement,
            Self::Out => is_return || (is_statement && depth < from),
            Self::Back => is_statement && depth <= from,
        }
    }
}

impl Session {
    /// Moves the run, and sends where it stopped.
    pub fn go(&mut self, motion: Motion, host: &mut dyn Host) -> Events {
        let Self { run, breakpoints, marks, .. } = self;
        let Some(run) = run.as_mut() else { return Vec::new() };
        run.handles.clear();
        let is_over = matches!(run.replay.seen().place.halt(), Halt::End | Halt::Failed(_));
        if is_over && !motion.is_back() {
            return vec![("exited", json!({ "exitCode": 0 })), ("terminated", Value::Null)];
        }
        let (from, is_stopped) = (run.replay.seen().place.depth(), motion != Motion::Restart);
        let Running { replay, expressions, .. } = run;
        // `hit` is of the last halt that is wanted: those after it are asked about too.
        let (mut hit, mut events) = (Vec::new(), Vec::new());
        let mut wanted = |seen: &Seen<'_>| {
            let is_marked = seen.place.new_marks().any(|one| marks.contains(one.mark.name()));
            let mut own = Vec::new();
            if is_stopped {
                for breakpoint in breakpoints.iter() {
                    match breakpoint.meets(seen, expressions) {
                        Ok(None) => {}
                        Ok(Some(None)) => own.push(breakpoint.id),
                        Ok(Some(Some(words))) if !motion.is_back() => {
                            events.push(output_event(&format!("{words}\n")));
                        }
                        Ok(Some(Some(_))) => {}
                        Err(words) => {
                            own.push(breakpoint.id);
                            events.push(output_event(&condition_failed(breakpoint, &words)));
                        }
                    }
                }
            }
            let is_wanted =
                is_stopped && (is_marked || !own.is_empty()) || motion.has_arrived(from, seen);
            if is_wanted {
                hit = own;
            }
            is_wanted
        };
        let is_interrupted = || host.is_interrupted();
        let found = match motion.is_back() {
            true => replay.back(&mut wanted, &is_interrupted),
            false => replay.forward(&mut wanted, &is_interrupted),
        };
        events.push(run.stopped(motion, found, &hit, |name| marks.contains(name)));
        events
    }

    /// What the mark or the error is at which the run stands.
    pub fn exception_info(&self) -> Result<Value, Failed> {
        let run = self.running()?;
        let place = run.replay.seen().place;
        let marks: Vec<_> = place.new_marks().collect();
        let first = marks.first().map(|marked| marked.mark.name());
        let description = match place.halt() {
            Halt::Failed(error) => error.message.clone(),
            _ => marks.iter().map(|one| one.mark.text()).collect::<Vec<_>>().join("\n"),
        };
        match (first, description.is_empty()) {
            (None, true) => Err("nothing is marked here".to_owned()),
            (first, _) => Ok(json!({
                "exceptionId": first.unwrap_or("error"),
                "description": description,
                "breakMode": "always",
            })),
        }
    }
}

fn output_event(text: &str) -> (&'static str, Value) {
    ("output", json!({ "category": "console", "output": text }))
}

fn condition_failed(breakpoint: &Breakpoint, words: &str) -> String {
    format!("the condition in line {} has no value: {words}\n", breakpoint.line)
}

impl Running {
    /// The event that says why the run stands.
    fn stopped(
        &self,
        motion: Motion,
        found: Found,
        hit: &[i64],
        is_asked: impl Fn(&str) -> bool,
    ) -> (&'static str, Value) {
        let place = self.replay.seen().place;
        let marks: Vec<_> = place.new_marks().collect();
        let is_marked = marks.iter().any(|one| is_asked(one.mark.name()));
        let (reason, description) = match (place.halt(), found) {
            (_, Found::Interrupted) => ("pause", "Paused".to_owned()),
            (Halt::Failed(_), _) => ("exception", "The run ended with an error".to_owned()),
            _ if found == Found::Yes && is_marked && motion != Motion::Restart => {
                ("exception", "Something is marked".to_owned())
            }
            _ if !hit.is_empty() && found == Found::Yes => {
                ("breakpoint", "Paused at a breakpoint".to_owned())
            }
            (Halt::End, _) => ("end", self.end_text()),
            (_, Found::No) => ("entry", "At the beginning".to_owned()),
            _ if motion == Motion::Entry => ("entry", "At the beginning".to_owned()),
            _ => ("step", "Paused after a step".to_owned()),
        };
        let mut body = json!({
            "reason": reason, "description": description, "threadId": THREAD,
            "allThreadsStopped": true,
        });
        let text = match place.halt() {
            Halt::Failed(error) => error.message.clone(),
            _ => marks.iter().map(|one| one.mark.text()).collect::<Vec<_>>().join("\n"),
        };
        if !text.is_empty() {
            body["text"] = json!(text);
        }
        if !hit.is_empty() {
            body["hitBreakpointIds"] = json!(hit);
        }
        ("stopped", body)
    }

    /// What the run ended with.
    fn end_text(&self) -> String {
        if self.replay.is_discarded() {
            return "The fragment is discarded".to_owned();
        }
        let seen = self.replay.seen();
        let result = seen.subject.result();
        let text = result.map(|one| {
            let value = lamplight_debug::Value::read(&one.shape, one.place, seen.memory);
            if value.is_flat() { format!(": it returns {}", value.text()) } else { String::new() }
        });
        format!("The run has ended{}", text.unwrap_or_default())
    }
}

//! Where the run goes, and the events that the client gets when it stops.

use std::collections::BTreeSet;

use lamplight_debug::{Found, Halt, Seen};
use serde_json::{Value, json};

use crate::answer::{Failed, Host, Out};
use crate::breakpoints::{Breakpoint, Effect};
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
}

impl Motion {
    fn is_back(self) -> bool {
        matches!(self, Self::Back | Self::ContinueBack)
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
            Self::Continue | Self::ContinueBack => false,
            Self::Next => is_return || (is_statement && depth <= from),
            Self::In => is_return || is_statement,
            Self::Out => is_return || (is_statement && depth < from),
            Self::Back => is_statement && depth <= from,
        }
    }
}

impl Session {
    /// Moves the run, prints what breakpoints say on the way, and says where it stopped.
    pub fn go(&mut self, motion: Motion, host: &dyn Host, out: &mut Out<'_>) {
        let Self { run, breakpoints, marks, .. } = self;
        let Some(run) = run.as_mut() else { return };
        run.handles.clear();
        let is_over = matches!(run.replay.seen().place.halt(), Halt::End | Halt::Failed(_));
        if is_over && !motion.is_back() {
            out.event("exited", json!({ "exitCode": 0 }));
            return out.event("terminated", Value::Null);
        }
        let from = run.replay.seen().place.depth();
        let Running { replay, expressions, complaints, .. } = run;
        // `hit` is of the last halt that is wanted: those after it are asked about too.
        let mut hit = Vec::new();
        let mut wanted = |seen: &Seen<'_>| {
            let is_marked = seen.place.new_marks().any(|one| marks.contains(one.mark.name()));
            let mut own = Vec::new();
            for breakpoint in breakpoints.iter() {
                match breakpoint.effect(seen, expressions) {
                    Ok(Effect::None) => {}
                    Ok(Effect::Stop) => own.push(breakpoint.id),
                    Ok(Effect::Print(_)) if motion.is_back() => {}
                    Ok(Effect::Print(words)) => print(out, &words),
                    Err(words) => {
                        own.push(breakpoint.id);
                        complain(out, complaints, breakpoint, words);
                    }
                }
            }
            let is_wanted = is_marked || !own.is_empty() || motion.has_arrived(from, seen);
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
        let stopped = run.stopped(motion, found, &hit, |name| marks.contains(name));
        match found {
            // The request that interrupts is answered first.
            Found::Interrupted => self.hold(stopped),
            Found::Yes | Found::No => out.event("stopped", stopped),
        }
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
            (None, true) => {
                Err("nothing is marked where the run stands: `Marks` of the scopes has all so far"
                    .to_owned())
            }
            (first, _) => Ok(json!({
                "exceptionId": first.unwrap_or("error"),
                "description": description,
                "breakMode": "always",
            })),
        }
    }
}

fn print(out: &mut Out<'_>, words: &str) {
    out.event("output", json!({ "category": "console", "output": format!("{words}\n") }));
}

/// Says once why the condition of a breakpoint has no value. A run that goes back comes to it often.
fn complain(
    out: &mut Out<'_>,
    complaints: &mut BTreeSet<(i64, String)>,
    breakpoint: &Breakpoint,
    words: String,
) {
    let text = format!("the condition in line {} has no value: {words}", breakpoint.line);
    if complaints.insert((breakpoint.id, words)) {
        print(out, &text);
    }
}

impl Running {
    /// What the event says of why the run stands.
    fn stopped(
        &self,
        motion: Motion,
        found: Found,
        hit: &[i64],
        is_asked: impl Fn(&str) -> bool,
    ) -> Value {
        let place = self.replay.seen().place;
        let marks: Vec<_> = place.new_marks().collect();
        let is_marked = marks.iter().any(|one| is_asked(one.mark.name()));
        let (reason, description) = match (place.halt(), found) {
            (_, Found::Interrupted) => ("pause", "Paused".to_owned()),
            (Halt::Failed(_), _) => ("exception", "The run ended with an error".to_owned()),
            _ if found == Found::Yes && is_marked => {
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
        body
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

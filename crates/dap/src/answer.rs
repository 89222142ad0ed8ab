//! The conversation: requests in, answers and events out.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

use lamplight_debug::Subject;
use lamplight_diagnostic::source::{Source, SourceId, SourceSet, Span};
use serde_json::{Value, json};

use crate::requests::{self, Request};
use crate::session::Session;

/// What is debugged.
pub struct Launched {
    /// What runs.
    pub subject: Subject,
    /// The texts that it is made of.
    pub sources: SourceSet,
    /// For each text, the import or include that led to it first.
    pub imports: BTreeMap<SourceId, Span>,
    /// What the run is called, such as `pixel 40,40`.
    pub title: String,
    /// The share of a value that its bound may have before its digits count as lost.
    pub share: f64,
}

/// Why nothing is debugged.
pub struct Refusal {
    /// In a sentence.
    pub message: String,
    /// In full, with excerpts of the texts.
    pub output: String,
}

/// What the adapter needs of the machine that it runs on.
pub trait Host {
    /// Makes what is debugged of the arguments of `launch`, from the files as they are now.
    ///
    /// # Errors
    /// Why that cannot be.
    fn launch(&mut self, arguments: &Value) -> Result<Launched, Refusal>;

    /// The path of a text that is a file on the disk.
    fn path_of(&self, source: &Source) -> Option<String>;

    /// Whether two paths lead to one file.
    fn is_same(&self, one: &str, other: &str) -> bool;

    /// Whether a run should stop, since a message came in that asks for it.
    fn is_interrupted(&self) -> bool;
}

/// The failure of a request: a sentence.
pub type Failed = String;

/// A debug adapter.
#[derive(Default)]
pub struct Adapter {
    sent: i64,
    session: Session,
}

/// What a request does: gives the body of its answer. Events go out after it.
pub(crate) struct Turn<'a> {
    pub arguments: &'a Value,
    pub host: &'a mut dyn Host,
    /// Events that follow the answer.
    pub after: Vec<(&'static str, Value)>,
    /// Events that come before it.
    pub before: Vec<(&'static str, Value)>,
}

impl Turn<'_> {
    /// An event after the answer.
    pub fn event(&mut self, name: &'static str, body: Value) {
        self.after.push((name, body));
    }
}

/// Where messages go out, each with its number.
pub(crate) struct Out<'a> {
    sent: &'a mut i64,
    send: &'a mut dyn FnMut(Value),
}

impl Out<'_> {
    pub fn event(&mut self, name: &str, body: Value) {
        let mut event = json!({ "type": "event", "event": name });
        if !body.is_null() {
            event["body"] = body;
        }
        self.message(event);
    }

    fn events(&mut self, events: Vec<(&'static str, Value)>) {
        for (name, body) in events {
            self.event(name, body);
        }
    }

    fn answer(&mut self, sequence: i64, command: &str, found: Result<Value, Failed>) {
        let mut answer = json!({
            "type": "response", "request_seq": sequence, "success": found.is_ok(),
            "command": command,
        });
        match found {
            Ok(body) if body.is_null() => {}
            Ok(body) => answer["body"] = body,
            Err(words) => {
                let variables = json!({ "words": words });
                let error = json!({ "id": 1, "format": "{words}", "variables": variables });
                answer["body"] = json!({ "error": error });
                answer["message"] = json!(words);
            }
        }
        self.message(answer);
    }

    fn message(&mut self, mut message: Value) {
        *self.sent += 1;
        message["seq"] = json!(*self.sent);
        (self.send)(message);
    }
}

impl Adapter {
    /// Whether the client has left.
    pub fn is_ended(&self) -> bool {
        self.session.is_ended
    }

    /// Answers a message. `send` gets the answer and the events that belong to it, in order.
    ///
    /// A request that panics is answered too: its run is lost, and the conversation goes on.
    pub fn receive(&mut self, message: &Value, host: &mut dyn Host, send: &mut dyn FnMut(Value)) {
        let Self { sent, session } = self;
        let mut out = Out { sent, send };
        if message.get("type").and_then(Value::as_str).is_none_or(|kind| kind == "request") {
            answer_request(session, message, host, &mut out);
        }
        // The answer to what interrupted a run goes out before the event that says so.
        if !host.is_interrupted()
            && let Some(stopped) = session.take_held()
        {
            out.event("stopped", stopped);
        }
    }

    /// Says that something came in that is no message.
    pub fn reject(&mut self, words: &str, send: &mut dyn FnMut(Value)) {
        let output = format!("the debugger got something that is no message: {words}\n");
        let mut out = Out { sent: &mut self.sent, send };
        out.event("output", json!({ "category": "stderr", "output": output }));
    }
}

fn answer_request(session: &mut Session, message: &Value, host: &mut dyn Host, out: &mut Out<'_>) {
    let command = message.get("command").and_then(Value::as_str);
    let sequence = message.get("seq").and_then(Value::as_i64);
    let (sequence, name) = (sequence.unwrap_or(0), command.unwrap_or_default());
    let request = match (command, message.get("seq").and_then(Value::as_i64)) {
        (None, _) => Err("a request has a `command`, and this message has none".to_owned()),
        (Some(_), None) => Err("the `seq` of a request is a whole number".to_owned()),
        (Some(name), Some(_)) => requests::find(name)
            .ok_or_else(|| format!("the debugger of shaders has no request `{name}`")),
    };
    match request {
        Ok(request) => run_request(session, (request, sequence), message, host, out),
        Err(words) => out.answer(sequence, name, Err(words)),
    }
}

fn run_request(
    session: &mut Session,
    (request, sequence): (&Request, i64),
    message: &Value,
    host: &mut dyn Host,
    out: &mut Out<'_>,
) {
    let nothing = Value::Null;
    let arguments = message.get("arguments").unwrap_or(&nothing);
    let mut turn = Turn { arguments, host: &mut *host, after: Vec::new(), before: Vec::new() };
    let found = catch_unwind(AssertUnwindSafe(|| (request.run)(session, &mut turn)));
    let Turn { arguments: _, host: _, after, before } = turn;
    match found {
        Ok(found) => {
            out.events(before);
            out.answer(sequence, request.name, found);
            out.events(after);
        }
        Err(_) => {
            out.answer(sequence, request.name, Err(lost(request.name)));
            return lose(session, out);
        }
    }
    // The answer goes out before the run does, which may take long.
    let Some(motion) = session.take_motion() else { return };
    if catch_unwind(AssertUnwindSafe(|| session.go(motion, host, out))).is_err() {
        let output = json!({ "category": "stderr", "output": format!("{}\n", lost(request.name)) });
        out.event("output", output);
        lose(session, out);
    }
}

fn lost(request: &str) -> Failed {
    format!(
        "the debugger itself failed at `{request}`, which is a fault of Lamplight, and the run is \
         lost: start it again"
    )
}

/// Ends a run in whose middle the debugger failed.
fn lose(session: &mut Session, out: &mut Out<'_>) {
    if session.running().is_ok() {
        session.end();
        out.event("terminated", Value::Null);
    }
}

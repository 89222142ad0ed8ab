//! The conversation: requests in, answers and events out.

use lamplight_debug::Subject;
use lamplight_diagnostic::source::{Source, SourceSet};
use serde_json::{Value, json};

use crate::requests;
use crate::session::Session;

/// What is debugged.
pub struct Launched {
    /// What runs.
    pub subject: Subject,
    /// The texts that it is made of.
    pub sources: SourceSet,
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
    /// Makes what is debugged of the arguments of `launch`.
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
    pub(crate) session: Session,
    /// Whether the client has left.
    pub is_ended: bool,
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

impl Adapter {
    /// Answers a message. `send` gets the answer and the events that belong to it, in order.
    pub fn receive(&mut self, message: &Value, host: &mut dyn Host, send: &mut dyn FnMut(Value)) {
        if message.get("type").and_then(Value::as_str).is_some_and(|kind| kind != "request") {
            return;
        }
        let sequence = message.get("seq").and_then(Value::as_i64).unwrap_or(0);
        let Some(command) = message.get("command").and_then(Value::as_str) else {
            let words = "a request has a `command`, and this message has none";
            return self.fail(sequence, "", words, send);
        };
        let Some(request) = requests::find(command) else {
            let words = format!("the debugger of shaders has no request `{command}`");
            return self.fail(sequence, command, &words, send);
        };
        let nothing = Value::Null;
        let arguments = message.get("arguments").unwrap_or(&nothing);
        let mut turn = Turn { arguments, host, after: Vec::new(), before: Vec::new() };
        let found = (request.run)(self, &mut turn);
        let Turn { after, before, .. } = turn;
        self.events(before, send);
        match found {
            Ok(body) => {
                let mut answer = json!({
                    "type": "response", "request_seq": sequence, "success": true,
                    "command": command,
                });
                if !body.is_null() {
                    answer["body"] = body;
                }
                self.send(answer, send);
            }
            Err(words) => self.fail(sequence, command, &words, send),
        }
        self.events(after, send);
        // The answer goes out before the run does, which may take long.
        let moved = self.session.take_motion().map(|motion| self.session.go(motion, host));
        self.events(moved.unwrap_or_default(), send);
    }

    /// Says that something came in that is no message.
    pub fn reject(&mut self, words: &str, send: &mut dyn FnMut(Value)) {
        let output = format!("the debugger got something that is no message: {words}\n");
        let event = ("output", json!({ "category": "stderr", "output": output }));
        self.events(vec![event], send);
    }

    fn fail(&mut self, sequence: i64, command: &str, words: &str, send: &mut dyn FnMut(Value)) {
        let error = json!({ "id": 1, "format": "{words}", "variables": { "words": words } });
        let answer = json!({
            "type": "response", "request_seq": sequence, "success": false, "command": command,
            "message": words, "body": { "error": error },
        });
        self.send(answer, send);
    }

    fn events(&mut self, events: Vec<(&'static str, Value)>, send: &mut dyn FnMut(Value)) {
        for (name, body) in events {
            let mut event = json!({ "type": "event", "event": name });
            if !body.is_null() {
                event["body"] = body;
            }
            self.send(event, send);
        }
    }

    fn send(&mut self, mut message: Value, send: &mut dyn FnMut(Value)) {
        self.sent += 1;
        message["seq"] = json!(self.sent);
        send(message);
    }
}

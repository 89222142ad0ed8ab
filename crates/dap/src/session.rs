//! What is debugged, and what the client has said of it.

use std::collections::{BTreeMap, BTreeSet};

use lamplight_debug::{Expressions, Replay};
use lamplight_diagnostic::source::{SourceId, SourceSet, Span};
use serde_json::{Value, json};

use crate::answer::{Failed, Launched, Turn};
use crate::breakpoints::{Asked, Breakpoint};
use crate::motion::Motion;
use crate::numbers::Counting;
use crate::variables::Handle;

/// The number of the only thread.
pub(crate) const THREAD: i64 = 1;

/// A run that was launched.
pub(crate) struct Running {
    pub replay: Replay,
    pub sources: SourceSet,
    /// For each text, the import or include that led to it first.
    pub imports: BTreeMap<SourceId, Span>,
    pub title: String,
    /// What `launch` said, for `restart`.
    arguments: Value,
    /// What variables the client may ask for.
    pub handles: Vec<Handle>,
    /// Expressions that were compiled.
    pub expressions: Expressions,
    /// What was said of breakpoints whose conditions have no value, by their numbers: each once.
    pub complaints: BTreeSet<(i64, String)>,
}

/// The state of the conversation.
pub(crate) struct Session {
    /// How the client counts.
    pub counting: Counting,
    pub run: Option<Running>,
    /// What the client asked for, and what became of it.
    pub asked: Vec<Asked>,
    pub breakpoints: Vec<Breakpoint>,
    pub numbered: i64,
    /// The names of marks at which the run stops.
    pub marks: BTreeSet<String>,
    /// Whether the client has left.
    pub is_ended: bool,
    stops_on_entry: bool,
    motion: Option<Motion>,
    /// What the event says of a run that was interrupted, until the answer to what did that.
    held: Option<Value>,
}

impl Default for Session {
    fn default() -> Self {
        Self {
            counting: Counting { line: 1, column: 1 },
            run: None,
            asked: Vec::new(),
            breakpoints: Vec::new(),
            numbered: 0,
            marks: BTreeSet::new(),
            is_ended: false,
            stops_on_entry: false,
            motion: None,
            held: None,
        }
    }
}

impl Session {
    /// Makes a run of what the client wants to debug. If that cannot be, an earlier run stays.
    pub fn launch(&mut self, arguments: &Value, turn: &mut Turn<'_>) -> Result<(), Failed> {
        let launched = match turn.host.launch(arguments) {
            Ok(launched) => launched,
            Err(refusal) => {
                let output = json!({ "category": "stderr", "output": refusal.output });
                turn.before.push(("output", output));
                return Err(refusal.message);
            }
        };
        let Launched { subject, sources, imports, title, share } = launched;
        let replay = Replay::new(subject, share).map_err(|error| error.message)?;
        let stops = arguments.get("stopOnEntry").and_then(Value::as_bool);
        self.stops_on_entry = stops.unwrap_or(false);
        self.run = Some(Running {
            replay,
            sources,
            imports,
            title,
            arguments: arguments.clone(),
            handles: Vec::new(),
            expressions: Expressions::default(),
            complaints: BTreeSet::new(),
        });
        self.verify_earlier(turn);
        Ok(())
    }

    /// Begins with the files as they are now. The client may have changed what it launches.
    pub fn restart(&mut self, turn: &mut Turn<'_>) -> Result<Value, Failed> {
        let known = &self.running()?.arguments;
        let given = turn.arguments.get("arguments").filter(|given| given.is_object());
        let arguments = given.unwrap_or(known).clone();
        self.launch(&arguments, turn)?;
        self.set_off()
    }

    /// The run.
    pub fn running(&self) -> Result<&Running, Failed> {
        self.run.as_ref().ok_or_else(nothing_runs)
    }

    pub fn running_mut(&mut self) -> Result<&mut Running, Failed> {
        self.run.as_mut().ok_or_else(nothing_runs)
    }

    /// Begins as the launch says: with a stop at the first statement, or without.
    pub fn set_off(&mut self) -> Result<Value, Failed> {
        let first = if self.stops_on_entry { Motion::Entry } else { Motion::Continue };
        self.begin(first)?;
        Ok(Value::Null)
    }

    /// Notes where the run goes after the answer.
    pub fn begin(&mut self, motion: Motion) -> Result<Value, Failed> {
        self.running()?;
        self.motion = Some(motion);
        self.held = None;
        Ok(match motion {
            Motion::Continue => json!({ "allThreadsContinued": true }),
            _ => Value::Null,
        })
    }

    pub fn take_motion(&mut self) -> Option<Motion> {
        self.motion.take()
    }

    /// Keeps what the event says of a run that was interrupted.
    pub fn hold(&mut self, stopped: Value) {
        self.held = Some(stopped);
    }

    pub fn take_held(&mut self) -> Option<Value> {
        self.held.take()
    }

    /// Forgets the run.
    pub fn end(&mut self) {
        (self.run, self.motion, self.held) = (None, None, None);
    }

    pub fn threads(&self) -> Result<Value, Failed> {
        let name = self.run.as_ref().map_or("shader", |run| &run.title);
        Ok(json!({ "threads": [{ "id": THREAD, "name": name }] }))
    }
}

fn nothing_runs() -> Failed {
    "no shader runs: `launch` comes first".to_owned()
}

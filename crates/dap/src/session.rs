//! What is debugged, and what the client has said of it.

use std::collections::BTreeSet;

use lamplight_debug::{Expressions, Replay};
use lamplight_diagnostic::source::{SourceId, SourceSet};
use serde_json::{Value, json};

use crate::answer::{Failed, Launched, Turn};
use crate::breakpoints::{Asked, Breakpoint};
use crate::imports::Imports;
use crate::motion::Motion;
use crate::variables::Handle;

/// The number of the only thread.
pub(crate) const THREAD: i64 = 1;

/// A run that was launched.
pub(crate) struct Running {
    pub replay: Replay,
    pub sources: SourceSet,
    pub imports: Imports,
    pub title: String,
    /// What variables the client may ask for.
    pub handles: Vec<Handle>,
    /// Expressions that were compiled.
    pub expressions: Expressions,
}

/// The state of the conversation.
pub(crate) struct Session {
    /// The number of the first line and of the first column, for the client.
    pub first_line: u32,
    pub first_column: u32,
    pub stops_on_entry: bool,
    pub run: Option<Running>,
    /// What the client asked for, and what became of it.
    pub asked: Vec<Asked>,
    pub breakpoints: Vec<Breakpoint>,
    pub numbered: i64,
    /// The names of marks at which the run stops.
    pub marks: BTreeSet<String>,
    motion: Option<Motion>,
}

impl Default for Session {
    fn default() -> Self {
        Self {
            first_line: 1,
            first_column: 1,
            stops_on_entry: false,
            run: None,
            asked: Vec::new(),
            breakpoints: Vec::new(),
            numbered: 0,
            marks: BTreeSet::new(),
            motion: None,
        }
    }
}

impl Session {
    /// Begins with a run.
    pub fn start(&mut self, launched: Launched, turn: &mut Turn<'_>) -> Result<(), Failed> {
        let Launched { subject, sources, title, share } = launched;
        let replay = Replay::new(subject, share).map_err(|error| error.message)?;
        let (handles, expressions) = (Vec::new(), Expressions::default());
        let imports = Imports::of(&sources);
        self.run = Some(Running { replay, sources, imports, title, handles, expressions });
        let stops = turn.arguments.get("stopOnEntry").and_then(Value::as_bool);
        self.stops_on_entry = stops.unwrap_or(false);
        self.verify_earlier(turn);
        Ok(())
    }

    /// The run.
    pub fn running(&self) -> Result<&Running, Failed> {
        self.run.as_ref().ok_or_else(nothing_runs)
    }

    pub fn running_mut(&mut self) -> Result<&mut Running, Failed> {
        self.run.as_mut().ok_or_else(nothing_runs)
    }

    /// Notes where the run goes after the answer.
    pub fn begin(&mut self, motion: Motion) -> Result<Value, Failed> {
        self.running()?;
        self.motion = Some(motion);
        Ok(match motion {
            Motion::Continue => json!({ "allThreadsContinued": true }),
            _ => Value::Null,
        })
    }

    pub fn take_motion(&mut self) -> Option<Motion> {
        self.motion.take()
    }

    /// Forgets the run.
    pub fn end(&mut self) {
        self.run = None;
    }

    pub fn threads(&self) -> Result<Value, Failed> {
        let name = self.run.as_ref().map_or("shader", |run| &run.title);
        Ok(json!({ "threads": [{ "id": THREAD, "name": name }] }))
    }

    pub fn source(&self, turn: &Turn<'_>) -> Result<Value, Failed> {
        let run = self.running()?;
        let given = turn.arguments.pointer("/source/sourceReference");
        let given = given.or_else(|| turn.arguments.get("sourceReference"));
        let reference = given.and_then(Value::as_i64).unwrap_or(0);
        let path = turn.arguments.pointer("/source/path").and_then(Value::as_str);
        let is_meant = |(id, _): &(SourceId, _)| match (reference, path) {
            (0, Some(path)) => {
                let own = turn.host.path_of(run.sources.get(*id));
                own.is_some_and(|own| turn.host.is_same(&own, path))
            }
            _ => reference_of(*id) == reference,
        };
        let found = run.sources.iter().find(is_meant);
        let (_, source) = found.ok_or("the run has no such text")?;
        Ok(json!({ "content": &*source.text, "mimeType": "text/plain" }))
    }

    pub fn loaded_sources(&self, turn: &Turn<'_>) -> Result<Value, Failed> {
        let run = self.running()?;
        let all = run.sources.iter().map(|(id, _)| run.source_json(id, turn.host));
        Ok(json!({ "sources": all.collect::<Vec<_>>() }))
    }
}

fn nothing_runs() -> Failed {
    "no shader runs: `launch` comes first".to_owned()
}

/// The number under which the client may ask for a text.
pub(crate) fn reference_of(id: SourceId) -> i64 {
    i64::from(id.0) + 1
}

impl Running {
    /// A text, as a file of the client or by its number.
    pub fn source_json(&self, id: SourceId, host: &dyn crate::Host) -> Value {
        let source = self.sources.get(id);
        let name = source.path.rsplit('/').next().unwrap_or_default();
        match host.path_of(source) {
            Some(path) => json!({ "name": name, "path": path }),
            None => {
                let reference = reference_of(id);
                json!({ "name": source.path, "sourceReference": reference, "origin": "library" })
            }
        }
    }
}

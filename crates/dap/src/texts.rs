//! The texts of a run, as the client names them: by a path, or by a number that it has from here.

use lamplight_diagnostic::source::SourceId;
use serde_json::{Value, json};

use crate::answer::{Failed, Host, Turn};
use crate::numbers::number_of;
use crate::session::{Running, Session};

/// A text that the client means.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum AskedText {
    /// A file of the client.
    Path(String),
    /// A text that the client has from here.
    Reference(u32),
}

impl AskedText {
    /// Whether both are one text.
    pub fn is_same(&self, other: &Self, host: &dyn Host) -> bool {
        match (self, other) {
            (Self::Path(one), Self::Path(other)) => host.is_same(one, other),
            _ => self == other,
        }
    }
}

impl Turn<'_> {
    /// The text that the arguments name. A number goes before a path.
    pub fn asked_text(&self) -> Result<AskedText, Failed> {
        let nothing = Value::Null;
        let source = self.arguments.get("source").unwrap_or(&nothing);
        let reference = match number_of(source, "sourceReference")? {
            None | Some(0) => self.number("sourceReference")?.unwrap_or(0),
            Some(reference) => reference,
        };
        let path = source.get("path").and_then(Value::as_str).filter(|_| reference == 0);
        Ok(path.map_or(AskedText::Reference(reference), |path| AskedText::Path(path.to_owned())))
    }
}

impl Session {
    pub fn source(&self, turn: &Turn<'_>) -> Result<Value, Failed> {
        let run = self.running()?;
        let id = run.find_source(&turn.asked_text()?, turn.host)?;
        let text = &*run.sources.get(id).text;
        Ok(json!({ "content": text, "mimeType": "text/plain" }))
    }

    pub fn loaded_sources(&self, turn: &Turn<'_>) -> Result<Value, Failed> {
        let run = self.running()?;
        let all = run.sources.iter().map(|(id, _)| run.source_json(id, turn.host));
        Ok(json!({ "sources": all.collect::<Vec<_>>() }))
    }
}

/// The number under which the client may ask for a text.
fn reference_of(id: SourceId) -> u32 {
    id.0.saturating_add(1)
}

impl Running {
    /// The text that the client means. Of several readings of one file, that which runs.
    pub fn find_source(&self, asked: &AskedText, host: &dyn Host) -> Result<SourceId, Failed> {
        let is_meant = |id: &SourceId| match asked {
            AskedText::Path(path) => {
                let own = host.path_of(self.sources.get(*id));
                own.is_some_and(|own| host.is_same(&own, path))
            }
            AskedText::Reference(reference) => reference_of(*id) == *reference,
        };
        let statements = &self.replay.subject().statements;
        let runs = |id: &&SourceId| statements.from_line(**id, 0).is_some();
        let all: Vec<SourceId> =
            self.sources.iter().map(|(id, _)| id).filter(|id| is_meant(id)).collect();
        let found = all.iter().find(runs).or(all.first()).copied();
        found.ok_or_else(|| match asked {
            AskedText::Path(path) => format!("the shader does not read `{path}`"),
            AskedText::Reference(_) => "the shader does not read this text".to_owned(),
        })
    }

    /// A text, as a file of the client or by its number.
    pub fn source_json(&self, id: SourceId, host: &dyn Host) -> Value {
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

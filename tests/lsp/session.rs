//! The editor's side of the protocol.

use std::fs;
use std::io::{self, BufReader};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use lamplight::lsp::wire::{self, Incoming};
use libtest_mimic::Failed;
use serde_json::{Value, json};
use tempfile::TempDir;

use super::Outcome;

/// The module that most tests ask about.
pub const MAIN: &str = "import package::util::half;
import lamplight::brdf::diffuse::lambert;

@if(fog)
fn fade(x: f32) -> f32 {
    return x;
}

@fragment
fn fs_main(@location(0) n: vec3f) -> @location(0) vec4f {
    let up = vec3f(0.0, 1.0, 0.0);
    var sum = lambert(n, up);
    @if(fog) {
        sum = fade(sum);
    }
    @if(TINT) sum = half(sum);
    @if(cone == soft) sum = half(sum);
    return vec4f(sum);
}
";

pub const MANIFEST: &str = r#"[program.lamp]
wesl = "main.wesl"

[program.lamp.axis]
fog = { values = [false, true], doc = "Far things fade." }
cone = { values = ["hard", "soft"] }

[features]
TINT = { doc = "A warm colour." }
"#;

pub const UTIL: &str = "/// Half of it.\nfn half(x: f32) -> f32 {\n    return x * 0.5;\n}\n";

/// How long a server may say nothing. A test that waits for what never comes has to fail.
const SILENCE: Duration = Duration::from_secs(120);

/// A package on disk, and a server with one of its files open.
pub struct Session {
    pub folder: TempDir,
    pub child: Child,
    pub to: Option<ChildStdin>,
    from: Receiver<io::Result<Incoming>>,
    next: u64,
}

impl Session {
    pub fn new(main: &str) -> Result<Self, Failed> {
        let folder = tempfile::tempdir()?;
        fs::write(folder.path().join("lamplight.toml"), MANIFEST)?;
        fs::write(folder.path().join("util.wesl"), UTIL)?;
        fs::write(folder.path().join("main.wesl"), main)?;
        let mut child = Command::new(env!("CARGO_BIN_EXE_lamplight"))
            .arg("lsp")
            .env("XDG_CACHE_HOME", folder.path().join("cache"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let to = child.stdin.take();
        let mut output = BufReader::new(child.stdout.take().ok_or("no output")?);
        let (sender, from) = channel();
        // It ends with the server, or with the session.
        std::thread::spawn(move || while sender.send(wire::read_message(&mut output)).is_ok() {});
        let mut session = Self { folder, child, to, from, next: 0 };
        session.ask("initialize", json!({ "capabilities": {} }))?;
        session.notify("initialized", json!({}))?;
        session.open("main.wesl", main)?;
        Ok(session)
    }

    pub fn uri(&self, name: &str) -> Result<String, Failed> {
        Ok(format!("file://{}", self.folder.path().canonicalize()?.join(name).display()))
    }

    pub fn send(&mut self, message: &Value) -> Outcome {
        Ok(wire::write_message(self.to.as_mut().ok_or("closed")?, message)?)
    }

    pub fn notify(&mut self, method: &str, parameters: Value) -> Outcome {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": parameters }))
    }

    pub fn open(&mut self, name: &str, text: &str) -> Outcome {
        let uri = self.uri(name)?;
        let document = json!({ "uri": uri, "languageId": "wesl", "version": 1, "text": text });
        self.notify("textDocument/didOpen", json!({ "textDocument": document }))
    }

    pub fn receive(&mut self) -> Result<Value, Failed> {
        let received = self.from.recv_timeout(SILENCE);
        match received.map_err(|error| format!("no message within {SILENCE:?}: {error}"))?? {
            Incoming::Message(message) => Ok(message),
            other => Err(format!("expected a message of the server, found {other:?}").into()),
        }
    }

    /// The answer to a request: its result, or its error.
    pub fn answer(
        &mut self,
        method: &str,
        parameters: Value,
    ) -> Result<Result<Value, Value>, Failed> {
        self.next += 1;
        let id = self.next;
        let message = json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": parameters });
        self.send(&message)?;
        loop {
            let found = self.receive()?;
            if found.get("id") == Some(&json!(id)) {
                let error = found.get("error").cloned();
                return Ok(error.map_or(Ok(found["result"].clone()), Err));
            }
        }
    }

    pub fn ask(&mut self, method: &str, parameters: Value) -> Result<Value, Failed> {
        self.answer(method, parameters)?.map_err(|error| error.to_string().into())
    }

    /// Asks about the first place of some words in a text. `more` is added to the parameters.
    pub fn at(
        &mut self,
        method: &str,
        text: &str,
        words: &str,
        more: Value,
    ) -> Result<Value, Failed> {
        let parameters = self.place(text, words, more)?;
        self.ask(method, parameters)
    }

    pub fn place(&self, text: &str, words: &str, more: Value) -> Result<Value, Failed> {
        let byte = text.find(words).ok_or_else(|| format!("the text has no `{words}`"))?;
        let line = text[..byte].matches('\n').count();
        let start = text[..byte].rfind('\n').map_or(0, |end| end + 1);
        let mut parameters = json!({
            "textDocument": { "uri": self.uri("main.wesl")? },
            "position": { "line": line, "character": text[start..byte].encode_utf16().count() },
        });
        if let (Some(parameters), Some(more)) = (parameters.as_object_mut(), more.as_object()) {
            parameters.extend(more.clone());
        }
        Ok(parameters)
    }

    /// The next diagnostics that the server publishes for a file.
    pub fn diagnostics(&mut self, name: &str) -> Result<Vec<Value>, Failed> {
        let uri = self.uri(name)?;
        loop {
            let message = self.receive()?;
            if message["method"] == "textDocument/publishDiagnostics"
                && message["params"]["uri"] == json!(uri)
            {
                return Ok(message["params"]["diagnostics"]
                    .as_array()
                    .cloned()
                    .unwrap_or_default());
            }
        }
    }

    pub fn change(&mut self, text: &str) -> Outcome {
        let uri = self.uri("main.wesl")?;
        let parameters = json!({
            "textDocument": { "uri": uri, "version": 2 },
            "contentChanges": [{ "text": text }],
        });
        self.notify("textDocument/didChange", parameters)
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.to = None;
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

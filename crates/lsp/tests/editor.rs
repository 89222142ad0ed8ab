//! An editor: files on the disk, and a server that it sends messages to.

use std::fs;

use lamplight_diagnostic::source::Embedded;
use lamplight_lsp::LanguageServer;
use libtest_mimic::Failed;
use serde_json::{Value, json};
use tempfile::TempDir;

const NO_LIBRARY: Embedded = Embedded { texts: &[], tables: &[] };

/// A folder that an editor shows, and its server.
pub struct Editor {
    pub folder: TempDir,
    server: LanguageServer,
}

impl Editor {
    /// A session in a folder with these files. The last path of each is below the folder.
    pub fn new(files: &[(&str, &str)]) -> Result<Self, Failed> {
        let folder = tempfile::tempdir()?;
        for (path, text) in files {
            let file = folder.path().join(path);
            fs::create_dir_all(file.parent().ok_or("no folder")?)?;
            fs::write(file, text)?;
        }
        let server = LanguageServer::new(Box::new(|_| None), NO_LIBRARY);
        let mut editor = Self { folder, server };
        let root = editor.uri("")?;
        let workspace = json!({ "didChangeWatchedFiles": { "dynamicRegistration": true } });
        let parameters = json!({
            "workspaceFolders": [{ "uri": root, "name": "w" }],
            "capabilities": { "workspace": workspace },
        });
        editor.ask("initialize", parameters)?;
        Ok(editor)
    }

    pub fn uri(&self, path: &str) -> Result<String, Failed> {
        Ok(format!("file://{}", self.folder.path().canonicalize()?.join(path).display()))
    }

    /// What the server sends upon a notification, before it looks at documents.
    pub fn notify(&mut self, method: &str, parameters: Value) -> Vec<Value> {
        let message = json!({ "jsonrpc": "2.0", "method": method, "params": parameters });
        self.server.receive(&message)
    }

    pub fn open(&mut self, path: &str) -> Result<String, Failed> {
        let text = fs::read_to_string(self.folder.path().join(path))?;
        self.open_text(path, &text)?;
        Ok(text)
    }

    pub fn open_text(&mut self, path: &str, text: &str) -> Result<(), Failed> {
        let uri = self.uri(path)?;
        let document = json!({ "uri": uri, "languageId": "wesl", "version": 1, "text": text });
        self.notify("textDocument/didOpen", json!({ "textDocument": document }));
        Ok(())
    }

    /// The answer to a request: its result, or the words of its error.
    pub fn answer(
        &mut self,
        method: &str,
        parameters: Value,
    ) -> Result<Result<Value, String>, Failed> {
        let message = json!({ "jsonrpc": "2.0", "id": 1, "method": method, "params": parameters });
        let answers = self.server.receive(&message);
        let answer = answers.first().ok_or("no answer")?;
        Ok(match answer["error"]["message"].as_str() {
            Some(words) => Err(words.to_owned()),
            None => Ok(answer["result"].clone()),
        })
    }

    pub fn ask(&mut self, method: &str, parameters: Value) -> Result<Value, Failed> {
        self.answer(method, parameters)?.map_err(Failed::from)
    }

    /// Parameters that name the first place of some words in a text.
    pub fn place(&self, path: &str, text: &str, words: &str) -> Result<Value, Failed> {
        let byte = text.find(words).ok_or_else(|| format!("`{path}` has no `{words}`"))?;
        Ok(json!({
            "textDocument": { "uri": self.uri(path)? },
            "position": position(text, byte),
        }))
    }

    /// What is shown at each file below the folder once the server has looked at everything.
    pub fn shown(&mut self) -> Result<Vec<(String, Vec<Value>)>, Failed> {
        let root = self.uri("")?;
        let mut shown: Vec<(String, Vec<Value>)> = Vec::new();
        while !self.server.is_idle() {
            for message in self.server.look() {
                let parameters = &message["params"];
                let uri = parameters["uri"].as_str().unwrap_or_default();
                let path = uri.strip_prefix(&root).unwrap_or(uri).trim_start_matches('/');
                let found = parameters["diagnostics"].as_array().cloned().unwrap_or_default();
                shown.retain(|(known, _)| known != path);
                shown.push((path.to_owned(), found));
            }
        }
        shown.sort_by(|one, other| one.0.cmp(&other.0));
        Ok(shown)
    }
}

pub fn position(text: &str, byte: usize) -> Value {
    let line = text[..byte].matches('\n').count();
    let start = text[..byte].rfind('\n').map_or(0, |end| end + 1);
    json!({ "line": line, "character": text[start..byte].encode_utf16().count() })
}

/// Fails unless a condition holds, with the place of the call and what was found.
#[track_caller]
pub fn expect(is_so: bool, found: &impl std::fmt::Debug) -> Result<(), Failed> {
    let place = std::panic::Location::caller();
    if is_so { Ok(()) } else { Err(format!("{place}: unexpected: {found:#?}").into()) }
}

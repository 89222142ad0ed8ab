//! What an editor asks about the files of a project: the language server of `lamplight lsp`, with all
//! files open and none on a disk.

use std::cell::RefCell;

use lamplight::LIBRARY_FILES;
use lamplight_lsp::LanguageServer;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::wasm_bindgen;

use crate::package::Files;
use crate::{Answer, answer};

/// A question about a place in a project.
#[derive(Deserialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct EditorRequest {
    #[tsify(type = "Record<string, string>")]
    pub files: Files,
    /// The file that is asked about.
    pub path: String,
    /// Such as `completion`, `hover`, `signatureHelp` or `formatting`.
    pub method: String,
    /// The line, from 0.
    pub line: u32,
    /// UTF-16 units before the place in its line.
    pub character: u32,
}

/// An answer in the form of the Language Server Protocol.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct EditorAnswer {
    /// JSON; `null` if there is nothing to say.
    pub json: String,
}

/// A session, with the files that it has open.
struct Session {
    server: LanguageServer,
    files: Files,
}

thread_local! {
    static SESSION: RefCell<Option<Session>> = const { RefCell::new(None) };
}

/// The folder that the files are said to be in.
fn address(path: &str) -> String {
    format!("file:///project/{path}")
}

impl Session {
    fn begin() -> Self {
        let mut server = LanguageServer::new(Box::new(|_| None), LIBRARY_FILES);
        let parameters = json!({ "capabilities": {} });
        server.receive(&json!({ "id": 0, "method": "initialize", "params": parameters }));
        server.receive(&json!({ "method": "initialized", "params": {} }));
        Self { server, files: Files::new() }
    }

    fn notify(&mut self, method: &str, parameters: Value) {
        let method = format!("textDocument/{method}");
        self.server.receive(&json!({ "method": method, "params": parameters }));
    }

    /// Tells the server of what changed since the last question.
    fn update(&mut self, files: Files) {
        let before = std::mem::take(&mut self.files);
        for path in before.keys().filter(|path| !files.contains_key(*path)) {
            self.notify("didClose", json!({ "textDocument": { "uri": address(path) } }));
        }
        for (path, text) in &files {
            let uri = address(path);
            match before.get(path) {
                None => {
                    let document = json!({ "uri": uri, "version": 1, "text": text });
                    self.notify("didOpen", json!({ "textDocument": document }));
                }
                Some(known) if known != text => {
                    let changes = json!([{ "text": text }]);
                    let document = json!({ "uri": uri, "version": 1 });
                    let change = json!({ "textDocument": document, "contentChanges": changes });
                    self.notify("didChange", change);
                }
                Some(_) => {}
            }
        }
        self.files = files;
    }

    fn ask(&mut self, request: EditorRequest) -> Value {
        let EditorRequest { files, path, method, line, character } = request;
        self.update(files);
        let parameters = json!({
            "textDocument": { "uri": address(&path) },
            "position": { "line": line, "character": character },
            "options": { "tabSize": 4, "insertSpaces": true },
        });
        let method = format!("textDocument/{method}");
        let request = json!({ "id": 1, "method": method, "params": parameters });
        let answers = self.server.receive(&request);
        let found =
            answers.into_iter().find_map(|mut answer| answer.get_mut("result").map(Value::take));
        found.unwrap_or(Value::Null)
    }
}

/// Answers what an editor asks at a place. A question about a file that is no module has no answer.
#[wasm_bindgen]
pub fn editor(request: Ts<EditorRequest>) -> Answer<EditorAnswer> {
    let request = request.to_rust()?;
    let found = SESSION.with_borrow_mut(|session| {
        let session = session.get_or_insert_with(Session::begin);
        session.ask(request)
    });
    answer(&EditorAnswer { json: found.to_string() })
}

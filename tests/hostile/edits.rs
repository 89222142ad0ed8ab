//! Messages to the language server that ask for much work.

use lamplight::lsp::LanguageServer;
use libtest_mimic::Trial;
use serde_json::{Value, json};

use super::Outcome;

pub fn tests() -> Vec<Trial> {
    vec![Trial::test("hostile::edits_of_a_large_document", many)]
}

const URI: &str = "file:///no/such/folder/lamp.wesl";
/// The size of the document. This many edits of it move more bytes than one message may.
const BYTES: usize = 1 << 20;
const EDITS: usize = 300;

fn edit() -> Value {
    let place = json!({ "line": 0, "character": 0 });
    json!({ "range": { "start": place, "end": place }, "text": "x" })
}

/// A message with too many edits is not applied, and the user is notified. The server then gives no
/// answers about the document, since its text differs from the editor's.
fn many() -> Outcome {
    let mut server = LanguageServer::new(Box::new(|_| None), lamplight::LIBRARY_FILES);
    let document = json!({ "uri": URI, "version": 1, "text": "x".repeat(BYTES) });
    let opened = json!({ "textDocument": document });
    server.receive(&json!({ "method": "textDocument/didOpen", "params": opened }));
    let few = changed(&mut server, 10);
    let many = changed(&mut server, EDITS);
    let is_notified = many.iter().any(|message| message["method"] == "window/showMessage");
    let answers = server.receive(&json!({
        "id": 1,
        "method": "textDocument/documentSymbol",
        "params": { "textDocument": { "uri": URI } },
    }));
    let refused = answers.iter().any(|message| message["error"].is_object());
    match (few.is_empty(), is_notified, refused) {
        (true, true, true) => Ok(()),
        _ => {
            let what = format!("10 edits should give no message: {few:?}");
            let what = format!("{what}; {EDITS} should give `showMessage`: {many:?}");
            Err(format!("{what}; a question after them should give an error: {answers:?}").into())
        }
    }
}

fn changed(server: &mut LanguageServer, edits: usize) -> Vec<Value> {
    let changes: Vec<Value> = (0..edits).map(|_| edit()).collect();
    let parameters =
        json!({ "textDocument": { "uri": URI, "version": 2 }, "contentChanges": changes });
    server.receive(&json!({ "method": "textDocument/didChange", "params": parameters }))
}

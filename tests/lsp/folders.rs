//! Files whose folder is not on the disk.

use serde_json::{Value, json};

use super::session::{MAIN, Session};
use super::{Outcome, expect};

/// An editor may open a new file in a folder that it has not made yet. The file is looked at all the
/// same.
pub fn folder_that_is_not_there() -> Outcome {
    let mut session = Session::new(MAIN)?;
    let text = "import lamplight::brdf::diffuse::lambert;\nfn f(n: vec3f) -> vec4f { return lambert(n, n); }\n";
    session.open("not/there/new.wesl", text)?;
    let found = session.diagnostics("not/there/new.wesl")?;
    let is_type = |found: &Value| found["code"] == "type-mismatch";
    expect(found.len() == 1 && found.iter().all(is_type), &found)?;
    let alone = session.uri("../no folder/of/new.wesl")?.replace(' ', "%20");
    let document = json!({ "uri": alone, "languageId": "wesl", "version": 1, "text": text });
    session.notify("textDocument/didOpen", json!({ "textDocument": document }))?;
    loop {
        let message = session.receive()?;
        if message["params"]["uri"].as_str().is_some_and(|uri| uri.ends_with("of/new.wesl")) {
            let found = &message["params"]["diagnostics"];
            return expect(is_type(&found[0]), found);
        }
    }
}

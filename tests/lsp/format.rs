//! Formatting of documents.

use lamplight::LIBRARY_FILES;
use lamplight::source::Files as _;
use libtest_mimic::Failed;
use serde_json::json;

use super::session::{MAIN, Session};
use super::{Outcome, expect};

/// Formatting changes only blanks, and changes nothing the second time. This holds for a text with
/// odd blanks and for every module of the library.
pub fn formatting() -> Outcome {
    let mut session = Session::new(MAIN)?;
    let mut format = |text: &str| -> Result<String, Failed> {
        session.change(text)?;
        let document = json!({
            "textDocument": { "uri": session.uri("main.wesl")? },
            "options": { "tabSize": 4, "insertSpaces": true },
        });
        let edits = session.ask("textDocument/formatting", document)?;
        Ok(edits[0]["newText"].as_str().unwrap_or(text).to_owned())
    };
    let words = |text: &str| text.split_whitespace().collect::<String>();
    let odd = MAIN.replace("    ", "\t ");
    let odd = odd.replace("return vec4f(sum);", "return   vec4f(\n\nsum\n);\n\n\n");
    let once = format(&odd)?;
    expect(words(&once) == words(&odd), &once)?;
    expect(once.contains("    return   vec4f(\n        sum\n    );\n}\n"), &once)?;
    expect(format(&once)? == once, &once)?;
    for file in LIBRARY_FILES.list(&["wesl"]) {
        let text = LIBRARY_FILES.read(&file).ok().flatten().ok_or("unreadable")?;
        let once = format(&text)?;
        expect(words(&once) == words(&text) && format(&once)? == once, &file)?;
    }
    Ok(())
}

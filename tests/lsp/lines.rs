//! Places in a file that is one long line.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::session::{MAIN, Session};
use super::{Outcome, expect};

/// Functions in a line.
const FUNCTIONS: usize = 1500;

/// What stands before each function: texts of which a character has one, two and four bytes, so
/// that functions begin at every distance from a mark.
const BEFORE: [&str; 4] = ["/* a */ ", "/* \u{e4}\u{f6} */ ", "/* \u{1d11e} */ ", ""];

/// Every function is listed at its place in UTF-16 units, in texts of ASCII and in others.
pub fn long_lines() -> Outcome {
    let mut session = Session::new(MAIN)?;
    for before in [&BEFORE[..1], &BEFORE] {
        let (mut text, mut places) = (String::new(), Vec::new());
        for index in 0..FUNCTIONS {
            write!(text, "{}void ", before[index % before.len()])?;
            places.push(text.encode_utf16().count());
            write!(text, "f{index}(){{}}")?;
        }
        session.open("long.frag", &text)?;
        let document = json!({ "textDocument": { "uri": session.uri("long.frag")? } });
        let found = session.ask("textDocument/documentSymbol", document.clone())?;
        let found: Vec<&Value> = found.as_array().into_iter().flatten().collect();
        expect(found.len() == FUNCTIONS, &found.len())?;
        for (index, (found, place)) in found.iter().zip(&places).enumerate() {
            let start = &found["selectionRange"]["start"];
            let is_it = found["name"] == format!("f{index}") && start["character"] == *place;
            expect(is_it && start["line"] == 0, &(found, place))?;
        }
        session.notify("textDocument/didClose", document)?;
    }
    Ok(())
}

//! The inactive code of a document: what the permutation that the editor shows leaves out.

use crate::failure::RequestError;
use std::ops::Range;

use serde_json::{Value, json};

use super::place::Lines;
use super::{LanguageServer, look};
use lamplight_compose::resolve::Graph;
use lamplight_permute::Settings;

impl LanguageServer {
    /// The text that parameters name, and its inactive parts.
    fn shaded(&self, parameters: &Value) -> Result<(&str, Vec<Range<u32>>), RequestError> {
        let document = self.document(parameters)?;
        let found = self.opened(&document.root).and_then(|mut opened| {
            let choice = self.choice(&document.root);
            let (settings, _) = look::module_settings(&opened, &document.path, &choice);
            let graph = self.graph(&mut opened, &document.path).ok()?;
            Some(look::inactive_ranges(&graph, &settings))
        });
        Ok((&document.text, found.unwrap_or_default()))
    }
}

/// Hints that let editors fade inactive code.
pub fn inactive_hints(text: &str, graph: &Graph, settings: &Settings) -> Vec<Value> {
    let lines = Lines::new(text);
    let hint = |range: Range<u32>| {
        json!({
            "range": lines.range(trimmed_range(text, &range)),
            "severity": 4,
            "code": "inactive",
            "source": "lamplight",
            "message": "not in this permutation",
            "tags": [1],
        })
    };
    look::inactive_ranges(graph, settings).into_iter().map(hint).collect()
}

/// A range without the blanks at its ends.
fn trimmed_range(text: &str, range: &Range<u32>) -> Range<usize> {
    let range = range.start as usize..(range.end as usize).min(text.len());
    let inner = text.get(range.clone()).unwrap_or_default();
    let start = range.start + inner.len() - inner.trim_start().len();
    start..start + inner.trim().len()
}

/// `textDocument/semanticTokens/full`: inactive code as comments, line by line.
pub fn semantic_tokens(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    let (text, inactive) = server.shaded(parameters)?;
    let lines = Lines::new(text);
    let (mut data, mut last) = (Vec::new(), (0, 0));
    let mut covered = 0;
    for range in inactive {
        let range = trimmed_range(text, &range);
        let mut at = range.start.max(covered);
        covered = covered.max(range.end);
        while at < range.end {
            let end = text[at..range.end].find('\n').map_or(range.end, |length| at + length);
            let line = &text[at..end];
            let start = at + line.len() - line.trim_start().len();
            let length = line.trim().encode_utf16().count();
            if length > 0 {
                let (row, column) = lines.units(start);
                let shift = if row == last.0 { column - last.1 } else { column };
                data.extend([row - last.0, shift, length, 0, 0]);
                last = (row, column);
            }
            at = end + 1;
        }
    }
    Ok(json!({ "data": data }))
}

/// `textDocument/inlayHint`: a hint at the end of the first line of each inactive part.
pub fn inlay_hints(server: &mut LanguageServer, parameters: &Value) -> Result<Value, RequestError> {
    let (text, inactive) = server.shaded(parameters)?;
    let lines = Lines::new(text);
    let hint = |range: Range<u32>| {
        let range = trimmed_range(text, &range);
        let first = text[range.clone()].find('\n').map_or(range.end, |end| range.start + end);
        json!({
            "position": lines.position(first),
            "label": "not in this permutation",
            "paddingLeft": true,
        })
    };
    Ok(inactive.into_iter().map(hint).collect())
}

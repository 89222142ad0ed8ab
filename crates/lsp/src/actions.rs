//! Code actions that mend what a diagnostic reports, and formatting.

use crate::failure::RequestError;
use std::ops::Range;
use std::path::Path;

use serde_json::{Value, json};

use super::package::PackageModules;
use super::place::{self, Lines};
use super::{LanguageServer, complete, navigate};
use lamplight_compose::project::{MANIFEST, WESL_MANIFEST};

/// The most imports that are offered for one name.
const OFFERED: usize = 8;

/// `textDocument/codeAction`.
pub fn code_actions(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    let document = server.document(parameters)?;
    let (root, path, text) = (document.root.clone(), document.path.clone(), document.text.clone());
    let uri = parameters.pointer("/textDocument/uri").cloned().unwrap_or_default();
    let lines = Lines::new(&text);
    let mut found = Vec::new();
    let diagnostics = parameters.pointer("/context/diagnostics").and_then(Value::as_array);
    for diagnostic in diagnostics.into_iter().flatten() {
        let start = diagnostic.pointer("/range/start");
        let start = start.and_then(|at| place::byte_of_position(&text, at));
        let Some(start) = start else { continue };
        let word = place::word_at_byte(&text, start);
        let name = text[word.clone()].to_owned();
        let action = |title: String, uri: &Value, edit: Value| {
            json!({
                "title": title,
                "kind": "quickfix",
                "diagnostics": [diagnostic],
                "edit": { "changes": { uri.as_str().unwrap_or_default(): [edit] } },
            })
        };
        match diagnostic.get("code").and_then(Value::as_str) {
            Some("unused-import") => {
                if let Some(range) = import_part(&text, word) {
                    let edit = json!({ "range": lines.range(range), "newText": "" });
                    found.push(action(format!("Remove the import of `{name}`"), &uri, edit));
                }
            }
            Some("undeclared-flag" | "unknown-feature") => {
                if navigate::why_no_name(&name).is_none()
                    && let Some((file, edit)) = feature_declaration(&root, &name)
                {
                    let title = format!("Declare the feature `{name}`");
                    found.push(action(title, &Value::String(file), edit));
                }
            }
            _ => {
                let Some(modules) = server.modules(&root) else { continue };
                for path in importable(server, &modules, &path, &name) {
                    let edit = import_edit(&text, &lines, &path);
                    found.push(action(format!("Import `{path}`"), &uri, edit));
                }
            }
        }
    }
    Ok(Value::Array(found))
}

/// The paths by which a module may import a name; none if it declares or imports the name already,
/// since another import would be a clash.
fn importable(
    server: &mut LanguageServer,
    modules: &PackageModules,
    path: &str,
    name: &str,
) -> Vec<String> {
    let found = modules.graph.names.find(name);
    let node = modules.node(path).map(|node| &modules.graph.nodes[node as usize]);
    let is_declared = found.zip(node).is_some_and(|(name, node)| {
        node.sets.contains_key(&name) || node.aliases.contains_key(&name)
    });
    if is_declared {
        return Vec::new();
    }
    let known = complete::importable_items(server, modules, path).into_iter();
    let fitting = known.filter(|(_, found, _)| *found == name);
    fitting.map(|(path, ..)| path).take(OFFERED).collect()
}

/// The edit that adds an import after the existing ones, or else on the first line.
pub fn import_edit(text: &str, lines: &Lines<'_>, path: &str) -> Value {
    import_edit_at(text, lines, import_place(text), path)
}

/// The edit that adds an import at `at`, which comes from [`import_place`].
pub fn import_edit_at(text: &str, lines: &Lines<'_>, at: usize, path: &str) -> Value {
    let before = if at > 0 && !text[..at].ends_with('\n') { "\n" } else { "" };
    json!({ "range": lines.range(at..at), "newText": format!("{before}import {path};\n") })
}

/// Where to add an import: the byte after the existing imports, or else the first byte.
pub fn import_place(text: &str) -> usize {
    let mut at = 0;
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        if line.trim_start().starts_with("import ") {
            let end = text[start..].find(';').map_or(text.len(), |end| start + end + 1);
            at = at.max(text[end..].find('\n').map_or(text.len(), |rest| end + rest + 1));
        }
        start += line.len();
    }
    at
}

/// The range to delete to remove an imported name: its whole statement, or its part of the braces.
fn import_part(text: &str, word: Range<usize>) -> Option<Range<usize>> {
    let start = text[..word.start].rfind("import")?;
    let end = word.end + text[word.end..].find(';')? + 1;
    if !text[start..end].contains('{') {
        let line = text[..start].rfind('\n').map_or(0, |end| end + 1);
        let only_blank = text[line..start].trim().is_empty();
        let after = end + usize::from(text[end..].starts_with('\n'));
        return Some(if only_blank { line..after } else { start..end });
    }
    let from = text[..word.start].rfind(['{', ',', ';'])? + 1;
    let until = word.end + text[word.end..].find(['}', ','])?;
    match (text[..from].ends_with('{'), text[until..].starts_with(',')) {
        // The only name in the braces. Empty braces are not valid, so the whole statement is
        // deleted.
        (true, false) if text[start..from].matches('{').count() == 1 => Some(start..end),
        (true, false) => None,
        (false, _) => Some(from - 1..until),
        (true, true) => Some(from..until + 1),
    }
}

/// The file that declares features, and the edit that adds one.
fn feature_declaration(root: &Path, name: &str) -> Option<(String, Value)> {
    let folders = root.ancestors().take(2);
    let names = [MANIFEST, WESL_MANIFEST];
    let places = folders.flat_map(|folder| names.iter().map(move |name| folder.join(name)));
    let (file, text) =
        places.into_iter().find_map(|file| Some((file.clone(), read_text(&file)?)))?;
    const TABLE: &str = "[features]\n";
    let (at, new) = match text.find(TABLE) {
        Some(at) => (at + TABLE.len(), format!("{name} = false\n")),
        None => {
            let gap = if text.is_empty() || text.ends_with('\n') { "\n" } else { "\n\n" };
            (text.len(), format!("{gap}{TABLE}{name} = false\n"))
        }
    };
    let new = match name.is_ascii() {
        true => new,
        // A key of TOML without quotes has only letters of ASCII.
        false => new.replace(&format!("{name} ="), &format!("\"{name}\" =")),
    };
    let edit = json!({ "range": Lines::new(&text).range(at..at), "newText": new });
    Some((place::file_address(&file), edit))
}

/// The text of a file on disk, if it is there and can be read.
pub(super) fn read_text(file: &Path) -> Option<String> {
    let bytes =
        lamplight_files::input::read_file(file, lamplight_files::limits::FILE_BYTES as u64).ok()?;
    String::from_utf8(bytes).ok()
}

//! Searches for a word: first in names, then in documentation.

use serde_json::json;

use super::{ShowIndex, ShownItem};
use crate::cli::text;

/// The items that contain every word of the search; `None` if there are none.
pub fn search_library(library: &ShowIndex, query: &str) -> Option<ShownItem> {
    let words: Vec<String> = query.split_whitespace().map(str::to_lowercase).collect();
    let has = |text: &str| {
        let text = text.to_lowercase();
        words.iter().all(|word| text.contains(word.as_str()))
    };
    let things = searchable_things(library);
    let (named, rest): (Vec<SearchEntry>, Vec<SearchEntry>) =
        things.into_iter().partition(|thing| has(&thing.path));
    let described = rest.into_iter().filter(|thing| has(&thing.summary) || has(&thing.doc));
    let found: Vec<SearchEntry> = named.into_iter().chain(described).collect();
    if found.is_empty() || words.is_empty() {
        return None;
    }
    let rows: Vec<Vec<String>> = found
        .iter()
        .map(|thing| vec![thing.path.clone(), thing.what.to_owned(), thing.summary.clone()])
        .collect();
    let json = found
        .iter()
        .map(|thing| json!({ "path": thing.path, "kind": thing.what, "summary": thing.summary }));
    Some(ShownItem {
        text: text::table_text(&["path", "kind", "summary"], &rows),
        json: json!({ "matches": json.collect::<Vec<_>>() }),
    })
}

struct SearchEntry {
    path: String,
    what: &'static str,
    summary: String,
    doc: String,
}

fn searchable_things(library: &ShowIndex) -> Vec<SearchEntry> {
    let modules = library.modules.iter().map(|module| SearchEntry {
        path: module.path.clone(),
        what: "module",
        summary: module.summary().to_owned(),
        doc: module.doc.join(" "),
    });
    let items = library.modules.iter().flat_map(|module| &module.items).map(|item| SearchEntry {
        path: item.path(),
        what: item.kind.name(),
        summary: item.summary().to_owned(),
        doc: item.doc.join(" "),
    });
    let programs = library.manifests.iter().flat_map(|manifest| &manifest.programs);
    let axes = programs.flat_map(|program| {
        program.space.axes().iter().map(|axis| SearchEntry {
            path: format!("{}.{}", program.name, axis.name),
            what: "axis",
            summary: axis.doc.clone().unwrap_or_default(),
            doc: axis.value_names().join(" "),
        })
    });
    items.chain(modules).chain(axes).collect()
}

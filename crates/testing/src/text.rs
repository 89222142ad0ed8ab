//! Texts that were not composed.

use lamplight_bundle::{Language, Stage};
use lamplight_compose::{Composed, Segment, SourceMap};
use lamplight_diagnostic::source::{SourceSet, Span};

/// The text as the composer would give it for one file that it does not change.
pub fn wrap(
    name: &str,
    text: String,
    language: Language,
    stage: Option<Stage>,
) -> (SourceSet, Composed) {
    let mut sources = SourceSet::default();
    let id = sources.add(name, text.as_str());
    let mut map = SourceMap::default();
    map.push(Segment { start: 0, span: Some(Span::new(id, 0..text.len())), verbatim: true });
    (sources, Composed { map, ..Composed::of_text(language, stage, text) })
}

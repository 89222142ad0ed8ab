//! Composes one entry point of one permutation again, to show its author where something in an
//! output comes from.

use std::sync::Arc;

use super::entry::{self, ShaderEntry};
use lamplight_bundle::Language;
use lamplight_compose::resolve::{Graph, Packages};
use lamplight_compose::{self as compose, Composed};
use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::SourceSet;
use lamplight_permute::{Manifest, Quoted, key};

/// Which shader of a bundle.
#[derive(Debug, Clone, Copy)]
pub struct ShaderName<'a> {
    /// Its program.
    pub program: &'a str,
    /// Its source language.
    pub language: Language,
    /// The entry point's name in the bundle.
    pub label: &'a str,
    /// The key of its permutation.
    pub key: &'a str,
}

/// A shader's text, with its places.
pub struct Permutation {
    /// The text.
    pub composed: Composed,
    /// The entry point's name in the text.
    pub entry: String,
    graph: Arc<Graph>,
    note: String,
}

impl Permutation {
    /// Diagnostics about the text, with the chain of imports and the permutation.
    pub fn named(&self, diagnostics: Diagnostics) -> Diagnostics {
        let one = |error: lamplight_diagnostic::Diagnostic| error.note(self.note.as_str());
        self.graph.traced(diagnostics).into_iter().map(one).collect()
    }
}

/// Composes a shader of the manifest; `None` where it has no such shader.
///
/// # Errors
/// What is wrong with the key, or with the text when it is composed.
pub fn permutation(
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &Manifest,
    named: ShaderName<'_>,
) -> Result<Option<Permutation>, Diagnostics> {
    let Some(program) = manifest.program(named.program) else { return Ok(None) };
    let id = sources.add("key", named.key);
    let point = key::parse(&program.space, &Quoted::whole(sources, id))?;
    let entries = entry::entries(sources, packages, program, Some(&point))?;
    let is_it =
        |entry: &&ShaderEntry| entry.language == named.language && entry.label == named.label;
    let Some(entry) = entries.iter().find(is_it) else { return Ok(None) };
    let settings = program.space.settings(&point);
    let composed = compose::compose(&entry.graph, &settings, &entry.options)?;
    Ok(Some(Permutation {
        composed,
        entry: entry.name.clone(),
        graph: entry.graph.clone(),
        note: format!("in permutation `{}` of {}", program.space.key(&point), entry.title()),
    }))
}

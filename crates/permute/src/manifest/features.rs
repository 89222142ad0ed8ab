//! The table `features`, of a manifest or of a `wesl.toml`: the features that conditions may name.
//!
//! ```toml
//! [features]
//! FOG = true                                # on, unless it is turned off
//! SKINNED = false
//! MSAA = { doc = "Several samples for each pixel.", excludes = ["WEBGL2"] }
//! WEBGL2 = { doc = "What old browsers lack.", default = false }
//! ```

use std::collections::BTreeMap;

use toml::de::DeTable;

use super::names;
use super::reader::{ManifestReader, TomlName, TomlValue};
use crate::{Setting, Settings};
use lamplight_diagnostic::source::{SourceId, SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};

const KEYS: &[&str] = &["doc", "default", "excludes"];

/// A feature that a package declares.
#[derive(Debug, Clone)]
pub struct Feature {
    /// What it is.
    pub doc: Option<String>,
    /// Its value where nothing chooses one.
    pub default: bool,
    /// Features that are never on together with it.
    pub excludes: Vec<(String, Span)>,
    /// Its name in the file.
    pub span: Span,
}

/// Features by name.
#[derive(Debug, Clone, Default)]
pub struct Features {
    /// All that are declared.
    pub declared: BTreeMap<String, Feature>,
}

impl Features {
    /// Adds features of another file; what is declared already stays as it is.
    pub fn extend(&mut self, other: Self) {
        for (name, feature) in other.declared {
            self.declared.entry(name).or_insert(feature);
        }
    }

    /// The value of each where nothing chooses one.
    pub fn defaults(&self) -> impl Iterator<Item = (String, Setting)> {
        self.declared.iter().map(|(name, found)| (name.clone(), Setting::Bool(found.default)))
    }

    /// Gives each its default that has no value yet.
    pub fn complete(&self, settings: &mut Settings) {
        for (name, value) in self.defaults() {
            settings.values.entry(name).or_insert(value);
        }
    }

    /// A warning for each two that exclude each other and are both on.
    pub fn broken(&self, settings: &Settings) -> Diagnostics {
        let is_on = |name: &str| settings.values.get(name) == Some(&Setting::Bool(true));
        let on = self.declared.iter().filter(|(name, _)| is_on(name));
        let both = on.flat_map(|(name, feature)| {
            let excluded = feature.excludes.iter().filter(|(other, _)| is_on(other));
            excluded.map(move |(other, span)| {
                let message = format!("`{name}` and `{other}` are never on together");
                Diagnostic::warning(codes::INVALID_PERMUTATION, message).at(*span, "declared here")
            })
        });
        both.collect()
    }
}

/// Reads the table `features` of a file that is in the set, and ignores the rest of the file.
pub fn read_file(sources: &SourceSet, id: SourceId) -> Result<Features, Diagnostics> {
    let (document, errors) = DeTable::parse_recoverable(&sources.get(id).text);
    if !errors.is_empty() {
        return Err(errors.iter().map(|error| super::syntax_error(sources, id, error)).collect());
    }
    let mut reader = ManifestReader::new(sources, id);
    let found = read_features(&mut reader, document.get_ref());
    if reader.problems.is_empty() { Ok(found) } else { Err(reader.problems) }
}

/// The features of a document.
pub fn read_features(reader: &mut ManifestReader, document: &DeTable) -> Features {
    let mut found = Features::default();
    let Some(value) = document.get("features") else { return found };
    let Some(table) = reader.table(value, "`features`") else { return found };
    for (name, value) in table.iter() {
        if let Some(feature) = read_feature(reader, name, value) {
            found.declared.insert(name.get_ref().to_string(), feature);
        }
    }
    for (name, feature) in &found.declared {
        let known = |other: &str| other != name && found.declared.contains_key(other);
        for (other, span) in feature.excludes.iter().filter(|(other, _)| !known(other)) {
            let message = format!("`{name}` excludes `{other}`, which is not another feature");
            let others = found.declared.keys().filter(|known| *known != name);
            let error = Diagnostic::error(codes::UNKNOWN_FEATURE, message)
                .at(*span, "not declared here")
                .suggest(other, others.map(String::as_str));
            reader.problems.push(error);
        }
    }
    found
}

fn read_feature(
    reader: &mut ManifestReader,
    name: &TomlName,
    value: &TomlValue,
) -> Option<Feature> {
    let span = reader.span(name.span());
    let text = name.get_ref().to_string();
    reader.problems.extend(names::check_name(&text, "a feature", span));
    if let Some(default) = value.get_ref().as_bool() {
        return Some(Feature { doc: None, default, excludes: Vec::new(), span });
    }
    let what = format!("feature `{text}`");
    let table = reader.table(value, &what)?;
    reader.check_keys(table, KEYS, &what);
    let doc = reader.doc(table);
    let default = match table.get("default") {
        Some(value) => reader.boolean(value, "`default`")?,
        None => false,
    };
    let list = table.get("excludes");
    let list = list.and_then(|value| reader.array(value, "`excludes`"));
    let excludes = list.into_iter().flat_map(|list| list.iter()).filter_map(|value| {
        let name = reader.string(value, "an entry of `excludes`")?;
        Some((name.text, name.span))
    });
    let excludes = excludes.collect();
    Some(Feature { doc, default, excludes, span })
}

//! Sources of other preprocessors, rewritten to WESL.
//!
//! [`naga_oil`] takes the files of one folder. Each is cut into tokens and directives ([`scan`]),
//! read as lists of declarations, statements and members, so that each condition stands around
//! whole ones ([`mod@unit`]), and written again with its comments and its layout ([`write`]).

mod condition;
mod import;
mod level;
mod names;
mod scan;
mod tree;
mod unit;
mod uses;
mod write;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use lamplight_diagnostic::source::{SourceId, SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_syntax::wesl;

/// What became of a folder.
#[derive(Debug, Default)]
pub struct Migrated {
    /// Text of each file that could be rewritten, by the path of the `.wgsl` file.
    pub files: BTreeMap<String, String>,
    /// Shader defs that conditions ask for.
    pub features: BTreeSet<String>,
    /// Shader defs whose numbers conditions compare.
    pub numbers: BTreeSet<String>,
    /// Shader defs whose values stand in the text.
    pub constants: BTreeSet<String>,
    /// What could not be rewritten, and what has to be known.
    pub diagnostics: Diagnostics,
}

/// Rewrites sources of `naga_oil`; each has its path below the folder.
pub fn naga_oil(sources: &SourceSet, files: &[(String, SourceId)]) -> Migrated {
    let mut migrated = Migrated::default();
    let mut scanned = Vec::new();
    for (path, id) in files {
        match scan::scan_file(&sources.get(*id).text, *id) {
            Ok(found) => scanned.push((path, *id, found)),
            Err(error) => migrated.diagnostics.push(error),
        }
    }
    let text = |id: &SourceId| &*sources.get(*id).text;
    let own = scanned.iter().map(|(path, id, found)| (path.as_str(), text(id), *id, found));
    let modules = names::FolderModules::new(own, &mut migrated.diagnostics);
    for (path, id, found) in &scanned {
        match write::write_file(text(id), *id, found, &modules)
            .and_then(|text| parse_result(*id, text))
        {
            Ok(text) => {
                migrated.files.insert((*path).clone(), text);
                found.defs.add_to(&mut migrated);
            }
            Err(error) => migrated.diagnostics.push(error),
        }
        migrated.diagnostics.extend(found.notes.iter().cloned());
    }
    migrated.diagnostics.extend(modules.foreign());
    migrated
        .diagnostics
        .extend(condition::used_both_ways(scanned.iter().map(|(_, _, found)| found)));
    migrated
}

/// The text, if it is WESL as far as the parser can tell.
fn parse_result(id: SourceId, text: String) -> Result<String, Diagnostic> {
    let module = wesl::parse(id, text.as_str().into(), &mut wesl::Names::default());
    let module = wesl::PlacedModule::new(Arc::new(module), id);
    match module.errors.first() {
        None => Ok(text),
        Some(error) => {
            let message = format!("what it would become is not WESL: {}", error.message);
            Err(Diagnostic::error(codes::NOT_MIGRATED, message)
                .at(Span::new(id, 0..0), "this file stays as it is"))
        }
    }
}

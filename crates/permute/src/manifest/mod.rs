//! `lamplight.toml`: the programs of a package and the space of each.
//!
//! ```toml
//! [program.forward]
//! wesl = "programs/forward.wesl"
//! glsl = { vertex = "programs/forward.vert.glsl", fragment = "programs/forward.frag.glsl" }
//! targets = ["spirv", "glsl330"]          # all, where it is left out
//! clip = "native"                         # the API's own clip space; "wgpu", where it is left out
//! limit = 5000                            # permutations; a million, where it is left out
//! include = ["shadow=hard,two_sided"]     # keys: wanted whatever the next two say
//! only = [{ lights = ["spot", "point"], shadow = "*" }]
//! usage = "forward.used"                  # or instead: the keys that engines asked for
//! exclude = [{ shadow = "vsm", two_sided = true }]
//!
//! [program.forward.axis]
//! lights    = { values = ["none", "spot", "point"], doc = "Kinds of light." }
//! shadow    = { values = ["none", "hard", "vsm"], default = "none" }
//! two_sided = { values = [false, true], mode = "spec" }
//!
//! [[program.forward.constraint]]
//! require = "shadow != none => lights != none"
//! doc = "A shadow needs a light."
//!
//! [features]                              # what conditions may name besides axes
//! FOG = true                              # on, unless it is turned off
//! MSAA = { doc = "Several samples.", default = false, excludes = ["WEBGL2"] }
//! WEBGL2 = false
//!
//! [glsl]                                  # as `-I` and `-D` on the command line
//! include = ["../common"]
//! define = { LIGHTS = 4 }
//! ```
//!
//! Each entry of `only` is a slice of the space, and their union is wanted: an axis has the
//! value it names, one of the values it lists, or any for `"*"`; **an axis it does not name is
//! at its default**, so that a new axis multiplies nothing until someone asks. Each entry of
//! `exclude` takes away the points that match it, **whatever the axes it does not name**. Keys
//! of `include` come back in any case, and must satisfy the constraints. With `usage`, a list that
//! a bundle's loader recorded, nothing is wanted but its keys and those of `include`.

mod axes;
mod features;
mod glsl;
mod lists;
mod names;
mod program;
mod reader;

pub use features::{Feature, Features, read_file as read_features};
pub use glsl::{GlslSettings, read_file as read_glsl};
pub use program::{Glsl, ManifestFile, Program};

use toml::de::DeTable;

use lamplight_diagnostic::source::{SourceId, SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, Severity, codes};
use reader::{Depth, ManifestReader};

/// What a manifest declares.
#[derive(Debug, Clone)]
pub struct Manifest {
    /// By name.
    pub programs: Vec<Program>,
    /// What it declares, and what the `wesl.toml` of its package does.
    pub features: Features,
    /// What files in GLSL find.
    pub glsl: GlslSettings,
    /// Lints.
    pub warnings: Vec<Diagnostic>,
}

impl Manifest {
    /// Adds features. One that the manifest already has stays as it is.
    pub fn adopt(&mut self, features: Features) {
        self.features.extend(features);
        for program in &mut self.programs {
            program.space.features = self.features.defaults().collect();
        }
    }

    /// The program of that name.
    pub fn program(&self, name: &str) -> Option<&Program> {
        self.programs.iter().find(|program| program.name == name)
    }
}

/// Reads a manifest that is in the set. Every mistake in it is reported, at its place, except
/// those that only follow from another; warnings come with errors too.
pub fn parse(sources: &SourceSet, id: SourceId) -> Result<Manifest, Diagnostics> {
    parse_to(Depth::Whole, sources, id)
}

/// As [`parse`], without the lists that decide which permutations there are, and without lints and
/// limits: for callers that choose a permutation themselves. The spaces of its programs are outlines
/// ([`Space::outline`](super::Space::outline)).
pub fn parse_outline(sources: &SourceSet, id: SourceId) -> Result<Manifest, Diagnostics> {
    parse_to(Depth::Outline, sources, id)
}

fn parse_to(depth: Depth, sources: &SourceSet, id: SourceId) -> Result<Manifest, Diagnostics> {
    let (document, errors) = DeTable::parse_recoverable(&sources.get(id).text);
    if !errors.is_empty() {
        return Err(errors.iter().map(|error| syntax_error(sources, id, error)).collect());
    }
    let mut reader = ManifestReader { depth, ..ManifestReader::new(sources, id) };
    let programs = read_programs(&mut reader, document.get_ref());
    let features = features::read_features(&mut reader, document.get_ref());
    let glsl = glsl::read_glsl(&mut reader, document.get_ref());
    let mut problems = reader.problems;
    problems.sort_by_key(|problem| problem.labels.first().map(|label| label.span));
    if problems.iter().any(|problem| problem.severity == Severity::Error) {
        return Err(problems);
    }
    let mut manifest =
        Manifest { programs, features: Features::default(), glsl, warnings: problems };
    manifest.adopt(features);
    Ok(manifest)
}

fn read_programs(reader: &mut ManifestReader, document: &DeTable) -> Vec<Program> {
    reader.check_keys(document, &["program", "features", "glsl", "format"], "a manifest");
    let Some(found) = document.get("program") else {
        if ["features", "glsl", "format"].iter().any(|key| document.contains_key(*key)) {
            return Vec::new();
        }
        let message = "the manifest declares no program";
        let start = Span::new(reader.id, 0..0);
        reader.problems.push(
            Diagnostic::error(codes::MISSING_KEY, message).at(start, "expected `[program.NAME]`"),
        );
        return Vec::new();
    };
    let Some(table) = reader.table(found, "`program`") else { return Vec::new() };
    table.iter().filter_map(|(name, value)| program::read_program(reader, name, value)).collect()
}

fn syntax_error(sources: &SourceSet, id: SourceId, error: &toml::de::Error) -> Diagnostic {
    let length = sources.get(id).text.len();
    let range = error.span().unwrap_or(0..0);
    let span = Span::new(id, range.start.min(length)..range.end.min(length));
    let message = error.message().lines().collect::<Vec<_>>().join("; ");
    Diagnostic::error(codes::MANIFEST_SYNTAX, message).at(span, "")
}

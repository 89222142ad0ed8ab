//! Writes the modules that an entry point reaches as one text, with a map back to the authors'
//! files.

pub mod glsl;
pub mod lean;
mod part;
mod plain;
pub mod project;
pub mod resolve;
mod source_map;
pub mod wesl;

pub use lean::{Leaner, lean, lean_glsl};
pub use part::{Part, PartKind};
pub use plain::parts_of_wgsl;
pub use source_map::{Segment, SourceMap};

use std::ops::Range;

use crate::resolve::Graph;
use lamplight_bundle::{Language, Stage};
use lamplight_diagnostic::source::{Embedded, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics};
use lamplight_permute::{Setting, Settings};

/// How imported items are named in the output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum Mangle {
    /// Names stay unless two collide.
    #[default]
    Collisions,
    /// The underscore-count form of the WESL specification, for every imported item.
    Underscore,
}

/// What of the root module is kept, together with all that it reaches.
#[derive(Debug, Clone, PartialEq, Eq, Default, Hash)]
pub enum Keep {
    /// Entry points of the root module; all its content where it has none.
    #[default]
    EntryPoints,
    /// The items of these names (entry points or functions).
    Items(Vec<String>),
    /// All that the root module declares, entry points or not.
    Root,
    /// Everything of every module that is reached.
    All,
}

/// How to compose.
#[derive(Debug, Clone, PartialEq, Eq, Default, Hash)]
pub struct Options {
    /// Names of imported items.
    pub mangle: Mangle,
    /// What is written.
    pub keep: Keep,
    /// The stage of a GLSL file, whatever its name says.
    pub stage: Option<Stage>,
}

/// A composed text and where each part of it came from.
#[derive(Debug, Clone)]
pub struct Composed {
    /// The language of the text.
    pub language: Language,
    /// Stage of the text as a whole: always known for GLSL, `None` for WESL.
    pub stage: Option<Stage>,
    /// The text itself.
    pub text: String,
    /// Leads from the text back to the authors' files.
    pub map: SourceMap,
    /// The declarations of the text, in its order. Beside them it has only comments and blanks.
    /// There are none for a text that was not composed, or if too many declarations share a name.
    pub parts: Vec<Part>,
    /// The settings that were asked for and their values, in the order of asking. Another
    /// permutation with the same values for these composes to the same text.
    pub reads: Vec<(String, Setting)>,
    /// Lints.
    pub warnings: Vec<Diagnostic>,
    /// For GLSL, the conditions that asked for a setting, in the order of reading. Conditions of
    /// WESL are evaluated separately.
    pub decisions: Vec<Decision>,
    /// The library that its modules may import, if it is the one that the program carries.
    pub library: Option<Embedded>,
}

impl Composed {
    /// A text that was not composed: it has no map to an author's file.
    pub fn of_text(language: Language, stage: Option<Stage>, text: String) -> Self {
        Self {
            language,
            stage,
            text,
            map: SourceMap::default(),
            parts: Vec::new(),
            reads: Vec::new(),
            warnings: Vec::new(),
            decisions: Vec::new(),
            library: None,
        }
    }

    /// The function of that name.
    pub fn function(&self, name: &str) -> Option<&Part> {
        let is_it = |part: &&Part| {
            part.kind == PartKind::Function && part.names.iter().any(|found| found == name)
        };
        self.parts.iter().find(is_it)
    }

    /// The author's first line of a declaration, comments aside.
    pub fn place_of(&self, part: &Part) -> Option<Span> {
        self.map.lookup(code_lines(&self.text, part.range.clone()).next()?)
    }
}

/// The ranges of the lines in a part that have code, without the blanks around it.
pub fn code_lines(text: &str, part: Range<usize>) -> impl Iterator<Item = Range<usize>> {
    let mut at = part.start;
    let lines = text.get(part).unwrap_or_default().split_inclusive('\n');
    lines.filter_map(move |line| {
        let code = line.split("//").next().unwrap_or_default();
        let start = at + code.len() - code.trim_start().len();
        at += line.len();
        (!code.trim().is_empty()).then(|| start..start + code.trim().len())
    })
}

/// A condition of an `#if` or `#elif`, with its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Decision {
    /// The directive's line.
    pub span: Span,
    /// What the condition gave.
    pub holds: bool,
    /// `#elif`: an earlier branch was not taken.
    pub later: bool,
}

/// Composes a graph's root for the settings. The same input always gives the same bytes.
pub fn compose(
    graph: &Graph,
    settings: &Settings,
    options: &Options,
) -> Result<Composed, Diagnostics> {
    let mut composed = match graph {
        Graph::Wesl(graph) => wesl::compose(graph, settings, options),
        Graph::Glsl(graph) => glsl::compose(graph, settings, options),
    }?;
    if !composed.map.is_empty() {
        composed.map.imports = graph.imports();
    }
    Ok(composed)
}

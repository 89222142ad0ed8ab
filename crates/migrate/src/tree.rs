//! A file as tokens, imports and choices between them.

use std::ops::Range;

use super::condition::{ShaderDefTest, ShaderDefs};
use lamplight_diagnostic::Diagnostic;

/// Bytes of the author's text.
pub type ByteRange = Range<usize>;

/// A file that was cut up.
#[derive(Debug, Default)]
pub struct Scanned {
    pub nodes: Vec<Node>,
    /// What follows the last node.
    pub tail: ByteRange,
    /// Imports that stand behind or between declarations, with the conditions around them.
    pub late: Vec<(Vec<ShaderDefTest>, ImportDirective)>,
    /// Every import, wherever it stands.
    pub imports: Vec<ImportedPath>,
    /// What `#define_import_path` says, and where.
    pub name: Option<(String, ByteRange)>,
    /// Shader defs that the file asks for.
    pub defs: ShaderDefs,
    pub notes: Vec<Diagnostic>,
}

#[derive(Debug)]
pub enum Node {
    Token(Token),
    Import(ImportDirective),
    Choice(Conditional),
    /// A directive that becomes a comment.
    Comment(DirectiveLine),
    /// A directive of which nothing remains.
    Gone(DirectiveLine),
}

/// A token and the blanks and comments before it.
#[derive(Debug, Clone)]
pub struct Token {
    pub lead: ByteRange,
    pub range: ByteRange,
    pub kind: TokenKind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TokenKind {
    Word,
    Number,
    /// `::`
    Path,
    /// `#NAME` or `#{NAME}`.
    Def,
    Mark(u8),
}

/// A directive: whole lines, with what stands before them.
#[derive(Debug, Clone)]
pub struct DirectiveLine {
    pub lead: ByteRange,
    /// From the line's first byte past its line break.
    pub range: ByteRange,
    /// The directive itself, without blanks and comments around it.
    pub words: ByteRange,
}

#[derive(Debug)]
pub struct ImportDirective {
    pub line: DirectiveLine,
    pub tree: ImportLeaf,
}

/// A part of an import: a path, and what is imported from there.
#[derive(Debug, Clone)]
pub struct ImportLeaf {
    pub path: Vec<String>,
    /// A file in quotes before the path.
    pub file: Option<String>,
    pub alias: Option<String>,
    pub children: Vec<ImportLeaf>,
    /// What stands in braces, as it was written, braces included.
    pub braces: Option<ByteRange>,
    /// Comments and blanks before it in its braces.
    pub lead: ByteRange,
    pub at: ByteRange,
}

/// An imported name with its whole path.
#[derive(Debug, Clone)]
pub struct ImportedPath {
    pub alias: String,
    pub path: Vec<String>,
    pub at: ByteRange,
}

/// `#ifdef` to `#endif`.
#[derive(Debug)]
pub struct Conditional {
    pub branches: Vec<ConditionalBranch>,
    pub end: DirectiveLine,
}

#[derive(Debug)]
pub struct ConditionalBranch {
    pub line: DirectiveLine,
    /// `None` for `#else`.
    pub condition: Option<ShaderDefTest>,
    pub nodes: Vec<Node>,
}

impl Conditional {
    /// Whether there are imports in it, and nothing that is compiled.
    pub fn is_of_imports(&self) -> bool {
        self.branches.iter().flat_map(|branch| &branch.nodes).all(|node| match node {
            Node::Token(_) => false,
            Node::Choice(choice) => choice.is_of_imports(),
            Node::Import(_) | Node::Comment(_) | Node::Gone(_) => true,
        })
    }
}

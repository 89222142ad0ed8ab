//! A file as tokens, imports and choices between them.

use std::ops::Range;

use super::condition::{Asked, Condition};
use crate::diagnostic::Diagnostic;

/// Bytes of the author's text.
pub type Bytes = Range<usize>;

/// A file that was cut up.
#[derive(Debug, Default)]
pub struct Scanned {
    pub nodes: Vec<Node>,
    /// What follows the last node.
    pub tail: Bytes,
    /// Imports that stand behind or between declarations, with the conditions around them.
    pub late: Vec<(Vec<Condition>, Import)>,
    /// Every import, wherever it stands.
    pub imports: Vec<Path>,
    /// What `#define_import_path` says, and where.
    pub name: Option<(String, Bytes)>,
    /// Shader defs that the file asks for.
    pub asked: Asked,
    pub notes: Vec<Diagnostic>,
}

#[derive(Debug)]
pub enum Node {
    Token(Token),
    Import(Import),
    Choice(Choice),
    /// A directive that becomes a comment.
    Comment(Line),
    /// A directive of which nothing remains.
    Gone(Line),
}

/// A token and the blanks and comments before it.
#[derive(Debug, Clone)]
pub struct Token {
    pub lead: Bytes,
    pub range: Bytes,
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
pub struct Line {
    pub lead: Bytes,
    /// From the line's first byte past its line break.
    pub range: Bytes,
    /// The directive itself, without blanks and comments around it.
    pub words: Bytes,
}

#[derive(Debug)]
pub struct Import {
    pub line: Line,
    pub tree: Leaf,
}

/// A part of an import: a path, and what is imported from there.
#[derive(Debug, Clone)]
pub struct Leaf {
    pub path: Vec<String>,
    /// A file in quotes before the path.
    pub file: Option<String>,
    pub alias: Option<String>,
    pub children: Vec<Leaf>,
    /// What stands in braces, as it was written, braces included.
    pub braces: Option<Bytes>,
    /// Comments and blanks before it in its braces.
    pub lead: Bytes,
    pub at: Bytes,
}

/// An imported name with its whole path.
#[derive(Debug, Clone)]
pub struct Path {
    pub alias: String,
    pub path: Vec<String>,
    pub at: Bytes,
}

/// `#ifdef` to `#endif`.
#[derive(Debug)]
pub struct Choice {
    pub branches: Vec<Branch>,
    pub end: Line,
}

#[derive(Debug)]
pub struct Branch {
    pub line: Line,
    /// `None` for `#else`.
    pub condition: Option<Condition>,
    pub nodes: Vec<Node>,
}

impl Choice {
    /// Whether there are imports in it, and nothing that is compiled.
    pub fn is_of_imports(&self) -> bool {
        self.branches.iter().flat_map(|branch| &branch.nodes).all(|node| match node {
            Node::Token(_) => false,
            Node::Choice(choice) => choice.is_of_imports(),
            Node::Import(_) | Node::Comment(_) | Node::Gone(_) => true,
        })
    }
}

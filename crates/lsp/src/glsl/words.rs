//! Words of GLSL by their place in a declaration or a statement.

/// Qualifiers: words of a declaration that are no types.
pub const QUALIFIERS: &[&str] = &[
    "attribute",
    "buffer",
    "centroid",
    "coherent",
    "const",
    "flat",
    "highp",
    "in",
    "inout",
    "invariant",
    "lowp",
    "mediump",
    "noperspective",
    "out",
    "precise",
    "readonly",
    "restrict",
    "sample",
    "shared",
    "smooth",
    "uniform",
    "varying",
    "volatile",
    "writeonly",
];

/// Words that begin a statement, before which no type can be.
pub const STATEMENTS: &[&str] = &[
    "break",
    "case",
    "continue",
    "default",
    "discard",
    "do",
    "else",
    "for",
    "if",
    "layout",
    "precision",
    "return",
    "switch",
    "while",
];

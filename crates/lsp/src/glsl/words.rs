//! Words of GLSL by their place in a declaration or a statement.

/// Qualifiers: words of a declaration that are no types.
pub const QUALIFIERS: &[&str] = &[
    "attribute",
    "const",
    "highp",
    "in",
    "inout",
    "lowp",
    "mediump",
    "out",
    "uniform",
    "varying",
    "volatile",
];

/// Qualifiers that some versions leave to authors for names. Where one is a qualifier, a word follows
/// it.
pub const YOUNG_QUALIFIERS: &[&str] = &[
    "buffer",
    "centroid",
    "coherent",
    "flat",
    "invariant",
    "noperspective",
    "patch",
    "precise",
    "readonly",
    "restrict",
    "sample",
    "shared",
    "smooth",
    "subroutine",
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

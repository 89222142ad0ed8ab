//! The words that GLSL keeps for itself: no declaration may have one as its name.

use super::Version;

/// Reserved since the first versions of GLSL and of GLSL ES.
const ALWAYS: &[&str] = &[
    "asm",
    "cast",
    "class",
    "enum",
    "extern",
    "external",
    "fixed",
    "fvec2",
    "fvec3",
    "fvec4",
    "goto",
    "half",
    "hvec2",
    "hvec3",
    "hvec4",
    "inline",
    "input",
    "interface",
    "long",
    "namespace",
    "noinline",
    "output",
    "public",
    "short",
    "sizeof",
    "static",
    "template",
    "this",
    "typedef",
    "union",
    "unsigned",
    "using",
];

/// Reserved since GLSL 1.40 and GLSL ES 3.00.
const SINCE_140: &[&str] = &["active", "common", "filter", "partition", "superp"];

/// Keywords of GLSL 4.00 and reserved words of GLSL ES 3.00.
const SINCE_400: &[&str] = &[
    "dmat2",
    "dmat3",
    "dmat4",
    "double",
    "dvec2",
    "dvec3",
    "dvec4",
    "patch",
    "precise",
    "sample",
    "subroutine",
];

/// Keywords of GLSL 4.20, and reserved words of GLSL ES 3.00.
const SINCE_420: &[&str] = &["atomic_uint", "resource"];

/// Whether a version keeps a word for itself. Words that the grammar needs are no names anyway.
pub(super) fn is_reserved(word: &str, version: Version) -> bool {
    let since = |desktop: u32| if version.es { 300 } else { desktop };
    let lists =
        [(ALWAYS, 0), (SINCE_140, since(140)), (SINCE_400, since(400)), (SINCE_420, since(420))];
    lists.iter().any(|(words, number)| version.number >= *number && words.contains(&word))
}

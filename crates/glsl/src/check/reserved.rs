//! The words that GLSL keeps for itself: no declaration may have one as its name.

use std::collections::HashMap;
use std::sync::LazyLock;

use super::Version;

/// Reserved since the first versions of GLSL and of GLSL ES.
const ALWAYS: &[&str] = &[
    "asm",
    "cast",
    "class",
    "double",
    "dvec2",
    "dvec3",
    "dvec4",
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
const SINCE_400: &[&str] =
    &["dmat2", "dmat3", "dmat4", "patch", "sample", "samplerCubeArray", "subroutine"];

/// Keywords of GLSL 4.00 and of GLSL ES 3.20, where 3.10 has extensions for it.
const PRECISE: &[&str] = &["precise"];

/// Keywords of GLSL 4.30 and of GLSL ES 3.10.
const STORAGE: &[&str] = &["buffer", "shared"];

/// A keyword since GLSL 1.20, and always of GLSL ES.
const INVARIANT: &[&str] = &["invariant"];

/// Keywords of GLSL 4.20, and reserved words of GLSL ES 3.00.
const SINCE_420: &[&str] = &["atomic_uint", "resource"];

/// Keywords of every version, and words that the first versions reserve.
const KEYWORDS: &[&str] = &[
    "attribute",
    "bool",
    "break",
    "bvec2",
    "bvec3",
    "bvec4",
    "const",
    "continue",
    "default",
    "discard",
    "do",
    "else",
    "false",
    "float",
    "for",
    "if",
    "in",
    "inout",
    "int",
    "ivec2",
    "ivec3",
    "ivec4",
    "mat2",
    "mat3",
    "mat4",
    "out",
    "return",
    "sampler1D",
    "sampler1DShadow",
    "sampler2D",
    "sampler2DRect",
    "sampler2DRectShadow",
    "sampler2DShadow",
    "sampler3D",
    "sampler3DRect",
    "samplerCube",
    "struct",
    "switch",
    "true",
    "uniform",
    "varying",
    "vec2",
    "vec3",
    "vec4",
    "void",
    "volatile",
    "while",
];

/// Keywords since GLSL 1.30, and reserved by GLSL ES 1.00 already.
const SINCE_130: &[&str] = &["flat", "highp", "lowp", "mediump", "precision"];

/// Keywords of GLSL 1.40 and of GLSL ES 3.00, or reserved by these.
const MODERN: &[&str] = &[
    "case",
    "centroid",
    "isampler1D",
    "isampler1DArray",
    "isampler2D",
    "isampler2DArray",
    "isampler2DRect",
    "isampler3D",
    "isamplerBuffer",
    "isamplerCube",
    "layout",
    "mat2x2",
    "mat2x3",
    "mat2x4",
    "mat3x2",
    "mat3x3",
    "mat3x4",
    "mat4x2",
    "mat4x3",
    "mat4x4",
    "noperspective",
    "sampler1DArray",
    "sampler1DArrayShadow",
    "sampler2DArray",
    "sampler2DArrayShadow",
    "samplerBuffer",
    "samplerCubeShadow",
    "smooth",
    "uint",
    "usampler1D",
    "usampler1DArray",
    "usampler2D",
    "usampler2DArray",
    "usampler2DRect",
    "usampler3D",
    "usamplerBuffer",
    "usamplerCube",
    "uvec2",
    "uvec3",
    "uvec4",
];

/// Keywords of GLSL 4.20, and reserved since 1.30, that begin with a letter for the kind of their
/// numbers, or with none.
const IMAGES: &[&str] =
    &["image1D", "image1DArray", "image2D", "image2DArray", "image3D", "imageBuffer", "imageCube"];

/// The same of GLSL 3.20 and 1.50.
const SAMPLES: &[&str] = &["sampler2DMS", "sampler2DMSArray"];

/// How accesses to memory are qualified, since GLSL 4.20.
const ACCESSES: &[&str] = &["coherent", "readonly", "restrict", "writeonly"];

/// Words, with the first version of GLSL and of GLSL ES that keeps them.
const LISTS: [(&[&str], [u32; 2]); 11] = [
    (ALWAYS, [0, 0]),
    (KEYWORDS, [0, 0]),
    (INVARIANT, [120, 100]),
    (SINCE_130, [130, 100]),
    (MODERN, [140, 300]),
    (SINCE_140, [140, 300]),
    (SINCE_400, [400, 300]),
    (SINCE_420, [420, 300]),
    (ACCESSES, [420, 300]),
    (PRECISE, [400, 310]),
    (STORAGE, [430, 310]),
];

/// The same of words that may begin with a letter for the kind of their numbers.
const OF_NUMBERS: [(&[&str], [u32; 2]); 2] = [(IMAGES, [130, 300]), (SAMPLES, [150, 300])];

/// The versions of all words.
static VERSIONS: LazyLock<HashMap<String, [u32; 2]>> = LazyLock::new(|| {
    let plain = LISTS
        .iter()
        .flat_map(|(words, since)| words.iter().map(move |word| ((*word).to_owned(), *since)));
    let of_numbers = OF_NUMBERS.iter().flat_map(|(words, since)| {
        let forms = |word: &&str| ["", "i", "u"].map(|letter| format!("{letter}{word}"));
        words.iter().flat_map(forms).map(move |word| (word, *since))
    });
    plain.chain(of_numbers).collect()
});

/// Whether a version keeps a word for itself: no declaration may have it as its name.
pub(super) fn is_reserved(word: &str, version: Version) -> bool {
    // A word of layouts since these versions.
    if word == "packed" {
        return version.number < if version.es { 300 } else { 140 };
    }
    VERSIONS.get(word).is_some_and(|since| version.number >= since[usize::from(version.es)])
}

#[cfg(test)]
mod tests {
    use super::{Version, is_reserved};

    #[test]
    fn words_of_versions() {
        let version = |number, es| Version { number, es, converts: false };
        for word in ["bool", "while", "input", "sampler3D"] {
            assert!(is_reserved(word, version(110, false)), "{word}");
            assert!(is_reserved(word, version(100, true)), "{word}");
        }
        for word in ["uimage2D", "isampler2DMS", "uint", "coherent", "smooth"] {
            assert!(is_reserved(word, version(300, true)), "{word}");
            assert!(is_reserved(word, version(450, false)), "{word}");
            assert!(!is_reserved(word, version(120, false)), "{word}");
        }
        for word in ["double", "dvec3"] {
            assert!(is_reserved(word, version(100, true)), "{word}");
            assert!(is_reserved(word, version(330, false)), "{word}");
        }
        for (word, number) in [("sample", 400), ("precise", 400), ("buffer", 430), ("flat", 130)] {
            assert!(is_reserved(word, version(number, false)), "{word}");
            assert!(!is_reserved(word, version(number - 10, false)), "{word}");
        }
        for (word, number) in [("sample", 300), ("precise", 310), ("buffer", 310), ("smooth", 300)]
        {
            assert!(is_reserved(word, version(number, true)), "{word}");
            assert!(
                !is_reserved(word, version(if number == 310 { 300 } else { 100 }, true)),
                "{word}"
            );
        }
        assert!(!is_reserved("invariant", version(110, false)));
        assert!(!is_reserved("image2D", version(120, false)));
        assert!(!is_reserved("colour", version(460, false)));
    }
}

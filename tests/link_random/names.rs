//! Chooses names for declarations. Many have a meaning for naga's writers, or are names that these
//! writers form themselves.

mod taken;

use std::collections::BTreeSet;

use crate::random::Random;

use taken::NAMES;

/// Words that are reserved in GLSL sources, or that naga's front end takes for reserved.
const NOT_IN_GLSL: &[&str] = &[
    "buffer",
    "subroutine",
    "attribute",
    "varying",
    "uvec2",
    "ivec3",
    "dvec2",
    "bvec4",
    "sampler2D",
    "image2D",
    "isampler2D",
    "mod",
    "textureLod",
    "texelFetch",
    "dFdx",
    "greaterThan",
    "half",
    "lessThanEqual",
    "noise1",
    "matrixCompMult",
    "outerProduct",
    "roundEven",
    "uintBitsToFloat",
    "input",
    "output",
    "union",
    "goto",
    "sizeof",
    "inline",
    "short",
    "long",
    "main",
    "double4",
    "half4",
    "texture2D",
    "texture2d",
    "type",
    "common",
    "partition",
    "active",
    "asm",
    "template",
    "this",
    "resource",
    "extern",
    "external",
    "interface",
    "fixed",
    "unsigned",
    "superp",
    "filter",
    "hvec2",
    "fvec2",
    "cast",
    "namespace",
    "using",
    "noinline",
    "public",
    "static",
    "enum",
    "typedef",
    "class",
    "precise",
    "flat",
    "smooth",
    "abs",
    "max",
    "min",
    "modf",
    "frexp",
    "clamp",
    "dot",
    "mix",
    "fract",
    "floor",
    "inversesqrt",
    "float",
    "vec2",
    "mat2",
    "vec3",
    "float2",
    "double",
];

/// Gives distinct names.
pub struct Names {
    taken: BTreeSet<String>,
    is_glsl: bool,
}

impl Names {
    pub fn new(is_glsl: bool) -> Self {
        Self { taken: BTreeSet::new(), is_glsl }
    }

    /// A name for a declaration. Three in ten are formed from one that was given before.
    pub fn declared(&mut self, random: &mut Random, used: &BTreeSet<&str>) -> String {
        loop {
            let name = self.candidate(random);
            let is_allowed = self.is_allowed(&name) && !used.contains(name.as_str());
            if is_allowed && self.taken.insert(name.clone()) {
                return name;
            }
        }
    }

    /// A name for a local variable, which may hide a declaration that is not in `used`.
    pub fn local(&self, random: &mut Random, used: &BTreeSet<String>) -> String {
        loop {
            let name = self.candidate(random);
            if self.is_allowed(&name) && !used.contains(&name) {
                return name;
            }
        }
    }

    pub fn is_declared(&self, name: &str) -> bool {
        self.taken.contains(name)
    }

    fn candidate(&self, random: &mut Random) -> String {
        let plain = (*random.pick(NAMES)).to_owned();
        if self.taken.is_empty() || !random.chance(30) {
            return plain;
        }
        let known: Vec<&String> = self.taken.iter().collect();
        let known = random.pick(&known).as_str();
        match random.below(8) {
            0 => format!("{known}_1"),
            1 => format!("{known}_"),
            2 => format!("{known}2"),
            3 => format!("Construct{known}"),
            4 => known.to_lowercase(),
            5 => format!("{known}Input"),
            6 => format!("naga_{known}"),
            _ => format!("_{known}"),
        }
    }

    /// Whether the language allows an author to use a name.
    fn is_allowed(&self, name: &str) -> bool {
        let is_plain = name.is_ascii() && !name.contains("__") && !name.starts_with("gl_");
        match self.is_glsl {
            true => is_plain && !NOT_IN_GLSL.contains(&name),
            false => !name.starts_with("__") && !naga::keywords::wgsl::RESERVED.contains(&name),
        }
    }
}

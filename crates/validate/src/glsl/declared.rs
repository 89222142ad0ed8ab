//! What a GLSL text declares at file scope, and the declarations that naga reads in another way.

use std::collections::BTreeSet;
use std::ops::Range;

use super::tokens::Tokens;
use super::{Found, construct};

/// A function with a body.
pub struct DeclaredFunction<'t> {
    pub name: &'t str,
    pub parameters: Vec<Parameter<'t>>,
    /// The braces of the body.
    pub body: Range<usize>,
}

/// A parameter of a function.
pub struct Parameter<'t> {
    pub name: &'t str,
    /// `out` or `inout`.
    pub is_output: bool,
}

/// A declaration of variables.
pub struct Declaration<'t> {
    pub is_constant: bool,
    pub variables: Vec<Variable<'t>>,
    /// The index of its `;`.
    pub end: usize,
}

/// One variable of a declaration.
pub struct Variable<'t> {
    pub name: &'t str,
    /// The index of its name.
    pub at: usize,
    /// The tokens behind its `=`.
    pub value: Option<Range<usize>>,
}

/// What stands at file scope.
#[derive(Default)]
pub struct FileScope<'t> {
    pub functions: Vec<DeclaredFunction<'t>>,
    /// Variables that are no constants and have an initial value.
    pub initialised: Vec<Variable<'t>>,
    structures: BTreeSet<&'t str>,
    variables: BTreeSet<&'t str>,
    function_names: BTreeSet<&'t str>,
}

const QUALIFIERS: &[&str] = &[
    "const",
    "in",
    "out",
    "inout",
    "uniform",
    "buffer",
    "shared",
    "flat",
    "smooth",
    "noperspective",
    "centroid",
    "sample",
    "invariant",
    "precise",
    "highp",
    "mediump",
    "lowp",
    "coherent",
    "volatile",
    "restrict",
    "readonly",
    "writeonly",
    "layout",
];

/// Texture and image types, after their first words and letters.
const DIMENSIONS: &[&str] = &["1D", "2D", "3D", "Cube", "Buffer", "2DMS", "2DRect"];

/// Whether a word is a type of GLSL itself.
fn is_built_in_type(word: &str) -> bool {
    let bare = word.trim_start_matches(['b', 'i', 'u', 'd']);
    let is_vector = |name: &str| ["vec2", "vec3", "vec4"].contains(&name);
    let is_matrix = bare
        .strip_prefix("mat")
        .is_some_and(|size| !size.is_empty() && size.bytes().all(|byte| b"234x".contains(&byte)));
    let is_scalar = ["void", "bool", "int", "uint", "float", "double"].contains(&word);
    is_scalar || is_vector(bare) || is_matrix || is_opaque(word)
}

fn is_opaque(word: &str) -> bool {
    let bare = word.strip_prefix(['i', 'u']).filter(|rest| !rest.starts_with("nt")).unwrap_or(word);
    let is_shape = |rest: &str| {
        DIMENSIONS.iter().any(|shape| {
            let after = rest.strip_prefix(shape);
            after.is_some_and(|after| ["", "Array", "Shadow", "ArrayShadow"].contains(&after))
        })
    };
    ["sampler", "samplerShadow"].contains(&word)
        || ["sampler", "texture", "image"]
            .iter()
            .any(|kind| bare.strip_prefix(kind).is_some_and(is_shape))
}

/// Whether a type is a texture and a sampler in one.
pub fn is_combined(word: &str) -> bool {
    is_opaque(word) && word.contains("sampler") && !["sampler", "samplerShadow"].contains(&word)
}

impl<'t> FileScope<'t> {
    /// Reads a whole text.
    pub fn read(tokens: &Tokens<'t>, has_stage_inputs: bool, found: &mut Found) -> Self {
        let (mut scope, mut at) = (Self::default(), 0);
        while at < tokens.len() {
            at = scope.item(tokens, at, has_stage_inputs, found);
        }
        scope
    }

    /// Whether a word names a type.
    pub fn is_type(&self, word: &str) -> bool {
        is_built_in_type(word) || self.structures.contains(word)
    }

    /// Reads the item at `at`, and returns the index behind it.
    fn item(&mut self, tokens: &Tokens<'t>, at: usize, stage: bool, found: &mut Found) -> usize {
        let qualified = skip_qualifiers(tokens, at);
        if let Some(end) = self.function(tokens, qualified, found) {
            return end;
        }
        let end = tokens.find(qualified, tokens.len(), &[";"]);
        let has = |word: &str| (at..qualified).any(|index| tokens.text(index) == word);
        let is_block = tokens.is_word(qualified) && tokens.text(qualified + 1) == "{";
        if is_block && tokens.text(qualified) != "struct" {
            self.members(tokens, qualified + 1, found);
            let (_, dimensions) = tokens.skip_dimensions(tokens.pair(qualified + 1) + 2);
            if dimensions > 0 && (has("uniform") || has("buffer")) {
                found.add(&construct::BLOCK_ARRAY, tokens.bytes(qualified, end));
            }
        }
        if has("push_constant") {
            found.add(&construct::PUSH_CONSTANT, tokens.bytes(at, qualified));
        }
        let needs_location = stage && (has("in") || has("out"));
        if needs_location && is_without_location(tokens, at..end, qualified) {
            found.add(&construct::NO_LOCATION, tokens.bytes(at, end));
        }
        if let Some(declaration) = self.declaration(tokens, at, found) {
            return self.globals(tokens, declaration, found);
        }
        end + 1
    }

    fn globals(
        &mut self,
        tokens: &Tokens<'t>,
        declaration: Declaration<'t>,
        found: &mut Found,
    ) -> usize {
        for variable in declaration.variables {
            let (name, at) = (variable.name, variable.at);
            let is_function = self.function_names.contains(name);
            let is_new = self.variables.insert(name) && !self.structures.contains(name);
            if (!is_new || is_function) && !name.starts_with("gl_") {
                found.add(&construct::DECLARED_TWICE, tokens.bytes(at, at));
            }
            if variable.value.is_some() && !declaration.is_constant {
                self.initialised.push(variable);
            }
        }
        declaration.end + 1
    }

    /// Reads a function or a prototype whose result is at `at`, and returns the index behind it.
    fn function(&mut self, tokens: &Tokens<'t>, at: usize, found: &mut Found) -> Option<usize> {
        let (named, _) = tokens.skip_dimensions(at + 1);
        let is_function =
            self.is_type(tokens.text(at)) && tokens.is_word(named) && tokens.text(named + 1) == "(";
        if !is_function {
            return None;
        }
        let mut parameters = Vec::new();
        for part in tokens.parts(named + 1) {
            let ty = skip_qualifiers(tokens, part.start);
            if is_combined(tokens.text(ty)) {
                found.add(&construct::COMBINED_SAMPLER, tokens.bytes(part.start, part.end - 1));
            }
            let (name, before) = tokens.skip_dimensions(ty + 1);
            let (_, after) = tokens.skip_dimensions(name + 1);
            if before + after > 1 {
                found.add(&construct::ARRAY_OF_ARRAYS, tokens.bytes(ty, part.end - 1));
            }
            let is_output =
                (part.start..ty).any(|index| ["out", "inout"].contains(&tokens.text(index)));
            parameters.push(Parameter { name: tokens.text(name), is_output });
        }
        let after = tokens.pair(named + 1) + 1;
        let name = tokens.text(named);
        if self.variables.contains(name) || self.structures.contains(name) {
            found.add(&construct::DECLARED_TWICE, tokens.bytes(named, named));
        }
        self.function_names.insert(name);
        if tokens.text(after) == "{" {
            let body = after..tokens.pair(after);
            self.functions.push(DeclaredFunction { name, parameters, body });
        }
        Some(tokens.pair(after) + 1)
    }

    /// Reads a declaration of variables or of a structure that begins at `at`, if one does.
    pub fn declaration(
        &mut self,
        tokens: &Tokens<'t>,
        at: usize,
        found: &mut Found,
    ) -> Option<Declaration<'t>> {
        let ty = skip_qualifiers(tokens, at);
        let mut next = ty + 1;
        if tokens.text(ty) == "struct" {
            let open = if tokens.is_word(next) { next + 1 } else { next };
            if open > next && !self.structures.insert(tokens.text(next)) {
                found.add(&construct::DECLARED_TWICE, tokens.bytes(next, next));
            }
            self.members(tokens, open, found);
            next = tokens.pair(open) + 1;
        } else if !self.is_type(tokens.text(ty)) {
            return None;
        }
        let (first, dimensions) = tokens.skip_dimensions(next);
        if !tokens.is_word(first) && (tokens.text(ty) != "struct" || tokens.text(first) != ";") {
            return None;
        }
        let has = |word: &str| (at..ty).any(|index| tokens.text(index) == word);
        if is_combined(tokens.text(ty)) && has("uniform") {
            found.add(&construct::COMBINED_SAMPLER, tokens.bytes(ty, first));
        }
        let variables = declared_variables(tokens, first, dimensions, found);
        let end = tokens.find(first, tokens.len(), &[";"]);
        Some(Declaration { is_constant: has("const"), variables, end })
    }

    /// Reads the members of a structure or a block.
    fn members(&mut self, tokens: &Tokens<'t>, open: usize, found: &mut Found) {
        let mut at = open + 1;
        while at < tokens.pair(open) {
            let member = self.declaration(tokens, at, found);
            let end = tokens.find(at, tokens.pair(open), &[";"]);
            at = member.map_or(end, |member| member.end) + 1;
        }
    }
}

fn skip_qualifiers(tokens: &Tokens<'_>, mut at: usize) -> usize {
    while QUALIFIERS.contains(&tokens.text(at)) {
        let has_arguments = tokens.text(at) == "layout" && tokens.text(at + 1) == "(";
        at = if has_arguments { tokens.pair(at + 1) + 1 } else { at + 1 };
    }
    at
}

/// The variables from the name at `at` on. `dimensions` is how many the type itself has.
fn declared_variables<'t>(
    tokens: &Tokens<'t>,
    mut at: usize,
    dimensions: usize,
    found: &mut Found,
) -> Vec<Variable<'t>> {
    let mut variables = Vec::new();
    while tokens.is_word(at) {
        let (after, own) = tokens.skip_dimensions(at + 1);
        if dimensions + own > 1 {
            found.add(&construct::ARRAY_OF_ARRAYS, tokens.bytes(at, after - 1));
        }
        let end = tokens.find(after, tokens.len(), &[",", ";"]);
        let value = (tokens.text(after) == "=").then_some(after + 1..end);
        variables.push(Variable { name: tokens.text(at), at, value });
        at = end + 1;
        if tokens.text(end) != "," {
            break;
        }
    }
    variables
}

/// Whether an input or an output has a name of its author's, and no location.
fn is_without_location(tokens: &Tokens<'_>, item: Range<usize>, ty: usize) -> bool {
    let name = tokens.skip_dimensions(ty + 1).0;
    let is_named = tokens.is_word(ty) && (tokens.is_word(name) || tokens.text(name) == "{");
    is_named
        && !tokens.text(name).starts_with("gl_")
        && !tokens.text(ty).starts_with("gl_")
        && !item.into_iter().any(|index| tokens.text(index) == "location")
}

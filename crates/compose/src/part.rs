//! The declarations of a composed text, and which of them each one names.

use std::ops::Range;

/// A declaration, a directive or an assertion of a composed text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Part {
    /// What kind of declaration it is.
    pub kind: PartKind,
    /// Names that it declares in the scope of the module: one in WGSL; in GLSL one for each
    /// declarator, or the members of a block that has no instance name.
    pub names: Vec<String>,
    /// Bytes of the composed text, comments around the declaration included.
    pub range: Range<usize>,
    /// Indices of the parts that it names, sorted, each once. In GLSL a local variable that has
    /// the name of a part counts as a use of that part.
    pub uses: Vec<u32>,
    /// Uses of type aliases: bytes of the composed text, and the alias.
    pub aliases: Vec<(Range<usize>, u32)>,
}

/// What a part is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PartKind {
    /// `enable`, `requires`, `diagnostic`; `#version`, `#extension`, `#pragma`.
    Directive,
    /// A function, entry points included.
    Function,
    /// A function that only GLSL has: a name, its parameters, and no body.
    Prototype,
    /// A structure.
    Struct,
    /// Another name of a type.
    Alias,
    /// A constant of the module.
    Constant,
    /// A variable of the module, bound ones included.
    Variable,
    /// A constant that the host may choose.
    Override,
    /// A `const_assert`.
    Assertion,
    /// What is none of these, such as a `precision` statement.
    Other,
}

//! Why a text, or one target of it, is compiled as a whole.

use serde::{Deserialize, Serialize};

/// The summary of a run reports each reason, with an example.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reason {
    /// The text was not written by the composer, so its declarations are not listed.
    NoParts,
    /// There is not exactly one entry point, or it is a compute shader.
    EntryPoint,
    Override,
    /// A storage buffer: writers pass the lengths of its arrays to the functions that need them. So
    /// the text of a function would depend on what its callees do, and not only on their names,
    /// parameters and results (the first assumption in `crates/link/src/lib.rs`).
    /// `refuse_part` in `outline.rs` finds declarations; `uses.rs` finds pointers in an address
    /// space that no stub has.
    StorageBuffer,
    /// An array of bindings: writers ask whether its index is uniform.
    BindingArray,
    /// Two functions of one name.
    Overload,
    /// A declaration that is not understood.
    Declaration,
    /// An identifier has the form of a mark.
    MarkedName,
    /// Functions call each other in a cycle, or are nested too deeply.
    Recursion,
    /// The text has very many declarations, or a function is very large or names very much:
    /// translating each by itself would take longer than the whole.
    Large,
    /// naga refused a function by itself. The text is compiled as a whole, so that naga reports
    /// why.
    Refused,
    /// A stub cannot stand for its function: for example, naga's analysis finds that it uses other
    /// variables.
    Stub,
    /// Two pointers of a call may lead to one variable. Only the whole text shows whether the
    /// function changes it, which is an error.
    Alias,
    /// A texture is sampled in a way that no stub can repeat.
    Sampling,
    /// A vertex entry point uses what only fragment shaders have: a derivative or `discard`. The
    /// text is compiled as a whole, so that naga reports the error.
    Stage,
    /// naga wrote an output in a form that this crate does not know. `cut.rs` divides an output
    /// into declarations, and finds in them the marks that stand for names. `names.rs` asks how the
    /// target spells a name. `translate.rs` and `texts.rs` write and read an entry point's native
    /// names as JSON. `pool.rs` looks for the piece of each target, which is text or SPIR-V.
    Shape,
    /// The lines before the declarations of two outputs cannot be merged.
    Header,
    /// Two functions need different declarations of one name.
    Clash,
    /// A SPIR-V module has instructions that this crate does not know.
    Spirv,
}

impl Reason {
    /// One line for the summary of a run.
    pub fn about(self) -> &'static str {
        match self {
            Self::NoParts => "the text does not come from the composer",
            Self::EntryPoint => "not one vertex or fragment entry point",
            Self::Override => "the text has overrides",
            Self::StorageBuffer => "the text has storage buffers",
            Self::BindingArray => "the text has binding arrays",
            Self::Overload => "the text has two functions of one name",
            Self::Declaration => "the text has a declaration that cannot be separated",
            Self::MarkedName => "an identifier looks like a mark of the linker",
            Self::Recursion => "functions call each other in a cycle or nest too deeply",
            Self::Large => "the text or a function is too large, or functions name too much",
            Self::Refused => "naga refuses a function by itself",
            Self::Stub => "a stub cannot stand for a function",
            Self::Alias => "two pointers of a call may lead to one variable",
            Self::Sampling => "a texture is sampled in a way that a stub cannot repeat",
            Self::Stage => "a function is not for this stage",
            Self::Shape => "an output cannot be divided into declarations",
            Self::Header => "first lines of outputs differ",
            Self::Clash => "two functions need different declarations of one name",
            Self::Spirv => "a SPIR-V module cannot be divided into functions",
        }
    }
}

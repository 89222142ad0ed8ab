//! The program that a module is lowered to: a flat list of instructions over the slots of one
//! memory.
//!
//! WGSL has no recursion, so every function's values have fixed places in that memory: calls
//! copy arguments to them, nothing is allocated, and a pointer is the number of a slot.

/// Number of a slot of the memory.
pub type Slot = u32;

pub use super::operation::{
    Binary, Compare, Convert, Geometry, Packing, Product, Ternary, Unary, Word1, Word2,
};

/// An operand: its first slot, and the distance between the slots of its components, which is 1, or
/// 0 if all components share one slot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Operand {
    pub slot: Slot,
    pub stride: u32,
}

impl Operand {
    /// The slot of component `index`.
    #[inline(always)]
    pub fn at(self, index: u32) -> usize {
        (self.slot + index * self.stride) as usize
    }
}

/// One step of the program. `n` counts components; results never overlap operands.
#[derive(Debug, Clone, Copy)]
pub enum Instruction {
    Copy {
        to: Slot,
        from: Slot,
        n: u32,
    },
    Fill {
        to: Slot,
        from: Slot,
        n: u32,
    },
    Zero {
        to: Slot,
        n: u32,
    },
    Float1 {
        op: Unary,
        n: u8,
        to: Slot,
        a: Operand,
    },
    Float2 {
        op: Binary,
        n: u8,
        to: Slot,
        a: Operand,
        b: Operand,
    },
    Float3 {
        op: Ternary,
        n: u8,
        to: Slot,
        a: Operand,
        b: Operand,
        c: Operand,
    },
    Compare {
        op: Compare,
        n: u8,
        to: Slot,
        a: Operand,
        b: Operand,
    },
    Word1 {
        op: Word1,
        n: u8,
        to: Slot,
        a: Operand,
    },
    Word2 {
        op: Word2,
        n: u8,
        to: Slot,
        a: Operand,
        b: Operand,
    },
    ExtractBits {
        signed: bool,
        n: u8,
        to: Slot,
        from: Operand,
        offset: Slot,
        count: Slot,
    },
    InsertBits {
        n: u8,
        to: Slot,
        from: Operand,
        new: Operand,
        offset: Slot,
        count: Slot,
    },
    Convert {
        op: Convert,
        n: u8,
        to: Slot,
        a: Operand,
    },
    Pack {
        op: Packing,
        to: Slot,
        from: Slot,
    },
    Select {
        n: u8,
        to: Slot,
        condition: Operand,
        accept: Operand,
        reject: Operand,
    },
    Reduce {
        all: bool,
        n: u8,
        to: Slot,
        a: Slot,
    },
    Geometry {
        op: Geometry,
        n: u8,
        to: Slot,
        a: Slot,
        b: Slot,
        c: Slot,
    },
    Product {
        op: Product,
        inner: u8,
        rows: u8,
        columns: u8,
        to: Slot,
        a: Slot,
        b: Slot,
    },
    Transpose {
        rows: u8,
        columns: u8,
        to: Slot,
        from: Slot,
    },
    /// `to = address(base) + min(index, count - 1) * size`: WGSL's clamped access.
    Index {
        to: Slot,
        base: Slot,
        index: Slot,
        size: u32,
        count: Slot,
    },
    /// Copies the component of a value at an index, which is clamped.
    Pick {
        to: Slot,
        from: Slot,
        index: Slot,
        size: u32,
        count: u32,
    },
    Load {
        to: Slot,
        pointer: Slot,
        offset: u32,
        n: u32,
    },
    Store {
        pointer: Slot,
        offset: u32,
        from: Slot,
        n: u32,
    },
    Jump {
        to: u32,
    },
    JumpUnless {
        condition: Slot,
        to: u32,
    },
    Switch {
        selector: Slot,
        table: u32,
    },
    Call {
        to: u32,
    },
    Return,
    /// A loop begins another iteration.
    Trip,
    /// A block that coverage counts begins.
    Mark {
        point: u32,
    },
    Kill,
    Derivative {
        axis: DerivativeDirection,
        coarse: bool,
        n: u8,
        to: Slot,
        a: Operand,
    },
    /// An access to a texture, by its index in `Program::images`.
    Image {
        access: u32,
    },
    /// Waits for the other invocations of the workgroup.
    Barrier,
}

impl Instruction {
    /// How many steps the instruction counts as against the limit. Long copies count as more than
    /// one.
    #[inline(always)]
    pub fn steps(&self) -> u64 {
        match *self {
            Self::Copy { n, .. }
            | Self::Fill { n, .. }
            | Self::Zero { n, .. }
            | Self::Load { n, .. }
            | Self::Store { n, .. }
            | Self::Pick { size: n, .. } => 1 + u64::from(n >> 3),
            _ => 1,
        }
    }

    /// Copies a value so that each component has a slot of its own.
    pub fn spread(to: Slot, from: Operand, n: u32) -> Self {
        match from.stride {
            0 => Self::Fill { to, from: from.slot, n },
            _ => Self::Copy { to, from: from.slot, n },
        }
    }
}

/// Direction of a derivative. `Width` is that of `fwidth`: the sum of both magnitudes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DerivativeDirection {
    X,
    Y,
    Width,
}

/// The jump targets of a `switch`: each case's value with its instruction.
#[derive(Debug, Clone, Default)]
pub struct JumpTable {
    pub cases: Vec<(u32, u32)>,
    pub default: u32,
}

/// How the level of detail of a sample is chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lod {
    Auto,
    Zero,
    Exact(Slot),
    Bias(Slot),
    Gradient(Slot, Slot),
}

/// What an access asks of a texture.
#[derive(Debug, Clone, Copy)]
pub enum TextureOp {
    Sample {
        sampler: Slot,
        gather: Option<u8>,
        level: Lod,
        offset: Option<Slot>,
        reference: Option<Slot>,
        clamp_to_edge: bool,
    },
    Load {
        level: Option<Slot>,
    },
    Size {
        level: Option<Slot>,
    },
    Levels,
    Layers,
    Samples,
}

/// An access to a texture. The components of each operand are in consecutive slots.
#[derive(Debug, Clone, Copy)]
pub struct Access {
    pub image: Slot,
    pub coordinate: Slot,
    pub dimensions: u8,
    pub layer: Option<Slot>,
    pub ask: TextureOp,
    pub to: Slot,
    /// Components of the result, which are words if `words` is set.
    pub n: u8,
    pub words: bool,
    pub depth: bool,
}

impl Access {
    /// Whether the level depends on how the coordinates differ between neighbouring fragments.
    pub fn implicit(&self) -> bool {
        matches!(self.ask, TextureOp::Sample { level: Lod::Auto | Lod::Bias(_), gather: None, .. })
    }
}

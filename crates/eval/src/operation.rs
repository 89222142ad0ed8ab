//! What instructions compute: the operations on numbers, words, vectors and matrices.

/// Float functions of one argument.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unary {
    Negate,
    Abs,
    Saturate,
    Cos,
    Cosh,
    Sin,
    Sinh,
    Tan,
    Tanh,
    Acos,
    Asin,
    Atan,
    Asinh,
    Acosh,
    Atanh,
    Radians,
    Degrees,
    Ceil,
    Floor,
    Round,
    Fract,
    Trunc,
    Exp,
    Exp2,
    Log,
    Log2,
    Sign,
    Sqrt,
    InverseSqrt,
    Quantize,
}

/// Float functions of two arguments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    Min,
    Max,
    Atan2,
    Pow,
    Step,
}

/// Float functions of three arguments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ternary {
    Clamp,
    Fma,
    Mix,
    SmoothStep,
}

/// Comparisons of floats. In a comparison sampler, the left side is the reference, and the right
/// side is the stored depth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Compare {
    /// `reference == stored`
    Equal,
    /// `reference != stored`
    NotEqual,
    /// `reference < stored`
    Less,
    /// `reference <= stored`
    LessEqual,
    /// `reference > stored`
    Greater,
    /// `reference >= stored`
    GreaterEqual,
}

impl Compare {
    /// The name in a case file, and the function.
    pub const NAMES: &'static [(&'static str, Self)] = &[
        ("less", Self::Less),
        ("less_equal", Self::LessEqual),
        ("greater", Self::Greater),
        ("greater_equal", Self::GreaterEqual),
        ("equal", Self::Equal),
        ("not_equal", Self::NotEqual),
    ];

    /// Whether the reference passes against the stored depth.
    pub fn passes(self, reference: f64, stored: f64) -> bool {
        match self {
            Self::Less => reference < stored,
            Self::LessEqual => reference <= stored,
            Self::Greater => reference > stored,
            Self::GreaterEqual => reference >= stored,
            Self::Equal => reference == stored,
            Self::NotEqual => reference != stored,
        }
    }
}

/// Functions of one 32-bit word: integers and booleans (0 or 1).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Word1 {
    Negate,
    Not,
    LogicalNot,
    Abs,
    Sign,
    TrailingZeros,
    LeadingZeros,
    CountOnes,
    Reverse,
    FirstTrailing,
    FirstLeadingSigned,
    FirstLeading,
    Truth,
}

/// Functions of two words. `S` and `U` forms read them as signed and unsigned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Word2 {
    Add,
    Subtract,
    Multiply,
    DivideS,
    DivideU,
    RemainderS,
    RemainderU,
    And,
    Or,
    Xor,
    ShiftLeft,
    ShiftRightS,
    ShiftRightU,
    Equal,
    NotEqual,
    LessS,
    LessU,
    LessEqualS,
    LessEqualU,
    MinS,
    MinU,
    MaxS,
    MaxU,
    DotBytesS,
    DotBytesU,
}

/// Conversions between floats and words, and tests of floats.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Convert {
    FloatFromS,
    FloatFromU,
    SFromFloat,
    UFromFloat,
    BoolFromFloat,
    FloatFromBits,
    BitsFromFloat,
    IsNan,
    IsInf,
}

/// Functions of whole vectors and matrices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Geometry {
    Dot,
    DotWord,
    Cross,
    Distance,
    Length,
    Normalize,
    FaceForward,
    Reflect,
    Refract,
    Determinant,
    Inverse,
    Modf,
    Frexp,
    Ldexp,
}

/// Functions between vectors and packed words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Packing {
    Pack4Snorm8,
    Pack4Unorm8,
    Pack2Snorm16,
    Pack2Unorm16,
    Pack2Half,
    Pack4,
    PackClampS,
    PackClampU,
    Unpack4Snorm8,
    Unpack4Unorm8,
    Unpack2Snorm16,
    Unpack2Unorm16,
    Unpack2Half,
    Unpack4S,
    Unpack4U,
}

/// Products of matrices and vectors. Matrices are stored column by column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Product {
    MatrixVector,
    VectorMatrix,
    MatrixMatrix,
    Outer,
}

//! Functions of numbers, with their signatures.
//!
//! A signature is `RESULT=PARAMETER,...`. `f i u b` are numbers. `F I U B` are numbers or vectors
//! of the same size everywhere in the signature, `v w x y` the same without single numbers. A digit
//! makes a vector of that size. `M` is a matrix and `m` a square one. `>` is before an `out`
//! parameter.

use crate::tree::Dir;
use crate::types::{Scalar, Type};

/// A function of the language.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Function {
    /// Its name.
    pub name: &'static str,
    /// Its signatures, separated by blanks.
    signatures: &'static str,
    /// In which stages it may be called: all if empty, else the fragment stage.
    pub fragment_only: bool,
}

const fn all(name: &'static str, signatures: &'static str) -> Function {
    Function { name, signatures, fragment_only: false }
}

const fn fragment(name: &'static str, signatures: &'static str) -> Function {
    Function { name, signatures, fragment_only: true }
}

/// All of them but those of textures, images and atomics.
const FUNCTIONS: &[Function] = &[
    all("radians", "F=F"),
    all("degrees", "F=F"),
    all("sin", "F=F"),
    all("cos", "F=F"),
    all("tan", "F=F"),
    all("asin", "F=F"),
    all("acos", "F=F"),
    all("atan", "F=F,F F=F"),
    all("sinh", "F=F"),
    all("cosh", "F=F"),
    all("tanh", "F=F"),
    all("asinh", "F=F"),
    all("acosh", "F=F"),
    all("atanh", "F=F"),
    all("pow", "F=F,F"),
    all("exp", "F=F"),
    all("log", "F=F"),
    all("exp2", "F=F"),
    all("log2", "F=F"),
    all("sqrt", "F=F"),
    all("inversesqrt", "F=F"),
    all("abs", "F=F I=I"),
    all("sign", "F=F I=I"),
    all("floor", "F=F"),
    all("trunc", "F=F"),
    all("round", "F=F"),
    all("roundEven", "F=F"),
    all("ceil", "F=F"),
    all("fract", "F=F"),
    all("mod", "F=F,F F=F,f"),
    all("modf", "F=F,>F"),
    all("min", "F=F,F F=F,f I=I,I I=I,i U=U,U U=U,u"),
    all("max", "F=F,F F=F,f I=I,I I=I,i U=U,U U=U,u"),
    all("clamp", "F=F,F,F F=F,f,f I=I,I,I I=I,i,i U=U,U,U U=U,u,u"),
    all("mix", "F=F,F,F F=F,F,f F=F,F,B I=I,I,B U=U,U,B B=B,B,B"),
    all("step", "F=F,F F=f,F"),
    all("smoothstep", "F=F,F,F F=f,f,F"),
    all("isnan", "B=F"),
    all("isinf", "B=F"),
    all("floatBitsToInt", "I=F"),
    all("floatBitsToUint", "U=F"),
    all("intBitsToFloat", "F=I"),
    all("uintBitsToFloat", "F=U"),
    all("fma", "F=F,F,F"),
    all("frexp", "F=F,>I"),
    all("ldexp", "F=F,I"),
    all("packUnorm2x16", "u=f2"),
    all("packSnorm2x16", "u=f2"),
    all("packUnorm4x8", "u=f4"),
    all("packSnorm4x8", "u=f4"),
    all("unpackUnorm2x16", "f2=u"),
    all("unpackSnorm2x16", "f2=u"),
    all("unpackUnorm4x8", "f4=u"),
    all("unpackSnorm4x8", "f4=u"),
    all("packHalf2x16", "u=f2"),
    all("unpackHalf2x16", "f2=u"),
    all("length", "f=F"),
    all("distance", "f=F,F"),
    all("dot", "f=F,F"),
    all("cross", "f3=f3,f3"),
    all("normalize", "F=F"),
    all("faceforward", "F=F,F,F"),
    all("reflect", "F=F,F"),
    all("refract", "F=F,F,f"),
    all("matrixCompMult", "M=M,M"),
    all("determinant", "f=m"),
    all("inverse", "m=m"),
    all("lessThan", "y=v,v y=w,w y=x,x"),
    all("lessThanEqual", "y=v,v y=w,w y=x,x"),
    all("greaterThan", "y=v,v y=w,w y=x,x"),
    all("greaterThanEqual", "y=v,v y=w,w y=x,x"),
    all("equal", "y=v,v y=w,w y=x,x y=y,y"),
    all("notEqual", "y=v,v y=w,w y=x,x y=y,y"),
    all("any", "b=y"),
    all("all", "b=y"),
    all("not", "y=y"),
    all("uaddCarry", "U=U,U,>U"),
    all("usubBorrow", "U=U,U,>U"),
    all("bitfieldExtract", "I=I,i,i U=U,i,i"),
    all("bitfieldInsert", "I=I,I,i,i U=U,U,i,i"),
    all("bitfieldReverse", "I=I U=U"),
    all("bitCount", "I=I I=U"),
    all("findLSB", "I=I I=U"),
    all("findMSB", "I=I I=U"),
    fragment("dFdx", "F=F"),
    fragment("dFdy", "F=F"),
    fragment("fwidth", "F=F"),
    fragment("dFdxFine", "F=F"),
    fragment("dFdyFine", "F=F"),
    fragment("fwidthFine", "F=F"),
    fragment("dFdxCoarse", "F=F"),
    fragment("dFdyCoarse", "F=F"),
    fragment("fwidthCoarse", "F=F"),
];

/// Functions without a result: each is a barrier.
pub const BARRIERS: &[&str] = &[
    "barrier",
    "memoryBarrier",
    "memoryBarrierAtomicCounter",
    "memoryBarrierBuffer",
    "memoryBarrierShared",
    "memoryBarrierImage",
    "groupMemoryBarrier",
];

/// Functions of memory that several invocations write at once.
pub const ATOMICS: &[&str] = &[
    "atomicAdd",
    "atomicMin",
    "atomicMax",
    "atomicAnd",
    "atomicOr",
    "atomicXor",
    "atomicExchange",
    "atomicCompSwap",
];

/// Functions that are known and for which WGSL has nothing.
pub const REFUSED: &[&str] = &[
    "umulExtended",
    "imulExtended",
    "interpolateAtCentroid",
    "interpolateAtSample",
    "interpolateAtOffset",
    "noise1",
    "noise2",
    "noise3",
    "noise4",
    "ftransform",
    "packDouble2x32",
    "unpackDouble2x32",
    "EmitVertex",
    "EndPrimitive",
    "allInvocations",
    "anyInvocation",
    "allInvocationsEqual",
    "debugPrintfEXT",
    "imageAtomicAdd",
    "imageAtomicMin",
    "imageAtomicMax",
    "imageAtomicAnd",
    "imageAtomicOr",
    "imageAtomicXor",
    "imageAtomicExchange",
    "imageAtomicCompSwap",
];

/// The function of that name.
pub fn find_function(name: &str) -> Option<&'static Function> {
    FUNCTIONS.iter().find(|function| function.name == name)
}

/// A signature for one size of its vectors.
#[derive(Debug, Clone)]
pub struct Signature {
    /// What it returns.
    pub ret: Type,
    /// Its parameters.
    pub params: Vec<(Dir, Type)>,
}

impl Function {
    /// All signatures with that many parameters.
    pub fn signatures(&self, count: usize) -> Vec<Signature> {
        let mut list = Vec::new();
        for text in self.signatures.split(' ') {
            let Some((ret, params)) = text.split_once('=') else { continue };
            if params.split(',').count() != count {
                continue;
            }
            for shape in shapes(text) {
                list.push(Signature {
                    ret: type_of(ret, shape).1,
                    params: params.split(',').map(|param| type_of(param, shape)).collect(),
                });
            }
        }
        list
    }
}

/// The sizes that the letters of a signature stand for: columns and rows of a matrix, or the rows of
/// a vector.
fn shapes(text: &str) -> Vec<(u8, u8)> {
    let square = [2, 3, 4].map(|size| (size, size));
    let has = |letters: &str| text.chars().any(|letter| letters.contains(letter));
    if has("M") {
        (2..=4).flat_map(|columns| (2..=4).map(move |rows| (columns, rows))).collect()
    } else if has("m") || has("vwxy") {
        square.to_vec()
    } else if has("FIUB") {
        (1..=4).map(|size| (1, size)).collect()
    } else {
        vec![(1, 1)]
    }
}

fn type_of(text: &str, (columns, rows): (u8, u8)) -> (Dir, Type) {
    let (dir, text) = match text.strip_prefix('>') {
        Some(rest) => (Dir::Out, rest),
        None => (Dir::In, text),
    };
    let bytes = text.as_bytes();
    let size = bytes.get(1).map(|digit| digit - b'0');
    let scalar = match bytes.first() {
        Some(b'i' | b'I' | b'w') => Scalar::Int,
        Some(b'u' | b'U' | b'x') => Scalar::Uint,
        Some(b'b' | b'B' | b'y') => Scalar::Bool,
        _ => Scalar::Float,
    };
    let ty = match bytes.first() {
        Some(b'M' | b'm') => Type::Matrix(Scalar::Float, columns, rows),
        Some(letter) if letter.is_ascii_uppercase() || b"vwxy".contains(letter) => {
            Type::vector(scalar, rows)
        }
        _ => Type::vector(scalar, size.unwrap_or(1)),
    };
    (dir, ty)
}

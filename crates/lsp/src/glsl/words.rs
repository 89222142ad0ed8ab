//! Words that any version of GLSL reserves or gives a meaning.

/// Qualifiers: words of a declaration that are no types.
pub const QUALIFIERS: &[&str] = &[
    "attribute",
    "buffer",
    "centroid",
    "coherent",
    "const",
    "flat",
    "highp",
    "in",
    "inout",
    "invariant",
    "lowp",
    "mediump",
    "noperspective",
    "out",
    "precise",
    "readonly",
    "restrict",
    "sample",
    "shared",
    "smooth",
    "uniform",
    "varying",
    "volatile",
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

/// Keywords, words reserved for later, and functions (The OpenGL Shading Language 4.60, sections
/// 3.6 and 8; the OpenGL ES Shading Language 3.20). Types with a number of parts are in
/// [`is_type`].
const WORDS: &str = "\
    EmitStreamVertex EmitVertex EndPrimitive EndStreamPrimitive abs acos acosh active all \
    allInvocations allInvocationsEqual any anyInvocation asin asinh asm atan atanh atomicAdd \
    atomicAnd atomicCompSwap atomicCounter atomicCounterAdd atomicCounterAnd \
    atomicCounterCompSwap atomicCounterDecrement atomicCounterExchange atomicCounterIncrement \
    atomicCounterMax atomicCounterMin atomicCounterOr atomicCounterSubtract atomicCounterXor \
    atomicExchange atomicMax atomicMin atomicOr atomicXor atomic_uint attribute barrier bitCount \
    bitfieldExtract bitfieldInsert bitfieldReverse bool break buffer case cast ceil centroid \
    clamp class coherent common const continue cos cosh cross dFdx dFdxCoarse dFdxFine dFdy \
    dFdyCoarse dFdyFine default degrees determinant discard distance do dot double else enum \
    equal exp exp2 extern external faceforward false filter findLSB findMSB fixed flat float \
    floatBitsToInt floatBitsToUint floor fma for fract frexp ftransform fvec2 fvec3 fvec4 fwidth \
    fwidthCoarse fwidthFine goto greaterThan greaterThanEqual groupMemoryBarrier half highp \
    hvec2 hvec3 hvec4 if imageAtomicAdd imageAtomicAnd imageAtomicCompSwap imageAtomicExchange \
    imageAtomicMax imageAtomicMin imageAtomicOr imageAtomicXor imageLoad imageSamples imageSize \
    imageStore imulExtended in inline inout input int intBitsToFloat interface \
    interpolateAtCentroid interpolateAtOffset interpolateAtSample invariant inverse inversesqrt \
    isinf isnan isubpassInput isubpassInputMS layout ldexp length lessThan lessThanEqual log \
    log2 long lowp matrixCompMult max mediump memoryBarrier memoryBarrierAtomicCounter \
    memoryBarrierBuffer memoryBarrierImage memoryBarrierShared min mix mod modf namespace \
    noinline noise1 noise2 noise3 noise4 noperspective normalize not notEqual out outerProduct \
    output packDouble2x32 packHalf2x16 packSnorm2x16 packSnorm4x8 packUnorm2x16 packUnorm4x8 \
    packed partition patch pow precise precision public radians readonly reflect refract \
    resource restrict return round roundEven row_major sample shadow1D shadow1DLod shadow1DProj \
    shadow1DProjLod shadow2D shadow2DLod shadow2DProj shadow2DProjLod shared short sign sin sinh \
    sizeof smooth smoothstep sqrt static step struct subpassInput subpassInputMS subpassLoad \
    subroutine superp switch tan tanh template texelFetch texelFetchOffset texture1DLod \
    texture1DProj texture1DProjLod texture2DLod texture2DProj texture2DProjLod texture3DLod \
    texture3DProj texture3DProjLod textureCubeLod textureGather textureGatherOffset \
    textureGatherOffsets textureGrad textureGradOffset textureLod textureLodOffset textureOffset \
    textureProj textureProjGrad textureProjGradOffset textureProjLod textureProjLodOffset \
    textureProjOffset textureQueryLevels textureQueryLod textureSamples textureSize this \
    transpose true trunc typedef uaddCarry uint uintBitsToFloat umulExtended uniform union \
    unpackDouble2x32 unpackHalf2x16 unpackSnorm2x16 unpackSnorm4x8 unpackUnorm2x16 \
    unpackUnorm4x8 unsigned using usubBorrow usubpassInput usubpassInputMS varying void volatile \
    while writeonly";

/// The dimensions in the names of image and sampler types.
const SHAPES: [&str; 6] = ["", "1D", "2D", "3D", "Cube", "Buffer"];

/// How the names of image and sampler types end.
const ENDINGS: [&str; 8] =
    ["", "Rect", "MS", "Array", "Shadow", "MSArray", "ArrayShadow", "RectShadow"];

/// Whether no declaration may have the word as its name.
pub fn is_reserved(word: &str) -> bool {
    let is_kept = word.starts_with("gl_") || word.contains("__") || word == "main";
    is_kept || is_type(word) || WORDS.split_whitespace().any(|known| known == word)
}

/// Vectors, matrices, images and samplers.
fn is_type(word: &str) -> bool {
    let sizes = |text: &str| match text.as_bytes() {
        [rows] => (b'2'..=b'4').contains(rows),
        [columns, b'x', rows] => [columns, rows].iter().all(|size| (b'2'..=b'4').contains(size)),
        _ => false,
    };
    let vector = word.trim_start_matches(['b', 'd', 'i', 'u']).strip_prefix("vec");
    let matrix = word.trim_start_matches('d').strip_prefix("mat");
    if vector.is_some_and(|size| size.len() == 1 && sizes(size)) || matrix.is_some_and(sizes) {
        return true;
    }
    let plain = word.strip_prefix(['i', 'u']).filter(|rest| !rest.starts_with("mage"));
    let plain = plain.unwrap_or(word);
    let of = ["sampler", "image", "texture"].iter().find_map(|kind| plain.strip_prefix(kind));
    let is_shape = |rest: &str| {
        SHAPES.iter().filter_map(|shape| rest.strip_prefix(shape)).any(|end| ENDINGS.contains(&end))
    };
    of.is_some_and(is_shape)
}

//! Words that any version of GLSL reserves or gives a meaning.

/// Keywords and words reserved for later (The OpenGL Shading Language 4.60, section 3.6; the OpenGL ES
/// Shading Language 3.20). Types with a number of parts are in [`is_type`].
const KEYWORDS: &str = "\
    active asm atomic_uint attribute bool break buffer case cast centroid class coherent common \
    const continue default discard do double else enum extern external false filter fixed flat \
    float for fvec2 fvec3 fvec4 goto half highp hvec2 hvec3 hvec4 if in inline inout input int \
    interface invariant isubpassInput isubpassInputMS layout long lowp mediump namespace \
    noinline noperspective out output packed partition patch precise precision public readonly \
    resource restrict return row_major sample shared short sizeof smooth static struct \
    subpassInput subpassInputMS subroutine superp switch template this true typedef uint uniform \
    union unsigned using usubpassInput usubpassInputMS varying void volatile while writeonly";

/// Functions of the language (section 8).
const FUNCTIONS: &str = "\
    EmitStreamVertex EmitVertex EndPrimitive EndStreamPrimitive abs acos acosh all \
    allInvocations allInvocationsEqual any anyInvocation asin asinh atan atanh atomicAdd \
    atomicAnd atomicCompSwap atomicCounter atomicCounterAdd atomicCounterAnd \
    atomicCounterCompSwap atomicCounterDecrement atomicCounterExchange atomicCounterIncrement \
    atomicCounterMax atomicCounterMin atomicCounterOr atomicCounterSubtract atomicCounterXor \
    atomicExchange atomicMax atomicMin atomicOr atomicXor barrier bitCount bitfieldExtract \
    bitfieldInsert bitfieldReverse ceil clamp cos cosh cross dFdx dFdxCoarse dFdxFine dFdy \
    dFdyCoarse dFdyFine degrees determinant distance dot equal exp exp2 faceforward findLSB \
    findMSB floatBitsToInt floatBitsToUint floor fma fract frexp ftransform fwidth fwidthCoarse \
    fwidthFine greaterThan greaterThanEqual groupMemoryBarrier imageAtomicAdd imageAtomicAnd \
    imageAtomicCompSwap imageAtomicExchange imageAtomicMax imageAtomicMin imageAtomicOr \
    imageAtomicXor imageLoad imageSamples imageSize imageStore imulExtended intBitsToFloat \
    interpolateAtCentroid interpolateAtOffset interpolateAtSample inverse inversesqrt isinf \
    isnan ldexp length lessThan lessThanEqual log log2 matrixCompMult max memoryBarrier \
    memoryBarrierAtomicCounter memoryBarrierBuffer memoryBarrierImage memoryBarrierShared min \
    mix mod modf noise1 noise2 noise3 noise4 normalize not notEqual outerProduct packDouble2x32 \
    packHalf2x16 packSnorm2x16 packSnorm4x8 packUnorm2x16 packUnorm4x8 pow radians reflect \
    refract round roundEven shadow1D shadow1DLod shadow1DProj shadow1DProjLod shadow2D \
    shadow2DLod shadow2DProj shadow2DProjLod sign sin sinh smoothstep sqrt step subpassLoad tan \
    tanh texelFetch texelFetchOffset texture1DLod texture1DProj texture1DProjLod texture2DLod \
    texture2DProj texture2DProjLod texture3DLod texture3DProj texture3DProjLod textureCubeLod \
    textureGather textureGatherOffset textureGatherOffsets textureGrad textureGradOffset \
    textureLod textureLodOffset textureOffset textureProj textureProjGrad textureProjGradOffset \
    textureProjLod textureProjLodOffset textureProjOffset textureQueryLevels textureQueryLod \
    textureSamples textureSize transpose trunc uaddCarry uintBitsToFloat umulExtended \
    unpackDouble2x32 unpackHalf2x16 unpackSnorm2x16 unpackSnorm4x8 unpackUnorm2x16 \
    unpackUnorm4x8 usubBorrow";

/// The dimensions in the names of image and sampler types.
const SHAPES: [&str; 6] = ["", "1D", "2D", "3D", "Cube", "Buffer"];

/// How the names of image and sampler types end.
const ENDINGS: [&str; 8] =
    ["", "Rect", "MS", "Array", "Shadow", "MSArray", "ArrayShadow", "RectShadow"];

/// Whether no global declaration may have the word as its name.
pub fn is_reserved(word: &str) -> bool {
    is_keyword(word) || is_function(word) || word == "main"
}

/// Keywords, words reserved for later, and types: nothing can have such a name.
pub fn is_keyword(word: &str) -> bool {
    let is_kept = word.starts_with("gl_") || word.contains("__");
    is_kept || is_type(word) || KEYWORDS.split_whitespace().any(|known| known == word)
}

/// Whether a version of the language has a function of the name.
pub fn is_function(word: &str) -> bool {
    FUNCTIONS.split_whitespace().any(|known| known == word)
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

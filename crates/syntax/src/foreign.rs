//! Names of other shading languages, with what WGSL and GLSL have in their place.

/// A name, and what is written instead of it in WGSL and in GLSL: code, or words with code in
/// backticks. A text is empty where the language has the name itself.
pub type Foreign = (&'static str, &'static str, &'static str);

/// Sorted by name. Types of HLSL that end in a number are in [`sized`].
const FOREIGN: &[Foreign] = &[
    ("asfloat", "bitcast<f32>(x)", "uintBitsToFloat(x)"),
    ("asint", "bitcast<i32>(x)", "floatBitsToInt(x)"),
    ("asuint", "bitcast<u32>(x)", "floatBitsToUint(x)"),
    ("atan2", "", "atan(y, x)"),
    ("attribute", "a parameter of the entry point with `@location(0)`", "in"),
    ("bitCount", "countOneBits(x)", ""),
    ("clip", "if (x < 0.0) { discard; }", "if (x < 0.0) { discard; }"),
    ("countbits", "countOneBits(x)", "bitCount(x)"),
    ("countOneBits", "", "bitCount(x)"),
    ("ddx", "dpdx(x)", "dFdx(x)"),
    ("ddy", "dpdy(x)", "dFdy(x)"),
    ("dFdx", "dpdx(x)", ""),
    ("dFdy", "dpdy(x)", ""),
    ("double", "`f32`: WGSL has no 64-bit floats", ""),
    ("dpdx", "", "dFdx(x)"),
    ("dpdy", "", "dFdy(x)"),
    ("equal", "a == b", ""),
    ("f16tof32", "unpack2x16float(x).x", "unpackHalf2x16(x).x"),
    ("f32", "", "float"),
    ("f32tof16", "pack2x16float(vec2f(x, 0.0))", "packHalf2x16(vec2(x, 0.0))"),
    ("faceforward", "faceForward(n, i, ng)", ""),
    ("float", "f32", ""),
    ("floatBitsToInt", "bitcast<i32>(x)", ""),
    ("floatBitsToUint", "bitcast<u32>(x)", ""),
    ("fmod", "x % y", "x - y * trunc(x / y)"),
    ("frac", "fract(x)", "fract(x)"),
    (
        "gl_FragColor",
        "the result of the entry point with `@location(0)`",
        "layout(location = 0) out vec4 color;",
    ),
    ("gl_FragCoord", "a parameter with `@builtin(position)`", ""),
    ("gl_FragDepth", "a result with `@builtin(frag_depth)`", ""),
    ("gl_FrontFacing", "a parameter with `@builtin(front_facing)`", ""),
    ("gl_InstanceID", "a parameter with `@builtin(instance_index)`", "gl_InstanceIndex"),
    ("gl_InstanceIndex", "a parameter with `@builtin(instance_index)`", ""),
    ("gl_Position", "the result with `@builtin(position)`", ""),
    ("gl_VertexID", "a parameter with `@builtin(vertex_index)`", "gl_VertexIndex"),
    ("gl_VertexIndex", "a parameter with `@builtin(vertex_index)`", ""),
    ("greaterThan", "a > b", ""),
    ("half", "`f16`, with `enable f16;`", "float"),
    ("i32", "", "int"),
    ("int", "i32", ""),
    ("intBitsToFloat", "bitcast<f32>(x)", ""),
    ("inverseSqrt", "", "inversesqrt(x)"),
    ("inversesqrt", "inverseSqrt(x)", ""),
    ("lerp", "mix(a, b, t)", "mix(a, b, t)"),
    ("lessThan", "a < b", ""),
    ("mad", "fma(a, b, c)", "fma(a, b, c)"),
    ("mat2", "mat2x2f", ""),
    ("mat3", "mat3x3f", ""),
    ("mat4", "mat4x4f", ""),
    ("mod", "x - y * floor(x / y)", ""),
    ("mul", "a * b", "a * b"),
    ("notEqual", "a != b", ""),
    ("roundEven", "round(x)", ""),
    ("rsqrt", "inverseSqrt(x)", "inversesqrt(x)"),
    ("sampler2D", "`texture_2d<f32>` and a `sampler`", ""),
    ("samplerCube", "`texture_cube<f32>` and a `sampler`", ""),
    ("saturate", "", "clamp(x, 0.0, 1.0)"),
    ("select", "", "condition ? a : b"),
    ("sincos", "`sin(x)` and `cos(x)`", "`sin(x)` and `cos(x)`"),
    ("tex2D", "textureSample(t, s, uv)", "texture(t, uv)"),
    ("tex2Dlod", "textureSampleLevel(t, s, uv, level)", "textureLod(t, uv, level)"),
    ("texCUBE", "textureSample(t, s, direction)", "texture(t, direction)"),
    ("texelFetch", "textureLoad(t, texel, level)", ""),
    ("texture", "textureSample(t, s, uv)", ""),
    ("texture2D", "textureSample(t, s, uv)", "texture(t, uv)"),
    ("textureCube", "textureSample(t, s, direction)", "texture(t, direction)"),
    ("textureDimensions", "", "textureSize(t, level)"),
    ("textureGrad", "textureSampleGrad(t, s, uv, ddx, ddy)", ""),
    ("textureLoad", "", "texelFetch(t, texel, level)"),
    ("textureLod", "textureSampleLevel(t, s, uv, level)", ""),
    ("textureSample", "", "texture(t, uv)"),
    ("textureSampleGrad", "", "textureGrad(t, uv, ddx, ddy)"),
    ("textureSampleLevel", "", "textureLod(t, uv, level)"),
    ("textureSize", "textureDimensions(t, level)", ""),
    ("u32", "", "uint"),
    ("uint", "u32", ""),
    ("uintBitsToFloat", "bitcast<f32>(x)", ""),
    (
        "varying",
        "a result and a parameter with the same `@location`",
        "`out` in the vertex stage, `in` in the fragment stage",
    ),
];

/// All names, each with what WGSL and GLSL have in its place.
pub fn names() -> &'static [Foreign] {
    FOREIGN
}

/// What a name of another language is called in WGSL.
pub fn wgsl_text(name: &str) -> Option<String> {
    let listed = FOREIGN.iter().find(|(foreign, ..)| *foreign == name);
    let text = listed.map(|(_, wgsl, _)| (*wgsl).to_owned());
    text.or_else(|| sized(Side::Wgsl, name)).filter(|text| !text.is_empty())
}

/// What a name of another language is called in GLSL.
pub fn glsl_text(name: &str) -> Option<String> {
    let listed = FOREIGN.iter().find(|(foreign, ..)| *foreign == name);
    let text = listed.map(|(.., glsl)| (*glsl).to_owned());
    text.or_else(|| sized(Side::Glsl, name)).filter(|text| !text.is_empty())
}

/// The language that a name is wanted in.
#[derive(Clone, Copy)]
enum Side {
    Wgsl,
    Glsl,
}

/// A vector or a matrix of another language: `float3`, `ivec2`, `half4x4`, `vec3f`.
fn sized(side: Side, name: &str) -> Option<String> {
    /// The letters before the size, those behind it, and what stands for the scalar type behind a
    /// vector of WGSL and before one of GLSL.
    const TYPES: [(&str, &str, &str, &str); 13] = [
        ("float", "", "f", ""),
        ("half", "", "h", ""),
        ("int", "", "i", "i"),
        ("uint", "", "u", "u"),
        ("bool", "", "<bool>", "b"),
        ("ivec", "", "i", "i"),
        ("uvec", "", "u", "u"),
        ("bvec", "", "<bool>", "b"),
        ("vec", "f", "f", ""),
        ("vec", "h", "h", ""),
        ("vec", "i", "i", "i"),
        ("vec", "u", "u", "u"),
        ("mat", "f", "f", ""),
    ];
    let size = name.trim_matches(|letter: char| !letter.is_ascii_digit());
    let (before, after) = name.split_once(size).filter(|_| !size.is_empty())?;
    let (.., wgsl, glsl) = TYPES.iter().find(|one| (one.0, one.1) == (before, after))?;
    let is_size = |digit: u8| (b'2'..=b'4').contains(&digit);
    let text = match (side, size.as_bytes()) {
        (_, [one]) if !is_size(*one) => return None,
        (Side::Wgsl, [_]) => format!("vec{size}{wgsl}"),
        (Side::Glsl, [_]) => format!("{glsl}vec{size}"),
        (_, [one, b'x', other]) if !is_size(*one) || !is_size(*other) || !glsl.is_empty() => {
            return None;
        }
        (Side::Wgsl, [_, b'x', _]) => format!("mat{size}{wgsl}"),
        (Side::Glsl, [one, b'x', other]) if one == other => {
            format!("mat{}", char::from(*one))
        }
        (Side::Glsl, [_, b'x', _]) => format!("mat{size}"),
        _ => return None,
    };
    (text != name).then_some(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each name once, in order, with at least one of the two languages.
    #[test]
    fn table_is_sorted() {
        assert!(
            FOREIGN.is_sorted_by(|a, b| { (a.0.to_lowercase(), a.0) < (b.0.to_lowercase(), b.0) })
        );
        assert!(FOREIGN.iter().all(|(_, wgsl, glsl)| !wgsl.is_empty() || !glsl.is_empty()));
    }

    #[test]
    fn vectors_and_matrices() {
        let both = |name| [wgsl_text(name), glsl_text(name)];
        assert_eq!(both("float3"), [Some("vec3f".into()), Some("vec3".into())]);
        assert_eq!(both("float3x3"), [Some("mat3x3f".into()), Some("mat3".into())]);
        assert_eq!(both("bool2"), [Some("vec2<bool>".into()), Some("bvec2".into())]);
        assert_eq!(both("vec3f"), [None, Some("vec3".into())]);
        assert_eq!(both("vec2i"), [None, Some("ivec2".into())]);
        assert_eq!(both("mat4x4f"), [None, Some("mat4".into())]);
        assert_eq!(both("float2x3"), [Some("mat2x3f".into()), Some("mat2x3".into())]);
        assert_eq!(both("ivec2"), [Some("vec2i".into()), None]);
        assert_eq!(both("float5"), [None, None]);
        assert_eq!(both("int2x2"), [None, None]);
        assert_eq!(both("float2x5"), [None, None]);
        assert_eq!(both("x2"), [None, None]);
        assert_eq!(both("normal"), [None, None]);
    }
}

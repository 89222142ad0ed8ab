//! Names of other shading languages, with what WGSL and GLSL have in their place.

use lamplight_bundle::Language;

/// A name, and what is written instead of it in WGSL and in GLSL: code, or words with code in
/// backticks. A text is empty where the language has the name itself.
type Foreign = (&'static str, &'static str, &'static str);

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

/// What a name of another language is called in this one.
pub fn native_text(language: Language, name: &str) -> Option<String> {
    let listed = FOREIGN.iter().find(|(foreign, ..)| *foreign == name);
    let text = listed.map(|(_, wgsl, glsl)| match language {
        Language::Wesl => (*wgsl).to_owned(),
        Language::Glsl => (*glsl).to_owned(),
    });
    text.or_else(|| sized(language, name)).filter(|text| !text.is_empty())
}

/// A vector or a matrix of another language: `float3`, `ivec2`, `half4x4`, `vec3f`.
fn sized(language: Language, name: &str) -> Option<String> {
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
    let text = match (language, size.as_bytes()) {
        (_, [one]) if !is_size(*one) => return None,
        (Language::Wesl, [_]) => format!("vec{size}{wgsl}"),
        (Language::Glsl, [_]) => format!("{glsl}vec{size}"),
        (_, [one, b'x', other]) if !is_size(*one) || !is_size(*other) || !glsl.is_empty() => {
            return None;
        }
        (Language::Wesl, [_, b'x', _]) => format!("mat{size}{wgsl}"),
        (Language::Glsl, [one, b'x', other]) if one == other => {
            format!("mat{}", char::from(*one))
        }
        (Language::Glsl, [_, b'x', _]) => format!("mat{size}"),
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

    /// naga knows every function and every type that the table has for WGSL.
    #[test]
    fn names_of_wgsl_are_known() {
        let code = FOREIGN.iter().map(|(_, wgsl, _)| *wgsl).filter(|text| !text.contains('`'));
        for native in code.filter(|text| !text.is_empty() && !text.starts_with("if ")) {
            let is_type = native.chars().all(|letter| letter.is_ascii_alphanumeric());
            let text = match is_type {
                true => format!("alias T = {native};"),
                false => format!(
                    "@group(0) @binding(0) var t: texture_2d<f32>;
                     @group(0) @binding(1) var s: sampler;
                     @group(0) @binding(2) var c: texture_cube<f32>;
                     fn f(a: f32, b: f32, t_: f32, x: f32, y: f32, level: f32, uv: vec2f) {{
                         let texel = vec2u(uv);
                         let ddx = uv; let ddy = uv;
                         let value = {};
                     }}",
                    arguments_of(native)
                ),
            };
            let read = naga::front::wgsl::parse_str(&text);
            assert!(read.is_ok(), "{native}: {}", read.unwrap_err().emit_to_string(&text));
        }
    }

    /// The code with arguments of the types that its function takes.
    fn arguments_of(native: &str) -> String {
        let integers = native.replace("(x)", "(u32(x))");
        match native {
            text if text.ends_with("direction)") => "textureSample(c, s, vec3f(x))".to_owned(),
            text if text.starts_with("unpack") || text.starts_with("count") => integers,
            "mix(a, b, t)" => "mix(a, b, t_)".to_owned(),
            "faceForward(n, i, ng)" => "faceForward(vec3f(a), vec3f(b), vec3f(x))".to_owned(),
            "fma(a, b, c)" => "fma(a, b, x)".to_owned(),
            "textureLoad(t, texel, level)" | "textureDimensions(t, level)" => {
                native.replace("level", "u32(level)")
            }
            text => text.to_owned(),
        }
    }

    #[test]
    fn types_of_wgsl_are_known() {
        for types in ["float3", "ivec2", "uvec4", "bvec3", "half2", "float4x4", "uint2"] {
            let native = native_text(Language::Wesl, types).unwrap_or_default();
            let text = format!("enable f16; alias T = {native};");
            assert!(naga::front::wgsl::parse_str(&text).is_ok(), "{types}: {native}");
        }
    }

    #[test]
    fn vectors_and_matrices() {
        let both = |name| [Language::Wesl, Language::Glsl].map(|of| native_text(of, name));
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

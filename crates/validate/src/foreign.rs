//! Names of other shading languages in the language of a text.

use lamplight_bundle::Language;
use lamplight_syntax::foreign::{glsl_text, wgsl_text};

/// What a name of another language is called in this one.
pub fn native_text(language: Language, name: &str) -> Option<String> {
    match language {
        Language::Wesl => wgsl_text(name),
        Language::Glsl => glsl_text(name),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lamplight_syntax::foreign::names;

    /// naga knows every function and every type that the table has for WGSL.
    #[test]
    fn names_of_wgsl_are_known() {
        let code = names().iter().map(|(_, wgsl, _)| *wgsl).filter(|text| !text.contains('`'));
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
}

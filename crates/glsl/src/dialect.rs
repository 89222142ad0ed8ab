//! Whether a text is written for Vulkan or for OpenGL.

use crate::lexer::{Kind, Lexed, Token, mark, tokenize};

/// Built-in variables and words of layouts that only GLSL for Vulkan has.
const WORDS: &[&str] = &[
    "constant_id",
    "gl_InstanceIndex",
    "gl_VertexIndex",
    "input_attachment_index",
    "push_constant",
    "sampler",
    "samplerShadow",
];

/// How the names of types begin that only GLSL for Vulkan has. Some of them are functions too.
const TYPES: &[&str] =
    &["isubpassInput", "itexture", "subpassInput", "texture", "usubpassInput", "utexture"];

/// The least version that shaders for Vulkan have. What is written for OpenGL rarely asks for it.
const VERSION: u32 = 450;

/// Words of the first versions, which GLSL for Vulkan does not have. A text without a `#version` may
/// have them.
const OLD_WORDS: &[&str] = &["attribute", "varying"];

/// Whether a text is of version 4.50 or later, or has anything that only GLSL for Vulkan has. One with
/// words of the first versions is not for Vulkan.
pub fn is_for_vulkan(text: &str) -> bool {
    let Lexed { tokens, comments: _, directives } = tokenize(text);
    let word = |token: &Token| match token.kind {
        Kind::Word => text.get(token.at.range()),
        _ => None,
    };
    if tokens.iter().filter_map(word).any(|word| OLD_WORDS.contains(&word)) {
        return false;
    }
    if directives.iter().filter_map(|at| version(text.get(at.range())?)).any(|it| it >= VERSION) {
        return true;
    }
    tokens.windows(2).any(|pair| {
        let Some(found) = word(&pair[0]) else { return false };
        let is_type = || TYPES.iter().any(|start| found.starts_with(start));
        match pair[1].kind {
            _ if WORDS.contains(&found) => true,
            // `set = 0` of a layout; a variable of this name is declared with `=` too, so that
            // what is before it decides.
            Kind::Word => is_type(),
            kind => found == "set" && kind == mark("=") && is_in_layout(text, &tokens, pair[0]),
        }
    })
}

/// The number of a `#version` line.
fn version(line: &str) -> Option<u32> {
    let rest = line.strip_prefix('#')?.trim_start().strip_prefix("version")?;
    rest.split_whitespace().next()?.parse().ok()
}

/// Whether a token is directly behind the bracket of a layout, or behind a comma in it.
fn is_in_layout(text: &str, tokens: &[Token], token: Token) -> bool {
    let end = tokens.partition_point(|one| one.at.start < token.at.start);
    let mut before = tokens[..end].iter().rev();
    let open = before.find(|one| [mark("("), mark(";")].contains(&one.kind));
    let layout = before.next().and_then(|one| text.get(one.at.range()));
    open.is_some_and(|one| one.kind == mark("(")) && layout == Some("layout")
}

#[cfg(test)]
mod tests {
    use super::is_for_vulkan;

    #[test]
    fn words_of_vulkan() {
        for text in [
            "layout(set = 0, binding = 1) uniform B { vec4 a; };",
            "layout(binding = 1, set=2) uniform texture2D t;",
            "uniform texture2D t;",
            "#version 450\nvoid main() {}",
            "# version 460 core\nvoid main() {}",
            "uniform sampler s;",
            "void main() { gl_Position = vec4(gl_VertexIndex); }",
            "layout(push_constant) uniform P { vec4 a; };",
        ] {
            assert!(is_for_vulkan(text), "{text}");
        }
    }

    #[test]
    fn words_of_opengl() {
        for text in [
            "#version 330 core\nvoid main() {}",
            "#version 320 es\nvoid main() {}",
            "#version 450\nattribute vec4 a; void main() { gl_Position = a; }",
            "uniform sampler2D t; void main() { gl_FragColor = texture2D(t, vec2(0.0)); }",
            "void main() { int set = 0; set = 1; gl_Position = texture(t, a); }",
            "layout(location = 0) in vec4 texture_at; void main() { f(a, set = 1); }",
        ] {
            assert!(!is_for_vulkan(text), "{text}");
        }
    }
}

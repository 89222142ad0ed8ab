//! Computes the built-in functions of constants that naga does not.

use std::fmt::Write;

use super::evaluate::Constants;
use crate::names::Module;
use crate::parse;
use crate::syntax::{Expr, ExprKind};

/// What naga 30 refuses in constant expressions, though WGSL allows it there.
const NOT_COMPUTED: &[&str] = &[
    "mix",
    "smoothstep",
    "ldexp",
    "frexp",
    "modf",
    "insertBits",
    "extractBits",
    "transpose",
    "determinant",
    "reflect",
    "refract",
    "faceForward",
    "quantizeToF16",
    "pack4x8snorm",
    "pack4x8unorm",
    "pack4xI8",
    "pack4xU8",
    "pack4xI8Clamp",
    "pack4xU8Clamp",
    "pack2x16snorm",
    "pack2x16unorm",
    "pack2x16float",
    "unpack4x8snorm",
    "unpack4x8unorm",
    "unpack4xI8",
    "unpack4xU8",
    "unpack2x16snorm",
    "unpack2x16unorm",
    "unpack2x16float",
];

/// The text with the values of such calls in constants at its end, and blanks where the names of
/// these constants leave room: whatever stays keeps its place. `None` where there is none. It needs
/// a large stack.
pub fn fold(text: &str) -> Option<String> {
    let (tree, problems) = parse::parse(text)?.ok()?;
    if !problems.is_empty() {
        return None;
    }
    let module = Module::read(&tree);
    let constants = Constants::of(&module);
    let prefix = ["c", "k", "q", "folded_"].into_iter().find(|prefix| is_free(text, prefix))?;
    let (mut folded, mut declared) = (text.as_bytes().to_vec(), String::new());
    let (mut count, mut first_replaced) = (0, u32::MAX);
    // An expression comes after those in it, so the outermost is found first.
    for (id, expression) in tree.expressions.iter().enumerate().rev() {
        if expression.place.end > first_replaced || !is_of_such_a_call(&module, expression) {
            continue;
        }
        let Some(value) = constants.value(id as u32) else { continue };
        let name = format!("{prefix}{count}");
        let call = folded.get_mut(expression.place.range())?;
        if name.len() > call.len() {
            continue;
        }
        call.fill(b' ');
        call[..name.len()].copy_from_slice(name.as_bytes());
        let _ = write!(declared, "\nconst {name} = {};", value.text());
        (count, first_replaced) = (count + 1, expression.place.start);
    }
    let folded = String::from_utf8(folded).ok().filter(|_| count > 0)?;
    Some(folded + &declared)
}

/// Whether no name of a text is the prefix with digits.
fn is_free(text: &str, prefix: &str) -> bool {
    lamplight_syntax::words::words(text).all(|word| {
        let rest = word.text.strip_prefix(prefix);
        rest.is_none_or(|rest| rest.is_empty() || !rest.bytes().all(|byte| byte.is_ascii_digit()))
    })
}

/// Whether an expression is the call of a function that naga does not compute, or a member of what
/// that returns.
fn is_of_such_a_call(module: &Module<'_, '_>, expression: &Expr<'_>) -> bool {
    let call = match &expression.kind {
        ExprKind::Member { base, name: _ } => module.tree.kind(module.tree.inner(*base)),
        kind => kind,
    };
    match call {
        ExprKind::Call { callee, template: _, arguments: _ } => {
            NOT_COMPUTED.contains(callee) && module.find(callee).is_none()
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::fold;

    #[track_caller]
    fn folded(expression: &str) -> String {
        let text = format!("const x = {expression};");
        let folded = fold(&text).unwrap_or_default();
        folded.rsplit_once(" = ").map_or("", |(_, value)| value).to_owned()
    }

    /// Expected values are those that the specification's definitions give by hand.
    #[test]
    fn calls_become_their_values() {
        let cases = [
            ("mix(1, 3, 0.25)", "1.5;"),
            ("mix(vec2f(1, 2), vec2f(3, 4), 0.5)", "vec2(2.0f, 3.0f);"),
            ("smoothstep(0.0, 2.0, 1.0)", "0.5;"),
            ("ldexp(0.75, 3)", "6.0;"),
            ("frexp(6f).fract", "0.75f;"),
            ("frexp(6f).exp", "i32(3);"),
            ("modf(-1.5).whole", "-1.0;"),
            ("modf(vec2(1.5, -2.25)).fract", "vec2(0.5, -0.25);"),
            ("insertBits(0u, 5u, 4, 3)", "80u;"),
            ("extractBits(-1i, 0, 4)", "i32(-1);"),
            ("transpose(mat2x3f(1, 2, 3, 4, 5, 6))", "mat3x2(1.0f, 4.0f, 2.0f, 5.0f, 3.0f, 6.0f);"),
            ("determinant(mat3x3f(2, 0, 1, 0, 3, 0, 1, 0, 4))", "21.0f;"),
            ("determinant(mat4x4f(0,1,0,0, 1,0,0,0, 0,0,2,0, 0,0,0,3))", "-6.0f;"),
            ("reflect(vec2f(1, -1), vec2f(0, 1))", "vec2(1.0f, 1.0f);"),
            ("refract(vec2f(0, -1), vec2f(0, 1), 0.5)", "vec2(0.0f, -1.0f);"),
            ("faceForward(vec2f(0, 1), vec2f(0, 1), vec2f(0, 1))", "vec2(-0.0f, -1.0f);"),
            ("quantizeToF16(0.1f)", "0.099975586f;"),
            ("pack4x8snorm(vec4f(-1, 0, 0.5, 1))", "2134900865u;"),
            ("pack2x16float(vec2f(1, -2))", "3221240832u;"),
            ("unpack4xI8(0xff01u)", "vec4(i32(1), i32(-1), i32(0), i32(0));"),
            ("unpack2x16float(3221240832u)", "vec2(1.0f, -2.0f);"),
            ("mix(min(2, 1), max(3, 4), step(1.0, 2.0))", "4.0;"),
        ];
        for (expression, value) in cases {
            assert_eq!(folded(expression), value, "{expression}");
        }
    }

    #[test]
    fn what_has_no_value_or_another_meaning_stays() {
        let cases = [
            "const x = smoothstep(1.0, 1.0, 2.0);",
            "const x = ldexp(1f, 200);",
            "const x = mix(1i, 2i, 3i);",
            "fn mix(a: f32, b: f32, c: f32) -> f32 { return a; } const x = mix(1.0, 2.0, 3.0);",
            "fn f(a: f32) -> f32 { return mix(a, 1.0, 2.0); }",
            "fn f() -> f32 { let mix = 1.0; return mix(1.0, 2.0, 0.5); }",
            "override a: f32; override b = mix(a, 1.0, 2.0);",
            "const a = mix(b, 1.0, 2.0); const b = mix(a, 1.0, 2.0);",
        ];
        for text in cases {
            assert_eq!(fold(text), None, "{text}");
        }
    }

    #[test]
    fn everything_else_keeps_its_place_and_names_are_new() {
        let text = "const c0 = 1.0; const x = mix(c0, mix(1.0, 2.0, 0.5), 0.5); const y = 2;";
        let folded = fold(text).unwrap();
        assert_eq!(folded.find("const y"), text.find("const y"));
        assert!(folded.contains("const x = k0 "), "{folded}");
        assert!(folded.ends_with("\nconst k0 = 1.25;"), "{folded}");
    }
}

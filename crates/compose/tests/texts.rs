//! What texts are divided into, and GLSL without its comments and layout.

use lamplight_compose::lean_glsl;
use lamplight_syntax::words::{LexemeKind, has_word, is_word, pieces, word_around, words};
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("texts::pieces_are_all_of_the_text", pieces_are_all_of_the_text),
        Trial::test("texts::words_are_whole", words_are_whole),
        Trial::test("texts::glsl_is_squeezed", glsl_is_squeezed_as_line_by_line),
    ]
}

fn pieces_are_all_of_the_text() -> Outcome {
    let text = "vec3f(.5e-3, 0x1p-2+größe)\u{a0} @x";
    let found: Vec<&str> = pieces(text).map(|piece| piece.text).collect();
    assert_eq!(found.concat(), text);
    let solid: Vec<&str> = pieces(text)
        .filter(|piece| piece.kind != LexemeKind::Blank)
        .map(|piece| piece.text)
        .collect();
    assert_eq!(solid, ["vec3f", "(", ".5e-3", ",", "0x1p-2", "+", "größe", ")", "@", "x"]);
    Ok(())
}

fn words_are_whole() -> Outcome {
    let found: Vec<(&str, u8)> =
        words("@fragment a.b 1e5 _c").map(|word| (word.text, word.before)).collect();
    assert_eq!(found, [("fragment", b'@'), ("a", b't'), ("b", b'.'), ("_c", b'5')]);
    assert!(has_word("x + größe", "größe") && !has_word("größer 1e5", "größe"));
    assert!(is_word("_a1") && !is_word("1a") && !is_word("a-b") && !is_word(""));
    assert_eq!(word_around("(größe)", 2..2), 1.."(größe".len());
    Ok(())
}

/// A second implementation of the same rule, which works line by line. The results must be equal.
fn line_by_line(text: &str) -> String {
    let (mut plain, mut rest) = (String::new(), text);
    while let Some((before, comment)) = rest.split_once('/') {
        plain.push_str(before);
        let found = match comment.as_bytes().first() {
            Some(b'/') => Some(comment.find(['\n', '\r']).unwrap_or(comment.len())),
            Some(b'*') => Some(comment[1..].find("*/").map_or(comment.len(), |end| end + 3)),
            _ => None,
        };
        plain.push(if found.is_some() { ' ' } else { '/' });
        rest = &comment[found.unwrap_or(0)..];
    }
    plain.push_str(rest);
    let mut lean = String::new();
    for line in plain.split('\n') {
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let is_directive = words.first().is_some_and(|word| word.starts_with('#'));
        for (place, word) in words.iter().enumerate() {
            let touches = |byte: Option<&u8>| byte.is_none_or(|byte| b"\n()[]{},;".contains(byte));
            let is_apart = touches(lean.as_bytes().last()) || touches(word.as_bytes().first());
            if if is_directive && place > 0 { true } else { !is_apart } {
                lean.push(' ');
            }
            lean.push_str(word);
        }
        if !words.is_empty() {
            lean.push('\n');
        }
    }
    lean
}

fn glsl_is_squeezed_as_line_by_line() -> Outcome {
    const PARTS: &[&str] = &[
        "a",
        "1.5",
        " ",
        "  ",
        "\t",
        "\n",
        "\r\n",
        "\r",
        "\x0c",
        "/",
        "//",
        "/*",
        "*/",
        "*",
        "#define F",
        "#",
        "(",
        ")",
        ";",
        "{",
        "}",
        ",",
        "=",
        "é",
        "\u{a0}",
        "a/b",
    ];
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut squeezed = 0;
    for _ in 0..20_000 {
        let mut text = String::new();
        for _ in 0..state % 24 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            text.push_str(PARTS[(state >> 33) as usize % PARTS.len()]);
        }
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let expected = line_by_line(&text);
        squeezed += usize::from(expected.len() < text.len());
        assert_eq!(lean_glsl(&text), expected, "{text:?}");
    }
    assert!(squeezed > 10_000, "{squeezed}");
    Ok(())
}

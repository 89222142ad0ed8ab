//! Texts that nobody writes: as deep as brackets may nest, and with thousands of the same. None ends
//! the process, and each holds what every text holds.

use libtest_mimic::{Failed, Trial};

use lamplight_format::{Language, Options};

use super::random::check_text;

/// Repetitions in a long text.
const MANY: usize = 20_000;
/// Brackets in a deep one.
const DEEP: usize = 190;

pub fn tests() -> Vec<Trial> {
    vec![Trial::test("long_texts", long_texts), Trial::test("deep_texts", deep_texts)]
}

fn check_all(texts: &[(Language, String)]) -> Result<(), Failed> {
    for (language, text) in texts {
        check_text(text, *language, &Options::default(), text.len() / 2)
            .map_err(|found| format!("{:?}...: {found:.400}", &text[..text.len().min(80)]))?;
    }
    Ok(())
}

fn long_texts() -> Result<(), Failed> {
    let wesl = |start: &str, many: &str, end: &str| {
        (Language::Wesl, format!("{start}{}{end}", many.repeat(MANY)))
    };
    let glsl = |start: &str, many: &str, end: &str| {
        (Language::Glsl, format!("{start}{}{end}", many.repeat(MANY)))
    };
    check_all(&[
        wesl("fn f() { g(", "/**/", "a); }"),
        wesl("fn f() { g(", "/**/ ", "a, b); }"),
        wesl("fn f() { ", "/**/", "a(); }"),
        wesl("fn f() { switch a { ", "case 1: ", "} }"),
        wesl("#import a::{", "\n", "}"),
        wesl("#import a::{", "b,\n", ""),
        wesl("const a = 1", " + 1", ";"),
        wesl("const a = b", "<c", ";"),
        wesl("", "@a ", "fn f() {}"),
        wesl("", "@if(A) { } ", ""),
        glsl("void f() { ", "if (a) ", "b(); }"),
        glsl("void f() { ", "if (a) b(); else ", "b(); }"),
        glsl("void f() { ", "a ? b : ", "c; }"),
        glsl("", "#if A\n", ""),
        glsl("", "A\n", ""),
        glsl("#define A ", "\\\n", "1"),
    ])
}

fn deep_texts() -> Result<(), Failed> {
    let deep = |language, open: &str, close: &str| {
        (language, format!("{}a{}", open.repeat(DEEP), close.repeat(DEEP)))
    };
    let chain = "(a || b && c | d ^ e & f == g < h << i + j * ";
    let choice = "(a = b ? c : d || e ^^ f && g | h ^ i & j == k < l << m + n * ";
    check_all(&[
        deep(Language::Wesl, "f(", ")"),
        deep(Language::Wesl, "array<", ">"),
        deep(Language::Wesl, chain, ")"),
        deep(Language::Wesl, "{", "}"),
        deep(Language::Wesl, "@if(A) {\n", "}"),
        deep(Language::Wesl, "if a {\n", "} else { b(); }"),
        deep(Language::Wesl, "fn f() {", "}"),
        deep(Language::Glsl, choice, ")"),
        deep(Language::Glsl, "switch (a) { case 1: ", "}"),
        deep(Language::Glsl, "do {", "} while (a);"),
    ])
}

//! Errors in expressions and cases, and functions with wrong results, are reported with their place.

use std::sync::{Arc, Mutex};

use lamplight::LIBRARY_FILES;
use lamplight::bundle::Language;
use lamplight::check::expression;
use lamplight::check::library::Library;
use lamplight::diagnostic::render::Form;
use lamplight::source::{Memory, SourceSet};
use libtest_mimic::Failed;

use super::{failed, opened, render};

/// Wrong expressions, and the start of the diagnostic, which has a place in the expression.
const EXPRESSION_ERRORS: &[(&str, Language, &str)] = &[
    ("1.0 +", Language::Wesl, "<expression>:1:"),
    ("vec3f(1.0) * nothing", Language::Wesl, "<expression>:1:14: error["),
    ("lighting::spot::cone_harf(0.5, 0.75)", Language::Wesl, "<expression>:1:"),
    ("select(1.0, 2.0, true)", Language::Glsl, "<expression>:1:1: error[glsl-error]"),
];

pub fn expression_errors() -> Result<(), Failed> {
    opened(|open| {
        let library = Library::shipped(LIBRARY_FILES);
        for (text, language, expected) in EXPRESSION_ERRORS {
            let sources = Mutex::new(SourceSet::default());
            let errors = expression::evaluate_expression(
                &library,
                &sources,
                text,
                *language,
                open[0].session.as_mut(),
            )
            .err()
            .unwrap_or_default();
            let found = lamplight::diagnostic::render::render(
                &sources.lock().unwrap(),
                &errors,
                Form::Short,
            );
            if !found.starts_with(expected) {
                return Err(format!("{text}: found {found}, expected {expected}").into());
            }
        }
        Ok(())
    })
}

const USER_MODULE: &str = "fn half(x: f32) -> f32 { return 0.5 * x; }\nfn wrong(x: f32) -> f32 { return select(x, x + 1.0, x > 3.0); }";

/// A wrong case file of a user's module, and the start of the diagnostic.
const CASE_ERRORS: &[(&str, &str)] = &[
    ("[[case]\n", "mine.toml:1:"),
    (
        "[[case]]\nfunction = \"half\"\ninputs = { y = 1 }\n",
        "mine.toml:3:16: error[case-invalid]: the function has no parameter `y`",
    ),
    (
        "[[case]]\nfunction = \"half\"\ninput = { x = 1 }\n",
        "mine.toml:3:1: error[case-invalid]: unknown key `input`",
    ),
    (
        "[[case]]\nfunction = \"half\"\ninputs = { x = { grit = [0, 1], count = 3 } }\n",
        "mine.toml:3:",
    ),
    (
        "[[case]]\nfunction = \"half\"\noracle = \"reference\"\ninputs = { x = 1 }\n",
        "mine.toml:2:12: error[case-invalid]: there is no reference for `mine::half`",
    ),
    (
        "[[case]]\nfunction = \"half\"\ninputs = { x = 1 }\nformula = \"0.5*z\"\n",
        "mine.toml:4:16: error[case-invalid]: there is no parameter `z`",
    ),
    (
        "[[case]]\nfunction = \"half\"\ninputs = { x = 1 }\nformula = \"0.5*x\"\ntolerance = { ulps = 1 }\n",
        "mine.toml:5:15: error[case-invalid]: unknown error term `ulps`",
    ),
    (
        "[[case]]\nfunction = \"half\"\ninputs = { x = 1 }\nformula = \"x\"\nlaws = { rises = \"x\" }\n",
        "mine.toml:5:8: error[case-invalid]: this table is not a law",
    ),
    (
        "[[case]]\nfunction = \"half\"\ninputs = { x = 1 }\nformula = \"x\"\nlaws = { continuous = \"x\", slop = 1 }\n",
        "mine.toml:5:28: error[case-invalid]: the law `continuous` has no `slop`",
    ),
    (
        "[[case]]\nfunction = \"half\"\ninputs = { x = 1 }\nformula = \"x\"\nlaws = { integral = \"x\", gives = 1, within = 1 }\n",
        "mine.toml:5:8: error[case-invalid]: `x` is not a direction",
    ),
    (
        "[[case]]\nfunction = \"half\"\ninputs = { x = 1 }\nformula = \"x\"\nlaws = { swap = \"x\" }\n",
        "mine.toml:5:17: error[case-invalid]: parameters are exchanged in pairs",
    ),
    (
        "[[case]]\nfunction = \"half\"\ninputs = { x = 1 }\nformula = \"x\"\nlaws = { area = \"half\", from = 0, to = 1, within = 1 }\n",
        "mine.toml:5:8: error[case-invalid]: `along` is missing",
    ),
    (
        "[[case]]\nfunction = \"half\"\ninputs = { x = 1 }\nformula = \"x\"\nlaws = { equal = \"wrong\", with = { x = \"z\" }, within = 1 }\n",
        "mine.toml:5:",
    ),
    ("[[case]]\nfunction = \"hal\"\ninputs = { x = 1 }\n", "mine.toml:2:12: error["),
    (
        "[[case]]\nfunction = \"half\"\ninputs = { x = { hemisphere = \"n\", count = 2 } }\nformula = \"x\"\n",
        "mine.toml:3:16: error[case-invalid]: `n` is given no values",
    ),
];

fn user_library(cases: &str) -> Library {
    let files = [("mine.wesl", USER_MODULE), ("mine.toml", cases)]
        .map(|(path, text)| (path.to_owned(), text.to_owned()));
    Library::new("mine", Arc::new(Memory(files.into())), Vec::new())
}

pub fn case_errors() -> Result<(), Failed> {
    let mut wrong = String::new();
    for (text, expected) in CASE_ERRORS {
        let sources = Mutex::new(SourceSet::default());
        let errors = user_library(text)
            .check(&sources, &["mine.toml".to_owned()], &[Language::Wesl], &mut [])
            .err()
            .unwrap_or_default();
        let found =
            lamplight::diagnostic::render::render(&sources.lock().unwrap(), &errors, Form::Short);
        if !found.starts_with(expected) {
            wrong += &format!("{text}: expected {expected}, found {found}\n");
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.into()) }
}

/// A function with wrong results fails with its smallest wrong input, the broken law, and a row that
/// can be pasted into the case file.
pub fn wrong_function() -> Result<(), Failed> {
    let cases = "[[case]]\nfunction = \"wrong\"\nformula = \"x\"\nlaws = { falling = \"x\" }\ninputs = { x = { random = [0, 10], count = 500 } }\n";
    opened(|open| {
        let sources = Mutex::new(SourceSet::default());
        let report = user_library(cases)
            .check(&sources, &["mine.toml".to_owned()], &[Language::Wesl], open)
            .map_err(|errors| render(&sources, &errors))?;
        let text = failed(&report);
        for expected in [
            "x = 4 (0x40800000)",
            "found 5 (0x40a00000)",
            "the law `falling` is broken",
            "rows = [{ x = [4.0], expect = [4.0] }]",
        ] {
            if !text.contains(expected) {
                return Err(format!("expected `{expected}` in\n{text}").into());
            }
        }
        Ok(())
    })
}

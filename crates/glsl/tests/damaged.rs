//! Damaged texts: they are read without a panic, however deep they nest.

use lamplight_diagnostic::source::SourceId;
use lamplight_glsl::lexer::tokenize;
use lamplight_glsl::translate;
use lamplight_glsl::tree::Stage;
use lamplight_testing::random::Random;
use libtest_mimic::{Failed, Trial};

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("glsl::damaged_tokens", damaged_tokens),
        Trial::test("glsl::deep_texts", deep_texts),
    ]
}

/// How many damaged texts are made of each text.
const ROUNDS: usize = 300;

fn damaged_tokens() -> Result<(), Failed> {
    let texts = crate::texts();
    let mut random = Random(1);
    for (name, text) in &texts {
        let stage = crate::stage_of(name);
        let tokens = tokenize(text).tokens;
        for _ in 0..ROUNDS {
            let mut pieces: Vec<&str> =
                tokens.iter().map(|token| &text[token.at.range()]).collect();
            for _ in 0..1 + random.below(3) {
                let at = random.below(pieces.len());
                match random.below(3) {
                    0 => {
                        pieces.remove(at);
                    }
                    1 => pieces.insert(at, pieces[random.below(pieces.len())]),
                    _ => pieces[at] = pieces[random.below(pieces.len())],
                }
            }
            let damaged = format!("#version 450\n{}", pieces.join(" "));
            // Either answer is right; a panic fails the test.
            let _ = translate(&damaged, stage, SourceId(0), Default::default());
        }
    }
    if texts.is_empty() { Err("there are no texts".into()) } else { Ok(()) }
}

/// Nesting that has no end in sight is refused; sums that are only long are not.
fn deep_texts() -> Result<(), Failed> {
    let depth = 100_000;
    let deep = [
        format!("void main() {{ int a = {}1; }}", "(".repeat(depth)),
        format!("void main() {{ int a = {}1; }}", "-".repeat(depth)),
        format!("void main() {{ {} }}", "{".repeat(depth)),
        format!("void main() {{ {} }}", "if (true) ".repeat(depth)),
        format!("void main() {{ int a = 1{}; }}", " + 1".repeat(depth)),
        format!("void main() {{ int a = b{}; }}", "[0]".repeat(depth)),
        format!("void main() {{ int a = true{}; }}", " ? 1 : true".repeat(depth)),
        format!("void main() {{ int a{}; }}", "[1]".repeat(depth)),
        "struct A { ".repeat(depth),
    ];
    for text in &deep {
        let found = translate(text, Stage::Fragment, SourceId(0), Default::default());
        if found.is_ok() {
            return Err(format!("accepted: {}", &text[..60]).into());
        }
    }
    let long = format!("void main() {{ int a = 1{}; }}", " + 1".repeat(150));
    translate(&long, Stage::Fragment, SourceId(0), Default::default())
        .map_err(|problems| format!("{problems:?}"))?;
    Ok(())
}

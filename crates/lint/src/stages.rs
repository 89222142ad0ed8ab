//! What a stage of GLSL must not have, and what it lacks, where no front end says so.

use std::ops::Range;

use lamplight_bundle::Stage;
use lamplight_compose::Composed;
use lamplight_diagnostic::source::LIMITS;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_syntax::glsl::{Symbols, tokenize};

/// A word of a text, and where it is.
type PlacedWord<'t> = (&'t str, Range<usize>);

/// Looks at the whole text of a stage.
///
/// A vertex shader without `gl_Position` is valid, and draws nothing that is defined. `shared` is
/// for compute shaders alone.
pub fn mistakes_of_stage(composed: &Composed) -> Diagnostics {
    let text = &composed.text;
    let Ok(tokens) = tokenize(text, &mut Symbols::default(), LIMITS.tokens) else {
        return Diagnostics::new();
    };
    let words: Vec<PlacedWord<'_>> =
        tokens.iter().map(|token| (&text[token.range()], token.range())).collect();
    match composed.stage {
        Some(Stage::Vertex) => {
            let unplaced = without_position(composed, &words);
            shared_memory(composed, &words).into_iter().chain(unplaced).collect()
        }
        Some(Stage::Fragment) => shared_memory(composed, &words).into_iter().collect(),
        Some(Stage::Compute) | None => Diagnostics::new(),
    }
}

fn without_position(composed: &Composed, words: &[PlacedWord<'_>]) -> Option<Diagnostic> {
    if words.iter().any(|(word, _)| *word == "gl_Position") {
        return None;
    }
    let message = "nothing writes `gl_Position`, so no vertex has a position";
    let (_, main) = words.iter().find(|(word, _)| *word == "main")?;
    let warning = Diagnostic::warning(codes::GLSL_ERROR, message);
    Some(placed(composed, warning, main, "the vertex shader"))
}

fn shared_memory(composed: &Composed, words: &[PlacedWord<'_>]) -> Option<Diagnostic> {
    let mut depth = 0_u32;
    let (_, shared) = words.iter().find(|(word, _)| {
        match *word {
            "(" => depth += 1,
            ")" => depth = depth.saturating_sub(1),
            _ => {}
        }
        // `layout(shared)` is about the bytes of a block.
        *word == "shared" && depth == 0
    })?;
    let error = Diagnostic::error(codes::GLSL_ERROR, "`shared` is for compute shaders");
    Some(placed(composed, error, shared, "not in this stage"))
}

fn placed(composed: &Composed, found: Diagnostic, range: &Range<usize>, label: &str) -> Diagnostic {
    match composed.map.lookup(range.clone()) {
        Some(span) => found.at(span, label),
        None => found,
    }
}

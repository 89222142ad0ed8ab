//! What an expression must be before a module is written around it. Otherwise an error would be about
//! the text of the module, which the author has not written.

use std::ops::Range;

use super::rewrite::expression_tokens;
use lamplight_diagnostic::source::{SourceId, Span};
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_syntax::wesl::blank::without_comments;

const BRACKETS: [(&str, &str); 3] = [("(", ")"), ("[", "]"), ("{", "}")];
/// What no expression ends with. `>` may end the type of a constructor.
const OPERATORS: &[&str] =
    &["+", "-", "*", "/", "%", "&", "|", "^", "<", "=", "!", "~", ",", ".", "::"];

/// # Errors
/// Brackets without their partners, and an expression that ends too early.
pub fn check_complete(text: &str, id: SourceId) -> Result<(), Diagnostic> {
    let text = &*without_comments(text);
    let tokens: Vec<Range<usize>> = expression_tokens(text)
        .into_iter()
        .filter(|range| !text[range.clone()].trim().is_empty())
        .collect();
    let Some(last) = tokens.last() else {
        let error = Diagnostic::error(codes::WGSL_ERROR, "expected an expression");
        return Err(error.at(Span::new(id, 0..text.len()), "nothing is here"));
    };
    check_brackets(text, &tokens, id)?;
    if !OPERATORS.contains(&&text[last.clone()]) {
        return Ok(());
    }
    let operator = last_operator(text, &tokens);
    let word = &text[operator.clone()];
    let message = format!("expected an expression after `{word}`");
    let error = Diagnostic::error(codes::WGSL_ERROR, message);
    Err(error.at(Span::new(id, operator), "the expression ends here"))
}

/// The operator at the end. Its characters are tokens of their own: `&&`.
fn last_operator(text: &str, tokens: &[Range<usize>]) -> Range<usize> {
    let mut found = tokens.last().cloned().unwrap_or_default();
    for token in tokens.iter().rev().skip(1) {
        if token.end != found.start || !OPERATORS.contains(&&text[token.clone()]) {
            break;
        }
        found.start = token.start;
    }
    found
}

fn check_brackets(text: &str, tokens: &[Range<usize>], id: SourceId) -> Result<(), Diagnostic> {
    let mut open: Vec<(&Range<usize>, &str)> = Vec::new();
    for token in tokens {
        let word = &text[token.clone()];
        if let Some((_, close)) = BRACKETS.iter().find(|(open, _)| *open == word) {
            open.push((token, close));
        } else if BRACKETS.iter().any(|(_, close)| *close == word) {
            match open.pop() {
                Some((_, wanted)) if wanted == word => {}
                Some((opened, wanted)) => {
                    let message = format!("expected `{wanted}`, found `{word}`");
                    let error = unbalanced(message, token, id, "this is another bracket");
                    return Err(error.at(Span::new(id, opened.clone()), "to close this"));
                }
                None => {
                    let message = format!("`{word}` closes nothing");
                    return Err(unbalanced(message, token, id, "no bracket is open here"));
                }
            }
        }
    }
    match open.last() {
        Some((opened, close)) => {
            let message = format!("`{}` is not closed", &text[(*opened).clone()]);
            Err(unbalanced(message, opened, id, &format!("`{close}` is missing")))
        }
        None => Ok(()),
    }
}

fn unbalanced(message: String, token: &Range<usize>, id: SourceId, label: &str) -> Diagnostic {
    Diagnostic::error(codes::UNBALANCED_BRACKET, message).at(Span::new(id, token.clone()), label)
}

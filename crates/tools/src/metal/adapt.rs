//! Rewrites what the headers cannot express. Lines keep their numbers.

use std::borrow::Cow;

use super::token::{Token, msl_tokens};

/// The text that clang gets.
///
/// - A function constant has no value: in C++ a constant needs one.
/// - The helper that compares and exchanges atomically is declared for two address spaces, which
///   are one here.
/// - `(a < b).x` is the number 0 or -1 in clang. The headers' `__lamplight::truth` makes it a
///   `bool`.
pub fn adapt_text(text: &str) -> Cow<'_, str> {
    let tokens = msl_tokens(text);
    let mut edits = Vec::new();
    for at in 0..tokens.len() {
        edits.extend(function_constant(&tokens, at));
        edits.extend(second_helper(&tokens, at));
        edits.extend(component_of_group(&tokens, at));
    }
    if edits.is_empty() {
        return Cow::Borrowed(text);
    }
    edits.sort();
    let (mut to, mut done) = (String::with_capacity(text.len()), 0);
    for (from, end, instead) in edits {
        to += &text[done..from];
        to += instead;
        done = end;
    }
    Cow::Owned(to + &text[done..])
}

/// The first byte, the byte after the last one, and what replaces them.
type TextEdit = (usize, usize, &'static str);

fn token_texts<'t, const N: usize>(tokens: &[Token<'t>], at: usize) -> Option<[&'t str; N]> {
    let found = tokens.get(at..at + N)?;
    Some(std::array::from_fn(|index| found[index].text))
}

/// `[[function_constant(0)]];` -> `= {};`
fn function_constant(tokens: &[Token<'_>], at: usize) -> Option<TextEdit> {
    let ["[", "[", "function_constant", "(", _, ")", "]", "]", ";"] = token_texts::<9>(tokens, at)?
    else {
        return None;
    };
    Some((tokens[at].at, tokens[at + 8].at, "= {}"))
}

/// `template <typename A> R naga_...(threadgroup A *atomic_ptr` gets a name of its own.
fn second_helper(tokens: &[Token<'_>], at: usize) -> Option<TextEdit> {
    const HELPER: &str = "naga_atomic_compare_exchange_weak_explicit";
    let [HELPER, "(", "threadgroup", "A", "*"] = token_texts::<5>(tokens, at)? else { return None };
    Some((tokens[at].at, tokens[at].end(), "naga_atomic_of_threadgroup"))
}

/// `(a < b).x` -> `__lamplight::truth(a < b).x`, unless the bracket belongs to a call.
fn component_of_group(tokens: &[Token<'_>], at: usize) -> Option<TextEdit> {
    let (before, open) = (tokens.get(at.checked_sub(1)?)?, tokens[at]);
    let is_call =
        before.text.ends_with(|last: char| last.is_alphanumeric() || "_>)]".contains(last));
    if open.text != "(" || is_call && before.text != "return" {
        return None;
    }
    let close = closing_bracket(tokens, at)?;
    let [".", letter] = token_texts::<2>(tokens, close + 1)? else { return None };
    let is_component = letter.starts_with(['x', 'y', 'z', 'w']);
    let edit = (open.at, open.at, " __lamplight::truth");
    (is_component && has_comparison(&tokens[at + 1..close])).then_some(edit)
}

/// Index of the bracket that closes the one at `at`.
fn closing_bracket(tokens: &[Token<'_>], at: usize) -> Option<usize> {
    let mut depth = 0u32;
    for (index, token) in tokens.iter().enumerate().skip(at) {
        match token.text {
            "(" => depth += 1,
            ")" if depth == 1 => return Some(index),
            ")" => depth -= 1,
            "{" | "}" | ";" => return None,
            _ => {}
        }
    }
    None
}

/// Whether anything is compared, at any depth.
fn has_comparison(tokens: &[Token<'_>]) -> bool {
    tokens.iter().any(|token| matches!(token.text, "<" | ">" | "=" | "!"))
}

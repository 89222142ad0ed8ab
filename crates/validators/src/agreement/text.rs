//! The declarations of a text in GLSL, HLSL or MSL, which look alike.

use lamplight_syntax::words::begins_word;
use lamplight_tools::metal::token::{Token, msl_tokens};

/// A declaration between the braces of others: what stands before its own braces, and in them.
#[derive(Debug)]
pub struct Statement<'t> {
    /// The tokens before `{` or `;`.
    pub head: Vec<&'t str>,
    /// The tokens between the braces, if there are any.
    pub body: Option<Vec<&'t str>>,
    /// The name between the closing brace and `;`.
    pub instance: Option<&'t str>,
    /// The first byte, and the byte after the last one.
    pub range: (usize, usize),
}

/// The words that declare a block or a structure.
const BLOCKS: [&str; 4] = ["struct", "uniform", "buffer", "cbuffer"];

impl<'t> Statement<'t> {
    /// The name of the structure or the block that it declares with one of these words.
    pub fn block_name(&self, words: &[&str]) -> Option<&'t str> {
        self.body.as_ref()?;
        let at = self.head.iter().position(|token| words.contains(token))?;
        let name = *self.head.get(at + 1)?;
        let is_last = self.head.get(at + 2).is_none_or(|next| *next == ":");
        (is_last && name.starts_with(begins_word)).then_some(name)
    }

    /// Whether it is a function with its body.
    fn is_function(&self) -> bool {
        let has = |wanted: &str| self.head.contains(&wanted);
        self.body.is_some() && self.block_name(&BLOCKS).is_none() && has("(") && !has("=")
    }

    /// The name of a function and what stands between its brackets.
    pub fn function(&self) -> Option<(&'t str, &[&'t str])> {
        let mut depth = 0usize;
        let open = self.head.iter().position(|token| {
            match *token {
                "[" => depth += 1,
                "]" => depth = depth.saturating_sub(1),
                _ => {}
            }
            // Attributes have brackets too: `[numthreads(8, 1, 1)]`.
            *token == "(" && depth == 0
        });
        let open = open.filter(|_| self.is_function())?;
        let close = open + closing_bracket(self.head[open..].iter().copied())?;
        Some((*self.head.get(open.checked_sub(1)?)?, &self.head[open + 1..close]))
    }
}

/// The index of the token that closes the bracket or brace which the first token opens.
pub fn closing_bracket<'t>(mut tokens: impl Iterator<Item = &'t str>) -> Option<usize> {
    let mut depth = 0usize;
    tokens.position(|token| {
        match token {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth = depth.saturating_sub(1),
            _ => {}
        }
        depth == 0
    })
}

/// The declarations of a text. Directives and comments belong to none.
pub fn read_statements(text: &str) -> Vec<Statement<'_>> {
    let tokens = msl_tokens(text);
    let (mut found, mut at) = (Vec::new(), 0);
    while at < tokens.len() {
        let (statement, end) = read_statement(&tokens, at);
        found.extend(statement);
        at = end;
    }
    found
}

/// The declaration that begins at a token, and the index behind it.
fn read_statement<'t>(tokens: &[Token<'t>], start: usize) -> (Option<Statement<'t>>, usize) {
    let rest = &tokens[start..];
    let texts = |tokens: &[Token<'t>]| tokens.iter().map(|token| token.text).collect::<Vec<_>>();
    let end = rest.iter().position(|token| ["{", ";"].contains(&token.text)).unwrap_or(rest.len());
    let (mut last, mut body, mut instance) = (end.min(rest.len() - 1), None, None);
    if rest.get(end).is_some_and(|token| token.text == "{") {
        let close = end
            + closing_bracket(rest[end..].iter().map(|token| token.text))
                .unwrap_or(rest.len() - 1 - end);
        body = Some(texts(&rest[end + 1..close.max(end + 1)]));
        let behind = rest.get(close + 1..).unwrap_or_default();
        last = close.min(rest.len() - 1);
        match behind {
            [end, ..] if end.text == ";" => last = close + 1,
            [name, next, ..]
                if name.text.starts_with(begins_word) && [";", "["].contains(&next.text) =>
            {
                instance = Some(name.text);
                let end = behind.iter().position(|token| token.text == ";");
                last = end.map_or(rest.len() - 1, |end| close + 1 + end);
            }
            _ => {}
        }
    }
    let range = (rest[0].at, rest[last].end());
    let statement = Statement { head: texts(&rest[..end]), body, instance, range };
    let is_empty = statement.head.is_empty() && statement.body.is_none();
    ((!is_empty).then_some(statement), start + last + 1)
}

/// The text without its functions.
pub fn without_functions(text: &str) -> String {
    with_statements(text, |statement| !statement.is_function())
}

/// The text with some of its declarations, and with all of its directives.
pub fn with_statements(text: &str, is_kept: impl Fn(&Statement<'_>) -> bool) -> String {
    let (mut to, mut done) = (String::new(), 0);
    for statement in read_statements(text).iter().filter(|one| !is_kept(one)) {
        let (start, end) = statement.range;
        to += &text[done..start];
        done = end;
    }
    to += &text[done..];
    let lines = to.lines().filter(|line| !line.trim().is_empty());
    lines.flat_map(|line| [line, "\n"]).collect()
}

/// Whether a text has a function of that name.
pub fn has_function(statements: &[Statement<'_>], name: &str) -> bool {
    statements.iter().filter_map(Statement::function).any(|(found, _)| found == name)
}

/// The number in a token.
pub fn number_of(token: &str) -> Option<u32> {
    token.trim_end_matches(['u', 'U']).parse().ok()
}

/// The members that are declared between braces: the tokens of each, without `;`.
pub fn member_tokens<'b, 't>(body: &'b [&'t str]) -> impl Iterator<Item = &'b [&'t str]> {
    body.split(|token| *token == ";").filter(|member| !member.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "#version 450 core
#ifndef SIZE
#define SIZE 4
#endif
struct Lamp { vec3 a; float b[3]; };
layout(std140) uniform Lamp_block { Lamp lamp; };
layout(std430) readonly buffer Items_block { float items[]; } items;
const float TABLE[2] = float[2](1.0, 2.0);
#define OTHER
float f(float buffer) { if (buffer > 0.0) { return 1.0; } return TABLE[0]; }
#undef OTHER
void main() {}
";

    #[test]
    fn functions_are_left_out_and_directives_stay() {
        let without = without_functions(TEXT);
        assert!(!without.contains("f(float") && !without.contains("main"), "{without}");
        for kept in
            ["struct Lamp", "Lamp_block", "items[]; } items;", "TABLE", "#endif", "#undef OTHER"]
        {
            assert!(without.contains(kept), "{kept}: {without}");
        }
    }

    #[test]
    fn blocks_have_names() {
        let statements = read_statements(TEXT);
        let names: Vec<&str> =
            statements.iter().filter_map(|one| one.block_name(&BLOCKS)).collect();
        assert_eq!(names, ["Lamp", "Lamp_block", "Items_block"]);
        let functions: Vec<&str> =
            statements.iter().filter_map(|one| Some(one.function()?.0)).collect();
        assert_eq!(functions, ["f", "main"]);
    }

    #[test]
    fn no_text_is_too_broken() {
        for text in
            ["", ";", "{", "}", "struct", "struct A {", "f(", ") {", "a b c", "{{}", "}}};("]
        {
            without_functions(text);
            read_statements(text).iter().for_each(|one| _ = one.function());
        }
    }
}

//! Tokens of a GLSL file with their depth in braces.

use lamplight_syntax::glsl::{Directive, FilePart, Module, Token, known};

/// A token and the number of braces around it. A brace itself is outside of what it encloses.
#[derive(Clone, Copy)]
pub struct NestedToken {
    pub token: Token,
    pub depth: u32,
}

/// The tokens between directives. Each branch of a conditional begins at the depth of its `#if`.
pub fn text_tokens(module: &Module) -> Vec<NestedToken> {
    let mut found = Vec::with_capacity(module.tokens.len());
    let (mut depth, mut open) = (0_u32, Vec::new());
    for part in &module.parts {
        match part {
            FilePart::Text(text) => {
                let range = text.tokens.start as usize..text.tokens.end as usize;
                for token in module.tokens.get(range).unwrap_or_default() {
                    if token.symbol == known::CLOSE_BRACE {
                        depth = depth.saturating_sub(1);
                    }
                    found.push(NestedToken { token: *token, depth });
                    depth += u32::from(token.symbol == known::OPEN_BRACE);
                }
            }
            FilePart::Directive(Directive::If { .. } | Directive::Ifdef { .. }, _) => {
                open.push(depth)
            }
            FilePart::Directive(Directive::Elif { .. } | Directive::Else { .. }, _) => {
                depth = open.last().copied().unwrap_or(depth);
            }
            FilePart::Directive(Directive::Endif, _) => drop(open.pop()),
            FilePart::Directive(..) => {}
        }
    }
    found
}

/// For each opening parenthesis the one that closes it within its statement.
pub fn matching_parentheses(tokens: &[NestedToken]) -> Vec<Option<usize>> {
    let (mut found, mut open) = (vec![None; tokens.len()], Vec::new());
    for (at, placed) in tokens.iter().enumerate() {
        match placed.token.symbol {
            known::OPEN => open.push(at),
            known::CLOSE => {
                if let Some(start) = open.pop() {
                    found[start] = Some(at);
                }
            }
            known::OPEN_BRACE | known::CLOSE_BRACE => open.clear(),
            _ => {}
        }
    }
    found
}

/// For each opening brace the first token behind it that is not within it.
pub fn ends_of_blocks(tokens: &[NestedToken]) -> Vec<usize> {
    let (mut found, mut open) = (vec![tokens.len(); tokens.len()], Vec::new());
    for (at, placed) in tokens.iter().enumerate() {
        while let Some(start) =
            open.pop_if(|start: &mut usize| tokens[*start].depth >= placed.depth)
        {
            found[start] = at;
        }
        if placed.token.symbol == known::OPEN_BRACE {
            open.push(at);
        }
    }
    found
}

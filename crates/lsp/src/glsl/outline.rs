//! What a GLSL file declares, found in its tokens: the file need be neither complete nor correct.
//! Both branches of a conditional count.

use std::ops::Range;

use super::tokens::{NestedToken, ends_of_blocks, matching_parentheses, text_tokens};
use super::words::{QUALIFIERS, STATEMENTS, YOUNG_QUALIFIERS};
use lamplight_syntax::glsl::{Directive, FilePart, Module, Symbol, Symbols, TokenKind, known};

/// What a declaration is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SymbolKind {
    Function,
    Struct,
    Constant,
    Variable,
    Member,
    Macro,
}

/// A name that a file declares in global scope, or a member of a struct or block.
#[derive(Debug, Clone)]
pub struct GlslDeclaration {
    pub kind: SymbolKind,
    pub name: Symbol,
    /// The name's place.
    pub place: Range<u32>,
    /// The declaration, without the body of a function.
    pub range: Range<u32>,
    /// The declaration with the body of a function.
    pub whole: Range<u32>,
}

/// A parameter or a local variable.
#[derive(Debug, Clone)]
pub struct Local {
    pub name: Symbol,
    pub place: Range<u32>,
    /// From its type to its name.
    pub range: Range<u32>,
    /// Where its scope begins: after its initial value.
    pub start: u32,
    /// The end of its scope.
    pub end: u32,
}

impl Local {
    /// Whether its name stands for it at a byte, if no other local of the name was declared since.
    pub fn is_known(&self, byte: u32) -> bool {
        byte == self.place.start || (self.start <= byte && byte < self.end)
    }
}

/// What a file declares, in its order.
#[derive(Debug, Default)]
pub struct GlslOutline {
    pub declarations: Vec<GlslDeclaration>,
    pub locals: Vec<Local>,
}

/// The most headers (`for (...)`, `if (...)`) of one statement that are followed. A statement with
/// more counts as ending where its function does.
const HEADERS: usize = 64;

/// Reads the tokens of a file.
pub fn outline_of(module: &Module, symbols: &Symbols) -> GlslOutline {
    let tokens = text_tokens(module);
    let closes = matching_parentheses(&tokens);
    let ends = ends_of_blocks(&tokens);
    let mut reader =
        OutlineReader { tokens: &tokens, closes, ends, symbols, found: GlslOutline::default() };
    for part in &module.parts {
        if let FilePart::Directive(Directive::Define(found), span) = part {
            let place = found.name_span.start..found.name_span.end;
            let range = span.start..span.end;
            reader.declare(SymbolKind::Macro, found.name, place, range.clone(), range);
        }
    }
    let mut at = 0;
    while at < tokens.len() {
        at = reader.read_declaration(at).max(at + 1);
    }
    let mut found = reader.found;
    found.declarations.sort_by_key(|declaration| declaration.place.start);
    found
}

struct OutlineReader<'t> {
    tokens: &'t [NestedToken],
    closes: Vec<Option<usize>>,
    /// For each opening brace the first token that is not within it.
    ends: Vec<usize>,
    symbols: &'t Symbols,
    found: GlslOutline,
}

impl OutlineReader<'_> {
    fn symbol(&self, at: usize) -> Option<Symbol> {
        self.tokens.get(at).map(|placed| placed.token.symbol)
    }

    /// An identifier that is neither a qualifier nor begins a statement.
    fn is_name(&self, at: usize) -> bool {
        let Some(text) = self.word(at) else { return false };
        let is_qualifier = QUALIFIERS.contains(&text)
            || YOUNG_QUALIFIERS.contains(&text) && self.word(at + 1).is_some();
        !is_qualifier && !STATEMENTS.contains(&text)
    }

    fn word(&self, at: usize) -> Option<&str> {
        let token = &self.tokens.get(at)?.token;
        (token.kind == TokenKind::Identifier).then(|| self.symbols.text(token.symbol))
    }

    fn place(&self, at: usize) -> Range<u32> {
        self.tokens[at].token.start..self.tokens[at].token.end
    }

    /// From the first byte of a token to the last of another one.
    fn bytes(&self, first: usize, last: usize) -> Range<u32> {
        self.tokens[first].token.start..self.tokens[last.max(first)].token.end
    }

    fn declare(
        &mut self,
        kind: SymbolKind,
        name: Symbol,
        place: Range<u32>,
        range: Range<u32>,
        whole: Range<u32>,
    ) {
        self.found.declarations.push(GlslDeclaration { kind, name, place, range, whole });
    }

    /// The brace that closes the one at a token, or the last token before the end of its branch.
    fn close_of(&self, open: usize) -> usize {
        let next = self.ends[open];
        let is_brace = self.symbol(next) == Some(known::CLOSE_BRACE);
        if is_brace { next } else { next - 1 }
    }

    /// Reads one declaration at the top level; returns the token after it.
    fn read_declaration(&mut self, first: usize) -> usize {
        let mut at = first;
        let mut is_struct = false;
        while let Some(symbol) = self.symbol(at) {
            match symbol {
                known::SEMICOLON => {
                    self.declare_names(first, at);
                    return at + 1;
                }
                known::ASSIGN => {
                    let end = self.statement_end(at);
                    self.declare_names(first, end);
                    return end + 1;
                }
                known::STRUCT => is_struct = true,
                known::LAYOUT if self.symbol(at + 1) == Some(known::OPEN) => {
                    at = self.closes[at + 1].unwrap_or(at);
                }
                known::OPEN if at > first && self.is_name(at - 1) => {
                    return self.read_function(first, at);
                }
                known::OPEN_BRACE => return self.read_block(first, at, is_struct),
                known::CLOSE_BRACE => return at + 1,
                _ => {}
            }
            at += 1;
        }
        at
    }

    /// The semicolon that ends the statement of a token, or the last token.
    fn statement_end(&self, from: usize) -> usize {
        let depth = self.tokens[from].depth;
        let ends = |placed: &NestedToken| {
            placed.depth < depth
                || (placed.depth == depth && placed.token.symbol == known::SEMICOLON)
        };
        let found = self.tokens[from..].iter().position(ends);
        found.map_or(self.tokens.len() - 1, |offset| from + offset)
    }

    fn read_function(&mut self, first: usize, open: usize) -> usize {
        let Some(close) = self.closes[open] else { return open + 1 };
        let name = self.tokens[open - 1].token.symbol;
        let (place, range) = (self.place(open - 1), self.bytes(first, close));
        if self.symbol(close + 1) != Some(known::OPEN_BRACE) {
            let end = self.statement_end(close);
            if self.symbol(close + 1) == Some(known::SEMICOLON) && open - first > 1 {
                self.declare(SymbolKind::Function, name, place, range.clone(), range);
            }
            return end + 1;
        }
        let last = self.close_of(close + 1);
        self.declare(SymbolKind::Function, name, place, range, self.bytes(first, last));
        self.read_locals(open + 1, last);
        last + 1
    }

    /// A struct, or a block of uniforms, buffers, inputs or outputs.
    fn read_block(&mut self, first: usize, open: usize, is_struct: bool) -> usize {
        let last = self.close_of(open);
        let end = self.statement_end(last);
        if open > first && self.is_name(open - 1) {
            let kind = if is_struct { SymbolKind::Struct } else { SymbolKind::Variable };
            let whole = self.bytes(first, last);
            let (name, place) = (self.tokens[open - 1].token.symbol, self.place(open - 1));
            self.declare(kind, name, place, whole.clone(), whole);
        }
        let instance = (last + 1..end).find(|at| self.is_name(*at));
        let is_nameless = !is_struct && instance.is_none();
        let mut start = open + 1;
        while start < last {
            let next = self.statement_end(start).min(last);
            let kind = if is_nameless { SymbolKind::Variable } else { SymbolKind::Member };
            self.declare_each(kind, start, next);
            start = next + 1;
        }
        if let Some(at) = instance {
            let range = self.bytes(first, end.saturating_sub(1));
            let name = self.tokens[at].token.symbol;
            self.declare(SymbolKind::Variable, name, self.place(at), range.clone(), range);
        }
        end + 1
    }

    fn declare_names(&mut self, first: usize, end: usize) {
        let words = self.tokens[first..end].iter().map(|placed| placed.token.symbol);
        let is_constant = words.clone().any(|symbol| symbol == known::CONST);
        let kind = if is_constant { SymbolKind::Constant } else { SymbolKind::Variable };
        if !words.clone().any(|symbol| symbol == known::PRECISION) {
            self.declare_each(kind, first, end);
        }
    }

    fn declare_each(&mut self, kind: SymbolKind, first: usize, end: usize) {
        let range = self.bytes(first, end.min(self.tokens.len() - 1));
        for at in self.names_declared(first, end) {
            let name = self.tokens[at].token.symbol;
            self.declare(kind, name, self.place(at), range.clone(), range.clone());
        }
    }

    /// The names that a statement declares: the one after the type, and those after its commas.
    fn names_declared(&self, first: usize, end: usize) -> Vec<usize> {
        let mut found: Vec<usize> = Vec::new();
        let mut nested = 0_i32;
        for at in first..end.min(self.tokens.len()) {
            let symbol = self.tokens[at].token.symbol;
            match symbol {
                known::OPEN | known::OPEN_BRACKET | known::OPEN_BRACE => nested += 1,
                known::CLOSE | known::CLOSE_BRACKET | known::CLOSE_BRACE => nested -= 1,
                _ => {}
            }
            if nested != 0 || at == first || !self.is_name(at) {
                continue;
            }
            let before = self.tokens[at - 1].token.symbol;
            let is_typed = self.is_name(at - 1) || before == known::CLOSE_BRACKET;
            let is_next = before == known::COMMA && !found.is_empty();
            let is_ended = self.symbol(at + 1).is_none_or(|next| {
                let ends = [
                    known::ASSIGN,
                    known::SEMICOLON,
                    known::COMMA,
                    known::OPEN_BRACKET,
                    known::CLOSE,
                ];
                ends.contains(&next)
            });
            if is_ended && (is_next || (is_typed && found.is_empty())) {
                found.push(at);
            }
        }
        found
    }

    /// Parameters and variables between two tokens of a function. A variable is known to the end of
    /// its block, or of the statement whose header declares it; a parameter to that of the
    /// function.
    fn read_locals(&mut self, first: usize, last: usize) {
        let mut start = first;
        // For each open parenthesis the end of its statement, if statements begin within it.
        let mut open: Vec<Option<usize>> = Vec::new();
        let mut waiting: Vec<(u32, usize)> = Vec::new();
        for at in first..=last {
            let NestedToken { token, depth } = self.tokens[at];
            while let Some((_, local)) = waiting.pop_if(|(known, _)| *known > depth) {
                self.found.locals[local].end = token.end;
            }
            let header = open.last().copied().flatten();
            let ends = match token.symbol {
                known::OPEN => {
                    open.push(self.opens_header(at).then(|| self.statement_of_header(at, last)));
                    open.last().is_some_and(Option::is_some)
                }
                known::CLOSE => open.pop() != Some(None),
                known::COMMA => depth == 0 && open.is_empty(),
                known::OPEN_BRACE | known::CLOSE_BRACE => {
                    open.clear();
                    true
                }
                symbol => symbol == known::SEMICOLON,
            };
            if !ends {
                continue;
            }
            for name in self.names_declared(start, at) {
                if header.is_none() {
                    waiting.push((self.tokens[name].depth, self.found.locals.len()));
                }
                self.found.locals.push(Local {
                    name: self.tokens[name].token.symbol,
                    place: self.place(name),
                    range: self.bytes(start, name),
                    start: self.end_of_value(name, at),
                    end: self.tokens[header.unwrap_or(last)].token.end,
                });
            }
            start = at + 1;
        }
    }

    /// The first byte behind the initial value of a name that is declared, in a statement that ends
    /// at a token.
    fn end_of_value(&self, name: usize, end: usize) -> u32 {
        let mut nested = 0_i32;
        for at in name + 1..end {
            match self.tokens[at].token.symbol {
                known::OPEN | known::OPEN_BRACKET | known::OPEN_BRACE => nested += 1,
                known::CLOSE | known::CLOSE_BRACKET | known::CLOSE_BRACE => nested -= 1,
                known::COMMA if nested == 0 => return self.tokens[at].token.start,
                _ => {}
            }
        }
        self.tokens[end].token.start
    }

    /// The last token of the statement whose header begins at a parenthesis.
    fn statement_of_header(&self, open: usize, last: usize) -> usize {
        let mut at = self.closes[open].map_or(last, |close| close + 1);
        // Headers that follow this one are part of its statement: `for (...) if (...) x; else y;`.
        for _ in 0..HEADERS {
            let end = match self.symbol(at) {
                Some(known::OPEN_BRACE) => self.close_of(at),
                Some(known::ELSE) => {
                    at += 1;
                    continue;
                }
                Some(_)
                    if self.symbol(at + 1) == Some(known::OPEN) && self.opens_header(at + 1) =>
                {
                    at = self.closes[at + 1].map_or(last, |close| close + 1);
                    continue;
                }
                Some(_) => self.statement_end(at),
                None => return last,
            };
            if self.symbol(end + 1) != Some(known::ELSE) {
                return end.min(last);
            }
            at = end + 2;
        }
        last
    }

    /// Whether a parenthesis belongs to a `for`, `while`, `if` or `switch`.
    fn opens_header(&self, at: usize) -> bool {
        let before = at.checked_sub(1).map(|at| self.symbols.text(self.tokens[at].token.symbol));
        before.is_some_and(|word| STATEMENTS.contains(&word))
    }
}

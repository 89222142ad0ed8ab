//! Gives every bracket a partner in a text whose brackets do not match, as one that is being typed.
//!
//! Brackets are closed where the statement or the declaration that has them ends: no `;` stands
//! between round brackets, and `fn` begins a declaration wherever it stands. Where that does not
//! decide, columns do. What is added has no bytes, and what closes nothing is left out. So an open
//! bracket costs little more than the statement that it stands in.

use super::token::{Name, Token, TokenKind};
use lamplight_diagnostic::source::LIMITS;

/// The tokens with brackets added or left out so that all have partners.
pub fn balance_brackets(tokens: &[Token], text: &str) -> Vec<Token> {
    let mut balancer = Balancer::new(tokens, text);
    for at in 0..tokens.len() {
        balancer.token(at);
    }
    while !balancer.open.is_empty() {
        balancer.close_top();
    }
    with_partners(balancer.out)
}

/// A bracket that is not closed yet.
struct OpenBracket {
    mark: u8,
    /// The braces of a condition around declarations.
    is_of_items: bool,
    /// The column of the line that it belongs to: where the declaration begins, or its own line.
    column: usize,
    /// For the head of a `for`: how many of its two semicolons are still to come.
    semicolons: usize,
}

/// The declaration that is being read.
#[derive(Clone, Copy)]
struct OpenItem {
    column: usize,
    /// It ends with a brace, and not with a semicolon.
    is_braced: bool,
}

struct Balancer<'t> {
    tokens: &'t [Token],
    columns: Vec<Columns>,
    out: Vec<Token>,
    open: Vec<OpenBracket>,
    item: Option<OpenItem>,
    /// The first token of the statement.
    statement: usize,
}

/// Words that begin a declaration or a statement.
const EITHER: [Name; 3] = [Name::CONST, Name::VAR, Name::CONST_ASSERT];

/// Words that begin a directive.
const DIRECTIVES: [Name; 3] = [Name::ENABLE, Name::REQUIRES, Name::DIAGNOSTIC];

fn is_round(mark: u8) -> bool {
    mark != b'{'
}

impl<'t> Balancer<'t> {
    fn new(tokens: &'t [Token], text: &str) -> Self {
        let columns = columns_of(tokens, text);
        Self { tokens, columns, out: Vec::new(), open: Vec::new(), item: None, statement: 0 }
    }

    fn token(&mut self, at: usize) {
        match self.tokens[at].kind {
            TokenKind::Word(name) => self.word(at, name),
            TokenKind::Mark(b'{') => self.open_brace(at),
            TokenKind::Mark(mark @ (b'(' | b'[')) => self.open_bracket(at, mark),
            TokenKind::Mark(mark @ (b')' | b']')) => self.close_bracket(at, mark),
            TokenKind::Mark(b'}') => self.close_brace(at),
            TokenKind::Mark(b';') => self.semicolon(at),
            _ => self.out.push(self.tokens[at]),
        }
        let ends = [b'{', b'}', b';'].iter().any(|mark| self.is(at, *mark));
        if ends && !self.open.last().is_some_and(|top| is_round(top.mark)) {
            self.statement = at + 1;
        }
    }

    fn is(&self, at: usize, mark: u8) -> bool {
        is_mark(self.tokens, at, mark)
    }

    /// Whether everything that is open has declarations within.
    fn is_among_items(&self) -> bool {
        self.open.iter().all(|bracket| bracket.is_of_items)
    }

    fn word(&mut self, at: usize, name: Name) {
        let is_attribute = at > 0 && self.is(at - 1, b'@');
        if !is_attribute && self.begins_item(at, name) {
            self.end_items();
        } else if !is_attribute && name.begins_statement() {
            self.end_expression(at);
        }
        let is_item = name.begins_item() || EITHER.contains(&name) || DIRECTIVES.contains(&name);
        if is_item && !is_attribute && self.item.is_none() && self.is_among_items() {
            let first = attributes_before(self.tokens, at);
            let is_braced = matches!(name, Name::FN | Name::STRUCT);
            self.item = Some(OpenItem { column: self.line_column(first), is_braced });
        }
        self.out.push(self.tokens[at]);
    }

    /// Whether a word begins a declaration though something is open.
    fn begins_item(&self, at: usize, name: Name) -> bool {
        let is_named = |at: usize| {
            matches!(self.tokens.get(at).map(|next| next.kind), Some(TokenKind::Word(_)))
        };
        if self.item.is_none() && self.is_among_items() {
            return false;
        }
        if name.begins_item() {
            return is_named(at + 1);
        }
        let first = attributes_before(self.tokens, at);
        let is_first = self.begins_line(first) && self.column(first) == 0;
        EITHER.contains(&name) && is_first && !self.is_conditional(at)
    }

    /// Closes what is open before a declaration, whose attributes were taken already.
    fn end_items(&mut self) {
        let at = attributes_before(&self.out, self.out.len());
        let attributes = self.out.split_off(at);
        while !self.is_among_items() {
            self.close_top();
        }
        if self.item.take().is_some_and(|item| !item.is_braced) {
            self.add(b';');
        }
        self.out.extend(attributes);
    }

    /// Closes round and square brackets before a word that is in no expression, and ends the
    /// statement.
    fn end_expression(&mut self, at: usize) {
        let Some(top) = self.open.last().filter(|top| is_round(top.mark)) else { return };
        // A head is written in one line, up to its first declaration.
        if top.semicolons == HEAD && self.is_last(b'(') && !self.begins_line(at) {
            return;
        }
        self.close_round();
        self.add(b';');
    }

    fn is_last(&self, mark: u8) -> bool {
        self.out.last().is_some_and(|token| token.kind == TokenKind::Mark(mark))
    }

    fn close_round(&mut self) {
        while self.open.last().is_some_and(|top| is_round(top.mark)) {
            self.close_top();
        }
    }

    fn close_top(&mut self) {
        let Some(top) = self.open.pop() else { return };
        self.add(match top.mark {
            b'(' => b')',
            b'[' => b']',
            _ => b'}',
        });
    }

    /// A mark without bytes.
    fn add(&mut self, mark: u8) {
        let end = self.out.last().map_or(0, |token| token.end);
        self.out.push(Token { kind: TokenKind::Mark(mark), start: end, end, partner: 0 });
    }

    fn open_bracket(&mut self, at: usize, mark: u8) {
        if self.open.len() >= LIMITS.nesting {
            return;
        }
        let is_head =
            mark == b'(' && at > 0 && self.tokens[at - 1].kind == TokenKind::Word(Name::FOR);
        let semicolons = if is_head { HEAD } else { 0 };
        let column = self.line_column(at);
        self.open.push(OpenBracket { mark, is_of_items: false, column, semicolons });
        self.out.push(self.tokens[at]);
    }

    fn open_brace(&mut self, at: usize) {
        // No expression has braces.
        self.close_round();
        if self.open.len() >= LIMITS.nesting {
            return;
        }
        let is_outer = self.is_among_items();
        let column = match self.item {
            Some(item) if is_outer => item.column,
            _ => self.statement_column(at),
        };
        let is_of_items = is_outer && self.item.is_none();
        if is_of_items && !self.is_conditional(at) {
            return;
        }
        self.open.push(OpenBracket { mark: b'{', is_of_items, column, semicolons: 0 });
        self.out.push(self.tokens[at]);
    }

    /// Whether a condition stands before a token.
    fn is_conditional(&self, at: usize) -> bool {
        let name = self.tokens.get(attributes_before(self.tokens, at) + 1).map(|token| token.kind);
        matches!(name, Some(TokenKind::Word(Name::IF | Name::ELIF | Name::ELSE)))
    }

    fn close_bracket(&mut self, at: usize, mark: u8) {
        let opener = if mark == b')' { b'(' } else { b'[' };
        let within = self.open.iter().rev().take_while(|bracket| is_round(bracket.mark));
        let Some(above) = within.map(|bracket| bracket.mark).position(|found| found == opener)
        else {
            return;
        };
        (0..above).for_each(|_| self.close_top());
        self.open.pop();
        self.out.push(self.tokens[at]);
    }

    fn close_brace(&mut self, at: usize) {
        self.close_round();
        let Some(top) = self.open.last() else { return };
        let column = self.column(at);
        if self.begins_line(at) {
            if column >= top.column && self.goes_on_below(at, top.column) {
                return;
            }
            // A brace closes what begins in its column, if anything does.
            let inner = self.open.iter().rev().take_while(|bracket| bracket.column > column);
            let inner = inner.count();
            if inner < self.open.len() {
                (0..inner).for_each(|_| self.close_top());
            }
        }
        self.open.pop();
        self.out.push(self.tokens[at]);
        let ends_item = self.item.is_some_and(|item| item.is_braced) && self.is_among_items();
        self.item = self.item.filter(|_| !ends_item);
    }

    /// Whether the line after a closing brace goes on with what the brace would end: it begins to
    /// the right of that, and with no declaration.
    fn goes_on_below(&self, at: usize, column: usize) -> bool {
        let Some(next) = self.tokens.get(at + 1) else { return false };
        let is_statement = match next.kind {
            TokenKind::Word(name) => name != Name::ELSE && !name.begins_item(),
            TokenKind::Mark(mark) => mark == b'@',
            _ => false,
        };
        is_statement && self.begins_line(at + 1) && self.column(at + 1) > column
    }

    fn semicolon(&mut self, at: usize) {
        match self.open.last_mut() {
            Some(top) if top.semicolons > 0 => top.semicolons -= 1,
            _ => self.close_round(),
        }
        self.out.push(self.tokens[at]);
        if self.is_among_items() {
            self.item = None;
        }
    }

    fn column(&self, at: usize) -> usize {
        self.columns.get(at).map_or(0, |found| found.own)
    }

    fn line_column(&self, at: usize) -> usize {
        self.columns.get(at).map_or(0, |found| found.of_line)
    }

    fn begins_line(&self, at: usize) -> bool {
        self.column(at) == self.line_column(at)
    }

    /// The column of the line in which a statement begins that has a brace; an attribute is no part
    /// of it, unless it stands before the brace itself.
    fn statement_column(&self, brace: usize) -> usize {
        let mut at = self.statement;
        while self.is(at, b'@') && at < brace {
            at += 2;
            let mut depth = i32::from(self.is(at, b'('));
            while depth > 0 && at < brace {
                at += 1;
                depth += i32::from(self.is(at, b'(')) - i32::from(self.is(at, b')'));
                at += usize::from(depth == 0);
            }
        }
        self.line_column(if at < brace { at } else { self.statement })
    }
}

/// Where a token stands, in bytes from the start of its line.
#[derive(Clone, Copy)]
struct Columns {
    own: usize,
    /// Of the first token of its line.
    of_line: usize,
}

fn columns_of(tokens: &[Token], text: &str) -> Vec<Columns> {
    let (mut behind, mut line, mut of_line) = (0, 0, None);
    let columns = tokens.iter().map(|token| {
        let start = token.start as usize;
        if let Some(end) = text[behind..start].rfind('\n') {
            (line, of_line) = (behind + end + 1, None);
        }
        behind = token.end as usize;
        let own = start - line;
        Columns { own, of_line: *of_line.get_or_insert(own) }
    });
    columns.collect()
}

fn is_mark(tokens: &[Token], at: usize, mark: u8) -> bool {
    tokens.get(at).is_some_and(|token| token.kind == TokenKind::Mark(mark))
}

/// The most tokens in the brackets of an attribute that is looked for from its end.
const ATTRIBUTE: usize = 256;

/// The index of the first attribute before a token; its own where there is none.
fn attributes_before(tokens: &[Token], at: usize) -> usize {
    let mut first = at;
    loop {
        let Some(mut name) = first.checked_sub(1) else { return first };
        if is_mark(tokens, name, b')') {
            let Some(open) = opener_before(tokens, name) else { return first };
            name = open.saturating_sub(1);
        }
        let is_word = matches!(tokens[name].kind, TokenKind::Word(_));
        if !is_word || name == 0 || !is_mark(tokens, name - 1, b'@') {
            return first;
        }
        first = name - 1;
    }
}

/// The bracket that a closing one belongs to.
fn opener_before(tokens: &[Token], close: usize) -> Option<usize> {
    let mut depth = 0;
    for at in (close.saturating_sub(ATTRIBUTE)..=close).rev() {
        match tokens[at].kind {
            TokenKind::Mark(b')') => depth += 1,
            TokenKind::Mark(b'(') => depth -= 1,
            TokenKind::Mark(b';' | b'{') => return None,
            _ => {}
        }
        if depth == 0 {
            return Some(at);
        }
    }
    None
}

/// The semicolons in the head of a `for`.
const HEAD: usize = 2;

/// The tokens with the partner of each bracket. None where a bracket has no partner.
fn with_partners(mut tokens: Vec<Token>) -> Vec<Token> {
    let mut open: Vec<usize> = Vec::new();
    for at in 0..tokens.len() {
        tokens[at].partner = at as u32;
        match tokens[at].kind {
            TokenKind::Mark(b'(' | b'[' | b'{') => open.push(at),
            TokenKind::Mark(b')' | b']' | b'}') => {
                let Some(opener) = open.pop() else { return Vec::new() };
                tokens[at].partner = opener as u32;
                tokens[opener].partner = at as u32;
            }
            _ => {}
        }
    }
    if open.is_empty() { tokens } else { Vec::new() }
}

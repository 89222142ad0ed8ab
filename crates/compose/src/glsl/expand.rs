//! Macro expansion, with the C preprocessor's rules: arguments are expanded before they are
//! put in, the result is scanned again together with what follows it, and a macro is not
//! expanded inside its own expansion.

mod call;

use super::reads::Reads;
use super::table::{MacroMeaning, MacroTable};
use super::token::{NO_SETTING, NONE, Tok};
use crate::resolve::glsl::Graph;
use lamplight_diagnostic::source::LIMITS;
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_files::limits::count_steps;
use lamplight_syntax::glsl::{BodyToken, Macro, Module, Symbol, TokenKind, known};

/// An error that ends the composition.
pub type Fatal = Box<Diagnostic>;

/// Where tokens come from.
pub enum TokenInput<'t> {
    /// Tokens `at..end` of a module.
    Source { module: u32, at: u32, end: u32 },
    /// The tokens of a macro's argument, which were read before.
    Tokens { tokens: &'t [Tok], at: usize },
}

/// The state of macro expansion.
pub struct Expander<'g, 's> {
    pub graph: &'g Graph,
    pub table: MacroTable<'g>,
    pub reads: Reads<'s>,
    pub errors: Vec<Diagnostic>,
    /// What `#line` directives added to line numbers so far.
    pub line_shift: i64,
    /// The value of `__FILE__`.
    pub file_number: i64,
    /// Whether the language is GLSL ES, which has no `##`.
    pub es: bool,
    /// Whether the input is a condition, in which the name after `defined` is not expanded.
    pub in_condition: bool,
    frames: Vec<MacroFrame>,
    work: usize,
    bytes: usize,
    depth: usize,
}

/// The arguments of a call, and its closing parenthesis.
type Call = (Vec<Vec<Tok>>, Tok);

/// The expansion of a macro while it is scanned.
struct MacroFrame {
    tokens: Vec<Tok>,
    at: usize,
    name: Symbol,
}

impl<'g, 's> Expander<'g, 's> {
    /// Nothing expanded yet.
    pub fn new(graph: &'g Graph, table: MacroTable<'g>, reads: Reads<'s>, es: bool) -> Self {
        Self {
            graph,
            table,
            reads,
            errors: Vec::new(),
            line_shift: 0,
            file_number: 0,
            es,
            in_condition: false,
            frames: Vec::new(),
            work: 0,
            bytes: 0,
            depth: 0,
        }
    }

    /// Appends the expansion of the whole input.
    pub fn run(&mut self, mut input: TokenInput<'_>, out: &mut Vec<Tok>) -> Result<(), Fatal> {
        let floor = self.frames.len();
        // Where a macro expanded to nothing, the white space before it precedes the next token.
        let mut gap = None;
        loop {
            if self.frames.len() == floor {
                self.copy_plain(&mut input, out);
            }
            close_gap(&mut gap, out);
            let Some(token) = self.next(floor, &mut input) else { return Ok(()) };
            let length = out.len();
            self.token(token, floor, &mut input, out)?;
            close_gap(&mut gap, out);
            self.pop_finished(floor);
            if out.len() == length && self.frames.len() == floor && token.before != NONE {
                gap = gap.or(Some((length, token.before)));
            }
        }
    }

    /// Counts work against the limit of an expansion. Included text counts too.
    pub fn spend(
        &mut self,
        tokens: usize,
        bytes: usize,
        place: lamplight_diagnostic::source::Span,
    ) -> Result<(), Fatal> {
        self.work += tokens;
        count_steps(tokens as u64);
        self.bytes += bytes;
        if self.work > LIMITS.tokens || self.bytes > LIMITS.expansion_bytes {
            let message = format!(
                "the expansion has more than {} tokens or {} MiB",
                LIMITS.tokens,
                LIMITS.expansion_bytes >> 20
            );
            return Err(Box::new(
                Diagnostic::error(codes::EXPANSION_TOO_LARGE, message)
                    .at(place, "the limit is reached here"),
            ));
        }
        Ok(())
    }

    fn modules(&self) -> &'g [Module] {
        &self.graph.modules
    }

    /// Copies tokens up to the next name of a macro.
    fn copy_plain(&mut self, input: &mut TokenInput<'_>, out: &mut Vec<Tok>) {
        let defined = if self.in_condition { known::DEFINED } else { known::HASH };
        let is_plain = |kind, symbol| {
            kind != TokenKind::Identifier || (symbol != defined && !self.table.has(symbol))
        };
        match input {
            TokenInput::Source { module, at, end } => {
                let tokens =
                    &self.graph.modules[*module as usize].tokens[*at as usize..*end as usize];
                let plain =
                    tokens.iter().take_while(|token| is_plain(token.kind, token.symbol)).count();
                out.extend(
                    tokens[..plain]
                        .iter()
                        .zip(*at..)
                        .map(|(token, index)| Tok::copy(*module, index, token)),
                );
                *at += plain as u32;
            }
            TokenInput::Tokens { tokens, at } => {
                let plain = tokens[*at..]
                    .iter()
                    .take_while(|token| is_plain(token.kind, token.symbol))
                    .count();
                out.extend_from_slice(&tokens[*at..*at + plain]);
                *at += plain;
            }
        }
    }

    /// The next token: from the frames above index `floor`, which belong to this run, then from the
    /// input. The name of a macro inside its own expansion is marked, so that it is not expanded
    /// again.
    fn next(&mut self, floor: usize, input: &mut TokenInput<'_>) -> Option<Tok> {
        let mut token = self.take(floor, input)?;
        if token.kind == TokenKind::Identifier && self.table.is_active(token.symbol) {
            token.painted = true;
        }
        Some(token)
    }

    fn take(&mut self, floor: usize, input: &mut TokenInput<'_>) -> Option<Tok> {
        self.pop_finished(floor);
        if self.frames.len() > floor
            && let Some(frame) = self.frames.last_mut()
        {
            frame.at += 1;
            return Some(frame.tokens[frame.at - 1]);
        }
        let token = self.peek_input(input)?;
        match input {
            TokenInput::Source { at, .. } => *at += 1,
            TokenInput::Tokens { at, .. } => *at += 1,
        }
        Some(token)
    }

    fn peek(&mut self, floor: usize, input: &TokenInput<'_>) -> Option<Tok> {
        self.pop_finished(floor);
        match self.frames[floor..].last() {
            Some(frame) => frame.tokens.get(frame.at).copied(),
            None => self.peek_input(input),
        }
    }

    fn peek_input(&self, input: &TokenInput<'_>) -> Option<Tok> {
        match *input {
            TokenInput::Source { module, at, end } if at < end => Some(Tok::copy(
                module,
                at,
                &self.graph.modules[module as usize].tokens[at as usize],
            )),
            TokenInput::Source { .. } => None,
            TokenInput::Tokens { tokens, at } => tokens.get(at).copied(),
        }
    }

    fn pop_finished(&mut self, floor: usize) {
        while self.frames.len() > floor
            && self.frames.last().is_some_and(|frame| frame.at == frame.tokens.len())
        {
            if let Some(frame) = self.frames.pop() {
                self.table.set_active(frame.name, false);
            }
        }
    }

    fn token(
        &mut self,
        token: Tok,
        floor: usize,
        input: &mut TokenInput<'_>,
        out: &mut Vec<Tok>,
    ) -> Result<(), Fatal> {
        if token.kind != TokenKind::Identifier || token.painted {
            out.push(token);
            return Ok(());
        }
        if self.in_condition && token.symbol == known::DEFINED {
            self.copy_defined(token, floor, input, out);
            return Ok(());
        }
        match self.table.get(token.symbol) {
            None => out.push(token),
            Some(MacroMeaning::User { definition, .. }) => {
                return self.user(definition, token, floor, input, out);
            }
            Some(meaning) => {
                let (symbol, setting) = self.number(meaning, &token);
                out.push(Tok { symbol, setting, kind: TokenKind::Number, expanded: true, ..token });
            }
        }
        Ok(())
    }

    fn number(&mut self, meaning: MacroMeaning<'g>, token: &Tok) -> (Symbol, u16) {
        match meaning {
            MacroMeaning::Setting(setting) => (self.reads.symbol(setting), setting),
            MacroMeaning::Number(symbol) => (symbol, NO_SETTING),
            MacroMeaning::Line => {
                // In the body of a macro, it is the line in which the call ends.
                let at = if token.expanded { token.end.saturating_sub(1) } else { token.start };
                let line = self.modules()[token.module as usize].line(at) as i64 + self.line_shift;
                (self.table.spellings.intern(&line.to_string()), NO_SETTING)
            }
            MacroMeaning::File | MacroMeaning::User { .. } => {
                (self.table.spellings.intern(&self.file_number.to_string()), NO_SETTING)
            }
        }
    }

    /// Copies `defined NAME` or `defined(NAME)` without expanding it.
    fn copy_defined(
        &mut self,
        token: Tok,
        floor: usize,
        input: &mut TokenInput<'_>,
        out: &mut Vec<Tok>,
    ) {
        out.push(token);
        let open = self.peek(floor, input).is_some_and(|token| token.symbol == known::OPEN);
        for _ in 0..if open { 3 } else { 1 } {
            out.extend(self.take(floor, input));
        }
    }
}

fn close_gap(gap: &mut Option<(usize, u32)>, out: &mut [Tok]) {
    if let Some((index, before)) = *gap
        && let Some(token) = out.get_mut(index)
    {
        *gap = None;
        if token.before != NONE {
            token.before = before;
        }
    }
}

/// Whether two macros are defined alike, so that the second definition changes nothing.
pub fn same_definition(left: &Macro, right: &Macro) -> bool {
    let equal = |(left, right): (&BodyToken, &BodyToken)| left == right;
    left.parameters == right.parameters
        && left.body.len() == right.body.len()
        && left.body.iter().zip(&right.body).all(equal)
}

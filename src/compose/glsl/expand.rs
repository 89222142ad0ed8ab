//! Macro expansion, with the C preprocessor's rules: arguments are expanded before they are
//! put in, the result is scanned again together with what follows it, and a macro is not
//! expanded inside its own expansion.

use super::reads::Reads;
use super::table::{Meaning, Table};
use super::token::{NO_SETTING, NONE, Tok};
use crate::diagnostic::{Diagnostic, codes};
use crate::parse::glsl::{BodyToken, Kind, Macro, Module, Symbol, known, single_token};
use crate::resolve::glsl::Graph;
use crate::source::LIMITS;

/// An error that ends the composition.
pub type Fatal = Box<Diagnostic>;

/// Where tokens come from.
pub enum Input<'t> {
    /// Tokens `at..end` of a module.
    Source { module: u32, at: u32, end: u32 },
    /// Tokens that were read before.
    Tokens { tokens: &'t [Tok], at: usize },
}

/// The state of macro expansion.
pub struct Expander<'g, 's> {
    pub graph: &'g Graph,
    pub table: Table<'g>,
    pub reads: Reads<'s>,
    pub errors: Vec<Diagnostic>,
    /// What `#line` added to the line numbers of the current file.
    pub line_shift: i64,
    /// `__FILE__`.
    pub file_number: i64,
    /// GLSL ES has no `##`.
    pub es: bool,
    /// In a condition `defined NAME` leaves the name alone.
    pub in_condition: bool,
    frames: Vec<Frame>,
    work: usize,
    bytes: usize,
    depth: usize,
}

/// The arguments of a call, and its closing parenthesis.
type Call = (Vec<Vec<Tok>>, Tok);

/// The expansion of a macro while it is scanned.
struct Frame {
    tokens: Vec<Tok>,
    at: usize,
    name: Symbol,
}

impl<'g, 's> Expander<'g, 's> {
    /// Nothing expanded yet.
    pub fn new(graph: &'g Graph, table: Table<'g>, reads: Reads<'s>, es: bool) -> Self {
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
    pub fn run(&mut self, mut input: Input<'_>, out: &mut Vec<Tok>) -> Result<(), Fatal> {
        let floor = self.frames.len();
        // Where a macro expanded to nothing, what stood before it stands before the next token.
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

    /// Counts included text as expansion too.
    pub fn spend(
        &mut self,
        tokens: usize,
        bytes: usize,
        place: crate::source::Span,
    ) -> Result<(), Fatal> {
        self.work += tokens;
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

    /// Copies up to the next name of a macro.
    fn copy_plain(&mut self, input: &mut Input<'_>, out: &mut Vec<Tok>) {
        let defined = if self.in_condition { known::DEFINED } else { known::HASH };
        let is_plain = |kind, symbol| {
            kind != Kind::Identifier || (symbol != defined && !self.table.has(symbol))
        };
        match input {
            Input::Source { module, at, end } => {
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
            Input::Tokens { tokens, at } => {
                let plain = tokens[*at..]
                    .iter()
                    .take_while(|token| is_plain(token.kind, token.symbol))
                    .count();
                out.extend_from_slice(&tokens[*at..*at + plain]);
                *at += plain;
            }
        }
    }

    /// The next token, from expansions above `floor` first; a macro inside its own is painted.
    fn next(&mut self, floor: usize, input: &mut Input<'_>) -> Option<Tok> {
        let mut token = self.take(floor, input)?;
        if token.kind == Kind::Identifier && self.table.is_active(token.symbol) {
            token.painted = true;
        }
        Some(token)
    }

    fn take(&mut self, floor: usize, input: &mut Input<'_>) -> Option<Tok> {
        self.pop_finished(floor);
        if self.frames.len() > floor
            && let Some(frame) = self.frames.last_mut()
        {
            frame.at += 1;
            return Some(frame.tokens[frame.at - 1]);
        }
        let token = self.peek_input(input)?;
        match input {
            Input::Source { at, .. } => *at += 1,
            Input::Tokens { at, .. } => *at += 1,
        }
        Some(token)
    }

    fn peek(&mut self, floor: usize, input: &Input<'_>) -> Option<Tok> {
        self.pop_finished(floor);
        match self.frames[floor..].last() {
            Some(frame) => frame.tokens.get(frame.at).copied(),
            None => self.peek_input(input),
        }
    }

    fn peek_input(&self, input: &Input<'_>) -> Option<Tok> {
        match *input {
            Input::Source { module, at, end } if at < end => Some(Tok::copy(
                module,
                at,
                &self.graph.modules[module as usize].tokens[at as usize],
            )),
            Input::Source { .. } => None,
            Input::Tokens { tokens, at } => tokens.get(at).copied(),
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
        input: &mut Input<'_>,
        out: &mut Vec<Tok>,
    ) -> Result<(), Fatal> {
        if token.kind != Kind::Identifier || token.painted {
            out.push(token);
            return Ok(());
        }
        if self.in_condition && token.symbol == known::DEFINED {
            self.copy_defined(token, floor, input, out);
            return Ok(());
        }
        match self.table.get(token.symbol) {
            None => out.push(token),
            Some(Meaning::User { definition, .. }) => {
                return self.user(definition, token, floor, input, out);
            }
            Some(meaning) => {
                let (symbol, setting) = self.number(meaning, &token);
                out.push(Tok { symbol, setting, kind: Kind::Number, expanded: true, ..token });
            }
        }
        Ok(())
    }

    fn number(&mut self, meaning: Meaning<'g>, token: &Tok) -> (Symbol, u16) {
        match meaning {
            Meaning::Setting(setting) => (self.reads.symbol(setting), setting),
            Meaning::Number(symbol) => (symbol, NO_SETTING),
            Meaning::Line => {
                let line = self.modules()[token.module as usize].line(token.start) as i64
                    + self.line_shift;
                (self.table.spellings.intern(&line.to_string()), NO_SETTING)
            }
            Meaning::File | Meaning::User { .. } => {
                (self.table.spellings.intern(&self.file_number.to_string()), NO_SETTING)
            }
        }
    }

    /// `defined NAME` or `defined(NAME)`, unexpanded.
    fn copy_defined(
        &mut self,
        token: Tok,
        floor: usize,
        input: &mut Input<'_>,
        out: &mut Vec<Tok>,
    ) {
        out.push(token);
        let open = self.peek(floor, input).is_some_and(|token| token.symbol == known::OPEN);
        for _ in 0..if open { 3 } else { 1 } {
            out.extend(self.take(floor, input));
        }
    }

    fn user(
        &mut self,
        definition: &'g Macro,
        name: Tok,
        floor: usize,
        input: &mut Input<'_>,
        out: &mut Vec<Tok>,
    ) -> Result<(), Fatal> {
        let Some(parameters) = definition.parameters else {
            return self.replace(definition, name, name, &[]);
        };
        if self.peek(floor, input).is_none_or(|token| token.symbol != known::OPEN) {
            out.push(name);
            return Ok(());
        }
        let Some((arguments, close)) = self.arguments(name, floor, input)? else {
            self.call_error(
                name,
                definition,
                "is not closed before the next directive or the end of the file".into(),
            );
            return Ok(());
        };
        let given = if parameters == 0 && arguments.iter().all(Vec::is_empty) {
            0
        } else {
            arguments.len()
        };
        if given != parameters {
            self.call_error(name, definition, format!("has {given} arguments, not {parameters}"));
            return Ok(());
        }
        self.replace(definition, name, close, &arguments)
    }

    fn call_error(&mut self, name: Tok, definition: &Macro, what: String) {
        let text = self.table.spellings.text(name.symbol);
        let error =
            Diagnostic::error(codes::MACRO_ARGUMENTS, format!("the call of macro `{text}` {what}"));
        self.errors.push(
            error
                .at(name.span(self.modules()), "called here")
                .at(definition.name_span, "defined here"),
        );
    }

    /// The arguments between the parentheses, and the closing one; `None` where that is missing.
    fn arguments(
        &mut self,
        name: Tok,
        floor: usize,
        input: &mut Input<'_>,
    ) -> Result<Option<Call>, Fatal> {
        self.take(floor, input);
        let mut arguments = vec![Vec::new()];
        let mut depth = 0usize;
        while let Some(token) = self.next(floor, input) {
            match token.symbol {
                known::CLOSE if depth == 0 => return Ok(Some((arguments, token))),
                known::COMMA if depth == 0 => {
                    arguments.push(Vec::new());
                    continue;
                }
                known::OPEN => depth += 1,
                known::CLOSE => depth -= 1,
                _ => {}
            }
            if depth > LIMITS.nesting {
                return Err(Box::new(self.too_deep(&token)));
            }
            // The tokens of nested calls are read once for each level.
            self.spend(1, 0, name.span(self.modules()))?;
            if let Some(argument) = arguments.last_mut() {
                argument.push(Tok { before: NONE, after: NONE, ..token });
            }
        }
        Ok(None)
    }

    fn too_deep(&self, token: &Tok) -> Diagnostic {
        let message = format!("macro calls nest deeper than {}", LIMITS.nesting);
        Diagnostic::error(codes::NESTING_TOO_DEEP, message)
            .at(token.span(self.modules()), "one too many")
    }

    /// Puts the macro's body, with its arguments, in front of what is still to be scanned.
    fn replace(
        &mut self,
        definition: &'g Macro,
        name: Tok,
        close: Tok,
        arguments: &[Vec<Tok>],
    ) -> Result<(), Fatal> {
        let end =
            if close.module == name.module && close.end > name.end { close.end } else { name.end };
        let site = Tok {
            end,
            before: NONE,
            after: NONE,
            expanded: true,
            setting: NO_SETTING,
            painted: false,
            ..name
        };
        let mut tokens = self.substitute(definition, site, arguments)?;
        let bytes =
            tokens.iter().map(|token| self.table.spellings.text(token.symbol).len() + 1).sum();
        self.spend(tokens.len() + 1, bytes, name.span(self.modules()))?;
        if let Some(first) = tokens.first_mut() {
            first.before = name.before;
            first.spaced = name.spaced;
        }
        if let Some(last) = tokens.last_mut() {
            last.after = close.after;
        }
        self.table.set_active(definition.name, true);
        self.frames.push(Frame { tokens, at: 0, name: definition.name });
        Ok(())
    }

    fn substitute(
        &mut self,
        definition: &'g Macro,
        site: Tok,
        arguments: &[Vec<Tok>],
    ) -> Result<Vec<Tok>, Fatal> {
        let mut result = Vec::with_capacity(definition.body.len());
        let mut expanded: Vec<Option<Vec<Tok>>> = vec![None; arguments.len()];
        // Whether the left operand of a pending `##` has a token.
        let (mut pasting, mut has_left) = (false, false);
        for body in &definition.body {
            let own = [Tok { symbol: body.symbol, kind: body.kind, spaced: body.spaced, ..site }];
            let piece = match body.parameter.map(usize::from) {
                None => &own[..],
                Some(index) if pasting || body.pasted => &arguments[index],
                Some(index) => self.expanded(&mut expanded[index], &arguments[index], &site)?,
            };
            let right = self.paste(&mut result, piece, pasting && has_left, &site);
            let spaced = right.len() == piece.len();
            let length = result.len();
            result.extend_from_slice(right);
            if let (true, Some(first)) = (spaced, result.get_mut(length)) {
                first.spaced = body.spaced;
            }
            has_left = !piece.is_empty() || (pasting && has_left);
            pasting = body.pasted;
        }
        Ok(result)
    }

    fn expanded<'a>(
        &mut self,
        cache: &'a mut Option<Vec<Tok>>,
        argument: &[Tok],
        site: &Tok,
    ) -> Result<&'a [Tok], Fatal> {
        if cache.is_none() {
            let mut tokens = Vec::with_capacity(argument.len());
            self.depth += 1;
            if self.depth > LIMITS.nesting {
                return Err(Box::new(self.too_deep(site)));
            }
            self.run(Input::Tokens { tokens: argument, at: 0 }, &mut tokens)?;
            self.depth -= 1;
            *cache = Some(tokens);
        }
        Ok(cache.as_deref().unwrap_or_default())
    }

    /// Joins the last token of `left` with the first of `right` if asked to; what is left of `right`.
    fn paste<'a>(
        &mut self,
        left: &mut Vec<Tok>,
        right: &'a [Tok],
        join: bool,
        site: &Tok,
    ) -> &'a [Tok] {
        let (true, Some(last), Some((first, rest))) =
            (join, left.last().copied(), right.split_first())
        else {
            return right;
        };
        for token in [&last, first] {
            if token.setting != NO_SETTING {
                // The name that comes out depends on the value, so the value is asked for. A value
                // that is not declared is reported where it is used as a number.
                let _ = self.reads.read(token.setting);
            }
        }
        let text = format!(
            "{}{}",
            self.table.spellings.text(last.symbol),
            self.table.spellings.text(first.symbol)
        );
        match single_token(&text) {
            Some(kind) if !self.es => {
                let symbol = self.table.spellings.intern(&text);
                left.pop();
                left.push(Tok { symbol, kind, spaced: last.spaced, ..*site });
                rest
            }
            _ => {
                let message = if self.es {
                    "GLSL ES has no `##`".to_owned()
                } else {
                    format!("`##` makes `{text}`, which is not a token")
                };
                self.errors.push(
                    Diagnostic::error(codes::BAD_PASTE, message)
                        .at(site.span(self.modules()), "in this expansion"),
                );
                right
            }
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

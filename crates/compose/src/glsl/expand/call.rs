//! Calls of the author's macros: reads their arguments, and replaces each call by the macro's body.

use super::{Call, Expander, Fatal, MacroFrame, TokenInput};
use crate::glsl::token::{NO_SETTING, NONE, Tok};
use lamplight_diagnostic::source::LIMITS;
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_syntax::glsl::{Macro, known, single_token};

impl<'g> Expander<'g, '_> {
    pub(super) fn user(
        &mut self,
        definition: &'g Macro,
        name: Tok,
        floor: usize,
        input: &mut TokenInput<'_>,
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

    /// Reads the arguments of a call. Returns them with the closing parenthesis, or `None` if that
    /// is missing.
    fn arguments(
        &mut self,
        name: Tok,
        floor: usize,
        input: &mut TokenInput<'_>,
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
            // Counted as work, since the tokens of nested calls are read once for each level.
            self.spend(1, 0, name.span(self.modules()))?;
            if let Some(argument) = arguments.last_mut() {
                argument.push(Tok { before: NONE, after: NONE, ..token });
            }
        }
        Ok(None)
    }

    pub(super) fn too_deep(&self, token: &Tok) -> Diagnostic {
        let message = format!("macro calls nest deeper than {}", LIMITS.nesting);
        Diagnostic::error(codes::NESTING_TOO_DEEP, message)
            .at(token.span(self.modules()), "one too many")
    }

    /// Puts the macro's body, with its arguments, before what is still to be scanned.
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
        self.frames.push(MacroFrame { tokens, at: 0, name: definition.name });
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
        // Whether a `##` is pending, and whether its left operand has a token.
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
            self.run(TokenInput::Tokens { tokens: argument, at: 0 }, &mut tokens)?;
            self.depth -= 1;
            *cache = Some(tokens);
        }
        Ok(cache.as_deref().unwrap_or_default())
    }

    /// Joins the last token of `left` with the first of `right`, if asked to. Returns what remains
    /// of `right`.
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
                // The new name depends on the setting's value, so the setting counts as read. A
                // value that its axis does not declare is reported where it is used as a number.
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

//! Reads directives.

use super::{
    BodyToken, DIRECTIVES, Directive, FilePart, Include, Macro, Module, Symbol, Symbols, Token,
    TokenKind, known,
};
use lamplight_diagnostic::source::{LIMITS, Span};
use lamplight_diagnostic::{Code, Diagnostic, codes};

/// Reads the directive whose `#` is token `hash` and whose line ends before token `end`.
pub fn push_directive(module: &mut Module, hash: usize, end: usize, symbols: &Symbols) {
    let span = Span::new(
        module.source,
        module.tokens[hash].start as usize..module.tokens[end - 1].end as usize,
    );
    let directive = read_directive(module, hash + 1, end, symbols)
        .unwrap_or_else(|error| Directive::Invalid(Box::new(error)));
    module.parts.push(FilePart::Directive(directive, span));
}

/// A conditional whose `#endif` was not reached yet.
struct OpenConditional {
    /// Its branches so far, as indices of parts.
    branches: Vec<usize>,
    otherwise: Option<Span>,
}

/// Connects the branches of every conditional; unbalanced ones are errors of the module.
pub fn link_branches(module: &mut Module) {
    let mut open: Vec<OpenConditional> = Vec::new();
    for index in 0..module.parts.len() {
        let FilePart::Directive(directive, span) = &module.parts[index] else { continue };
        let span = *span;
        match directive {
            Directive::If { .. } | Directive::Ifdef { .. } => {
                open.push(OpenConditional { branches: vec![index], otherwise: None })
            }
            Directive::Elif { .. } | Directive::Else { .. } => {
                let otherwise = matches!(directive, Directive::Else { .. }).then_some(span);
                let error = check_branch(open.last_mut(), index, span, otherwise).err();
                module.errors.extend(error);
            }
            Directive::Endif => match open.pop() {
                Some(mut last) => {
                    last.branches.push(index);
                    connect_branches(&mut module.parts, &last.branches);
                }
                None => module.errors.push(nothing_open(span)),
            },
            _ => {}
        }
        if open.len() > LIMITS.nesting {
            let message = format!("conditionals nest deeper than {}", LIMITS.nesting);
            module
                .errors
                .push(Diagnostic::error(codes::NESTING_TOO_DEEP, message).at(span, "one too many"));
            return;
        }
    }
    for open in open {
        if let FilePart::Directive(_, span) = &module.parts[open.branches[0]] {
            let error =
                unbalanced_directive("a conditional is never closed", *span, "without an `#endif`");
            module
                .errors
                .push(error.note("help: write `#endif` on a line of its own where it ends"));
        }
    }
}

fn check_branch(
    open: Option<&mut OpenConditional>,
    index: usize,
    span: Span,
    otherwise: Option<Span>,
) -> Result<(), Diagnostic> {
    let open = open.ok_or_else(|| nothing_open(span))?;
    if let Some(earlier) = open.otherwise {
        let message = "a branch follows the `#else` of its conditional";
        return Err(unbalanced_directive(message, span, "this branch").at(earlier, "the `#else`"));
    }
    open.branches.push(index);
    open.otherwise = otherwise;
    Ok(())
}

fn nothing_open(span: Span) -> Diagnostic {
    unbalanced_directive("no conditional is open here", span, "without an `#if` before it")
}

fn unbalanced_directive(message: &str, span: Span, label: &str) -> Diagnostic {
    Diagnostic::error(codes::UNBALANCED_CONDITIONAL, message).at(span, label)
}

fn connect_branches(parts: &mut [FilePart], branches: &[usize]) {
    let last = branches[branches.len() - 1];
    for pair in branches.windows(2) {
        let FilePart::Directive(directive, _) = &mut parts[pair[0]] else { continue };
        match directive {
            Directive::If { next, .. } | Directive::Ifdef { next, .. } => *next = pair[1],
            Directive::Elif { next, end, .. } => (*next, *end) = (pair[1], last),
            Directive::Else { end } => *end = last,
            _ => {}
        }
    }
}

/// Reads the tokens `start..end` after the `#`.
fn read_directive(
    module: &mut Module,
    start: usize,
    end: usize,
    symbols: &Symbols,
) -> Result<Directive, Diagnostic> {
    if start == end {
        return Ok(Directive::Empty);
    }
    let line = DirectiveTokens { module, start: start + 1, end, symbols };
    // A text behind these is an error, and they still end a branch: the rest would be unbalanced. What
    // continues a conditional in other languages is an error in a group that is skipped too.
    let error = line.extra_of_branch().or_else(|| line.foreign_branch());
    module.errors.extend(error);
    let line = DirectiveTokens { module, start: start + 1, end, symbols };
    let condition = start as u32 + 1..end as u32;
    match line.module.tokens[start].symbol {
        known::INCLUDE => {
            let include = line.include()?;
            module.includes.push(include);
            Ok(Directive::Include(module.includes.len() - 1))
        }
        known::DEFINE => line.define().map(Directive::Define),
        known::UNDEF => line.only_name("undef").map(Directive::Undef),
        known::IF => Ok(Directive::If { condition, next: 0 }),
        known::IFDEF => Ok(line.ifdef("ifdef", false)),
        known::IFNDEF => Ok(line.ifdef("ifndef", true)),
        known::ELIF => Ok(Directive::Elif { condition, next: 0, end: 0 }),
        known::ELSE => Ok(Directive::Else { end: 0 }),
        known::ENDIF => Ok(Directive::Endif),
        known::ERROR => Ok(Directive::Error(line.rest())),
        known::LINE => Ok(Directive::Line(condition)),
        known::VERSION => line.version(),
        known::EXTENSION => line.extension(),
        known::PRAGMA if line.token(0).is_some_and(|token| token.symbol == known::ONCE) => {
            Ok(Directive::PragmaOnce)
        }
        known::PRAGMA => Ok(Directive::Pragma(line.whole())),
        // The error is known.
        _ if line.foreign_branch().is_some() => Ok(Directive::Empty),
        wrong => {
            let name = symbols.text(wrong);
            Err(line.unknown(name).suggest(name, DIRECTIVES.iter().copied()))
        }
    }
}

/// The tokens after a directive's name.
struct DirectiveTokens<'m> {
    module: &'m Module,
    start: usize,
    end: usize,
    symbols: &'m Symbols,
}

impl DirectiveTokens<'_> {
    fn token(&self, index: usize) -> Option<&Token> {
        self.module.tokens[self.start..self.end].get(index)
    }

    fn span_of(&self, token: &Token) -> Span {
        Span::new(self.module.source, token.range())
    }

    /// From the `#` to the last token.
    fn whole(&self) -> Span {
        let tokens = &self.module.tokens;
        Span::new(
            self.module.source,
            tokens[self.start - 2].start as usize..tokens[self.end - 1].end as usize,
        )
    }

    /// The span after the directive's name; that of the name where nothing follows.
    fn rest(&self) -> Span {
        let tokens = &self.module.tokens;
        let first = self.start.min(self.end - 1);
        Span::new(
            self.module.source,
            tokens[first].start as usize..tokens[self.end - 1].end as usize,
        )
    }

    /// A text behind `#else` or `#endif`.
    fn extra_of_branch(&self) -> Option<Diagnostic> {
        let directive = match self.module.tokens[self.start - 1].symbol {
            known::ELSE => "else",
            known::ENDIF => "endif",
            _ => return None,
        };
        let extra = self.token(0)?;
        let message = format!("unexpected text after `#{directive}`");
        let error = Diagnostic::error(codes::MALFORMED_DIRECTIVE, message);
        let error = error.at(self.span_of(extra), "not part of the directive");
        Some(error.note("help: put it behind `//`"))
    }

    fn malformed(&self, message: String, label: &str) -> Diagnostic {
        Diagnostic::error(codes::MALFORMED_DIRECTIVE, message).at(self.rest(), label)
    }

    /// A directive that continues a conditional in other languages.
    fn foreign_branch(&self) -> Option<Diagnostic> {
        let name = self.symbols.text(self.module.tokens[self.start - 1].symbol);
        let condition = self.token(0).map_or("NAME", |token| self.symbols.text(token.symbol));
        let own = match name {
            "elifdef" => format!("#elif defined({condition})"),
            "elifndef" => format!("#elif !defined({condition})"),
            "elseif" | "elsif" | "elseifdef" => "#elif".to_owned(),
            _ => return None,
        };
        Some(self.unknown(name).note(format!("help: a conditional goes on with `{own}`")))
    }

    fn unknown(&self, name: &str) -> Diagnostic {
        let message = format!("unknown directive `#{name}`");
        Diagnostic::error(codes::MALFORMED_DIRECTIVE, message)
            .at(self.span_of(&self.module.tokens[self.start - 1]), "not a directive of GLSL")
    }

    fn name(&self, directive: &str) -> Result<(Symbol, Span), Diagnostic> {
        match self.token(0) {
            Some(token) if token.kind == TokenKind::Identifier => {
                Ok((token.symbol, self.span_of(token)))
            }
            _ => {
                Err(self
                    .malformed(format!("`#{directive}` needs the name of a macro"), "no name here"))
            }
        }
    }

    fn only_name(&self, directive: &str) -> Result<Symbol, Diagnostic> {
        let (symbol, span) = self.name(directive)?;
        if let Some(extra) = self.token(1) {
            let message =
                format!("unexpected text after `#{directive} {}`", self.symbols.text(symbol));
            return Err(Diagnostic::error(codes::MALFORMED_DIRECTIVE, message)
                .at(self.span_of(extra), "not part of the directive"));
        }
        if directive == "undef" && is_reserved(self.symbols.text(symbol)) {
            return Err(self.reserved(symbol, span));
        }
        Ok(symbol)
    }

    /// Reads `#ifdef` or `#ifndef`. A malformed one still opens a conditional, since the rest of
    /// the file would be unbalanced otherwise.
    fn ifdef(&self, directive: &str, negated: bool) -> Directive {
        Directive::Ifdef { name: self.only_name(directive).map_err(Box::new), negated, next: 0 }
    }

    fn reserved(&self, name: Symbol, span: Span) -> Diagnostic {
        let code: &'static Code = codes::RESERVED_MACRO;
        Diagnostic::error(code, format!("the macro name `{}` is reserved", self.symbols.text(name)))
            .at(span, "cannot be defined or undefined")
    }

    /// Reads the path from the raw text, since a path does not consist of tokens.
    fn include(&self) -> Result<Include, Diagnostic> {
        let rest = self.rest();
        let text = &self.module.text[rest.start as usize..];
        let text = text.lines().next().unwrap_or_default();
        let close = match text.as_bytes().first() {
            Some(b'"') => '"',
            Some(b'<') => '>',
            _ => {
                return Err(self.malformed(
                    "`#include` needs a path".into(),
                    "expected `\"path\"` or `<path>`",
                ));
            }
        };
        let Some(length) = text[1..].find(close).filter(|length| *length > 0) else {
            return Err(self.malformed(
                "the path of an `#include` is empty or not closed".into(),
                "expected `\"path\"` or `<path>`",
            ));
        };
        let start = rest.start as usize;
        let span = Span::new(self.module.source, start..start + length + 2);
        let extra =
            self.module.tokens[self.start..self.end].iter().find(|token| token.start >= span.end);
        match extra {
            Some(extra) => Err(Diagnostic::error(
                codes::MALFORMED_DIRECTIVE,
                "unexpected text after the path of an `#include`",
            )
            .at(self.span_of(extra), "not part of the directive")),
            None => Ok(Include { path: text[1..=length].to_owned(), angled: close == '>', span }),
        }
    }

    fn define(&self) -> Result<Macro, Diagnostic> {
        let (name, name_span) = self.name("define")?;
        if is_reserved(self.symbols.text(name)) {
            return Err(self.reserved(name, name_span));
        }
        let parameters = match self.token(1) {
            Some(open) if open.symbol == known::OPEN && !open.spaced => Some(self.parameters()?),
            _ => None,
        };
        let body_start = self.start + 1 + parameters.as_ref().map_or(0, |(_, length)| *length);
        let names = parameters.map(|(names, _)| names);
        let body = self.body(body_start, names.as_deref().unwrap_or_default())?;
        Ok(Macro { name, name_span, parameters: names.map(|names| names.len()), body })
    }

    /// The names between the parentheses, and the number of tokens, parentheses included.
    fn parameters(&self) -> Result<(Vec<Symbol>, usize), Diagnostic> {
        let mut names = Vec::new();
        let mut index = 2;
        if self.token(index).is_some_and(|token| token.symbol == known::CLOSE) {
            return Ok((names, 2));
        }
        loop {
            match self.token(index) {
                Some(token)
                    if token.kind == TokenKind::Identifier
                        && names.len() < LIMITS.nesting
                        && !names.contains(&token.symbol) =>
                {
                    names.push(token.symbol)
                }
                found => return Err(self.parameter_error(found)),
            }
            match self.token(index + 1) {
                Some(token) if token.symbol == known::CLOSE => {
                    return Ok((names, index + 1));
                }
                Some(token) if token.symbol == known::COMMA => index += 2,
                found => return Err(self.parameter_error(found)),
            }
        }
    }

    fn parameter_error(&self, found: Option<&Token>) -> Diagnostic {
        let message =
            "the parameters of a macro are different names, separated by commas, at most 256";
        let span = found.map_or(self.rest(), |token| self.span_of(token));
        Diagnostic::error(codes::MALFORMED_DIRECTIVE, message).at(span, "not so here")
    }

    fn body(&self, start: usize, parameters: &[Symbol]) -> Result<Vec<BodyToken>, Diagnostic> {
        let mut body: Vec<BodyToken> = Vec::with_capacity(self.end - start);
        for (offset, token) in self.module.tokens[start..self.end].iter().enumerate() {
            let paste = token.symbol == known::PASTE;
            if token.symbol == known::HASH {
                let message = "GLSL has no stringizing operator `#`";
                return Err(Diagnostic::error(codes::MALFORMED_DIRECTIVE, message)
                    .at(self.span_of(token), "in the body of a macro"));
            }
            if paste && (offset == 0 || start + offset + 1 == self.end) {
                let message = "`##` needs a token on both sides";
                return Err(Diagnostic::error(codes::BAD_PASTE, message)
                    .at(self.span_of(token), "at the edge of the macro's body"));
            }
            match body.last_mut() {
                Some(last) if paste => last.pasted = true,
                _ => body.push(BodyToken {
                    symbol: token.symbol,
                    kind: token.kind,
                    spaced: token.spaced && offset > 0,
                    parameter: parameters
                        .iter()
                        .position(|name| *name == token.symbol)
                        .map(|index| index as u16),
                    pasted: false,
                }),
            }
        }
        Ok(body)
    }

    fn version(&self) -> Result<Directive, Diagnostic> {
        let number = self.token(0).and_then(|token| self.symbols.text(token.symbol).parse().ok());
        let profile = self.token(1).map(|token| self.symbols.text(token.symbol));
        match (number, profile, self.token(2)) {
            (Some(number), None | Some("core" | "compatibility" | "es"), None)
                if is_version(number, profile == Some("es")) =>
            {
                Ok(Directive::Version {
                    number,
                    es: profile == Some("es") || number == 100,
                    line: self.whole(),
                })
            }
            _ => Err(self.malformed(
                "`#version` needs a number that GLSL has, and at most a profile".into(),
                "expected for example `450` or `300 es`",
            )),
        }
    }

    fn extension(&self) -> Result<Directive, Diagnostic> {
        let words: Vec<&str> = (0..4)
            .filter_map(|index| self.token(index))
            .map(|token| self.symbols.text(token.symbol))
            .collect();
        match (self.token(0), words.as_slice()) {
            // All extensions together can only be warned of, or be off.
            (Some(_), ["all", ":", "require" | "enable"]) => Err(self.malformed(
                "`#extension all` is `warn` or `disable`".into(),
                "name the extensions that the shader needs",
            )),
            (Some(name), [_, ":", "require" | "enable" | "warn" | "disable"])
                if name.kind == TokenKind::Identifier =>
            {
                Ok(Directive::Extension { name: name.symbol, line: self.whole() })
            }
            _ => Err(self.malformed(
                "`#extension` needs a name and a behaviour".into(),
                "expected `NAME : require`, `enable`, `warn` or `disable`",
            )),
        }
    }
}

/// Whether GLSL, or GLSL ES, has a version of this number.
fn is_version(number: u32, es: bool) -> bool {
    match es {
        true => [300, 310, 320].contains(&number),
        false => {
            let desktop = [110, 120, 130, 140, 150, 330, 400, 410, 420, 430, 440, 450, 460];
            number == 100 || desktop.contains(&number)
        }
    }
}

fn is_reserved(name: &str) -> bool {
    name.starts_with("GL_") || ["defined", "__LINE__", "__FILE__", "__VERSION__"].contains(&name)
}

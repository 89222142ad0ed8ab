//! Evaluates the condition of an `#if`, in integers of 32 bits that wrap around, as in GLSL.

use super::expand::Expander;
use super::token::{NO_SETTING, Tok};
use lamplight_diagnostic::source::{LIMITS, Span};
use lamplight_diagnostic::{Code, Diagnostic, codes};
use lamplight_syntax::glsl::{Symbol, TokenKind, known};

/// Evaluates the expanded tokens of a condition. Operands that `&&` and `||` skip are not
/// evaluated: they may divide by zero, and settings in them do not count as read.
pub fn evaluate_condition(
    expander: &mut Expander<'_, '_>,
    tokens: &[Tok],
    directive: Span,
) -> Result<bool, Diagnostic> {
    let mut parser = ConditionParser { expander, tokens, at: 0, depth: 0, directive };
    let value = parser.binary(0, true)?;
    match parser.peek() {
        None => Ok(value != 0),
        Some(extra) => {
            Err(parser.error(&extra, "unexpected text in a condition", "an operator was expected"))
        }
    }
}

/// How many errors of one composition may suggest a similar name. Later ones suggest none, since
/// the search through all names is slow.
const SUGGESTED: usize = 100;

struct ConditionParser<'a, 'g, 's> {
    expander: &'a mut Expander<'g, 's>,
    tokens: &'a [Tok],
    at: usize,
    depth: usize,
    directive: Span,
}

/// Binary operators with their precedence, higher binding tighter.
const BINARY: &[(Symbol, u8)] = &[
    (known::OR_OR, 1),
    (known::AND_AND, 2),
    (known::OR, 3),
    (known::XOR, 4),
    (known::AND, 5),
    (known::EQUAL, 6),
    (known::NOT_EQUAL, 6),
    (known::LESS, 7),
    (known::GREATER, 7),
    (known::LESS_EQUAL, 7),
    (known::GREATER_EQUAL, 7),
    (known::SHIFT_LEFT, 8),
    (known::SHIFT_RIGHT, 8),
    (known::PLUS, 9),
    (known::MINUS, 9),
    (known::STAR, 10),
    (known::SLASH, 10),
    (known::PERCENT, 10),
];

impl ConditionParser<'_, '_, '_> {
    fn peek(&self) -> Option<Tok> {
        self.tokens.get(self.at).copied()
    }

    fn next(&mut self) -> Result<Tok, Diagnostic> {
        let token = self.peek().ok_or_else(|| self.end_error())?;
        self.at += 1;
        Ok(token)
    }

    /// Evaluates an expression whose binary operators have a higher precedence than `least`. `live`
    /// is false in operands that `&&` or `||` skip.
    fn binary(&mut self, least: u8, live: bool) -> Result<i32, Diagnostic> {
        let mut left = self.unary(live)?;
        while let Some(operator) = self.peek() {
            let Some((_, precedence)) = BINARY
                .iter()
                .find(|(symbol, precedence)| *symbol == operator.symbol && *precedence > least)
            else {
                break;
            };
            self.at += 1;
            let skipped = (operator.symbol == known::AND_AND && left == 0)
                || (operator.symbol == known::OR_OR && left != 0);
            let right = self.binary(*precedence, live && !skipped)?;
            left = self.apply(&operator, left, right, live)?;
        }
        Ok(left)
    }

    fn apply(&self, operator: &Tok, left: i32, right: i32, live: bool) -> Result<i32, Diagnostic> {
        Ok(match operator.symbol {
            known::OR_OR => i32::from(left != 0 || right != 0),
            known::AND_AND => i32::from(left != 0 && right != 0),
            known::OR => left | right,
            known::XOR => left ^ right,
            known::AND => left & right,
            known::EQUAL => i32::from(left == right),
            known::NOT_EQUAL => i32::from(left != right),
            known::LESS => i32::from(left < right),
            known::GREATER => i32::from(left > right),
            known::LESS_EQUAL => i32::from(left <= right),
            known::GREATER_EQUAL => i32::from(left >= right),
            known::SHIFT_LEFT => left.wrapping_shl(right as u32),
            known::SHIFT_RIGHT => left.wrapping_shr(right as u32),
            known::PLUS => left.wrapping_add(right),
            known::MINUS => left.wrapping_sub(right),
            known::STAR => left.wrapping_mul(right),
            _ if right == 0 && live => {
                return Err(self.error(
                    operator,
                    "division by zero in a condition",
                    "the right side is 0",
                ));
            }
            _ if right == 0 => 0,
            known::SLASH => left.wrapping_div(right),
            _ => left.wrapping_rem(right),
        })
    }

    fn unary(&mut self, live: bool) -> Result<i32, Diagnostic> {
        let token = self.next()?;
        self.depth += 1;
        if self.depth > LIMITS.nesting {
            let message = format!("a condition nests deeper than {}", LIMITS.nesting);
            return Err(self.coded(codes::NESTING_TOO_DEEP, &token, &message, "one too many"));
        }
        let value = match token.symbol {
            known::PLUS => self.unary(live)?,
            known::MINUS => self.unary(live)?.wrapping_neg(),
            known::NOT => i32::from(self.unary(live)? == 0),
            known::TILDE => !self.unary(live)?,
            known::OPEN => self.parenthesised(live)?,
            known::DEFINED => self.defined(&token)?,
            _ if token.setting != NO_SETTING => self.setting(&token, live)?,
            _ if token.kind == TokenKind::Number => self.literal(&token)?,
            _ if token.kind == TokenKind::Identifier => self.undefined(&token, live)?,
            _ => {
                return Err(self.error(
                    &token,
                    "a condition needs a value here",
                    "a number, a macro or `defined(..)` was expected",
                ));
            }
        };
        self.depth -= 1;
        Ok(value)
    }

    fn parenthesised(&mut self, live: bool) -> Result<i32, Diagnostic> {
        let value = self.binary(0, live)?;
        let close = self.next()?;
        if close.symbol != known::CLOSE {
            return Err(self.error(
                &close,
                "unexpected text in a condition",
                "an operator or `)` was expected",
            ));
        }
        Ok(value)
    }

    fn defined(&mut self, defined: &Tok) -> Result<i32, Diagnostic> {
        let mut name = self.next()?;
        let parenthesised = name.symbol == known::OPEN;
        if parenthesised {
            name = self.next()?;
        }
        if name.kind != TokenKind::Identifier
            || (parenthesised && self.next()?.symbol != known::CLOSE)
        {
            return Err(self.error(
                defined,
                "`defined` needs the name of a macro",
                "expected `defined NAME` or `defined(NAME)`",
            ));
        }
        Ok(i32::from(self.expander.table.is_defined(name.symbol)))
    }

    fn setting(&mut self, token: &Tok, live: bool) -> Result<i32, Diagnostic> {
        if !live {
            return Ok(0);
        }
        match self.expander.reads.read(token.setting) {
            Ok(value) => Ok(value as i32),
            Err((name, value)) => {
                let message = format!("`{value}` is not a declared value of `{name}`");
                Err(self.coded(codes::BAD_SETTING, token, &message, "asked for here"))
            }
        }
    }

    /// Decimal, octal or hexadecimal, with an optional `u`; 32 bits.
    fn literal(&self, token: &Tok) -> Result<i32, Diagnostic> {
        let text = self.expander.table.spellings.text(token.symbol);
        let digits = text.trim_end_matches(['u', 'U']);
        let value = match digits.strip_prefix("0x").or(digits.strip_prefix("0X")) {
            Some(digits) => u32::from_str_radix(digits, 16),
            None if digits.len() > 1 && digits.starts_with('0') => u32::from_str_radix(digits, 8),
            None => digits.parse(),
        };
        match value {
            Ok(value) if text.len() - digits.len() <= 1 => Ok(value as i32),
            _ => Err(self.error(
                token,
                &format!("`{text}` is not an integer of 32 bits"),
                "conditions count in integers",
            )),
        }
    }

    fn undefined(&self, token: &Tok, live: bool) -> Result<i32, Diagnostic> {
        if !live {
            // Only the name is skipped. Parentheses after a macro that is not defined stay an
            // error, since they need not hold an expression.
            return Ok(0);
        }
        let name = self.expander.table.spellings.text(token.symbol);
        if self.expander.table.has(token.symbol) {
            return Err(self.error(
                token,
                &format!("the macro `{name}` has no value without its arguments"),
                "used in a condition",
            ));
        }
        if let Some(on) = self.expander.reads.undeclared {
            return Ok(i32::from(on));
        }
        let error = self.coded(
            codes::UNDEFINED_MACRO,
            token,
            &format!("the macro `{name}` is not defined"),
            "used in a condition",
        );
        let is_one_of_many = self.expander.errors.len() >= SUGGESTED;
        let known = (!is_one_of_many).then(|| self.expander.table.names());
        Err(error.suggest(name, known.into_iter().flatten()))
    }

    fn error(&self, token: &Tok, message: &str, label: &str) -> Diagnostic {
        self.coded(codes::INVALID_CONDITION, token, message, label)
    }

    fn coded(&self, code: &'static Code, token: &Tok, message: &str, label: &str) -> Diagnostic {
        Diagnostic::error(code, message).at(token.span(&self.expander.graph.modules), label)
    }

    fn end_error(&self) -> Diagnostic {
        let message = if self.tokens.is_empty() {
            "a condition is missing"
        } else {
            "a condition ends too early"
        };
        Diagnostic::error(codes::INVALID_CONDITION, message)
            .at(self.directive, "a value was expected at the end")
    }
}

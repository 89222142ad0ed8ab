//! `@if`, `@elif`, `@else` and their translate-time expressions.

use std::ops::Range;

use super::module::{
    ComparisonOperand, ComparisonOperator, Condition, ConditionId, Expression, ExpressionId, Module,
};
use super::token::TokenKind;
use crate::wesl::token::Name;
use crate::wesl::token::Tokens;
use lamplight_diagnostic::source::LIMITS;
use lamplight_diagnostic::{Diagnostic, codes};

/// The last condition among siblings, which an `@elif` or `@else` may follow.
#[derive(Debug, Clone, Copy, Default)]
pub struct Chain {
    last: Option<ConditionId>,
    /// The condition of the block that the siblings are in.
    pub within: Option<ConditionId>,
}

impl Chain {
    /// For the siblings in a block that has this condition, if any.
    pub fn within(block: Option<ConditionId>) -> Self {
        Self { last: None, within: block }
    }
}

/// The attributes before a node.
#[derive(Debug, Clone, Copy)]
pub struct Attributes {
    /// The index after the last token.
    pub end: usize,
    /// Its own condition, or else that of the block around it.
    pub condition: Option<ConditionId>,
    /// Whether it has a translate-time attribute itself.
    pub conditional: bool,
    /// Whether it has `@vertex`, `@fragment` or `@compute`.
    pub entry: bool,
}

/// Reads the attributes that start at `at`, making a condition of the translate-time one.
pub fn read_attributes(
    module: &mut Module,
    tokens: Tokens<'_>,
    at: usize,
    chain: &mut Chain,
) -> Attributes {
    let mut found = Attributes { end: at, condition: None, conditional: false, entry: false };
    let mut first: Option<usize> = None;
    while tokens.is(found.end, b'@') {
        let name_at = found.end + 1;
        let arguments = tokens.is(name_at + 1, b'(').then_some(name_at + 1);
        match tokens.word(name_at) {
            Some(Name::IF | Name::ELIF | Name::ELSE) if first.is_some() => {
                module.errors.push(second_condition(tokens, name_at));
            }
            Some(word @ (Name::IF | Name::ELIF | Name::ELSE)) => {
                first = Some(name_at);
                match read_condition(module, tokens, name_at, word, arguments, *chain) {
                    Ok(id) => found.condition = Some(id),
                    Err(error) => {
                        module.errors.push(error);
                        found.condition =
                            (word == Name::IF).then(|| literal_condition(module, true, chain));
                    }
                }
            }
            Some(name) if !name.begins_item() && !name.begins_block_statement() => {
                found.entry |= matches!(tokens.names.text(name), "vertex" | "fragment" | "compute")
            }
            // A declaration or a statement after an attribute whose name is not written yet.
            Some(_) | None => {
                module.errors.push(tokens.expected(name_at, "the name of an attribute"));
                found.end = name_at;
                found.condition = found.condition.or(chain.within);
                return found;
            }
        }
        found.end = arguments.map_or(name_at + 1, |open| tokens.partner(open) + 1);
    }
    let closed = first.is_some_and(|name_at| tokens.is_word(name_at, Name::ELSE));
    chain.last = found.condition.filter(|_| !closed);
    found.conditional = first.is_some();
    found.condition = found.condition.or(chain.within);
    found
}

fn second_condition(tokens: Tokens<'_>, name_at: usize) -> Diagnostic {
    let message = "a node has two translate-time attributes";
    illegal_attribute(tokens, name_at, message, "the second one")
        .note("help: join the conditions with `&&`")
}

/// Whether the token at `at` starts a translate-time attribute.
pub fn is_conditional(tokens: Tokens<'_>, at: usize) -> bool {
    tokens.is(at, b'@') && matches!(tokens.word(at + 1), Some(Name::IF | Name::ELIF | Name::ELSE))
}

/// The error for a translate-time attribute where none may be.
pub fn illegal_attribute(
    tokens: Tokens<'_>,
    name_at: usize,
    message: &str,
    label: &str,
) -> Diagnostic {
    Diagnostic::error(codes::ILLEGAL_CONDITION, message).at(tokens.span(name_at), label)
}

/// A condition that nobody wrote. It replaces one that is wrong, so that an `@else` after it is not
/// an error too, or stands for braces without a condition.
pub fn literal_condition(module: &mut Module, value: bool, chain: &Chain) -> ConditionId {
    module.expressions.push(Expression::Literal(value));
    let expression = Some(module.expressions.len() as u32 - 1);
    module.conditions.push(Condition { expression, after: None, within: chain.within });
    module.conditions.len() as u32 - 1
}

fn read_condition(
    module: &mut Module,
    tokens: Tokens<'_>,
    name_at: usize,
    word: Name,
    arguments: Option<usize>,
    chain: Chain,
) -> Result<ConditionId, Diagnostic> {
    let text = tokens.names.text(word);
    let expression = match arguments {
        Some(open) if word == Name::ELSE => {
            return Err(illegal_attribute(
                tokens,
                open,
                "`@else` takes no condition",
                "not allowed",
            )
            .note("help: use `@elif(...)`"));
        }
        None if word != Name::ELSE => {
            return Err(
                tokens.expected(name_at + 1, &format!("`(` and the condition of `@{text}`"))
            );
        }
        Some(open) => Some(read_parenthesised(module, tokens, open)?),
        None => None,
    };
    if word != Name::IF && chain.last.is_none() {
        let message = format!("`@{text}` without an `@if` before it");
        return Err(illegal_attribute(
            tokens,
            name_at,
            &message,
            "the sibling before has no `@if` or `@elif`",
        ));
    }
    let after = chain.last.filter(|_| word != Name::IF);
    module.conditions.push(Condition { expression, after, within: chain.within });
    Ok(module.conditions.len() as u32 - 1)
}

/// `( expression ,? )`.
fn read_parenthesised(
    module: &mut Module,
    tokens: Tokens<'_>,
    open: usize,
) -> Result<ExpressionId, Diagnostic> {
    let close = tokens.partner(open);
    let mut reader = ConditionReader { module, tokens, at: open + 1 };
    let expression = reader.expression()?;
    if tokens.is(reader.at, b',') {
        reader.at += 1;
    }
    if reader.at == close { Ok(expression) } else { Err(unexpected_token(tokens, reader.at)) }
}

fn unexpected_token(tokens: Tokens<'_>, at: usize) -> Diagnostic {
    Diagnostic::error(codes::CONDITION_SYNTAX, format!("unexpected `{}` in a condition", tokens.text(at)))
        .at(tokens.span(at), "not part of a translate-time expression")
        .note("a condition has names, `true`, `false`, `!`, `&&`, `||` and parentheses; declared axes may be compared")
}

struct ConditionReader<'a, 'b> {
    module: &'a mut Module,
    tokens: Tokens<'b>,
    at: usize,
}

impl ConditionReader<'_, '_> {
    fn add(&mut self, expression: Expression) -> ExpressionId {
        self.module.expressions.push(expression);
        self.module.expressions.len() as u32 - 1
    }

    /// Whether two marks stand here without white space between them.
    fn pair(&self, first: u8, second: u8) -> bool {
        self.tokens.is(self.at, first)
            && self.tokens.is(self.at + 1, second)
            && self.tokens.tokens[self.at].end == self.tokens.start(self.at + 1)
    }

    /// Operands joined by `&&` or by `||`. As in WGSL, the two may be mixed only with parentheses.
    fn expression(&mut self) -> Result<ExpressionId, Diagnostic> {
        let first = self.unary()?;
        let mark = if self.pair(b'&', b'&') { b'&' } else { b'|' };
        let mut operands = vec![first];
        while self.pair(mark, mark) {
            self.at += 2;
            operands.push(self.unary()?);
        }
        if self.pair(b'&', b'&') || self.pair(b'|', b'|') {
            let message = "`&&` and `||` in one condition need parentheses";
            return Err(Diagnostic::error(codes::CONDITION_SYNTAX, message)
                .at(self.tokens.span(self.at), "mixed here"));
        }
        Ok(match operands.len() {
            1 => first,
            _ if mark == b'&' => self.add(Expression::All(operands)),
            _ => self.add(Expression::Any(operands)),
        })
    }

    fn unary(&mut self) -> Result<ExpressionId, Diagnostic> {
        let start = self.at;
        while self.tokens.is(self.at, b'!') && !self.pair(b'!', b'=') {
            self.at += 1;
        }
        let negations = self.at - start;
        if negations > LIMITS.nesting {
            return Err(Diagnostic::error(codes::NESTING_TOO_DEEP, "too many `!` in a row")
                .at(self.tokens.span(start), "here"));
        }
        let operand = self.primary()?;
        Ok(if negations % 2 == 1 { self.add(Expression::Not(operand)) } else { operand })
    }

    fn primary(&mut self) -> Result<ExpressionId, Diagnostic> {
        if self.tokens.is(self.at, b'(') {
            let close = self.tokens.partner(self.at);
            self.at += 1;
            let inner = self.expression()?;
            if self.at != close {
                return Err(unexpected_token(self.tokens, self.at));
            }
            self.at = close + 1;
            return Ok(inner);
        }
        if let Some(word @ (Name::TRUE | Name::FALSE)) = self.tokens.word(self.at) {
            self.at += 1;
            return Ok(self.add(Expression::Literal(word == Name::TRUE)));
        }
        let start = self.at;
        let left = self.operand()?;
        let Some(operator) = self.comparison() else {
            return match left {
                ComparisonOperand::Name(name, range) => Ok(self.add(Expression::Flag(name, range))),
                ComparisonOperand::Integer(..) => Err(unexpected_token(self.tokens, start)),
            };
        };
        let right = self.operand()?;
        let range = self.tokens.range(start, self.at);
        Ok(self.add(Expression::Compare { left, operator, right, range }))
    }

    fn comparison(&mut self) -> Option<ComparisonOperator> {
        const OPERATORS: &[(&[u8], ComparisonOperator)] = &[
            (b"==", ComparisonOperator::Equal),
            (b"!=", ComparisonOperator::NotEqual),
            (b"<=", ComparisonOperator::LessEqual),
            (b">=", ComparisonOperator::GreaterEqual),
            (b"<", ComparisonOperator::Less),
            (b">", ComparisonOperator::Greater),
        ];
        let (text, operator) = OPERATORS.iter().find(|(text, _)| match text {
            [first, second] => self.pair(*first, *second),
            single => self.tokens.is(self.at, single[0]),
        })?;
        self.at += text.len();
        Some(*operator)
    }

    fn operand(&mut self) -> Result<ComparisonOperand, Diagnostic> {
        let start = self.at;
        if self.tokens.is(self.at, b'-') && self.tokens.kind(self.at + 1) == Some(TokenKind::Number)
        {
            self.at += 1;
        }
        let (kind, negative) = (self.tokens.kind(self.at), self.at > start);
        self.at += 1;
        let range: Range<u32> = self.tokens.range(start, self.at.min(self.tokens.len()));
        match kind {
            Some(TokenKind::Number) => match parse_integer(self.tokens.text(self.at - 1), negative)
            {
                Some(value) => Ok(ComparisonOperand::Integer(value, range)),
                None => Err(unexpected_token(self.tokens, self.at - 1)
                    .note("only integers may be compared")),
            },
            Some(TokenKind::Word(name)) if !name.is_keyword() => {
                Ok(ComparisonOperand::Name(name, range))
            }
            _ => Err(unexpected_token(self.tokens, start)),
        }
    }
}

fn parse_integer(text: &str, negative: bool) -> Option<i64> {
    let digits = text.strip_suffix(['i', 'u']).unwrap_or(text);
    let value: i64 = match digits.strip_prefix("0x").or_else(|| digits.strip_prefix("0X")) {
        Some(hexadecimal) => i64::from_str_radix(hexadecimal, 16).ok()?,
        None => digits.parse().ok()?,
    };
    Some(if negative { -value } else { value })
}

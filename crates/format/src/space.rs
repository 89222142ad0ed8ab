//! Whether a space stands between two tokens in a line.

use crate::token::{Kind, Token};

/// Words before a bracket that is no call.
const KEYWORDS: [&str; 12] = [
    "if",
    "else",
    "for",
    "while",
    "switch",
    "return",
    "case",
    "loop",
    "do",
    "continuing",
    "default",
    "break",
];

/// Whether a word is one behind which no operand has ended.
pub fn is_keyword(word: &str) -> bool {
    KEYWORDS.contains(&word)
}

/// Whether an operand of an operator may end with a token.
pub fn ends_operand(token: &Token, text: &str) -> bool {
    match token.kind {
        Kind::Word => !is_keyword(token.text(text)),
        Kind::Number | Kind::TemplateClose | Kind::Other => true,
        Kind::Mark => matches!(token.text(text), ")" | "]" | "++" | "--"),
        _ => false,
    }
}

/// The precedence of an operator between two operands, from 3 for `||` on. Assignments have 1.
pub fn precedence_of(operator: &str) -> Option<u8> {
    Some(match operator {
        "=" | "+=" | "-=" | "*=" | "/=" | "%=" | "&=" | "|=" | "^=" | "<<=" | ">>=" => 1,
        "?" => 2,
        "||" => 3,
        "^^" => 4,
        "&&" => 5,
        "|" => 6,
        "^" => 7,
        "&" => 8,
        "==" | "!=" => 9,
        "<" | ">" | "<=" | ">=" => 10,
        "<<" | ">>" => 11,
        "+" | "-" => 12,
        "*" | "/" | "%" => 13,
        _ => return None,
    })
}

/// What a token is to those beside it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// An operator before its operand, or a bracket that opens.
    Prefix,
    /// An operator behind its operand, a comma, or a bracket that closes.
    Suffix,
    /// An operator between operands.
    Infix,
    /// Without spaces on either side.
    Tight,
    /// A word, a number or a bracket that opens behind an operand.
    Operand,
    /// Unknown: the author's blanks are kept.
    Unknown,
}

/// The role of a token behind another one. `is_choice` says whether a `:` belongs to a `?`.
pub fn role_of(token: &Token, before: Option<&Token>, text: &str, is_choice: bool) -> Role {
    let word = token.text(text);
    match token.kind {
        Kind::Word | Kind::Number => Role::Operand,
        Kind::TemplateOpen => Role::Tight,
        Kind::TemplateClose => Role::Suffix,
        Kind::Other => Role::Unknown,
        Kind::LineComment | Kind::BlockComment | Kind::Directive | Kind::Raw => Role::Operand,
        Kind::Mark => match word {
            "(" | "[" => Role::Prefix,
            ")" | "]" | "," | ";" => Role::Suffix,
            "." | "::" => Role::Tight,
            "@" | "!" | "~" => Role::Prefix,
            ":" if is_choice => Role::Infix,
            ":" => Role::Suffix,
            "++" | "--" => match before.is_some_and(|before| ends_operand(before, text)) {
                true => Role::Suffix,
                false => Role::Prefix,
            },
            "-" | "+" | "*" | "&" => {
                match before.is_some_and(|before| ends_operand(before, text)) {
                    true => Role::Infix,
                    false => Role::Prefix,
                }
            }
            "{" | "}" => Role::Operand,
            _ => Role::Infix,
        },
    }
}

/// A token with its role.
#[derive(Debug, Clone, Copy)]
pub struct Placed<'t> {
    pub token: &'t Token,
    pub role: Role,
}

/// Whether a space stands between two tokens of code.
pub fn is_spaced(left: Placed<'_>, right: Placed<'_>, text: &str) -> bool {
    let (before, after) = (left.token.text(text), right.token.text(text));
    let author = right.token.spaced;
    if left.role == Role::Unknown || right.role == Role::Unknown {
        return author;
    }
    let wanted = wants_space(left, right, before, after);
    // Two tokens never become one, and a number none with a point.
    wanted || (author && may_join(left.token, right.token, before, after))
}

fn may_join(left: &Token, right: &Token, before: &str, after: &str) -> bool {
    let is_operator = |kind: Kind, word: &str| match kind {
        Kind::TemplateClose => true,
        _ => kind == Kind::Mark && !word.starts_with(['(', ')', '[', ']', '{', '}', ',', ';', '@']),
    };
    match (left.kind, right.kind) {
        (Kind::Number, _) => after.starts_with('.'),
        (_, Kind::Number) => before.ends_with('.'),
        (left, right) => is_operator(left, before) && is_operator(right, after),
    }
}

fn wants_space(left: Placed<'_>, right: Placed<'_>, before: &str, after: &str) -> bool {
    let is_word = |token: &Token| matches!(token.kind, Kind::Word | Kind::Number);
    match (left.role, right.role) {
        (Role::Infix, _) | (_, Role::Infix) => true,
        (_, Role::Suffix) if after == ";" || after == "," => false,
        (Role::Suffix, _) if matches!(before, "," | ";" | ":") => {
            !(before == ";" && after == ")" || before == "," && matches!(after, ")" | "]"))
        }
        (Role::Tight | Role::Prefix, _) => false,
        (_, Role::Tight | Role::Suffix) => false,
        // A bracket behind an operand: a call or an index, but for words such as `if`.
        (_, Role::Prefix) if after == "(" => is_keyword(before) && before != "default",
        (_, Role::Prefix) if after == "[" => is_keyword(before),
        (_, Role::Prefix) if after == "@" => true,
        (_, Role::Prefix) => is_word(left.token) || matches!(before, ")" | "]" | "}"),
        _ => true,
    }
}

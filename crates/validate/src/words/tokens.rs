//! Tokens of GLSL as authors write them.

use naga::front::glsl::{ErrorKind, ExpectedToken, TokenValue};

use super::spaced_name;

/// What the parser expected.
fn expected_words(tokens: &[ExpectedToken]) -> String {
    let words: Vec<String> = tokens.iter().map(wanted_words).collect();
    match words.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, before)) => format!("{} or {last}", before.join(", ")),
        None => "something else".to_owned(),
    }
}

fn wanted_words(token: &ExpectedToken) -> String {
    match token {
        ExpectedToken::Token(value) => self::token_text(value),
        ExpectedToken::TypeName => "a type".to_owned(),
        ExpectedToken::Identifier => "a name".to_owned(),
        ExpectedToken::IntLiteral => "an integer".to_owned(),
        ExpectedToken::FloatLiteral => "a number".to_owned(),
        ExpectedToken::BoolLiteral => "`true` or `false`".to_owned(),
        ExpectedToken::Eof => "the end of the file".to_owned(),
    }
}

/// A token, in backticks if it is text from the file.
fn token_text(value: &TokenValue) -> String {
    use TokenValue as T;
    let text = match value {
        T::Identifier(name) => return format!("`{name}`"),
        T::FloatConstant(_) | T::IntConstant(_) => return "a number".to_owned(),
        T::BoolConstant(value) => return format!("`{value}`"),
        T::MemoryQualifier(_) => return "a memory qualifier".to_owned(),
        T::Interpolation(_) | T::Sampling(_) => return "an interpolation qualifier".to_owned(),
        T::PrecisionQualifier(_) => return "a precision qualifier".to_owned(),
        T::TypeName(_) => return "the name of a type".to_owned(),
        T::Layout => "layout",
        T::In => "in",
        T::Out => "out",
        T::InOut => "inout",
        T::Uniform => "uniform",
        T::Buffer => "buffer",
        T::Const => "const",
        T::Shared => "shared",
        T::Restrict => "restrict",
        T::Invariant => "invariant",
        T::Precision => "precision",
        T::Continue => "continue",
        T::Break => "break",
        T::Return => "return",
        T::Discard => "discard",
        T::If => "if",
        T::Else => "else",
        T::Switch => "switch",
        T::Case => "case",
        T::Default => "default",
        T::While => "while",
        T::Do => "do",
        T::For => "for",
        T::Void => "void",
        T::Struct => "struct",
        T::Assign => "=",
        T::AddAssign => "+=",
        T::SubAssign => "-=",
        T::MulAssign => "*=",
        T::DivAssign => "/=",
        T::ModAssign => "%=",
        T::LeftShiftAssign => "<<=",
        T::RightShiftAssign => ">>=",
        T::AndAssign => "&=",
        T::XorAssign => "^=",
        T::OrAssign => "|=",
        T::Increment => "++",
        T::Decrement => "--",
        T::LogicalOr => "||",
        T::LogicalAnd => "&&",
        T::LogicalXor => "^^",
        T::LessEqual => "<=",
        T::GreaterEqual => ">=",
        T::Equal => "==",
        T::NotEqual => "!=",
        T::LeftShift => "<<",
        T::RightShift => ">>",
        T::LeftBrace => "{",
        T::RightBrace => "}",
        T::LeftParen => "(",
        T::RightParen => ")",
        T::LeftBracket => "[",
        T::RightBracket => "]",
        T::LeftAngle => "<",
        T::RightAngle => ">",
        T::Comma => ",",
        T::Semicolon => ";",
        T::Colon => ":",
        T::Dot => ".",
        T::Bang => "!",
        T::Dash => "-",
        T::Tilde => "~",
        T::Plus => "+",
        T::Star => "*",
        T::Slash => "/",
        T::Percent => "%",
        T::VerticalBar => "|",
        T::Caret => "^",
        T::Ampersand => "&",
        T::Question => "?",
    };
    format!("`{text}`")
}

/// What naga's GLSL parser reports, as a sentence.
pub fn glsl_words(kind: &ErrorKind) -> String {
    match kind {
        ErrorKind::EndOfFile => "the file ends too early".to_owned(),
        ErrorKind::InvalidProfile(profile) => format!("there is no profile `{profile}`"),
        ErrorKind::InvalidVersion(version) => {
            format!("`#version {version}` is not read: 440, 450 and 460 are")
        }
        ErrorKind::InvalidToken(found, wanted) => {
            format!("expected {}, found {}", expected_words(wanted), token_text(found))
        }
        ErrorKind::NotImplemented(what) => format!("naga does not read this yet: {what}"),
        ErrorKind::UnknownVariable(name) => format!("there is no variable `{name}`"),
        ErrorKind::UnknownType(name) => format!("there is no type `{name}`"),
        ErrorKind::UnknownField(name) => format!("there is no member `{name}`"),
        ErrorKind::UnknownLayoutQualifier(name) => {
            format!("there is no layout qualifier `{name}`")
        }
        ErrorKind::UnsupportedMatrixWithTwoRowsInStd140 { columns } => {
            format!("`mat{columns}x2` cannot be in a uniform block: use vectors")
        }
        ErrorKind::UnsupportedF16MatrixInStd140 { .. } => {
            "matrices of half numbers cannot be in a uniform block".to_owned()
        }
        ErrorKind::VariableAlreadyDeclared(name) => format!("`{name}` is declared twice"),
        ErrorKind::SemanticError(text) => text.to_string(),
        // The type of this error belongs to a crate that is not a dependency of ours.
        ErrorKind::PreprocessorError(error) => spaced_name(&format!("{error:?}")),
        ErrorKind::InternalError(text) => format!("naga stopped: {text}"),
    }
}

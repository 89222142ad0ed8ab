//! Splits preprocessed GLSL into tokens, and keeps the comments and directives beside them.

/// A range of bytes of the text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct At {
    /// The first byte.
    pub start: u32,
    /// The byte after the last one.
    pub end: u32,
}

impl At {
    /// From the start of this range to the end of another.
    pub fn to(self, end: Self) -> Self {
        Self { start: self.start, end: end.end.max(self.start) }
    }

    /// As a range of indices.
    pub fn range(self) -> std::ops::Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// What a token is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A name, a keyword or a type.
    Word,
    /// An integer without a suffix.
    Int,
    /// An integer with the suffix `u`.
    Uint,
    /// A number with a point, an exponent or the suffix `f`.
    Float,
    /// A number with the suffix `lf`.
    Double,
    /// An operator or a bracket: its text as up to three bytes.
    Mark([u8; 3]),
    /// Text that no token begins with.
    Bad,
    /// The end of the text.
    End,
}

/// A token and its place.
#[derive(Debug, Clone, Copy)]
pub struct Token {
    /// What it is.
    pub kind: Kind,
    /// Where it is.
    pub at: At,
}

/// The tokens of a text.
#[derive(Debug, Default)]
pub struct Lexed {
    /// All tokens; the last one is [`Kind::End`].
    pub tokens: Vec<Token>,
    /// Comments, in order.
    pub comments: Vec<At>,
    /// Lines of the preprocessor, in order.
    pub directives: Vec<At>,
}

/// The operator or bracket of that text.
#[inline]
pub const fn mark(text: &str) -> Kind {
    let bytes = text.as_bytes();
    let mut padded = [0; 3];
    let mut index = 0;
    while index < bytes.len() && index < 3 {
        padded[index] = bytes[index];
        index += 1;
    }
    Kind::Mark(padded)
}

/// Splits a text. Whatever cannot be a token becomes [`Kind::Bad`].
pub fn tokenize(text: &str) -> Lexed {
    let mut lexer =
        Lexer { bytes: text.as_bytes(), at: 0, line_start: true, out: Lexed::default() };
    lexer.out.tokens.reserve(text.len() / 4);
    while lexer.at < lexer.bytes.len() {
        lexer.step();
    }
    let end = text.len() as u32;
    lexer.out.tokens.push(Token { kind: Kind::End, at: At { start: end, end } });
    lexer.out
}

struct Lexer<'a> {
    bytes: &'a [u8],
    at: usize,
    line_start: bool,
    out: Lexed,
}

impl Lexer<'_> {
    fn peek(&self, ahead: usize) -> u8 {
        self.bytes.get(self.at + ahead).copied().unwrap_or(0)
    }

    fn step(&mut self) {
        let start = self.at;
        match self.peek(0) {
            b'\n' => {
                self.line_start = true;
                self.at += 1;
            }
            b' ' | b'\t' | b'\r' | 0x0b | 0x0c => self.at += 1,
            b'/' if self.peek(1) == b'/' => self.comment(Self::line_comment),
            b'/' if self.peek(1) == b'*' => self.comment(Self::block_comment),
            b'#' if self.line_start => {
                self.skip_line();
                self.out.directives.push(self.since(start));
            }
            b'\\' if matches!(self.peek(1), b'\n' | b'\r') => self.at += 2,
            _ => {
                self.line_start = false;
                let kind = self.token();
                let at = self.since(start);
                self.out.tokens.push(Token { kind, at });
            }
        }
    }

    fn since(&self, start: usize) -> At {
        At { start: start as u32, end: self.at as u32 }
    }

    fn comment(&mut self, skip: fn(&mut Self)) {
        let start = self.at;
        skip(self);
        self.out.comments.push(self.since(start));
    }

    fn line_comment(&mut self) {
        self.skip_line();
        while self.at > 0 && self.bytes[self.at - 1] == b'\r' {
            self.at -= 1;
        }
    }

    /// To the end of the line, over continued lines.
    fn skip_line(&mut self) {
        while self.at < self.bytes.len() && self.bytes[self.at] != b'\n' {
            self.at += match (self.bytes[self.at], self.peek(1), self.peek(2)) {
                (b'\\', b'\r', b'\n') => 3,
                (b'\\', b'\n', _) => 2,
                _ => 1,
            };
        }
        self.at = self.at.min(self.bytes.len());
    }

    fn block_comment(&mut self) {
        let rest = &self.bytes[self.at + 2..];
        let end = rest.windows(2).position(|pair| pair == b"*/");
        self.at = end.map_or(self.bytes.len(), |end| self.at + 2 + end + 2);
    }

    fn token(&mut self) -> Kind {
        let byte = self.peek(0);
        if byte.is_ascii_alphabetic() || byte == b'_' {
            while self.peek(0).is_ascii_alphanumeric() || self.peek(0) == b'_' {
                self.at += 1;
            }
            return Kind::Word;
        }
        if byte.is_ascii_digit() || (byte == b'.' && self.peek(1).is_ascii_digit()) {
            return self.number();
        }
        self.mark()
    }

    fn number(&mut self) -> Kind {
        if self.peek(0) == b'0' && matches!(self.peek(1), b'x' | b'X') {
            self.at += 2;
            self.digits(u8::is_ascii_hexdigit);
            return self.integer_suffix();
        }
        self.digits(u8::is_ascii_digit);
        let mut float = false;
        if self.peek(0) == b'.' {
            float = true;
            self.at += 1;
            self.digits(u8::is_ascii_digit);
        }
        let sign = usize::from(matches!(self.peek(1), b'+' | b'-'));
        if matches!(self.peek(0), b'e' | b'E') && self.peek(1 + sign).is_ascii_digit() {
            float = true;
            self.at += 1 + sign;
            self.digits(u8::is_ascii_digit);
        }
        match (self.peek(0), self.peek(1)) {
            // `1f` is no number of GLSL: a float has a point or an exponent.
            (b'f' | b'F', _) if float => self.suffix(1, Kind::Float),
            (b'l', b'f') | (b'L', b'F') => self.suffix(2, Kind::Double),
            _ if float => Kind::Float,
            _ => self.integer_suffix(),
        }
    }

    fn integer_suffix(&mut self) -> Kind {
        match self.peek(0) {
            b'u' | b'U' => self.suffix(1, Kind::Uint),
            _ => Kind::Int,
        }
    }

    fn suffix(&mut self, length: usize, kind: Kind) -> Kind {
        self.at += length;
        kind
    }

    fn digits(&mut self, is_digit: fn(&u8) -> bool) {
        while is_digit(&self.peek(0)) {
            self.at += 1;
        }
    }

    fn mark(&mut self) -> Kind {
        let three = [self.peek(0), self.peek(1), self.peek(2)];
        let length = match &three {
            b"<<=" | b">>=" => 3,
            [b'+', b'+', _] | [b'-', b'-', _] | [b'<', b'<', _] | [b'>', b'>', _] => 2,
            [b'&', b'&', _] | [b'|', b'|', _] | [b'^', b'^', _] => 2,
            [b'+' | b'-' | b'*' | b'/' | b'%' | b'<' | b'>' | b'=' | b'!', b'=', _] => 2,
            [b'&' | b'|' | b'^', b'=', _] => 2,
            [byte, _, _] if b"(){}[].,;:?+-*/%<>=!&|^~".contains(byte) => 1,
            _ => {
                self.at += 1;
                while self.at < self.bytes.len() && self.bytes[self.at] & 0xc0 == 0x80 {
                    self.at += 1;
                }
                return Kind::Bad;
            }
        };
        self.at += length;
        let mut text = three;
        text[length..].fill(0);
        Kind::Mark(text)
    }
}

#[cfg(test)]
mod tests {
    use super::{Kind, tokenize};

    #[test]
    fn comments_go_on_behind_a_backslash() {
        for end in ["\n", "\r\n"] {
            let text = format!("// one \\{end} two{end}name");
            let lexed = tokenize(&text);
            assert_eq!(lexed.comments.len(), 1, "{text:?}");
            let kinds: Vec<Kind> = lexed.tokens.iter().map(|token| token.kind).collect();
            assert!(matches!(kinds[..], [Kind::Word, Kind::End]), "{kinds:?}");
        }
    }
}

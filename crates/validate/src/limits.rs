//! Bounds on a composed text, checked in one pass before naga reads it.
//!
//! naga's parsers and validator recurse over the syntax tree, and an exhausted stack cannot be
//! caught. An upper estimate of the tree's depth is bounded here: the operators that may nest in
//! one statement, nested brackets, and the length of the text. The number of functions is bounded
//! too, since naga's time grows with its square.

use super::constants;
use lamplight_compose::Composed;
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_files::limits;
use lamplight_syntax::words::is_word_byte;

/// Bounds on what naga is given.
#[derive(Debug, Clone, Copy)]
pub struct NagaLimits {
    /// Bytes of the text.
    pub bytes: usize,
    /// How deeply brackets of any kind nest.
    pub nesting: usize,
    /// Operators of one expression, or branches of one chain of `else if`.
    pub operators: usize,
    /// Functions and structures of the text.
    pub bodies: usize,
}

/// The limits that [`super::validate`] uses. naga's stack overflowed at some 20,000 operators on a
/// thread of 2 MiB; no expression of the shader library has 40. naga takes a quarter of a second
/// for 5,000 functions that call each other, and a minute for 40,000.
pub const LIMITS: NagaLimits = NagaLimits {
    bytes: limits::COMPILED_BYTES,
    nesting: limits::COMPILED_NESTING,
    operators: limits::OPERATORS,
    bodies: limits::BODIES,
};

/// Refuses a text that might exhaust naga's stack. For a text that is accepted but needs the
/// sandbox, gives the place that exceeds the part of a limit.
pub fn check_limits(composed: &Composed) -> Result<Option<Excess>, Diagnostic> {
    let text = &composed.text;
    if text.len() > LIMITS.bytes {
        let message = format!(
            "the composed text has {} bytes, more than the limit of {}",
            text.len(),
            LIMITS.bytes
        );
        return Err(Diagnostic::error(codes::LIMIT_EXCEEDED, message));
    }
    // Nearly every text is below that part and is read only once.
    let Some(large) = beyond_limits(composed, limits::CALM_PART) else { return Ok(None) };
    beyond_limits(composed, 1)
        .map_or(Ok(Some(large)), |excess| Err(report_excess(composed, &excess)))
}

/// The first place that exceeds any limit, divided by `part`.
fn beyond_limits(composed: &Composed, part: usize) -> Option<Excess> {
    let text = &composed.text;
    let limit = LIMITS.bytes / part;
    let long = (text.len() > limit).then_some(Excess { offset: limit, what: "bytes", limit });
    scan_text(text.as_bytes(), part)
        .or_else(|| constants::scan_constants(text, composed.language, part as u64))
        .or(long)
}

/// What a text has too many of, for a bound or a part of it.
pub struct Excess {
    pub offset: usize,
    pub what: &'static str,
    pub limit: usize,
}

fn report_excess(composed: &Composed, excess: &Excess) -> Diagnostic {
    let message = format!("more than {} {}", excess.limit, excess.what);
    let error = Diagnostic::error(codes::LIMIT_EXCEEDED, message);
    place_excess(composed, error, excess, "the limit is reached")
}

/// Adds the place of an excess to an error, and what is wrong there.
pub(super) fn place_excess(
    composed: &Composed,
    error: Diagnostic,
    excess: &Excess,
    what: &str,
) -> Diagnostic {
    match composed.map.lookup(excess.offset..excess.offset + 1) {
        Some(span) => error.at(span, format!("{what} here")),
        None => error.note(format!("{what} at byte {} of the composed text", excess.offset)),
    }
}

/// A bracket that is open at the byte being read; the first level is the file.
#[derive(Default)]
struct BracketLevel {
    /// Operators since the last `,` or `;` of this level.
    operators: usize,
    /// The most operators between two `,` of this level.
    most: usize,
}

struct Scan<'a> {
    bytes: &'a [u8],
    at: usize,
    levels: Vec<BracketLevel>,
    /// The operators of all open levels together: an upper estimate of the tree's depth here.
    open: usize,
    /// Whether a `}` was just read: unless `else` follows, the statement is over.
    after_block: bool,
    /// Braces that were opened at the level of the file.
    bodies: usize,
    /// Declarations at that level that end in a semicolon, and how many of them are overrides.
    declarations: usize,
    overrides: usize,
    /// Attributes of entry points.
    entries: usize,
    /// Statements, cases and values of cases since the last brace at that level.
    statements: usize,
    /// Whether this is between `case` and its colon or brace.
    in_case: bool,
}

fn scan_text(bytes: &[u8], part: usize) -> Option<Excess> {
    let mut scan = Scan {
        bytes,
        at: 0,
        levels: vec![BracketLevel::default()],
        open: 0,
        after_block: false,
        bodies: 0,
        declarations: 0,
        overrides: 0,
        entries: 0,
        statements: 0,
        in_case: false,
    };
    while scan.at < bytes.len() {
        let offset = scan.at;
        scan.step();
        if let Some((what, limit)) = scan.excess(part) {
            return Some(Excess { offset, what, limit });
        }
    }
    None
}

impl Scan<'_> {
    /// What exceeds its bound, divided by `part`, so far; with the divided bound.
    #[inline]
    fn excess(&self, part: usize) -> Option<(&'static str, usize)> {
        let counts = [
            (self.levels.len(), "brackets within each other", LIMITS.nesting),
            (self.open, "operators in one expression", LIMITS.operators),
            (self.bodies, "functions and structures", LIMITS.bodies),
            (self.declarations, "variables, constants and aliases", limits::DECLARATIONS),
            (self.overrides, "overrides", limits::OVERRIDES),
            (self.entries, "entry points", limits::ENTRY_POINTS),
            (self.statements, "statements and values of cases in one function", limits::STATEMENTS),
        ];
        let found = counts.into_iter().find(|(count, _, limit)| *count > limit / part);
        found.map(|(_, what, limit)| (what, limit / part))
    }

    fn step(&mut self) {
        let byte = self.bytes[self.at];
        self.at += 1;
        match byte {
            b' ' | b'\t' | b'\n' | b'\r' => return,
            b'/' if self.peek() == Some(b'/') => return self.skip_line(),
            b'/' if self.peek() == Some(b'*') => return self.skip_block(),
            b'a'..=b'z' | b'A'..=b'Z' | b'_' => return self.word(),
            _ => self.end_block(),
        }
        match byte {
            b'(' | b'[' | b'{' => {
                self.in_case &= byte != b'{';
                if byte == b'{' && self.levels.len() == 1 {
                    self.bodies += 1;
                    self.statements = 0;
                }
                self.levels.push(BracketLevel::default());
            }
            b')' | b']' => self.close(),
            b'}' => {
                self.close();
                self.after_block = true;
            }
            b',' => {
                self.statements += usize::from(self.in_case);
                self.separate();
            }
            b';' => {
                let is_outside = self.levels.len() == 1;
                self.declarations += usize::from(is_outside);
                self.statements += usize::from(!is_outside);
                self.reset();
            }
            b':' => {
                self.in_case = false;
                self.count(1);
            }
            b'.' if self.peek().is_none_or(|next| !next.is_ascii_alphabetic()) => {}
            b'+' | b'-' | b'*' | b'/' | b'%' | b'<' | b'>' | b'=' | b'!' | b'~' | b'&' | b'|'
            | b'^' | b'?' | b'.' => self.count(1),
            _ => {}
        }
    }

    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    /// Reads an identifier or keyword, and updates the counts. `if`, `else`, `for`, `while`, `do`
    /// and `switch` count as one operator each, since they nest statements even without braces.
    fn word(&mut self) {
        let start = self.at - 1;
        while self.peek().is_some_and(is_word_byte) {
            self.at += 1;
        }
        let word = &self.bytes[start..self.at];
        if word == b"else" {
            self.after_block = false;
        }
        self.end_block();
        if self.levels.len() == 1 {
            let is_attribute = start > 0 && self.bytes[start - 1] == b'@';
            self.entries +=
                usize::from(is_attribute && matches!(word, b"vertex" | b"fragment" | b"compute"));
            self.overrides += usize::from(word == b"override");
        }
        if word == b"case" {
            self.statements += 1;
            self.in_case = true;
        }
        if matches!(word, b"if" | b"else" | b"for" | b"while" | b"do" | b"switch") {
            self.count(1);
        }
    }

    fn end_block(&mut self) {
        if std::mem::take(&mut self.after_block) {
            self.reset();
        }
    }

    fn count(&mut self, operators: usize) {
        if let Some(level) = self.levels.last_mut() {
            level.operators += operators;
            self.open += operators;
        }
    }

    fn separate(&mut self) {
        if let Some(level) = self.levels.last_mut() {
            level.most = level.most.max(level.operators);
            self.open -= std::mem::take(&mut level.operators);
        }
    }

    fn reset(&mut self) {
        if let Some(level) = self.levels.last_mut() {
            self.open -= level.operators;
            *level = BracketLevel::default();
        }
    }

    /// Closes a bracket. For the level around it, the bracket counts as one operator more than its
    /// deepest part has.
    fn close(&mut self) {
        if self.levels.len() > 1
            && let Some(inner) = self.levels.pop()
        {
            self.open -= inner.operators;
            self.count(1 + inner.most.max(inner.operators));
        }
    }

    fn skip_line(&mut self) {
        while self.peek().is_some_and(|byte| byte != b'\n') {
            self.at += 1;
        }
    }

    /// Skips a block comment. They nest in WGSL but not in GLSL. Stopping at the first end reads
    /// more text, so it can only raise the estimate.
    fn skip_block(&mut self) {
        self.at += 1;
        while self.at < self.bytes.len()
            && !(self.bytes[self.at] == b'*' && self.bytes.get(self.at + 1) == Some(&b'/'))
        {
            self.at += 1;
        }
        self.at = (self.at + 2).min(self.bytes.len());
    }
}

//! Splits a text into tokens and directives. As in `naga_oil`, a line that starts with `#` and the
//! name of a directive is a directive, unless it is in a comment.

use super::condition::ShaderDefTest;
use super::import;
use super::tree::{
    ByteRange, Conditional, ConditionalBranch, DirectiveLine, ImportDirective, Node, Scanned,
    Token, TokenKind,
};
use lamplight_diagnostic::source::{LIMITS, SourceId, Span};
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_files::limits::count_steps;
use lamplight_syntax::wesl::blank::{block_comment, comment_length, without_comments};
use lamplight_syntax::words::{begins_word, continues_word, leading_word, number_end};

/// Cuts up a file. The error is the first thing that cannot be understood.
pub fn scan_file(text: &str, source: SourceId) -> Result<Scanned, Diagnostic> {
    let mut scanner = MigrateScanner {
        text,
        source,
        at: 0,
        lead: 0,
        tokens: 0,
        found: Scanned::default(),
        nodes: Vec::new(),
        open: Vec::new(),
        declared: false,
    };
    while scanner.skip_blank()? {
        match scanner.directive_word() {
            Some(word) => scanner.directive(&word)?,
            None => scanner.token()?,
        }
    }
    if let Some(open) = scanner.open.last() {
        return Err(scanner.wrong("a condition that no `#endif` ends", open.line.words.clone()));
    }
    let mut found = scanner.found;
    found.tail = scanner.lead..text.len();
    found.nodes = super::import::without_late_imports(scanner.nodes, &mut found.late);
    Ok(found)
}

/// A condition that is not ended yet.
struct OpenCondition {
    branches: Vec<ConditionalBranch>,
    line: DirectiveLine,
    condition: Option<ShaderDefTest>,
    /// The nodes before it.
    before: Vec<Node>,
}

struct MigrateScanner<'a> {
    text: &'a str,
    source: SourceId,
    at: usize,
    /// Where the blanks before the next token start.
    lead: usize,
    tokens: usize,
    found: Scanned,
    nodes: Vec<Node>,
    open: Vec<OpenCondition>,
    declared: bool,
}

const DIRECTIVES: &[&str] = &[
    "ifdef",
    "ifndef",
    "if",
    "else",
    "endif",
    "import",
    "define_import_path",
    "define",
    "version",
];

impl MigrateScanner<'_> {
    fn wrong(&self, message: &str, place: ByteRange) -> Diagnostic {
        Diagnostic::error(codes::NOT_MIGRATED, message.to_owned())
            .at(Span::new(self.source, place), "this file stays as it is")
    }

    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    /// Goes to the next token; false at the end of the text.
    fn skip_blank(&mut self) -> Result<bool, Diagnostic> {
        loop {
            let blank = self.rest().len() - self.rest().trim_start().len();
            self.at += blank;
            if self.rest().starts_with("//") {
                self.at += self.rest().find('\n').unwrap_or(self.rest().len());
            } else if self.rest().starts_with("/*") {
                let (length, is_closed) = block_comment(self.rest());
                if !is_closed {
                    return Err(self.wrong("a comment that is never closed", self.at..self.at + 2));
                }
                self.at += length;
            } else {
                return Ok(self.at < self.text.len());
            }
        }
    }

    fn line_start(&self) -> usize {
        self.text[..self.at].rfind('\n').map_or(0, |newline| newline + 1)
    }

    /// Whether only blanks are before this place in its line. Only these are looked at: a line may
    /// have many marks.
    fn begins_line(&self) -> bool {
        let is_blank = |letter: char| letter != '\n' && letter.is_whitespace();
        let before = self.text[..self.at].trim_end_matches(is_blank);
        count_steps(1 + (self.at - before.len()) as u64);
        before.is_empty() || before.ends_with('\n')
    }

    /// The word of a directive, if one starts here.
    fn directive_word(&self) -> Option<String> {
        if !self.rest().starts_with('#') || !self.begins_line() {
            return None;
        }
        let word = leading_word(self.rest()[1..].trim_start());
        DIRECTIVES.contains(&word).then(|| word.to_owned())
    }

    /// Takes the whole line, and finds where its directive ends.
    fn line(&mut self) -> DirectiveLine {
        let start = self.line_start();
        let end = self.at + self.rest().find('\n').unwrap_or(self.rest().len());
        let whole = &self.text[self.at..end];
        let bare = without_comments(whole);
        let words = self.at..self.at + bare.trim_end().len();
        let end = (end + 1).min(self.text.len());
        let line = DirectiveLine { lead: self.lead.min(start)..start, range: start..end, words };
        (self.at, self.lead) = (end, end);
        line
    }

    fn directive(&mut self, word: &str) -> Result<(), Diagnostic> {
        if word == "import" {
            return self.import();
        }
        let line = self.line();
        let text = self.text[line.words.clone()][1..].trim();
        match word {
            "ifdef" | "ifndef" | "if" => {
                let condition = self.condition(text, &line)?;
                self.open.push(OpenCondition {
                    branches: Vec::new(),
                    line,
                    condition: Some(condition),
                    before: std::mem::take(&mut self.nodes),
                });
                match self.open.len() > LIMITS.nesting {
                    true => Err(self.wrong("conditions nest too deep", self.at..self.at)),
                    false => Ok(()),
                }
            }
            "else" => self.otherwise(text, line),
            "endif" => self.end(line),
            "define_import_path" => {
                let name = text["define_import_path".len()..].trim().trim_end_matches(';');
                self.found.name = Some((name.to_owned(), line.words.clone()));
                self.nodes.push(Node::Gone(line));
                Ok(())
            }
            "define" => {
                self.defined(text, &line);
                self.nodes.push(Node::Comment(line));
                Ok(())
            }
            _ => {
                self.nodes.push(Node::Comment(line));
                Ok(())
            }
        }
    }

    /// Notes that a definition must be given from outside in WESL: `#define NAME` holds for all
    /// that the file imports, which no file of WESL can say.
    fn defined(&mut self, text: &str, line: &DirectiveLine) {
        let mut words = text.split_whitespace().skip(1);
        let name = words.next().unwrap_or_default();
        let how = match words.next() {
            Some(value) if value != "true" => format!("`--constant {name}={value}`"),
            _ => format!("`--feature {name}`"),
        };
        let message = format!("`{name}` is given from outside in WESL");
        let note = Diagnostic::warning(codes::MIGRATED_OTHERWISE, message)
            .at(Span::new(self.source, line.words.clone()), "now a comment")
            .note(format!("help: compose this file with {how}"));
        self.found.notes.push(note);
    }

    fn condition(&mut self, text: &str, line: &DirectiveLine) -> Result<ShaderDefTest, Diagnostic> {
        let mut words = text.split_whitespace();
        let kind = words.next().unwrap_or_default();
        let name = words.next().unwrap_or_default();
        let found = match kind {
            _ if leading_word(name) != name || name.is_empty() => None,
            "ifdef" => Some(ShaderDefTest::defined(name)),
            "ifndef" => Some(ShaderDefTest::defined(name).not()),
            _ => {
                let rest: String = words.collect();
                let value = rest.trim_start_matches(['=', '!', '<', '>']);
                ShaderDefTest::compared(name, &rest[..rest.len() - value.len()], value)
            }
        };
        let condition = found.ok_or_else(|| {
            self.wrong("a condition that cannot be understood", line.words.clone())
                .note("`#ifdef NAME`, `#ifndef NAME` and `#if NAME OPERATOR VALUE` are known")
        })?;
        // `#ifdef 0` is never true.
        if !condition.is_never() {
            self.found.defs.note(&condition, self.source, &line.words);
        }
        Ok(condition)
    }

    fn otherwise(&mut self, text: &str, line: DirectiveLine) -> Result<(), Diagnostic> {
        let chained = text["else".len()..].trim();
        let condition = match chained.starts_with("if") {
            true => Some(self.condition(chained, &line)?),
            false => None,
        };
        let nodes = std::mem::take(&mut self.nodes);
        let Some(open) = self.open.last_mut() else {
            return Err(self.wrong("an `#else` without an `#ifdef` before it", line.words));
        };
        let before = std::mem::replace(&mut open.condition, condition);
        if before.is_none() {
            return Err(self.wrong("an `#else` after another", line.words));
        }
        let line = std::mem::replace(&mut open.line, line);
        open.branches.push(ConditionalBranch { line, condition: before, nodes });
        Ok(())
    }

    fn end(&mut self, line: DirectiveLine) -> Result<(), Diagnostic> {
        let Some(mut open) = self.open.pop() else {
            return Err(self.wrong("an `#endif` without an `#ifdef` before it", line.words));
        };
        let nodes = std::mem::replace(&mut self.nodes, open.before);
        open.branches.push(ConditionalBranch { line: open.line, condition: open.condition, nodes });
        self.nodes.push(Node::Choice(Conditional { branches: open.branches, end: line }));
        Ok(())
    }

    /// Reads an import: whole lines, up to the one that closes the last brace.
    fn import(&mut self) -> Result<(), Diagnostic> {
        let start = self.at;
        let mut line = self.line();
        let is_open = |text: &str| {
            let bare = without_comments(text);
            bare.matches('{').count() > bare.matches('}').count()
        };
        while is_open(&self.text[start..self.at]) && self.at < self.text.len() {
            let next = self.line();
            line.range.end = next.range.end;
            line.words.end = next.words.end;
        }
        let tree = import::parse_import(self.text, line.words.clone())
            .map_err(|(message, place)| self.wrong(message, place))?;
        self.found.imports.extend(import::import_paths(&tree));
        let import = ImportDirective { line, tree };
        match self.declared {
            false => self.nodes.push(Node::Import(import)),
            true => {
                let conditions = self.around();
                self.found.late.push((conditions, import));
            }
        }
        Ok(())
    }

    /// The conditions around this place.
    fn around(&self) -> Vec<ShaderDefTest> {
        let mut all = Vec::new();
        for open in &self.open {
            all.extend(
                open.branches.iter().flat_map(|one| one.condition.clone()).map(ShaderDefTest::not),
            );
            all.extend(open.condition.clone());
        }
        all
    }

    fn token(&mut self) -> Result<(), Diagnostic> {
        let lead = self.lead..self.at;
        let (kind, length) = self.kind()?;
        let range = self.at..self.at + length;
        self.tokens += 1;
        if self.tokens > LIMITS.tokens {
            return Err(self.wrong("more tokens than a file may have", range));
        }
        let text = &self.text[range.clone()];
        // Directives of WGSL come before imports.
        let directive = ["enable", "requires", "diagnostic"].contains(&text);
        let before = self.nodes.iter().rev().find_map(|node| match node {
            Node::Token(token) => Some(&self.text[token.range.clone()]),
            _ => None,
        });
        let starts = before.is_none_or(|before| before == ";");
        self.declared |= starts && !directive || !self.open.is_empty();
        (self.at, self.lead) = (range.end, range.end);
        self.nodes.push(Node::Token(Token { lead, range, kind }));
        Ok(())
    }

    fn kind(&mut self) -> Result<(TokenKind, usize), Diagnostic> {
        let rest = self.rest();
        let first = rest.chars().next().unwrap_or_default();
        let length = first.len_utf8();
        let dotted = first == '.' && rest[1..].starts_with(|next: char| next.is_ascii_digit());
        match first {
            _ if begins_word(first) => Ok((TokenKind::Word, leading_word(rest).len())),
            _ if first.is_ascii_digit() || dotted => Ok((TokenKind::Number, number_end(rest, 0))),
            ':' if rest.starts_with("::") => Ok((TokenKind::Path, 2)),
            '#' => self.def(),
            '"' => match rest[1..].find(['"', '\n']) {
                Some(end) if rest[1 + end..].starts_with('"') => Ok((TokenKind::Word, end + 2)),
                _ => Err(self.wrong("quotes that are never closed", self.at..self.at + 1)),
            },
            _ if first.is_ascii_graphic() => Ok((TokenKind::Mark(first as u8), length)),
            _ => Err(self.wrong("a character that WGSL does not have", self.at..self.at + length)),
        }
    }

    /// `#NAME` or `#{NAME}`.
    fn def(&mut self) -> Result<(TokenKind, usize), Diagnostic> {
        let rest = self.rest();
        let after = rest[1..].trim_start();
        let (name, length) = match after.strip_prefix('{') {
            Some(inner) => {
                let name = leading_word(inner);
                let closed = inner[name.len()..].starts_with('}');
                (if closed { name } else { "" }, rest.len() - inner.len() + name.len() + 1)
            }
            None => (leading_word(after), rest.len() - after.len() + leading_word(after).len()),
        };
        let place = self.at..self.at + length.min(rest.len());
        if name.is_empty() {
            return Err(self.wrong("a `#` that is not a directive", self.at..self.at + 1));
        }
        let pasted = self.text[..self.at].ends_with(continues_word);
        if pasted {
            return Err(self.wrong("a name that is put together from a shader def", place));
        }
        let span = Span::new(self.source, place);
        self.found.defs.constants.entry(name.to_owned()).or_insert(span);
        Ok((TokenKind::Def, length))
    }
}

/// Bytes of blanks and comments at the start of a text.
pub fn trivia_length(text: &str) -> usize {
    let mut at = 0;
    loop {
        let rest = &text[at..];
        at += match comment_length(rest).max(rest.len() - rest.trim_start().len()) {
            0 => return at,
            length => length,
        };
    }
}

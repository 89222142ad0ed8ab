//! Writes a layout as text. A group stands in one line if it fits, up to the first place where a
//! line ends in any case. Only [`Printer::fits`] looks ahead, never further than a line is wide.

use crate::op::{Break, Group, GroupKind, Line, Op, Place};
use crate::options::{Indent, Options};
use crate::token::{Kind, Token};

/// Whether the places of a group end their lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mode {
    /// Only those that must.
    Flat,
    /// Those that must, the edges, and those before what would not fit.
    Fill,
    /// All.
    All,
}

/// A group that is open.
#[derive(Debug, Clone, Copy)]
struct Opened {
    mode: Mode,
    /// The level of the line of the nearest opening bracket.
    list: u16,
    /// The level of the line of the nearest element.
    element: u16,
    /// The level of lines that begin with an operator of this group.
    chain: u16,
    /// Whether a line of this group has ended at one of its own places.
    has_ended: bool,
    is_list: bool,
    /// Whether the nearest element stands in lines of its own between brackets.
    is_own: bool,
}

impl Opened {
    const OUTERMOST: Self = Self {
        mode: Mode::Flat,
        list: 0,
        element: 0,
        chain: 1,
        has_ended: false,
        is_list: false,
        is_own: false,
    };
}

pub struct Printer<'t> {
    text: &'t str,
    tokens: &'t [Token],
    ops: &'t [Op],
    options: &'t Options,
    out: &'t mut String,
    /// Where the layout begins in it.
    start: usize,
    column: usize,
    /// The level of the line that is written.
    level: u16,
    /// Indentation to write before the next token.
    pending: Option<u16>,
    open: Vec<Opened>,
    /// Whether the last token was one behind which nothing may stand in its line.
    is_ended: bool,
}

/// Writes a layout.
pub fn print_layout(text: &str, tokens: &[Token], ops: &[Op], options: &Options, out: &mut String) {
    let start = out.len();
    let mut printer = Printer {
        text,
        tokens,
        ops,
        options,
        out,
        start,
        column: 0,
        level: 0,
        pending: None,
        open: vec![Opened::OUTERMOST],
        is_ended: false,
    };
    for (index, op) in ops.iter().enumerate() {
        printer.step(index, op);
    }
}

impl Printer<'_> {
    fn step(&mut self, index: usize, op: &Op) {
        match *op {
            Op::Token(token) => self.token(token as usize),
            Op::Space => self.write(" "),
            Op::Gap(token) => self.gap(token as usize),
            Op::Break(place) => self.place(index, place),
            Op::Soft { is_forced } => {
                if is_forced || self.needs_break(index) {
                    let level = self.top().element + 1;
                    self.newline(level, false, false);
                } else {
                    self.write(" ");
                }
            }
            Op::Line(Line { level, is_margin, is_empty }) => {
                self.newline(level, is_margin, is_empty);
            }
            Op::Open(group) => self.open_group(index, group),
            Op::Close => {
                self.open.pop();
            }
        }
    }

    fn top(&self) -> Opened {
        self.open.last().copied().unwrap_or(Opened::OUTERMOST)
    }

    fn open_group(&mut self, index: usize, group: Group) {
        let mut opened = self.top();
        match group.kind {
            GroupKind::Element => {
                opened.is_own = opened.is_list && self.pending.is_some();
                (opened.element, opened.mode) = (self.level, Mode::Flat);
                opened.chain = self.level + 1;
            }
            GroupKind::List | GroupKind::Rigid => opened.list = self.level,
            GroupKind::Chain | GroupKind::Block => {}
        }
        opened.is_list = matches!(group.kind, GroupKind::List | GroupKind::Rigid);
        if group.kind != GroupKind::Element {
            opened.mode = match group.is_forced {
                true => Mode::Fill,
                false if group.kind == GroupKind::Rigid => Mode::Flat,
                false if self.fits(index + 1, 1) => Mode::Flat,
                false if group.is_filled => Mode::Fill,
                false => Mode::All,
            };
        }
        // Operands of a line that begins with an operator stand one level behind it.
        opened.chain += u16::from(group.kind == GroupKind::Chain && opened.has_ended);
        opened.has_ended = false;
        self.open.push(opened);
    }

    fn place(&mut self, index: usize, place: Break) {
        let ends = place.is_forced
            || match self.top().mode {
                Mode::Flat => false,
                Mode::Fill => place.is_edge || !self.fits(index + 1, 0) || self.is_wide(place),
                // Behind brackets that close in this line, there is room for operands.
                Mode::All if matches!(place.place, Place::Chain | Place::Trail) => {
                    !self.is_closing() || !self.fits(index + 1, 0)
                }
                Mode::All => true,
            };
        if !ends {
            if place.is_spaced {
                self.write(" ");
            }
            return;
        }
        if let Some(group) = self.open.last_mut() {
            group.has_ended |= matches!(place.place, Place::Chain);
        }
        let level = match place.place {
            Place::Inner => self.top().list + 1,
            Place::Outer => self.top().list,
            Place::Element => self.top().element,
            Place::Trail if self.top().is_own => self.top().element,
            Place::Trail => self.top().element + 1,
            Place::Chain => self.top().chain,
            Place::Level(level) => level,
        };
        self.newline(level, place.is_margin, place.is_empty);
    }

    /// Whether the line has nothing but brackets that close.
    fn is_closing(&self) -> bool {
        let line = self.out.rfind('\n').map_or(0, |at| at + 1);
        let line = self.out[line..].trim_start();
        self.pending.is_none()
            && !line.is_empty()
            && line.bytes().all(|byte| matches!(byte, b')' | b']'))
    }

    /// Whether not even the space of a place fits.
    fn is_wide(&self, place: Break) -> bool {
        place.is_spaced && self.column >= self.options.width
    }

    /// Whether what follows fits into the line, up to the next place where the line can end. Groups
    /// are taken to stand in one line; `depth` of them have been opened just before.
    fn fits(&self, from: usize, mut depth: usize) -> bool {
        let mut left = self.options.width.saturating_sub(self.column()) as isize;
        let mut above = self.open.len();
        // Whether the next place is the first one of a block, which can always end its line.
        let mut is_block = false;
        for op in &self.ops[from..] {
            match *op {
                Op::Token(index) => {
                    let (width, is_whole) = self.width_of(index as usize);
                    left -= width as isize;
                    if !is_whole {
                        return left >= 0;
                    }
                }
                Op::Space | Op::Soft { is_forced: false } => left -= 1,
                Op::Gap(_) => return left >= 0,
                Op::Line(_) | Op::Soft { is_forced: true } => return left >= 0,
                Op::Break(place) => {
                    let mode = match depth {
                        0 => self.open[..above].last().map_or(Mode::Flat, |group| group.mode),
                        _ => Mode::Flat,
                    };
                    if place.is_forced || is_block || mode != Mode::Flat {
                        return left >= 0;
                    }
                    left -= isize::from(place.is_spaced);
                }
                Op::Open(group) => {
                    depth += 1;
                    is_block |= group.kind == GroupKind::Block;
                }
                Op::Close if depth > 0 => depth -= 1,
                Op::Close => above = above.saturating_sub(1),
            }
            if left < 0 {
                return false;
            }
        }
        true
    }

    /// Whether what follows a place behind `=` does not fit up to the first place where the line
    /// can end, and there is more room in the next line.
    fn needs_break(&self, index: usize) -> bool {
        let next = (usize::from(self.top().element) + 1) * self.options.indent.columns();
        let mut left = self.options.width as isize - self.column() as isize - 1;
        if next > self.column() {
            return false;
        }
        for op in &self.ops[index + 1..] {
            match *op {
                Op::Token(token) => {
                    let (width, is_whole) = self.width_of(token as usize);
                    left -= width as isize;
                    if !is_whole {
                        break;
                    }
                }
                Op::Space => left -= 1,
                Op::Break(_) | Op::Soft { .. } | Op::Line(_) | Op::Gap(_) => break,
                Op::Open(_) | Op::Close => {}
            }
            if left < 0 {
                return true;
            }
        }
        left < 0
    }

    /// The columns of a token, up to its first line break; whether it has none.
    fn width_of(&self, index: usize) -> (usize, bool) {
        let token = &self.tokens[index];
        let text = token.text(self.text);
        let is_short = matches!(token.kind, Kind::Word | Kind::Number | Kind::Mark);
        if is_short && text.is_ascii() {
            return (text.len(), true);
        }
        let line = text.find('\n').map_or(text, |end| &text[..end]);
        (line.chars().count(), line.len() == text.len() && !token.ends_line())
    }

    fn column(&self) -> usize {
        match self.pending {
            Some(level) => usize::from(level) * self.options.indent.columns(),
            None => self.column,
        }
    }

    fn newline(&mut self, level: u16, is_margin: bool, is_empty: bool) {
        if self.out.len() > self.start {
            self.out.push('\n');
            if is_empty {
                self.out.push('\n');
            }
        }
        self.column = 0;
        self.level = level;
        self.pending = Some(if is_margin { 0 } else { level });
        self.is_ended = false;
    }

    fn write(&mut self, text: &str) {
        self.out.push_str(text);
        self.column += text.len();
    }

    fn indent(&mut self) {
        let Some(level) = self.pending.take() else { return };
        for _ in 0..level {
            match self.options.indent {
                Indent::Tab => self.out.push('\t'),
                Indent::Spaces(count) => {
                    self.out.extend(std::iter::repeat_n(' ', usize::from(count)));
                }
            }
        }
        self.column = usize::from(level) * self.options.indent.columns();
    }

    fn token(&mut self, index: usize) {
        let token = &self.tokens[index];
        let is_started = self.pending.is_none() && self.out.len() > self.start;
        if is_started && (self.is_ended || token.begins_line()) {
            // No layout puts a token there; a comment must not swallow one in any case.
            self.newline(self.top().element + 1, false, false);
        }
        if token.kind == Kind::Raw {
            self.pending = None;
        }
        let is_first = self.pending.is_some();
        self.indent();
        let text = token.text(self.text);
        match token.kind {
            Kind::BlockComment if text.contains('\n') => self.block_comment(token, is_first),
            Kind::BlockComment | Kind::Raw | Kind::Other | Kind::Directive => {
                self.out.push_str(text);
                self.column = match text.rfind('\n') {
                    Some(end) => text[end + 1..].chars().count(),
                    None => self.column + text.chars().count(),
                };
            }
            _ => {
                self.out.push_str(text);
                self.column += if text.is_ascii() { text.len() } else { text.chars().count() };
            }
        }
        self.is_ended = token.ends_line();
    }

    /// A comment over several lines. The lines below move with the first one if they are indented
    /// at least as far.
    fn block_comment(&mut self, token: &Token, is_first: bool) {
        let text = token.text(self.text);
        let start = token.start as usize;
        let line = self.text[..start].rfind('\n').map_or(0, |at| at + 1);
        let old = &self.text[line..start];
        let is_alone = is_first && old.chars().all(|letter| matches!(letter, ' ' | '\t'));
        let mut rest = text.split('\n').skip(1);
        let is_moved = is_alone && rest.all(|line| line.starts_with(old) || line.trim().is_empty());
        let own = self.out.rfind('\n').map_or(0, |at| at + 1);
        let new = self.out[own..].to_owned();
        for (number, line) in text.split('\n').enumerate() {
            if number > 0 {
                self.out.push('\n');
            }
            let line = line.trim_end_matches([' ', '\t']);
            match line.strip_prefix(old).filter(|_| is_moved && number > 0 && !line.is_empty()) {
                Some(moved) => {
                    self.out.push_str(&new);
                    self.out.push_str(moved);
                }
                None => self.out.push_str(line),
            }
        }
        let last = self.out.rfind('\n').map_or(0, |at| at + 1);
        self.column = self.out[last..].chars().count();
    }

    fn gap(&mut self, index: usize) {
        let start = self.tokens[index].start as usize;
        let blanks = self.text[..start].trim_end_matches([' ', '\t']).len();
        match &self.text[blanks..start] {
            "" => self.write(" "),
            author => self.write(author),
        }
    }
}

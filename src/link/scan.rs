//! What one declaration of WGSL names, and where it takes derivatives; without the module around it.

use super::outline::{HANDLES, Kind};
use super::words::{begins_word, end, words};

/// What there is to know of one declaration without the others.
#[derive(Debug, Default)]
pub struct Scan {
    /// Names that are not the declaration's own, in the order of appearance, each once.
    pub names: Vec<Name>,
    /// How many of them are in the signature.
    pub signature: usize,
    /// Bytes of the signature.
    pub head: usize,
    /// Members of a structure, or arguments of a function.
    pub members: Vec<Box<str>>,
    /// Whether a call can be noticed by more than its value, whatever the names stand for.
    pub acts: bool,
}

/// A name of the module or of the language.
#[derive(Debug)]
pub struct Name {
    pub text: Box<str>,
    /// Used where neighbouring fragments may have parted.
    pub loud: bool,
    /// As the language's own: compares neighbouring fragments,
    pub derives: bool,
    /// and is more than a computation.
    pub acts: bool,
}

/// Reads one declaration. `None` where its brackets do not match.
pub fn scan(text: &str, kind: Kind, name: &str) -> Option<Scan> {
    let is_function = matches!(kind, Kind::Function | Kind::Entry);
    let head = if is_function { text.find('{')? } else { text.len() };
    let mut scanner = Scanner { text, scan: Scan { head, ..Scan::default() }, locals: Vec::new() };
    let members = scanner.signature(kind, name)?;
    scanner.scan.signature = scanner.scan.names.len();
    scanner.scan.members = members.iter().map(|member| (*member).into()).collect();
    if is_function {
        scanner.locals = members;
        scanner.body()?;
    }
    Some(scanner.scan)
}

struct Scanner<'a> {
    text: &'a str,
    scan: Scan,
    /// Names that are declared within the function and visible.
    locals: Vec<&'a str>,
}

/// A block, and what its end takes out of sight.
struct Block {
    locals: usize,
}

/// Where the scanner is in a body.
#[derive(Default)]
struct Place<'a> {
    blocks: Vec<Block>,
    /// Locals before the header of a loop whose body has not begun.
    header: Option<usize>,
    /// `let` or `var` was read: the next word is a name.
    declares: bool,
    /// A name that is visible after its statement.
    pending: Option<&'a str>,
    /// Fragments may have parted within the statement, or in its header.
    parted_here: bool,
    /// Some fragments may have left.
    parted: bool,
}

impl<'a> Scanner<'a> {
    /// Everything before a body, where all names are those of the module; what it gives names to.
    fn signature(&mut self, kind: Kind, own: &str) -> Option<Vec<&'a str>> {
        let text = self.text.get(..self.scan.head)?;
        let has_members = kind != Kind::Variable && (kind != Kind::Other || text.contains('{'));
        let mut members = Vec::new();
        for word in words(text).filter(|word| !matches!(word.before, b'@' | b'.') && word.text != own) {
            let is_member = has_members && text[word.start + word.text.len()..].trim_start().starts_with(':');
            self.scan.acts |= HANDLES.iter().any(|handle| word.text.starts_with(handle));
            if is_member { members.push(word.text) } else { self.name(word.text, false) }
        }
        Some(members)
    }

    fn name(&mut self, word: &str, loud: bool) {
        match self.scan.names.iter_mut().find(|name| &*name.text == word) {
            Some(name) => name.loud |= loud,
            None => self.scan.names.push(Name { text: word.into(), loud, derives: derives(word), acts: derives(word) || acts(word) }),
        }
    }

    fn body(&mut self) -> Option<()> {
        let bytes = self.text.as_bytes();
        let (mut at, mut before) = (self.scan.head, b' ');
        let mut place = Place::default();
        while let Some(&byte) = bytes.get(at) {
            let start = at;
            at = end(bytes, at);
            match byte {
                b'{' => self.open(&mut place),
                b'}' => self.close(&mut place)?,
                b';' => self.statement(&mut place),
                b'<' if place.declares => at += self.text[at..].find('>')? + 1,
                b'&' | b'|' if bytes.get(at) == Some(&byte) => {
                    at += 1;
                    place.parted_here = true;
                }
                b'&' => self.scan.acts = true,
                _ if begins_word(byte) && !matches!(before, b'.' | b'@') => self.word(&self.text[start..at], &mut place),
                _ => {}
            }
            if !byte.is_ascii_whitespace() {
                before = bytes[at - 1];
            }
        }
        place.blocks.is_empty().then_some(())
    }

    fn open(&mut self, place: &mut Place<'a>) {
        place.blocks.push(Block { locals: place.header.take().unwrap_or(self.locals.len()) });
        place.parted_here = false;
    }

    fn close(&mut self, place: &mut Place<'a>) -> Option<()> {
        self.locals.truncate(place.blocks.pop()?.locals);
        place.parted_here = false;
        Some(())
    }

    fn statement(&mut self, place: &mut Place<'a>) {
        self.locals.extend(place.pending.take());
        // The header of a loop is read again and again.
        place.parted_here = place.header.is_some();
    }

    fn word(&mut self, word: &'a str, place: &mut Place<'a>) {
        if std::mem::take(&mut place.declares) {
            place.pending = Some(word);
            return;
        }
        match word {
            "let" | "var" | "const" => place.declares = true,
            "for" | "while" => {
                place.header = Some(self.locals.len());
                place.parted_here = true;
            }
            "else" => place.parted_here = true,
            "return" | "discard" | "break" | "continue" if place.blocks.len() > 1 => place.parted = true,
            _ if self.locals.contains(&word) => return,
            _ => self.name(word, place.blocks.len() > 1 || place.parted || place.parted_here),
        }
        self.scan.acts |= word == "discard";
    }
}

/// Built-ins that compare neighbouring fragments.
fn derives(word: &str) -> bool {
    matches!(word, "textureSample" | "textureSampleBias" | "textureSampleCompare")
        || ["dpdx", "dpdy", "fwidth"].iter().any(|name| word.starts_with(name))
}

/// Built-ins that are more than a computation.
fn acts(word: &str) -> bool {
    let starts = ["atomic", "subgroup", "quad", "workgroup", "arrayLength"];
    starts.iter().chain(&HANDLES).any(|start| word.starts_with(start)) || word.ends_with("Barrier")
}

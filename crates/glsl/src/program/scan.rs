//! The declarations of files that are not preprocessed: all branches one after another.

use std::collections::{BTreeMap, BTreeSet};

use crate::lexer::{Kind, Lexed, Token, mark, tokenize};
use crate::types::{Type, named_type};

/// The size of an array that is neither a number nor a constant.
const OPEN_SIZE: u32 = 16;

/// The longest array whose elements have numbers of their own.
const LONGEST: u32 = 64;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DeclaredKind {
    Input,
    Output,
    /// A texture, an image, a sampler or a block.
    Resource,
}

/// Something that has a location or a binding.
#[derive(Debug, Clone, Copy)]
pub(super) struct Declared<'t> {
    pub(super) kind: DeclaredKind,
    /// Its name; that of the block, where it is one.
    pub(super) name: &'t str,
    /// How many numbers it takes.
    pub(super) count: u32,
    /// How many combined textures it has.
    pub(super) samplers: u32,
    /// The number that the text gives it.
    pub(super) number: Option<u32>,
    pub(super) group: u32,
}

/// A uniform outside of blocks.
#[derive(Debug, Clone)]
pub(super) struct Loose<'t> {
    pub(super) name: &'t str,
    pub(super) ty: &'t str,
    /// The lengths of arrays, the outermost first.
    pub(super) lengths: Vec<u32>,
    /// Its size by the rules of `std140`.
    pub(super) size: u32,
    /// Whether a length may be another one in other permutations.
    pub(super) open: bool,
    /// Whether its type is the language's, or a structure of the files.
    pub(super) is_known: bool,
}

/// What a stage declares, in the order of the files.
#[derive(Debug, Default)]
pub(super) struct Scanned<'t> {
    declared: Vec<Declared<'t>>,
    pub(super) loose: Vec<Loose<'t>>,
    structures: BTreeMap<&'t str, Parts>,
    sizes: BTreeMap<&'t str, u32>,
    /// The macros among the sizes that other directives may change.
    changing: BTreeSet<&'t str>,
}

/// What a type consists of.
#[derive(Debug, Clone, Copy, Default)]
struct Parts {
    locations: u32,
    opaque: u32,
    combined: u32,
    /// Whether it has anything but textures and samplers.
    plain: bool,
    /// Alignment and size of the rest by the rules of `std140`.
    align: u32,
    size: u32,
    /// Whether the size depends on the permutation.
    open: bool,
}

fn round_up(value: u32, align: u32) -> u32 {
    value.div_ceil(align.max(1)).saturating_mul(align.max(1))
}

impl Parts {
    fn times(self, count: u32) -> Self {
        let Self { locations, opaque, combined, plain, align: _, size, open } = self;
        let times = |number: u32| number.saturating_mul(count);
        let (locations, opaque) = (times(locations), times(opaque));
        let size = times(round_up(size, 16));
        Self { locations, opaque, combined: times(combined), plain, align: 16, size, open }
    }

    fn with(self, other: Self) -> Self {
        Self {
            locations: self.locations.saturating_add(other.locations),
            opaque: self.opaque.saturating_add(other.opaque),
            combined: self.combined.saturating_add(other.combined),
            plain: self.plain || other.plain,
            align: self.align.max(other.align),
            size: round_up(self.size, other.align).saturating_add(other.size),
            open: self.open || other.open,
        }
    }

    /// The size of so many numbers of four bytes in a row.
    fn of_numbers(count: u32) -> Self {
        let align = if count == 3 { 16 } else { 4 * count };
        Self { locations: 1, plain: true, align, size: 4 * count, ..Self::default() }
    }
}

/// The tokens of one file.
struct File<'t> {
    text: &'t str,
    tokens: Vec<Token>,
}

impl<'t> File<'t> {
    fn word(&self, at: usize) -> Option<&'t str> {
        let token = self.tokens.get(at)?;
        (token.kind == Kind::Word).then(|| &self.text[token.at.range()])
    }

    fn is(&self, at: usize, text: &'static str) -> bool {
        self.tokens.get(at).is_some_and(|token| token.kind == mark(text))
    }

    fn number(&self, at: usize) -> Option<u32> {
        let token = self.tokens.get(at)?;
        let digits = &self.text[token.at.range()];
        match token.kind {
            Kind::Int | Kind::Uint => digits.trim_end_matches(['u', 'U']).parse().ok(),
            _ => None,
        }
    }

    fn at_end(&self, at: usize) -> bool {
        self.tokens.get(at).is_none_or(|token| token.kind == Kind::End)
    }

    /// Behind the bracket that closes the one at a place.
    fn behind(&self, open: usize, pair: [&'static str; 2]) -> usize {
        let (mut depth, mut at) = (0_u32, open);
        while !self.at_end(at) {
            depth += u32::from(self.is(at, pair[0]));
            if self.is(at, pair[1]) {
                depth = depth.saturating_sub(1);
                if depth == 0 {
                    return at + 1;
                }
            }
            at += 1;
        }
        at
    }
}

/// What stands before the type of a declaration.
#[derive(Debug, Default)]
struct Qualifiers {
    input: bool,
    output: bool,
    uniform: bool,
    buffer: bool,
    location: Option<u32>,
    binding: Option<u32>,
    group: u32,
    /// Whether a number is given that is not read here, such as a sum of constants. The translator
    /// reads it.
    unread: bool,
}

/// Words before a type that decide nothing here.
const PASSED: &[&str] = &[
    "attribute",
    "centroid",
    "coherent",
    "const",
    "flat",
    "highp",
    "in",
    "invariant",
    "lowp",
    "mediump",
    "noperspective",
    "out",
    "patch",
    "precise",
    "readonly",
    "restrict",
    "sample",
    "shared",
    "smooth",
    "uniform",
    "buffer",
    "varying",
    "volatile",
    "writeonly",
    "layout",
];

impl<'t> Scanned<'t> {
    /// Reads the files of a stage, its root first.
    pub(super) fn of(texts: &[&'t str]) -> Self {
        let mut found = Self::default();
        let files: Vec<File<'t>> = texts
            .iter()
            .map(|text| {
                let Lexed { tokens, comments: _, directives } = tokenize(text);
                directives.iter().for_each(|at| found.directive(&text[at.range()]));
                File { text, tokens }
            })
            .collect();
        // What a root uses may be declared in a file that it includes.
        for pass in [Pass::Structures, Pass::Declarations] {
            files.iter().for_each(|file| found.read_file(file, pass));
        }
        found
    }

    /// Keeps the value of a macro, and the words of the other directives.
    fn directive(&mut self, line: &'t str) {
        if let Some((name, number)) = definition(line) {
            if self.sizes.insert(name, number).is_some() {
                self.changing.insert(name);
            }
            return;
        }
        let is_part = |letter: char| letter.is_alphanumeric() || letter == '_';
        self.changing.extend(line.split(|letter| !is_part(letter)));
    }

    pub(super) fn of_kind(&self, kind: DeclaredKind) -> impl Iterator<Item = &Declared<'t>> {
        self.declared.iter().filter(move |declared| declared.kind == kind)
    }

    fn read_file(&mut self, file: &File<'t>, pass: Pass) {
        let mut at = 0;
        while !file.at_end(at) {
            at = self.item(file, at, pass).max(at + 1);
        }
    }

    /// Reads one declaration, and gives the place behind it.
    fn item(&mut self, file: &File<'t>, start: usize, pass: Pass) -> usize {
        let (qualifiers, at) = self.qualifiers(file, start);
        if file.word(at) == Some("struct") {
            return self.structure(file, at, pass);
        }
        let Some(ty) = file.word(at) else { return at };
        if file.is(at + 1, "{") {
            let (parts, next) = self.members(file, at + 1);
            if pass == Pass::Declarations {
                self.block(&qualifiers, ty, parts, self.block_elements(file, next));
            }
            return end_of_item(file, next);
        }
        let behind_type = at + 1;
        let of_type = self.sized(file, behind_type, self.parts_of(ty));
        let mut at = of_type.1;
        while let Some(name) = file.word(at) {
            if file.is(at + 1, "(") {
                return end_of_item(file, file.behind(at + 1, ["(", ")"]));
            }
            let (parts, next) = self.sized(file, at + 1, of_type.0);
            match pass {
                Pass::Structures => self.constant(file, name, next),
                Pass::Declarations => {
                    self.variable(&qualifiers, name, parts);
                    if qualifiers.uniform && parts.plain && !name.starts_with("gl_") {
                        let mut lengths = self.lengths(file, at + 1);
                        lengths.extend(self.lengths(file, behind_type));
                        let Parts { size, open, .. } = parts;
                        let is_known = named_type(ty).is_some() || self.structures.contains_key(ty);
                        self.loose.push(Loose { name, ty, lengths, size, open, is_known });
                    }
                }
            }
            at = end_of_declarator(file, next);
            if !file.is(at, ",") {
                break;
            }
            at += 1;
        }
        end_of_item(file, at)
    }

    fn qualifiers(&self, file: &File<'t>, start: usize) -> (Qualifiers, usize) {
        let (mut found, mut at) = (Qualifiers::default(), start);
        while let Some(word) = file.word(at).filter(|word| PASSED.contains(word)) {
            match word {
                "attribute" | "in" => found.input = true,
                "out" => found.output = true,
                // The stage decides.
                "varying" => (found.input, found.output) = (true, true),
                "uniform" => found.uniform = true,
                "buffer" => found.buffer = true,
                "layout" => {
                    let end = file.behind(at + 1, ["(", ")"]);
                    self.layout(file, at + 1..end, &mut found);
                    at = end;
                    continue;
                }
                _ => {}
            }
            at += 1;
        }
        (found, at)
    }

    fn layout(&self, file: &File<'t>, range: std::ops::Range<usize>, found: &mut Qualifiers) {
        for at in range {
            let is_given = file.is(at + 1, "=");
            let is_single = file.is(at + 3, ",") || file.is(at + 3, ")");
            let given = (is_given && is_single).then(|| self.size_at(file, at + 2)).flatten();
            let is_number = matches!(file.word(at), Some("location" | "binding" | "set"));
            found.unread |= is_given && is_number && given.is_none();
            match file.word(at) {
                Some("location") => found.location = given,
                Some("binding") => found.binding = given,
                Some("set") => found.group = given.unwrap_or(0),
                _ => {}
            }
        }
    }

    fn structure(&mut self, file: &File<'t>, at: usize, pass: Pass) -> usize {
        let Some(name) = file.word(at + 1) else { return at + 1 };
        let (parts, next) = self.members(file, at + 2);
        if pass == Pass::Structures {
            let size = round_up(parts.size, 16);
            self.structures.insert(name, Parts { align: 16, size, ..parts });
        }
        end_of_item(file, next)
    }

    /// The parts of all members, and the place behind the brace.
    fn members(&self, file: &File<'t>, open: usize) -> (Parts, usize) {
        let end = file.behind(open, ["{", "}"]);
        let (mut parts, mut at) = (Parts::default(), open + 1);
        while at + 1 < end {
            let (_, next) = self.qualifiers(file, at);
            let Some(ty) = file.word(next) else {
                at = next + 1;
                continue;
            };
            let (of_type, mut next) = self.sized(file, next + 1, self.parts_of(ty));
            while file.word(next).is_some() && next < end {
                let (one, after) = self.sized(file, next + 1, of_type);
                parts = parts.with(one);
                next = after + usize::from(file.is(after, ","));
            }
            at = next + 1;
        }
        (parts, end)
    }

    /// How many elements the instance of a block has.
    fn block_elements(&self, file: &File<'t>, at: usize) -> u32 {
        let one = Parts { locations: 1, ..Parts::default() };
        match file.word(at) {
            Some(_) => self.sized(file, at + 1, one).0.locations,
            None => 1,
        }
    }

    /// The parts of an array of a type, whose sizes begin at a place.
    fn sized(&self, file: &File<'t>, start: usize, mut parts: Parts) -> (Parts, usize) {
        let mut at = start;
        while file.is(at, "[") {
            let end = file.behind(at, ["[", "]"]);
            let known = if end == at + 3 { self.size_at(file, at + 1) } else { None };
            // An array without a size is one of bindings, which has one number.
            let size = if end == at + 2 { 1 } else { known.unwrap_or(OPEN_SIZE) };
            parts = parts.times(size);
            let is_changing = file.word(at + 1).is_some_and(|name| self.changing.contains(name));
            parts.open |= known.is_none() || is_changing;
            at = end;
        }
        (parts, at)
    }

    /// The lengths of an array that begin at a place, where they are known.
    fn lengths(&self, file: &File<'t>, start: usize) -> Vec<u32> {
        let (mut found, mut at) = (Vec::new(), start);
        while file.is(at, "[") {
            found.extend(self.size_at(file, at + 1));
            at = file.behind(at, ["[", "]"]);
        }
        found
    }

    fn size_at(&self, file: &File<'t>, at: usize) -> Option<u32> {
        file.number(at).or_else(|| self.sizes.get(file.word(at)?).copied())
    }

    /// Keeps the value of an integer.
    fn constant(&mut self, file: &File<'t>, name: &'t str, at: usize) {
        if file.is(at, "=")
            && let Some(number) = file.number(at + 1)
            && (file.is(at + 2, ";") || file.is(at + 2, ","))
        {
            self.sizes.insert(name, number);
        }
    }

    fn parts_of(&self, ty: &str) -> Parts {
        if let Some(parts) = self.structures.get(ty) {
            return *parts;
        }
        let bare = ty.strip_prefix(['i', 'u']).unwrap_or(ty);
        let is_combined =
            bare.starts_with("sampler") && !["sampler", "samplerShadow"].contains(&ty);
        let opaque = ["sampler", "image", "texture", "subpassInput", "accelerationStructure"];
        if opaque.iter().any(|start| bare.starts_with(start)) {
            let filtered = is_combined && !bare.contains("MS");
            let combined = u32::from(filtered);
            return Parts { locations: 1, opaque: 1, combined, ..Parts::default() };
        }
        match named_type(ty) {
            Some(Type::Matrix(_, columns, _)) => {
                let columns = u32::from(columns);
                Parts { locations: columns, size: 16 * columns, ..Parts::of_numbers(4) }
            }
            Some(Type::Vector(_, count)) => Parts::of_numbers(u32::from(count)),
            _ => Parts::of_numbers(1),
        }
    }

    fn block(&mut self, qualifiers: &Qualifiers, name: &'t str, parts: Parts, elements: u32) {
        let Qualifiers { input, output, uniform, buffer, location, binding, group, unread } =
            *qualifiers;
        if unread || name.starts_with("gl_") {
            return;
        }
        let count = parts.locations.saturating_mul(elements);
        self.interface(input, output, name, count, location);
        if uniform || buffer {
            let count = if elements > LONGEST { 1 } else { elements };
            self.declared.push(Declared {
                kind: DeclaredKind::Resource,
                name,
                count,
                samplers: 0,
                number: binding,
                group,
            });
        }
    }

    fn variable(&mut self, qualifiers: &Qualifiers, name: &'t str, parts: Parts) {
        let Qualifiers { input, output, uniform, buffer: _, location, binding, group, unread } =
            *qualifiers;
        if unread || name.starts_with("gl_") {
            return;
        }
        self.interface(input, output, name, parts.locations, location);
        if uniform && parts.opaque > 0 {
            let bound = parts.opaque > LONGEST;
            self.declared.push(Declared {
                kind: DeclaredKind::Resource,
                name,
                count: if bound { 1 } else { parts.opaque },
                samplers: if bound { parts.combined.min(1) } else { parts.combined },
                number: binding,
                group,
            });
        }
    }

    fn interface(
        &mut self,
        input: bool,
        output: bool,
        name: &'t str,
        count: u32,
        number: Option<u32>,
    ) {
        let kinds = [(input, DeclaredKind::Input), (output, DeclaredKind::Output)];
        for kind in kinds.into_iter().filter_map(|(is_it, kind)| is_it.then_some(kind)) {
            let count = count.clamp(1, LONGEST);
            let (samplers, group) = (0, 0);
            self.declared.push(Declared { kind, name, count, samplers, number, group });
        }
    }
}

/// What is read of a file at a time.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pass {
    /// Structures and constants, which declarations need.
    Structures,
    Declarations,
}

/// `#define NAME 4`
fn definition(line: &str) -> Option<(&str, u32)> {
    let rest = line.strip_prefix('#')?.trim_start().strip_prefix("define")?;
    let mut words = rest.split_whitespace();
    let name = words.next()?;
    let number = words.next()?.parse().ok()?;
    words.next().is_none().then_some((name, number))
}

/// The `,` or `;` behind a declarator and its initializer.
fn end_of_declarator(file: &File<'_>, start: usize) -> usize {
    let mut at = start;
    while !file.at_end(at) && !file.is(at, ",") && !file.is(at, ";") {
        at = match () {
            () if file.is(at, "(") => file.behind(at, ["(", ")"]),
            () if file.is(at, "{") => file.behind(at, ["{", "}"]),
            () if file.is(at, "[") => file.behind(at, ["[", "]"]),
            () => at + 1,
        };
    }
    at
}

/// Behind the `;` or the body that ends a declaration.
fn end_of_item(file: &File<'_>, start: usize) -> usize {
    let mut at = start;
    while !file.at_end(at) {
        if file.is(at, "{") {
            return file.behind(at, ["{", "}"]);
        }
        at += 1;
        if file.is(at - 1, ";") {
            return at;
        }
    }
    at
}

//! Splits modules of SPIR-V at their declarations, with a hole for each id.

use std::collections::BTreeMap;

/// Called with the bytes of a piece, the bits of its holes, and their values.
pub type Take<'t> = &'t mut dyn FnMut(&[u8], &[u8], &[u32]);

const MAGIC: u32 = 0x0723_0203;
/// Words before the first instruction, and which of them is the bound of the ids.
const HEADER: usize = 5;
const BOUND: usize = 3;

/// Numbers of instructions, from the specification of SPIR-V 1.6, section 3.
mod op {
    pub const SOURCE: u16 = 3;
    pub const NAME: u16 = 5;
    pub const MEMBER_NAME: u16 = 6;
    pub const STRING: u16 = 7;
    pub const EXTENSION: u16 = 10;
    pub const EXT_INST_IMPORT: u16 = 11;
    pub const EXT_INST: u16 = 12;
    pub const MEMORY_MODEL: u16 = 14;
    pub const ENTRY_POINT: u16 = 15;
    pub const EXECUTION_MODE: u16 = 16;
    pub const CAPABILITY: u16 = 17;
    pub const TYPE_INT: u16 = 21;
    pub const TYPE_FLOAT: u16 = 22;
    pub const TYPE_VECTOR: u16 = 23;
    pub const TYPE_MATRIX: u16 = 24;
    pub const TYPE_IMAGE: u16 = 25;
    pub const TYPE_POINTER: u16 = 32;
    pub const CONSTANT: u16 = 43;
    pub const SPEC_CONSTANT: u16 = 50;
    pub const SPEC_CONSTANT_OP: u16 = 52;
    pub const FUNCTION: u16 = 54;
    pub const FUNCTION_END: u16 = 56;
    pub const VARIABLE: u16 = 59;
    pub const LOAD: u16 = 61;
    pub const STORE: u16 = 62;
    pub const DECORATE: u16 = 71;
    pub const MEMBER_DECORATE: u16 = 72;
    pub const VECTOR_SHUFFLE: u16 = 79;
    pub const COMPOSITE_EXTRACT: u16 = 81;
    pub const COMPOSITE_INSERT: u16 = 82;
    pub const LOOP_MERGE: u16 = 246;
    pub const SELECTION_MERGE: u16 = 247;
}

/// Whether bytes are words of SPIR-V.
pub fn is_spirv(bytes: &[u8]) -> bool {
    bytes.len().is_multiple_of(4)
        && bytes.first_chunk().copied().map(u32::from_le_bytes) == Some(MAGIC)
}

/// Passes the pieces of a module to `take`: its header, each instruction before the functions, and
/// each function. Returns false if it is damaged.
pub fn split(bytes: &[u8], take: Take<'_>) -> bool {
    let words: Vec<u32> =
        bytes.as_chunks::<4>().0.iter().copied().map(u32::from_le_bytes).collect();
    if words.len() < HEADER {
        return false;
    }
    let mut piece = PieceOfWords::default();
    piece.words(&words[..HEADER], &|index| index == BOUND);
    piece.pass_on(take);
    let (mut at, mut is_inside) = (HEADER, false);
    while let Some(first) = words.get(at) {
        let (op, length) = (*first as u16, (first >> 16) as usize);
        let Some(instruction) = words.get(at..at + length).filter(|all| !all.is_empty()) else {
            return false;
        };
        let literals = literals_of(op);
        piece.words(instruction, &|index| index > 0 && !literals.contains(index, instruction));
        is_inside = (is_inside || op == op::FUNCTION) && op != op::FUNCTION_END;
        if !is_inside {
            piece.pass_on(take);
        }
        at += length;
    }
    piece.pass_on(take);
    true
}

/// Which words of an instruction are no ids. What is taken for an id by mistake is a value that does
/// not change, which costs a few bytes and nothing else.
enum Literals {
    None,
    All,
    At(usize),
    From(usize),
    /// Those of an entry point: its execution model, and its name, which is between its id and those
    /// of what it uses.
    EntryPoint,
}

impl Literals {
    fn contains(&self, index: usize, instruction: &[u32]) -> bool {
        match *self {
            Self::None => false,
            Self::All => true,
            Self::At(at) => index == at,
            Self::From(from) => index >= from,
            Self::EntryPoint => {
                let ends = |word: &u32| word.to_le_bytes().contains(&0);
                let name = instruction.iter().skip(3).position(ends).unwrap_or(0);
                index != 2 && index <= 3 + name
            }
        }
    }
}

fn literals_of(op: u16) -> Literals {
    match op {
        op::SOURCE | op::EXTENSION | op::MEMORY_MODEL | op::CAPABILITY => Literals::All,
        op::NAME
        | op::MEMBER_NAME
        | op::STRING
        | op::EXT_INST_IMPORT
        | op::EXECUTION_MODE
        | op::DECORATE
        | op::MEMBER_DECORATE
        | op::TYPE_INT
        | op::TYPE_FLOAT
        | op::SELECTION_MERGE => Literals::From(2),
        op::TYPE_VECTOR
        | op::TYPE_MATRIX
        | op::TYPE_IMAGE
        | op::CONSTANT
        | op::SPEC_CONSTANT
        | op::STORE
        | op::LOOP_MERGE => Literals::From(3),
        op::LOAD | op::COMPOSITE_EXTRACT => Literals::From(4),
        op::VECTOR_SHUFFLE | op::COMPOSITE_INSERT => Literals::From(5),
        op::TYPE_POINTER => Literals::At(2),
        op::SPEC_CONSTANT_OP | op::FUNCTION | op::VARIABLE => Literals::At(3),
        op::EXT_INST => Literals::At(4),
        op::ENTRY_POINT => Literals::EntryPoint,
        _ => Literals::None,
    }
}

/// A piece that is being made.
#[derive(Default)]
struct PieceOfWords {
    bytes: Vec<u8>,
    holes: Vec<u8>,
    values: Vec<u32>,
    /// The index of each value.
    indices: BTreeMap<u32, u32>,
}

impl PieceOfWords {
    /// Adds words. `is_hole` says which of them are holes.
    fn words(&mut self, words: &[u32], is_hole: &dyn Fn(usize) -> bool) {
        for (index, word) in words.iter().enumerate() {
            let place = self.bytes.len() / 4;
            if place.is_multiple_of(8) {
                self.holes.push(0);
            }
            let mut stored = *word;
            if is_hole(index) {
                stored = self.index_of(*word);
                self.holes[place / 8] |= 1 << (place % 8);
            }
            self.bytes.extend_from_slice(&stored.to_le_bytes());
        }
    }

    fn index_of(&mut self, value: u32) -> u32 {
        let next = self.values.len() as u32;
        let index = *self.indices.entry(value).or_insert(next);
        if index == next {
            self.values.push(value);
        }
        index
    }

    fn pass_on(&mut self, take: Take<'_>) {
        if self.bytes.is_empty() {
            return;
        }
        let holes: &[u8] = if self.values.is_empty() { &[] } else { &self.holes };
        take(&self.bytes, holes, &self.values);
        self.bytes.clear();
        self.holes.clear();
        self.values.clear();
        self.indices.clear();
    }
}

//! Takes SPIR-V modules apart by function, and puts pieces of different modules together.
//!
//! A piece holds nothing that depends on the rest of its module. Its own ids count from zero. What
//! it needs from outside is named by content or, for the author's functions, by name. So a module
//! made of its own pieces has the same bytes as one made of equal pieces found elsewhere.
//!
//! For the same reason a piece loses what naga adds because of other functions: the names of
//! constants, and the loads of variables that only callees use.

mod assemble;
mod capabilities;
mod module;
mod operands;
mod split;

pub use assemble::assemble_module;
pub use split::split_module;

use rustc_hash::FxHashMap;

/// Magic number, version 1.0 and the number of the generator, naga: other generators order their
/// modules differently.
const HEADER: [u32; 3] = [0x0723_0203, 0x0001_0000, 28];
/// Logical addressing with the GLSL memory model, as one instruction.
const MEMORY_MODEL: [u32; 3] = [3 << 16 | 14, 0, 1];
/// Bounds the recursion over calls and nested types, so that a malformed module cannot overflow the
/// stack of a small thread.
const DEPTH: u32 = 96;

/// What a piece needs from outside.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Ref {
    /// A declaration, by its number in the pool.
    Pool(u32),
    /// One of the author's functions.
    User(String),
}

/// Instructions whose ids are not yet assigned.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Instructions {
    words: Vec<u32>,
    /// Where the words hold the piece's own ids, counted from zero.
    locals: Vec<u32>,
    /// Where the words need ids from outside, each with the index of its reference.
    links: Vec<(u32, u32)>,
}

impl Instructions {
    /// Copies the words and fills in the ids.
    fn write(&self, base: u32, links: &[u32], out: &mut Vec<u32>) {
        let start = out.len();
        out.extend_from_slice(&self.words);
        let tail = out.get_mut(start..).unwrap_or_default();
        for &at in &self.locals {
            if let Some(word) = tail.get_mut(at as usize) {
                *word = word.wrapping_add(base);
            }
        }
        for &(at, link) in &self.links {
            if let (Some(word), Some(&id)) = (tail.get_mut(at as usize), links.get(link as usize)) {
                *word = id;
            }
        }
    }
}

/// A function or a declaration. What it needs from outside is a reference: into the pool, or by
/// name.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Piece {
    /// The instruction `OpEntryPoint`; empty for all but entry points.
    entry: Instructions,
    modes: Instructions,
    names: Instructions,
    notes: Instructions,
    body: Instructions,
    /// What is needed from outside: each once, in order of appearance.
    refs: Vec<Ref>,
    /// The capabilities that its own instructions need, sorted.
    needs: Vec<u32>,
    /// How many ids of its own it has.
    ids: u32,
}

/// Where a piece goes in a module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shelf {
    Import,
    Global,
    Function,
}
const SHELVES: [Shelf; 3] = [Shelf::Import, Shelf::Global, Shelf::Function];

/// Something that functions share.
#[derive(Debug)]
struct SharedDeclaration {
    shelf: Shelf,
    piece: Piece,
}

/// Declarations (types, constants, module variables, imports, helper functions), each once, by
/// content.
#[derive(Debug, Default)]
pub struct DeclarationPool {
    declarations: Vec<SharedDeclaration>,
    /// The number of each declaration, by its content as words.
    numbers: FxHashMap<Box<[u32]>, u32>,
}

impl DeclarationPool {
    /// The number of a known declaration.
    fn number(&self, key: &[u32]) -> Option<u32> {
        self.numbers.get(key).copied()
    }

    /// The number of a declaration, new or known.
    fn intern(&mut self, key: &[u32], declaration: SharedDeclaration) -> Result<u32, String> {
        if let Some(number) = self.number(key) {
            return Ok(number);
        }
        let number = u32::try_from(self.declarations.len()).map_err(|_| "the pool is full")?;
        self.declarations.push(declaration);
        self.numbers.insert(key.into(), number);
        Ok(number)
    }
}

/// The pieces of one module that were wanted.
#[derive(Clone, Debug)]
pub struct SplitParts {
    /// The author's functions with their names, in the order of the module.
    pub functions: Vec<(String, Piece)>,
    /// The entry point.
    pub entry: Option<Piece>,
}

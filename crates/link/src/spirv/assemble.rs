//! Puts pieces together into a module.

use std::collections::BTreeSet;

use rustc_hash::FxHashMap;

use super::capabilities::{SHADER, required_extensions};
use super::{
    DEPTH, DeclarationPool, HEADER, Instructions, MEMORY_MODEL, Piece, Ref, SHELVES, Shelf,
};
use lamplight_emit::spirv::{first_word, op};

/// A piece that the new module has.
struct PieceNode<'n> {
    piece: &'n Piece,
    shelf: Shelf,
    /// Where the piece's references start in the list of links.
    links: usize,
    /// The id of the piece's first own id; the others follow.
    base: u32,
}

/// Stands for a function whose callees are still being visited. Meeting it again is a recursion.
const OPEN: u32 = u32::MAX;

/// Collects the pieces of a new module, each after what it needs.
struct PieceLinker<'n, 'a> {
    pool: &'n DeclarationPool,
    function: &'n dyn Fn(&str) -> Option<&'a Piece>,
    nodes: Vec<PieceNode<'n>>,
    /// The references of all nodes: first as numbers of nodes, then as ids.
    links: Vec<u32>,
    /// For each declaration of the pool, one more than its node; 0 for none.
    declarations: Vec<u32>,
    users: FxHashMap<&'n str, u32>,
}

impl<'n, 'a: 'n> PieceLinker<'n, 'a> {
    /// Adds a piece after everything that it needs. The order depends on the pieces alone.
    fn visit(&mut self, piece: &'n Piece, shelf: Shelf, depth: u32) -> Result<u32, String> {
        if depth == DEPTH {
            return Err("the calls are too deep".into());
        }
        let links = self.links.len();
        self.links.resize(links + piece.refs.len(), 0);
        for (at, outside) in (links..).zip(&piece.refs) {
            let node = match outside {
                Ref::Pool(number) => self.declaration(*number, depth + 1)?,
                Ref::User(name) => self.user(name, depth + 1)?,
            };
            if let Some(link) = self.links.get_mut(at) {
                *link = node;
            }
        }
        self.nodes.push(PieceNode { piece, shelf, links, base: 0 });
        Ok(self.nodes.len() as u32 - 1)
    }

    fn declaration(&mut self, number: u32, depth: u32) -> Result<u32, String> {
        let at = number as usize;
        if let Some(node) = self.declarations.get(at).and_then(|node| node.checked_sub(1)) {
            return Ok(node);
        }
        let pool = self.pool;
        let declaration = pool.declarations.get(at).ok_or("a piece is of another pool")?;
        let node = self.visit(&declaration.piece, declaration.shelf, depth)?;
        if let Some(known) = self.declarations.get_mut(at) {
            *known = node + 1;
        }
        Ok(node)
    }

    fn user(&mut self, name: &'n str, depth: u32) -> Result<u32, String> {
        match self.users.get(name) {
            Some(&OPEN) => return Err(format!("the function {name} is recursive")),
            Some(&node) => return Ok(node),
            None => {}
        }
        let piece =
            (self.function)(name).ok_or_else(|| format!("the function {name} is missing"))?;
        self.users.insert(name, OPEN);
        let node = self.visit(piece, Shelf::Function, depth)?;
        self.users.insert(name, node);
        Ok(node)
    }

    /// Numbers the ids in the order in which the shelves are written, and returns the bound.
    fn number(&mut self) -> u32 {
        let mut next = 1;
        for shelf in SHELVES {
            for node in self.nodes.iter_mut().filter(|node| node.shelf == shelf) {
                node.base = next;
                next += node.piece.ids;
            }
        }
        for link in &mut self.links {
            *link = self.nodes.get(*link as usize).map_or(0, |node| node.base);
        }
        next
    }

    /// Writes one section of all nodes on some shelves.
    fn write(&self, shelves: &[Shelf], text: fn(&Piece) -> &Instructions, out: &mut Vec<u32>) {
        for shelf in shelves {
            for node in self.nodes.iter().filter(|node| node.shelf == *shelf) {
                let links = self.links.get(node.links..).unwrap_or_default();
                text(node.piece).write(node.base, links, out);
            }
        }
    }

    /// The capabilities that all nodes together need.
    fn needs(&self) -> BTreeSet<u32> {
        let needs = self.nodes.iter().flat_map(|node| &node.piece.needs).copied();
        needs.chain([SHADER]).collect()
    }

    /// How many words all nodes together have.
    fn len(&self) -> usize {
        let texts = self
            .nodes
            .iter()
            .flat_map(|node| [&node.piece.names, &node.piece.notes, &node.piece.body]);
        texts.map(|text| text.words.len()).sum()
    }
}

/// Writes an extension as an instruction.
fn write_extension(name: &str, out: &mut Vec<u32>) {
    // The string ends with at least one zero byte; more fill its last word.
    let words = name.len() / 4 + 1;
    let mut bytes = name.as_bytes().to_vec();
    bytes.resize(words * 4, 0);
    out.push(first_word(op::EXTENSION, words + 1));
    out.extend(bytes.as_chunks().0.iter().map(|&word| u32::from_le_bytes(word)));
}

/// Puts an entry point and the functions that it reaches together.
pub fn assemble_module<'a>(
    pool: &DeclarationPool,
    entry: &'a Piece,
    function: &dyn Fn(&str) -> Option<&'a Piece>,
) -> Result<Vec<u32>, String> {
    if entry.entry.words.is_empty() {
        return Err("the piece is not an entry point".into());
    }
    let declarations = vec![0; pool.declarations.len()];
    let mut linker = PieceLinker {
        pool,
        function,
        nodes: vec![],
        links: vec![],
        declarations,
        users: FxHashMap::default(),
    };
    linker.visit(entry, Shelf::Function, 0)?;
    let bound = linker.number();
    let needs = linker.needs();
    let mut out =
        Vec::with_capacity(linker.len() + entry.entry.words.len() + entry.modes.words.len() + 64);
    out.extend(HEADER);
    out.extend([bound, 0]);
    out.extend(needs.iter().flat_map(|&need| [first_word(op::CAPABILITY, 2), need]));
    for name in required_extensions(&needs) {
        write_extension(name, &mut out);
    }
    linker.write(&[Shelf::Import], |piece| &piece.body, &mut out);
    out.extend(MEMORY_MODEL);
    if let Some(main) = linker.nodes.last() {
        let links = linker.links.get(main.links..).unwrap_or_default();
        entry.entry.write(main.base, links, &mut out);
        entry.modes.write(main.base, links, &mut out);
    }
    linker.write(&SHELVES, |piece| &piece.names, &mut out);
    linker.write(&SHELVES, |piece| &piece.notes, &mut out);
    linker.write(&[Shelf::Global, Shelf::Function], |piece| &piece.body, &mut out);
    Ok(out)
}

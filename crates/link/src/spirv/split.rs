//! Takes a module apart.

use std::collections::{BTreeSet, HashSet};
use std::ops::Range;

use super::module::{FunctionRole, Module, SpirvFunction, find_functions};
use super::operands::Inst;
use super::{
    DEPTH, DeclarationPool, Instructions, Piece, Ref, SharedDeclaration, Shelf, SplitParts,
};
use lamplight_emit::spirv::op;

/// Takes a module apart into pieces.
///
/// `is_user` says which named functions are the author's: calls to those are kept by name.
/// `is_wanted` says which of them become pieces. The entry point becomes one by its own name, which
/// a function may have too. Nothing that these do not need is looked at.
pub fn split_module(
    words: &[u32],
    pool: &mut DeclarationPool,
    is_user: &dyn Fn(&str) -> bool,
    is_wanted: &dyn Fn(&str) -> bool,
) -> Result<SplitParts, String> {
    let module = Module::read(words)?;
    let point = module.entry_point()?;
    let functions = find_functions(&module, is_user)?;
    module.check()?;
    let mut splitter = PieceSplitter::new(&module, pool, &functions);
    let mut parts = SplitParts { functions: vec![], entry: None };
    for function in &functions {
        match &function.role {
            FunctionRole::User(name) if is_wanted(name) => {
                let draft = splitter.draft(function.span.clone(), 0)?;
                parts.functions.push((name.clone(), draft.finish()));
            }
            FunctionRole::Entry if is_wanted(&point.string(3)?) => {
                let mut draft = splitter.draft(function.span.clone(), 0)?;
                splitter.enter(&mut draft, point)?;
                parts.entry = Some(draft.finish());
            }
            _ => {}
        }
    }
    Ok(parts)
}

/// What is known of an id.
#[derive(Clone, Copy, Default)]
struct IdUses {
    /// How often the piece that owns the id names it.
    uses: u32,
    /// Its index among the ids of that piece.
    own: Option<u32>,
    /// Its number in the pool.
    pool: Option<u32>,
    /// The last piece that refers to it, by the index of that piece's first instruction, and the
    /// index of the reference there.
    link: Option<(usize, u32)>,
}

/// What an id is for the piece that names it.
enum IdTarget {
    Local(u32),
    Link(u32),
}

/// A piece that is being made.
struct Draft {
    span: Range<usize>,
    depth: u32,
    /// The piece's own ids, in order of appearance.
    own: Vec<u32>,
    needs: BTreeSet<u32>,
    piece: Piece,
}

impl Draft {
    fn finish(self) -> Piece {
        Piece { needs: self.needs.into_iter().collect(), ids: self.own.len() as u32, ..self.piece }
    }
}

/// Makes the pieces of one module.
struct PieceSplitter<'m, 'a> {
    module: &'m Module<'a>,
    pool: &'m mut DeclarationPool,
    functions: &'m [SpirvFunction],
    ids: Vec<IdUses>,
    /// The numbers of the variables that are in the pool already.
    variables: HashSet<u32>,
}

impl<'m, 'a> PieceSplitter<'m, 'a> {
    fn new(
        module: &'m Module<'a>,
        pool: &'m mut DeclarationPool,
        functions: &'m [SpirvFunction],
    ) -> Self {
        Self {
            module,
            pool,
            functions,
            ids: vec![IdUses::default(); module.bound()],
            variables: HashSet::new(),
        }
    }

    fn id(&mut self, id: u32) -> Result<&mut IdUses, String> {
        self.ids.get_mut(id as usize).ok_or_else(|| format!("id {id} is out of bounds"))
    }

    /// Makes a piece from a range of instructions: a function, or a single declaration.
    fn draft(&mut self, span: Range<usize>, depth: u32) -> Result<Draft, String> {
        if depth == DEPTH {
            return Err("the declarations are too deep".into());
        }
        let module = self.module;
        let insts = module.insts.get(span.clone()).unwrap_or_default();
        self.count(insts)?;
        let mut draft =
            Draft { span, depth, own: vec![], needs: BTreeSet::new(), piece: Piece::default() };
        for inst in insts {
            if !self.is_idle(inst)? {
                self.add(&mut draft, |piece| &mut piece.body, inst)?;
            }
        }
        if draft.own.first().copied() != insts.first().and_then(Inst::result) {
            return Err("a piece does not start with its own id".into());
        }
        self.describe(&mut draft)?;
        Ok(draft)
    }

    /// Counts how often ids are named, leaving out loads and access chains that nothing uses.
    ///
    /// naga starts a function with such a load for each module variable that the function or its
    /// callees use. Loads for the callees alone would show which callees the module had.
    fn count(&mut self, insts: &[Inst]) -> Result<(), String> {
        for inst in insts {
            inst.ids(|_, id| self.id(id).map(|id| id.uses += 1))?;
        }
        // Backwards, since an access chain may be used by an idle load alone.
        for inst in insts.iter().rev().filter(|inst| matches!(inst.op, op::LOAD | op::ACCESS_CHAIN))
        {
            if inst.result().is_some_and(|id| self.id(id).is_ok_and(|id| id.uses == 1)) {
                inst.ids(|_, id| self.id(id).map(|id| id.uses = id.uses.saturating_sub(1)))?;
            }
        }
        Ok(())
    }

    /// Whether an instruction is a load or an access chain that nothing uses.
    fn is_idle(&mut self, inst: &Inst) -> Result<bool, String> {
        Ok(matches!(inst.op, op::LOAD | op::ACCESS_CHAIN) && self.id(inst.word(2)?)?.uses == 0)
    }

    /// Appends an instruction to one of the piece's texts.
    fn add(
        &mut self,
        draft: &mut Draft,
        text: fn(&mut Piece) -> &mut Instructions,
        inst: &Inst,
    ) -> Result<(), String> {
        self.module.require(inst, &mut draft.needs)?;
        let start = text(&mut draft.piece).words.len();
        text(&mut draft.piece).words.extend_from_slice(inst.words);
        inst.ids(|at, id| {
            let target = self.target(draft, id)?;
            let text = text(&mut draft.piece);
            let place = (start + at) as u32;
            // Every id is overwritten with a number that depends on the piece alone, even where
            // linking fills it in later: equal pieces must have equal words.
            let number = match target {
                IdTarget::Link(link) => {
                    text.links.push((place, link));
                    0
                }
                IdTarget::Local(_) if inst.op == op::FUNCTION_CALL && at == 3 => {
                    return Err("a function calls itself".into());
                }
                IdTarget::Local(number) => {
                    text.locals.push(place);
                    number
                }
            };
            if let Some(word) = text.words.get_mut(start + at) {
                *word = number;
            }
            Ok(())
        })
    }

    /// Finds out whether an id belongs to the piece, and numbers it when it first appears.
    fn target(&mut self, draft: &mut Draft, id: u32) -> Result<IdTarget, String> {
        let known = *self.id(id)?;
        if self.module.defined(id).is_some_and(|at| draft.span.contains(&at)) {
            let number = known.own.unwrap_or(draft.own.len() as u32);
            if known.own.is_none() {
                draft.own.push(id);
                self.id(id)?.own = Some(number);
            }
            return Ok(IdTarget::Local(number));
        }
        if let Some((_, link)) = known.link.filter(|link| link.0 == draft.span.start) {
            return Ok(IdTarget::Link(link));
        }
        let outside = self.outside(id, draft.span.start, draft.depth + 1)?;
        let at = draft.piece.refs.iter().position(|known| *known == outside);
        let link = at.unwrap_or(draft.piece.refs.len());
        if at.is_none() {
            draft.piece.refs.push(outside);
        }
        self.id(id)?.link = Some((draft.span.start, link as u32));
        Ok(IdTarget::Link(link as u32))
    }

    /// What an id stands for outside its module. The instruction `user`, which refers to it, must
    /// come later.
    fn outside(&mut self, id: u32, user: usize, depth: u32) -> Result<Ref, String> {
        let defined = self
            .module
            .defined(id)
            .filter(|&at| at < user)
            .ok_or_else(|| format!("id {id} is not known"))?;
        if let Some(number) = self.id(id)?.pool {
            return Ok(Ref::Pool(number));
        }
        let at = self.functions.partition_point(|function| function.span.end <= defined);
        let number = match self.functions.get(at) {
            Some(function) if function.span.start == defined => match &function.role {
                FunctionRole::Entry => return Err("the entry point is called".into()),
                FunctionRole::User(name) => return Ok(Ref::User(name.clone())),
                FunctionRole::Helper => self.helper(function.span.clone(), depth)?,
            },
            Some(function) if at == 0 && defined < function.span.start => {
                self.declaration(defined, depth)?
            }
            _ => return Err(format!("id {id} is not known here")),
        };
        self.id(id)?.pool = Some(number);
        Ok(Ref::Pool(number))
    }

    /// Adds a function that is not the author's to the pool.
    fn helper(&mut self, span: Range<usize>, depth: u32) -> Result<u32, String> {
        let piece = self.draft(span, depth)?.finish();
        let key = key_of_helper(&piece).ok_or("a helper calls a function of the author's")?;
        self.pool.intern(&key, SharedDeclaration { shelf: Shelf::Function, piece })
    }

    /// Adds a type, a constant, a variable or an import to the pool. A declaration that the pool
    /// has is not made into a piece again: most modules have the same ones.
    fn declaration(&mut self, at: usize, depth: u32) -> Result<u32, String> {
        let inst = self.module.insts.get(at).ok_or("a declaration is missing")?;
        if depth == DEPTH {
            return Err("the declarations are too deep".into());
        }
        if inst.op == op::VARIABLE {
            self.declare_twins(at, depth)?;
        }
        let mut key = self.key(at, inst, depth)?;
        loop {
            if let Some(number) = self.pool.number(&key) {
                if inst.op != op::VARIABLE || self.variables.insert(number) {
                    return Ok(number);
                }
                key.first_mut().into_iter().for_each(|ordinal| *ordinal += 1);
                continue;
            }
            let shelf = if inst.op == op::IMPORT { Shelf::Import } else { Shelf::Global };
            let piece = self.draft(at..at + 1, depth)?.finish();
            self.pool.intern(&key, SharedDeclaration { shelf, piece })?;
        }
    }

    /// The content of a declaration: its words, its names and its decorations, with the pool's
    /// numbers for ids and zero for its own. An ordinal comes first, which tells equal variables of
    /// one module apart.
    fn key(&mut self, user: usize, inst: &Inst, depth: u32) -> Result<Vec<u32>, String> {
        let module = self.module;
        let own = inst.result().ok_or("a declaration has no id")?;
        let mut key = vec![0];
        key.extend(inst.words);
        let mut result = Some(own);
        inst.ids(|at, id| {
            let own = result.take_if(|own| *own == id).map(|_| 0);
            let number = own.map_or_else(|| self.number(id, user, depth), Ok)?;
            key.get_mut(at + 1).into_iter().for_each(|word| *word = number);
            Ok(())
        })?;
        for inst in module.description(own) {
            key.extend(inst.words.first());
            key.push(0);
            key.extend(inst.words.get(2..).unwrap_or_default());
        }
        Ok(key)
    }

    /// The pool's number of what a declaration refers to.
    fn number(&mut self, id: u32, user: usize, depth: u32) -> Result<u32, String> {
        match self.outside(id, user, depth + 1)? {
            Ref::Pool(number) => Ok(number),
            Ref::User(name) => Err(format!("a declaration refers to the function {name}")),
        }
    }

    /// Adds to the pool the variables before this one that may equal it. So its ordinal does not
    /// depend on which pieces are wanted.
    fn declare_twins(&mut self, at: usize, depth: u32) -> Result<(), String> {
        let module = self.module;
        let Some((variable, before)) = module.insts.get(..=at).and_then(<[_]>::split_last) else {
            return Ok(());
        };
        for inst in before.iter().filter(|inst| inst.op == op::VARIABLE) {
            if let Some(id) = inst.result().filter(|_| are_alike(module, inst, variable)) {
                self.outside(id, at, depth + 1)?;
            }
        }
        Ok(())
    }

    /// Adds the names and decorations of the piece's own ids.
    fn describe(&mut self, draft: &mut Draft) -> Result<(), String> {
        let module = self.module;
        for id in draft.own.clone() {
            for inst in module.description(id) {
                match inst.op {
                    op::DECORATE | op::MEMBER_DECORATE => {
                        self.add(draft, |piece| &mut piece.notes, inst)?
                    }
                    _ => self.add(draft, |piece| &mut piece.names, inst)?,
                }
            }
        }
        Ok(())
    }

    /// Adds the entry point instruction and its execution modes, sorted.
    fn enter(&mut self, draft: &mut Draft, point: &Inst) -> Result<(), String> {
        self.add(draft, |piece| &mut piece.entry, point)?;
        let mut modes: Vec<&Inst> = self.module.of(op::EXECUTION_MODE).collect();
        modes.sort_by_key(|inst| inst.words);
        for inst in modes {
            if inst.word(1)? != point.word(2)? {
                return Err("an execution mode is not the entry point's".into());
            }
            self.add(draft, |piece| &mut piece.modes, inst)?;
        }
        Ok(())
    }
}

/// The content of a helper as words, after a word with which no declaration starts. `None` if it
/// calls one of the author's functions.
fn key_of_helper(piece: &Piece) -> Option<Vec<u32>> {
    let mut key = vec![u32::MAX];
    for text in [&piece.body, &piece.names, &piece.notes] {
        key.extend([&text.words, &text.locals].map(|list| list.len() as u32));
        key.push(text.links.len() as u32);
        key.extend(text.words.iter().chain(&text.locals));
        key.extend(text.links.iter().flat_map(|&(at, link)| [at, link]));
    }
    for outside in &piece.refs {
        match outside {
            Ref::Pool(number) => key.push(*number),
            Ref::User(_) => return None,
        }
    }
    Some(key)
}

/// Whether two variables may be equal: they have the same storage class, and all names and
/// decorations of one are among the other's.
fn are_alike(module: &Module, one: &Inst, other: &Inst) -> bool {
    let (Ok(id), Ok(twin)) = (one.word(2), other.word(2)) else { return false };
    let same =
        |one: &Inst, other: &Inst| one.op == other.op && one.words.get(2..) == other.words.get(2..);
    one.word(3) == other.word(3)
        && module.about(id).all(|inst| module.about(twin).any(|twin| same(inst, twin)))
}

//! Reads a module only as far as needed: its functions, and the layout of each instruction.

use std::collections::{BTreeSet, HashSet};
use std::ops::Range;

use super::capabilities::{self, SHADER, STORAGE_IMAGE_WRITE_WITHOUT_FORMAT, required_extensions};
use super::operands::Inst;
use super::operands::Section::{Body, Either, Global};
use super::{HEADER, MEMORY_MODEL};
use lamplight_emit::spirv::{HEADER_WORDS, op, split_first};

/// Vertex and fragment. The other stages have instructions of their own, which the table of
/// operands lacks.
const STAGES: [u32; 2] = [0, 4];

/// What the module says of an id.
#[derive(Clone, Copy, Default)]
struct IdInfo {
    /// The instruction that defines it.
    defined: Option<usize>,
    /// Its last name or decoration, as an index into [`Module::about`].
    about: Option<usize>,
}

/// A module as it is read. Instructions are referred to by their index.
pub struct Module<'a> {
    pub insts: Vec<Inst<'a>>,
    ids: Vec<IdInfo>,
    /// Names and decorations, each with the index of the one before it for the same id.
    about: Vec<(usize, Option<usize>)>,
}

impl<'a> Module<'a> {
    /// Reads all instructions, and checks that each id is defined once.
    pub fn read(words: &'a [u32]) -> Result<Self, String> {
        let (header, mut rest) =
            words.split_at_checked(HEADER_WORDS).ok_or("the header is cut off")?;
        if !header.starts_with(&HEADER) || header.last() != Some(&0) {
            return Err("the header is not of a known kind".into());
        }
        // The bound is checked, since a malformed one could make the list of ids very long.
        let bound = header
            .get(3)
            .map(|&bound| bound as usize)
            .filter(|&bound| bound <= words.len() * 4 + 1024);
        let ids = vec![IdInfo::default(); bound.ok_or("the bound is too high")?];
        let mut module = Self { insts: Vec::with_capacity(words.len() / 3), ids, about: vec![] };
        while let Some((instruction, after)) = split_first(rest)? {
            module.push(Inst::new(instruction)?)?;
            rest = after;
        }
        Ok(module)
    }

    fn push(&mut self, inst: Inst<'a>) -> Result<(), String> {
        let at = self.insts.len();
        if let Some(id) = inst.result()
            && self.id(id)?.defined.replace(at).is_some()
        {
            return Err(format!("id {id} is defined twice"));
        }
        if let op::NAME | op::MEMBER_NAME | op::DECORATE | op::MEMBER_DECORATE = inst.op {
            let last = self.about.len();
            let earlier = self.id(inst.word(1)?)?.about.replace(last);
            self.about.push((at, earlier));
        }
        self.insts.push(inst);
        Ok(())
    }

    fn id(&mut self, id: u32) -> Result<&mut IdInfo, String> {
        self.ids.get_mut(id as usize).ok_or_else(|| format!("id {id} is out of bounds"))
    }

    /// One more than the highest id.
    pub fn bound(&self) -> usize {
        self.ids.len()
    }

    /// The number of the instruction that defines an id.
    pub fn defined(&self, id: u32) -> Option<usize> {
        self.ids.get(id as usize)?.defined
    }

    /// The names and decorations of an id, the last one first.
    pub fn about(&self, id: u32) -> impl Iterator<Item = &Inst<'a>> {
        let mut next = self.ids.get(id as usize).and_then(|id| id.about);
        std::iter::from_fn(move || {
            let &(at, earlier) = self.about.get(next?)?;
            next = earlier;
            self.insts.get(at)
        })
    }

    /// The names and decorations of an id that belongs to a piece: sorted, each once.
    ///
    /// Constants and most types lose their names. naga gives `0u` the name of any constant of the
    /// module that has this value, so the name would depend on the module that the piece came from.
    pub fn description(&self, id: u32) -> Vec<&Inst<'a>> {
        let defined = self.defined(id).and_then(|at| self.insts.get(at));
        let nameless =
            defined.is_some_and(|inst| inst.section == Global && inst.op != op::TYPE_STRUCT);
        let is_described =
            |inst: &&Inst| !nameless || matches!(inst.op, op::DECORATE | op::MEMBER_DECORATE);
        let mut about: Vec<&Inst> = self.about(id).filter(is_described).collect();
        about.sort_by_key(|inst| (inst.words.get(1..), inst.op));
        about.dedup_by_key(|inst| inst.words);
        about
    }

    /// The name of an id, if it has one.
    pub fn name(&self, id: u32) -> Result<Option<String>, String> {
        self.about(id)
            .filter(|inst| inst.op == op::NAME)
            .last()
            .map(|inst| inst.string(2))
            .transpose()
    }

    /// All instructions of an opcode.
    pub fn of(&self, op: u16) -> impl Iterator<Item = &Inst<'a>> {
        self.insts.iter().filter(move |inst| inst.op == op)
    }

    /// The only entry point. Its stage and the memory model must be known ones.
    pub fn entry_point(&self) -> Result<&Inst<'a>, String> {
        let mut points = self.of(op::ENTRY_POINT);
        let (Some(point), None) = (points.next(), points.next()) else {
            return Err("there must be one entry point".into());
        };
        if !STAGES.contains(&point.word(1)?) {
            return Err("the stage is not known".into());
        }
        if !self.of(op::MEMORY_MODEL).map(|inst| inst.words).eq([&MEMORY_MODEL]) {
            return Err("the memory model is not known".into());
        }
        Ok(point)
    }

    /// The functions, as ranges of instructions. Each instruction must stand in its section.
    fn spans(&self) -> Result<Vec<Range<usize>>, String> {
        let mut functions = vec![];
        let mut start = None;
        for (at, inst) in self.insts.iter().enumerate() {
            match (inst.op, start) {
                (op::FUNCTION, None) => start = Some(at),
                (op::FUNCTION_END, Some(first)) => {
                    functions.push(first..at + 1);
                    start = None;
                }
                (op::FUNCTION, Some(_)) => return Err("a function has no end".into()),
                (op, _) if inst.section != Either && start.is_some() != (inst.section == Body) => {
                    return Err(format!("opcode {op} is out of place"));
                }
                _ => {}
            }
        }
        if start.is_some() { Err("a function has no end".into()) } else { Ok(functions) }
    }

    /// Adds the capabilities that an instruction needs to `needs`.
    pub fn require(&self, inst: &Inst, needs: &mut BTreeSet<u32>) -> Result<(), String> {
        if inst.op == op::IMAGE_WRITE && self.lacks_format(inst.word(1)?) {
            needs.insert(STORAGE_IMAGE_WRITE_WITHOUT_FORMAT);
        }
        capabilities::require_capabilities(inst, needs)
    }

    /// Whether the type of an image has no format.
    fn lacks_format(&self, image: u32) -> bool {
        let definition = |id| self.insts.get(self.defined(id)?);
        let kind = definition(image).and_then(|inst| definition(inst.word(1).ok()?));
        kind.is_some_and(|inst| inst.op == op::TYPE_IMAGE && inst.word(8) == Ok(0))
    }

    /// The capabilities and extensions that were derived must be those that the module declares. If
    /// they are not, the tables lack some.
    pub fn check(&self) -> Result<(), String> {
        let mut needs = BTreeSet::from([SHADER]);
        self.insts.iter().try_for_each(|inst| self.require(inst, &mut needs))?;
        let declared: BTreeSet<u32> =
            self.of(op::CAPABILITY).filter_map(|inst| inst.word(1).ok()).collect();
        if declared != needs {
            return Err(format!("the capabilities are {declared:?}, not {needs:?}"));
        }
        let declared = self
            .of(op::EXTENSION)
            .map(|inst| inst.string(1))
            .collect::<Result<BTreeSet<_>, _>>()?;
        if !declared.iter().map(String::as_str).eq(required_extensions(&needs)) {
            return Err(format!("the extensions {declared:?} are not those of {needs:?}"));
        }
        Ok(())
    }
}

/// What a function is.
pub enum FunctionRole {
    Entry,
    User(String),
    Helper,
}

pub struct SpirvFunction {
    pub span: Range<usize>,
    pub role: FunctionRole,
}

/// The functions, in the order of the module. One of them is the entry point's.
pub fn find_functions(
    module: &Module,
    is_user: &dyn Fn(&str) -> bool,
) -> Result<Vec<SpirvFunction>, String> {
    let entry = module.entry_point()?.word(2)?;
    let (mut functions, mut entries, mut taken) = (vec![], 0, HashSet::new());
    for span in module.spans()? {
        let id =
            module.insts.get(span.start).and_then(Inst::result).ok_or("a function has no id")?;
        let role = if id == entry {
            entries += 1;
            FunctionRole::Entry
        } else if let Some(name) = module.name(id)?.filter(|name| is_user(name)) {
            if !taken.insert(name.clone()) {
                return Err(format!("there are two functions {name}"));
            }
            FunctionRole::User(name)
        } else {
            FunctionRole::Helper
        };
        functions.push(SpirvFunction { span, role });
    }
    if entries == 1 { Ok(functions) } else { Err("the entry point has no function".into()) }
}

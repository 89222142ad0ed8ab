//! A lowered module.

use super::code::{Access, Instruction, JumpTable, Slot};
use super::error::Error;
use super::layout::SlotKind;
use super::lower;
use super::names::Variable;
use super::number::Number;
use naga::{Handle, Span, Type, UniqueArena};
use std::ops::Range;

/// A module ready to run on any [`super::Number`]. It borrows nothing and may be shared between
/// threads; each thread has its own [`super::Machine`].
#[derive(Debug)]
pub struct Program {
    pub(super) code: Vec<Instruction>,
    /// Place of each instruction in the text naga parsed.
    pub(super) spans: Vec<Span>,
    /// How many slots the memory has before buffers of runtime size are added.
    pub(super) slots: u32,
    pub(super) pool: Vec<(Slot, InitialValue)>,
    /// Where the instructions begin that compute constants and overrides, once per machine.
    pub(super) start: u32,
    pub(super) functions: Vec<Function>,
    pub(super) tables: Vec<JumpTable>,
    pub(super) images: Vec<Access>,
    pub(super) points: Vec<CoveragePoint>,
    pub(super) globals: Vec<Global>,
    pub(super) types: UniqueArena<Type>,
    /// What authors named, if the program was lowered with names.
    pub(super) variables: Vec<Variable>,
}

/// Index of a function of a [`Program`]: functions first, entry points after them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FunctionId(pub(super) u32);

impl FunctionId {
    /// Its place among the functions of [`Program::functions`].
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl From<Handle<naga::Function>> for FunctionId {
    /// The function of that handle in the module the program was lowered from.
    fn from(handle: Handle<naga::Function>) -> Self {
        Self(handle.index() as u32)
    }
}

/// What a caller needs to know of a function.
#[derive(Debug, Clone)]
pub struct Function {
    /// As in the module.
    pub name: String,
    /// Kinds of the flattened arguments; for a pointer, those of the type it points to.
    pub arguments: Vec<SlotKind>,
    /// Kinds of the flattened result, then of the values behind pointers after the call.
    pub result: Vec<SlotKind>,
    /// For entry points, the built-in or location of each argument slot.
    pub inputs: Vec<Option<naga::Binding>>,
    /// The same for each slot of the result.
    pub outputs: Vec<Option<naga::Binding>>,
    /// The size of a compute entry point's workgroups.
    pub workgroup: Option<[u32; 3]>,
    /// Slots of the returned value alone.
    pub(super) returned: u32,
    pub(super) parameters: Vec<ParameterSlots>,
    pub(super) result_slot: Slot,
    pub(super) entry: u32,
    /// Buffers the function or its callees read, by index.
    pub(super) buffers: Vec<u32>,
    /// Why the function cannot be run, if it cannot.
    pub error: Option<Error>,
}

/// The slots of a parameter. For a pointer, `pointee` is the first slot of the value that it points
/// to.
#[derive(Debug, Clone, Copy)]
pub(super) struct ParameterSlots {
    pub slot: Slot,
    /// How many slots the caller gives: those of the value, or of what the pointer points to.
    pub n: u32,
    pub pointee: Option<Slot>,
}

/// A block of statements that coverage counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoveragePoint {
    /// The function that it is in.
    pub function: FunctionId,
    /// Which block of the statement it is.
    pub branch: Branch,
    /// All statements that run if the block is reached.
    pub span: Span,
}

/// How a block is reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Branch {
    /// The body of the function.
    Entry,
    /// The branch of an `if` whose condition holds.
    Accept,
    /// The other branch of an `if`.
    Reject,
    /// A case of a `switch`.
    Case,
    /// The body of a loop.
    Body,
    /// The `continuing` block of a loop.
    Continuing,
    /// The statements after a branch that may have left the function or the loop.
    After,
}

/// The value of a slot before anything runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum InitialValue {
    Word(u32),
    Float(f64),
}

/// A module-scope variable.
#[derive(Debug, Clone)]
pub(super) struct Global {
    pub name: String,
    /// Group and binding.
    pub binding: Option<(u32, u32)>,
    pub ty: Handle<Type>,
    pub slot: Slot,
    pub slots: u32,
    /// The least size of a buffer for it.
    pub bytes: u32,
    pub role: GlobalRole,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum GlobalRole {
    /// Initialised at each call, from the slot or with zero.
    Private(Option<Slot>),
    /// Zero when a workgroup begins, and shared by its invocations.
    Workgroup,
    Buffer,
    /// A buffer that ends in a runtime-sized array. It is appended to the memory when it is bound.
    /// `address` and `count` are the slots of its address and the array's length, `element` is how
    /// many slots an element has.
    Runtime {
        address: Slot,
        count: Slot,
        element: u32,
    },
    Image,
    Sampler,
}

impl Program {
    /// Lowers a validated module. A function that uses something unsupported keeps the error; the
    /// others can be run.
    ///
    /// # Errors
    /// `eval-too-large` if the module-scope values take too much memory.
    pub fn new(module: &naga::Module, info: &naga::valid::ModuleInfo) -> Result<Self, Error> {
        lower::lower(module, info, false)
    }

    /// As [`Self::new`], with [`Self::variables`].
    ///
    /// # Errors
    /// Those of [`Self::new`].
    pub fn with_names(
        module: &naga::Module,
        info: &naga::valid::ModuleInfo,
    ) -> Result<Self, Error> {
        lower::lower(module, info, true)
    }

    /// What the text names, in the order of functions and, within each, of declaration.
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// The place of each instruction in the text that naga parsed.
    pub fn spans(&self) -> &[Span] {
        &self.spans
    }

    /// For each instruction, whether a statement of the text can begin with it. Jumps and the like
    /// have the place of what is around them, and variables get their initial values before the first
    /// statement of a function.
    pub fn beginnings(&self) -> Vec<bool> {
        let mut entries: Vec<u32> = self.functions.iter().map(|function| function.entry).collect();
        entries.sort_unstable();
        let mut has_begun = false;
        let begins = |(pc, instruction): (usize, &Instruction)| {
            has_begun &= entries.binary_search(&(pc as u32)).is_err();
            has_begun |= matches!(instruction, Instruction::Mark { .. });
            let is_passed = matches!(
                instruction,
                Instruction::Jump { .. }
                    | Instruction::Mark { .. }
                    | Instruction::Return
                    | Instruction::Trip
            );
            has_begun && !is_passed
        };
        self.code.iter().enumerate().map(begins).collect()
    }

    /// The instruction that runs once the declaration of a variable of a function is reached: the first
    /// one of a statement there or behind it in the text. `None` if the text has no place for it.
    pub fn reached_by(&self, variable: &Variable) -> Option<u32> {
        let (function, start) = (variable.function?, variable.span.to_range()?.start);
        let first = self.signature(function)?.entry;
        let is_own = |pc: &u32| self.function_around(*pc) == Some(function);
        let is_behind = |pc: &u32| {
            let span = self.spans.get(*pc as usize).and_then(|span| span.to_range());
            span.is_some_and(|span| span.start >= start)
        };
        let begins = self.beginnings();
        let begins = |pc: &u32| begins.get(*pc as usize).is_some_and(|begins| *begins);
        let own = (first..self.code.len() as u32).take_while(is_own);
        { own }.find(|pc| begins(pc) && is_behind(pc))
    }

    /// The function whose instructions begin at this one.
    pub(super) fn function_at(&self, entry: u32) -> Option<FunctionId> {
        // One that could not be lowered has no instructions, so it shares its first with the next.
        let after = self.functions.partition_point(|function| function.entry <= entry);
        after.checked_sub(1).map(|index| FunctionId(index as u32))
    }

    /// The instruction without a place in the text that copies a value to a slot.
    pub fn copy_to(&self, slot: u32) -> Option<u32> {
        let copies = |(instruction, span): (&Instruction, &Span)| {
            let to = match instruction {
                Instruction::Copy { to, .. } | Instruction::Load { to, .. } => *to,
                _ => return false,
            };
            to == slot && !span.is_defined()
        };
        let found = self.code.iter().zip(&self.spans).position(copies);
        found.map(|pc| pc as u32)
    }

    /// The function that has an instruction.
    pub fn function_around(&self, pc: u32) -> Option<FunctionId> {
        self.function_at(pc)
    }

    /// The function or entry point of that name.
    pub fn function(&self, name: &str) -> Option<FunctionId> {
        self.functions
            .iter()
            .position(|function| function.name == name)
            .map(|index| FunctionId(index as u32))
    }

    /// The word that stands for a texture or sampler where a function takes one as argument.
    pub fn handle(&self, group: u32, binding: u32) -> Option<u32> {
        self.globals
            .iter()
            .position(|global| global.binding == Some((group, binding)))
            .map(|index| index as u32)
    }

    /// Every function and entry point.
    pub fn functions(&self) -> impl Iterator<Item = (FunctionId, &Function)> {
        self.functions
            .iter()
            .enumerate()
            .map(|(index, function)| (FunctionId(index as u32), function))
    }

    /// The slots of the variables that a call begins with, and those of their initial values. `None`
    /// if the initial value is zero. A function that runs alone is a workgroup of its own; others
    /// keep what their workgroup shares.
    pub(super) fn initial_values(
        &self,
        is_alone: bool,
    ) -> impl Iterator<Item = (std::ops::Range<usize>, Option<std::ops::Range<usize>>)> {
        let range = |slot: u32, n: u32| slot as usize..(slot + n) as usize;
        self.globals.iter().filter_map(move |global| match global.role {
            GlobalRole::Private(from) => {
                Some((range(global.slot, global.slots), from.map(|from| range(from, global.slots))))
            }
            GlobalRole::Workgroup if is_alone => Some((range(global.slot, global.slots), None)),
            _ => None,
        })
    }

    /// The slots of each variable of the module that a run can change, by its name. Those of a buffer
    /// of runtime size are where the memory says.
    pub(super) fn module_slots<'p, N: Number>(
        &'p self,
        memory: &[N],
    ) -> Vec<(&'p str, Range<usize>)> {
        let word = |slot: u32| memory.get(slot as usize).map_or(0, |slot| slot.word()) as usize;
        let slots = |global: &Global| match global.role {
            GlobalRole::Private(_) | GlobalRole::Workgroup | GlobalRole::Buffer => {
                let first = global.slot as usize;
                Some(first..first + global.slots as usize)
            }
            GlobalRole::Runtime { address, count, element } => {
                let (first, element) = (word(address), element as usize);
                let fixed = (global.slots as usize).saturating_sub(element);
                Some(first..first + fixed + word(count) * element)
            }
            GlobalRole::Image | GlobalRole::Sampler => None,
        };
        let named = |global: &'p Global| Some((global.name.as_str(), slots(global)?));
        self.globals.iter().filter_map(named).collect()
    }

    /// The slots of the variables that the invocations of a workgroup share.
    pub(super) fn workgroup_slots(&self) -> impl Iterator<Item = std::ops::Range<usize>> {
        let is_shared = |global: &&Global| global.role == GlobalRole::Workgroup;
        let range = |global: &Global| global.slot as usize..(global.slot + global.slots) as usize;
        self.globals.iter().filter(is_shared).map(range)
    }

    pub(super) fn instruction(&self, pc: u32) -> Option<&Instruction> {
        self.code.get(pc as usize)
    }

    /// An access to a texture, by its index.
    pub(super) fn access(&self, index: u32) -> Option<&Access> {
        self.images.get(index as usize)
    }

    /// What the caller must know of a function.
    pub fn signature(&self, id: FunctionId) -> Option<&Function> {
        self.functions.get(id.0 as usize)
    }

    /// The blocks that coverage counts, in the order of `Machine::hits`.
    pub fn points(&self) -> &[CoveragePoint] {
        &self.points
    }
}

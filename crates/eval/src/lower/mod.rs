//! Lowers naga's module to a program, once per module.
//!
//! A [`Body`] is what the lowering of all expressions and statements of a function shares.

mod atomic;
mod expression;
mod named;
mod operator;
mod statement;

use crate::code::{Instruction, Operand, Slot, Word2};
use crate::error::Error;
use crate::layout::{Layout, MAX_SLOTS, SlotKind};
use crate::program::{Function, Global, GlobalRole, InitialValue, ParameterSlots, Program};
use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{AddressSpace, Arena, ArraySize, Expression, Handle, Module, Span, Type, TypeInner};
use std::collections::BTreeMap;

/// The group and binding of immediates, as in outputs that have a buffer in their place.
const IMMEDIATES: (u32, u32) = (4, 0);

/// Where an expression's value is.
#[derive(Debug, Clone, Copy)]
enum Loc {
    /// In slots. If `constant`, functions never write to them.
    Value { operand: Operand, constant: bool },
    /// A pointer to a slot that is known when the program is lowered.
    Place(Slot),
    /// A pointer whose address is the value of a slot plus an offset.
    Through { slot: Slot, offset: u32 },
}

/// The program that is being built.
struct ProgramBuilder<'m> {
    module: &'m Module,
    layout: Layout<'m>,
    program: Program,
    /// Instructions that compute constants.
    start: Vec<Instruction>,
    literals: BTreeMap<(u8, u64), Slot>,
    globals: Vec<Result<Loc, Error>>,
    constants: Vec<Option<Loc>>,
    /// Whether the program gets the names of the text.
    has_names: bool,
}

/// The function, or the module-scope constants, that are being lowered.
struct LoweredBody<'b, 'm> {
    build: &'b mut ProgramBuilder<'m>,
    expressions: &'m Arena<Expression>,
    types: Vec<&'m TypeInner>,
    locs: Vec<Option<Loc>>,
    /// First slot of each local variable.
    locals: Vec<Slot>,
    arguments: Vec<Slot>,
    function: u32,
    span: Span,
    /// Whether instructions go to the part that computes constants.
    constant: bool,
    breaks: Vec<Vec<usize>>,
    continues: Vec<Vec<usize>>,
    depth: u32,
    point: Option<u32>,
}

/// Lowers every function of the module.
pub(super) fn lower(module: &Module, info: &ModuleInfo, has_names: bool) -> Result<Program, Error> {
    let mut build = ProgramBuilder::new(module);
    build.has_names = has_names;
    build.constants(info)?;
    build.globals();
    if has_names {
        build.name_globals();
    }
    for (handle, function) in module.functions.iter() {
        build.function(function.name.clone().unwrap_or_default(), function, &info[handle]);
    }
    for (index, entry) in module.entry_points.iter().enumerate() {
        build.function(entry.name.clone(), &entry.function, info.get_entry_point(index));
        build.workgroup(entry);
    }
    build.finish()
}

impl<'m> ProgramBuilder<'m> {
    fn new(module: &'m Module) -> Self {
        let program = Program {
            code: Vec::new(),
            spans: Vec::new(),
            slots: 0,
            pool: Vec::new(),
            start: 0,
            functions: Vec::new(),
            tables: Vec::new(),
            images: Vec::new(),
            points: Vec::new(),
            globals: Vec::new(),
            types: module.types.clone(),
            variables: Vec::new(),
        };
        let layout = Layout::new(&module.types);
        Self {
            module,
            layout,
            program,
            start: Vec::new(),
            literals: BTreeMap::new(),
            globals: Vec::new(),
            constants: Vec::new(),
            has_names: false,
        }
    }

    /// Allocates new slots, which are zero before anything runs.
    fn alloc(&mut self, slots: u32) -> Result<Slot, Error> {
        let first = self.program.slots;
        match first.checked_add(slots) {
            Some(end) if end <= MAX_SLOTS => {
                self.program.slots = end;
                Ok(first)
            }
            _ => Err(Error::too_large(format!(
                "the values of the module take more than {MAX_SLOTS} scalars"
            ))),
        }
    }

    /// The slot of a constant. Constants with the same bits share one.
    fn literal(&mut self, value: InitialValue) -> Result<Slot, Error> {
        let key = match value {
            InitialValue::Word(word) => (0, u64::from(word)),
            InitialValue::Float(float) => (1, float.to_bits()),
        };
        if let Some(slot) = self.literals.get(&key) {
            return Ok(*slot);
        }
        let slot = self.alloc(1)?;
        self.program.pool.push((slot, value));
        self.literals.insert(key, slot);
        Ok(slot)
    }

    fn word(&mut self, word: u32) -> Result<Slot, Error> {
        self.literal(InitialValue::Word(word))
    }

    /// Lowers module-scope constants and overrides to instructions that run once per machine. One
    /// that is not supported is left out, and is an error where it is used.
    fn constants(&mut self, info: &'m ModuleInfo) -> Result<(), Error> {
        let expressions = &self.module.global_expressions;
        let types = expressions
            .iter()
            .map(|(handle, _)| info[handle].inner_with(&self.module.types))
            .collect();
        let mut body = LoweredBody::new(self, expressions, types);
        body.constant = true;
        for (handle, _) in expressions.iter() {
            match body.evaluate(handle) {
                Err(error) if error.code == lamplight_diagnostic::codes::EVAL_TOO_LARGE => {
                    return Err(error);
                }
                _ => {}
            }
        }
        self.constants = body.locs;
        Ok(())
    }

    fn globals(&mut self) {
        for (_, variable) in self.module.global_variables.iter() {
            let loc = self.global(variable).map_err(|error| error.or_at(Span::UNDEFINED));
            self.globals.push(loc);
        }
    }

    fn global(&mut self, variable: &naga::GlobalVariable) -> Result<Loc, Error> {
        let slots = self.layout.size(variable.ty)?;
        let index = self.program.globals.len() as u32;
        let inner = &self.module.types[variable.ty].inner;
        let (role, loc) = match (variable.space, inner) {
            (AddressSpace::Private, _) => self.private(variable, slots)?,
            (AddressSpace::WorkGroup, _) => (GlobalRole::Workgroup, Loc::Place(self.alloc(slots)?)),
            (AddressSpace::Handle, TypeInner::Sampler { .. }) => {
                (GlobalRole::Sampler, Loc::dense(self.word(index)?, true))
            }
            (AddressSpace::Handle, _) => (GlobalRole::Image, Loc::dense(self.word(index)?, true)),
            (AddressSpace::Uniform | AddressSpace::Storage { .. } | AddressSpace::Immediate, _) => {
                self.buffer(inner, slots)?
            }
            (space, _) => {
                return Err(Error::unsupported(format!(
                    "variables in the address space `{space:?}`"
                )));
            }
        };
        let slot = if let Loc::Place(slot) = loc { slot } else { 0 };
        // Immediates are bound where they are a buffer in other languages.
        let binding = match variable.space {
            AddressSpace::Immediate => Some(IMMEDIATES),
            _ => variable.binding.map(|binding| (binding.group, binding.binding)),
        };
        let bytes = inner.try_size(self.module.to_ctx()).unwrap_or(0);
        self.program.globals.push(Global {
            name: variable.name.clone().unwrap_or_default(),
            binding,
            ty: variable.ty,
            slot,
            slots,
            bytes,
            role,
        });
        Ok(loc)
    }

    fn private(
        &mut self,
        variable: &naga::GlobalVariable,
        slots: u32,
    ) -> Result<(GlobalRole, Loc), Error> {
        let init =
            match variable.init.map(|init| self.constants.get(init.index()).copied().flatten()) {
                Some(Some(Loc::Value { operand, .. })) if operand.stride == 1 || slots == 1 => {
                    Some(operand.slot)
                }
                Some(_) => return Err(Error::unsupported("this initial value of a variable")),
                None => None,
            };
        Ok((GlobalRole::Private(init), Loc::Place(self.alloc(slots)?)))
    }

    fn buffer(&mut self, inner: &TypeInner, slots: u32) -> Result<(GlobalRole, Loc), Error> {
        let last = match *inner {
            TypeInner::Struct { ref members, .. } => {
                members.last().map_or(inner, |member| &self.module.types[member.ty].inner)
            }
            _ => inner,
        };
        let TypeInner::Array { base, size: ArraySize::Dynamic, .. } = *last else {
            return Ok((GlobalRole::Buffer, Loc::Place(self.alloc(slots)?)));
        };
        let (address, count, element) = (self.alloc(1)?, self.alloc(1)?, self.layout.size(base)?);
        Ok((
            GlobalRole::Runtime { address, count, element },
            Loc::Through { slot: address, offset: 0 },
        ))
    }

    /// Lowers a function. An error is kept with the function.
    fn function(&mut self, name: String, function: &'m naga::Function, info: &'m FunctionInfo) {
        let entry = Function {
            name,
            arguments: Vec::new(),
            result: Vec::new(),
            inputs: Vec::new(),
            outputs: Vec::new(),
            workgroup: None,
            returned: 0,
            parameters: Vec::new(),
            result_slot: 0,
            entry: self.program.code.len() as u32,
            buffers: Vec::new(),
            error: None,
        };
        let (code, points) = (self.program.code.len(), self.program.points.len());
        self.program.functions.push(entry);
        if let Err(error) = self.lower_function(function, info) {
            self.program.code.truncate(code);
            self.program.spans.truncate(code);
            self.program.points.truncate(points);
            if let Some(entry) = self.program.functions.last_mut() {
                entry.error = Some(error);
            }
        }
    }

    /// Notes the size of the workgroups of the entry point that was lowered last.
    fn workgroup(&mut self, entry: &naga::EntryPoint) {
        if let Some(function) = self.program.functions.last_mut() {
            let is_compute = entry.stage == naga::ShaderStage::Compute;
            function.workgroup = is_compute.then_some(entry.workgroup_size);
        }
    }

    fn lower_function(
        &mut self,
        function: &'m naga::Function,
        info: &'m FunctionInfo,
    ) -> Result<(), Error> {
        let (mut arguments, mut result) = (Vec::new(), Vec::new());
        if let Some(returned) = &function.result {
            self.layout.kinds(returned.ty, &mut result)?;
        }
        let returned = result.len() as u32;
        let (mut inputs, mut outputs) = (Vec::new(), Vec::new());
        if let Some(returned) = &function.result {
            self.layout.bindings(returned.ty, &returned.binding, &mut outputs)?;
        }
        let mut parameters = Vec::new();
        for argument in &function.arguments {
            let (parameter, kinds) = self.parameter(argument, result.len(), &mut inputs)?;
            result.extend(kinds.iter().filter(|_| parameter.pointee.is_some()));
            parameters.push(parameter);
            arguments.extend(kinds);
        }
        let result_slot = self.alloc(result.len() as u32)?;
        parameters.iter_mut().for_each(|parameter| {
            parameter.pointee = parameter.pointee.map(|behind| result_slot + behind)
        });
        let slots = parameters.iter().map(|parameter| parameter.slot).collect();
        let buffers = self.buffers(info);
        let index = self.program.functions.len() - 1;
        let entry = &mut self.program.functions[index];
        *entry = Function {
            arguments,
            result,
            inputs,
            outputs,
            returned,
            parameters,
            result_slot,
            buffers,
            ..entry.clone()
        };
        let types = function
            .expressions
            .iter()
            .map(|(handle, _)| info[handle].ty.inner_with(&self.module.types))
            .collect();
        let mut body = LoweredBody::new(self, &function.expressions, types);
        (body.function, body.arguments) = (index as u32, slots);
        body.whole(function).map(|()| body.name_variables(function))
    }

    /// A parameter with the kinds of its scalars. The value that a pointer points to is also part
    /// of the function's result, after the first `results` scalars: the caller gets it from there.
    fn parameter(
        &mut self,
        argument: &naga::FunctionArgument,
        results: usize,
        inputs: &mut Vec<Option<naga::Binding>>,
    ) -> Result<(ParameterSlots, Vec<SlotKind>), Error> {
        let pointee = pointed_type(&self.module.types[argument.ty].inner);
        let mut kinds = Vec::new();
        self.layout.kinds(pointee.unwrap_or(argument.ty), &mut kinds)?;
        let (slots, n) = (self.layout.size(argument.ty)?, kinds.len() as u32);
        self.layout.bindings(pointee.unwrap_or(argument.ty), &argument.binding, inputs)?;
        let pointee = pointee.map(|_| results as u32);
        Ok((ParameterSlots { slot: self.alloc(slots)?, n, pointee }, kinds))
    }

    /// The buffers that a function and its callees use, by index.
    fn buffers(&self, info: &FunctionInfo) -> Vec<u32> {
        let used =
            self.module.global_variables.iter().filter(|(handle, _)| !info[*handle].is_empty());
        let bindings: Vec<_> = used
            .filter_map(|(_, variable)| {
                variable.binding.map(|binding| (binding.group, binding.binding))
            })
            .collect();
        let globals = self.program.globals.iter().enumerate();
        let wanted = globals.filter(|(_, global)| {
            global.binding.is_some_and(|binding| bindings.contains(&binding))
        });
        wanted
            .filter(|(_, global)| {
                matches!(global.role, GlobalRole::Buffer | GlobalRole::Runtime { .. })
            })
            .map(|(index, _)| index as u32)
            .collect()
    }

    fn finish(mut self) -> Result<Program, Error> {
        let start = self.program.code.len() as u32;
        self.program.start = start;
        self.program.code.append(&mut self.start);
        self.program.code.push(Instruction::Return);
        self.program.spans.resize(self.program.code.len(), Span::UNDEFINED);
        Ok(self.program)
    }
}

/// What a pointer parameter points to.
fn pointed_type(inner: &TypeInner) -> Option<Handle<Type>> {
    match *inner {
        TypeInner::Pointer { base, .. } => Some(base),
        _ => None,
    }
}

impl Loc {
    fn dense(slot: Slot, constant: bool) -> Self {
        Self::Value { operand: Operand { slot, stride: 1 }, constant }
    }
}

impl<'b, 'm> LoweredBody<'b, 'm> {
    pub(super) fn new(
        build: &'b mut ProgramBuilder<'m>,
        expressions: &'m Arena<Expression>,
        types: Vec<&'m TypeInner>,
    ) -> Self {
        let locs = vec![None; expressions.len()];
        Self {
            build,
            expressions,
            types,
            locs,
            locals: Vec::new(),
            arguments: Vec::new(),
            function: 0,
            span: Span::UNDEFINED,
            constant: false,
            breaks: Vec::new(),
            continues: Vec::new(),
            depth: 0,
            point: None,
        }
    }

    pub(super) fn emit(&mut self, instruction: Instruction) {
        if self.constant {
            self.build.start.push(instruction);
        } else {
            self.build.program.code.push(instruction);
            self.build.program.spans.push(self.span);
        }
    }

    pub(super) fn inner(&self, handle: Handle<Expression>) -> &'m TypeInner {
        self.types[handle.index()]
    }

    pub(super) fn slots(&self, handle: Handle<Expression>) -> Result<u32, Error> {
        self.build.layout.slots(self.inner(handle))
    }

    /// Kind of the scalars of an expression.
    pub(super) fn kind(&self, handle: Handle<Expression>) -> Result<SlotKind, Error> {
        let scalar = self.inner(handle).scalar();
        scalar
            .and_then(crate::layout::kind_of)
            .ok_or_else(|| Error::unsupported("an operation on this type"))
    }

    /// The operand of a value, whose components have slots of their own or share one. For a pointer
    /// it is the slot that holds the address.
    pub(super) fn operand(&mut self, handle: Handle<Expression>) -> Result<Operand, Error> {
        match self.loc(handle)? {
            Loc::Value { operand, .. } => Ok(operand),
            pointer => Ok(Operand { slot: self.address(pointer)?, stride: 1 }),
        }
    }

    /// As [`Self::operand`], for an operation on `n` components: a scalar is shared by all.
    pub(super) fn spread(&mut self, handle: Handle<Expression>, n: u32) -> Result<Operand, Error> {
        let operand = self.operand(handle)?;
        let single = n > 1 && matches!(self.inner(handle), TypeInner::Scalar(_));
        Ok(if single { Operand { stride: 0, ..operand } } else { operand })
    }

    /// The first slot of a value whose components each have a slot of their own.
    pub(super) fn dense(&mut self, handle: Handle<Expression>) -> Result<Slot, Error> {
        let (operand, n) = (self.operand(handle)?, self.slots(handle)?);
        if operand.stride == 1 || n == 1 {
            return Ok(operand.slot);
        }
        let to = self.build.alloc(n)?;
        self.emit(Instruction::Fill { to, from: operand.slot, n });
        Ok(to)
    }

    /// A slot that holds the address of a pointer.
    pub(super) fn address(&mut self, pointer: Loc) -> Result<Slot, Error> {
        match pointer {
            Loc::Value { operand, .. } => Ok(operand.slot),
            Loc::Place(place) => self.build.word(place),
            Loc::Through { slot, offset: 0 } => Ok(slot),
            Loc::Through { slot, offset } => {
                let (to, offset) = (self.build.alloc(1)?, self.build.word(offset)?);
                let [a, b] = [slot, offset].map(|slot| Operand { slot, stride: 1 });
                self.emit(Instruction::Word2 { op: Word2::Add, n: 1, to, a, b });
                Ok(to)
            }
        }
    }
}

//! Pointers as arguments that WGSL allows (`unrestricted_pointer_parameters`) and naga does not:
//! those to buffers and to workgroup memory, which it refuses, and those to a part of a variable,
//! which it does not write as SPIR-V. Storage textures as arguments are handled as such pointers:
//! naga stops where it writes them as MSL, and writes GLSL that is not valid.
//!
//! A function with such a parameter is made anew for each place that it is called with: the
//! variable of the module and the members on the way are then a part of its body, and the indices on
//! the way are parameters instead. A variable of a function is a parameter as a whole. Functions with
//! pointers to buffers that nothing calls are left out, since nothing says where these point to.

use std::collections::{BTreeMap, BTreeSet};

use naga::front::Typifier;
use naga::proc::ResolveContext;
use naga::{
    AddressSpace, Arena, Block, EntryPoint, Expression, Function, FunctionArgument, GlobalVariable,
    Handle, ImageClass, LocalVariable, MemoryDecorations, Module, Range, ResourceBinding, Span,
    Statement, Type, TypeInner, UniqueArena,
};

use lamplight_files::limits::PLACED_EXPRESSIONS;

use super::operands::{change_operands, change_used, inner_blocks, inner_blocks_mut, result_mut};
use super::uses::functions;

type Value = Handle<Expression>;

/// Where a pointer leads, but for the indices on the way.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Place {
    root: Root,
    path: Vec<Step>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Root {
    Variable(Handle<GlobalVariable>),
    /// A pointer of this type, which the caller passes.
    Passed(Handle<Type>),
}

/// The places of a function's parameters; `None` for one that stays as it is.
type Places = Vec<Option<Place>>;

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Step {
    Member(u32),
    /// An index, and its type.
    Index(Handle<Type>),
}

/// A module with its pointers placed.
pub struct PlacedPointers {
    pub module: Module,
    /// The same with the functions that nothing calls, as if each pointer led to a variable of its
    /// own; `None` where there are none. It is there to be checked.
    pub uncalled: Option<Module>,
}

/// Why pointers are not placed.
#[derive(Debug, Clone, Copy)]
pub enum Unplaced {
    /// The module is not valid. naga's validator finds out why.
    Invalid,
    /// There are more functions than `PLACED_EXPRESSIONS` allows.
    Many(Span),
}

/// Whether a module has pointers that naga does not take.
pub fn has_pointers_to_place(module: &Module) -> bool {
    functions(module).any(|function| takes(module, function) || passes(module, function))
}

/// The module in which naga takes every pointer.
///
/// # Errors
/// Where it cannot be made.
pub fn place_pointers(module: &Module) -> Result<PlacedPointers, Unplaced> {
    let mut made = MadeFunctions {
        module,
        types: module.types.clone(),
        functions: Arena::new(),
        handles: BTreeMap::new(),
        expressions: 0,
        excess: None,
    };
    let placed = made.place_called().and_then(|points| {
        let placed = made.module(points, module.global_variables.clone());
        let uncalled = made.place_uncalled()?;
        Some(PlacedPointers { module: placed, uncalled })
    });
    placed.ok_or(made.excess.map_or(Unplaced::Invalid, Unplaced::Many))
}

/// Places for the pointers of a function that nothing calls: new variables of the module.
fn own_places(
    module: &Module,
    function: &Function,
    variables: &mut Arena<GlobalVariable>,
) -> Option<Places> {
    let mut place = |argument: &FunctionArgument| {
        let (base, space) = match module.types[argument.ty].inner {
            TypeInner::Pointer { base, space } => (base, space),
            TypeInner::Image { dim: _, arrayed: _, class: _ } => {
                (argument.ty, AddressSpace::Handle)
            }
            _ => return None,
        };
        let is_bound = matches!(
            space,
            AddressSpace::Uniform | AddressSpace::Storage { access: _ } | AddressSpace::Handle
        );
        let number = variables.len() as u32;
        let binding = is_bound.then_some(ResourceBinding { group: u32::MAX, binding: number });
        let variable = GlobalVariable {
            name: argument.name.clone(),
            space,
            binding,
            ty: base,
            init: None,
            memory_decorations: MemoryDecorations::empty(),
        };
        let root = Root::Variable(variables.append(variable, Span::UNDEFINED));
        Some(Some(Place { root, path: Vec::new() }))
    };
    let arguments = function.arguments.iter();
    arguments.map(|one| if is_refused(module, one) { place(one) } else { Some(None) }).collect()
}

/// Whether a function takes a pointer that naga refuses, or a storage texture.
fn takes(module: &Module, function: &Function) -> bool {
    function.arguments.iter().any(|argument| is_refused(module, argument))
}

fn is_refused(module: &Module, argument: &FunctionArgument) -> bool {
    let inner = &module.types[argument.ty].inner;
    if let TypeInner::Image { dim: _, arrayed: _, class } = inner {
        return matches!(class, ImageClass::Storage { format: _, access: _ });
    }
    let space = inner.pointer_space();
    space.is_some_and(|space| !matches!(space, AddressSpace::Private | AddressSpace::Function))
}

/// Whether a function passes a pointer to a part of a variable on.
fn passes(module: &Module, function: &Function) -> bool {
    any_call(&function.body, &mut |callee, arguments| {
        let parameters = &module.functions[callee].arguments;
        parameters.iter().zip(arguments).any(|(parameter, value)| {
            is_pointer(module, parameter) && leads_to_a_part(&function.expressions, *value)
        })
    })
}

fn any_call(block: &Block, is_it: &mut dyn FnMut(Handle<Function>, &[Value]) -> bool) -> bool {
    block.iter().any(|statement| {
        let is_own = match statement {
            Statement::Call { function, arguments, result: _ } => is_it(*function, arguments),
            _ => false,
        };
        is_own || inner_blocks(statement).into_iter().any(|inner| any_call(inner, is_it))
    })
}

fn is_pointer(module: &Module, argument: &FunctionArgument) -> bool {
    module.types[argument.ty].inner.pointer_space().is_some()
}

/// Whether a pointer leads to a part of a variable.
fn leads_to_a_part(expressions: &Arena<Expression>, mut value: Value) -> bool {
    let mut has_path = false;
    loop {
        value = match expressions[value] {
            Expression::Access { base, index: _ } | Expression::AccessIndex { base, index: _ } => {
                base
            }
            Expression::LocalVariable(_)
            | Expression::GlobalVariable(_)
            | Expression::FunctionArgument(_) => return has_path,
            _ => return false,
        };
        has_path = true;
    }
}

struct MadeFunctions<'m> {
    module: &'m Module,
    types: UniqueArena<Type>,
    functions: Arena<Function>,
    handles: BTreeMap<(Handle<Function>, Places), Handle<Function>>,
    /// How many expressions the functions have.
    expressions: usize,
    /// The function that has more than are allowed.
    excess: Option<Span>,
}

impl MadeFunctions<'_> {
    /// Makes the functions whose pointers are known, and returns the entry points.
    fn place_called(&mut self) -> Option<Vec<EntryPoint>> {
        let module = self.module;
        for (handle, function) in module.functions.iter() {
            if !takes(module, function) {
                self.function(handle, &vec![None; function.arguments.len()])?;
            }
        }
        let mut points = module.entry_points.clone();
        for point in &mut points {
            let places = vec![None; point.function.arguments.len()];
            point.function = self.rewritten(&point.function, &places)?;
        }
        Some(points)
    }

    /// A module that also has the functions that nothing calls, if there are any.
    fn place_uncalled(&mut self) -> Option<Option<Module>> {
        let called: BTreeSet<Handle<Function>> =
            self.handles.keys().map(|(handle, _)| *handle).collect();
        let mut variables = self.module.global_variables.clone();
        let mut uncalled = Vec::new();
        for (handle, function) in self.module.functions.iter() {
            if !called.contains(&handle) {
                uncalled.push((handle, own_places(self.module, function, &mut variables)?));
            }
        }
        for (handle, places) in &uncalled {
            self.function(*handle, places)?;
        }
        Some((!uncalled.is_empty()).then(|| self.module(Vec::new(), variables)))
    }

    /// A module of what is made so far.
    fn module(&self, entry_points: Vec<EntryPoint>, variables: Arena<GlobalVariable>) -> Module {
        let Module {
            types: _,
            special_types,
            constants,
            overrides,
            global_variables: _,
            global_expressions,
            functions: _,
            entry_points: _,
            diagnostic_filters,
            diagnostic_filter_leaf,
            doc_comments,
        } = self.module.clone();
        Module {
            types: self.types.clone(),
            special_types,
            constants,
            overrides,
            global_variables: variables,
            global_expressions,
            functions: self.functions.clone(),
            entry_points,
            diagnostic_filters,
            diagnostic_filter_leaf,
            doc_comments,
        }
    }

    /// The function with its pointers at these places.
    fn function(
        &mut self,
        old: Handle<Function>,
        at: &[Option<Place>],
    ) -> Option<Handle<Function>> {
        let key = (old, at.to_vec());
        if let Some(known) = self.handles.get(&key) {
            return Some(*known);
        }
        let function = &self.module.functions[old];
        self.expressions += function.expressions.len();
        if self.expressions > PLACED_EXPRESSIONS {
            self.excess = Some(self.module.functions.get_span(old));
            return None;
        }
        let function = self.rewritten(function, at)?;
        let made = self.functions.append(function, self.module.functions.get_span(old));
        self.handles.insert(key, made);
        Some(made)
    }

    fn rewritten(&mut self, function: &Function, at: &[Option<Place>]) -> Option<Function> {
        let Function {
            name,
            arguments,
            result,
            local_variables,
            expressions,
            named_expressions,
            body,
            diagnostic_filter_leaf,
        } = function;
        let mut rewrite = FunctionRewrite {
            made: self,
            calls: BTreeMap::new(),
            arguments: Vec::new(),
            parameters: Vec::new(),
            locals: local_variables,
            expressions: Arena::new(),
            values: BTreeMap::new(),
            computed: Vec::new(),
            typifier: Typifier::new(),
        };
        rewrite.find_calls(body);
        rewrite.declare(arguments, at);
        for (handle, expression) in expressions.iter() {
            rewrite.expression(handle, expression, expressions.get_span(handle))?;
        }
        let mut new_body = Block::new();
        write_runs(&rewrite.computed, Span::UNDEFINED, &mut new_body);
        new_body.extend_block(rewrite.block(body)?);
        let locals = rewrite.local_variables()?;
        let mut names = naga::FastIndexMap::default();
        for (value, name) in named_expressions {
            names.insert(rewrite.value(*value)?, name.clone());
        }
        Some(Function {
            name: name.clone(),
            arguments: rewrite.arguments,
            result: result.clone(),
            local_variables: locals,
            expressions: rewrite.expressions,
            named_expressions: names,
            body: new_body,
            diagnostic_filter_leaf: *diagnostic_filter_leaf,
        })
    }
}

/// What a parameter has become.
enum Parameter {
    Plain(u32),
    /// A place, and the first of the parameters that it is made from.
    Placed(Place, u32),
}

struct FunctionRewrite<'r, 'm> {
    made: &'r mut MadeFunctions<'m>,
    /// The calls whose results are used, by these.
    calls: BTreeMap<Value, (Handle<Function>, Vec<Value>)>,
    arguments: Vec<FunctionArgument>,
    /// By the numbers of the old ones.
    parameters: Vec<Parameter>,
    locals: &'r Arena<LocalVariable>,
    expressions: Arena<Expression>,
    /// What each value has become.
    values: BTreeMap<Value, Value>,
    /// The parts of places, which are computed at the start of the function.
    computed: Vec<Value>,
    typifier: Typifier,
}

/// A call with the pointers in its arguments placed.
struct PlacedCall {
    function: Handle<Function>,
    arguments: Vec<Value>,
}

impl FunctionRewrite<'_, '_> {
    fn find_calls(&mut self, block: &Block) {
        for statement in block {
            if let Statement::Call { function, arguments, result: Some(result) } = statement {
                self.calls.insert(*result, (*function, arguments.clone()));
            }
            for inner in inner_blocks(statement) {
                self.find_calls(inner);
            }
        }
    }

    fn declare(&mut self, arguments: &[FunctionArgument], at: &[Option<Place>]) {
        for (argument, place) in arguments.iter().zip(at) {
            let next = self.arguments.len() as u32;
            let Some(place) = place else {
                self.arguments.push(argument.clone());
                self.parameters.push(Parameter::Plain(next));
                continue;
            };
            if let Root::Passed(ty) = place.root {
                let name = argument.name.clone();
                self.arguments.push(FunctionArgument { name, ty, binding: None });
            }
            let name = argument.name.as_deref().unwrap_or("p");
            for step in &place.path {
                if let Step::Index(ty) = step {
                    let name = Some(format!("{name}_index"));
                    self.arguments.push(FunctionArgument { name, ty: *ty, binding: None });
                }
            }
            self.parameters.push(Parameter::Placed(place.clone(), next));
        }
    }

    fn local_variables(&self) -> Option<Arena<LocalVariable>> {
        let mut locals = Arena::new();
        for (handle, LocalVariable { name, ty, init }) in self.locals.iter() {
            let init = match init {
                Some(value) => Some(self.value(*value)?),
                None => None,
            };
            let local = LocalVariable { name: name.clone(), ty: *ty, init };
            locals.append(local, self.locals.get_span(handle));
        }
        Some(locals)
    }

    fn value(&self, old: Value) -> Option<Value> {
        self.values.get(&old).copied()
    }

    fn expression(&mut self, old: Value, expression: &Expression, span: Span) -> Option<()> {
        let new = match expression {
            Expression::FunctionArgument(index) => self.parameter(*index, span)?,
            Expression::CallResult(_) => {
                let (function, arguments) = self.calls.get(&old)?.clone();
                let call = self.call(function, &arguments)?;
                self.expressions.append(Expression::CallResult(call.function), span)
            }
            other => {
                let mut changed = other.clone();
                let mut is_known = true;
                change_operands(&mut changed, &mut |operand| match self.values.get(operand) {
                    Some(value) => *operand = *value,
                    None => is_known = false,
                });
                is_known.then(|| self.expressions.append(changed, span))?
            }
        };
        self.values.insert(old, new);
        Some(())
    }

    /// The expression that a parameter has become.
    fn parameter(&mut self, index: u32, span: Span) -> Option<Value> {
        let (place, mut next) = match self.parameters.get(index as usize)? {
            Parameter::Plain(index) => {
                let argument = Expression::FunctionArgument(*index);
                return Some(self.expressions.append(argument, span));
            }
            Parameter::Placed(place, first) => (place.clone(), *first),
        };
        let mut argument = |expressions: &mut Arena<Expression>| {
            next += 1;
            expressions.append(Expression::FunctionArgument(next - 1), span)
        };
        let mut base = match place.root {
            Root::Passed(_) => argument(&mut self.expressions),
            Root::Variable(variable) => {
                self.expressions.append(Expression::GlobalVariable(variable), span)
            }
        };
        // Values that are computed follow each other.
        let indices = place.path.iter().map(|step| match step {
            Step::Member(_) => None,
            Step::Index(_) => Some(argument(&mut self.expressions)),
        });
        let indices: Vec<Option<Value>> = indices.collect();
        for (step, index) in place.path.iter().zip(indices) {
            let part = match (step, index) {
                (Step::Index(_), Some(index)) => Expression::Access { base, index },
                (Step::Member(index), _) => Expression::AccessIndex { base, index: *index },
                (Step::Index(_), None) => return None,
            };
            base = self.expressions.append(part, span);
            self.computed.push(base);
        }
        Some(base)
    }

    /// A call with the places that its pointers lead to.
    fn call(&mut self, function: Handle<Function>, arguments: &[Value]) -> Option<PlacedCall> {
        let module = self.made.module;
        let (mut places, mut new) = (Vec::new(), Vec::new());
        for (argument, value) in module.functions[function].arguments.iter().zip(arguments) {
            let value = self.value(*value)?;
            let is_placed =
                is_pointer(module, argument) && leads_to_a_part(&self.expressions, value);
            if !is_placed && !is_refused(module, argument) {
                new.push(value);
                places.push(None);
                continue;
            }
            // naga no longer compares the two.
            let ty = self.type_of(value)?;
            let types = &self.made.types;
            (pointed(types, ty) == pointed(types, argument.ty)).then_some(())?;
            places.push(Some(self.place(value, &mut new)?));
        }
        Some(PlacedCall { function: self.made.function(function, &places)?, arguments: new })
    }

    /// Where a pointer leads. Its indices become arguments.
    fn place(&mut self, pointer: Value, arguments: &mut Vec<Value>) -> Option<Place> {
        let (mut at, mut path, mut indices) = (pointer, Vec::new(), Vec::new());
        let root = loop {
            at = match self.expressions[at] {
                Expression::GlobalVariable(variable) => break Root::Variable(variable),
                Expression::LocalVariable(_) | Expression::FunctionArgument(_) => {
                    arguments.push(at);
                    break Root::Passed(self.type_of(at)?);
                }
                Expression::AccessIndex { base, index } => {
                    path.push(Step::Member(index));
                    base
                }
                Expression::Access { base, index } => {
                    path.push(Step::Index(self.type_of(index)?));
                    indices.push(index);
                    base
                }
                _ => return None,
            };
        };
        path.reverse();
        arguments.extend(indices.into_iter().rev());
        Some(Place { root, path })
    }

    fn type_of(&mut self, value: Value) -> Option<Handle<Type>> {
        let module = self.made.module;
        let context = ResolveContext {
            constants: &module.constants,
            overrides: &module.overrides,
            types: &self.made.types,
            special_types: &module.special_types,
            global_vars: &module.global_variables,
            local_vars: self.locals,
            functions: &self.made.functions,
            arguments: &self.arguments,
        };
        self.typifier.grow(value, &self.expressions, &context).ok()?;
        Some(self.typifier.register_type(value, &mut self.made.types))
    }

    fn block(&mut self, old: &Block) -> Option<Block> {
        let mut block = Block::new();
        for (statement, span) in old.span_iter() {
            let mut statement = statement.clone();
            match &mut statement {
                Statement::Emit(range) => {
                    let values: Option<Vec<Value>> =
                        range.clone().map(|value| self.value(value)).collect();
                    write_runs(&values?, *span, &mut block);
                    continue;
                }
                Statement::Call { function, arguments, result: _ } => {
                    let call = self.call(*function, arguments)?;
                    (*function, *arguments) = (call.function, call.arguments);
                }
                other => {
                    let mut is_known = true;
                    change_used(other, &mut |used| match self.values.get(used) {
                        Some(value) => *used = *value,
                        None => is_known = false,
                    });
                    is_known.then_some(())?;
                }
            }
            for inner in inner_blocks_mut(&mut statement) {
                *inner = self.block(inner)?;
            }
            if let Some(result) = result_mut(&mut statement) {
                *result = self.value(*result)?;
            }
            block.push(statement, *span);
        }
        Some(block)
    }
}

/// A pointer to numbers with the type of these in place of its handle, since naga has two forms.
fn pointed(types: &UniqueArena<Type>, ty: Handle<Type>) -> TypeInner {
    let inner = &types[ty].inner;
    let TypeInner::Pointer { base, space } = *inner else { return inner.clone() };
    match types[base].inner {
        TypeInner::Scalar(scalar) => TypeInner::ValuePointer { size: None, scalar, space },
        TypeInner::Vector { size, scalar } => {
            TypeInner::ValuePointer { size: Some(size), scalar, space }
        }
        _ => inner.clone(),
    }
}

/// Writes the emission of values, those that follow each other together.
fn write_runs(values: &[Value], span: Span, block: &mut Block) {
    for run in values.chunk_by(|one, next| one.index() + 1 == next.index()) {
        if let [first, .., last] | [first @ last] = run {
            block.push(Statement::Emit(Range::new_from_bounds(*first, *last)), span);
        }
    }
}

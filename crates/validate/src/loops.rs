//! Values of a loop's body that its `continuing` block uses.
//!
//! naga writes the `continuing` block before the body in HLSL, MSL and GLSL, and so without the
//! variables that hold the body's values: whatever `continuing` uses is computed there again, from
//! variables that may have changed. So the body stores such a value in a variable of its own, and
//! `continuing` loads it. A pointer cannot be stored. It is made again, from indices that were.

use std::collections::{BTreeMap, BTreeSet};

use naga::front::Typifier;
use naga::proc::ResolveContext;
use naga::{
    Arena, Block, Expression, Function, Handle, LocalVariable, Module, Range, Span, Statement,
    Type, TypeInner,
};

use super::operands::{
    change_operands, change_used, computed, inner_blocks, inner_blocks_mut, operands, result_mut,
    used,
};

type Value = Handle<Expression>;

/// Stores the values of loops' bodies that their `continuing` blocks use.
///
/// # Errors
/// The place of a value that can be neither stored nor computed again: what
/// `atomicCompareExchangeWeak` returns, whose type has no name.
pub fn store_loop_values(module: &mut Module) -> Result<(), Span> {
    let functions: Vec<Handle<Function>> =
        module.functions.iter().map(|(handle, _)| handle).collect();
    for handle in functions {
        let changed = changed_function(&module.functions[handle], module)?;
        if let Some((function, types)) = changed {
            module.types = types;
            module.functions[handle] = function;
        }
    }
    for index in 0..module.entry_points.len() {
        let changed = changed_function(&module.entry_points[index].function, module)?;
        if let Some((function, types)) = changed {
            module.types = types;
            module.entry_points[index].function = function;
        }
    }
    Ok(())
}

/// A function with stored values, and the types that it needs.
type ChangedFunction = (Function, naga::UniqueArena<Type>);

/// What a loop needs of its body.
#[derive(Default)]
struct LoopNeeds {
    /// Values that the `continuing` block uses, in the order of their computation.
    values: BTreeSet<Value>,
    /// What the `continuing` block computes.
    computed: BTreeSet<Value>,
}

/// How a value reaches the `continuing` block.
enum Carried {
    /// In a variable of this type.
    Stored(Handle<Type>),
    /// It is computed again from what is carried: pointers, and results of `modf` and `frexp`,
    /// whose types have no name.
    Repeated,
}

/// The function with stored values; `None` where it needs none.
fn changed_function(function: &Function, module: &Module) -> Result<Option<ChangedFunction>, Span> {
    let mut loops = Vec::new();
    find_loops(&function.body, &mut loops);
    let mut needs: Vec<LoopNeeds> =
        loops.iter().map(|(body, rest)| needs_of(body, rest, function)).collect();
    if needs.iter().all(|needs| needs.values.is_empty()) {
        return Ok(None);
    }
    let mut typifier = Typifier::new();
    let context =
        ResolveContext::with_locals(module, &function.local_variables, &function.arguments);
    // naga's validator reports what has no type.
    let Some((last, _)) = function.expressions.iter().next_back() else { return Ok(None) };
    if typifier.grow(last, &function.expressions, &context).is_err() {
        return Ok(None);
    }
    let mut types = module.types.clone();
    let mut carried = BTreeMap::new();
    for (needs, (body, _)) in needs.iter_mut().zip(&loops) {
        let body: BTreeSet<Value> = computed(body).into_iter().collect();
        let mut open: Vec<Value> = needs.values.iter().copied().collect();
        while let Some(value) = open.pop() {
            needs.values.insert(value);
            let expression = &function.expressions[value];
            let ty = typifier.register_type(value, &mut types);
            let how = match is_repeated(module, &types, ty, expression) {
                Some(true) => {
                    open.extend(operands(expression).into_iter().filter(|one| body.contains(one)));
                    Carried::Repeated
                }
                Some(false) => Carried::Stored(ty),
                None => return Err(function.expressions.get_span(value)),
            };
            carried.insert(value, how);
        }
    }
    let mut function = function.clone();
    LoopRewrite::new(&needs, carried).rewrite(&mut function);
    Ok(Some((function, types)))
}

/// The bodies of all loops, each with its statement, in the order in which a walk meets them.
fn find_loops<'f>(block: &'f Block, loops: &mut Vec<(&'f Block, &'f Statement)>) {
    for statement in block {
        if let Statement::Loop { body, continuing: _, break_if: _ } = statement {
            loops.push((body, statement));
        }
        for inner in inner_blocks(statement) {
            find_loops(inner, loops);
        }
    }
}

fn needs_of(body: &Block, statement: &Statement, function: &Function) -> LoopNeeds {
    let Statement::Loop { body: _, continuing, break_if } = statement else {
        return LoopNeeds::default();
    };
    let body: BTreeSet<Value> = computed(body).into_iter().collect();
    let computed: BTreeSet<Value> = computed(continuing).into_iter().collect();
    let mut all: Vec<Value> = break_if.iter().copied().collect();
    all.extend(computed.iter().flat_map(|value| operands(&function.expressions[*value])));
    let mut open = vec![continuing];
    while let Some(block) = open.pop() {
        for statement in block {
            all.extend(used(statement));
            open.extend(inner_blocks(statement));
        }
    }
    LoopNeeds { values: all.into_iter().filter(|value| body.contains(value)).collect(), computed }
}

/// Whether a value is computed again instead of stored; `None` where neither is possible.
fn is_repeated(
    module: &Module,
    types: &naga::UniqueArena<Type>,
    ty: Handle<Type>,
    expression: &Expression,
) -> Option<bool> {
    let is_pointer = matches!(
        types[ty].inner,
        TypeInner::Pointer { base: _, space: _ }
            | TypeInner::ValuePointer { size: _, scalar: _, space: _ }
    );
    let is_nameless = module.special_types.predeclared_types.values().any(|one| *one == ty);
    match expression {
        _ if is_pointer => Some(true),
        Expression::Math { .. } if is_nameless => Some(true),
        _ if is_nameless => None,
        _ => Some(false),
    }
}

/// Rebuilds the expressions of a function: operands must come before what is computed from them.
struct LoopRewrite<'n> {
    needs: &'n [LoopNeeds],
    carried: BTreeMap<Value, Carried>,
    /// The new expression of each old one.
    moved: BTreeMap<Value, Value>,
    /// What a value is within the `continuing` block of a loop.
    within: BTreeMap<(usize, Value), Value>,
    /// The variable that each stored value is in.
    variables: BTreeMap<Value, Value>,
    /// The number of the next loop.
    next: usize,
}

impl<'n> LoopRewrite<'n> {
    fn new(needs: &'n [LoopNeeds], carried: BTreeMap<Value, Carried>) -> Self {
        let (moved, within, variables) = (BTreeMap::new(), BTreeMap::new(), BTreeMap::new());
        Self { needs, carried, moved, within, variables, next: 0 }
    }

    fn rewrite(mut self, function: &mut Function) {
        let mut expressions = Arena::new();
        let old: Vec<_> = function.expressions.drain().collect();
        for (handle, expression, span) in old {
            let loops: Vec<usize> = (0..self.needs.len())
                .filter(|index| self.needs[*index].computed.contains(&handle))
                .collect();
            let new = expressions.append(self.changed(&expression, &loops), span);
            self.moved.insert(handle, new);
            self.carry(handle, &expression, span, function, &mut expressions);
        }
        function.expressions = expressions;
        let named = std::mem::take(&mut function.named_expressions);
        function.named_expressions =
            named.into_iter().map(|(value, name)| (self.moved[&value], name)).collect();
        for (_, LocalVariable { name: _, ty: _, init }) in function.local_variables.iter_mut() {
            init.iter_mut().for_each(|value| *value = self.found(*value, &[]));
        }
        let mut body = std::mem::take(&mut function.body);
        self.block(&mut body, &mut Vec::new());
        function.body = body;
    }

    /// Adds what the `continuing` blocks have instead of a value.
    fn carry(
        &mut self,
        value: Value,
        expression: &Expression,
        span: Span,
        function: &mut Function,
        expressions: &mut Arena<Expression>,
    ) {
        let pointer = match self.carried.get(&value) {
            None => return,
            Some(Carried::Repeated) => None,
            Some(Carried::Stored(ty)) => {
                let name = function.named_expressions.get(&value).cloned();
                let local = LocalVariable { name, ty: *ty, init: None };
                let local = function.local_variables.append(local, span);
                let pointer = expressions.append(Expression::LocalVariable(local), span);
                self.variables.insert(value, pointer);
                Some(pointer)
            }
        };
        let needs = self.needs;
        for index in (0..needs.len()).filter(|index| needs[*index].values.contains(&value)) {
            let replacement = match pointer {
                Some(pointer) => Expression::Load { pointer },
                None => self.changed(expression, &[index]),
            };
            let replacement = expressions.append(replacement, span);
            self.within.insert((index, value), replacement);
        }
    }

    fn changed(&self, expression: &Expression, loops: &[usize]) -> Expression {
        let mut changed = expression.clone();
        change_operands(&mut changed, &mut |operand| *operand = self.found(*operand, loops));
        changed
    }

    /// What a value is within the `continuing` blocks of these loops.
    fn found(&self, value: Value, loops: &[usize]) -> Value {
        let within = loops.iter().find_map(|index| self.within.get(&(*index, value)));
        within.or_else(|| self.moved.get(&value)).copied().unwrap_or(value)
    }

    /// Rewrites a block, which is in the `continuing` blocks of these loops.
    fn block(&mut self, block: &mut Block, loops: &mut Vec<usize>) {
        for (mut statement, span) in std::mem::take(block).span_into_iter() {
            if let Statement::Emit(range) = &statement {
                self.emit(range.clone(), span, block);
                continue;
            }
            let own = matches!(statement, Statement::Loop { .. }).then(|| {
                self.next += 1;
                self.next - 1
            });
            if let Statement::Loop { body, continuing, break_if } = &mut statement {
                self.block(body, loops);
                loops.extend(own);
                self.block(continuing, loops);
                break_if.iter_mut().for_each(|value| *value = self.found(*value, loops));
                own.into_iter().for_each(|index| self.load(index, continuing, span));
                loops.pop();
            } else {
                change_used(&mut statement, &mut |value| *value = self.found(*value, loops));
                for inner in inner_blocks_mut(&mut statement) {
                    self.block(inner, loops);
                }
            }
            let result = result_mut(&mut statement).map(|result| {
                let old = *result;
                *result = self.moved.get(&old).copied().unwrap_or(old);
                old
            });
            block.push(statement, span);
            result.into_iter().for_each(|value| self.store(value, span, block));
        }
    }

    /// Writes the emission of some values, each followed by its store.
    fn emit(&self, range: Range<Expression>, span: Span, block: &mut Block) {
        let mut run: Option<(Value, Value)> = None;
        for value in range {
            let new = self.found(value, &[]);
            run = Some((run.map_or(new, |(first, _)| first), new));
            if self.carried.contains_key(&value) {
                write_run(run.take(), span, block);
                self.store(value, span, block);
            }
        }
        write_run(run, span, block);
    }

    fn store(&self, value: Value, span: Span, block: &mut Block) {
        if let Some(pointer) = self.variables.get(&value) {
            let value = self.found(value, &[]);
            block.push(Statement::Store { pointer: *pointer, value }, span);
        }
    }

    /// Emits what a `continuing` block has instead of the body's values, at its start.
    fn load(&self, index: usize, continuing: &mut Block, span: Span) {
        let mut block = Block::new();
        for value in &self.needs[index].values {
            let value = self.within.get(&(index, *value)).copied();
            write_run(value.map(|value| (value, value)), span, &mut block);
        }
        block.extend_block(std::mem::take(continuing));
        *continuing = block;
    }
}

fn write_run(run: Option<(Value, Value)>, span: Span, block: &mut Block) {
    if let Some((first, last)) = run {
        block.push(Statement::Emit(Range::new_from_bounds(first, last)), span);
    }
}

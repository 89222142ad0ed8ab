//! What functions compute from overrides that became literals.
//!
//! A pipeline knows the values of such expressions before it starts. So naga's front end takes them
//! for the initial values of variables, and says of some of them nowhere when they are computed. Its
//! SPIR-V writer knows only literals, and what is made of them, before a function begins.

use std::collections::{BTreeMap, BTreeSet};

use naga::{Block, Expression, Function, Handle, Range, Span, Statement};

use lamplight_validate::{inner_blocks_mut, operands};

/// The pointers to variables, by the expressions that were their initial values.
type Stores = BTreeMap<Handle<Expression>, Vec<Handle<Expression>>>;

/// Gives each of them a place where it is computed, and variables their values there.
pub fn compute_in_statements(function: &mut Function) {
    let computed = computed_from_literals(function);
    let mut stores = stores_of(function, &computed);
    let mut emitted = BTreeSet::new();
    store_after(&mut function.body, &mut stores, &mut emitted);
    let mut start = Block::new();
    for value in computed.difference(&emitted) {
        start.push(Statement::Emit(Range::new_from_bounds(*value, *value)), Span::UNDEFINED);
        push_stores(*value, &mut stores, &mut start);
    }
    function.body.splice(0..0, start);
}

/// The expressions that are computed from literals, and that are neither literals nor made of
/// literals alone.
fn computed_from_literals(function: &Function) -> BTreeSet<Handle<Expression>> {
    let (mut known, mut written) = (BTreeSet::new(), BTreeSet::new());
    for (handle, expression) in function.expressions.iter() {
        let operands = operands(expression);
        let are_in = |set: &BTreeSet<_>| operands.iter().all(|operand| set.contains(operand));
        let is_written = match expression {
            Expression::Literal(_) | Expression::Constant(_) | Expression::ZeroValue(_) => true,
            Expression::Compose { ty: _, components: _ }
            | Expression::Splat { size: _, value: _ } => are_in(&written),
            _ => false,
        };
        if is_written {
            written.insert(handle);
        }
        if is_written || !operands.is_empty() && are_in(&known) {
            known.insert(handle);
        }
    }
    known.difference(&written).copied().collect()
}

/// Takes these initial values from the variables.
fn stores_of(function: &mut Function, computed: &BTreeSet<Handle<Expression>>) -> Stores {
    let mut stores = Stores::new();
    for (pointer, expression) in function.expressions.iter() {
        let Expression::LocalVariable(variable) = expression else { continue };
        let init = &mut function.local_variables[*variable].init;
        if let Some(value) = init.take_if(|value| computed.contains(value)) {
            stores.entry(value).or_default().push(pointer);
        }
    }
    // Nothing reads the others, which no expression names.
    for (_, variable) in function.local_variables.iter_mut() {
        variable.init.take_if(|value| computed.contains(value));
    }
    stores
}

/// Stores what statements compute right after them. A variable that is declared in a loop has no
/// initial value, so each store is made once.
fn store_after(block: &mut Block, stores: &mut Stores, emitted: &mut BTreeSet<Handle<Expression>>) {
    for (mut statement, span) in std::mem::take(block).span_into_iter() {
        for inner in inner_blocks_mut(&mut statement) {
            store_after(inner, stores, emitted);
        }
        let values: Vec<_> = match &statement {
            Statement::Emit(range) => range.clone().collect(),
            _ => Vec::new(),
        };
        block.push(statement, span);
        for value in values {
            emitted.insert(value);
            push_stores(value, stores, block);
        }
    }
}

fn push_stores(value: Handle<Expression>, stores: &mut Stores, block: &mut Block) {
    for pointer in stores.remove(&value).unwrap_or_default() {
        block.push(Statement::Store { pointer, value }, Span::UNDEFINED);
    }
}

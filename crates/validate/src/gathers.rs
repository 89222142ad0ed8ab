//! The invocation that `subgroupShuffle` and its like read from: WGSL takes signed integers too, and
//! numbers without a suffix; naga takes unsigned ones alone.

use naga::front::Typifier;
use naga::proc::ResolveContext;
use naga::{
    Block, Expression, Function, Handle, Literal, Module, Range, Scalar, ScalarKind, Statement,
};

use super::operands::{change_gathered, inner_blocks, inner_blocks_mut};

/// Makes the invocations unsigned.
pub fn make_invocations_unsigned(module: &mut Module) {
    let functions: Vec<Handle<Function>> =
        module.functions.iter().map(|(handle, _)| handle).collect();
    for handle in functions {
        if gathers(&module.functions[handle].body) {
            let mut function = module.functions[handle].clone();
            rewrite(&mut function, module);
            module.functions[handle] = function;
        }
    }
    for index in 0..module.entry_points.len() {
        if gathers(&module.entry_points[index].function.body) {
            let mut function = module.entry_points[index].function.clone();
            rewrite(&mut function, module);
            module.entry_points[index].function = function;
        }
    }
}

fn gathers(block: &Block) -> bool {
    block.iter().any(|statement| {
        matches!(statement, Statement::SubgroupGather { .. })
            || inner_blocks(statement).into_iter().any(gathers)
    })
}

fn rewrite(function: &mut Function, module: &Module) {
    let mut body = std::mem::take(&mut function.body);
    let mut typifier = Typifier::new();
    rewrite_block(&mut body, function, module, &mut typifier);
    function.body = body;
}

fn rewrite_block(
    block: &mut Block,
    function: &mut Function,
    module: &Module,
    typifier: &mut Typifier,
) {
    for (mut statement, span) in std::mem::take(block).span_into_iter() {
        if let Statement::SubgroupGather { mode, argument: _, result: _ } = &mut statement {
            change_gathered(mode, &mut |index| {
                let context = ResolveContext::with_locals(
                    module,
                    &function.local_variables,
                    &function.arguments,
                );
                // naga's validator reports what has no type.
                let grown = typifier.grow(*index, &function.expressions, &context);
                let inner = grown.map(|()| typifier.get(*index, &module.types).scalar());
                if inner != Ok(Some(Scalar::I32)) {
                    return;
                }
                if let Expression::Literal(Literal::I32(number @ 0..)) =
                    function.expressions[*index]
                {
                    let number = Expression::Literal(Literal::U32(number as u32));
                    *index = function.expressions.append(number, span);
                    return;
                }
                let unsigned =
                    Expression::As { expr: *index, kind: ScalarKind::Uint, convert: Some(4) };
                *index = function.expressions.append(unsigned, span);
                block.push(Statement::Emit(Range::new_from_bounds(*index, *index)), span);
            });
        }
        for inner in inner_blocks_mut(&mut statement) {
            rewrite_block(inner, function, module, typifier);
        }
        block.push(statement, span);
    }
}

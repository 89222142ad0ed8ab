//! Ends the loops of a module after a number of trips, so that no loop keeps a device busy.

use naga::{
    AddressSpace, Arena, BinaryOperator, Block, Expression, Function, GlobalVariable, Handle,
    Literal, LocalVariable, MemoryDecorations, Module, Range, Scalar, Span, Statement, Type,
    TypeInner,
};

use lamplight_emit::blocks::{inner_blocks, inner_blocks_mut};

/// Ends each loop once `most` trips were made, in all functions of an invocation together.
///
/// Browsers refuse derivatives in a loop whose end depends on a module-scope variable, since that
/// could differ between invocations. So in a module with derivatives, each call of a function
/// counts its own trips. If functions call one another in loops, their numbers of trips multiply.
pub fn bound_loops(module: &mut Module, most: u32) {
    let ty = Type { name: None, inner: TypeInner::Scalar(Scalar::U32) };
    let ty = module.types.insert(ty, Span::UNDEFINED);
    let shared = match has_derivatives(module) {
        true => None,
        false => Some(module.global_variables.append(trip_counter(ty), Span::UNDEFINED)),
    };
    let functions = module.functions.iter_mut().map(|(_, function)| function);
    for function in functions.chain(module.entry_points.iter_mut().map(|point| &mut point.function))
    {
        if has_loop(&function.body) {
            bound_function(function, shared, ty, most);
        }
    }
}

fn trip_counter(ty: Handle<Type>) -> GlobalVariable {
    GlobalVariable {
        name: Some("lamplight_trips".to_owned()),
        space: AddressSpace::Private,
        binding: None,
        ty,
        init: None,
        memory_decorations: MemoryDecorations::empty(),
    }
}

fn has_derivatives(module: &Module) -> bool {
    let functions = module.functions.iter().map(|(_, function)| function);
    let mut all = functions.chain(module.entry_points.iter().map(|point| &point.function));
    all.any(|function| {
        function.expressions.iter().any(|(_, expression)| {
            matches!(expression, Expression::Derivative { .. } | Expression::ImageSample { .. })
        })
    })
}

fn has_loop(block: &Block) -> bool {
    block.iter().any(|statement| {
        matches!(statement, Statement::Loop { .. })
            || inner_blocks(statement).into_iter().any(has_loop)
    })
}

fn bound_function(
    function: &mut Function,
    shared: Option<Handle<GlobalVariable>>,
    ty: Handle<Type>,
    most: u32,
) {
    let mut add = |expression| function.expressions.append(expression, Span::UNDEFINED);
    let counter = match shared {
        Some(global) => add(Expression::GlobalVariable(global)),
        None => {
            let zero = add(Expression::Literal(Literal::U32(0)));
            let name = Some("lamplight_trips".to_owned());
            let local = LocalVariable { name, ty, init: Some(zero) };
            let local = function.local_variables.append(local, Span::UNDEFINED);
            add(Expression::LocalVariable(local))
        }
    };
    let (one, most) =
        (add(Expression::Literal(Literal::U32(1))), add(Expression::Literal(Literal::U32(most))));
    bound_block(&mut function.body, &mut function.expressions, [counter, one, most]);
}

type BudgetValue = Handle<Expression>;

/// Begins the body of every loop with `trips += 1; if trips > most { break; }`.
fn bound_block(block: &mut Block, arena: &mut Arena<Expression>, given: [BudgetValue; 3]) {
    for statement in block.iter_mut() {
        for inner in inner_blocks_mut(statement) {
            bound_block(inner, arena, given);
        }
        if let Statement::Loop { body, .. } = statement {
            body.splice(0..0, counted_trip(arena, given));
        }
    }
}

fn counted_trip(arena: &mut Arena<Expression>, [counter, one, most]: [BudgetValue; 3]) -> Block {
    let mut add = |expression| arena.append(expression, Span::UNDEFINED);
    let before = add(Expression::Load { pointer: counter });
    let binary = |op, left, right| Expression::Binary { op, left, right };
    let after = add(binary(BinaryOperator::Add, before, one));
    let done = add(binary(BinaryOperator::Greater, after, most));
    let accept = Block::from_vec(vec![Statement::Break]);
    Block::from_vec(vec![
        Statement::Emit(Range::new_from_bounds(before, done)),
        Statement::Store { pointer: counter, value: after },
        Statement::If { condition: done, accept, reject: Block::new() },
    ])
}

//! Repairs what naga's GLSL front end reads almost rightly.
//!
//! Cases of a `switch` that end in `return`, or in braces with a `break`, are marked as if they fell
//! through, which WGSL cannot express. An argument of an `out` or `inout` parameter is passed as a
//! pointer into a vector, a matrix, an array or a structure, and twice if it is given twice. GLSL
//! copies it in and out, so that is done here, through a local variable.

use naga::{
    AddressSpace, Block, Expression, Function, Handle, LocalVariable, Module, Range, Span,
    Statement, Type, TypeInner,
};

/// Repairs every function of a module.
pub fn repair_module(module: &mut Module) {
    let pointees: Vec<Vec<Option<Handle<Type>>>> =
        module.functions.iter().map(|(_, function)| pointees_of(module, function)).collect();
    let points = module.entry_points.iter_mut().map(|point| &mut point.function);
    let functions = module.functions.iter_mut().map(|(_, function)| function);
    for function in functions.chain(points) {
        let mut body = std::mem::take(&mut function.body);
        repair_block(&mut body, function, &pointees);
        function.body = body;
    }
}

/// For each parameter what it points to, if it is a pointer to a variable of a function.
fn pointees_of(module: &Module, function: &Function) -> Vec<Option<Handle<Type>>> {
    let parameters = function.arguments.iter();
    let pointee = |ty: Handle<Type>| match module.types[ty].inner {
        TypeInner::Pointer { base, space: AddressSpace::Function } => Some(base),
        _ => None,
    };
    parameters.map(|parameter| pointee(parameter.ty)).collect()
}

fn repair_block(
    block: &mut Block,
    function: &mut Function,
    pointees: &[Vec<Option<Handle<Type>>>],
) {
    let old = std::mem::take(block);
    for (mut statement, span) in old.span_into_iter() {
        let mut after = Block::new();
        match &mut statement {
            Statement::Block(inner) => repair_block(inner, function, pointees),
            Statement::If { condition: _, accept, reject } => {
                repair_block(accept, function, pointees);
                repair_block(reject, function, pointees);
            }
            Statement::Loop { body, continuing, break_if: _ } => {
                repair_block(body, function, pointees);
                repair_block(continuing, function, pointees);
            }
            Statement::Switch { selector: _, cases } => {
                for case in cases {
                    repair_block(&mut case.body, function, pointees);
                    case.fall_through &= !never_ends(&case.body);
                }
            }
            Statement::Call { function: callee, arguments, result: _ } => {
                let pointees = pointees.get(callee.index()).map_or(&[][..], Vec::as_slice);
                copy_arguments(arguments, pointees, function, span, (block, &mut after));
            }
            _ => {}
        }
        block.push(statement, span);
        block.extend_block(after);
    }
}

/// Whether control never reaches the end of a block.
fn never_ends(block: &Block) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Return { value: _ }
        | Statement::Kill
        | Statement::Break
        | Statement::Continue => true,
        Statement::Block(inner) => never_ends(inner),
        Statement::If { condition: _, accept, reject } => never_ends(accept) && never_ends(reject),
        _ => false,
    })
}

/// Replaces the arguments that are parts of variables, or a variable that is given twice, by local
/// variables. They are written before the call and read after it.
fn copy_arguments(
    arguments: &mut [Handle<Expression>],
    pointees: &[Option<Handle<Type>>],
    function: &mut Function,
    span: Span,
    (before, after): (&mut Block, &mut Block),
) {
    let roots: Vec<_> = arguments.iter().map(|argument| root_of(function, *argument)).collect();
    for (index, argument) in arguments.iter_mut().enumerate() {
        let Some(ty) = pointees.get(index).copied().flatten() else { continue };
        let is_pointer = |other: usize| pointees.get(other).copied().flatten().is_some();
        let is_given_twice = (0..roots.len())
            .any(|other| other != index && is_pointer(other) && roots[other] == roots[index]);
        if roots[index] == *argument && !is_given_twice {
            continue;
        }
        let local = LocalVariable { name: None, ty, init: None };
        let local = function.local_variables.append(local, span);
        let copy = function.expressions.append(Expression::LocalVariable(local), span);
        move_value(function, *argument, copy, span, before);
        move_value(function, copy, *argument, span, after);
        *argument = copy;
    }
}

/// The variable or parameter that a pointer points into. Each has one expression in naga's GLSL.
fn root_of(function: &Function, mut pointer: Handle<Expression>) -> Handle<Expression> {
    while let Expression::Access { base, index: _ } | Expression::AccessIndex { base, index: _ } =
        function.expressions[pointer]
    {
        pointer = base;
    }
    pointer
}

fn move_value(
    function: &mut Function,
    from: Handle<Expression>,
    to: Handle<Expression>,
    span: Span,
    block: &mut Block,
) {
    let value = function.expressions.append(Expression::Load { pointer: from }, span);
    block.push(Statement::Emit(Range::new_from_bounds(value, value)), span);
    block.push(Statement::Store { pointer: to, value }, span);
}

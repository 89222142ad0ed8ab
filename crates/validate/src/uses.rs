//! Where types are used. Those without a name have no place of their own.

use naga::{Expression, Function, Handle, Module, Scalar, Span, Type, TypeInner};

/// All functions of a module, those of its entry points last.
pub fn functions(module: &Module) -> impl Iterator<Item = &Function> {
    let points = module.entry_points.iter().map(|point| &point.function);
    module.functions.iter().map(|(_, function)| function).chain(points)
}

/// Whether an expression is a number of a type, or a conversion to it.
pub fn makes_scalar(expression: &Expression, scalar: Scalar) -> bool {
    match expression {
        Expression::As { expr: _, kind, convert } => {
            *kind == scalar.kind && *convert == Some(scalar.width)
        }
        Expression::Literal(literal) => literal.scalar() == scalar,
        _ => false,
    }
}

/// The place of the first variable, parameter, member or value that has one of some types.
pub fn first_use(module: &Module, is_it: &dyn Fn(Handle<Type>) -> bool) -> Span {
    let in_functions = functions(module).flat_map(|function| {
        let locals = function.local_variables.iter().filter(|(_, local)| is_it(local.ty));
        let made = function.expressions.iter().filter(|(_, one)| match one {
            Expression::Compose { ty, components: _ } | Expression::ZeroValue(ty) => is_it(*ty),
            _ => false,
        });
        let locals = locals.map(|(handle, _)| function.local_variables.get_span(handle));
        locals.chain(made.map(|(handle, _)| function.expressions.get_span(handle)))
    });
    let globals = module.global_variables.iter().filter(|(_, global)| is_it(global.ty));
    let globals = globals.map(|(handle, _)| module.global_variables.get_span(handle));
    let holders = module.types.iter().filter(|(_, one)| match &one.inner {
        TypeInner::Struct { members, span: _ } => members.iter().any(|member| is_it(member.ty)),
        _ => false,
    });
    let holders = holders.map(|(handle, _)| module.types.get_span(handle));
    let mut all = globals.chain(holders).chain(in_functions);
    all.find(Span::is_defined).unwrap_or_default()
}

/// The place of the first conversion to a scalar, or of the first value that is one.
pub fn first_scalar(module: &Module, scalar: Scalar) -> Span {
    let has = |ty: Handle<Type>| module.types[ty].inner.scalar() == Some(scalar);
    let declared = first_use(module, &has);
    if declared.is_defined() {
        return declared;
    }
    let found = functions(module).find_map(|function| {
        let mut all = function.expressions.iter();
        all.find(|(_, one)| makes_scalar(one, scalar))
            .map(|(at, _)| function.expressions.get_span(at))
    });
    found.unwrap_or_default()
}

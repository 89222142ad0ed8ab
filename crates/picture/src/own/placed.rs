//! A vertex stage of an author's, whose positions can be moved.
//!
//! Samples of a pixel are frames that are moved by a part of a pixel, and pictures of shaders for
//! OpenGL are drawn upside down. Both are a matrix that the clip position is multiplied with. So the
//! entry point becomes a function, and another one takes its place that calls it.

use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_execute::kernel::FunctionBody;
use lamplight_validate::{Validated, info_for_some};
use naga::{
    AddressSpace, Binding, BuiltIn, Expression, Function, GlobalVariable, Handle,
    MemoryDecorations, Module, ResourceBinding, Scalar, Span, Statement, StructMember, Type,
    TypeInner, VectorSize,
};

/// The name of the buffer, whose only member is the matrix `clip_from_world`.
pub const PLACE: &str = "camera";

/// The stage with positions that are multiplied with the matrix at a group and binding. The module
/// has one entry point.
///
/// # Errors
/// `naga-internal` where naga refuses the result.
pub fn placed_vertex(stage: &Validated, place: (u32, u32)) -> Result<Validated, Diagnostic> {
    let mut module = stage.module.clone();
    let matrix = place_buffer(&mut module, place);
    replace_entry(&mut module, matrix).ok_or_else(|| internal("it has no position"))?;
    let info = info_for_some(&module).map_err(|error| internal(&error.to_string()))?;
    Ok(Validated { module, info, portable: stage.portable })
}

fn internal(message: &str) -> Diagnostic {
    let message = format!("the vertex stage cannot be placed: {message}");
    Diagnostic::error(codes::NAGA_INTERNAL, message)
}

fn matrix_type(module: &mut Module) -> Handle<Type> {
    let inner = TypeInner::Matrix {
        columns: VectorSize::Quad,
        rows: VectorSize::Quad,
        scalar: Scalar::F32,
    };
    module.types.insert(Type { name: None, inner }, Span::UNDEFINED)
}

/// Declares the buffer with the matrix.
fn place_buffer(module: &mut Module, (group, binding): (u32, u32)) -> Handle<GlobalVariable> {
    let ty = matrix_type(module);
    let name = Some("clip_from_world".to_owned());
    let members = vec![StructMember { name, ty, binding: None, offset: 0 }];
    let name = Some("LamplightPlace".to_owned());
    let ty = Type { name, inner: TypeInner::Struct { members, span: 64 } };
    let ty = module.types.insert(ty, Span::UNDEFINED);
    let variable = GlobalVariable {
        name: Some(PLACE.to_owned()),
        space: AddressSpace::Uniform,
        binding: Some(ResourceBinding { group, binding }),
        ty,
        init: None,
        memory_decorations: MemoryDecorations::empty(),
    };
    module.global_variables.append(variable, Span::UNDEFINED)
}

/// Puts an entry point that calls the author's in its place.
fn replace_entry(module: &mut Module, matrix: Handle<GlobalVariable>) -> Option<()> {
    let mut inner = module.entry_points.first()?.function.clone();
    let (arguments, result) = (inner.arguments.clone(), inner.result.clone()?);
    inner.result.as_mut()?.binding = None;
    inner.arguments.iter_mut().for_each(|argument| argument.binding = None);
    inner.name = Some("lamplight_inner".to_owned());
    let inner = module.functions.append(inner, Span::UNDEFINED);
    let members = match &module.types[result.ty].inner {
        TypeInner::Struct { members, span: _ } => Some(members.clone()),
        _ => None,
    };
    let function = Function { arguments, result: Some(result.clone()), ..Function::default() };
    let mut body = FunctionBody { module, function };
    let returned = call(&mut body, inner);
    let value = match members {
        None => moved(&mut body, returned, matrix),
        Some(members) => {
            let is_position = |member: &StructMember| {
                matches!(member.binding, Some(Binding::BuiltIn(BuiltIn::Position { invariant: _ })))
            };
            let at = members.iter().position(is_position)?;
            let mut parts: Vec<_> =
                (0..members.len() as u32).map(|index| body.component(returned, index)).collect();
            parts[at] = moved(&mut body, parts[at], matrix);
            body.add(Expression::Compose { ty: result.ty, components: parts })
        }
    };
    body.function.body.push(Statement::Return { value: Some(value) }, Span::UNDEFINED);
    let function = body.function;
    module.entry_points.first_mut()?.function = function;
    Some(())
}

fn call(body: &mut FunctionBody<'_>, function: Handle<Function>) -> Handle<Expression> {
    let arguments: Vec<_> = (0..body.function.arguments.len() as u32)
        .map(|index| body.add(Expression::FunctionArgument(index)))
        .collect();
    let result =
        body.function.expressions.append(Expression::CallResult(function), Span::UNDEFINED);
    let call = Statement::Call { function, arguments, result: Some(result) };
    body.function.body.push(call, Span::UNDEFINED);
    result
}

fn moved(
    body: &mut FunctionBody<'_>,
    position: Handle<Expression>,
    matrix: Handle<GlobalVariable>,
) -> Handle<Expression> {
    let buffer = body.add(Expression::GlobalVariable(matrix));
    let pointer = body.component(buffer, 0);
    let matrix = body.add(Expression::Load { pointer });
    body.binary(naga::BinaryOperator::Multiply, matrix, position)
}

//! Refuses values with atomics in them. WGSL has none: only atomic functions read and write atomics.
//! naga copies a structure or an array with atomics as any other, stops where it writes that as
//! HLSL, and writes MSL that is not valid.

use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{
    AddressSpace, Expression, Function, FunctionArgument, Handle, Module, Span, Type, TypeInner,
};

use lamplight_compose::Composed;
use lamplight_diagnostic::{Diagnostic, codes};

/// Refuses loads of structures and arrays that have atomics in them.
pub fn refuse_atomic_values(
    composed: &Composed,
    module: &Module,
    info: &ModuleInfo,
) -> Result<(), Diagnostic> {
    if let Some(span) = misplaced_pointer(module) {
        let message = "only buffers and workgroup memory have atomics";
        return Err(described(composed, Diagnostic::error(codes::WGSL_ERROR, message), span));
    }
    if !has_inner_atomics(module) {
        return Ok(());
    }
    let functions = module.functions.iter().map(|(handle, function)| (function, &info[handle]));
    let points = module.entry_points.iter().enumerate();
    let points = points.map(|(index, point)| (&point.function, info.get_entry_point(index)));
    let found = functions.chain(points).find_map(|(function, info)| first(module, function, info));
    match found {
        None => Ok(()),
        Some(span) => Err(describe(composed, span)),
    }
}

/// Whether a module may have what is refused here.
pub fn may_be_refused(module: &Module) -> bool {
    has_inner_atomics(module) || misplaced_pointer(module).is_some()
}

/// Whether a structure or an array of a module has an atomic in it.
fn has_inner_atomics(module: &Module) -> bool {
    module.types.iter().any(|(handle, ty)| match ty.inner {
        TypeInner::Struct { members: _, span: _ }
        | TypeInner::Array { base: _, size: _, stride: _ } => has_atomic(module, handle),
        _ => false,
    })
}

fn has_atomic(module: &Module, ty: Handle<Type>) -> bool {
    match &module.types[ty].inner {
        TypeInner::Atomic(_) => true,
        TypeInner::Array { base, size: _, stride: _ } => has_atomic(module, *base),
        TypeInner::Struct { members, span: _ } => {
            members.iter().any(|member| has_atomic(module, member.ty))
        }
        _ => false,
    }
}

/// The first load of a structure or an array with an atomic in it. `atomicLoad` loads the atomic
/// alone.
fn first(module: &Module, function: &Function, info: &FunctionInfo) -> Option<Span> {
    let is_load = |expression: &Expression| {
        let Expression::Load { pointer } = expression else { return false };
        match *info[*pointer].ty.inner_with(&module.types) {
            TypeInner::Pointer { base, space: _ } => {
                !matches!(module.types[base].inner, TypeInner::Atomic(_))
                    && has_atomic(module, base)
            }
            _ => false,
        }
    };
    let mut all = function.expressions.iter();
    all.find(|(_, one)| is_load(one)).map(|(at, _)| function.expressions.get_span(at))
}

/// The first function with a pointer to an atomic where no atomic can be.
fn misplaced_pointer(module: &Module) -> Option<Span> {
    let is_misplaced = |argument: &FunctionArgument| match module.types[argument.ty].inner {
        TypeInner::Pointer { base, space: AddressSpace::Private | AddressSpace::Function } => {
            has_atomic(module, base)
        }
        _ => false,
    };
    let mut all = module.functions.iter();
    let found = all.find(|(_, function)| function.arguments.iter().any(is_misplaced));
    found.map(|(handle, _)| module.functions.get_span(handle))
}

fn describe(composed: &Composed, span: Span) -> Diagnostic {
    let message = "only atomic functions read and write atomics";
    let error = Diagnostic::error(codes::WGSL_ERROR, message)
        .note("help: read each atomic in it with `atomicLoad`");
    described(composed, error, span)
}

fn described(composed: &Composed, error: Diagnostic, span: Span) -> Diagnostic {
    match span.to_range().and_then(|range| composed.map.lookup(range)) {
        Some(span) => error.at(span, "atomics are not for this"),
        None => error,
    }
}

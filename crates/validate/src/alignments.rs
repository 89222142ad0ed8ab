//! Refuses members that lie elsewhere than WGSL says, since naga forgets an `@align` within their
//! types: a structure that has one is aligned to it wherever it is a member ("Alignment and Size" in
//! the specification), and naga aligns it to its types alone.

use naga::{AddressSpace, Handle, Module, Type, TypeInner};

use lamplight_compose::Composed;
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_rules::{NestedAlignment, nested_alignments};

/// Refuses the first such member of a module. It needs a large stack.
pub fn refuse_lost_alignments(composed: &Composed, module: &Module) -> Result<(), Diagnostic> {
    let Some(lost) = first_lost(&composed.text, module) else { return Ok(()) };
    let NestedAlignment { structure: _, member: _, name, place, alignment } = lost;
    let message = format!(
        "`{name}` would not lie at a multiple of {alignment}, which an `@align` within its type asks \
         for"
    );
    let error = Diagnostic::error(codes::NOT_PORTABLE, message)
        .note(format!("help: write it at the member too: `@align({alignment}) {name}`"));
    Err(match composed.map.lookup(place.range()) {
        Some(span) => error.at(span, "this member"),
        None => error,
    })
}

/// Whether a text in WGSL, which naga read as the module, has such a member. It needs a large stack.
pub fn has_lost_alignments(text: &str, module: &Module) -> bool {
    first_lost(text, module).is_some()
}

fn first_lost(text: &str, module: &Module) -> Option<NestedAlignment> {
    nested_alignments(text).into_iter().find(|nested| is_lost(nested, module))
}

/// Whether naga has put a member, or the end of its structure, where the alignment does not allow it.
fn is_lost(nested: &NestedAlignment, module: &Module) -> bool {
    let NestedAlignment { structure, member, name: _, place: _, alignment } = nested;
    let is_off = |at: u32| !at.is_multiple_of(*alignment);
    module.types.iter().any(|(handle, ty)| match &ty.inner {
        TypeInner::Struct { members, span } if ty.name.as_deref() == Some(structure) => {
            let is_moved = members.get(*member).is_some_and(|found| is_off(found.offset));
            (is_moved || is_off(*span)) && is_in_buffer(module, handle)
        }
        _ => false,
    })
}

/// Whether a buffer has values of a type. Elsewhere, nobody knows where members lie.
fn is_in_buffer(module: &Module, wanted: Handle<Type>) -> bool {
    module.global_variables.iter().any(|(_, variable)| {
        matches!(
            variable.space,
            AddressSpace::Uniform | AddressSpace::Immediate | AddressSpace::Storage { access: _ }
        ) && has_type(module, variable.ty, wanted)
    })
}

fn has_type(module: &Module, ty: Handle<Type>, wanted: Handle<Type>) -> bool {
    ty == wanted
        || match &module.types[ty].inner {
            TypeInner::Array { base, size: _, stride: _ }
            | TypeInner::BindingArray { base, size: _ } => has_type(module, *base, wanted),
            TypeInner::Struct { members, span: _ } => {
                members.iter().any(|member| has_type(module, member.ty, wanted))
            }
            _ => false,
        }
}

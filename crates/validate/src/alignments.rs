//! Refuses members that lie elsewhere than WGSL says, since naga forgets an `@align` within their
//! types: a structure that has one is aligned to it wherever it is a member ("Alignment and Size" in
//! the specification), and naga aligns it to its types alone.

use naga::{Module, TypeInner};

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
    module.types.iter().any(|(_, ty)| match &ty.inner {
        TypeInner::Struct { members, span } if ty.name.as_deref() == Some(structure) => {
            let is_off = |at: u32| !at.is_multiple_of(*alignment);
            members.get(*member).is_some_and(|found| is_off(found.offset)) || is_off(*span)
        }
        _ => false,
    })
}

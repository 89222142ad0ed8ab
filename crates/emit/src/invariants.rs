//! `@invariant` at the position that a fragment shader gets. It has no effect there, GLSL refuses the
//! word, and Metal has it from version 2.1.

use naga::{Binding, BuiltIn, FunctionArgument, Module, ShaderStage, Type, TypeInner};

/// The module without the word at inputs; `None` where it has none.
pub fn without_invariant_inputs(module: &Module) -> Option<Module> {
    let is_fragment = |stage: ShaderStage| stage == ShaderStage::Fragment;
    let mut changed = None;
    for (index, point) in module.entry_points.iter().enumerate() {
        if !is_fragment(point.stage) {
            continue;
        }
        for (at, FunctionArgument { name: _, ty, binding }) in
            point.function.arguments.iter().enumerate()
        {
            if is_invariant(binding.as_ref()) {
                let copy = changed.get_or_insert_with(|| module.clone());
                copy.entry_points[index].function.arguments[at].binding = Some(PLAIN);
            }
            let Type { name, inner: TypeInner::Struct { members, span } } = &module.types[*ty]
            else {
                continue;
            };
            if !members.iter().any(|member| is_invariant(member.binding.as_ref())) {
                continue;
            }
            let mut members = members.clone();
            for member in &mut members {
                if is_invariant(member.binding.as_ref()) {
                    member.binding = Some(PLAIN);
                }
            }
            let copy = changed.get_or_insert_with(|| module.clone());
            let inner = TypeInner::Struct { members, span: *span };
            copy.types.replace(*ty, Type { name: name.clone(), inner });
        }
    }
    changed
}

const PLAIN: Binding = Binding::BuiltIn(BuiltIn::Position { invariant: false });

fn is_invariant(binding: Option<&Binding>) -> bool {
    matches!(binding, Some(Binding::BuiltIn(BuiltIn::Position { invariant: true })))
}

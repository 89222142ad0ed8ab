//! `@invariant` at the position that a fragment shader gets. It has no effect there, GLSL refuses the
//! word, and Metal has it from version 2.1.

use naga::{
    Binding, BuiltIn, FunctionArgument, Handle, Module, ShaderStage, Type, TypeInner, UniqueArena,
};

/// The module without the word at inputs, to write a stage of it; `None` where there is nothing to
/// change. A vertex shader may return the same structure, and keeps the word.
pub fn without_invariant_inputs(module: &Module, stage: ShaderStage) -> Option<Module> {
    let points = module.entry_points.iter().filter(|point| point.stage == stage);
    let mut inputs = points.flat_map(|point| &point.function.arguments);
    let is_in = |argument: &FunctionArgument| match &module.types[argument.ty].inner {
        TypeInner::Struct { members, span: _ } => {
            members.iter().any(|member| is_invariant(&member.binding))
        }
        _ => is_invariant(&argument.binding),
    };
    let has_some = stage == ShaderStage::Fragment && inputs.any(is_in);
    has_some.then(|| {
        let mut changed = module.clone();
        for point in changed.entry_points.iter_mut().filter(|point| point.stage == stage) {
            for argument in &mut point.function.arguments {
                make_plain(&mut argument.binding);
                replace_members(&mut changed.types, argument.ty);
            }
        }
        changed
    })
}

fn replace_members(types: &mut UniqueArena<Type>, ty: Handle<Type>) {
    let Type { name, mut inner } = types[ty].clone();
    if let TypeInner::Struct { members, span: _ } = &mut inner {
        members.iter_mut().for_each(|member| make_plain(&mut member.binding));
        types.replace(ty, Type { name, inner });
    }
}

fn make_plain(binding: &mut Option<Binding>) {
    if is_invariant(binding) {
        *binding = Some(Binding::BuiltIn(BuiltIn::Position { invariant: false }));
    }
}

fn is_invariant(binding: &Option<Binding>) -> bool {
    matches!(binding, Some(Binding::BuiltIn(BuiltIn::Position { invariant: true })))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_lose_the_word_and_outputs_keep_it() {
        let module = naga::front::wgsl::parse_str(
            "struct P { @builtin(position) @invariant place: vec4f }
             @vertex fn v() -> P { return P(vec4f(1.0)); }
             @fragment fn f(p: P) {}
             @fragment fn g(@builtin(position) @invariant place: vec4f) {}",
        )
        .unwrap();
        let words = |module: &Module| {
            let of_types = module.types.iter().filter(|(_, one)| match &one.inner {
                TypeInner::Struct { members, span: _ } => is_invariant(&members[0].binding),
                _ => false,
            });
            let of_g = &module.entry_points[2].function.arguments[0].binding;
            (of_types.count(), is_invariant(of_g))
        };
        assert_eq!(words(&module), (1, true));
        let written = without_invariant_inputs(&module, ShaderStage::Fragment).unwrap();
        assert_eq!(words(&written), (0, false));
        assert!(without_invariant_inputs(&module, ShaderStage::Vertex).is_none());
    }
}

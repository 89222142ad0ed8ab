//! Whether a fragment stage decides itself which fragments are visible.

use naga::{Binding, Block, BuiltIn, FunctionResult, Module, ShaderStage, Statement, TypeInner};

use lamplight_emit::blocks::inner_blocks;

/// Whether the fragment stage of a module may discard a fragment, or writes its depth.
pub fn is_decided_by(module: &Module) -> bool {
    let stages = || module.entry_points.iter().filter(|one| one.stage == ShaderStage::Fragment);
    let bodies = module.functions.iter().map(|(_, function)| &function.body);
    bodies.chain(stages().map(|one| &one.function.body)).any(discards)
        || stages().any(|one| {
            one.function.result.as_ref().is_some_and(|result| writes_depth(module, result))
        })
}

fn discards(block: &Block) -> bool {
    block.iter().any(|statement| {
        matches!(statement, Statement::Kill) || inner_blocks(statement).into_iter().any(discards)
    })
}

fn writes_depth(module: &Module, result: &FunctionResult) -> bool {
    let is_depth =
        |binding: &Option<Binding>| matches!(binding, Some(Binding::BuiltIn(BuiltIn::FragDepth)));
    let members = match &module.types[result.ty].inner {
        TypeInner::Struct { members, .. } => members.as_slice(),
        _ => &[],
    };
    is_depth(&result.binding) || members.iter().any(|member| is_depth(&member.binding))
}

//! What only some stages can do: naga says that an entry point does something of the kind, this finds
//! what and where.

use std::collections::BTreeSet;

use naga::{
    Block, Expression, Function, Handle, Module, SampleLevel, ShaderStage, Span, Statement,
};

use crate::operands::inner_blocks;

/// What a function does that its stage cannot: its place, and a sentence.
pub type Forbidden = (Span, &'static str);

/// The first thing that the function of an entry point, or one that it calls, cannot do in a stage.
pub fn forbidden_operation(
    module: &Module,
    function: &Function,
    stage: ShaderStage,
) -> Option<Forbidden> {
    let mut seen = BTreeSet::new();
    let mut open = vec![function];
    while let Some(function) = open.pop() {
        let found =
            of_statements(&function.body, stage).or_else(|| of_expressions(function, stage));
        if found.is_some() {
            return found;
        }
        let mut called = Vec::new();
        calls(&function.body, &mut called);
        let new = called.into_iter().filter(|handle| seen.insert(*handle));
        open.extend(new.map(|handle| &module.functions[handle]));
    }
    None
}

fn of_statements(block: &Block, stage: ShaderStage) -> Option<Forbidden> {
    let is_fragment = stage == ShaderStage::Fragment;
    block.span_iter().find_map(|(statement, span)| {
        let sentence = match statement {
            Statement::Kill if !is_fragment => Some("`discard` is for fragment shaders"),
            Statement::ControlBarrier(_) | Statement::MemoryBarrier(_)
                if stage != ShaderStage::Compute =>
            {
                Some("barriers are for compute shaders")
            }
            Statement::WorkGroupUniformLoad { .. } if stage != ShaderStage::Compute => {
                Some("`workgroupUniformLoad` is for compute shaders")
            }
            _ => None,
        };
        let own = sentence.map(|sentence| (*span, sentence));
        let inner =
            || inner_blocks(statement).into_iter().find_map(|inner| of_statements(inner, stage));
        own.or_else(inner)
    })
}

/// Other stages have no neighbouring fragments, whose differences are the derivatives.
fn of_expressions(function: &Function, stage: ShaderStage) -> Option<Forbidden> {
    if stage == ShaderStage::Fragment {
        return None;
    }
    function.expressions.iter().find_map(|(handle, expression)| {
        let sentence = match expression {
            Expression::Derivative { .. } => "derivatives are for fragment shaders",
            Expression::ImageSample { level: SampleLevel::Auto | SampleLevel::Bias(_), .. } => {
                "sampling without a level is for fragment shaders: `textureSampleLevel` has one"
            }
            _ => return None,
        };
        Some((function.expressions.get_span(handle), sentence))
    })
}

fn calls(block: &Block, called: &mut Vec<Handle<Function>>) {
    for statement in block {
        if let Statement::Call { function, .. } = statement {
            called.push(*function);
        }
        inner_blocks(statement).into_iter().for_each(|inner| calls(inner, called));
    }
}

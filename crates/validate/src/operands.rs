//! What naga's expressions and statements refer to.
//!
//! Every field is listed, without `..`: a field that a new version of naga adds does not compile
//! here until somebody has read what it means.

use naga::{
    AtomicFunction, CooperativeData, Expression, GatherMode, Handle, ImageQuery,
    RayPipelineFunction, RayQueryFunction, SampleLevel, Statement,
};

type Change<'c> = &'c mut dyn FnMut(&mut Handle<Expression>);

/// Changes each expression that an expression is computed from.
pub fn change_operands(expression: &mut Expression, change: Change<'_>) {
    use Expression as E;
    match expression {
        E::Literal(_)
        | E::Constant(_)
        | E::Override(_)
        | E::ZeroValue(_)
        | E::FunctionArgument(_)
        | E::GlobalVariable(_)
        | E::LocalVariable(_)
        | E::CallResult(_)
        | E::AtomicResult { ty: _, comparison: _ }
        | E::WorkGroupUniformLoadResult { ty: _ }
        | E::RayQueryProceedResult
        | E::SubgroupBallotResult
        | E::SubgroupOperationResult { ty: _ } => {}
        E::Compose { ty: _, components } => components.iter_mut().for_each(change),
        E::Access { base, index } => [base, index].into_iter().for_each(change),
        E::AccessIndex { base, index: _ } => change(base),
        E::Splat { size: _, value } => change(value),
        E::Swizzle { size: _, vector, pattern: _ } => change(vector),
        E::Load { pointer } => change(pointer),
        E::ImageSample { .. } | E::ImageLoad { .. } | E::ImageQuery { .. } => {
            change_image_operands(expression, change);
        }
        E::Unary { op: _, expr }
        | E::Derivative { axis: _, ctrl: _, expr }
        | E::As { expr, kind: _, convert: _ } => change(expr),
        E::Binary { op: _, left, right } => [left, right].into_iter().for_each(change),
        E::Select { condition, accept, reject } => {
            [condition, accept, reject].into_iter().for_each(change);
        }
        E::Relational { fun: _, argument } => change(argument),
        E::Math { fun: _, arg, arg1, arg2, arg3 } => {
            change(arg);
            [arg1, arg2, arg3].into_iter().flatten().for_each(change);
        }
        E::ArrayLength(array) => change(array),
        E::RayQueryVertexPositions { query, committed: _ }
        | E::RayQueryGetIntersection { query, committed: _ } => change(query),
        E::CooperativeLoad { columns: _, rows: _, role: _, data } => {
            change_cooperative(data, change);
        }
        E::CooperativeMultiplyAdd { a, b, c } => [a, b, c].into_iter().for_each(change),
    }
}

fn change_image_operands(expression: &mut Expression, change: Change<'_>) {
    match expression {
        Expression::ImageSample {
            image,
            sampler,
            gather: _,
            coordinate,
            array_index,
            offset,
            level,
            depth_ref,
            clamp_to_edge: _,
        } => {
            [image, sampler, coordinate].into_iter().for_each(&mut *change);
            [array_index, offset, depth_ref].into_iter().flatten().for_each(&mut *change);
            match level {
                SampleLevel::Auto | SampleLevel::Zero => {}
                SampleLevel::Exact(level) | SampleLevel::Bias(level) => change(level),
                SampleLevel::Gradient { x, y } => [x, y].into_iter().for_each(change),
            }
        }
        Expression::ImageLoad { image, coordinate, array_index, sample, level } => {
            [image, coordinate].into_iter().for_each(&mut *change);
            [array_index, sample, level].into_iter().flatten().for_each(change);
        }
        Expression::ImageQuery { image, query } => {
            change(image);
            match query {
                ImageQuery::Size { level } => level.iter_mut().for_each(change),
                ImageQuery::NumLevels | ImageQuery::NumLayers | ImageQuery::NumSamples => {}
            }
        }
        _ => {}
    }
}

fn change_cooperative(data: &mut CooperativeData, change: Change<'_>) {
    let CooperativeData { pointer, stride, row_major: _ } = data;
    [pointer, stride].into_iter().for_each(change);
}

/// The expressions that an expression is computed from.
pub fn operands(expression: &Expression) -> Vec<Handle<Expression>> {
    let mut found = Vec::new();
    change_operands(&mut expression.clone(), &mut |operand| found.push(*operand));
    found
}

/// Changes each expression that a statement itself uses; those of the blocks within it, and what it
/// emits, are left alone.
pub fn change_used(statement: &mut Statement, change: Change<'_>) {
    use Statement as S;
    match statement {
        S::Emit(_)
        | S::Block(_)
        | S::Break
        | S::Continue
        | S::Kill
        | S::ControlBarrier(_)
        | S::MemoryBarrier(_) => {}
        S::If { condition, accept: _, reject: _ } => change(condition),
        S::Switch { selector, cases: _ } => change(selector),
        S::Loop { body: _, continuing: _, break_if } => break_if.iter_mut().for_each(change),
        S::Return { value } => value.iter_mut().for_each(change),
        S::Store { pointer, value } => [pointer, value].into_iter().for_each(change),
        S::Atomic { .. } | S::ImageStore { .. } | S::ImageAtomic { .. } => {
            change_used_in_memory(statement, change);
        }
        S::WorkGroupUniformLoad { pointer, result: _ } => change(pointer),
        S::Call { function: _, arguments, result: _ } => arguments.iter_mut().for_each(change),
        S::RayQuery { query, fun } => {
            change(query);
            change_queried(fun, change);
        }
        S::RayPipelineFunction(RayPipelineFunction::TraceRay {
            acceleration_structure,
            descriptor,
            payload,
        }) => [acceleration_structure, descriptor, payload].into_iter().for_each(change),
        S::SubgroupBallot { result: _, predicate } => predicate.iter_mut().for_each(change),
        S::SubgroupGather { mode, argument, result: _ } => {
            change(argument);
            change_gathered(mode, change);
        }
        S::SubgroupCollectiveOperation { op: _, collective_op: _, argument, result: _ } => {
            change(argument);
        }
        S::CooperativeStore { target, data } => {
            change(target);
            change_cooperative(data, change);
        }
    }
}

fn change_used_in_memory(statement: &mut Statement, change: Change<'_>) {
    let function = match statement {
        Statement::Atomic { pointer, fun, value, result: _ } => {
            [pointer, value].into_iter().for_each(&mut *change);
            fun
        }
        Statement::ImageAtomic { image, coordinate, array_index, fun, value } => {
            [image, coordinate, value].into_iter().for_each(&mut *change);
            array_index.iter_mut().for_each(&mut *change);
            fun
        }
        Statement::ImageStore { image, coordinate, array_index, value } => {
            [image, coordinate, value].into_iter().for_each(&mut *change);
            return array_index.iter_mut().for_each(change);
        }
        _ => return,
    };
    if let AtomicFunction::Exchange { compare } = function {
        compare.iter_mut().for_each(change);
    }
}

fn change_queried(function: &mut RayQueryFunction, change: Change<'_>) {
    match function {
        RayQueryFunction::Initialize { acceleration_structure, descriptor } => {
            [acceleration_structure, descriptor].into_iter().for_each(change);
        }
        RayQueryFunction::GenerateIntersection { hit_t } => change(hit_t),
        RayQueryFunction::Proceed { result: _ }
        | RayQueryFunction::ConfirmIntersection
        | RayQueryFunction::Terminate => {}
    }
}

/// Changes the invocation that values are gathered from.
pub fn change_gathered(mode: &mut GatherMode, change: Change<'_>) {
    match mode {
        GatherMode::BroadcastFirst | GatherMode::QuadSwap(_) => {}
        GatherMode::Broadcast(lane)
        | GatherMode::Shuffle(lane)
        | GatherMode::ShuffleDown(lane)
        | GatherMode::ShuffleUp(lane)
        | GatherMode::ShuffleXor(lane)
        | GatherMode::QuadBroadcast(lane) => change(lane),
    }
}

/// The expressions that a statement itself uses.
pub fn used(statement: &Statement) -> Vec<Handle<Expression>> {
    let mut found = Vec::new();
    change_used(&mut statement.clone(), &mut |operand| found.push(*operand));
    found
}

/// The expression that stands for the result of a statement, to be changed.
pub fn result_mut(statement: &mut Statement) -> Option<&mut Handle<Expression>> {
    use Statement as S;
    match statement {
        S::Call { function: _, arguments: _, result } => result.as_mut(),
        S::Atomic { pointer: _, fun: _, value: _, result } => result.as_mut(),
        S::WorkGroupUniformLoad { pointer: _, result }
        | S::SubgroupBallot { result, predicate: _ }
        | S::SubgroupGather { mode: _, argument: _, result }
        | S::SubgroupCollectiveOperation { op: _, collective_op: _, argument: _, result }
        | S::RayQuery { query: _, fun: RayQueryFunction::Proceed { result } } => Some(result),
        S::RayQuery { query: _, fun: _ }
        | S::Emit(_)
        | S::Block(_)
        | S::If { condition: _, accept: _, reject: _ }
        | S::Switch { selector: _, cases: _ }
        | S::Loop { body: _, continuing: _, break_if: _ }
        | S::Break
        | S::Continue
        | S::Return { value: _ }
        | S::Kill
        | S::ControlBarrier(_)
        | S::MemoryBarrier(_)
        | S::Store { pointer: _, value: _ }
        | S::ImageStore { image: _, coordinate: _, array_index: _, value: _ }
        | S::ImageAtomic { image: _, coordinate: _, array_index: _, fun: _, value: _ }
        | S::RayPipelineFunction(_)
        | S::CooperativeStore { target: _, data: _ } => None,
    }
}

/// The expressions that a block computes, those of the blocks within it included.
pub fn computed(block: &naga::Block) -> Vec<Handle<Expression>> {
    let (mut open, mut found) = (vec![block], Vec::new());
    while let Some(block) = open.pop() {
        for statement in block {
            if let Statement::Emit(range) = statement {
                found.extend(range.clone());
            }
            found.extend(result_mut(&mut statement.clone()).map(|result| *result));
            open.extend(inner_blocks(statement));
        }
    }
    found
}

/// The blocks within a statement, in order.
pub fn inner_blocks(statement: &Statement) -> Vec<&naga::Block> {
    match statement {
        Statement::Block(block) => vec![block],
        Statement::If { condition: _, accept, reject } => vec![accept, reject],
        Statement::Switch { selector: _, cases } => cases.iter().map(|case| &case.body).collect(),
        Statement::Loop { body, continuing, break_if: _ } => vec![body, continuing],
        _ => Vec::new(),
    }
}

/// As [`inner_blocks`], to be changed.
pub fn inner_blocks_mut(statement: &mut Statement) -> Vec<&mut naga::Block> {
    match statement {
        Statement::Block(block) => vec![block],
        Statement::If { condition: _, accept, reject } => vec![accept, reject],
        Statement::Switch { selector: _, cases } => {
            cases.iter_mut().map(|case| &mut case.body).collect()
        }
        Statement::Loop { body, continuing, break_if: _ } => vec![body, continuing],
        _ => Vec::new(),
    }
}

//! Replaces expressions of a function by others. naga wants operands before what is computed from
//! them, so all expressions are written again.

use naga::{Arena, Block, Expression, Function, Handle, Range, Span, Statement};

use lamplight_validate::inner_blocks_mut;
use lamplight_validate::{change_operands, change_used, result_mut};

/// Appends what stands for an expression, and returns its value. It gets the old handle, and the
/// expression with new operands.
pub type Replace<'r> = dyn FnMut(Handle<Expression>, Expression, Span, &mut Arena<Expression>) -> Handle<Expression>
    + 'r;

/// The new expressions of an old one: the first, and the last, which has its value.
type Moved = (usize, Handle<Expression>);

/// Writes every expression of a function again.
pub fn rebuild(function: &mut Function, replace: &mut Replace<'_>) {
    let old: Vec<_> = function.expressions.drain().collect();
    let mut expressions = Arena::new();
    let mut moved: Vec<Moved> = Vec::with_capacity(old.len());
    for (handle, mut expression, span) in old {
        change_operands(&mut expression, &mut |operand| *operand = moved[operand.index()].1);
        let first = expressions.len();
        moved.push((first, replace(handle, expression, span, &mut expressions)));
    }
    let named = std::mem::take(&mut function.named_expressions);
    function.named_expressions =
        named.into_iter().map(|(value, name)| (moved[value.index()].1, name)).collect();
    function.expressions = expressions;
    let mut body = std::mem::take(&mut function.body);
    move_block(&mut body, &moved, &function.expressions);
    function.body = body;
    for (_, local) in function.local_variables.iter_mut() {
        let naga::LocalVariable { name: _, ty: _, init } = local;
        init.iter_mut().for_each(|init| *init = moved[init.index()].1);
    }
}

fn move_block(block: &mut Block, moved: &[Moved], expressions: &Arena<Expression>) {
    for (mut statement, span) in std::mem::take(block).span_into_iter() {
        if let Statement::Emit(range) = &statement {
            emit(range.clone(), span, moved, expressions, block);
            continue;
        }
        change_used(&mut statement, &mut |value| *value = moved[value.index()].1);
        if let Some(result) = result_mut(&mut statement) {
            *result = moved[result.index()].1;
        }
        for inner in inner_blocks_mut(&mut statement) {
            move_block(inner, moved, expressions);
        }
        block.push(statement, span);
    }
}

/// Emits all that stands for some expressions, but for what is never emitted, such as literals.
fn emit(
    range: Range<Expression>,
    span: Span,
    moved: &[Moved],
    expressions: &Arena<Expression>,
    block: &mut Block,
) {
    let ends = |old: Handle<Expression>| moved[old.index()];
    let mut all = range.map(ends);
    let Some((first, mut last)) = all.next() else { return };
    if let Some((_, value)) = all.last() {
        last = value;
    }
    let mut run: Option<(Handle<Expression>, Handle<Expression>)> = None;
    let new = expressions.iter().skip(first).take(last.index() + 1 - first);
    for (handle, expression) in new {
        if !expression.needs_pre_emit() {
            run = Some((run.map_or(handle, |(first, _)| first), handle));
        } else if let Some((first, last)) = run.take() {
            block.push(Statement::Emit(Range::new_from_bounds(first, last)), span);
        }
    }
    if let Some((first, last)) = run {
        block.push(Statement::Emit(Range::new_from_bounds(first, last)), span);
    }
}

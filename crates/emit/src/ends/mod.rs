//! Loops that end under [`BoundsChecks::Restrict`](lamplight_bundle::BoundsChecks).
//!
//! naga's writers can give every loop a counter, or none. Here only those loops get one that
//! [`proof`] cannot show to end by themselves. It counts as naga's counters do: down from 2^64 - 1,
//! in two words.

pub mod proof;

use naga::valid::ModuleInfo;
use naga::{
    BinaryOperator, Block, Expression, Function, Handle, Literal, LocalVariable, Module, Range,
    RelationalFunction, Scalar, Span, Statement, Type, TypeInner, VectorSize,
};

use crate::EmitSource;
use lamplight_validate::{functions, info_unchecked, inner_blocks_mut};
use proof::LoopProofs;

/// The name of a counter, which naga's writers give theirs too.
const COUNTER: &str = "loop_bound";

/// The module with a counter in each loop that is not proved to end, and naga's analysis of it;
/// `None` where it has no such loop, or where loops are not checked.
///
/// # Errors
/// The message of naga, if it refuses the new module.
pub fn with_counters(source: &EmitSource<'_>) -> Result<Option<(Module, ModuleInfo)>, String> {
    if !source.is_restricted() {
        return Ok(None);
    }
    let open: Vec<Vec<bool>> =
        functions(source.module).map(|one| LoopProofs::new(source.module, one).open()).collect();
    if !open.iter().flatten().any(|is_open| *is_open) {
        return Ok(None);
    }
    let mut module = source.module.clone();
    let inner = TypeInner::Vector { size: VectorSize::Bi, scalar: Scalar::U32 };
    let pair = module.types.insert(Type { name: None, inner }, Span::UNDEFINED);
    let points = module.entry_points.iter_mut().map(|point| &mut point.function);
    let all = module.functions.iter_mut().map(|(_, function)| function).chain(points);
    for (function, open) in all.zip(open) {
        if open.contains(&true) {
            let mut body = std::mem::take(&mut function.body);
            count_turns(&mut body, &mut open.into_iter(), &mut Counters { function, pair });
            function.body = body;
        }
    }
    let info = info_unchecked(&module)
        .map_err(|error| format!("a module with counters in loops is not valid: {error}"))?;
    Ok(Some((module, info)))
}

/// Adds counters to loops, in the order of [`proof::loops`].
fn count_turns(
    block: &mut Block,
    is_open: &mut impl Iterator<Item = bool>,
    counters: &mut Counters<'_>,
) {
    for (mut statement, span) in std::mem::take(block).span_into_iter() {
        let is_loop = matches!(statement, Statement::Loop { .. });
        let counter = (is_loop && is_open.next() == Some(true)).then(|| counters.test(span));
        for inner in inner_blocks_mut(&mut statement) {
            count_turns(inner, is_open, counters);
        }
        if let (Some(mut counted), Statement::Loop { body, continuing: _, break_if: _ }) =
            (counter, &mut statement)
        {
            counted.extend_block(std::mem::take(body));
            *body = counted;
        }
        block.push(statement, span);
    }
}

/// Makes counters of a function.
struct Counters<'f> {
    function: &'f mut Function,
    /// The type of a counter.
    pair: Handle<Type>,
}

impl Counters<'_> {
    fn add(&mut self, expression: Expression) -> Handle<Expression> {
        self.function.expressions.append(expression, Span::UNDEFINED)
    }

    fn number(&mut self, value: u32) -> Handle<Expression> {
        self.add(Expression::Literal(Literal::U32(value)))
    }

    fn equal(&mut self, left: Handle<Expression>, right: Handle<Expression>) -> Handle<Expression> {
        self.add(Expression::Binary { op: BinaryOperator::Equal, left, right })
    }

    /// The statements at the beginning of a turn: they leave the loop if both words of a new counter
    /// are zero, and else count.
    fn test(&mut self, span: Span) -> Block {
        let [zero, one, most] = [0, 1, u32::MAX].map(|value| self.number(value));
        let all = Expression::Compose { ty: self.pair, components: vec![most, most] };
        let init = Some(self.add(all));
        let counter = LocalVariable { name: Some(COUNTER.to_owned()), ty: self.pair, init };
        let counter = self.function.local_variables.append(counter, span);
        let pointer = self.add(Expression::LocalVariable(counter));
        let left = self.add(Expression::Load { pointer });
        let zeros = self.add(Expression::Splat { size: VectorSize::Bi, value: zero });
        let argument = self.equal(left, zeros);
        let all = self.add(Expression::Relational { fun: RelationalFunction::All, argument });
        let mut block = Block::new();
        block.push(Statement::Emit(Range::new_from_bounds(left, all)), span);
        let accept = Block::from_vec(vec![Statement::Break]);
        block.push(Statement::If { condition: all, accept, reject: Block::new() }, span);
        // The first word counts down where the second is zero.
        let low = self.add(Expression::AccessIndex { base: left, index: 1 });
        let condition = self.equal(low, zero);
        let high = self.add(Expression::Select { condition, accept: one, reject: zero });
        let right = self.add(Expression::Compose { ty: self.pair, components: vec![high, one] });
        let value = self.add(Expression::Binary { op: BinaryOperator::Subtract, left, right });
        block.push(Statement::Emit(Range::new_from_bounds(low, value)), span);
        block.push(Statement::Store { pointer, value }, span);
        block
    }
}

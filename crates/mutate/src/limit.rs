//! A mistake of its own: a bound on all results of a function, which its formula does not have.

use naga::{
    Block, Expression, Function, Handle, Literal, MathFunction as Math, Module, Range, ScalarKind,
    Span, Statement, TypeInner, VectorSize,
};

use crate::site::{Mutation, Site};
use lamplight_validate::inner_blocks_mut;

/// The bound of all components of all results.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    pub side: Side,
    /// The size, if the result is a vector.
    size: Option<VectorSize>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Side {
    /// At least 0.
    Least,
    /// At most 1.
    Most,
}

/// The bounds that can be put on the results of a function: none if they are no floats.
pub fn limit_sites(module: &Module, handle: Handle<Function>) -> Vec<Site> {
    let function = &module.functions[handle];
    let result = function.result.as_ref().map(|result| &module.types[result.ty].inner);
    let size = match result {
        Some(TypeInner::Scalar(scalar)) if scalar.kind == ScalarKind::Float => None,
        Some(TypeInner::Vector { size, scalar }) if scalar.kind == ScalarKind::Float => Some(*size),
        _ => return Vec::new(),
    };
    let span = module.functions.get_span(handle);
    let site = |side| Site { span, edit: Mutation::Limited(Limit { side, size }) };
    [Side::Least, Side::Most].map(site).to_vec()
}

impl Limit {
    pub fn describe(self) -> String {
        match self.side {
            Side::Least => "results of at least 0".to_owned(),
            Side::Most => "results of at most 1".to_owned(),
        }
    }

    /// Puts the bound before each return.
    pub fn apply(self, function: &mut Function) -> bool {
        let mut body = std::mem::take(&mut function.body);
        self.limit_block(function, &mut body);
        function.body = body;
        true
    }

    fn limit_block(self, function: &mut Function, block: &mut Block) {
        let old = std::mem::take(block);
        for (mut statement, span) in old.span_into_iter() {
            for inner in inner_blocks_mut(&mut statement) {
                self.limit_block(function, inner);
            }
            if let Statement::Return { value: Some(value) } = &mut statement {
                let (emitted, limited) = self.limited(function, *value);
                *value = limited;
                block.push(Statement::Emit(emitted), span);
            }
            block.push(statement, span);
        }
    }

    /// The expressions of the value with the bound, and the last of them.
    fn limited(
        self,
        function: &mut Function,
        value: Handle<Expression>,
    ) -> (Range<Expression>, Handle<Expression>) {
        let (fun, bound) = match self.side {
            Side::Least => (Math::Max, 0.0),
            Side::Most => (Math::Min, 1.0),
        };
        let mut add = |expression| function.expressions.append(expression, Span::UNDEFINED);
        let number = add(Expression::Literal(Literal::F32(bound)));
        let splat = self.size.map(|size| add(Expression::Splat { size, value: number }));
        let bound = splat.unwrap_or(number);
        let limited =
            add(Expression::Math { fun, arg: value, arg1: Some(bound), arg2: None, arg3: None });
        (Range::new_from_bounds(splat.unwrap_or(limited), limited), limited)
    }
}

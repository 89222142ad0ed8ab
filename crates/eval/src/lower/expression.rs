//! Lowers expressions. Many of naga's expressions only select slots, and need no instruction.

use super::{Loc, LoweredBody};
use crate::code::{DerivativeDirection, Instruction, Operand, Slot};
use crate::error::Error;
use crate::program::InitialValue;
use naga::{
    DerivativeAxis, DerivativeControl, Expression, Handle, Literal, SwizzleComponent, TypeInner,
};

impl LoweredBody<'_, '_> {
    /// Where an expression's value is. An expression that no statement emits is computed on first
    /// use.
    pub(super) fn loc(&mut self, handle: Handle<Expression>) -> Result<Loc, Error> {
        match self.locs[handle.index()] {
            Some(loc) => Ok(loc),
            None if self.expressions[handle].needs_pre_emit() || self.constant => {
                self.evaluate(handle)
            }
            None => Err(Error::new(
                lamplight_diagnostic::codes::EVAL_INTERNAL,
                "an expression is used before it is evaluated",
            )),
        }
    }

    /// Emits the instructions that compute the expression.
    pub(super) fn evaluate(&mut self, handle: Handle<Expression>) -> Result<Loc, Error> {
        let loc =
            self.lowered(handle).map_err(|error| error.or_at(self.expressions.get_span(handle)))?;
        self.locs[handle.index()] = Some(loc);
        Ok(loc)
    }

    fn lowered(&mut self, handle: Handle<Expression>) -> Result<Loc, Error> {
        match self.expressions[handle] {
            Expression::Literal(literal) => self.literal(literal),
            Expression::Constant(constant) => {
                self.global_value(self.build.module.constants[constant].init)
            }
            Expression::Override(constant) => self.override_value(constant),
            Expression::ZeroValue(ty) => self.zero_value(ty),
            Expression::Compose { ref components, .. } => self.compose(handle, components),
            Expression::Splat { value, .. } => self.splat(value),
            Expression::Swizzle { size, vector, pattern } => {
                self.swizzle(vector, &pattern[..size as usize])
            }
            Expression::Access { base, index } => self.access(handle, base, index),
            Expression::AccessIndex { base, index } => self.access_index(base, index),
            Expression::FunctionArgument(index) => self.argument(handle, index),
            Expression::GlobalVariable(variable) => self.global_variable(variable),
            Expression::LocalVariable(variable) => Ok(Loc::Place(self.locals[variable.index()])),
            Expression::Load { pointer } => self.load(handle, pointer),
            Expression::Unary { op, expr } => self.unary(handle, op, expr),
            Expression::Binary { op, left, right } => self.binary(handle, op, left, right),
            Expression::Select { condition, accept, reject } => {
                self.select(handle, condition, accept, reject)
            }
            Expression::Relational { fun, argument } => self.relational(handle, fun, argument),
            Expression::Math { fun, arg, arg1, arg2, arg3 } => {
                self.math(handle, fun, arg, [arg1, arg2, arg3])
            }
            Expression::As { expr, kind, convert } => self.cast(handle, expr, kind, convert),
            Expression::Derivative { axis, ctrl, expr } => {
                self.derivative(handle, axis, ctrl, expr)
            }
            Expression::ArrayLength(pointer) => self.array_length(pointer),
            Expression::CallResult(_) => Err(Error::unsupported("a result without its call")),
            Expression::ImageSample { .. }
            | Expression::ImageLoad { .. }
            | Expression::ImageQuery { .. } => self.image(handle),
            ref other => Err(Error::unsupported(expression_name(other))),
        }
    }

    fn override_value(&mut self, constant: Handle<naga::Override>) -> Result<Loc, Error> {
        match self.build.module.overrides[constant].init {
            Some(init) => self.global_value(init),
            None => Err(Error::unsupported("overrides without a value")),
        }
    }

    fn zero_value(&mut self, ty: Handle<naga::Type>) -> Result<Loc, Error> {
        let size = self.build.layout.size(ty)?;
        Ok(Loc::dense(self.build.alloc(size)?, true))
    }

    fn global_variable(&self, variable: Handle<naga::GlobalVariable>) -> Result<Loc, Error> {
        let known = self.build.globals.get(variable.index()).cloned();
        known.unwrap_or_else(|| Err(Error::unsupported("this variable")))
    }

    /// Fresh slots for the value of an expression.
    pub(super) fn fresh(&mut self, handle: Handle<Expression>) -> Result<(Slot, u32), Error> {
        let n = self.slots(handle)?;
        Ok((self.build.alloc(n)?, n))
    }

    fn literal(&mut self, literal: Literal) -> Result<Loc, Error> {
        let value = match literal {
            Literal::F32(value) => InitialValue::Float(f64::from(value)),
            Literal::AbstractFloat(value) => InitialValue::Float(value),
            Literal::U32(value) => InitialValue::Word(value),
            Literal::I32(value) => InitialValue::Word(value as u32),
            Literal::AbstractInt(value) => InitialValue::Word(value as u32),
            Literal::Bool(value) => InitialValue::Word(u32::from(value)),
            _ => return Err(Error::unsupported(format!("literals of {} bytes", literal.width()))),
        };
        Ok(Loc::dense(self.build.literal(value)?, true))
    }

    fn global_value(&mut self, init: Handle<Expression>) -> Result<Loc, Error> {
        // While the constants themselves are lowered, the table of constants does not exist yet.
        let known = if self.build.constants.is_empty() {
            self.locs.get(init.index())
        } else {
            self.build.constants.get(init.index())
        };
        known.copied().flatten().ok_or_else(|| Error::unsupported("this module-scope constant"))
    }

    fn compose(
        &mut self,
        handle: Handle<Expression>,
        components: &[Handle<Expression>],
    ) -> Result<Loc, Error> {
        let (first, _) = self.fresh(handle)?;
        let locs = components
            .iter()
            .map(|component| self.loc(*component))
            .collect::<Result<Vec<_>, _>>()?;
        let constant = locs.iter().all(|loc| matches!(loc, Loc::Value { constant: true, .. }));
        let before = self.constant;
        self.constant |= constant;
        let mut to = first;
        for component in components {
            let (from, n) = (self.operand(*component)?, self.slots(*component)?);
            self.emit(Instruction::spread(to, from, n));
            to += n;
        }
        self.constant = before;
        Ok(Loc::dense(first, constant))
    }

    fn splat(&mut self, value: Handle<Expression>) -> Result<Loc, Error> {
        match self.loc(value)? {
            Loc::Value { operand, constant } => {
                Ok(Loc::Value { operand: Operand { stride: 0, ..operand }, constant })
            }
            _ => Err(Error::unsupported("a vector of pointers")),
        }
    }

    fn swizzle(
        &mut self,
        vector: Handle<Expression>,
        pattern: &[SwizzleComponent],
    ) -> Result<Loc, Error> {
        let from = self.operand(vector)?;
        let first = pattern.first().map_or(0, |component| *component as u32);
        let consecutive = pattern
            .iter()
            .enumerate()
            .all(|(index, component)| *component as u32 == first + index as u32);
        if from.stride == 0 || consecutive {
            let operand = Operand { slot: from.at(first) as Slot, ..from };
            return Ok(Loc::Value {
                operand,
                constant: matches!(self.loc(vector)?, Loc::Value { constant: true, .. }),
            });
        }
        let to = self.build.alloc(pattern.len() as u32)?;
        for (index, component) in pattern.iter().enumerate() {
            self.emit(Instruction::Copy {
                to: to + index as u32,
                from: from.at(*component as u32) as Slot,
                n: 1,
            });
        }
        Ok(Loc::dense(to, false))
    }

    fn argument(&mut self, handle: Handle<Expression>, index: u32) -> Result<Loc, Error> {
        let slot = self
            .arguments
            .get(index as usize)
            .copied()
            .ok_or_else(|| Error::unsupported("this argument"))?;
        match self.inner(handle) {
            TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. } => {
                Ok(Loc::Through { slot, offset: 0 })
            }
            _ => Ok(Loc::dense(slot, false)),
        }
    }

    fn select(
        &mut self,
        handle: Handle<Expression>,
        condition: Handle<Expression>,
        accept: Handle<Expression>,
        reject: Handle<Expression>,
    ) -> Result<Loc, Error> {
        let (to, n) = self.fresh(handle)?;
        let whole = matches!(self.inner(condition), TypeInner::Scalar(_));
        let condition = self.operand(condition)?;
        let condition = if whole { Operand { stride: 0, ..condition } } else { condition };
        let (accept, reject) = (self.spread(accept, n)?, self.spread(reject, n)?);
        self.emit(Instruction::Select { n: n as u8, to, condition, accept, reject });
        Ok(Loc::dense(to, false))
    }

    fn derivative(
        &mut self,
        handle: Handle<Expression>,
        axis: DerivativeAxis,
        control: DerivativeControl,
        expr: Handle<Expression>,
    ) -> Result<Loc, Error> {
        let (to, n) = self.fresh(handle)?;
        let a = self.operand(expr)?;
        let axis = match axis {
            DerivativeAxis::X => DerivativeDirection::X,
            DerivativeAxis::Y => DerivativeDirection::Y,
            DerivativeAxis::Width => DerivativeDirection::Width,
        };
        self.emit(Instruction::Derivative {
            axis,
            coarse: control == DerivativeControl::Coarse,
            n: n as u8,
            to,
            a,
        });
        Ok(Loc::dense(to, false))
    }
}

fn expression_name(expression: &Expression) -> String {
    let text = format!("{expression:?}");
    format!("the operation `{}`", text.split([' ', '(', '{']).next().unwrap_or("?"))
}

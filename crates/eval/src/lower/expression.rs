//! Lowers expressions, pointers, accesses to parts of values, and accesses to textures. Many of
//! naga's expressions only select slots, and need no instruction.

use crate::code::{Access, DerivativeDirection, Instruction, Lod, Operand, Slot, TextureOp};
use crate::error::Error;
use crate::layout::SlotKind;
use crate::lower::{Loc, LoweredBody};
use crate::program::{GlobalRole, InitialValue};
use naga::{
    AddressSpace, DerivativeAxis, DerivativeControl, Expression, Handle, ImageClass, ImageQuery,
    Literal, SampleLevel, SwizzleComponent, TypeInner,
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

impl LoweredBody<'_, '_> {
    pub(super) fn access_index(
        &mut self,
        base: Handle<Expression>,
        index: u32,
    ) -> Result<Loc, Error> {
        let skip = self.build.layout.component(self.pointee(base), index)?;
        Ok(match self.loc(base)? {
            Loc::Value { operand, constant } => Loc::Value {
                operand: Operand { slot: operand.slot + skip * operand.stride, ..operand },
                constant,
            },
            Loc::Place(slot) => Loc::Place(slot + skip),
            Loc::Through { slot, offset } => Loc::Through { slot, offset: offset + skip },
        })
    }

    pub(super) fn access(
        &mut self,
        handle: Handle<Expression>,
        base: Handle<Expression>,
        index: Handle<Expression>,
    ) -> Result<Loc, Error> {
        let (size, count) = self.build.layout.element(self.pointee(base))?;
        let index = self.operand(index)?.slot;
        let loc = self.loc(base)?;
        if let Loc::Value { .. } = loc {
            let from = self.dense(base)?;
            let (to, _) = self.fresh(handle)?;
            self.emit(Instruction::Pick { to, from, index, size, count: count.unwrap_or(1) });
            return Ok(Loc::dense(to, false));
        }
        let count = match count {
            Some(count) => self.build.word(count)?,
            None => self.runtime_count(base)?,
        };
        let (base, to) = (self.address(loc)?, self.build.alloc(1)?);
        self.emit(Instruction::Index { to, base, index, size, count });
        Ok(Loc::Through { slot: to, offset: 0 })
    }

    pub(super) fn load(
        &mut self,
        handle: Handle<Expression>,
        pointer: Handle<Expression>,
    ) -> Result<Loc, Error> {
        let n = self.slots(handle)?;
        let loc = self.loc(pointer)?;
        // No statement can write to these address spaces, so no copy is needed.
        if let (Loc::Place(slot), Some(AddressSpace::Uniform | AddressSpace::Immediate)) =
            (loc, self.inner(pointer).pointer_space())
        {
            return Ok(Loc::dense(slot, false));
        }
        let to = self.build.alloc(n)?;
        match loc {
            Loc::Place(from) => self.emit(Instruction::Copy { to, from, n }),
            Loc::Through { slot, offset } => {
                self.emit(Instruction::Load { to, pointer: slot, offset, n })
            }
            Loc::Value { operand, .. } => {
                self.emit(Instruction::Load { to, pointer: operand.slot, offset: 0, n })
            }
        }
        Ok(Loc::dense(to, false))
    }

    pub(super) fn store(
        &mut self,
        pointer: Handle<Expression>,
        value: Handle<Expression>,
    ) -> Result<(), Error> {
        let (operand, n) = (self.operand(value)?, self.slots(value)?);
        match self.loc(pointer)? {
            Loc::Place(to) if operand.stride == 0 => {
                self.emit(Instruction::Fill { to, from: operand.slot, n })
            }
            Loc::Place(to) => self.emit(Instruction::Copy { to, from: operand.slot, n }),
            Loc::Through { slot, offset } => {
                let from = self.dense(value)?;
                self.emit(Instruction::Store { pointer: slot, offset, from, n });
            }
            Loc::Value { operand, .. } => {
                let from = self.dense(value)?;
                self.emit(Instruction::Store { pointer: operand.slot, offset: 0, from, n });
            }
        }
        Ok(())
    }

    pub(super) fn array_length(&mut self, pointer: Handle<Expression>) -> Result<Loc, Error> {
        Ok(Loc::dense(self.runtime_count(pointer)?, false))
    }

    /// The slot with the length of a buffer's runtime-sized array.
    fn runtime_count(&mut self, pointer: Handle<Expression>) -> Result<Slot, Error> {
        let variable = match self.expressions[pointer] {
            Expression::GlobalVariable(variable) => variable,
            Expression::AccessIndex { base, .. } => match self.expressions[base] {
                Expression::GlobalVariable(variable) => variable,
                _ => return Err(Error::unsupported("the length of this array")),
            },
            _ => return Err(Error::unsupported("the length of an array behind a parameter")),
        };
        let name = self.build.module.global_variables[variable].binding;
        let binding = name.map(|binding| (binding.group, binding.binding));
        match self
            .build
            .program
            .globals
            .iter()
            .find(|global| global.binding == binding)
            .map(|global| global.role)
        {
            Some(GlobalRole::Runtime { count, .. }) => Ok(count),
            _ => Err(Error::unsupported("the length of this array")),
        }
    }

    /// The type that a pointer points to, or the type of a value.
    fn pointee(&self, handle: Handle<Expression>) -> &TypeInner {
        match *self.inner(handle) {
            TypeInner::Pointer { base, .. } => &self.build.module.types[base].inner,
            ref inner => inner,
        }
    }
}

impl LoweredBody<'_, '_> {
    pub(super) fn image(&mut self, handle: Handle<Expression>) -> Result<Loc, Error> {
        let (to, n) = self.fresh(handle)?;
        let words = self.kind(handle)? != SlotKind::Float;
        let mut access = Access {
            image: 0,
            coordinate: 0,
            dimensions: 0,
            layer: None,
            ask: TextureOp::Levels,
            to,
            n: n as u8,
            words,
            depth: false,
        };
        match self.expressions[handle] {
            Expression::ImageSample {
                image,
                sampler,
                gather,
                coordinate,
                array_index,
                offset,
                level,
                depth_ref,
                clamp_to_edge,
            } => {
                self.coordinates(&mut access, image, Some(coordinate), array_index)?;
                let (sampler, offset, reference) =
                    (self.operand(sampler)?.slot, self.maybe(offset)?, self.maybe(depth_ref)?);
                let (level, gather) = (self.level(level)?, gather.map(|component| component as u8));
                access.ask =
                    TextureOp::Sample { sampler, gather, level, offset, reference, clamp_to_edge };
            }
            Expression::ImageLoad { image, coordinate, array_index, level, .. } => {
                self.coordinates(&mut access, image, Some(coordinate), array_index)?;
                access.ask = TextureOp::Load { level: self.maybe(level)? };
            }
            Expression::ImageQuery { image, query } => {
                self.coordinates(&mut access, image, None, None)?;
                access.ask = self.query(query)?;
            }
            _ => return Err(Error::unsupported("this access to a texture")),
        }
        let index = self.build.program.images.len() as u32;
        self.build.program.images.push(access);
        self.emit(Instruction::Image { access: index });
        Ok(Loc::dense(to, false))
    }

    fn coordinates(
        &mut self,
        access: &mut Access,
        image: Handle<Expression>,
        coordinate: Option<Handle<Expression>>,
        layer: Option<Handle<Expression>>,
    ) -> Result<(), Error> {
        let TypeInner::Image { class, .. } = *self.inner(image) else {
            return Err(Error::unsupported("arrays of textures"));
        };
        if matches!(class, ImageClass::Storage { .. } | ImageClass::External) {
            return Err(Error::unsupported("storage and external textures"));
        }
        access.depth = matches!(class, ImageClass::Depth { .. });
        access.image = self.operand(image)?.slot;
        if let Some(coordinate) = coordinate {
            (access.coordinate, access.dimensions) =
                (self.dense(coordinate)?, self.slots(coordinate)? as u8);
        }
        access.layer = self.maybe(layer)?;
        Ok(())
    }

    fn maybe(&mut self, handle: Option<Handle<Expression>>) -> Result<Option<Slot>, Error> {
        handle.map(|handle| self.dense(handle)).transpose()
    }

    fn level(&mut self, level: SampleLevel) -> Result<Lod, Error> {
        Ok(match level {
            SampleLevel::Auto => Lod::Auto,
            SampleLevel::Zero => Lod::Zero,
            // The level of a depth texture is an integer, which is converted to a float here.
            SampleLevel::Exact(level) if self.kind(level)? != SlotKind::Float => {
                Lod::Exact(self.float_of(level)?)
            }
            SampleLevel::Exact(level) => Lod::Exact(self.dense(level)?),
            SampleLevel::Bias(bias) => Lod::Bias(self.dense(bias)?),
            SampleLevel::Gradient { x, y } => Lod::Gradient(self.dense(x)?, self.dense(y)?),
        })
    }

    fn float_of(&mut self, handle: Handle<Expression>) -> Result<Slot, Error> {
        let (a, to) = (self.operand(handle)?, self.build.alloc(1)?);
        self.emit(Instruction::Convert { op: crate::code::Convert::FloatFromS, n: 1, to, a });
        Ok(to)
    }

    fn query(&mut self, query: ImageQuery) -> Result<TextureOp, Error> {
        Ok(match query {
            ImageQuery::Size { level } => TextureOp::Size { level: self.maybe(level)? },
            ImageQuery::NumLevels => TextureOp::Levels,
            ImageQuery::NumLayers => TextureOp::Layers,
            ImageQuery::NumSamples => TextureOp::Samples,
        })
    }
}

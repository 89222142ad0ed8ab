//! Writes the body of a function of naga's modules, and converts values to words and back.

use naga::{
    BinaryOperator as Op, Expression, Function, Handle, Literal, MathFunction, Module, Range,
    Scalar, ScalarKind, Span, Statement, Type, TypeInner, VectorSize,
};

/// A value within the body.
pub type KernelValue = Handle<Expression>;

/// The function that is being built, and the module that it is for.
pub struct FunctionBody<'a> {
    pub module: &'a mut Module,
    pub function: Function,
}

impl FunctionBody<'_> {
    /// Adds an expression, and the statement that evaluates it if it needs one.
    pub fn add(&mut self, expression: Expression) -> KernelValue {
        let emitted = !expression.needs_pre_emit();
        let value = self.function.expressions.append(expression, Span::UNDEFINED);
        if emitted {
            self.function
                .body
                .push(Statement::Emit(Range::new_from_bounds(value, value)), Span::UNDEFINED);
        }
        value
    }

    /// A type without a name.
    pub fn ty(&mut self, inner: TypeInner) -> Handle<Type> {
        self.module.types.insert(Type { name: None, inner }, Span::UNDEFINED)
    }

    pub fn scalar(&mut self, scalar: Scalar) -> Handle<Type> {
        self.ty(TypeInner::Scalar(scalar))
    }

    pub fn vector(&mut self, size: VectorSize, kind: ScalarKind) -> Handle<Type> {
        let width = if kind == ScalarKind::Bool { naga::BOOL_WIDTH } else { 4 };
        self.ty(TypeInner::Vector { size, scalar: Scalar { kind, width } })
    }

    /// A literal of `u32`.
    pub fn literal(&mut self, value: u32) -> KernelValue {
        self.add(Expression::Literal(Literal::U32(value)))
    }

    /// A component of a vector, a matrix, an array or a struct.
    pub fn component(&mut self, base: KernelValue, index: u32) -> KernelValue {
        self.add(Expression::AccessIndex { base, index })
    }

    pub fn binary(&mut self, op: Op, left: KernelValue, right: KernelValue) -> KernelValue {
        self.add(Expression::Binary { op, left, right })
    }

    /// A built-in function of two values.
    pub fn math(
        &mut self,
        fun: MathFunction,
        left: KernelValue,
        right: KernelValue,
    ) -> KernelValue {
        self.add(Expression::Math { fun, arg: left, arg1: Some(right), arg2: None, arg3: None })
    }

    /// A value converted to 32 bits of a kind.
    pub fn convert(&mut self, expr: KernelValue, kind: ScalarKind) -> KernelValue {
        self.add(Expression::As { expr, kind, convert: Some(4) })
    }

    /// A value of the type from words; `None` if the type does not consist of words.
    pub fn unflatten(
        &mut self,
        ty: Handle<Type>,
        words: &mut dyn Iterator<Item = KernelValue>,
    ) -> Option<KernelValue> {
        if let TypeInner::Scalar(scalar) = self.module.types[ty].inner {
            return words.next().map(|word| self.word_as(word, scalar.kind));
        }
        let components = self
            .parts(ty)?
            .into_iter()
            .map(|part| self.unflatten(part, words))
            .collect::<Option<_>>()?;
        Some(self.add(Expression::Compose { ty, components }))
    }

    fn word_as(&mut self, word: KernelValue, kind: ScalarKind) -> KernelValue {
        match kind {
            ScalarKind::Uint => word,
            ScalarKind::Bool => {
                let zero = self.literal(0);
                self.binary(Op::NotEqual, word, zero)
            }
            _ => self.add(Expression::As { expr: word, kind, convert: None }),
        }
    }

    /// Appends the words of a value.
    pub fn flatten(&mut self, value: KernelValue, ty: Handle<Type>, words: &mut Vec<KernelValue>) {
        if let TypeInner::Scalar(scalar) = self.module.types[ty].inner {
            let word = self.as_word(value, scalar.kind);
            return words.push(word);
        }
        for (index, part) in self.parts(ty).into_iter().flatten().enumerate() {
            let component = self.component(value, index as u32);
            self.flatten(component, part, words);
        }
    }

    /// The types of what a value is made of; `None` where it has no words.
    fn parts(&mut self, ty: Handle<Type>) -> Option<Vec<Handle<Type>>> {
        Some(match self.module.types[ty].inner.clone() {
            TypeInner::Vector { size, scalar } => vec![self.scalar(scalar); size as usize],
            TypeInner::Matrix { columns, rows, scalar } => {
                vec![self.vector(rows, scalar.kind); columns as usize]
            }
            TypeInner::Array { base, size: naga::ArraySize::Constant(count), .. } => {
                vec![base; count.get() as usize]
            }
            TypeInner::Struct { members, .. } => members.iter().map(|member| member.ty).collect(),
            _ => return None,
        })
    }

    fn as_word(&mut self, value: KernelValue, kind: ScalarKind) -> KernelValue {
        match kind {
            ScalarKind::Uint => value,
            ScalarKind::Bool => {
                let (accept, reject) = (self.literal(1), self.literal(0));
                self.add(Expression::Select { condition: value, accept, reject })
            }
            _ => self.add(Expression::As { expr: value, kind: ScalarKind::Uint, convert: None }),
        }
    }
}

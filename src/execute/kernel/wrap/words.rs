//! Converts values to words, and back.

use naga::{BinaryOperator as Op, Expression, Handle, ScalarKind, Type, TypeInner, VectorSize};

use super::{Body, Value};

impl Body<'_> {
    /// A value of the type from words; `None` if the type does not consist of words.
    pub(super) fn unflatten(
        &mut self,
        ty: Handle<Type>,
        words: &mut dyn Iterator<Item = Value>,
    ) -> Option<Value> {
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

    fn word_as(&mut self, word: Value, kind: ScalarKind) -> Value {
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
    pub(super) fn flatten(&mut self, value: Value, ty: Handle<Type>, words: &mut Vec<Value>) {
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

    fn as_word(&mut self, value: Value, kind: ScalarKind) -> Value {
        match kind {
            ScalarKind::Uint => value,
            ScalarKind::Bool => {
                let (accept, reject) = (self.literal(1), self.literal(0));
                self.add(Expression::Select { condition: value, accept, reject })
            }
            _ => self.add(Expression::As { expr: value, kind: ScalarKind::Uint, convert: None }),
        }
    }

    /// The four words of this pixel: those of part 0, unless `part` is another.
    pub(super) fn choose(&mut self, words: &[Value], part: Value) -> Value {
        let ty = self.vector(VectorSize::Quad, ScalarKind::Uint);
        let zero = self.literal(0);
        let mut chosen = self.add(Expression::Compose {
            ty,
            components: padded_words(words.get(..4).unwrap_or(words), zero),
        });
        for (index, four) in words.chunks(4).enumerate().skip(1) {
            let accept = self.add(Expression::Compose { ty, components: padded_words(four, zero) });
            let index = self.literal(index as u32);
            let condition = self.binary(Op::Equal, part, index);
            chosen = self.add(Expression::Select { condition, accept, reject: chosen });
        }
        chosen
    }
}

fn padded_words(words: &[Value], zero: Value) -> Vec<Value> {
    words.iter().copied().chain(std::iter::repeat(zero)).take(4).collect()
}

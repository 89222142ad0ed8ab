//! The shape of a value as 32-bit words, which is how arguments and results are flattened.

use naga::{ArraySize, Handle, Module, ScalarKind, Type, TypeInner};

/// A type without layout: its words follow each other in the order of declaration, matrices by
/// columns, without padding.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TypeShape {
    /// One word: f32, i32, u32 or bool.
    Scalar(ScalarKind),
    /// Two to four words.
    Vector { size: u32, kind: ScalarKind },
    /// `columns * rows` words, column by column; always f32.
    Matrix { columns: u32, rows: u32 },
    /// The elements in order.
    Array { base: Box<TypeShape>, count: u32 },
    /// The members in order, by name.
    Struct { members: Vec<(String, TypeShape)> },
}

/// Columns of two to four rows.
static COLUMNS: [TypeShape; 3] = [column_shape(2), column_shape(3), column_shape(4)];
static SCALARS: [TypeShape; 4] = [
    TypeShape::Scalar(ScalarKind::Float),
    TypeShape::Scalar(ScalarKind::Sint),
    TypeShape::Scalar(ScalarKind::Uint),
    TypeShape::Scalar(ScalarKind::Bool),
];
const COMPONENTS: [&str; 4] = ["x", "y", "z", "w"];

const fn column_shape(size: u32) -> TypeShape {
    TypeShape::Vector { size, kind: ScalarKind::Float }
}

impl TypeShape {
    /// The shape of a naga type; `None` for a type whose values are not words.
    pub fn of(module: &Module, ty: Handle<Type>) -> Option<Self> {
        match module.types[ty].inner {
            TypeInner::Scalar(scalar) => word_kind(scalar).map(Self::Scalar),
            TypeInner::Vector { size, scalar } => {
                Some(Self::Vector { size: size as u32, kind: word_kind(scalar)? })
            }
            TypeInner::Matrix { columns, rows, scalar } => word_kind(scalar)
                .map(|_| Self::Matrix { columns: columns as u32, rows: rows as u32 }),
            TypeInner::Array { base, size: ArraySize::Constant(count), .. } => {
                Some(Self::Array { base: Box::new(Self::of(module, base)?), count: count.get() })
            }
            TypeInner::Struct { ref members, .. } => {
                let members = members
                    .iter()
                    .map(|member| Some((member.name.clone()?, Self::of(module, member.ty)?)));
                Some(Self::Struct { members: members.collect::<Option<_>>()? })
            }
            _ => None,
        }
    }

    /// Number of 32-bit words.
    pub fn words(&self) -> u32 {
        match self {
            Self::Scalar(_) => 1,
            Self::Vector { size, .. } => *size,
            Self::Matrix { columns, rows } => columns * rows,
            Self::Array { base, count } => base.words().saturating_mul(*count),
            Self::Struct { members } => {
                members.iter().map(|(_, shape)| shape.words()).fold(0, u32::saturating_add)
            }
        }
    }

    /// The scalar kind of every word, in order.
    pub fn kinds(&self) -> Vec<ScalarKind> {
        match self {
            Self::Scalar(kind) => vec![*kind],
            Self::Vector { size, kind } => vec![*kind; *size as usize],
            Self::Matrix { columns, rows } => vec![ScalarKind::Float; (columns * rows) as usize],
            Self::Array { base, count } => base.kinds().repeat(*count as usize),
            Self::Struct { members } => {
                members.iter().flat_map(|(_, shape)| shape.kinds()).collect()
            }
        }
    }

    /// The part at a path, with the index of its first word. A path consists of member names, array
    /// indices, numbers of matrix columns, and letters of vector components.
    pub fn part(&self, path: &[String]) -> Option<(u32, &Self)> {
        let Some((first, rest)) = path.split_first() else { return Some((0, self)) };
        let (skipped, inner) = match self {
            Self::Struct { members } => {
                let index = members.iter().position(|(name, _)| name == first)?;
                (members[..index].iter().map(|(_, shape)| shape.words()).sum(), &members[index].1)
            }
            Self::Array { base, count } => {
                let index: u32 = first.parse().ok().filter(|index| index < count)?;
                (index * base.words(), &**base)
            }
            Self::Matrix { columns, rows } => {
                let index: u32 = first.parse().ok().filter(|index| index < columns)?;
                (index * rows, COLUMNS.get(*rows as usize - 2)?)
            }
            Self::Vector { size, kind } => {
                let index = COMPONENTS
                    .iter()
                    .position(|name| name == first)
                    .filter(|index| *index < *size as usize)?;
                (index as u32, SCALARS.iter().find(|scalar| **scalar == Self::Scalar(*kind))?)
            }
            Self::Scalar(_) => return None,
        };
        let (offset, part) = inner.part(rest)?;
        Some((skipped + offset, part))
    }
}

fn word_kind(scalar: naga::Scalar) -> Option<ScalarKind> {
    let is_bool = scalar.kind == ScalarKind::Bool;
    (is_bool || scalar.width == 4).then_some(scalar.kind)
}

//! How values are made of scalars, and the names of their parts.

use std::ops::Range;

use crate::layout::{SlotKind, kind_of};
use naga::{ArraySize, Handle, Type, TypeInner, UniqueArena};

/// How a value is made of scalars.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// One scalar.
    Scalar(SlotKind),
    /// Two to four scalars.
    Vector(u32, SlotKind),
    /// Columns of rows.
    Matrix { columns: u32, rows: u32 },
    /// Elements of one shape.
    Array(u32, Box<Self>),
    /// Members by name.
    Struct(Vec<(String, Self)>),
}

impl Shape {
    /// The shape of a type; `None` for pointers, textures and samplers. A runtime-sized array has
    /// one element.
    pub fn of(types: &UniqueArena<Type>, inner: &TypeInner) -> Option<Self> {
        let typed = |ty: Handle<Type>| Self::of(types, &types[ty].inner);
        Some(match *inner {
            TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => Self::Scalar(kind_of(scalar)?),
            TypeInner::Vector { size, scalar } => Self::Vector(size as u32, kind_of(scalar)?),
            TypeInner::Matrix { columns, rows, scalar: _ } => {
                Self::Matrix { columns: columns as u32, rows: rows as u32 }
            }
            TypeInner::Array { base, size, stride: _ } => {
                let count = if let ArraySize::Constant(count) = size { count.get() } else { 1 };
                Self::Array(count, Box::new(typed(base)?))
            }
            TypeInner::Struct { ref members, span: _ } => {
                let member = |(index, member): (usize, &naga::StructMember)| {
                    let name = member.name.clone().unwrap_or_else(|| index.to_string());
                    Some((name, typed(member.ty)?))
                };
                Self::Struct(members.iter().enumerate().map(member).collect::<Option<_>>()?)
            }
            _ => return None,
        })
    }

    /// How many scalars it has.
    pub fn scalars(&self) -> u32 {
        match self {
            Self::Scalar(_) => 1,
            Self::Vector(count, _) => *count,
            Self::Matrix { columns, rows } => columns * rows,
            Self::Array(count, element) => count.saturating_mul(element.scalars()),
            Self::Struct(members) => members.iter().map(|(_, shape)| shape.scalars()).sum(),
        }
    }

    /// The kinds of its scalars in order, but at most so many.
    pub fn kinds(&self, most: usize) -> Vec<SlotKind> {
        let mut kinds = Vec::new();
        self.add_kinds(most, &mut kinds);
        kinds
    }

    fn add_kinds(&self, most: usize, kinds: &mut Vec<SlotKind>) {
        let free = most - kinds.len();
        let mut add = |count: u32, kind| kinds.extend((0..count).map(|_| kind).take(free));
        match self {
            _ if free == 0 => {}
            Self::Scalar(kind) => add(1, *kind),
            Self::Vector(count, kind) => add(*count, *kind),
            Self::Matrix { columns, rows } => add(columns * rows, SlotKind::Float),
            Self::Array(count, element) => {
                (0..(*count as usize).min(free)).for_each(|_| element.add_kinds(most, kinds));
            }
            Self::Struct(members) => {
                members.iter().for_each(|(_, shape)| shape.add_kinds(most, kinds));
            }
        }
    }

    /// Its parts by their numbers: components, columns, elements or members. A scalar has none.
    pub fn parts(&self, range: Range<u32>) -> impl Iterator<Item = ShapePart> + '_ {
        let count = match self {
            Self::Scalar(_) => 0,
            Self::Vector(count, _) | Self::Array(count, _) => *count,
            Self::Matrix { columns, rows: _ } => *columns,
            Self::Struct(members) => members.len() as u32,
        };
        (range.start..range.end.min(count)).filter_map(|at| self.part_at(at))
    }

    fn part_at(&self, at: u32) -> Option<ShapePart> {
        let element = format!("[{at}]");
        let (name, first, shape) = match self {
            Self::Scalar(_) => return None,
            Self::Vector(_, kind) => {
                ((*COMPONENTS.get(at as usize)?).to_owned(), at, Self::Scalar(*kind))
            }
            Self::Matrix { columns: _, rows } => {
                (element, at * rows, Self::Vector(*rows, SlotKind::Float))
            }
            Self::Array(_, shape) => {
                (element, at.saturating_mul(shape.scalars()), shape.as_ref().clone())
            }
            Self::Struct(members) => {
                let (before, (name, shape)) =
                    (members.get(..at as usize)?, members.get(at as usize)?);
                let first = before.iter().map(|(_, shape)| shape.scalars()).sum();
                (name.clone(), first, shape.clone())
            }
        };
        Some(ShapePart { name, first, shape })
    }

    /// The part of a name: `x` or `r`, `[2]`, or that of a member.
    fn part(&self, name: &str) -> Option<ShapePart> {
        let index = name.strip_prefix('[').and_then(|rest| rest.strip_suffix(']'));
        let at = match (self, index) {
            (Self::Scalar(_), _) | (Self::Struct(_), Some(_)) => return None,
            (Self::Struct(members), None) => {
                members.iter().position(|(known, _)| known == name)? as u32
            }
            (Self::Vector(..), None) => {
                let is_meant = |at: &usize| [COMPONENTS[*at], COLORS[*at]].contains(&name);
                (0..COMPONENTS.len()).find(is_meant)? as u32
            }
            (_, Some(index)) => index.trim().trim_end_matches(['u', 'i']).parse().ok()?,
            (Self::Matrix { .. } | Self::Array(..), None) => return None,
        };
        self.parts(at..at.saturating_add(1)).next()
    }

    /// The part that a path such as `.position.x` or `[2]` leads to; its name is the path.
    ///
    /// # Errors
    /// The first piece of the path that leads nowhere.
    pub fn follow(&self, path: &str) -> Result<ShapePart, String> {
        let mut found = ShapePart { name: String::new(), first: 0, shape: self.clone() };
        let mut rest = path.trim();
        while !rest.is_empty() {
            let inner = rest.strip_prefix('.').map(str::trim_start);
            let end = match inner {
                Some(inner) => inner.find(['.', '[']).unwrap_or(inner.len()),
                None if rest.starts_with('[') => rest.find(']').map_or(rest.len(), |end| end + 1),
                None => return Err(rest.to_owned()),
            };
            let (piece, behind) = inner.unwrap_or(rest).split_at(end);
            let part = found.shape.part(piece.trim()).ok_or_else(|| piece.trim().to_owned())?;
            found = found.then(part);
            rest = behind.trim_start();
        }
        Ok(found)
    }

    /// Its parts of parts in order with their paths, each down to one that is `whole`, but at most so
    /// many.
    pub fn leaves(&self, most: usize, whole: fn(&Self) -> bool) -> Vec<ShapePart> {
        let mut leaves = Vec::new();
        let all = ShapePart { name: String::new(), first: 0, shape: self.clone() };
        all.add_leaves(most, whole, &mut leaves);
        leaves
    }

    /// Whether it is one number.
    pub fn is_scalar(&self) -> bool {
        matches!(self, Self::Scalar(_))
    }
}

const COMPONENTS: [&str; 4] = ["x", "y", "z", "w"];
const COLORS: [&str; 4] = ["r", "g", "b", "a"];

/// A part of a value.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapePart {
    /// Its name, such as `x`, `position` or `[2]`, or the path to it.
    pub name: String,
    /// The number of its first scalar in the whole.
    pub first: u32,
    /// How it is made.
    pub shape: Shape,
}

impl ShapePart {
    /// What a path is with one more name behind it.
    pub fn path(before: &str, name: &str) -> String {
        let dot = if name.starts_with('[') { "" } else { "." };
        format!("{before}{dot}{name}")
    }

    /// A part of this one, as a part of the whole.
    #[must_use]
    pub fn then(&self, part: Self) -> Self {
        let Self { name, first, shape } = part;
        let first = self.first.saturating_add(first);
        Self { name: Self::path(&self.name, &name), first, shape }
    }

    fn add_leaves(self, most: usize, whole: fn(&Shape) -> bool, leaves: &mut Vec<Self>) {
        if whole(&self.shape) {
            return leaves.push(self);
        }
        for part in self.shape.parts(0..u32::MAX) {
            if leaves.len() >= most {
                return;
            }
            self.then(part).add_leaves(most, whole, leaves);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `struct { a: f32, at: array<struct { m: mat2x3f, n: vec2u }, 5> }`
    fn shape() -> Shape {
        let m = Shape::Matrix { columns: 2, rows: 3 };
        let n = Shape::Vector(2, SlotKind::Uint);
        let element = Shape::Struct(vec![("m".to_owned(), m), ("n".to_owned(), n)]);
        let at = Shape::Array(5, Box::new(element));
        Shape::Struct(vec![("a".to_owned(), Shape::Scalar(SlotKind::Float)), ("at".to_owned(), at)])
    }

    #[test]
    fn paths() {
        let found = |path: &str| shape().follow(path).map(|part| (part.first, part.name));
        let is = |first: u32, name: &str| Ok((first, name.to_owned()));
        assert_eq!(found(""), is(0, ""));
        assert_eq!(found(".a"), is(0, ".a"));
        // An element has 8 scalars, the first six of which are its matrix.
        assert_eq!(found(".at[2].n.y"), is(1 + 2 * 8 + 7, ".at[2].n.y"));
        assert_eq!(found(". at [ 2u ] .n .g"), is(1 + 2 * 8 + 7, ".at[2].n.y"));
        assert_eq!(found(".at[4].m[1].z"), is(1 + 4 * 8 + 5, ".at[4].m[1].z"));
        assert_eq!(found(".at[4].m[1][2]"), is(1 + 4 * 8 + 5, ".at[4].m[1].z"));
        for (wrong, piece) in [
            (".b", "b"),
            (".at[5]", "[5]"),
            (".at.x", "x"),
            (".a.x", "x"),
            (".at[0].n.z", "z"),
            (".at[0].n.xy", "xy"),
            (".at[", "["),
            (".at[-1]", "[-1]"),
            ("a", "a"),
            (".", ""),
        ] {
            assert_eq!(found(wrong), Err(piece.to_owned()), "{wrong}");
        }
    }

    #[test]
    fn scalars_in_order() {
        let leaves = shape().leaves(8, Shape::is_scalar);
        let names: Vec<&str> = leaves.iter().map(|part| part.name.as_str()).collect();
        let expected = [".a", ".at[0].m[0].x", ".at[0].m[0].y", ".at[0].m[0].z"];
        assert_eq!(names[..4], expected);
        assert!(leaves.iter().zip(0..).all(|(part, at)| part.first == at));
        assert_eq!((leaves.len(), shape().leaves(1000, Shape::is_scalar).len()), (8, 41));
        let kinds = shape().kinds(1000);
        assert_eq!((kinds.len(), kinds[7], kinds[8]), (41, SlotKind::Uint, SlotKind::Uint));
        assert_eq!(shape().kinds(9), kinds[..9]);
        let large = Shape::Array(u32::MAX, Box::new(Shape::Vector(4, SlotKind::Sint)));
        assert_eq!((large.kinds(5).len(), large.leaves(5, Shape::is_scalar).len()), (5, 5));
    }
}

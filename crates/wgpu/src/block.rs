//! Uniform blocks: bytes by the names of members.

use std::fmt;

use lamplight_bundle::{Binding, Member, Shape};

/// The bytes of a uniform buffer, whose members are set by their paths. What is not set is 0.
#[derive(Debug, Clone)]
pub struct Block<'a> {
    binding: &'a Binding,
    bytes: Vec<u8>,
}

/// Why a member cannot be set.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum BlockError {
    /// There is no member of this path; with the names that there are.
    NoMember(String, Vec<String>),
    /// The array of this path has fewer elements.
    NoElement(String),
    /// The member of this path takes another number of numbers.
    Count(String, u64),
    /// The member of this path has another type.
    Type(String, String),
}

impl fmt::Display for BlockError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoMember(path, known) => {
                write!(f, "there is no member `{path}`; there are: {}", known.join(", "))
            }
            Self::NoElement(path) => write!(f, "`{path}` is beyond the end of its array"),
            Self::Count(path, count) => write!(f, "`{path}` takes {count} numbers"),
            Self::Type(path, ty) => write!(f, "`{path}` is of type `{ty}`"),
        }
    }
}

impl std::error::Error for BlockError {}

/// A number that a uniform buffer may hold.
pub trait Number: Copy {
    /// Its type in WGSL.
    const SCALAR: &'static str;
    /// Its bytes, the lowest first.
    fn bytes(self) -> [u8; 4];
}

impl Number for f32 {
    const SCALAR: &'static str = "f32";
    fn bytes(self) -> [u8; 4] {
        self.to_le_bytes()
    }
}

impl Number for i32 {
    const SCALAR: &'static str = "i32";
    fn bytes(self) -> [u8; 4] {
        self.to_le_bytes()
    }
}

impl Number for u32 {
    const SCALAR: &'static str = "u32";
    fn bytes(self) -> [u8; 4] {
        self.to_le_bytes()
    }
}

impl<'a> Block<'a> {
    /// A block of zeros, as large as the binding is in any permutation.
    pub fn new(binding: &'a Binding) -> Self {
        Self { binding, bytes: vec![0; binding.size.unwrap_or(0) as usize] }
    }

    /// Sets a member, such as `exposure` or `all[1].color`, from numbers without padding: a matrix
    /// column after column, an array element after element.
    ///
    /// # Errors
    /// One for each way in which path, type or count can be wrong.
    pub fn set<T: Number>(&mut self, path: &str, numbers: &[T]) -> Result<(), BlockError> {
        let (at, member) = self.find(path)?;
        let wrong_type = || BlockError::Type(path.to_owned(), member.ty.clone());
        let shape = member.shape.as_ref().ok_or_else(wrong_type)?;
        if shape.scalar.as_deref() != Some(T::SCALAR) {
            return Err(wrong_type());
        }
        let count = number_count(shape);
        if count != numbers.len() as u64 {
            return Err(BlockError::Count(path.to_owned(), count));
        }
        let places = number_places(shape, member.stride.unwrap_or(0) as usize);
        for (place, number) in places.into_iter().zip(numbers) {
            // A bundle may say that a member is outside of its buffer.
            let to = self.bytes.get_mut(at + place..at + place + 4).ok_or_else(wrong_type)?;
            to.copy_from_slice(&number.bytes());
        }
        Ok(())
    }

    /// The bytes, for `Queue::write_buffer`.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// A member and its offset in the buffer.
    fn find(&self, path: &str) -> Result<(usize, &'a Member), BlockError> {
        let (mut at, mut members) = (0, &self.binding.members);
        let mut words = path.split('.').peekable();
        while let Some(word) = words.next() {
            let (name, element) = match word.strip_suffix(']').and_then(|word| word.split_once('['))
            {
                Some((name, element)) => (name, Some(element)),
                None => (word, None),
            };
            let found = members.iter().find(|member| member.name == name).ok_or_else(|| {
                let known = members.iter().map(|member| member.name.clone()).collect();
                BlockError::NoMember(path.to_owned(), known)
            })?;
            at += found.offset as usize;
            if let Some(element) = element {
                let count = found.shape.as_ref().and_then(|shape| shape.count).unwrap_or(0);
                let index = element.parse::<u32>().ok().filter(|index| *index < count);
                let index = index.ok_or_else(|| BlockError::NoElement(path.to_owned()))?;
                at += index as usize * found.stride.unwrap_or(0) as usize;
            }
            if words.peek().is_none() {
                return Ok((at, found));
            }
            members = &found.members;
        }
        Err(BlockError::NoMember(path.to_owned(), Vec::new()))
    }
}

/// How many numbers a member has.
fn number_count(shape: &Shape) -> u64 {
    let counts = [shape.count, shape.columns, shape.rows];
    counts.iter().fold(1, |all, count| all.saturating_mul(count.unwrap_or(1).into()))
}

/// Where each number of a member is, from its start.
fn number_places(shape: &Shape, stride: usize) -> Vec<usize> {
    let (rows, columns) = (shape.rows.unwrap_or(1) as usize, shape.columns.unwrap_or(1) as usize);
    let column_stride = shape.matrix_stride.unwrap_or(0) as usize;
    let elements = shape.count.unwrap_or(1) as usize;
    (0..elements * columns * rows)
        .map(|number| {
            let (element, rest) = (number / (columns * rows), number % (columns * rows));
            element * stride + rest / rows * column_stride + rest % rows * 4
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use lamplight_bundle::BindingKind;

    use super::*;

    fn member(name: &str, offset: u32, shape: Option<Shape>) -> Member {
        Member {
            name: name.to_owned(),
            ty: "T".to_owned(),
            offset,
            size: 4,
            stride: None,
            shape,
            members: Vec::new(),
        }
    }

    fn floats(rows: Option<u32>, columns: Option<u32>, count: Option<u32>) -> Option<Shape> {
        let matrix_stride = columns.map(|_| 16);
        Some(Shape { scalar: Some("f32".to_owned()), rows, columns, matrix_stride, count })
    }

    /// A matrix of three columns, and two lamps with a colour each.
    fn binding() -> Binding {
        let mut all = member("all", 48, Some(Shape { count: Some(2), ..Shape::default() }));
        all.stride = Some(16);
        all.members = vec![member("color", 0, floats(Some(3), None, None))];
        Binding {
            group: 0,
            binding: 0,
            name: "lamps".to_owned(),
            kind: BindingKind::Uniform,
            ty: String::new(),
            count: None,
            size: Some(80),
            writable: false,
            shape: None,
            texture: None,
            members: vec![member("normal", 0, floats(Some(3), Some(3), None)), all],
        }
    }

    #[test]
    fn numbers_are_at_their_places() {
        let binding = binding();
        let mut block = Block::new(&binding);
        block.set("normal", &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0_f32]).unwrap();
        block.set("all[1].color", &[10.0, 11.0, 12.0_f32]).unwrap();
        let found: Vec<f32> =
            block.bytes().as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
        let normal = [1.0, 2.0, 3.0, 0.0, 4.0, 5.0, 6.0, 0.0, 7.0, 8.0, 9.0, 0.0];
        assert_eq!(found[..12], normal);
        assert_eq!(found[12..], [0.0, 0.0, 0.0, 0.0, 10.0, 11.0, 12.0, 0.0]);
    }

    /// A bundle may say of a member what no buffer can have.
    #[test]
    fn members_beyond_the_buffer_are_errors() {
        let mut binding = binding();
        let most = Some(u32::MAX);
        binding.members = vec![
            member("huge", 0, floats(most, most, most)),
            member("far", u32::MAX, floats(None, None, None)),
        ];
        let mut block = Block::new(&binding);
        assert_eq!(
            block.set("huge", &[1.0_f32]).unwrap_err(),
            BlockError::Count("huge".to_owned(), u64::MAX)
        );
        assert!(matches!(block.set("far", &[1.0_f32]), Err(BlockError::Type(..))));
    }

    #[test]
    fn wrong_paths_are_errors() {
        let binding = binding();
        let mut block = Block::new(&binding);
        let error = block.set("norml", &[1.0_f32]).unwrap_err();
        assert_eq!(error.to_string(), "there is no member `norml`; there are: normal, all");
        assert_eq!(
            block.set("all[2].color", &[1.0_f32]).unwrap_err(),
            BlockError::NoElement("all[2].color".to_owned())
        );
        assert_eq!(
            block.set("normal", &[1.0_f32]).unwrap_err(),
            BlockError::Count("normal".to_owned(), 9)
        );
        assert_eq!(
            block.set("normal", &[1_u32; 9]).unwrap_err(),
            BlockError::Type("normal".to_owned(), "T".to_owned())
        );
        assert!(block.set("", &[1.0_f32]).is_err());
    }
}

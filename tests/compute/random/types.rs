//! Types of random programs, and where their numbers lie in a buffer by the rules of WGSL.

use crate::random::Random;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scalar {
    Int,
    Uint,
    Float,
    Bool,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Ty {
    Scalar(Scalar),
    Vector(u32, Scalar),
    /// Columns and rows.
    Matrix(u32, u32),
    Array(Box<Ty>, u32),
    /// The index of a structure.
    Struct(usize),
}

pub const INT: Ty = Ty::Scalar(Scalar::Int);
pub const UINT: Ty = Ty::Scalar(Scalar::Uint);
pub const FLOAT: Ty = Ty::Scalar(Scalar::Float);
pub const BOOL: Ty = Ty::Scalar(Scalar::Bool);

#[derive(Debug, Clone)]
pub struct Struct {
    pub name: String,
    pub members: Vec<Member>,
}

#[derive(Debug, Clone)]
pub struct Member {
    pub name: String,
    pub ty: Ty,
    /// The attribute `@size`, or 0.
    pub size: u32,
}

/// A number of a buffer: its offset, and what it is.
pub type Number = (u32, Scalar);

impl Scalar {
    fn name(self) -> &'static str {
        match self {
            Self::Int => "i32",
            Self::Uint => "u32",
            Self::Float => "f32",
            Self::Bool => "bool",
        }
    }
}

impl Ty {
    pub fn array(of: Self, count: u32) -> Self {
        Self::Array(Box::new(of), count)
    }

    pub fn spelt(&self, structs: &[Struct]) -> String {
        match self {
            Self::Scalar(scalar) => scalar.name().to_owned(),
            Self::Vector(size, Scalar::Bool) => format!("vec{size}<bool>"),
            Self::Vector(size, scalar) => format!("vec{size}{}", &scalar.name()[..1]),
            Self::Matrix(columns, rows) => format!("mat{columns}x{rows}f"),
            Self::Array(of, count) => format!("array<{}, {count}>", of.spelt(structs)),
            Self::Struct(index) => structs[*index].name.clone(),
        }
    }

    pub fn align(&self, structs: &[Struct]) -> u32 {
        match self {
            Self::Scalar(_) => 4,
            Self::Vector(2, _) | Self::Matrix(_, 2) => 8,
            Self::Vector(..) | Self::Matrix(..) => 16,
            Self::Array(of, _) => of.align(structs),
            Self::Struct(index) => {
                let members = structs[*index].members.iter();
                members.map(|member| member.ty.align(structs)).max().unwrap_or(4)
            }
        }
    }

    pub fn size(&self, structs: &[Struct]) -> u32 {
        match self {
            Self::Scalar(_) => 4,
            Self::Vector(size, _) => 4 * size,
            Self::Matrix(columns, _) => columns * self.align(structs),
            Self::Array(of, count) => count * of.stride(structs),
            Self::Struct(index) => {
                let (_, end) = placed(&structs[*index], structs);
                end.next_multiple_of(self.align(structs))
            }
        }
    }

    /// Bytes from one element of an array of them to the next.
    pub fn stride(&self, structs: &[Struct]) -> u32 {
        self.size(structs).next_multiple_of(self.align(structs))
    }

    /// Adds the numbers of the type, which begins at `from`.
    pub fn numbers(&self, structs: &[Struct], from: u32, to: &mut Vec<Number>) {
        match self {
            Self::Scalar(scalar) => to.push((from, *scalar)),
            Self::Vector(size, scalar) => to.extend((0..*size).map(|i| (from + 4 * i, *scalar))),
            Self::Matrix(columns, rows) => {
                for column in 0..*columns {
                    let at = from + column * self.align(structs);
                    to.extend((0..*rows).map(|row| (at + 4 * row, Scalar::Float)));
                }
            }
            Self::Array(of, count) => (0..*count)
                .for_each(|index| of.numbers(structs, from + index * of.stride(structs), to)),
            Self::Struct(index) => {
                let (offsets, _) = placed(&structs[*index], structs);
                for (member, offset) in structs[*index].members.iter().zip(offsets) {
                    member.ty.numbers(structs, from + offset, to);
                }
            }
        }
    }

    pub fn scalar(&self) -> Option<Scalar> {
        match self {
            Self::Scalar(scalar) | Self::Vector(_, scalar) => Some(*scalar),
            Self::Matrix(..) => Some(Scalar::Float),
            Self::Array(..) | Self::Struct(_) => None,
        }
    }
}

/// The offsets of members, and where the last one ends.
fn placed(of: &Struct, structs: &[Struct]) -> (Vec<u32>, u32) {
    let (mut offsets, mut end) = (Vec::new(), 0u32);
    for member in &of.members {
        end = end.next_multiple_of(member.ty.align(structs));
        offsets.push(end);
        end += member.ty.size(structs).max(member.size);
    }
    (offsets, end)
}

/// The bytes of a buffer with random numbers, which ends after the last of them.
pub fn random_bytes(numbers: &[Number], size: u32, random: &mut Random) -> Vec<u8> {
    let mut bytes = vec![0; size as usize];
    for (offset, scalar) in numbers {
        let word = match scalar {
            Scalar::Float => quarter(random).to_bits(),
            _ if random.chance(50) => random.below(9) as u32,
            _ => *random.pick(&EXTREME) ^ random.below(3) as u32,
        };
        let at = *offset as usize;
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
    }
    bytes
}

/// Words at the ends of what integers hold.
const EXTREME: [u32; 6] = [0, u32::MAX, 0x7fff_ffff, 0x8000_0000, 0xaaaa_5555, 31];

/// A multiple of 1/4 from -16 to 16, which arithmetic with a few operations keeps exact.
pub fn quarter(random: &mut Random) -> f32 {
    random.below(129) as f32 / 4.0 - 16.0
}

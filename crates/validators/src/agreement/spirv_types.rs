//! The types of a module in SPIR-V, laid out by their decorations.

use std::collections::{BTreeMap, BTreeSet};

use lamplight_emit::padding::PADDING;
use lamplight_emit::spirv::{op, string};

use super::reading::{MOST_LEVELS, ReadMember, ReadType};

/// Opcodes, beside those of [`op`].
const TYPE_BOOL: u16 = 20;
const TYPE_FLOAT: u16 = 22;
const TYPE_VECTOR: u16 = 23;
const TYPE_MATRIX: u16 = 24;
const TYPE_SAMPLED_IMAGE: u16 = 27;

/// Decorations.
const ROW_MAJOR: u32 = 4;
const ARRAY_STRIDE: u32 = 6;
const MATRIX_STRIDE: u32 = 7;
const OFFSET: u32 = 35;

/// Types, constants, names and decorations, by id.
#[derive(Default)]
pub struct SpirvTypes<'w> {
    /// The opcode, and the words behind the id.
    types: BTreeMap<u32, (u16, &'w [u32])>,
    constants: BTreeMap<u32, u32>,
    names: BTreeMap<u32, String>,
    /// The decoration and its operands.
    decorations: BTreeMap<u32, Vec<&'w [u32]>>,
    /// The same of members, by structure and index.
    members: BTreeMap<(u32, u32), Vec<&'w [u32]>>,
    /// Members that fill gaps.
    padding: BTreeSet<(u32, u32)>,
}

/// The operand of a decoration, or 0 if it has none.
fn find_decoration(all: Option<&Vec<&[u32]>>, wanted: u32) -> Option<u32> {
    let found = all?.iter().find(|one| one.first() == Some(&wanted))?;
    Some(found.get(1).copied().unwrap_or(0))
}

impl<'w> SpirvTypes<'w> {
    /// Takes in an instruction.
    pub fn see(&mut self, op: u16, words: &'w [u32]) {
        match (op, words) {
            (op::NAME, [_, id, name @ ..]) => _ = self.names.insert(*id, string(name)),
            (op::MEMBER_NAME, [_, id, member, name @ ..]) if string(name).starts_with(PADDING) => {
                self.padding.insert((*id, *member));
            }
            (op::DECORATE, [_, id, decoration @ ..]) => {
                self.decorations.entry(*id).or_default().push(decoration);
            }
            (op::MEMBER_DECORATE, [_, id, member, decoration @ ..]) => {
                self.members.entry((*id, *member)).or_default().push(decoration);
            }
            (op::CONSTANT | op::SPEC_CONSTANT, [_, _, id, value, ..]) => {
                self.constants.insert(*id, *value);
            }
            (TYPE_BOOL..=op::TYPE_STRUCT, [_, id, parts @ ..]) => {
                self.types.insert(*id, (op, parts));
            }
            _ => {}
        }
    }

    /// The name of an id, if it has one.
    pub fn name(&self, id: u32) -> Option<&str> {
        self.names.get(&id).map(String::as_str).filter(|name| !name.is_empty())
    }

    /// The value of a constant, or the default of one that a pipeline chooses.
    pub fn constant(&self, id: u32) -> Option<u32> {
        self.constants.get(&id).copied()
    }

    /// The operand of a decoration.
    pub fn decoration(&self, id: u32, wanted: u32) -> Option<u32> {
        find_decoration(self.decorations.get(&id), wanted)
    }

    /// Whether an id has a decoration.
    pub fn is_decorated(&self, id: u32, wanted: u32) -> bool {
        self.decoration(id, wanted).is_some()
    }

    /// The opcode that declares a type.
    pub fn opcode(&self, ty: u32) -> Option<u16> {
        self.types.get(&ty).map(|(op, _)| *op)
    }

    /// The elements of an array, and their number; 0 if it has none.
    pub fn array_parts(&self, ty: u32) -> Option<(u32, u32)> {
        match self.types.get(&ty)? {
            (op::TYPE_ARRAY, [element, count]) => Some((*element, self.constant(*count)?)),
            (op::TYPE_RUNTIME_ARRAY, [element]) => Some((*element, 0)),
            _ => None,
        }
    }

    /// Whether a type is an image that is written to.
    pub fn is_storage_image(&self, ty: u32) -> bool {
        matches!(self.types.get(&ty), Some((op::TYPE_IMAGE, [_, _, _, _, _, 2, ..])))
    }

    /// The dimension of a texture.
    pub fn dimension(&self, ty: u32) -> Option<String> {
        let (dim, arrayed) = match self.types.get(&ty)? {
            (op::TYPE_IMAGE, [_, dim, _, arrayed, ..]) => (*dim, *arrayed != 0),
            (TYPE_SAMPLED_IMAGE, [image]) => return self.image_dimension(*image),
            _ => return None,
        };
        let name = match dim {
            0 => "1d",
            1 => "2d",
            2 => "3d",
            3 => "cube",
            _ => return None,
        };
        Some(if arrayed { format!("{name}_array") } else { name.to_owned() })
    }

    fn image_dimension(&self, image: u32) -> Option<String> {
        match self.types.get(&image)? {
            (op::TYPE_IMAGE, _) => self.dimension(image),
            _ => None,
        }
    }

    /// A type as it lies in a buffer.
    pub fn read_type(&self, ty: u32) -> Result<ReadType, String> {
        self.read_at(ty, None, MOST_LEVELS)
    }

    /// Parameter `place`: the structure and the member that have the type, whose decorations say how
    /// matrices lie.
    fn read_at(
        &self,
        ty: u32,
        place: Option<(u32, u32)>,
        levels: usize,
    ) -> Result<ReadType, String> {
        let levels = levels.checked_sub(1).ok_or("its types are nested too deep")?;
        let (op, parts) = self.types.get(&ty).ok_or("a type is not declared")?;
        match (*op, *parts) {
            (TYPE_VECTOR, [scalar, rows]) => {
                let (scalar, width) = self.scalar(*scalar)?;
                Ok(ReadType::Number { scalar, width, rows: Some(*rows), columns: None })
            }
            (TYPE_MATRIX, [column, columns]) => self.read_matrix(*column, *columns, place),
            (op::TYPE_ARRAY | op::TYPE_RUNTIME_ARRAY, _) => {
                let (element, count) = self.array_parts(ty).ok_or("an array has no length")?;
                let element = Box::new(self.read_at(element, place, levels)?);
                let stride = self.decoration(ty, ARRAY_STRIDE);
                Ok(ReadType::Array { element, count, stride })
            }
            (op::TYPE_STRUCT, types) => {
                let places = (0..).map(|index| (ty, index));
                let own = places.zip(types).filter(|(place, _)| !self.padding.contains(place));
                let member = |(place, member): ((u32, u32), &u32)| {
                    let offset = find_decoration(self.members.get(&place), OFFSET);
                    let offset = Some(offset.ok_or("a member of a block has no offset")?);
                    Ok(ReadMember { offset, ty: self.read_at(*member, Some(place), levels)? })
                };
                let members = own.map(member).collect::<Result<_, String>>()?;
                Ok(ReadType::Struct { members, size: None })
            }
            _ => {
                let (scalar, width) = self.scalar(ty)?;
                Ok(ReadType::Number { scalar, width, rows: None, columns: None })
            }
        }
    }

    fn read_matrix(
        &self,
        column: u32,
        columns: u32,
        place: Option<(u32, u32)>,
    ) -> Result<ReadType, String> {
        let Some((TYPE_VECTOR, [scalar, rows])) = self.types.get(&column) else {
            return Err("a matrix has no columns".to_owned());
        };
        let decorated = place.and_then(|place| self.members.get(&place));
        if find_decoration(decorated, ROW_MAJOR).is_some() {
            return Err("a matrix in a buffer is stored by rows".to_owned());
        }
        let stride = find_decoration(decorated, MATRIX_STRIDE);
        let (scalar, width) = self.scalar(*scalar)?;
        let columns = Some((columns, Some(stride.ok_or("a matrix in a buffer has no stride")?)));
        Ok(ReadType::Number { scalar, width, rows: Some(*rows), columns })
    }

    /// The name of a scalar type in WGSL, and its bytes.
    fn scalar(&self, ty: u32) -> Result<(String, u32), String> {
        let (letter, bits) = match self.types.get(&ty) {
            Some((op::TYPE_INT, [bits, 0])) => ("u", *bits),
            Some((op::TYPE_INT, [bits, _])) => ("i", *bits),
            Some((TYPE_FLOAT, [bits, ..])) => ("f", *bits),
            other => return Err(format!("{other:?} is no type of numbers")),
        };
        Ok((format!("{letter}{bits}"), bits / 8))
    }
}

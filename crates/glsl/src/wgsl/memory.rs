//! How variables lie in memory that the host fills: where GLSL's rules and WGSL's differ, members
//! get sizes, elements are wrapped, and matrices become columns.

use std::rc::Rc;

use rustc_hash::FxHashMap;

use super::Writer;
use crate::lexer::At;
use crate::tree::Packing;
use crate::types::{Scalar, Type};

/// The form of a value in memory.
#[derive(Debug, PartialEq)]
pub(super) enum Mem {
    /// As everywhere else.
    Value,
    /// `u32` for `bool`, or a vector of it.
    Bool,
    /// An atomic integer.
    Atomic,
    /// An array whose elements have another form, or are wrapped in a structure with padding.
    Array { element: Rc<Self>, wrapped: bool, name: String },
    /// A matrix as an array of wrapped columns.
    Columns,
    /// A matrix whose rows are stored as columns.
    RowMajor(Rc<Self>),
    /// A structure whose members have other forms; its name.
    Struct(String, Vec<Rc<Self>>),
}

/// A type in memory: its form, its text, and its sizes by both languages' rules.
#[derive(Debug, Clone)]
pub(super) struct Cell {
    pub(super) text: String,
    pub(super) mem: Rc<Mem>,
    /// Alignment and size by the rules of the block.
    align: u32,
    size: u32,
    /// Alignment and size of the text in WGSL.
    own_align: u32,
    own_size: u32,
}

impl Cell {
    /// Its size by the rules of the block.
    pub(super) fn size(&self) -> u32 {
        self.size
    }
}

/// The rules of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Rules {
    pub(super) packing: Packing,
    pub(super) row_major: bool,
    pub(super) uniform: bool,
}

/// Structures that were made for memory.
#[derive(Debug, Default)]
pub(super) struct Stored {
    wrappers: std::collections::BTreeMap<String, String>,
    variants: FxHashMap<(u32, Rules), Cell>,
    texts: Vec<String>,
    /// Attributes of the members of structures that are the same in memory but for these.
    pub(super) attributes: FxHashMap<u32, Vec<String>>,
}

impl Stored {
    pub(super) fn declarations(&self) -> Vec<String> {
        self.texts.iter().cloned().chain(self.wrappers.values().cloned()).collect()
    }
}

fn round_up(value: u32, align: u32) -> u32 {
    value.div_ceil(align.max(1)).saturating_mul(align.max(1))
}

impl Writer<'_> {
    /// A type by the rules of a block.
    pub(super) fn cell(&mut self, ty: &Type, rules: Rules, at: At) -> Option<Cell> {
        match ty {
            Type::Scalar(_) | Type::Vector(..) => Some(self.number_cell(ty, rules)),
            Type::Matrix(scalar, columns, rows) => {
                Some(self.matrix_cell((*scalar, *columns, *rows), rules))
            }
            Type::Array(element, size) => self.array_cell(element, *size, rules, at),
            Type::Struct(index) => self.struct_cell(*index, rules),
            Type::Void | Type::Opaque(_) => None,
        }
    }

    fn number_cell(&self, ty: &Type, rules: Rules) -> Cell {
        let (scalar, size) = ty.as_vector().unwrap_or((Scalar::Float, 1));
        let is_bool = scalar == Scalar::Bool;
        let stored = if is_bool { ty.with_scalar(Scalar::Uint) } else { ty.clone() };
        let bytes = 4 * u32::from(size);
        let own_align = if size == 3 { 16 } else { bytes };
        let align = if rules.packing == Packing::Scalar { 4 } else { own_align };
        let mem = Rc::new(if is_bool { Mem::Bool } else { Mem::Value });
        let text = self.type_text(&stored);
        Cell { text, mem, align, size: bytes, own_align, own_size: bytes }
    }

    fn matrix_cell(&mut self, shape: (Scalar, u8, u8), rules: Rules) -> Cell {
        let (scalar, columns, rows) = shape;
        if rules.row_major {
            let mut cell =
                self.matrix_cell((scalar, rows, columns), Rules { row_major: false, ..rules });
            cell.mem = Rc::new(Mem::RowMajor(Rc::clone(&cell.mem)));
            return cell;
        }
        let column = self.number_cell(&Type::Vector(scalar, rows), rules);
        let least = if rules.packing == Packing::Std140 { 16 } else { 1 };
        let align = column.align.max(least);
        let stride = round_up(column.size, align);
        let count = u32::from(columns);
        let own_stride = round_up(column.own_size, column.own_align);
        if stride == own_stride {
            let text = self.type_text(&Type::Matrix(scalar, columns, rows));
            let (own_align, own_size) = (column.own_align, own_stride * count);
            let mem = Rc::new(Mem::Value);
            return Cell { text, mem, align, size: stride * count, own_align, own_size };
        }
        let wrapper = self.wrapper(&column.text, stride);
        Cell {
            text: format!("array<{wrapper}, {columns}>"),
            mem: Rc::new(Mem::Columns),
            align,
            size: stride * count,
            own_align: column.own_align,
            own_size: stride * count,
        }
    }

    /// A structure with one member, which has the size of an element.
    fn wrapper(&mut self, element: &str, stride: u32) -> String {
        let plain: String =
            element.chars().filter(|letter| letter.is_ascii_alphanumeric()).collect();
        let key = format!("{element} {stride}");
        if let Some(text) = self.stored.wrappers.get(&key) {
            let name = text.split_whitespace().nth(1).unwrap_or_default();
            return name.to_owned();
        }
        let name = self.global_name(&format!("Padded_{plain}"));
        let text = format!("struct {name} {{\n    @size({stride}) value: {element},\n}}");
        self.stored.wrappers.insert(key, text);
        name
    }

    fn array_cell(
        &mut self,
        element: &Type,
        size: Option<u32>,
        rules: Rules,
        at: At,
    ) -> Option<Cell> {
        let inner = self.cell(element, rules, at)?;
        let least = if rules.packing == Packing::Std140 { 16 } else { 1 };
        let align = inner.align.max(least);
        let stride = round_up(inner.size, align);
        let own_stride = round_up(inner.own_size, inner.own_align);
        if stride < own_stride || (rules.uniform && !stride.is_multiple_of(16)) {
            let message = format!("an array with {stride} bytes for each element is not in WGSL");
            self.refuse(at, message);
            return None;
        }
        let wrapped = stride > own_stride;
        let text = if wrapped { self.wrapper(&inner.text, stride) } else { inner.text };
        let name = match size {
            Some(size) => format!("array<{text}, {size}>"),
            None => format!("array<{text}>"),
        };
        let plain = !wrapped && *inner.mem == Mem::Value;
        let mem = if plain {
            Mem::Value
        } else {
            Mem::Array { element: inner.mem, wrapped, name: name.clone() }
        };
        let total = stride.saturating_mul(size.unwrap_or(1));
        Some(Cell {
            text: name,
            mem: Rc::new(mem),
            align,
            size: total,
            own_align: inner.own_align,
            own_size: total,
        })
    }

    /// A structure in memory: the same as elsewhere, perhaps with sizes of members, or one of its
    /// own.
    fn struct_cell(&mut self, index: u32, rules: Rules) -> Option<Cell> {
        if let Some(cell) = self.stored.variants.get(&(index, rules)) {
            return Some(cell.clone());
        }
        let members = self.place_members(index, rules)?;
        let plain = members.cells.iter().all(|cell| *cell.mem == Mem::Value);
        let known = self.stored.attributes.get(&index);
        let fits = known.is_none_or(|known| *known == members.attributes);
        let is_block = self.shader.structs[index as usize].block;
        let name = self.struct_names[index as usize].clone();
        let (text, mem) = if is_block || (plain && fits) {
            self.stored.attributes.insert(index, members.attributes.clone());
            let mems = members.cells.iter().map(|cell| Rc::clone(&cell.mem)).collect();
            (name.clone(), if plain { Mem::Value } else { Mem::Struct(name, mems) })
        } else {
            let suffix = match rules.packing {
                Packing::Std140 => "std140",
                Packing::Std430 => "std430",
                Packing::Scalar => "scalar",
            };
            let name = self.global_name(&format!("{name}_{suffix}"));
            let fields: String = (0..members.cells.len())
                .filter(|at| !members.cells[*at].text.is_empty())
                .map(|at| {
                    let member = self.member_name(index, at as u32);
                    let text = &members.cells[at].text;
                    format!("    {}{member}: {text},\n", members.attributes[at])
                })
                .collect();
            self.stored.texts.push(format!("struct {name} {{\n{fields}}}"));
            let mems = members.cells.iter().map(|cell| Rc::clone(&cell.mem)).collect();
            (name.clone(), Mem::Struct(name, mems))
        };
        let cell = Cell { text, mem: Rc::new(mem), ..members.whole };
        self.stored.variants.insert((index, rules), cell.clone());
        Some(cell)
    }

    /// A member for the bytes before the first one of the text.
    fn pad_start(&mut self, placed: &mut Placed, bytes: u32) {
        let name = self.temporary();
        let text = match bytes % 16 {
            0 => format!("@size({bytes}) before_{name}: vec4f,\n    "),
            _ => format!("@size({bytes}) before_{name}: f32,\n    "),
        };
        if let Some(first) = placed.attributes.first_mut() {
            first.insert_str(0, &text);
        }
    }

    /// Where the members lie, and which attributes put them there in WGSL.
    fn place_members(&mut self, index: u32, rules: Rules) -> Option<Placed> {
        let shader = self.shader;
        let content = &shader.structs[index as usize];
        let mut cells = Vec::with_capacity(content.members.len());
        let mut offsets: Vec<u32> = Vec::new();
        let (mut end, mut align) = (0_u32, 1_u32);
        for field in &content.members {
            if field.ty.is_opaque() {
                // Textures of a structure are variables of their own.
                offsets.push(end);
                cells.push(empty_cell(1, 0));
                continue;
            }
            let row_major = field.row_major.unwrap_or(rules.row_major);
            let cell = self.cell(&field.ty, Rules { row_major, ..rules }, field.at)?;
            align = align.max(cell.align);
            let natural = round_up(end, cell.align.max(field.align.unwrap_or(1)));
            let offset = match field.offset {
                Some(offset) => round_up(offset, field.align.unwrap_or(1)),
                None => natural,
            };
            if offset < end || offset % cell.own_align != 0 {
                let message = format!("WGSL does not put this member at byte {offset}");
                self.refuse(field.at, message);
                return None;
            }
            end = offset.saturating_add(cell.size);
            offsets.push(offset);
            cells.push(cell);
        }
        if rules.packing == Packing::Std140 && !content.block {
            align = round_up(align, 16);
        }
        let size = if content.block { end } else { round_up(end, align) };
        let whole = empty_cell(align, size);
        let mut placed = Placed { attributes: Vec::new(), whole, cells, block: content.block };
        placed.add_sizes(&offsets, size);
        let first = offsets.first().copied().unwrap_or(0);
        if first > 0 {
            self.pad_start(&mut placed, first);
        }
        Some(placed)
    }
}

fn empty_cell(align: u32, size: u32) -> Cell {
    let mem = Rc::new(Mem::Value);
    Cell { text: String::new(), mem, align, size, own_align: 1, own_size: size }
}

struct Placed {
    block: bool,
    attributes: Vec<String>,
    cells: Vec<Cell>,
    whole: Cell,
}

impl Placed {
    /// Sizes of members, where WGSL would put the next one elsewhere.
    fn add_sizes(&mut self, offsets: &[u32], size: u32) {
        let own_align = self.cells.iter().map(|cell| cell.own_align).max().unwrap_or(1);
        for (index, cell) in self.cells.iter().enumerate() {
            let end = offsets[index].saturating_add(cell.own_size);
            let later = self.cells.iter().zip(offsets).skip(index + 1);
            let mut later = later.filter(|(next, _)| !next.text.is_empty());
            let attribute = match later.next().unzip() {
                (Some(next), Some(offset)) if round_up(end, next.own_align) != *offset => {
                    format!("@size({}) ", offset - offsets[index])
                }
                (Some(_), _) => String::new(),
                (None, _) if self.block || round_up(end, own_align) == size => String::new(),
                (None, _) => format!("@size({}) ", size - offsets[index]),
            };
            self.attributes.push(attribute);
        }
        self.whole.own_align = own_align;
        self.whole.own_size = round_up(size, own_align);
    }
}

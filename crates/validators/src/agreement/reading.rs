//! What a reader finds in an output.

use lamplight_bundle::{BindingKind, Shape, Stage};

/// How deep types may be nested. WGSL allows 15 levels, and some languages need a few more for
/// wrappers. Hostile bytes could nest without an end.
pub const MOST_LEVELS: usize = 32;

/// An output. What a language does not say is `None`.
#[derive(Debug, Default)]
pub struct Reading {
    /// Name of the entry point.
    pub entry: Option<String>,
    /// Its stage.
    pub stage: Option<Stage>,
    /// The size of its workgroups.
    pub workgroup_size: Option<[u32; 3]>,
    /// What it binds.
    pub bindings: Vec<ReadBinding>,
}

/// One resource of an output.
#[derive(Debug, Default)]
pub struct ReadBinding {
    /// Descriptor set or register space.
    pub space: Option<u32>,
    /// Binding, register, index or unit.
    pub index: Option<u32>,
    /// The class of the register.
    pub register: Option<String>,
    /// The name by which hosts look it up.
    pub name: Option<String>,
    /// What is bound. Languages do not tell samplers that compare from others: see [`same_kind`].
    pub kind: Option<BindingKind>,
    /// How many bindings an array of them has; 0 if the host decides it.
    pub count: Option<u32>,
    /// The type of a buffer.
    pub ty: Option<ReadType>,
    /// `1d`, `2d`, `2d_array`, `3d`, `cube` or `cube_array`, of a texture.
    pub dimension: Option<String>,
}

/// A type in a buffer, laid out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ReadType {
    /// A scalar, a vector or a matrix.
    Number {
        /// `f32` and the like.
        scalar: String,
        /// Bytes of a scalar.
        width: u32,
        /// Components of a vector or a column.
        rows: Option<u32>,
        /// Columns of a matrix, and the bytes from one to the next, if they are known.
        columns: Option<(u32, Option<u32>)>,
    },
    /// An array.
    Array {
        /// Its elements.
        element: Box<ReadType>,
        /// Their number; 0 if the buffer decides it.
        count: u32,
        /// Bytes from one to the next, if they are known.
        stride: Option<u32>,
    },
    /// A structure.
    Struct {
        /// In order, without padding.
        members: Vec<ReadMember>,
        /// Its bytes, if they are known.
        size: Option<u32>,
    },
}

/// A member of a structure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReadMember {
    /// Offset in the structure, if it is known.
    pub offset: Option<u32>,
    /// Its type.
    pub ty: ReadType,
}

/// A number of bytes as far as a language says it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReadSize {
    /// So many.
    Exact(u32),
    /// So many or more: padding at the end of a structure is not said.
    AtLeast(u32),
}

impl ReadType {
    /// Its bytes. A runtime-sized array counts as one element, as in WebGPU's minimum binding size.
    pub fn size(&self) -> ReadSize {
        match self {
            Self::Number { scalar: _, width, rows, columns } => {
                let column = width.saturating_mul(rows.unwrap_or(1));
                match columns {
                    Some((columns, Some(stride))) => {
                        ReadSize::Exact(columns.saturating_mul(*stride))
                    }
                    Some((columns, None)) => ReadSize::AtLeast(columns.saturating_mul(column)),
                    None => ReadSize::Exact(column),
                }
            }
            Self::Array { element: _, count, stride: Some(stride) } => {
                ReadSize::Exact(stride.saturating_mul((*count).max(1)))
            }
            Self::Array { element, count, stride: None } => {
                ReadSize::AtLeast(element.size().bytes().saturating_mul((*count).max(1)))
            }
            Self::Struct { members: _, size: Some(size) } => ReadSize::Exact(*size),
            Self::Struct { members, size: None } => {
                let end = |member: &ReadMember| {
                    member.offset.unwrap_or(0).saturating_add(member.ty.size().bytes())
                };
                ReadSize::AtLeast(members.iter().map(end).max().unwrap_or(0))
            }
        }
    }

    /// The shape that a reflection has for it.
    pub fn shape(&self) -> Option<Shape> {
        match self {
            Self::Number { scalar, width: _, rows, columns } => Some(Shape {
                scalar: Some(scalar.clone()),
                rows: *rows,
                columns: columns.map(|(columns, _)| columns),
                matrix_stride: columns.and_then(|(_, stride)| stride),
                count: None,
            }),
            Self::Array { element, count, stride: _ } => {
                let element = match **element {
                    Self::Array { .. } => Shape::default(),
                    _ => element.shape().unwrap_or_default(),
                };
                Some(Shape { count: Some(*count), ..element })
            }
            Self::Struct { .. } => None,
        }
    }

    /// The members of a structure, or of the elements of an array of structures.
    pub fn members(&self) -> &[ReadMember] {
        match self {
            Self::Struct { members, size: _ } => members,
            Self::Array { element, .. } => element.members(),
            Self::Number { .. } => &[],
        }
    }

    /// The stride of an array.
    pub fn stride(&self) -> Option<u32> {
        match self {
            Self::Array { stride, .. } => *stride,
            Self::Number { .. } | Self::Struct { .. } => None,
        }
    }
}

impl ReadSize {
    /// The bytes that are certain.
    pub fn bytes(self) -> u32 {
        match self {
            Self::Exact(bytes) | Self::AtLeast(bytes) => bytes,
        }
    }

    /// Whether so many bytes agree with it.
    pub fn is(self, bytes: u32) -> bool {
        match self {
            Self::Exact(found) => found == bytes,
            Self::AtLeast(found) => found <= bytes,
        }
    }
}

/// Whether a reader may take what a reflection has for what it found. Samplers that compare look
/// like others in most languages, and immediates are uniform buffers in them.
pub fn same_kind(found: BindingKind, reflected: BindingKind) -> bool {
    let plain = |kind| match kind {
        BindingKind::ComparisonSampler => BindingKind::Sampler,
        BindingKind::Immediate => BindingKind::Uniform,
        kind => kind,
    };
    plain(found) == plain(reflected)
}

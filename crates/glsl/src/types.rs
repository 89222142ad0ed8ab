//! The types of GLSL.

use std::fmt;
use std::rc::Rc;

/// What a number is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Scalar {
    /// `bool`
    Bool,
    /// `int`
    Int,
    /// `uint`
    Uint,
    /// `float`
    Float,
    /// `double`
    Double,
}

/// How many coordinates a texture has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Dim {
    /// One.
    D1,
    /// Two.
    D2,
    /// Three.
    D3,
    /// A direction.
    Cube,
    /// Two, in pixels.
    Rect,
    /// An index.
    Buffer,
}

/// What an opaque variable is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum OpaqueKind {
    /// `sampler2D`: a texture with its sampler.
    Combined,
    /// `texture2D` of Vulkan.
    Texture,
    /// `sampler`, `samplerShadow`.
    Sampler,
    /// `image2D`.
    Image,
    /// `subpassInput`.
    Subpass,
    /// `atomic_uint`, acceleration structures and others.
    Other,
}

/// An opaque type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Opaque {
    /// What it is.
    pub kind: OpaqueKind,
    /// What its values are.
    pub scalar: Scalar,
    /// Its coordinates.
    pub dim: Dim,
    /// Whether it has layers.
    pub arrayed: bool,
    /// Whether it has samples.
    pub multisampled: bool,
    /// Whether it compares.
    pub shadow: bool,
}

/// A type.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Type {
    /// `void`
    Void,
    /// A number.
    Scalar(Scalar),
    /// Two to four numbers.
    Vector(Scalar, u8),
    /// Columns and rows.
    Matrix(Scalar, u8, u8),
    /// Elements and how many; `None` for a size that is not known yet.
    Array(Rc<Type>, Option<u32>),
    /// A structure by its index.
    Struct(u32),
    /// A texture, a sampler or an image.
    Opaque(Opaque),
}

/// `float`
pub const FLOAT: Type = Type::Scalar(Scalar::Float);
/// `int`
pub const INT: Type = Type::Scalar(Scalar::Int);
/// `uint`
pub const UINT: Type = Type::Scalar(Scalar::Uint);
/// `bool`
pub const BOOL: Type = Type::Scalar(Scalar::Bool);

impl Type {
    /// A vector, or a number for size 1.
    pub fn vector(scalar: Scalar, size: u8) -> Self {
        if size == 1 { Self::Scalar(scalar) } else { Self::Vector(scalar, size) }
    }

    /// The numbers of a scalar, vector or matrix.
    pub fn scalar(&self) -> Option<Scalar> {
        match self {
            Self::Scalar(scalar) | Self::Vector(scalar, _) | Self::Matrix(scalar, _, _) => {
                Some(*scalar)
            }
            _ => None,
        }
    }

    /// The numbers of an expression that is a scalar or a vector, and how many.
    pub fn as_vector(&self) -> Option<(Scalar, u8)> {
        match self {
            Self::Scalar(scalar) => Some((*scalar, 1)),
            Self::Vector(scalar, size) => Some((*scalar, *size)),
            _ => None,
        }
    }

    /// The same shape with other numbers.
    pub fn with_scalar(&self, scalar: Scalar) -> Self {
        match self {
            Self::Scalar(_) => Self::Scalar(scalar),
            Self::Vector(_, size) => Self::Vector(scalar, *size),
            Self::Matrix(_, columns, rows) => Self::Matrix(scalar, *columns, *rows),
            other => other.clone(),
        }
    }

    /// How many numbers a scalar, vector or matrix has.
    pub fn components(&self) -> u32 {
        match self {
            Self::Scalar(_) => 1,
            Self::Vector(_, size) => u32::from(*size),
            Self::Matrix(_, columns, rows) => u32::from(*columns) * u32::from(*rows),
            _ => 0,
        }
    }

    /// What an index gives.
    pub fn element(&self) -> Option<Self> {
        match self {
            Self::Vector(scalar, _) => Some(Self::Scalar(*scalar)),
            Self::Matrix(scalar, _, rows) => Some(Self::Vector(*scalar, *rows)),
            Self::Array(element, _) => Some((**element).clone()),
            _ => None,
        }
    }

    /// The type below all array sizes.
    pub fn innermost(&self) -> &Self {
        match self {
            Self::Array(element, _) => element.innermost(),
            other => other,
        }
    }

    /// Whether it is made of integers.
    pub fn is_integer(&self) -> bool {
        matches!(self.innermost().scalar(), Some(Scalar::Int | Scalar::Uint))
    }

    /// An array of it.
    pub fn array(self, size: Option<u32>) -> Self {
        Self::Array(Rc::new(self), size)
    }

    /// Whether it is a texture, sampler or image, or an array of them.
    pub fn is_opaque(&self) -> bool {
        matches!(self.innermost(), Self::Opaque(_))
    }
}

/// The type with that name, if it is one of the language's own.
pub fn named_type(name: &str) -> Option<Type> {
    let plain = match name {
        "void" => Type::Void,
        "float" => FLOAT,
        "int" => INT,
        "uint" => UINT,
        "bool" => BOOL,
        "double" => Type::Scalar(Scalar::Double),
        _ => return vector_type(name).or_else(|| matrix_type(name)).or_else(|| opaque_type(name)),
    };
    Some(plain)
}

fn vector_type(name: &str) -> Option<Type> {
    let (prefix, size) = name.split_at_checked(name.len().checked_sub(1)?)?;
    let scalar = match prefix {
        "vec" => Scalar::Float,
        "ivec" => Scalar::Int,
        "uvec" => Scalar::Uint,
        "bvec" => Scalar::Bool,
        "dvec" => Scalar::Double,
        _ => return None,
    };
    Some(Type::Vector(scalar, small_size(size)?))
}

fn small_size(text: &str) -> Option<u8> {
    text.parse().ok().filter(|size| (2..=4).contains(size))
}

fn matrix_type(name: &str) -> Option<Type> {
    let (scalar, sizes) = match name.strip_prefix("dmat") {
        Some(sizes) => (Scalar::Double, sizes),
        None => (Scalar::Float, name.strip_prefix("mat")?),
    };
    let (columns, rows) = sizes.split_once('x').unwrap_or((sizes, sizes));
    Some(Type::Matrix(scalar, small_size(columns)?, small_size(rows)?))
}

/// Opaque types that no rule makes, which are refused where they are used.
const OTHER: &[&str] = &["atomic_uint", "accelerationStructureEXT", "rayQueryEXT"];

fn opaque_type(name: &str) -> Option<Type> {
    if OTHER.contains(&name) {
        return Some(opaque(OpaqueKind::Other, Scalar::Uint, Dim::Buffer, [false; 3]));
    }
    if name == "sampler" || name == "samplerShadow" {
        let shadow = name == "samplerShadow";
        return Some(opaque(OpaqueKind::Sampler, Scalar::Float, Dim::D2, [false, false, shadow]));
    }
    let (scalar, rest) = match name.as_bytes().first()? {
        b'i' if !name.starts_with("image") => (Scalar::Int, &name[1..]),
        b'u' => (Scalar::Uint, &name[1..]),
        _ => (Scalar::Float, name),
    };
    if let Some(rest) = rest.strip_prefix("subpassInput") {
        let multisampled = rest == "MS";
        let known = rest.is_empty() || multisampled;
        return known
            .then(|| opaque(OpaqueKind::Subpass, scalar, Dim::D2, [false, multisampled, false]));
    }
    const KINDS: [(&str, OpaqueKind); 3] = [
        ("sampler", OpaqueKind::Combined),
        ("texture", OpaqueKind::Texture),
        ("image", OpaqueKind::Image),
    ];
    let (kind, rest) =
        KINDS.iter().find_map(|(prefix, kind)| Some((*kind, rest.strip_prefix(prefix)?)))?;
    let (dim, rest) = dimension(rest)?;
    let (multisampled, rest) = take_suffix(rest, "MS");
    let (arrayed, rest) = take_suffix(rest, "Array");
    let (shadow, rest) = take_suffix(rest, "Shadow");
    let sensible = !shadow || (scalar == Scalar::Float && kind == OpaqueKind::Combined);
    (rest.is_empty() && sensible)
        .then(|| opaque(kind, scalar, dim, [arrayed, multisampled, shadow]))
}

fn opaque(kind: OpaqueKind, scalar: Scalar, dim: Dim, flags: [bool; 3]) -> Type {
    let [arrayed, multisampled, shadow] = flags;
    Type::Opaque(Opaque { kind, scalar, dim, arrayed, multisampled, shadow })
}

fn dimension(text: &str) -> Option<(Dim, &str)> {
    const DIMS: [(&str, Dim); 6] = [
        ("1D", Dim::D1),
        ("2DRect", Dim::Rect),
        ("2D", Dim::D2),
        ("3D", Dim::D3),
        ("Cube", Dim::Cube),
        ("Buffer", Dim::Buffer),
    ];
    DIMS.iter().find_map(|(prefix, dim)| Some((*dim, text.strip_prefix(prefix)?)))
}

fn take_suffix<'a>(text: &'a str, word: &str) -> (bool, &'a str) {
    match text.strip_prefix(word) {
        Some(rest) => (true, rest),
        None => (false, text),
    }
}

impl Opaque {
    /// How many numbers a coordinate has, without a reference value.
    pub fn coordinates(&self) -> u8 {
        let flat = match self.dim {
            Dim::D1 | Dim::Buffer => 1,
            Dim::D2 | Dim::Rect => 2,
            Dim::D3 | Dim::Cube => 3,
        };
        flat + u8::from(self.arrayed)
    }

    /// How many numbers an offset has.
    pub fn flat(&self) -> u8 {
        self.coordinates() - u8::from(self.arrayed)
    }

    /// Its name in GLSL.
    pub fn glsl_name(&self) -> String {
        let prefix = match self.scalar {
            Scalar::Int => "i",
            Scalar::Uint => "u",
            _ => "",
        };
        let kind = match self.kind {
            OpaqueKind::Combined => "sampler",
            OpaqueKind::Texture => "texture",
            OpaqueKind::Image => "image",
            OpaqueKind::Sampler if self.shadow => return "samplerShadow".to_owned(),
            OpaqueKind::Sampler => return "sampler".to_owned(),
            OpaqueKind::Subpass => return format!("{prefix}subpassInput"),
            OpaqueKind::Other => return "an opaque type".to_owned(),
        };
        let dim = match self.dim {
            Dim::D1 => "1D",
            Dim::D2 => "2D",
            Dim::D3 => "3D",
            Dim::Cube => "Cube",
            Dim::Rect => "2DRect",
            Dim::Buffer => "Buffer",
        };
        let flags = [(self.multisampled, "MS"), (self.arrayed, "Array"), (self.shadow, "Shadow")];
        let suffix: String = flags.iter().filter(|(set, _)| *set).map(|(_, text)| *text).collect();
        format!("{prefix}{kind}{dim}{suffix}")
    }
}

impl fmt::Display for Scalar {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Bool => "bool",
            Self::Int => "int",
            Self::Uint => "uint",
            Self::Float => "float",
            Self::Double => "double",
        })
    }
}

impl fmt::Display for Type {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let letter = |scalar: &Scalar| match scalar {
            Scalar::Bool => "b",
            Scalar::Int => "i",
            Scalar::Uint => "u",
            Scalar::Float => "",
            Scalar::Double => "d",
        };
        match self {
            Self::Void => f.write_str("void"),
            Self::Scalar(scalar) => write!(f, "{scalar}"),
            Self::Vector(scalar, size) => write!(f, "{}vec{size}", letter(scalar)),
            Self::Matrix(scalar, columns, rows) if columns == rows => {
                write!(f, "{}mat{columns}", letter(scalar))
            }
            Self::Matrix(scalar, columns, rows) => {
                write!(f, "{}mat{columns}x{rows}", letter(scalar))
            }
            Self::Array(element, size) => {
                let mut element = element;
                let mut sizes = vec![*size];
                while let Self::Array(inner, size) = &**element {
                    sizes.push(*size);
                    element = inner;
                }
                write!(f, "{element}")?;
                sizes.iter().try_for_each(|size| match size {
                    Some(size) => write!(f, "[{size}]"),
                    None => write!(f, "[]"),
                })
            }
            Self::Struct(_) => f.write_str("a structure"),
            Self::Opaque(opaque) => f.write_str(&opaque.glsl_name()),
        }
    }
}

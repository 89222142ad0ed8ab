//! Types, and their spelling in both languages.

use lamplight::bundle::Language;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scalar {
    Float,
    Int,
    Uint,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Type {
    Scalar(Scalar),
    Vector(usize, Scalar),
    /// Columns and rows.
    Matrix(usize, usize),
    Array(Box<Type>, usize),
    /// The index in the list of structures.
    Struct(usize),
}

pub const FLOAT: Type = Type::Scalar(Scalar::Float);
pub const INT: Type = Type::Scalar(Scalar::Int);
pub const UINT: Type = Type::Scalar(Scalar::Uint);

/// A condition: an axis of the program has a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct When {
    pub axis: usize,
    pub value: usize,
}

/// The values of an axis; none for a boolean axis.
pub type Axis = &'static [&'static str];

/// The axes of a program. The name of the first is `axis_0`.
pub const AXES: [Axis; 4] = [&[], &[], &["one", "two", "three"], &["low", "high", "none", "all"]];

/// A structure, of which some members may exist only under a condition.
#[derive(Debug, Clone)]
pub struct Struct {
    pub name: String,
    pub members: Vec<Member>,
}

#[derive(Debug, Clone)]
pub struct Member {
    pub name: String,
    pub ty: Type,
    pub when: Option<When>,
}

impl Struct {
    pub fn is_plain(&self) -> bool {
        self.members.iter().all(|member| member.when.is_none())
    }
}

/// The spelling of a language.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Spelling(pub Language);

impl Spelling {
    pub fn is_glsl(self) -> bool {
        self.0 == Language::Glsl
    }

    pub fn ty(self, ty: &Type, structs: &[Struct]) -> String {
        let glsl = self.is_glsl();
        match ty {
            Type::Scalar(scalar) => self.scalar(*scalar).to_owned(),
            Type::Vector(size, scalar) => {
                let (before, behind) = match scalar {
                    Scalar::Float => ("", "f"),
                    Scalar::Int => ("i", "i"),
                    Scalar::Uint => ("u", "u"),
                };
                if glsl { format!("{before}vec{size}") } else { format!("vec{size}{behind}") }
            }
            Type::Matrix(columns, rows) => {
                format!("mat{columns}x{rows}{}", if glsl { "" } else { "f" })
            }
            Type::Array(of, size) if glsl => format!("{}[{size}]", self.ty(of, structs)),
            Type::Array(of, size) => format!("array<{}, {size}>", self.ty(of, structs)),
            Type::Struct(index) => structs[*index].name.clone(),
        }
    }

    pub fn scalar(self, scalar: Scalar) -> &'static str {
        match (scalar, self.is_glsl()) {
            (Scalar::Float, false) => "f32",
            (Scalar::Int, false) => "i32",
            (Scalar::Uint, false) => "u32",
            (Scalar::Float, true) => "float",
            (Scalar::Int, true) => "int",
            (Scalar::Uint, true) => "uint",
        }
    }

    /// The declaration of a variable, a member or a parameter, without the character that ends it.
    pub fn declared(self, name: &str, ty: &str) -> String {
        // In GLSL the size of an array is after the name.
        match (self.is_glsl(), ty.split_once('[')) {
            (false, _) => format!("{name}: {ty}"),
            (true, None) => format!("{ty} {name}"),
            (true, Some((of, size))) => format!("{of} {name}[{size}"),
        }
    }

    /// The text of a condition.
    pub fn condition(self, when: When) -> String {
        let values = AXES[when.axis];
        let axis = format!("axis_{}", when.axis);
        match (self.is_glsl(), values.get(when.value)) {
            (false, None) if when.value == 0 => format!("!{axis}"),
            (false, None) => axis,
            (false, Some(value)) => format!("{axis} == {value}"),
            (true, None) if when.value == 0 => format!("!{}", axis.to_uppercase()),
            (true, None) => axis.to_uppercase(),
            (true, Some(value)) => {
                let axis = axis.to_uppercase();
                format!("{axis} == {axis}_{}", value.to_uppercase())
            }
        }
    }

    /// Lines under a condition, and others for when the condition does not hold. In WESL each of
    /// them is one declaration, member, parameter or statement.
    pub fn either(self, when: When, some: &str, other: Option<&str>) -> String {
        let condition = self.condition(when);
        // A bracket after `@else` would be read as a condition.
        let other = other.map(|other| match other.starts_with('(') {
            true => format!("{{ {other} }}"),
            false => other.to_owned(),
        });
        match (self.is_glsl(), other) {
            (false, None) => format!("@if({condition}) {some}\n"),
            (false, Some(other)) => format!("@if({condition}) {some}\n@else {other}\n"),
            (true, None) => format!("#if {condition}\n{some}\n#endif\n"),
            (true, Some(other)) => format!("#if {condition}\n{some}\n#else\n{other}\n#endif\n"),
        }
    }
}

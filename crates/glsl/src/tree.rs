//! The typed tree: names are resolved, every expression has a type, and conversions are explicit.

use std::rc::Rc;

use crate::lexer::At;
use crate::types::{Scalar, Type};

/// Which shader of a pipeline a text is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Stage {
    /// Vertices.
    Vertex,
    /// Fragments.
    Fragment,
    /// Compute.
    Compute,
}

/// A number that is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Number {
    /// `bool`
    Bool(bool),
    /// `int`
    Int(i32),
    /// `uint`
    Uint(u32),
    /// `float`
    Float(f32),
}

/// The numbers of a constant, in the order of its components, elements and members.
pub type Known = Rc<[Number]>;

/// A checked shader.
#[derive(Debug)]
pub struct Shader {
    /// The stage.
    pub stage: Stage,
    /// All structures, those of blocks too.
    pub structs: Vec<Struct>,
    /// All variables, parameters and locals too.
    pub vars: Vec<Var>,
    /// All functions.
    pub functions: Vec<Function>,
    /// Structures, variables and functions in the order of the text.
    pub order: Vec<Item>,
    /// `local_size` of a compute shader: numbers, and specialisation constants by their ids.
    pub local_size: [u32; 3],
    /// Ids of the constants that decide `local_size`.
    pub local_size_ids: [Option<u32>; 3],
    /// How the depth is bounded.
    pub depth_mode: Option<String>,
}

impl Shader {
    /// Whether a type is or has a texture or a sampler.
    pub fn has_opaque(&self, ty: &Type) -> bool {
        match ty.innermost() {
            Type::Opaque(_) => true,
            Type::Struct(index) => {
                let members = &self.structs[*index as usize].members;
                members.iter().any(|field| self.has_opaque(&field.ty))
            }
            _ => false,
        }
    }
}

/// One declaration of the text.
#[derive(Debug, Clone, Copy)]
pub enum Item {
    /// By its index.
    Struct(u32),
    /// By its index.
    Var(u32),
    /// By its index.
    Function(u32),
}

/// How matrices and arrays lie in a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Packing {
    /// `std140`, and what `shared` and `packed` leave open.
    Std140,
    /// `std430`
    Std430,
    /// `scalar`
    Scalar,
}

/// A structure or the members of a block.
#[derive(Debug)]
pub struct Struct {
    /// Its name; empty for one without.
    pub name: String,
    /// Where it is declared.
    pub at: At,
    /// Its members.
    pub members: Vec<Field>,
    /// Whether it is the content of a block.
    pub block: bool,
}

/// A member.
#[derive(Debug, Clone)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// Its type.
    pub ty: Type,
    /// Where it is.
    pub at: At,
    /// `layout(offset = ...)`.
    pub offset: Option<u32>,
    /// `layout(align = ...)`.
    pub align: Option<u32>,
    /// Whether its matrices are `row_major`; `None` takes the block's.
    pub row_major: Option<bool>,
    /// `layout(location = ...)`.
    pub location: Option<u32>,
    /// How it is interpolated.
    pub interpolation: Interpolation,
    /// Whether it cannot be written.
    pub readonly: bool,
}

/// How an input is interpolated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Interpolation {
    /// `flat`
    pub flat: bool,
    /// `noperspective`
    pub linear: bool,
    /// `centroid`
    pub centroid: bool,
    /// `sample`
    pub sample: bool,
    /// `invariant`
    pub invariant: bool,
}

impl Interpolation {
    /// What holds for a member of a block: its own words beside those of the block.
    pub fn with(self, outer: Self) -> Self {
        let Self { flat, linear, centroid, sample, invariant } = self;
        Self {
            flat: flat || outer.flat,
            linear: linear || outer.linear,
            centroid: centroid || outer.centroid,
            sample: sample || outer.sample,
            invariant: invariant || outer.invariant,
        }
    }
}

/// What is written in `layout(...)` before a variable or a block.
#[derive(Debug, Clone, Default)]
pub struct Layout {
    /// `location`
    pub location: Option<u32>,
    /// `component`
    pub component: Option<u32>,
    /// `index` of dual source blending.
    pub index: Option<u32>,
    /// `set`
    pub set: Option<u32>,
    /// `binding`
    pub binding: Option<u32>,
    /// `constant_id`
    pub constant_id: Option<u32>,
    /// `input_attachment_index`
    pub attachment: Option<u32>,
    /// `push_constant`
    pub push: bool,
    /// The format of an image.
    pub format: Option<String>,
    /// How a block is packed.
    pub packing: Option<Packing>,
    /// Whether matrices are `row_major`.
    pub row_major: Option<bool>,
}

/// Where a variable lives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// A constant of a function or of the text.
    Const,
    /// `layout(constant_id) const`, and constants made of them.
    Override,
    /// A variable of a function.
    Local,
    /// A parameter: `in`, `out` or `inout`.
    Param(Dir),
    /// A variable of the text.
    Private,
    /// An input of the stage.
    Input,
    /// An output of the stage.
    Output,
    /// A uniform that is in no block, or an opaque one.
    Uniform,
    /// The instance of a uniform block.
    UniformBlock,
    /// The instance of a storage block.
    StorageBlock,
    /// `shared`
    Shared,
    /// A variable of the language.
    Builtin(&'static crate::builtin::variables::Builtin),
}

/// The direction of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dir {
    /// A copy of the argument.
    In,
    /// Copied back.
    Out,
    /// Both.
    InOut,
}

/// A variable.
#[derive(Debug)]
pub struct Var {
    /// Its name in GLSL.
    pub name: String,
    /// Its type.
    pub ty: Type,
    /// Where it lives.
    pub place: Place,
    /// Where it is declared.
    pub at: At,
    /// What it begins with.
    pub init: Option<Expr>,
    /// What it always is.
    pub known: Option<Known>,
    /// `layout(...)`
    pub layout: Layout,
    /// How it is interpolated.
    pub interpolation: Interpolation,
    /// `readonly`, `writeonly`, `coherent`.
    pub access: Access,
    /// Whether anything but its initializer writes it.
    pub written: bool,
    /// Whether an index that is not constant reaches into it.
    pub indexed: bool,
    /// The functions that name it, sorted; empty for locals.
    pub users: Vec<u32>,
    /// Whether a block's members are names of their own.
    pub open: bool,
}

/// Which ways a buffer or an image is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Access {
    /// `readonly`
    pub readonly: bool,
    /// `writeonly`
    pub writeonly: bool,
    /// `coherent` or `volatile`: the invocations of a stage see at once what others write.
    pub coherent: bool,
}

/// A function.
#[derive(Debug)]
pub struct Function {
    /// Its name in GLSL.
    pub name: String,
    /// What it returns.
    pub ret: Type,
    /// Its parameters, by their variables.
    pub params: Vec<u32>,
    /// Its statements; `None` for a prototype without a definition.
    pub body: Option<Vec<Stmt>>,
    /// Where its head is.
    pub at: At,
    /// Functions that it calls, sorted.
    pub calls: Vec<u32>,
    /// Whether it writes what its caller can see, other than its parameters.
    pub effects: bool,
    /// Whether it has a `discard` of its own.
    pub discards: bool,
    /// Whether it has a loop.
    pub loops: bool,
}

/// A statement.
#[derive(Debug)]
pub struct Stmt {
    /// What it is.
    pub kind: StmtKind,
    /// Where it is.
    pub at: At,
}

/// What a statement is.
#[derive(Debug)]
pub enum StmtKind {
    /// A variable begins.
    Declare(u32),
    /// An expression for its effects.
    Expr(Expr),
    /// Statements with a scope of their own.
    Block(Vec<Stmt>),
    /// `if`
    If(Expr, Vec<Stmt>, Vec<Stmt>),
    /// `switch`: each group of labels with what follows.
    Switch(Expr, Vec<Case>),
    /// `for` and `while`: what comes first, the condition, the step and the body.
    Loop(Box<Loop>),
    /// `return`
    Return(Option<Expr>),
    /// `break`
    Break,
    /// `continue`
    Continue,
    /// `discard`
    Discard,
}

/// A loop.
#[derive(Debug)]
pub struct Loop {
    /// What comes before it, in a scope with it.
    pub first: Vec<Stmt>,
    /// A variable that the condition declares.
    pub declared: Option<u32>,
    /// The condition.
    pub condition: Option<Expr>,
    /// Whether the condition stands at the end.
    pub last: bool,
    /// What comes after each round.
    pub step: Option<Expr>,
    /// The body.
    pub body: Vec<Stmt>,
}

/// Labels and what follows them.
#[derive(Debug)]
pub struct Case {
    /// Values; `None` is `default`.
    pub labels: Vec<Option<Number>>,
    /// Statements up to the next label.
    pub body: Vec<Stmt>,
}

/// An expression.
#[derive(Debug, Clone)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// Its type.
    pub ty: Type,
    /// Where it is.
    pub at: At,
    /// What it always is.
    pub known: Option<Known>,
}

impl Expr {
    /// Calls a function with this expression and with each one in it.
    pub fn each_part<'e>(&'e self, visit: &mut dyn FnMut(&'e Self)) {
        visit(self);
        match &self.kind {
            ExprKind::Literal(..) | ExprKind::Var(_) | ExprKind::Kept(_) => {}
            ExprKind::Unary(_, a)
            | ExprKind::Step(_, _, a)
            | ExprKind::Convert(a)
            | ExprKind::Swizzle(a, _)
            | ExprKind::Member(a, _)
            | ExprKind::Length(a) => a.each_part(visit),
            ExprKind::Binary(_, a, b)
            | ExprKind::Logic(_, a, b)
            | ExprKind::Assign(_, a, b)
            | ExprKind::Comma(a, b)
            | ExprKind::Index(a, b) => {
                a.each_part(visit);
                b.each_part(visit);
            }
            ExprKind::Ternary(a, b, c) => [a, b, c].iter().for_each(|part| part.each_part(visit)),
            ExprKind::Call(_, parts)
            | ExprKind::Builtin(_, parts)
            | ExprKind::Texture(_, parts)
            | ExprKind::Construct(parts) => parts.iter().for_each(|part| part.each_part(visit)),
        }
    }

    /// Whether it names a variable for which something holds.
    pub fn names(&self, holds: &dyn Fn(u32) -> bool) -> bool {
        let mut found = false;
        self.each_part(&mut |part| {
            if let ExprKind::Var(index) = part.kind {
                found |= holds(index);
            }
        });
        found
    }
}

/// What an expression is.
#[derive(Debug, Clone)]
pub enum ExprKind {
    /// A literal, with its text where it was written as one.
    Literal(Number, Option<String>),
    /// A variable.
    Var(u32),
    /// `-`, `!`, `~`
    Unary(Op, Box<Expr>),
    /// `a + b`
    Binary(Op, Box<Expr>, Box<Expr>),
    /// `a && b`, `a || b`: whether it is `&&`.
    Logic(bool, Box<Expr>, Box<Expr>),
    /// `c ? a : b`
    Ternary(Box<Expr>, Box<Expr>, Box<Expr>),
    /// `a = b`, or `a op= b`.
    Assign(Option<Op>, Box<Expr>, Box<Expr>),
    /// `++a`, `a--`: whether it adds, and whether its value is the new one.
    Step(bool, bool, Box<Expr>),
    /// `a, b`
    Comma(Box<Expr>, Box<Expr>),
    /// A call of a function of the text.
    Call(u32, Vec<Expr>),
    /// A call of a function of the language.
    Builtin(&'static str, Vec<Expr>),
    /// A call that reads or writes a texture or an image.
    Texture(crate::builtin::textures::Access, Vec<Expr>),
    /// A value of a type from others.
    Construct(Vec<Expr>),
    /// Other numbers of the same shape.
    Convert(Box<Expr>),
    /// `a.xy`
    Swizzle(Box<Expr>, Vec<u8>),
    /// A member of a structure.
    Member(Box<Expr>, u32),
    /// `a[i]`
    Index(Box<Expr>, Box<Expr>),
    /// A value that the translator keeps in a variable of its own.
    Kept(String),
    /// `a.length()` of an array whose size only the buffer knows.
    Length(Box<Expr>),
}

/// An operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Op {
    /// `+`
    Add,
    /// `-`
    Sub,
    /// `*`
    Mul,
    /// `/`
    Div,
    /// `%`
    Mod,
    /// `<<`
    ShiftLeft,
    /// `>>`
    ShiftRight,
    /// `&`
    And,
    /// `|`
    Or,
    /// `^`
    Xor,
    /// `==`
    Equal,
    /// `!=`
    NotEqual,
    /// `<`
    Less,
    /// `>`
    Greater,
    /// `<=`
    LessEqual,
    /// `>=`
    GreaterEqual,
    /// `^^`
    LogicXor,
    /// `-` before its operand
    Negate,
    /// `!`
    Not,
    /// `~`
    Invert,
}

impl Op {
    /// The binary operator of that text.
    pub fn binary(text: &str) -> Option<Self> {
        Some(match text {
            "+" => Self::Add,
            "-" => Self::Sub,
            "*" => Self::Mul,
            "/" => Self::Div,
            "%" => Self::Mod,
            "<<" => Self::ShiftLeft,
            ">>" => Self::ShiftRight,
            "&" => Self::And,
            "|" => Self::Or,
            "^" => Self::Xor,
            "==" => Self::Equal,
            "!=" => Self::NotEqual,
            "<" => Self::Less,
            ">" => Self::Greater,
            "<=" => Self::LessEqual,
            ">=" => Self::GreaterEqual,
            "^^" => Self::LogicXor,
            _ => return None,
        })
    }

    /// Its text, in both languages except for `^^`.
    pub fn text(self) -> &'static str {
        match self {
            Self::Add => "+",
            Self::Sub | Self::Negate => "-",
            Self::Mul => "*",
            Self::Div => "/",
            Self::Mod => "%",
            Self::ShiftLeft => "<<",
            Self::ShiftRight => ">>",
            Self::And => "&",
            Self::Or => "|",
            Self::Xor => "^",
            Self::Equal => "==",
            Self::NotEqual | Self::LogicXor => "!=",
            Self::Less => "<",
            Self::Greater => ">",
            Self::LessEqual => "<=",
            Self::GreaterEqual => ">=",
            Self::Not => "!",
            Self::Invert => "~",
        }
    }
}

impl Number {
    /// What it is.
    pub fn scalar(self) -> Scalar {
        match self {
            Self::Bool(_) => Scalar::Bool,
            Self::Int(_) => Scalar::Int,
            Self::Uint(_) => Scalar::Uint,
            Self::Float(_) => Scalar::Float,
        }
    }

    /// As another kind of number, by the rules of constructors.
    pub fn to(self, scalar: Scalar) -> Self {
        match scalar {
            Scalar::Bool => Self::Bool(match self {
                Self::Bool(value) => value,
                Self::Int(value) => value != 0,
                Self::Uint(value) => value != 0,
                Self::Float(value) => value != 0.0,
            }),
            Scalar::Int => Self::Int(match self {
                Self::Bool(value) => i32::from(value),
                Self::Int(value) => value,
                Self::Uint(value) => value as i32,
                Self::Float(value) => value as i32,
            }),
            Scalar::Uint => Self::Uint(match self {
                Self::Bool(value) => u32::from(value),
                Self::Int(value) => value as u32,
                Self::Uint(value) => value,
                Self::Float(value) => value as i64 as u32,
            }),
            Scalar::Float | Scalar::Double => Self::Float(match self {
                Self::Bool(value) => f32::from(u8::from(value)),
                Self::Int(value) => value as f32,
                Self::Uint(value) => value as f32,
                Self::Float(value) => value,
            }),
        }
    }

    /// As an integer that is not negative.
    pub fn as_size(self) -> Option<u32> {
        match self {
            Self::Int(value) => u32::try_from(value).ok(),
            Self::Uint(value) => Some(value),
            _ => None,
        }
    }
}

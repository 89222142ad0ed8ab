//! The typed tree that readers make and printers write.
//!
//! A node keeps the comments and blank lines around it, and its condition: nothing is chosen here.
//! Types are those that WGSL and GLSL share; each expression has one after [`crate::types`].

use std::fmt;

use lamplight_diagnostic::source::{SourceId, Span};

use crate::condition::Condition;

/// One file.
#[derive(Debug, Clone)]
pub struct Module {
    /// The path of the module: `brdf`, `fresnel`.
    pub path: Vec<String>,
    pub source: SourceId,
    /// The `//!` lines at its head, without the mark.
    pub doc: Vec<String>,
    pub imports: Vec<Import>,
    pub items: Vec<Node<Item>>,
    /// The comments after the last item.
    pub end: Vec<Line>,
}

/// A name that another module declares.
#[derive(Debug, Clone)]
pub struct Import {
    pub condition: Option<Condition>,
    pub path: ItemPath,
    /// The name here.
    pub alias: String,
}

/// Where an item is: the path of its module, and its name there.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ItemPath {
    pub module: Vec<String>,
    pub name: String,
}

/// Something with comments around it, and a condition.
#[derive(Debug, Clone)]
pub struct Node<T> {
    /// The lines above.
    pub lead: Vec<Line>,
    pub branch: Option<Branch>,
    pub body: T,
    /// A comment behind it on its last line.
    pub trail: Option<String>,
    pub span: Span,
}

/// A line without code.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Line {
    Blank,
    Comment(String),
}

/// Under which condition a node stands, beside its siblings.
#[derive(Debug, Clone, PartialEq)]
pub enum Branch {
    If(Condition),
    Elif(Condition),
    Else,
}

/// A global declaration.
#[derive(Debug, Clone)]
pub enum Item {
    Function(Function),
    Structure(Structure),
    Constant(Constant),
    Variable(Variable),
    /// A type's other name. Checking replaces its uses by the type.
    Alias(String, Type),
    /// A `const_assert`, as it was written: it has no meaning at run time.
    Assertion(String),
}

impl Item {
    /// The declared name; that of an assertion is empty.
    pub fn name(&self) -> &str {
        match self {
            Self::Function(function) => &function.name,
            Self::Structure(structure) => &structure.name,
            Self::Constant(constant) => &constant.name,
            Self::Variable(variable) => &variable.name,
            Self::Alias(name, _) => name,
            Self::Assertion(_) => "",
        }
    }
}

#[derive(Debug, Clone)]
pub struct Function {
    pub name: String,
    pub stage: Option<Stage>,
    /// Of a compute stage.
    pub workgroup: Vec<Expression>,
    pub parameters: Vec<Node<Field>>,
    /// Whether each parameter is on a line of its own.
    pub is_broken: bool,
    pub result: Option<Field>,
    pub body: Block,
    pub span: Span,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    Vertex,
    Fragment,
    Compute,
}

#[derive(Debug, Clone)]
pub struct Structure {
    pub name: String,
    pub members: Vec<Node<Field>>,
    pub end: Vec<Line>,
}

/// A parameter, a member, or a result, whose name is empty.
#[derive(Debug, Clone)]
pub struct Field {
    pub name: String,
    pub ty: Type,
    pub binding: Option<StageBinding>,
    pub span: Span,
}

/// How a field of a stage meets what is outside of it.
#[derive(Debug, Clone, PartialEq)]
pub struct StageBinding {
    pub place: StagePlace,
    pub interpolation: Option<Interpolation>,
    pub invariant: bool,
}

#[derive(Debug, Clone, PartialEq)]
pub enum StagePlace {
    Location(u32),
    Builtin(String),
}

#[derive(Debug, Clone, PartialEq)]
pub struct Interpolation {
    pub kind: String,
    pub sampling: Option<String>,
}

/// A `const` or an `override`.
#[derive(Debug, Clone)]
pub struct Constant {
    pub name: String,
    /// The type that was written.
    pub given: Option<Type>,
    pub value: Expression,
    /// The number of an `override`.
    pub id: Option<u32>,
    pub span: Span,
}

/// A `var` of the module.
#[derive(Debug, Clone)]
pub struct Variable {
    pub name: String,
    pub space: Space,
    pub ty: Type,
    pub binding: Option<(u32, u32)>,
    pub value: Option<Expression>,
    pub span: Span,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Space {
    /// Textures and samplers.
    Handle,
    Uniform,
    Storage {
        is_written: bool,
    },
    Private,
    Workgroup,
    Function,
}

/// Statements in braces.
#[derive(Debug, Clone)]
pub struct Block {
    pub nodes: Vec<Node<Statement>>,
    /// Comments before the closing brace.
    pub end: Vec<Line>,
}

#[derive(Debug, Clone)]
pub enum Statement {
    /// `let`, `const` or `var`.
    Local(Local),
    Assign {
        target: Expression,
        /// The operator of a compound assignment.
        operator: Option<Binary>,
        value: Expression,
    },
    /// `x++` or `x--`.
    Step {
        target: Expression,
        is_up: bool,
    },
    /// A call whose result nobody needs.
    Call(Expression),
    Return(Option<Expression>),
    If {
        condition: Expression,
        accept: Block,
        reject: Option<Box<Node<Statement>>>,
    },
    Block(Block),
    /// Statements in braces under a condition: not a scope of their own.
    Group(Block),
    For {
        first: Option<Box<Statement>>,
        condition: Option<Expression>,
        step: Option<Box<Statement>>,
        body: Block,
    },
    While {
        condition: Expression,
        body: Block,
    },
    Loop {
        body: Block,
        continuing: Option<Block>,
        break_if: Option<Expression>,
    },
    Switch {
        selector: Expression,
        cases: Vec<Node<Case>>,
        end: Vec<Line>,
    },
    Break,
    Continue,
    Discard,
    Assertion(String),
    Empty,
}

#[derive(Debug, Clone)]
pub struct Local {
    pub name: String,
    pub is_variable: bool,
    pub is_constant: bool,
    /// The type that was written; after checking, the type.
    pub ty: Option<Type>,
    pub value: Option<Expression>,
    pub span: Span,
}

#[derive(Debug, Clone)]
pub struct Case {
    pub selectors: Vec<Expression>,
    pub is_default: bool,
    pub body: Block,
}

/// An expression, its type and its place.
#[derive(Debug, Clone)]
pub struct Expression {
    pub kind: ExpressionKind,
    pub ty: Type,
    pub span: Span,
}

#[derive(Debug, Clone)]
pub enum ExpressionKind {
    /// A number as it was written, without its suffix.
    Number(Number),
    Bool(bool),
    /// A name, and what it means once that is known.
    Name(String, Meaning),
    /// The value of an axis: `constants::NAME`.
    Axis(String),
    Parenthesised(Box<Expression>),
    Unary(Unary, Box<Expression>),
    Binary {
        operator: Binary,
        left: Box<Expression>,
        right: Box<Expression>,
        /// Where the line was broken.
        line_break: LineBreak,
    },
    Member(Box<Expression>, String),
    Index(Box<Expression>, Box<Expression>),
    /// A call of a function of the module or of the language.
    Call {
        callee: Callee,
        arguments: Vec<Argument>,
        /// Whether the closing parenthesis is on a line of its own.
        is_broken: bool,
    },
    /// A value of another type, of an expression of this type: made by the checker.
    Convert(Box<Expression>),
}

/// What a name in an expression means.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Meaning {
    Unknown,
    /// A parameter or a variable of the function, by the numbers of the declarations that it may be,
    /// each under its condition.
    Local(Vec<u32>),
    Item(ItemPath),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineBreak {
    None,
    Before,
    After,
}

/// An argument, and whether it begins a line.
#[derive(Debug, Clone)]
pub struct Argument {
    pub value: Expression,
    pub is_on_new_line: bool,
}

#[derive(Debug, Clone)]
pub enum Callee {
    /// A name that is not resolved yet.
    Name(String),
    Function(ItemPath),
    Builtin(String),
    /// `vec3f(...)`, a structure's name, `bitcast<u32>(...)`.
    Construct(Type),
    Bitcast(Type),
}

#[derive(Debug, Clone, PartialEq)]
pub struct Number {
    pub text: String,
    pub value: NumberValue,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NumberValue {
    Integer(i64),
    Float(f64),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unary {
    Negate,
    Not,
    Complement,
    /// `&x`
    Address,
    /// `*x`
    Follow,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    And,
    Or,
    BitAnd,
    BitOr,
    BitXor,
    ShiftLeft,
    ShiftRight,
    Equal,
    NotEqual,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
}

/// Every binary operator, its spelling, and how tightly it binds in C and GLSL.
pub const BINARY: &[(Binary, &str, u8)] = &[
    (Binary::Or, "||", 1),
    (Binary::And, "&&", 3),
    (Binary::BitOr, "|", 4),
    (Binary::BitXor, "^", 5),
    (Binary::BitAnd, "&", 6),
    (Binary::Equal, "==", 7),
    (Binary::NotEqual, "!=", 7),
    (Binary::LessEqual, "<=", 8),
    (Binary::GreaterEqual, ">=", 8),
    (Binary::Less, "<", 8),
    (Binary::Greater, ">", 8),
    (Binary::ShiftLeft, "<<", 9),
    (Binary::ShiftRight, ">>", 9),
    (Binary::Add, "+", 10),
    (Binary::Subtract, "-", 10),
    (Binary::Multiply, "*", 11),
    (Binary::Divide, "/", 11),
    (Binary::Remainder, "%", 11),
];

impl Binary {
    /// Its spelling and how tightly it binds.
    pub fn spelling(self) -> (&'static str, u8) {
        BINARY.iter().find(|(known, ..)| *known == self).map_or(("", 0), |found| (found.1, found.2))
    }

    /// Whether the result is boolean.
    pub fn compares(self) -> bool {
        matches!(
            self,
            Self::Equal
                | Self::NotEqual
                | Self::Less
                | Self::LessEqual
                | Self::Greater
                | Self::GreaterEqual
        )
    }
}

/// A type of a value, or of something that has none.
#[derive(Debug, Clone, PartialEq)]
pub enum Type {
    /// Not found yet.
    Unknown,
    /// That of a function without a result.
    Nothing,
    Scalar(Scalar),
    Vector(u8, Scalar),
    Matrix {
        columns: u8,
        rows: u8,
        scalar: Scalar,
    },
    Array(Box<Type>, Count),
    /// A name that is not resolved yet.
    Named(String),
    Structure(ItemPath),
    Pointer(Space, Box<Type>),
    Atomic(Scalar),
    Texture(Texture),
    Sampler {
        compares: bool,
    },
    /// `vec3(...)`, whose component type is that of its arguments.
    OpenVector(u8),
    OpenMatrix {
        columns: u8,
        rows: u8,
    },
    OpenArray,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scalar {
    AbstractInteger,
    AbstractFloat,
    Bool,
    I32,
    U32,
    F32,
}

/// How many elements an array has.
#[derive(Debug, Clone, PartialEq)]
pub enum Count {
    Fixed(u32),
    /// The value of an axis.
    Axis(String),
    /// A constant, as the module names it.
    Named(String),
    /// The constant that such a name means.
    Constant(ItemPath),
    /// As many as the buffer holds.
    Runtime,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    pub shape: Shape,
    pub is_array: bool,
    pub kind: TextureKind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    D1,
    D2,
    D3,
    Cube,
}

#[derive(Debug, Clone, PartialEq)]
pub enum TextureKind {
    Sampled(Scalar),
    Multisampled(Scalar),
    Depth,
    DepthMultisampled,
    Storage { format: String, access: String },
}

impl Type {
    pub const BOOL: Self = Self::Scalar(Scalar::Bool);
    pub const F32: Self = Self::Scalar(Scalar::F32);
    pub const I32: Self = Self::Scalar(Scalar::I32);
    pub const U32: Self = Self::Scalar(Scalar::U32);

    /// The scalar that it is made of, if it is a scalar, a vector or a matrix.
    pub fn scalar(&self) -> Option<Scalar> {
        match self {
            Self::Scalar(scalar) | Self::Vector(_, scalar) | Self::Matrix { scalar, .. } => {
                Some(*scalar)
            }
            _ => None,
        }
    }

    /// The same shape with another scalar.
    pub fn with_scalar(&self, scalar: Scalar) -> Self {
        match self {
            Self::Scalar(_) => Self::Scalar(scalar),
            Self::Vector(size, _) => Self::Vector(*size, scalar),
            Self::Matrix { columns, rows, .. } => {
                Self::Matrix { columns: *columns, rows: *rows, scalar }
            }
            Self::Array(element, count) => {
                Self::Array(Box::new(element.with_scalar(scalar)), count.clone())
            }
            other => other.clone(),
        }
    }

    /// Whether it is of abstract numbers.
    pub fn is_abstract(&self) -> bool {
        match self {
            Self::Array(element, _) => element.is_abstract(),
            other => {
                matches!(other.scalar(), Some(Scalar::AbstractInteger | Scalar::AbstractFloat))
            }
        }
    }
}

impl fmt::Display for Scalar {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::AbstractInteger => "an abstract integer",
            Self::AbstractFloat => "an abstract float",
            Self::Bool => "bool",
            Self::I32 => "i32",
            Self::U32 => "u32",
            Self::F32 => "f32",
        })
    }
}

impl fmt::Display for Type {
    /// In the words of WGSL.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown => formatter.write_str("unknown"),
            Self::Nothing => formatter.write_str("nothing"),
            Self::Scalar(scalar) => write!(formatter, "{scalar}"),
            Self::Vector(size, scalar) => write!(formatter, "vec{size}<{scalar}>"),
            Self::Matrix { columns, rows, scalar } => {
                write!(formatter, "mat{columns}x{rows}<{scalar}>")
            }
            Self::Array(element, Count::Fixed(count)) => {
                write!(formatter, "array<{element}, {count}>")
            }
            Self::Array(element, Count::Axis(name) | Count::Named(name)) => {
                write!(formatter, "array<{element}, {name}>")
            }
            Self::Array(element, Count::Constant(path)) => {
                write!(formatter, "array<{element}, {}>", path.name)
            }
            Self::Array(element, Count::Runtime) => write!(formatter, "array<{element}>"),
            Self::Named(name) => formatter.write_str(name),
            Self::Structure(path) => formatter.write_str(&path.name),
            Self::Pointer(_, target) => write!(formatter, "a pointer to {target}"),
            Self::Atomic(scalar) => write!(formatter, "atomic<{scalar}>"),
            Self::Texture(_) => formatter.write_str("a texture"),
            Self::Sampler { .. } => formatter.write_str("a sampler"),
            Self::OpenVector(size) => write!(formatter, "vec{size}"),
            Self::OpenMatrix { columns, rows } => write!(formatter, "mat{columns}x{rows}"),
            Self::OpenArray => formatter.write_str("array"),
        }
    }
}

/// The condition of each of some siblings, wherever it stands: those of the siblings before it are
/// in it.
pub fn whole_conditions<T>(nodes: &[Node<T>]) -> Vec<Condition> {
    let mut before = Condition::Literal(true);
    let mut all = Vec::new();
    for node in nodes {
        let own = match &node.branch {
            None => {
                all.push(Condition::Literal(true));
                continue;
            }
            Some(Branch::If(condition)) => {
                before = condition.clone().negated();
                condition.clone()
            }
            Some(Branch::Elif(condition)) => {
                let own = before.clone().and(condition.clone());
                before = before.and(condition.clone().negated());
                own
            }
            Some(Branch::Else) => before.clone(),
        };
        all.push(own);
    }
    all
}

/// Some of the siblings. Those whose `@if` is not complete without the others get whole conditions.
pub fn kept_siblings<T: Clone>(nodes: &[Node<T>], keep: impl Fn(&Node<T>) -> bool) -> Vec<Node<T>> {
    let conditions = whole_conditions(nodes);
    let is_start = |at: &usize| !matches!(nodes[*at].branch, Some(Branch::Elif(_) | Branch::Else));
    let mut kept = Vec::new();
    let mut first = 0;
    while first < nodes.len() {
        let end = (first + 1..nodes.len()).find(is_start).unwrap_or(nodes.len());
        let is_whole = nodes[first..end].iter().all(&keep);
        for at in (first..end).filter(|at| keep(&nodes[*at])) {
            let mut node = nodes[at].clone();
            if !is_whole && node.branch.is_some() {
                node.branch = match conditions[at].clone() {
                    Condition::Literal(true) => None,
                    condition => Some(Branch::If(condition)),
                };
            }
            kept.push(node);
        }
        first = end;
    }
    kept
}

impl Expression {
    /// An expression whose type is not known yet.
    pub fn new(kind: ExpressionKind, span: Span) -> Self {
        Self { kind, ty: Type::Unknown, span }
    }

    /// The expression without parentheses around it.
    pub fn bare(&self) -> &Self {
        match &self.kind {
            ExpressionKind::Parenthesised(inner) => inner.bare(),
            _ => self,
        }
    }

    /// Calls `visit` with this and everything in it.
    pub fn walk<'a>(&'a self, visit: &mut dyn FnMut(&'a Self)) {
        visit(self);
        match &self.kind {
            ExpressionKind::Parenthesised(inner)
            | ExpressionKind::Unary(_, inner)
            | ExpressionKind::Member(inner, _)
            | ExpressionKind::Convert(inner) => inner.walk(visit),
            ExpressionKind::Binary { left, right, .. } | ExpressionKind::Index(left, right) => {
                left.walk(visit);
                right.walk(visit);
            }
            ExpressionKind::Call { arguments, .. } => {
                arguments.iter().for_each(|argument| argument.value.walk(visit));
            }
            ExpressionKind::Number(_)
            | ExpressionKind::Bool(_)
            | ExpressionKind::Name(..)
            | ExpressionKind::Axis(_) => {}
        }
    }
}

//! What the parser makes of a text: names are not resolved, and types not known.

use crate::lexer::At;

/// A word of the text.
#[derive(Debug, Clone, Copy)]
pub struct Name<'a> {
    /// Its letters.
    pub text: &'a str,
    /// Where it is.
    pub at: At,
}

/// An expression.
#[derive(Debug)]
pub struct Expr<'a> {
    /// What it is.
    pub kind: ExprKind<'a>,
    /// Where it is.
    pub at: At,
}

/// What an expression is.
#[derive(Debug)]
pub enum ExprKind<'a> {
    /// `1`, as bits.
    Int(u32),
    /// `1u`.
    Uint(u32),
    /// `1.0`, with its text.
    Float(&'a str),
    /// `1.0lf`.
    Double,
    /// `true`.
    Bool(bool),
    /// A variable, a function or a type.
    Name(&'a str),
    /// `-a`; the operator's text.
    Unary(&'static str, Box<Expr<'a>>),
    /// `++a`, `a--`: the operator, whether it stands before, and the operand.
    Step(&'static str, bool, Box<Expr<'a>>),
    /// `a + b`.
    Binary(&'static str, Box<Expr<'a>>, Box<Expr<'a>>),
    /// `a = b`, `a += b`: the operator without `=`, empty for `=`.
    Assign(&'static str, Box<Expr<'a>>, Box<Expr<'a>>),
    /// `c ? a : b`.
    Ternary(Box<Expr<'a>>, Box<Expr<'a>>, Box<Expr<'a>>),
    /// `a, b`.
    Comma(Box<Expr<'a>>, Box<Expr<'a>>),
    /// `f(a)`, `vec3(a)`, `float[2](a, b)`, `a.length()`.
    Call(Box<Expr<'a>>, Vec<Expr<'a>>),
    /// `a.b`.
    Member(Box<Expr<'a>>, Name<'a>),
    /// `a[b]`, `float[]`.
    Index(Box<Expr<'a>>, Option<Box<Expr<'a>>>),
    /// `{ a, b }`.
    List(Vec<Expr<'a>>),
}

/// Sizes in brackets; `None` for `[]`.
pub type Sizes<'a> = Vec<Option<Expr<'a>>>;

/// A type as it is written.
#[derive(Debug)]
pub struct TypeSpec<'a> {
    /// Its name or its structure.
    pub base: Base<'a>,
    /// Sizes after it.
    pub sizes: Sizes<'a>,
    /// Where it is.
    pub at: At,
}

/// What a type is before its sizes.
#[derive(Debug)]
pub enum Base<'a> {
    /// A type's name.
    Name(&'a str),
    /// A structure that is declared here.
    Struct(Option<Name<'a>>, Vec<Member<'a>>),
}

/// A member of a structure or a block.
#[derive(Debug)]
pub struct Member<'a> {
    /// Qualifiers.
    pub quals: Vec<Qual<'a>>,
    /// Its type.
    pub ty: TypeSpec<'a>,
    /// Names, with sizes.
    pub names: Vec<Declarator<'a>>,
}

/// A qualifier.
#[derive(Debug)]
pub enum Qual<'a> {
    /// `in`, `const`, `highp` and so on.
    Word(Name<'a>),
    /// `layout(...)`.
    Layout(Vec<(Name<'a>, Option<Expr<'a>>)>),
}

/// A name that is declared.
#[derive(Debug)]
pub struct Declarator<'a> {
    /// The name.
    pub name: Name<'a>,
    /// Sizes after it.
    pub sizes: Sizes<'a>,
    /// What it begins with.
    pub init: Option<Expr<'a>>,
}

/// A parameter.
#[derive(Debug)]
pub struct Param<'a> {
    /// Qualifiers.
    pub quals: Vec<Qual<'a>>,
    /// Its type.
    pub ty: TypeSpec<'a>,
    /// Its name, which may be missing.
    pub name: Option<Name<'a>>,
    /// Sizes after the name.
    pub sizes: Sizes<'a>,
}

/// A declaration.
#[derive(Debug)]
pub enum Item<'a> {
    /// A function or its prototype.
    Function(Box<Function<'a>>),
    /// Variables or only a structure.
    Vars(Vars<'a>),
    /// `uniform Name { ... } instance[2];`
    Block(Box<Block<'a>>),
    /// `layout(...) in;`, `invariant gl_Position;`
    Quals(Vec<Qual<'a>>, Vec<Name<'a>>),
    /// `precision highp float;` and `;`
    Nothing,
}

/// A function.
#[derive(Debug)]
pub struct Function<'a> {
    /// What it returns.
    pub ty: TypeSpec<'a>,
    /// Its name.
    pub name: Name<'a>,
    /// Its parameters.
    pub params: Vec<Param<'a>>,
    /// Its statements; a prototype has none.
    pub body: Option<Vec<Stmt<'a>>>,
}

/// Variables of one declaration.
#[derive(Debug)]
pub struct Vars<'a> {
    /// Qualifiers.
    pub quals: Vec<Qual<'a>>,
    /// Their type.
    pub ty: TypeSpec<'a>,
    /// The variables.
    pub names: Vec<Declarator<'a>>,
}

/// A block of an interface.
#[derive(Debug)]
pub struct Block<'a> {
    /// Qualifiers.
    pub quals: Vec<Qual<'a>>,
    /// The block's name.
    pub name: Name<'a>,
    /// Its members.
    pub members: Vec<Member<'a>>,
    /// The name of the instance, with sizes.
    pub instance: Option<(Name<'a>, Sizes<'a>)>,
}

/// A statement.
#[derive(Debug)]
pub struct Stmt<'a> {
    /// What it is.
    pub kind: StmtKind<'a>,
    /// Where it is.
    pub at: At,
}

/// What a statement is.
#[derive(Debug)]
pub enum StmtKind<'a> {
    /// A declaration.
    Item(Item<'a>),
    /// An expression.
    Expr(Expr<'a>),
    /// `;`
    Nothing,
    /// `{ ... }`
    Block(Vec<Stmt<'a>>),
    /// `if`, its statement and that of `else`.
    If(Expr<'a>, Box<Stmt<'a>>, Option<Box<Stmt<'a>>>),
    /// `switch`.
    Switch(Expr<'a>, Vec<Stmt<'a>>),
    /// `case a:`, or `default:` without a value.
    Case(Option<Expr<'a>>),
    /// `while`.
    While(Cond<'a>, Box<Stmt<'a>>),
    /// `do ... while`.
    Do(Box<Stmt<'a>>, Expr<'a>),
    /// `for`.
    For(Box<Stmt<'a>>, Option<Cond<'a>>, Option<Expr<'a>>, Box<Stmt<'a>>),
    /// `return`.
    Return(Option<Expr<'a>>),
    /// `break`.
    Break,
    /// `continue`.
    Continue,
    /// `discard`.
    Discard,
}

/// A condition of a loop.
#[derive(Debug)]
pub enum Cond<'a> {
    /// An expression.
    Expr(Expr<'a>),
    /// `bool a = b`.
    Declared(Box<Vars<'a>>),
}

//! The tree of a WGSL text. Names are words of the text.

use super::Place;

/// An expression of a [`Tree`].
pub type ExprId = u32;

/// A parameter or a declaration in a function, by its number in the text.
pub type LocalId = u32;

#[derive(Debug)]
pub struct Expr<'t> {
    pub kind: ExprKind<'t>,
    pub place: Place,
    /// How deep expressions nest in it.
    pub height: u16,
}

#[derive(Debug)]
pub enum ExprKind<'t> {
    Literal(&'t str),
    /// A name, or a type with its template list.
    Name {
        name: &'t str,
        template: Vec<ExprId>,
        /// What it means, where that is no declaration of the module.
        local: Option<LocalId>,
    },
    Call {
        callee: &'t str,
        template: Vec<ExprId>,
        arguments: Vec<ExprId>,
    },
    Member {
        base: ExprId,
        name: &'t str,
    },
    Index {
        base: ExprId,
        index: ExprId,
    },
    /// `-`, `!` or `~`.
    Unary {
        operator: &'t str,
        operand: ExprId,
    },
    AddressOf(ExprId),
    Indirection(ExprId),
    Binary {
        operator: &'t str,
        left: ExprId,
        right: ExprId,
    },
    Parenthesized(ExprId),
}

/// How weighty a diagnostic is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    Off,
    Info,
    Warning,
    /// An error, as no filter says otherwise.
    Default,
    /// A filter makes it an error.
    Error,
}

/// A diagnostic rule that texts can filter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Filtered {
    DerivativeUniformity,
    SubgroupUniformity,
}

/// `diagnostic(SEVERITY, RULE)`.
#[derive(Debug, Clone)]
pub struct Filter {
    pub severity: Severity,
    pub rule: Filtered,
}

#[derive(Debug)]
pub struct Attribute<'t> {
    pub name: &'t str,
    pub arguments: Vec<ExprId>,
    pub place: Place,
}

#[derive(Debug)]
pub struct Block<'t> {
    pub filters: Vec<Filter>,
    pub statements: Vec<Statement<'t>>,
    pub place: Place,
}

#[derive(Debug)]
pub struct Statement<'t> {
    pub kind: StatementKind<'t>,
    pub filters: Vec<Filter>,
    pub place: Place,
    pub behaviour: super::behaviour::Behaviour,
}

#[derive(Debug)]
pub enum StatementKind<'t> {
    Empty,
    Block(Block<'t>),
    If {
        condition: ExprId,
        accept: Block<'t>,
        reject: Option<Box<Statement<'t>>>,
    },
    Switch {
        selector: ExprId,
        filters: Vec<Filter>,
        /// The values of its cases.
        values: Vec<ExprId>,
        /// The bodies of its cases.
        clauses: Vec<Block<'t>>,
    },
    Loop {
        body: Block<'t>,
        continuing: Option<Block<'t>>,
    },
    For(Box<ForLoop<'t>>),
    While {
        condition: ExprId,
        body: Block<'t>,
    },
    Declare(LocalId, Declaration<'t>),
    /// Without a target it is `_ = value`.
    Assign {
        target: Option<ExprId>,
        operator: &'t str,
        value: ExprId,
    },
    /// `++` and `--`.
    Count {
        target: ExprId,
    },
    Call(ExprId),
    Return(Option<ExprId>),
    Break,
    BreakIf(ExprId),
    Continue,
    Discard,
    Assert,
}

#[derive(Debug)]
pub struct ForLoop<'t> {
    pub start: Option<Statement<'t>>,
    pub condition: Option<ExprId>,
    pub update: Option<Statement<'t>>,
    pub body: Block<'t>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DeclarationKind {
    Const,
    Let,
    Override,
    Var,
}

#[derive(Debug)]
pub struct Declaration<'t> {
    pub kind: DeclarationKind,
    pub name: &'t str,
    pub place: Place,
    /// The words between `var<` and `>`.
    pub template: Vec<ExprId>,
    pub of_type: Option<ExprId>,
    pub value: Option<ExprId>,
    pub attributes: Vec<Attribute<'t>>,
}

/// A parameter, or a member of a structure.
#[derive(Debug)]
pub struct Member<'t> {
    pub name: &'t str,
    pub place: Place,
    pub of_type: ExprId,
    pub attributes: Vec<Attribute<'t>>,
}

/// What a name in a function may mean.
#[derive(Debug)]
pub struct Local {
    pub of_type: Option<ExprId>,
    /// The value of a `const`.
    pub constant: Option<ExprId>,
}

#[derive(Debug)]
pub struct Function<'t> {
    pub name: &'t str,
    pub place: Place,
    /// The number of the first parameter. The others follow it.
    pub first_local: LocalId,
    pub attributes: Vec<Attribute<'t>>,
    pub filters: Vec<Filter>,
    pub parameters: Vec<Member<'t>>,
    pub result: Option<ExprId>,
    pub result_attributes: Vec<Attribute<'t>>,
    pub body: Block<'t>,
}

#[derive(Debug)]
pub struct Struct<'t> {
    pub name: &'t str,
    pub members: Vec<Member<'t>>,
}

#[derive(Debug)]
pub struct Alias<'t> {
    pub name: &'t str,
    pub of_type: ExprId,
}

/// `enable` or `requires`, with the names of extensions.
#[derive(Debug)]
pub struct Directive<'t> {
    pub word: &'t str,
    pub names: Vec<&'t str>,
    pub place: Place,
}

/// A text as a tree.
#[derive(Debug, Default)]
pub struct Tree<'t> {
    pub expressions: Vec<Expr<'t>>,
    pub filters: Vec<Filter>,
    /// `@diagnostic(...)` at statements.
    pub statement_filters: Vec<Place>,
    pub enabled: Vec<&'t str>,
    /// `enable ...;` and `requires ...;`.
    pub extensions: Vec<Directive<'t>>,
    pub functions: Vec<Function<'t>>,
    pub structs: Vec<Struct<'t>>,
    pub aliases: Vec<Alias<'t>>,
    /// `const`, `override` and `var` of the module.
    pub declarations: Vec<Declaration<'t>>,
    /// By their numbers.
    pub locals: Vec<Local>,
}

impl<'t> Tree<'t> {
    pub fn kind(&self, id: ExprId) -> &ExprKind<'t> {
        &self.expressions[id as usize].kind
    }

    pub fn place(&self, id: ExprId) -> Place {
        self.expressions[id as usize].place
    }

    /// An expression without the brackets around it.
    pub fn inner(&self, mut id: ExprId) -> ExprId {
        while let ExprKind::Parenthesized(inner) = self.kind(id) {
            id = *inner;
        }
        id
    }

    /// The expressions within a place, each after those in it. The place must hold whole expressions.
    pub fn within(&self, place: Place) -> impl Iterator<Item = &Expr<'t>> {
        // Expressions are in the order in which they end.
        let first = self.expressions.partition_point(|one| one.place.end <= place.start);
        self.expressions[first..].iter().take_while(move |one| one.place.end <= place.end)
    }

    /// The function that a place is in. Functions are in the order of the text.
    pub fn enclosing(&self, place: Place) -> Option<usize> {
        let at = self.functions.partition_point(|function| function.place.start <= place.start);
        let at = at.checked_sub(1)?;
        (place.end <= self.functions[at].body.place.end).then_some(at)
    }
}

//! One WESL file, split into items, with every identifier that could mean another item marked.

use std::ops::{Deref, Range};
use std::sync::Arc;

use crate::wesl::token::Name;
use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::source::{SourceId, Span};

/// A parsed file. Indices are into its own tables.
#[derive(Debug)]
pub struct Module {
    /// The file that it was first parsed for. Another file may have the same text and share the
    /// parsed form, so [`PlacedModule`] makes the spans.
    pub(in crate::wesl) source: SourceId,
    pub text: Arc<str>,
    pub directives: Vec<Directive>,
    pub imports: Vec<Import>,
    pub wildcards: Vec<Wildcard>,
    /// Whether other packages may import all that it shows, by `@!wildcardable;`.
    pub is_wildcardable: bool,
    /// Whether anything in it says from where it can be named. Modules that are older than these words
    /// do not, and show all that they declare.
    pub says_visibility: bool,
    pub items: Vec<Item>,
    pub conditions: Vec<Condition>,
    pub expressions: Vec<Expression>,
    pub references: Vec<UsedName>,
    pub guards: Vec<Guard>,
    /// Each place that names a parameter or a local; only where these were asked for.
    pub local_uses: Vec<LocalUse>,
    /// Errors in parts of the file that could not be parsed.
    pub(in crate::wesl) errors: Vec<Diagnostic>,
    /// Warnings about code that other tools refuse, or that looks as if it meant something else.
    pub(in crate::wesl) warnings: Vec<Diagnostic>,
}

impl Module {
    /// Whether parts of the text could not be parsed.
    pub fn has_errors(&self) -> bool {
        !self.errors.is_empty()
    }

    /// The errors that were found since this was last called.
    pub fn take_errors(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.errors)
    }
}

/// A parsed text together with the file that it is used for. Several files, or several readings of
/// one, may share a parsed text.
#[derive(Debug)]
pub struct PlacedModule {
    pub source: SourceId,
    /// Errors in parts of the file that could not be parsed.
    pub errors: Vec<Diagnostic>,
    /// Warnings about code that other tools refuse, or that looks as if it meant something else.
    pub warnings: Vec<Diagnostic>,
    module: Arc<Module>,
}

impl PlacedModule {
    /// The parsed text as that of the file.
    pub fn new(module: Arc<Module>, source: SourceId) -> Self {
        let moved = |found: &[Diagnostic]| {
            found.iter().map(|one| one.clone().moved(module.source, source)).collect()
        };
        Self { source, errors: moved(&module.errors), warnings: moved(&module.warnings), module }
    }

    /// The parsed text itself.
    pub fn shared(&self) -> Arc<Module> {
        Arc::clone(&self.module)
    }

    /// A place in this file.
    pub fn span(&self, range: Range<u32>) -> Span {
        Span { source: self.source, start: range.start, end: range.end }
    }
}

impl Deref for PlacedModule {
    type Target = Module;

    fn deref(&self) -> &Module {
        &self.module
    }
}

/// Index into [`Module::conditions`].
pub type ConditionId = u32;

/// `@if`, `@elif` or `@else` of one node.
#[derive(Debug, Clone)]
pub struct Condition {
    /// `None` for `@else`.
    pub expression: Option<ExpressionId>,
    /// For `@elif` and `@else`, the `@if` or `@elif` of the sibling before.
    pub after: Option<ConditionId>,
    /// The condition of the block around it. Unless that holds, this one is not evaluated and
    /// counts as false.
    pub within: Option<ConditionId>,
}

/// Index into [`Module::expressions`].
pub type ExpressionId = u32;

/// A translate-time expression. A chain of one operator is a single node, so the depth is bounded
/// by the nesting of brackets.
#[derive(Debug, Clone)]
pub enum Expression {
    Literal(bool),
    Flag(Name, Range<u32>),
    Not(ExpressionId),
    All(Vec<ExpressionId>),
    Any(Vec<ExpressionId>),
    Compare {
        left: ComparisonOperand,
        operator: ComparisonOperator,
        right: ComparisonOperand,
        range: Range<u32>,
    },
}

impl Expression {
    /// The names in it: flags, axes and values. Names in its operands are not included.
    pub fn names(&self) -> impl Iterator<Item = Name> {
        let (first, second) = match self {
            Self::Flag(name, _) => (Some(*name), None),
            Self::Compare { left, right, .. } => (left.name(), right.name()),
            _ => (None, None),
        };
        first.into_iter().chain(second)
    }
}

/// A side of a comparison.
#[derive(Debug, Clone)]
pub enum ComparisonOperand {
    Name(Name, Range<u32>),
    Integer(i64, Range<u32>),
}

impl ComparisonOperand {
    fn name(&self) -> Option<Name> {
        match self {
            Self::Name(name, _) => Some(*name),
            Self::Integer(..) => None,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ComparisonOperator {
    Equal,
    NotEqual,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
}

/// `enable`, `requires` or `diagnostic`.
#[derive(Debug)]
pub struct Directive {
    pub keyword: Name,
    pub condition: Option<ConditionId>,
    /// From the keyword to the semicolon.
    pub range: Range<u32>,
    /// Names of an `enable` or `requires`; the words of a `diagnostic`.
    pub names: Vec<Name>,
}

/// One name an `import` statement brings into scope.
#[derive(Debug)]
pub struct Import {
    pub condition: Option<ConditionId>,
    pub path: Path,
    /// The name in scope.
    pub alias: Name,
    pub alias_range: Range<u32>,
    /// Whether the name can also be imported from this module, by `public import`.
    pub is_public: bool,
}

/// `import a::b::*;`: what the module shows, unless something else has the name.
#[derive(Debug)]
pub struct Wildcard {
    pub condition: Option<ConditionId>,
    /// The module. Without segments, it is the package's own module, or that so many `super` above.
    pub path: Path,
    /// The `*`.
    pub range: Range<u32>,
    /// Which of the rules for wildcards between packages a `@diagnostic(off, ...)` turns off.
    pub off: Vec<Name>,
}

/// `package::a::b`, `super::super::c` or `d::e`.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Path {
    pub origin: Origin,
    pub segments: Vec<Name>,
    pub range: Range<u32>,
    pub parts: PathParts,
}

/// Places within a path. In a collection, `a::{b, c}`, the shared part is before `range`.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct PathParts {
    pub first: Range<u32>,
    /// All names but the last, as far as they are written in one piece.
    pub parents: Range<u32>,
    pub last: Range<u32>,
}

/// Where a path starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Origin {
    /// The importing module's package.
    Package,
    /// The module that is so many `super` above the importing one.
    Super(u32),
    /// A name in scope, or a package.
    Scope,
}

/// What kind of global declaration an item is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ItemKind {
    Function,
    Struct,
    Const,
    Override,
    Var,
    Alias,
    ConstAssert,
}

/// From where a declaration can be named.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Visibility {
    /// From its own module, by `private`.
    Private,
    /// From its own package.
    Package,
    /// From every package, by `public`.
    Public,
}

/// A global declaration.
#[derive(Debug)]
pub struct Item {
    pub kind: ItemKind,
    pub visibility: Visibility,
    /// [`Name::UNDERSCORE`] for a `const_assert`.
    pub name: Name,
    pub name_range: Range<u32>,
    /// What is copied: the comments above, the attributes, the declaration, and a comment behind it
    /// on the same line.
    pub range: Range<u32>,
    pub condition: Option<ConditionId>,
    /// Has `@vertex`, `@fragment` or `@compute`.
    pub entry: bool,
    /// Sorted by place. A node contains the events up to its `next`.
    pub events: Vec<Event>,
    /// Names of parameters and local declarations, sorted.
    pub locals: Vec<Name>,
    /// Identifiers that name neither a local nor anything in the module's scope, sorted.
    pub free: Vec<Name>,
}

/// A place of an item where composing may change the text.
#[derive(Debug, Clone, Copy)]
pub enum Event {
    /// Text that is always removed: a translate-time attribute.
    Cut { start: u32, end: u32 },
    /// A conditional node. If the condition is false, `start..end` is removed and the next event is
    /// `next`.
    Node { condition: ConditionId, start: u32, end: u32, next: u32 },
    /// The declared name.
    Definition { start: u32, end: u32 },
    /// A use of something global, unless a guard in the chain that starts at `guard` holds.
    Use { reference: u32, guard: Option<u32>, start: u32, end: u32 },
}

/// What a use names.
#[derive(Debug, Clone)]
pub enum UsedName {
    /// An item of the module or an imported name.
    Name(Name),
    /// A path written in place.
    Path(Path),
}

/// A place that declares or uses a parameter or a local.
#[derive(Debug, Clone, Copy)]
pub struct LocalUse {
    /// The first byte of the name where it is declared.
    pub declared: u32,
    pub start: u32,
    pub end: u32,
}

/// A conditional local declaration. While its condition holds, the name means the local.
#[derive(Debug, Clone, Copy)]
pub struct Guard {
    pub condition: ConditionId,
    /// The guard of the next outer declaration of the name.
    pub next: Option<u32>,
}

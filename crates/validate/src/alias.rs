//! Refuses calls whose pointers lead to one variable that the function changes (WGSL, "Alias
//! Analysis"). naga accepts them, and each language gives them another result: HLSL and GLSL copy
//! arguments in and out, the others do not.

use std::collections::BTreeMap;

use naga::{Expression, Function, GlobalVariable, Handle, Module, Span, Statement, TypeInner};

use super::operands::inner_blocks;
use lamplight_compose::Composed;
use lamplight_diagnostic::{Diagnostic, codes};

/// What a pointer leads to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Root {
    Global(Handle<GlobalVariable>),
    Local(Handle<naga::LocalVariable>),
    Parameter(u32),
}

/// What is done to the variable that a pointer leads to.
#[derive(Debug, Clone, Copy, Default)]
struct Use {
    reads: bool,
    writes: bool,
}

impl Use {
    fn add(&mut self, other: Self) {
        self.reads |= other.reads;
        self.writes |= other.writes;
    }

    /// Whether one of the two changes what the other sees.
    fn disturbs(self, other: Self) -> bool {
        (self.writes && (other.reads || other.writes)) || (other.writes && self.reads)
    }
}

const READ: Use = Use { reads: true, writes: false };
const WRITE: Use = Use { reads: false, writes: true };
const BOTH: Use = Use { reads: true, writes: true };

/// What a function does to its parameters and to the variables of the module, its callees included.
type Uses = BTreeMap<Root, Use>;

/// A call with arguments that disturb each other.
struct AliasedCall {
    call: Span,
    /// The arguments. Of a variable of the module that the function itself uses, only one is.
    arguments: Vec<Span>,
    /// The name of the variable, if the function uses it by itself.
    global: Option<String>,
}

/// The first call of a module whose pointers lead to one variable that the function changes.
pub fn refuse_aliases(composed: &Composed, module: &Module) -> Result<(), Diagnostic> {
    match find_alias(module) {
        None => Ok(()),
        Some(found) => Err(describe(composed, &found)),
    }
}

/// Whether two pointers of a call lead to one variable, or one of them to a variable that the
/// function names itself, whatever is done to them.
pub fn may_alias(module: &Module, function: &Function, names: NamesGlobal<'_>) -> bool {
    let mut found = false;
    for_each_call(function, &mut |callee, arguments, _| {
        let roots = pointer_roots(module, function, arguments);
        let mut pairs = roots
            .iter()
            .enumerate()
            .flat_map(|(at, one)| roots[..at].iter().map(move |other| one.root == other.root));
        let twice = pairs.any(|is_same| is_same);
        let names = |root: &PointerRoot| match root.root {
            Root::Global(global) => names(callee, global),
            Root::Local(_) | Root::Parameter(_) => false,
        };
        found |= twice || roots.iter().any(names);
    });
    found
}

/// Whether a function names a variable of the module, directly or in what it calls.
pub type NamesGlobal<'n> = &'n dyn Fn(Handle<Function>, Handle<GlobalVariable>) -> bool;

fn describe(composed: &Composed, found: &AliasedCall) -> Diagnostic {
    let message = match &found.global {
        Some(name) => {
            format!("`{name}` is passed to a function that also uses `{name}` by its name")
        }
        None => "two arguments are one variable, which the function changes".to_owned(),
    };
    let error = Diagnostic::error(codes::ALIASED_POINTER, message);
    let place = |span: &Span| span.to_range().and_then(|range| composed.map.lookup(range));
    // naga has no place for the name of a variable in GLSL but that of its declaration.
    let error = match place(&found.call) {
        Some(span) => error.at(span, "in this call"),
        None => {
            let arguments = found.arguments.iter().find_map(place);
            arguments.into_iter().fold(error, |error, span| error.at(span, "this variable"))
        }
    };
    error.note("help: pass a copy: `var copy = value;`")
}

fn find_alias(module: &Module) -> Option<AliasedCall> {
    let mut uses: Vec<Uses> = Vec::with_capacity(module.functions.len());
    // Callees come before their callers.
    for (_, function) in module.functions.iter() {
        let (found, alias) = uses_of(module, function, &uses);
        if alias.is_some() {
            return alias;
        }
        uses.push(found);
    }
    let mut points = module.entry_points.iter();
    points.find_map(|point| uses_of(module, &point.function, &uses).1)
}

fn uses_of(module: &Module, function: &Function, known: &[Uses]) -> (Uses, Option<AliasedCall>) {
    let (mut uses, mut alias) = (Uses::new(), None);
    for (_, expression) in function.expressions.iter() {
        if let Expression::Load { pointer } = expression {
            add(&mut uses, function, *pointer, READ);
        }
    }
    for_each_statement(function, &mut |statement, _| match statement {
        Statement::Store { pointer, value: _ } => add(&mut uses, function, *pointer, WRITE),
        Statement::Atomic { pointer, fun: _, value: _, result: _ } => {
            add(&mut uses, function, *pointer, BOTH);
        }
        Statement::WorkGroupUniformLoad { pointer, result: _ } => {
            add(&mut uses, function, *pointer, READ);
        }
        _ => {}
    });
    for_each_call(function, &mut |callee, arguments, call| {
        let Some(callee) = known.get(callee.index()) else { return };
        let roots = pointer_roots(module, function, arguments);
        if alias.is_none() {
            alias = aliased(module, &roots, callee, call);
        }
        for PointerRoot { root, parameter, span: _ } in &roots {
            let done = callee.get(&Root::Parameter(*parameter)).copied().unwrap_or_default();
            uses.entry(*root).or_default().add(done);
        }
        for (root, done) in callee {
            if let Root::Global(_) = root {
                uses.entry(*root).or_default().add(*done);
            }
        }
    });
    (uses, alias)
}

fn aliased(
    module: &Module,
    roots: &[PointerRoot],
    callee: &Uses,
    call: Span,
) -> Option<AliasedCall> {
    let of = |one: &PointerRoot| {
        callee.get(&Root::Parameter(one.parameter)).copied().unwrap_or_default()
    };
    for (at, one) in roots.iter().enumerate() {
        let other =
            roots[..at].iter().find(|other| other.root == one.root && of(one).disturbs(of(other)));
        if let Some(other) = other {
            return Some(AliasedCall { call, arguments: vec![one.span, other.span], global: None });
        }
        let Root::Global(global) = one.root else { continue };
        if callee.get(&one.root).is_some_and(|own| own.disturbs(of(one))) {
            let name = module.global_variables[global].name.clone().unwrap_or_default();
            return Some(AliasedCall { call, arguments: vec![one.span], global: Some(name) });
        }
    }
    None
}

fn add(uses: &mut Uses, function: &Function, pointer: Handle<Expression>, done: Use) {
    if let Some(root) = root_of(function, pointer) {
        uses.entry(root).or_default().add(done);
    }
}

/// An argument that is a pointer.
struct PointerRoot {
    root: Root,
    /// The parameter that it is passed for.
    parameter: u32,
    span: Span,
}

/// The arguments that are pointers.
fn pointer_roots(
    module: &Module,
    function: &Function,
    arguments: &[Handle<Expression>],
) -> Vec<PointerRoot> {
    let pointers = arguments.iter().enumerate().filter_map(|(parameter, argument)| {
        let root = root_of(function, *argument)?;
        let span = function.expressions.get_span(*argument);
        is_memory(module, function, root).then_some(PointerRoot {
            root,
            parameter: parameter as u32,
            span,
        })
    });
    pointers.collect()
}

/// Whether a root is memory. Textures and samplers are passed in the same way.
fn is_memory(module: &Module, function: &Function, root: Root) -> bool {
    match root {
        Root::Global(global) => module.global_variables[global].space != naga::AddressSpace::Handle,
        Root::Local(_) => true,
        Root::Parameter(index) => function.arguments.get(index as usize).is_some_and(|argument| {
            matches!(
                module.types[argument.ty].inner,
                TypeInner::Pointer { base: _, space: _ }
                    | TypeInner::ValuePointer { size: _, scalar: _, space: _ }
            )
        }),
    }
}

/// What a pointer leads to; `None` for a value.
fn root_of(function: &Function, mut pointer: Handle<Expression>) -> Option<Root> {
    loop {
        match function.expressions[pointer] {
            Expression::Access { base, index: _ } | Expression::AccessIndex { base, index: _ } => {
                pointer = base;
            }
            Expression::GlobalVariable(global) => return Some(Root::Global(global)),
            Expression::LocalVariable(local) => return Some(Root::Local(local)),
            Expression::FunctionArgument(index) => return Some(Root::Parameter(index)),
            _ => return None,
        }
    }
}

fn for_each_statement<'f>(function: &'f Function, visit: &mut dyn FnMut(&'f Statement, Span)) {
    let mut open = vec![&function.body];
    while let Some(block) = open.pop() {
        for (statement, span) in block.span_iter() {
            visit(statement, *span);
            open.extend(inner_blocks(statement));
        }
    }
}

/// What is done with a call: the function, its arguments, and the place.
type VisitCall<'v> = dyn FnMut(Handle<Function>, &[Handle<Expression>], Span) + 'v;

fn for_each_call(function: &Function, visit: &mut VisitCall<'_>) {
    for_each_statement(function, &mut |statement, span| {
        if let Statement::Call { function, arguments, result: _ } = statement {
            visit(*function, arguments, span);
        }
    });
}

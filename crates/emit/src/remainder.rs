//! Signed remainders in GLSL.
//!
//! WGSL truncates: `-5 % 3` is -2. GLSL leaves `%` undefined where an operand is negative
//! (Kessenich, Baldwin and Rost, "The OpenGL Shading Language", version 4.50, section 5.9), and
//! naga writes it all the same. A function computes `a - a / b * b` instead, since division
//! truncates.

use std::collections::BTreeMap;

use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{
    Arena, BinaryOperator, Block, Expression, Function, FunctionArgument, FunctionResult, Handle,
    Module, Range, Scalar, ScalarKind, Span, Statement, Type, TypeInner, VectorSize,
};

use lamplight_validate::info_unchecked;
use lamplight_validate::inner_blocks_mut;

/// The name of the functions, as naga has it in other languages.
const NAME: &str = "naga_mod";

/// The type of a remainder's operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct OperandShape {
    /// `None` for a scalar.
    size: Option<VectorSize>,
    width: u8,
}

type Remainders = BTreeMap<Handle<Expression>, OperandShape>;

/// The module with calls in the place of signed remainders, and naga's analysis of it; `None` where
/// there are none.
///
/// # Errors
/// The message of naga, if it refuses the new module.
pub fn with_defined_remainders(
    module: &Module,
    info: &ModuleInfo,
) -> Result<Option<(Module, ModuleInfo)>, String> {
    let of_functions = module.functions.iter().map(|(handle, one)| (one, &info[handle]));
    let of_entries = module
        .entry_points
        .iter()
        .enumerate()
        .map(|(index, point)| (&point.function, info.get_entry_point(index)));
    let found: Vec<Remainders> = of_functions
        .chain(of_entries)
        .map(|(function, info)| signed_remainders(module, function, info))
        .collect();
    if found.iter().all(BTreeMap::is_empty) {
        return Ok(None);
    }
    let mut module = module.clone();
    let mut functions = Arena::new();
    let mut helpers = BTreeMap::new();
    for shape in found.iter().flat_map(BTreeMap::values) {
        helpers.entry(*shape).or_insert_with(|| {
            functions.append(remainder_function(&mut module, *shape), Span::UNDEFINED)
        });
    }
    // The new functions come first, since naga has no calls forward.
    let mut moved = BTreeMap::new();
    let mut found = found.into_iter();
    for (old, mut function, span) in std::mem::take(&mut module.functions).drain() {
        call_helpers(&mut function, &moved, &helpers, &found.next().unwrap_or_default());
        moved.insert(old, functions.append(function, span));
    }
    for point in &mut module.entry_points {
        call_helpers(&mut point.function, &moved, &helpers, &found.next().unwrap_or_default());
    }
    module.functions = functions;
    let info = info_unchecked(&module);
    let info = info.map_err(|error| format!("a module with remainders is not valid: {error}"))?;
    Ok(Some((module, info)))
}

/// The written text, in which all functions for remainders have the same names of parameters. naga
/// numbers these where the module has the names elsewhere, so that one function would have several
/// texts.
pub fn with_plain_parameters(text: String) -> String {
    if !text.contains(NAME) {
        return text;
    }
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    let mut plain = String::with_capacity(text.len());
    let mut at = 0;
    while at < lines.len() {
        match lines.get(at + 1).and_then(|body| plain_function(lines[at], body)) {
            Some(function) => {
                plain.push_str(&function);
                at += 2;
            }
            None => {
                plain.push_str(lines[at]);
                at += 1;
            }
        }
    }
    plain
}

/// The same remainder function with parameters `lhs` and `rhs`; `None` if naga wrote another body.
fn plain_function(head: &str, body: &str) -> Option<String> {
    let (start, parameters) = head.trim_end().strip_suffix(") {")?.split_once('(')?;
    let (ty, _) = start.split_once(' ').filter(|(_, name)| name.starts_with(NAME))?;
    let (left, right) = parameters.split_once(", ")?;
    let (left, right) = (left.split_once(' ')?.1, right.split_once(' ')?.1);
    let computed = |left: &str, right: &str| {
        format!("    return ({left} - (({left} / {right}) * {right}));\n")
    };
    let plain = || format!("{start}({ty} lhs, {ty} rhs) {{\n{}", computed("lhs", "rhs"));
    (body == computed(left, right)).then(plain)
}

/// The remainders of signed integers in a function.
fn signed_remainders(module: &Module, function: &Function, info: &FunctionInfo) -> Remainders {
    let signed = |expression: &Expression| {
        let Expression::Binary { op: BinaryOperator::Modulo, left, .. } = *expression else {
            return None;
        };
        let (size, scalar) = match *info[left].ty.inner_with(&module.types) {
            TypeInner::Scalar(scalar) => (None, scalar),
            TypeInner::Vector { size, scalar } => (Some(size), scalar),
            _ => return None,
        };
        (scalar.kind == ScalarKind::Sint).then_some(OperandShape { size, width: scalar.width })
    };
    let all = function.expressions.iter();
    all.filter_map(|(handle, expression)| Some((handle, signed(expression)?))).collect()
}

/// `a - a / b * b`.
fn remainder_function(module: &mut Module, OperandShape { size, width }: OperandShape) -> Function {
    let scalar = Scalar { kind: ScalarKind::Sint, width };
    let inner = match size {
        None => TypeInner::Scalar(scalar),
        Some(size) => TypeInner::Vector { size, scalar },
    };
    let ty = module.types.insert(Type { name: None, inner }, Span::UNDEFINED);
    let argument = |name: &str| FunctionArgument { name: Some(name.to_owned()), ty, binding: None };
    let mut expressions = Arena::new();
    let mut add = |expression| expressions.append(expression, Span::UNDEFINED);
    let (a, b) = (add(Expression::FunctionArgument(0)), add(Expression::FunctionArgument(1)));
    let quotient = add(Expression::Binary { op: BinaryOperator::Divide, left: a, right: b });
    let whole = add(Expression::Binary { op: BinaryOperator::Multiply, left: quotient, right: b });
    let rest = add(Expression::Binary { op: BinaryOperator::Subtract, left: a, right: whole });
    let mut body = Block::new();
    body.push(Statement::Emit(Range::new_from_bounds(quotient, rest)), Span::UNDEFINED);
    body.push(Statement::Return { value: Some(rest) }, Span::UNDEFINED);
    Function {
        name: Some(NAME.to_owned()),
        arguments: vec![argument("lhs"), argument("rhs")],
        result: Some(FunctionResult { ty, binding: None }),
        expressions,
        body,
        ..Function::default()
    }
}

type Moved = BTreeMap<Handle<Function>, Handle<Function>>;
type Helpers = BTreeMap<OperandShape, Handle<Function>>;
/// The call that computes an expression.
type HelperCalls = BTreeMap<Handle<Expression>, Statement>;

/// Replaces remainders by calls of helpers, and gives all other calls the new handles of their
/// functions.
fn call_helpers(
    function: &mut Function,
    moved: &Moved,
    helpers: &Helpers,
    remainders: &Remainders,
) {
    let mut calls = HelperCalls::new();
    for (handle, expression) in function.expressions.iter_mut() {
        match expression {
            Expression::CallResult(callee) => *callee = moved[callee],
            Expression::Binary { left, right, .. } => {
                if let Some(shape) = remainders.get(&handle) {
                    let helper = helpers[shape];
                    let arguments = vec![*left, *right];
                    let result = Some(handle);
                    calls.insert(handle, Statement::Call { function: helper, arguments, result });
                    *expression = Expression::CallResult(helper);
                }
            }
            _ => {}
        }
    }
    call_in(&mut function.body, moved, &calls);
}

fn call_in(block: &mut Block, moved: &Moved, calls: &HelperCalls) {
    for (mut statement, span) in std::mem::take(block).span_into_iter() {
        match &mut statement {
            Statement::Emit(range) => {
                for handle in range.clone() {
                    let alone = Statement::Emit(Range::new_from_bounds(handle, handle));
                    block.push(calls.get(&handle).cloned().unwrap_or(alone), span);
                }
                continue;
            }
            Statement::Call { function, .. } => *function = moved[function],
            _ => {}
        }
        for inner in inner_blocks_mut(&mut statement) {
            call_in(inner, moved, calls);
        }
        block.push(statement, span);
    }
}

//! Keeps values of `let` apart from constants in WGSL.
//!
//! A `let` is no constant there: `let a = 3e38; a * a` is computed as the shader runs. naga puts the
//! value of `a` in the place of its name, and would write `3e38f * 3e38f`, a constant expression that
//! browsers refuse. naga has computed every other constant expression, so what is left of them gets
//! an operand from a variable.

use std::collections::BTreeMap;

use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{
    Arena, Expression, Function, Handle, Literal, LocalVariable, MathFunction, Module, ScalarKind,
    Type,
};

use super::rebuild::rebuild;
use lamplight_validate::{change_operands, info_unchecked, operands};

type Value = Handle<Expression>;

/// The operand, by its number, that becomes a variable, for each expression that needs one.
type Places = BTreeMap<Value, usize>;

/// The module with variables in constant expressions, and naga's analysis of it; `None` where it has
/// no such expressions.
///
/// # Errors
/// The message of naga, if it refuses the new module.
pub fn with_variables(
    module: &Module,
    info: &ModuleInfo,
) -> Result<Option<(Module, ModuleInfo)>, String> {
    let points = module.entry_points.iter().enumerate();
    let points = points.map(|(index, point)| (&point.function, info.get_entry_point(index)));
    let all = module.functions.iter().map(|(handle, function)| (function, &info[handle]));
    let all: Vec<(&Function, &FunctionInfo)> = all.chain(points).collect();
    let found: Vec<Places> = all.iter().map(|(function, _)| places(module, function)).collect();
    if found.iter().all(BTreeMap::is_empty) {
        return Ok(None);
    }
    let mut made = module.clone();
    let types: Vec<BTreeMap<Value, Handle<Type>>> =
        all.iter().zip(&found).map(|(one, places)| types_of(&mut made, *one, places)).collect();
    let functions = made.functions.iter_mut().map(|(_, function)| function);
    let points = made.entry_points.iter_mut().map(|point| &mut point.function);
    for ((function, places), types) in functions.chain(points).zip(&found).zip(&types) {
        put_variables(function, places, types);
    }
    let info = info_unchecked(&made)
        .map_err(|error| format!("a module with variables for values is not valid: {error}"))?;
    Ok(Some((made, info)))
}

/// The type of each operand that becomes a variable.
fn types_of(
    made: &mut Module,
    (function, info): (&Function, &FunctionInfo),
    places: &Places,
) -> BTreeMap<Value, Handle<Type>> {
    let mut types = BTreeMap::new();
    for (value, place) in places {
        let operand = operands(&function.expressions[*value])[*place];
        let ty = match &info[operand].ty {
            naga::proc::TypeResolution::Handle(handle) => *handle,
            naga::proc::TypeResolution::Value(inner) => {
                let ty = Type { name: None, inner: inner.clone() };
                made.types.insert(ty, naga::Span::UNDEFINED)
            }
        };
        types.insert(operand, ty);
    }
    types
}

/// Reads variables in the place of operands. Each has the operand for its initial value.
fn put_variables(function: &mut Function, places: &Places, types: &BTreeMap<Value, Handle<Type>>) {
    let mut variables = BTreeMap::new();
    for (operand, ty) in types {
        let name = Some("constant".to_owned());
        let span = function.expressions.get_span(*operand);
        let local = LocalVariable { name, ty: *ty, init: Some(*operand) };
        variables.insert(*operand, function.local_variables.append(local, span));
    }
    let old: BTreeMap<Value, Value> = places
        .iter()
        .map(|(value, place)| (*value, operands(&function.expressions[*value])[*place]))
        .collect();
    rebuild(function, &mut |value, mut expression, span, expressions: &mut Arena<Expression>| {
        if let (Some(place), Some(operand)) = (places.get(&value), old.get(&value)) {
            let variable = Expression::LocalVariable(variables[operand]);
            let pointer = expressions.append(variable, span);
            let read = expressions.append(Expression::Load { pointer }, span);
            let mut index = 0;
            change_operands(&mut expression, &mut |operand| {
                if index == *place {
                    *operand = read;
                }
                index += 1;
            });
        }
        expressions.append(expression, span)
    });
}

/// The expressions of a function that WGSL would compute beforehand, and refuse.
fn places(module: &Module, function: &Function) -> Places {
    let constants = Constants { module, function };
    let place = |(value, expression)| Some((value, constants.place(expression)?));
    function.expressions.iter().filter_map(place).collect()
}

struct Constants<'m> {
    module: &'m Module,
    function: &'m Function,
}

impl Constants<'_> {
    /// The number of the operand that must not be a constant.
    fn place(&self, expression: &Expression) -> Option<usize> {
        let all = || operands(expression).iter().all(|operand| self.is_constant(*operand));
        match expression {
            Expression::Unary { .. } | Expression::Binary { .. } => all().then_some(0),
            Expression::As { expr, kind, convert } => {
                // The bits of a number have a value, but for those of an infinity.
                let is_bits = convert.is_none();
                let is_open = match self.numbers(*expr) {
                    Some(numbers) if is_bits => {
                        *kind == ScalarKind::Float
                            && numbers.iter().any(|bits| !bits.as_float().is_finite())
                    }
                    _ => true,
                };
                (is_open && self.is_constant(*expr)).then_some(0)
            }
            Expression::Math { fun, .. } => {
                self.refused(*fun, &operands(expression)).or_else(|| all().then_some(0))
            }
            _ => None,
        }
    }

    /// The argument that WGSL refuses as a constant, whatever the first one is.
    fn refused(&self, function: MathFunction, arguments: &[Value]) -> Option<usize> {
        let any = |low: usize, high: usize, holds: &dyn Fn(f64, f64) -> bool| {
            let numbers = |index: usize| self.numbers(*arguments.get(index)?);
            let (Some(low), Some(high)) = (numbers(low), numbers(high)) else { return false };
            let count = low.len().max(high.len());
            let at = |list: &[Bits], index: usize| list[index.min(list.len() - 1)].value;
            (0..count).any(|index| holds(at(&low, index), at(&high, index)))
        };
        let is_beyond = |offset, count| offset + count > 32.0;
        match function {
            MathFunction::SmoothStep => any(0, 1, &|low, high| low >= high).then_some(0),
            MathFunction::Clamp => any(1, 2, &|low, high| low > high).then_some(1),
            MathFunction::Ldexp => any(1, 1, &|exponent, _| exponent > 128.0).then_some(1),
            MathFunction::ExtractBits => any(1, 2, &is_beyond).then_some(1),
            MathFunction::InsertBits => any(2, 3, &is_beyond).then_some(2),
            _ => None,
        }
    }

    /// Whether WGSL takes an expression for a constant, as it is written.
    fn is_constant(&self, value: Value) -> bool {
        match &self.function.expressions[value] {
            Expression::Literal(_) | Expression::Constant(_) | Expression::ZeroValue(_) => true,
            Expression::Splat { size: _, value } => self.is_constant(*value),
            Expression::Compose { ty: _, components } => {
                components.iter().all(|component| self.is_constant(*component))
            }
            Expression::Swizzle { size: _, vector, pattern: _ } => self.is_constant(*vector),
            Expression::AccessIndex { base, index: _ } => self.is_constant(*base),
            _ => false,
        }
    }

    /// The numbers of a constant: one, or one for each component.
    fn numbers(&self, value: Value) -> Option<Vec<Bits>> {
        let numbers = numbers_of(&self.function.expressions, value, &|constant| {
            let init = self.module.constants[constant].init;
            numbers_of(&self.module.global_expressions, init, &|_| None)
        });
        numbers.filter(|numbers| !numbers.is_empty())
    }
}

/// A number, and its bits if it has 32.
#[derive(Clone, Copy)]
struct Bits {
    value: f64,
    bits: u32,
}

impl Bits {
    fn as_float(self) -> f32 {
        f32::from_bits(self.bits)
    }
}

fn numbers_of(
    expressions: &Arena<Expression>,
    value: Value,
    constant: &dyn Fn(Handle<naga::Constant>) -> Option<Vec<Bits>>,
) -> Option<Vec<Bits>> {
    match &expressions[value] {
        Expression::Literal(literal) => Some(vec![bits_of(*literal)?]),
        Expression::Constant(handle) => constant(*handle),
        Expression::ZeroValue(_) => Some(vec![Bits { value: 0.0, bits: 0 }]),
        Expression::Splat { size: _, value } => numbers_of(expressions, *value, constant),
        Expression::Compose { ty: _, components } => {
            let parts = components.iter().map(|part| numbers_of(expressions, *part, constant));
            Some(parts.collect::<Option<Vec<_>>>()?.concat())
        }
        _ => None,
    }
}

fn bits_of(literal: Literal) -> Option<Bits> {
    Some(match literal {
        Literal::F32(value) => Bits { value: f64::from(value), bits: value.to_bits() },
        Literal::U32(value) => Bits { value: f64::from(value), bits: value },
        Literal::I32(value) => Bits { value: f64::from(value), bits: value as u32 },
        Literal::F16(value) => Bits { value: f64::from(value), bits: 0 },
        _ => return None,
    })
}

//! Expressions that a writer writes wrongly, in a form that it writes right.

use std::collections::BTreeMap;

use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{
    Arena, AtomicFunction, BinaryOperator, Block, Expression, Function, Handle, Literal,
    MathFunction, Module, Scalar, ScalarKind, Span, Statement, Type, TypeInner, UnaryOperator,
    UniqueArena, VectorSize,
};

use super::rebuild::rebuild;
use lamplight_validate::{info_unchecked, inner_blocks};

type Value = Handle<Expression>;

/// What a target's writer needs.
#[derive(Debug, Clone, Copy, Default)]
pub struct Needs {
    /// Offsets of samples as vectors with all their components: naga's writer of GLSL panics where a
    /// number stands for all of them.
    pub whole_offsets: bool,
    /// A choice between vectors of integers, component by component. GLSL has `mix` for them from
    /// 4.50, and ES from 3.10.
    pub separate_choices: bool,
    /// Integer divisors that are never zero, and never -1 for the smallest number: WGSL says what
    /// the results are, and GLSL does not.
    pub defined_divisors: bool,
    /// Floats that become integers and are never beyond the range of these: WGSL takes the nearest
    /// integer that the float can be, and GLSL leaves it open.
    pub bounded_integers: bool,
    /// Unpacked numbers of 8 bits and of 16 bits that are never below -1.
    pub clamped_bytes: bool,
    pub clamped_words: bool,
    /// Four unsigned numbers packed to bytes, as an operand of something: naga's writers of texts put
    /// no parentheses around the operators that they write for it.
    pub enclosed_bytes: bool,
    /// Values that an atomic function subtracts: naga writes a `-` before them for GLSL, also before
    /// another one.
    pub enclosed_subtrahends: bool,
    /// Vectors of three as what is chosen between: Metal packs them where they are members, and takes
    /// a choice between a packed vector and another one for ambiguous.
    pub unpacked_choices: bool,
    /// Shifts by less than the bits of a number: WGSL counts modulo these, other languages leave the
    /// result open.
    pub masked_shifts: bool,
}

/// What stands in the place of an expression.
#[derive(Debug, Clone, Copy)]
enum Form {
    /// A vector of this type, with one number for all components.
    Repeated(VectorSize),
    Separate(VectorSize, Scalar),
    /// A division or a remainder: of vectors of this size, of signed integers.
    Defined(Option<VectorSize>, bool),
    Clamped(VectorSize),
    /// An operand of an operator beside this zero, around which each writer puts parentheses.
    Enclosed(Literal),
    /// A shift whose right side has this size, and keeps the bits of this number.
    Masked(Option<VectorSize>, u32),
    /// A member that becomes a vector of numbers of this kind and width, which it is already.
    Unpacked(ScalarKind, u8),
    /// A conversion of vectors of this size to integers, from floats with these bounds.
    Bounded(Option<VectorSize>, [Literal; 2]),
}

/// The module in which these expressions have another form, and naga's analysis of it; `None` where
/// it has none of them.
///
/// # Errors
/// The message of naga, if it refuses the new module.
pub fn with_plain_forms(
    module: &Module,
    info: &ModuleInfo,
    needs: Needs,
) -> Result<Option<(Module, ModuleInfo)>, String> {
    let points = module.entry_points.iter().enumerate();
    let points = points.map(|(index, point)| (&point.function, info.get_entry_point(index)));
    let all = module.functions.iter().map(|(handle, function)| (function, &info[handle]));
    let found: Vec<BTreeMap<Value, Form>> =
        all.chain(points).map(|(function, info)| forms(module, function, info, needs)).collect();
    if found.iter().all(BTreeMap::is_empty) {
        return Ok(None);
    }
    let mut module = module.clone();
    let mut found = found.into_iter();
    let (types, points) = (&mut module.types, &mut module.entry_points);
    let functions = module.functions.iter_mut().map(|(_, function)| function);
    for function in functions.chain(points.iter_mut().map(|point| &mut point.function)) {
        let forms = found.next().unwrap_or_default();
        if !forms.is_empty() {
            let mut write = |old: Value, expression, span, expressions: &mut Arena<Expression>| {
                let mut maker = Maker { types: &mut *types, expressions, span };
                match forms.get(&old) {
                    Some(form) => maker.written(*form, expression),
                    None => maker.add(expression),
                }
            };
            rebuild(function, &mut write);
        }
    }
    let info = info_unchecked(&module)
        .map_err(|error| format!("a module with other expressions is not valid: {error}"))?;
    Ok(Some((module, info)))
}

/// The expressions of a function that need another form.
fn forms(
    module: &Module,
    function: &Function,
    info: &FunctionInfo,
    needs: Needs,
) -> BTreeMap<Value, Form> {
    let mut found = repeated_offsets(function, needs);
    if needs.unpacked_choices {
        found.extend(chosen_members(module, function, info));
    }
    if needs.enclosed_subtrahends {
        found.extend(subtrahends(function, &function.body));
    }
    for (handle, _) in function.expressions.iter() {
        found.extend(own_form(module, (function, info), handle, needs).map(|form| (handle, form)));
    }
    found
}

/// The values below zero, or negated ones, that atomic functions subtract.
fn subtrahends(function: &Function, block: &Block) -> BTreeMap<Value, Form> {
    let own = block.iter().filter_map(|statement| {
        let Statement::Atomic { pointer: _, fun: AtomicFunction::Subtract, value, result: _ } =
            statement
        else {
            return None;
        };
        match function.expressions[*value] {
            Expression::Literal(Literal::I32(number)) if number < 0 => Some(*value),
            Expression::Unary { op: UnaryOperator::Negate, expr: _ } => Some(*value),
            _ => None,
        }
    });
    let own = own.map(|value| (value, Form::Enclosed(Literal::I32(0))));
    let inner = block.iter().flat_map(inner_blocks);
    own.chain(inner.flat_map(|block| subtrahends(function, block))).collect()
}

/// The form that an expression needs for what it is itself.
fn own_form(
    module: &Module,
    (function, info): (&Function, &FunctionInfo),
    handle: Value,
    needs: Needs,
) -> Option<Form> {
    match function.expressions[handle] {
        Expression::Select { condition, accept: _, reject: _ } if needs.separate_choices => {
            match (shape(module, info, condition), shape(module, info, handle)) {
                (Some((Some(size), _)), Some((_, scalar))) if scalar.kind != ScalarKind::Float => {
                    Some(Form::Separate(size, scalar))
                }
                _ => None,
            }
        }
        Expression::Binary {
            op: BinaryOperator::Divide | BinaryOperator::Modulo,
            left: _,
            right,
        } if needs.defined_divisors && !is_harmless(module, function, right) => {
            match shape(module, info, handle) {
                Some((size, Scalar::I32)) => Some(Form::Defined(size, true)),
                Some((size, Scalar::U32)) => Some(Form::Defined(size, false)),
                _ => None,
            }
        }
        Expression::Binary {
            op: BinaryOperator::ShiftLeft | BinaryOperator::ShiftRight,
            left: _,
            right,
        } if needs.masked_shifts => masked(module, (function, info), handle, right),
        Expression::As { expr, kind, convert: Some(4) } if needs.bounded_integers => {
            shape(module, info, expr)
                .and_then(|(size, from)| Some(Form::Bounded(size, integer_bounds(from, kind)?)))
        }
        Expression::Math { fun: MathFunction::Unpack4x8snorm, .. } if needs.clamped_bytes => {
            Some(Form::Clamped(VectorSize::Quad))
        }
        Expression::Math { fun: MathFunction::Unpack2x16snorm, .. } if needs.clamped_words => {
            Some(Form::Clamped(VectorSize::Bi))
        }
        Expression::Math { fun: MathFunction::Pack4xU8 | MathFunction::Pack4xU8Clamp, .. }
            if needs.enclosed_bytes =>
        {
            Some(Form::Enclosed(Literal::U32(0)))
        }
        _ => None,
    }
}

/// The form of a shift by a number that may be too large.
fn masked(
    module: &Module,
    (function, info): (&Function, &FunctionInfo),
    shift: Value,
    by: Value,
) -> Option<Form> {
    let (size, Scalar { kind: _, width }) = shape(module, info, shift)?;
    let most = u32::from(width) * 8 - 1;
    (!is_within(module, function, by, most)).then_some(Form::Masked(size, most))
}

/// The members of values that are vectors of three and that a choice may give.
fn chosen_members(
    module: &Module,
    function: &Function,
    info: &FunctionInfo,
) -> BTreeMap<Value, Form> {
    let chosen = function.expressions.iter().filter_map(|(_, expression)| match expression {
        Expression::Select { condition: _, accept, reject } => Some([*accept, *reject]),
        _ => None,
    });
    let member = |value: Value| {
        let Expression::AccessIndex { base, index: _ } = function.expressions[value] else {
            return None;
        };
        let inner = info[base].ty.inner_with(&module.types);
        let is_value = matches!(inner, TypeInner::Struct { members: _, span: _ });
        match shape(module, info, value) {
            Some((Some(VectorSize::Tri), Scalar { kind, width })) if is_value => {
                Some((value, Form::Unpacked(kind, width)))
            }
            _ => None,
        }
    };
    chosen.flatten().filter_map(member).collect()
}

/// The least and the largest float that an integer of 32 bits can be.
fn integer_bounds(from: Scalar, into: ScalarKind) -> Option<[Literal; 2]> {
    Some(match (from, into) {
        (Scalar::F32, ScalarKind::Sint) => [i32::MIN as f32, 2_147_483_520.0].map(Literal::F32),
        (Scalar::F32, ScalarKind::Uint) => [0.0, 4_294_967_040.0].map(Literal::F32),
        (Scalar::F64, ScalarKind::Sint) => [i32::MIN, i32::MAX].map(f64::from).map(Literal::F64),
        (Scalar::F64, ScalarKind::Uint) => [u32::MIN, u32::MAX].map(f64::from).map(Literal::F64),
        _ => return None,
    })
}

/// The scalar of a value, and its size if it is a vector.
fn shape(
    module: &Module,
    info: &FunctionInfo,
    value: Value,
) -> Option<(Option<VectorSize>, Scalar)> {
    match *info[value].ty.inner_with(&module.types) {
        TypeInner::Scalar(scalar) => Some((None, scalar)),
        TypeInner::Vector { size, scalar } => Some((Some(size), scalar)),
        _ => None,
    }
}

fn repeated_offsets(function: &Function, needs: Needs) -> BTreeMap<Value, Form> {
    let offsets = function.expressions.iter().filter_map(|(_, expression)| match expression {
        Expression::ImageSample { offset, .. } if needs.whole_offsets => *offset,
        _ => None,
    });
    let repeated = offsets.filter_map(|offset| match function.expressions[offset] {
        Expression::Splat { size, value: _ } => Some((offset, Form::Repeated(size))),
        _ => None,
    });
    repeated.collect()
}

/// The module with shifts by less than the bits of a number, for those who give a module of naga to wgpu;
/// `None` where it has no others. naga writes SPIR-V in which those are open.
///
/// # Errors
/// The message of naga, if it refuses the module.
pub fn with_masked_shifts(module: &Module) -> Result<Option<Module>, String> {
    let functions = module.functions.iter().map(|(_, function)| function);
    let all = functions.chain(module.entry_points.iter().map(|point| &point.function));
    let is_shift = |expression: &Expression| {
        use BinaryOperator::{ShiftLeft, ShiftRight};
        matches!(expression, Expression::Binary { op: ShiftLeft | ShiftRight, left: _, right: _ })
    };
    let mut expressions = all.flat_map(|function| function.expressions.iter());
    if !expressions.any(|(_, expression)| is_shift(expression)) {
        return Ok(None);
    }
    let info = info_unchecked(module).map_err(|error| error.to_string())?;
    let needs = Needs { masked_shifts: true, ..Needs::default() };
    Ok(with_plain_forms(module, &info, needs)?.map(|(module, _)| module))
}

/// Whether a divisor is a number other than 0 and -1.
fn is_harmless(module: &Module, function: &Function, divisor: Value) -> bool {
    let is_number = |literal: Literal| !matches!(literal, Literal::I32(0 | -1) | Literal::U32(0));
    all_are(module, &function.expressions, divisor, &is_number)
}

/// Whether a number without a sign is known not to be above another one.
fn is_within(module: &Module, function: &Function, value: Value, most: u32) -> bool {
    let all = |value: Value, most: u32| {
        let is_number = |literal: Literal| matches!(literal, Literal::U32(one) if one <= most);
        all_are(module, &function.expressions, value, &is_number)
    };
    match function.expressions[value] {
        Expression::Binary { op: BinaryOperator::And, left, right } => {
            all(left, most) || all(right, most)
        }
        Expression::Binary { op: BinaryOperator::Modulo, left: _, right } => {
            all(right, most + 1) && is_harmless(module, function, right)
        }
        Expression::Math { fun: MathFunction::Min, arg, arg1: Some(other), arg2: _, arg3: _ } => {
            all(arg, most) || all(other, most)
        }
        _ => all(value, most),
    }
}

/// Whether all numbers of a constant are of a kind.
fn all_are(
    module: &Module,
    expressions: &Arena<Expression>,
    value: Value,
    is_number: &dyn Fn(Literal) -> bool,
) -> bool {
    match &expressions[value] {
        Expression::Literal(literal) => is_number(*literal),
        Expression::Constant(constant) => {
            let init = module.constants[*constant].init;
            all_are(module, &module.global_expressions, init, is_number)
        }
        Expression::Splat { size: _, value } => all_are(module, expressions, *value, is_number),
        Expression::Compose { ty: _, components } => {
            components.iter().all(|one| all_are(module, expressions, *one, is_number))
        }
        _ => false,
    }
}

/// Makes expressions.
struct Maker<'m> {
    types: &'m mut UniqueArena<Type>,
    expressions: &'m mut Arena<Expression>,
    span: Span,
}

impl Maker<'_> {
    fn add(&mut self, expression: Expression) -> Value {
        self.expressions.append(expression, self.span)
    }

    fn written(&mut self, form: Form, expression: Expression) -> Value {
        match (form, expression) {
            (Form::Repeated(size), Expression::Splat { size: _, value }) => {
                let ty = self.vector(size, Scalar::I32);
                self.add(Expression::Compose { ty, components: vec![value; size as usize] })
            }
            (Form::Separate(size, scalar), Expression::Select { condition, accept, reject }) => {
                self.separate(size, scalar, [condition, accept, reject])
            }
            (Form::Defined(size, signed), Expression::Binary { op, left, right }) => {
                let right = self.defined(size, signed, left, right);
                self.add(Expression::Binary { op, left, right })
            }
            (Form::Masked(size, most), Expression::Binary { op, left, right }) => {
                let bits = self.all(size, Literal::U32(most));
                let right = self.both(BinaryOperator::And, right, bits);
                self.add(Expression::Binary { op, left, right })
            }
            (Form::Clamped(size), expression) => {
                let value = self.add(expression);
                let least = self.add(Expression::Literal(Literal::F32(-1.0)));
                let least = self.add(Expression::Splat { size, value: least });
                let (fun, arg1) = (MathFunction::Max, Some(least));
                self.add(Expression::Math { fun, arg: value, arg1, arg2: None, arg3: None })
            }
            (Form::Enclosed(zero), expression) => {
                let (left, right) = (self.add(expression), self.add(Expression::Literal(zero)));
                self.both(BinaryOperator::InclusiveOr, left, right)
            }
            (Form::Unpacked(kind, width), expression) => {
                let expr = self.add(expression);
                self.add(Expression::As { expr, kind, convert: Some(width) })
            }
            (Form::Bounded(size, bounds), Expression::As { expr, kind, convert }) => {
                let [least, most] = bounds.map(|bound| self.all(size, bound));
                let (fun, arg1, arg2) = (MathFunction::Clamp, Some(least), Some(most));
                let expr = self.add(Expression::Math { fun, arg: expr, arg1, arg2, arg3: None });
                self.add(Expression::As { expr, kind, convert })
            }
            (_, expression) => self.add(expression),
        }
    }

    /// A number, or a vector of this size with it in all components.
    fn all(&mut self, size: Option<VectorSize>, number: Literal) -> Value {
        let value = self.add(Expression::Literal(number));
        match size {
            None => value,
            Some(size) => self.add(Expression::Splat { size, value }),
        }
    }

    fn both(&mut self, op: BinaryOperator, left: Value, right: Value) -> Value {
        self.add(Expression::Binary { op, left, right })
    }

    fn vector(&mut self, size: VectorSize, scalar: Scalar) -> Handle<Type> {
        let inner = TypeInner::Vector { size, scalar };
        self.types.insert(Type { name: None, inner }, Span::UNDEFINED)
    }

    /// A choice between vectors, component by component.
    fn separate(&mut self, size: VectorSize, scalar: Scalar, operands: [Value; 3]) -> Value {
        let mut components = Vec::new();
        for index in 0..size as u32 {
            let [condition, accept, reject] =
                operands.map(|base| self.add(Expression::AccessIndex { base, index }));
            components.push(self.add(Expression::Select { condition, accept, reject }));
        }
        let ty = self.vector(size, scalar);
        self.add(Expression::Compose { ty, components })
    }

    /// A divisor with 1 in the place of those that have no defined result. Then a division by them
    /// gives the dividend and a remainder 0, as WGSL says.
    fn defined(
        &mut self,
        size: Option<VectorSize>,
        signed: bool,
        left: Value,
        right: Value,
    ) -> Value {
        let number = |value: i32| match signed {
            true => Literal::I32(value),
            false => Literal::U32(value.cast_unsigned()),
        };
        let all = |maker: &mut Self, value: i32| maker.all(size, number(value));
        let (zero, one) = (all(self, 0), all(self, 1));
        let mut condition = self.both(BinaryOperator::Equal, right, zero);
        if signed {
            let (least, minus) = (all(self, i32::MIN), all(self, -1));
            let is_least = self.both(BinaryOperator::Equal, left, least);
            let is_minus = self.both(BinaryOperator::Equal, right, minus);
            let overflows = self.both(BinaryOperator::And, is_least, is_minus);
            condition = self.both(BinaryOperator::InclusiveOr, condition, overflows);
        }
        self.add(Expression::Select { condition, accept: one, reject: right })
    }
}

#[cfg(test)]
mod tests {
    use super::{Needs, with_plain_forms};
    use lamplight_validate::info_for_some;
    use naga::{BinaryOperator, Expression};

    /// How many operands of shifts get a mask.
    fn masks(expression: &str) -> usize {
        let text = format!(
            "const thirty = 30u; override two = 3u;
            fn f(a: u32, b: u32, v: vec2u) -> vec2u {{ let s = {expression}; return vec2u(s); }}"
        );
        let module = naga::front::wgsl::parse_str(&text).unwrap();
        let info = info_for_some(&module).unwrap();
        let ands = |module: &naga::Module| {
            let (_, function) = module.functions.iter().next().unwrap();
            let is_and = |expression: &Expression| {
                matches!(expression, Expression::Binary { op: BinaryOperator::And, .. })
            };
            function.expressions.iter().filter(|(_, one)| is_and(one)).count()
        };
        let needs = Needs { masked_shifts: true, ..Needs::default() };
        let made = with_plain_forms(&module, &info, needs).unwrap();
        made.map_or(0, |(made, _)| ands(&made) - ands(&module))
    }

    #[test]
    fn shifts_that_may_be_too_wide_are_masked() {
        let masked =
            ["a << b", "a >> (b & 63u)", "a << (b % 33u)", "a << min(b, 32u)", "v << v.yx"];
        let masked = masked.into_iter().chain(["a << two", "v >> vec2(b, 3u)", "1u << b"]);
        for expression in masked {
            assert_eq!(masks(expression), 1, "{expression}");
        }
        let known =
            ["a << 31u", "a >> (b & 31u)", "a << (7u & b)", "a << (b % 32u)", "a << thirty"];
        for expression in known.into_iter().chain(["v << min(v, vec2(31u))", "v >> vec2(3u, 4u)"]) {
            assert_eq!(masks(expression), 0, "{expression}");
        }
    }
}

//! Expressions as texts. What needs statements puts them before the statement that is written.

use super::Writer;
use super::constant::{is_refused_beside, is_risky};
use super::output::Lines;
use super::path::{has_effects, letter_name, swizzled};
use super::value::{Strength, Value, list_text};
use crate::lexer::At;
use crate::tree::{Expr, ExprKind, Op, Place};
use crate::types::{Scalar, Type};

impl Writer<'_> {
    /// The text of an expression.
    pub(super) fn value(&mut self, expr: &Expr) -> Value {
        if let Some(known) = &expr.known
            && !matches!(expr.kind, ExprKind::Literal(..) | ExprKind::Var(_))
            && (is_risky(expr) || self.is_folded(expr))
            && let Some(value) = self.known_text(&expr.ty, known)
        {
            return value;
        }
        match &expr.kind {
            ExprKind::Literal(number, text) => self.literal(*number, text.as_deref()),
            ExprKind::Var(index) => self.var_value(*index, expr),
            ExprKind::Unary(op, operand) => self.unary(*op, operand),
            ExprKind::Binary(op, left, right) => self.binary(*op, left, right),
            ExprKind::Logic(is_and, left, right) => self.logic(*is_and, left, right),
            ExprKind::Ternary(condition, yes, no) => self.ternary(condition, yes, no, &expr.ty),
            ExprKind::Assign(op, left, right) => {
                let left = self.with_kept_indices(left);
                self.assign(*op, &left, right, expr.at);
                self.value(&left)
            }
            ExprKind::Step(adds, new, operand) => self.step(*adds, *new, operand, true),
            ExprKind::Comma(left, right) => {
                self.effect(left);
                self.value(right)
            }
            ExprKind::Call(function, arguments) => self.user_call(*function, arguments, expr),
            ExprKind::Builtin(name, arguments) => self.builtin(name, arguments, expr),
            ExprKind::Texture(access, arguments) => self.texture(*access, arguments, expr),
            ExprKind::Construct(parts) => self.construct(&expr.ty, parts, expr.at),
            ExprKind::Convert(inner) => self.convert(inner, &expr.ty),
            ExprKind::Swizzle(base, letters) => self.swizzle(base, letters),
            ExprKind::Member(base, member) => match self.path(expr) {
                Some(path) => self.read(&path),
                None => {
                    let Type::Struct(index) = base.ty else { return Value::primary("", true) };
                    let value = self.value(base);
                    let name = self.member_name(index, *member);
                    let text = format!("{}.{name}", value.at_least(Strength::Primary));
                    Value::primary(text, value.stable)
                }
            },
            ExprKind::Index(base, index) => match self.path(expr) {
                Some(path) => self.read(&path),
                None => self.index_value(base, index),
            },
            ExprKind::Length(base) => self.length(base),
            ExprKind::Kept(name) => Value::primary(name.as_str(), true),
        }
    }

    /// Calls of functions with known arguments are written as what they give, since front ends
    /// differ in which they evaluate.
    fn is_folded(&self, expr: &Expr) -> bool {
        matches!(expr.kind, ExprKind::Builtin(..)) && expr.ty.components() <= 4
    }

    fn var_value(&mut self, index: u32, expr: &Expr) -> Value {
        let var = self.var(index);
        let kept = match var.place {
            Place::Local => !var.written && var.init.is_some(),
            Place::Const | Place::Override | Place::Input | Place::Uniform => true,
            Place::Param(crate::tree::Dir::In) => !var.written,
            _ => false,
        };
        match self.path(expr) {
            Some(path) => {
                let mut value = self.read(&path);
                value.stable = kept;
                value
            }
            None => Value::primary("", true),
        }
    }

    fn index_value(&mut self, base: &Expr, index: &Expr) -> Value {
        let values = self.operands(&[base, index]);
        let constant = index.known.as_deref().and_then(|known| known.first()?.as_size());
        let mut text = values[0].at_least(Strength::Primary);
        let place = match constant {
            Some(number) => number.to_string(),
            None => {
                // Values are indexed by constants everywhere, by others only in variables.
                let name = self.temporary();
                self.line(base.at, format!("var {name} = {text};"));
                text = name;
                values[1].text.clone()
            }
        };
        if let (Type::Vector(..), Some(number)) = (&base.ty, constant) {
            return Value::primary(
                format!("{text}.{}", letter_name(number as u8)),
                values[0].stable,
            );
        }
        Value::primary(format!("{text}[{place}]"), values[0].stable && values[1].stable)
    }

    fn length(&mut self, base: &Expr) -> Value {
        if let Some(size) = self.known_length(base) {
            return Value::primary(size.to_string(), true);
        }
        match self.path(base) {
            Some(path) => Value::primary(format!("i32(arrayLength(&{}))", path.text), true),
            None => {
                self.refuse(base.at, "the size of this array is not known");
                Value::primary("0", true)
            }
        }
    }

    fn known_length(&self, base: &Expr) -> Option<u32> {
        let ExprKind::Var(index) = base.kind else { return None };
        match &self.var(index).ty {
            Type::Array(_, size) => *size,
            _ => None,
        }
    }

    /// Several operands, evaluated in their order: where one needs statements, those before it are
    /// kept in temporaries.
    pub(super) fn operands(&mut self, exprs: &[&Expr]) -> Vec<Value> {
        let parts: Vec<(Value, Lines)> =
            exprs.iter().map(|expr| self.capture(|writer| writer.value(expr))).collect();
        let last = parts.iter().rposition(|(_, lines)| !lines.is_empty());
        self.in_order(parts, last, |index| exprs[index].at)
    }

    /// Values with the statements that each needs before it: values before the last one that needs
    /// any are kept in temporaries.
    pub(super) fn in_order(
        &mut self,
        parts: Vec<(Value, Lines)>,
        last: Option<usize>,
        at: impl Fn(usize) -> At,
    ) -> Vec<Value> {
        let mut values = Vec::with_capacity(parts.len());
        for (index, (value, lines)) in parts.into_iter().enumerate() {
            self.lines.extend(lines);
            let early = last.is_some_and(|last| index < last) && !value.stable;
            if early {
                let name = self.temporary();
                self.line(at(index), format!("let {name} = {};", value.text));
                values.push(Value::primary(name, true));
            } else {
                values.push(value);
            }
        }
        values
    }

    fn unary(&mut self, op: Op, operand: &Expr) -> Value {
        let value = self.value(operand);
        if op == Op::Negate && matches!(operand.ty, Type::Matrix(..)) {
            let text = format!("{} * -1.0", value.at_least(Strength::Product));
            return Value { text, strength: Strength::Product, stable: value.stable };
        }
        if op == Op::Negate && operand.ty.scalar() == Some(Scalar::Uint) {
            let name = self.type_text(&operand.ty);
            let text = format!("{name}(0u) - {}", value.at_least(Strength::Product));
            return Value { text, strength: Strength::Sum, stable: value.stable };
        }
        let needed = if op == Op::Negate { Strength::Primary } else { Strength::Unary };
        let text = format!("{}{}", op.text(), value.at_least(needed));
        Value { text, strength: Strength::Unary, stable: value.stable }
    }

    fn binary(&mut self, op: Op, left: &Expr, right: &Expr) -> Value {
        // Literals alone would be numbers of another precision.
        let literal = |expr: &Expr| expr.known.is_some();
        let suffixed = self.suffixed;
        self.suffixed |= literal(left) && literal(right);
        self.suffixed |= matches!(op, Op::ShiftLeft | Op::ShiftRight) && literal(left);
        let mut values = self.operands(&[left, right]);
        self.suffixed = suffixed;
        if left.known.is_none() && is_refused_beside(op, &left.ty, right) {
            values[1] = self.unfolded(&right.ty, &values[1]);
        }
        let [left_value, right_value] = values.as_slice() else { return Value::primary("", true) };
        let pair = ((&left.ty, left_value.clone()), (&right.ty, right_value.clone()));
        self.binary_values(op, pair.0, pair.1)
    }

    /// A binary operator between texts.
    pub(super) fn binary_values(
        &mut self,
        op: Op,
        (left_ty, left): (&Type, Value),
        (right_ty, right): (&Type, Value),
    ) -> Value {
        let stable = left.stable && right.stable;
        let matrix = |ty: &Type| matches!(ty, Type::Matrix(..));
        if matches!(op, Op::Equal | Op::NotEqual) {
            return self.equality(op, left_ty, &left, &right);
        }
        if matrix(left_ty) || matrix(right_ty) {
            return self.matrix_operator(op, (left_ty, left), (right_ty, right));
        }
        let (mut left, mut right) = (left, right);
        if matches!(op, Op::ShiftLeft | Op::ShiftRight) {
            right = self.shift_count(left_ty, right_ty, &right);
        } else if matches!(op, Op::And | Op::Or | Op::Xor) {
            left = self.splat(left_ty, right_ty, left);
            right = self.splat(right_ty, left_ty, right);
        }
        let (strength, needed) = match op {
            Op::Add | Op::Sub => (Strength::Sum, (Strength::Sum, Strength::Product)),
            Op::Mul | Op::Div | Op::Mod => {
                (Strength::Product, (Strength::Product, Strength::Unary))
            }
            Op::ShiftLeft | Op::ShiftRight => (Strength::Shift, (Strength::Unary, Strength::Unary)),
            Op::And | Op::Or | Op::Xor => (Strength::Bits, (Strength::Unary, Strength::Unary)),
            // `a < b >> c` would begin with a template.
            _ => (Strength::Relation, (Strength::Sum, Strength::Sum)),
        };
        let text =
            format!("{} {} {}", left.at_least(needed.0), op.text(), right.at_least(needed.1));
        Value { text, strength, stable }
    }

    /// Bits are combined between vectors only.
    fn splat(&mut self, ty: &Type, other: &Type, value: Value) -> Value {
        match (ty, other) {
            (Type::Scalar(_), Type::Vector(..)) => {
                let name = self.type_text(other);
                Value::primary(format!("{name}({})", value.text), value.stable)
            }
            _ => value,
        }
    }

    /// Bits are shifted by unsigned numbers, and vectors by vectors.
    fn shift_count(&mut self, ty: &Type, count: &Type, value: &Value) -> Value {
        let target = ty.with_scalar(Scalar::Uint);
        if *count == target {
            return value.clone();
        }
        let name = self.type_text(&target);
        let text = match (count, &target) {
            (Type::Scalar(Scalar::Int), Type::Vector(..)) => format!("{name}(u32({}))", value.text),
            _ => format!("{name}({})", value.text),
        };
        Value::primary(text, value.stable)
    }

    fn logic(&mut self, is_and: bool, left: &Expr, right: &Expr) -> Value {
        let left_value = self.value(left);
        let (right_value, lines) = self.capture(|writer| writer.value(right));
        let (op, strength) = if is_and { ("&&", Strength::And) } else { ("||", Strength::Or) };
        if lines.is_empty() {
            let side = |value: &Value| {
                if value.strength == strength || value.strength >= Strength::Relation {
                    value.text.clone()
                } else {
                    format!("({})", value.text)
                }
            };
            let text = format!("{} {op} {}", side(&left_value), side(&right_value));
            let stable = left_value.stable && right_value.stable;
            return Value { text, strength, stable };
        }
        let name = self.temporary();
        self.line(left.at, format!("var {name} = {};", left_value.text));
        let condition = if is_and { name.clone() } else { format!("!{name}") };
        self.line(left.at, format!("if {condition} {{"));
        self.lines.nest(lines);
        let mut last = Lines::default();
        last.push(super::Line::new(format!("{name} = {};", right_value.text), right.at));
        self.lines.nest(last);
        self.line(right.at, "}");
        Value::primary(name, true)
    }

    fn ternary(&mut self, condition: &Expr, yes: &Expr, no: &Expr, ty: &Type) -> Value {
        let chosen = self.value(condition);
        let (yes_value, yes_lines) = self.capture(|writer| writer.value(yes));
        let (no_value, no_lines) = self.capture(|writer| writer.value(no));
        let selectable = yes_lines.is_empty()
            && no_lines.is_empty()
            && matches!(ty, Type::Scalar(_) | Type::Vector(..))
            && is_cheap(yes, 6)
            && is_cheap(no, 6);
        if selectable {
            let stable = chosen.stable && yes_value.stable && no_value.stable;
            let list = [self.typed(no, no_value), self.typed(yes, yes_value), chosen];
            return Value::primary(format!("select({})", list_text(&list)), stable);
        }
        let name = self.temporary();
        let ty = self.type_text(ty);
        self.line(condition.at, format!("var {name}: {ty};"));
        self.line(condition.at, format!("if {} {{", chosen.text));
        self.branch(yes_lines, &name, &yes_value, yes.at);
        self.line(condition.at, "} else {");
        self.branch(no_lines, &name, &no_value, no.at);
        self.line(condition.at, "}");
        Value::primary(name, true)
    }

    fn branch(&mut self, mut lines: Lines, name: &str, value: &Value, at: At) {
        lines.push(super::Line::new(format!("{name} = {};", value.text), at));
        self.lines.nest(lines);
    }

    /// A literal with its suffix, where nothing else says its type.
    fn typed(&mut self, expr: &Expr, value: Value) -> Value {
        match &expr.kind {
            ExprKind::Literal(..) | ExprKind::Convert(_) if expr.known.is_some() => {
                let suffixed = std::mem::replace(&mut self.suffixed, true);
                let value = self.value(expr);
                self.suffixed = suffixed;
                value
            }
            _ => value,
        }
    }

    fn swizzle(&mut self, base: &Expr, letters: &[u8]) -> Value {
        let value = self.value(base);
        if let Type::Scalar(scalar) = base.ty {
            if letters.len() == 1 {
                return value;
            }
            let name = self.type_text(&Type::vector(scalar, letters.len() as u8));
            return Value::primary(format!("{name}({})", value.text), value.stable);
        }
        let size = base.ty.as_vector().map_or(1, |(_, size)| size);
        swizzled(&value, size, letters)
    }

    /// Other numbers of the same shape.
    pub(super) fn convert(&mut self, inner: &Expr, to: &Type) -> Value {
        if let (ExprKind::Literal(number, _), Some(scalar)) = (&inner.kind, to.scalar()) {
            let number = number.to(scalar);
            return self.number(number);
        }
        let value = self.value(inner);
        let name = self.type_text(to);
        Value::primary(format!("{name}({})", value.text), value.stable)
    }

    /// An expression for its effects only.
    pub(super) fn effect(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Assign(op, left, right) => self.assign(*op, left, right, expr.at),
            ExprKind::Step(adds, new, operand) => {
                self.step(*adds, *new, operand, false);
            }
            ExprKind::Comma(left, right) => {
                self.effect(left);
                self.effect(right);
            }
            ExprKind::Ternary(condition, yes, no) if expr.ty == Type::Void => {
                let condition = self.value(condition);
                self.line(expr.at, format!("if {} {{", condition.text));
                let ((), lines) = self.capture(|writer| writer.effect(yes));
                self.lines.nest(lines);
                self.line(expr.at, "} else {");
                let ((), lines) = self.capture(|writer| writer.effect(no));
                self.lines.nest(lines);
                self.line(expr.at, "}");
            }
            _ if !has_effects(expr, self.shader) => {}
            ExprKind::Builtin(name, arguments) if self.atomic_effect(name, arguments, expr) => {}
            _ => {
                let value = self.value(expr);
                // What is stable was evaluated by statements before.
                if value.stable || value.text.is_empty() {
                    return;
                }
                let is_call = matches!(expr.kind, ExprKind::Call(..)) || expr.ty == Type::Void;
                let start = if is_call { "" } else { "_ = " };
                self.line(expr.at, format!("{start}{};", value.text));
            }
        }
    }
}

/// Whether an expression costs so little that it may be evaluated without need.
fn is_cheap(expr: &Expr, budget: u32) -> bool {
    weight(expr) <= budget
}

fn weight(expr: &Expr) -> u32 {
    const HEAVY: u32 = 1000;
    match &expr.kind {
        ExprKind::Literal(..) | ExprKind::Var(_) | ExprKind::Kept(_) => 0,
        _ if expr.known.is_some() => 0,
        ExprKind::Construct(parts) => parts.iter().map(weight).sum::<u32>().saturating_add(1),
        ExprKind::Unary(_, a) | ExprKind::Convert(a) => weight(a).saturating_add(1),
        ExprKind::Swizzle(a, _) | ExprKind::Member(a, _) => weight(a),
        ExprKind::Binary(op, a, b) => {
            let slow = u32::from(matches!(op, Op::Div | Op::Mod)) * 2;
            weight(a).saturating_add(weight(b)).saturating_add(1 + slow)
        }
        ExprKind::Index(a, b) if b.known.is_some() => weight(a),
        ExprKind::Builtin(name, parts) if matches!(*name, "abs" | "min" | "max" | "clamp") => {
            parts.iter().map(weight).sum::<u32>().saturating_add(1)
        }
        _ => HEAVY,
    }
}

//! Matrices: constructors, and operators that WGSL lacks.

use super::Writer;
use super::value::{Strength, Value};
use crate::lexer::At;
use crate::tree::{Expr, Op};
use crate::types::{Scalar, Type};

impl Writer<'_> {
    pub(super) fn construct_matrix(&mut self, ty: &Type, parts: &[&Expr], at: At) -> Value {
        let Type::Matrix(_, columns, rows) = ty else { return Value::primary("", true) };
        let (columns, rows) = (*columns, *rows);
        let values = self.operands(parts);
        let stable = values.iter().all(|value| value.stable);
        let name = self.type_text(ty);
        if let ([part], [value]) = (parts, values.as_slice()) {
            match &part.ty {
                Type::Scalar(scalar) => {
                    let value = self.as_float(*scalar, part, value);
                    return self.diagonal(&name, (columns, rows), &value, at);
                }
                Type::Matrix(_, from_columns, from_rows) => {
                    let kept = self.kept(at, value);
                    let from = (*from_columns, *from_rows);
                    return resized(&name, (columns, rows), &kept, from, stable);
                }
                _ => {}
            }
        }
        let whole = parts
            .iter()
            .all(|part| matches!(&part.ty, Type::Vector(Scalar::Float, size) if *size == rows));
        if whole {
            let texts: Vec<&str> = values.iter().map(|value| value.text.as_str()).collect();
            return Value::primary(format!("{name}({})", texts.join(", ")), stable);
        }
        let mut texts = Vec::new();
        for (part, value) in parts.iter().zip(&values) {
            self.components(part, value, at, &mut texts);
        }
        texts.truncate(usize::from(columns) * usize::from(rows));
        Value::primary(format!("{name}({})", texts.join(", ")), stable)
    }

    fn as_float(&mut self, scalar: Scalar, part: &Expr, value: &Value) -> Value {
        if scalar == Scalar::Float {
            return value.clone();
        }
        if let Some([number]) = part.known.as_deref() {
            return self.number(number.to(Scalar::Float));
        }
        Value::primary(format!("f32({})", value.text), value.stable)
    }

    /// All numbers of a part, as texts.
    fn components(&mut self, part: &Expr, value: &Value, at: At, texts: &mut Vec<String>) {
        match &part.ty {
            Type::Vector(scalar, size) => {
                let kept = self.kept(at, value);
                for letter in 0..*size {
                    let name = super::path::letter_name(letter);
                    let text = format!("{kept}.{name}");
                    texts.push(if *scalar == Scalar::Float {
                        text
                    } else {
                        format!("f32({text})")
                    });
                }
            }
            Type::Matrix(_, columns, rows) => {
                let kept = self.kept(at, value);
                for column in 0..*columns {
                    texts.extend((0..*rows).map(|row| format!("{kept}[{column}][{row}]")));
                }
            }
            other => {
                let scalar = other.scalar().unwrap_or(Scalar::Float);
                texts.push(self.as_float(scalar, part, value).text);
            }
        }
    }

    fn diagonal(&mut self, name: &str, shape: (u8, u8), value: &Value, at: At) -> Value {
        let kept = if value.strength >= Strength::Unary && value.is_simple() {
            value.text.clone()
        } else {
            self.kept(at, value)
        };
        let texts: Vec<String> = (0..shape.0)
            .flat_map(|column| {
                let kept = kept.clone();
                (0..shape.1).map(move |row| match column == row {
                    true => kept.clone(),
                    false => "0.0".to_owned(),
                })
            })
            .collect();
        Value::primary(format!("{name}({})", texts.join(", ")), value.stable)
    }

    /// An operator with a matrix: WGSL has sums, differences and products, the others go by
    /// columns.
    pub(super) fn matrix_operator(
        &mut self,
        op: Op,
        (left_ty, left): (&Type, Value),
        (right_ty, right): (&Type, Value),
    ) -> Value {
        let stable = left.stable && right.stable;
        let both = matches!(left_ty, Type::Matrix(..)) && matches!(right_ty, Type::Matrix(..));
        let direct = op == Op::Mul || (both && matches!(op, Op::Add | Op::Sub));
        if direct {
            let (strength, first, second) = match op {
                Op::Mul => (Strength::Product, Strength::Product, Strength::Unary),
                _ => (Strength::Sum, Strength::Sum, Strength::Product),
            };
            let (left, right) = (left.at_least(first), right.at_least(second));
            return Value { text: format!("{left} {} {right}", op.text()), strength, stable };
        }
        let result = if matches!(left_ty, Type::Matrix(..)) { left_ty } else { right_ty };
        let Type::Matrix(_, columns, _) = result else { return left };
        let names = (self.type_text(left_ty), self.type_text(right_ty), self.type_text(result));
        let side = |ty: &Type, name: &str, column: u8| match ty {
            Type::Matrix(..) => format!("{name}[{column}]"),
            _ => name.to_owned(),
        };
        let parts: Vec<String> = (0..*columns)
            .map(|column| {
                let (a, b) = (side(left_ty, "a", column), side(right_ty, "b", column));
                format!("{a} {} {b}", op.text())
            })
            .collect();
        let title = match op {
            Op::Add => "matrix_add",
            Op::Sub => "matrix_subtract",
            _ => "matrix_divide",
        };
        let helper = self.helper_for(title, &format!("{} {}", names.0, names.1), |name| {
            let (left, right, result) = &names;
            format!(
                "fn {name}(a: {left}, b: {right}) -> {result} {{\n    return {result}({});\n}}",
                parts.join(", ")
            )
        });
        Value::primary(format!("{helper}({}, {})", left.text, right.text), stable)
    }

    /// Whether two values are equal: numbers, vectors, matrices, arrays and structures.
    pub(super) fn equality(&mut self, op: Op, ty: &Type, left: &Value, right: &Value) -> Value {
        let stable = left.stable && right.stable;
        if let Type::Scalar(_) = ty {
            let (left, right) = (left.at_least(Strength::Shift), right.at_least(Strength::Shift));
            let text = format!("{left} {} {right}", op.text());
            return Value { text, strength: Strength::Relation, stable };
        }
        if let Type::Vector(..) = ty {
            let function = if op == Op::Equal { "all" } else { "any" };
            let (left, right) = (left.at_least(Strength::Shift), right.at_least(Strength::Shift));
            let text = format!("{function}({left} {} {right})", op.text());
            return Value::primary(text, stable);
        }
        let helper = self.equal_function(ty);
        let call = format!("{helper}({}, {})", left.text, right.text);
        if op == Op::Equal {
            return Value::primary(call, stable);
        }
        Value { text: format!("!{call}"), strength: Strength::Unary, stable }
    }

    fn equal_function(&mut self, ty: &Type) -> String {
        let name = self.type_text(ty);
        let body = match ty {
            Type::Matrix(_, columns, _) => {
                let parts: Vec<String> =
                    (0..*columns).map(|at| format!("all(a[{at}] == b[{at}])")).collect();
                format!("    return {};", parts.join(" && "))
            }
            Type::Array(element, Some(size)) => {
                let (a, b) = (Value::primary("x[i]", true), Value::primary("y[i]", true));
                let unequal = self.equality(Op::NotEqual, element, &a, &b).text;
                format!(
                    "    var x = a;\n    var y = b;\n    for (var i = 0u; i < {size}u; i++) {{\n        \
                     if {unequal} {{\n            return false;\n        }}\n    }}\n    return true;"
                )
            }
            Type::Struct(index) => {
                let shader = self.shader;
                let mut parts = Vec::new();
                for (at, field) in shader.structs[*index as usize].members.iter().enumerate() {
                    let member = self.member_name(*index, at as u32);
                    let (a, b) = (format!("a.{member}"), format!("b.{member}"));
                    let (a, b) = (Value::primary(a, true), Value::primary(b, true));
                    parts.push(self.equality(Op::Equal, &field.ty, &a, &b).text);
                }
                format!("    return {};", parts.join(" && "))
            }
            _ => "    return true;".to_owned(),
        };
        self.helper_for("equal", &name, |helper| {
            format!("fn {helper}(a: {name}, b: {name}) -> bool {{\n{body}\n}}")
        })
    }
}

/// A matrix from another one: missing numbers are those of the identity.
fn resized(name: &str, shape: (u8, u8), kept: &str, from: (u8, u8), stable: bool) -> Value {
    let columns: Vec<String> = (0..shape.0)
        .map(|column| {
            if column >= from.0 {
                let numbers: Vec<&str> =
                    (0..shape.1).map(|row| if row == column { "1.0" } else { "0.0" }).collect();
                return format!("vec{}f({})", shape.1, numbers.join(", "));
            }
            if shape.1 <= from.1 {
                let letters = &"xyzw"[..usize::from(shape.1)];
                let swizzle = if shape.1 == from.1 { String::new() } else { format!(".{letters}") };
                return format!("{kept}[{column}]{swizzle}");
            }
            let rest: Vec<&str> =
                (from.1..shape.1).map(|row| if row == column { "1.0" } else { "0.0" }).collect();
            format!("vec{}f({kept}[{column}], {})", shape.1, rest.join(", "))
        })
        .collect();
    Value::primary(format!("{name}({})", columns.join(", ")), stable)
}

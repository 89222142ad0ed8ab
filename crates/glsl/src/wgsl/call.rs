//! Calls of the author's functions, and constructors.

use super::Writer;
use super::path::{has_effects, indexed, letter_name};
use super::value::{Value, list_text};
use crate::lexer::At;
use crate::tree::{Dir, Expr, ExprKind, Place};
use crate::types::{OpaqueKind, Scalar, Type};

impl Writer<'_> {
    pub(super) fn user_call(&mut self, function: u32, arguments: &[Expr], expr: &Expr) -> Value {
        let shader = self.shader;
        let callee = &shader.functions[function as usize];
        let mut back = Vec::new();
        let mut parts = Vec::with_capacity(arguments.len());
        for (at, (argument, param)) in arguments.iter().zip(&callee.params).enumerate() {
            let part = self.capture(|writer| match writer.place(*param) {
                _ if argument.ty.is_opaque() => {
                    Value::primary(writer.opaque_argument(argument), true)
                }
                Place::Param(dir @ (Dir::Out | Dir::InOut)) => {
                    let others = arguments[..at].iter().chain(&arguments[at + 1..]);
                    let others =
                        others.zip(callee.params[..at].iter().chain(&callee.params[at + 1..]));
                    let direct = writer.direct_pointer(argument, others);
                    let text = direct.unwrap_or_else(|| writer.copy(argument, dir, &mut back));
                    Value::primary(text, true)
                }
                _ => writer.value(argument),
            });
            parts.push(part);
        }
        let is_last = |argument: &Expr| has_effects(argument, shader);
        let last = arguments.iter().rposition(is_last);
        let values = self.in_order(parts, last, |at| arguments[at].at);
        let name = &self.function_names[function as usize];
        let call = format!("{name}({})", list_text(&values));
        self.copy_back(call, back, expr)
    }

    /// Copies results of `out` and `inout` to where they belong, in order.
    fn copy_back(&mut self, call: String, back: Vec<(Expr, String)>, expr: &Expr) -> Value {
        if back.is_empty() {
            return Value::primary(call, false);
        }
        let value = if expr.ty == Type::Void {
            self.line(expr.at, format!("{call};"));
            Value::primary("", true)
        } else {
            let name = self.temporary();
            self.line(expr.at, format!("let {name} = {call};"));
            Value::primary(name, true)
        };
        for (target, name) in back {
            self.write_back(&target, &name);
        }
        value
    }

    /// Writes a temporary to what an argument names.
    pub(super) fn write_back(&mut self, target: &Expr, name: &str) {
        let at = target.at;
        let value = Value::primary(name, true);
        if let ExprKind::Swizzle(base, letters) = &target.kind {
            let Some(path) = self.path(base) else {
                self.refuse(at, "this place is not written in WGSL");
                return;
            };
            let Some((scalar, size)) = base.ty.as_vector() else { return };
            if size == 1 {
                self.write_path(at, &path, &value);
                return;
            }
            for (from, letter) in letters.iter().enumerate() {
                let index = letter.to_string();
                let part = indexed(path.clone(), &base.ty, &index, Type::Scalar(scalar));
                let text = match letters.len() {
                    1 => name.to_owned(),
                    _ => format!("{name}.{}", letter_name(from as u8)),
                };
                self.write_path(at, &part, &Value::primary(text, true));
            }
            return;
        }
        match self.path(target) {
            Some(path) => self.write_path(at, &path, &value),
            None => self.refuse(at, "this place is not written in WGSL"),
        }
    }

    /// A pointer to a variable of the function, unless another argument of the call writes it.
    fn direct_pointer<'e>(
        &self,
        argument: &Expr,
        mut others: impl Iterator<Item = (&'e Expr, &'e u32)>,
    ) -> Option<String> {
        let ExprKind::Var(index) = argument.kind else { return None };
        let writes = |(other, param): (&Expr, &u32)| {
            let may = !matches!(self.place(*param), Place::Param(Dir::In))
                || has_effects(other, self.shader);
            may && other.names(&|found| found == index)
        };
        if !self.is_function_variable(index) || others.any(writes) {
            return None;
        }
        let name = self.var_name(index);
        Some(match self.place(index) {
            Place::Param(Dir::Out | Dir::InOut) => name,
            _ => format!("&{name}"),
        })
    }

    /// A pointer to a copy, which is written back to its place after the call.
    fn copy(&mut self, argument: &Expr, dir: Dir, back: &mut Vec<(Expr, String)>) -> String {
        let place = self.with_kept_indices(argument);
        let name = self.temporary();
        if dir == Dir::InOut {
            let value = self.value(&place);
            self.line(argument.at, format!("var {name} = {};", value.text));
        } else {
            let ty = self.type_text(&argument.ty);
            self.line(argument.at, format!("var {name}: {ty};"));
        }
        back.push((place, name.clone()));
        format!("&{name}")
    }

    fn is_function_variable(&self, index: u32) -> bool {
        match self.place(index) {
            Place::Local | Place::Param(Dir::Out | Dir::InOut) => true,
            Place::Param(Dir::In) => self.copied.contains_key(&index),
            Place::Output | Place::Builtin(_) => self.entry.is_local(index),
            _ => false,
        }
    }

    /// A value of a type from others.
    pub(super) fn construct(&mut self, ty: &Type, parts: &[Expr], at: At) -> Value {
        let refs: Vec<&Expr> = parts.iter().collect();
        match ty {
            Type::Opaque(_) => Value::primary("", true),
            Type::Array(..) | Type::Struct(_) => {
                let values = self.operands(&refs);
                let stable = values.iter().all(|value| value.stable);
                let name = self.type_text(ty);
                Value::primary(format!("{name}({})", list_text(&values)), stable)
            }
            Type::Matrix(..) => self.construct_matrix(ty, &refs, at),
            _ => self.construct_vector(ty, &refs, at),
        }
    }

    fn construct_vector(&mut self, ty: &Type, parts: &[&Expr], at: At) -> Value {
        let Some((scalar, size)) = ty.as_vector() else { return Value::primary("", true) };
        let values = self.operands(parts);
        let stable = values.iter().all(|value| value.stable);
        let name = self.type_text(ty);
        let mut left = u32::from(size);
        let mut fitting = Vec::new();
        for (part, value) in parts.iter().zip(&values) {
            if left == 0 {
                break;
            }
            let count = part.ty.components();
            let value = if let Type::Matrix(_, _, rows) = part.ty {
                let kept = self.kept(at, value);
                let names: Vec<String> = (0..count.min(left))
                    .map(|index| {
                        let (column, row) = (index / u32::from(rows), index % u32::from(rows));
                        format!("{kept}[{column}][{row}]")
                    })
                    .collect();
                Value::primary(names.join(", "), true)
            } else {
                self.fitting_part(part, value, scalar, count.min(left))
            };
            fitting.push(value);
            left = left.saturating_sub(count);
        }
        if let ([part], [value]) = (parts, fitting.as_slice())
            && (&part.ty == ty || (ty.components() == 1 && part.ty.scalar() == Some(scalar)))
        {
            return value.clone();
        }
        Value::primary(format!("{name}({})", list_text(&fitting)), stable)
    }

    /// The first numbers of a part, of the kind that is asked for.
    fn fitting_part(&mut self, part: &Expr, value: &Value, scalar: Scalar, count: u32) -> Value {
        let size = part.ty.components();
        let mut value = value.clone();
        if count < size {
            let letters: Vec<u8> = (0..count as u8).collect();
            value = super::path::swizzled(&value, size as u8, &letters);
        }
        if part.ty.scalar() == Some(scalar) {
            return value;
        }
        let literal = matches!(part.kind, ExprKind::Literal(..));
        if literal && let Some([number]) = part.known.as_deref() {
            return self.number(number.to(scalar));
        }
        let name = self.type_text(&Type::vector(scalar, count as u8));
        Value::primary(format!("{name}({})", value.text), value.stable)
    }

    /// A texture with its sampler, or one of them.
    fn opaque_argument(&mut self, argument: &Expr) -> String {
        let Some(names) = self.opaque_names(argument) else { return String::new() };
        let Type::Opaque(opaque) = argument.ty else { return names.texture };
        match (opaque.kind, names.sampler) {
            (OpaqueKind::Combined, Some(sampler)) => format!("{}, {sampler}", names.texture),
            _ => names.texture,
        }
    }
}

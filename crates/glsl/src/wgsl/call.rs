//! Calls of the author's functions, and constructors.

use super::Writer;
use super::path::{indexed, letter_name};
use super::value::{Strength, Value};
use crate::lexer::At;
use crate::tree::{Dir, Expr, ExprKind, Place};
use crate::types::{OpaqueKind, Scalar, Type};

impl Writer<'_> {
    pub(super) fn user_call(&mut self, function: u32, arguments: &[Expr], expr: &Expr) -> Value {
        let shader = self.shader;
        let callee = &shader.functions[function as usize];
        let inputs: Vec<&Expr> = arguments
            .iter()
            .zip(&callee.params)
            .filter(|(argument, param)| {
                matches!(self.place(**param), Place::Param(Dir::In)) && !argument.ty.is_opaque()
            })
            .map(|(argument, _)| argument)
            .collect();
        let copies =
            callee.params.iter().any(|param| !matches!(self.place(*param), Place::Param(Dir::In)));
        let pinned = self.pinned;
        self.pinned |= copies;
        let mut values = self.operands(&inputs).into_iter();
        let mut texts: Vec<String> = Vec::new();
        let mut back = Vec::new();
        for (argument, param) in arguments.iter().zip(&callee.params) {
            if argument.ty.is_opaque() {
                texts.push(self.opaque_argument(argument));
                continue;
            }
            match self.place(*param) {
                Place::Param(Dir::In) => {
                    texts.push(values.next().map_or(String::new(), |value| value.text));
                }
                Place::Param(dir) => {
                    texts.push(self.pointer(argument, dir, arguments, &mut back));
                }
                _ => {}
            }
        }
        self.pinned = pinned;
        let call = format!("{}({})", self.function_names[function as usize], texts.join(", "));
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

    /// A pointer for a parameter that is written: to the variable itself if it is a plain one of
    /// the function that nothing else in the call is, else to a copy.
    fn pointer(
        &mut self,
        argument: &Expr,
        dir: Dir,
        arguments: &[Expr],
        back: &mut Vec<(Expr, String)>,
    ) -> String {
        if let ExprKind::Var(index) = argument.kind
            && self.is_function_variable(index)
            && arguments.iter().filter(|other| names_var(other, index)).count() == 1
        {
            let name = self.var_name(index);
            return match self.place(index) {
                Place::Param(Dir::Out | Dir::InOut) => name,
                _ => format!("&{name}"),
            };
        }
        // The indices of the place are evaluated once.
        let pinned = std::mem::replace(&mut self.pinned, true);
        let fixed = self.fixed(argument);
        self.pinned = pinned;
        let name = self.temporary();
        if dir == Dir::InOut {
            let value = self.value(&fixed);
            self.line(argument.at, format!("var {name} = {};", value.text));
        } else {
            let ty = self.type_text(&argument.ty);
            self.line(argument.at, format!("var {name}: {ty};"));
        }
        back.push((fixed, name.clone()));
        format!("&{name}")
    }

    /// The same place with indices that do not change any more.
    pub(super) fn fixed(&mut self, expr: &Expr) -> Expr {
        let mut fixed = expr.clone();
        match &mut fixed.kind {
            ExprKind::Index(base, index) => {
                **base = self.fixed(base);
                if index.known.is_none() {
                    let value = self.value(index);
                    let name = self.temporary();
                    self.line(index.at, format!("let {name} = {};", value.text));
                    index.kind = ExprKind::Kept(name);
                }
            }
            ExprKind::Member(base, _) | ExprKind::Swizzle(base, _) => **base = self.fixed(base),
            _ => {}
        }
        fixed
    }

    fn is_function_variable(&self, index: u32) -> bool {
        match self.place(index) {
            Place::Local | Place::Param(Dir::Out | Dir::InOut) => true,
            Place::Param(Dir::In) => self.copied.contains(&index),
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
                let texts: Vec<&str> = values.iter().map(|value| value.text.as_str()).collect();
                let stable = values.iter().all(|value| value.stable);
                let name = self.type_text(ty);
                Value::primary(format!("{name}({})", texts.join(", ")), stable)
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
        let mut texts = Vec::new();
        for (part, value) in parts.iter().zip(&values) {
            if left == 0 {
                break;
            }
            let count = part.ty.components();
            let text = if let Type::Matrix(_, _, rows) = part.ty {
                let kept = self.kept(at, value);
                let names: Vec<String> = (0..count.min(left))
                    .map(|index| {
                        let (column, row) = (index / u32::from(rows), index % u32::from(rows));
                        format!("{kept}[{column}][{row}]")
                    })
                    .collect();
                names.join(", ")
            } else {
                self.fitting_part(part, value, scalar, count.min(left))
            };
            texts.push(text);
            left = left.saturating_sub(count);
        }
        let mut same_type = false;
        if let ([part], [text]) = (parts, texts.as_slice()) {
            let rest = &part.ty == ty;
            same_type = rest && !text.is_empty();
            if ty.components() == 1 && part.ty.scalar() == Some(scalar) {
                return Value { text: text.clone(), strength: Strength::Or, stable }.wrapped();
            }
        }
        if same_type {
            return Value::primary(format!("({})", texts.join(", ")), stable);
        }
        Value::primary(format!("{name}({})", texts.join(", ")), stable)
    }

    /// The first numbers of a part, of the kind that is asked for.
    fn fitting_part(&mut self, part: &Expr, value: &Value, scalar: Scalar, count: u32) -> String {
        let size = part.ty.components();
        let mut value = value.clone();
        if count < size {
            let letters: Vec<u8> = (0..count as u8).collect();
            value = super::path::swizzled(&value, size as u8, &letters);
        }
        if part.ty.scalar() == Some(scalar) {
            return value.text;
        }
        let literal = matches!(part.kind, ExprKind::Literal(..));
        if literal && let Some([number]) = part.known.as_deref() {
            return self.number(number.to(scalar)).text;
        }
        let name = self.type_text(&Type::vector(scalar, count as u8));
        format!("{name}({})", value.text)
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

impl Value {
    /// In brackets unless it binds strongly.
    fn wrapped(self) -> Self {
        let plain =
            self.text.chars().all(|letter| letter.is_ascii_alphanumeric() || "_.".contains(letter));
        if plain {
            return Self::primary(self.text, self.stable);
        }
        Self::primary(format!("({})", self.text), self.stable)
    }
}

/// Whether an expression names a variable anywhere.
fn names_var(expr: &Expr, index: u32) -> bool {
    match &expr.kind {
        ExprKind::Var(found) => *found == index,
        ExprKind::Member(base, _) | ExprKind::Swizzle(base, _) => names_var(base, index),
        ExprKind::Index(base, at) => names_var(base, index) || names_var(at, index),
        _ => false,
    }
}

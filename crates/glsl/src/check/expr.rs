//! Expressions.

use super::{Checker, Res, fold, int_literal, literal};
use crate::ast::{self, ExprKind as Ast};
use crate::lexer::At;
use crate::tree::{Expr, ExprKind, Known, Number, Op, Place};
use crate::types::{INT, Scalar, Type, UINT};

/// The letters of swizzles, in the order of components.
const SWIZZLES: [&str; 3] = ["xyzw", "rgba", "stpq"];

impl<'a> Checker<'a> {
    /// An expression that has a value or is a call.
    pub(super) fn expr(&mut self, expr: &'a ast::Expr<'a>) -> Res<Expr> {
        let at = expr.at;
        match &expr.kind {
            Ast::Int(bits) => Ok(literal(Number::Int(*bits as i32), at)),
            Ast::Uint(value) => Ok(literal(Number::Uint(*value), at)),
            Ast::Float(text) => Ok(float_literal(text, at)),
            Ast::Double => self.refuse(at, "`double` has no counterpart in WGSL"),
            Ast::Bool(value) => Ok(literal(Number::Bool(*value), at)),
            Ast::Name(name) => self.name_expr(name, at),
            Ast::Unary(op, operand) => {
                let operand = self.value(operand)?;
                self.unary(op, operand, at)
            }
            Ast::Step(op, before, operand) => self.step(op, *before, operand, at),
            Ast::Binary("&&", left, right) => self.logic(true, left, right, at),
            Ast::Binary("||", left, right) => self.logic(false, left, right, at),
            Ast::Binary(op, left, right) => {
                let (left, right) = (self.value(left), self.value(right));
                let (left, right) = (left?, right?);
                match Op::binary(op) {
                    Some(op) => self.binary(op, left, right, at),
                    None => self.fail(at, format!("`{op}` is not an operator")),
                }
            }
            Ast::Assign(op, left, right) => self.assign(op, left, right, at),
            Ast::Ternary(condition, yes, no) => self.ternary(condition, yes, no, at),
            Ast::Comma(left, right) => {
                let left = self.expr(left)?;
                let right = self.expr(right)?;
                let ty = right.ty.clone();
                let kind = ExprKind::Comma(Box::new(left), Box::new(right));
                Ok(Expr { kind, ty, at, known: None })
            }
            Ast::Call(callee, arguments) => self.call(callee, arguments, at),
            Ast::Member(base, name) => {
                let base = self.value(base)?;
                self.member(base, *name, at)
            }
            Ast::Index(base, Some(index)) => {
                let base = self.value(base)?;
                let index = self.value(index)?;
                self.index(base, index, at)
            }
            Ast::Index(_, None) => self.fail(at, "an index is missing between the brackets"),
            Ast::List(_) => self.fail(at, "a list in braces belongs into a declaration"),
        }
    }

    /// An expression that has a value.
    pub(super) fn value(&mut self, expr: &'a ast::Expr<'a>) -> Res<Expr> {
        let value = self.expr(expr)?;
        if value.ty == Type::Void {
            return self.fail(expr.at, "a function without a result is used as a value");
        }
        Ok(value)
    }

    fn ternary(
        &mut self,
        condition: &'a ast::Expr<'a>,
        yes: &'a ast::Expr<'a>,
        no: &'a ast::Expr<'a>,
        at: At,
    ) -> Res<Expr> {
        let condition = self.bool_expr(condition)?;
        let (yes, no) = (self.expr(yes), self.expr(no));
        let (yes, no) = (yes?, no?);
        let (yes, no) = match self.convert(no, &yes.ty) {
            Ok(no) => (yes, no),
            Err(no) => match self.convert(yes, &no.ty) {
                Ok(yes) => (yes, no),
                Err(yes) => {
                    let (yes, no) = (self.type_name(&yes.ty), self.type_name(&no.ty));
                    let message = format!("`?:` chooses between `{yes}` and `{no}`");
                    return self.fail(at, message);
                }
            },
        };
        let known = match condition.known.as_deref() {
            Some([Number::Bool(true)]) => yes.known.clone().filter(|_| no.known.is_some()),
            Some([Number::Bool(false)]) => no.known.clone().filter(|_| yes.known.is_some()),
            _ => None,
        };
        let ty = yes.ty.clone();
        if self.shader.has_opaque(&ty) {
            return self.fail(at, "`?:` does not choose between textures");
        }
        let kind = ExprKind::Ternary(Box::new(condition), Box::new(yes), Box::new(no));
        Ok(Expr { kind, ty, at, known })
    }

    fn step(&mut self, op: &str, before: bool, operand: &'a ast::Expr<'a>, at: At) -> Res<Expr> {
        let operand = self.value(operand)?;
        if matches!(operand.ty.scalar(), None | Some(Scalar::Bool)) {
            let name = self.type_name(&operand.ty);
            return self.fail(at, format!("`{op}` does not take `{name}`"));
        }
        self.mark_written(&operand)?;
        let ty = operand.ty.clone();
        let kind = ExprKind::Step(op == "++", before, Box::new(operand));
        Ok(Expr { kind, ty, at, known: None })
    }

    fn assign(
        &mut self,
        op: &str,
        left: &'a ast::Expr<'a>,
        right: &'a ast::Expr<'a>,
        at: At,
    ) -> Res<Expr> {
        let (left, right) = (self.value(left), self.value(right));
        let (left, right) = (left?, right?);
        self.mark_written(&left)?;
        let ty = left.ty.clone();
        let Some(op) = Op::binary(op) else {
            let right = self.convert_to(right, &ty, "the value")?;
            let kind = ExprKind::Assign(None, Box::new(left), Box::new(right));
            return Ok(Expr { kind, ty, at, known: None });
        };
        let result = self.binary(op, left, right, at)?;
        let ExprKind::Binary(op, left, right) = result.kind else {
            return self.fail(at, "this is not an assignment");
        };
        // The left operand may only have been converted if the result fits into it again.
        if result.ty != ty || matches!(left.kind, ExprKind::Convert(_)) {
            let (found, wanted) = (self.type_name(&result.ty), self.type_name(&ty));
            let message =
                format!("`{}=` gives `{found}`, which is assigned to `{wanted}`", op.text());
            return self.fail(at, message);
        }
        Ok(Expr { kind: ExprKind::Assign(Some(op), left, right), ty, at, known: None })
    }

    /// Checks that an expression can be written, and records that it is.
    pub(super) fn mark_written(&mut self, expr: &Expr) -> Res<()> {
        match &expr.kind {
            ExprKind::Var(index) => self.mark_var_written(*index, expr.at),
            ExprKind::Member(base, member) => {
                if let Type::Struct(index) = base.ty
                    && self.shader.structs[index as usize].members[*member as usize].readonly
                {
                    return self.fail(expr.at, "this is `readonly`");
                }
                self.mark_written(base)
            }
            ExprKind::Index(base, _) => self.mark_written(base),
            ExprKind::Swizzle(base, letters) => {
                let mut sorted = letters.clone();
                sorted.sort_unstable();
                sorted.dedup();
                if sorted.len() != letters.len() {
                    return self.fail(expr.at, "a component is written twice");
                }
                self.mark_written(base)
            }
            _ => self.fail(expr.at, "this cannot be written to"),
        }
    }

    fn mark_var_written(&mut self, index: u32, at: At) -> Res<()> {
        let var = self.var(index);
        let reason = match var.place {
            Place::Const | Place::Override => Some("a constant"),
            Place::Input => Some("an input"),
            Place::Uniform | Place::UniformBlock => Some("a uniform"),
            Place::Builtin(builtin) if !builtin.output => Some("an input"),
            _ if var.access.readonly => Some("`readonly`"),
            _ => None,
        };
        if let Some(reason) = reason {
            let message = format!("`{}` is {reason}, and cannot be written to", var.name);
            return self.fail(at, message);
        }
        if !matches!(var.place, Place::Local | Place::Param(_)) {
            self.effects = true;
        }
        self.var_mut(index).written = true;
        Ok(())
    }

    pub(super) fn member(&mut self, base: Expr, name: ast::Name<'a>, at: At) -> Res<Expr> {
        match &base.ty {
            Type::Struct(index) => {
                let content = &self.shader.structs[*index as usize];
                for (found, field) in content.members.iter().enumerate() {
                    let found = found as u32;
                    if field.name == name.text {
                        let ty = field.ty.clone();
                        let known = self.member_known(&base, *index, found);
                        let kind = ExprKind::Member(Box::new(base), found);
                        return Ok(Expr { kind, ty, at, known });
                    }
                }
                let known: Vec<String> = content.members.iter().map(|m| m.name.clone()).collect();
                let message = format!("`{}` has no member `{}`", content.name, name.text);
                let problem = lamplight_diagnostic::Diagnostic::error(
                    lamplight_diagnostic::codes::GLSL_ERROR,
                    message,
                )
                .at(self.span(name.at), "here")
                .suggest(name.text, known.iter().map(String::as_str));
                self.problems.push(problem);
                Err(super::Failed)
            }
            Type::Vector(..) | Type::Scalar(_) => self.swizzle(base, name, at),
            _ => {
                let found = self.type_name(&base.ty);
                self.fail(name.at, format!("`{found}` has no members"))
            }
        }
    }

    fn member_known(&self, base: &Expr, index: u32, member: u32) -> Option<Known> {
        let members = &self.shader.structs[index as usize].members;
        let before = members[..member as usize].iter();
        let start = before.map(|field| self.number_count(&field.ty)).fold(0, usize::saturating_add);
        fold::part(base.known.as_ref(), start, self.number_count(&members[member as usize].ty))
    }

    /// How many numbers a value of a type has.
    pub(super) fn number_count(&self, ty: &Type) -> usize {
        match ty {
            Type::Array(element, size) => {
                self.number_count(element).saturating_mul(size.unwrap_or(0) as usize)
            }
            Type::Struct(index) => {
                let members = &self.shader.structs[*index as usize].members;
                let counts = members.iter().map(|field| self.number_count(&field.ty));
                counts.fold(0, usize::saturating_add)
            }
            other => other.components() as usize,
        }
    }

    fn swizzle(&mut self, base: Expr, name: ast::Name<'a>, at: At) -> Res<Expr> {
        let Some((scalar, size)) = base.ty.as_vector() else { return Err(super::Failed) };
        let letters = SWIZZLES.iter().find_map(|set| {
            name.text.chars().map(|letter| set.find(letter).map(|at| at as u8)).collect()
        });
        let letters: Option<Vec<u8>> = letters;
        let valid = letters.filter(|letters| {
            (1..=4).contains(&letters.len()) && letters.iter().all(|letter| *letter < size)
        });
        let Some(letters) = valid else {
            let found = self.type_name(&base.ty);
            return self.fail(name.at, format!("`{found}` has no components `{}`", name.text));
        };
        let known = base.known.as_ref().and_then(|known| {
            letters.iter().map(|at| known.get(usize::from(*at)).copied()).collect()
        });
        let ty = Type::vector(scalar, letters.len() as u8);
        Ok(Expr { kind: ExprKind::Swizzle(Box::new(base), letters), ty, at, known })
    }

    pub(super) fn index(&mut self, base: Expr, index: Expr, at: At) -> Res<Expr> {
        let Some(ty) = base.ty.element() else {
            let found = self.type_name(&base.ty);
            return self.fail(at, format!("`{found}` has no elements"));
        };
        if index.ty != INT && index.ty != UINT {
            let found = self.type_name(&index.ty);
            return self
                .fail(index.at, format!("an index is `int` or `uint`, and this is `{found}`"));
        }
        let size = match &base.ty {
            Type::Vector(_, size) => Some(u32::from(*size)),
            Type::Matrix(_, columns, _) => Some(u32::from(*columns)),
            Type::Array(_, size) => *size,
            _ => None,
        };
        let constant = index.known.as_ref().and_then(|known| known.first().copied());
        let mut known = None;
        match (constant, size) {
            (Some(number), size) => {
                let value = number.as_size();
                if value.is_none() || size.is_some_and(|size| value.is_some_and(|v| v >= size)) {
                    return self.fail(index.at, "the index is out of bounds");
                }
                let count = self.number_count(&ty);
                let start = (value.unwrap_or(0) as usize).saturating_mul(count);
                known = fold::part(base.known.as_ref(), start, count);
                if size.is_none() {
                    self.grow_array(&base, value.unwrap_or(0));
                }
            }
            (None, _) => self.mark_indexed(&base),
        }
        let kind = ExprKind::Index(Box::new(base), Box::new(index));
        Ok(Expr { kind, ty, at, known })
    }

    /// An array without a size is as large as its largest constant index asks for, but for the last
    /// member of a buffer.
    fn grow_array(&mut self, base: &Expr, index: u32) {
        let ExprKind::Var(var) = base.kind else { return };
        let is_open = matches!(self.var(var).ty, Type::Array(_, None));
        if is_open && !matches!(self.var(var).place, Place::StorageBlock) {
            let grown = self.grown.entry(var).or_default();
            *grown = (*grown).max(index.saturating_add(1));
        }
    }

    fn mark_indexed(&mut self, base: &Expr) {
        match &base.kind {
            ExprKind::Var(index) => self.var_mut(*index).indexed = true,
            ExprKind::Member(base, _) | ExprKind::Index(base, _) | ExprKind::Swizzle(base, _) => {
                self.mark_indexed(base);
            }
            _ => {}
        }
    }

    /// `a.length()`.
    pub(super) fn length(&mut self, base: Expr, at: At) -> Res<Expr> {
        let size = match &base.ty {
            Type::Array(_, Some(size)) => Some(*size),
            Type::Vector(_, size) => Some(u32::from(*size)),
            Type::Matrix(_, columns, _) => Some(u32::from(*columns)),
            Type::Array(_, None) => None,
            _ => {
                let found = self.type_name(&base.ty);
                return self.fail(at, format!("`{found}` has no length"));
            }
        };
        match size {
            Some(size) => Ok(int_literal(size as i32, at)),
            None => Ok(Expr { kind: ExprKind::Length(Box::new(base)), ty: INT, at, known: None }),
        }
    }

    /// An expression whose value must be known: a size, a label or a number of a layout.
    pub(super) fn constant_int(&mut self, expr: &'a ast::Expr<'a>, what: &str) -> Res<Number> {
        let value = self.value(expr)?;
        self.constant_number(&value, what)
    }

    /// The number of such an expression.
    pub(super) fn constant_number(&mut self, value: &Expr, what: &str) -> Res<Number> {
        match value.known.as_deref() {
            Some([number @ (Number::Int(_) | Number::Uint(_))]) => Ok(*number),
            _ => self.fail(value.at, format!("{what} must be a constant integer")),
        }
    }
}

fn float_literal(text: &str, at: At) -> Expr {
    let digits = text.trim_end_matches(['f', 'F']);
    let value: f32 = digits.parse().unwrap_or(f32::INFINITY);
    let number = Number::Float(value);
    Expr {
        kind: ExprKind::Literal(number, Some(digits.to_owned())),
        ty: Type::Scalar(Scalar::Float),
        at,
        known: Some([number].into()),
    }
}

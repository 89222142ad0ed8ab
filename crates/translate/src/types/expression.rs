//! Types of expressions.

use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, codes};

use super::constant::{convert, default_type};
use super::scope::Scope;
use crate::tree::{Expression, ExpressionKind, Scalar, Type, Unary};

impl Scope<'_> {
    /// Finds the type of an expression. It has no size yet if it is of such numbers alone.
    pub fn expression(&mut self, value: &mut Expression) -> Result<(), Diagnostic> {
        let span = value.span;
        value.ty = match &mut value.kind {
            ExpressionKind::Number(_) | ExpressionKind::Bool(_) => return Ok(()),
            ExpressionKind::Axis(_) => Type::Scalar(Scalar::AbstractInteger),
            ExpressionKind::Name(name, meaning) => {
                let (found, ty) = self.look_up(name, span)?;
                *meaning = found;
                ty
            }
            ExpressionKind::Parenthesised(inner) | ExpressionKind::Convert(inner) => {
                self.expression(inner)?;
                inner.ty.clone()
            }
            ExpressionKind::Unary(operator, inner) => {
                self.expression(inner)?;
                unary_type(*operator, &inner.ty, span)?
            }
            ExpressionKind::Binary { operator, left, right, line_break: _ } => {
                self.expression(left)?;
                self.expression(right)?;
                self.binary(*operator, left, right, span)?
            }
            ExpressionKind::Member(object, name) => {
                self.expression(object)?;
                self.member(&object.ty, name, span)?
            }
            ExpressionKind::Index(object, index) => {
                self.expression(object)?;
                self.sized(index)?;
                if !matches!(index.ty, Type::Scalar(Scalar::I32 | Scalar::U32)) {
                    return Err(mismatch(index.span, format!("{} is no index", index.ty)));
                }
                element_type(&object.ty, span)?
            }
            ExpressionKind::Call { callee, arguments, is_broken: _ } => {
                for argument in arguments.iter_mut() {
                    self.expression(&mut argument.value)?;
                }
                self.call(callee, arguments, span)?
            }
        };
        Ok(())
    }

    /// The same, with a type that has a size.
    pub fn sized(&mut self, value: &mut Expression) -> Result<(), Diagnostic> {
        self.expression(value)?;
        let ty = default_type(&value.ty);
        convert(value, &ty, self.globals)
    }

    /// The same, of a known type.
    pub fn expected(&mut self, value: &mut Expression, ty: &Type) -> Result<(), Diagnostic> {
        self.expression(value)?;
        self.fit(value, ty)
    }

    /// Gives an expression whose type is known another one, if that is possible.
    pub fn fit(&self, value: &mut Expression, ty: &Type) -> Result<(), Diagnostic> {
        convert(value, ty, self.globals)?;
        match value.ty == *ty {
            true => Ok(()),
            false => Err(mismatch(value.span, format!("expected {ty}, found {}", value.ty))),
        }
    }

    fn member(&self, object: &Type, name: &str, span: Span) -> Result<Type, Diagnostic> {
        match object {
            Type::Pointer(_, target) => self.member(target, name, span),
            Type::Vector(size, scalar) => {
                let is_letter = |set: &str| {
                    name.chars().all(|one| set[..*size as usize].contains(one))
                        && (1..=4).contains(&name.len())
                };
                match (is_letter("xyzw") || is_letter("rgba"), name.len()) {
                    (true, 1) => Ok(Type::Scalar(*scalar)),
                    (true, length) => Ok(Type::Vector(length as u8, *scalar)),
                    (false, _) => Err(mismatch(span, format!("{object} has no `{name}`"))),
                }
            }
            Type::Structure(path) => {
                let members = self.globals.members(path);
                let mut found = members
                    .iter()
                    .filter(|member| member.name == name && !self.is_absent(&member.condition));
                let unknown = || mismatch(span, format!("`{}` has no member `{name}`", path.name));
                let first = found.next().ok_or_else(unknown)?;
                match found.all(|member| is_alike(&member.ty, &first.ty)) {
                    true => Ok(first.ty.clone()),
                    false => {
                        let what = format!("the member `{name}` has several types here");
                        Err(crate::wesl::untranslated(span, what))
                    }
                }
            }
            other => Err(mismatch(span, format!("{other} has no members"))),
        }
    }
}

/// Whether two types are the same but for the lengths of arrays. A member may have a longer array
/// under one condition than under another; only whole copies of it would tell.
fn is_alike(left: &Type, right: &Type) -> bool {
    match (left, right) {
        (Type::Array(left, _), Type::Array(right, _)) => is_alike(left, right),
        _ => left == right,
    }
}

fn unary_type(operator: Unary, inner: &Type, span: Span) -> Result<Type, Diagnostic> {
    let scalar = inner.scalar();
    let fits = match operator {
        Unary::Negate => scalar.is_some_and(|scalar| !matches!(scalar, Scalar::Bool | Scalar::U32)),
        Unary::Not => scalar == Some(Scalar::Bool),
        Unary::Complement => {
            matches!(scalar, Some(Scalar::I32 | Scalar::U32 | Scalar::AbstractInteger))
        }
        Unary::Address => {
            return Ok(Type::Pointer(crate::tree::Space::Function, Box::new(inner.clone())));
        }
        Unary::Follow => match inner {
            Type::Pointer(_, target) => return Ok((**target).clone()),
            _ => false,
        },
    };
    match fits {
        true => Ok(inner.clone()),
        false => Err(mismatch(span, format!("this operator does not take {inner}"))),
    }
}

fn element_type(object: &Type, span: Span) -> Result<Type, Diagnostic> {
    match object {
        Type::Pointer(_, target) => element_type(target, span),
        Type::Array(element, _) => Ok((**element).clone()),
        Type::Vector(_, scalar) => Ok(Type::Scalar(*scalar)),
        Type::Matrix { rows, scalar, .. } => Ok(Type::Vector(*rows, *scalar)),
        other => Err(mismatch(span, format!("{other} has no elements"))),
    }
}

/// The error for types that do not go together.
pub fn mismatch(span: Span, what: String) -> Diagnostic {
    Diagnostic::error(codes::TYPE_MISMATCH, what).at(span, "here")
}

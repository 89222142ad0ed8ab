//! Constructors and initializers.

use std::rc::Rc;

use super::{Checker, Res, fold};
use crate::ast::{self, ExprKind as Ast};
use crate::lexer::At;
use crate::tree::{Expr, ExprKind, Place};
use crate::types::{OpaqueKind, Scalar, Type, named_type};

impl<'a> Checker<'a> {
    /// The type that an expression before brackets names, such as `vec3` or `float[2]`.
    pub(super) fn type_of_callee(&mut self, callee: &'a ast::Expr<'a>) -> Option<Res<Type>> {
        let mut sizes = Vec::new();
        let mut base = callee;
        while let Ast::Index(inner, size) = &base.kind {
            sizes.push(size.as_deref());
            base = inner;
        }
        let Ast::Name(name) = base.kind else { return None };
        let mut ty = match self.lookup(name) {
            Some(super::Symbol::Struct(index)) => Type::Struct(*index),
            Some(_) => return None,
            // `texture2D` is a type of Vulkan and a function of older versions.
            None => named_type(name).filter(
                |ty| !matches!(ty, Type::Opaque(opaque) if opaque.kind != OpaqueKind::Combined),
            )?,
        };
        // The sizes were read from the last to the first, and the last is the innermost.
        for size in sizes {
            let number = match size {
                None => None,
                Some(size) => match self.array_size(size) {
                    Ok(size) => Some(size),
                    Err(failed) => return Some(Err(failed)),
                },
            };
            ty = ty.array(number);
        }
        Some(Ok(ty))
    }

    /// A size between brackets.
    pub(super) fn array_size(&mut self, expr: &'a ast::Expr<'a>) -> Res<u32> {
        let value = self.value(expr)?;
        if self.is_specialised(&value) {
            let message = "an array whose size is a specialisation constant has no counterpart \
                           in WGSL";
            return self.refuse(expr.at, message);
        }
        match self.constant_number(&value, "the size of an array")?.as_size() {
            Some(size) if size > 0 && size <= 1 << 24 => Ok(size),
            Some(0) | None => self.fail(expr.at, "the size of an array must be positive"),
            Some(_) => self.fail(expr.at, "the array is too large"),
        }
    }

    /// Whether a specialisation constant decides a value.
    fn is_specialised(&self, value: &Expr) -> bool {
        value.known.is_none()
            && value.names(&|index| {
                let var = self.var(index);
                var.place == Place::Override
                    || var.place == Place::Const
                        && var.init.as_ref().is_some_and(|init| self.is_specialised(init))
            })
    }

    /// A value of a type from others.
    pub(super) fn construct(&mut self, ty: Type, arguments: Vec<Expr>, at: At) -> Res<Expr> {
        match &ty {
            Type::Array(element, size) => self.construct_array(element, *size, arguments, at),
            Type::Struct(index) => self.construct_struct(*index, arguments, at),
            Type::Opaque(opaque) if opaque.kind == OpaqueKind::Combined => {
                self.construct_sampler(ty.clone(), arguments, at)
            }
            Type::Void | Type::Opaque(_) => {
                let name = self.type_name(&ty);
                self.fail(at, format!("`{name}` has no constructor"))
            }
            _ => self.construct_numbers(ty, arguments, at),
        }
    }

    fn construct_sampler(&mut self, ty: Type, arguments: Vec<Expr>, at: At) -> Res<Expr> {
        let Type::Opaque(wanted) = ty else { return Err(super::Failed) };
        if let [Expr { ty: Type::Opaque(texture), .. }, Expr { ty: Type::Opaque(sampler), .. }] =
            arguments.as_slice()
        {
            let fits = texture.kind == OpaqueKind::Texture
                && sampler.kind == OpaqueKind::Sampler
                && texture.dim == wanted.dim
                && texture.scalar == wanted.scalar
                && texture.arrayed == wanted.arrayed
                && texture.multisampled == wanted.multisampled;
            if fits {
                return Ok(Expr { kind: ExprKind::Construct(arguments), ty, at, known: None });
            }
        }
        self.fail(at, format!("`{ty}` is made of a texture of its kind and a sampler"))
    }

    fn construct_numbers(&mut self, ty: Type, arguments: Vec<Expr>, at: At) -> Res<Expr> {
        if ty.scalar() == Some(Scalar::Double) {
            return self.refuse(at, "`double` has no counterpart in WGSL");
        }
        let wanted = ty.components();
        let mut found = 0;
        for (index, argument) in arguments.iter().enumerate() {
            let count = argument.ty.components();
            if count == 0 {
                let name = self.type_name(&argument.ty);
                return self.fail(argument.at, format!("`{ty}` is not made of `{name}`"));
            }
            let matrix = matches!(argument.ty, Type::Matrix(..));
            if matrix && matches!(ty, Type::Matrix(..)) && arguments.len() > 1 {
                return self.fail(argument.at, "a matrix is not made of a matrix and more");
            }
            if found >= wanted && index > 0 {
                return self.fail(argument.at, format!("`{ty}` has no room for this argument"));
            }
            found += count;
        }
        let whole = matches!(ty, Type::Matrix(..))
            && matches!(arguments.as_slice(), [Expr { ty: Type::Matrix(..), .. }]);
        let single = arguments.len() == 1 && found == 1;
        if found < wanted && !single && !whole {
            let message = format!("`{ty}` needs {wanted} numbers, and gets {found}");
            return self.fail(at, message);
        }
        if let [only] = arguments.as_slice()
            && only.ty.components() == wanted
            && matches!(only.ty, Type::Matrix(..)) == matches!(ty, Type::Matrix(..))
        {
            let only = only.clone();
            if only.ty == ty {
                return Ok(only);
            }
            if let Some(scalar) = ty.scalar()
                && only.ty.with_scalar(scalar) == ty
            {
                let mut converted = fold::converted(only, &ty);
                converted.at = at;
                return Ok(converted);
            }
        }
        let known = fold::constructed(&ty, &arguments);
        Ok(Expr { kind: ExprKind::Construct(arguments), ty, at, known })
    }

    fn construct_array(
        &mut self,
        element: &Rc<Type>,
        size: Option<u32>,
        arguments: Vec<Expr>,
        at: At,
    ) -> Res<Expr> {
        let count = arguments.len() as u32;
        if count == 0 || size.is_some_and(|size| size != count) {
            let message = format!("the array has {} elements, and gets {count}", size.unwrap_or(1));
            return self.fail(at, message);
        }
        let mut element: Type = (**element).clone();
        if has_unsized(&element)
            && let Some(first) = arguments.first()
        {
            element = first.ty.clone();
        }
        let mut converted = Vec::with_capacity(arguments.len());
        for argument in arguments {
            converted.push(self.convert_to(argument, &element, "the element")?);
        }
        let ty = element.array(Some(count));
        let known = fold::constructed(&ty, &converted);
        Ok(Expr { kind: ExprKind::Construct(converted), ty, at, known })
    }

    fn construct_struct(&mut self, index: u32, arguments: Vec<Expr>, at: At) -> Res<Expr> {
        let fields: Vec<Type> =
            self.shader.structs[index as usize].members.iter().map(|m| m.ty.clone()).collect();
        if fields.len() != arguments.len() {
            let name = self.shader.structs[index as usize].name.clone();
            let (wanted, found) = (fields.len(), arguments.len());
            return self.fail(at, format!("`{name}` has {wanted} members, and gets {found}"));
        }
        let mut converted = Vec::with_capacity(fields.len());
        for (argument, field) in arguments.into_iter().zip(&fields) {
            converted.push(self.convert_to(argument, field, "the member")?);
        }
        let ty = Type::Struct(index);
        let known = fold::constructed(&ty, &converted);
        Ok(Expr { kind: ExprKind::Construct(converted), ty, at, known })
    }

    /// What a variable of a type begins with.
    pub(super) fn initializer(&mut self, expr: &'a ast::Expr<'a>, ty: &Type) -> Res<Expr> {
        let Ast::List(list) = &expr.kind else {
            let value = self.value(expr)?;
            let wanted = if has_unsized(ty) { sized_like(ty, &value.ty) } else { ty.clone() };
            return self.convert_to(value, &wanted, "the initial value");
        };
        let parts: Vec<Type> = match ty {
            Type::Array(element, _) => vec![(**element).clone(); list.len()],
            Type::Struct(index) => {
                let members = &self.shader.structs[*index as usize].members;
                members.iter().map(|field| field.ty.clone()).collect()
            }
            Type::Matrix(scalar, columns, rows) => {
                vec![Type::Vector(*scalar, *rows); usize::from(*columns)]
            }
            Type::Vector(scalar, size) => vec![Type::Scalar(*scalar); usize::from(*size)],
            _ => return self.fail(expr.at, "a list in braces does not begin this variable"),
        };
        if parts.len() != list.len() {
            let message = format!("the list has {} parts, and needs {}", list.len(), parts.len());
            return self.fail(expr.at, message);
        }
        let mut values = Vec::with_capacity(list.len());
        for (part, ty) in list.iter().zip(&parts) {
            values.push(self.initializer(part, ty)?);
        }
        self.construct(ty.clone(), values, expr.at)
    }
}

/// Whether a size is still open.
pub(super) fn has_unsized(ty: &Type) -> bool {
    match ty {
        Type::Array(_, None) => true,
        Type::Array(element, _) => has_unsized(element),
        _ => false,
    }
}

/// A type whose open sizes are those of another type.
fn sized_like(ty: &Type, like: &Type) -> Type {
    match (ty, like) {
        (Type::Array(element, size), Type::Array(inner, known)) => {
            sized_like(element, inner).array(size.or(*known))
        }
        _ => ty.clone(),
    }
}

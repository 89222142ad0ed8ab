//! Types of calls.

use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, codes};

use super::constant::{convert, default_type};
use super::expression::mismatch;
use super::global::{Global, GlobalKind, MemberType, Signature};
use super::scope::Scope;
use crate::tree::{Argument, Callee, Count, ExpressionKind, ItemPath, Scalar, Type};
use crate::wesl::untranslated;

impl Scope<'_> {
    /// The type of a call's result. The types of the arguments are known, but for those that have no
    /// size yet.
    pub fn call(
        &mut self,
        callee: &mut Callee,
        arguments: &mut [Argument],
        span: Span,
    ) -> Result<Type, Diagnostic> {
        match callee {
            Callee::Name(name) => {
                let (resolved, ty) = self.named_call(name, arguments, span)?;
                *callee = resolved;
                Ok(ty)
            }
            Callee::Construct(ty) => {
                self.globals.resolve(self.module, ty, span, 0)?;
                *ty = self.construct(ty, arguments, span)?;
                Ok(ty.clone())
            }
            Callee::Bitcast(target) => {
                for argument in arguments {
                    let ty = default_type(&argument.value.ty);
                    convert(&mut argument.value, &ty, self.globals)?;
                }
                Ok(target.clone())
            }
            Callee::Function(path) => {
                let path = path.clone();
                self.function(&path, arguments, span)
            }
            Callee::Builtin(name) => {
                let name = name.clone();
                self.builtin(&name, arguments, span)
            }
        }
    }

    fn named_call(
        &mut self,
        name: &str,
        arguments: &mut [Argument],
        span: Span,
    ) -> Result<(Callee, Type), Diagnostic> {
        if self.is_local(name) {
            return Err(mismatch(span, format!("`{name}` is no function here")));
        }
        let path = self.globals.meaning(self.module, name);
        let path = path.filter(|path| !self.globals.items(path).is_empty());
        let Some(path) = path else {
            if self.globals.meaning(self.module, name).is_some() {
                let what = format!("there is no `{name}`");
                return Err(Diagnostic::error(codes::MISSING_ITEM, what).at(span, "called here"));
            }
            let ty = self.builtin(name, arguments, span)?;
            return Ok((Callee::Builtin(name.to_owned()), ty));
        };
        match self.globals.items(&path).first().map(|global| global.kind.clone()) {
            Some(GlobalKind::Structure(_)) => {
                let ty = self.construct(&Type::Structure(path), arguments, span)?;
                Ok((Callee::Construct(ty.clone()), ty))
            }
            Some(GlobalKind::Alias(mut target)) => {
                self.globals.resolve(&path.module, &mut target, span, 0)?;
                let ty = self.construct(&target, arguments, span)?;
                Ok((Callee::Construct(ty.clone()), ty))
            }
            _ => {
                let ty = self.function(&path, arguments, span)?;
                Ok((Callee::Function(path), ty))
            }
        }
    }

    /// A call of a function of a module.
    fn function(
        &mut self,
        path: &ItemPath,
        arguments: &mut [Argument],
        span: Span,
    ) -> Result<Type, Diagnostic> {
        let globals = self.globals;
        let possible: Vec<&Signature> = globals
            .items(path)
            .iter()
            .filter(|global: &&Global| !self.is_absent(&global.condition))
            .filter_map(|global| match &global.kind {
                GlobalKind::Function(signature) => Some(signature),
                _ => None,
            })
            .filter(|signature| self.fields(&signature.parameters, arguments.len()).is_some())
            .collect();
        let Some(first) = possible.first() else {
            let what = format!("no `{}` takes these {} arguments", path.name, arguments.len());
            return Err(mismatch(span, what));
        };
        let takes = |one: &Signature| -> Vec<Type> {
            let fields = self.fields(&one.parameters, arguments.len()).unwrap_or_default();
            fields.into_iter().map(|field| field.ty.clone()).collect()
        };
        let differs =
            |other: &Signature| other.result != first.result || takes(other) != takes(first);
        if possible.iter().any(|other| differs(other)) {
            let what = format!("`{}` has several types here", path.name);
            return Err(untranslated(span, what));
        }
        let fields = self.fields(&first.parameters, arguments.len()).unwrap_or_default();
        for (argument, field) in arguments.iter_mut().zip(fields) {
            self.argument(argument, &field.ty)?;
        }
        Ok(first.result.clone())
    }

    /// An argument for a parameter.
    fn argument(&self, argument: &mut Argument, ty: &Type) -> Result<(), Diagnostic> {
        match (&argument.value.ty, ty) {
            (Type::Pointer(_, given), Type::Pointer(_, wanted)) if given == wanted => Ok(()),
            _ => self.fit(&mut argument.value, ty),
        }
    }

    /// The members or parameters that exist here, if there are so many.
    pub fn fields<'f>(
        &self,
        fields: &'f [MemberType],
        count: usize,
    ) -> Option<Vec<&'f MemberType>> {
        let here: Vec<&MemberType> =
            fields.iter().filter(|field| !self.is_absent(&field.condition)).collect();
        if here.len() == count {
            return Some(here);
        }
        let sure: Vec<&MemberType> =
            here.into_iter().filter(|field| self.condition.implies(&field.condition)).collect();
        (sure.len() == count).then_some(sure)
    }

    /// A call of a type.
    fn construct(
        &mut self,
        ty: &Type,
        arguments: &mut [Argument],
        span: Span,
    ) -> Result<Type, Diagnostic> {
        match ty {
            Type::Scalar(_) => {
                self.convert_to_scalar(ty, arguments)?;
                Ok(ty.clone())
            }
            Type::Vector(_, scalar) | Type::Matrix { scalar, .. } => {
                for argument in arguments.iter_mut() {
                    let target = argument.value.ty.with_scalar(*scalar);
                    convert(&mut argument.value, &target, self.globals)?;
                }
                Ok(ty.clone())
            }
            Type::OpenVector(_) | Type::OpenMatrix { .. } => {
                let scalar = self.unify_arguments(arguments)?;
                let scalar = match (ty, scalar) {
                    (Type::OpenMatrix { .. }, Some(Scalar::AbstractInteger)) => {
                        Some(Scalar::AbstractFloat)
                    }
                    (_, scalar) => scalar,
                };
                let filled = scalar.and_then(|scalar| crate::wesl::filled_type(ty, scalar));
                filled.ok_or_else(|| mismatch(span, format!("`{ty}` of what?")))
            }
            Type::OpenArray => {
                self.unify_arguments(arguments)?;
                let first = arguments.first().map(|argument| argument.value.ty.clone());
                let element = first.ok_or_else(|| mismatch(span, "an empty array".to_owned()))?;
                let count = Count::Fixed(arguments.len() as u32);
                Ok(Type::Array(Box::new(element), count))
            }
            Type::Array(element, _) => {
                for argument in arguments.iter_mut() {
                    self.fit(&mut argument.value, element)?;
                }
                Ok(ty.clone())
            }
            Type::Structure(path) => {
                self.structure(path, arguments, span)?;
                Ok(ty.clone())
            }
            other => Err(mismatch(span, format!("{other} cannot be made"))),
        }
    }

    fn convert_to_scalar(
        &mut self,
        ty: &Type,
        arguments: &mut [Argument],
    ) -> Result<(), Diagnostic> {
        for argument in arguments.iter_mut() {
            let is_number = matches!(argument.value.kind, ExpressionKind::Number(_));
            let target = match argument.value.ty {
                // Numbers beyond those of an i32 are allowed here.
                Type::Scalar(Scalar::AbstractInteger) if is_number => ty.clone(),
                ref other => default_type(other),
            };
            convert(&mut argument.value, &target, self.globals)?;
        }
        Ok(())
    }

    fn structure(
        &mut self,
        path: &ItemPath,
        arguments: &mut [Argument],
        span: Span,
    ) -> Result<(), Diagnostic> {
        if arguments.is_empty() {
            return Ok(());
        }
        let globals = self.globals;
        let members = globals.members(path);
        let Some(fields) = self.fields(&members, arguments.len()) else {
            let what = format!("`{}` does not have {} members", path.name, arguments.len());
            return Err(mismatch(span, what));
        };
        for (argument, field) in arguments.iter_mut().zip(fields) {
            self.fit(&mut argument.value, &field.ty)?;
        }
        Ok(())
    }

    /// Gives arguments without a size the scalar of the others. Returns the scalar.
    pub fn unify_arguments(
        &self,
        arguments: &mut [Argument],
    ) -> Result<Option<Scalar>, Diagnostic> {
        let mut values: Vec<_> = arguments.iter_mut().map(|argument| &mut argument.value).collect();
        self.unify(&mut values)?;
        Ok(arguments.first().and_then(|argument| argument.value.ty.scalar()))
    }
}

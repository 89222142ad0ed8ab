//! Calls: of constructors, of functions of the text, and of the language's own.

use super::{Checker, Res, Symbol, called};
use crate::ast::{self, ExprKind as Ast};
use crate::builtin::functions::{ATOMICS, BARRIERS, REFUSED, find_function};
use crate::builtin::textures::{Access, find_texture_function, forms_of};
use crate::lexer::At;
use crate::tree::{Dir, Expr, ExprKind, Number, Place, Stage};
use crate::types::{FLOAT, OpaqueKind, Scalar, Type};

/// One function that a call may mean.
struct Candidate {
    params: Vec<(Dir, Type)>,
}

impl<'a> Checker<'a> {
    pub(super) fn call(
        &mut self,
        callee: &'a ast::Expr<'a>,
        arguments: &'a [ast::Expr<'a>],
        at: At,
    ) -> Res<Expr> {
        if let Ast::Member(base, name) = &callee.kind {
            if name.text != "length" || !arguments.is_empty() {
                return self.fail(name.at, format!("`{}` is not a function", name.text));
            }
            let base = self.value(base)?;
            return self.length(base, at);
        }
        let ty = self.type_of_callee(callee).transpose()?;
        let mut values = Vec::with_capacity(arguments.len());
        let mut failed = None;
        for argument in arguments {
            match self.value(argument) {
                Ok(value) => values.push(value),
                Err(error) => failed = Some(error),
            }
        }
        if let Some(failed) = failed {
            return Err(failed);
        }
        if let Some(ty) = ty {
            return self.construct(ty, values, at);
        }
        let Ast::Name(name) = callee.kind else {
            return self.fail(callee.at, "this is not a function");
        };
        match self.lookup(name).cloned() {
            Some(Symbol::Functions(functions)) => {
                if let Some(expr) = self.user_call(name, &functions, &values, at)? {
                    return Ok(expr);
                }
                self.builtin_call(name, values, at)
            }
            Some(_) => self.fail(callee.at, format!("`{name}` is not a function")),
            None => self.builtin_call(name, values, at),
        }
    }

    /// Calls a function of the text. `None` if none fits and the language has one of that name.
    fn user_call(
        &mut self,
        name: &str,
        functions: &[u32],
        values: &[Expr],
        at: At,
    ) -> Res<Option<Expr>> {
        let candidates: Vec<Candidate> = functions
            .iter()
            .map(|function| {
                let params = &self.shader.functions[*function as usize].params;
                let params = params.iter().map(|param| {
                    let var = self.var(*param);
                    let dir = match var.place {
                        Place::Param(dir) => dir,
                        _ => Dir::In,
                    };
                    (dir, var.ty.clone())
                });
                Candidate { params: params.collect() }
            })
            .collect();
        let exact = candidates.iter().any(|candidate| self.cost(candidate, values) == Some(0));
        if !exact && self.fits_builtin_exactly(name, values) {
            return Ok(None);
        }
        let Some(chosen) = self.choose(name, &candidates, values, at)? else {
            let known = find_function(name).is_some() || find_texture_function(name).is_some();
            return if known { Ok(None) } else { self.fail_arguments(name, values, at) };
        };
        let function = functions[chosen];
        let params = &candidates[chosen].params;
        let arguments = self.pass(values.to_vec(), params)?;
        self.calls.insert(function);
        let ty = self.shader.functions[function as usize].ret.clone();
        Ok(Some(Expr { kind: ExprKind::Call(function, arguments), ty, at, known: None }))
    }

    /// Whether a function of the language takes arguments without a conversion.
    fn fits_builtin_exactly(&self, name: &str, values: &[Expr]) -> bool {
        if let Some(function) = find_function(name) {
            return function.signatures(values.len()).iter().any(|signature| {
                let candidate = Candidate { params: signature.params.clone() };
                self.cost(&candidate, values) == Some(0)
            });
        }
        let (Some(access), Some(Type::Opaque(opaque))) =
            (find_texture_function(name), values.first().map(|value| &value.ty))
        else {
            return false;
        };
        let types = || values[1..].iter().map(|value| &value.ty);
        forms_of(access, opaque).iter().any(|form| {
            let least = form.params.len() - form.optional;
            values.len() > least && form.params.iter().take(values.len() - 1).eq(types())
        })
    }

    /// Arguments as the types of parameters; those that are written are checked.
    fn pass(&mut self, values: Vec<Expr>, params: &[(Dir, Type)]) -> Res<Vec<Expr>> {
        let mut arguments = Vec::with_capacity(values.len());
        for (value, (dir, ty)) in values.into_iter().zip(params) {
            if *dir == Dir::In {
                arguments.push(self.convert_to(value, ty, "the argument")?);
                continue;
            }
            self.mark_written(&value)?;
            if value.ty != *ty {
                let message = "arguments of `out` and `inout` must have the parameter's type";
                return self.refuse(value.at, message);
            }
            arguments.push(value);
        }
        Ok(arguments)
    }

    fn fail_arguments<T>(&mut self, name: &str, values: &[Expr], at: At) -> Res<T> {
        let types: Vec<String> = values.iter().map(|value| self.type_name(&value.ty)).collect();
        self.fail(at, format!("`{name}` does not take ({})", types.join(", ")))
    }

    /// The candidate that fits: exactly, or with the fewest conversions.
    fn choose(
        &mut self,
        name: &str,
        candidates: &[Candidate],
        values: &[Expr],
        at: At,
    ) -> Res<Option<usize>> {
        let mut best: Option<(u32, usize)> = None;
        let mut tied = false;
        for (index, candidate) in candidates.iter().enumerate() {
            let Some(cost) = self.cost(candidate, values) else { continue };
            match best {
                Some((least, _)) if cost > least => {}
                Some((least, known)) if cost == least => {
                    // `min(float, float)` stands for two forms, which are the same.
                    tied |= candidates[known].params != candidate.params;
                }
                _ => (best, tied) = (Some((cost, index)), false),
            }
        }
        if tied && best.is_some_and(|(cost, _)| cost > 0) {
            return self.fail(at, format!("the call of `{name}` fits several functions"));
        }
        Ok(best.map(|(_, index)| index))
    }

    /// How far arguments are from parameters: nothing for equal types. A conversion to `float` from
    /// integers is further than one between integers.
    fn cost(&self, candidate: &Candidate, values: &[Expr]) -> Option<u32> {
        if candidate.params.len() != values.len() {
            return None;
        }
        let mut sum = 0;
        for (value, (dir, ty)) in values.iter().zip(&candidate.params) {
            if value.ty == *ty {
                continue;
            }
            let (from, to) = match dir {
                Dir::In => (&value.ty, ty),
                Dir::Out => (ty, &value.ty),
                Dir::InOut => return None,
            };
            if !self.version.converts(from, to) {
                return None;
            }
            sum += if to.scalar() == Some(Scalar::Float) { 2 } else { 1 };
        }
        Some(sum)
    }

    fn builtin_call(&mut self, name: &'a str, values: Vec<Expr>, at: At) -> Res<Expr> {
        if let Some(function) = find_function(name) {
            if function.fragment_only && self.shader.stage != Stage::Fragment {
                return self.fail(at, format!("`{name}` is only known in fragment shaders"));
            }
            let signatures = function.signatures(values.len());
            let candidates: Vec<Candidate> = signatures
                .iter()
                .map(|signature| Candidate { params: signature.params.clone() })
                .collect();
            let Some(chosen) = self.choose(name, &candidates, &values, at)? else {
                return self.fail_arguments(name, &values, at);
            };
            let arguments = self.pass(values, &candidates[chosen].params)?;
            let known = called::called(name, &arguments);
            let ty = signatures[chosen].ret.clone();
            let kind = ExprKind::Builtin(function.name, arguments);
            return Ok(Expr { kind, ty, at, known });
        }
        // Every index may differ between invocations in WGSL.
        if name == "nonuniformEXT"
            && let [_] = values.as_slice()
        {
            return values.into_iter().next().ok_or(super::Failed);
        }
        match name {
            "transpose" | "outerProduct" => self.matrix_call(name, values, at),
            _ if BARRIERS.contains(&name) => self.barrier(name, values, at),
            _ if ATOMICS.contains(&name) => self.atomic(name, values, at),
            _ if REFUSED.contains(&name) || name.starts_with("subgroup") => {
                self.refuse(at, format!("`{name}` has no counterpart in WGSL"))
            }
            _ => match find_texture_function(name) {
                Some(access) => self.texture_call(name, access, values, at),
                None => self.fail_unknown(name, at),
            },
        }
    }

    fn matrix_call(&mut self, name: &str, values: Vec<Expr>, at: At) -> Res<Expr> {
        let (name, ty) = match (name, values.as_slice()) {
            ("transpose", [Expr { ty: Type::Matrix(scalar, columns, rows), .. }]) => {
                ("transpose", Type::Matrix(*scalar, *rows, *columns))
            }
            ("outerProduct", [left, right]) => match (left.ty.as_vector(), right.ty.as_vector()) {
                (Some((Scalar::Float, rows @ 2..)), Some((Scalar::Float, columns @ 2..))) => {
                    ("outerProduct", Type::Matrix(Scalar::Float, columns, rows))
                }
                _ => return self.fail_arguments(name, &values, at),
            },
            _ => return self.fail_arguments(name, &values, at),
        };
        Ok(Expr { kind: ExprKind::Builtin(name, values), ty, at, known: None })
    }

    fn barrier(&mut self, name: &str, values: Vec<Expr>, at: At) -> Res<Expr> {
        if !values.is_empty() {
            return self.fail_arguments(name, &values, at);
        }
        if self.shader.stage != Stage::Compute {
            return self.refuse(at, format!("WGSL has `{name}` only in compute shaders"));
        }
        let Some(name) = BARRIERS.iter().find(|known| **known == name) else {
            return Err(super::Failed);
        };
        self.effects = true;
        Ok(Expr { kind: ExprKind::Builtin(name, values), ty: Type::Void, at, known: None })
    }

    fn atomic(&mut self, name: &str, values: Vec<Expr>, at: At) -> Res<Expr> {
        let Some(name) = ATOMICS.iter().find(|known| **known == name) else {
            return Err(super::Failed);
        };
        let count = if *name == "atomicCompSwap" { 3 } else { 2 };
        let integer = |ty: &Type| matches!(ty, Type::Scalar(Scalar::Int | Scalar::Uint));
        if values.len() != count || !integer(&values[0].ty) {
            return self.fail_arguments(name, &values, at);
        }
        let ty = values[0].ty.clone();
        self.mark_written(&values[0])?;
        let mut arguments = Vec::with_capacity(count);
        for (index, value) in values.into_iter().enumerate() {
            let value =
                if index == 0 { value } else { self.convert_to(value, &ty, "the argument")? };
            arguments.push(value);
        }
        self.effects = true;
        Ok(Expr { kind: ExprKind::Builtin(name, arguments), ty, at, known: None })
    }

    fn texture_call(&mut self, name: &str, access: Access, values: Vec<Expr>, at: At) -> Res<Expr> {
        let Some(Type::Opaque(opaque)) = values.first().map(|value| value.ty.clone()) else {
            return self.fail_arguments(name, &values, at);
        };
        let bias_outside = self.shader.stage != Stage::Fragment && access == Access::QueryLod;
        if bias_outside {
            return self.fail(at, format!("`{name}` is only known in fragment shaders"));
        }
        for form in forms_of(access, &opaque) {
            let given = values.len() - 1;
            if given > form.params.len() || given + form.optional < form.params.len() {
                continue;
            }
            let params: Vec<(Dir, Type)> =
                form.params[..given].iter().map(|ty| (Dir::In, ty.clone())).collect();
            let rest = Candidate { params: params.clone() };
            if self.cost(&rest, &values[1..]).is_none() {
                continue;
            }
            let mut values = values;
            let rest = values.split_off(1);
            let mut arguments = values;
            arguments.extend(self.pass(rest, &params)?);
            if access == Access::Store {
                self.effects = true;
                self.mark_image(&arguments[0]);
            }
            let made = |kind, ty| Expr { kind, ty, at, known: None };
            if opaque.shadow && name.starts_with("shadow") && !name.ends_with("EXT") {
                // A depth is a luminance unless the program sets `GL_DEPTH_TEXTURE_MODE`.
                let depth = made(ExprKind::Texture(access, arguments), FLOAT);
                let vector = |size| Type::Vector(Scalar::Float, size);
                let luminance = made(ExprKind::Construct(vec![depth]), vector(3));
                let one = super::literal(Number::Float(1.0), at);
                return Ok(made(ExprKind::Construct(vec![luminance, one]), vector(4)));
            }
            return Ok(made(ExprKind::Texture(access, arguments), form.ret));
        }
        if opaque.kind == OpaqueKind::Other {
            return self.refuse(at, format!("`{name}` of this type has no counterpart in WGSL"));
        }
        self.fail_arguments(name, &values, at)
    }

    fn mark_image(&mut self, image: &Expr) {
        if let ExprKind::Var(index) = image.kind {
            self.var_mut(index).written = true;
        }
    }
}

//! Functions.

use super::decl::NO_SIZES;
use super::layout::Storage;
use super::{Checker, Res, Symbol};
use crate::ast;
use crate::builtin::functions::find_function;
use crate::tree::{Dir, Function, Item, Place, Stmt, StmtKind};
use crate::types::Type;

impl<'a> Checker<'a> {
    pub(super) fn function(&mut self, function: &'a ast::Function<'a>) -> Res<()> {
        let ret = self.spec_type(&function.ty, NO_SIZES)?;
        if self.shader.has_opaque(&ret) {
            return self.fail(function.ty.at, "a function does not return a texture or sampler");
        }
        let mut params = Vec::with_capacity(function.params.len());
        for param in &function.params {
            params.push(self.param(param)?);
        }
        if function.name.text == "main" && (ret != Type::Void || !params.is_empty()) {
            return self.fail(function.name.at, "`main` has no parameters and no result");
        }
        let index = self.function_index(function, ret, &params)?;
        let Some(body) = &function.body else { return Ok(()) };
        if self.shader.functions[index as usize].body.is_some() {
            let message = format!("`{}` is defined twice", function.name.text);
            return self.fail(function.name.at, message);
        }
        self.shader.functions[index as usize].params.clone_from(&params);
        self.shader.functions[index as usize].at = function.name.at;
        // A definition that fails must not be reported as missing too.
        self.shader.functions[index as usize].body = Some(Vec::new());
        self.shader.order.push(Item::Function(index));
        self.function = Some(index);
        self.calls.clear();
        self.effects = false;
        self.discards = false;
        let result = self.scoped(|checker| checker.function_body(function, &params, body));
        self.function = None;
        let found = &mut self.shader.functions[index as usize];
        found.calls = self.calls.iter().copied().collect();
        found.effects = self.effects;
        found.discards = self.discards;
        let body = result?;
        found.loops = has_loop(&body);
        found.body = Some(body);
        Ok(())
    }

    fn function_body(
        &mut self,
        function: &'a ast::Function<'a>,
        params: &[u32],
        body: &'a [ast::Stmt<'a>],
    ) -> Res<Vec<crate::tree::Stmt>> {
        for (param, index) in function.params.iter().zip(params) {
            if let Some(name) = param.name {
                self.declare(name, Symbol::Var(*index))?;
            }
        }
        Ok(self.statements(body))
    }

    fn param(&mut self, param: &'a ast::Param<'a>) -> Res<u32> {
        let quals = self.quals(&param.quals)?;
        let base = self.spec_type(&param.ty, NO_SIZES)?;
        let ty = self.after_name(base, &param.sizes)?;
        let at = param.name.map_or(param.ty.at, |name| name.at);
        if ty == Type::Void {
            return self.fail(at, "a parameter is not `void`");
        }
        if super::construct::has_unsized(&ty) {
            return self.fail(at, "an array that is a parameter has a size");
        }
        let dir = match quals.storage {
            None | Some(Storage::In | Storage::Const) => Dir::In,
            Some(Storage::Out) => Dir::Out,
            Some(Storage::InOut) => Dir::InOut,
            Some(_) => return self.fail(at, "a parameter is `in`, `out` or `inout`"),
        };
        if !self.is_passable(&ty) {
            return self.refuse(at, "arrays and structures of textures are no parameters in WGSL");
        }
        if ty.is_opaque() && dir != Dir::In {
            return self.fail(at, "a texture or sampler is not an `out` parameter");
        }
        let name = param.name.map_or("unnamed", |name| name.text);
        let index = self.new_var(name, ty, Place::Param(dir), at);
        self.var_mut(index).access.readonly = quals.constant;
        self.var_mut(index).layout = quals.layout;
        Ok(index)
    }

    /// The function with these parameters: a new one, or that of a prototype.
    fn function_index(
        &mut self,
        function: &'a ast::Function<'a>,
        ret: Type,
        params: &[u32],
    ) -> Res<u32> {
        let name = function.name;
        let types: Vec<(Type, Place)> = self.signature(params);
        let known = match self.scopes[0].get(name.text) {
            Some(Symbol::Functions(list)) => list.clone(),
            Some(_) => {
                let message = format!("`{}` is declared twice in this scope", name.text);
                return self.fail(name.at, message);
            }
            None => Vec::new(),
        };
        for index in &known {
            let before = self.signature(&self.shader.functions[*index as usize].params);
            let same = before.len() == types.len()
                && before.iter().zip(&types).all(|(before, new)| before.0 == new.0);
            if same && before != types {
                return self.fail(name.at, "this differs from an earlier one only in `out`");
            }
            if same {
                if self.shader.functions[*index as usize].ret != ret {
                    return self.fail(name.at, "this differs from an earlier one in its result");
                }
                return Ok(*index);
            }
        }
        self.check_function_name(name)?;
        let index = self.shader.functions.len() as u32;
        self.shader.functions.push(Function {
            name: name.text.to_owned(),
            ret,
            params: params.to_vec(),
            body: None,
            at: name.at,
            calls: Vec::new(),
            effects: false,
            discards: false,
            loops: false,
        });
        let mut list = known;
        list.push(index);
        self.scopes[0].insert(name.text, Symbol::Functions(list));
        Ok(index)
    }

    /// A name of a new function. GLSL ES keeps the names of its own functions since version 3.00.
    fn check_function_name(&mut self, name: ast::Name<'a>) -> Res<()> {
        self.check_name(name)?;
        if self.blocks.contains(name.text) {
            return self.fail(name.at, format!("there is a block `{}` already", name.text));
        }
        let is_kept = self.version.es && self.version.number >= 300;
        match is_kept && find_function(name.text).is_some() {
            true => self.fail(name.at, format!("`{}` is a function of GLSL ES", name.text)),
            false => Ok(()),
        }
    }

    fn signature(&self, params: &[u32]) -> Vec<(Type, Place)> {
        params.iter().map(|param| (self.var(*param).ty.clone(), self.var(*param).place)).collect()
    }
}

fn has_loop(list: &[Stmt]) -> bool {
    list.iter().any(|statement| match &statement.kind {
        StmtKind::Loop(_) => true,
        StmtKind::Block(list) => has_loop(list),
        StmtKind::If(_, yes, no) => has_loop(yes) || has_loop(no),
        StmtKind::Switch(_, cases) => cases.iter().any(|case| has_loop(&case.body)),
        _ => false,
    })
}

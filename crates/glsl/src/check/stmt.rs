//! Statements.

use super::decl::NO_SIZES;
use super::layout::Storage;
use super::{Checker, Res, Symbol};
use crate::ast::{self, Cond, StmtKind as Ast};
use crate::lexer::At;
use crate::tree::{Case, Expr, Interpolation, Loop, Number, Place, Stage, Stmt, StmtKind};
use crate::types::{INT, Type, UINT};

impl<'a> Checker<'a> {
    /// Statements of one scope. Those with errors are left out.
    pub(super) fn statements(&mut self, list: &'a [ast::Stmt<'a>]) -> Vec<Stmt> {
        let mut checked = Vec::with_capacity(list.len());
        for statement in list {
            let _: Res<()> = self.statement(statement, &mut checked);
        }
        checked
    }

    fn scoped_statements(&mut self, list: &'a [ast::Stmt<'a>]) -> Vec<Stmt> {
        self.scoped(|checker| checker.statements(list))
    }

    /// The body of a loop whose header may declare. Its braces make no further scope, so a name of
    /// the header is not declared in them again.
    fn header_body(&mut self, statement: &'a ast::Stmt<'a>) -> Vec<Stmt> {
        match &statement.kind {
            Ast::Block(list) => self.statements(list),
            _ => self.body(statement),
        }
    }

    /// A statement that has a scope of its own even without braces.
    fn body(&mut self, statement: &'a ast::Stmt<'a>) -> Vec<Stmt> {
        match &statement.kind {
            Ast::Block(list) => self.scoped_statements(list),
            _ => self.scoped_statements(std::slice::from_ref(statement)),
        }
    }

    fn statement(&mut self, statement: &'a ast::Stmt<'a>, out: &mut Vec<Stmt>) -> Res<()> {
        let at = statement.at;
        let kind = match &statement.kind {
            Ast::Nothing => return Ok(()),
            Ast::Item(item) => return self.local_item(item, at, out),
            Ast::Expr(expr) => StmtKind::Expr(self.expr(expr)?),
            Ast::Block(list) => StmtKind::Block(self.scoped_statements(list)),
            Ast::If(condition, yes, no) => {
                let condition = self.bool_expr(condition);
                let yes = self.body(yes);
                let no = no.as_ref().map_or(Vec::new(), |no| self.body(no));
                StmtKind::If(condition?, yes, no)
            }
            Ast::Switch(selector, list) => self.switch(selector, list, at)?,
            Ast::Case(_) => return self.fail(at, "a label belongs into a `switch`"),
            Ast::While(condition, body) => {
                self.scoped(|checker| checker.while_loop(condition, body))?
            }
            Ast::Do(body, condition) => {
                self.loops += 1;
                let body = self.body(body);
                self.loops -= 1;
                let condition = Some(self.bool_expr(condition)?);
                let (first, step) = (Vec::new(), None);
                StmtKind::Loop(Box::new(Loop {
                    first,
                    declared: None,
                    condition,
                    last: true,
                    step,
                    body,
                }))
            }
            Ast::For(first, condition, step, body) => self.scoped(|checker| {
                checker.for_loop(first, condition.as_ref(), step.as_ref(), body)
            })?,
            Ast::Return(value) => self.return_value(value.as_ref(), at)?,
            Ast::Break if self.loops + self.switches > 0 => StmtKind::Break,
            Ast::Break => return self.fail(at, "`break` belongs into a loop or a `switch`"),
            Ast::Continue if self.loops > 0 => StmtKind::Continue,
            Ast::Continue => return self.fail(at, "`continue` belongs into a loop"),
            Ast::Discard if self.shader.stage == Stage::Fragment => {
                (self.effects, self.discards) = (true, true);
                StmtKind::Discard
            }
            Ast::Discard => return self.fail(at, "`discard` belongs into a fragment shader"),
        };
        out.push(Stmt { kind, at });
        Ok(())
    }

    fn return_value(&mut self, value: Option<&'a ast::Expr<'a>>, at: At) -> Res<StmtKind> {
        let ret = match self.function {
            Some(function) => self.shader.functions[function as usize].ret.clone(),
            None => Type::Void,
        };
        let Some(value) = value else {
            if ret != Type::Void {
                return self.fail(at, "the function returns a value, and this gives none");
            }
            return Ok(StmtKind::Return(None));
        };
        if ret == Type::Void {
            return self.fail(at, "the function returns no value");
        }
        let value = self.value(value)?;
        Ok(StmtKind::Return(Some(self.convert_to(value, &ret, "the result")?)))
    }

    fn while_loop(&mut self, condition: &'a Cond<'a>, body: &'a ast::Stmt<'a>) -> Res<StmtKind> {
        let (declared, condition) = self.condition(condition)?;
        self.loops += 1;
        let body = self.header_body(body);
        self.loops -= 1;
        Ok(StmtKind::Loop(Box::new(Loop {
            first: Vec::new(),
            declared,
            condition: Some(condition),
            last: false,
            step: None,
            body,
        })))
    }

    fn for_loop(
        &mut self,
        first: &'a ast::Stmt<'a>,
        condition: Option<&'a Cond<'a>>,
        step: Option<&'a ast::Expr<'a>>,
        body: &'a ast::Stmt<'a>,
    ) -> Res<StmtKind> {
        let mut before = Vec::new();
        self.statement(first, &mut before)?;
        let (declared, condition) = match condition {
            Some(condition) => {
                let (declared, condition) = self.condition(condition)?;
                (declared, Some(condition))
            }
            None => (None, None),
        };
        let step = match step {
            Some(step) => Some(self.expr(step)?),
            None => None,
        };
        self.loops += 1;
        let body = self.header_body(body);
        self.loops -= 1;
        let first = before;
        Ok(StmtKind::Loop(Box::new(Loop { first, declared, condition, last: false, step, body })))
    }

    fn condition(&mut self, condition: &'a Cond<'a>) -> Res<(Option<u32>, Expr)> {
        match condition {
            Cond::Expr(expr) => Ok((None, self.bool_expr(expr)?)),
            Cond::Declared(vars) => {
                let mut out = Vec::new();
                self.local_vars(vars, &mut out)?;
                let Some(Stmt { kind: StmtKind::Declare(index), at }) = out.into_iter().next()
                else {
                    return Err(super::Failed);
                };
                let value = self.var_expr(index, at);
                if value.ty != crate::types::BOOL {
                    return self.fail(at, "a condition is `bool`");
                }
                Ok((Some(index), value))
            }
        }
    }

    fn switch(
        &mut self,
        selector: &'a ast::Expr<'a>,
        list: &'a [ast::Stmt<'a>],
        at: At,
    ) -> Res<StmtKind> {
        let selector = self.value(selector)?;
        if selector.ty != INT && selector.ty != UINT {
            let name = self.type_name(&selector.ty);
            return self.fail(selector.at, format!("`switch` does not take `{name}`"));
        }
        self.switches += 1;
        let cases = self.scoped(|checker| checker.cases(list, &selector, at));
        self.switches -= 1;
        Ok(StmtKind::Switch(selector, cases?))
    }

    fn cases(&mut self, list: &'a [ast::Stmt<'a>], selector: &Expr, at: At) -> Res<Vec<Case>> {
        let mut cases: Vec<Case> = Vec::new();
        let mut seen: Vec<Option<i64>> = Vec::new();
        for statement in list {
            if let Ast::Case(value) = &statement.kind {
                let label = match value {
                    Some(value) => Some(self.label(value, &selector.ty)?),
                    None => None,
                };
                let key = label.map(as_key);
                if seen.contains(&key) {
                    return self.fail(statement.at, "this label stands twice in the `switch`");
                }
                seen.push(key);
                match cases.last_mut() {
                    Some(case) if case.body.is_empty() => case.labels.push(label),
                    _ => cases.push(Case { labels: vec![label], body: Vec::new() }),
                }
                continue;
            }
            let mut body = Vec::new();
            self.statement(statement, &mut body)?;
            match cases.last_mut() {
                Some(case) => case.body.extend(body),
                None => return self.fail(at, "a `switch` begins with a label"),
            }
        }
        match (cases.last(), list.last()) {
            (Some(case), Some(last))
                if case.body.is_empty() && matches!(last.kind, Ast::Case(_)) =>
            {
                self.fail(last.at, "a label has statements after it")
            }
            _ => Ok(cases),
        }
    }

    fn label(&mut self, value: &'a ast::Expr<'a>, ty: &Type) -> Res<Number> {
        let number = self.constant_int(value, "a label")?;
        Ok(match ty.scalar() {
            Some(scalar) => number.to(scalar),
            None => number,
        })
    }

    fn local_item(&mut self, item: &'a ast::Item<'a>, at: At, out: &mut Vec<Stmt>) -> Res<()> {
        match item {
            ast::Item::Vars(vars) => self.local_vars(vars, out),
            ast::Item::Nothing => Ok(()),
            ast::Item::Function(_) => self.fail(at, "a function is not declared in a function"),
            ast::Item::Block(_) | ast::Item::Quals(..) => {
                self.fail(at, "this is not declared in a function")
            }
        }
    }

    fn local_vars(&mut self, vars: &'a ast::Vars<'a>, out: &mut Vec<Stmt>) -> Res<()> {
        let read = self.each_local_var(vars, out);
        if read.is_err() {
            self.forget_names(vars);
        }
        read
    }

    fn each_local_var(&mut self, vars: &'a ast::Vars<'a>, out: &mut Vec<Stmt>) -> Res<()> {
        let quals = self.quals(&vars.quals)?;
        let base = self.spec_type(&vars.ty, NO_SIZES)?;
        let place = match quals.storage {
            None => Place::Local,
            Some(Storage::Const) => Place::Const,
            Some(_) => return self.fail(vars.ty.at, "a variable of a function has no such word"),
        };
        let Interpolation { flat, linear, centroid, sample, invariant: _ } = quals.interpolation;
        if flat || linear || centroid || sample {
            return self.fail(vars.ty.at, "a variable of a function has no such word");
        }
        for declarator in &vars.names {
            let name = declarator.name;
            let ty = self.after_name(base.clone(), &declarator.sizes)?;
            if ty == Type::Void || self.shader.has_opaque(&ty) {
                let found = self.type_name(&ty);
                return self.fail(name.at, format!("a variable of a function is not `{found}`"));
            }
            let init = match &declarator.init {
                Some(init) => match self.initializer(init, &ty) {
                    Ok(init) => Some(init),
                    Err(failed) => {
                        let index = self.new_var(name.text, ty, Place::Local, name.at);
                        self.declare(name, Symbol::Var(index))?;
                        return Err(failed);
                    }
                },
                None if place == Place::Const => {
                    return self
                        .fail(name.at, format!("the constant `{}` has no value", name.text));
                }
                None => None,
            };
            let ty = init.as_ref().map_or(ty, |init| init.ty.clone());
            let index = self.new_var(name.text, ty, place, name.at);
            let var = self.var_mut(index);
            if place == Place::Const {
                var.known = init.as_ref().and_then(|init| init.known.clone());
            }
            var.init = init;
            self.declare(name, Symbol::Var(index))?;
            out.push(Stmt { kind: StmtKind::Declare(index), at: vars.ty.at.to(name.at) });
        }
        Ok(())
    }
}

fn as_key(number: Number) -> i64 {
    match number {
        Number::Int(value) => i64::from(value),
        Number::Uint(value) => i64::from(value),
        Number::Bool(_) | Number::Float(_) => 0,
    }
}

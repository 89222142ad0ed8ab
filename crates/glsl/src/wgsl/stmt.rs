//! Functions and statements.

use super::globals::OpaqueNames;
use super::output::Lines;
use super::{Line, Writer, names};
use crate::builtin::functions::BARRIERS;
use crate::lexer::At;
use crate::tree::{Dir, Expr, ExprKind, Place, Stmt, StmtKind};
use crate::types::{OpaqueKind, Type};

impl Writer<'_> {
    pub(super) fn function(&mut self, index: u32) {
        let shader = self.shader;
        let function = &shader.functions[index as usize];
        let Some(body) = &function.body else { return };
        self.flush_comments(function.at.start);
        self.function = Some(index);
        self.copied.clear();
        self.temporaries = 0;
        let is_main = function.name == "main";
        self.scoped(|writer| {
            let head = if is_main { writer.entry_head() } else { writer.head(index) };
            for line in head.lines() {
                writer.line(function.at, line.to_owned());
            }
            let ((), lines) = writer.capture(|writer| {
                if is_main {
                    writer.entry_start();
                } else {
                    writer.copy_params(index);
                }
                writer.statements(body);
                writer.end_function(index, body);
            });
            writer.lines.nest(lines);
            writer.line(function.at, "}");
        });
        self.function = None;
    }

    fn end_function(&mut self, index: u32, body: &[Stmt]) {
        let function = &self.shader.functions[index as usize];
        if !falls_through(body) {
            return;
        }
        if function.name == "main" {
            if self.entry_returns() {
                self.entry_return(function.at);
            }
        } else if function.ret != Type::Void {
            let ty = self.type_text(&function.ret);
            self.line(function.at, format!("return {ty}();"));
        }
    }

    fn head(&mut self, index: u32) -> String {
        let shader = self.shader;
        let function = &shader.functions[index as usize];
        let mut params = Vec::with_capacity(function.params.len());
        for param in &function.params {
            let text = self.param(*param);
            params.push(text);
        }
        let result = match &function.ret {
            Type::Void => String::new(),
            ty => format!(" -> {}", self.type_text(ty)),
        };
        let name = &self.function_names[index as usize];
        format!("fn {name}({}){result} {{", params.join(", "))
    }

    fn param(&mut self, index: u32) -> String {
        let var = self.var(index);
        if let Type::Opaque(opaque) = &var.ty {
            return self.opaque_param(index, opaque);
        }
        let ty = self.type_text(&var.ty);
        match var.place {
            Place::Param(Dir::Out | Dir::InOut) => {
                let name = self.name_local(index);
                format!("{name}: ptr<function, {ty}>")
            }
            _ if var.written || var.indexed => {
                let name = self.local_name(&var.name);
                let text = format!("{name}: {ty}");
                self.copied.insert(index, name);
                text
            }
            _ => {
                let name = self.name_local(index);
                format!("{name}: {ty}")
            }
        }
    }

    fn opaque_param(&mut self, index: u32, opaque: &crate::types::Opaque) -> String {
        let name = self.name_local(index);
        let is_depth = self.compared.textures.contains(&index);
        let ty = match opaque.kind {
            OpaqueKind::Sampler if opaque.shadow || self.compared.samplers.contains(&index) => {
                Some("sampler_comparison".to_owned())
            }
            OpaqueKind::Sampler => Some("sampler".to_owned()),
            OpaqueKind::Image | OpaqueKind::Other | OpaqueKind::Subpass => None,
            _ => names::texture_type(opaque, opaque.shadow || is_depth),
        };
        let Some(ty) = ty else {
            let at = self.var(index).at;
            self.refuse(at, format!("`{}` is no parameter in WGSL", opaque.glsl_name()));
            return String::new();
        };
        let depth = is_depth && opaque.kind == OpaqueKind::Texture;
        let mut kept = OpaqueNames { texture: name.clone(), sampler: None, depth };
        let mut text = format!("{name}: {ty}");
        if opaque.kind == OpaqueKind::Combined && !opaque.multisampled {
            let sampler = self.local_name(&format!("{name}_sampler"));
            let ty = if opaque.shadow { "sampler_comparison" } else { "sampler" };
            text.push_str(&format!(", {sampler}: {ty}"));
            kept.sampler = Some(sampler);
        }
        self.opaque.insert((index, Vec::new()), kept);
        text
    }

    /// Parameters that the body writes become variables.
    fn copy_params(&mut self, index: u32) {
        let shader = self.shader;
        for param in &shader.functions[index as usize].params {
            if let Some(from) = self.copied.get(param).cloned() {
                let name = self.name_local(*param);
                self.line(self.var(*param).at, format!("var {name} = {from};"));
            }
        }
    }

    /// Statements of a block, up to the first that nothing follows.
    pub(super) fn statements(&mut self, list: &[Stmt]) {
        for (at, statement) in list.iter().enumerate() {
            if !is_beside_barrier(list, at) {
                self.statement(statement);
            }
            if !falls_through(std::slice::from_ref(statement)) {
                return;
            }
        }
    }

    /// A block as lines with a scope of their own.
    pub(super) fn block_lines(&mut self, list: &[Stmt]) -> Lines {
        let ((), lines) = self.capture(|writer| writer.scoped(|writer| writer.statements(list)));
        lines
    }

    fn statement(&mut self, statement: &Stmt) {
        let at = statement.at;
        self.flush_comments(at.start);
        match &statement.kind {
            StmtKind::Declare(index) => self.declare(*index, at),
            StmtKind::Expr(expr) => self.effect(expr),
            StmtKind::Block(list) => {
                let lines = self.block_lines(list);
                self.line(at, "{");
                self.lines.nest(lines);
                self.line(at, "}");
            }
            StmtKind::If(condition, yes, no) => self.if_statement(at, (condition, yes, no)),
            StmtKind::Switch(selector, cases) => self.switch(selector, cases, at),
            StmtKind::Loop(content) => self.scoped(|writer| writer.loop_statement(content, at)),
            StmtKind::Return(value) => self.return_statement(value.as_ref(), at),
            StmtKind::Break => self.line(at, "break;"),
            StmtKind::Continue => self.line(at, "continue;"),
            StmtKind::Discard => self.discard(at),
        }
    }

    fn if_statement(
        &mut self,
        at: At,
        (condition, yes, no): (&crate::tree::Expr, &[Stmt], &[Stmt]),
    ) {
        let value = self.value(condition);
        self.line(at, format!("if {} {{", value.text));
        let lines = self.block_lines(yes);
        self.lines.nest(lines);
        if no.is_empty() {
            self.line(at, "}");
            return;
        }
        if let [Stmt { kind: StmtKind::If(condition, yes, no), at: inner }] = no {
            let (_, before) = self.capture(|writer| {
                let temporaries = writer.temporaries;
                let _ = writer.value(condition);
                writer.temporaries = temporaries;
            });
            if before.is_empty() {
                let ((), chain) =
                    self.capture(|writer| writer.if_statement(*inner, (condition, yes, no)));
                self.chain(at, chain);
                return;
            }
        }
        self.line(at, "} else {");
        let lines = self.block_lines(no);
        self.lines.nest(lines);
        self.line(at, "}");
    }

    /// `} else if ... {`
    fn chain(&mut self, at: At, lines: Lines) {
        self.lines.extend(lines.prefixed("} else ", at));
    }

    fn return_statement(&mut self, value: Option<&crate::tree::Expr>, at: At) {
        let is_main =
            self.function.is_some_and(|index| self.shader.functions[index as usize].name == "main");
        match value {
            Some(value) => {
                let value = self.value(value);
                self.line(at, format!("return {};", value.text));
            }
            None if is_main => self.entry_return(at),
            None => self.line(at, "return;"),
        }
    }

    /// WGSL goes on after `discard`, so the function is left.
    fn discard(&mut self, at: At) {
        if let Some(name) = &self.discarded {
            let text = format!("{name} = true;");
            self.line(at, text);
        }
        self.line(at, "discard;");
        self.leave(at);
    }

    /// The body of a loop. After a `discard` in a function, what a loop waits for may never come,
    /// so each round asks for it.
    pub(super) fn loop_body(&mut self, body: &[Stmt], at: At) -> Lines {
        let ((), mut lines) = self.capture(|writer| {
            let Some(name) = writer.discarded.clone() else { return };
            writer.line(at, format!("if {name} {{"));
            let ((), inner) = writer.capture(|writer| writer.leave(at));
            writer.lines.nest(inner);
            writer.line(at, "}");
        });
        lines.extend(self.block_lines(body));
        lines
    }

    /// Ends the function, with any result.
    fn leave(&mut self, at: At) {
        let Some(function) = self.function else { return };
        let function = &self.shader.functions[function as usize];
        if function.name == "main" {
            self.entry_return(at);
        } else if function.ret == Type::Void {
            self.line(at, "return;");
        } else {
            let ty = self.type_text(&function.ret);
            self.line(at, format!("return {ty}();"));
        }
    }

    /// A variable of a function.
    pub(super) fn declare(&mut self, index: u32, at: At) {
        let var = self.var(index);
        let value = var.init.as_ref().map(|init| self.value(init));
        if self.hoisted.contains(&index) {
            let name = self.var_name(index);
            if let Some(value) = value {
                self.line(at, format!("{name} = {};", value.text));
            }
            return;
        }
        let name = self.name_local(index);
        let ty = self.type_text(&var.ty);
        let fixed = !var.written && !var.indexed;
        let text = match value {
            Some(value) if fixed => format!("let {name}: {ty} = {};", value.text),
            Some(value) => format!("var {name}: {ty} = {};", value.text),
            None => format!("var {name}: {ty};"),
        };
        self.line(at, text);
    }
}

impl Lines {
    /// The same lines, the first of them behind a text.
    fn prefixed(self, text: &str, at: At) -> Self {
        let mut out = Self::default();
        for (index, line) in self.into_iter().enumerate() {
            if index == 0 {
                out.push(Line::new(format!("{text}{}", line.text()), at));
            } else {
                out.push(line);
            }
        }
        out
    }
}

/// Whether a statement is a barrier for memory beside `barrier()`, which is one for all memory.
fn is_beside_barrier(list: &[Stmt], at: usize) -> bool {
    let of_memory =
        |statement: &&Stmt| barrier_name(statement).is_some_and(|name| name != "barrier");
    if !of_memory(&&list[at]) {
        return false;
    }
    let before = list[..at].iter().rev().find(|statement| !of_memory(statement));
    let after = list[at..].iter().find(|statement| !of_memory(statement));
    [before, after].into_iter().flatten().any(|other| barrier_name(other) == Some("barrier"))
}

fn barrier_name(statement: &Stmt) -> Option<&'static str> {
    match &statement.kind {
        StmtKind::Expr(Expr { kind: ExprKind::Builtin(name, _), .. }) => {
            BARRIERS.contains(name).then_some(*name)
        }
        _ => None,
    }
}

/// Whether what follows statements may be reached.
pub(super) fn falls_through(list: &[Stmt]) -> bool {
    !list.iter().any(|statement| match &statement.kind {
        StmtKind::Return(_) | StmtKind::Break | StmtKind::Continue | StmtKind::Discard => true,
        StmtKind::Block(list) => !falls_through(list),
        StmtKind::If(_, yes, no) => !falls_through(yes) && !falls_through(no),
        _ => false,
    })
}

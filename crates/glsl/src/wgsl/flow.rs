//! Loops and switches.

use rustc_hash::FxHashSet;

use super::Writer;
use super::output::Lines;
use super::stmt::falls_through;
use super::value::{Strength, Value};
use crate::lexer::At;
use crate::tree::{Case, Expr, ExprKind, Loop, Number, Shader, Stmt, StmtKind};

impl Writer<'_> {
    pub(super) fn loop_statement(&mut self, content: &Loop, at: At) {
        let ((), first) = self.capture(|writer| writer.statements(&content.first));
        let (declared, (condition, before)) = match content.declared {
            Some(index) => {
                let ((), lines) = self.capture(|writer| writer.declare(index, at));
                (true, (Some(Value::primary(self.var_name(index), false)), lines))
            }
            None => (
                false,
                self.capture(|writer| {
                    content.condition.as_ref().map(|condition| writer.value(condition))
                }),
            ),
        };
        let ((), step) = self.capture(|writer| {
            if let Some(step) = &content.step {
                writer.effect(step);
            }
        });
        let body = self.loop_body(&content.body, at);
        if content.last {
            self.do_loop(condition, before, body, at);
            return;
        }
        let one_line = |lines: &Lines| lines.is_empty() || lines.single().is_some();
        let plain = !declared && before.is_empty() && one_line(&first) && one_line(&step);
        if plain && !self.starts_value(&step) {
            self.plain_loop(&first, condition, &step, body, at);
            return;
        }
        if first.is_empty() {
            self.full_loop(condition, before, step, body, at);
            return;
        }
        self.line(at, "{");
        let ((), inner) = self.capture(|writer| {
            writer.lines.extend(first);
            writer.full_loop(condition, before, step, body, at);
        });
        self.lines.nest(inner);
        self.line(at, "}");
    }

    /// Whether a line declares something, which a `for` does not take as its step.
    fn starts_value(&self, lines: &Lines) -> bool {
        lines.single().is_some_and(|line| {
            ["let ", "var ", "if ", "_ = "].iter().any(|word| line.starts_with(word))
        })
    }

    fn plain_loop(
        &mut self,
        first: &Lines,
        condition: Option<Value>,
        step: &Lines,
        body: Lines,
        at: At,
    ) {
        let bare =
            |lines: &Lines| lines.single().unwrap_or_default().trim_end_matches(';').to_owned();
        let test = condition.map(|value| value.text);
        let head = match (first.is_empty() && step.is_empty(), test) {
            (true, Some(test)) => format!("while {test} {{"),
            (true, None) => "loop {".to_owned(),
            (false, test) => {
                let test = test.map(|text| format!(" {text}")).unwrap_or_default();
                let step = bare(step);
                let step = if step.is_empty() { step } else { format!(" {step}") };
                format!("for ({};{test};{step}) {{", bare(first))
            }
        };
        self.line(at, head);
        self.lines.nest(body);
        self.line(at, "}");
    }

    /// A loop whose condition or step needs statements.
    fn full_loop(
        &mut self,
        condition: Option<Value>,
        before: Lines,
        step: Lines,
        body: Lines,
        at: At,
    ) {
        self.line(at, "loop {");
        let ((), inner) = self.capture(|writer| {
            writer.lines.extend(before);
            if let Some(condition) = condition {
                let text = condition.at_least(Strength::Unary);
                writer.line(at, format!("if !{text} {{ break; }}"));
            }
            writer.line(at, "{");
            writer.lines.nest(body);
            writer.line(at, "}");
            if !step.is_empty() {
                writer.line(at, "continuing {");
                writer.lines.nest(step);
                writer.line(at, "}");
            }
        });
        self.lines.nest(inner);
        self.line(at, "}");
    }

    fn do_loop(&mut self, condition: Option<Value>, before: Lines, body: Lines, at: At) {
        self.line(at, "loop {");
        let ((), inner) = self.capture(|writer| {
            writer.line(at, "{");
            writer.lines.nest(body);
            writer.line(at, "}");
            writer.line(at, "continuing {");
            let ((), last) = writer.capture(|writer| {
                writer.lines.extend(before);
                if let Some(condition) = condition {
                    let text = condition.at_least(Strength::Unary);
                    writer.line(at, format!("break if !{text};"));
                }
            });
            writer.lines.nest(last);
            writer.line(at, "}");
        });
        self.lines.nest(inner);
        self.line(at, "}");
    }

    /// A `switch`. Cases that fall through share one clause of WGSL, in which each body asks
    /// whether the selector came in before it.
    pub(super) fn switch(&mut self, selector: &Expr, cases: &[Case], at: At) {
        self.hoist_shared(cases);
        let mut value = self.value(selector);
        let groups = grouped(cases);
        if groups.iter().any(|group| group.len() > 1) {
            let name = self.temporary();
            self.line(at, format!("let {name} = {};", value.text));
            value = Value::primary(name, true);
        }
        self.line(at, format!("switch {} {{", value.text));
        let ((), inner) = self.capture(|writer| {
            let mut has_default = false;
            for group in &groups {
                has_default |= group.iter().any(|case| case.labels.contains(&None));
                writer.clause(group, cases, &value.text, at);
            }
            if !has_default {
                writer.line(at, "default: {}");
            }
        });
        self.lines.nest(inner);
        self.line(at, "}");
    }

    fn clause(&mut self, group: &[&Case], all: &[Case], selector: &str, at: At) {
        let labels: Vec<Option<Number>> =
            group.iter().flat_map(|case| case.labels.iter().copied()).collect();
        let texts: Vec<String> = labels.iter().map(|label| self.label(*label)).collect();
        let head = match texts.as_slice() {
            [only] if only == "default" => "default: {".to_owned(),
            _ => format!("case {}: {{", texts.join(", ")),
        };
        self.line(at, head);
        let ((), body) = self.capture(|writer| {
            let last = group.len() - 1;
            let mut entered: Vec<Option<Number>> = Vec::new();
            for (index, case) in group.iter().enumerate() {
                entered.extend(&case.labels);
                let statements = without_break(&case.body);
                let lines = writer.block_lines(statements);
                if index == last {
                    writer.lines.extend(lines);
                    continue;
                }
                let condition = writer.entry_condition(&entered, all, selector);
                writer.line(at, format!("if {condition} {{"));
                writer.lines.nest(lines);
                writer.line(at, "}");
            }
        });
        self.lines.nest(body);
        self.line(at, "}");
    }

    fn label(&mut self, label: Option<Number>) -> String {
        match label {
            Some(number) => self.number(number).text,
            None => "default".to_owned(),
        }
    }

    /// Whether the selector is one of some labels; `default` is whatever is no label at all.
    fn entry_condition(
        &mut self,
        entered: &[Option<Number>],
        all: &[Case],
        selector: &str,
    ) -> String {
        let has_default = entered.contains(&None);
        let mut parts = Vec::new();
        if has_default {
            for label in all.iter().flat_map(|case| &case.labels) {
                if let Some(number) = label
                    && !entered.contains(&Some(*number))
                {
                    let text = self.number(*number).text;
                    parts.push(format!("{selector} != {text}"));
                }
            }
            return if parts.is_empty() { "true".to_owned() } else { parts.join(" && ") };
        }
        for number in entered.iter().flatten() {
            let text = self.number(*number).text;
            parts.push(format!("{selector} == {text}"));
        }
        parts.join(" || ")
    }

    /// Variables that one case declares and another one uses are declared before the `switch`.
    fn hoist_shared(&mut self, cases: &[Case]) {
        let shader = self.shader;
        for (number, case) in cases.iter().enumerate() {
            let declared: FxHashSet<u32> = case
                .body
                .iter()
                .filter_map(|statement| match statement.kind {
                    StmtKind::Declare(index) => Some(index),
                    _ => None,
                })
                .collect();
            let mut shared = FxHashSet::default();
            for other in &cases[number + 1..] {
                each_expr(&other.body, shader, &mut |expr| {
                    if let ExprKind::Var(index) = expr.kind
                        && declared.contains(&index)
                    {
                        shared.insert(index);
                    }
                });
            }
            let mut shared: Vec<u32> = shared.into_iter().collect();
            shared.sort_unstable();
            for index in shared {
                let name = self.name_local(index);
                let var = self.var(index);
                let ty = self.type_text(&var.ty);
                self.line(var.at, format!("var {name}: {ty};"));
                self.hoisted.insert(index);
            }
        }
    }
}

/// Cases by clauses: those that fall through are with the next one.
fn grouped(cases: &[Case]) -> Vec<Vec<&Case>> {
    let mut groups: Vec<Vec<&Case>> = Vec::new();
    let mut open = false;
    for case in cases {
        match groups.last_mut() {
            Some(group) if open => group.push(case),
            _ => groups.push(vec![case]),
        }
        open = falls_through(&case.body);
    }
    groups
}

/// Statements without the `break` at their end, which WGSL does not need.
fn without_break(list: &[Stmt]) -> &[Stmt] {
    match list.split_last() {
        Some((Stmt { kind: StmtKind::Break, .. }, rest)) => rest,
        _ => list,
    }
}

/// Calls a function with every expression of statements.
pub(super) fn each_expr<'e>(list: &'e [Stmt], shader: &'e Shader, visit: &mut dyn FnMut(&'e Expr)) {
    for statement in list {
        match &statement.kind {
            StmtKind::Declare(index) => {
                if let Some(init) = &shader.vars[*index as usize].init {
                    init.each_part(visit);
                }
            }
            StmtKind::Expr(expr) | StmtKind::Return(Some(expr)) => expr.each_part(visit),
            StmtKind::Block(list) => each_expr(list, shader, visit),
            StmtKind::If(condition, yes, no) => {
                condition.each_part(visit);
                each_expr(yes, shader, visit);
                each_expr(no, shader, visit);
            }
            StmtKind::Switch(selector, cases) => {
                selector.each_part(visit);
                cases.iter().for_each(|case| each_expr(&case.body, shader, visit));
            }
            StmtKind::Loop(content) => {
                each_expr(&content.first, shader, visit);
                let declared =
                    content.declared.and_then(|at| shader.vars[at as usize].init.as_ref());
                let parts = [declared, content.condition.as_ref(), content.step.as_ref()];
                parts.into_iter().flatten().for_each(|part| part.each_part(visit));
                each_expr(&content.body, shader, visit);
            }
            StmtKind::Return(None) | StmtKind::Break | StmtKind::Continue | StmtKind::Discard => {}
        }
    }
}

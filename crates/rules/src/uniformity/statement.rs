//! Statements: control flow after them, and the values of variables there.

use super::graph::{NodeId, Role};
use super::{Exit, Local, Root, Walk};
use crate::behaviour::{Behaviour, of_block};
use crate::syntax::{
    Block, Clause, Declaration, DeclarationKind, ExprId, ForLoop, Statement, StatementKind,
};

impl<'t> Walk<'_, 't> {
    pub fn block(&mut self, flow: NodeId, block: &Block<'t>) -> NodeId {
        let names = self.locals.len();
        let after = self.block_open(flow, block);
        self.leave(names);
        after
    }

    /// A block whose names stay: a loop's body, whose `continuing` block sees them.
    fn block_open(&mut self, mut flow: NodeId, block: &Block<'t>) -> NodeId {
        self.filtered(&block.filters, |walk| {
            for statement in &block.statements {
                flow = walk.statement(flow, statement);
                if !statement.behaviour.has(Behaviour::NEXT) {
                    break;
                }
            }
            flow
        })
    }

    fn leave(&mut self, names: usize) {
        self.locals.truncate(names);
    }

    fn statement(&mut self, flow: NodeId, statement: &Statement<'t>) -> NodeId {
        self.filtered(&statement.filters, |walk| walk.kind(flow, statement))
    }

    fn kind(&mut self, flow: NodeId, statement: &Statement<'t>) -> NodeId {
        match &statement.kind {
            StatementKind::Empty | StatementKind::Discard | StatementKind::Assert => flow,
            StatementKind::Block(block) => self.block(flow, block),
            StatementKind::If { condition, accept, reject } => {
                self.conditional(flow, statement, *condition, (accept, reject.as_deref()))
            }
            StatementKind::Switch { selector, filters, clauses } => {
                self.switch(flow, statement, *selector, (filters, clauses))
            }
            StatementKind::Loop { body, continuing } => {
                self.endless_loop(flow, statement, body, continuing.as_ref())
            }
            StatementKind::For(parts) => {
                let names = self.locals.len();
                let after = self.for_loop(flow, statement, parts);
                self.leave(names);
                after
            }
            StatementKind::While { condition, body } => {
                self.conditional_loop(flow, statement, (Some(*condition), None), body)
            }
            StatementKind::Declare(declaration) => self.declare(flow, declaration),
            StatementKind::Assign { target, operator, value } => {
                self.assign(flow, *target, operator, Some(*value))
            }
            StatementKind::Count { target } => self.assign(flow, Some(*target), "+=", None),
            StatementKind::Call(call) => self.value(flow, *call).0,
            StatementKind::Return(value) => self.leave_function(flow, *value),
            StatementKind::Break => {
                self.exit(false);
                flow
            }
            StatementKind::Continue => {
                self.exit(true);
                flow
            }
            StatementKind::BreakIf(condition) => {
                let (_, value) = self.value(flow, *condition);
                let end = self.condition(*condition, value);
                self.exit(false);
                end
            }
        }
    }

    /// Control flow that depends on a condition.
    fn condition(&mut self, condition: ExprId, value: NodeId) -> NodeId {
        let node = self.graph.marked(self.module.tree.place(condition), Role::Condition);
        self.graph.edge(node, value);
        node
    }

    fn leave_function(&mut self, flow: NodeId, value: Option<ExprId>) -> NodeId {
        let flow = match value {
            Some(value) => {
                let (after, value) = self.value(flow, value);
                self.graph.edge(self.result, value);
                after
            }
            None => flow,
        };
        self.output_contents();
        flow
    }

    /// Takes the contents of pointer parameters out of the function.
    pub fn output_contents(&mut self) {
        for at in 0..self.pointers.len() {
            let (_, slot) = self.pointers[at];
            self.graph.edge(self.outputs[at], self.values[slot]);
        }
    }

    fn declare(&mut self, flow: NodeId, declaration: &Declaration<'t>) -> NodeId {
        let name = declaration.name;
        let Some(value) = declaration.value else {
            self.declare_variable(name, flow);
            return flow;
        };
        match declaration.kind {
            DeclarationKind::Const | DeclarationKind::Override => {
                self.locals.push((name, Local::Constant));
                flow
            }
            DeclarationKind::Let => match self.view(flow, value) {
                Ok((after, view)) if view.is_pointer => {
                    self.locals.push((name, Local::Pointer(view)));
                    after
                }
                Ok((after, view)) => {
                    let value = self.loaded_value(flow, value, view);
                    self.locals.push((name, Local::Value(value)));
                    after
                }
                Err((after, value)) => {
                    self.locals.push((name, Local::Value(value)));
                    after
                }
            },
            DeclarationKind::Var => {
                let (after, value) = self.value(flow, value);
                self.declare_variable(name, value);
                after
            }
        }
    }

    /// An assignment. Without a value, it counts.
    fn assign(
        &mut self,
        flow: NodeId,
        target: Option<ExprId>,
        operator: &str,
        value: Option<ExprId>,
    ) -> NodeId {
        let Some(target) = target else {
            return value.map_or(flow, |value| self.value(flow, value).0);
        };
        let view = self.view(flow, target);
        let after = match view {
            Ok((after, _)) | Err((after, _)) => after,
        };
        let mut parts = Vec::new();
        if operator != "="
            && let Ok((_, view)) = view
        {
            parts.push(self.loaded_value(flow, target, view));
        }
        let after = match value {
            Some(value) => {
                let (after, value) = self.value(after, value);
                parts.push(value);
                after
            }
            None => after,
        };
        let Ok((_, view)) = view else { return after };
        let Root::Slot(slot) = view.root else { return after };
        let stored = self.graph.marked(self.module.tree.place(target), Role::Value);
        parts.push(view.place);
        if view.is_partial {
            parts.push(self.values[slot]);
        }
        parts.into_iter().for_each(|part| self.graph.edge(stored, part));
        self.values[slot] = stored;
        after
    }

    fn conditional(
        &mut self,
        flow: NodeId,
        statement: &Statement<'t>,
        condition: ExprId,
        (accept, reject): (&Block<'t>, Option<&Statement<'t>>),
    ) -> NodeId {
        let (after, value) = self.value(flow, condition);
        let branch = self.condition(condition, value);
        let before = self.values.clone();
        let first_end = self.block(branch, accept);
        let first = std::mem::replace(&mut self.values, before);
        let first_goes_on = of_block(accept).has(Behaviour::NEXT);
        let (second_end, second_goes_on) = match reject {
            Some(reject) => (self.statement(branch, reject), reject.behaviour.has(Behaviour::NEXT)),
            None => (branch, true),
        };
        self.values.truncate(first.len().min(self.values.len()));
        match (first_goes_on, second_goes_on) {
            (true, true) => self.join_values(&first),
            (true, false) => {
                let count = self.values.len();
                self.values.copy_from_slice(&first[..count]);
            }
            (false, _) => {}
        }
        match statement.behaviour == Behaviour::NEXT {
            true => after,
            false => self.graph.joined(&[first_end, second_end]),
        }
    }

    /// Joins the values of variables with those of another way to the same place.
    fn join_values(&mut self, other: &[NodeId]) {
        for (slot, other) in other.iter().enumerate().take(self.values.len()) {
            if self.values[slot] != *other {
                self.values[slot] = self.graph.joined(&[self.values[slot], *other]);
            }
        }
    }

    /// Leaves the innermost loop or switch, or for `continue` the iteration.
    fn exit(&mut self, continues: bool) {
        let mut exits = self.exits.iter_mut().rev();
        let Some(exit) = exits.find(|exit| !continues || exit.is_loop) else { return };
        let values = if continues { &mut exit.continued } else { &mut exit.values };
        for (value, now) in values.iter_mut().zip(&self.values) {
            let node = *value.get_or_insert_with(|| self.graph.node());
            self.graph.edge(node, *now);
        }
    }

    fn enter(&mut self, is_loop: bool) {
        let slots = self.values.len();
        let empty = vec![None; slots];
        self.exits.push(Exit { is_loop, slots, values: empty.clone(), continued: empty });
    }

    /// Ends a loop or a switch: variables have the values that they left it with.
    fn leave_exit(&mut self) {
        let Some(exit) = self.exits.pop() else { return };
        self.values.truncate(exit.slots);
        for (slot, value) in exit.values.iter().enumerate() {
            if let Some(value) = value {
                self.values[slot] = *value;
            }
        }
    }

    fn switch(
        &mut self,
        flow: NodeId,
        statement: &Statement<'t>,
        selector: ExprId,
        (filters, clauses): (&[crate::syntax::Filter], &[Clause<'t>]),
    ) -> NodeId {
        let (after, value) = self.value(flow, selector);
        let branch = self.condition(selector, value);
        self.enter(false);
        let before = self.values.clone();
        let mut ends = Vec::new();
        self.filtered(filters, |walk| {
            for clause in clauses {
                walk.values.clone_from(&before);
                ends.push(walk.block(branch, &clause.body));
                if of_block(&clause.body).has(Behaviour::NEXT) {
                    walk.exit(false);
                }
            }
        });
        self.values = before;
        self.leave_exit();
        match statement.behaviour == Behaviour::NEXT {
            true => after,
            false => self.graph.joined(&ends),
        }
    }

    /// Gives each variable a node for its value at the start of an iteration.
    fn begin_loop(&mut self) -> Vec<NodeId> {
        self.enter(true);
        for slot in 0..self.values.len() {
            self.values[slot] = self.graph.joined(&[self.values[slot]]);
        }
        self.values.clone()
    }

    /// The values of variables at the end of an iteration are those at the start of the next one.
    fn end_iteration(&mut self, start: &[NodeId]) {
        for (slot, start) in start.iter().enumerate() {
            self.graph.edge(*start, self.values[slot]);
        }
    }

    /// Where the body ended and where it continued, `continuing` goes on.
    fn join_continued(&mut self, body: Behaviour) {
        let Some(exit) = self.exits.last_mut() else { return };
        let continued = std::mem::replace(&mut exit.continued, vec![None; exit.slots]);
        for (slot, value) in continued.into_iter().enumerate() {
            let Some(value) = value else { continue };
            self.values[slot] = match body.has(Behaviour::NEXT) {
                true => self.graph.joined(&[self.values[slot], value]),
                false => value,
            };
        }
    }

    fn endless_loop(
        &mut self,
        flow: NodeId,
        statement: &Statement<'t>,
        body: &Block<'t>,
        continuing: Option<&Block<'t>>,
    ) -> NodeId {
        let names = self.locals.len();
        let iteration = self.graph.joined(&[flow]);
        let start = self.begin_loop();
        let end = self.block_open(iteration, body);
        let behaviour = of_block(body);
        self.join_continued(behaviour);
        let repeats = behaviour.has(Behaviour::NEXT.or(Behaviour::CONTINUE));
        if repeats {
            let end = match continuing {
                Some(continuing) => {
                    self.filtered(&body.filters, |walk| walk.block(end, continuing))
                }
                None => end,
            };
            self.graph.edge(iteration, end);
            self.end_iteration(&start);
        }
        self.leave(names);
        self.leave_exit();
        match (statement.behaviour == Behaviour::NEXT, repeats) {
            (true, _) => flow,
            (false, true) => iteration,
            (false, false) => end,
        }
    }

    fn for_loop(&mut self, flow: NodeId, statement: &Statement<'t>, parts: &ForLoop<'t>) -> NodeId {
        let flow = match &parts.start {
            Some(start) => self.statement(flow, start),
            None => flow,
        };
        let head = (parts.condition, parts.update.as_ref());
        self.conditional_loop(flow, statement, head, &parts.body)
    }

    fn conditional_loop(
        &mut self,
        flow: NodeId,
        statement: &Statement<'t>,
        (condition, update): (Option<ExprId>, Option<&Statement<'t>>),
        body: &Block<'t>,
    ) -> NodeId {
        let iteration = self.graph.joined(&[flow]);
        let start = self.begin_loop();
        let begun = match condition {
            Some(condition) => {
                let (_, value) = self.value(iteration, condition);
                let begun = self.condition(condition, value);
                self.exit(false);
                begun
            }
            None => iteration,
        };
        let end = self.block(begun, body);
        let behaviour = of_block(body);
        self.join_continued(behaviour);
        if behaviour.has(Behaviour::NEXT.or(Behaviour::CONTINUE)) {
            let end = match update {
                Some(update) => self.statement(end, update),
                None => end,
            };
            self.graph.edge(iteration, end);
            self.end_iteration(&start);
        }
        self.leave_exit();
        match statement.behaviour == Behaviour::NEXT {
            true => flow,
            false => iteration,
        }
    }
}

//! Statements: control flow after them, and the values of variables there.

use std::collections::BTreeMap;

use super::graph::{NodeId, Role};
use super::{Exit, Local, Root, Walk};
use crate::Place;
use crate::behaviour::{Behaviour, of_block};
use crate::syntax::{
    Block, Declaration, DeclarationKind, Expr, ExprId, ExprKind, Filter, ForLoop, LocalId,
    Statement, StatementKind,
};

impl<'t> Walk<'_, 't> {
    pub fn block(&mut self, flow: NodeId, block: &Block<'t>) -> NodeId {
        self.scoped(|walk| walk.block_open(flow, block))
    }

    /// A block whose variables stay: a loop's body, whose `continuing` block sees them.
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

    /// Does something whose variables end with it.
    fn scoped<T>(&mut self, go: impl FnOnce(&mut Self) -> T) -> T {
        let outer = self.values.len();
        let result = go(self);
        self.values.truncate(outer);
        result
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
            StatementKind::Switch { selector, filters, values: _, clauses } => {
                self.switch(flow, statement, *selector, (filters, clauses))
            }
            StatementKind::Loop { body, continuing } => {
                self.endless_loop(flow, statement, body, continuing.as_ref())
            }
            StatementKind::For(parts) => self.scoped(|walk| walk.for_loop(flow, statement, parts)),
            StatementKind::While { condition, body } => {
                self.conditional_loop(flow, statement, (Some(*condition), None), body)
            }
            StatementKind::Declare(id, declaration) => self.declare(flow, *id, declaration),
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

    fn declare(&mut self, flow: NodeId, id: LocalId, declaration: &Declaration<'t>) -> NodeId {
        let Some(value) = declaration.value else {
            self.declare_variable(id, flow);
            return flow;
        };
        match declaration.kind {
            DeclarationKind::Const | DeclarationKind::Override => {
                self.locals.insert(id, Local::Constant);
                flow
            }
            DeclarationKind::Let => match self.view(flow, value) {
                Ok((after, view)) if view.is_pointer => {
                    self.locals.insert(id, Local::Pointer(view));
                    after
                }
                Ok((after, view)) => {
                    let value = self.loaded(flow, value, view);
                    self.locals.insert(id, Local::Value(value));
                    after
                }
                Err((after, value)) => {
                    self.locals.insert(id, Local::Value(value));
                    after
                }
            },
            DeclarationKind::Var => {
                let (after, value) = self.value(flow, value);
                self.declare_variable(id, value);
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
            parts.push(self.loaded(flow, target, view));
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
        let slots = self.named_slots(statement.place);
        let before = self.values_of(&slots);
        let first_end = self.block(branch, accept);
        let first = self.values_of(&slots);
        self.set_values(&slots, &before);
        let first_goes_on = of_block(accept).has(Behaviour::NEXT);
        let (second_end, second_goes_on) = match reject {
            Some(reject) => (self.statement(branch, reject), reject.behaviour.has(Behaviour::NEXT)),
            None => (branch, true),
        };
        match (first_goes_on, second_goes_on) {
            (true, true) => self.join_values(&slots, &first),
            (true, false) => self.set_values(&slots, &first),
            (false, _) => {}
        }
        match statement.behaviour == Behaviour::NEXT {
            true => after,
            false => self.graph.joined(&[first_end, second_end]),
        }
    }

    /// The variables in scope that something within a statement names. No other variable changes
    /// there, so that nodes are made for these alone.
    fn named_slots(&self, place: Place) -> Vec<usize> {
        let named = self.module.tree.within(place).filter_map(|one| self.slot_of(local_of(one)?));
        let mut slots: Vec<usize> = named.collect();
        slots.sort_unstable();
        slots.dedup();
        slots
    }

    fn values_of(&self, slots: &[usize]) -> Vec<NodeId> {
        slots.iter().map(|slot| self.values[*slot]).collect()
    }

    fn set_values(&mut self, slots: &[usize], values: &[NodeId]) {
        slots.iter().zip(values).for_each(|(slot, value)| self.values[*slot] = *value);
    }

    /// Joins the values of variables with those of another way to the same place.
    fn join_values(&mut self, slots: &[usize], other: &[NodeId]) {
        for (slot, other) in slots.iter().zip(other) {
            if self.values[*slot] != *other {
                self.values[*slot] = self.graph.joined(&[self.values[*slot], *other]);
            }
        }
    }

    /// Leaves the innermost loop or switch, or for `continue` the iteration.
    fn exit(&mut self, continues: bool) {
        let at = self.exits.iter().rposition(|exit| !continues || exit.is_loop);
        let Some(at) = at else { return };
        let exit = &self.exits[at];
        let of_body = exit.continuing.iter().filter(|_| continues);
        let of_body = of_body.filter_map(|id| self.slot_of(*id)).filter(|slot| *slot >= exit.outer);
        let slots: Vec<usize> = exit.slots.iter().copied().chain(of_body).collect();
        let exit = &mut self.exits[at];
        let values = if continues { &mut exit.continued } else { &mut exit.left };
        for slot in slots {
            let Some(now) = self.values.get(slot) else { continue };
            let node = *values.entry(slot).or_insert_with(|| self.graph.node());
            self.graph.edge(node, *now);
        }
    }

    fn enter(&mut self, is_loop: bool, place: Place, continuing: Option<&Block<'t>>) {
        let tree = self.module.tree;
        let named = continuing.into_iter().flat_map(|block| tree.within(block.place));
        self.exits.push(Exit {
            is_loop,
            outer: self.values.len(),
            slots: self.named_slots(place),
            continuing: named.filter_map(local_of).collect(),
            left: BTreeMap::new(),
            continued: BTreeMap::new(),
        });
    }

    /// Ends a loop or a switch: variables have the values that they left it with.
    fn leave_exit(&mut self) {
        let Some(exit) = self.exits.pop() else { return };
        self.values.truncate(exit.outer);
        exit.left.into_iter().for_each(|(slot, value)| self.values[slot] = value);
    }

    fn switch(
        &mut self,
        flow: NodeId,
        statement: &Statement<'t>,
        selector: ExprId,
        (filters, clauses): (&[Filter], &[Block<'t>]),
    ) -> NodeId {
        let (after, value) = self.value(flow, selector);
        let branch = self.condition(selector, value);
        self.enter(false, statement.place, None);
        let slots = self.named_slots(statement.place);
        let before = self.values_of(&slots);
        let mut ends = Vec::new();
        self.filtered(filters, |walk| {
            for clause in clauses {
                walk.set_values(&slots, &before);
                ends.push(walk.block(branch, clause));
                if of_block(clause).has(Behaviour::NEXT) {
                    walk.exit(false);
                }
            }
        });
        self.set_values(&slots, &before);
        self.leave_exit();
        match statement.behaviour == Behaviour::NEXT {
            true => after,
            false => self.graph.joined(&ends),
        }
    }

    /// Gives each variable that may change a node for its value at the start of an iteration.
    fn begin_loop(&mut self, place: Place, continuing: Option<&Block<'t>>) -> Vec<(usize, NodeId)> {
        self.enter(true, place, continuing);
        let slots = self.named_slots(place);
        let start = |slot: usize| {
            self.values[slot] = self.graph.joined(&[self.values[slot]]);
            (slot, self.values[slot])
        };
        slots.into_iter().map(start).collect()
    }

    /// The values of variables at the end of an iteration are those at the start of the next one.
    fn end_iteration(&mut self, start: &[(usize, NodeId)]) {
        start.iter().for_each(|(slot, start)| self.graph.edge(*start, self.values[*slot]));
    }

    /// Where the body ended and where it continued, `continuing` goes on.
    fn join_continued(&mut self, body: Behaviour) {
        let Some(exit) = self.exits.last_mut() else { return };
        for (slot, value) in std::mem::take(&mut exit.continued) {
            let Some(now) = self.values.get_mut(slot) else { continue };
            *now = match body.has(Behaviour::NEXT) {
                true => self.graph.joined(&[*now, value]),
                false => value,
            };
        }
    }

    /// Control flow after a loop whose iterations end at `last` if they do not repeat.
    fn after_loop(
        &mut self,
        statement: &Statement<'t>,
        repeats: bool,
        (flow, iteration, last): (NodeId, NodeId, NodeId),
    ) -> NodeId {
        self.leave_exit();
        match (statement.behaviour == Behaviour::NEXT, repeats) {
            (true, _) => flow,
            (false, true) => iteration,
            (false, false) => last,
        }
    }

    fn endless_loop(
        &mut self,
        flow: NodeId,
        statement: &Statement<'t>,
        body: &Block<'t>,
        continuing: Option<&Block<'t>>,
    ) -> NodeId {
        let iteration = self.graph.joined(&[flow]);
        let start = self.begin_loop(statement.place, continuing);
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
        self.after_loop(statement, repeats, (flow, iteration, end))
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
        let start = self.begin_loop(statement.place, None);
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
        let repeats = behaviour.has(Behaviour::NEXT.or(Behaviour::CONTINUE));
        if repeats {
            let end = match update {
                Some(update) => self.statement(end, update),
                None => end,
            };
            self.graph.edge(iteration, end);
            self.end_iteration(&start);
        } else if matches!(statement.kind, StatementKind::While { .. }) {
            // The specification has this edge for every loop. Tint has it for `while` alone.
            self.graph.edge(iteration, end);
        }
        // A false condition leaves the loop too.
        let last = self.graph.joined(&[begun, end]);
        self.after_loop(statement, repeats, (flow, iteration, last))
    }
}

/// What a name means that is declared in a function.
fn local_of(expression: &Expr<'_>) -> Option<LocalId> {
    match expression.kind {
        ExprKind::Name { name: _, template: _, local } => local,
        _ => None,
    }
}

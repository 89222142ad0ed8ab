//! Expressions: which nodes their values depend on.

use super::graph::{NodeId, Role, VARYING};
use super::{Global, Local, Root, View, Walk};
use crate::names::may_vary;
use crate::syntax::{ExprId, ExprKind, LocalId};

/// Control flow after an expression, and its value.
pub type Flow = (NodeId, NodeId);

/// What an expression is: memory, or a value.
enum Found {
    Memory(NodeId, View),
    Value(Flow),
}

impl<'t> Walk<'_, 't> {
    /// A value. Memory is loaded.
    pub fn value(&mut self, flow: NodeId, id: ExprId) -> Flow {
        match self.found(flow, id) {
            Found::Value(value) => value,
            Found::Memory(after, view) => (after, self.loaded(flow, id, view)),
        }
    }

    /// A pointer or a reference, if the expression is one. Otherwise its value.
    pub fn view(&mut self, flow: NodeId, id: ExprId) -> Result<(NodeId, View), Flow> {
        match self.found(flow, id) {
            Found::Memory(after, view) => Ok((after, view)),
            Found::Value(value) => Err(value),
        }
    }

    /// The value of memory, or of the pointer to it.
    pub fn loaded(&mut self, flow: NodeId, id: ExprId, view: View) -> NodeId {
        let node = self.graph.marked(self.module.tree.place(id), Role::Value);
        self.graph.edge(node, view.place);
        if !view.is_pointer {
            self.graph.edge(node, flow);
            match view.root {
                Root::Slot(slot) => self.graph.edge(node, self.values[slot]),
                Root::Varying => self.graph.edge(node, VARYING),
                Root::Fixed => {}
            }
        }
        node
    }

    fn found(&mut self, flow: NodeId, id: ExprId) -> Found {
        match self.module.tree.kind(id) {
            ExprKind::Literal(_) => Found::Value((flow, flow)),
            ExprKind::Name { name, template: _, local } => self.name(flow, id, name, *local),
            ExprKind::Parenthesized(inner) => self.found(flow, *inner),
            ExprKind::Call { callee, template: _, arguments } => {
                Found::Value(self.call(flow, id, callee, arguments))
            }
            ExprKind::Member { base, name: _ } => match self.found(flow, *base) {
                Found::Memory(after, view) => Found::Memory(after, part(view)),
                Found::Value(value) => Found::Value(value),
            },
            ExprKind::Index { base, index } => self.index(flow, *base, *index),
            ExprKind::Unary { operator: _, operand } => Found::Value(self.value(flow, *operand)),
            ExprKind::AddressOf(operand) => self.pointed(flow, *operand, true),
            ExprKind::Indirection(operand) => self.pointed(flow, *operand, false),
            ExprKind::Binary { operator: "&&" | "||", left, right } => {
                let (_, first) = self.value(flow, *left);
                let place = self.module.tree.place(*left);
                let condition = self.graph.marked(place, Role::Condition);
                self.graph.edge(condition, first);
                let (_, second) = self.value(condition, *right);
                Found::Value((flow, second))
            }
            ExprKind::Binary { operator: _, left, right } => {
                let (after, first) = self.value(flow, *left);
                let (after, second) = self.value(after, *right);
                Found::Value((after, self.graph.joined(&[first, second])))
            }
        }
    }

    fn pointed(&mut self, flow: NodeId, operand: ExprId, is_pointer: bool) -> Found {
        match self.found(flow, operand) {
            Found::Memory(after, view) => Found::Memory(after, View { is_pointer, ..view }),
            Found::Value(value) => Found::Value(value),
        }
    }

    fn index(&mut self, flow: NodeId, base: ExprId, index: ExprId) -> Found {
        let found = self.found(flow, base);
        let (Found::Memory(after, _) | Found::Value((after, _))) = found;
        let (after, index) = self.value(after, index);
        match found {
            Found::Memory(_, view) => {
                let place = self.graph.joined(&[view.place, index]);
                Found::Memory(after, View { place, ..part(view) })
            }
            Found::Value((_, base)) => Found::Value((after, self.graph.joined(&[base, index]))),
        }
    }

    fn name(&mut self, flow: NodeId, id: ExprId, name: &'t str, local: Option<LocalId>) -> Found {
        let reference = |root| View { root, is_pointer: false, is_partial: false, place: flow };
        match local.and_then(|local| self.locals.get(&local).copied()) {
            Some(Local::Constant) => return Found::Value((flow, flow)),
            Some(Local::Value(value)) => {
                let node = self.graph.marked(self.module.tree.place(id), Role::Value);
                self.graph.edge(node, flow);
                self.graph.edge(node, value);
                return Found::Value((flow, node));
            }
            Some(Local::Variable(slot)) => {
                return Found::Memory(flow, reference(Root::Slot(slot)));
            }
            Some(Local::Pointer(view)) => {
                let place = self.graph.joined(&[view.place, flow]);
                return Found::Memory(flow, View { place, ..view });
            }
            None => {}
        }
        match self.module.find(name) {
            Some(Global::Variable(at)) => {
                let root = match self.module.may_vary(at) {
                    true => Root::Varying,
                    false => Root::Fixed,
                };
                Found::Memory(flow, reference(root))
            }
            _ => Found::Value((flow, flow)),
        }
    }

    /// Whether a texture is one that the shader also writes.
    pub fn is_written_texture(&self, texture: ExprId) -> bool {
        let of_type = self.module.declared_type(texture);
        let Some((kind, template)) = of_type.and_then(|id| self.module.type_of(id)) else {
            return false;
        };
        kind.starts_with("texture_storage_")
            && self.module.template_word(template, 1) == Some("read_write")
    }
}

/// A view of a part of what it was.
fn part(view: View) -> View {
    View { is_pointer: false, is_partial: true, ..view }
}

/// The view of a pointer parameter, whose contents are in a slot or elsewhere.
pub fn pointer_parameter(
    space: Option<&str>,
    access: Option<&str>,
    slot: usize,
    place: NodeId,
) -> View {
    let root = match space {
        Some("function") => Root::Slot(slot),
        _ if may_vary(space, access) => Root::Varying,
        _ => Root::Fixed,
    };
    View { root, is_pointer: true, is_partial: false, place }
}

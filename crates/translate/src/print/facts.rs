//! What has to be known of a whole package before any of it is written.

use std::collections::{BTreeMap, BTreeSet};

use super::visit::{block_expressions, item_locals};
use crate::condition::Condition;
use crate::tree::{Callee, Expression, ExpressionKind, Field, Function, Item, ItemPath, Meaning};
use crate::tree::{Module, Node, Space, Structure, Type, Unary};
use crate::types::{GlobalKind, Globals, MemberType};

/// Facts about all modules.
#[derive(Debug, Default)]
pub struct Facts {
    /// Structures of what a stage takes or returns.
    stages: BTreeMap<ItemPath, Vec<Node<Field>>>,
    /// Structures that are the blocks of uniforms, and the number of their other uses.
    blocks: BTreeMap<ItemPath, Structure>,
    /// Structures whose zero somebody needs.
    zeros: BTreeSet<ItemPath>,
    /// Structures that an expression makes of their members.
    made: BTreeSet<ItemPath>,
    /// Functions that write something that is not their own.
    effects: BTreeSet<ItemPath>,
    /// Functions that compute with the values of neighbouring fragments.
    derivatives: BTreeSet<ItemPath>,
}

/// A member of what a stage takes or returns.
#[derive(Debug, Clone, PartialEq)]
pub struct StageField {
    pub name: String,
    /// As it is written in expressions.
    pub variable: String,
}

impl Facts {
    pub fn of(modules: &[Module], globals: &Globals) -> Self {
        let mut facts = Self::default();
        for module in modules {
            for node in &module.items {
                if let Item::Structure(structure) = &node.body {
                    facts.structure(module, structure);
                }
            }
        }
        facts.find_blocks(modules);
        facts.find_zeros(modules, globals);
        facts.find_effects(modules, globals);
        facts
    }

    fn structure(&mut self, module: &Module, structure: &Structure) {
        if structure.members.iter().any(|node| node.body.binding.is_some()) {
            let path = ItemPath { module: module.path.clone(), name: structure.name.clone() };
            self.stages.insert(path, structure.members.clone());
        }
    }

    /// Structures of uniforms that nothing else uses.
    fn find_blocks(&mut self, modules: &[Module]) {
        let mut uses: BTreeMap<ItemPath, usize> = BTreeMap::new();
        let mut blocks: Vec<ItemPath> = Vec::new();
        for module in modules {
            for node in &module.items {
                super::visit::item_types(&node.body, &mut |ty| {
                    if let Type::Structure(path) = ty {
                        *uses.entry(path.clone()).or_default() += 1;
                    }
                });
                if let Item::Variable(variable) = &node.body
                    && matches!(variable.space, Space::Uniform | Space::Storage { .. })
                    && let Type::Structure(path) = &variable.ty
                {
                    blocks.push(path.clone());
                }
            }
        }
        for module in modules {
            for node in &module.items {
                let Item::Structure(structure) = &node.body else { continue };
                let path = ItemPath { module: module.path.clone(), name: structure.name.clone() };
                if blocks.contains(&path) && uses.get(&path) == Some(&1) {
                    self.blocks.insert(path, structure.clone());
                }
            }
        }
    }

    fn find_zeros(&mut self, modules: &[Module], globals: &Globals) {
        let mut wanted: Vec<ItemPath> = Vec::new();
        let mut made = BTreeSet::new();
        for module in modules {
            for node in &module.items {
                item_locals(&node.body, &mut |local| {
                    if local.value.is_none() {
                        wanted.extend(local.ty.as_ref().and_then(structure_within));
                    }
                });
                item_expressions(&node.body, &mut |value| {
                    if let ExpressionKind::Call {
                        callee: Callee::Construct(ty), arguments, ..
                    } = &value.kind
                    {
                        match (arguments.is_empty(), ty) {
                            (true, ty) => wanted.extend(structure_within(ty)),
                            (false, Type::Structure(path)) => drop(made.insert(path.clone())),
                            (false, _) => {}
                        }
                    }
                });
            }
        }
        while let Some(path) = wanted.pop() {
            if self.stages.contains_key(&path) || self.zeros.contains(&path) {
                continue;
            }
            let members = globals.members(&path);
            match is_small(&members) {
                true => drop(made.insert(path.clone())),
                false => drop(self.zeros.insert(path.clone())),
            }
            for member in &members {
                wanted.extend(structure_within(&member.ty));
            }
        }
        self.made = made;
    }

    /// Whether an expression makes a structure of its members.
    pub fn is_made(&self, path: &ItemPath) -> bool {
        self.made.contains(path)
    }

    fn find_effects(&mut self, modules: &[Module], globals: &Globals) {
        loop {
            let before = (self.effects.len(), self.derivatives.len());
            for module in modules {
                for node in &module.items {
                    let Item::Function(function) = &node.body else { continue };
                    let path =
                        ItemPath { module: module.path.clone(), name: function.name.clone() };
                    if self.function_has_effects(function, globals) {
                        self.effects.insert(path.clone());
                    }
                    let mut derives = false;
                    block_expressions(&function.body, &mut |value| {
                        derives |= self.derives(value);
                    });
                    if derives {
                        self.derivatives.insert(path);
                    }
                }
            }
            if before == (self.effects.len(), self.derivatives.len()) {
                return;
            }
        }
    }

    fn function_has_effects(&self, function: &Function, globals: &Globals) -> bool {
        let takes_pointer =
            function.parameters.iter().any(|node| matches!(node.body.ty, Type::Pointer(..)));
        let mut found = takes_pointer || super::visit::discards(&function.body);
        super::visit::targets(&function.body, &mut |target| {
            found |= is_outer(target, globals);
        });
        block_expressions(&function.body, &mut |value| found |= self.acts(value));
        found
    }

    /// Whether an expression itself, without its parts, changes something.
    fn acts(&self, value: &Expression) -> bool {
        match &value.kind {
            ExpressionKind::Call { callee: Callee::Function(path), .. } => {
                self.effects.contains(path)
            }
            ExpressionKind::Call { callee: Callee::Builtin(name), .. } => {
                name.ends_with("Barrier") || name == "textureStore" || name.starts_with("atomic")
            }
            _ => false,
        }
    }

    fn derives(&self, value: &Expression) -> bool {
        match &value.kind {
            ExpressionKind::Call { callee: Callee::Function(path), .. } => {
                self.derivatives.contains(path)
            }
            _ => super::function::calls_builtin(value, &crate::types::DERIVATIVES),
        }
    }

    /// Whether computing an expression changes something.
    pub fn has_effects(&self, value: &Expression) -> bool {
        let mut found = false;
        value.walk(&mut |part| found |= self.acts(part));
        found
    }

    /// Whether an expression has values of neighbouring fragments in it.
    pub fn has_derivatives(&self, value: &Expression) -> bool {
        let mut found = false;
        value.walk(&mut |part| found |= self.derives(part));
        found
    }

    /// Whether a type is that of what a stage takes or returns.
    pub fn is_stage_type(&self, ty: &Type) -> bool {
        matches!(ty, Type::Structure(path) if self.stages.contains_key(path))
    }

    pub fn is_stage_structure(&self, path: &ItemPath) -> bool {
        self.stages.contains_key(path)
    }

    /// The members of such a type.
    pub fn stage_members(&self, path: &ItemPath) -> &[Node<Field>] {
        self.stages.get(path).map_or(&[], Vec::as_slice)
    }

    /// The members of what a stage returns.
    pub fn result_members(&self, function: &Function) -> &[Node<Field>] {
        match function.result.as_ref().map(|field| &field.ty) {
            Some(Type::Structure(path)) => self.stage_members(path),
            _ => &[],
        }
    }

    pub fn is_block(&self, path: &ItemPath) -> bool {
        self.blocks.contains_key(path)
    }

    pub fn needs_zero(&self, path: &ItemPath) -> bool {
        self.zeros.contains(path)
    }
}

/// Whether the zero of a structure is short enough to be written where it is needed.
fn is_small(members: &[MemberType]) -> bool {
    let is_plain = |member: &MemberType| {
        member.condition == Condition::Literal(true)
            && matches!(member.ty, Type::Scalar(_) | Type::Vector(..) | Type::Matrix { .. })
    };
    members.len() <= 8 && members.iter().all(is_plain)
}

fn structure_within(ty: &Type) -> Option<ItemPath> {
    match ty {
        Type::Structure(path) => Some(path.clone()),
        Type::Array(element, _) => structure_within(element),
        _ => None,
    }
}

fn item_expressions(item: &Item, visit: &mut dyn FnMut(&Expression)) {
    if let Item::Function(function) = item {
        block_expressions(&function.body, visit);
    }
}

/// Whether what is assigned to belongs to somebody else than the function.
fn is_outer(target: &Expression, globals: &Globals) -> bool {
    match &target.kind {
        ExpressionKind::Name(_, Meaning::Item(path)) => {
            globals.items(path).iter().any(|global| matches!(global.kind, GlobalKind::Variable(..)))
        }
        ExpressionKind::Unary(Unary::Follow, _) => true,
        ExpressionKind::Member(inner, _)
        | ExpressionKind::Index(inner, _)
        | ExpressionKind::Parenthesised(inner) => is_outer(inner, globals),
        _ => false,
    }
}

//! Names of locals that GLSL would take for something else.
//!
//! GLSL and WGSL let inner names hide outer ones in the same way, so a local keeps its name as long
//! as everything in the function does. It changes where GLSL has another meaning for it, or where the
//! text names something that WGSL does not: an item by another name than its author used there.

use std::collections::{BTreeMap, BTreeSet};

use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::source::Span;

use super::expression::LocalRole;
use super::names::{Names, changed_name, free_name};
use super::visit::{block_expressions, within};
use crate::tree::{Block, Callee, Count, ExpressionKind, Function, ItemPath, Local, Meaning, Node};
use crate::tree::{Statement, Type};
use crate::types::Globals;
use crate::wesl::untranslated;

/// What is known where a function stands.
pub struct Surroundings<'a> {
    pub names: &'a Names,
    pub globals: &'a Globals,
    pub module: &'a [String],
    /// The variables of the stage.
    pub variables: &'a [String],
}

/// The names of parameters and locals, by where they are declared.
pub fn local_names(
    function: &Function,
    around: &Surroundings<'_>,
) -> Result<BTreeMap<u32, LocalRole>, Diagnostic> {
    let mut found = Declarations::default();
    for node in &function.parameters {
        found.add(&node.body.name, node.body.span, &BTreeSet::new());
    }
    found.block(&function.body, &BTreeSet::new());
    found.check_groups(&function.body)?;
    let foreign = foreign_names(function, around);
    let mut taken = foreign.clone();
    taken.extend(found.all.iter().map(|one| one.name.clone()));
    taken.extend(spelled_items(function, around));
    let mut changed: BTreeMap<(String, bool), String> = BTreeMap::new();
    let mut names = BTreeMap::new();
    for Declared { name, span, is_inner } in found.all {
        let key = (name.clone(), is_inner);
        let known = changed.get(&key).cloned();
        let wanted = match changed_name(&name, |word| around.names.dialect.is_hidden(word)) {
            Some(wanted) => Some(wanted),
            None if is_inner => Some(format!("{}_inner", name.trim_end_matches('_'))),
            None if foreign.contains(&name) => Some(format!("{}_", name.trim_end_matches('_'))),
            None => None,
        };
        let name = match (known, wanted) {
            (Some(known), _) => known,
            (None, None) => name,
            (None, Some(wanted)) => {
                let free = free_name(&wanted, &taken);
                taken.insert(free.clone());
                changed.insert(key, free.clone());
                free
            }
        };
        names.insert(span.start, LocalRole::Named(name));
    }
    Ok(names)
}

/// Names in the function's text that its author did not write there.
fn foreign_names(function: &Function, around: &Surroundings<'_>) -> BTreeSet<String> {
    let mut foreign: BTreeSet<String> = around.variables.iter().cloned().collect();
    foreign.extend(around.names.zeros().cloned());
    let mut add_type = |ty: &Type| {
        within(ty, &mut |ty| match ty {
            Type::Structure(path) | Type::Array(_, Count::Constant(path)) => {
                foreign.insert(around.names.item(path).to_owned());
            }
            _ => {}
        });
    };
    function.parameters.iter().for_each(|node| add_type(&node.body.ty));
    super::visit::statements(&function.body, &mut |one| {
        if let Statement::Local(Local { ty: Some(ty), .. }) = one {
            add_type(ty);
        }
    });
    block_expressions(&function.body, &mut |value| {
        if let ExpressionKind::Call { callee: Callee::Construct(ty), .. } = &value.kind {
            add_type(ty);
        }
    });
    for path in used_items(function) {
        let name = around.names.item(&path);
        let is_own = name == path.name && around.globals.is_known_as(around.module, &path);
        if !is_own {
            foreign.insert(name.to_owned());
        }
    }
    foreign
}

fn spelled_items(function: &Function, around: &Surroundings<'_>) -> Vec<String> {
    used_items(function).iter().map(|path| around.names.item(path).to_owned()).collect()
}

fn used_items(function: &Function) -> BTreeSet<ItemPath> {
    let mut used = BTreeSet::new();
    block_expressions(&function.body, &mut |value| match &value.kind {
        ExpressionKind::Name(_, Meaning::Item(path))
        | ExpressionKind::Call { callee: Callee::Function(path), .. } => {
            used.insert(path.clone());
        }
        _ => {}
    });
    used
}

struct Declared {
    name: String,
    span: Span,
    /// Whether it would stand in the scope of the one that it hides. The body of a loop is not a
    /// scope beside that of the loop's variable in GLSL.
    is_inner: bool,
}

#[derive(Default)]
struct Declarations {
    all: Vec<Declared>,
}

impl Declarations {
    fn add(&mut self, name: &str, span: Span, taken: &BTreeSet<String>) {
        let is_inner = taken.contains(name);
        self.all.push(Declared { name: name.to_owned(), span, is_inner });
    }

    fn block(&mut self, block: &Block, taken: &BTreeSet<String>) {
        block.nodes.iter().for_each(|node| self.statement(&node.body, taken));
    }

    fn statement(&mut self, statement: &Statement, taken: &BTreeSet<String>) {
        let none = BTreeSet::new();
        match statement {
            Statement::Local(local) => self.add(&local.name, local.span, taken),
            Statement::If { accept, reject, condition: _ } => {
                self.block(accept, &none);
                if let Some(Node { body, .. }) = reject.as_deref() {
                    self.statement(body, &none);
                }
            }
            Statement::Group(block) => self.block(block, taken),
            Statement::Block(block) | Statement::While { body: block, condition: _ } => {
                self.block(block, &none);
            }
            Statement::For { first, body, .. } => {
                let mut own = BTreeSet::new();
                if let Some(Statement::Local(local)) = first.as_deref() {
                    self.add(&local.name, local.span, &none);
                    own.insert(local.name.clone());
                }
                self.block(body, &own);
            }
            Statement::Loop { body, continuing, break_if: _ } => {
                self.block(body, &none);
                let own = declared_names(body);
                continuing.iter().for_each(|block| self.block(block, &own));
            }
            Statement::Switch { cases, .. } => {
                cases.iter().for_each(|node| self.block(&node.body.body, &none));
            }
            _ => {}
        }
    }

    /// A use that may mean several declarations needs one name for all of them.
    fn check_groups(&self, body: &Block) -> Result<(), Diagnostic> {
        let is_inner =
            |number: u32| self.all.iter().any(|one| one.span.start == number && one.is_inner);
        let mut error = None;
        block_expressions(body, &mut |value| {
            let ExpressionKind::Name(name, Meaning::Local(numbers)) = &value.kind else { return };
            let inner = numbers.iter().filter(|number| is_inner(**number)).count();
            if inner > 0 && inner < numbers.len() {
                let what = format!("`{name}`, which hides that of the loop under a condition");
                error = Some(untranslated(value.span, what));
            }
        });
        error.map_or(Ok(()), Err)
    }
}

/// The names that a block declares itself.
fn declared_names(block: &Block) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for node in &block.nodes {
        match &node.body {
            Statement::Local(local) => drop(names.insert(local.name.clone())),
            Statement::Group(block) => names.extend(declared_names(block)),
            _ => {}
        }
    }
    names
}

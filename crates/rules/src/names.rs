//! What the names of a module mean.

use rustc_hash::FxHashMap;

use std::collections::BTreeSet;

use super::syntax::{Attribute, DeclarationKind, ExprId, ExprKind, Function, Tree};

/// What a name means in the scope of the module.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Global {
    /// A `const` or an `override`, by its index among the declarations.
    Constant(usize),
    /// A `var`, by its index among the declarations.
    Variable(usize),
    Function(usize),
    Struct(usize),
    Alias(usize),
}

pub struct Module<'t, 'm> {
    pub tree: &'m Tree<'t>,
    names: FxHashMap<&'t str, Global>,
    /// What each function names.
    pub uses: Vec<Uses>,
}

/// The functions and the variables of the module that a function names.
#[derive(Debug, Default, Clone)]
pub struct Uses {
    pub functions: BTreeSet<usize>,
    pub variables: BTreeSet<usize>,
}

impl<'t, 'm> Module<'t, 'm> {
    pub fn read(tree: &'m Tree<'t>) -> Self {
        let mut names = FxHashMap::default();
        for (at, declaration) in tree.declarations.iter().enumerate() {
            let meaning = match declaration.kind {
                DeclarationKind::Var => Global::Variable(at),
                _ => Global::Constant(at),
            };
            names.insert(declaration.name, meaning);
        }
        let functions = tree.functions.iter().enumerate();
        names.extend(functions.map(|(at, function)| (function.name, Global::Function(at))));
        let structs = tree.structs.iter().enumerate();
        names.extend(structs.map(|(at, structure)| (structure.name, Global::Struct(at))));
        let aliases = tree.aliases.iter().enumerate();
        names.extend(aliases.map(|(at, alias)| (alias.name, Global::Alias(at))));
        let mut module = Self { tree, names, uses: Vec::new() };
        module.uses = module.uses_of_functions();
        module
    }

    fn uses_of_functions(&self) -> Vec<Uses> {
        let mut uses = vec![Uses::default(); self.tree.functions.len()];
        for expression in &self.tree.expressions {
            let (ExprKind::Name { name, template: _, local: None }
            | ExprKind::Call { callee: name, template: _, arguments: _ }) = &expression.kind
            else {
                continue;
            };
            let Some(function) = self.tree.enclosing(expression.place) else { continue };
            match self.find(name) {
                Some(Global::Function(callee)) => {
                    uses[function].functions.insert(callee);
                }
                Some(Global::Variable(variable)) => {
                    uses[function].variables.insert(variable);
                }
                _ => {}
            }
        }
        uses
    }

    pub fn find(&self, name: &str) -> Option<Global> {
        self.names.get(name).copied()
    }

    /// A type with its aliases followed.
    pub fn resolved(&self, mut id: ExprId) -> ExprId {
        // Aliases that lead to each other are refused before; the bound is only for safety.
        for _ in 0..64 {
            let ExprKind::Name { name, template, local: _ } = self.tree.kind(id) else { break };
            match self.find(name) {
                Some(Global::Alias(at)) if template.is_empty() => {
                    id = self.tree.aliases[at].of_type;
                }
                _ => break,
            }
        }
        id
    }

    /// The name and the template list of a type.
    pub fn type_of(&self, id: ExprId) -> Option<(&'t str, &'m [ExprId])> {
        match self.tree.kind(self.resolved(id)) {
            ExprKind::Name { name, template, local: _ } => Some((name, template)),
            _ => None,
        }
    }

    /// A word of a template list: an address space, an access mode, a format.
    pub fn template_word(&self, template: &[ExprId], at: usize) -> Option<&'t str> {
        match self.tree.kind(*template.get(at)?) {
            ExprKind::Name { name, template: _, local: _ } => Some(name),
            _ => None,
        }
    }

    /// The type that stands at the declaration of a name.
    pub fn declared_type(&self, id: ExprId) -> Option<ExprId> {
        match self.tree.kind(self.tree.inner(id)) {
            ExprKind::Name { name: _, template: _, local: Some(local) } => {
                self.tree.locals[*local as usize].of_type
            }
            ExprKind::Name { name, template: _, local: None } => match self.find(name)? {
                Global::Variable(at) => self.tree.declarations[at].of_type,
                _ => None,
            },
            _ => None,
        }
    }

    /// Whether loads from a variable of the module may give each invocation another value.
    pub fn may_vary(&self, variable: usize) -> bool {
        let template = &self.tree.declarations[variable].template;
        may_vary(self.template_word(template, 0), self.template_word(template, 1))
    }

    /// The structure of a type.
    pub fn structure(&self, id: ExprId) -> Option<usize> {
        let (name, _) = self.type_of(id)?;
        match self.find(name) {
            Some(Global::Struct(at)) => Some(at),
            _ => None,
        }
    }
}

/// The stage of an entry point.
pub fn stage_of(function: &Function<'_>) -> Option<&'static str> {
    let has = |stage: &str| {
        let is = |attribute: &Attribute<'_>| attribute.name == stage;
        function.attributes.iter().any(is)
    };
    ["vertex", "fragment", "compute"].into_iter().find(|stage| has(stage))
}

/// Whether a built-in function belongs to the extension `subgroups`.
pub fn is_of_subgroups(name: &str) -> bool {
    name.starts_with("subgroup") || name.starts_with("quad")
}

/// Whether memory of an address space and an access mode can change.
pub fn may_vary(space: Option<&str>, access: Option<&str>) -> bool {
    match space {
        Some("private" | "workgroup" | "function") => true,
        Some("storage") => matches!(access, Some("write" | "read_write")),
        _ => false,
    }
}

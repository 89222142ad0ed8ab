//! What the names of a module mean.

use rustc_hash::FxHashMap;

use super::syntax::{DeclarationKind, ExprId, ExprKind, Tree};

/// What a name means in the scope of the module.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Global {
    /// `const` and `override`.
    Constant,
    /// A `var`, by its index among the declarations.
    Variable(usize),
    Function(usize),
    Struct(usize),
    Alias(usize),
}

pub struct Module<'t, 'm> {
    pub tree: &'m Tree<'t>,
    names: FxHashMap<&'t str, Global>,
}

impl<'t, 'm> Module<'t, 'm> {
    pub fn read(tree: &'m Tree<'t>) -> Self {
        let mut names = FxHashMap::default();
        for (at, declaration) in tree.declarations.iter().enumerate() {
            let meaning = match declaration.kind {
                DeclarationKind::Var => Global::Variable(at),
                _ => Global::Constant,
            };
            names.insert(declaration.name, meaning);
        }
        let functions = tree.functions.iter().enumerate();
        names.extend(functions.map(|(at, function)| (function.name, Global::Function(at))));
        let structs = tree.structs.iter().enumerate();
        names.extend(structs.map(|(at, structure)| (structure.name, Global::Struct(at))));
        let aliases = tree.aliases.iter().enumerate();
        names.extend(aliases.map(|(at, alias)| (alias.name, Global::Alias(at))));
        Self { tree, names }
    }

    pub fn find(&self, name: &str) -> Option<Global> {
        self.names.get(name).copied()
    }

    /// A type with its aliases followed.
    pub fn resolved(&self, mut id: ExprId) -> ExprId {
        // Aliases that lead to each other are refused before; the bound is only for safety.
        for _ in 0..64 {
            let ExprKind::Name { name, template } = self.tree.kind(id) else { break };
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
            ExprKind::Name { name, template } => Some((name, template)),
            _ => None,
        }
    }

    /// A word of a template list: an address space, an access mode, a format.
    pub fn template_word(&self, template: &[ExprId], at: usize) -> Option<&'t str> {
        match self.tree.kind(*template.get(at)?) {
            ExprKind::Name { name, template: _ } => Some(name),
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

/// Whether memory of an address space and an access mode can change.
pub fn may_vary(space: Option<&str>, access: Option<&str>) -> bool {
    match space {
        Some("private" | "workgroup" | "function") => true,
        Some("storage") => matches!(access, Some("write" | "read_write")),
        _ => false,
    }
}

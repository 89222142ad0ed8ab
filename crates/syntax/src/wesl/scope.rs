//! The local names that are in scope while a function is scanned.

use super::module::{ConditionId, Guard, Module};
use super::name::Name;

/// What an identifier may mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IdentifierMeaning {
    /// A local, whatever the settings.
    Local,
    /// Something global, unless a guard in the chain holds.
    Global(Option<u32>),
}

/// The declarations in scope. Looking a name up takes constant time.
#[derive(Debug, Default)]
pub struct Scopes {
    declarations: Vec<ScopedName>,
    /// By name: one more than the index of its innermost declaration.
    innermost: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct ScopedName {
    name: Name,
    meaning: IdentifierMeaning,
    /// The value in `innermost` before this declaration.
    outer: u32,
    /// Whether it was declared in the braces of a condition that have ended. Its first use gets a
    /// warning.
    behind_block: bool,
    /// First byte of the name.
    place: u32,
}

impl Scopes {
    /// No declarations. Names are below `names`.
    pub fn new(names: usize) -> Self {
        Self { declarations: Vec::new(), innermost: vec![0; names] }
    }

    /// Begins a scope. Calling `leave` with the returned mark ends it and removes its declarations.
    pub fn enter(&self) -> usize {
        self.declarations.len()
    }

    pub fn leave(&mut self, mark: usize) {
        while self.declarations.len() > mark {
            if let Some(declaration) = self.declarations.pop() {
                self.innermost[declaration.name.0 as usize] = declaration.outer;
            }
        }
    }

    pub fn declare(
        &mut self,
        module: &mut Module,
        (name, place): (Name, u32),
        condition: Option<ConditionId>,
    ) {
        let meaning = match (condition, self.meaning(name)) {
            (None, _) | (_, IdentifierMeaning::Local) => IdentifierMeaning::Local,
            (Some(condition), IdentifierMeaning::Global(next)) => {
                module.guards.push(Guard { condition, next });
                IdentifierMeaning::Global(Some(module.guards.len() as u32 - 1))
            }
        };
        let outer = std::mem::replace(
            &mut self.innermost[name.0 as usize],
            self.declarations.len() as u32 + 1,
        );
        self.declarations.push(ScopedName { name, meaning, outer, behind_block: false, place });
    }

    /// Ends the braces of a condition. What was declared in them stays in scope.
    pub fn end_block(&mut self, mark: usize) {
        self.declarations[mark..].iter_mut().for_each(|found| found.behind_block = true);
    }

    /// Whether a name means a local from a conditional block that has ended. It is true only once
    /// for each declaration.
    pub fn is_behind_block(&mut self, name: Name) -> bool {
        let index = self.innermost[name.0 as usize].checked_sub(1);
        let found = index.and_then(|index| self.declarations.get_mut(index as usize));
        found.is_some_and(|found| std::mem::take(&mut found.behind_block))
    }

    /// Where the local of a name is declared.
    pub fn place(&self, name: Name) -> Option<u32> {
        let index = self.innermost[name.0 as usize].checked_sub(1)?;
        Some(self.declarations[index as usize].place)
    }

    pub fn meaning(&self, name: Name) -> IdentifierMeaning {
        match self.innermost[name.0 as usize] {
            0 => IdentifierMeaning::Global(None),
            index => self.declarations[index as usize - 1].meaning,
        }
    }
}

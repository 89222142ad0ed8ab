//! Local names while a function is scanned: which ones an identifier may mean.

use super::module::{ConditionId, Guard, Module};
use super::name::Name;

/// What an identifier means as far as locals go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meaning {
    /// A local, whatever the settings.
    Local,
    /// Something global, unless a guard in the chain holds.
    Global(Option<u32>),
}

/// The declarations in scope. Looking a name up takes constant time.
#[derive(Debug, Default)]
pub struct Scopes {
    declarations: Vec<Declaration>,
    /// By name: one more than the index of the innermost declaration.
    innermost: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct Declaration {
    name: Name,
    meaning: Meaning,
    /// What `innermost` had for the name before.
    outer: u32,
    /// Declared in the braces of a condition that ended since; told at its first use.
    behind_block: bool,
    /// First byte of the name.
    place: u32,
}

impl Scopes {
    /// Room for names below `names`.
    pub fn new(names: usize) -> Self {
        Self { declarations: Vec::new(), innermost: vec![0; names] }
    }

    /// What leaving takes to forget all that is declared from here on.
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
            (None, _) | (_, Meaning::Local) => Meaning::Local,
            (Some(condition), Meaning::Global(next)) => {
                module.guards.push(Guard { condition, next });
                Meaning::Global(Some(module.guards.len() as u32 - 1))
            }
        };
        let outer = std::mem::replace(
            &mut self.innermost[name.0 as usize],
            self.declarations.len() as u32 + 1,
        );
        self.declarations.push(Declaration { name, meaning, outer, behind_block: false, place });
    }

    /// The braces of a condition end: what was declared in them stays in scope.
    pub fn end_block(&mut self, mark: usize) {
        self.declarations[mark..].iter_mut().for_each(|found| found.behind_block = true);
    }

    /// Whether a name means a local of a conditional block that ended; true only once for each.
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

    pub fn meaning(&self, name: Name) -> Meaning {
        match self.innermost[name.0 as usize] {
            0 => Meaning::Global(None),
            index => self.declarations[index as usize - 1].meaning,
        }
    }
}

//! The names that are in scope at a place of a function.

use std::collections::BTreeMap;

use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, codes};

use super::global::{GlobalKind, Globals};
use crate::condition::Condition;
use crate::tree::{Meaning, Type};
use crate::wesl::untranslated;

/// What is known at a place.
pub struct Scope<'a> {
    pub globals: &'a Globals,
    pub module: &'a [String],
    /// Under which the place is.
    pub condition: Condition,
    frames: Vec<BTreeMap<String, Vec<Declared>>>,
}

/// A parameter or a local.
#[derive(Debug, Clone)]
struct Declared {
    condition: Condition,
    ty: Type,
    /// The first byte of its name where it is declared.
    number: u32,
}

impl<'a> Scope<'a> {
    /// The scope of a module.
    pub fn new(globals: &'a Globals, module: &'a [String]) -> Self {
        let condition = Condition::Literal(true);
        Self { globals, module, condition, frames: vec![BTreeMap::new()] }
    }

    pub fn enter(&mut self) {
        self.frames.push(BTreeMap::new());
    }

    pub fn leave(&mut self) {
        self.frames.pop();
    }

    /// Declares a name under the condition of this place.
    pub fn declare(&mut self, name: &str, ty: Type, span: Span) {
        let condition = self.condition.clone();
        let declared = Declared { condition, ty, number: span.start };
        if let Some(frame) = self.frames.last_mut() {
            frame.entry(name.to_owned()).or_default().push(declared);
        }
    }

    /// What a name means here, and its type: every declaration that it may be, from the innermost
    /// scope outwards, until one of them surely exists.
    pub fn look_up(&self, name: &str, span: Span) -> Result<(Meaning, Type), Diagnostic> {
        let mut possible: Vec<&Declared> = Vec::new();
        // Where none of those that are found exists.
        let mut rest = self.condition.clone();
        let mut is_certain = false;
        for declared in self.frames.iter().rev().filter_map(|frame| frame.get(name)) {
            let here: Vec<&Declared> =
                declared.iter().filter(|one| !is_absent_at(&one.condition, &rest)).collect();
            for one in &here {
                rest = rest.and(one.condition.clone().negated());
            }
            possible.extend(here);
            is_certain = !possible.is_empty() && rest.excludes(&rest);
            if is_certain {
                break;
            }
        }
        let Some(first) = possible.first() else { return self.look_up_item(name, span) };
        if possible.iter().any(|one| one.ty != first.ty) {
            let what = format!("`{name}` has several types here, each under its condition");
            return Err(untranslated(span, what));
        }
        if !is_certain && self.names_value(name, &rest) {
            let what = format!("`{name}`, which is a local only under some conditions");
            return Err(untranslated(span, what));
        }
        let mut numbers: Vec<u32> = possible.iter().map(|one| one.number).collect();
        numbers.sort_unstable();
        Ok((Meaning::Local(numbers), first.ty.clone()))
    }

    /// Whether a name may mean an item under a condition.
    fn names_value(&self, name: &str, condition: &Condition) -> bool {
        let path = self.globals.meaning(self.module, name);
        let items = path.as_ref().map_or(&[][..], |path| self.globals.items(path));
        items.iter().any(|global| !is_absent_at(&global.condition, condition))
    }

    /// Whether something under a condition surely does not exist here. Where conditions contradict
    /// each other, nothing is reached, and everything exists.
    pub fn is_absent(&self, condition: &Condition) -> bool {
        is_absent_at(condition, &self.condition)
    }

    /// Whether a name means a parameter or a local.
    pub fn is_local(&self, name: &str) -> bool {
        let here = |one: &Declared| !self.is_absent(&one.condition);
        self.frames.iter().any(|frame| frame.get(name).is_some_and(|all| all.iter().any(here)))
    }

    fn look_up_item(&self, name: &str, span: Span) -> Result<(Meaning, Type), Diagnostic> {
        let unknown = || {
            Diagnostic::error(codes::MISSING_ITEM, format!("there is no `{name}`"))
                .at(span, "used here")
        };
        let path = self.globals.meaning(self.module, name).ok_or_else(unknown)?;
        let values: Vec<Type> = self
            .globals
            .items(&path)
            .iter()
            .filter(|global| !self.is_absent(&global.condition))
            .filter_map(|global| match &global.kind {
                GlobalKind::Constant { ty, .. } | GlobalKind::Variable(ty, _) => Some(ty.clone()),
                _ => None,
            })
            .collect();
        let first = values.first().cloned().ok_or_else(unknown)?;
        if values.iter().any(|ty| *ty != first) {
            let what = format!("`{name}` has several types here, each under its condition");
            return Err(untranslated(span, what));
        }
        Ok((Meaning::Item(path), first))
    }
}

fn is_absent_at(condition: &Condition, place: &Condition) -> bool {
    condition.excludes(place) && !place.excludes(place)
}

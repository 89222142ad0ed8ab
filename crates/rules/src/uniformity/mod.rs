//! The uniformity analysis of the specification. Each function becomes a graph, whose edges lead
//! from what must or shall be uniform to what that depends on. What callers need of a function
//! stays as its [`Summary`].

mod builtin;
mod call;
mod expression;
mod graph;
mod statement;
mod summary;

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::FxHashMap;

use super::names::{Global, Module};
use super::syntax::{Filter, Filtered, Function, LocalId, Severity, Tree};
use super::{Place, Problem, Rule};
use graph::{Graph, NodeId};
use summary::Required;
pub use summary::Summary;

/// The problems of all functions, and their summaries. `known` has those of functions whose bodies
/// are elsewhere.
pub fn check<'s>(
    tree: &Tree<'_>,
    module: &Module<'_, '_>,
    known: &dyn Fn(&str) -> Option<&'s Summary>,
) -> (Vec<Problem>, Vec<(String, Summary)>) {
    let mut problems = Vec::new();
    let of = |function: &Function<'_>| known(function.name).cloned();
    let mut summaries: Vec<Option<Summary>> = tree.functions.iter().map(of).collect();
    for index in callees_first(module) {
        if summaries[index].is_none() {
            let (summary, found) = summary::analyse(module, &tree.functions[index], &summaries);
            summaries[index] = Some(summary);
            problems.extend(found);
        }
    }
    let names = tree.functions.iter().map(|function| function.name.to_owned());
    (problems, names.zip(summaries.into_iter().flatten()).collect())
}

/// The functions, each after those that it calls.
fn callees_first(module: &Module<'_, '_>) -> Vec<usize> {
    let calls: Vec<Vec<usize>> =
        module.uses.iter().map(|uses| uses.functions.iter().copied().collect()).collect();
    let (mut order, mut seen) = (Vec::new(), vec![false; calls.len()]);
    // A stack instead of recursion: chains of calls may be long.
    for start in 0..calls.len() {
        let mut open = vec![(start, 0)];
        while let Some((at, next)) = open.pop() {
            if next == 0 && std::mem::replace(&mut seen[at], true) {
                continue;
            }
            match calls[at].get(next) {
                Some(callee) => {
                    open.push((at, next + 1));
                    if !seen[*callee] {
                        open.push((*callee, 0));
                    }
                }
                None => order.push(at),
            }
        }
    }
    order
}

/// What a pointer or a reference leads to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Root {
    /// A variable of the function, or the contents of a pointer parameter to one.
    Slot(usize),
    /// Memory that each invocation may find changed.
    Varying,
    /// Memory that never changes.
    Fixed,
}

/// A pointer or a reference.
#[derive(Debug, Clone, Copy)]
pub struct View {
    pub root: Root,
    pub is_pointer: bool,
    /// It leads to a part of the variable.
    pub is_partial: bool,
    /// The uniformity of where it leads to.
    pub place: NodeId,
}

/// What a name means within a function.
#[derive(Debug, Clone, Copy)]
pub enum Local {
    Value(NodeId),
    Pointer(View),
    Variable(usize),
    /// A value that is the same everywhere: a `const`.
    Constant,
}

/// What leaves a loop or a switch takes along.
pub struct Exit {
    is_loop: bool,
    /// How many variables were declared before it.
    outer: usize,
    /// Those of them that something within names.
    slots: Vec<usize>,
    /// What a `continuing` block names. Some of it is declared within the loop.
    continuing: BTreeSet<LocalId>,
    /// The values with which control flow leaves it.
    left: BTreeMap<usize, NodeId>,
    /// The same at the end of an iteration.
    continued: BTreeMap<usize, NodeId>,
}

/// The analysis of one function.
pub struct Walk<'w, 't> {
    module: &'w Module<'t, 'w>,
    summaries: &'w [Option<Summary>],
    graph: Graph,
    /// What was declared so far.
    locals: FxHashMap<LocalId, Local>,
    /// The value of each variable in scope now. Pointer parameters to the function's memory come
    /// first.
    values: Vec<NodeId>,
    exits: Vec<Exit>,
    /// Filters by nesting, outermost first.
    filters: Vec<Filter>,
    /// The parameters by which the contents of slots come and go.
    pointers: Vec<(usize, usize)>,
    result: NodeId,
    /// Where contents of pointer parameters leave the function.
    outputs: Vec<NodeId>,
    required: Vec<Required>,
}

impl<'t> Walk<'_, 't> {
    fn declare_variable(&mut self, id: LocalId, value: NodeId) {
        self.locals.insert(id, Local::Variable(self.values.len()));
        self.values.push(value);
    }

    /// The variable that a name stands for, itself or as a pointer to it.
    fn slot_of(&self, id: LocalId) -> Option<usize> {
        match self.locals.get(&id)? {
            Local::Variable(slot) | Local::Pointer(View { root: Root::Slot(slot), .. }) => {
                Some(*slot)
            }
            Local::Value(_) | Local::Constant | Local::Pointer(_) => None,
        }
    }

    /// Does something with filters that hold only there.
    fn filtered<T>(&mut self, filters: &[Filter], go: impl FnOnce(&mut Self) -> T) -> T {
        let before = self.filters.len();
        self.filters.extend(filters.iter().cloned());
        let result = go(self);
        self.filters.truncate(before);
        result
    }

    fn severity(&self, rule: Filtered) -> Severity {
        let mut filters = self.filters.iter().rev();
        filters
            .find(|filter| filter.rule == rule)
            .map_or(Severity::Default, |filter| filter.severity)
    }
}

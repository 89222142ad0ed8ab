//! Conditions over axes in a normal form: shared, simplified, and cheap to restrict.
//!
//! Every atom says that the value of one axis is in a set. So equality, order and membership have
//! one form, and the negation of an atom is an atom with the other values. Nodes are interned: two
//! conditions with the same normal form have the same number. The diagram uses this number to share
//! nodes.

use std::rc::Rc;

use rustc_hash::FxHashMap;

use super::TooComplex;
use crate::axis::ValueSet;
use lamplight_files::limits::{Exhausted, Steps};

/// A condition as written: axes by index, values by ordinal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ConstraintFormula {
    /// The axis's value is in the set.
    Is(usize, ValueSet),
    /// The formula does not hold.
    Not(Box<ConstraintFormula>),
    /// All of them hold.
    All(Vec<ConstraintFormula>),
    /// At least one of them holds.
    Any(Vec<ConstraintFormula>),
}

impl ConstraintFormula {
    /// Whether it holds where `ordinals[axis]` is the value of each axis.
    pub fn holds(&self, ordinals: &[u8]) -> bool {
        match self {
            Self::Is(axis, set) => set.contains(usize::from(ordinals[*axis])),
            Self::Not(inner) => !inner.holds(ordinals),
            Self::All(parts) => parts.iter().all(|part| part.holds(ordinals)),
            Self::Any(parts) => parts.iter().any(|part| part.holds(ordinals)),
        }
    }

    /// Marks in `axes` those that it mentions.
    pub fn mark(&self, axes: &mut [bool]) {
        match self {
            Self::Is(axis, _) => axes[*axis] = true,
            Self::Not(inner) => inner.mark(axes),
            Self::All(parts) | Self::Any(parts) => parts.iter().for_each(|part| part.mark(axes)),
        }
    }
}

/// An interned condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FormulaId(u32);

pub const FALSE: FormulaId = FormulaId(0);
pub const TRUE: FormulaId = FormulaId(1);

#[derive(Debug, Clone, PartialEq, Eq, Hash)]
enum ConditionNode {
    Constant(bool),
    Is(u8, ValueSet),
    Join(Join, Rc<[FormulaId]>),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Join {
    All,
    Any,
}

impl Join {
    /// The constant that decides the whole condition, whatever its other parts are.
    fn absorbing(self) -> FormulaId {
        match self {
            Self::All => FALSE,
            Self::Any => TRUE,
        }
    }

    /// The constant that can be left out of the condition.
    fn neutral(self) -> FormulaId {
        match self {
            Self::All => TRUE,
            Self::Any => FALSE,
        }
    }
}

/// The value of an axis is in a set.
type Atom = (u8, ValueSet);

/// Interned conditions over axes with the given domains.
pub struct ConditionPool {
    domains: Vec<ValueSet>,
    nodes: Vec<ConditionNode>,
    /// Axes mentioned by each node, one bit each.
    support: Vec<u128>,
    ids: FxHashMap<ConditionNode, FormulaId>,
    restricted: FxHashMap<(FormulaId, u8, ValueSet), FormulaId>,
    steps: Steps,
}

impl ConditionPool {
    /// A store without conditions. After `steps` steps, its conditions are called too complex.
    /// Counting the points that satisfy arbitrary conditions is #P-hard, so hostile input must meet
    /// a bound; real manifests take some thousands of steps.
    pub fn new(domains: Vec<ValueSet>, steps: Steps) -> Self {
        let mut store = Self {
            domains,
            nodes: Vec::new(),
            support: Vec::new(),
            ids: FxHashMap::default(),
            restricted: FxHashMap::default(),
            steps,
        };
        store.intern(ConditionNode::Constant(false));
        store.intern(ConditionNode::Constant(true));
        store
    }

    /// Steps that are left.
    pub fn steps(&self) -> Steps {
        self.steps
    }

    /// The condition in normal form.
    pub fn add(&mut self, formula: &ConstraintFormula) -> Result<FormulaId, TooComplex> {
        self.add_signed(formula, true)
    }

    /// The condition that all of the given ones hold.
    pub fn all(&mut self, parts: Vec<FormulaId>) -> Result<FormulaId, TooComplex> {
        self.join(Join::All, parts)
    }

    /// What is left of a condition where the axis's value is known to be in the set.
    pub fn restrict(
        &mut self,
        id: FormulaId,
        axis: usize,
        set: ValueSet,
    ) -> Result<FormulaId, TooComplex> {
        if self.support[id.0 as usize] >> axis & 1 == 0 {
            return Ok(id);
        }
        let question = (id, axis as u8, set);
        if let Some(known) = self.restricted.get(&question) {
            return Ok(*known);
        }
        let answer = match self.nodes[id.0 as usize].clone() {
            ConditionNode::Constant(_) => id,
            ConditionNode::Is(_, allowed) if set.without(allowed).is_empty() => TRUE,
            ConditionNode::Is(_, allowed) => self.is(axis, allowed.and(set)),
            ConditionNode::Join(join, parts) => {
                let parts = parts
                    .iter()
                    .map(|part| self.restrict(*part, axis, set))
                    .collect::<Result<_, _>>()?;
                self.join(join, parts)?
            }
        };
        self.restricted.insert(question, answer);
        Ok(answer)
    }

    fn add_signed(
        &mut self,
        formula: &ConstraintFormula,
        positive: bool,
    ) -> Result<FormulaId, TooComplex> {
        match formula {
            ConstraintFormula::Is(axis, set) => {
                Ok(self.is(*axis, if positive { *set } else { self.domains[*axis].without(*set) }))
            }
            ConstraintFormula::Not(inner) => self.add_signed(inner, !positive),
            ConstraintFormula::All(parts) => {
                self.add_join(if positive { Join::All } else { Join::Any }, parts, positive)
            }
            ConstraintFormula::Any(parts) => {
                self.add_join(if positive { Join::Any } else { Join::All }, parts, positive)
            }
        }
    }

    fn add_join(
        &mut self,
        join: Join,
        parts: &[ConstraintFormula],
        positive: bool,
    ) -> Result<FormulaId, TooComplex> {
        let parts =
            parts.iter().map(|part| self.add_signed(part, positive)).collect::<Result<_, _>>()?;
        self.join(join, parts)
    }

    fn is(&mut self, axis: usize, set: ValueSet) -> FormulaId {
        let set = set.and(self.domains[axis]);
        if set.is_empty() {
            FALSE
        } else if set == self.domains[axis] {
            TRUE
        } else {
            self.intern(ConditionNode::Is(axis as u8, set))
        }
    }

    /// The normal form of a conjunction or disjunction: flattens it, merges the atoms of each axis,
    /// and simplifies the other parts by each atom until nothing changes (unit propagation, and its
    /// dual for `Any`).
    fn join(&mut self, join: Join, parts: Vec<FormulaId>) -> Result<FormulaId, TooComplex> {
        // Both are sorted. There are few of them, so vectors are faster than trees.
        let mut atoms: Vec<Atom> = Vec::new();
        let mut others: Vec<FormulaId> = Vec::new();
        let mut pending = parts;
        while let Some(part) = pending.pop() {
            self.spend(1)?;
            match self.nodes[part.0 as usize].clone() {
                _ if part == join.absorbing() => return Ok(part),
                ConditionNode::Constant(_) => {}
                ConditionNode::Join(inner, parts) if inner == join => pending.extend(&*parts),
                ConditionNode::Join(..) => {
                    pending.extend(self.settle(join, part, &atoms, &mut others)?)
                }
                ConditionNode::Is(axis, set) => {
                    let Some(merged) = self.merge(join, &mut atoms, axis, set) else {
                        return Ok(join.absorbing());
                    };
                    if merged {
                        let support = &self.support;
                        let is_touched =
                            |other: &FormulaId| support[other.0 as usize] >> axis & 1 == 1;
                        let touched: Vec<FormulaId> =
                            others.iter().copied().filter(is_touched).collect();
                        if !touched.is_empty() {
                            others.retain(|other| !is_touched(other));
                            pending.extend(touched);
                        }
                    }
                }
            }
        }
        let atoms: Vec<FormulaId> =
            atoms.into_iter().map(|(axis, set)| self.is(axis.into(), set)).collect();
        Ok(self.joined(join, atoms.into_iter().chain(others).collect()))
    }

    /// Simplifies a part by the atoms known so far. If that changes nothing, the part is added to
    /// `others`. If not, the simpler part is returned, since it must be joined again.
    fn settle(
        &mut self,
        join: Join,
        part: FormulaId,
        atoms: &[Atom],
        others: &mut Vec<FormulaId>,
    ) -> Result<Option<FormulaId>, TooComplex> {
        let mut simpler = part;
        for (axis, set) in atoms {
            let known = match join {
                Join::All => *set,
                Join::Any => self.domains[usize::from(*axis)].without(*set),
            };
            simpler = self.restrict(simpler, (*axis).into(), known)?;
        }
        if simpler == part {
            if let Err(at) = others.binary_search(&part) {
                others.insert(at, part);
            }
            return Ok(None);
        }
        Ok(Some(simpler))
    }

    /// Adds an atom to those of its axis. Returns whether they changed, or `None` if the atom
    /// decides the whole condition.
    fn merge(&self, join: Join, atoms: &mut Vec<Atom>, axis: u8, set: ValueSet) -> Option<bool> {
        let place = atoms.binary_search_by_key(&axis, |(axis, _)| *axis);
        let before = place.ok().map(|at| atoms[at].1);
        let after = match (join, before) {
            (_, None) => set,
            (Join::All, Some(before)) => before.and(set),
            (Join::Any, Some(before)) => before.or(set),
        };
        match place {
            Ok(at) => atoms[at].1 = after,
            Err(at) => atoms.insert(at, (axis, after)),
        }
        let decided = match join {
            Join::All => after.is_empty(),
            Join::Any => after == self.domains[usize::from(axis)],
        };
        (!decided).then_some(before != Some(after))
    }

    fn joined(&mut self, join: Join, mut parts: Vec<FormulaId>) -> FormulaId {
        parts.sort();
        match parts.as_slice() {
            [] => join.neutral(),
            [only] => *only,
            _ => self.intern(ConditionNode::Join(join, parts.into())),
        }
    }

    fn intern(&mut self, node: ConditionNode) -> FormulaId {
        if let Some(id) = self.ids.get(&node) {
            return *id;
        }
        let id = FormulaId(self.nodes.len() as u32);
        self.support.push(match &node {
            ConditionNode::Constant(_) => 0,
            ConditionNode::Is(axis, _) => 1 << axis,
            ConditionNode::Join(_, parts) => {
                parts.iter().fold(0, |bits, part| bits | self.support[part.0 as usize])
            }
        });
        self.nodes.push(node.clone());
        self.ids.insert(node, id);
        id
    }

    fn spend(&mut self, steps: usize) -> Result<(), TooComplex> {
        self.steps.spend(steps as u64).map_err(|Exhausted| TooComplex)
    }
}

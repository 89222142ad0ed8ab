//! Conditions over axes in a normal form: shared, simplified, and cheap to restrict.
//!
//! Every atom says that the value of one axis is in a set. So equality, order and membership have
//! one form, and the negation of an atom is an atom with the other values. Nodes are interned: two
//! conditions with the same normal form have the same number. The diagram uses this number to share
//! nodes.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::TooComplex;
use crate::limits::{Exhausted, Steps};
use crate::permute::axis::ValueSet;

/// A condition as written: axes by index, values by ordinal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Formula {
    /// The axis's value is in the set.
    Is(usize, ValueSet),
    /// The formula does not hold.
    Not(Box<Formula>),
    /// All of them hold.
    All(Vec<Formula>),
    /// At least one of them holds.
    Any(Vec<Formula>),
}

impl Formula {
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
pub struct Id(u32);

pub const FALSE: Id = Id(0);
pub const TRUE: Id = Id(1);

#[derive(Debug, Clone, PartialEq, Eq, Hash)]
enum Node {
    Constant(bool),
    Is(u8, ValueSet),
    Join(Join, Box<[Id]>),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Join {
    All,
    Any,
}

impl Join {
    /// The constant that decides the whole condition, whatever its other parts are.
    fn absorbing(self) -> Id {
        match self {
            Self::All => FALSE,
            Self::Any => TRUE,
        }
    }

    /// The constant that can be left out of the condition.
    fn neutral(self) -> Id {
        match self {
            Self::All => TRUE,
            Self::Any => FALSE,
        }
    }
}

/// Interned conditions over axes with the given domains.
pub struct Conditions {
    domains: Vec<ValueSet>,
    nodes: Vec<Node>,
    /// Axes mentioned by each node, one bit each.
    support: Vec<u128>,
    ids: HashMap<Node, Id>,
    restricted: HashMap<(Id, u8, ValueSet), Id>,
    steps: Steps,
}

impl Conditions {
    /// A store without conditions. After `steps` steps, its conditions are called too complex.
    /// Counting the points that satisfy arbitrary conditions is #P-hard, so hostile input must meet
    /// a bound; real manifests take some thousands of steps.
    pub fn new(domains: Vec<ValueSet>, steps: Steps) -> Self {
        let mut store = Self {
            domains,
            nodes: Vec::new(),
            support: Vec::new(),
            ids: HashMap::new(),
            restricted: HashMap::new(),
            steps,
        };
        store.intern(Node::Constant(false));
        store.intern(Node::Constant(true));
        store
    }

    /// Steps that are left.
    pub fn steps(&self) -> Steps {
        self.steps
    }

    /// The condition in normal form.
    pub fn add(&mut self, formula: &Formula) -> Result<Id, TooComplex> {
        self.add_signed(formula, true)
    }

    /// The condition that all of the given ones hold.
    pub fn all(&mut self, parts: Vec<Id>) -> Result<Id, TooComplex> {
        self.join(Join::All, parts)
    }

    /// What is left of a condition where the axis's value is known to be in the set.
    pub fn restrict(&mut self, id: Id, axis: usize, set: ValueSet) -> Result<Id, TooComplex> {
        if self.support[id.0 as usize] >> axis & 1 == 0 {
            return Ok(id);
        }
        let question = (id, axis as u8, set);
        if let Some(known) = self.restricted.get(&question) {
            return Ok(*known);
        }
        let answer = match self.nodes[id.0 as usize].clone() {
            Node::Constant(_) => id,
            Node::Is(_, allowed) if set.without(allowed).is_empty() => TRUE,
            Node::Is(_, allowed) => self.is(axis, allowed.and(set)),
            Node::Join(join, parts) => {
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

    fn add_signed(&mut self, formula: &Formula, positive: bool) -> Result<Id, TooComplex> {
        match formula {
            Formula::Is(axis, set) => {
                Ok(self.is(*axis, if positive { *set } else { self.domains[*axis].without(*set) }))
            }
            Formula::Not(inner) => self.add_signed(inner, !positive),
            Formula::All(parts) => {
                self.add_join(if positive { Join::All } else { Join::Any }, parts, positive)
            }
            Formula::Any(parts) => {
                self.add_join(if positive { Join::Any } else { Join::All }, parts, positive)
            }
        }
    }

    fn add_join(
        &mut self,
        join: Join,
        parts: &[Formula],
        positive: bool,
    ) -> Result<Id, TooComplex> {
        let parts =
            parts.iter().map(|part| self.add_signed(part, positive)).collect::<Result<_, _>>()?;
        self.join(join, parts)
    }

    fn is(&mut self, axis: usize, set: ValueSet) -> Id {
        let set = set.and(self.domains[axis]);
        if set.is_empty() {
            FALSE
        } else if set == self.domains[axis] {
            TRUE
        } else {
            self.intern(Node::Is(axis as u8, set))
        }
    }

    /// The normal form of a conjunction or disjunction: flattens it, merges the atoms of each axis,
    /// and simplifies the other parts by each atom until nothing changes (unit propagation, and its
    /// dual for `Any`).
    fn join(&mut self, join: Join, parts: Vec<Id>) -> Result<Id, TooComplex> {
        let mut atoms: BTreeMap<u8, ValueSet> = BTreeMap::new();
        let mut others: BTreeSet<Id> = BTreeSet::new();
        let mut pending = parts;
        while let Some(part) = pending.pop() {
            self.spend(1)?;
            match self.nodes[part.0 as usize].clone() {
                _ if part == join.absorbing() => return Ok(part),
                Node::Constant(_) => {}
                Node::Join(inner, parts) if inner == join => pending.extend(parts),
                Node::Join(..) => pending.extend(self.settle(join, part, &atoms, &mut others)?),
                Node::Is(axis, set) => {
                    let Some(merged) = self.merge(join, &mut atoms, axis, set) else {
                        return Ok(join.absorbing());
                    };
                    if merged {
                        let support = &self.support;
                        let is_touched = |other: &Id| support[other.0 as usize] >> axis & 1 == 1;
                        let touched: Vec<Id> = others.iter().copied().filter(is_touched).collect();
                        if !touched.is_empty() {
                            others.retain(|other| !is_touched(other));
                            pending.extend(touched);
                        }
                    }
                }
            }
        }
        let atoms: Vec<Id> =
            atoms.into_iter().map(|(axis, set)| self.is(axis.into(), set)).collect();
        Ok(self.joined(join, atoms.into_iter().chain(others).collect()))
    }

    /// Simplifies a part by the atoms known so far. If that changes nothing, the part is added to
    /// `others`. If not, the simpler part is returned, since it must be joined again.
    fn settle(
        &mut self,
        join: Join,
        part: Id,
        atoms: &BTreeMap<u8, ValueSet>,
        others: &mut BTreeSet<Id>,
    ) -> Result<Option<Id>, TooComplex> {
        let mut simpler = part;
        for (axis, set) in atoms {
            let known = match join {
                Join::All => *set,
                Join::Any => self.domains[usize::from(*axis)].without(*set),
            };
            simpler = self.restrict(simpler, (*axis).into(), known)?;
        }
        if simpler == part {
            others.insert(part);
            return Ok(None);
        }
        Ok(Some(simpler))
    }

    /// Adds an atom to those of its axis. Returns whether they changed, or `None` if the atom
    /// decides the whole condition.
    fn merge(
        &self,
        join: Join,
        atoms: &mut BTreeMap<u8, ValueSet>,
        axis: u8,
        set: ValueSet,
    ) -> Option<bool> {
        let before = atoms.get(&axis).copied();
        let after = match (join, before) {
            (_, None) => set,
            (Join::All, Some(before)) => before.and(set),
            (Join::Any, Some(before)) => before.or(set),
        };
        atoms.insert(axis, after);
        let decided = match join {
            Join::All => after.is_empty(),
            Join::Any => after == self.domains[usize::from(axis)],
        };
        (!decided).then_some(before != Some(after))
    }

    fn joined(&mut self, join: Join, mut parts: Vec<Id>) -> Id {
        parts.sort();
        match parts.as_slice() {
            [] => join.neutral(),
            [only] => *only,
            _ => self.intern(Node::Join(join, parts.into())),
        }
    }

    fn intern(&mut self, node: Node) -> Id {
        if let Some(id) = self.ids.get(&node) {
            return *id;
        }
        let id = Id(self.nodes.len() as u32);
        self.support.push(match &node {
            Node::Constant(_) => 0,
            Node::Is(axis, _) => 1 << axis,
            Node::Join(_, parts) => {
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

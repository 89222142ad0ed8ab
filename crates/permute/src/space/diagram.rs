//! The valid points of a space as a decision diagram. It has one level for each axis, and on each
//! level one node for each condition that is still to be satisfied. Branches without a valid point
//! are left out, so that counting and listing cost no more than what they find.

use rustc_hash::FxHashMap;

use super::formula::{ConditionPool, FALSE, FormulaId};
use super::{Assignment, TooComplex};
use crate::axis::ValueSet;

/// A set of points. Nodes come after their children. So one forward pass computes any property of
/// the nodes that depends on the nodes below them, such as a count.
#[derive(Debug, Clone)]
pub struct Diagram {
    /// The axis asked at each level.
    order: Vec<usize>,
    nodes: Vec<DiagramNode>,
    root: u32,
}

#[derive(Debug, Clone)]
struct DiagramNode {
    level: u8,
    /// The node below for each ordinal of the level's axis.
    children: Box<[u32]>,
}

/// The node below which there is no point, and the node at which every point ends.
const DEAD: u32 = 0;
const END: u32 = 1;

/// With more nodes than this, a set of conditions is called too complex.
const NODES: usize = 1 << 18;

impl Diagram {
    /// The points of the domains where the condition holds, asking the axes in that order.
    pub fn new(
        conditions: &mut ConditionPool,
        condition: FormulaId,
        domains: &[ValueSet],
        order: Vec<usize>,
    ) -> Result<Self, TooComplex> {
        let end = DiagramNode { level: u8::MAX, children: Box::default() };
        let mut builder = Builder {
            conditions,
            domains,
            order: &order,
            nodes: vec![end.clone(), end],
            known: FxHashMap::default(),
        };
        let root = builder.node(0, condition)?;
        let nodes = builder.nodes;
        Ok(Self { order, nodes, root })
    }

    /// A set without points.
    pub fn empty(order: Vec<usize>) -> Self {
        let end = DiagramNode { level: u8::MAX, children: Box::default() };
        Self { order, nodes: vec![end.clone(), end], root: DEAD }
    }

    /// How many points it has; `u128::MAX` for that many or more.
    pub fn count(&self) -> u128 {
        self.counts(|_, children, counts| Ok(sum_counts(children, counts))).unwrap_or(0)
    }

    /// How many points there are if those that differ only in one axis count as one.
    pub fn count_without(&self, axis: usize) -> Result<u128, TooComplex> {
        let mut known = FxHashMap::default();
        self.counts(|level_axis, children, counts| match level_axis == axis {
            true => self.merged(children.to_vec(), counts, &mut known),
            false => Ok(sum_counts(children, counts)),
        })
    }

    /// Every point, in no particular order.
    pub fn points(&self) -> Vec<Assignment> {
        let mut found = Vec::new();
        let mut point = vec![0; self.order.len()];
        self.walk(self.root, &mut point, &mut found);
        found
    }

    /// Nodes of all levels.
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    pub fn contains(&self, point: &Assignment) -> bool {
        let below = |node: u32, axis: &usize| {
            self.nodes[node as usize].children.get(point.ordinal(*axis)).copied().unwrap_or(DEAD)
        };
        self.order
            .iter()
            .fold(self.root, |node, axis| if node == DEAD { DEAD } else { below(node, axis) })
            == END
    }

    /// The values of each axis that occur in a point, by axis.
    pub fn used(&self) -> Vec<ValueSet> {
        let mut used = vec![ValueSet::EMPTY; self.order.len()];
        for node in &self.nodes[2..] {
            let alive = node.children.iter().enumerate().filter(|(_, child)| **child != DEAD);
            let axis = self.order[usize::from(node.level)];
            used[axis] = used[axis].or(alive.map(|(ordinal, _)| ordinal).collect());
        }
        used
    }

    /// Whether it has a point whose values are all among those allowed, by axis.
    pub fn meets(&self, allowed: &[ValueSet]) -> bool {
        self.alive(allowed)[self.root as usize]
    }

    /// A point whose values are all allowed, or `None` if there is none. For each axis, in the
    /// diagram's order, `choose` picks one of the ordinals that lead to such a point.
    pub fn pick(
        &self,
        allowed: &[ValueSet],
        mut choose: impl FnMut(usize, ValueSet) -> usize,
    ) -> Option<Assignment> {
        let alive = self.alive(allowed);
        let mut node = self.root;
        let mut point = vec![0; self.order.len()];
        if !alive[node as usize] {
            return None;
        }
        for axis in self.order.iter().copied() {
            let ordinal = choose(axis, self.open(node, allowed[axis], &alive));
            point[axis] = ordinal as u8;
            node = self.nodes[node as usize].children[ordinal];
        }
        Some(Assignment(point.into()))
    }

    /// For each node whether a point of the values allowed is below it.
    fn alive(&self, allowed: &[ValueSet]) -> Vec<bool> {
        let mut alive = vec![false; self.nodes.len()];
        alive[END as usize] = true;
        for node in 2..self.nodes.len() {
            let axis = self.order[usize::from(self.nodes[node].level)];
            alive[node] = !self.open(node as u32, allowed[axis], &alive).is_empty();
        }
        alive
    }

    fn open(&self, node: u32, allowed: ValueSet, alive: &[bool]) -> ValueSet {
        let children = &self.nodes[node as usize].children;
        let alive =
            |ordinal: &usize| children.get(*ordinal).is_some_and(|child| alive[*child as usize]);
        allowed.iter().filter(alive).collect()
    }

    /// Computes the count of each node from the axis it asks, its children and their counts.
    fn counts(
        &self,
        mut count: impl FnMut(usize, &[u32], &[u128]) -> Result<u128, TooComplex>,
    ) -> Result<u128, TooComplex> {
        let mut counts = vec![0, 1];
        for DiagramNode { level, children } in &self.nodes[2..] {
            let found = count(self.order[usize::from(*level)], children, &counts)?;
            counts.push(found);
        }
        Ok(counts[self.root as usize])
    }

    /// How many points are below at least one of the nodes, which are of the same level.
    fn merged(
        &self,
        mut nodes: Vec<u32>,
        counts: &[u128],
        known: &mut FxHashMap<Vec<u32>, u128>,
    ) -> Result<u128, TooComplex> {
        nodes.retain(|node| *node != DEAD);
        nodes.sort_unstable();
        nodes.dedup();
        let values = match nodes.as_slice() {
            [] => return Ok(0),
            [only] => return Ok(counts[*only as usize]),
            [first, ..] => self.nodes[*first as usize].children.len(),
        };
        if let Some(count) = known.get(&nodes) {
            return Ok(*count);
        }
        let mut total: u128 = 0;
        for ordinal in 0..values {
            let below =
                nodes.iter().map(|node| self.nodes[*node as usize].children[ordinal]).collect();
            total = total.saturating_add(self.merged(below, counts, known)?);
        }
        known.insert(nodes, total);
        if known.len() > NODES { Err(TooComplex) } else { Ok(total) }
    }

    /// Recursion is as deep as there are axes, which [`crate::axis::MAX`] bounds.
    fn walk(&self, node: u32, point: &mut Vec<u8>, found: &mut Vec<Assignment>) {
        if node == END {
            found.push(Assignment(point.as_slice().into()));
            return;
        }
        let DiagramNode { level, children } = &self.nodes[node as usize];
        for (ordinal, child) in children.iter().enumerate().filter(|(_, child)| **child != DEAD) {
            point[self.order[usize::from(*level)]] = ordinal as u8;
            self.walk(*child, point, found);
        }
    }
}

fn sum_counts(children: &[u32], counts: &[u128]) -> u128 {
    children.iter().fold(0, |sum: u128, child| sum.saturating_add(counts[*child as usize]))
}

struct Builder<'a> {
    conditions: &'a mut ConditionPool,
    domains: &'a [ValueSet],
    order: &'a [usize],
    nodes: Vec<DiagramNode>,
    known: FxHashMap<(usize, FormulaId), u32>,
}

impl Builder<'_> {
    fn node(&mut self, level: usize, condition: FormulaId) -> Result<u32, TooComplex> {
        if condition == FALSE {
            return Ok(DEAD);
        }
        let Some(axis) = self.order.get(level).copied() else { return Ok(END) };
        if let Some(node) = self.known.get(&(level, condition)) {
            return Ok(*node);
        }
        let children = self.children(level, axis, condition)?;
        let node = if children.iter().all(|child| *child == DEAD) {
            DEAD
        } else {
            self.push(level, children)?
        };
        self.known.insert((level, condition), node);
        Ok(node)
    }

    fn children(
        &mut self,
        level: usize,
        axis: usize,
        condition: FormulaId,
    ) -> Result<Box<[u32]>, TooComplex> {
        let domain = self.domains[axis];
        let count = domain.iter().last().map_or(0, |last| last + 1);
        let mut children = vec![DEAD; count];
        for ordinal in domain.iter() {
            let rest = self.conditions.restrict(condition, axis, ValueSet::single(ordinal))?;
            children[ordinal] = self.node(level + 1, rest)?;
        }
        Ok(children.into())
    }

    fn push(&mut self, level: usize, children: Box<[u32]>) -> Result<u32, TooComplex> {
        self.nodes.push(DiagramNode { level: level as u8, children });
        if self.nodes.len() > NODES { Err(TooComplex) } else { Ok(self.nodes.len() as u32 - 1) }
    }
}

//! The control flow of blocks: their order, and the loops.

use std::collections::BTreeSet;

use super::MachineError;
use super::text::{Block, Edge, Instruction};

/// A loop: every path into it leads through its header.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Loop {
    pub header: usize,
    /// With the header and the inner loops.
    pub body: BTreeSet<usize>,
    /// The loop around it.
    pub parent: Option<usize>,
}

/// Blocks that can be reached, and how they lie in loops.
#[derive(Debug, Clone)]
pub struct Flow {
    /// In an order in which each block is behind those that lead to it, except by the last edge
    /// of a loop.
    pub order: Vec<usize>,
    pub edges: Vec<Vec<Edge>>,
    pub sources: Vec<Vec<usize>>,
    /// The block that each path to a block leads through last.
    dominators: Vec<Option<usize>>,
    /// In the order of the headers in the code.
    pub loops: Vec<Loop>,
    /// The innermost loop of each block.
    pub loop_of: Vec<Option<usize>>,
    /// Blocks that swap the sides of an `if`: what was inactive becomes active. The branch at the
    /// end of such a block skips the second side.
    pub swaps: Vec<bool>,
}

impl Flow {
    pub fn of(blocks: &[Block]) -> Result<Self, MachineError> {
        let edges: Vec<Vec<Edge>> = blocks.iter().map(|block| block.edges.clone()).collect();
        let order = reachable_order(&edges);
        let mut sources = vec![Vec::new(); blocks.len()];
        for from in &order {
            for edge in &edges[*from] {
                sources[edge.to].push(*from);
            }
        }
        let dominators = dominators_of(&order, &sources);
        let swaps = blocks.iter().map(swaps_sides).collect();
        let loop_of = vec![None; blocks.len()];
        let mut flow =
            Self { order, edges, sources, dominators, loops: Vec::new(), loop_of, swaps };
        flow.find_loops(blocks)?;
        Ok(flow)
    }

    /// Whether every path to `block` leads through `above`.
    pub fn dominates(&self, above: usize, block: usize) -> bool {
        let up = |at: &usize| self.dominators[*at].filter(|next| next != at);
        std::iter::successors(Some(block), up).any(|at| at == above)
    }

    fn find_loops(&mut self, blocks: &[Block]) -> Result<(), MachineError> {
        let mut place = vec![usize::MAX; blocks.len()];
        for (index, block) in self.order.iter().enumerate() {
            place[*block] = index;
        }
        let mut loops: Vec<Loop> = Vec::new();
        for from in self.order.iter().copied() {
            for edge in &self.edges[from] {
                if place[edge.to] > place[from] {
                    continue;
                }
                if !self.dominates(edge.to, from) {
                    return Err(MachineError::Irreducible(blocks[edge.to].label.clone()));
                }
                let body = self.natural_body(edge.to, from);
                match loops.iter_mut().find(|known| known.header == edge.to) {
                    Some(known) => known.body.extend(body),
                    None => loops.push(Loop { header: edge.to, body, parent: None }),
                }
            }
        }
        loops.sort_by_key(|found| found.header);
        let around = |inner: &Loop, at: usize| {
            let outer = loops.iter().enumerate().filter(|(index, outer)| {
                *index != at && outer.body.contains(&inner.header) && outer.header != inner.header
            });
            outer.min_by_key(|(_, outer)| outer.body.len()).map(|(index, _)| index)
        };
        let parents: Vec<Option<usize>> =
            loops.iter().enumerate().map(|(at, inner)| around(inner, at)).collect();
        for block in 0..blocks.len() {
            let inside = loops.iter().enumerate().filter(|(_, found)| found.body.contains(&block));
            let innermost = inside.min_by_key(|(_, found)| found.body.len());
            self.loop_of[block] = innermost.map(|(index, _)| index);
        }
        for (found, parent) in loops.iter_mut().zip(parents) {
            found.parent = parent;
        }
        self.loops = loops;
        Ok(())
    }

    /// The blocks from which the last edge of a loop is reached without passing its header.
    fn natural_body(&self, header: usize, latch: usize) -> BTreeSet<usize> {
        let mut body = BTreeSet::from([header]);
        let mut open = vec![latch];
        while let Some(block) = open.pop() {
            if body.insert(block) {
                open.extend(&self.sources[block]);
            }
        }
        body
    }
}

/// Reverse postorder from the first block.
fn reachable_order(edges: &[Vec<Edge>]) -> Vec<usize> {
    let mut seen = vec![false; edges.len()];
    let mut order = Vec::new();
    let mut stack = vec![(0, 0)];
    if let Some(first) = seen.first_mut() {
        *first = true;
    }
    while let Some((block, next)) = stack.pop() {
        let Some(edge) = edges.get(block).and_then(|edges| edges.get(next)) else {
            order.push(block);
            continue;
        };
        stack.push((block, next + 1));
        if !std::mem::replace(&mut seen[edge.to], true) {
            stack.push((edge.to, 0));
        }
    }
    order.reverse();
    order
}

/// Immediate dominators, after Cooper, Harvey and Kennedy, "A Simple, Fast Dominance Algorithm".
fn dominators_of(order: &[usize], sources: &[Vec<usize>]) -> Vec<Option<usize>> {
    let mut place = vec![usize::MAX; sources.len()];
    for (index, block) in order.iter().enumerate() {
        place[*block] = index;
    }
    let mut above: Vec<Option<usize>> = vec![None; sources.len()];
    let Some(entry) = order.first().copied() else { return above };
    above[entry] = Some(entry);
    let meet = |above: &[Option<usize>], mut one: usize, mut other: usize| {
        while one != other {
            while place[one] > place[other] {
                one = above[one].unwrap_or(entry);
            }
            while place[other] > place[one] {
                other = above[other].unwrap_or(entry);
            }
        }
        one
    };
    let mut changed = true;
    while std::mem::take(&mut changed) {
        for block in order.iter().copied().skip(1) {
            let known = sources[block].iter().copied().filter(|source| above[*source].is_some());
            let new = known.reduce(|one, other| meet(&above, one, other));
            if above[block] != new {
                above[block] = new;
                changed = true;
            }
        }
    }
    above
}

/// Whether a block begins the other side of an `if`, and does nothing else with the active threads:
/// it inverts them within those that came to the `if`.
fn swaps_sides(block: &Block) -> bool {
    const SWAPS: [&str; 4] = ["s_andn2_b64", "s_andn2_b32", "s_and_not1_b64", "s_and_not1_b32"];
    let is_mask = |operand: &str| operand.starts_with("exec");
    let writes = block.instructions.iter().filter(|instruction| {
        is_mask(instruction.operand(0))
            || instruction.name.contains("saveexec")
            || instruction.name.starts_with("v_cmpx")
    });
    let is_swap = |instruction: &Instruction| {
        let name = instruction.name.as_str();
        (SWAPS.contains(&name) || name.starts_with("s_xor_b")) && is_mask(instruction.operand(2))
    };
    writes.clone().count() == 1 && writes.into_iter().all(is_swap)
}

//! Which statements and inputs each value of a run comes from.
//!
//! All turns of a loop are one node, so the graph is as large as the text and not as the run.

use std::collections::{BTreeMap, BTreeSet};

use lamplight_eval::{
    Action, Error, Executed, FunctionId, Observer, Shape, ShapePart, SlotRange, Variable,
    VariableKind, VariablePlace,
};

use crate::record::stored_variables;
use crate::subject::Subject;
use crate::text::StatementId;
use crate::walk::Walk;

/// Index of a node.
pub type NodeId = usize;

/// The most call paths that have nodes of their own. Calls beyond it share those of their function.
const MOST_PATHS: usize = 4096;

/// A statement as it is reached by one call path, or an input.
#[derive(Debug, Clone)]
pub struct Node {
    /// What it is.
    pub origin: Origin,
    /// The nodes whose values it reads.
    pub reads: BTreeSet<NodeId>,
    /// The nodes that say where it reads textures.
    pub looked_up: BTreeSet<NodeId>,
    /// The nodes that decide whether it runs.
    pub decided_by: BTreeSet<NodeId>,
    /// The call that it is in.
    pub called_by: Option<NodeId>,
    /// How often it ran.
    pub runs: u64,
    /// The variables that it stores to or names, by number.
    pub gives: BTreeSet<usize>,
    /// The textures that it reads.
    pub textures: BTreeSet<String>,
}

/// What a node stands for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Origin {
    /// A statement of a function, and how many calls deep.
    Statement(StatementId, FunctionId, usize),
    /// A part of a parameter or a buffer: its name, its first slot and how many it has.
    Input(String, u32, u32),
}

/// Names nodes in the order in which a run reaches them: the same in each run of a subject.
#[derive(Default)]
pub struct Nodes {
    paths: BTreeMap<(usize, Option<StatementId>), usize>,
    nodes: BTreeMap<(usize, StatementId), NodeId>,
    /// The path of each frame.
    frames: Vec<usize>,
}

impl Nodes {
    /// The node of the statement that a frame is in. Calls `made` with the depth of each node that is
    /// new, callers first; `count` is the number of the next one.
    pub fn of(
        &mut self,
        walk: &Walk,
        depth: usize,
        count: &mut NodeId,
        made: &mut dyn FnMut(usize),
    ) -> Option<NodeId> {
        self.frames.truncate(walk.frames.len());
        while self.frames.len() < walk.frames.len() {
            let path = self.next_path(walk);
            self.frames.push(path);
        }
        let key =
            |depth: usize| Some((*self.frames.get(depth)?, walk.frames.get(depth)?.statement?));
        let own = key(depth)?;
        if let Some(known) = self.nodes.get(&own) {
            return Some(*known);
        }
        for (depth, key) in (0..=depth).filter_map(|depth| Some((depth, key(depth)?))) {
            if let std::collections::btree_map::Entry::Vacant(place) = self.nodes.entry(key) {
                place.insert(*count);
                *count += 1;
                made(depth);
            }
        }
        self.nodes.get(&own).copied()
    }

    /// The call path to the frame after those that are known.
    fn next_path(&mut self, walk: &Walk) -> usize {
        let Some(caller) = self.frames.len().checked_sub(1) else { return 0 };
        let from = (self.frames[caller], walk.frames[caller].statement);
        let next = if self.paths.len() < MOST_PATHS { self.paths.len() + 1 } else { 0 };
        *self.paths.entry(from).or_insert(next)
    }
}

/// The graph of a run.
pub struct Graph {
    /// All nodes: inputs first, statements as they were reached.
    pub nodes: Vec<Node>,
    /// How many of them are inputs.
    pub inputs: usize,
    /// The node that wrote each slot last.
    pub last: BTreeMap<u32, NodeId>,
}

impl Graph {
    /// Runs a subject.
    ///
    /// # Errors
    /// The evaluator's.
    pub fn of(subject: &Subject) -> Result<Self, Error> {
        let mut tracer = Tracer::new(subject);
        subject.run::<f32>(&mut tracer)?;
        Ok(Self { nodes: tracer.nodes, inputs: tracer.inputs, last: tracer.last })
    }

    /// The nodes that a slot comes from in any way.
    pub fn sources(&self, slot: u32) -> BTreeSet<NodeId> {
        self.closure(slot, |node| {
            let decided = node.decided_by.iter().chain(&node.called_by);
            node.reads.iter().chain(&node.looked_up).chain(decided).copied().collect()
        })
    }

    /// Those from which a derivative may lead to it: neither through textures nor through decisions.
    pub fn smooth_sources(&self, slot: u32) -> BTreeSet<NodeId> {
        self.closure(slot, |node| node.reads.iter().copied().collect())
    }

    fn closure(&self, slot: u32, next: impl Fn(&Node) -> Vec<NodeId>) -> BTreeSet<NodeId> {
        let mut open: Vec<NodeId> = self.last.get(&slot).copied().into_iter().collect();
        let mut found = BTreeSet::new();
        while let Some(node) = open.pop() {
            if found.insert(node) {
                open.extend(next(&self.nodes[node]));
            }
        }
        found
    }
}

struct Tracer<'a> {
    subject: &'a Subject,
    walk: Walk,
    names: Nodes,
    nodes: Vec<Node>,
    inputs: usize,
    last: BTreeMap<u32, NodeId>,
    stored: Vec<(u32, u32, usize)>,
    /// For each frame, the decisions that it is below: where each ends, and its node.
    decisions: Vec<Vec<(SlotRange, NodeId)>>,
}

impl<'a> Tracer<'a> {
    fn new(subject: &'a Subject) -> Self {
        let mut nodes = Vec::new();
        let mut last = BTreeMap::new();
        for variable in subject.program.variables() {
            let is_input = match variable.kind {
                VariableKind::Parameter => variable.function == Some(subject.function()),
                VariableKind::Buffer => true,
                _ => false,
            };
            let VariablePlace::At { slot, stride: _ } = variable.place else { continue };
            if is_input {
                for (name, first, count) in leaves(variable, slot) {
                    last.extend((first..first + count).map(|slot| (slot, nodes.len())));
                    nodes.push(Node::new(Origin::Input(name, first, count)));
                }
            }
        }
        Self {
            subject,
            walk: Walk::new(subject.function()),
            names: Nodes::default(),
            inputs: nodes.len(),
            nodes,
            last,
            stored: stored_variables(subject),
            decisions: vec![Vec::new()],
        }
    }

    /// The node of the statement that a frame is in.
    fn node(&mut self, depth: usize) -> Option<NodeId> {
        let mut count = self.nodes.len();
        let mut new = Vec::new();
        let node = self.names.of(&self.walk, depth, &mut count, &mut |depth| new.push(depth))?;
        for depth in new {
            let frame = self.walk.frames.get(depth)?;
            let origin = Origin::Statement(frame.statement?, frame.function, depth);
            self.nodes.push(Node::new(origin));
            let calling = depth.checked_sub(1).and_then(|caller| self.node(caller));
            if let Some(node) = self.nodes.last_mut() {
                node.called_by = calling;
            }
        }
        Some(node)
    }

    fn trace(&mut self, seen: &Executed<'_, f32>, node: NodeId) {
        let decisions = self.decisions.get_mut(seen.depth);
        if let Some(decisions) = decisions {
            decisions.retain(|(range, _)| range.contains(&seen.pc));
            let others = decisions.iter().map(|(_, decision)| *decision);
            self.nodes[node].decided_by.extend(others.filter(|decision| *decision != node));
            if let Action::Branch { end, .. } = seen.action {
                decisions.push((seen.pc..end, node));
            }
        }
        let (last, own) = (&self.last, &mut self.nodes[node]);
        let is_lookup = seen.action == Action::Texture;
        let reads = if is_lookup { &mut own.looked_up } else { &mut own.reads };
        seen.read(&mut |range| {
            let sources = range.filter_map(|slot| last.get(&slot).copied());
            reads.extend(sources.filter(|source| *source != node));
        });
        if let Some(read) = seen.texture() {
            self.nodes[node].textures.insert(read.name);
        }
        let written = seen.written();
        let after = self.stored.partition_point(|(first, _, _)| *first < written.end);
        for (_, end, index) in self.stored[..after].iter().rev() {
            if *end <= written.start {
                break;
            }
            self.nodes[node].gives.insert(*index);
        }
        self.last.extend(written.map(|slot| (slot, node)));
    }
}

impl Observer<f32> for Tracer<'_> {
    fn ahead(&mut self, next: &mut Executed<'_, f32>) -> Result<(), Error> {
        let motion = self.walk.end(&self.subject.statements, next);
        if motion.is_ended
            && let Some(node) = self.node(next.depth)
        {
            self.nodes[node].runs += 1;
        }
        self.walk.begin(&self.subject.statements, next, &motion);
        self.decisions.resize_with(self.walk.frames.len(), Vec::new);
        Ok(())
    }

    fn see(&mut self, seen: &mut Executed<'_, f32>) -> Result<(), Error> {
        if !matches!(seen.action, Action::Call { .. } | Action::Return)
            && let Some(node) = self.node(seen.depth)
        {
            self.trace(seen, node);
        }
        Ok(())
    }
}

impl Node {
    fn new(origin: Origin) -> Self {
        Self {
            origin,
            reads: BTreeSet::new(),
            looked_up: BTreeSet::new(),
            decided_by: BTreeSet::new(),
            called_by: None,
            runs: 0,
            gives: BTreeSet::new(),
            textures: BTreeSet::new(),
        }
    }
}

/// The scalars, vectors and matrices of a variable: name, first slot and how many scalars.
fn leaves(variable: &Variable, slot: u32) -> Vec<(String, u32, u32)> {
    let is_whole = |shape: &Shape| !matches!(shape, Shape::Array(..) | Shape::Struct(_));
    let parts = variable.shape.leaves(usize::MAX, is_whole).into_iter();
    let leaf = |ShapePart { name, first, shape }: ShapePart| {
        (format!("{}{name}", variable.name), slot + first, shape.scalars())
    };
    parts.map(leaf).collect()
}

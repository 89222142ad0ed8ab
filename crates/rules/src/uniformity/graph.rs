//! Nodes, and edges to what they depend on.

use std::collections::VecDeque;

use rustc_hash::FxHashMap;

use super::Place;

pub type NodeId = u32;

/// What may differ between invocations.
pub const VARYING: NodeId = 0;
/// Control flow where the function begins.
pub const START: NodeId = 1;

/// Why a node is in the way from a requirement to what varies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    None,
    /// A condition that decides whether control flow gets somewhere.
    Condition,
    /// A value.
    Value,
}

struct Node {
    /// The last edge of this node.
    edge: u32,
    place: Place,
    role: Role,
}

struct Edge {
    to: NodeId,
    /// The edge of the same node before this one.
    next: u32,
}

/// How many nodes and edges the graph of a function has at most: some 100 MB.
const MOST: usize = 4 << 20;

const NO_EDGE: u32 = u32::MAX;
const NO_PLACE: Place = Place { start: 0, end: 0 };

pub struct Graph {
    nodes: Vec<Node>,
    edges: Vec<Edge>,
    /// The number of the last search that reached each node.
    reached: Vec<u32>,
    search: u32,
}

impl Graph {
    /// A graph with [`VARYING`] and [`START`].
    pub fn new() -> Self {
        let mut graph =
            Self { nodes: Vec::new(), edges: Vec::new(), reached: Vec::new(), search: 0 };
        graph.node();
        graph.node();
        graph
    }

    /// Whether nodes or edges are missing, since there would be too many.
    pub fn is_full(&self) -> bool {
        self.nodes.len() + self.edges.len() >= MOST
    }

    pub fn node(&mut self) -> NodeId {
        self.marked(NO_PLACE, Role::None)
    }

    pub fn marked(&mut self, place: Place, role: Role) -> NodeId {
        if self.is_full() {
            return VARYING;
        }
        self.nodes.push(Node { edge: NO_EDGE, place, role });
        self.reached.push(0);
        self.nodes.len() as NodeId - 1
    }

    pub fn edge(&mut self, from: NodeId, to: NodeId) {
        if from != to && from != VARYING && !self.is_full() {
            let next = self.nodes[from as usize].edge;
            self.edges.push(Edge { to, next });
            self.nodes[from as usize].edge = self.edges.len() as u32 - 1;
        }
    }

    /// A node that depends on others.
    pub fn joined(&mut self, on: &[NodeId]) -> NodeId {
        let node = self.node();
        on.iter().for_each(|other| self.edge(node, *other));
        node
    }

    /// Begins a search. What it reaches is found by [`Self::is_reached`].
    pub fn begin_search(&mut self) {
        self.search += 1;
    }

    pub fn is_reached(&self, node: NodeId) -> bool {
        self.reached[node as usize] == self.search
    }

    /// Goes on with a search from a node, past what it reached before.
    pub fn reach(&mut self, from: NodeId) {
        let mut open = vec![from];
        while let Some(node) = open.pop() {
            if std::mem::replace(&mut self.reached[node as usize], self.search) != self.search {
                open.extend(self.targets(node));
            }
        }
    }

    fn targets(&self, node: NodeId) -> impl Iterator<Item = NodeId> {
        let edge = |at: u32| self.edges.get(at as usize);
        let edges = std::iter::successors(edge(self.nodes[node as usize].edge), move |last| {
            edge(last.next)
        });
        edges.map(|edge| edge.to)
    }

    /// The shortest way from a node to [`VARYING`], if there is one.
    pub fn way_to_varying(&mut self, from: NodeId) -> Option<Vec<NodeId>> {
        self.begin_search();
        let mut before: FxHashMap<NodeId, NodeId> = FxHashMap::default();
        let mut open = VecDeque::from([from]);
        self.reached[from as usize] = self.search;
        while let Some(node) = open.pop_front() {
            if node == VARYING {
                let mut way: Vec<NodeId> =
                    std::iter::successors(Some(node), |at| before.get(at).copied()).collect();
                way.reverse();
                return Some(way);
            }
            for to in self.targets(node).collect::<Vec<_>>() {
                if std::mem::replace(&mut self.reached[to as usize], self.search) != self.search {
                    before.insert(to, node);
                    open.push_back(to);
                }
            }
        }
        None
    }

    /// The nodes from which there is a way to [`VARYING`].
    pub fn all_varying(&self) -> Vec<bool> {
        let mut sources: Vec<Vec<NodeId>> = vec![Vec::new(); self.nodes.len()];
        for node in 0..self.nodes.len() as NodeId {
            self.targets(node).for_each(|to| sources[to as usize].push(node));
        }
        let mut varies = vec![false; self.nodes.len()];
        let mut open = vec![VARYING];
        while let Some(node) = open.pop() {
            if !std::mem::replace(&mut varies[node as usize], true) {
                open.extend(&sources[node as usize]);
            }
        }
        varies
    }

    /// The places on a way: of the first condition, and of the last value.
    pub fn explain(&self, way: &[NodeId]) -> (Option<Place>, Option<Place>) {
        let of = |role: Role| move |node: &&NodeId| self.nodes[**node as usize].role == role;
        let place = |node: &NodeId| self.nodes[*node as usize].place;
        let condition = way.iter().find(of(Role::Condition)).map(place);
        (condition, way.iter().rev().find(of(Role::Value)).map(place))
    }
}

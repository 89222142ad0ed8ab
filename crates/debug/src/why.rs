//! Backwards: the statements and inputs that made a value, each with its share.
//!
//! The share of a number is how many percent more the value gets if that number gets one percent
//! more, to first order. It is a derivative, which dual numbers give: each run has some of them. What
//! a `let` in a loop names counts in all turns, and a variable with its last value. Integers,
//! comparisons and textures have no derivative; what the value comes from through these is listed
//! without a share.

use std::collections::{BTreeMap, BTreeSet};

use lamplight_eval::{
    Action, DUAL_SEEDS, Dual, Error, Executed, Number, Observer, Shape, SlotKind, Variable,
    VariableKind, VariablePlace,
};

use crate::graph::{Graph, NodeId, Nodes, Origin};
use crate::subject::Subject;
use crate::text::StatementId;
use crate::walk::Walk;

/// The most numbers whose share is computed.
const MOST_SEEDS: usize = 4096;

/// Why a value is what it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Why {
    /// The value that was asked about.
    pub value: f64,
    /// What it comes from, in the order of the run: inputs first.
    pub causes: Vec<Cause>,
    /// Whether there were too many numbers to compute the share of each.
    pub is_cut: bool,
}

/// A number that a value comes from, or a statement that gives none with a derivative.
#[derive(Debug, Clone, PartialEq)]
pub struct Cause {
    /// The statement; `None` for an input.
    pub statement: Option<StatementId>,
    /// How many calls deep.
    pub depth: usize,
    /// Its name, with the component; for a statement that gives no name, nothing.
    pub name: String,
    /// Its value, in a loop the last one; `None` for a statement that gives no name.
    pub value: Option<f64>,
    /// How many percent the asked value grows if this grows by one percent. `None` if either is 0, or
    /// without a derivative.
    pub share: Option<f64>,
    /// By how much the asked value grows for each unit that this grows; `None` without a derivative.
    pub slope: Option<f64>,
    /// What there is instead of a derivative, or beside it.
    pub instead: Vec<String>,
}

/// Why a run did not answer.
#[derive(Debug, Clone, PartialEq)]
pub enum WhyError {
    /// Nothing has that name; these are the names that there are.
    Unknown(Vec<String>),
    /// The name has several numbers: with these parts.
    Several(Vec<String>),
    /// The run did not end.
    Run(Error),
}

impl From<Error> for WhyError {
    fn from(error: Error) -> Self {
        Self::Run(error)
    }
}

/// What made a value: the last one of a variable, or a component of what the subject returns.
///
/// # Errors
/// A name that nothing has or that has several numbers, and those of the evaluator.
pub fn why(subject: &Subject, asked: &str) -> Result<Why, WhyError> {
    let slot = find_slot(subject, asked)?;
    let graph = Graph::of(subject)?;
    let sources = graph.sources(slot);
    let mut seeds = seeds_of(subject, &graph, &sources);
    let is_cut = seeds.len() > MOST_SEEDS;
    seeds.truncate(MOST_SEEDS);
    let (mut value, mut effects) = (0.0, Vec::new());
    // One run more, if there is nothing to seed.
    let batches = seeds.chunks(AT_ONCE).chain(seeds.is_empty().then_some(&[][..]));
    for some in batches {
        let mut run = SeededRun::new(subject, &graph, some, slot);
        subject.run::<Dual>(&mut run)?;
        value = run.result.value();
        effects.extend(run.effects());
    }
    let smooth = graph.smooth_sources(slot);
    let reached = Reached { graph: &graph, sources: &sources, smooth: &smooth, asked: value };
    Ok(Why { value, causes: reached.causes(&seeds, &effects), is_cut })
}

/// How many numbers one run has as seeds: each has a relative and an absolute derivative.
const AT_ONCE: usize = DUAL_SEEDS / 2;

/// What a seed was, and what it does to the asked value.
#[derive(Debug, Clone, Copy)]
struct Effect {
    value: f64,
    /// The growth of the asked value, for the growth of the seed by its own size.
    relative: f64,
    /// The same, for its growth by 1.
    absolute: f64,
}

/// A number whose derivative is asked for.
#[derive(Debug, Clone)]
struct Seed {
    node: NodeId,
    name: String,
    place: VariablePlace,
    /// Which of the scalars at the place.
    index: u32,
    kind: SlotKind,
    /// Whether only the last value counts.
    is_last: bool,
    /// The name without the component.
    variable: String,
}

/// The numbers that the nodes give.
fn seeds_of(subject: &Subject, graph: &Graph, sources: &BTreeSet<NodeId>) -> Vec<Seed> {
    let mut seeds = Vec::new();
    let lets = lets_of(subject);
    for &id in sources {
        let node = &graph.nodes[id];
        match &node.origin {
            Origin::Input(name, slot, count) => {
                let place = VariablePlace::At { slot: *slot, stride: 1 };
                let kinds = input_kinds(subject, *slot);
                for index in 0..*count {
                    let (variable, kind) = (name.clone(), kinds(index));
                    let name = component_name(name, index, *count);
                    let is_last = false;
                    seeds.push(Seed { node: id, name, place, index, kind, is_last, variable });
                }
            }
            Origin::Statement(statement, function, _) => {
                let own = lets.get(statement).into_iter().flatten();
                for variable in node.gives.iter().chain(own) {
                    let variable = &subject.program.variables()[*variable];
                    if variable.function.is_none_or(|of| of == *function) {
                        seeds.extend(variable_seeds(id, variable));
                    }
                }
            }
        }
    }
    seeds
}

fn lets_of(subject: &Subject) -> BTreeMap<StatementId, Vec<usize>> {
    let mut lets: BTreeMap<StatementId, Vec<usize>> = BTreeMap::new();
    for (index, variable) in subject.program.variables().iter().enumerate() {
        if let (VariableKind::Let, Some(at)) =
            (variable.kind, subject.statements.of_variable(index))
        {
            lets.entry(at).or_default().push(index);
        }
    }
    lets
}

/// The kinds of the scalars of the variable that has a slot.
fn input_kinds(subject: &Subject, slot: u32) -> impl Fn(u32) -> SlotKind + '_ {
    let holds = move |variable: &&Variable| match variable.place {
        VariablePlace::At { slot: first, stride: 1 } => {
            (first..first + variable.shape.scalars()).contains(&slot)
        }
        _ => false,
    };
    let variable = subject.program.variables().iter().find(holds);
    let kinds = variable.map_or(Vec::new(), |variable| variable.shape.kinds(usize::MAX));
    let first = variable.map_or(0, |variable| match variable.place {
        VariablePlace::At { slot, .. } | VariablePlace::Through { slot, .. } => slot,
    });
    move |index| kinds.get((slot - first + index) as usize).copied().unwrap_or(SlotKind::Uint)
}

/// The most scalars of one variable that are seeds.
const MOST_PARTS: usize = 16;

fn variable_seeds(node: NodeId, variable: &Variable) -> Vec<Seed> {
    let kinds = variable.shape.kinds(MOST_PARTS);
    let count = variable.shape.scalars();
    let seed = |(index, kind): (u32, SlotKind)| {
        let name = component_name(&variable.name, index, count);
        let is_last = variable.kind != VariableKind::Let;
        let (place, variable) = (variable.place, variable.name.clone());
        Seed { node, name, place, index, kind, is_last, variable }
    };
    (0..count).zip(kinds).map(seed).collect()
}

fn component_name(name: &str, index: u32, count: u32) -> String {
    match (count, ["x", "y", "z", "w"].get(index as usize)) {
        (1, _) => name.to_owned(),
        (2..=4, Some(component)) => format!("{name}.{component}"),
        _ => format!("{name}[{index}]"),
    }
}

/// A run in which some numbers are seeds.
struct SeededRun<'a> {
    subject: &'a Subject,
    graph: &'a Graph,
    walk: Walk,
    names: Nodes,
    count: NodeId,
    seeds: &'a [Seed],
    /// The last value of each seed, and how often its statement ran.
    values: Vec<(f64, u64)>,
    /// The slot that is asked about.
    slot: u32,
    result: Dual,
    is_started: bool,
}

impl<'a> SeededRun<'a> {
    fn new(subject: &'a Subject, graph: &'a Graph, seeds: &'a [Seed], slot: u32) -> Self {
        Self {
            subject,
            graph,
            walk: Walk::new(subject.function()),
            names: Nodes::default(),
            count: graph.inputs,
            seeds,
            values: vec![(0.0, 0); seeds.len()],
            slot,
            result: Dual::default(),
            is_started: false,
        }
    }

    /// Makes the numbers of a node seeds.
    fn seed(&mut self, is_meant: impl Fn(NodeId) -> bool, memory: &mut [Dual]) {
        for (index, seed) in self.seeds.iter().enumerate().filter(|(_, seed)| is_meant(seed.node)) {
            let slot = seed.place.slot(seed.index, memory) as usize;
            let Some(slot) = memory.get_mut(slot) else { continue };
            let value = match seed.kind {
                SlotKind::Float => slot.value(),
                SlotKind::Sint => f64::from(slot.word() as i32),
                _ => f64::from(slot.word()),
            };
            let runs = self.values[index].1 + 1;
            self.values[index] = (value, runs);
            let is_counted = !seed.is_last || runs >= self.graph.nodes[seed.node].runs;
            if seed.kind == SlotKind::Float && is_counted {
                *slot = slot.seeded(2 * index, value).seeded(2 * index + 1, 1.0);
            }
        }
    }

    fn node(&mut self, depth: usize) -> Option<NodeId> {
        self.names.of(&self.walk, depth, &mut self.count, &mut |_| ())
    }

    fn effects(&self) -> Vec<Effect> {
        let slopes = self.result.slopes();
        let effect = |(index, (value, _)): (usize, &(f64, u64))| Effect {
            value: *value,
            relative: slopes[2 * index],
            absolute: slopes[2 * index + 1],
        };
        self.values.iter().enumerate().map(effect).collect()
    }
}

impl Observer<Dual> for SeededRun<'_> {
    fn ahead(&mut self, next: &mut Executed<'_, Dual>) -> Result<(), Error> {
        if !std::mem::replace(&mut self.is_started, true) {
            let inputs = self.graph.inputs;
            self.seed(|node| node < inputs, next.memory);
        }
        let motion = self.walk.end(&self.subject.statements, next);
        if motion.is_ended
            && let Some(node) = self.node(next.depth)
        {
            self.seed(|other| other == node, next.memory);
        }
        if let Some(slot) = next.memory.get(self.slot as usize) {
            self.result = *slot;
        }
        self.walk.begin(&self.subject.statements, next, &motion);
        Ok(())
    }

    fn see(&mut self, seen: &mut Executed<'_, Dual>) -> Result<(), Error> {
        if !matches!(seen.action, Action::Call { .. } | Action::Return) {
            // The graph's names need the same questions in the same order.
            self.node(seen.depth);
        }
        Ok(())
    }
}

/// The nodes that a value comes from.
struct Reached<'a> {
    graph: &'a Graph,
    sources: &'a BTreeSet<NodeId>,
    /// Those from which a derivative may lead to the value.
    smooth: &'a BTreeSet<NodeId>,
    asked: f64,
}

impl Reached<'_> {
    /// The causes in the order of the run, inputs first.
    fn causes(&self, seeds: &[Seed], effects: &[Effect]) -> Vec<Cause> {
        let mut causes = Vec::new();
        let mut deciding = BTreeSet::new();
        for &id in self.sources {
            deciding.extend(self.graph.nodes[id].decided_by.iter().copied());
        }
        for &id in self.sources {
            let own: Vec<(&Seed, Effect)> = seeds
                .iter()
                .zip(effects.iter().copied())
                .filter(|(seed, _)| seed.node == id)
                .collect();
            let instead = self.instead_of(id, &deciding);
            let has_effect = |variable: &str| {
                own.iter().any(|(seed, effect)| seed.variable == variable && effect.absolute != 0.0)
            };
            let mut is_listed = false;
            for (seed, effect) in &own {
                // Components without effect say nothing where others have some.
                if effect.absolute == 0.0 && has_effect(&seed.variable) {
                    continue;
                }
                is_listed = true;
                causes.push(self.cause(seed, *effect, &instead));
            }
            if !is_listed && !instead.is_empty() {
                let (name, value, share, slope) = (String::new(), None, None, None);
                let (statement, depth) = self.place_of(id);
                causes.push(Cause { statement, depth, name, value, share, slope, instead });
            }
        }
        causes
    }

    fn place_of(&self, id: NodeId) -> (Option<StatementId>, usize) {
        match self.graph.nodes[id].origin {
            Origin::Statement(statement, _, depth) => (Some(statement), depth),
            Origin::Input(..) => (None, 0),
        }
    }

    /// What a node does beside computing numbers.
    fn instead_of(&self, id: NodeId, deciding: &BTreeSet<NodeId>) -> Vec<String> {
        let textures = self.graph.nodes[id].textures.iter();
        let mut instead: Vec<String> =
            textures.map(|name| format!("reads the texture `{name}`")).collect();
        instead.extend(deciding.contains(&id).then(|| "decides what runs".to_owned()));
        instead
    }

    fn cause(&self, seed: &Seed, effect: Effect, instead: &[String]) -> Cause {
        let (statement, depth) = self.place_of(seed.node);
        let mut instead = instead.to_vec();
        let has_slope = seed.kind == SlotKind::Float && self.smooth.contains(&seed.node);
        if seed.kind != SlotKind::Float {
            instead.push("an integer".to_owned());
        } else if !has_slope && instead.is_empty() {
            instead.push("only through a texture or a decision".to_owned());
        } else if !effect.absolute.is_finite() {
            instead.push("not finite".to_owned());
        }
        let is_known = has_slope && effect.absolute.is_finite();
        let share = effect.relative / self.asked;
        let has_share = is_known && effect.value != 0.0 && share.is_finite();
        Cause {
            statement,
            depth,
            name: seed.name.clone(),
            value: Some(effect.value),
            share: has_share.then_some(share),
            slope: is_known.then_some(effect.absolute),
            instead,
        }
    }
}

/// The slot of a number by its name, such as `sum`, `color.r` or `lamp.position.x`.
fn find_slot(subject: &Subject, asked: &str) -> Result<u32, WhyError> {
    let (name, path) = match asked.find(['.', '[']) {
        Some(at) => (&asked[..at], &asked[at..]),
        None => (asked, ""),
    };
    let names = || {
        let all = subject.program.variables().iter().map(|one| one.name.clone());
        let sorted: BTreeSet<String> = all.chain(["color".to_owned()]).collect();
        sorted.into_iter().collect::<Vec<_>>()
    };
    let variables = subject.program.variables();
    let own = |one: &&Variable| one.name == name && one.function == Some(subject.function());
    let any = |one: &&Variable| one.name == name && one.kind != VariableKind::Result;
    let result = || subject.result().filter(|_| name == "color");
    let found = variables.iter().rev().find(own).or_else(|| variables.iter().rev().find(any));
    let variable = found.or_else(result).ok_or_else(|| WhyError::Unknown(names()))?;
    let index = scalar_at(&variable.shape, path).map_err(|parts| {
        WhyError::Several(parts.into_iter().map(|part| format!("{name}{part}")).collect())
    })?;
    match variable.place {
        VariablePlace::At { slot, stride } => Ok(slot + index * stride),
        VariablePlace::Through { .. } => Err(WhyError::Unknown(names())),
    }
}

/// Which scalar a path names, or the paths of those that it may mean.
fn scalar_at(shape: &Shape, path: &str) -> Result<u32, Vec<String>> {
    match shape.follow(path) {
        Ok(part) if part.shape.is_scalar() => Ok(part.first),
        _ => {
            let parts = shape.leaves(MOST_PARTS, Shape::is_scalar);
            Err(parts.into_iter().map(|part| part.name).collect())
        }
    }
}

//! What callers need to know of a function.

use super::expression::pointer_parameter;
use super::graph::{Graph, NodeId, Role, START, VARYING};
use super::{Function, Local, Module, Place, Problem, Rule, Severity, Walk};
use crate::behaviour::{Behaviour, of_block};
use crate::names::stage_of;
use crate::syntax::{Attribute, ExprKind, LocalId, Member};
use rustc_hash::FxHashMap;

/// A built-in function that asks for something uniform.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Operation {
    pub rule: Rule,
    pub name: String,
    pub place: Place,
    /// The argument that must be uniform; otherwise control flow.
    pub argument: Option<usize>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Requirement {
    pub severity: Severity,
    pub operation: Operation,
}

#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Parameter {
    /// Its value must be uniform.
    pub value: Option<Requirement>,
    /// What it points to must be uniform.
    pub contents: Option<Requirement>,
    pub reaches_result: bool,
    pub contents_reach_result: bool,
    pub becomes_varying: bool,
    /// Parameters whose values get into what it points to.
    pub value_sources: Vec<usize>,
    /// Parameters whose contents do.
    pub contents_sources: Vec<usize>,
}

/// What callers notice of a function.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Summary {
    /// Control flow must be uniform where it is called.
    pub(super) call_site: Option<Requirement>,
    pub(super) result_varies: bool,
    pub(super) parameters: Vec<Parameter>,
}

impl Summary {
    /// The same without the places and the names of what asks for uniformity.
    pub(crate) fn without_places(mut self) -> Self {
        let parameters = self.parameters.iter_mut();
        let values = parameters.flat_map(|one| [&mut one.value, &mut one.contents]);
        for requirement in values.chain([&mut self.call_site]).flatten() {
            requirement.operation.place = Place { start: 0, end: 0 };
            requirement.operation.name.clear();
        }
        self
    }
}

/// A node that must be uniform.
pub struct Required {
    node: NodeId,
    requirement: Requirement,
    /// The call in this function.
    call: Place,
}

/// The nodes of a parameter: its value, and what it points to.
struct ParameterNodes {
    value: NodeId,
    contents: Option<NodeId>,
}

pub fn analyse(
    module: &Module<'_, '_>,
    function: &Function<'_>,
    summaries: &[Option<Summary>],
) -> (Summary, Vec<Problem>) {
    let stage = stage_of(function);
    let mut graph = Graph::new();
    let result = graph.node();
    let mut walk = Walk {
        module,
        summaries,
        graph,
        locals: FxHashMap::default(),
        values: Vec::new(),
        exits: Vec::new(),
        filters: module.tree.filters.clone(),
        pointers: Vec::new(),
        result,
        outputs: Vec::new(),
        required: Vec::new(),
    };
    walk.filters.extend(function.filters.iter().cloned());
    let parameters: Vec<ParameterNodes> = function
        .parameters
        .iter()
        .enumerate()
        .map(|(at, parameter)| {
            let id = function.first_local + at as LocalId;
            walk.parameter((at, id), parameter, stage)
        })
        .collect();
    walk.block(START, &function.body);
    if of_block(&function.body).has(Behaviour::NEXT) {
        walk.output_contents();
    }
    if walk.graph.is_full() {
        let message = format!("`{}` is too large to find out what is uniform in it", function.name);
        let problem = Problem::new(Rule::Depth, function.place, message);
        return (walk.summarise(&parameters).0, vec![problem]);
    }
    walk.summarise(&parameters)
}

impl<'t> Walk<'_, 't> {
    fn parameter(
        &mut self,
        (at, id): (usize, LocalId),
        parameter: &Member<'t>,
        stage: Option<&str>,
    ) -> ParameterNodes {
        let value = self.graph.marked(parameter.place, Role::Value);
        if let Some(stage) = stage {
            let target = if self.is_uniform_input(parameter, stage) { START } else { VARYING };
            self.graph.edge(value, target);
            self.locals.insert(id, Local::Value(value));
            return ParameterNodes { value, contents: None };
        }
        let pointer = self.module.type_of(parameter.of_type).filter(|(kind, _)| *kind == "ptr");
        let Some((_, template)) = pointer else {
            self.locals.insert(id, Local::Value(value));
            return ParameterNodes { value, contents: None };
        };
        let space = self.module.template_word(template, 0);
        let access = self.module.template_word(template, 2);
        let slot = self.values.len();
        let view = pointer_parameter(space, access, slot, value);
        self.locals.insert(id, Local::Pointer(view));
        if space != Some("function") {
            return ParameterNodes { value, contents: None };
        }
        let contents = self.graph.node();
        self.values.push(contents);
        self.pointers.push((at, slot));
        let output = self.graph.node();
        self.outputs.push(output);
        ParameterNodes { value, contents: Some(contents) }
    }

    /// Whether an input of an entry point is the same for all invocations.
    fn is_uniform_input(&self, parameter: &Member<'t>, stage: &str) -> bool {
        match self.module.structure(parameter.of_type) {
            Some(structure) => self.module.tree.structs[structure]
                .members
                .iter()
                .all(|member| self.is_uniform_builtin(&member.attributes, stage)),
            None => self.is_uniform_builtin(&parameter.attributes, stage),
        }
    }

    fn is_uniform_builtin(&self, attributes: &[Attribute<'t>], stage: &str) -> bool {
        let builtin = attributes.iter().find(|attribute| attribute.name == "builtin");
        let name = builtin.and_then(|attribute| attribute.arguments.first());
        let Some(ExprKind::Name { name, .. }) = name.map(|id| self.module.tree.kind(*id)) else {
            return false;
        };
        match *name {
            "workgroup_id" | "num_workgroups" | "num_subgroups" => true,
            "subgroup_size" => stage == "compute",
            _ => false,
        }
    }

    pub fn require(&mut self, node: NodeId, requirement: Requirement, call: Place) {
        self.required.push(Required { node, requirement, call });
    }

    fn summarise(mut self, parameters: &[ParameterNodes]) -> (Summary, Vec<Problem>) {
        let mut summary = Summary {
            parameters: vec![Parameter::default(); parameters.len()],
            ..Summary::default()
        };
        let problems = self.settle_requirements(&mut summary, parameters);
        self.graph.begin_search();
        self.graph.reach(self.result);
        summary.result_varies = self.graph.is_reached(VARYING);
        for (found, nodes) in summary.parameters.iter_mut().zip(parameters) {
            found.reaches_result = self.graph.is_reached(nodes.value);
            found.contents_reach_result =
                nodes.contents.is_some_and(|contents| self.graph.is_reached(contents));
        }
        for (at, (parameter, _)) in self.pointers.clone().into_iter().enumerate() {
            self.graph.begin_search();
            let found = &mut summary.parameters[parameter];
            self.graph.reach(self.outputs[at]);
            found.becomes_varying = self.graph.is_reached(VARYING);
            let of = |wanted: &dyn Fn(&ParameterNodes) -> bool| {
                let all = parameters.iter().enumerate();
                all.filter(|(_, nodes)| wanted(nodes)).map(|(at, _)| at).collect::<Vec<_>>()
            };
            found.value_sources = of(&|nodes| self.graph.is_reached(nodes.value));
            found.contents_sources =
                of(&|nodes| nodes.contents.is_some_and(|contents| self.graph.is_reached(contents)));
        }
        (summary, problems)
    }

    /// Reports the requirements that are not met, and hands on those that callers must meet.
    fn settle_requirements(
        &mut self,
        summary: &mut Summary,
        parameters: &[ParameterNodes],
    ) -> Vec<Problem> {
        let mut problems = Vec::new();
        let mut required = std::mem::take(&mut self.required);
        // Of those that a caller must meet, the heaviest one counts.
        required.sort_by_key(|one| std::cmp::Reverse(one.requirement.severity));
        self.graph.begin_search();
        for one in &required {
            self.graph.reach(one.node);
            let hand_on = |to: &mut Option<Requirement>, is_reached: bool| {
                if is_reached && to.is_none() {
                    *to = Some(one.requirement.clone());
                }
            };
            hand_on(&mut summary.call_site, self.graph.is_reached(START));
            for (found, nodes) in summary.parameters.iter_mut().zip(parameters) {
                hand_on(&mut found.value, self.graph.is_reached(nodes.value));
                if let Some(contents) = nodes.contents {
                    hand_on(&mut found.contents, self.graph.is_reached(contents));
                }
            }
        }
        if self.graph.is_reached(VARYING) {
            let varies = self.graph.all_varying();
            for one in required.iter().filter(|one| varies[one.node as usize]) {
                let way = self.graph.way_to_varying(one.node).unwrap_or_default();
                problems.push(self.problem(one, &way));
            }
        }
        problems
    }

    fn problem(&self, required: &Required, way: &[NodeId]) -> Problem {
        let Operation { rule, name, place, argument } = &required.requirement.operation;
        let message = match argument {
            None => format!("`{name}` in non-uniform control flow"),
            Some(_) => format!("`{name}` with an argument that is not uniform"),
        };
        let (condition, source) = self.graph.explain(way);
        let mut notes = Vec::new();
        if *place != required.call {
            notes.push((required.call, "in this call".to_owned()));
        }
        if let Some(condition) = condition {
            notes.push((condition, "control flow depends on this".to_owned()));
        }
        if let Some(source) = source.filter(|source| Some(*source) != condition) {
            notes.push((source, "this may differ between invocations".to_owned()));
        }
        Problem {
            rule: *rule,
            severity: required.requirement.severity,
            place: *place,
            message,
            notes,
        }
    }
}

//! Calls.

use super::builtin::{self, Demand};
use super::expression::Flow;
use super::graph::{NodeId, Role, VARYING};
use super::summary::{Operation, Parameter, Requirement};
use super::{Filtered, Global, Root, Rule, Severity, View, Walk};
use crate::Place;
use crate::syntax::ExprId;

/// An argument: the uniformity of its value, and what it points to.
struct Argument {
    value: NodeId,
    view: Option<View>,
    /// What it points to, before the call.
    contents: Option<NodeId>,
}

impl<'t> Walk<'_, 't> {
    pub fn call(
        &mut self,
        flow: NodeId,
        id: ExprId,
        callee: &'t str,
        arguments: &[ExprId],
    ) -> Flow {
        let (mut after, mut given) = (flow, Vec::with_capacity(arguments.len()));
        for argument in arguments {
            let (next, one) = self.argument(after, *argument);
            after = next;
            given.push(one);
        }
        // Arguments may change what the arguments before them point to.
        for one in &mut given {
            one.contents = match one.view {
                Some(View { root: Root::Slot(slot), .. }) => Some(self.values[slot]),
                _ => None,
            };
        }
        let place = self.module.tree.place(id);
        let call = self.graph.joined(&[after]);
        let result = self.graph.marked(place, Role::Value);
        self.graph.edge(result, call);
        match self.module.find(callee) {
            Some(Global::Function(function)) => {
                self.call_function(function, place, (call, result), &given);
            }
            None => self.call_builtin(callee, place, (call, result), arguments, &given),
            _ => given.iter().for_each(|one| self.graph.edge(result, one.value)),
        }
        (call, result)
    }

    fn argument(&mut self, flow: NodeId, id: ExprId) -> (NodeId, Argument) {
        match self.view(flow, id) {
            Ok((after, view)) if view.is_pointer => {
                let value = self.graph.marked(self.module.tree.place(id), Role::Value);
                self.graph.edge(value, view.place);
                (after, Argument { value, view: Some(view), contents: None })
            }
            Ok((after, view)) => {
                let value = self.loaded(flow, id, view);
                (after, Argument { value, view: None, contents: None })
            }
            Err((after, value)) => (after, Argument { value, view: None, contents: None }),
        }
    }

    fn call_builtin(
        &mut self,
        name: &'t str,
        place: Place,
        (call, result): (NodeId, NodeId),
        arguments: &[ExprId],
        given: &[Argument],
    ) {
        let builtin = builtin::find(name);
        let is_read = name == "textureLoad"
            && arguments.first().is_some_and(|texture| self.is_written_texture(*texture));
        if builtin.varies || is_read {
            self.graph.edge(result, VARYING);
        }
        given.iter().for_each(|one| self.graph.edge(result, one.value));
        let (severity, rule) = match builtin.demand {
            Demand::Nothing => return,
            Demand::Barrier => (Severity::Default, Rule::Barrier),
            Demand::Derivative => (self.severity(Filtered::DerivativeUniformity), Rule::Derivative),
            Demand::Subgroup => (self.severity(Filtered::SubgroupUniformity), Rule::Subgroup),
        };
        if severity == Severity::Off {
            return;
        }
        let operation = Operation { rule, name: name.to_owned(), place, argument: None };
        if let Some(argument) = builtin.uniform_argument.and_then(|at| given.get(at)) {
            let operation = Operation { argument: builtin.uniform_argument, ..operation.clone() };
            self.require(argument.value, Requirement { severity, operation }, place);
        }
        self.require(call, Requirement { severity, operation }, place);
    }

    fn call_function(
        &mut self,
        function: usize,
        place: Place,
        (call, result): (NodeId, NodeId),
        given: &[Argument],
    ) {
        let summaries = self.summaries;
        let Some(summary) = &summaries[function] else { return };
        if summary.result_varies {
            self.graph.edge(result, VARYING);
        }
        let mut outputs = Vec::new();
        for (parameter, argument) in summary.parameters.iter().zip(given) {
            if let Some(requirement) = &parameter.value {
                self.require(argument.value, requirement.clone(), place);
            }
            if parameter.reaches_result {
                self.graph.edge(result, argument.value);
            }
            let Some(contents) = argument.contents else { continue };
            if let Some(requirement) = &parameter.contents {
                self.require(contents, requirement.clone(), place);
            }
            if parameter.contents_reach_result {
                self.graph.edge(result, contents);
            }
            let Some(View { root: Root::Slot(slot), is_partial, .. }) = argument.view else {
                continue;
            };
            let output = self.output(parameter, place, call, given);
            if is_partial {
                self.graph.edge(output, contents);
            }
            outputs.push((slot, output));
        }
        for (slot, output) in outputs {
            self.values[slot] = output;
        }
        if let Some(requirement) = &summary.call_site {
            self.require(call, requirement.clone(), place);
        }
    }

    /// What a pointer leads to after a call.
    fn output(
        &mut self,
        parameter: &Parameter,
        place: Place,
        call: NodeId,
        given: &[Argument],
    ) -> NodeId {
        let output = self.graph.marked(place, Role::Value);
        self.graph.edge(output, call);
        if parameter.becomes_varying {
            self.graph.edge(output, VARYING);
        }
        for source in &parameter.value_sources {
            self.graph.edge(output, given[*source].value);
        }
        for source in &parameter.contents_sources {
            if let Some(contents) = given[*source].contents {
                self.graph.edge(output, contents);
            }
        }
        output
    }
}

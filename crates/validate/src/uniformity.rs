//! Warns, for GLSL, of derivatives in non-uniform control flow, and of samples that choose their level by
//! derivatives there. GPUs give undefined results, and naga accepts them. WGSL has rules of its own
//! for this ([`super::browsers`]).
//!
//! Values that differ between fragments are followed from the inputs of the fragment stage through
//! expressions, variables, arguments and results. What cannot be followed counts as uniform, since
//! a lint should not give false alarms.

use std::collections::BTreeMap;

use naga::diagnostic_filter::{
    DiagnosticFilter, DiagnosticFilterNode, FilterableTriggeringRule,
    StandardFilterableTriggeringRule,
};
use naga::{Block, Expression, Function, Handle, SampleLevel, ShaderStage, Span, Statement};

use super::Validated;
use lamplight_compose::Composed;
use lamplight_diagnostic::{Diagnostic, Diagnostics, Severity, codes};

/// The most rounds in which facts move from function to function. Longer chains of calls stay
/// unknown.
const ROUNDS: usize = 8;

/// Warnings about the fragment entry points of a module, in the order of its text.
pub fn lint(composed: &Composed, validated: &Validated) -> Diagnostics {
    find_derivatives(validated)
        .iter()
        .filter_map(|(range, finding)| derivative_warning(composed, range.0..range.1, finding))
        .collect()
}

/// Whether there is anything to warn of, whatever text it is in.
pub fn has_lints(validated: &Validated) -> bool {
    !find_derivatives(validated).is_empty()
}

fn find_derivatives(validated: &Validated) -> BTreeMap<(usize, usize), DerivativeFinding> {
    let mut flow = Flow::new(&validated.module);
    if flow.functions.iter().any(|function| function.is_entry) {
        let _ = (0..ROUNDS).find(|_| !flow.round());
    }
    flow.found
}

fn derivative_warning(
    composed: &Composed,
    range: std::ops::Range<usize>,
    finding: &DerivativeFinding,
) -> Option<Diagnostic> {
    let (what, help) = match finding.sample {
        true => (
            "a texture sampled with an implicit level",
            "help: sample before the branch, or give the level or the gradients",
        ),
        false => ("a derivative", "help: take it before the branch"),
    };
    let warning = Diagnostic {
        severity: finding.severity,
        ..Diagnostic::error(
            codes::NON_UNIFORM_DERIVATIVE,
            format!("{what} in non-uniform control flow"),
        )
    };
    let place = composed.map.lookup(range);
    // A lean text has no places at all.
    if place.is_none() && !composed.map.is_empty() {
        return None;
    }
    let warning = place.into_iter().fold(warning, |warning, span| {
        warning.at(span, "other fragments of the quad may skip this branch")
    });
    let cause = finding.cause.to_range().and_then(|range| composed.map.lookup(range));
    let warning = cause
        .into_iter()
        .fold(warning, |warning, span| warning.at(span, "differs between fragments"));
    Some(warning.note(help))
}

/// A derivative in non-uniform control flow.
struct DerivativeFinding {
    sample: bool,
    severity: Severity,
    /// The condition that made control flow non-uniform.
    cause: Span,
}

/// How much a finding in a function weighs, by the filters of the function and of the module; `None`
/// where they turn it off. A message of the severity `info` is a warning.
fn severity_in(module: &naga::Module, function: &Function) -> Option<Severity> {
    let rule =
        FilterableTriggeringRule::Standard(StandardFilterableTriggeringRule::DerivativeUniformity);
    let mut next = function.diagnostic_filter_leaf;
    while let Some(handle) = next {
        let DiagnosticFilterNode { inner, parent } = &module.diagnostic_filters[handle];
        let DiagnosticFilter { new_severity, triggering_rule } = inner;
        if *triggering_rule == rule {
            return match new_severity {
                naga::diagnostic_filter::Severity::Off => None,
                naga::diagnostic_filter::Severity::Info
                | naga::diagnostic_filter::Severity::Warning => Some(Severity::Warning),
                naga::diagnostic_filter::Severity::Error => Some(Severity::Error),
            };
        }
        next = *parent;
    }
    Some(Severity::Warning)
}

/// What is known of one function.
struct FunctionFacts {
    is_entry: bool,
    arguments: Vec<bool>,
    locals: Vec<bool>,
    result: bool,
    /// The condition because of which it is called in non-uniform control flow, if it is.
    non_uniform: Option<Span>,
    /// For each loop, by number: a condition because of which some fragments leave it before
    /// others.
    loops: BTreeMap<usize, Span>,
}

struct Flow<'a> {
    module: &'a naga::Module,
    /// The functions of the module, then all its entry points. Of those, only the fragment entry
    /// points are walked.
    functions: Vec<FunctionFacts>,
    globals: Vec<bool>,
    found: BTreeMap<(usize, usize), DerivativeFinding>,
    changed: bool,
}

impl<'a> Flow<'a> {
    fn new(module: &'a naga::Module) -> Self {
        let known = |function: &Function, is_entry| FunctionFacts {
            is_entry,
            arguments: vec![is_entry; function.arguments.len()],
            locals: vec![false; function.local_variables.len()],
            result: false,
            non_uniform: None,
            loops: BTreeMap::new(),
        };
        let functions = module.functions.iter().map(|(_, function)| known(function, false));
        let entries = module
            .entry_points
            .iter()
            .map(|point| known(&point.function, point.stage == ShaderStage::Fragment));
        let functions = functions.chain(entries).collect();
        Self {
            module,
            functions,
            globals: vec![false; module.global_variables.len()],
            found: BTreeMap::new(),
            changed: false,
        }
    }

    /// Walks every function once, callees first. Returns whether anything new was learnt.
    fn round(&mut self) -> bool {
        self.changed = false;
        let module = self.module;
        for (handle, function) in module.functions.iter() {
            self.walk(handle.index(), function);
        }
        for (index, point) in module
            .entry_points
            .iter()
            .enumerate()
            .filter(|(_, point)| point.stage == ShaderStage::Fragment)
        {
            self.walk(module.functions.len() + index, &point.function);
        }
        self.changed
    }

    fn walk(&mut self, index: usize, function: &'a Function) {
        let mut walk = UniformityWalk {
            varying: self.varying(index, function),
            flow: self,
            index,
            function,
            returned: None,
            left: None,
            loops: 0,
        };
        let non_uniform = walk.flow.functions[index].non_uniform;
        walk.block(&function.body, non_uniform);
    }

    /// Whether each expression differs between fragments. Operands come before the expressions that
    /// use them.
    fn varying(&self, index: usize, function: &Function) -> Vec<bool> {
        let known = &self.functions[index];
        let mut varying: Vec<bool> = Vec::with_capacity(function.expressions.len());
        for (_, expression) in function.expressions.iter() {
            let of =
                |handle: &Handle<Expression>| varying.get(handle.index()).copied().unwrap_or(false);
            let value = match expression {
                Expression::FunctionArgument(argument) => known.arguments[*argument as usize],
                Expression::LocalVariable(variable) => known.locals[variable.index()],
                Expression::GlobalVariable(variable) => self.globals[variable.index()],
                Expression::CallResult(callee) => self.functions[callee.index()].result,
                Expression::Derivative { expr, .. } => of(expr),
                Expression::Load { pointer } => of(pointer),
                Expression::Access { base, index } => of(base) || of(index),
                Expression::AccessIndex { base, .. } => of(base),
                Expression::Splat { value, .. } | Expression::Swizzle { vector: value, .. } => {
                    of(value)
                }
                Expression::Unary { expr, .. } | Expression::As { expr, .. } => of(expr),
                Expression::Relational { argument, .. } => of(argument),
                Expression::Compose { components, .. } => components.iter().any(of),
                Expression::Binary { left, right, .. } => of(left) || of(right),
                Expression::Select { condition, accept, reject } => {
                    of(condition) || of(accept) || of(reject)
                }
                Expression::Math { arg, arg1, arg2, arg3, .. } => {
                    of(arg) || [arg1, arg2, arg3].into_iter().flatten().any(of)
                }
                Expression::ImageSample { coordinate, .. }
                | Expression::ImageLoad { coordinate, .. } => of(coordinate),
                _ => false,
            };
            varying.push(value);
        }
        varying
    }
}

/// The walk over one function.
struct UniformityWalk<'w, 'a> {
    varying: Vec<bool>,
    flow: &'w mut Flow<'a>,
    index: usize,
    function: &'a Function,
    /// The condition because of which some fragments have returned.
    returned: Option<Span>,
    /// The condition because of which some have left this iteration of the innermost loop.
    left: Option<Span>,
    /// How many loops were met so far.
    loops: usize,
}

impl<'a> UniformityWalk<'_, 'a> {
    fn block(&mut self, block: &'a Block, non_uniform: Option<Span>) {
        for statement in block.iter() {
            let non_uniform = non_uniform.or(self.returned).or(self.left);
            self.statement(statement, non_uniform);
        }
    }

    fn statement(&mut self, statement: &'a Statement, non_uniform: Option<Span>) {
        match statement {
            Statement::Emit(range) => {
                if let Some(cause) = non_uniform {
                    range.clone().for_each(|handle| self.emit(handle, cause));
                }
            }
            Statement::Block(block) => self.block(block, non_uniform),
            Statement::If { condition, accept, reject } => {
                let non_uniform = self.made_non_uniform_by(*condition, non_uniform);
                self.block(accept, non_uniform);
                self.block(reject, non_uniform);
            }
            Statement::Switch { selector, cases } => {
                let non_uniform = self.made_non_uniform_by(*selector, non_uniform);
                // A `break` in a case only leaves the switch.
                let outer = self.left;
                for case in cases {
                    self.block(&case.body, non_uniform);
                    self.left = outer;
                }
            }
            Statement::Loop { body, continuing, .. } => {
                let outer = self.left.take();
                let number = self.loops;
                self.loops += 1;
                let before = self.flow.functions[self.index].loops.get(&number).copied();
                self.block(body, non_uniform.or(before));
                self.block(continuing, non_uniform.or(before).or(self.left));
                self.leave(number);
                self.left = outer;
            }
            Statement::Break | Statement::Continue => self.left = self.left.or(non_uniform),
            Statement::Return { value } => {
                self.returned = self.returned.or(non_uniform);
                let varies =
                    non_uniform.is_some() || value.is_some_and(|value| self.varying[value.index()]);
                self.learn(varies, |flow, index| &mut flow.functions[index].result);
            }
            Statement::Store { pointer, value } => {
                self.store(*pointer, non_uniform.is_some() || self.varying[value.index()])
            }
            Statement::Call { function, arguments, .. } => {
                self.call(*function, arguments, non_uniform)
            }
            _ => {}
        }
    }

    /// Notes that fragments left an iteration of a loop at different times. The iterations after it
    /// are then non-uniform, which the next walk uses.
    fn leave(&mut self, number: usize) {
        let loops = &mut self.flow.functions[self.index].loops;
        if let Some(cause) = self.left.filter(|_| !loops.contains_key(&number)) {
            loops.insert(number, cause);
            self.flow.changed = true;
        }
    }

    fn made_non_uniform_by(
        &self,
        condition: Handle<Expression>,
        non_uniform: Option<Span>,
    ) -> Option<Span> {
        non_uniform.or_else(|| {
            self.varying[condition.index()].then(|| self.function.expressions.get_span(condition))
        })
    }

    fn emit(&mut self, handle: Handle<Expression>, cause: Span) {
        let sample = match &self.function.expressions[handle] {
            Expression::ImageSample { level: SampleLevel::Auto | SampleLevel::Bias(_), .. } => true,
            Expression::Derivative { .. } => false,
            _ => return,
        };
        let Some(severity) = severity_in(self.flow.module, self.function) else { return };
        if let Some(range) = self.function.expressions.get_span(handle).to_range() {
            self.flow.found.entry((range.start, range.end)).or_insert(DerivativeFinding {
                sample,
                severity,
                cause,
            });
        }
    }

    /// Notes that the variable behind a pointer holds a value that differs between fragments.
    fn store(&mut self, pointer: Handle<Expression>, varies: bool) {
        let mut root = pointer;
        while let Expression::Access { base, .. } | Expression::AccessIndex { base, .. } =
            &self.function.expressions[root]
        {
            root = *base;
        }
        match &self.function.expressions[root] {
            Expression::LocalVariable(variable) => {
                self.learn(varies, |flow, index| {
                    &mut flow.functions[index].locals[variable.index()]
                });
            }
            Expression::GlobalVariable(variable) => {
                self.learn(varies, |flow, _| &mut flow.globals[variable.index()])
            }
            _ => {}
        }
    }

    fn call(
        &mut self,
        callee: Handle<Function>,
        arguments: &[Handle<Expression>],
        non_uniform: Option<Span>,
    ) {
        for (position, argument) in arguments.iter().enumerate() {
            let varies = self.varying[argument.index()];
            self.learn(varies, |flow, _| &mut flow.functions[callee.index()].arguments[position]);
        }
        let known = &mut self.flow.functions[callee.index()].non_uniform;
        if known.is_none() && non_uniform.is_some() {
            *known = non_uniform;
            self.flow.changed = true;
        }
    }

    fn learn(
        &mut self,
        holds: bool,
        fact: impl for<'f> FnOnce(&'f mut Flow<'a>, usize) -> &'f mut bool,
    ) {
        let index = self.index;
        let fact = fact(self.flow, index);
        if holds && !*fact {
            *fact = true;
            self.flow.changed = true;
        }
    }
}

//! Statements as GLSL.

use lamplight_diagnostic::Diagnostic;

use super::condition::{chains_of, directive};
use super::dialect::Dialect;
use super::expression::{LocalRole, Writer};
use super::hlsl::made_array;
use super::lines::{Indented, comment_text};
use super::order::check_order;
use super::outputs::{reads_outputs, write_zeros};
use super::range::{COUNTER, range_of};
use super::stage::StageResult;
use crate::tree::{Binary, Block, Callee, Case, Expression, ExpressionKind, Field, Line, Local};
use crate::tree::{Meaning, Node, Statement, Type};
use crate::wesl::untranslated;

/// Writes the statements of a function.
pub struct BodyWriter<'a> {
    pub writer: Writer<'a>,
    pub out: Indented,
    /// What a stage returns: `None` in a function that is no stage.
    pub result: Option<StageResult>,
    /// The outputs of the stage that are zero at first.
    pub unset: Vec<Node<Field>>,
}

impl BodyWriter<'_> {
    /// The statements of a block, without its braces. `is_tail` where nothing comes after them.
    pub fn nodes(&mut self, block: &Block, is_tail: bool) -> Result<(), Diagnostic> {
        let chains = chains_of(&block.nodes);
        let count = chains.len();
        for (index, chain) in chains.iter().enumerate() {
            let is_last = is_tail && index + 1 == count && block.end.is_empty();
            for (number, (condition, nodes)) in chain.arms.iter().enumerate() {
                let mut is_first = true;
                for (place, node) in nodes.iter().enumerate() {
                    let mut lead = node.lead.as_slice();
                    if chain.is_conditional && is_first {
                        if lead.first() == Some(&Line::Blank) {
                            lead = &lead[1..];
                            if number == 0 {
                                self.out.blank();
                            }
                        }
                        self.out.raw(&directive(number, *condition));
                    }
                    is_first = false;
                    self.lead(lead);
                    self.node(node, is_last && place + 1 == nodes.len())?;
                }
            }
            if chain.is_conditional {
                self.out.raw("#endif\n");
            }
        }
        self.lead(&block.end);
        Ok(())
    }

    fn lead(&mut self, lines: &[Line]) {
        for line in lines {
            match line {
                Line::Blank => self.out.blank(),
                Line::Comment(text) => self.out.line(&comment_text(text)),
            }
        }
    }

    fn node(&mut self, node: &Node<Statement>, is_tail: bool) -> Result<(), Diagnostic> {
        self.statement(&node.body, is_tail)?;
        if let Some(comment) = &node.trail {
            self.out.trail(&comment_text(comment));
        }
        Ok(())
    }

    fn value(&self, value: &Expression) -> Result<String, Diagnostic> {
        check_order(&self.writer, value)?;
        self.writer.whole(value, self.out.depth)
    }

    fn statement(&mut self, statement: &Statement, is_tail: bool) -> Result<(), Diagnostic> {
        match statement {
            Statement::Return(value) => self.returned(value.as_ref(), is_tail),
            Statement::If { condition, accept, reject } => {
                self.branches(condition, accept, reject.as_deref(), "")
            }
            Statement::Block(block) => {
                self.out.line("{");
                self.inner(block)?;
                self.out.line("}");
                Ok(())
            }
            Statement::Group(block) => self.nodes(block, is_tail),
            Statement::For { first, condition, step, body } => {
                self.counted_loop(first.as_deref(), condition.as_ref(), step.as_deref(), body)
            }
            Statement::While { condition, body } => {
                let condition = self.value(condition)?;
                self.out.line(&format!("while ({}) {{", bare(&condition)));
                self.inner(body)?;
                self.out.line("}");
                Ok(())
            }
            Statement::Loop { body, continuing, break_if } => {
                self.endless_loop(body, continuing.as_ref(), break_if.as_ref())
            }
            Statement::Switch { selector, cases, end } => self.switch(selector, cases, end),
            Statement::Assertion(text) => {
                self.out.line(&format!("// {}", text.replace('\n', " ")));
                Ok(())
            }
            Statement::Empty => Ok(()),
            simple => {
                if let Some(text) = self.simple(simple)? {
                    self.out.line(&format!("{text};"));
                }
                Ok(())
            }
        }
    }

    fn inner(&mut self, block: &Block) -> Result<(), Diagnostic> {
        self.out.depth += 1;
        self.nodes(block, false)?;
        self.out.depth -= 1;
        Ok(())
    }

    /// A statement that ends with `;`, without that. Nothing for one that has become nothing.
    fn simple(&mut self, statement: &Statement) -> Result<Option<String>, Diagnostic> {
        match statement {
            Statement::Local(local) => self.local(local),
            Statement::Assign { target, operator, value } => {
                self.assignment(target, *operator, value).map(Some)
            }
            Statement::Step { target, is_up } => {
                let target = self.value(target)?;
                Ok(Some(format!("{target}{}", if *is_up { "++" } else { "--" })))
            }
            Statement::Call(value) => self.value(value).map(Some),
            Statement::Break => Ok(Some("break".to_owned())),
            Statement::Continue => Ok(Some("continue".to_owned())),
            Statement::Discard if self.writer.dialect() == Dialect::Msl => {
                Ok(Some("discard_fragment()".to_owned()))
            }
            Statement::Discard => Ok(Some("discard".to_owned())),
            _ => Ok(None),
        }
    }

    fn local(&mut self, local: &Local) -> Result<Option<String>, Diagnostic> {
        let ty = local.ty.as_ref().unwrap_or(&Type::Unknown);
        if let Some(LocalRole::Outputs(fields)) = self.writer.locals.get(&local.span.start) {
            write_zeros(&self.writer, fields, &self.unset, &mut self.out)?;
            return Ok(None);
        }
        if matches!(ty, Type::Pointer(..)) {
            return Err(untranslated(local.span, "a pointer with a name")
                .note("help: use the variable itself"));
        }
        let (name, lengths) = self.writer.names.declared_type(ty, local.span)?;
        if let Some(value) = local.value.as_ref().filter(|_| !local.is_variable) {
            let range = range_of(value, &self.writer.counters);
            self.writer.counters.insert(local.span.start, range);
        }
        let value = match &local.value {
            Some(value) if self.is_list(value) => self.list(value)?,
            Some(value) => self.value(value)?,
            None => self.writer.zero(ty, local.span)?,
        };
        let constant = if local.is_constant { "const " } else { "" };
        let declared = self.local_name(local);
        Ok(Some(format!("{constant}{name} {declared}{lengths} = {value}")))
    }

    fn local_name(&self, local: &Local) -> String {
        match self.writer.locals.get(&local.span.start) {
            Some(LocalRole::Named(name)) => name.clone(),
            _ => local.name.clone(),
        }
    }

    fn assignment(
        &mut self,
        target: &Expression,
        operator: Option<Binary>,
        value: &Expression,
    ) -> Result<String, Diagnostic> {
        let has_effects = self.writer.facts.has_effects(value);
        if has_effects && (operator.is_some() || has_index(target)) {
            return Err(untranslated(value.span, "a value with effects in this assignment")
                .note("help: give the value a name first"));
        }
        let text = self.value(target)?;
        let Some(operator) = operator else {
            return Ok(format!("{text} = {}", self.value(value)?));
        };
        let depth = self.out.depth;
        check_order(&self.writer, value)?;
        if let Some(special) = self.writer.special_binary(operator, target, value, depth)? {
            return match self.writer.is_cheap(target) {
                true => Ok(format!("{text} = {}", special.0)),
                false => Err(untranslated(target.span, "this target of a compound assignment")),
            };
        }
        let is_truth = target.ty == Type::BOOL;
        let value = self.writer.operand(value, if is_truth { 4 } else { 0 }, depth)?;
        Ok(match (operator, is_truth) {
            (Binary::BitAnd, true) => format!("{text} = {text} && {value}"),
            (Binary::BitOr, true) => format!("{text} = {text} || {value}"),
            _ => format!("{text} {}= {value}", operator.spelling().0),
        })
    }

    /// Whether HLSL writes a value as a list, in a declaration.
    fn is_list(&self, value: &Expression) -> bool {
        self.writer.dialect() == Dialect::Hlsl && made_array(value).is_some()
    }

    fn list(&self, value: &Expression) -> Result<String, Diagnostic> {
        check_order(&self.writer, value)?;
        self.writer.array_list(
            &value.ty,
            made_array(value).unwrap_or_default(),
            true,
            self.out.depth,
        )
    }

    fn returned(&mut self, value: Option<&Expression>, is_tail: bool) -> Result<(), Diagnostic> {
        let Some(result) = self.result.clone() else {
            if let Some(value) = value.filter(|value| self.is_list(value)) {
                let (ty, lengths) = self.writer.names.declared_type(&value.ty, value.span)?;
                let name = self.writer.free_local("made");
                let list = self.list(value)?;
                self.out.line(&format!("{ty} {name}{lengths} = {list};"));
                self.out.line(&format!("return {name};"));
                return Ok(());
            }
            let text = value.map(|value| self.value(value)).transpose()?;
            let text = text.map_or("return;".to_owned(), |text| format!("return {text};"));
            self.out.line(&text);
            return Ok(());
        };
        if let Some(value) = value {
            for line in self.outputs(&result, value)? {
                self.out.line(&line);
            }
        }
        if !is_tail {
            self.out.line("return;");
        }
        Ok(())
    }

    /// The assignments that give a stage's result to its outputs.
    fn outputs(&self, result: &StageResult, value: &Expression) -> Result<Vec<String>, Diagnostic> {
        if let ExpressionKind::Name(_, Meaning::Local(numbers)) = &value.bare().kind
            && let Some(LocalRole::Outputs(_)) = self.writer.role(numbers)
        {
            return Ok(Vec::new());
        }
        if let StageResult::One(variable) = result {
            return Ok(vec![format!("{variable} = {};", self.value(value)?)]);
        }
        let refused = || untranslated(value.span, "a result that is neither made here nor a `var`");
        let ExpressionKind::Call { callee: Callee::Construct(_), arguments, .. } =
            &value.bare().kind
        else {
            return Err(refused());
        };
        if let Some(argument) =
            arguments.iter().find(|argument| reads_outputs(&argument.value, &self.writer))
        {
            let what = "a result that is made of what the stage would have returned";
            return Err(untranslated(argument.value.span, what));
        }
        let StageResult::Fields(fields) = result else { return Err(refused()) };
        let fields: Vec<_> = match arguments.len() == fields.len() {
            true => fields.iter().collect(),
            false => fields.iter().filter(|(is_always, _)| *is_always).collect(),
        };
        if fields.len() != arguments.len() {
            return Err(refused());
        }
        let mut lines = Vec::new();
        for ((_, field), argument) in fields.into_iter().zip(arguments) {
            lines.push(format!("{} = {};", field.variable, self.value(&argument.value)?));
        }
        Ok(lines)
    }

    fn branches(
        &mut self,
        condition: &Expression,
        accept: &Block,
        reject: Option<&Node<Statement>>,
        before: &str,
    ) -> Result<(), Diagnostic> {
        let text = self.value(condition)?;
        self.out.line(&format!("{before}if ({}) {{", bare(&text)));
        self.inner(accept)?;
        let Some(node) = reject else {
            self.out.line("}");
            return Ok(());
        };
        if !node.lead.is_empty() {
            self.out.depth += 1;
            self.lead(&node.lead);
            self.out.depth -= 1;
        }
        match &node.body {
            Statement::If { condition, accept, reject } => {
                self.branches(condition, accept, reject.as_deref(), "} else ")
            }
            Statement::Block(block) => {
                self.out.line("} else {");
                self.inner(block)?;
                self.out.line("}");
                Ok(())
            }
            _ => Err(untranslated(node.span, "what follows this `else`")),
        }
    }

    fn counted_loop(
        &mut self,
        first: Option<&Statement>,
        condition: Option<&Expression>,
        step: Option<&Statement>,
        body: &Block,
    ) -> Result<(), Diagnostic> {
        let counter = super::counter::counter_of(first, condition, step, body);
        self.writer.counters.extend(counter.map(|number| (number, COUNTER)));
        let first = first.map(|one| self.simple(one)).transpose()?.flatten().unwrap_or_default();
        let condition = condition.map(|one| self.value(one)).transpose()?.unwrap_or_default();
        let step = step.map(|one| self.simple(one)).transpose()?.flatten().unwrap_or_default();
        let space = |text: &str| if text.is_empty() { "" } else { " " };
        let (before, behind) = (space(&condition), space(&step));
        self.out.line(&format!("for ({first};{before}{condition};{behind}{step}) {{"));
        self.inner(body)?;
        self.out.line("}");
        if let Some(counter) = counter {
            self.writer.counters.remove(&counter);
        }
        Ok(())
    }

    /// `loop`. What its `continuing` does must also happen after a `continue`.
    fn endless_loop(
        &mut self,
        body: &Block,
        continuing: Option<&Block>,
        break_if: Option<&Expression>,
    ) -> Result<(), Diagnostic> {
        let continues = super::counter::continues(body);
        let steps = continuing.map_or(&[][..], |block| block.nodes.as_slice());
        if continues && (break_if.is_some() || steps.len() > 1) {
            let place = break_if.map(|value| value.span).or(steps.first().map(|node| node.span));
            if let Some(span) = place {
                return Err(untranslated(span, "a `continuing` after a `continue`")
                    .note("help: `while` and `for` have forms in GLSL"));
            }
        }
        let mut step = String::new();
        if let (true, [node]) = (continues, steps) {
            // GLSL's `for` takes its step outside of the scope of the body.
            let is_local = matches!(node.body, Statement::Local(_));
            if !is_local && !super::counter::uses_locals(&node.body, body) {
                step = self.simple(&node.body)?.unwrap_or_default();
            }
            if step.is_empty() || node.branch.is_some() {
                return Err(untranslated(node.span, "this `continuing` after a `continue`"));
            }
        }
        let head =
            if step.is_empty() { "for (;;) {".to_owned() } else { format!("for (;; {step}) {{") };
        self.out.line(&head);
        self.inner(body)?;
        self.out.depth += 1;
        if let Some(block) = continuing.filter(|_| step.is_empty()) {
            self.nodes(block, false)?;
        }
        if let Some(condition) = break_if {
            let condition = self.value(condition)?;
            self.out.line(&format!("if ({}) {{", bare(&condition)));
            self.out.line("    break;");
            self.out.line("}");
        }
        self.out.depth -= 1;
        self.out.line("}");
        Ok(())
    }

    fn switch(
        &mut self,
        selector: &Expression,
        cases: &[Node<Case>],
        end: &[Line],
    ) -> Result<(), Diagnostic> {
        let selector = self.value(selector)?;
        self.out.line(&format!("switch ({}) {{", bare(&selector)));
        self.out.depth += 1;
        for chain in chains_of(cases) {
            for (number, (condition, nodes)) in chain.arms.iter().enumerate() {
                if chain.is_conditional {
                    self.out.raw(&directive(number, *condition));
                }
                for node in nodes {
                    self.case(node)?;
                }
            }
            if chain.is_conditional {
                self.out.raw("#endif\n");
            }
        }
        self.lead(end);
        self.out.depth -= 1;
        self.out.line("}");
        Ok(())
    }

    fn case(&mut self, node: &Node<Case>) -> Result<(), Diagnostic> {
        self.lead(&node.lead);
        let Case { selectors, is_default, body } = &node.body;
        let mut labels = Vec::new();
        for selector in selectors {
            labels.push(format!("case {}:", self.value(selector)?));
        }
        if *is_default {
            labels.push("default:".to_owned());
        }
        let last = labels.pop().unwrap_or_default();
        labels.iter().for_each(|label| self.out.line(label));
        self.out.line(&format!("{last} {{"));
        self.inner(body)?;
        let ends = body.nodes.last().is_some_and(|node| {
            node.branch.is_none()
                && matches!(
                    node.body,
                    Statement::Return(_) | Statement::Break | Statement::Continue
                )
        });
        if !ends || self.result.is_some() {
            self.out.line("    break;");
        }
        self.out.line("}");
        Ok(())
    }
}

fn has_index(target: &Expression) -> bool {
    let mut found = false;
    target.walk(&mut |part| {
        if let ExpressionKind::Index(_, index) = &part.kind {
            found |= !matches!(index.bare().kind, ExpressionKind::Number(_));
        }
    });
    found
}

/// A condition without the parentheses that its author wrote around all of it.
fn bare(text: &str) -> &str {
    let Some(inner) = text.strip_prefix('(').and_then(|text| text.strip_suffix(')')) else {
        return text;
    };
    let mut depth = 0_i32;
    for letter in inner.chars() {
        depth += match letter {
            '(' => 1,
            ')' => -1,
            _ => 0,
        };
        if depth < 0 {
            return text;
        }
    }
    inner
}

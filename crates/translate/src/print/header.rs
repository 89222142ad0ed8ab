//! The heads of functions.

use lamplight_diagnostic::Diagnostic;

use super::condition::chains_of;
use super::dialect::Dialect;
use super::expression::{LocalRole, Writer};
use super::item::{ItemWriter, write_chain, write_line};
use super::lines::{Indented, comment_text};
use super::texture::pair_parameter;
use crate::tree::{Field, Function, Node, Space, Type};
use crate::wesl::untranslated;

/// Where the parameters of a function get lines of their own.
const LONGEST_LINE: usize = 120;

/// A parameter as text, and those that it was.
struct Parameter<'a> {
    text: String,
    nodes: Vec<&'a Node<Field>>,
}

impl ItemWriter<'_> {
    /// The head of a function, and the brace that opens its body.
    pub fn header(
        &self,
        function: &Function,
        writer: &Writer<'_>,
        out: &mut Indented,
    ) -> Result<(), Diagnostic> {
        let result = function.result.as_ref().map_or(&Type::Nothing, |field| &field.ty);
        let name = self.own_name(&function.name);
        let head = format!("{} {name}", self.names.returned_type(result, function.span)?);
        let kept: Vec<&Node<Field>> = function
            .parameters
            .iter()
            .filter(|node| !self.facts.is_stage_type(&node.body.ty))
            .collect();
        if kept.iter().any(|node| node.branch.is_some()) {
            return self.conditional_header(&head, &kept, writer, out);
        }
        let parameters = self.parameters(&kept, writer)?;
        let texts: Vec<&str> = parameters.iter().map(|one| one.text.as_str()).collect();
        let line = format!("{head}({}) {{", texts.join(", "));
        let is_long = line.len() > LONGEST_LINE && parameters.len() > 1;
        let has_comments = kept.iter().any(|node| !node.lead.is_empty() || node.trail.is_some());
        if !is_long && !has_comments {
            out.line(&line);
            return Ok(());
        }
        out.line(&format!("{head}("));
        out.depth += 1;
        let last = parameters.len() - 1;
        for (index, Parameter { text, nodes }) in parameters.iter().enumerate() {
            let comma = if index == last { "" } else { "," };
            nodes.iter().flat_map(|node| &node.lead).for_each(|line| write_line(line, out));
            out.line(&format!("{text}{comma}"));
            let trails = nodes.iter().filter_map(|node| node.trail.as_ref());
            trails.for_each(|comment| out.trail(&comment_text(comment)));
        }
        out.depth -= 1;
        out.line(") {");
        Ok(())
    }

    /// Parameters as texts. A texture and the sampler behind it may be one macro.
    fn parameters<'n>(
        &self,
        kept: &[&'n Node<Field>],
        writer: &Writer<'_>,
    ) -> Result<Vec<Parameter<'n>>, Diagnostic> {
        let mut found = Vec::new();
        let mut at = 0;
        while let Some(node) = kept.get(at) {
            let pair = kept.get(at + 1).and_then(|next| self.pair(node, next, writer));
            let (text, count) = match pair {
                Some(pair) => (pair, 2),
                None => (self.parameter(&node.body, writer)?, 1),
            };
            found.push(Parameter { text, nodes: kept[at..at + count].to_vec() });
            at += count;
        }
        Ok(found)
    }

    /// Two parameters as one macro.
    fn pair(
        &self,
        texture: &Node<Field>,
        sampler: &Node<Field>,
        writer: &Writer<'_>,
    ) -> Option<String> {
        let (texture, sampler) = (&texture.body, &sampler.body);
        let names = (parameter_name(texture, writer), parameter_name(sampler, writer));
        let pair = pair_parameter(&texture.ty, &sampler.ty, (names.0, names.1));
        pair.filter(|_| self.has_macros)
    }

    fn parameter(&self, field: &Field, writer: &Writer<'_>) -> Result<String, Diagnostic> {
        let (word, mark, ty) = match &field.ty {
            Type::Pointer(Space::Function | Space::Private, target)
                if self.names.dialect == Dialect::Msl =>
            {
                ("thread ", "&", &**target)
            }
            Type::Pointer(Space::Function | Space::Private, target) => ("inout ", "", &**target),
            Type::Pointer(..) => return Err(untranslated(field.span, "a pointer into a buffer")),
            other => ("", "", other),
        };
        let (ty, lengths) = self.names.declared_type(ty, field.span)?;
        let name = parameter_name(field, writer);
        Ok(format!("{word}{ty}{mark} {name}{lengths}"))
    }

    /// A header with parameters that have conditions. The commas belong to the conditions: those
    /// before the last parameter that always exists stand behind, and those after it before.
    fn conditional_header(
        &self,
        head: &str,
        kept: &[&Node<Field>],
        writer: &Writer<'_>,
        out: &mut Indented,
    ) -> Result<(), Diagnostic> {
        if let Some(node) = kept.windows(2).find(|two| self.pair(two[0], two[1], writer).is_some())
        {
            let what = "a texture beside parameters that have conditions";
            return Err(untranslated(node[0].span, what));
        }
        let nodes: Vec<Node<Field>> = kept.iter().map(|node| (*node).clone()).collect();
        let last_fixed = nodes.iter().rposition(|node| node.branch.is_none());
        let chains = chains_of(&nodes);
        let is_one = chains.len() == 1 && chains[0].arms.iter().all(|(_, arm)| arm.len() == 1);
        if last_fixed.is_none() && !is_one {
            return Err(untranslated(nodes[0].span, "parameters that all have conditions"));
        }
        out.line(&format!("{head}("));
        out.depth += 1;
        let mut at = 0;
        for chain in &chains {
            write_chain(chain, out, |node, out| {
                let text = self.parameter(&node.body, writer)?;
                node.lead.iter().for_each(|line| write_line(line, out));
                match last_fixed {
                    Some(fixed) if at < fixed => out.line(&format!("{text},")),
                    Some(fixed) if at > fixed => out.line(&format!(", {text}")),
                    _ => out.line(&text),
                }
                if let Some(comment) = &node.trail {
                    out.trail(&comment_text(comment));
                }
                at += 1;
                Ok(())
            })?;
        }
        out.depth -= 1;
        out.line(") {");
        Ok(())
    }
}

fn parameter_name<'a>(field: &'a Field, writer: &'a Writer<'_>) -> &'a str {
    match writer.locals.get(&field.span.start) {
        Some(LocalRole::Named(name)) => name,
        _ => &field.name,
    }
}

//! Items as GLSL.

use std::collections::BTreeMap;

use lamplight_diagnostic::Diagnostic;

use super::condition::{Chain, chains_of, directive};
use super::expression::{LocalRole, Writer};
use super::facts::Facts;
use super::lines::{Indented, comment_text};
use super::rename::local_names;
use super::stage::{Direction, StageResult, stage_fields, stage_result};
use super::statement::BodyWriter;
use super::texture::pair_parameter;
use super::words::{declared_type, glsl_name, type_name};
use crate::tree::{Constant, Field, Function, Item, ItemPath, Line, Node, Space, Stage, Structure};
use crate::tree::{Type, Variable};
use crate::types::Globals;
use crate::wesl::untranslated;

/// What all items of a file are written with.
#[derive(Clone, Copy)]
pub struct ItemWriter<'a> {
    pub globals: &'a Globals,
    pub facts: &'a Facts,
    pub module: &'a [String],
    pub has_macros: bool,
    /// The samplers that textures are read with, by name.
    pub samplers: &'a BTreeMap<String, String>,
    /// The structures of the module, for the blocks of its uniforms.
    pub structures: &'a BTreeMap<String, (Vec<Line>, Structure)>,
}

impl<'a> ItemWriter<'a> {
    fn writer(&self) -> Writer<'a> {
        Writer {
            globals: self.globals,
            facts: self.facts,
            has_macros: self.has_macros,
            locals: BTreeMap::new(),
            counters: Default::default(),
            samplers: self.samplers,
        }
    }

    /// An item with the comments above it.
    pub fn item(&self, node: &Node<Item>, out: &mut Indented) -> Result<(), Diagnostic> {
        let mut lead: Vec<Line> = node.lead.clone();
        if let Item::Variable(variable) = &node.body
            && let Some((own, _)) = self.block_structure(variable)
        {
            lead.splice(0..0, own.iter().cloned());
            lead.retain(|line| *line != Line::Blank);
        }
        let first = lead.iter().position(|line| *line != Line::Blank).unwrap_or(lead.len());
        lead[first..].iter().for_each(|line| write_line(line, out));
        let before = out.text.len();
        match &node.body {
            Item::Function(function) => self.function(function, out)?,
            Item::Structure(structure) => self.structure(structure, out)?,
            Item::Constant(constant) => self.constant(constant, out)?,
            Item::Variable(variable) => self.variable(variable, out)?,
            Item::Alias(..) => {}
            Item::Assertion(text) => out.line(&format!("// {}", text.replace('\n', " "))),
        }
        if let Some(comment) = node.trail.as_ref().filter(|_| out.text.len() > before) {
            out.trail(&comment_text(comment));
        }
        Ok(())
    }

    fn constant(&self, constant: &Constant, out: &mut Indented) -> Result<(), Diagnostic> {
        let Constant { name, given, value, id, span } = constant;
        let ty = given.as_ref().unwrap_or(&value.ty);
        let (ty, lengths) = declared_type(ty, *span)?;
        let value = self.writer().whole(value, 0)?;
        let layout = id.map_or(String::new(), |id| format!("layout(constant_id = {id}) "));
        out.line(&format!("{layout}const {ty} {}{lengths} = {value};", glsl_name(name)));
        Ok(())
    }

    fn structure(&self, structure: &Structure, out: &mut Indented) -> Result<(), Diagnostic> {
        out.line(&format!("struct {} {{", glsl_name(&structure.name)));
        self.members(structure, out)?;
        out.line("};");
        let path = ItemPath { module: self.module.to_vec(), name: structure.name.clone() };
        match self.facts.needs_zero(&path) {
            true => self.zero_function(&path, structure, out),
            false => Ok(()),
        }
    }

    fn members(&self, structure: &Structure, out: &mut Indented) -> Result<(), Diagnostic> {
        out.depth += 1;
        for chain in chains_of(&structure.members) {
            write_chain(&chain, out, |node, out| {
                node.lead.iter().for_each(|line| write_line(line, out));
                let Field { name, ty, span, binding: _ } = &node.body;
                let (ty, lengths) = declared_type(ty, *span)?;
                out.line(&format!("{ty} {}{lengths};", glsl_name(name)));
                if let Some(comment) = &node.trail {
                    out.trail(&comment_text(comment));
                }
                Ok(())
            })?;
        }
        structure.end.iter().for_each(|line| write_line(line, out));
        out.depth -= 1;
        Ok(())
    }

    /// A function that makes a structure of zeros, as a `var` without a value is in WGSL.
    fn zero_function(
        &self,
        path: &ItemPath,
        structure: &Structure,
        out: &mut Indented,
    ) -> Result<(), Diagnostic> {
        let name = glsl_name(&structure.name);
        out.blank();
        out.line(&format!("/// Zero in every member of `{name}`."));
        out.line(&format!("{name} {}() {{", self.facts.zero_function(path)));
        out.depth += 1;
        out.line(&format!("{name} zero;"));
        let writer = self.writer();
        for chain in chains_of(&structure.members) {
            write_chain(&chain, out, |node, out| {
                let zero = writer.zero(&node.body.ty, node.body.span)?;
                out.line(&format!("zero.{} = {zero};", glsl_name(&node.body.name)));
                Ok(())
            })?;
        }
        out.line("return zero;");
        out.depth -= 1;
        out.line("}");
        Ok(())
    }

    /// The structure that a uniform is the block of, and the comments above it.
    fn block_structure(&self, variable: &Variable) -> Option<&'a (Vec<Line>, Structure)> {
        match &variable.ty {
            Type::Structure(path) if self.facts.is_block(path) && path.module == self.module => {
                self.structures.get(&path.name)
            }
            _ => None,
        }
    }

    fn variable(&self, variable: &Variable, out: &mut Indented) -> Result<(), Diagnostic> {
        let Variable { name, space, ty, binding, value, span } = variable;
        let place = binding.map(|(set, binding)| format!("set = {set}, binding = {binding}"));
        match (space, place) {
            (Space::Handle, Some(place)) => {
                let ty = type_name(ty, *span)?;
                out.line(&format!("layout({place}) uniform {ty} {};", glsl_name(name)));
                Ok(())
            }
            (Space::Uniform | Space::Storage { .. }, Some(place)) => {
                self.block(variable, &place, out)
            }
            (Space::Private, None) => {
                let (ty_text, lengths) = declared_type(ty, *span)?;
                let value = match value {
                    Some(value) => self.writer().whole(value, 0)?,
                    None => self.writer().zero(ty, *span)?,
                };
                out.line(&format!("{ty_text} {}{lengths} = {value};", glsl_name(name)));
                Ok(())
            }
            (Space::Workgroup, None) => {
                let (ty_text, lengths) = declared_type(ty, *span)?;
                out.line(&format!("shared {ty_text} {}{lengths};", glsl_name(name)));
                Ok(())
            }
            _ => Err(untranslated(*span, "this variable")),
        }
    }

    fn block(
        &self,
        variable: &Variable,
        place: &str,
        out: &mut Indented,
    ) -> Result<(), Diagnostic> {
        let Variable { name, space, ty, span, .. } = variable;
        let (layout, kind) = match space {
            Space::Uniform => ("std140", "uniform"),
            Space::Storage { is_written: true } => ("std430", "buffer"),
            _ => ("std430", "readonly buffer"),
        };
        self.check_layout(ty, *space, variable)?;
        if let Some((_, structure)) = self.block_structure(variable) {
            let block = glsl_name(&structure.name);
            out.line(&format!("layout({layout}, {place}) {kind} {block} {{"));
            self.members(structure, out)?;
            out.line(&format!("}} {};", glsl_name(name)));
            return Ok(());
        }
        if matches!(ty, Type::Structure(_)) {
            return Err(untranslated(
                *span,
                "a structure of a binding that is also used elsewhere",
            )
            .note("help: give the binding a structure of its own"));
        }
        let (ty, lengths) = declared_type(ty, *span)?;
        let name = glsl_name(name);
        let mut block = name.clone();
        if let Some(first) = block.get_mut(0..1) {
            first.make_ascii_uppercase();
        }
        let block = if block == name { format!("{name}Block") } else { block };
        out.line(&format!("layout({layout}, {place}) {kind} {block} {{"));
        out.line(&format!("    {ty} {name}{lengths};"));
        out.line("};");
        Ok(())
    }

    /// Types that have other places in GLSL's layouts than in WGSL's are refused.
    fn check_layout(&self, ty: &Type, space: Space, variable: &Variable) -> Result<(), Diagnostic> {
        let refused = |what: &str| Err(untranslated(variable.span, what));
        match ty {
            Type::Matrix { rows: 2, .. } if space == Space::Uniform => {
                refused("a matrix of two rows in a uniform: its columns are farther apart in GLSL")
            }
            Type::Scalar(_) | Type::Vector(2, _)
                if space == Space::Uniform && variable.ty != *ty && is_element(variable, ty) =>
            {
                refused("an array of such elements in a uniform: they are farther apart in GLSL")
            }
            Type::Array(element, _) => self.check_layout(element, space, variable),
            Type::Structure(path) => {
                for member in self.globals.members(path).unwrap_or_default() {
                    match &member.ty {
                        Type::Array(element, _) => {
                            let is_narrow =
                                matches!(**element, Type::Scalar(_) | Type::Vector(2, _));
                            if is_narrow && space == Space::Uniform {
                                return refused("an array of scalars in a uniform");
                            }
                            self.check_layout(element, space, variable)?;
                        }
                        other => self.check_layout(other, space, variable)?,
                    }
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// A function, or a stage.
    pub fn function(&self, function: &Function, out: &mut Indented) -> Result<(), Diagnostic> {
        let mut writer = self.writer();
        writer.locals = local_names(function);
        self.stage_locals(function, &mut writer)?;
        let result = match function.stage {
            Some(stage) => Some(stage_result(function, stage, self.facts)?),
            None => None,
        };
        match function.stage {
            Some(_) => out.line("void main() {"),
            None => self.header(function, &writer, out)?,
        }
        let inner = Indented { text: std::mem::take(&mut out.text), depth: 1 };
        let mut body = BodyWriter { writer, out: inner, result };
        let written = body.nodes(&function.body, true);
        out.text = body.out.text;
        written?;
        out.line("}");
        Ok(())
    }

    /// What the parameters of a stage and of its functions have become.
    fn stage_locals(&self, function: &Function, writer: &mut Writer<'_>) -> Result<(), Diagnostic> {
        let stage = function.stage.unwrap_or(Stage::Fragment);
        for node in &function.parameters {
            let Field { name, ty, binding, span } = &node.body;
            let role = match (ty, binding) {
                (_, Some(binding)) => {
                    LocalRole::Input(Direction::In.variable(stage, name, &binding.place, *span)?)
                }
                (Type::Structure(path), None) if self.facts.is_stage_structure(path) => {
                    let members = self.facts.stage_members(path);
                    LocalRole::Stage(stage_fields(members, stage, Direction::In)?)
                }
                _ if function.stage.is_some() => {
                    return Err(untranslated(*span, "a parameter of a stage without a place"));
                }
                _ => continue,
            };
            writer.locals.insert(span.start, role);
        }
        if let (Some(stage), Some(StageResult::Fields(_))) =
            (function.stage, self.result_of(function)?)
        {
            let wanted = function.result.as_ref().map(|field| field.ty.clone());
            let item = Item::Function(function.clone());
            let mut found = Vec::new();
            super::visit::item_locals(&item, &mut |local| {
                if local.ty == wanted {
                    found.push(local.span.start);
                }
            });
            if let Some(Type::Structure(path)) = &wanted {
                let members = self.facts.stage_members(path);
                let fields = stage_fields(members, stage, Direction::Out)?;
                for number in found {
                    writer.locals.insert(number, LocalRole::Stage(fields.clone()));
                }
            }
        }
        Ok(())
    }

    fn result_of(&self, function: &Function) -> Result<Option<StageResult>, Diagnostic> {
        match function.stage {
            Some(stage) => stage_result(function, stage, self.facts).map(Some),
            None => Ok(None),
        }
    }

    fn header(
        &self,
        function: &Function,
        writer: &Writer<'_>,
        out: &mut Indented,
    ) -> Result<(), Diagnostic> {
        let result = function.result.as_ref().map_or(&Type::Nothing, |field| &field.ty);
        let head = format!("{} {}", type_name(result, function.span)?, glsl_name(&function.name));
        let kept: Vec<&Node<Field>> = function
            .parameters
            .iter()
            .filter(|node| !self.facts.is_stage_type(&node.body.ty))
            .collect();
        let is_conditional = kept.iter().any(|node| node.branch.is_some());
        if is_conditional {
            return self.conditional_header(&head, function, writer, out);
        }
        let parameters = self.parameters(&kept, writer)?;
        let line = format!("{head}({}) {{", parameters.join(", "));
        let is_long = line.len() > LONGEST_LINE && parameters.len() > 1;
        let has_comments = kept.iter().any(|node| !node.lead.is_empty() || node.trail.is_some());
        match is_long || has_comments {
            false => out.line(&line),
            true => {
                out.line(&format!("{head}("));
                let last = parameters.len() - 1;
                for (index, parameter) in parameters.iter().enumerate() {
                    let comma = if index == last { "" } else { "," };
                    kept_lines(&kept, index, out);
                    out.line(&format!("    {parameter}{comma}"));
                    if let Some(comment) = kept.get(index).and_then(|node| node.trail.as_ref()) {
                        out.trail(&comment_text(comment));
                    }
                }
                out.line(") {");
            }
        }
        Ok(())
    }

    /// Parameters as texts. A texture and the sampler behind it may be one macro.
    fn parameters(
        &self,
        kept: &[&Node<Field>],
        writer: &Writer<'_>,
    ) -> Result<Vec<String>, Diagnostic> {
        let mut texts = Vec::new();
        let mut at = 0;
        while let Some(node) = kept.get(at) {
            let name = parameter_name(&node.body, writer);
            if let Some(next) = kept.get(at + 1).filter(|_| self.has_macros) {
                let names = (name.as_str(), parameter_name(&next.body, writer));
                let pair = pair_parameter(&node.body.ty, &next.body.ty, (names.0, &names.1));
                if let Some(pair) = pair {
                    texts.push(pair);
                    at += 2;
                    continue;
                }
            }
            texts.push(self.parameter(&node.body, &name)?);
            at += 1;
        }
        Ok(texts)
    }

    fn parameter(&self, field: &Field, name: &str) -> Result<String, Diagnostic> {
        let (word, ty) = match &field.ty {
            Type::Pointer(Space::Function | Space::Private, target) => ("inout ", &**target),
            Type::Pointer(..) => return Err(untranslated(field.span, "a pointer into a buffer")),
            other => ("", other),
        };
        let (ty, lengths) = declared_type(ty, field.span)?;
        Ok(format!("{word}{ty} {name}{lengths}"))
    }

    /// A header with parameters that have conditions. The commas belong to the conditions: those
    /// before the last parameter that always exists stand behind, and those after it before.
    fn conditional_header(
        &self,
        head: &str,
        function: &Function,
        writer: &Writer<'_>,
        out: &mut Indented,
    ) -> Result<(), Diagnostic> {
        let nodes: Vec<Node<Field>> = function
            .parameters
            .iter()
            .filter(|node| !self.facts.is_stage_type(&node.body.ty))
            .cloned()
            .collect();
        let last_fixed = nodes.iter().rposition(|node| node.branch.is_none());
        let chains = chains_of(&nodes);
        if last_fixed.is_none() && chains.len() > 1 {
            return Err(untranslated(nodes[0].span, "parameters that all have conditions"));
        }
        out.line(&format!("{head}("));
        out.depth += 1;
        let mut at = 0;
        for chain in &chains {
            write_chain(chain, out, |node, out| {
                let name = parameter_name(&node.body, writer);
                let text = self.parameter(&node.body, &name)?;
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

/// Where the parameters of a function get lines of their own.
const LONGEST_LINE: usize = 120;

/// Whether a type is the element of an array that is a binding.
fn is_element(variable: &Variable, ty: &Type) -> bool {
    matches!(&variable.ty, Type::Array(element, _) if **element == *ty)
}

fn kept_lines(kept: &[&Node<Field>], index: usize, out: &mut Indented) {
    if let Some(node) = kept.get(index) {
        out.depth += 1;
        node.lead.iter().for_each(|line| write_line(line, out));
        out.depth -= 1;
    }
}

fn parameter_name(field: &Field, writer: &Writer<'_>) -> String {
    match writer.locals.get(&field.span.start) {
        Some(LocalRole::Named(name)) => name.clone(),
        _ => glsl_name(&field.name),
    }
}

/// A chain with its directives.
pub fn write_chain<T>(
    chain: &Chain<'_, T>,
    out: &mut Indented,
    mut write: impl FnMut(&Node<T>, &mut Indented) -> Result<(), Diagnostic>,
) -> Result<(), Diagnostic> {
    for (number, (condition, nodes)) in chain.arms.iter().enumerate() {
        if chain.is_conditional {
            out.raw(&directive(number, *condition));
        }
        for node in nodes {
            write(node, out)?;
        }
    }
    if chain.is_conditional {
        out.raw("#endif\n");
    }
    Ok(())
}

/// A line without code.
pub fn write_line(line: &Line, out: &mut Indented) {
    match line {
        Line::Blank => out.blank(),
        Line::Comment(text) => out.line(&comment_text(text)),
    }
}

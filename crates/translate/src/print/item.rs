//! Items as GLSL.

use std::collections::BTreeMap;

use lamplight_diagnostic::Diagnostic;

use super::condition::{Chain, chains_of, directive};
use super::dialect::Dialect;
use super::expression::{LocalRole, Writer};
use super::facts::Facts;
use super::lines::{Indented, comment_text};
use super::names::Names;
use super::outputs::{output_variable, unset_members};
use super::place::{Samplers, parameter_samplers};
use super::rename::{Surroundings, local_names};
use super::stage::{Direction, StageResult, Variables, stage_result};
use super::statement::BodyWriter;
use crate::tree::{Constant, Field, Function, Item, ItemPath, Line, Node, Space, Stage, Structure};
use crate::tree::{Type, Variable};
use crate::types::Globals;
use crate::wesl::untranslated;

/// What all items of a file are written with.
#[derive(Clone, Copy)]
pub struct ItemWriter<'a> {
    pub globals: &'a Globals,
    pub facts: &'a Facts,
    pub names: &'a Names,
    /// The stage whose file this is.
    pub stage: Option<Stage>,
    /// The variables of that stage.
    pub variables: &'a [String],
    pub module: &'a [String],
    pub has_macros: bool,
    /// The samplers that the textures of the module are read with.
    pub samplers: &'a Samplers,
    /// The structures of the module, for the blocks of its uniforms.
    pub structures: &'a BTreeMap<String, (Vec<Line>, Structure)>,
}

impl<'a> ItemWriter<'a> {
    fn own_path(&self, name: &str) -> ItemPath {
        ItemPath { module: self.module.to_vec(), name: name.to_owned() }
    }

    /// The name of an item of the module.
    pub fn own_name(&self, name: &str) -> &'a str {
        self.names.item(&self.own_path(name))
    }

    pub fn writer(&self) -> Writer<'a> {
        Writer {
            globals: self.globals,
            facts: self.facts,
            names: self.names,
            has_macros: self.has_macros,
            locals: BTreeMap::new(),
            counters: Default::default(),
            samplers: self.samplers,
            pairs: BTreeMap::new(),
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
        let (ty, lengths) = self.names.declared_type(ty, *span)?;
        let words = match self.names.dialect {
            Dialect::Glsl => "const",
            Dialect::Hlsl => "static const",
            Dialect::Msl => "constant",
        };
        if self.names.dialect != Dialect::Glsl && id.is_some() {
            return Err(untranslated(*span, "an `override`"));
        }
        let value = match super::hlsl::made_array(value) {
            Some(arguments) if self.names.dialect == Dialect::Hlsl => {
                self.writer().array_list(&value.ty, arguments, true, 0)?
            }
            _ => self.writer().whole(value, 0)?,
        };
        let layout = id.map_or(String::new(), |id| format!("layout(constant_id = {id}) "));
        let name = self.own_name(name);
        out.line(&format!("{layout}{words} {ty} {name}{lengths} = {value};"));
        Ok(())
    }

    fn structure(&self, structure: &Structure, out: &mut Indented) -> Result<(), Diagnostic> {
        out.line(&format!("struct {} {{", self.own_name(&structure.name)));
        self.members(structure, out)?;
        out.line("};");
        let path = self.own_path(&structure.name);
        if self.names.dialect == Dialect::Hlsl && self.facts.is_made(&path) {
            self.make_function(&path, structure, out)?;
        }
        match self.facts.needs_zero(&path) && self.names.dialect != Dialect::Msl {
            true => self.zero_function(&path, structure, out),
            false => Ok(()),
        }
    }

    fn members(&self, structure: &Structure, out: &mut Indented) -> Result<(), Diagnostic> {
        let path = self.own_path(&structure.name);
        out.depth += 1;
        for chain in chains_of(&structure.members) {
            write_chain(&chain, out, |node, out| {
                node.lead.iter().for_each(|line| write_line(line, out));
                let Field { name, ty, span, binding: _ } = &node.body;
                let (ty, lengths) = self.names.declared_type(ty, *span)?;
                let name = self.names.member(&path, name);
                out.line(&format!("{ty} {name}{lengths};"));
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
        let name = self.own_name(&structure.name);
        out.blank();
        out.line(&format!("/// Zero in every member of `{name}`."));
        out.line(&format!("{name} {}() {{", self.names.zero(path)));
        out.depth += 1;
        out.line(&format!("{name} zero;"));
        let writer = self.writer();
        for chain in chains_of(&structure.members) {
            write_chain(&chain, out, |node, out| {
                let zero = writer.zero(&node.body.ty, node.body.span)?;
                let member = self.names.member(path, &node.body.name);
                out.line(&format!("zero.{member} = {zero};"));
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
        if self.names.dialect != Dialect::Glsl {
            let what = "a variable of a module";
            return Err(untranslated(*span, what)
                .note("help: give it to functions as a parameter: only these are translated"));
        }
        let place = binding.map(|(set, binding)| format!("set = {set}, binding = {binding}"));
        match (space, place) {
            (Space::Handle, Some(place)) => {
                let ty = self.names.type_name(ty, *span)?;
                out.line(&format!("layout({place}) uniform {ty} {};", self.own_name(name)));
                Ok(())
            }
            (Space::Uniform | Space::Storage { .. }, Some(place)) => {
                self.block(variable, &place, out)
            }
            (Space::Private, None) => {
                let (ty_text, lengths) = self.names.declared_type(ty, *span)?;
                let value = match value {
                    Some(value) => self.writer().whole(value, 0)?,
                    None => self.writer().zero(ty, *span)?,
                };
                out.line(&format!("{ty_text} {}{lengths} = {value};", self.own_name(name)));
                Ok(())
            }
            (Space::Workgroup, _) => Err(untranslated(
                *span,
                "a variable of a workgroup, which is zero at first in WGSL",
            )),
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
            let block = self.own_name(&structure.name);
            out.line(&format!("layout({layout}, {place}) {kind} {block} {{"));
            self.members(structure, out)?;
            out.line(&format!("}} {};", self.own_name(name)));
            return Ok(());
        }
        if matches!(ty, Type::Structure(_)) {
            return Err(untranslated(
                *span,
                "a structure of a binding that is also used elsewhere",
            )
            .note("help: give the binding a structure of its own"));
        }
        let (ty, lengths) = self.names.declared_type(ty, *span)?;
        let name = self.own_name(name);
        let mut block = name.to_owned();
        if let Some(first) = block.get_mut(0..1) {
            first.make_ascii_uppercase();
        }
        let block = if block == name { format!("{name}Block") } else { block };
        let block = self.names.invented(&block);
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
                for member in &self.globals.members(path) {
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
        if self.names.dialect != Dialect::Glsl && function.stage.is_some() {
            let what = "an entry point";
            return Err(untranslated(function.span, what)
                .note("help: only functions are translated: move what you need into one"));
        }
        let mut writer = self.writer();
        let around = Surroundings {
            names: self.names,
            globals: self.globals,
            module: self.module,
            variables: self.variables,
        };
        writer.locals = local_names(function, &around)?;
        writer.pairs = parameter_samplers(function);
        self.stage_inputs(function, &mut writer)?;
        let result = match function.stage {
            Some(stage) => Some(stage_result(function, stage, self.facts, self.names)?),
            None => None,
        };
        let mut unset = Vec::new();
        if let Some(StageResult::Fields(fields)) = &result
            && let Some(number) = output_variable(function)?
        {
            let fields = fields.iter().map(|(_, field)| field.clone()).collect();
            writer.locals.insert(number, LocalRole::Outputs(fields));
            let members = self.facts.result_members(function);
            unset = unset_members(&function.body, number, members);
        }
        match function.stage {
            Some(_) => out.line("void main() {"),
            None => self.header(function, &writer, out)?,
        }
        let inner = Indented { text: std::mem::take(&mut out.text), depth: 1 };
        let mut body = BodyWriter { writer, out: inner, result, unset };
        let written = body.nodes(&function.body, true);
        out.text = body.out.text;
        written?;
        out.line("}");
        Ok(())
    }

    /// What the parameters of a stage and of its functions have become.
    fn stage_inputs(&self, function: &Function, writer: &mut Writer<'_>) -> Result<(), Diagnostic> {
        for node in &function.parameters {
            let Field { name, ty, binding, span } = &node.body;
            let variables = self.stage.map(|stage| Variables {
                stage,
                direction: Direction::In,
                names: self.names,
            });
            let role = match (ty, binding, variables) {
                (_, Some(binding), Some(variables)) => {
                    LocalRole::Input(variables.one(name, &binding.place, *span)?)
                }
                (Type::Structure(path), None, Some(variables))
                    if self.facts.is_stage_structure(path) =>
                {
                    LocalRole::Stage(variables.fields(self.facts.stage_members(path))?)
                }
                _ if function.stage.is_some() => {
                    return Err(untranslated(*span, "a parameter of a stage without a place"));
                }
                _ => continue,
            };
            writer.locals.insert(span.start, role);
        }
        Ok(())
    }
}

/// Whether a type is the element of an array that is a binding.
fn is_element(variable: &Variable, ty: &Type) -> bool {
    matches!(&variable.ty, Type::Array(element, _) if **element == *ty)
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

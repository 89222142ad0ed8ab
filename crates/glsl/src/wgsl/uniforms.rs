//! Uniforms that are in no block become one block. If the program has numbers for both stages, it is
//! the same block in both: with all members of the program, in one order.

use super::Writer;
use super::globals::Bindings;
use super::memory::Rules;
use super::names::plain_name;
use super::output::Fact;
use crate::lexer::At;
use crate::program::UniformMember;
use crate::tree::{Number, Packing, Place, Var};
use crate::types::{Type, named_type};

const RULES: Rules = Rules { packing: Packing::Std140, row_major: false, uniform: true };

impl Writer<'_> {
    pub(super) fn plan_default_block(&mut self, bindings: &mut Bindings) {
        let shader = self.shader;
        let mut own: Vec<(u32, &Var)> = Vec::new();
        for (index, var) in (0..).zip(&shader.vars) {
            if var.place == Place::Uniform && !self.is_all_opaque(&var.ty) {
                own.push((index, var));
            }
        }
        if own.is_empty() {
            return;
        }
        let mut members = String::new();
        for member in std::mem::take(&mut self.numbers.members) {
            members += &match own.iter().position(|(_, var)| var.name == member.name) {
                Some(at) => {
                    let (index, var) = own.remove(at);
                    self.own_member(index, var, Some(&member))
                }
                None => self.other_member(&member),
            };
        }
        for (index, var) in own {
            members += &self.own_member(index, var, None);
        }
        if members.is_empty() {
            return;
        }
        let ty = self.global_name("Uniforms");
        let name = self.global_name("uniforms");
        let binding = bindings.take(0, self.numbers.uniforms(), 0);
        self.preamble.push(format!(
            "struct {ty} {{\n{members}}}\n@group(0) @binding({binding}) var<uniform> {name}: {ty};"
        ));
        self.add_resource(String::new(), name.clone(), (0, binding), None);
        self.entry.uniforms = name;
    }

    /// A uniform of this text. Where it is smaller than its place in the block, there is room behind.
    fn own_member(&mut self, index: u32, var: &Var, place: Option<&UniformMember>) -> String {
        let Some(cell) = self.cell(&var.ty, RULES, var.at) else { return String::new() };
        let name = self.var_name(index);
        let mut attribute = alignment(&var.ty).to_owned();
        match place {
            Some(UniformMember { size, open: false, .. }) if cell.size() < *size => {
                attribute += &format!("@size({size}) ");
            }
            Some(UniformMember { size, open: false, .. }) if cell.size() > *size => {
                let message = "the size of this uniform is not the same in all branches of the \
                               sources: give it a size that is a number, or a block";
                self.refuse(var.at, message);
            }
            _ => {}
        }
        self.initial_fact(var);
        let text = format!("    {attribute}{name}: {},\n", cell.text);
        self.memory.insert(index, cell.mem);
        text
    }

    fn initial_fact(&mut self, var: &Var) {
        let Some(init) = &var.init else { return };
        match &init.known {
            Some(known) => {
                let numbers = known.iter().map(|number| as_f64(*number)).collect();
                self.facts.list.push((Fact::Initial(var.name.clone(), numbers), var.at));
            }
            None => self.refuse(
                init.at,
                "the initial value of this uniform is not computed before the shader runs",
            ),
        }
    }

    /// A uniform that only the other stage reads. A structure of that stage is an array here, since
    /// this text does not have the structure.
    fn other_member(&mut self, member: &UniformMember) -> String {
        let UniformMember { name, size, ty, lengths, open } = member;
        let name = plain_name(name);
        if let Some(mut ty) = named_type(ty).filter(|_| !open) {
            for length in lengths.iter().rev() {
                ty = Type::Array(ty.into(), Some(*length));
            }
            if let Some(cell) = self.cell(&ty, RULES, At::default()) {
                return format!("    {}{name}: {},\n", alignment(&ty), cell.text);
            }
        }
        match open {
            // It is the last one.
            true => String::new(),
            false => format!("    {name}: array<vec4f, {}>,\n", size.div_ceil(16)),
        }
    }
}

/// Where uniforms have structures and arrays in WGSL.
fn alignment(ty: &Type) -> &'static str {
    match ty {
        Type::Struct(_) | Type::Array(..) | Type::Matrix(..) => "@align(16) ",
        _ => "",
    }
}

fn as_f64(number: Number) -> f64 {
    match number {
        Number::Bool(value) => f64::from(u8::from(value)),
        Number::Int(value) => f64::from(value),
        Number::Uint(value) => f64::from(value),
        Number::Float(value) => f64::from(value),
    }
}

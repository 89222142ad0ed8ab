//! The entry point: GLSL's inputs and outputs are variables, WGSL's are parameters and a result.

use std::collections::{BTreeMap, BTreeSet};

use super::output::{Fact, InterfaceName, Slot};
use super::{Clip, Writer};
use crate::builtin::variables::{Builtin, Meaning};
use crate::lexer::At;
use crate::program::NumberOf;
use crate::tree::{ExprKind, Interpolation, Number, Place, Shader, Stage, Var};
use crate::types::Type;

/// What the entry point takes and gives.
#[derive(Debug, Default)]
pub(super) struct Plan {
    /// The variable of the uniforms that are in no block.
    pub(super) uniforms: String,
    /// Parameters.
    params: Vec<String>,
    /// Statements at the start, with their places.
    before: Vec<(String, At)>,
    /// Members of the result: attributes and type, the name, and the value.
    outputs: Vec<(String, String, String)>,
    /// Outputs that are variables of `main`.
    locals: BTreeSet<u32>,
    /// Declarations of variables of the module.
    privates: BTreeMap<u32, String>,
    /// The name of the result's structure.
    result: String,
    /// Whether an input attachment is read.
    pub(super) needs_position: bool,
    /// The variable that has the pixel's position for input attachments.
    pub(super) fragment_position: String,
    position: Option<u32>,
}

impl Plan {
    pub(super) fn private_text(&self, index: u32) -> Option<String> {
        self.privates.get(&index).cloned()
    }

    pub(super) fn is_local(&self, index: u32) -> bool {
        self.locals.contains(&index)
    }
}

/// A part of an input or output that has a location of its own.
struct Leaf {
    path: String,
    name: String,
    ty: Type,
    location: Option<u32>,
    interpolation: Interpolation,
}

impl<'s> Writer<'s> {
    /// Decides parameters and results.
    pub(super) fn plan_entry(&mut self) {
        let shader = self.shader;
        self.scopes.push(Default::default());
        for place in [Place::Input, Place::Output] {
            let mut next = 0;
            let vars = shader.vars.iter().enumerate();
            let vars =
                vars.filter(|(_, var)| var.place == place && !Self::is_superseded(shader, var));
            let taken = |var: &Var| {
                let first = var.layout.location?;
                Some(first..first.saturating_add(self.location_count(&var.ty).min(64)))
            };
            let used: BTreeSet<u32> =
                vars.clone().filter_map(|(_, var)| taken(var)).flatten().collect();
            for (index, var) in vars {
                self.plan_interface(index as u32, var, &used, &mut next);
            }
        }
        for (index, var) in shader.vars.iter().enumerate() {
            if let Place::Builtin(builtin) = var.place {
                self.plan_builtin(index as u32, var, builtin);
            }
        }
        self.plan_rest();
        if let Some(mode) = &shader.depth_mode {
            self.facts.list.push((Fact::DepthMode(mode.clone()), At::default()));
        }
    }

    /// Whether a variable is an output that a text declares and does not write, beside `gl_FragColor` or
    /// `gl_FragData`.
    fn is_superseded(shader: &Shader, var: &Var) -> bool {
        let is_color = |var: &Var| match var.place {
            Place::Builtin(builtin) => matches!(builtin.meaning, Meaning::Color) && var.written,
            _ => false,
        };
        var.place == Place::Output && !var.written && shader.vars.iter().any(is_color)
    }

    /// WGSL goes on after `discard`, so that loops must know of those in functions.
    pub(super) fn plan_discards(&mut self) {
        let mut functions = self.shader.functions.iter();
        let in_function = functions.any(|function| function.discards && function.name != "main");
        if in_function && self.shader.functions.iter().any(|function| function.loops) {
            let name = self.global_name("discarded");
            self.preamble.push(format!("var<private> {name}: bool;"));
            self.discarded = Some(name);
        }
    }

    /// What WGSL needs though the text does not name it.
    fn plan_rest(&mut self) {
        if self.shader.stage == Stage::Vertex && self.entry.position.is_none() {
            let attribute = "@builtin(position) ".to_owned();
            self.entry.outputs.insert(
                0,
                (format!("{attribute}#: vec4f"), "position".to_owned(), "vec4f()".to_owned()),
            );
        }
        if self.entry.needs_position {
            let name = self.global_name("fragment_position");
            let known = self.entry.params.iter().find_map(|param| {
                param.strip_prefix("@builtin(position) ")?.split(':').next().map(str::to_owned)
            });
            let param = match known {
                Some(known) => known,
                None => {
                    let param = self.local_name("position");
                    self.entry.params.push(format!("@builtin(position) {param}: vec4f"));
                    param
                }
            };
            self.preamble.push(format!("var<private> {name}: vec4f;"));
            self.entry.before.push((format!("{name} = {param};"), Self::nowhere()));
            self.entry.fragment_position = name;
        }
        if self.entry.outputs.len() > 1 {
            let title = match self.shader.stage {
                Stage::Vertex => "VertexOutput",
                _ => "FragmentOutput",
            };
            let name = self.global_name(title);
            let fields: String = self
                .entry
                .outputs
                .iter()
                .map(|(text, member, _)| format!("    {},\n", text.replace('#', member)))
                .collect();
            self.preamble.push(format!("struct {name} {{\n{fields}}}"));
            self.entry.result = name;
        }
    }

    /// Whether only `main` names a variable.
    fn only_main(&self, var: &Var) -> bool {
        var.users.iter().all(|user| self.shader.functions[*user as usize].name == "main")
    }

    fn plan_interface(&mut self, index: u32, var: &Var, used: &BTreeSet<u32>, next: &mut u32) {
        let input = var.place == Place::Input;
        if var.layout.component.is_some_and(|component| component > 0)
            || var.layout.index.is_some_and(|at| at > 0)
        {
            self.refuse(var.at, "`component` and `index` have no counterpart in WGSL");
            return;
        }
        let Some(root) = self.located(index, var, used, next) else { return };
        let name = root.name.clone();
        let mut leaves = Vec::new();
        self.flatten(root, &mut leaves, var.at);
        let simple = leaves.len() == 1 && leaves[0].path == name;
        let direct = simple && self.only_main(var);
        let ty = self.type_text(&var.ty);
        let declaration = format!("var<private> {name}: {ty};");
        match (input, direct) {
            (true, true) => {}
            (false, true) => {
                self.entry.locals.insert(index);
                self.entry.before.push((format!("var {name}: {ty};"), var.at));
            }
            (_, false) => {
                self.entry.privates.insert(index, declaration);
            }
        }
        for leaf in leaves {
            let own = if simple { &var.name } else { &leaf.name };
            self.name_slot(input, Slot::Location(leaf.location.unwrap_or(0)), own);
            self.plan_leaf(leaf, input, direct, var.at);
        }
    }

    /// Notes what the author calls an input or output.
    fn name_slot(&mut self, is_input: bool, slot: Slot, name: &str) {
        let name = name.to_owned();
        self.facts.names.interface.push(InterfaceName { is_input, slot, name });
    }

    /// An input or output with its first location.
    fn located(
        &mut self,
        index: u32,
        var: &Var,
        used: &BTreeSet<u32>,
        next: &mut u32,
    ) -> Option<Leaf> {
        let name = self.var_name(index);
        let mut root = Leaf {
            path: name.clone(),
            name: name.clone(),
            ty: var.ty.clone(),
            location: var.layout.location,
            interpolation: var.interpolation,
        };
        if let Type::Struct(content) = &var.ty
            && root.location.is_none()
            && self.shader.structs[*content as usize].members.iter().all(|m| m.location.is_some())
        {
            root.location = Some(0);
        }
        let count = self.location_count(&var.ty);
        if count > 64 {
            self.refuse(var.at, "so many inputs or outputs are not translated");
            return None;
        }
        if root.location.is_none() {
            root.location = self.number_of(var);
        }
        if root.location.is_none() {
            while (*next..*next + count).any(|location| used.contains(&location)) {
                *next += 1;
            }
            root.location = Some(*next);
            if !self.is_only_color(var) {
                self.facts.list.push((Fact::Location(var.name.clone(), *next), var.at));
            }
            *next += count;
        }
        Some(root)
    }

    /// The location that the program gives an input or an output. That of a block is by its name.
    fn number_of(&self, var: &Var) -> Option<u32> {
        let of = if var.place == Place::Input { NumberOf::Input } else { NumberOf::Output };
        self.numbers.get(of, self.linked_name(var))
    }

    /// The name by which the stages of a program share a variable.
    pub(super) fn linked_name<'v>(&self, var: &'v Var) -> &'v str
    where
        's: 'v,
    {
        match var.ty.innermost() {
            Type::Struct(index) if self.shader.structs[*index as usize].block => {
                &self.shader.structs[*index as usize].name
            }
            _ => &var.name,
        }
    }

    /// Whether this is the only output of a fragment shader, which has the location 0.
    fn is_only_color(&self, var: &Var) -> bool {
        let is_output = |var: &&Var| var.place == Place::Output;
        var.place == Place::Output
            && self.shader.stage == Stage::Fragment
            && self.shader.vars.iter().filter(is_output).count() == 1
    }

    fn plan_leaf(&mut self, leaf: Leaf, input: bool, direct: bool, at: At) {
        let attributes = self.leaf_attributes(&leaf, input);
        let ty = self.type_text(&leaf.ty);
        if !input {
            let member = self.output_name(&leaf.name);
            self.entry.outputs.push((format!("{attributes}#: {ty}"), member, leaf.path));
            return;
        }
        if direct {
            self.entry.params.push(format!("{attributes}{}: {ty}", leaf.name));
            return;
        }
        let suffix = if leaf.path == leaf.name { "_in" } else { "" };
        let param = self.local_name(&format!("{}{suffix}", leaf.name));
        self.entry.params.push(format!("{attributes}{param}: {ty}"));
        self.entry.before.push((format!("{} = {param};", leaf.path), at));
    }

    /// A name among the members of the result.
    fn output_name(&self, name: &str) -> String {
        let mut found = super::names::plain_name(name);
        while self.entry.outputs.iter().any(|(_, member, _)| *member == found) {
            found.push('_');
        }
        found
    }

    fn leaf_attributes(&self, leaf: &Leaf, input: bool) -> String {
        let location = leaf.location.unwrap_or(0);
        let mut text = format!("@location({location}) ");
        let between = (self.shader.stage == Stage::Vertex) != input;
        if !between {
            return text;
        }
        let kept = leaf.interpolation;
        if kept.flat || leaf.ty.is_integer() {
            text.push_str("@interpolate(flat) ");
            return text;
        }
        let sampling = match (kept.centroid, kept.sample) {
            (_, true) => ", sample",
            (true, _) => ", centroid",
            _ => "",
        };
        match (kept.linear, sampling) {
            (true, _) => text.push_str(&format!("@interpolate(linear{sampling}) ")),
            (false, "") => {}
            (false, _) => text.push_str(&format!("@interpolate(perspective{sampling}) ")),
        }
        text
    }

    /// How many locations a type takes.
    fn location_count(&self, ty: &Type) -> u32 {
        match ty {
            Type::Matrix(_, columns, _) => u32::from(*columns),
            Type::Array(element, size) => {
                size.unwrap_or(1).saturating_mul(self.location_count(element))
            }
            Type::Struct(index) => {
                let members = &self.shader.structs[*index as usize].members;
                members
                    .iter()
                    .map(|field| self.location_count(&field.ty))
                    .fold(0, u32::saturating_add)
            }
            _ => 1,
        }
    }

    /// Vectors and numbers of a variable, with their locations.
    fn flatten(&mut self, leaf: Leaf, out: &mut Vec<Leaf>, at: At) {
        if out.len() > 64 {
            self.refuse(at, "so many inputs or outputs are not translated");
            return;
        }
        let part = |path: String, name: String, ty: Type, location: u32| Leaf {
            path,
            name,
            ty,
            location: Some(location),
            interpolation: leaf.interpolation,
        };
        let first = leaf.location.unwrap_or(0);
        match &leaf.ty {
            Type::Matrix(scalar, columns, rows) => {
                for column in 0..*columns {
                    let path = format!("{}[{column}]", leaf.path);
                    let name = format!("{}_{column}", leaf.name);
                    let ty = Type::Vector(*scalar, *rows);
                    out.push(part(path, name, ty, first + u32::from(column)));
                }
            }
            Type::Array(element, size) => {
                let step = self.location_count(element);
                for number in 0..size.unwrap_or(0).min(65) {
                    let path = format!("{}[{number}]", leaf.path);
                    let name = format!("{}_{number}", leaf.name);
                    let inner = part(path, name, (**element).clone(), first + number * step);
                    self.flatten(inner, out, at);
                }
            }
            Type::Struct(index) => {
                let shader = self.shader;
                let mut next = first;
                for (number, field) in shader.structs[*index as usize].members.iter().enumerate() {
                    let member = self.member_name(*index, number as u32);
                    next = field.location.unwrap_or(next);
                    let path = format!("{}.{member}", leaf.path);
                    let name = format!("{}_{}", leaf.name, field.name);
                    let mut inner = part(path, name, field.ty.clone(), next);
                    inner.interpolation = field.interpolation.with(leaf.interpolation);
                    self.flatten(inner, out, at);
                    next += self.location_count(&field.ty);
                }
            }
            _ => out.push(leaf),
        }
    }

    fn plan_builtin(&mut self, index: u32, var: &Var, builtin: &'static Builtin) {
        match builtin.meaning {
            Meaning::Refused(reason) => {
                let message = format!("`{}` is not in WGSL: {reason}", builtin.name);
                self.refuse(var.at, message);
            }
            Meaning::Dropped(_) => {
                self.facts.list.push((Fact::Dropped(builtin.name.to_owned()), var.at));
                self.declare_builtin(index, var);
            }
            Meaning::Color => self.plan_color(index, var),
            Meaning::Value(name, ty) if builtin.output => self.plan_output(index, var, (name, ty)),
            Meaning::Value(name, ty) => self.plan_input(index, var, (name, ty)),
        }
    }

    /// A variable of the language as one of `main`, or of the module.
    fn declare_builtin(&mut self, index: u32, var: &Var) {
        let name = self.var_name(index);
        let ty = self.type_text(&var.ty);
        if self.only_main(var) {
            self.entry.locals.insert(index);
            self.entry.before.push((format!("var {name}: {ty};"), Self::nowhere()));
        } else {
            self.preamble.push(format!("var<private> {name}: {ty};"));
        }
    }

    fn plan_output(&mut self, index: u32, var: &Var, (builtin, ty): (&str, &str)) {
        // Nothing is in an array without a size: a block declares it, and no statement has an index.
        if matches!(var.ty, Type::Array(_, None)) {
            return;
        }
        self.name_slot(false, Slot::Builtin(builtin.to_owned()), &var.name);
        let name = self.var_name(index);
        self.declare_builtin(index, var);
        let (ty, value) = match (builtin, &var.ty) {
            ("clip_distances", Type::Array(_, size)) => {
                self.clip_distances = true;
                (format!("array<f32, {}>", size.unwrap_or(0)), name)
            }
            ("sample_mask", _) => (ty.to_owned(), format!("u32({name}[0])")),
            _ => (ty.to_owned(), name),
        };
        if builtin == "position" {
            self.entry.position = Some(index);
        }
        let invariant = if var.interpolation.invariant { "@invariant " } else { "" };
        let member = self.output_name(builtin);
        let text = format!("@builtin({builtin}) {invariant}#: {ty}");
        let at = if builtin == "position" { 0 } else { self.entry.outputs.len() };
        self.entry.outputs.insert(at, (text, member, value));
    }

    fn plan_color(&mut self, index: u32, var: &Var) {
        let name = self.var_name(index);
        self.declare_builtin(index, var);
        let Type::Array(_, size) = var.ty else {
            self.name_slot(false, Slot::Location(0), &var.name);
            let text = "@location(0) #: vec4f".to_owned();
            self.entry.outputs.push((text, "color".to_owned(), name));
            return;
        };
        for number in self.color_numbers(index, size.unwrap_or(0)) {
            let own = format!("{}[{number}]", var.name);
            self.name_slot(false, Slot::Location(number), &own);
            let text = format!("@location({number}) #: vec4f");
            let value = format!("{name}[{number}]");
            self.entry.outputs.push((text, format!("color_{number}"), value));
        }
    }

    /// The elements of `gl_FragData` that may be written: all, if one is by an index that is not
    /// constant, or the array as a whole.
    fn color_numbers(&self, index: u32, size: u32) -> BTreeSet<u32> {
        let mut found = BTreeSet::new();
        let (mut named, mut known) = (0, 0);
        for function in &self.shader.functions {
            let Some(body) = &function.body else { continue };
            super::flow::each_expr(body, self.shader, &mut |expr| match &expr.kind {
                ExprKind::Var(var) if *var == index => named += 1,
                ExprKind::Index(base, at) if matches!(base.kind, ExprKind::Var(var) if var == index) => {
                    if let Some(number) = Self::constant_of(at).and_then(Number::as_size) {
                        found.insert(number);
                        known += 1;
                    }
                }
                _ => {}
            });
        }
        if named == known { found } else { (0..size).collect() }
    }

    fn plan_input(&mut self, index: u32, var: &Var, (builtin, ty): (&str, &str)) {
        self.name_slot(true, Slot::Builtin(builtin.to_owned()), &var.name);
        let name = self.var_name(index);
        let wanted = self.type_text(&var.ty);
        let is_array = matches!(var.ty, Type::Array(..));
        let same = wanted == ty;
        if same && self.only_main(var) {
            self.entry.params.push(format!("@builtin({builtin}) {name}: {ty}"));
            return;
        }
        let param = self.local_name(builtin);
        self.entry.params.push(format!("@builtin({builtin}) {param}: {ty}"));
        let value = if same { param } else { format!("i32({param})") };
        let value = if is_array { format!("array<i32, 1>({value})") } else { value };
        if self.only_main(var) {
            let word = if is_array { "var" } else { "let" };
            self.entry.before.push((format!("{word} {name} = {value};"), Self::nowhere()));
        } else {
            self.preamble.push(format!("var<private> {name}: {wanted};"));
            self.entry.before.push((format!("{name} = {value};"), Self::nowhere()));
        }
    }

    /// The head of the entry point.
    pub(super) fn entry_head(&self) -> String {
        let attributes = match self.shader.stage {
            Stage::Vertex => "@vertex".to_owned(),
            Stage::Fragment => "@fragment".to_owned(),
            Stage::Compute => format!("@compute @workgroup_size({})", self.group_size()),
        };
        let result = match self.entry.outputs.as_slice() {
            [] => String::new(),
            [(text, _, _)] => format!(" -> {}", text.replace("#: ", "")),
            _ => format!(" -> {}", self.entry.result),
        };
        let params = &self.entry.params;
        let list = if params.join(", ").len() > 70 {
            let lines: String = params.iter().map(|param| format!("    {param},\n")).collect();
            format!("\n{lines}")
        } else {
            params.join(", ")
        };
        format!("{attributes}\nfn main({list}){result} {{")
    }

    fn group_size(&self) -> String {
        let axes: Vec<String> = (0..3)
            .map(|axis| {
                let id = self.shader.local_size_ids[axis];
                let by_id = id.and_then(|id| {
                    let is_it = |var: &&Var| var.layout.constant_id == Some(id);
                    let found = self.shader.vars.iter().position(|var| is_it(&var))?;
                    Some(self.var_name(found as u32))
                });
                by_id.unwrap_or_else(|| self.shader.local_size[axis].to_string())
            })
            .collect();
        axes.join(", ")
    }

    /// Statements that come before those of `main`.
    pub(super) fn entry_start(&mut self) {
        let before = std::mem::take(&mut self.entry.before);
        for (text, at) in &before {
            self.line(*at, text.clone());
        }
        let shader = self.shader;
        for item in &shader.order {
            let crate::tree::Item::Var(index) = item else { continue };
            let var = self.var(*index);
            if !self.is_set_at_entry(var) {
                continue;
            }
            let Some(init) = &var.init else { continue };
            let value = self.value(init);
            let name = self.var_name(*index);
            self.line(var.at, format!("{name} = {};", value.text));
        }
    }

    /// What `main` returns, after the position is converted.
    pub(super) fn entry_return(&mut self, at: At) {
        if let Some(index) = self.entry.position {
            let name = self.var_name(index);
            match self.options.clip {
                Clip::Kept => {}
                Clip::OpenGl => {
                    self.line(at, format!("{name}.z = ({name}.z + {name}.w) * 0.5;"));
                }
                Clip::Vulkan => self.line(at, format!("{name}.y = -{name}.y;")),
            }
        }
        let values: Vec<&str> =
            self.entry.outputs.iter().map(|(_, _, value)| value.as_str()).collect();
        let text = match values.as_slice() {
            [] => "return;".to_owned(),
            [value] => format!("return {value};"),
            _ => format!("return {}({});", self.entry.result, values.join(", ")),
        };
        self.line(at, text);
    }

    /// Whether `main` returns anything.
    pub(super) fn entry_returns(&self) -> bool {
        !self.entry.outputs.is_empty()
    }
}

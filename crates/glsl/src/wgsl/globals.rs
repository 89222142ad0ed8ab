//! Declarations outside of functions: structures, constants, variables and resources.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use super::bound::open_index;
use super::memory::{Mem, Rules};
use super::output::{Fact, Resource};
use super::{Writer, names};
use crate::lexer::At;
use crate::program::NumberOf;
use crate::tree::{Expr, ExprKind, Number, Packing, Place, Stage, Var};
use crate::types::{Opaque, OpaqueKind, Type};

/// The names of a texture and of its sampler.
#[derive(Debug, Clone, Default)]
pub(super) struct OpaqueNames {
    pub(super) texture: String,
    pub(super) sampler: Option<String>,
    /// Whether it is declared as a depth texture, though GLSL's is not one.
    pub(super) depth: bool,
}

/// Bindings that are in use.
#[derive(Debug, Default)]
pub(super) struct Bindings {
    used: BTreeSet<(u32, u32)>,
    /// Those that the text names: only the variables that it gives them have them.
    named: BTreeSet<(u32, u32)>,
}

impl Bindings {
    /// A binding: that of a variable, that of an element of it, or any.
    pub(super) fn take(&mut self, group: u32, wanted: Option<u32>, element: u32) -> u32 {
        let is_free = |binding: u32| !self.used.contains(&(group, binding));
        let is_open = |binding: u32| is_free(binding) && !self.named.contains(&(group, binding));
        let own = wanted.and_then(|binding| match element {
            0 => is_free(binding).then_some(binding),
            _ => binding.checked_add(element).filter(|binding| is_open(*binding)),
        });
        let binding = own.or_else(|| (0..).find(|binding| is_open(*binding))).unwrap_or(0);
        self.used.insert((group, binding));
        binding
    }
}

/// What a whole text does with its resources.
#[derive(Debug, Default)]
pub(super) struct Uses {
    atomics: BTreeSet<(u32, Option<u32>)>,
    loaded: BTreeSet<u32>,
    stored: BTreeSet<u32>,
    /// Arrays of textures, samplers and blocks with an index that only an array of bindings takes.
    pub(super) indexed: BTreeSet<u32>,
}

/// Formats of images in GLSL and in WGSL.
const FORMATS: &[(&str, &str)] = &[
    ("rgba32f", "rgba32float"),
    ("rgba16f", "rgba16float"),
    ("rg32f", "rg32float"),
    ("rg16f", "rg16float"),
    ("r32f", "r32float"),
    ("r16f", "r16float"),
    ("r11f_g11f_b10f", "rg11b10ufloat"),
    ("rgb10_a2", "rgb10a2unorm"),
    ("rgba16", "rgba16unorm"),
    ("rgba8", "rgba8unorm"),
    ("rg8", "rg8unorm"),
    ("r8", "r8unorm"),
    ("rgba8_snorm", "rgba8snorm"),
    ("rgba32i", "rgba32sint"),
    ("rgba16i", "rgba16sint"),
    ("rgba8i", "rgba8sint"),
    ("rg32i", "rg32sint"),
    ("r32i", "r32sint"),
    ("rgba32ui", "rgba32uint"),
    ("rgba16ui", "rgba16uint"),
    ("rgba8ui", "rgba8uint"),
    ("rg32ui", "rg32uint"),
    ("r32ui", "r32uint"),
];

impl Writer<'_> {
    /// Decides bindings, and how everything lies in memory.
    pub(super) fn plan_globals(&mut self) {
        let uses = self.uses();
        self.atomics.clone_from(&uses.atomics);
        let shader = self.shader;
        let given = |var: &Var| {
            let number = || self.numbers.get(NumberOf::Binding, self.linked_name(var));
            Some((var.layout.set.unwrap_or(0), var.layout.binding.or_else(number)?))
        };
        let named = shader.vars.iter().filter_map(given).collect();
        let mut bindings = Bindings { used: BTreeSet::new(), named };
        let (mut first, mut later) = (Vec::new(), Vec::new());
        let mut seen = BTreeSet::new();
        for (index, var) in shader.vars.iter().enumerate() {
            let key = (var.layout.set.unwrap_or(0), var.layout.binding.unwrap_or(0));
            let is_first = var.layout.binding.is_some() && seen.insert(key);
            if is_first { &mut first } else { &mut later }.push(index as u32);
        }
        for index in first {
            self.plan_global(index, &uses, &mut bindings);
        }
        for index in later {
            self.plan_global(index, &uses, &mut bindings);
        }
        self.plan_samplers(&mut bindings);
        self.plan_default_block(&mut bindings);
    }

    /// Whether a stage both reads and writes a variable other than by atomic functions. Only these are
    /// coherent in WGSL.
    fn is_incoherent(&self, index: u32, uses: &Uses) -> bool {
        let var = self.var(index);
        if var.access.readonly || var.access.writeonly {
            return false;
        }
        match (var.place, var.ty.innermost()) {
            (Place::Uniform, _) => {
                // A parameter may stand for any image.
                let is_this =
                    |root: &u32| *root == index || matches!(self.place(*root), Place::Param(_));
                uses.loaded.iter().any(is_this) && uses.stored.iter().any(is_this)
            }
            (Place::StorageBlock, Type::Struct(block)) => {
                let mut members = 0..self.shader.structs[*block as usize].members.len() as u32;
                let is_plain = |member| !uses.atomics.contains(&(index, Some(member)));
                var.written && members.any(is_plain)
            }
            (Place::Shared, _) => var.written && !uses.atomics.contains(&(index, None)),
            _ => false,
        }
    }

    fn plan_global(&mut self, index: u32, uses: &Uses, bindings: &mut Bindings) {
        let var = self.var(index);
        if var.access.coherent && self.is_incoherent(index, uses) {
            let message = "what is `coherent` or `volatile`, and both read and written, has no \
                           counterpart in WGSL, in which only atomic functions see at once what \
                           other invocations write";
            self.refuse(var.at, message);
        }
        match var.place {
            Place::UniformBlock | Place::StorageBlock => self.plan_block(index, uses, bindings),
            Place::Uniform => {
                self.plan_opaque(index, &mut Vec::new(), &var.ty, uses, bindings);
            }
            Place::Shared => {
                let atomic = self.atomics.contains(&(index, None));
                if atomic {
                    self.memory.insert(index, Rc::new(Mem::Atomic));
                }
                let name = self.var_name(index);
                let ty = if atomic { self.atomic_type(&var.ty) } else { self.type_text(&var.ty) };
                self.declarations.insert(index, vec![format!("var<workgroup> {name}: {ty};")]);
            }
            _ => {}
        }
    }

    fn atomic_type(&self, ty: &Type) -> String {
        match ty {
            Type::Array(element, Some(size)) => {
                format!("array<{}, {size}>", self.atomic_type(element))
            }
            Type::Array(element, None) => format!("array<{}>", self.atomic_type(element)),
            other => format!("atomic<{}>", self.type_text(other)),
        }
    }

    fn plan_block(&mut self, index: u32, uses: &Uses, bindings: &mut Bindings) {
        let var = self.var(index);
        let uniform = var.place == Place::UniformBlock;
        let packing = var.layout.packing.unwrap_or(Packing::Std140);
        let row_major = var.layout.row_major.unwrap_or(false);
        let rules = Rules { packing, row_major, uniform };
        let (ty, count) = match &var.ty {
            Type::Array(element, size) if self.is_bound_array(index, *size, uses) => {
                self.bound_arrays.insert(index, *size);
                ((**element).clone(), None)
            }
            Type::Array(element, size) => ((**element).clone(), *size),
            other => (other.clone(), None),
        };
        if matches!(ty, Type::Array(..)) {
            self.refuse(var.at, "an array of arrays of blocks is not translated");
            return;
        }
        let Some(cell) = self.cell(&ty, rules, var.at) else { return };
        self.memory.insert(index, Rc::clone(&cell.mem));
        let vertex = self.shader.stage == Stage::Vertex;
        if vertex && !uniform && var.written {
            self.refuse(var.at, "a vertex shader writes no buffer in WGSL");
        }
        let space = match (uniform, var.access.readonly || vertex) {
            (true, _) => "uniform",
            (false, true) => "storage, read",
            (false, false) => "storage, read_write",
        };
        let name = self.var_name(index);
        let group = var.layout.set.unwrap_or(0);
        if var.layout.push {
            let at = self.var(index).at;
            self.facts.list.push((Fact::PushConstant(name.clone()), at));
        }
        let names = match count {
            Some(count) => (0..count).map(|at| format!("{name}_{at}")).collect(),
            None => vec![name],
        };
        let mut lines = Vec::new();
        for (at, name) in names.into_iter().enumerate() {
            let binding = self.binding(index, &name, at as u32, bindings);
            let text = self.bound_text(index, &cell.text);
            lines.push(format!("@group({group}) @binding({binding}) var<{space}> {name}: {text};"));
            self.add_resource(var.name.clone(), name, (group, binding), None);
        }
        self.declarations.insert(index, lines);
    }

    /// The binding of an element of a variable; one that the text says otherwise is noted.
    fn binding(&mut self, index: u32, name: &str, element: u32, bindings: &mut Bindings) -> u32 {
        let var = self.var(index);
        let layout = &var.layout;
        let number = self.numbers.get(NumberOf::Binding, self.linked_name(var));
        let wanted = layout.binding.or(number);
        let found = bindings.take(layout.set.unwrap_or(0), wanted, element);
        if let Some(wanted) = layout.binding.map(|first| first.saturating_add(element))
            && wanted != found
        {
            self.facts.list.push((Fact::Binding(name.to_owned(), wanted, found), var.at));
        }
        found
    }

    pub(super) fn add_resource(
        &mut self,
        name: String,
        wgsl: String,
        (group, binding): (u32, u32),
        sampler: Option<u32>,
    ) {
        self.facts.names.resources.push(Resource { name, wgsl, group, binding, sampler });
    }

    /// Textures, samplers and images of a variable, in structures and arrays too.
    fn plan_opaque(
        &mut self,
        index: u32,
        path: &mut Vec<u32>,
        ty: &Type,
        uses: &Uses,
        bindings: &mut Bindings,
    ) {
        match ty {
            Type::Opaque(opaque) => self.declare_opaque(index, path, opaque, uses, bindings),
            Type::Array(element, size)
                if path.is_empty()
                    && element.is_opaque()
                    && self.is_bound_array(index, *size, uses) =>
            {
                self.bound_arrays.insert(index, *size);
                self.plan_opaque(index, path, element, uses, bindings);
            }
            Type::Array(element, Some(size)) if self.shader.has_opaque(element) => {
                if *size > 64 || self.opaque.len() > 256 {
                    self.refuse(
                        self.var(index).at,
                        "so large an array of textures is not translated",
                    );
                    return;
                }
                for at in 0..*size {
                    path.push(at);
                    self.plan_opaque(index, path, element, uses, bindings);
                    path.pop();
                }
            }
            Type::Array(element, None) if self.shader.has_opaque(element) => {
                self.refuse(self.var(index).at, "an array of textures has a size in WGSL");
            }
            Type::Struct(content) => {
                let shader = self.shader;
                for (at, field) in shader.structs[*content as usize].members.iter().enumerate() {
                    path.push(at as u32);
                    self.plan_opaque(index, path, &field.ty, uses, bindings);
                    path.pop();
                }
            }
            _ => {}
        }
    }

    /// The name of a part of a variable, with members and numbers.
    fn part_name(&self, index: u32, path: &[u32]) -> (String, String) {
        let var = self.var(index);
        let (mut glsl, mut wgsl) = (var.name.clone(), var.name.clone());
        let mut ty = var.ty.clone();
        for step in path {
            ty = match ty {
                Type::Array(element, _) => {
                    glsl.push_str(&format!("[{step}]"));
                    wgsl.push_str(&format!("_{step}"));
                    (*element).clone()
                }
                Type::Struct(content) => {
                    let field = &self.shader.structs[content as usize].members[*step as usize];
                    glsl.push_str(&format!(".{}", field.name));
                    wgsl.push_str(&format!("_{}", field.name));
                    field.ty.clone()
                }
                other => other,
            };
        }
        (glsl, wgsl)
    }

    fn declare_opaque(
        &mut self,
        index: u32,
        path: &[u32],
        opaque: &Opaque,
        uses: &Uses,
        bindings: &mut Bindings,
    ) {
        let var = self.var(index);
        let Some(text) = self.opaque_type(index, opaque, uses) else { return };
        let text = self.bound_text(index, &text);
        let depth = opaque.shadow || self.compared.textures.contains(&index);
        let group = var.layout.set.unwrap_or(0);
        let element = self.declarations.get(&index).map_or(0, Vec::len) as u32;
        let (glsl, name) = self.part_name(index, path);
        let name = if path.is_empty() { self.var_name(index) } else { self.global_name(&name) };
        let binding = self.binding(index, &glsl, element, bindings);
        let line = format!("@group({group}) @binding({binding}) var {name}: {text};");
        self.declarations.entry(index).or_default().push(line);
        if opaque.kind == OpaqueKind::Subpass {
            let number = var.layout.attachment.unwrap_or(0);
            self.facts.list.push((Fact::Attachment(glsl.clone(), number), var.at));
            self.entry.needs_position = true;
        }
        self.add_resource(glsl, name.clone(), (group, binding), None);
        let depth = depth && !opaque.shadow && opaque.kind == OpaqueKind::Texture;
        self.opaque
            .insert((index, path.to_vec()), OpaqueNames { texture: name, sampler: None, depth });
    }

    /// The type of a texture, sampler or image; what WGSL lacks is refused.
    fn opaque_type(&mut self, index: u32, opaque: &Opaque, uses: &Uses) -> Option<String> {
        let var = self.var(index);
        let before = self.problems.len();
        let text = match opaque.kind {
            OpaqueKind::Sampler if opaque.shadow || self.compared.samplers.contains(&index) => {
                Some("sampler_comparison".to_owned())
            }
            OpaqueKind::Sampler => Some("sampler".to_owned()),
            OpaqueKind::Image => self.image_type(index, opaque, uses),
            OpaqueKind::Other => None,
            _ => {
                let depth = opaque.shadow || self.compared.textures.contains(&index);
                names::texture_type(opaque, depth)
            }
        };
        if text.is_none() && self.problems.len() == before {
            let name = opaque.glsl_name();
            self.refuse(var.at, format!("`{name}` has no counterpart in WGSL"));
        }
        text
    }

    fn image_type(&mut self, index: u32, opaque: &Opaque, uses: &Uses) -> Option<String> {
        let var = self.var(index);
        let Some(format) = &var.layout.format else {
            self.refuse(var.at, "an image has a format in WGSL");
            return None;
        };
        let Some((_, format)) = FORMATS.iter().find(|(glsl, _)| glsl == format) else {
            self.refuse(var.at, format!("WGSL has no images of format `{format}`"));
            return None;
        };
        let loaded = uses.loaded.contains(&index);
        let access = match (var.access.readonly, var.access.writeonly) {
            (true, _) => "read",
            (_, true) => "write",
            _ if !uses.stored.contains(&index) => "read",
            _ if loaded => "read_write",
            _ => "write",
        };
        let plain = names::texture_type(opaque, false)?;
        let shape = plain.strip_prefix("texture_")?.split('<').next()?.to_owned();
        if shape.starts_with("cube") || shape.starts_with("multi") {
            return None;
        }
        Some(format!("texture_storage_{shape}<{format}, {access}>"))
    }

    /// Samplers of combined textures come behind all other bindings.
    fn plan_samplers(&mut self, bindings: &mut Bindings) {
        let keys: Vec<(u32, Vec<u32>)> = self.opaque.keys().cloned().collect();
        let mut counted: BTreeMap<u32, u32> = BTreeMap::new();
        for key in keys {
            let Some(opaque) = self.opaque_of(&key) else { continue };
            if opaque.kind != OpaqueKind::Combined || opaque.multisampled {
                continue;
            }
            let group = self.var(key.0).layout.set.unwrap_or(0);
            let element = counted.entry(key.0).or_insert(0);
            let first = self.numbers.get(NumberOf::Sampler, &self.var(key.0).name);
            let binding = bindings.take(group, first.map(|first| first + *element), 0);
            *element += 1;
            let Some(texture) = self.opaque.get(&key).map(|names| names.texture.clone()) else {
                continue;
            };
            let name = self.global_name(&format!("{texture}_sampler"));
            let ty = if opaque.shadow { "sampler_comparison" } else { "sampler" };
            let ty = self.bound_text(key.0, ty);
            let line = format!("@group({group}) @binding({binding}) var {name}: {ty};");
            self.declarations.entry(key.0).or_default().push(line);
            for resource in &mut self.facts.names.resources {
                if resource.wgsl == texture {
                    resource.sampler = Some(binding);
                }
            }
            if let Some(names) = self.opaque.get_mut(&key) {
                names.sampler = Some(name);
            }
        }
    }

    fn opaque_of(&self, key: &(u32, Vec<u32>)) -> Option<Opaque> {
        let mut ty = self.var(key.0).ty.clone();
        if self.bound_arrays.contains_key(&key.0)
            && let Type::Array(element, _) = ty
        {
            ty = (*element).clone();
        }
        for step in &key.1 {
            ty = match ty {
                Type::Array(element, _) => (*element).clone(),
                Type::Struct(content) => {
                    self.shader.structs[content as usize].members[*step as usize].ty.clone()
                }
                _ => return None,
            };
        }
        match ty {
            Type::Opaque(opaque) => Some(opaque),
            _ => None,
        }
    }

    pub(super) fn is_all_opaque(&self, ty: &Type) -> bool {
        match ty.innermost() {
            Type::Opaque(_) => true,
            Type::Struct(index) => {
                let members = &self.shader.structs[*index as usize].members;
                members.iter().all(|field| self.is_all_opaque(&field.ty))
            }
            _ => false,
        }
    }

    /// The names of a texture and its sampler.
    pub(super) fn opaque_names(&mut self, expr: &Expr) -> Option<OpaqueNames> {
        if let ExprKind::Construct(parts) = &expr.kind {
            let [texture, sampler] = parts.as_slice() else { return None };
            let texture = self.opaque_names(texture)?;
            let sampler = self.opaque_names(sampler)?;
            let compares = matches!(expr.ty, Type::Opaque(Opaque { shadow: true, .. }));
            let depth = texture.depth && !compares;
            return Some(OpaqueNames { sampler: Some(sampler.texture), depth, ..texture });
        }
        let mut path = Vec::new();
        let mut at = expr;
        let index = loop {
            match &at.kind {
                ExprKind::Var(index) => break *index,
                ExprKind::Member(base, member) => {
                    path.push(*member);
                    at = base;
                }
                ExprKind::Index(base, index) if self.is_bound(base) => {
                    return self.bound_element(base, index);
                }
                ExprKind::Index(base, index) => {
                    let Some(number) = Self::constant_of(index).and_then(Number::as_size) else {
                        let message = "an array of textures is indexed by constants in WGSL";
                        self.refuse(index.at, message);
                        return None;
                    };
                    path.push(number);
                    at = base;
                }
                _ => {
                    self.refuse(at.at, "this texture is not known");
                    return None;
                }
            }
        };
        path.reverse();
        let found = self.opaque.get(&(index, path)).cloned();
        if found.is_none() && self.problems.is_empty() {
            self.refuse(expr.at, "this texture is not known");
        }
        found
    }

    fn uses(&self) -> Uses {
        let mut uses = Uses::default();
        for function in &self.shader.functions {
            let Some(body) = &function.body else { continue };
            super::flow::each_expr(body, self.shader, &mut |expr| self.note_use(expr, &mut uses));
        }
        uses
    }

    fn note_use(&self, expr: &Expr, uses: &mut Uses) {
        use crate::builtin::textures::Access;
        match &expr.kind {
            ExprKind::Builtin(name, arguments) if name.starts_with("atomic") => {
                if let Some(found) = atomic_root(&arguments[0]) {
                    uses.atomics.insert(found);
                }
            }
            ExprKind::Texture(access, arguments) => {
                if !self.is_switched(*access, arguments) {
                    uses.indexed.extend(open_index(&arguments[0]));
                }
                let Some(root) = root_var(&arguments[0]) else { return };
                match access {
                    Access::Load => uses.loaded.insert(root),
                    Access::Store => uses.stored.insert(root),
                    _ => false,
                };
            }
            ExprKind::Call(_, arguments) => {
                uses.indexed.extend(arguments.iter().filter_map(open_index))
            }
            ExprKind::Index(base, _) if matches!(base.kind, ExprKind::Var(var) if self.is_block(var)) =>
            {
                uses.indexed.extend(open_index(expr));
            }
            ExprKind::Construct(parts) if expr.ty.is_opaque() => {
                uses.indexed.extend(parts.iter().filter_map(open_index));
            }
            _ => {}
        }
    }

    fn is_block(&self, var: u32) -> bool {
        matches!(self.place(var), Place::UniformBlock | Place::StorageBlock)
    }

    /// A structure of the text.
    pub(super) fn structure(&mut self, index: u32) {
        let shader = self.shader;
        let content = &shader.structs[index as usize];
        self.flush_comments(content.at.start);
        let is_interface = content.block && !self.stored.attributes.contains_key(&index);
        if content.members.iter().all(|field| self.is_all_opaque(&field.ty)) {
            return;
        }
        let name = self.struct_names[index as usize].clone();
        let attributes = self.stored.attributes.get(&index).cloned().unwrap_or_default();
        let texts = self.stored_members(index, is_interface);
        self.line(content.at, format!("struct {name} {{"));
        for (at, field) in content.members.iter().enumerate() {
            if field.ty.is_opaque() {
                continue;
            }
            self.flush_comments(field.at.start);
            let member = self.member_name(index, at as u32);
            let attribute = attributes.get(at).map_or("", String::as_str);
            let mut inner = super::Lines::default();
            let text = format!("{attribute}{member}: {},", texts[at]);
            inner.push(super::Line::new(text, field.at));
            self.lines.nest(inner);
        }
        self.line(content.at, "}");
    }

    /// The types of members, as a block's variable stores them.
    fn stored_members(&mut self, index: u32, interface: bool) -> Vec<String> {
        let shader = self.shader;
        let content = &shader.structs[index as usize];
        let owner = shader
            .vars
            .iter()
            .enumerate()
            .find(|(_, var)| content.block && *var.ty.innermost() == Type::Struct(index));
        let rules = owner.map(|(_, var)| Rules {
            packing: var.layout.packing.unwrap_or(Packing::Std140),
            row_major: var.layout.row_major.unwrap_or(false),
            uniform: var.place == Place::UniformBlock,
        });
        let mut texts = Vec::with_capacity(content.members.len());
        for (at, field) in content.members.iter().enumerate() {
            let atomic =
                owner.is_some_and(|(var, _)| self.atomics.contains(&(var as u32, Some(at as u32))));
            let text = match rules {
                _ if atomic => self.atomic_type(&field.ty),
                Some(rules) if !interface => {
                    let row_major = field.row_major.unwrap_or(rules.row_major);
                    let cell = self.cell(&field.ty, Rules { row_major, ..rules }, field.at);
                    cell.map_or(String::new(), |cell| cell.text)
                }
                _ => self.type_text(&field.ty),
            };
            texts.push(text);
        }
        texts
    }

    /// A variable of the text.
    pub(super) fn global(&mut self, index: u32) {
        let var = self.var(index);
        self.flush_comments(var.at.start);
        if let Some(lines) = self.declarations.get(&index).cloned() {
            for line in lines {
                self.line(var.at, line);
            }
            return;
        }
        match var.place {
            Place::Const => self.constant(index, var),
            Place::Override => self.override_constant(index, var),
            Place::Private => {
                let name = self.var_name(index);
                let ty = self.type_text(&var.ty);
                let init = var.init.as_ref().filter(|init| self.is_constant(init));
                let text = match init {
                    Some(init) => {
                        let value = self.value(init);
                        format!("var<private> {name}: {ty} = {};", value.text)
                    }
                    None => format!("var<private> {name}: {ty};"),
                };
                self.line(var.at, text);
            }
            _ => {
                if let Some(text) = self.entry.private_text(index) {
                    self.line(var.at, text);
                }
            }
        }
    }

    fn constant(&mut self, index: u32, var: &Var) {
        let name = self.var_name(index);
        let ty = self.type_text(&var.ty);
        let Some(init) = &var.init else { return };
        if self.is_constant(init) {
            let value = self.value(init);
            self.line(var.at, format!("const {name}: {ty} = {};", value.text));
        } else if self.depends_on_override(init) {
            let value = self.value(init);
            self.line(var.at, format!("override {name}: {ty} = {};", value.text));
        } else {
            self.line(var.at, format!("var<private> {name}: {ty};"));
        }
    }

    fn override_constant(&mut self, index: u32, var: &Var) {
        let name = self.var_name(index);
        let ty = self.type_text(&var.ty);
        let Some(init) = &var.init else { return };
        let value = self.value(init);
        let id = var.layout.constant_id.map(|id| format!("@id({id}) ")).unwrap_or_default();
        self.line(var.at, format!("{id}override {name}: {ty} = {};", value.text));
    }

    fn depends_on_override(&self, init: &Expr) -> bool {
        let scalar = matches!(init.ty, Type::Scalar(_));
        scalar && init.names(&|index| self.place(index) == Place::Override)
    }

    /// Whether WGSL takes an expression as a constant of the module.
    pub(super) fn is_constant(&self, expr: &Expr) -> bool {
        if let Some(known) = &expr.known
            && expr.ty.components() > 0
        {
            return known.iter().all(|number| match number {
                Number::Float(value) => value.is_finite(),
                _ => true,
            });
        }
        match &expr.kind {
            ExprKind::Construct(parts) => parts.iter().all(|part| self.is_constant(part)),
            ExprKind::Var(index) => {
                let var = self.var(*index);
                let init = var.init.as_ref();
                var.place == Place::Const && init.is_some_and(|init| self.is_constant(init))
            }
            ExprKind::Convert(inner) => self.is_constant(inner),
            _ => false,
        }
    }

    /// Whether a variable of the module begins with a value that only the entry point can compute.
    pub(super) fn is_set_at_entry(&self, var: &Var) -> bool {
        let Some(init) = &var.init else { return false };
        match var.place {
            Place::Private => !self.is_constant(init),
            Place::Const => !self.is_constant(init) && !self.depends_on_override(init),
            _ => false,
        }
    }

    /// The place of a whole text, for what has none.
    pub(super) fn nowhere() -> At {
        At::default()
    }
}

/// The variable at the root of a path.
pub(super) fn root_var(expr: &Expr) -> Option<u32> {
    match &expr.kind {
        ExprKind::Var(index) => Some(*index),
        ExprKind::Member(base, _) | ExprKind::Index(base, _) | ExprKind::Swizzle(base, _) => {
            root_var(base)
        }
        _ => None,
    }
}

/// The variable, and the member of a block, that an atomic function works on.
fn atomic_root(expr: &Expr) -> Option<(u32, Option<u32>)> {
    match &expr.kind {
        ExprKind::Var(index) => Some((*index, None)),
        ExprKind::Index(base, _) => atomic_root(base),
        ExprKind::Member(base, member) => match base.kind {
            ExprKind::Var(index) => Some((index, Some(*member))),
            _ => None,
        },
        _ => None,
    }
}

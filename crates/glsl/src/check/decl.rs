//! Declarations outside of functions, structures and blocks.

use super::construct::has_unsized;
use super::layout::{Quals, Storage};
use super::{Checker, Res, Symbol};
use crate::ast::{self, Base};
use crate::lexer::At;
use crate::tree::{Field, Item, Packing, Place, Stage, Struct, Var};
use crate::types::{OpaqueKind, Scalar, Type, named_type};

impl<'a> Checker<'a> {
    /// A declaration of the text.
    pub(super) fn item(&mut self, item: &'a ast::Item<'a>, at: At) -> Res<()> {
        match item {
            ast::Item::Function(function) => {
                let read = self.function(function);
                if read.is_err() {
                    self.unread.insert(function.name.text);
                }
                read
            }
            ast::Item::Vars(vars) => self.global_vars(vars),
            ast::Item::Block(block) => self.block(block),
            ast::Item::Quals(list, names) => self.qualified(list, names, at),
            ast::Item::Nothing => Ok(()),
        }
    }

    fn qualified(
        &mut self,
        list: &'a [ast::Qual<'a>],
        names: &'a [ast::Name<'a>],
        at: At,
    ) -> Res<()> {
        let quals = self.quals(list)?;
        if names.is_empty() {
            return self.global_layout(quals, at);
        }
        for name in names {
            let index = match self.lookup(name.text) {
                Some(Symbol::Var(index)) => Some(*index),
                Some(_) => None,
                None => self.builtin_index(name.text, name.at)?,
            };
            let Some(index) = index else {
                return self.fail(name.at, format!("`{}` is not a variable", name.text));
            };
            let var = self.var_mut(index);
            var.interpolation.invariant |= quals.interpolation.invariant;
        }
        Ok(())
    }

    /// The type that is written, with sizes after a name.
    pub(super) fn spec_type(
        &mut self,
        spec: &'a ast::TypeSpec<'a>,
        sizes: &'a ast::Sizes<'a>,
    ) -> Res<Type> {
        let base = match &spec.base {
            Base::Name(name) => match self.lookup(name) {
                Some(Symbol::Struct(index)) => Type::Struct(*index),
                Some(_) => return self.fail(spec.at, format!("`{name}` is not a type")),
                None => match named_type(name) {
                    Some(ty) => ty,
                    None => return self.fail_unknown(name, spec.at),
                },
            },
            Base::Struct(name, members) => {
                let read = self.structure(*name, members, spec.at);
                if read.is_err() {
                    self.unread.extend(name.iter().map(|name| name.text));
                }
                read?
            }
        };
        self.sized(base, spec, sizes)
    }

    /// `vec4[3] a[2]` is an array of two arrays of three: sizes after the name come first.
    pub(super) fn sized(
        &mut self,
        base: Type,
        spec: &'a ast::TypeSpec<'a>,
        sizes: &'a ast::Sizes<'a>,
    ) -> Res<Type> {
        if base.innermost().scalar() == Some(Scalar::Double) {
            return self.refuse(spec.at, "`double` has no counterpart in WGSL");
        }
        let mut ty = base;
        for size in sizes.iter().chain(&spec.sizes).rev() {
            if ty == Type::Void {
                return self.fail(spec.at, "there are no arrays of `void`");
            }
            ty = match size {
                Some(size) => ty.array(Some(self.array_size(size)?)),
                None => ty.array(None),
            };
        }
        Ok(ty)
    }

    fn structure(
        &mut self,
        name: Option<ast::Name<'a>>,
        members: &'a [ast::Member<'a>],
        at: At,
    ) -> Res<Type> {
        let members = self.fields(members, None)?;
        if members.is_empty() {
            return self.fail(at, "a structure has at least one member");
        }
        let shape = self.shape_of(&members);
        if shape.0 > NESTED || shape.1 > PARTS {
            return self.fail(at, "the structure is too large");
        }
        self.shapes.push(shape);
        let text = name.map_or(String::new(), |name| name.text.to_owned());
        let index = self.shader.structs.len() as u32;
        self.shader.structs.push(Struct { name: text, at, members, block: false });
        self.shader.order.push(Item::Struct(index));
        if let Some(name) = name {
            self.declare(name, Symbol::Struct(index))?;
        }
        Ok(Type::Struct(index))
    }

    /// How deep members nest, and how many there are with those of inner structures.
    fn shape_of(&self, members: &[Field]) -> (u32, u32) {
        let of = |field: &Field| match field.ty.innermost() {
            Type::Struct(index) => self.shapes[*index as usize],
            _ => (0, 1),
        };
        let depth = members.iter().map(|field| of(field).0).max().unwrap_or(0);
        (depth + 1, members.iter().map(|field| of(field).1).sum())
    }

    /// The members of a structure, or of a block in this storage.
    fn fields(
        &mut self,
        members: &'a [ast::Member<'a>],
        block: Option<Storage>,
    ) -> Res<Vec<Field>> {
        let mut fields: Vec<Field> = Vec::new();
        for member in members {
            let quals = self.quals(&member.quals)?;
            self.check_member(member, &quals, block)?;
            if quals.access.coherent {
                let at = member.names.first().map_or(member.ty.at, |one| one.name.at);
                return self
                    .refuse(at, "a `coherent` or `volatile` member has no counterpart in WGSL");
            }
            let base = self.spec_type(&member.ty, NO_SIZES)?;
            for declarator in &member.names {
                let ty = self.after_name(base.clone(), &declarator.sizes)?;
                if ty == Type::Void {
                    return self.fail(declarator.name.at, "a member is not `void`");
                }
                self.check_name(declarator.name)?;
                if fields.iter().any(|field| field.name == declarator.name.text) {
                    let message =
                        format!("the member `{}` is declared twice", declarator.name.text);
                    return self.fail(declarator.name.at, message);
                }
                fields.push(Field {
                    name: declarator.name.text.to_owned(),
                    ty,
                    at: declarator.name.at,
                    offset: quals.offset,
                    align: quals.align,
                    row_major: quals.layout.row_major,
                    location: quals.layout.location,
                    interpolation: quals.interpolation,
                    readonly: quals.access.readonly,
                });
            }
        }
        Ok(fields)
    }

    /// A member is stored as its block is, and declares nothing else.
    fn check_member(
        &mut self,
        member: &'a ast::Member<'a>,
        quals: &Quals,
        block: Option<Storage>,
    ) -> Res<()> {
        let at = member.ty.at;
        if quals.storage.is_some() && quals.storage != block {
            return self.fail(at, "a member has no storage of its own");
        }
        let is_shared = matches!(block, Some(Storage::Uniform | Storage::Buffer));
        if quals.interpolation.invariant && is_shared {
            return self.fail(at, "`invariant` is for what a shader computes");
        }
        if quals.packs {
            return self.fail(at, "a member has no packing of its own: the whole block has one");
        }
        if block.is_some() && matches!(member.ty.base, Base::Struct(..)) {
            return self.fail(at, "a structure is not declared in a block");
        }
        Ok(())
    }

    /// A type with the sizes that stand after a name: they are outside of those of the type.
    pub(super) fn after_name(&mut self, base: Type, sizes: &'a ast::Sizes<'a>) -> Res<Type> {
        let mut ty = base;
        for size in sizes.iter().rev() {
            ty = match size {
                Some(size) => ty.array(Some(self.array_size(size)?)),
                None => ty.array(None),
            };
        }
        Ok(ty)
    }

    fn global_vars(&mut self, vars: &'a ast::Vars<'a>) -> Res<()> {
        let read = self.each_global_var(vars);
        if read.is_err() {
            self.forget_names(vars);
        }
        read
    }

    /// Notes the names of a declaration that has a mistake.
    pub(super) fn forget_names(&mut self, vars: &'a ast::Vars<'a>) {
        self.unread.extend(vars.names.iter().map(|declarator| declarator.name.text));
    }

    fn each_global_var(&mut self, vars: &'a ast::Vars<'a>) -> Res<()> {
        let quals = self.quals(&vars.quals)?;
        let base = self.spec_type(&vars.ty, NO_SIZES)?;
        for declarator in &vars.names {
            let ty = self.after_name(base.clone(), &declarator.sizes)?;
            self.global_var(&quals, ty, declarator)?;
        }
        Ok(())
    }

    fn global_place(&mut self, quals: &Quals, ty: &Type, name: ast::Name<'a>) -> Res<Place> {
        let place = match quals.storage {
            None if ty.is_opaque() => {
                return self.fail(name.at, "a texture or sampler is a `uniform`");
            }
            None => Place::Private,
            Some(Storage::Const) if quals.layout.constant_id.is_some() => Place::Override,
            Some(Storage::Const) => Place::Const,
            Some(Storage::In) => Place::Input,
            Some(Storage::Out) => Place::Output,
            Some(Storage::Varying) if self.shader.stage == Stage::Vertex => Place::Output,
            Some(Storage::Varying) => Place::Input,
            Some(Storage::Uniform) => Place::Uniform,
            Some(Storage::Shared) => Place::Shared,
            Some(Storage::Buffer) => {
                return self.fail(name.at, "`buffer` is for blocks");
            }
            Some(Storage::InOut) => {
                return self.fail(name.at, "`inout` is for parameters");
            }
        };
        if self.shader.has_opaque(ty) && place != Place::Uniform {
            return self.fail(name.at, "a texture or sampler is a `uniform`");
        }
        if self.shader.stage == Stage::Compute && matches!(place, Place::Input | Place::Output) {
            return self.fail(name.at, "a compute shader has no inputs and outputs of its own");
        }
        Ok(place)
    }

    fn global_var(
        &mut self,
        quals: &Quals,
        ty: Type,
        declarator: &'a ast::Declarator<'a>,
    ) -> Res<()> {
        let name = declarator.name;
        if ty == Type::Void {
            return self.fail(name.at, "a variable is not `void`");
        }
        if name.text.starts_with("gl_") {
            return self.redeclare(quals, &ty, name);
        }
        let place = self.global_place(quals, &ty, name)?;
        self.check_invariant(quals, place, name)?;
        let init = match &declarator.init {
            Some(init) => Some(self.initializer(init, &ty)?),
            None => None,
        };
        let ty = init.as_ref().map_or(ty, |init| init.ty.clone());
        if place == Place::Input && ty.is_integer() && self.shader.stage == Stage::Fragment {
            let flat = quals.interpolation.flat;
            if !flat {
                return self.fail(name.at, "an input of integers must be `flat`");
            }
        }
        if matches!(place, Place::Const | Place::Override) && init.is_none() {
            return self.fail(name.at, format!("the constant `{}` has no value", name.text));
        }
        if let Some(id) = quals.layout.constant_id
            && self.constant_with(id).is_some()
        {
            let message = format!("a specialisation constant has the id {id} already");
            return self.fail(name.at, message);
        }
        let index = self.new_var(name.text, ty, place, name.at);
        let var = self.var_mut(index);
        if place == Place::Const {
            var.known = init.as_ref().and_then(|init| init.known.clone());
        }
        var.init = init;
        var.layout = quals.layout.clone();
        var.interpolation = quals.interpolation;
        var.access = quals.access;
        self.shader.order.push(Item::Var(index));
        self.declare(name, Symbol::Var(index))
    }

    /// What the host gives is the same for every shader anyway.
    fn check_invariant(&mut self, quals: &Quals, place: Place, name: ast::Name<'a>) -> Res<()> {
        // Inputs of a fragment are computed by the vertex stage; since GLSL ES 3.00, it says so alone.
        let is_modern = self.version.es && self.version.number >= 300;
        let is_given = matches!(place, Place::Uniform | Place::UniformBlock)
            || (place == Place::Input && (is_modern || self.shader.stage == Stage::Vertex));
        match quals.interpolation.invariant && is_given {
            true => self.fail(name.at, "`invariant` is for what a shader computes"),
            false => Ok(()),
        }
    }

    /// `out float gl_FragDepth;` and its siblings.
    fn redeclare(&mut self, quals: &Quals, ty: &Type, name: ast::Name<'a>) -> Res<()> {
        let Some(index) = self.builtin_index(name.text, name.at)? else {
            return self.fail(name.at, "names that begin with `gl_` are reserved");
        };
        if quals.depth.is_some() {
            self.shader.depth_mode.clone_from(&quals.depth);
        }
        let var = self.var_mut(index);
        var.interpolation.invariant |= quals.interpolation.invariant;
        if matches!(ty, Type::Array(_, Some(_))) {
            var.ty = ty.clone();
        }
        Ok(())
    }

    fn block(&mut self, block: &'a ast::Block<'a>) -> Res<()> {
        let quals = self.quals(&block.quals)?;
        let place = match quals.storage {
            Some(Storage::Uniform) => Place::UniformBlock,
            Some(Storage::Buffer) => Place::StorageBlock,
            Some(Storage::In) => Place::Input,
            Some(Storage::Out) => Place::Output,
            _ => return self.fail(block.name.at, "a block is `uniform`, `buffer`, `in` or `out`"),
        };
        if block.name.text.starts_with("gl_") {
            return self.per_vertex(block);
        }
        self.check_name(block.name)?;
        self.check_block_name(place, block.name)?;
        self.check_invariant(&quals, place, block.name)?;
        let members = self.fields(&block.members, quals.storage)?;
        if members.is_empty() {
            return self.fail(block.name.at, "a block has at least one member");
        }
        self.check_block_members(place, &members)?;
        let content = self.shader.structs.len() as u32;
        let shape = self.shape_of(&members);
        if shape.1 > PARTS {
            return self.fail(block.name.at, "the block is too large");
        }
        self.shapes.push(shape);
        let name = block.name.text.to_owned();
        self.shader.structs.push(Struct { name, at: block.name.at, members, block: true });
        let (name, ty) = match &block.instance {
            Some((name, sizes)) => (*name, self.after_name(Type::Struct(content), sizes)?),
            None => (block.name, Type::Struct(content)),
        };
        let index = self.new_var(name.text, ty, place, name.at);
        self.set_block_layout(index, quals);
        self.var_mut(index).open = block.instance.is_none();
        self.shader.order.push(Item::Struct(content));
        self.shader.order.push(Item::Var(index));
        self.blocks.insert(block.name.text);
        match block.instance {
            Some(_) => self.declare(name, Symbol::Var(index)),
            None => block.members.iter().flat_map(|member| &member.names).enumerate().try_for_each(
                |(at, member)| self.declare(member.name, Symbol::Member(index, at as u32)),
            ),
        }
    }

    /// Two blocks of one kind have two names, and nothing else has them.
    fn check_block_name(&mut self, place: Place, name: ast::Name<'a>) -> Res<()> {
        if self.scopes[0].contains_key(name.text) {
            return self.fail(name.at, format!("`{}` is declared already", name.text));
        }
        let is_same = |var: &Var| {
            let Type::Struct(content) = *var.ty.innermost() else { return false };
            let content = &self.shader.structs[content as usize];
            var.place == place && content.block && content.name == name.text
        };
        match self.shader.vars.iter().any(is_same) {
            true => self.fail(name.at, format!("there is a block `{}` already", name.text)),
            false => Ok(()),
        }
    }

    /// The layout of a block: what is written before it, else what holds for the whole text.
    fn set_block_layout(&mut self, index: u32, quals: Quals) {
        let place = self.var(index).place;
        let kept = &self.packing[usize::from(place == Place::StorageBlock)];
        let (packing, rows) = (kept.packing, kept.row_major);
        let var = &mut self.shader.vars[index as usize];
        var.layout = quals.layout;
        var.layout.packing = var.layout.packing.or(packing).or(match place {
            // Push constants are packed tightly unless they say otherwise.
            Place::UniformBlock if var.layout.push => Some(Packing::Std430),
            // Vulkan's default; OpenGL leaves the layout of such a buffer open.
            Place::StorageBlock => Some(Packing::Std430),
            _ => Some(Packing::Std140),
        });
        var.layout.row_major = var.layout.row_major.or(rows);
        var.interpolation = quals.interpolation;
        var.access = quals.access;
    }

    fn check_block_members(&mut self, place: Place, members: &[Field]) -> Res<()> {
        let last = members.len() - 1;
        for (index, field) in members.iter().enumerate() {
            if self.shader.has_opaque(&field.ty) {
                return self.fail(field.at, "a texture or sampler is not in a block");
            }
            let open = has_unsized(&field.ty);
            if open && !(place == Place::StorageBlock && index == last) {
                let message = "only the last member of a buffer has an array without a size";
                return self.fail(field.at, message);
            }
        }
        Ok(())
    }

    /// `out gl_PerVertex { ... };` says what there is anyway, and how large its arrays are.
    fn per_vertex(&mut self, block: &'a ast::Block<'a>) -> Res<()> {
        if let Some((name, _)) = &block.instance {
            return self.refuse(name.at, "`gl_PerVertex` with an instance name is not translated");
        }
        for member in &block.members {
            let invariant = self.quals(&member.quals)?.interpolation.invariant;
            let base = self.spec_type(&member.ty, NO_SIZES)?;
            for declarator in &member.names {
                let ty = self.after_name(base.clone(), &declarator.sizes)?;
                let name = declarator.name;
                let Some(index) = self.builtin_index(name.text, name.at)? else { continue };
                let var = self.var_mut(index);
                var.interpolation.invariant |= invariant;
                if matches!(ty, Type::Array(_, Some(_))) {
                    var.ty = ty;
                }
            }
        }
        Ok(())
    }

    /// Whether opaque values of a type may be parameters.
    pub(super) fn is_passable(&self, ty: &Type) -> bool {
        match ty {
            Type::Opaque(opaque) => opaque.kind != OpaqueKind::Other,
            _ => !self.shader.has_opaque(ty),
        }
    }
}

/// How deep structures may nest.
const NESTED: u32 = 16;
/// How many members a structure may have, with those of the structures in it.
const PARTS: u32 = 4096;

/// No sizes.
pub(super) const NO_SIZES: &ast::Sizes<'static> = &Vec::new();

//! A program that is being written: its declarations, and the names and values that are visible.

use std::collections::BTreeSet;

use super::names::Names;
use super::types::{AXES, FLOAT, INT, Member, Scalar, Spelling, Struct, Type, UINT, When};
use crate::random::Random;

/// A constant, a variable of the module, or a member of a block.
#[derive(Debug, Clone)]
pub struct Value {
    /// The name of its declaration.
    pub root: String,
    /// The expression that reads it.
    pub path: String,
    pub ty: Type,
    pub is_mutable: bool,
    /// The condition under which it exists.
    pub when: Option<When>,
}

/// How a parameter is passed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Parameter {
    Value(Type),
    /// `ptr<function, T>`, or `inout` in GLSL.
    Pointer(Type),
    /// A texture and the sampler for it: two parameters.
    Texture,
}

/// A function that can be called.
#[derive(Debug, Clone)]
pub struct Signature {
    pub name: String,
    pub parameters: Vec<Parameter>,
    /// The parameters under a condition, if they differ.
    pub other: Option<(When, Vec<Parameter>)>,
    pub result: Type,
}

/// A texture and its sampler.
#[derive(Debug, Clone)]
pub struct Texture {
    pub name: String,
    pub sampler: String,
    pub kind: TextureKind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextureKind {
    Plain,
    Depth,
    Cube,
}

pub struct Draft {
    pub random: Random,
    pub names: Names,
    pub spelling: Spelling,
    pub axes: usize,
    pub structs: Vec<Struct>,
    pub aliases: Vec<(String, Type)>,
    pub values: Vec<Value>,
    pub textures: Vec<Texture>,
    pub functions: Vec<Signature>,
    /// The texts of the declarations. Each comes after those that it names.
    pub items: Vec<String>,
    /// The built-in functions that are called. No declaration may have their names.
    pub built_ins: BTreeSet<&'static str>,
    /// The next free binding.
    pub bindings: u32,
    /// The constants that a pipeline may set, and that always exist.
    pub overrides: Vec<(String, Type)>,
    /// The last id of them.
    pub ids: u32,
    /// The program has functions that GLSL 3.30 and GLSL ES 3.00 lack, so they are not among its
    /// targets.
    pub is_modern: bool,
    /// The program has matrices of two rows in blocks. GLSL has another layout for them, so it is not
    /// among the targets.
    pub has_two_rows: bool,
    /// The structure from the vertex to the fragment stage, which begins with the position.
    pub carried: Option<usize>,
    /// The vertex stage draws a triangle over the whole frame. Otherwise its position is random.
    pub places_corners: bool,
}

impl Draft {
    pub fn new(mut random: Random, spelling: Spelling) -> Self {
        let axes = 1 + random.below(AXES.len());
        let is_modern = random.chance(40);
        let has_two_rows = !spelling.is_glsl() && random.chance(25);
        let places_corners = random.chance(75);
        Self {
            random,
            names: Names::new(spelling.is_glsl()),
            spelling,
            axes,
            structs: Vec::new(),
            aliases: Vec::new(),
            values: Vec::new(),
            textures: Vec::new(),
            functions: Vec::new(),
            items: Vec::new(),
            built_ins: BTreeSet::new(),
            bindings: 0,
            overrides: Vec::new(),
            ids: 0,
            is_modern,
            has_two_rows,
            carried: None,
            places_corners,
        }
    }

    pub fn name(&mut self) -> String {
        self.names.declared(&mut self.random, &self.built_ins)
    }

    pub fn when(&mut self) -> When {
        let axis = self.random.below(self.axes);
        When { axis, value: self.random.below(AXES[axis].len().max(2)) }
    }

    /// A condition, with a probability in percent.
    pub fn perhaps(&mut self, percent: usize) -> Option<When> {
        self.random.chance(percent).then(|| self.when())
    }

    /// The name of a type, or often an alias if it has one.
    pub fn spell(&mut self, ty: &Type) -> String {
        let aliases: Vec<&String> =
            self.aliases.iter().filter(|(_, of)| of == ty).map(|(name, _)| name).collect();
        if !aliases.is_empty() && self.random.chance(60) {
            return (*self.random.pick(&aliases)).clone();
        }
        match ty {
            Type::Array(of, size) if !self.spelling.is_glsl() => {
                format!("array<{}, {size}>", self.spell(of))
            }
            _ => self.spelling.ty(ty, &self.structs),
        }
    }

    /// A random type of values.
    pub fn some_type(&mut self) -> Type {
        match self.random.below(14) {
            0..=2 => FLOAT,
            3 => INT,
            4 => UINT,
            5..=7 => Type::Vector(2 + self.random.below(3), Scalar::Float),
            8 => Type::Vector(2 + self.random.below(3), Scalar::Int),
            9 => Type::Vector(2 + self.random.below(3), Scalar::Uint),
            10 => self.matrix(),
            11 => {
                let of = self.element();
                Type::Array(Box::new(of), 2 + self.random.below(3))
            }
            _ if self.structs.is_empty() => FLOAT,
            _ => Type::Struct(self.random.below(self.structs.len())),
        }
    }

    /// A random type of matrices. From GLSL sources, the crate refuses two rows in blocks and
    /// structures.
    fn matrix(&mut self) -> Type {
        let rows = if self.spelling.is_glsl() { 3 } else { 2 };
        Type::Matrix(2 + self.random.below(3), rows + self.random.below(5 - rows))
    }

    /// A random type of an array's elements.
    fn element(&mut self) -> Type {
        match self.random.below(7) {
            0 => FLOAT,
            1 => INT,
            2 | 3 => Type::Vector(2 + self.random.below(3), Scalar::Float),
            4 => Type::Vector(2, Scalar::Uint),
            5 => self.matrix(),
            _ if self.structs.is_empty() => Type::Vector(4, Scalar::Float),
            _ => Type::Struct(self.random.below(self.structs.len())),
        }
    }

    pub fn structure(&mut self) {
        let name = self.name();
        let mut used = BTreeSet::new();
        let count = 1 + self.random.below(4);
        let members: Vec<Member> = (0..count)
            .map(|index| {
                let ty = self.member_type();
                let name = self.names.local(&mut self.random, &used);
                used.insert(name.clone());
                // The first member always exists, since a structure must not be empty.
                let when = if index > 0 { self.perhaps(20) } else { None };
                Member { name, ty, when }
            })
            .collect();
        let item = self.struct_text(&name, &members);
        self.items.push(item);
        self.structs.push(Struct { name, members });
    }

    /// A random type of a member. naga's GLSL front end gives arrays in structures another layout than
    /// other compilers, so GLSL sources have none.
    fn member_type(&mut self) -> Type {
        loop {
            let ty = self.some_type();
            if !(self.spelling.is_glsl() && matches!(ty, Type::Array(..))) {
                return ty;
            }
        }
    }

    fn struct_text(&mut self, name: &str, members: &[Member]) -> String {
        let mut text = format!("struct {name} {{\n");
        for member in members {
            let line = self.member(member);
            match member.when {
                None => text += &format!("{line}\n"),
                Some(when) => text += &self.spelling.either(when, &line, None),
            }
        }
        text + if self.spelling.is_glsl() { "};\n" } else { "}\n" }
    }

    fn member(&mut self, member: &Member) -> String {
        let ty = self.spell(&member.ty);
        let end = if self.spelling.is_glsl() { ";" } else { "," };
        self.spelling.declared(&member.name, &ty) + end
    }

    /// Adds an alias. Only WESL has them.
    pub fn alias(&mut self) {
        let ty = self.some_type();
        let name = self.name();
        let of = self.spell(&ty);
        self.items.push(format!("alias {name} = {of};\n"));
        self.aliases.push((name, ty));
    }

    /// Adds a uniform: a block, or one value. Blocks have types with the same layout in both languages.
    pub fn uniform(&mut self) {
        let (binding, name) = (self.bindings, self.name());
        self.bindings += 1;
        if !self.spelling.is_glsl() && self.random.chance(30) {
            let ty = Type::Vector(4, Scalar::Float);
            let spelt = self.spell(&ty);
            let text = format!("@group(0) @binding({binding}) var<uniform> {name}: {spelt};\n");
            self.items.push(text);
            let (root, path) = (name.clone(), name);
            self.values.push(Value { root, path, ty, is_mutable: false, when: None });
            return;
        }
        let block = self.name();
        let mut used = BTreeSet::new();
        let count = 2 + self.random.below(4);
        let members: Vec<Member> = (0..count)
            .map(|_| {
                let member = self.names.local(&mut self.random, &used);
                used.insert(member.clone());
                Member { name: member, ty: self.uniform_type(), when: None }
            })
            .collect();
        let head = match self.spelling.is_glsl() {
            true => format!("layout(set = 0, binding = {binding}) uniform {block} {{\n"),
            false => format!("struct {block} {{\n"),
        };
        let lines: Vec<String> =
            members.iter().map(|member| self.attributes() + &self.member(member)).collect();
        let end = match self.spelling.is_glsl() {
            true => format!("}} {name};\n"),
            false => {
                format!("}}\n@group(0) @binding({binding}) var<uniform> {name}: {block};\n")
            }
        };
        self.items.push(head + &lines.join("\n") + "\n" + &end);
        for member in members {
            let path = format!("{name}.{}", member.name);
            let (root, ty) = (name.clone(), member.ty);
            self.values.push(Value { root, path, ty, is_mutable: false, when: None });
        }
    }

    /// What moves a member of a block, or those behind it.
    fn attributes(&mut self) -> String {
        let aligned = *self.random.pick(&[16, 32, 64]);
        match (self.random.below(8), self.spelling.is_glsl()) {
            (0, false) => format!("@align({aligned}) "),
            // No type of a block has more bytes.
            (1, false) => format!("@size({}) ", 64 + aligned),
            (2, false) => format!("@size({}) @align({aligned}) ", 64 + aligned),
            (0 | 1, true) => format!("layout(align = {aligned}) "),
            _ => String::new(),
        }
    }

    fn uniform_type(&mut self) -> Type {
        match self.random.below(9) {
            0 => FLOAT,
            1 => INT,
            2 => Type::Vector(4, Scalar::Int),
            // `has_two_rows` is never set for GLSL sources, in which the crate refuses them.
            3 | 4 => {
                let rows = if self.has_two_rows { 2 } else { 4 };
                Type::Matrix(2 + self.random.below(3), rows)
            }
            5 => Type::Matrix(3, 3 + self.random.below(2)),
            6 => Type::Array(Box::new(Type::Vector(4, Scalar::Float)), 2 + self.random.below(3)),
            size => Type::Vector(size - 4, Scalar::Float),
        }
    }

    pub fn texture(&mut self) {
        let kind = *self.random.pick(&[TextureKind::Plain, TextureKind::Depth, TextureKind::Cube]);
        let (name, sampler) = (self.name(), self.name());
        let (first, second) = (self.bindings, self.bindings + 1);
        self.bindings += 2;
        let ty = match (kind, self.spelling.is_glsl()) {
            (TextureKind::Plain, false) => "texture_2d<f32>",
            (TextureKind::Depth, false) => "texture_depth_2d",
            (TextureKind::Cube, false) => "texture_cube<f32>",
            (TextureKind::Cube, true) => "textureCube",
            (_, true) => "texture2D",
        };
        let compare = match (kind, self.spelling.is_glsl()) {
            (TextureKind::Depth, false) => "sampler_comparison",
            (TextureKind::Depth, true) => "samplerShadow",
            _ => "sampler",
        };
        let text = match self.spelling.is_glsl() {
            true => format!(
                "layout(set = 0, binding = {first}) uniform {ty} {name};\n\
                 layout(set = 0, binding = {second}) uniform {compare} {sampler};\n"
            ),
            false => format!(
                "@group(0) @binding({first}) var {name}: {ty};\n\
                 @group(0) @binding({second}) var {sampler}: {compare};\n"
            ),
        };
        self.items.push(text);
        self.textures.push(Texture { name, sampler, kind });
    }
}

//! Writes bodies of functions: the names in scope, and expressions of a type.

use std::collections::BTreeSet;

use super::draft::{Draft, Texture, TextureKind};
use super::types::{FLOAT, INT, Scalar, Type, UINT, When};

/// A variable in scope.
#[derive(Debug, Clone)]
pub struct Local {
    pub name: String,
    pub ty: Type,
    pub is_mutable: bool,
    /// The variable of the function that it is, or that it points into. A call is given at most one
    /// pointer into each.
    pub root: Option<String>,
}

/// A function that is being written.
pub struct Body<'d> {
    pub draft: &'d mut Draft,
    pub locals: Vec<Local>,
    /// The textures that are parameters.
    pub textures: Vec<Texture>,
    /// The lines so far.
    pub lines: Vec<String>,
    /// The condition under which the function exists.
    pub given: Option<When>,
    /// The declarations of the module that the function names.
    pub used: BTreeSet<String>,
    /// How many functions may be called, from the first one on.
    pub callable: usize,
    /// What `return` gives; `None` where there must be none.
    pub result: Option<Type>,
    /// How many loops are around a statement that may leave the innermost.
    pub loops: usize,
}

impl Local {
    /// What no statement changes by its name.
    pub fn fixed(name: String, ty: Type) -> Self {
        Self { name, ty, is_mutable: false, root: None }
    }

    /// A variable of the function, or what a parameter points to.
    pub fn variable(name: String, ty: Type) -> Self {
        Self { root: Some(name.clone()), name, ty, is_mutable: true }
    }

    /// The name, without the `(*...)` that dereferences a pointer.
    pub fn plain(&self) -> &str {
        self.name.trim_matches(['(', '*', ')'])
    }
}

/// The greatest length of a path through members and elements of a value.
const REACH: usize = 3;

impl<'d> Body<'d> {
    pub fn new(draft: &'d mut Draft, given: Option<When>) -> Self {
        let callable = draft.functions.len();
        Self {
            draft,
            locals: Vec::new(),
            textures: Vec::new(),
            lines: Vec::new(),
            given,
            used: BTreeSet::new(),
            callable,
            result: None,
            loops: 0,
        }
    }

    /// Whether a local variable or a parameter hides a name of the module.
    pub fn hides(&self, name: &str) -> bool {
        self.locals.iter().any(|local| local.plain() == name)
            || self.textures.iter().any(|texture| texture.name == name || texture.sampler == name)
    }

    /// Whether a built-in function can be called here, because nothing hides its name. If so, the
    /// function counts as called, and no later declaration takes its name.
    pub fn has(&mut self, name: &'static str) -> bool {
        let is_free = !self.draft.names.is_declared(name) && !self.hides(name);
        if is_free {
            self.draft.built_ins.insert(name);
        }
        is_free
    }

    /// A name that is not in scope and that the function has not used so far.
    pub fn name(&mut self) -> String {
        let mut taken = self.used.clone();
        taken.extend(self.locals.iter().map(|local| local.plain().to_owned()));
        taken.extend(self.textures.iter().flat_map(|one| [one.name.clone(), one.sampler.clone()]));
        let draft = &mut *self.draft;
        taken.extend(draft.structs.iter().map(|one| one.name.clone()));
        taken.extend(draft.aliases.iter().map(|(name, _)| name.clone()));
        taken.extend(draft.built_ins.iter().map(|name| (*name).to_owned()));
        let built_in = ["modf", "frexp", "abs", "max", "min", "select", "clamp", "mix", "dot"];
        taken.extend(built_in.map(str::to_owned));
        draft.names.local(&mut draft.random, &taken)
    }

    pub fn below(&mut self, bound: usize) -> usize {
        self.draft.random.below(bound)
    }

    pub fn is_glsl(&self) -> bool {
        self.draft.spelling.is_glsl()
    }

    /// Paths to all variables, members and elements of a type that can be read, or that can be
    /// written if `is_written` is set.
    pub fn paths(&mut self, ty: &Type, is_written: bool) -> Vec<String> {
        let mut found = Vec::new();
        let index = self.index();
        for local in self.locals.iter().filter(|local| local.is_mutable || !is_written) {
            self.reach(&local.name, &local.ty, ty, &index, REACH, &mut found);
        }
        for value in self.draft.values.iter().filter(|value| value.is_mutable || !is_written) {
            let is_there = value.when.is_none() || value.when == self.given;
            if is_there && !self.hides(&value.root) {
                self.reach(&value.path, &value.ty, ty, &index, REACH, &mut found);
            }
        }
        found
    }

    /// An index that is not constant, if a variable can be one.
    fn index(&mut self) -> Option<String> {
        let counts = self.locals.iter().filter(|local| local.ty == UINT).map(|local| &local.name);
        let counts: Vec<String> = counts.cloned().collect();
        let has_min = self.has("min");
        (!counts.is_empty() && has_min && self.draft.random.chance(50))
            .then(|| self.draft.random.pick(&counts).clone())
    }

    fn reach(
        &self,
        path: &str,
        ty: &Type,
        wanted: &Type,
        index: &Option<String>,
        depth: usize,
        found: &mut Vec<String>,
    ) {
        if ty == wanted && !path.is_empty() {
            found.push(path.to_owned());
        }
        if depth == 0 {
            return;
        }
        let at = |size: usize| match index {
            Some(index) => format!("[min({index}, {}u)]", size - 1),
            None => format!("[{}]", size - 1),
        };
        let mut deeper = |path: String, ty: &Type| {
            self.reach(&path, ty, wanted, index, depth - 1, found);
        };
        match ty {
            Type::Scalar(_) => {}
            Type::Vector(size, scalar) => {
                let scalar = Type::Scalar(*scalar);
                deeper(format!("{path}.{}", ["x", "y", "z", "w"][size - 1]), &scalar);
                deeper(format!("{path}.x"), &scalar);
                deeper(format!("{path}{}", at(*size)), &scalar);
            }
            // naga's GLSL front end refuses a component of a column with an index that is not
            // constant.
            Type::Matrix(columns, rows) => {
                let last = if self.is_glsl() { "[1]".to_owned() } else { at(*columns) };
                deeper(format!("{path}{last}"), &Type::Vector(*rows, Scalar::Float));
                deeper(format!("{path}[0]"), &Type::Vector(*rows, Scalar::Float));
            }
            Type::Array(of, size) => deeper(format!("{path}{}", at(*size)), of),
            Type::Struct(number) => {
                for member in &self.draft.structs[*number].members {
                    if member.when.is_none() || member.when == self.given {
                        deeper(format!("{path}.{}", member.name), &member.ty);
                    }
                }
            }
        }
    }

    /// An expression of a type.
    pub fn value(&mut self, ty: &Type, depth: usize) -> String {
        let is_leaf = depth == 0 || self.draft.random.chance(25);
        if is_leaf || matches!(ty, Type::Struct(_) | Type::Array(..)) && self.below(3) > 0 {
            let paths = self.paths(ty, false);
            if !paths.is_empty() && self.draft.random.chance(90) {
                let path = self.draft.random.pick(&paths).clone();
                self.note(&path);
                return path;
            }
        }
        if !is_leaf
            && self.draft.random.chance(25)
            && let Some(result) = self.called(ty)
        {
            return result;
        }
        match ty {
            Type::Scalar(_) if is_leaf => self.literal(ty),
            Type::Scalar(Scalar::Float) => self.float(depth - 1),
            Type::Scalar(scalar) => self.integer(*scalar, depth - 1),
            Type::Vector(size, scalar) => self.vector(*size, *scalar, depth.saturating_sub(1)),
            Type::Matrix(columns, rows) => self.matrix(*columns, *rows, depth.saturating_sub(1)),
            Type::Array(of, size) => {
                let parts: Vec<String> =
                    (0..*size).map(|_| self.value(of, depth.saturating_sub(1))).collect();
                let name = self.draft.spell(ty);
                format!("{name}({})", parts.join(", "))
            }
            Type::Struct(number) => self.structure(*number, depth.saturating_sub(1)),
        }
    }

    /// Records that the function uses the declaration at the start of a path.
    pub fn note(&mut self, path: &str) {
        let name = path.split(['.', '[']).next().unwrap_or(path);
        self.used.insert(name.to_owned());
    }

    pub fn literal(&mut self, ty: &Type) -> String {
        match ty {
            Type::Scalar(Scalar::Int) => self.draft.random.pick(&["1", "2", "3", "7"]).to_string(),
            Type::Scalar(Scalar::Uint) => {
                self.draft.random.pick(&["1u", "2u", "3u", "5u"]).to_string()
            }
            _ => self.draft.random.pick(&["0.5", "1.0", "0.25", "1.75", "2.0"]).to_string(),
        }
    }

    /// A value of a structure: its constructor, or a variable if members depend on an axis.
    fn structure(&mut self, number: usize, depth: usize) -> String {
        let of = self.draft.structs[number].clone();
        if of.is_plain() {
            let parts: Vec<String> =
                of.members.iter().map(|member| self.value(&member.ty, depth)).collect();
            let name = self.draft.spell(&Type::Struct(number));
            return format!("{name}({})", parts.join(", "));
        }
        let name = self.name();
        let ty = self.draft.spell(&Type::Struct(number));
        let declared = self.draft.spelling.declared(&name, &ty);
        let var = if self.is_glsl() { "" } else { "var " };
        self.lines.push(format!("{var}{declared};"));
        for member in &of.members {
            let value = self.value(&member.ty, depth.min(1));
            let line = format!("{name}.{} = {value};", member.name);
            let line = match member.when {
                Some(when) => self.draft.spelling.either(when, &line, None),
                None => line,
            };
            self.lines.push(line);
        }
        self.locals.push(Local::variable(name.clone(), Type::Struct(number)));
        name
    }

    fn vector(&mut self, size: usize, scalar: Scalar, depth: usize) -> String {
        let (ty, part) = (Type::Vector(size, scalar), Type::Scalar(scalar));
        let name = self.draft.spell(&ty);
        if depth == 0 {
            let parts: Vec<String> = (0..size).map(|_| self.value(&part, 0)).collect();
            return format!("{name}({})", parts.join(", "));
        }
        let one = self.value(&ty, depth);
        match (scalar, self.below(9)) {
            (_, 0) => {
                let part = self.value(&part, depth);
                format!("{name}({part})")
            }
            (Scalar::Float, choice) => self.float_vector((&name, size), one, choice, depth),
            (_, choice) => self.integer_vector((&name, size, scalar), one, choice, depth),
        }
    }

    fn float_vector(
        &mut self,
        (name, size): (&str, usize),
        one: String,
        choice: usize,
        depth: usize,
    ) -> String {
        let ty = Type::Vector(size, Scalar::Float);
        match choice {
            1 => {
                let columns = 2 + self.below(3);
                let matrix = self.value(&Type::Matrix(columns, size), depth);
                let vector = self.value(&Type::Vector(columns, Scalar::Float), depth - 1);
                format!("(({matrix} * {vector}) * 0.25)")
            }
            2 if self.has("mix") && self.has("clamp") => {
                let other = self.value(&ty, depth);
                format!("mix({one}, {other}, clamp({one}, {name}(0.0), {name}(1.0)))")
            }
            3 if !self.is_glsl() && self.has("modf") => format!("modf({one}).fract"),
            4 if self.draft.is_modern && !self.is_glsl() && self.has("frexp") => {
                format!("frexp({one}).fract")
            }
            _ => {
                let other = self.value(&ty, depth);
                let operator = self.draft.random.pick(&["+", "-", "*"]);
                format!("(({one} {operator} {other}) * 0.5)")
            }
        }
    }

    fn integer_vector(
        &mut self,
        (name, size, scalar): (&str, usize, Scalar),
        one: String,
        choice: usize,
        depth: usize,
    ) -> String {
        let ty = Type::Vector(size, scalar);
        match choice {
            1 => {
                let other = self.value(&Type::Vector(size, Scalar::Float), depth);
                match scalar {
                    // As for scalars: GLSL does not define what a negative float becomes.
                    Scalar::Uint if self.draft.has_two_rows => format!("{name}({other})"),
                    Scalar::Uint if self.has("abs") => format!("{name}(abs({other}))"),
                    Scalar::Uint => one,
                    _ => format!("{name}({other})"),
                }
            }
            2 | 3 => {
                let other = self.value(&ty, depth);
                let one_of = self.literal(&Type::Scalar(scalar));
                let operator = self.draft.random.pick(&["/", "%"]);
                format!("({one} {operator} ({other} | {name}({one_of})))")
            }
            4 if scalar == Scalar::Int => format!("(-{one})"),
            5 if scalar == Scalar::Int && self.has("abs") => format!("abs({one})"),
            _ => {
                let other = self.value(&ty, depth);
                let most = if scalar == Scalar::Uint { "31u" } else { "31" };
                let operator = self.draft.random.pick(&["+", "^", "|", "&", "*"]);
                format!("(({one} {operator} {other}) & {name}({most}))")
            }
        }
    }

    fn matrix(&mut self, columns: usize, rows: usize, depth: usize) -> String {
        let ty = Type::Matrix(columns, rows);
        if depth > 0 && self.draft.random.chance(30) && self.has("transpose") {
            let other = self.value(&Type::Matrix(rows, columns), depth);
            return format!("transpose({other})");
        }
        if depth > 0 && self.draft.random.chance(30) {
            let one = self.value(&ty, depth - 1);
            let by = self.value(&FLOAT, depth - 1);
            return format!("({one} * {by})");
        }
        let column = Type::Vector(rows, Scalar::Float);
        let parts: Vec<String> =
            (0..columns).map(|_| self.value(&column, depth.saturating_sub(1))).collect();
        let name = self.draft.spell(&ty);
        format!("{name}({})", parts.join(", "))
    }

    pub fn condition(&mut self, depth: usize) -> String {
        let ty = self.draft.random.pick(&[FLOAT, INT, UINT]).clone();
        let (one, other) = (self.value(&ty, depth), self.value(&ty, depth));
        let operator = self.draft.random.pick(&["<", ">", "<=", "!="]);
        format!("({one} {operator} {other})")
    }

    /// A condition that calls nothing, for places where no statement can stand before it.
    pub fn plain_condition(&mut self) -> String {
        self.condition(0)
    }

    /// A lookup in a texture of the module or in one that is a parameter.
    pub fn sampled(&mut self, depth: usize) -> Option<String> {
        let hidden =
            |texture: &&Texture| !self.hides(&texture.name) && !self.hides(&texture.sampler);
        let mut all: Vec<Texture> = self.draft.textures.iter().filter(hidden).cloned().collect();
        all.extend(self.textures.iter().cloned());
        if all.is_empty() {
            return None;
        }
        let texture = self.draft.random.pick(&all).clone();
        let Texture { name, sampler, kind } = &texture;
        let size = if *kind == TextureKind::Cube { 3 } else { 2 };
        let mut at = self.value(&Type::Vector(size, Scalar::Float), depth);
        self.used.extend([name.clone(), sampler.clone()]);
        let glsl = self.is_glsl();
        if *kind == TextureKind::Cube {
            // On an edge of the cube, either face may be read.
            let vector = self.draft.spelling.ty(&Type::Vector(3, Scalar::Float), &[]);
            at = format!("({at} + {vector}(0.0117, 0.0431, 0.0873))");
        }
        Some(match (kind, glsl) {
            (TextureKind::Plain, false) if self.below(4) == 0 && self.has("textureLoad") => {
                let size = format!("vec2i(textureDimensions({name}))");
                format!("textureLoad({name}, {size} - vec2i(1), 0).x")
            }
            (TextureKind::Depth, false) => {
                format!("textureSampleCompareLevel({name}, {sampler}, {at}, 0.5)")
            }
            (_, false) => format!("textureSampleLevel({name}, {sampler}, {at}, 0.0).y"),
            (TextureKind::Plain, true) => {
                format!("textureLod(sampler2D({name}, {sampler}), {at}, 0.0).y")
            }
            (TextureKind::Depth, true) => {
                format!("textureLod(sampler2DShadow({name}, {sampler}), vec3({at}, 0.5), 0.0)")
            }
            (TextureKind::Cube, true) => {
                format!("textureLod(samplerCube({name}, {sampler}), {at}, 0.0).y")
            }
        })
    }
}

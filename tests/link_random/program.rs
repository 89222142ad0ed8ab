//! A random program: its manifest and its one file.

use std::fmt::Write as _;

use lamplight::bundle::{Language, Target};
use lamplight::emit::targets;
use naga::back::glsl::Version;

use super::body::{Body, Local};
use super::draft::{Draft, Parameter, Signature, Texture, TextureKind, Value};
use super::types::{AXES, FLOAT, INT, Scalar, Spelling, Type, UINT, When};
use crate::random::Random;

/// A program, as it is given to the crate.
#[derive(Debug, Clone)]
pub struct Program {
    pub seed: u64,
    pub language: Language,
    pub manifest: String,
    pub targets: Vec<Target>,
    /// The name of its one file.
    pub file: &'static str,
    pub text: String,
    /// Whether the vertex stage draws a triangle over the whole frame, so that it can be run.
    pub places_corners: bool,
}

impl Program {
    /// The program of a seed.
    pub fn new(seed: u64) -> Self {
        let mut random = Random(seed);
        let language = if random.chance(30) { Language::Glsl } else { Language::Wesl };
        let mut draft = Draft::new(random, Spelling(language));
        draft.declarations();
        let (key, file) = match language {
            Language::Wesl => {
                draft.wesl_stages();
                ("wesl = \"program.wesl\"", "program.wesl")
            }
            Language::Glsl if draft.random.chance(30) => {
                draft.glsl_vertex();
                ("glsl = { vertex = \"program.vert.glsl\" }", "program.vert.glsl")
            }
            Language::Glsl => {
                draft.glsl_fragment();
                ("glsl = { fragment = \"program.frag.glsl\" }", "program.frag.glsl")
            }
        };
        let mut targets = Target::ALL.to_vec();
        if draft.is_modern {
            let is_new = |version| matches!(version, Version::Desktop(450..));
            targets.retain(|target| glsl_version(*target).is_none_or(is_new));
        }
        if draft.has_two_rows {
            targets.retain(|target| glsl_version(*target).is_none());
        }
        let mut manifest = manifest(key, &targets, draft.axes);
        // The checks change what writers make of a program, and no result.
        if seed % 3 == 1 {
            manifest = manifest.replacen("targets", "bounds = \"restrict\"\ntargets", 1);
        }
        let text = match language {
            Language::Glsl => format!("#version 450\n{}", draft.items.concat()),
            Language::Wesl => {
                // The order of declarations has no meaning in WGSL.
                draft.random.shuffle(&mut draft.items);
                let directive = match draft.random.chance(20) {
                    true => "diagnostic(off, derivative_uniformity);\n",
                    false => "",
                };
                directive.to_owned() + &draft.items.concat()
            }
        };
        let places_corners = draft.places_corners;
        Self { seed, language, manifest, targets, file, text, places_corners }
    }
}

/// The version of a target that is GLSL.
fn glsl_version(target: Target) -> Option<Version> {
    targets::find(target).and_then(|entry| entry.glsl)
}

fn manifest(files: &str, targets: &[Target], axes: usize) -> String {
    let targets: Vec<&str> = targets.iter().map(|target| target.name()).collect();
    let mut text =
        format!("[program.random]\n{files}\ntargets = {targets:?}\n[program.random.axis]\n");
    for (index, values) in AXES.iter().take(axes).enumerate() {
        let values = match values.is_empty() {
            true => "[false, true]".to_owned(),
            false => format!("{values:?}"),
        };
        let _ = writeln!(text, "axis_{index} = {{ values = {values} }}");
    }
    text
}

impl Draft {
    fn declarations(&mut self) {
        for _ in 0..1 + self.random.below(3) {
            self.structure();
        }
        for _ in 0..self.random.below(3) {
            match self.spelling.is_glsl() {
                true => {}
                false => self.alias(),
            }
        }
        for _ in 0..self.random.below(3) {
            self.uniform();
        }
        for _ in 0..self.random.below(3) {
            self.texture();
        }
        for _ in 0..1 + self.random.below(3) {
            self.constant();
        }
        for _ in 0..self.random.below(3) {
            self.private();
        }
    }

    pub fn functions(&mut self) {
        for _ in 0..1 + self.random.below(4) {
            self.function();
        }
    }

    /// A value that consists of literals.
    fn literal(&mut self, ty: &Type) -> String {
        let some = match ty {
            Type::Scalar(Scalar::Float) => {
                return self.random.pick(&["0.5", "1.0", "0.25", "-1.5"]).to_string();
            }
            Type::Scalar(Scalar::Int) => {
                return self.random.pick(&["1", "2", "-3", "7"]).to_string();
            }
            Type::Scalar(Scalar::Uint) => {
                return self.random.pick(&["1u", "2u", "3u"]).to_string();
            }
            Type::Vector(size, scalar) => vec![Type::Scalar(*scalar); *size],
            Type::Matrix(columns, rows) => vec![Type::Vector(*rows, Scalar::Float); *columns],
            Type::Array(of, size) => vec![(**of).clone(); *size],
            Type::Struct(index) => {
                self.structs[*index].members.iter().map(|member| member.ty.clone()).collect()
            }
        };
        let parts: Vec<String> = some.iter().map(|ty| self.literal(ty)).collect();
        format!("{}({})", self.spell(ty), parts.join(", "))
    }

    /// Whether no member of the type depends on an axis.
    fn is_plain(&self, ty: &Type) -> bool {
        match ty {
            Type::Array(of, _) => self.is_plain(of),
            Type::Struct(index) => {
                let of = &self.structs[*index];
                of.is_plain() && of.members.iter().all(|member| self.is_plain(&member.ty))
            }
            _ => true,
        }
    }

    /// A random type whose values can be constants in the language.
    fn constant_type(&mut self) -> Type {
        loop {
            let ty = self.some_type();
            let is_struct = match &ty {
                Type::Struct(_) => true,
                Type::Array(of, _) => matches!(**of, Type::Struct(_)),
                _ => false,
            };
            if self.is_plain(&ty) && !(is_struct && self.spelling.is_glsl()) {
                return ty;
            }
        }
    }

    fn constant(&mut self) {
        let ty = self.constant_type();
        let name = self.name();
        let is_scalar = matches!(ty, Type::Scalar(_));
        let overrides = is_scalar && !self.spelling.is_glsl() && self.random.chance(60);
        let mut one = || {
            if overrides {
                return self.overridable(&name, &ty);
            }
            let value = self.literal(&ty);
            let spelt = self.spell(&ty);
            let declared = self.spelling.declared(&name, &spelt);
            match self.spelling.is_glsl() {
                false if self.random.chance(50) && !is_scalar => {
                    format!("const {name} = {value};\n")
                }
                _ => format!("const {declared} = {value};\n"),
            }
        };
        let (some, other) = (one(), one());
        let (text, when) = match self.random.below(5) {
            0 => {
                let when = self.when();
                (self.spelling.either(when, &some, Some(&other)), None)
            }
            1 => {
                let when = self.when();
                (self.spelling.either(when, &some, None), Some(when))
            }
            _ => (some, None),
        };
        self.items.push(text);
        if overrides && when.is_none() {
            self.overrides.push((name.clone(), ty.clone()));
        }
        self.values.push(Value { root: name.clone(), path: name, ty, is_mutable: false, when });
    }

    /// A constant that a pipeline may set. Its value may be computed from others.
    fn overridable(&mut self, name: &str, ty: &Type) -> String {
        let id = match self.random.chance(30) {
            true => {
                self.ids += 1;
                format!("@id({}) ", self.ids)
            }
            false => String::new(),
        };
        let (value, spelt) = (self.from_overrides(ty), self.spell(ty));
        format!("{id}override {name}: {spelt} = {value};\n")
    }

    /// A literal, or a value that is computed from constants of the pipeline.
    fn from_overrides(&mut self, ty: &Type) -> String {
        let literal = self.literal(ty);
        let same = self.overrides.iter().filter(|(_, of)| of == ty).map(|(name, _)| name.clone());
        let same: Vec<String> = same.collect();
        match same.is_empty() || self.random.chance(50) {
            true => literal,
            false => {
                let operator = self.random.pick(&["+", "*"]);
                format!("{} {operator} {literal}", self.random.pick(&same))
            }
        }
    }

    fn private(&mut self) {
        let ty = self.constant_type();
        let (name, spelt) = (self.name(), self.spell(&ty));
        let declared = self.spelling.declared(&name, &spelt);
        let value = match self.random.chance(60) || self.spelling.is_glsl() {
            true => format!(" = {}", self.from_overrides(&ty)),
            false => String::new(),
        };
        let var = if self.spelling.is_glsl() { "" } else { "var<private> " };
        self.items.push(format!("{var}{declared}{value};\n"));
        let (root, path) = (name.clone(), name);
        self.values.push(Value { root, path, ty, is_mutable: true, when: None });
    }

    fn parameters(&mut self) -> Vec<Parameter> {
        let count = self.random.below(4);
        let mut one = || match self.random.below(8) {
            0 if !self.textures.is_empty() && !self.spelling.is_glsl() => Parameter::Texture,
            1 | 2 => Parameter::Pointer(self.some_type()),
            _ => Parameter::Value(self.some_type()),
        };
        (0..count).map(|_| one()).collect()
    }

    fn function(&mut self) {
        let (name, result) = (self.name(), self.some_type());
        let parameters = self.parameters();
        let plain = self.function_text(&name, &parameters, &result, None);
        let (text, other) = match self.perhaps(40) {
            None => (plain, None),
            Some(when) => {
                let others =
                    if self.random.chance(50) { self.parameters() } else { parameters.clone() };
                let some = self.function_text(&name, &others, &result, Some(when));
                let other = (others != parameters).then_some((when, others));
                (self.spelling.either(when, &some, Some(&plain)), other)
            }
        };
        self.items.push(text);
        self.functions.push(Signature { name, parameters, other, result });
    }

    fn function_text(
        &mut self,
        name: &str,
        parameters: &[Parameter],
        result: &Type,
        given: Option<When>,
    ) -> String {
        let glsl = self.spelling.is_glsl();
        let spelt = self.spell(result);
        let mut body = Body::new(self, given);
        let mut list = Vec::new();
        // A parameter must not have the function's own name.
        body.used.insert(name.to_owned());
        for parameter in parameters {
            list.push(body.parameter(parameter));
        }
        body.seeded();
        body.result = Some(result.clone());
        body.statements(2);
        let (value, attribute) = (body.value(result, 2), body.attribute());
        let lines = body.lines.join("\n");
        let list = list.join(", ");
        match glsl {
            true => format!("{spelt} {name}({list}) {{\n{lines}\nreturn {value};\n}}\n"),
            false => {
                let head = format!("{attribute}fn {name}({list}) -> {spelt}");
                format!("{head} {{\n{lines}\nreturn {value};\n}}\n")
            }
        }
    }
}

impl Body<'_> {
    /// The text of a parameter. The body may use it from then on.
    fn parameter(&mut self, parameter: &Parameter) -> String {
        let glsl = self.draft.spelling.is_glsl();
        let name = self.name();
        match parameter {
            Parameter::Value(ty) => {
                let spelt = self.draft.spell(ty);
                let declared = self.draft.spelling.declared(&name, &spelt);
                self.locals.push(match glsl {
                    true => Local::variable(name, ty.clone()),
                    false => Local::fixed(name, ty.clone()),
                });
                declared
            }
            Parameter::Pointer(ty) => {
                let spelt = self.draft.spell(ty);
                let declared = self.draft.spelling.declared(&name, &spelt);
                let text = match glsl {
                    true => format!("inout {declared}"),
                    false => format!("{name}: ptr<function, {spelt}>"),
                };
                let name = if glsl { name } else { format!("(*{name})") };
                self.locals.push(Local::variable(name, ty.clone()));
                text
            }
            Parameter::Texture => {
                self.textures.push(Texture {
                    name: name.clone(),
                    sampler: String::new(),
                    kind: TextureKind::Plain,
                });
                let sampler = self.name();
                let text = format!("{name}: texture_2d<f32>, {sampler}: sampler");
                self.textures.pop();
                self.textures.push(Texture { name, sampler, kind: TextureKind::Plain });
                text
            }
        }
    }

    /// Adds a variable of each scalar type that has none, so that expressions are not all constant.
    pub fn seeded(&mut self) {
        for ty in [FLOAT, INT, UINT] {
            let is_it = |local: &Local| local.ty == ty;
            if !self.locals.iter().any(is_it) {
                let (name, value) = (self.name(), self.first(&ty));
                let spelt = self.draft.spelling.ty(&ty, &[]);
                let declared = self.draft.spelling.declared(&name, &spelt);
                let var = if self.draft.spelling.is_glsl() { "" } else { "var " };
                self.lines.push(format!("{var}{declared} = {value};"));
                self.locals.push(Local::variable(name, ty));
            }
        }
    }

    /// The initial value of a variable: now and then the largest or the smallest of its type.
    fn first(&mut self, ty: &Type) -> String {
        if !self.draft.random.chance(8) {
            return self.literal(ty);
        }
        let extreme: &[&str] = match ty {
            Type::Scalar(Scalar::Int) => &["2147483647", "(-2147483647 - 1)", "-1", "0"],
            Type::Scalar(Scalar::Uint) => &["4294967295u", "2147483648u", "0u"],
            _ => &["16777216.0", "-8388609.0", "1e-30", "0.0"],
        };
        self.draft.random.pick(extreme).to_string()
    }
}

//! Writes entry points with their inputs and outputs.

use std::fmt::Write as _;

use super::body::{Body, Local};
use super::draft::{Draft, Value};
use super::types::{FLOAT, INT, Member, Scalar, Struct, Type, UINT, When};

const FOUR: Type = Type::Vector(4, Scalar::Float);

/// The values that go from the vertex stage to the fragment stage.
struct Between {
    /// Their types and conditions, by location.
    types: Vec<(Type, Option<When>)>,
}

impl Draft {
    fn between(&mut self) -> Between {
        let count = 1 + self.random.below(4);
        let types = (0..count).map(|index| {
            let ty = match self.random.below(6) {
                0 => FLOAT,
                1 => INT,
                2 => UINT,
                size => Type::Vector(size - 1, Scalar::Float),
            };
            (ty, if index > 0 { self.perhaps(25) } else { None })
        });
        Between { types: types.collect() }
    }

    /// Adds a structure that is the interface of a stage. Other functions may use it too.
    fn interface(&mut self, attributes: &[(String, Type, Option<When>)]) -> usize {
        let name = self.name();
        let mut text = format!("struct {name} {{\n");
        let (mut members, mut used) = (Vec::new(), std::collections::BTreeSet::new());
        for (attribute, ty, when) in attributes {
            let member = self.names.local(&mut self.random, &used);
            used.insert(member.clone());
            let spelt = self.spell(ty);
            let line = format!("{attribute} {member}: {spelt},");
            match when {
                None => text += &format!("{line}\n"),
                // The condition is an attribute before the member's own.
                Some(when) => text += &self.spelling.either(*when, &line, None),
            }
            members.push(Member { name: member, ty: ty.clone(), when: *when });
        }
        self.items.push(text + "}\n");
        self.structs.push(Struct { name, members });
        self.structs.len() - 1
    }

    /// Adds a vertex and a fragment stage.
    pub fn wesl_stages(&mut self) {
        let between = self.between();
        let located = between.types.iter().enumerate().map(|(location, (ty, when))| {
            let flat = if is_flat(ty) { " @interpolate(flat)" } else { "" };
            (format!("@location({location}){flat}"), ty.clone(), *when)
        });
        let located: Vec<_> = located.collect();
        let position = ("@builtin(position)".to_owned(), FOUR, None);
        let all: Vec<_> = std::iter::once(position).chain(located.clone()).collect();
        let carried = self.interface(&all);
        self.carried = Some(carried);
        let given = if self.random.chance(40) { Some(self.interface(&located)) } else { None };
        let drawn = self.drawn();
        self.functions();
        self.vertex_stage(carried);
        let taken = given.unwrap_or(carried);
        self.fragment_stage(taken, drawn);
    }

    /// Adds the structure that a fragment stage may return: a colour, more targets, and a depth.
    fn drawn(&mut self) -> usize {
        let mut targets = vec![("@location(0)".to_owned(), FOUR, None)];
        for location in 1..1 + self.random.below(3) {
            let size = 1 + self.random.below(4);
            let ty = if size == 1 { FLOAT } else { Type::Vector(size, Scalar::Float) };
            targets.push((format!("@location({location})"), ty, None));
        }
        if self.random.chance(15) {
            targets.push(("@builtin(frag_depth)".to_owned(), FLOAT, None));
        }
        self.interface(&targets)
    }

    fn vertex_stage(&mut self, carried: usize) {
        let name = self.name();
        let mut body = Body::new(self, None);
        body.used.insert(name.clone());
        let mut list = Vec::new();
        for (attribute, ty) in [
            ("@location(0)", Type::Vector(3, Scalar::Float)),
            ("@location(1)", FOUR),
            ("@builtin(vertex_index)", UINT),
            ("@builtin(instance_index)", UINT),
        ] {
            let (name, spelt) = (body.name(), body.draft.spelling.ty(&ty, &[]));
            list.push(format!("{attribute} {name}: {spelt}"));
            body.locals.push(Local::fixed(name, ty));
        }
        let index = body.locals[2].name.clone();
        body.seeded();
        body.statements(1);
        let value = body.value(&Type::Struct(carried), 2);
        let end = match body.draft.places_corners {
            false => format!("return {value};"),
            true => {
                let placed = body.name();
                let (ty, corner) =
                    (body.draft.spell(&Type::Struct(carried)), corner("vec4f", "f32", &index, "u"));
                let position = &body.draft.structs[carried].members[0].name;
                let declared = format!("var {placed}: {ty} = {value};");
                format!("{declared}\n{placed}.{position} = {corner};\nreturn {placed};")
            }
        };
        let (lines, result) = (body.lines.join("\n"), self.spell(&Type::Struct(carried)));
        let list = list.join(", ");
        self.items.push(format!("@vertex fn {name}({list}) -> {result} {{\n{lines}\n{end}\n}}\n"));
    }

    /// Adds a fragment stage. It returns a colour or a structure, or an axis decides which of them.
    fn fragment_stage(&mut self, taken: usize, drawn: usize) {
        let name = self.name();
        let color = |draft: &mut Self, when| draft.fragment(&name, taken, None, when);
        let many = |draft: &mut Self, when| draft.fragment(&name, taken, Some(drawn), when);
        let text = match self.random.below(4) {
            0 => color(self, None),
            1 => many(self, None),
            _ => {
                let when = self.when();
                let (some, other) = (many(self, Some(when)), color(self, None));
                self.spelling.either(when, &some, Some(&other))
            }
        };
        self.items.push(text);
    }

    fn fragment(
        &mut self,
        name: &str,
        taken: usize,
        drawn: Option<usize>,
        given: Option<When>,
    ) -> String {
        let (input, result) = (self.spell(&Type::Struct(taken)), drawn.map(Type::Struct));
        let has_position = self.carried == Some(taken);
        let mut body = Body::new(self, given);
        body.used.insert(name.to_owned());
        let argument = body.name();
        body.locals.push(Local::fixed(argument.clone(), Type::Struct(taken)));
        let more = body.built_ins(has_position);
        body.seeded();
        body.statements(2);
        let value = body.value(result.as_ref().unwrap_or(&FOUR), 3);
        let lines = body.lines.join("\n");
        let result = match result {
            Some(ty) => self.spell(&ty),
            None => format!("@location(0) {}", self.spell(&FOUR)),
        };
        let head = format!("@fragment fn {name}({argument}: {input}{more}) -> {result}");
        format!("{head} {{\n{lines}\nreturn {value};\n}}\n")
    }

    /// Adds the inputs of a GLSL stage. Every function can read them.
    fn glsl_inputs(&mut self, between: &Between) {
        for (location, (ty, when)) in between.types.iter().enumerate() {
            let (name, spelt) = (self.name(), self.spelling.ty(ty, &[]));
            let flat = if is_flat(ty) { "flat " } else { "" };
            let line = format!("layout(location = {location}) {flat}in {spelt} {name};");
            let text = match when {
                None => format!("{line}\n"),
                Some(when) => self.spelling.either(*when, &line, None),
            };
            self.items.push(text);
            let (root, path, ty) = (name.clone(), name, ty.clone());
            self.values.push(Value { root, path, ty, is_mutable: false, when: *when });
        }
    }

    /// Adds the outputs of a GLSL stage, and gives their names.
    fn glsl_outputs(&mut self, types: &[Type]) -> Vec<String> {
        let mut names = Vec::new();
        for (location, ty) in types.iter().enumerate() {
            let (name, spelt) = (self.name(), self.spelling.ty(ty, &[]));
            let flat = if is_flat(ty) { "flat " } else { "" };
            let text = format!("layout(location = {location}) {flat}out {spelt} {name};\n");
            self.items.push(text);
            names.push(name);
        }
        names
    }

    fn built_in(&mut self, name: &str, path: &str, ty: Type) {
        let (root, path) = (name.to_owned(), path.to_owned());
        self.values.push(Value { root, path, ty, is_mutable: false, when: None });
    }

    /// Adds the `main` of a GLSL stage, which writes the outputs and ends with given lines.
    fn glsl_main(&mut self, outputs: &[(String, Type)], last: &str) {
        let mut body = Body::new(self, None);
        body.used.extend(outputs.iter().map(|(name, _)| name.clone()));
        body.seeded();
        body.statements(2);
        let mut end = String::new();
        for (name, ty) in outputs {
            let value = body.value(ty, 3);
            let _ = writeln!(end, "{name} = {value};");
        }
        let lines = body.lines.join("\n");
        self.items.push(format!("void main() {{\n{lines}\n{end}{last}}}\n"));
    }

    pub fn glsl_fragment(&mut self) {
        let between = self.between();
        self.glsl_inputs(&between);
        if self.random.chance(40) {
            self.built_in("gl_FragCoord", "gl_FragCoord", FOUR);
        }
        let mut types = vec![FOUR];
        types.extend((0..self.random.below(2)).map(|_| Type::Vector(2, Scalar::Float)));
        let names = self.glsl_outputs(&types);
        self.functions();
        let outputs: Vec<_> = names.into_iter().zip(types).collect();
        self.glsl_main(&outputs, "");
    }

    pub fn glsl_vertex(&mut self) {
        let between = self.between();
        let given = vec![(Type::Vector(3, Scalar::Float), None), (FOUR, None)];
        self.glsl_inputs(&Between { types: given });
        self.built_in("gl_VertexIndex", "int(gl_VertexIndex)", INT);
        let types: Vec<Type> = between.types.into_iter().map(|(ty, _)| ty).collect();
        let names = self.glsl_outputs(&types);
        self.functions();
        let mut outputs: Vec<_> = names.into_iter().zip(types).collect();
        if !self.places_corners {
            outputs.push(("gl_Position".to_owned(), FOUR));
            return self.glsl_main(&outputs, "");
        }
        let corner = corner("vec4", "float", "gl_VertexIndex", "");
        self.glsl_main(&outputs, &format!("gl_Position = {corner};\n"));
    }
}

impl Body<'_> {
    /// Adds parameters of a fragment stage with values that are built in, and gives their text.
    fn built_ins(&mut self, has_position: bool) -> String {
        let mut all = vec![("front_facing", None)];
        if !has_position {
            all.push(("position", Some(FOUR)));
        }
        // GLSL 3.30 and GLSL ES 3.00 lack them.
        if self.draft.is_modern {
            all.extend([("sample_index", Some(UINT)), ("sample_mask", Some(UINT))]);
        }
        let mut text = String::new();
        for (built_in, ty) in all {
            if !self.draft.random.chance(25) {
                continue;
            }
            let name = self.name();
            let spelt = ty.as_ref().map_or("bool".to_owned(), |ty| self.draft.spell(ty));
            let _ = write!(text, ", @builtin({built_in}) {name}: {spelt}");
            match ty {
                Some(ty) => self.locals.push(Local::fixed(name, ty)),
                None => self.facing(&name),
            }
        }
        text
    }

    /// Adds a number that depends on a condition by its name.
    fn facing(&mut self, name: &str) {
        // The name is in scope from here on.
        self.used.insert(name.to_owned());
        let number = self.declare(FLOAT, true);
        self.lines.push(format!("if {name} {{ {number} += 0.5; }}"));
    }
}

/// The place of a vertex by its index: three corners of one triangle over the whole frame.
fn corner(vector: &str, float: &str, index: &str, suffix: &str) -> String {
    let (x, y) = (format!("({index} << 1u) & 2{suffix}"), format!("{index} & 2{suffix}"));
    format!("{vector}({float}({x}) * 2.0 - 1.0, {float}({y}) * 2.0 - 1.0, 0.0, 1.0)")
}

fn is_flat(ty: &Type) -> bool {
    matches!(ty, Type::Scalar(Scalar::Int | Scalar::Uint))
}

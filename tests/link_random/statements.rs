//! Writes statements, and calls of functions whose signature may depend on an axis.

use super::body::{Body, Local};
use super::draft::{Parameter, Signature, Texture, TextureKind};
use super::types::{FLOAT, INT, Type};

/// The most statements of a block.
const MOST: usize = 3;
/// The depth of their expressions.
const DEPTH: usize = 2;

impl Body<'_> {
    /// Adds one to [`MOST`] statements.
    pub fn statements(&mut self, nesting: usize) {
        for _ in 0..1 + self.below(MOST) {
            self.statement(nesting);
        }
    }

    fn statement(&mut self, nesting: usize) {
        match self.below(16) {
            0..=3 => self.variable(),
            4 | 5 => self.assignment(),
            6 => self.either(),
            7 if nesting > 0 => self.branch(nesting),
            8 | 9 if nesting > 0 => self.loops(nesting),
            10 if nesting > 0 => self.switch(nesting),
            11 if nesting > 0 => self.block("{", "}", nesting),
            12 => self.pointer(),
            13 => self.early(),
            _ => self.changed_number(),
        }
    }

    /// Adds a variable.
    pub fn variable(&mut self) {
        let ty = self.draft.some_type();
        let is_mutable = self.below(2) == 0;
        self.declare(ty, is_mutable);
    }

    pub fn declare(&mut self, ty: Type, is_mutable: bool) -> String {
        let value = self.value(&ty, DEPTH);
        let name = self.name();
        let glsl = self.draft.spelling.is_glsl();
        let declared = if glsl || is_mutable && self.below(2) == 0 {
            let spelt = self.draft.spell(&ty);
            self.draft.spelling.declared(&name, &spelt)
        } else {
            name.clone()
        };
        let word = match (glsl, is_mutable) {
            (true, _) => "",
            (false, true) => "var ",
            (false, false) => "let ",
        };
        self.lines.push(format!("{word}{declared} = {value};"));
        self.locals.push(match is_mutable {
            true => Local::variable(name.clone(), ty),
            false => Local::fixed(name.clone(), ty),
        });
        name
    }

    pub fn assignment(&mut self) {
        let ty = self.draft.some_type();
        if let Some(line) = self.assigned(&ty) {
            self.lines.push(line);
        }
    }

    fn assigned(&mut self, ty: &Type) -> Option<String> {
        let value = self.value(ty, DEPTH);
        let paths = self.paths(ty, true);
        if paths.is_empty() {
            return None;
        }
        let path = self.draft.random.pick(&paths).clone();
        self.note(&path);
        Some(format!("{path} = {value};"))
    }

    pub fn changed_number(&mut self) {
        let ty = self.draft.random.pick(&[FLOAT, INT, FLOAT]).clone();
        let value = self.value(&ty, DEPTH);
        let paths = self.paths(&ty, true);
        match paths.is_empty() {
            true => self.variable(),
            false => {
                let path = self.draft.random.pick(&paths).clone();
                self.note(&path);
                let operator = self.draft.random.pick(&["+=", "-="]);
                self.lines.push(format!("{path} {operator} {value};"));
            }
        }
    }

    /// Adds one statement for a value of an axis, and another for its other values.
    fn either(&mut self) {
        let when = self.draft.when();
        let ty = self.draft.some_type();
        let (some, other) = (self.assigned(&ty), self.assigned(&ty));
        if let (Some(some), Some(other)) = (some, other) {
            let text = self.draft.spelling.either(when, &some, Some(&other));
            self.lines.push(text);
        }
    }

    /// Adds a call of a function, and gives the name of the variable with its result.
    pub fn called(&mut self, ty: &Type) -> Option<String> {
        let functions = self.draft.functions[..self.callable].to_vec();
        let fitting = functions.into_iter().filter(|one| one.result == *ty);
        let fitting: Vec<Signature> = fitting.filter(|one| !self.hides(&one.name)).collect();
        if fitting.is_empty() {
            return None;
        }
        let function = self.draft.random.pick(&fitting).clone();
        self.used.insert(function.name.clone());
        let arguments = self.arguments(&function.parameters)?;
        let name = &function.name;
        let Some((when, parameters)) = &function.other else {
            let call = format!("{name}({arguments})");
            return Some(self.kept(ty, &call));
        };
        let others = self.arguments(parameters)?;
        let kept = self.name();
        let spelt = self.draft.spell(ty);
        let declared = self.draft.spelling.declared(&kept, &spelt);
        let var = if self.draft.spelling.is_glsl() { "" } else { "var " };
        self.lines.push(format!("{var}{declared};"));
        let some = format!("{kept} = {name}({others});");
        let other = format!("{kept} = {name}({arguments});");
        let text = self.draft.spelling.either(*when, &some, Some(&other));
        self.lines.push(text);
        self.locals.push(Local::variable(kept.clone(), ty.clone()));
        Some(kept)
    }

    /// Adds a variable with the result of a call, and gives its name. Calls change variables, and
    /// not every language defines the order of calls within an expression.
    fn kept(&mut self, ty: &Type, call: &str) -> String {
        let kept = self.name();
        let glsl = self.draft.spelling.is_glsl();
        let spelt = self.draft.spell(ty);
        let declared =
            if glsl { self.draft.spelling.declared(&kept, &spelt) } else { format!("let {kept}") };
        self.lines.push(format!("{declared} = {call};"));
        self.locals.push(Local::fixed(kept.clone(), ty.clone()));
        kept
    }

    fn arguments(&mut self, parameters: &[Parameter]) -> Option<String> {
        let (mut arguments, mut roots) = (Vec::new(), Vec::new());
        for parameter in parameters {
            match parameter {
                Parameter::Value(ty) => arguments.push(self.value(ty, 1)),
                Parameter::Pointer(ty) => arguments.push(self.pointed(ty, &mut roots)),
                Parameter::Texture => {
                    let Texture { name, sampler, .. } = self.plain_texture()?;
                    self.used.extend([name.clone(), sampler.clone()]);
                    arguments.push(format!("{name}, {sampler}"));
                }
            }
        }
        Some(arguments.join(", "))
    }

    /// The argument for a parameter that is a pointer, which leads into another variable than the
    /// pointers before it.
    fn pointed(&mut self, ty: &Type, roots: &mut Vec<String>) -> String {
        let is_free = |root: &String| !roots.contains(root);
        let is_it = |local: &&Local| {
            local.is_mutable && local.ty == *ty && local.root.as_ref().is_some_and(is_free)
        };
        let known: Vec<Local> = self.locals.iter().filter(is_it).cloned().collect();
        let (name, root) = match known.is_empty() {
            true => {
                let name = self.declare(ty.clone(), true);
                (name.clone(), Some(name))
            }
            false => {
                let Local { name, root, .. } = self.draft.random.pick(&known).clone();
                (name, root)
            }
        };
        roots.extend(root);
        match (name.starts_with("(*"), self.is_glsl()) {
            (true, _) => name.trim_matches(['(', '*', ')']).to_owned(),
            (false, true) => name,
            (false, false) => format!("&{name}"),
        }
    }

    fn plain_texture(&mut self) -> Option<Texture> {
        let is_it = |texture: &&Texture| {
            let hidden = self.hides(&texture.name) || self.hides(&texture.sampler);
            texture.kind == TextureKind::Plain && !hidden
        };
        let own = self.textures.iter();
        let all: Vec<Texture> =
            self.draft.textures.iter().filter(is_it).chain(own).cloned().collect();
        (!all.is_empty()).then(|| self.draft.random.pick(&all).clone())
    }
}

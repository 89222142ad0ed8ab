//! Writes branches, loops, switches and what ends them early, and pointers to parts of variables.

use super::body::{Body, Local};
use super::types::{FLOAT, INT, Scalar, Type, UINT};

/// What may stand before a statement of WESL. It changes nothing.
const DIAGNOSTIC: &str = "@diagnostic(off, derivative_uniformity) ";

/// How deep statements are in loops at most.
const LOOPS: usize = 2;

impl Body<'_> {
    /// An attribute of a statement or a function, now and then.
    pub fn attribute(&mut self) -> &'static str {
        if !self.is_glsl() && self.draft.random.chance(6) { DIAGNOSTIC } else { "" }
    }

    pub fn branch(&mut self, nesting: usize) {
        let (condition, attribute) = (self.condition(1), self.attribute());
        self.block(&format!("{attribute}if {condition} {{"), "}", nesting);
        match self.below(4) {
            0 => {
                // What the condition of an `else if` calls would be called before the first one.
                let condition = self.plain_condition();
                self.block(&format!("else if {condition} {{"), "}", nesting);
                self.block("else {", "}", nesting);
            }
            1 => self.block("else {", "}", nesting),
            _ => {}
        }
    }

    pub fn block(&mut self, head: &str, end: &str, nesting: usize) {
        self.lines.push(head.to_owned());
        let known = self.locals.len();
        self.statements(nesting - 1);
        self.locals.truncate(known);
        self.lines.push(end.to_owned());
    }

    /// A loop of some kind.
    pub fn loops(&mut self, nesting: usize) {
        if self.loops == LOOPS {
            return self.variable();
        }
        match (self.below(4), self.is_glsl()) {
            (0 | 1, _) => self.counted(nesting),
            (2, false) => self.with_continuing(nesting),
            _ => self.while_loop(nesting),
        }
    }

    /// The statements of a loop, which may leave it.
    fn looped(&mut self, nesting: usize) {
        self.loops += 1;
        self.statements(nesting - 1);
        self.loops -= 1;
    }

    fn counted(&mut self, nesting: usize) {
        let (name, attribute) = (self.name(), self.attribute());
        let ty = if self.is_glsl() { "int" } else { "var" };
        let most = 1 + self.below(3);
        let step = if self.below(2) == 0 { "++" } else { " += 1" };
        let known = self.locals.len();
        self.locals.push(Local::fixed(name.clone(), INT));
        let more = match self.below(4) {
            0 => format!(" && {}", self.plain_condition()),
            _ => String::new(),
        };
        let condition = format!("{name} < {most}{more}");
        self.lines.push(format!("{attribute}for ({ty} {name} = 0; {condition}; {name}{step}) {{"));
        self.looped(nesting);
        self.lines.push("}".to_owned());
        self.locals.truncate(known);
    }

    /// A counter that only the loop itself changes.
    fn counter(&mut self) -> String {
        let name = self.name();
        let declared = if self.is_glsl() { "int " } else { "var " };
        self.lines.push(format!("{declared}{name} = 0;"));
        self.locals.push(Local::fixed(name.clone(), INT));
        name
    }

    fn while_loop(&mut self, nesting: usize) {
        let counter = self.counter();
        let most = 1 + self.below(3);
        let condition = format!("{counter} < {most}");
        // `do` is a loop of GLSL alone.
        let is_last = self.is_glsl() && self.below(2) == 0;
        let known = self.locals.len();
        self.lines.push(match is_last {
            true => "do {".to_owned(),
            false => format!("while ({condition}) {{"),
        });
        self.lines.push(format!("{counter} += 1;"));
        self.looped(nesting);
        self.lines.push(match is_last {
            true => format!("}} while ({condition});"),
            false => "}".to_owned(),
        });
        self.locals.truncate(known);
    }

    /// A loop with `continuing`, which uses a value of the body.
    fn with_continuing(&mut self, nesting: usize) {
        let (counter, attribute) = (self.counter(), self.attribute());
        let known = self.locals.len();
        self.lines.push(format!("{attribute}loop {{"));
        let end = 1 + self.below(3);
        if self.below(2) == 0 {
            self.lines.push(format!("if {counter} >= {} {{ break; }}", end + 1));
        }
        let kept = [INT, UINT, FLOAT, Type::Vector(3, Scalar::Float)];
        let ty = self.draft.random.pick(&kept).clone();
        let is_mutable = self.below(2) == 0;
        let first = self.locals.len();
        let kept = self.declare(ty, is_mutable);
        let kept = self.locals[first..].iter().find(|one| one.name == kept).cloned();
        self.looped(nesting);
        self.locals.truncate(known);
        self.locals.extend(kept);
        self.lines.push("continuing {".to_owned());
        self.continuing();
        let more = match self.below(2) {
            0 => format!(" || {}", self.condition(1)),
            _ => String::new(),
        };
        self.lines.push(format!("{counter} += 1;"));
        self.lines.push(format!("break if {counter} > {end}{more};\n}}\n}}"));
        self.locals.truncate(known);
    }

    /// The statements of `continuing`, which nothing leaves.
    fn continuing(&mut self) {
        let (loops, result) = (std::mem::replace(&mut self.loops, 0), self.result.take());
        for _ in 0..1 + self.below(2) {
            match self.below(5) {
                0 => self.branch(1),
                1 => self.assignment(),
                2 => self.counted(1),
                _ => self.changed_number(),
            }
        }
        (self.loops, self.result) = (loops, result);
    }

    pub fn switch(&mut self, nesting: usize) {
        let ty = self.draft.random.pick(&[INT, UINT]).clone();
        let (value, attribute) = (self.value(&ty, 2), self.attribute());
        let suffix = if ty == UINT { "u" } else { "" };
        let value = if self.below(2) == 0 { format!("{value} & 3{suffix}") } else { value };
        self.lines.push(format!("{attribute}switch ({value}) {{"));
        let mut labels: Vec<String> =
            ["0", "1", "2", "3"].map(|one| format!("{one}{suffix}")).into();
        labels.push(if ty == UINT { "4294967295u" } else { "-1" }.to_owned());
        self.draft.random.shuffle(&mut labels);
        let default = self.below(3);
        for index in 0..3 {
            let count = self.below(3);
            let own: Vec<String> = labels.drain(..count.min(labels.len())).collect();
            if !own.is_empty() || index == default {
                let head = self.case_head(own, index == default);
                self.case(&head, nesting);
            }
        }
        self.lines.push("}".to_owned());
    }

    /// The labels of a case, of which one may be the default.
    fn case_head(&mut self, mut labels: Vec<String>, is_default: bool) -> String {
        if self.is_glsl() {
            let cases = labels.iter().map(|label| format!("case {label}: "));
            let default = if is_default { "default: " } else { "" };
            return cases.collect::<String>() + default + "{";
        }
        if is_default && labels.is_empty() {
            return "default: {".to_owned();
        }
        if is_default {
            let at = self.below(labels.len() + 1);
            labels.insert(at, "default".to_owned());
        }
        format!("case {}: {{", labels.join(", "))
    }

    fn case(&mut self, head: &str, nesting: usize) {
        self.lines.push(head.to_owned());
        let known = self.locals.len();
        if self.below(6) > 0 {
            self.statements(nesting - 1);
            if self.below(4) == 0 {
                let condition = self.condition(1);
                self.lines.push(format!("if {condition} {{ break; }}"));
                self.statements(0);
            }
        }
        self.locals.truncate(known);
        // The next case would follow in GLSL.
        self.lines.push(if self.is_glsl() { "} break;" } else { "}" }.to_owned());
    }

    /// `break`, `continue` or `return` under a condition.
    pub fn early(&mut self) {
        let condition = self.condition(1);
        match self.result.clone() {
            _ if self.loops > 0 && self.below(3) > 0 => {
                let word = *self.draft.random.pick(&["break", "continue"]);
                self.lines.push(format!("if {condition} {{ {word}; }}"));
            }
            Some(ty) if self.below(3) == 0 => {
                self.lines.push(format!("if {condition} {{"));
                let known = self.locals.len();
                let value = self.value(&ty, 1);
                self.lines.push(format!("return {value};\n}}"));
                self.locals.truncate(known);
            }
            _ => self.assignment(),
        }
    }

    /// A pointer to a variable or to a part of one. What it leads to is written to by its own name,
    /// too, and the index that it was taken with changes afterwards.
    pub fn pointer(&mut self) {
        let types =
            [INT, UINT, FLOAT, Type::Vector(4, Scalar::Float), Type::Vector(3, Scalar::Int)];
        let ty = self.draft.random.pick(&types).clone();
        let paths: Vec<String> =
            self.paths(&ty, true).into_iter().filter(|path| self.is_addressable(path)).collect();
        if self.is_glsl() || paths.is_empty() {
            return self.variable();
        }
        let path = self.draft.random.pick(&paths).clone();
        self.note(&path);
        let name = self.name();
        self.lines.push(format!("let {name} = &{path};"));
        self.changed_number();
        let (one, other) = (self.value(&ty, 2), self.value(&ty, 1));
        self.lines.push(format!("*{name} = {one};"));
        self.lines.push(format!("{path} = {other};"));
        let base = path.split(['.', '[']).next().unwrap_or_default();
        let root = self.locals.iter().rev().find(|one| one.name == base);
        let root = root.and_then(|one| one.root.clone());
        self.locals.push(Local { name: format!("(*{name})"), ty, is_mutable: true, root });
    }

    /// Whether there are pointers to what a path leads to. There are none to components of vectors.
    fn is_addressable(&self, path: &str) -> bool {
        let Some((base, last)) = split_last(path) else { return true };
        !last.is_empty()
            && matches!(self.type_of(base), Some(of) if !matches!(of, Type::Vector(..)))
    }

    /// The type that a path of names, members and elements leads to.
    fn type_of(&self, path: &str) -> Option<Type> {
        let named = |name: &str| {
            let local = self.locals.iter().rev().find(|local| local.name == name);
            let value = || self.draft.values.iter().find(|value| value.path == name);
            local.map(|one| one.ty.clone()).or_else(|| value().map(|one| one.ty.clone()))
        };
        if let Some(found) = named(path) {
            return Some(found);
        }
        let (base, last) = split_last(path)?;
        match (self.type_of(base)?, last.strip_prefix('.')) {
            (Type::Struct(number), Some(member)) => {
                let members = &self.draft.structs[number].members;
                members.iter().find(|one| one.name == member).map(|one| one.ty.clone())
            }
            (Type::Array(of, _), None) => Some(*of),
            (Type::Matrix(_, rows), None) => Some(Type::Vector(rows, Scalar::Float)),
            _ => None,
        }
    }
}

/// A path without its last member or element, and that.
fn split_last(path: &str) -> Option<(&str, &str)> {
    let at = match path.ends_with(']') {
        true => path.rfind('[')?,
        false => path.rfind('.')?,
    };
    (at > 0).then(|| path.split_at(at))
}

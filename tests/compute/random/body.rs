//! Writes statements of random programs.

use super::scope::{Named, Signature};
use super::types::{BOOL, FLOAT, INT, Scalar, Struct, Ty, UINT};
use crate::random::Random;

/// The depth of expressions.
const DEPTH: usize = 3;

/// A function that is being written.
pub struct Body<'p> {
    pub random: &'p mut Random,
    pub structs: &'p [Struct],
    /// Functions that may be called.
    pub functions: &'p [Signature],
    pub lines: Vec<String>,
    /// What is in scope. The first ones are of the module.
    pub named: Vec<Named>,
    /// How many more calls there may be.
    pub calls: usize,
    /// Whether glslangValidator understands all of the program in HLSL.
    pub is_plain: bool,
    /// What `return` gives; `None` where there must be none.
    pub result: Option<Ty>,
    next: usize,
    /// How deep statements are in loops, and whether the innermost one of loops and switches is a
    /// loop that may be continued.
    pub loops: usize,
}

impl<'p> Body<'p> {
    pub fn new(
        random: &'p mut Random,
        structs: &'p [Struct],
        functions: &'p [Signature],
        named: Vec<Named>,
    ) -> Self {
        let lines = Vec::new();
        Self {
            random,
            structs,
            functions,
            lines,
            named,
            calls: 2,
            is_plain: false,
            result: None,
            next: 0,
            loops: 0,
        }
    }

    pub fn name(&mut self) -> String {
        self.next += 1;
        format!("v{}", self.next)
    }

    pub fn line(&mut self, text: impl Into<String>) {
        self.lines.push(text.into());
    }

    /// A path to something of a type that can be read.
    pub fn readable(&mut self, ty: &Ty) -> Option<String> {
        self.found(ty, |_| true).map(|(path, _)| path)
    }

    /// A path to something of a type that can be written to.
    pub fn writable(&mut self, ty: &Ty) -> Option<String> {
        self.found(ty, |one| one.is_mutable).map(|(path, _)| path)
    }

    /// A path to something of a type, and what it is a part of.
    pub fn found(&mut self, ty: &Ty, is_it: impl Fn(&Named) -> bool) -> Option<(String, Named)> {
        let index = self.index();
        let mut paths = Vec::new();
        for (at, named) in self.named.iter().enumerate().filter(|(_, one)| is_it(one)) {
            let mut own = Vec::new();
            named.parts(ty, self.structs, &index, self.random, &mut own);
            paths.extend(own.into_iter().map(|path| (path, at)));
        }
        let (path, at) = (!paths.is_empty()).then(|| self.random.pick(&paths).clone())?;
        Some((path, self.named[at].clone()))
    }

    /// A number without a sign for indices.
    fn index(&mut self) -> String {
        let scalars: Vec<String> = self
            .named
            .iter()
            .filter_map(|one| match one.ty {
                Ty::Scalar(Scalar::Uint) => Some(one.path.clone()),
                Ty::Scalar(Scalar::Int) => Some(format!("u32({})", one.path)),
                _ => None,
            })
            .collect();
        match scalars.is_empty() {
            true => "1u".to_owned(),
            false => self.random.pick(&scalars).clone(),
        }
    }

    /// A variable of the function, other than those that are taken, or what a pointer to one leads
    /// to.
    pub fn whole_variable(&mut self, ty: &Ty, taken: &[String]) -> Option<Named> {
        let is_free = |root: &String| !taken.contains(root);
        let is_it = |one: &&Named| {
            one.is_mutable && one.ty == *ty && one.root.as_ref().is_some_and(is_free)
        };
        let fitting: Vec<&Named> = self.named.iter().filter(is_it).collect();
        (!fitting.is_empty()).then(|| (*self.random.pick(&fitting)).clone())
    }

    /// How many structures, from the first one on, a value can have. The last one ends with an array
    /// of no size.
    fn constructible(&self) -> usize {
        self.structs.len() - 1
    }

    pub fn some_type(&mut self) -> Ty {
        let scalar = *self.random.pick(&[Scalar::Int, Scalar::Uint, Scalar::Float]);
        match self.random.below(12) {
            0..=5 => Ty::Scalar(scalar),
            6 | 7 => Ty::Vector(2 + self.random.below(3) as u32, scalar),
            8 => BOOL,
            9 => Ty::Matrix(2 + self.random.below(3) as u32, 2 + self.random.below(3) as u32),
            10 => Ty::Struct(self.random.below(self.constructible())),
            _ => {
                let of = Ty::Scalar(scalar);
                match self.random.chance(30) {
                    true => Ty::array(Ty::array(of, 2), 3),
                    false => Ty::array(of, 2 + self.random.below(3) as u32),
                }
            }
        }
    }

    pub fn statements(&mut self, count: usize, nesting: usize) {
        for _ in 0..1 + self.random.below(count) {
            self.statement(nesting);
        }
    }

    fn statement(&mut self, nesting: usize) {
        if self.random.chance(3) {
            return self.checked();
        }
        match self.random.below(20) {
            0..=2 => self.variable(),
            3..=6 => self.assignment(),
            7 | 8 => self.compound(),
            9 => self.pointer(),
            10 | 11 if nesting > 0 => self.branch(nesting),
            12 if nesting > 0 && self.loops < 2 => self.counted(nesting),
            13 if nesting > 0 && self.loops < 2 => self.while_loop(nesting),
            14 | 15 if nesting > 0 && self.loops < 2 => self.endless(nesting),
            16 | 17 if nesting > 0 => self.switch(nesting),
            18 => self.effect(),
            _ => self.early(nesting),
        }
    }

    /// A variable or a constant with a value.
    pub fn variable(&mut self) {
        let ty = self.some_type();
        let value = self.value(&ty, DEPTH);
        let (name, spelt) = (self.name(), ty.spelt(self.structs));
        // wgpu gives WGSL that emits an element of a constant array twice, and then refuses it.
        let is_list = matches!(ty, Ty::Array(..) | Ty::Struct(_) | Ty::Matrix(..));
        let is_mutable = is_list || self.random.chance(70);
        match is_mutable {
            true if self.random.chance(15) => self.line(format!("var {name}: {spelt};")),
            true => self.line(format!("var {name}: {spelt} = {value};")),
            false => self.line(format!("let {name}: {spelt} = {value};")),
        }
        self.named.push(match is_mutable {
            true => Named::variable(name.clone(), ty, name),
            false => Named::new(name, ty, false),
        });
    }

    /// An assertion about constants.
    fn checked(&mut self) {
        let claim = *self.random.pick(&["three == 3", "flag && !(three > 3)", "table[1] == -7"]);
        self.line(format!("const_assert {claim};"));
    }

    pub fn assignment(&mut self) {
        let ty = self.some_type();
        let Some(path) = self.writable(&ty) else { return self.variable() };
        let value = self.value(&ty, DEPTH);
        self.line(format!("{path} = {value};"));
    }

    /// Assigns to something of each type of number, if there is something.
    pub fn assigned(&mut self) {
        for ty in [INT, UINT, FLOAT] {
            if let Some(path) = self.writable(&ty) {
                let value = self.value(&ty, DEPTH);
                self.line(format!("{path} = {value};"));
            }
        }
    }

    pub fn compound(&mut self) {
        let ty = self.random.pick(&[INT, UINT, INT, UINT, Ty::Vector(3, Scalar::Int)]).clone();
        let Some(path) = self.writable(&ty) else { return self.variable() };
        if ty.scalar().is_some() && matches!(ty, Ty::Scalar(_)) && self.random.chance(30) {
            let op = *self.random.pick(&["++", "--"]);
            return self.line(format!("{path}{op};"));
        }
        let op = *self.random.pick(&["+", "-", "*", "/", "%", "&", "|", "^"]);
        let value = self.computed(&ty, 2);
        self.line(format!("{path} {op}= {value};"));
    }

    /// A pointer. Its index changes after it was taken, and what it leads to is written to by its
    /// own name too.
    fn pointer(&mut self) {
        let types = [INT, UINT, FLOAT, Ty::Vector(3, Scalar::Int), Ty::array(INT, 2)];
        let ty = self.random.pick(&types).clone();
        let Some((path, of)) = self.found(&ty, |one| one.is_mutable) else {
            return self.variable();
        };
        // There are no pointers to components of vectors, which an index may lead to as well.
        let is_element = matches!(&of.ty, Ty::Array(inner, _) if **inner == ty);
        if path != of.path && (!is_element || path[of.path.len()..].contains('.')) {
            return self.assignment();
        }
        let name = self.name();
        self.line(format!("let {name} = &{path};"));
        self.compound();
        let value = self.value(&ty, 2);
        match self.random.chance(70) {
            true => self.line(format!("*{name} = {value};")),
            false => self.line(format!("{path} = {value};")),
        }
        let root = of.root.filter(|_| path == of.path);
        self.named.push(Named { root, ..Named::new(format!("(*{name})"), ty, true) });
    }
}

//! Writes the declarations of a module.

use std::fmt::Write as _;

use super::imports::Imports;
use super::random::TreeRandom as _;
use super::{Item, Kind, NAMES, reaches};
use crate::random::Random;

pub struct Writer<'a> {
    pub random: &'a mut Random,
    /// The items that the declaration may use.
    pub items: &'a [Item],
    pub imports: &'a mut Imports,
    /// Names of local variables, which hide items of the module.
    pub hidden: Vec<String>,
}

impl Writer<'_> {
    pub fn item(&mut self, item: &Item) -> String {
        let (name, guard) = (
            item.name,
            item.guard.as_ref().map_or(String::new(), |guard| format!("@if({guard}) ")),
        );
        let comment =
            if self.random.chance(30) { format!("// About {name}.\n") } else { String::new() };
        let text = match item.kind {
            Kind::Real => {
                self.either(&guard, |writer| format!("const {name}: f32 = {};", writer.constant()))
            }
            Kind::Count => format!("{guard}const {name} = {};", 1 + self.random.below(4)),
            Kind::Alias => format!("{guard}alias {name} = {};", self.real()),
            Kind::Private => self.either(&guard, |writer| {
                format!("var<private> {name}: {} = {};", writer.real(), writer.constant())
            }),
            Kind::Override => {
                format!("{guard}@id({}) override {name}: f32 = {};", item.id, self.random.number())
            }
            Kind::Structure => format!("{guard}{}", self.structure(name)),
            Kind::Function { arity, shape } => {
                self.either(&guard, |writer| writer.function(name, arity, shape))
            }
        };
        let assertion = match item.kind {
            Kind::Real | Kind::Count if item.guard.is_none() && self.random.chance(20) => {
                format!("\nconst_assert {name} < 1000000;")
            }
            _ => String::new(),
        };
        format!("{comment}{text}{assertion}\n")
    }

    /// One declaration, or two or three with conditions that select one of them.
    fn either(&mut self, guard: &str, mut write: impl FnMut(&mut Self) -> String) -> String {
        if !guard.is_empty() || self.random.chance(70) {
            return format!("{guard}{}", write(self));
        }
        let mut text = format!("@if({}) {}\n", self.random.condition(), write(self));
        if self.random.chance(40) {
            let _ = writeln!(text, "@elif({}) {}", self.random.condition(), write(self));
        }
        text + "@else " + &write(self)
    }

    fn structure(&mut self, name: &str) -> String {
        let mut text = format!("struct {name} {{\n");
        if self.random.chance(40) {
            let _ = writeln!(text, "    @if({}) a: {},", self.random.condition(), self.real());
            let _ = writeln!(text, "    @else a: vec2<{}>,", self.real());
        }
        let _ = writeln!(text, "    b: {},", self.real());
        if self.random.chance(40) {
            let _ = writeln!(
                text,
                "    @if({}) c: array<vec4<f32>, {}>,",
                self.random.condition(),
                self.count()
            );
        }
        if self.random.chance(30)
            && let Some(inner) = self.find(|kind| kind == Kind::Structure)
        {
            let _ = writeln!(text, "    @if({}) inner: {inner},", self.random.condition());
        }
        text + "}"
    }

    fn function(&mut self, name: &str, arity: usize, shape: Option<usize>) -> String {
        let names: Vec<&str> =
            ["x", "y", NAMES[self.random.below(NAMES.len())]].into_iter().take(arity).collect();
        // Types of parameters are resolved outside of the function, where parameters hide nothing.
        let mut parameters: Vec<String> =
            names.iter().map(|name| format!("{name}: {}", self.real())).collect();
        if let Some(shape) = shape {
            let item = &self.items[shape];
            parameters.push(format!(
                "shape: {}",
                self.imports.reference(item, &self.hidden, self.random)
            ));
        }
        if self.random.chance(15) {
            parameters
                .iter_mut()
                .for_each(|parameter| *parameter = format!("@if(true) {parameter}"));
        }
        let returned = self.real();
        self.hidden = names
            .iter()
            .map(|name| (*name).to_owned())
            .chain(shape.map(|_| "shape".to_owned()))
            .chain(["acc".to_owned()])
            .collect();
        let start = names.first().map_or("0.5".to_owned(), |name| format!("{name} * 0.5"));
        let body = self.block(2, 2);
        self.hidden.clear();
        let used = if shape.is_some() { "    acc += shape.b;\n" } else { "" };
        let must_use = if self.random.chance(10) { "@must_use " } else { "" };
        let end = self.end();
        format!(
            "{must_use}fn {name}({}) -> {returned} {{\n    var acc: f32 = {start};\n{used}{body}{end}}}",
            parameters.join(", ")
        )
    }

    fn end(&mut self) -> String {
        match self.random.below(4) {
            0 => format!(
                "    @if({}) return acc * 2.0;\n    @else return acc;\n",
                self.random.condition()
            ),
            1 => format!(
                "    @if({}) {{ return acc; }} @else {{ return -acc; }}\n",
                self.random.condition()
            ),
            _ => "    return acc;\n".to_owned(),
        }
    }

    pub fn entry(&mut self, number: usize) -> String {
        self.hidden = vec!["acc".to_owned(), "place".to_owned()];
        let body = self.block(5, 2);
        self.hidden.clear();
        match self.random.below(3) {
            0 => format!(
                "@compute @workgroup_size({})\nfn work_{number}() {{\n    var acc: f32 = 1.0;\n{body}    results_{number} = acc;\n}}\nvar<workgroup> results_{number}: f32;\n",
                self.count()
            ),
            1 => format!(
                "@vertex\nfn stand_{number}(@location(0) place: {}) -> @builtin(position) vec4<f32> {{\n    var acc: f32 = place;\n{body}    return vec4<f32>(acc);\n}}\n",
                self.real()
            ),
            _ => format!(
                "@group(0) @binding({number}) var<uniform> given_{number}: vec4<{}>;\n@fragment\nfn shade_{number}(@if({}) @builtin(front_facing) front: bool, @location(0) place: f32) -> @location(0) vec4<f32> {{\n    var acc: f32 = place * given_{number}.x;\n{body}    return vec4<f32>(acc);\n}}\n",
                self.real(),
                self.random.condition()
            ),
        }
    }

    fn block(&mut self, statements: usize, depth: usize) -> String {
        (0..1 + self.random.below(statements)).map(|_| self.statement(depth)).collect()
    }

    fn statement(&mut self, depth: usize) -> String {
        let condition = self.random.condition();
        let deeper = depth.saturating_sub(1);
        match self.random.below(if depth == 0 { 8 } else { 16 }) {
            0..=2 => self.guarded(),
            3 => format!(
                "    @if({condition}) acc = {};\n    @else acc -= {};\n",
                self.expression(1),
                self.expression(1)
            ),
            4 => format!(
                "    @if({condition}) acc *= 2.0;\n    @elif({}) {{ acc += {}; }}\n    @else {{ acc -= 1.0; }}\n",
                self.random.condition(),
                self.expression(1)
            ),
            5 => format!("    {{ let q = &acc; *q += {}; }}\n", self.expression(1)),
            6 => self.shadow(&condition),
            7 => format!(
                "    {{ var taps = array<{}, {}>(); acc += taps[0]; _ = taps[0] + {}; }}\n",
                self.real(),
                self.count(),
                self.expression(0)
            ),
            8 => self.structured(),
            9 => format!("    @if({condition}) {{\n{}    }}\n", self.block(2, deeper)),
            10 => format!(
                "    if (acc > {}) {{\n{}    }} else {{\n{}    }}\n",
                self.expression(0),
                self.block(2, deeper),
                self.block(1, deeper)
            ),
            11 => format!(
                "    for (var i = 0; i < {}; i++) {{\n{}    }}\n",
                self.count(),
                self.block(2, deeper)
            ),
            12 => self.switch(&condition, deeper),
            13 => format!(
                "    loop {{\n{}        if (acc > 4.0) {{ break; }}\n        continuing {{ acc += 1.0; @if({condition}) acc += 0.5; }}\n    }}\n",
                self.block(1, deeper)
            ),
            14 => format!(
                "    while (acc < {}) {{\n        @if({condition}) {{ break; }}\n        acc += 1.0;\n{}    }}\n",
                self.expression(0),
                self.block(1, deeper)
            ),
            _ => format!("    @if({condition}) const_assert {} > 0;\n", self.count()),
        }
    }

    fn switch(&mut self, condition: &str, deeper: usize) -> String {
        format!(
            "    switch i32(acc) {{\n        case 0 {{\n{}        }}\n        @if({condition}) case {}, 9 {{\n{}        }}\n        default {{ }}\n    }}\n",
            self.block(1, deeper),
            5 + self.random.below(3),
            self.block(1, deeper)
        )
    }

    /// Adds a value to the sum. If the value exists only under a condition, the statement has the
    /// same condition.
    fn guarded(&mut self) -> String {
        let guarded: Vec<usize> = (0..self.items.len())
            .filter(|index| self.items[*index].guard.is_some() && self.usable(&self.items[*index]))
            .collect();
        if guarded.is_empty() || self.random.chance(60) {
            return format!("    acc += {};\n", self.expression(2));
        }
        let item = &self.items[guarded[self.random.below(guarded.len())]];
        let condition = item.guard.clone().unwrap();
        match self.value(item, 0) {
            Some(value) => format!("    @if({condition}) acc += {value};\n"),
            None => String::new(),
        }
    }

    /// A local variable that shadows an item, in all permutations or only in some.
    fn shadow(&mut self, condition: &str) -> String {
        let constants =
            self.items.iter().filter(|item| item.kind == Kind::Real && item.guard.is_none());
        let reals: Vec<&Item> =
            constants.filter(|item| reaches(self.imports.module, item.module)).collect();
        if reals.is_empty() || self.random.chance(40) {
            let name = NAMES[self.random.below(NAMES.len())];
            return format!("    {{ let {name} = acc * 0.25; acc += {name}; }}\n");
        }
        let item = reals[self.random.below(reals.len())];
        let name = self.imports.reference(item, &self.hidden, self.random);
        if name.contains("::") || self.hidden.contains(&name) {
            return format!("    {{ let {} = {name}; acc += {}; }}\n", item.name, item.name);
        }
        match self.random.below(3) {
            0 => format!("    {{ @if({condition}) let {name} = 2.0; acc += {name}; }}\n"),
            1 => format!("    {{ let {name} = {name} * 3.0; acc += {name}; }}\n"),
            _ => format!(
                "    for (var {name} = 0; {name} < 2; {name}++) {{ acc += f32({name}); }}\n    acc += {name};\n"
            ),
        }
    }

    /// A variable of a structure, which may be passed to a function.
    fn structured(&mut self) -> String {
        let takes = |item: &&Item| {
            item.guard.is_none() && matches!(item.kind, Kind::Function { shape: Some(_), .. })
        };
        let calls: Vec<&Item> =
            self.items.iter().filter(takes).filter(|item| self.usable(item)).collect();
        if calls.is_empty() || self.random.chance(40) {
            let Some(structure) = self.find(|kind| kind == Kind::Structure) else {
                return String::new();
            };
            return format!(
                "    {{ var held: {structure}; held.b = {}; acc += held.b; }}\n",
                self.expression(1)
            );
        }
        let item = calls[self.random.below(calls.len())];
        let Kind::Function { arity, shape: Some(shape) } = item.kind else { return String::new() };
        let structure = &self.items[shape];
        if !self.usable(structure) {
            return String::new();
        }
        let structure = self.imports.reference(structure, &self.hidden, self.random);
        let function = self.imports.reference(item, &self.hidden, self.random);
        let arguments: String = (0..arity).map(|_| self.expression(0) + ", ").collect();
        format!(
            "    {{ var held: {structure}; held.b = {}; acc += {function}({arguments}held); }}\n",
            self.expression(1)
        )
    }

    fn expression(&mut self, depth: usize) -> String {
        if depth == 0 || self.random.chance(30) {
            return if self.random.chance(50) { self.random.number() } else { "acc".to_owned() };
        }
        let candidates: Vec<usize> = (0..self.items.len())
            .filter(|index| self.items[*index].guard.is_none() && self.usable(&self.items[*index]))
            .collect();
        if candidates.is_empty() {
            return format!("({} * {})", self.expression(depth - 1), self.random.number());
        }
        let item = &self.items[candidates[self.random.below(candidates.len())]];
        let value = self.value(item, depth - 1).unwrap_or_else(|| "acc".to_owned());
        if self.random.chance(50) {
            value
        } else {
            format!("({value} + {})", self.expression(depth - 1))
        }
    }

    /// An expression of type `f32` that uses the item. `None` for structures, and for functions
    /// that take one.
    fn value(&mut self, item: &Item, depth: usize) -> Option<String> {
        let arguments = |writer: &mut Self, count: usize| {
            (0..count).map(|_| writer.expression(depth)).collect::<Vec<_>>().join(", ")
        };
        match item.kind {
            Kind::Function { shape: Some(_), .. } | Kind::Structure => None,
            Kind::Function { arity, shape: None } => {
                let arguments = arguments(self, arity);
                Some(format!(
                    "{}({arguments})",
                    self.imports.reference(item, &self.hidden, self.random)
                ))
            }
            Kind::Alias => Some(format!(
                "{}({})",
                self.imports.reference(item, &self.hidden, self.random),
                arguments(self, 1)
            )),
            Kind::Count => {
                Some(format!("f32({})", self.imports.reference(item, &self.hidden, self.random)))
            }
            Kind::Real | Kind::Private | Kind::Override => {
                Some(self.imports.reference(item, &self.hidden, self.random))
            }
        }
    }

    fn usable(&self, item: &Item) -> bool {
        let hidden =
            item.module == self.imports.module && self.hidden.iter().any(|name| name == item.name);
        reaches(self.imports.module, item.module) && !hidden
    }

    fn find(&mut self, is: impl Fn(Kind) -> bool) -> Option<String> {
        let found: Vec<&Item> = self
            .items
            .iter()
            .filter(|item| is(item.kind) && item.guard.is_none() && self.usable(item))
            .collect();
        if found.is_empty() {
            return None;
        }
        let item = found[self.random.below(found.len())];
        Some(self.imports.reference(item, &self.hidden, self.random))
    }

    /// A type that is `f32`.
    fn real(&mut self) -> String {
        let alias =
            if self.random.chance(40) { self.find(|kind| kind == Kind::Alias) } else { None };
        alias.unwrap_or_else(|| "f32".to_owned())
    }

    /// A positive constant integer.
    fn count(&mut self) -> String {
        let named =
            if self.random.chance(50) { self.find(|kind| kind == Kind::Count) } else { None };
        named.unwrap_or_else(|| (1 + self.random.below(3)).to_string())
    }

    /// A constant number.
    fn constant(&mut self) -> String {
        let named =
            if self.random.chance(50) { self.find(|kind| kind == Kind::Real) } else { None };
        named.map_or_else(|| self.random.number(), |name| format!("{name} * 0.5"))
    }
}

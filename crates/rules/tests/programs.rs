//! Random programs about uniformity: values that may vary or not, in control flow of all shapes,
//! through variables, pointers and calls, before operations that ask for uniform control flow.

use std::fmt::Write as _;

use crate::random::Random;

const MODULE: &str = "
struct Pair { a: i32, b: array<i32, 4> }
@group(0) @binding(0) var image: texture_2d<f32>;
@group(0) @binding(1) var smp: sampler;
@group(0) @binding(2) var<uniform> same: vec4<i32>;
@group(0) @binding(3) var<storage, read> fixed: array<i32, 8>;
@group(0) @binding(4) var<storage, read_write> changing: array<i32, 8>;
var<private> own: i32;
const four = 4;
";

/// What a function takes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Parameter {
    Value,
    Number,
    Pair,
}

struct Signature {
    parameters: Vec<Parameter>,
    returns: bool,
}

/// The names in scope, by what they are.
#[derive(Clone, Default)]
struct Scope {
    values: Vec<String>,
    numbers: Vec<String>,
    pairs: Vec<String>,
    /// Pointers to numbers, and to pairs.
    number_pointers: Vec<String>,
    pair_pointers: Vec<String>,
    /// What each pointer leads to, so that calls get no two pointers to one variable.
    leads: Vec<(String, String)>,
    /// The names of the innermost scope, which it cannot declare again.
    own: Vec<String>,
}

impl Scope {
    /// A scope within this one.
    fn inner(&self) -> Self {
        Self { own: Vec::new(), ..self.clone() }
    }

    /// Forgets what a name meant.
    fn hide(&mut self, name: &str) {
        let lists = [
            &mut self.values,
            &mut self.numbers,
            &mut self.pairs,
            &mut self.number_pointers,
            &mut self.pair_pointers,
        ];
        lists.into_iter().for_each(|list| list.retain(|known| known != name));
    }

    /// The names that it can declare again.
    fn outer(&self) -> Vec<String> {
        let all = self.values.iter().chain(&self.numbers).chain(&self.pairs);
        let all = all.chain(&self.number_pointers).chain(&self.pair_pointers);
        let is_plain = |name: &&String| name.chars().all(char::is_alphanumeric);
        all.filter(is_plain).filter(|name| !self.own.contains(name)).cloned().collect()
    }
}

struct Writer<'r> {
    random: &'r mut Random,
    text: String,
    functions: Vec<Signature>,
    is_compute: bool,
    names: usize,
    /// How deep in loops and switches: 0 outside, 1 where `break` is allowed, 2 `continue` too.
    leaves: Vec<u8>,
    returns: bool,
    budget: usize,
}

/// The program of a seed.
pub fn program(seed: u64) -> String {
    let mut random = Random(seed);
    let is_compute = random.chance(50);
    let mut text = String::new();
    if random.chance(10) {
        let severity = *random.pick(&["off", "warning", "info", "error"]);
        writeln!(text, "diagnostic({severity}, derivative_uniformity);").unwrap();
    }
    text.push_str(MODULE);
    if is_compute {
        text.push_str(
            "var<workgroup> shared_number: i32;\nvar<workgroup> shared_many: array<i32, 4>;\n",
        );
    }
    let functions = Vec::new();
    let mut writer = Writer {
        random: &mut random,
        text,
        functions,
        is_compute,
        names: 0,
        leaves: Vec::new(),
        returns: false,
        budget: 0,
    };
    let count = writer.random.below(4);
    (0..count).for_each(|_| writer.function());
    writer.entry();
    writer.text
}

impl Writer<'_> {
    fn name(&mut self, kind: &str) -> String {
        self.names += 1;
        format!("{kind}{}", self.names)
    }

    /// The name of a declaration, after its initializer was written. It may hide another one.
    fn declared(&mut self, scope: &mut Scope, kind: &str) -> String {
        let outer = scope.outer();
        let name = match !outer.is_empty() && self.random.chance(20) {
            true => self.random.pick(&outer).clone(),
            false => self.name(kind),
        };
        scope.hide(&name);
        scope.own.push(name.clone());
        name
    }

    fn filter(&mut self) -> &'static str {
        match self.random.below(40) {
            0 => "@diagnostic(off, derivative_uniformity) ",
            1 => "@diagnostic(warning, derivative_uniformity) ",
            2 => "@diagnostic(error, derivative_uniformity) ",
            _ => "",
        }
    }

    fn function(&mut self) {
        let index = self.functions.len();
        let kinds = [Parameter::Value, Parameter::Number, Parameter::Pair];
        let parameters: Vec<Parameter> =
            (0..self.random.below(4)).map(|_| *self.random.pick(&kinds)).collect();
        let returns = self.random.chance(60);
        let mut scope = Scope::default();
        let mut list = Vec::new();
        for (at, parameter) in parameters.iter().enumerate() {
            let name = format!("p{at}");
            scope.own.push(name.clone());
            match parameter {
                Parameter::Value => {
                    list.push(format!("{name}: i32"));
                    scope.values.push(name);
                }
                Parameter::Number => {
                    list.push(format!("{name}: ptr<function, i32>"));
                    scope.leads.push((name.clone(), name.clone()));
                    scope.number_pointers.push(name);
                }
                Parameter::Pair => {
                    list.push(format!("{name}: ptr<function, Pair>"));
                    scope.leads.push((name.clone(), name.clone()));
                    scope.pair_pointers.push(name);
                }
            }
        }
        let result = if returns { " -> i32" } else { "" };
        let filter = self.filter();
        writeln!(self.text, "{filter}fn f{index}({}){result} {{", list.join(", ")).unwrap();
        self.body(scope, returns);
        self.functions.push(Signature { parameters, returns });
    }

    fn entry(&mut self) {
        let mut scope = Scope::default();
        let filter = self.filter();
        if self.is_compute {
            writeln!(
                self.text,
                "{filter}@compute @workgroup_size(4) fn main(@builtin(workgroup_id) group: vec3u, \
                 @builtin(local_invocation_index) index: u32) {{"
            )
            .unwrap();
            scope.values.push("i32(group.x)".to_owned());
            scope.values.push("i32(index)".to_owned());
        } else {
            writeln!(
                self.text,
                "{filter}@fragment fn main(@location(0) @interpolate(flat) where_: vec2i) {{"
            )
            .unwrap();
            scope.values.push("where_.x".to_owned());
        }
        self.body(scope, false);
    }

    fn body(&mut self, mut scope: Scope, returns: bool) {
        self.returns = returns;
        self.budget = 8 + self.random.below(20);
        self.statements(&mut scope, 1);
        if returns {
            let value = self.number(&scope, 2);
            writeln!(self.text, "  return {value};").unwrap();
        }
        self.text.push_str("}\n");
    }

    fn statements(&mut self, scope: &mut Scope, depth: usize) {
        let count = 1 + self.random.below(5);
        for _ in 0..count {
            if self.budget == 0 {
                return;
            }
            self.budget -= 1;
            self.statement(scope, depth);
        }
    }

    fn block(&mut self, scope: &Scope, depth: usize) {
        self.text.push_str("{\n");
        let mut inner = scope.inner();
        self.statements(&mut inner, depth + 1);
        if self.random.chance(8) {
            let way = self.way(&inner);
            writeln!(self.text, "{way}").unwrap();
        }
        self.text.push('}');
    }

    fn filtered_block(&mut self, scope: &Scope, depth: usize) {
        let filter = self.filter();
        self.text.push_str(filter);
        self.block(scope, depth);
    }

    fn statement(&mut self, scope: &mut Scope, depth: usize) {
        let deep = depth > 5;
        match self.random.below(if deep { 14 } else { 23 }) {
            0..3 => self.declare(scope),
            3 => self.pointer(scope),
            4..7 => self.assign(scope),
            7..10 => self.operation(),
            10 => self.call_statement(scope),
            11 => self.leave(scope),
            12 => {
                let value = self.number(scope, 3);
                writeln!(self.text, "_ = {value};").unwrap();
            }
            13 => {
                let (target, value) = (self.place(scope), self.number(scope, 2));
                writeln!(self.text, "{target} += {value};").unwrap();
            }
            14..18 => self.conditional(scope, depth),
            18 => self.switch(scope, depth),
            19 => self.while_loop(scope, depth),
            20 => self.for_loop(scope, depth),
            21 => self.endless_loop(scope, depth),
            _ => {
                self.filtered_block(scope, depth);
                self.text.push('\n');
            }
        }
    }

    fn declare(&mut self, scope: &mut Scope) {
        match self.random.below(3) {
            0 => {
                let value = self.number(scope, 2);
                let name = self.declared(scope, "l");
                writeln!(self.text, "let {name} = {value};").unwrap();
                scope.values.push(name);
            }
            1 => {
                let value = self.number(scope, 2);
                let name = self.declared(scope, "v");
                match self.random.chance(80) {
                    true => writeln!(self.text, "var {name} = {value};").unwrap(),
                    false => writeln!(self.text, "var {name}: i32;").unwrap(),
                }
                scope.numbers.push(name);
            }
            _ => {
                let value = self.number(scope, 1);
                let name = self.declared(scope, "s");
                match self.random.chance(50) {
                    true => writeln!(self.text, "var {name}: Pair;").unwrap(),
                    false => {
                        writeln!(self.text, "var {name} = Pair({value}, array(1, 2, 3, 4));")
                            .unwrap();
                    }
                }
                scope.pairs.push(name);
            }
        }
    }

    fn pointer(&mut self, scope: &mut Scope) {
        let name = self.name("q");
        scope.own.push(name.clone());
        let to_part = self.random.chance(50);
        let base = self.pair(scope);
        match (base, to_part) {
            (Some((base, lead)), true) => {
                let index = self.number(scope, 1);
                let part = match self.random.chance(50) {
                    true => format!("{base}.a"),
                    false => format!("{base}.b[({index}) & 3]"),
                };
                writeln!(self.text, "let {name} = &{part};").unwrap();
                scope.leads.push((name.clone(), lead));
                scope.number_pointers.push(name);
            }
            (Some((base, lead)), false) => {
                writeln!(self.text, "let {name} = &{base};").unwrap();
                scope.leads.push((name.clone(), lead));
                scope.pair_pointers.push(name);
            }
            (None, _) => {
                let Some(number) = self.picked(&scope.numbers) else { return };
                writeln!(self.text, "let {name} = &{number};").unwrap();
                scope.leads.push((name.clone(), number));
                scope.number_pointers.push(name);
            }
        }
    }

    fn picked(&mut self, from: &[String]) -> Option<String> {
        match from.is_empty() {
            true => None,
            false => Some(self.random.pick(from).clone()),
        }
    }

    /// A reference to a pair, and the variable that it leads to.
    fn pair(&mut self, scope: &Scope) -> Option<(String, String)> {
        let pointer = self.picked(&scope.pair_pointers);
        let own = self.picked(&scope.pairs);
        match (pointer, own) {
            (Some(pointer), own) if own.is_none() || self.random.chance(50) => {
                let lead = lead(scope, &pointer);
                Some((format!("(*{pointer})"), lead))
            }
            (_, Some(own)) => Some((own.clone(), own)),
            _ => None,
        }
    }

    /// A reference to a number.
    fn place(&mut self, scope: &Scope) -> String {
        for _ in 0..4 {
            let found = match self.random.below(6) {
                0 => Some("own".to_owned()),
                1 => {
                    let index = self.number(scope, 1);
                    Some(format!("changing[({index}) & 3]"))
                }
                2 => self.picked(&scope.numbers),
                3 => self.picked(&scope.number_pointers).map(|name| format!("*{name}")),
                4 => self.pair(scope).map(|(base, _)| format!("{base}.a")),
                _ => match self.pair(scope) {
                    Some((base, _)) => {
                        let index = self.number(scope, 1);
                        Some(format!("{base}.b[({index}) & 3]"))
                    }
                    None => None,
                },
            };
            if let Some(found) = found {
                return found;
            }
        }
        "own".to_owned()
    }

    fn assign(&mut self, scope: &Scope) {
        if self.random.chance(20)
            && let Some((base, _)) = self.pair(scope)
        {
            let value = match self.pair(scope) {
                Some((other, _)) if self.random.chance(50) => other,
                _ => "Pair()".to_owned(),
            };
            writeln!(self.text, "{base} = {value};").unwrap();
            return;
        }
        let place = self.place(scope);
        match self.random.chance(10) {
            true => writeln!(self.text, "{place}++;").unwrap(),
            false => {
                let value = self.number(scope, 2);
                writeln!(self.text, "{place} = {value};").unwrap();
            }
        }
    }

    /// Something that asks for uniform control flow.
    fn operation(&mut self) {
        let text = match (self.is_compute, self.random.below(3)) {
            (true, 0) => "workgroupBarrier();",
            (true, 1) => "storageBarrier();",
            (true, _) => "_ = workgroupUniformLoad(&shared_number);",
            (false, 0) => "_ = dpdx(1.0);",
            (false, 1) => "_ = textureSample(image, smp, vec2f());",
            (false, _) => "_ = fwidth(1.0);",
        };
        if self.random.chance(40) {
            self.text.push_str(text);
            self.text.push('\n');
        }
    }

    fn arguments(&mut self, scope: &Scope, function: usize) -> Option<String> {
        let parameters = self.functions[function].parameters.clone();
        let (mut used, mut list) = (Vec::new(), Vec::new());
        for parameter in parameters {
            match parameter {
                Parameter::Value => list.push(self.number(scope, 1)),
                Parameter::Number | Parameter::Pair => {
                    let is_pair = parameter == Parameter::Pair;
                    let (own, pointers) = match is_pair {
                        true => (&scope.pairs, &scope.pair_pointers),
                        false => (&scope.numbers, &scope.number_pointers),
                    };
                    let pointer = self.picked(pointers);
                    let own = self.picked(own);
                    let (text, leads) = match (pointer, own) {
                        (Some(pointer), own) if own.is_none() || self.random.chance(50) => {
                            let leads = lead(scope, &pointer);
                            (pointer, leads)
                        }
                        (_, Some(own)) => (format!("&{own}"), own),
                        _ => return None,
                    };
                    if used.contains(&leads) {
                        return None;
                    }
                    used.push(leads);
                    list.push(text);
                }
            }
        }
        Some(list.join(", "))
    }

    fn call(&mut self, scope: &Scope, returns: bool) -> Option<String> {
        if self.functions.is_empty() {
            return None;
        }
        let function = self.random.below(self.functions.len());
        if self.functions[function].returns != returns {
            return None;
        }
        let arguments = self.arguments(scope, function)?;
        Some(format!("f{function}({arguments})"))
    }

    fn call_statement(&mut self, scope: &Scope) {
        let returns = self.random.chance(30);
        if let Some(call) = self.call(scope, returns) {
            writeln!(self.text, "{call};").unwrap();
        }
    }

    fn leave(&mut self, scope: &Scope) {
        if !self.random.chance(50) {
            return;
        }
        let condition = self.condition(scope, 1);
        let way = self.way(scope);
        writeln!(self.text, "if {condition} {{ {way} }}").unwrap();
    }

    /// A way out of a loop or of the function.
    fn way(&mut self, scope: &Scope) -> String {
        match (self.random.below(3), self.leaves.last().copied().unwrap_or(0)) {
            (0, 1..) => "break;".to_owned(),
            (1, 2) => "continue;".to_owned(),
            _ => match self.returns {
                true => format!("return {};", self.number(scope, 1)),
                false => "return;".to_owned(),
            },
        }
    }

    fn conditional(&mut self, scope: &Scope, depth: usize) {
        let condition = self.condition(scope, 2);
        let filter = self.filter();
        write!(self.text, "{filter}if {condition} ").unwrap();
        self.filtered_block(scope, depth);
        while self.random.chance(25) {
            let condition = self.condition(scope, 1);
            write!(self.text, " else if {condition} ").unwrap();
            self.block(scope, depth);
        }
        if self.random.chance(30) {
            self.text.push_str(" else ");
            self.block(scope, depth);
        }
        self.text.push('\n');
    }

    fn inside(&mut self, may_continue: u8, write: impl FnOnce(&mut Self)) {
        self.leaves.push(may_continue);
        write(self);
        self.leaves.pop();
    }

    fn switch(&mut self, scope: &Scope, depth: usize) {
        let selector = self.number(scope, 1);
        writeln!(self.text, "switch {selector} {{").unwrap();
        let outer = self.leaves.last().copied().unwrap_or(0);
        for case in 0..self.random.below(3) {
            write!(self.text, "case {case}: ").unwrap();
            self.inside(outer.max(1), |writer| writer.filtered_block(scope, depth));
            self.text.push('\n');
        }
        self.text.push_str("default: ");
        self.inside(outer.max(1), |writer| writer.block(scope, depth));
        self.text.push_str("\n}\n");
    }

    fn while_loop(&mut self, scope: &Scope, depth: usize) {
        let condition = self.condition(scope, 2);
        write!(self.text, "while {condition} ").unwrap();
        self.inside(2, |writer| writer.filtered_block(scope, depth));
        self.text.push('\n');
    }

    fn for_loop(&mut self, scope: &Scope, depth: usize) {
        let name = self.name("i");
        let (start, end) = (self.number(scope, 1), self.number(scope, 1));
        let mut inner = scope.inner();
        inner.numbers.push(name.clone());
        inner.own.push(name.clone());
        let condition = match self.random.chance(80) {
            true => format!("{name} < {end}"),
            false => self.condition(&inner, 1),
        };
        let update = match self.random.chance(80) {
            true => format!("{name}++"),
            false => format!("{} = {}", self.place(&inner), self.number(&inner, 1)),
        };
        write!(self.text, "for (var {name} = {start}; {condition}; {update}) ").unwrap();
        self.inside(2, |writer| writer.filtered_block(&inner, depth));
        self.text.push('\n');
    }

    fn endless_loop(&mut self, scope: &Scope, depth: usize) {
        self.text.push_str("loop {\n");
        let mut inner = scope.inner();
        let has_continuing = self.random.chance(60);
        // A `continue` must not pass the declaration of a name that `continuing` uses.
        self.inside(if has_continuing { 1 } else { 2 }, |writer| {
            writer.statements(&mut inner, depth + 1);
        });
        let before = inner.clone();
        self.inside(2, |writer| {
            if !has_continuing || writer.random.chance(50) {
                let condition = writer.condition(&inner, 1);
                writeln!(writer.text, "if {condition} {{ break; }}").unwrap();
                writer.statements(&mut inner, depth + 1);
            }
        });
        if has_continuing {
            if self.random.chance(20) {
                let way = self.way(&inner);
                writeln!(self.text, "{way}").unwrap();
            }
            let inner = match self.random.chance(80) {
                true => {
                    let later = inner.own.iter().filter(|name| !before.own.contains(name));
                    later.fold(before.clone(), |mut scope, name| {
                        scope.hide(name);
                        scope
                    })
                }
                false => inner,
            };
            let inner = inner.inner();
            self.text.push_str("continuing {\n");
            let (leaves, returns) = (std::mem::take(&mut self.leaves), self.returns);
            self.assign(&inner);
            self.operation();
            self.call_statement(&inner);
            (self.leaves, self.returns) = (leaves, returns);
            let condition = self.condition(&inner, 1);
            writeln!(self.text, "break if {condition};\n}}").unwrap();
        }
        self.text.push_str("}\n");
    }

    fn condition(&mut self, scope: &Scope, depth: usize) -> String {
        match self.random.below(if depth == 0 { 2 } else { 5 }) {
            0 => format!("{} > {}", self.number(scope, depth), self.number(scope, 0)),
            1 => format!("{} == 1", self.number(scope, depth)),
            2 => format!("!({})", self.condition(scope, depth - 1)),
            3 => format!(
                "(({}) && ({}))",
                self.condition(scope, depth - 1),
                self.condition(scope, depth - 1)
            ),
            _ => format!(
                "(({}) || ({}))",
                self.condition(scope, depth - 1),
                self.condition(scope, depth - 1)
            ),
        }
    }

    fn number(&mut self, scope: &Scope, depth: usize) -> String {
        if depth > 0 {
            match self.random.below(8) {
                0 => {
                    let (left, right) =
                        (self.number(scope, depth - 1), self.number(scope, depth - 1));
                    return format!("({left} + {right})");
                }
                1 => return format!("fixed[({}) & 3]", self.number(scope, depth - 1)),
                2 => {
                    if let Some(call) = self.call(scope, true) {
                        return call;
                    }
                }
                3 => {
                    let (left, right) =
                        (self.number(scope, depth - 1), self.number(scope, depth - 1));
                    let condition = self.condition(scope, depth - 1);
                    return format!("select({left}, {right}, {condition})");
                }
                4 if self.is_compute && self.random.chance(20) => {
                    return "workgroupUniformLoad(&shared_number)".to_owned();
                }
                4 if !self.is_compute && self.random.chance(20) => {
                    return "i32(dpdx(1.0))".to_owned();
                }
                _ => {}
            }
        }
        match self.random.below(9) {
            0 => "1".to_owned(),
            1 => "same.x".to_owned(),
            2 | 3 => self.picked(&scope.values).unwrap_or_else(|| "four".to_owned()),
            4 | 5 => self.picked(&scope.numbers).unwrap_or_else(|| "2".to_owned()),
            6 if self.is_compute && self.random.chance(30) => "shared_number".to_owned(),
            7 => "3".to_owned(),
            _ => self.place(scope),
        }
    }
}

fn lead(scope: &Scope, pointer: &str) -> String {
    let mut leads = scope.leads.iter().rev();
    leads.find(|(name, _)| name == pointer).map_or_else(String::new, |(_, lead)| lead.clone())
}

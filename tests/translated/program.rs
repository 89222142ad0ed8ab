//! Random functions of WESL whose results are exact on every device: integers, and floats that no
//! order of rounding changes.

use std::fmt::Write as _;

use crate::random::Random;

/// A function `f(a: u32, b: u32, c: i32, x: f32) -> u32`, and what it needs.
pub struct Program {
    /// With conditions, for translation.
    pub text: String,
    /// The same with all conditions decided, for naga.
    pub chosen: String,
    /// The values of the flags.
    pub flags: [bool; 2],
}

/// The names of the flags.
pub const FLAGS: [&str; 2] = ["warm", "wide"];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Ty {
    Int,
    Uint,
    Float,
    Bool,
    Ints,
    Floats,
    Row,
    Pair,
}

const TYPES: [(Ty, &str); 8] = [
    (Ty::Int, "i32"),
    (Ty::Uint, "u32"),
    (Ty::Float, "f32"),
    (Ty::Bool, "bool"),
    (Ty::Ints, "vec3i"),
    (Ty::Floats, "vec2f"),
    (Ty::Row, "array<i32, 4>"),
    (Ty::Pair, "Pair"),
];

fn spelled(ty: Ty) -> &'static str {
    TYPES.iter().find(|(known, _)| *known == ty).map_or("i32", |(_, name)| name)
}

const HEAD: &str = "\
struct Pair {
    a: i32,
    b: vec2u,
    c: f32,
    inner: Inner,
}

struct Inner {
    flag: bool,
    row: array<i32, 4>,
}

@if(warm) const SIZE = 3;
@else const SIZE = 5;
@if(wide) const SCALE: f32 = 0.5;
@else const SCALE: f32 = 0.25;

var<private> calls: u32;

fn stepped(state: ptr<function, u32>, by: u32) -> u32 {
    *state = *state * 747796405u + by;
    calls += 1u;
    return (*state >> 16u) ^ *state;
}

fn later(x: i32, pair: ptr<function, Pair>) -> bool {
    (*pair).a += x;
    pair.inner.row[1] = first(x);
    return pair.a > x;
}

fn first(x: i32) -> i32 {
    return x % 7 + SIZE;
}

";

/// The head with its conditions decided.
fn chosen_head(flags: [bool; 2]) -> String {
    let mut text = String::new();
    let mut holds = false;
    for line in HEAD.split_inclusive('\n') {
        let given = FLAGS.iter().zip(flags).find_map(|(name, flag)| {
            let rest = line.strip_prefix(&format!("@if({name}) "))?;
            Some((rest, flag))
        });
        match (given, line.strip_prefix("@else ")) {
            (Some((rest, flag)), _) => {
                holds = flag;
                text += if flag { rest } else { "" };
            }
            (None, Some(rest)) => text += if holds { "" } else { rest },
            (None, None) => text += line,
        }
    }
    text
}

/// Makes a program. GLSL ES 3.00 has no functions that count bits.
pub fn program(seed: u64, has_bits: bool) -> Program {
    let mut random = Random(seed);
    let flags = [random.chance(50), random.chance(50)];
    let mut maker = Maker {
        random,
        flags,
        text: HEAD.to_owned(),
        chosen: chosen_head(flags),
        is_live: true,
        scopes: vec![Vec::new()],
        declared: vec![Vec::new()],
        named: 0,
        depth: 1,
        has_bits,
    };
    maker.line("fn f(a: u32, b: u32, c: i32, x: f32) -> u32 {");
    for (name, ty) in [("a", Ty::Uint), ("b", Ty::Uint), ("c", Ty::Int), ("x", Ty::Float)] {
        maker.scopes[0].push(Var { name: name.to_owned(), ty, is_variable: false });
    }
    maker.line("    var state = a ^ 12345u;");
    maker.line("    var hash = b;");
    for ty in [Ty::Int, Ty::Uint, Ty::Float, Ty::Bool, Ty::Ints, Ty::Floats, Ty::Row, Ty::Pair] {
        maker.declare(ty, true);
    }
    maker.statements(10, 0, false);
    maker.result();
    Program { text: maker.text, chosen: maker.chosen, flags }
}

#[derive(Clone)]
struct Var {
    name: String,
    ty: Ty,
    is_variable: bool,
}

struct Maker {
    random: Random,
    flags: [bool; 2],
    text: String,
    chosen: String,
    /// Whether the conditions around hold.
    is_live: bool,
    /// What can be named, by the scope or the condition that it is declared in.
    scopes: Vec<Vec<Var>>,
    /// The names that the scopes have themselves, whether their conditions hold or not.
    declared: Vec<Vec<String>>,
    named: usize,
    depth: usize,
    has_bits: bool,
}

impl Maker {
    fn line(&mut self, line: &str) {
        let _ = writeln!(self.text, "{line}");
        if self.is_live {
            let _ = writeln!(self.chosen, "{line}");
        }
    }

    fn indented(&mut self, line: &str) {
        let line = format!("{}{line}", "    ".repeat(self.depth));
        self.line(&line);
    }

    /// A name that the scope does not have yet. Few of them, so that they hide each other; some
    /// are words of GLSL, or names that are made for something else.
    fn fresh(&mut self) -> String {
        let words = [
            "sample",
            "half",
            "input",
            "float",
            "cosh",
            "mix",
            "n",
            "k",
            "zero_pair",
            "n_inner",
            "sample_",
            "texture",
            "v",
            "zero",
        ];
        let name = *self.random.pick(&words);
        let is_taken =
            self.declared.last().is_some_and(|names| names.iter().any(|known| known == name));
        if is_taken {
            return self.unique();
        }
        self.take(name);
        name.to_owned()
    }

    /// A name that nothing else has.
    fn unique(&mut self) -> String {
        self.named += 1;
        let name = format!("v{}", self.named);
        self.take(&name);
        name
    }

    /// Makes a name one that the scope has itself.
    fn take(&mut self, name: &str) {
        if let Some(names) = self.declared.last_mut() {
            names.push(name.to_owned());
        }
    }

    fn open(&mut self) {
        self.scopes.push(Vec::new());
        self.declared.push(Vec::new());
    }

    fn close(&mut self) {
        self.scopes.pop();
        self.declared.pop();
    }

    /// Makes a local known from here on.
    fn know(&mut self, name: String, ty: Ty, is_variable: bool) {
        if let Some(scope) = self.scopes.last_mut() {
            scope.push(Var { name, ty, is_variable });
        }
    }

    /// Something of a type that is not hidden.
    fn var(&mut self, ty: Ty, is_variable: bool) -> Option<String> {
        let mut seen: Vec<&str> = Vec::new();
        let mut all = Vec::new();
        for one in self.scopes.iter().rev().flat_map(|scope| scope.iter().rev()) {
            if seen.contains(&one.name.as_str()) {
                continue;
            }
            seen.push(&one.name);
            if one.ty == ty && (one.is_variable || !is_variable) {
                all.push(one.name.clone());
            }
        }
        if all.is_empty() { None } else { Some(self.random.pick(&all).clone()) }
    }

    fn declare(&mut self, ty: Ty, is_variable: bool) {
        let keyword = if is_variable { "var" } else { "let" };
        let is_zero = is_variable && self.random.chance(25);
        let value = self.value(ty, 3);
        let name = self.fresh();
        match is_zero {
            true => self.indented(&format!("var {name}: {};", spelled(ty))),
            false if self.random.chance(30) => {
                self.indented(&format!("{keyword} {name}: {} = {value};", spelled(ty)));
            }
            false => self.indented(&format!("{keyword} {name} = {value};")),
        }
        self.know(name, ty, is_variable);
    }

    fn statements(&mut self, count: usize, nesting: usize, in_loop: bool) {
        for _ in 0..count {
            self.statement(nesting, in_loop);
        }
    }

    fn inner(&mut self, nesting: usize, in_loop: bool) {
        self.open();
        self.depth += 1;
        let count = 1 + self.random.below(3);
        self.statements(count, nesting + 1, in_loop);
        self.depth -= 1;
        self.close();
    }

    fn statement(&mut self, nesting: usize, in_loop: bool) {
        let deep = nesting > 2;
        match self.random.below(16) {
            0 | 1 => {
                let (ty, is_variable) = (self.random.pick(&TYPES).0, self.random.chance(60));
                self.declare(ty, is_variable);
            }
            2 if !deep => self.branch(nesting, in_loop),
            3 if !deep => self.counted(nesting),
            4 if !deep => self.endless(nesting),
            5 if !deep => self.switch(nesting, in_loop),
            6 if !deep => {
                self.indented("{");
                self.inner(nesting, in_loop);
                self.indented("}");
            }
            7 => self.effect(),
            8 if !deep => self.conditional(nesting, in_loop),
            9 => {
                let name = self.var(Ty::Int, true);
                let target = name.unwrap_or_else(|| "hash".to_owned());
                let sign = if self.random.chance(50) { "++" } else { "--" };
                self.indented(&format!("{target}{sign};"));
            }
            10 => self.part(),
            11 if in_loop && nesting > 1 => {
                let condition = self.value(Ty::Bool, 2);
                self.indented(&format!("if {condition} {{"));
                self.indented("    break;");
                self.indented("}");
            }
            _ => self.assign(),
        }
    }

    fn assign(&mut self) {
        let ty = self.random.pick(&TYPES).0;
        let Some(name) = self.var(ty, true) else { return };
        let value = self.value(ty, 3);
        let operators: &[&str] = match ty {
            Ty::Int | Ty::Ints => &["+=", "-=", "*=", "&=", "|=", "^="],
            Ty::Uint => &["+=", "-=", "*=", "&=", "|=", "^=", "<<=", ">>="],
            Ty::Bool => &["&=", "|="],
            _ => &[],
        };
        if operators.is_empty() || self.random.chance(40) {
            return self.indented(&format!("{name} = {value};"));
        }
        let operator = *self.random.pick(operators);
        self.indented(&format!("{name} {operator} {value};"));
    }

    /// A write to a part of something.
    fn part(&mut self) {
        let index = self.index();
        let (int, float) = (self.value(Ty::Int, 2), self.value(Ty::Float, 2));
        let bool = self.value(Ty::Bool, 2);
        let (row, pair) = (self.var(Ty::Row, true), self.var(Ty::Pair, true));
        let (ints, floats) = (self.var(Ty::Ints, true), self.var(Ty::Floats, true));
        let line = match (self.random.below(6), row, pair, ints, floats) {
            (0, Some(row), ..) => format!("{row}[{index}] += {int};"),
            (1, _, Some(pair), ..) => format!("{pair}.c = {float};"),
            (2, _, Some(pair), ..) => format!("{pair}.inner.row[{index}] = {int};"),
            (3, _, Some(pair), ..) => format!("{pair}.inner.flag = {bool};"),
            (4, _, _, Some(ints), _) => format!("{ints}.y = {int};"),
            (_, _, _, _, Some(floats)) => format!("{floats}[1] = {float};"),
            _ => return,
        };
        self.indented(&line);
    }

    /// A call that changes what it is given.
    fn effect(&mut self) {
        let (uint, int) = (self.value(Ty::Uint, 2), self.value(Ty::Int, 2));
        let bool = self.value(Ty::Bool, 2);
        let pair = self.var(Ty::Pair, true);
        match (self.random.below(4), pair) {
            (0, _) => self.indented(&format!("hash = stepped(&state, {uint});")),
            (1, Some(pair)) => {
                self.indented(&format!("if ({bool} && later({int}, &{pair})) {{"));
                self.indented("    hash += 3u;");
                self.indented("}");
            }
            (2, Some(pair)) => {
                let name = self.fresh();
                self.indented(&format!("let {name} = {bool} || later({int}, &{pair});"));
                self.know(name, Ty::Bool, false);
            }
            _ => self.indented(&format!("_ = stepped(&state, {uint});")),
        }
    }

    fn branch(&mut self, nesting: usize, in_loop: bool) {
        let condition = self.value(Ty::Bool, 3);
        self.indented(&format!("if {condition} {{"));
        self.inner(nesting, in_loop);
        if self.random.chance(40) {
            let condition = self.value(Ty::Bool, 2);
            self.indented(&format!("}} else if ({condition}) {{"));
            self.inner(nesting, in_loop);
        }
        if self.random.chance(50) {
            self.indented("} else {");
            self.inner(nesting, in_loop);
        }
        self.indented("}");
    }

    fn counted(&mut self, nesting: usize) {
        let (bound, is_signed) = (1 + self.random.below(5), self.random.chance(50));
        let (ty, end) = if is_signed { (Ty::Int, "") } else { (Ty::Uint, "u") };
        self.open();
        let name = self.fresh();
        self.indented(&format!("for (var {name} = 0{end}; {name} < {bound}{end}; {name}++) {{"));
        self.know(name.clone(), ty, false);
        self.open();
        self.depth += 1;
        if self.random.chance(40) {
            // A local of the body hides the variable of the loop.
            let value = self.value(ty, 2);
            self.take(&name);
            self.indented(&format!("let {name} = {value};"));
            self.indented(&format!("hash += u32({name});"));
            self.know(name, ty, false);
        }
        let count = 1 + self.random.below(3);
        self.statements(count, nesting + 1, true);
        self.depth -= 1;
        self.close();
        self.close();
        self.indented("}");
    }

    fn endless(&mut self, nesting: usize) {
        let name = self.unique();
        self.indented(&format!("var {name} = 0;"));
        self.indented("loop {");
        self.indented(&format!("    if {name} > 3 {{"));
        self.indented("        break;");
        self.indented("    }");
        match self.random.below(3) {
            0 => {
                self.indented(&format!("    if (({name} & 1) == 1) {{"));
                self.indented(&format!("        {name} += 1;"));
                self.indented("        continue;");
                self.indented("    }");
                self.inner(nesting, true);
                self.indented("    continuing {");
                self.indented(&format!("        {name} += 2;"));
                self.indented("    }");
            }
            1 => {
                self.inner(nesting, true);
                self.indented("    continuing {");
                self.indented(&format!("        {name} += 1;"));
                self.indented("        hash ^= 5u;");
                self.indented(&format!("        break if {name} > 2;"));
                self.indented("    }");
            }
            _ => {
                self.inner(nesting, true);
                self.indented(&format!("    {name} += 1;"));
            }
        }
        self.indented("}");
    }

    fn switch(&mut self, nesting: usize, _in_loop: bool) {
        let selector = self.value(Ty::Uint, 2);
        self.indented(&format!("switch ({selector}) & 3u {{"));
        for head in ["case 0u: {", "case 1u, 2u {", "default: {"] {
            self.indented(&format!("    {head}"));
            self.depth += 1;
            self.inner(nesting, false);
            self.depth -= 1;
            self.indented("    }");
        }
        self.indented("}");
    }

    /// Statements under a flag, and others where it is off. They stand in the scope around them:
    /// what both declare can be named behind them, and so can what hides something.
    fn conditional(&mut self, nesting: usize, in_loop: bool) {
        let flag = self.random.below(FLAGS.len());
        let (name, is_on, was_live) = (FLAGS[flag], self.flags[flag], self.is_live);
        let pad = "    ".repeat(self.depth);
        let ty = self.random.pick(&TYPES).0;
        let common = self.random.chance(60).then(|| self.fresh());
        // A name of an outer scope that one of the arms hides.
        let hiding = if self.random.chance(40) { self.hideable(ty) } else { None };
        let before = self.declared.last().cloned().unwrap_or_default();
        let mut after = before.clone();
        for (head, holds) in [(format!("@if({name})"), is_on), ("@else".to_owned(), !is_on)] {
            let _ = writeln!(self.text, "{pad}{head} {{");
            self.is_live = was_live && holds;
            self.declared.pop();
            self.declared.push(before.clone());
            self.scopes.push(Vec::new());
            if let Some(common) = &common {
                let value = self.value(ty, 2);
                self.indented(&format!("let {common}: {} = {value};", spelled(ty)));
                self.know(common.clone(), ty, false);
            }
            if let Some(hiding) = hiding.as_ref().filter(|_| head.starts_with("@if")) {
                let value = self.value(ty, 2);
                self.indented(&format!("let {hiding} = {value};"));
                self.know(hiding.clone(), ty, false);
            }
            let count = 1 + self.random.below(2);
            self.statements(count, nesting + 1, in_loop);
            self.scopes.pop();
            after.extend(self.declared.last().cloned().unwrap_or_default());
            self.is_live = was_live;
            let _ = writeln!(self.text, "{pad}}}");
        }
        // Names of one of the arms may hide others behind it: these are not used any more.
        let hidden: Vec<String> =
            after.iter().filter(|one| !before.contains(one)).cloned().collect();
        for scope in &mut self.scopes {
            scope.retain(|one| !hidden.contains(&one.name));
        }
        self.declared.pop();
        self.declared.push(after);
        for name in [common, hiding].into_iter().flatten() {
            self.know(name, ty, false);
        }
    }

    /// The name of something of an outer scope, which this one has now.
    fn hideable(&mut self, ty: Ty) -> Option<String> {
        let name =
            self.var(ty, false).filter(|name| !["a", "b", "c", "x"].contains(&name.as_str()))?;
        let names = self.declared.last_mut()?;
        if names.contains(&name) {
            return None;
        }
        names.push(name.clone());
        Some(name)
    }

    fn index(&mut self) -> String {
        let value = self.value(Ty::Uint, 1);
        format!("({value}) & 3u")
    }

    fn value(&mut self, ty: Ty, depth: usize) -> String {
        let name = self.var(ty, false);
        match name {
            Some(name) if depth == 0 || self.random.chance(30) => return name,
            _ if depth == 0 => return self.literal(ty),
            _ => {}
        }
        let below = depth - 1;
        match ty {
            Ty::Int => self.int(below),
            Ty::Uint => self.uint(below),
            Ty::Float => self.float(below),
            Ty::Bool => self.bool(below),
            Ty::Ints => self.ints(below),
            Ty::Floats => self.floats(below),
            Ty::Row => {
                let parts: Vec<String> = (0..4).map(|_| self.value(Ty::Int, below)).collect();
                format!("array<i32, 4>({})", parts.join(", "))
            }
            Ty::Pair => {
                let (a, c) = (self.value(Ty::Int, below), self.value(Ty::Float, below));
                let (b, flag) = (self.value(Ty::Uint, below), self.value(Ty::Bool, below));
                let row = self.value(Ty::Row, below);
                format!("Pair({a}, vec2u({b}, 7u), {c}, Inner({flag}, {row}))")
            }
        }
    }

    fn literal(&mut self, ty: Ty) -> String {
        match ty {
            Ty::Int => self.random.pick(&["0", "1", "-3", "17", "2147483647", "SIZE"]).to_string(),
            Ty::Uint => self.random.pick(&["0u", "1u", "9", "4294967295u", "0x80u"]).to_string(),
            Ty::Float => {
                self.random.pick(&["0.0", "1.5", "-2.0", "8", "SCALE", "SIZE"]).to_string()
            }
            Ty::Bool => self.random.pick(&["true", "false"]).to_string(),
            Ty::Ints => "vec3i(1, -2, 3)".to_owned(),
            Ty::Floats => "vec2f(0.5, 3)".to_owned(),
            Ty::Row => "array<i32, 4>(1, 2, 3, 4)".to_owned(),
            Ty::Pair => "Pair()".to_owned(),
        }
    }

    /// A name of an integer, or a parenthesised one: divisions need operands without effects.
    fn named_int(&mut self) -> String {
        self.var(Ty::Int, false).unwrap_or_else(|| "c".to_owned())
    }

    fn int(&mut self, depth: usize) -> String {
        let left = self.value(Ty::Int, depth);
        let right = self.value(Ty::Int, depth);
        let (one, other) = (self.named_int(), self.named_int());
        let uint = self.value(Ty::Uint, depth);
        match self.random.below(18) {
            0 => format!("({left} + {right})"),
            1 => format!("({left} - {right})"),
            2 => format!("({left} * {right})"),
            3 => format!("({one} / {other})"),
            4 => format!("({one} % 5)"),
            5 => format!("(({left} & 255) / 3)"),
            6 => format!("({left} << ({uint}))"),
            7 => format!("({left} >> ({uint}))"),
            8 => format!("({left} & {right})"),
            9 => format!("({left} ^ {right})"),
            10 => format!("-{left}").replace("--", "- -"),
            11 => format!("~({left})"),
            12 => format!("min({left}, {right})"),
            13 => format!("clamp({left}, -20, 20)"),
            14 => format!("i32({uint})"),
            15 => {
                let float = self.value(Ty::Float, depth);
                format!("i32({float} * 3e9)")
            }
            16 => {
                let (ints, bool) = (self.value(Ty::Ints, depth), self.value(Ty::Bool, depth));
                format!("select({left}, {ints}.z, {bool})")
            }
            _ => {
                let row =
                    self.var(Ty::Row, false).unwrap_or_else(|| "array(1, 2, 3, 4)".to_owned());
                let index = self.index();
                format!("{row}[{index}]")
            }
        }
    }

    fn uint(&mut self, depth: usize) -> String {
        let left = self.value(Ty::Uint, depth);
        let right = self.value(Ty::Uint, depth);
        let name = self.var(Ty::Uint, false).unwrap_or_else(|| "a".to_owned());
        match self.random.below(16) {
            0 => format!("({left} + {right})"),
            1 => format!("({left} * {right})"),
            2 => format!("({name} / hash)"),
            3 => format!("({name} % hash)"),
            4 => format!("({left} % 10u)"),
            5 => format!("({left} << ({right}))"),
            6 => format!("({left} >> ({right}))"),
            7 => format!("({left} | {right})"),
            8..=11 if !self.has_bits => format!("({left} ^ {right})"),
            8 => format!("countOneBits({left})"),
            9 => format!("firstLeadingBit({left})"),
            10 => format!("reverseBits({left})"),
            11 => format!("countLeadingZeros({left})"),
            12 => {
                let float = self.value(Ty::Float, depth);
                format!("u32({float} * 5e8)")
            }
            13 => {
                // The sign of a zero is nobody's business.
                let float = self.value(Ty::Float, depth);
                format!("bitcast<u32>(abs({float}) + 1.0)")
            }
            14 => {
                let bool = self.value(Ty::Bool, depth);
                format!("u32({bool})")
            }
            _ => {
                let int = self.value(Ty::Int, depth);
                format!("bitcast<u32>({int})")
            }
        }
    }

    /// Factors are powers of two, and results are bounded, so nothing depends on the rounding.
    fn float(&mut self, depth: usize) -> String {
        let (left, right) = (self.value(Ty::Float, depth), self.value(Ty::Float, depth));
        match self.random.below(12) {
            0 => format!("clamp({left} + {right}, -64.0, 64.0)"),
            1 => format!("clamp({left} - {right}, -64.0, 64.0)"),
            2 => format!("clamp(({left}) * 2.0, -64, 64)"),
            3 => format!("floor({left} * 0.5)"),
            4 => {
                let name = self.var(Ty::Float, false).unwrap_or_else(|| "x".to_owned());
                format!("({name} % 4.0)")
            }
            5 => format!("abs({left})"),
            6 => format!("min({left}, {right})"),
            7 => format!("trunc({left})"),
            8 => {
                let int = self.value(Ty::Int, depth);
                format!("f32(({int}) & 63)")
            }
            9 => {
                let floats = self.value(Ty::Floats, depth);
                format!("{floats}.y")
            }
            10 => {
                let bool = self.value(Ty::Bool, depth);
                format!("select({left}, {right}, {bool})")
            }
            _ => format!("saturate({left})"),
        }
    }

    fn bool(&mut self, depth: usize) -> String {
        let (left, right) = (self.value(Ty::Bool, depth), self.value(Ty::Bool, depth));
        match self.random.below(9) {
            0 => format!("({left} && {right})"),
            1 => format!("({left} || {right})"),
            2 => format!("!({left})"),
            3 => format!("({left} & {right})"),
            4 => {
                let (left, right) = (self.value(Ty::Int, depth), self.value(Ty::Int, depth));
                format!("({left} < {right})")
            }
            5 => {
                let (left, right) = (self.value(Ty::Uint, depth), self.value(Ty::Uint, depth));
                format!("({left} >= {right})")
            }
            6 => {
                let (left, right) = (self.value(Ty::Float, depth), self.value(Ty::Float, depth));
                format!("({left} != {right})")
            }
            7 => {
                let (left, right) = (self.value(Ty::Ints, depth), self.value(Ty::Ints, depth));
                let (name, sign) = *self.random.pick(&[("all", "=="), ("any", "<"), ("any", "!=")]);
                format!("{name}({left} {sign} {right})")
            }
            _ => {
                let pair = self.var(Ty::Pair, false).unwrap_or_else(|| "Pair()".to_owned());
                format!("{pair}.inner.flag")
            }
        }
    }

    fn ints(&mut self, depth: usize) -> String {
        let (left, right) = (self.value(Ty::Ints, depth), self.value(Ty::Ints, depth));
        let int = self.value(Ty::Int, depth);
        match self.random.below(7) {
            0 => format!("({left} + {right})"),
            1 => format!("({left} * {int})"),
            2 => format!("({int} - {left})"),
            3 => format!("max({left}, {right})"),
            4 => format!("vec3i({left}.zx, {int})"),
            5 => format!("vec3({int})"),
            _ => format!("({left} & {right})"),
        }
    }

    fn floats(&mut self, depth: usize) -> String {
        let (left, right) = (self.value(Ty::Floats, depth), self.value(Ty::Floats, depth));
        let float = self.value(Ty::Float, depth);
        match self.random.below(6) {
            0 => format!("clamp({left} + {right}, vec2f(-64), vec2f(64.0))"),
            1 => format!("({left} * 0.5)"),
            2 => format!("vec2f({float}, 1)"),
            3 => format!("min({left}, vec2f({float}))"),
            4 => format!("select({left}, {right}, {left} < {right})"),
            _ => format!("{left}.yx"),
        }
    }

    /// Everything that is in scope goes into the result.
    fn result(&mut self) {
        let all = self.scopes[0].clone();
        for Var { name, ty, .. } in all {
            let part = match ty {
                Ty::Int => format!("u32({name})"),
                Ty::Uint => name,
                Ty::Float => format!("u32(i32({name} * 256.0))"),
                Ty::Bool => format!("u32({name})"),
                Ty::Ints => format!("u32({name}.x) ^ u32({name}.y + {name}.z)"),
                Ty::Floats => format!("u32(i32({name}.x * 256.0) + i32({name}.y * 64.0))"),
                Ty::Row => {
                    format!("u32({name}[0] + {name}[1] * 3 + {name}[2] * 5 + {name}[3] * 7)")
                }
                Ty::Pair => format!(
                    "u32({name}.a) + {name}.b.x + {name}.b.y + u32(i32({name}.c * 16.0)) + u32({name}.inner.flag) + u32({name}.inner.row[1])"
                ),
            };
            self.indented(&format!("hash = hash * 31u + ({part});"));
        }
        self.indented("return hash ^ state ^ calls;");
        self.line("}");
    }
}

//! Random programs about what is constant, and about the ends of functions.

use lamplight_testing::random::Random;

const HEAD: &str = "@group(0) @binding(0) var<storage, read_write> p: i32;\n";
const ENTRY: &str = "@compute @workgroup_size(1) fn main() { p = f(p); }\n";

pub fn program(seed: u64) -> String {
    let random = Random(seed);
    let body = match seed % 2 {
        0 => Ends { random }.body(),
        _ => Constants { random, names: Vec::new() }.body(),
    };
    format!("{HEAD}const k = 3;\nfn f(x: i32) -> i32 {{\nvar i = x;\n{body}\n}}\n{ENTRY}")
}

/// Functions whose ends may be reached, or not.
struct Ends {
    random: Random,
}

/// What a statement is in.
#[derive(Clone, Copy)]
struct Within {
    depth: usize,
    is_loop: bool,
    is_switch: bool,
}

impl Ends {
    fn body(&mut self) -> String {
        let within = Within { depth: 3, is_loop: false, is_switch: false };
        let count = 1 + self.random.below(2);
        let mut statements: Vec<String> = (0..count).map(|_| self.statement(within)).collect();
        if self.random.chance(40) {
            let last = ["return i;", "return i;", "return;", "i += 1;"];
            statements.push((*self.random.pick(&last)).to_owned());
        }
        statements.join("\n")
    }

    fn block(&mut self, within: Within) -> String {
        let count = self.random.below(3);
        let mut statements: Vec<String> = (0..count).map(|_| self.statement(within)).collect();
        if self.random.chance(50) {
            statements.push(self.jump(within).to_owned());
        }
        format!("{{ {} }}", statements.join(" "))
    }

    fn jump(&mut self, Within { depth: _, is_loop, is_switch }: Within) -> &'static str {
        let mut jumps = vec!["return 1;", "return i;", "return k;", "i += 1;"];
        if self.random.chance(5) {
            jumps = vec!["return;"];
        }
        jumps.extend((is_loop || is_switch).then_some("break;"));
        jumps.extend(is_loop.then_some("continue;"));
        let jump: &&str = self.random.pick(&jumps);
        jump
    }

    fn statement(&mut self, within: Within) -> String {
        let Some(depth) = within.depth.checked_sub(1) else { return "i += 1;".to_owned() };
        let inner = Within { depth, ..within };
        let looped = Within { depth, is_loop: true, is_switch: false };
        let cased = Within { depth, is_switch: true, ..within };
        match self.random.below(9) {
            0 | 1 => "i += 1;".to_owned(),
            2 | 3 => {
                let (least, accept) = (self.random.below(6), self.block(inner));
                let has_other = self.random.chance(50);
                let reject = has_other.then(|| format!(" else {}", self.block(inner)));
                format!("if i > {least} {accept}{}", reject.unwrap_or_default())
            }
            4 | 5 => {
                let body = self.block(looped);
                let end = if self.random.chance(30) { "break if i > 9;" } else { "" };
                let continuing = format!("continuing {{ i += 1; {end} }} }}");
                let has_more = self.random.chance(40);
                let end = if has_more { continuing.as_str() } else { "}" };
                format!("{}{end}", body.trim_end_matches('}').replacen('{', "loop {", 1))
            }
            6 => {
                let condition = *self.random.pick(&["", "i < 9"]);
                format!("for (; {condition}; i++) {}", self.block(looped))
            }
            7 => {
                let (one, other) = (self.block(cased), self.block(cased));
                format!("switch i {{ case 1: {one} default: {other} }}")
            }
            _ => self.block(inner),
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Ty {
    Int,
    Uint,
    Float,
}

impl Ty {
    fn name(self) -> &'static str {
        match self {
            Self::Int => "i32",
            Self::Uint => "u32",
            Self::Float => "f32",
        }
    }
}

/// Names with constant values, and uses of them that only constants, or only variables, allow.
struct Constants {
    random: Random,
    names: Vec<(String, Ty)>,
}

impl Constants {
    fn body(&mut self) -> String {
        let mut lines = vec!["var t = array(1, 2, 3); let y = u32(x);".to_owned()];
        for at in 0..=self.random.below(4) {
            let ty = *self.random.pick(&[Ty::Int, Ty::Int, Ty::Uint, Ty::Float]);
            let keyword = *self.random.pick(&["let", "let", "let", "var", "const"]);
            let of =
                if self.random.chance(50) { format!(": {}", ty.name()) } else { String::new() };
            lines.push(format!("{keyword} a{at}{of} = {};", self.value(ty, 2)));
            self.names.push((format!("a{at}"), ty));
        }
        for at in 0..=self.random.below(3) {
            lines.push(self.line(at));
        }
        lines.push("return i;".to_owned());
        lines.join("\n")
    }

    /// A name of a type, or a number.
    fn named(&mut self, ty: Ty) -> String {
        let of_type = self.names.iter().filter(|(_, other)| *other == ty);
        let names: Vec<&String> = of_type.map(|(name, _)| name).collect();
        match names.as_slice() {
            [] => self.number(ty).to_owned(),
            names => (*self.random.pick(names)).clone(),
        }
    }

    fn number(&mut self, ty: Ty) -> &'static str {
        let numbers: &[&str] = match ty {
            Ty::Int => &["0", "1", "33", "-1", "7", "2147483647", "k", "3000000000"],
            Ty::Uint => &["0u", "1u", "31u", "32u", "33u", "4294967295u"],
            Ty::Float => &["0.0", "1.0", "-2.5", "3e38", "1e-30"],
        };
        let number: &&str = self.random.pick(numbers);
        number
    }

    fn value(&mut self, ty: Ty, depth: usize) -> String {
        match self.random.below(3) {
            0 => self.named(ty),
            1 if depth > 0 => {
                let operator = *self.random.pick(&["+", "*", "-"]);
                let one = self.value(ty, depth - 1);
                // Whole numbers without a type are followed up to 2^53, so large ones are not multiplied.
                let other = match (ty, operator) {
                    (Ty::Int, "*") => "7".to_owned(),
                    _ => self.value(ty, depth - 1),
                };
                format!("({one} {operator} {other})")
            }
            _ => self.number(ty).to_owned(),
        }
    }

    fn line(&mut self, at: usize) -> String {
        let (one, two) = (self.named(Ty::Int), self.named(Ty::Int));
        let (wide, far) = (self.named(Ty::Uint), self.named(Ty::Uint));
        match self.random.below(15) {
            0 => format!("i = x / {one};"),
            1 => format!("i = {one} % {two};"),
            2 => format!("i += i32(y << {wide});"),
            3 => format!("i += i32({wide} >> {far});"),
            4 => format!("i = t[{one}];"),
            5 => format!("i = array(1, 2, 3)[{one}];"),
            6 => format!("{one} = 1;"),
            7 => format!("{wide} += 1u;"),
            8 => format!("{one}++;"),
            9 => format!("let q{at} = &{one};"),
            10 => format!("const q{at} = {one} + 1;"),
            11 => format!("const_assert {one} < 50;"),
            12 => format!("switch x {{ case {one}: {{ i = 1; }} default: {{ }} }}"),
            13 => format!("for (let j = {one}; j < 3;) {{ i = j; break; }}"),
            _ => format!("if x > 0 {{ let {one}_ = {two}; i = x % {one}_; }}"),
        }
    }
}

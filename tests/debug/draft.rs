//! Random programs that note each value that they store.
//!
//! Every number is a multiple of a quarter between -64 and 64, so that each sum and product of two of
//! them is exact in f32, fused or not: all executors must give the same bits.

use std::fmt::Write as _;

use crate::random::Random;

/// How many values a run notes at most.
pub const NOTES: u32 = 160;

struct Draft {
    random: Random,
    /// How deep blocks may nest from here.
    depth: u32,
    loops: u32,
    /// Functions that may be called.
    callees: usize,
    inside: u32,
}

/// The text of a program whose function `f(given_x, given_y, given_i, index)` returns the value that
/// was noted at an index, or how many there are.
pub fn draft_program(seed: u32) -> String {
    let random = Random(u64::from(seed));
    let mut draft = Draft { random, depth: 2, loops: 0, callees: 0, inside: 0 };
    let mut text = format!(
        "var<private> noted: array<f32, {NOTES}>;\n\
         var<private> count: u32;\n\
         fn note(value: f32) {{\n    if count < {NOTES}u {{ noted[count] = value; }}\n    count++;\n}}\n\
         fn exact(value: f32) -> f32 {{\n    return clamp(floor(value * 4.0) * 0.25, -64.0, 64.0);\n}}\n\
         struct Pair {{ low: f32, high: vec2f }}\n"
    );
    for helper in 0..2 {
        let body = draft.block();
        let _ = writeln!(
            text,
            "fn helper_{helper}(given_x: f32, out: ptr<function, f32>, given_i: i32) -> f32 {{\n\
             var x = given_x; var y = *out; var i = given_i; var v = vec3f(x, y, 1.0);\n\
             var a = array<f32, 3>(y, x, 0.5); var p = Pair(x, v.yz);\n\
             {body}*out = exact(y + 1.0);\nnote(*out);\nreturn x;\n}}"
        );
        draft.callees += 1;
    }
    draft.depth = 3;
    let body: String = (0..5).map(|_| draft.block()).collect();
    let _ = writeln!(
        text,
        "fn run(given_x: f32, given_y: f32, given_i: i32) {{\n\
         var x = given_x; var y = given_y; var i = given_i; var v = vec3f(x, y, 2.0);\n\
         var a = array<f32, 3>(x, y, 0.25); var p = Pair(y, v.xy);\n{body}}}\n\
         fn f(given_x: f32, given_y: f32, given_i: i32, index: u32) -> f32 {{\n\
         run(given_x, given_y, given_i);\n\
         if index == {NOTES}u {{ return f32(count); }}\n\
         return noted[index];\n}}"
    );
    text
}

impl Draft {
    fn picked(&mut self, options: &[&str]) -> String {
        (*self.random.pick(options)).to_owned()
    }

    fn number(&mut self) -> String {
        self.picked(&[
            "x", "y", "v.x", "v[i & 1]", "a[i & 1]", "f32(i)", "p.low", "p.high.y", "0.75",
        ])
    }

    fn value(&mut self) -> String {
        let (a, b, c) = (self.number(), self.number(), self.number());
        match self.random.below(16) {
            0 => format!("{a} + {b}"),
            1 => format!("{a} - {b}"),
            2 => format!("{a} * {b}"),
            3 => format!("min({a}, {b}) + {c}"),
            4 => format!("max({a}, -{b})"),
            5 => format!("select({a}, {b}, {c} < {a})"),
            6 => format!("abs({a}) - floor({b})"),
            7 => format!("dot(vec2f({a}, 1.0), vec2f({b}, 0.5))"),
            8 => format!("step({a}, {b}) + sign({c})"),
            9 => format!("fma({a}, 0.5, {b})"),
            10 => format!("{a} / 4.0 + fract({b})"),
            11 => format!("(mat2x2f(1.0, 2.0, 0.5, 1.0) * vec2f({a}, {b})).y"),
            12 => format!("v.zyx.y + trunc({a})"),
            13 => format!("mix({a}, {b}, 0.5)"),
            _ => self.called(),
        }
    }

    fn called(&mut self) -> String {
        if self.callees == 0 {
            return self.number();
        }
        let callee = self.random.below(self.callees);
        format!("helper_{callee}({}, &y, i)", self.number())
    }

    fn whole(&mut self) -> String {
        self.picked(&[
            "(i + 1) & 7",
            "(i * 3 - 2) & 7",
            "i32(clamp(x, -5.0, 5.0))",
            "i & 6",
            "i >> 1u",
            "-i",
            "i / 2",
            "abs(i) % 5",
            "select(i, 2, y > x)",
        ])
    }

    fn condition(&mut self) -> String {
        let (a, b) = (self.number(), self.number());
        match self.random.below(4) {
            0 => format!("{a} < {b}"),
            1 => format!("{a} >= {b}"),
            2 => "i > 1".to_owned(),
            _ => "(i & 1) == 0".to_owned(),
        }
    }

    fn block(&mut self) -> String {
        self.depth -= 1;
        let count = 1 + self.random.below(3);
        let block = (0..count).map(|_| self.statement()).collect();
        self.depth += 1;
        block
    }

    fn statement(&mut self) -> String {
        let sides = if self.depth == 0 { 7 } else { 11 };
        let roll = self.random.below(sides);
        match roll {
            0 => format!("x = exact({});\nnote(x);\n", self.value()),
            1 => format!("y = exact({});\nnote(y);\n", self.value()),
            2 => format!("v[i & 1] = exact({});\nnote(v.x);\nnote(v.y);\n", self.value()),
            3 => format!("i = {};\nnote(f32(i));\n", self.whole()),
            4 => format!("a[i & 1] = exact({});\nnote(a[0]);\nnote(a[1]);\n", self.value()),
            5 => format!("p.high.x = exact({});\nnote(p.high.x);\n", self.value()),
            6 => {
                let (name, value) = (self.loops, self.value());
                self.loops += 1;
                format!("let named_{name} = exact({value});\nnote(named_{name});\n")
            }
            7 => {
                let condition = self.condition();
                format!("if {condition} {{\n{}}} else {{\n{}}}\n", self.block(), self.block())
            }
            8 => format!(
                "switch i {{\ncase 0, 2: {{\n{}}}\ncase 1: {{\n{}}}\ndefault: {{\n{}}}\n}}\n",
                self.block(),
                self.block(),
                self.block()
            ),
            9 => self.repeated(),
            _ if self.inside > 0 => format!("if {} {{ break; }}\n", self.condition()),
            _ => format!("if {} {{\n{}}}\n", self.condition(), self.block()),
        }
    }

    fn repeated(&mut self) -> String {
        let name = format!("turn_{}", self.loops);
        self.loops += 1;
        self.inside += 1;
        let block = self.block();
        self.inside -= 1;
        let most = 1 + self.random.below(3);
        format!("for (var {name} = 0; {name} < {most}; {name}++) {{\n{block}}}\n")
    }
}

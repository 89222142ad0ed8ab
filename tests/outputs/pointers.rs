//! Random functions that pass pointers to parts of variables on. Their values are found by doing
//! the same to a list of numbers, statement by statement.

use std::fmt::Write;

use libtest_mimic::Failed;

use super::{Outcome, lamplight};
use crate::is_whole;
use crate::random::Random;

/// The executors, each with another target: the ways in which arguments are passed differ.
const EXECUTORS: [&str; 5] = ["eval", "spirv", "glsl330", "msl", "hlsl"];

/// How many programs are run by day, and at night.
const PROGRAMS: [u64; 2] = [6, 60];

/// The types, each with the numbers that it holds: a number, three of them, a structure of three and
/// one, and two of these.
const TYPES: [(&str, usize); 4] =
    [("i32", 1), ("array<i32, 3>", 3), ("Row", 4), ("array<Row, 2>", 8)];

/// What a function does with its pointer.
enum Action {
    /// `*part = *part * 3 + number;`
    Change { part: Part, number: i32 },
    /// `sum += f(&part, at + number);`
    Call { part: Part, function: usize, number: i32 },
    /// `at += number;`
    Step(i32),
}

/// A part of what a pointer leads to.
struct Part {
    /// As WGSL, behind `(*p)`. `{}` is the index.
    text: String,
    ty: usize,
    /// Where it starts; the second factor is that of an index below the last number.
    offset: usize,
    indices: Vec<(usize, usize)>,
}

struct RandomFunction {
    ty: usize,
    actions: Vec<Action>,
}

impl Part {
    /// A part of a type that has the numbers of another type.
    fn random(random: &mut Random, from: usize, to: usize) -> Self {
        let mut part = Self { text: String::new(), ty: from, offset: 0, indices: Vec::new() };
        while part.ty > to {
            match part.ty {
                3 => part.index(2, 4, 2),
                2 if to == 0 && random.chance(50) => {
                    part.text += ".last";
                    part.offset += 3;
                    part.ty = 0;
                }
                2 => {
                    part.text += ".three";
                    part.ty = 1;
                }
                _ => part.index(3, 1, 0),
            }
        }
        part
    }

    fn index(&mut self, count: usize, size: usize, ty: usize) {
        let shift = self.indices.len();
        let _ = write!(self.text, "[(at + {shift}) % {count}]");
        self.indices.push((count, size));
        self.ty = ty;
    }

    fn place(&self, at: i32) -> usize {
        let indices = self.indices.iter().enumerate();
        let parts = indices.map(|(shift, (count, size))| (at as usize + shift) % count * size);
        self.offset + parts.sum::<usize>()
    }
}

/// Functions, each of which calls only earlier ones.
fn functions(random: &mut Random) -> Vec<RandomFunction> {
    let mut made: Vec<RandomFunction> = Vec::new();
    for index in 0..8 {
        let ty = if index == 7 { 3 } else { index % 4 };
        let action = |random: &mut Random, made: &[RandomFunction]| {
            let number = random.below(5) as i32;
            let callees: Vec<usize> = (0..made.len()).filter(|one| made[*one].ty <= ty).collect();
            match random.below(3) {
                0 => Action::Step(number),
                1 if !callees.is_empty() => {
                    let function = *random.pick(&callees);
                    let part = Part::random(random, ty, made[function].ty);
                    Action::Call { part, function, number }
                }
                _ => Action::Change { part: Part::random(random, ty, 0), number },
            }
        };
        let actions = (0..2 + random.below(3)).map(|_| action(random, &made)).collect();
        made.push(RandomFunction { ty, actions });
    }
    made
}

/// The function as WGSL. `space` is that of the variable.
fn text(index: usize, function: &RandomFunction, space: &str) -> String {
    let (ty, _) = TYPES[function.ty];
    let mut text = format!("fn {space}_{index}(p: ptr<{space}, {ty}>, start: i32) -> i32 {{\n");
    text += "    var at = start;\n    var sum = 0;\n";
    for action in &function.actions {
        let _ = match action {
            Action::Step(number) => writeln!(text, "    at += {number};"),
            Action::Change { part, number } => {
                let part = &part.text;
                writeln!(text, "    (*p){part} = ((*p){part} * 3 + {number} + at) % 1000;")
            }
            Action::Call { part, function, number } => {
                let part = &part.text;
                writeln!(text, "    sum += {space}_{function}(&(*p){part}, at + {number});")
            }
        };
    }
    text + "    return sum + at;\n}\n\n"
}

/// Does what a function does to numbers that begin at `from`.
fn run(
    functions: &[RandomFunction],
    index: usize,
    all: &mut [i32],
    from: usize,
    start: i32,
) -> i32 {
    let (mut at, mut sum) = (start, 0);
    for action in &functions[index].actions {
        match action {
            Action::Step(number) => at += number,
            Action::Change { part, number } => {
                let place = &mut all[from + part.place(at)];
                *place = (*place * 3 + number + at) % 1000;
            }
            Action::Call { part, function, number } => {
                sum += run(functions, *function, all, from + part.place(at), at + number);
            }
        }
    }
    sum + at
}

/// A number that depends on each number and on the result.
const DIGEST: &str = "
fn digest(rows: array<Row, 2>, result: i32) -> i32 {
    var sum = result;
    for (var row = 0; row < 2; row++) {
        for (var at = 0; at < 3; at++) { sum = (sum * 7 + rows[row].three[at]) % 100003; }
        sum = (sum * 7 + rows[row].last) % 100003;
    }
    return sum;
}
";

/// Functions with pointers to variables of functions, and to those of the module.
pub fn random_programs() -> Outcome {
    let folder = tempfile::tempdir()?;
    let rows = "array(Row(array(1, 2, 3), 4), Row(array(5, 6, 7), 8))";
    for seed in 0..PROGRAMS[usize::from(is_whole())] {
        let functions = functions(&mut Random(seed));
        let mut module = String::from("struct Row { three: array<i32, 3>, last: i32 }\n");
        module += "var<private> kept: array<Row, 2>;\n";
        module += DIGEST;
        for space in ["function", "private"] {
            for (index, function) in functions.iter().enumerate() {
                module += &text(index, function, space);
            }
        }
        let _ = write!(
            module,
            "fn of_function(start: i32) -> i32 {{\n    var rows = {rows};\n    \
             let result = function_7(&rows, start);\n    return digest(rows, result);\n}}\n\n\
             fn of_module(start: i32) -> i32 {{\n    kept = {rows};\n    \
             let result = private_7(&kept, start);\n    return digest(kept, result);\n}}\n"
        );
        std::fs::write(folder.path().join(format!("p{seed}.wesl")), module)?;
        std::fs::write(folder.path().join(format!("p{seed}.toml")), cases(&functions))?;
    }
    std::fs::write(
        folder.path().join("wesl.toml"),
        std::fs::read(super::folder("values").join("wesl.toml"))?,
    )?;
    for executor in EXECUTORS {
        lamplight(&["check", ".", "--executor", executor], folder.path())
            .map_err(|error| Failed::from(format!("{executor}: {error:?}")))?;
    }
    Ok(())
}

/// What both functions of a program return, as cases.
fn cases(functions: &[RandomFunction]) -> String {
    let row = |start: i32| {
        let mut all = [1, 2, 3, 4, 5, 6, 7, 8];
        let result = run(functions, 7, &mut all, 0, start);
        let wanted = all.iter().fold(result, |sum, number| (sum * 7 + number) % 100_003);
        format!("{{ start = {start}, expect = {wanted} }}")
    };
    let rows: Vec<String> = (0..4).map(row).collect();
    let rows = rows.join(", ");
    ["of_function", "of_module"]
        .map(|name| format!("[[case]]\nfunction = \"{name}\"\nrows = [{rows}]\n"))
        .concat()
}

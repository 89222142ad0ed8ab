//! Writes whole programs: declarations, functions, and the bytes of buffers.

use std::fmt::Write as _;

use super::body::Body;
use super::scope::{Named, Parameter, Signature};
use super::types::{FLOAT, INT, Member, Number, Scalar, Struct, Ty, UINT, random_bytes};
use crate::random::Random;
use lamplight::bundle::{BoundsChecks, Conventions};
use lamplight::execute::frame::Buffers;

/// A program, with what it is run with.
#[derive(Debug, Clone)]
pub struct Program {
    pub text: String,
    pub buffers: Buffers,
    pub groups: [u32; 3],
    /// Checks change what writers make of a program, and no result.
    pub bounds: BoundsChecks,
    /// The numbers of each buffer that is written to; what lies between them may be anything.
    pub numbers: Vec<((u32, u32), Vec<u32>)>,
}

const OUT: (u32, u32) = (0, 0);
const SETTINGS: (u32, u32) = (0, 1);
const DATA: (u32, u32) = (1, 2);
const MARKS: (u32, u32) = (0, 3);
const ROWS: (u32, u32) = (1, 0);
const SLOTS: (u32, u32) = (1, 1);

/// Functions with each kind of pointer. The two pointers of `both` may be the same, since it only reads.
const HELPERS: &str = "\
fn bump(at: ptr<function, u32>) -> u32 { *at += 1u; return *at; }
fn twice(at: ptr<private, i32>) -> i32 { *at = *at * 2; return *at ^ 5; }
fn both(a: ptr<function, i32>, b: ptr<function, i32>) -> i32 { return *a * 3 - *b; }
fn push(at: ptr<storage, Cell, read_write>, by: Word) -> u32 { (*at).last ^= by; return at.last; }
fn raise(at: ptr<workgroup, atomic<u32>>, by: u32) { atomicAdd(at, by); }
fn replace(at: ptr<storage, atomic<u32>, read_write>, old: u32, new_one: u32) -> bool {
    loop {
        let found = atomicCompareExchangeWeak(at, old, new_one);
        if found.exchanged || found.old_value != old { return found.exchanged; }
    }
    return false;
}";

/// Elements of the array at the end of `data`. No other array has as many.
const TAIL: u32 = 5;

pub struct Draft {
    pub random: Random,
    pub text: String,
    pub structs: Vec<Struct>,
    pub functions: Vec<Signature>,
    /// What every function can name.
    pub global: Vec<Named>,
    pub size: [u32; 3],
    /// The size as the entry point spells it.
    pub size_text: String,
    pub groups: [u32; 3],
    pub has_rows: bool,
    /// Whether glslangValidator understands all of the program in HLSL: it takes atomic numbers of
    /// buffers for unsigned, and puts matrices of three rows elsewhere.
    pub is_plain: bool,
}

impl Program {
    pub fn new(seed: u64) -> Self {
        let mut draft = Draft {
            random: Random(seed),
            text: String::new(),
            structs: Vec::new(),
            functions: Vec::new(),
            global: Vec::new(),
            size: [1; 3],
            size_text: String::new(),
            groups: [1; 3],
            has_rows: false,
            is_plain: true,
        };
        draft.is_plain = draft.random.chance(65);
        draft.constants();
        draft.structures();
        draft.variables();
        draft.functions();
        draft.entry();
        draft.finished()
    }
}

impl Draft {
    pub fn add(&mut self, text: &str) {
        self.text += text;
        self.text.push('\n');
    }

    /// Constants and overrides, and the size of workgroups.
    fn constants(&mut self) {
        if self.random.chance(20) {
            self.add("diagnostic(off, derivative_uniformity);");
        }
        let sizes: [[u32; 3]; 6] =
            [[4, 1, 1], [2, 2, 1], [8, 1, 1], [1, 1, 1], [2, 1, 2], [3, 2, 1]];
        self.size = *self.random.pick(&sizes);
        let groups: [[u32; 3]; 4] = [[1, 1, 1], [2, 1, 1], [1, 3, 1], [1, 1, 2]];
        self.groups = *self.random.pick(&groups);
        let [x, y, z] = self.size;
        let kinds = ["const size_x = ", "override size_x: u32 = ", "@id(7) override size_x = "];
        let kind = *self.random.pick(&kinds);
        self.add(&format!("{kind}{x}u;"));
        let doubled = match self.random.chance(50) {
            true => "override double_x = size_x * 2u;",
            false => "override double_x: u32 = size_x + size_x;",
        };
        self.add(doubled);
        self.add("alias Word = u32;\nconst three = 3;\nconst flag = three > 2;\nconst table = array(2, -7, 11, 5);");
        self.add("override gain: f32 = 0.5;\noverride is_on = true;\noverride shift = -3;");
        self.size_text = match self.random.below(3) {
            0 => format!("size_x, {y}, {z}"),
            1 => format!("double_x / 2u, {y}u, {z}u"),
            _ if y == 1 && z == 1 => "size_x".to_owned(),
            _ => format!("size_x, {y}, {z}"),
        };
        for (name, ty) in [("size_x", UINT), ("double_x", UINT), ("shift", INT), ("gain", FLOAT)] {
            self.global.push(Named::constant(name, ty));
        }
        self.global.push(Named::constant("three", INT));
        self.global.push(Named::constant("is_on", Ty::Scalar(Scalar::Bool)));
        self.global.push(Named::constant("table", Ty::array(INT, 4)));
        self.add("const_assert size_one == 1 && flag;\nconst size_one = 1;");
    }

    fn structures(&mut self) {
        for index in 0..1 + self.random.below(3) {
            let members = self.members(index, 2 + index);
            self.structure(format!("S{index}"), members);
        }
    }

    fn structure(&mut self, name: String, members: Vec<Member>) {
        let mut text = format!("struct {name} {{ ");
        for member in &members {
            let size =
                if member.size > 0 { format!("@size({}) ", member.size) } else { String::new() };
            let _ = write!(text, "{size}{}: {}, ", member.name, member.ty.spelt(&self.structs));
        }
        self.add(&format!("{text}}}"));
        self.structs.push(Struct { name, members });
    }

    /// Members of types that buffers may hold, of structures before `known`.
    fn members(&mut self, known: usize, count: usize) -> Vec<Member> {
        let member = |draft: &mut Self, index: usize| {
            let ty = draft.shared_type(known);
            let size = match draft.random.chance(15) {
                true => ty.size(&draft.structs).next_multiple_of(4) + 4,
                false => 0,
            };
            Member { name: format!("m{index}"), ty, size }
        };
        (0..count).map(|index| member(self, index)).collect()
    }

    fn shared_type(&mut self, known: usize) -> Ty {
        let scalar = *self.random.pick(&[Scalar::Int, Scalar::Uint, Scalar::Float]);
        let some = |random: &mut Random| 2 + random.below(3) as u32;
        match self.random.below(12) {
            0..=3 => Ty::Scalar(scalar),
            4 | 5 => Ty::Vector(some(&mut self.random), scalar),
            6 => Ty::Matrix(some(&mut self.random), some(&mut self.random)),
            7 if known > 0 => Ty::Struct(self.random.below(known)),
            8 if known > 0 => {
                Ty::array(Ty::Struct(self.random.below(known)), some(&mut self.random))
            }
            9 => Ty::array(Ty::array(Ty::Scalar(scalar), 2), 3),
            10 => Ty::array(Ty::Vector(some(&mut self.random), scalar), 2),
            _ => Ty::array(Ty::Scalar(scalar), some(&mut self.random)),
        }
    }

    /// Members of a uniform buffer: elements of arrays are 16 bytes apart.
    fn uniform_members(&mut self) -> Vec<Member> {
        let mut members = vec![Member { name: "count".to_owned(), ty: UINT, size: 0 }];
        for index in 0..2 + self.random.below(3) {
            let scalar = *self.random.pick(&[Scalar::Int, Scalar::Uint, Scalar::Float]);
            let four = Ty::Vector(4, scalar);
            let ty = match self.random.below(7) {
                0 => Ty::Scalar(scalar),
                1 => Ty::Vector(2 + self.random.below(3) as u32, scalar),
                2 => self.uniform_matrix(),
                3 => Ty::array(four, 3),
                4 => Ty::array(Ty::array(four, 2), 3),
                5 => Ty::array(Ty::Matrix(2, 4), 2),
                _ => four,
            };
            members.push(Member { name: format!("m{index}"), ty, size: 0 });
        }
        members
    }

    fn uniform_matrix(&mut self) -> Ty {
        let columns = 2 + self.random.below(3) as u32;
        match self.is_plain {
            true => Ty::Matrix(columns, 4),
            false => Ty::Matrix(columns, 2 + self.random.below(3) as u32),
        }
    }

    fn variables(&mut self) {
        let own = self.structs.len();
        let mut members = self.members(own, 4);
        members.push(Member { name: "last".to_owned(), ty: UINT, size: 0 });
        self.structure("Cell".to_owned(), members);
        let members = self.uniform_members();
        self.structure("Settings".to_owned(), members);
        let mut data = self.members(own, 3);
        let tail = Ty::array(Ty::Struct(self.random.below(own)), TAIL);
        data.push(Member { name: "tail".to_owned(), ty: tail, size: 0 });
        self.structure("Data".to_owned(), data);
        // The last array has no size in the text.
        self.text = self.text.replace(&format!(", {TAIL}>"), ">");
        self.buffers(own);
        self.add("var<private> own_int: i32 = shift * 2 + three;");
        let row = *self.random.pick(&["1u, size_x, 3u", "size_x, 7u, double_x", "1, 2, 3"]);
        self.add(&format!("var<private> own_row = array<u32, 3>({row});"));
        self.add("var<private> own_pair: vec2f = vec2f(gain, 0.25) * 2.0;");
        self.global.push(Named::new("own_int", INT, true));
        self.global.push(Named::new("own_row", Ty::array(UINT, 3), true));
        self.global.push(Named::new("own_pair", Ty::Vector(2, Scalar::Float), true));
    }

    fn buffers(&mut self, own: usize) {
        self.add(
            "struct Marks { sum: atomic<u32>, rest: atomic<i32>, low: atomic<i32>,\n    \
             high: atomic<i32>, top: atomic<u32>, some: atomic<u32>, odd: atomic<u32> }\n\
             @group(0) @binding(0) var<storage, read_write> cells: array<Cell>;\n\
             @group(0) @binding(1) var<uniform> settings: Settings;\n\
             @group(1) @binding(2) var<storage, read> data: Data;\n\
             @group(0) @binding(3) var<storage, read_write> marks: Marks;\n\
             @group(1) @binding(1) var<storage, read_write> slots: array<atomic<u32>>;",
        );
        self.global.push(Named::new("settings", Ty::Struct(own + 1), false));
        self.global.push(Named::new("data", Ty::Struct(own + 2), false));
        self.global.push(Named::new("arrayLength(&data.tail)", UINT, false));
        self.has_rows = self.random.chance(40);
        if self.has_rows {
            self.add("@group(1) @binding(0) var<uniform> rows: array<array<vec4i, 2>, 3>;");
            self.global.push(Named::new("rows", rows_type(), false));
        }
    }

    fn functions(&mut self) {
        self.add(HELPERS);
        let pointer = |ty: &Ty| vec![Parameter::Pointer(ty.clone())];
        self.known("bump", pointer(&UINT), UINT);
        self.known("twice", vec![Parameter::Place("&own_int")], INT);
        self.known("both", vec![Parameter::Shared(INT), Parameter::Shared(INT)], INT);
        for index in 0..2 + self.random.below(3) {
            self.function(index);
        }
    }

    fn known(&mut self, name: &str, parameters: Vec<Parameter>, result: Ty) {
        self.functions.push(Signature { name: name.to_owned(), parameters, result });
    }

    fn function(&mut self, index: usize) {
        let vector = Ty::Vector(3, Scalar::Int);
        let result = self.random.pick(&[INT, UINT, FLOAT, vector.clone()]).clone();
        let mut parameters = vec![Parameter::Value(UINT)];
        let (mut named, mut spelt) = (self.global.clone(), vec!["seed: u32".to_owned()]);
        named.push(Named::new("seed", UINT, false));
        for number in 0..self.random.below(3) {
            let name = format!("p{number}");
            let types = [INT, UINT, FLOAT, vector.clone(), Ty::array(INT, 2), Ty::Struct(0)];
            let ty = self.random.pick(&types).clone();
            let text = ty.spelt(&self.structs);
            if self.random.chance(45) {
                spelt.push(format!("{name}: ptr<function, {text}>"));
                named.push(Named::variable(format!("(*{name})"), ty.clone(), name));
                parameters.push(Parameter::Pointer(ty));
            } else {
                spelt.push(format!("{name}: {text}"));
                named.push(Named::new(name, ty.clone(), false));
                parameters.push(Parameter::Value(ty));
            }
        }
        let name = format!("f{index}");
        let mut body = Body::new(&mut self.random, &self.structs, &self.functions, named);
        (body.calls, body.is_plain) = (1, self.is_plain);
        body.result = Some(result.clone());
        body.statements(5, 2);
        let value = body.value(&result, 3);
        body.line(format!("return {value};"));
        let lines = body.lines.join("\n");
        let (list, of) = (spelt.join(", "), result.spelt(&self.structs));
        let attribute = match self.random.chance(10) {
            true => "@diagnostic(off, derivative_uniformity) ",
            false => "",
        };
        self.add(&format!("{attribute}fn {name}({list}) -> {of} {{\n{lines}\n}}"));
        self.functions.push(Signature { name, parameters, result });
    }

    fn finished(mut self) -> Program {
        let cell = self.structs.len() - 3;
        let invocations: u32 = self.size.iter().chain(&self.groups).product();
        let mut buffers = Buffers::new();
        let mut written = Vec::new();
        let cells = Ty::array(Ty::Struct(cell), invocations);
        let types = [(OUT, cells), (SETTINGS, Ty::Struct(cell + 1)), (DATA, Ty::Struct(cell + 2))];
        let rows = self.has_rows.then(|| (ROWS, rows_type()));
        for (place, ty) in types.into_iter().chain(rows) {
            let mut numbers: Vec<Number> = Vec::new();
            ty.numbers(&self.structs, 0, &mut numbers);
            let size = ty.size(&self.structs).next_multiple_of(16);
            let size = if place == OUT || place == DATA { ty.size(&self.structs) } else { size };
            buffers.insert(place, random_bytes(&numbers, size, &mut self.random));
            if place == OUT {
                written.push((place, numbers.iter().map(|(offset, _)| *offset).collect()));
            }
        }
        let marks: Vec<Number> = (0..7).map(|index| (4 * index, Scalar::Uint)).collect();
        buffers.insert(MARKS, random_bytes(&marks, 28, &mut self.random));
        let slots: Vec<Number> = (0..invocations).map(|at| (4 * at, Scalar::Uint)).collect();
        buffers.insert(SLOTS, random_bytes(&slots, 4 * invocations, &mut self.random));
        written.push((SLOTS, slots.iter().map(|(offset, _)| *offset).collect()));
        written.push((MARKS, marks.iter().map(|(offset, _)| *offset).collect()));
        let bounds = match self.random.chance(30) {
            true => BoundsChecks::Restrict,
            false => Conventions::default().bounds,
        };
        Program { text: self.text, buffers, groups: self.groups, bounds, numbers: written }
    }
}

fn rows_type() -> Ty {
    Ty::array(Ty::array(Ty::Vector(4, Scalar::Int), 2), 3)
}

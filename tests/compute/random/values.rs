//! Writes expressions. Integers do what WGSL defines for all of their values; floats stay multiples
//! of 1/4 below 64, so that every operation is exact.

use super::body::Body;
use super::scope::{Named, Parameter};
use super::types::{BOOL, FLOAT, INT, Scalar, Ty, UINT, quarter};

const INTS: [&str; 12] = [
    "0",
    "1",
    "-1",
    "2",
    "3",
    "7i",
    "-2147483648",
    "2147483647",
    "0x7fffffffi",
    "-0x80000000",
    "65535",
    "-5",
];
const UINTS: [&str; 10] = [
    "0u",
    "1u",
    "2u",
    "3u",
    "5u",
    "4294967295u",
    "0xffffffffu",
    "2147483648u",
    "31u",
    "0x0000ff00u",
];

const FLOATS: [&str; 14] = [
    "0f", "1.0", ".5", "2.5e1f", "0x1p-1", "0x1.8p2f", "1e1", "-0.0", "3.0f", "0x0.8p0", "-16.0",
    "5E-1", "0xcp-2f", "00.25f",
];
/// Numbers with which a float is compared.
const BOUNDS: [&str; 6] =
    ["3.4028234e38f", "-3.4028234e38", "0x1.fffffep+127f", "1e-30", "1e10f", "-0x1p100"];

impl Body<'_> {
    /// An expression of a type.
    pub fn value(&mut self, ty: &Ty, depth: usize) -> String {
        if depth == 0 || self.random.chance(20) {
            return self.leaf(ty);
        }
        if self.random.chance(12)
            && let Some(call) = self.call(ty, depth - 1)
        {
            return call;
        }
        match ty {
            Ty::Scalar(Scalar::Bool) => self.condition(depth),
            Ty::Scalar(Scalar::Int | Scalar::Uint) => self.integer(ty, depth),
            Ty::Vector(_, Scalar::Int | Scalar::Uint) => self.integer(ty, depth),
            Ty::Scalar(Scalar::Float) | Ty::Vector(_, Scalar::Float) => self.float(ty, depth),
            _ => self.leaf(ty),
        }
    }

    /// A literal, a name or a constructor.
    pub fn leaf(&mut self, ty: &Ty) -> String {
        if self.random.chance(75)
            && let Some(path) = self.readable(ty)
        {
            return path;
        }
        match ty {
            Ty::Scalar(Scalar::Int) => self.random.pick(&INTS).to_string(),
            Ty::Scalar(Scalar::Uint) => self.random.pick(&UINTS).to_string(),
            Ty::Scalar(Scalar::Float) => self.float_literal(),
            Ty::Scalar(Scalar::Bool) => self.random.pick(&["true", "false"]).to_string(),
            Ty::Vector(size, scalar) => {
                let of = Ty::Scalar(*scalar);
                let count = if self.random.chance(25) { 1 } else { *size };
                let parts: Vec<String> = (0..count).map(|_| self.leaf(&of)).collect();
                format!("{}({})", ty.spelt(self.structs), parts.join(", "))
            }
            Ty::Matrix(columns, rows) => {
                let of = Ty::Vector(*rows, Scalar::Float);
                self.constructed(ty, vec![of; *columns as usize])
            }
            Ty::Array(of, count) => self.constructed(ty, vec![(**of).clone(); *count as usize]),
            Ty::Struct(index) => {
                let members = self.structs[*index].members.clone();
                self.constructed(ty, members.into_iter().map(|member| member.ty).collect())
            }
        }
    }

    /// A multiple of 1/4, in one of the forms of the grammar.
    fn float_literal(&mut self) -> String {
        match self.random.chance(30) {
            true => self.random.pick(&FLOATS).to_string(),
            false => format!("{:?}", quarter(self.random)),
        }
    }

    fn constructed(&mut self, ty: &Ty, parts: Vec<Ty>) -> String {
        if self.random.chance(15) {
            return format!("{}()", ty.spelt(self.structs));
        }
        let parts: Vec<String> = parts.iter().map(|part| self.leaf(part)).collect();
        format!("{}({})", ty.spelt(self.structs), parts.join(", "))
    }

    pub fn condition(&mut self, depth: usize) -> String {
        let depth = depth.saturating_sub(1);
        match self.random.below(8) {
            0 => format!("!({})", self.value(&BOOL, depth)),
            1 => {
                let (a, b) = (self.value(&BOOL, depth), self.value(&BOOL, depth));
                let op = *self.random.pick(&["&&", "||", "&", "|", "==", "!="]);
                format!("(({a}) {op} ({b}))")
            }
            2 => {
                let of = self.random.pick(&[Scalar::Int, Scalar::Uint, Scalar::Float]);
                let ty = Ty::Vector(2 + self.random.below(3) as u32, *of);
                let fun = *self.random.pick(&["all", "any"]);
                format!("{fun}({})", self.comparison(&ty, depth))
            }
            _ => {
                let ty = self.random.pick(&[INT, UINT, FLOAT, INT]).clone();
                self.comparison(&ty, depth)
            }
        }
    }

    fn comparison(&mut self, ty: &Ty, depth: usize) -> String {
        if *ty == FLOAT && self.random.chance(15) {
            let (value, bound) = (self.value(ty, depth), *self.random.pick(&BOUNDS));
            let op = *self.random.pick(&["<", ">"]);
            return format!("(({value}) {op} {bound})");
        }
        let (a, b) = (self.typed(ty, depth), self.typed(ty, depth));
        let op = *self.random.pick(&["<", "<=", ">", ">=", "==", "!="]);
        format!("({a} {op} {b})")
    }

    /// A value that has its type even where all of it is literals.
    fn typed(&mut self, ty: &Ty, depth: usize) -> String {
        let value = self.value(ty, depth);
        format!("{}({value})", ty.spelt(self.structs))
    }

    fn integer(&mut self, ty: &Ty, depth: usize) -> String {
        let spelt = ty.spelt(self.structs);
        let depth = depth - 1;
        let is_signed = ty.scalar() == Some(Scalar::Int);
        let a = self.computed(ty, depth);
        match self.random.below(17) {
            0..=4 => {
                let op = *self.random.pick(&["+", "-", "*", "&", "|", "^"]);
                format!("({a} {op} {})", self.typed(ty, depth))
            }
            5 | 6 => {
                let op = *self.random.pick(&["/", "%"]);
                // Of numbers alone, it may be a constant 0, which is an error.
                format!("({a} {op} {})", self.computed(ty, 0))
            }
            7 => self.shifted(ty, &a, depth),
            8 => {
                let fun = *self.random.pick(&["min", "max"]);
                format!("{fun}({a}, {})", self.typed(ty, depth))
            }
            9 => {
                let (low, high) = (self.typed(ty, 0), self.typed(ty, 0));
                format!("min(max({a}, {low}), {high})")
            }
            10 => {
                let fun = *self.random.pick(&BITS);
                format!("{fun}({a})")
            }
            11 if is_signed => {
                let fun = *self.random.pick(&["abs", "sign", "-", "~"]);
                format!("{fun}({a})")
            }
            11 => format!("~({a})"),
            12 => self.bits(ty, &a),
            13 => self.selected(ty, &a, depth),
            14 => self.converted(ty, depth),
            15 => self.packed(ty, depth).unwrap_or(a),
            _ => match ty {
                Ty::Scalar(scalar) => {
                    let of = Ty::Vector(2 + self.random.below(3) as u32, *scalar);
                    let (b, c) = (self.computed(&of, depth), self.typed(&of, depth));
                    // glslangValidator takes a product of unsigned vectors for signed in HLSL, which
                    // is then no number of either kind for an overloaded function.
                    format!("(dot({b}, {c}) | {spelt}(0))")
                }
                _ => format!("{spelt}({a})"),
            },
        }
    }

    fn shifted(&mut self, ty: &Ty, a: &str, depth: usize) -> String {
        let (by, mask) = match ty {
            Ty::Vector(size, _) => (Ty::Vector(*size, Scalar::Uint), format!("vec{size}u(31u)")),
            _ => (UINT, "31u".to_owned()),
        };
        let op = *self.random.pick(&["<<", ">>"]);
        if self.random.chance(40) {
            // A constant must be below 32; others count modulo 32.
            let by = self.computed(&by, depth);
            return format!("({a} {op} {by})");
        }
        let by = self.typed(&by, depth);
        format!("({a} {op} ({by} & {mask}))")
    }

    /// An integer that is known only while the shader runs: operations on constants must not
    /// overflow.
    pub fn computed(&mut self, ty: &Ty, depth: usize) -> String {
        if depth > 0 && self.random.chance(60) {
            return self.integer(ty, depth);
        }
        if let Some((path, _)) = self.found(ty, |one| !one.is_constant) {
            return path;
        }
        match ty.scalar() {
            Some(Scalar::Int) => format!("{}(i32(seed) - 3)", ty.spelt(self.structs)),
            _ => format!("{}(seed)", ty.spelt(self.structs)),
        }
    }

    fn bits(&mut self, ty: &Ty, a: &str) -> String {
        let offset = self.random.below(32);
        let (offset, count) = match self.random.chance(50) {
            true => (self.computed(&UINT, 0), self.random.below(33)),
            false => (format!("{offset}u"), self.random.below(33 - offset)),
        };
        match self.random.chance(50) {
            true => format!("extractBits({a}, {offset}, {count}u)"),
            false => {
                let other = self.typed(ty, 0);
                format!("insertBits({a}, {other}, {offset}, {count}u)")
            }
        }
    }

    /// Four bytes of a number, or what is computed from them.
    fn packed(&mut self, ty: &Ty, depth: usize) -> Option<String> {
        let word = |body: &mut Self| body.computed(&UINT, depth);
        let four = |scalar: Scalar| Ty::Vector(4, scalar);
        Some(match ty {
            Ty::Vector(4, Scalar::Uint) => format!("unpack4xU8({})", word(self)),
            Ty::Vector(4, Scalar::Int) => format!("unpack4xI8({})", word(self)),
            Ty::Scalar(Scalar::Uint) => match self.random.below(3) {
                0 => format!("pack4xU8({})", self.computed(&four(Scalar::Uint), depth)),
                1 => format!("pack4xI8({})", self.computed(&four(Scalar::Int), depth)),
                _ => format!("(dot4U8Packed({}, {}) | 0u)", word(self), word(self)),
            },
            Ty::Scalar(Scalar::Int) => format!("dot4I8Packed({}, {})", word(self), word(self)),
            _ => return None,
        })
    }

    fn selected(&mut self, ty: &Ty, a: &str, depth: usize) -> String {
        let b = self.typed(ty, depth);
        let condition = match ty {
            Ty::Vector(..) if self.random.chance(50) => {
                let other = ty.clone();
                self.comparison(&other, 0)
            }
            _ => self.condition(1),
        };
        format!("select({a}, {b}, {condition})")
    }

    fn converted(&mut self, ty: &Ty, depth: usize) -> String {
        let spelt = ty.spelt(self.structs);
        let from = |scalar: Scalar| match ty {
            Ty::Vector(size, _) => Ty::Vector(*size, scalar),
            _ => Ty::Scalar(scalar),
        };
        let other = if ty.scalar() == Some(Scalar::Int) { Scalar::Uint } else { Scalar::Int };
        match self.random.below(4) {
            0 => {
                let value = self.typed(&from(other), depth);
                format!("bitcast<{spelt}>({value})")
            }
            1 => {
                let value = self.typed(&from(Scalar::Float), depth);
                match self.random.chance(25) {
                    // Numbers beyond the range become the first and the last of it.
                    true => format!("{spelt}({value} * 1e30)"),
                    false => format!("{spelt}({value})"),
                }
            }
            2 => {
                let value = self.value(&from(Scalar::Bool), 0);
                format!("{spelt}({value})")
            }
            _ => {
                let value = self.typed(&from(other), depth);
                format!("{spelt}({value})")
            }
        }
    }

    fn float(&mut self, ty: &Ty, depth: usize) -> String {
        let depth = depth - 1;
        let spelt = ty.spelt(self.structs);
        let a = self.value(ty, depth);
        let exact = match self.random.below(12) {
            10 => return self.parted(ty, &a),
            11 if *ty == Ty::Vector(3, Scalar::Float) => {
                format!("cross({a}, {})", self.value(ty, 0))
            }
            0..=2 => {
                let op = *self.random.pick(&["+", "-", "*"]);
                format!("{a} {op} {}", self.value(ty, depth))
            }
            3 => {
                let fun = *self.random.pick(&["min", "max"]);
                return format!("{fun}({a}, {})", self.value(ty, depth));
            }
            4 => {
                let fun = *self.random.pick(&["abs", "floor", "ceil", "trunc", "sign", "-"]);
                return format!("{fun}({a})");
            }
            5 => return self.selected(ty, &a, depth),
            6 => {
                let of = match ty {
                    Ty::Vector(size, _) => Ty::Vector(*size, Scalar::Int),
                    _ => INT,
                };
                let value = self.typed(&of, depth);
                return format!("{spelt}({value} % {}(17))", of.spelt(self.structs));
            }
            7 => format!("fma({a}, {}, {})", self.value(ty, depth), self.value(ty, 0)),
            8 => match ty {
                Ty::Vector(size, _) => self.product(*size),
                _ => {
                    let of = Ty::Vector(2 + self.random.below(3) as u32, Scalar::Float);
                    format!("dot({}, {})", self.value(&of, depth), self.value(&of, 0))
                }
            },
            _ => format!("{a} * {:?}", [0.5, 0.25, 2.0, -1.0][self.random.below(4)]),
        };
        let (low, high) = (format!("{spelt}(-64.0)"), format!("{spelt}(63.0)"));
        let fun = *self.random.pick(&["floor", "trunc", "ceil"]);
        format!("clamp({fun}({exact}), {low}, {high})")
    }

    /// A part of a float, which is exact.
    fn parted(&mut self, ty: &Ty, a: &str) -> String {
        let last = if self.is_plain { 5 } else { 8 };
        match self.random.below(last) {
            0 => format!("modf({a}).fract"),
            1 => format!("modf({a}).whole"),
            2 => format!("fract({a})"),
            3 => format!("mix({a}, {}, 0.5)", self.value(ty, 0)),
            4 => format!("step({a}, {})", self.value(ty, 0)),
            // glslangValidator has another frexp than Direct3D, and refuses ldexp.
            5 => format!("frexp({a}).fract"),
            6 => format!("quantizeToF16({a})"),
            _ => {
                let of = Ty::Vector(3, Scalar::Int).spelt(self.structs);
                match ty {
                    Ty::Vector(3, _) => format!("ldexp({a}, {of}(1, -1, 0))"),
                    _ => format!("fract({a})"),
                }
            }
        }
    }

    /// A matrix times a vector.
    fn product(&mut self, size: u32) -> String {
        let columns = 2 + self.random.below(3) as u32;
        let matrix = self.leaf(&Ty::Matrix(columns, size));
        let vector = self.leaf(&Ty::Vector(columns, Scalar::Float));
        format!("{matrix} * {vector}")
    }

    /// A call of a function with that result.
    pub fn call(&mut self, ty: &Ty, depth: usize) -> Option<String> {
        if self.calls == 0 {
            return None;
        }
        let fitting: Vec<_> = self.functions.iter().filter(|one| one.result == *ty).collect();
        let function = (!fitting.is_empty()).then(|| (*self.random.pick(&fitting)).clone())?;
        // The arguments may have calls, too.
        self.calls -= 1;
        let mut arguments: Vec<String> = Vec::new();
        let mut taken: Vec<String> = Vec::new();
        for parameter in &function.parameters {
            arguments.push(match parameter {
                Parameter::Value(ty) => self.value(ty, depth.min(1)),
                Parameter::Place(text) => (*text).to_owned(),
                Parameter::Shared(ty) => self.pointer_to(ty, &mut Vec::new())?,
                Parameter::Pointer(ty) => self.pointer_to(ty, &mut taken)?,
            });
        }
        Some(format!("{}({})", function.name, arguments.join(", ")))
    }
}

impl Body<'_> {
    /// A pointer to a variable, other than those that are taken.
    fn pointer_to(&mut self, ty: &Ty, taken: &mut Vec<String>) -> Option<String> {
        let Named { path, root, .. } = self.whole_variable(ty, taken)?;
        taken.extend(root);
        Some(match path.strip_prefix("(*").and_then(|one| one.strip_suffix(')')) {
            Some(pointer) => pointer.to_owned(),
            None => format!("&{path}"),
        })
    }
}

const BITS: [&str; 6] = [
    "countOneBits",
    "countLeadingZeros",
    "countTrailingZeros",
    "reverseBits",
    "firstLeadingBit",
    "firstTrailingBit",
];

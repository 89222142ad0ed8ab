//! Functions of the language: WGSL's own, operators, or functions that are added.

use super::Writer;
use super::constant::refused_operand;
use super::path::has_effects;
use super::value::{Strength, Value, list_text};
use crate::builtin::functions::{ATOMICS, BARRIERS};
use crate::lexer::At;
use crate::tree::{Expr, Number, Place, Var};
use crate::types::{OpaqueKind, Scalar, Type};

/// Functions with other names in WGSL.
const RENAMED: &[(&str, &str)] = &[
    ("inversesqrt", "inverseSqrt"),
    ("roundEven", "round"),
    ("faceforward", "faceForward"),
    ("dFdx", "dpdx"),
    ("dFdy", "dpdy"),
    ("dFdxFine", "dpdxFine"),
    ("dFdyFine", "dpdyFine"),
    ("dFdxCoarse", "dpdxCoarse"),
    ("dFdyCoarse", "dpdyCoarse"),
    ("packUnorm2x16", "pack2x16unorm"),
    ("packSnorm2x16", "pack2x16snorm"),
    ("packUnorm4x8", "pack4x8unorm"),
    ("packSnorm4x8", "pack4x8snorm"),
    ("packHalf2x16", "pack2x16float"),
    ("unpackUnorm2x16", "unpack2x16unorm"),
    ("unpackSnorm2x16", "unpack2x16snorm"),
    ("unpackUnorm4x8", "unpack4x8unorm"),
    ("unpackSnorm4x8", "unpack4x8snorm"),
    ("unpackHalf2x16", "unpack2x16float"),
];

/// Functions that are operators in WGSL.
const OPERATORS: &[(&str, &str)] = &[
    ("lessThan", "<"),
    ("lessThanEqual", "<="),
    ("greaterThan", ">"),
    ("greaterThanEqual", ">="),
    ("equal", "=="),
    ("notEqual", "!="),
];

/// Functions whose arguments all have the type of the result in WGSL.
const EQUAL_ARGUMENTS: &[&str] = &["min", "max", "clamp", "mod", "step", "smoothstep"];

impl Writer<'_> {
    pub(super) fn builtin(&mut self, name: &str, arguments: &[Expr], expr: &Expr) -> Value {
        if BARRIERS.contains(&name) {
            return self.barrier(name, expr.at);
        }
        if ATOMICS.contains(&name) {
            return self.atomic(name, arguments, expr);
        }
        if matches!(name, "modf" | "frexp" | "uaddCarry" | "usubBorrow") {
            return self.two_results(name, arguments, expr);
        }
        if name.starts_with("dFd") || name.starts_with("fwidth") {
            self.derivatives = true;
        }
        let refs: Vec<&Expr> = arguments.iter().collect();
        let suffixed = self.suffixed;
        self.suffixed |= arguments.iter().all(|argument| argument.known.is_some());
        let mut values = self.operands(&refs);
        self.suffixed = suffixed;
        if let Some(index) = refused_operand(expr) {
            values[index] = self.unfolded(&arguments[index].ty, &values[index]);
        }
        let stable = values.iter().all(|value| value.stable);
        for (argument, value) in arguments.iter().zip(&mut values) {
            let wide = EQUAL_ARGUMENTS.contains(&name)
                && matches!((&argument.ty, &expr.ty), (Type::Scalar(_), Type::Vector(..)));
            if wide {
                let text = format!("{}({})", self.type_text(&expr.ty), value.text);
                *value = Value::primary(text, value.stable);
            }
        }
        let mut value = self.mapped(name, arguments, &values, expr);
        value.stable = stable;
        value
    }

    fn mapped(&mut self, name: &str, arguments: &[Expr], values: &[Value], expr: &Expr) -> Value {
        let list = list_text(values);
        let scalar = matches!(arguments.first().map(|first| &first.ty), Some(Type::Scalar(_)));
        if let Some((_, op)) = OPERATORS.iter().find(|(known, _)| *known == name) {
            let (left, right) =
                (values[0].at_least(Strength::Sum), values[1].at_least(Strength::Sum));
            let text = format!("{left} {op} {right}");
            return Value { text, strength: Strength::Relation, stable: false };
        }
        if name == "not" {
            let text = format!("!{}", values[0].at_least(Strength::Unary));
            return Value { text, strength: Strength::Unary, stable: false };
        }
        let call = match (name, arguments.len()) {
            ("atan", 2) => format!("atan2({list})"),
            ("mix", _) if arguments[2].ty.scalar() == Some(Scalar::Bool) => {
                format!("select({list})")
            }
            ("floatBitsToInt" | "floatBitsToUint" | "intBitsToFloat" | "uintBitsToFloat", _) => {
                format!("bitcast<{}>({list})", self.type_text(&expr.ty))
            }
            (_, _) if name.starts_with("bit") || name.starts_with("find") => {
                self.bits(name, values, &expr.ty)
            }
            ("length", _) if scalar => format!("abs({list})"),
            ("normalize", _) if scalar => format!("sign({list})"),
            ("mod" | "isnan" | "isinf" | "matrixCompMult" | "inverse" | "outerProduct", _) => {
                format!("{}({list})", self.added(name, arguments, &expr.ty))
            }
            ("dot" | "distance" | "reflect" | "refract" | "faceforward", _) if scalar => {
                format!("{}({list})", self.added_scalar(name))
            }
            _ => {
                let renamed = RENAMED.iter().find(|(known, _)| *known == name);
                format!("{}({list})", renamed.map_or(name, |(_, wgsl)| wgsl))
            }
        };
        Value::primary(call, false)
    }

    /// Functions of single bits.
    fn bits(&mut self, name: &str, values: &[Value], ty: &Type) -> String {
        let list = list_text(values);
        let texts: Vec<&str> = values.iter().map(|value| value.text.as_str()).collect();
        let result = self.type_text(ty);
        match name {
            "bitCount" => format!("{result}(countOneBits({list}))"),
            "findLSB" => format!("{result}(firstTrailingBit({list}))"),
            "findMSB" => format!("{result}(firstLeadingBit({list}))"),
            "bitfieldExtract" => {
                format!("extractBits({}, u32({}), u32({}))", texts[0], texts[1], texts[2])
            }
            "bitfieldInsert" => format!(
                "insertBits({}, {}, u32({}), u32({}))",
                texts[0], texts[1], texts[2], texts[3]
            ),
            _ => format!("reverseBits({list})"),
        }
    }

    /// Functions of vectors in WGSL that GLSL has for numbers too.
    fn added_scalar(&mut self, name: &str) -> String {
        match name {
            "dot" => self.helper("dot_float", "fn NAME(a: f32, b: f32) -> f32 {\n    return a * b;\n}"),
            "distance" => self.helper(
                "distance_float",
                "fn NAME(a: f32, b: f32) -> f32 {\n    return abs(a - b);\n}",
            ),
            "reflect" => self.helper(
                "reflect_float",
                "fn NAME(i: f32, n: f32) -> f32 {\n    return i - 2.0 * n * i * n;\n}",
            ),
            "refract" => self.helper(
                "refract_float",
                "fn NAME(i: f32, n: f32, eta: f32) -> f32 {\n    let k = 1.0 - eta * eta * (1.0 - n * i * n * i);\n    \
                 return select(eta * i - (eta * n * i + sqrt(max(k, 0.0))) * n, 0.0, k < 0.0);\n}",
            ),
            _ => self.helper(
                "faceforward_float",
                "fn NAME(n: f32, i: f32, r: f32) -> f32 {\n    return select(-n, n, r * i < 0.0);\n}",
            ),
        }
    }

    /// Functions that WGSL lacks.
    fn added(&mut self, name: &str, arguments: &[Expr], ty: &Type) -> String {
        let argument = self.type_text(&arguments[0].ty);
        let result = self.type_text(ty);
        let size = arguments[0].ty.components();
        let title = if size > 1 && name != "inverse" {
            format!("{}_{argument}", plain_title(name))
        } else {
            plain_title(name).to_owned()
        };
        match name {
            "mod" => {
                // Both arguments have the result's type.
                let title = format!("mod_{result}");
                self.helper_for(&title, "", |name| {
                    format!(
                        "fn {name}(x: {result}, y: {result}) -> {result} {{\n    \
                         return x - y * floor(x / y);\n}}"
                    )
                })
            }
            "isnan" | "isinf" => {
                let op = if name == "isnan" { ">" } else { "==" };
                let bits = self.type_text(&arguments[0].ty.with_scalar(Scalar::Uint));
                self.helper_for(&title, "", |name| {
                    format!(
                        "fn {name}(x: {argument}) -> {result} {{\n    return \
                         (bitcast<{bits}>(x) & {bits}(0x7fffffffu)) {op} {bits}(0x7f800000u);\n}}"
                    )
                })
            }
            "matrixCompMult" | "outerProduct" => self.added_product(name, arguments, ty),
            _ => {
                let text = match ty {
                    Type::Matrix(_, 2, _) => INVERSE_2,
                    Type::Matrix(_, 3, _) => INVERSE_3,
                    _ => INVERSE_4,
                };
                self.helper(&format!("inverse_{result}"), text)
            }
        }
    }

    /// Products of matrices and vectors that WGSL lacks.
    fn added_product(&mut self, name: &str, arguments: &[Expr], ty: &Type) -> String {
        let Type::Matrix(_, columns, _) = ty else { return String::new() };
        let result = self.type_text(ty);
        let (left, right) = (self.type_text(&arguments[0].ty), self.type_text(&arguments[1].ty));
        let parts: Vec<String> = (0..*columns)
            .map(|at| match name {
                "outerProduct" => format!("a * b[{at}]"),
                _ => format!("a[{at}] * b[{at}]"),
            })
            .collect();
        let title = match name {
            "outerProduct" => format!("outer_product_{result}"),
            _ => format!("matrix_comp_mult_{result}"),
        };
        self.helper_for(&title, "", |name| {
            format!(
                "fn {name}(a: {left}, b: {right}) -> {result} {{\n    return {result}({});\n}}",
                parts.join(", ")
            )
        })
    }

    /// Functions with a second result: WGSL gives structures.
    fn two_results(&mut self, name: &str, arguments: &[Expr], expr: &Expr) -> Value {
        let count = arguments.len() - 1;
        let refs: Vec<&Expr> = arguments[..count].iter().collect();
        let at = expr.at;
        let mut values = self.operands(&refs);
        if has_effects(&arguments[count], self.shader) {
            for value in &mut values {
                *value = Value::primary(self.kept(at, value), true);
            }
        }
        let target = self.with_kept_indices(&arguments[count]);
        let result = self.temporary();
        let (second, first) = match name {
            "modf" | "frexp" => {
                self.line(at, format!("let {result} = {name}({});", values[0].text));
                let member = if name == "modf" { "whole" } else { "exp" };
                (format!("{result}.{member}"), format!("{result}.fract"))
            }
            _ => {
                let a = self.kept(at, &values[0]);
                let b = self.kept(at, &values[1]);
                let op = if name == "uaddCarry" { "+" } else { "-" };
                self.line(at, format!("let {result} = {a} {op} {b};"));
                let ty = self.type_text(&expr.ty);
                let compared = if name == "uaddCarry" {
                    format!("{result} < {a}")
                } else {
                    format!("{a} < {b}")
                };
                (format!("select({ty}(0u), {ty}(1u), {compared})"), result)
            }
        };
        self.write_back(&target, &second);
        Value::primary(first, true)
    }

    /// A barrier for the memory of the workgroup, and for buffers and images if there are any.
    fn barrier(&mut self, name: &str, at: At) -> Value {
        if name != "barrier" {
            self.refuse(at, format!("`{name}` has a counterpart in WGSL only beside `barrier()`"));
        }
        let vars = &self.shader.vars;
        if vars.iter().any(|var| var.place == Place::StorageBlock) {
            self.line(at, "storageBarrier();");
        }
        let is_shared_image = |var: &Var| {
            let is_image = matches!(var.ty.innermost(), Type::Opaque(opaque) if opaque.kind == OpaqueKind::Image);
            is_image && !var.access.readonly && !var.access.writeonly
        };
        if vars.iter().any(is_shared_image) {
            self.line(at, "textureBarrier();");
        }
        Value::primary("workgroupBarrier()", false)
    }

    /// The place in memory and the other values of an atomic function.
    fn atomic_parts(&mut self, arguments: &[Expr], expr: &Expr) -> Option<(String, Vec<Value>)> {
        let effects = arguments.iter().any(|argument| has_effects(argument, self.shader));
        let target = self.settled(&arguments[0], effects);
        let Some(path) = self.path(&target) else {
            self.refuse(expr.at, "an atomic function takes a variable in memory");
            return None;
        };
        let refs: Vec<&Expr> = arguments[1..].iter().collect();
        let values = self.operands(&refs);
        if *path.mem != super::memory::Mem::Atomic {
            self.refuse(arguments[0].at, "this member is not atomic in WGSL");
        }
        Some((path.text, values))
    }

    /// An atomic function whose value nothing reads. Returns whether it has such a form.
    pub(super) fn atomic_effect(&mut self, name: &str, arguments: &[Expr], expr: &Expr) -> bool {
        let has_form = name.starts_with("atomic") && name != "atomicCompSwap";
        if has_form && let Some((place, values)) = self.atomic_parts(arguments, expr) {
            self.line(expr.at, format!("{name}(&{place}, {});", values[0].text));
        }
        has_form
    }

    fn atomic(&mut self, name: &str, arguments: &[Expr], expr: &Expr) -> Value {
        let Some((place, values)) = self.atomic_parts(arguments, expr) else {
            return Value::primary("0", true);
        };
        let result = self.temporary();
        if name != "atomicCompSwap" {
            self.line(expr.at, format!("let {result} = {name}(&{place}, {});", values[0].text));
            return Value::primary(result, true);
        }
        // WGSL's exchange may fail without a reason, so it is tried again.
        let ty = self.type_text(&expr.ty);
        let (wanted, new) = (self.kept(expr.at, &values[0]), self.kept(expr.at, &values[1]));
        let tried = self.temporary();
        self.line(expr.at, format!("var {result}: {ty};"));
        let ((), body) = self.capture(|writer| {
            let call = format!("atomicCompareExchangeWeak(&{place}, {wanted}, {new})");
            writer.line(expr.at, format!("let {tried} = {call};"));
            writer.line(expr.at, format!("{result} = {tried}.old_value;"));
            let done = format!("{tried}.exchanged || {tried}.old_value != {wanted}");
            writer.line(expr.at, format!("if {done} {{ break; }}"));
        });
        self.line(expr.at, "loop {");
        self.lines.nest(body);
        self.line(expr.at, "}");
        Value::primary(result, true)
    }

    /// A number of a constant argument.
    pub(super) fn constant_of(expr: &Expr) -> Option<Number> {
        match expr.known.as_deref() {
            Some([number]) => Some(*number),
            _ => None,
        }
    }
}

fn plain_title(name: &str) -> &str {
    match name {
        "isnan" => "is_nan",
        "isinf" => "is_inf",
        other => other,
    }
}

const INVERSE_2: &str = "fn NAME(m: mat2x2f) -> mat2x2f {
    let scale = 1.0 / (m[0].x * m[1].y - m[1].x * m[0].y);
    return mat2x2f(m[1].y, -m[0].y, -m[1].x, m[0].x) * scale;
}";

const INVERSE_3: &str = "fn NAME(m: mat3x3f) -> mat3x3f {
    let x = cross(m[1], m[2]);
    let y = cross(m[2], m[0]);
    let z = cross(m[0], m[1]);
    return transpose(mat3x3f(x, y, z)) * (1.0 / dot(m[0], x));
}";

const INVERSE_4: &str = "fn NAME(m: mat4x4f) -> mat4x4f {
    let a = m[0].x * m[1].y - m[0].y * m[1].x;
    let b = m[0].x * m[1].z - m[0].z * m[1].x;
    let c = m[0].x * m[1].w - m[0].w * m[1].x;
    let d = m[0].y * m[1].z - m[0].z * m[1].y;
    let e = m[0].y * m[1].w - m[0].w * m[1].y;
    let f = m[0].z * m[1].w - m[0].w * m[1].z;
    let g = m[2].x * m[3].y - m[2].y * m[3].x;
    let h = m[2].x * m[3].z - m[2].z * m[3].x;
    let i = m[2].x * m[3].w - m[2].w * m[3].x;
    let j = m[2].y * m[3].z - m[2].z * m[3].y;
    let k = m[2].y * m[3].w - m[2].w * m[3].y;
    let l = m[2].z * m[3].w - m[2].w * m[3].z;
    let scale = 1.0 / (a * l - b * k + c * j + d * i - e * h + f * g);
    return mat4x4f(
        m[1].y * l - m[1].z * k + m[1].w * j,
        m[0].z * k - m[0].y * l - m[0].w * j,
        m[3].y * f - m[3].z * e + m[3].w * d,
        m[2].z * e - m[2].y * f - m[2].w * d,
        m[1].z * i - m[1].x * l - m[1].w * h,
        m[0].x * l - m[0].z * i + m[0].w * h,
        m[3].z * c - m[3].x * f - m[3].w * b,
        m[2].x * f - m[2].z * c + m[2].w * b,
        m[1].x * k - m[1].y * i + m[1].w * g,
        m[0].y * i - m[0].x * k - m[0].w * g,
        m[3].x * e - m[3].y * c + m[3].w * a,
        m[2].y * c - m[2].x * e - m[2].w * a,
        m[1].y * h - m[1].x * j - m[1].z * g,
        m[0].x * j - m[0].y * h + m[0].z * g,
        m[3].y * b - m[3].x * d - m[3].z * a,
        m[2].x * d - m[2].y * b + m[2].z * a,
    ) * scale;
}";

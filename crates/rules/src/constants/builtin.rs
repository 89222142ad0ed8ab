//! Operators and built-in functions of constants, as the sections "Expressions" and "Built-in
//! Functions" of the WGSL specification (W3C) define them. Each is computed in f64 and rounded once
//! to its type, which is within the accuracy that the specification asks for.

use half::f16;

use super::LARGEST_F16;
use super::value::{Kind, Shape, Value};

/// `-`, `!` and `~`.
pub fn unary(operator: &str, operand: &Value) -> Option<Value> {
    let kind = operand.kind;
    let apply: fn(Kind, f64) -> f64 = match operator {
        "-" if kind != Kind::Bool && kind != Kind::U32 => |_, part| -part,
        "!" if kind == Kind::Bool => |_, part| 1.0 - part,
        "~" if kind == Kind::U32 => |_, part| f64::from(!(part as u32)),
        "~" if kind.is_int() => |_, part| !(part as i64) as f64,
        _ => return None,
    };
    map(operand, |part| Some(apply(kind, part)))
}

/// An operator between two operands. `&&` and `||` need the right one only sometimes.
pub fn binary(
    operator: &str,
    left: &Value,
    right: impl FnOnce() -> Option<Value>,
) -> Option<Value> {
    if let "&&" | "||" = operator {
        let first = left.number().filter(|_| left.kind == Kind::Bool)? != 0.0;
        return match first == (operator == "||") {
            true => Some(left.clone()),
            false => right().filter(|value| value.kind == Kind::Bool && value.number().is_some()),
        };
    }
    let right = right()?;
    if let "<<" | ">>" = operator {
        return shift(operator, left, &right);
    }
    let kind = left.kind.common(right.kind)?;
    let (left, right) = (left.converted(kind)?, right.converted(kind)?);
    let shape = match (left.shape, right.shape) {
        (one, other) if one == other => one,
        (Shape::Scalar, other) if is_spread(operator, other) => other,
        (one, Shape::Scalar) if is_spread(operator, one) => one,
        _ => return None,
    };
    if matches!(shape, Shape::Matrix(..)) && left.shape == right.shape && operator == "*" {
        return None;
    }
    let result = if compares(operator) { Kind::Bool } else { kind };
    let pairs = spread(&left, shape).into_iter().zip(spread(&right, shape));
    let parts: Option<Vec<f64>> =
        pairs.map(|(left, right)| operate(operator, kind, left, right)).collect();
    Value::new(result, shape, &parts?)
}

/// Whether a number beside a vector or a matrix stands for one of that number.
fn is_spread(operator: &str, shape: Shape) -> bool {
    match shape {
        Shape::Matrix(..) => operator == "*",
        Shape::Scalar | Shape::Vector(_) => matches!(operator, "+" | "-" | "*" | "/" | "%"),
    }
}

fn compares(operator: &str) -> bool {
    matches!(operator, "==" | "!=" | "<" | "<=" | ">" | ">=")
}

fn operate(operator: &str, kind: Kind, left: f64, right: f64) -> Option<f64> {
    let truth = |is: bool| Some(f64::from(u8::from(is)));
    match operator {
        "==" => return truth(left == right),
        "!=" => return truth(left != right),
        _ => {}
    }
    if kind == Kind::Bool {
        return match operator {
            "&" => truth(left != 0.0 && right != 0.0),
            "|" => truth(left != 0.0 || right != 0.0),
            _ => None,
        };
    }
    let bits =
        |apply: fn(i64, i64) -> i64| kind.is_int().then(|| apply(left as i64, right as i64) as f64);
    match operator {
        "<" => truth(left < right),
        "<=" => truth(left <= right),
        ">" => truth(left > right),
        ">=" => truth(left >= right),
        "+" => Some(left + right),
        "-" => Some(left - right),
        "*" => Some(left * right),
        "/" | "%" if right == 0.0 => None,
        "/" if kind.is_int() => Some((left / right).trunc()),
        "/" => Some(left / right),
        "%" => Some(left % right),
        "&" => bits(|left, right| left & right),
        "|" => bits(|left, right| left | right),
        "^" => bits(|left, right| left ^ right),
        _ => None,
    }
}

/// `<<` and `>>`, where no bit is lost.
fn shift(operator: &str, left: &Value, right: &Value) -> Option<Value> {
    let is_right = left.kind.is_int() && matches!(right.kind, Kind::U32 | Kind::AbstractInt);
    if !is_right || left.shape != right.shape {
        return None;
    }
    let parts: Option<Vec<f64>> = left
        .parts
        .iter()
        .zip(&right.parts)
        .map(|(left, right)| {
            let by = (0.0..32.0).contains(right).then(|| 2f64.powf(*right))?;
            Some(if operator == "<<" { left * by } else { (left / by).floor() })
        })
        .collect();
    Value::new(left.kind, left.shape, &parts?)
}

fn map(value: &Value, apply: impl Fn(f64) -> Option<f64>) -> Option<Value> {
    let parts: Option<Vec<f64>> = value.parts.iter().map(|part| apply(*part)).collect();
    Value::new(value.kind, value.shape, &parts?)
}

/// The numbers of a value; a scalar stands for each of a shape.
fn spread(value: &Value, shape: Shape) -> Vec<f64> {
    match value.shape {
        Shape::Scalar => vec![value.parts[0]; shape.count()],
        Shape::Vector(_) | Shape::Matrix(..) => value.parts.clone(),
    }
}

/// The result of a built-in function; `None` where it has none, and for functions that naga itself
/// computes and that are rare in the arguments of others.
pub fn call(name: &str, values: &[Value]) -> Option<Value> {
    if let Some(apply) = of_one(name) {
        let [value] = common(values)?;
        return map(&value, apply);
    }
    match name {
        "transpose" | "determinant" => matrix(name, values),
        "extractBits" | "insertBits" => bits(name, values),
        "ldexp" => ldexp(values),
        "dot" | "length" | "distance" | "normalize" | "cross" | "reflect" | "refract"
        | "faceForward" => geometry(name, values),
        _ if name.starts_with("pack") => pack(name, values),
        _ if name.starts_with("unpack") => unpack(name, values),
        _ => of_several(name, values),
    }
}

/// Functions that take each number of a value alone.
fn of_one(name: &str) -> Option<fn(f64) -> Option<f64>> {
    Some(match name {
        "abs" => |x| Some(x.abs()),
        "acos" => |x| Some(x.acos()),
        "asin" => |x| Some(x.asin()),
        "atan" => |x| Some(x.atan()),
        "ceil" => |x| Some(x.ceil()),
        "cos" => |x| Some(x.cos()),
        "degrees" => |x| Some(x.to_degrees()),
        "exp" => |x| Some(x.exp()),
        "exp2" => |x| Some(x.exp2()),
        "floor" => |x| Some(x.floor()),
        "fract" => |x| Some(x - x.floor()),
        "inverseSqrt" => |x| (x > 0.0).then(|| 1.0 / x.sqrt()),
        "log" => |x| (x > 0.0).then(|| x.ln()),
        "log2" => |x| (x > 0.0).then(|| x.log2()),
        "quantizeToF16" => |x| (x.abs() <= LARGEST_F16).then(|| Kind::F16.round(x)).flatten(),
        "radians" => |x| Some(x.to_radians()),
        "round" => |x| Some(x.round_ties_even()),
        "saturate" => |x| Some(x.clamp(0.0, 1.0)),
        "sign" => |x| Some(if x == 0.0 { 0.0 } else { x.signum() }),
        "sin" => |x| Some(x.sin()),
        "sqrt" => |x| (x >= 0.0).then(|| x.sqrt()),
        "tan" => |x| Some(x.tan()),
        "trunc" => |x| Some(x.trunc()),
        _ => return None,
    })
}

/// Functions that take the numbers of several values together, one of each.
fn of_several(name: &str, values: &[Value]) -> Option<Value> {
    let apply: fn(&[f64]) -> Option<f64> = match (name, values.len()) {
        ("min", 2) => |x| Some(x[0].min(x[1])),
        ("max", 2) => |x| Some(x[0].max(x[1])),
        ("pow", 2) => |x| (x[0] >= 0.0).then(|| x[0].powf(x[1])),
        ("step", 2) => |x| Some(f64::from(u8::from(x[0] <= x[1]))),
        ("atan2", 2) => |x| Some(x[0].atan2(x[1])),
        ("clamp", 3) => |x| (x[1] <= x[2]).then(|| x[0].clamp(x[1], x[2])),
        ("fma", 3) => |x| Some(x[0].mul_add(x[1], x[2])),
        ("mix", 3) => |x| Some(x[0] * (1.0 - x[2]) + x[1] * x[2]),
        ("smoothstep", 3) => |x| {
            let t = ((x[2] - x[0]) / (x[1] - x[0])).clamp(0.0, 1.0);
            (x[0] != x[1]).then_some(t * t * (3.0 - 2.0 * t))
        },
        _ => return None,
    };
    let is_of_floats = !matches!(name, "min" | "max" | "clamp");
    let kind = common_kind(values, is_of_floats)?;
    let shape = values.first()?.shape;
    // Only the last argument of `mix` may be one number for all.
    let has_shape = |(at, value): (usize, &Value)| {
        value.shape == shape || name == "mix" && at == 2 && value.shape == Shape::Scalar
    };
    if matches!(shape, Shape::Matrix(..)) || !values.iter().enumerate().all(has_shape) {
        return None;
    }
    let columns: Option<Vec<Vec<f64>>> =
        values.iter().map(|value| Some(spread(&value.converted(kind)?, shape))).collect();
    let columns = columns?;
    let row = |at: usize| -> Vec<f64> { columns.iter().map(|column| column[at]).collect() };
    let parts: Option<Vec<f64>> = (0..shape.count()).map(|at| apply(&row(at))).collect();
    Value::new(kind, shape, &parts?)
}

/// The kind to which all values convert.
fn common_kind(values: &[Value], is_of_floats: bool) -> Option<Kind> {
    let first = values.first()?.kind;
    let kind = values.iter().try_fold(first, |kind, value| kind.common(value.kind))?;
    match kind {
        Kind::AbstractInt if is_of_floats => Some(Kind::AbstractFloat),
        Kind::Bool => None,
        kind => (kind.is_float() || !is_of_floats).then_some(kind),
    }
}

/// So many values of floating-point numbers, of one kind.
fn common<const COUNT: usize>(values: &[Value]) -> Option<[Value; COUNT]> {
    let kind = common_kind(values, true)?;
    let values: Option<Vec<Value>> = values.iter().map(|value| value.converted(kind)).collect();
    values?.try_into().ok()
}

/// The sum of products, each of which is of the kind, as each sum is.
fn dot(left: &Value, right: &Value) -> Option<f64> {
    let mut pairs = left.parts.iter().zip(&right.parts);
    pairs.try_fold(0.0, |sum, (one, other)| left.kind.round(sum + left.kind.round(one * other)?))
}

fn geometry(name: &str, values: &[Value]) -> Option<Value> {
    let kind = common_kind(values, true)?;
    let values: Option<Vec<Value>> = values.iter().map(|value| value.converted(kind)).collect();
    let values = values?;
    let vectors = &values[..values.len().min(if name == "refract" { 2 } else { 3 })];
    let shape = vectors.first()?.shape;
    let is_vector = |value: &Value| value.shape == shape;
    let has_scalars = matches!(name, "length" | "distance");
    if !vectors.iter().all(is_vector) || !matches!(shape, Shape::Vector(_)) && !has_scalars {
        return None;
    }
    let of_parts = |apply: &dyn Fn(usize) -> f64| {
        let parts: Vec<f64> = (0..shape.count()).map(apply).collect();
        Value::new(kind, shape, &parts)
    };
    match (name, values.as_slice()) {
        ("dot", [one, other]) => Value::scalar(kind, dot(one, other)?),
        ("length", [one]) => Value::scalar(kind, dot(one, one)?.sqrt()),
        ("distance", [one, other]) => {
            let difference = of_parts(&|at| one.parts[at] - other.parts[at])?;
            Value::scalar(kind, dot(&difference, &difference)?.sqrt())
        }
        ("normalize", [one]) => {
            let length = dot(one, one)?.sqrt();
            of_parts(&|at| one.parts[at] / length)
        }
        ("cross", [one, other]) if shape == Shape::Vector(3) => of_parts(&|at| {
            let (next, last) = ((at + 1) % 3, (at + 2) % 3);
            one.parts[next] * other.parts[last] - one.parts[last] * other.parts[next]
        }),
        ("reflect", [ray, normal]) => {
            let along = dot(normal, ray)?;
            of_parts(&|at| ray.parts[at] - 2.0 * along * normal.parts[at])
        }
        ("faceForward", [one, ray, normal]) => {
            let sign = if dot(ray, normal)? < 0.0 { 1.0 } else { -1.0 };
            of_parts(&|at| sign * one.parts[at])
        }
        ("refract", [ray, normal, ratio]) => {
            let ratio = ratio.number()?;
            let along = dot(normal, ray)?;
            let rest = 1.0 - ratio * ratio * (1.0 - along * along);
            let part = |at: usize| {
                ratio * ray.parts[at] - (ratio * along + rest.sqrt()) * normal.parts[at]
            };
            of_parts(&|at| if rest < 0.0 { 0.0 } else { part(at) })
        }
        _ => None,
    }
}

fn matrix(name: &str, values: &[Value]) -> Option<Value> {
    let [value] = values else { return None };
    let Shape::Matrix(columns, rows) = value.shape else { return None };
    let at = |column: usize, row: usize| value.parts[column * rows + row];
    if name == "transpose" {
        let parts: Vec<f64> = (0..rows)
            .flat_map(|row| (0..columns).map(move |column| (column, row)))
            .map(|(column, row)| at(column, row))
            .collect();
        return Value::new(value.kind, Shape::Matrix(rows, columns), &parts);
    }
    let size: Vec<usize> = (0..columns).collect();
    (columns == rows).then(|| Value::scalar(value.kind, determinant(&at, 0, &size))).flatten()
}

/// The determinant of some rows from a column on, by the column's cofactors.
fn determinant(at: &dyn Fn(usize, usize) -> f64, column: usize, rows: &[usize]) -> f64 {
    if rows.is_empty() {
        return 1.0;
    }
    let cofactor = |(place, row): (usize, &usize)| {
        let others: Vec<usize> = rows.iter().copied().filter(|other| other != row).collect();
        let sign = if place.is_multiple_of(2) { 1.0 } else { -1.0 };
        sign * at(column, *row) * determinant(at, column + 1, &others)
    };
    rows.iter().enumerate().map(cofactor).sum()
}

/// `ldexp`. Its exponents are of another type than its numbers.
fn ldexp(values: &[Value]) -> Option<Value> {
    let [number, exponent] = values else { return None };
    let number = number.converted(number.kind.common(Kind::AbstractFloat)?)?;
    if number.shape != exponent.shape || !matches!(exponent.kind, Kind::I32 | Kind::AbstractInt) {
        return None;
    }
    let pairs = number.parts.iter().zip(&exponent.parts);
    // In two steps, since a power alone may be out of range.
    let scaled = |(part, exponent): (&f64, &f64)| {
        let half = (exponent / 2.0).trunc();
        part * 2f64.powf(half) * 2f64.powf(exponent - half)
    };
    let parts: Vec<f64> = pairs.map(scaled).collect();
    Value::new(number.kind, number.shape, &parts)
}

/// `extractBits` and `insertBits`, whose last arguments count bits.
fn bits(name: &str, values: &[Value]) -> Option<Value> {
    let (numbers, [offset, count]) = values.split_at_checked(values.len().checked_sub(2)?)? else {
        return None;
    };
    let kind = match common_kind(numbers, false)? {
        Kind::AbstractInt => Kind::I32,
        kind => kind,
    };
    let number = |value: &Value| value.converted(Kind::U32)?.number().map(|part| part as u32);
    let (offset, count) = (number(offset)?, number(count)?);
    if !kind.is_int() || offset.checked_add(count)? > 32 {
        return None;
    }
    let mask = ((1u64 << count) - 1) as u32;
    let word = |part: f64| if kind == Kind::U32 { part as u32 } else { part as i32 as u32 };
    let part = |word: u32| match kind {
        Kind::U32 => f64::from(word),
        _ => f64::from(word as i32),
    };
    let extracted = |value: f64| {
        let found = (u64::from(word(value)) >> offset) as u32 & mask;
        let is_negative = kind == Kind::I32 && count > 0 && found >> (count - 1) & 1 == 1;
        Some(part(if is_negative { found | !mask } else { found }))
    };
    match (name, numbers) {
        ("extractBits", [value]) => map(&value.converted(kind)?, extracted),
        ("insertBits", [value, new]) if value.shape == new.shape => {
            let (value, new) = (value.converted(kind)?, new.converted(kind)?);
            let place = (u64::from(mask) << offset) as u32;
            let pairs = value.parts.iter().zip(&new.parts);
            let inserted = |(value, new): (&f64, &f64)| {
                let moved = (u64::from(word(*new)) << offset) as u32;
                part(word(*value) & !place | moved & place)
            };
            Value::new(kind, value.shape, &pairs.map(inserted).collect::<Vec<f64>>())
        }
        _ => None,
    }
}

/// How a function packs numbers into a word: the bits of each, and the word of one number.
type Packing = (u32, Kind, fn(f64) -> Option<u32>);

fn packing(name: &str) -> Option<Packing> {
    Some(match name {
        "4x8snorm" => {
            (8, Kind::F32, |x| Some((0.5 + 127.0 * x.clamp(-1.0, 1.0)).floor() as i32 as u32))
        }
        "4x8unorm" => (8, Kind::F32, |x| Some((0.5 + 255.0 * x.clamp(0.0, 1.0)).floor() as u32)),
        "2x16snorm" => {
            (16, Kind::F32, |x| Some((0.5 + 32767.0 * x.clamp(-1.0, 1.0)).floor() as i32 as u32))
        }
        "2x16unorm" => {
            (16, Kind::F32, |x| Some((0.5 + 65535.0 * x.clamp(0.0, 1.0)).floor() as u32))
        }
        "2x16float" => (16, Kind::F32, |x| {
            (x.abs() <= LARGEST_F16).then(|| u32::from(f16::from_f64(x).to_bits()))
        }),
        "4xI8" => (8, Kind::I32, |x| Some(x as i32 as u32)),
        "4xU8" => (8, Kind::U32, |x| Some(x as u32)),
        "4xI8Clamp" => (8, Kind::I32, |x| Some(x.clamp(-128.0, 127.0) as i32 as u32)),
        "4xU8Clamp" => (8, Kind::U32, |x| Some(x.clamp(0.0, 255.0) as u32)),
        _ => return None,
    })
}

fn pack(name: &str, values: &[Value]) -> Option<Value> {
    let (width, kind, word) = packing(name.strip_prefix("pack")?)?;
    let [value] = values else { return None };
    let value = value.converted(kind)?;
    if value.shape != Shape::Vector(32 / width as usize) {
        return None;
    }
    let mask = (1u32 << width) - 1;
    let mut packed = 0;
    for (at, part) in value.parts.iter().enumerate() {
        packed |= (word(*part)? & mask) << (width * at as u32);
    }
    Value::scalar(Kind::U32, f64::from(packed))
}

fn unpack(name: &str, values: &[Value]) -> Option<Value> {
    let [value] = values else { return None };
    let word = value.converted(Kind::U32)?.number()? as u32;
    let signed = |bits: u32, width: u32| f64::from((bits << (32 - width)) as i32 >> (32 - width));
    let (width, kind, part): (u32, Kind, &dyn Fn(u32) -> f64) = match name.strip_prefix("unpack")? {
        "4x8snorm" => (8, Kind::F32, &|bits| (signed(bits, 8) / 127.0).max(-1.0)),
        "4x8unorm" => (8, Kind::F32, &|bits| f64::from(bits) / 255.0),
        "2x16snorm" => (16, Kind::F32, &|bits| (signed(bits, 16) / 32767.0).max(-1.0)),
        "2x16unorm" => (16, Kind::F32, &|bits| f64::from(bits) / 65535.0),
        "2x16float" => (16, Kind::F32, &|bits| f16::from_bits(bits as u16).to_f64()),
        "4xI8" => (8, Kind::I32, &|bits| signed(bits, 8)),
        "4xU8" => (8, Kind::U32, &|bits| f64::from(bits)),
        _ => return None,
    };
    let count = 32 / width;
    let parts: Vec<f64> =
        (0..count).map(|at| part(word >> (width * at) & ((1 << width) - 1))).collect();
    Value::new(kind, Shape::Vector(count as usize), &parts)
}

/// A member of what `modf` and `frexp` return.
pub fn part_of(function: &str, member: &str, value: &Value) -> Option<Value> {
    let value = value.converted(common_kind(std::slice::from_ref(value), true)?)?;
    match (function, member) {
        ("modf", "whole") => map(&value, |part| Some(part.trunc())),
        ("modf", "fract") => map(&value, |part| Some(part - part.trunc())),
        ("frexp", "fract") => map(&value, |part| Some(split(part).0)),
        ("frexp", "exp") => {
            let kind =
                if value.kind == Kind::AbstractFloat { Kind::AbstractInt } else { Kind::I32 };
            let parts: Vec<f64> = value.parts.iter().map(|part| split(*part).1).collect();
            Value::new(kind, value.shape, &parts)
        }
        _ => None,
    }
}

/// A number as one in 0.5..1 (or 0) times a power of two.
fn split(number: f64) -> (f64, f64) {
    if number == 0.0 {
        return (number, 0.0);
    }
    // The first guess is off by at most one, where the logarithm is rounded or the number tiny.
    let mut exponent = number.abs().log2().floor() + 1.0;
    let mut fract = number / 2f64.powf(exponent);
    if fract.abs() >= 1.0 {
        (fract, exponent) = (fract / 2.0, exponent + 1.0);
    } else if fract.abs() < 0.5 {
        (fract, exponent) = (fract * 2.0, exponent - 1.0);
    }
    (fract, exponent)
}

//! What the language's functions give for constants.

use crate::tree::{Expr, Known, Number};

/// The value of a function of the language with known arguments, for the functions that sizes and
/// tables are made of.
pub(crate) fn called(name: &str, arguments: &[Expr]) -> Option<Known> {
    let known: Vec<&Known> =
        arguments.iter().map(|argument| argument.known.as_ref()).collect::<Option<_>>()?;
    if let Some(value) = of_vectors(name, &known) {
        return Some(value);
    }
    let count = known.iter().map(|numbers| numbers.len()).max()?;
    let at = |numbers: &Known, index: usize| {
        if numbers.len() == 1 { Some(numbers[0]) } else { numbers.get(index).copied() }
    };
    (0..count)
        .map(|index| {
            let row: Option<Vec<Number>> = known.iter().map(|known| at(known, index)).collect();
            called_number(name, &row?)
        })
        .collect()
}

fn called_number(name: &str, row: &[Number]) -> Option<Number> {
    match row {
        [Number::Float(a)] => one_float(name, *a).map(Number::Float),
        [Number::Int(a)] => match name {
            "abs" => Some(Number::Int(a.wrapping_abs())),
            "intBitsToFloat" => Some(Number::Float(f32::from_bits(*a as u32))),
            _ => None,
        },
        [Number::Uint(a)] if name == "uintBitsToFloat" => Some(Number::Float(f32::from_bits(*a))),
        [Number::Float(a), Number::Int(b)] if name == "ldexp" => {
            Some(Number::Float(scaled(*a, *b)))
        }
        [Number::Int(a), Number::Int(b)] => of_pair(name, *a, *b).map(Number::Int),
        [Number::Uint(a), Number::Uint(b)] => of_pair(name, *a, *b).map(Number::Uint),
        [Number::Int(a), Number::Int(b), Number::Int(c)] if name == "clamp" => {
            Some(Number::Int(*a.max(b).min(c)))
        }
        [Number::Uint(a), Number::Uint(b), Number::Uint(c)] if name == "clamp" => {
            Some(Number::Uint(*a.max(b).min(c)))
        }
        [Number::Float(a), Number::Float(b)] => two_floats(name, *a, *b).map(Number::Float),
        [Number::Float(a), Number::Float(b), Number::Float(c)] => {
            let value = match name {
                "clamp" => a.max(*b).min(*c),
                "mix" => a * (1.0 - c) + b * c,
                "fma" => a * b + c,
                _ => return None,
            };
            Some(Number::Float(value))
        }
        _ => None,
    }
}

fn one_float(name: &str, a: f32) -> Option<f32> {
    Some(match name {
        "radians" => a.to_radians(),
        "degrees" => a.to_degrees(),
        "sin" => a.sin(),
        "cos" => a.cos(),
        "tan" => a.tan(),
        "sinh" => a.sinh(),
        "cosh" => a.cosh(),
        "tanh" => a.tanh(),
        "asinh" => a.asinh(),
        "acosh" => a.acosh(),
        "atanh" => a.atanh(),
        "asin" => a.asin(),
        "acos" => a.acos(),
        "atan" => a.atan(),
        "exp" => a.exp(),
        "log" => a.ln(),
        "exp2" => a.exp2(),
        "log2" => a.log2(),
        "sqrt" => a.sqrt(),
        "inversesqrt" => 1.0 / a.sqrt(),
        "abs" => a.abs(),
        "floor" => a.floor(),
        "ceil" => a.ceil(),
        "trunc" => a.trunc(),
        "fract" => a - a.floor(),
        _ => return None,
    })
}

fn two_floats(name: &str, a: f32, b: f32) -> Option<f32> {
    Some(match name {
        "min" => a.min(b),
        "max" => a.max(b),
        "pow" => a.powf(b),
        "mod" => a - b * (a / b).floor(),
        "atan" => a.atan2(b),
        "step" => f32::from(u8::from(b >= a)),
        _ => return None,
    })
}

fn of_pair<N: Ord>(name: &str, a: N, b: N) -> Option<N> {
    match name {
        "min" => Some(a.min(b)),
        "max" => Some(a.max(b)),
        _ => None,
    }
}

/// `a * 2^exponent`, in steps that do not overflow before their product does.
fn scaled(a: f32, exponent: i32) -> f32 {
    let step = exponent.clamp(-600, 600) / 2;
    let rest = exponent.clamp(-600, 600) - step;
    (f64::from(a) * f64::from(step).exp2() * f64::from(rest).exp2()) as f32
}

/// Functions of whole vectors and matrices, and of bits that are two numbers. Squares and products are
/// those of `f32`, which overflow as on a GPU.
fn of_vectors(name: &str, known: &[&Known]) -> Option<Known> {
    let floats = |numbers: &Known| -> Option<Vec<f32>> {
        let float = |number: &Number| match number {
            Number::Float(value) => Some(*value),
            _ => None,
        };
        numbers.iter().map(float).collect()
    };
    if let ("unpackHalf2x16", [Number::Uint(bits)]) = (name, &known[0][..]) {
        let half = |bits: u32| f32::from(half::f16::from_bits(bits as u16));
        return Some(vector(&[half(*bits), half(*bits >> 16)]));
    }
    let a = floats(known.first()?)?;
    if name == "packHalf2x16" {
        let [low, high] = a[..] else { return None };
        let bits = |value: f32| u32::from(half::f16::from_f32(value).to_bits());
        return Some([Number::Uint(bits(low) | bits(high) << 16)].into());
    }
    let b = known.get(1).and_then(|numbers| floats(numbers));
    let c = known.get(2).and_then(|numbers| floats(numbers));
    Some(match (name, b, c) {
        ("length", None, None) => vector(&[dot(&a, &a).sqrt()]),
        ("normalize", None, None) => vector(&scale(&a, 1.0 / dot(&a, &a).sqrt())),
        ("determinant", None, None) => vector(&[determinant(&a)?]),
        ("dot", Some(b), None) => vector(&[dot(&a, &b)]),
        ("distance", Some(b), None) => {
            let between = add(&a, &scale(&b, -1.0));
            vector(&[dot(&between, &between).sqrt()])
        }
        ("cross", Some(b), None) => vector(&cross(&a, &b)?),
        ("reflect", Some(b), None) => vector(&add(&a, &scale(&b, -2.0 * dot(&b, &a)))),
        ("faceforward", Some(b), Some(c)) => {
            vector(&scale(&a, if dot(&c, &b) < 0.0 { 1.0 } else { -1.0 }))
        }
        ("refract", Some(b), Some(eta)) => vector(&refract(&a, &b, *eta.first()?)),
        _ => return None,
    })
}

fn vector(values: &[f32]) -> Known {
    values.iter().map(|value| Number::Float(*value)).collect()
}

fn dot(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn scale(a: &[f32], factor: f32) -> Vec<f32> {
    a.iter().map(|a| a * factor).collect()
}

fn add(a: &[f32], b: &[f32]) -> Vec<f32> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}

fn cross(a: &[f32], b: &[f32]) -> Option<[f32; 3]> {
    let ([a, b, c], [x, y, z]) = (a.first_chunk()?, b.first_chunk()?);
    Some([b * z - c * y, c * x - a * z, a * y - b * x])
}

fn refract(i: &[f32], n: &[f32], eta: f32) -> Vec<f32> {
    let d = dot(n, i);
    let k = 1.0 - eta * eta * (1.0 - d * d);
    if k < 0.0 {
        return vec![0.0; i.len()];
    }
    add(&scale(i, eta), &scale(n, -(eta * d + k.sqrt())))
}

/// The determinant by the first column: a matrix has its columns one after the other.
fn determinant(m: &[f32]) -> Option<f32> {
    let size = match m.len() {
        1 => return m.first().copied(),
        4 => 2,
        9 => 3,
        16 => 4,
        _ => return None,
    };
    let mut sum = 0.0;
    for row in 0..size {
        let is_rest = |index: &usize| index / size > 0 && index % size != row;
        let rest: Vec<f32> = (0..m.len()).filter(is_rest).map(|index| m[index]).collect();
        let sign = if row % 2 == 0 { 1.0 } else { -1.0 };
        sum += sign * m[row] * determinant(&rest)?;
    }
    Some(sum)
}

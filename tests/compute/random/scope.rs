//! What a place in a random program can name.

use super::types::{Scalar, Struct, Ty};
use crate::random::Random;

/// Something with a name: a variable, a constant, or a path to a part of a buffer.
#[derive(Debug, Clone)]
pub struct Named {
    pub path: String,
    pub ty: Ty,
    pub is_mutable: bool,
    /// Whether it is known before the shader runs. What is computed from such values alone must
    /// not overflow.
    pub is_constant: bool,
    /// The variable of the function that it is, or that it points to.
    pub root: Option<String>,
}

/// A function that is complete.
#[derive(Debug, Clone)]
pub struct Signature {
    pub name: String,
    pub parameters: Vec<Parameter>,
    pub result: Ty,
}

#[derive(Debug, Clone)]
pub enum Parameter {
    Value(Ty),
    /// A pointer to a variable of the function.
    Pointer(Ty),
    /// A pointer that is only read, so that another one may lead to the same variable.
    Shared(Ty),
    /// This text.
    Place(&'static str),
}

impl Named {
    pub fn new(path: impl Into<String>, ty: Ty, is_mutable: bool) -> Self {
        Self { path: path.into(), ty, is_mutable, is_constant: false, root: None }
    }

    pub fn constant(path: impl Into<String>, ty: Ty) -> Self {
        Self { is_constant: true, ..Self::new(path, ty, false) }
    }

    /// A variable of the function, or what a pointer to one leads to.
    pub fn variable(path: impl Into<String>, ty: Ty, root: impl Into<String>) -> Self {
        Self { root: Some(root.into()), ..Self::new(path, ty, true) }
    }

    /// Adds the paths to parts of a type. An index that is not constant comes from `index`, a
    /// number without a sign.
    pub fn parts(
        &self,
        wanted: &Ty,
        structs: &[Struct],
        index: &str,
        random: &mut Random,
        to: &mut Vec<String>,
    ) {
        parts(&self.path, &self.ty, wanted, (structs, index), random, to);
    }
}

fn parts(
    path: &str,
    ty: &Ty,
    wanted: &Ty,
    names: (&[Struct], &str),
    random: &mut Random,
    to: &mut Vec<String>,
) {
    if ty == wanted {
        to.push(path.to_owned());
    }
    let index = |count: u32, random: &mut Random| match random.below(3) {
        0 => format!("{}", random.below(count as usize)),
        1 => format!("min({}, {}u)", names.1, count - 1),
        _ => format!("{} % {count}u", names.1),
    };
    match ty {
        Ty::Vector(size, scalar) if *wanted == Ty::Scalar(*scalar) => {
            let part = match random.chance(50) {
                true => format!(".{}", ["x", "y", "z", "w"][random.below(*size as usize)]),
                false => format!("[{}]", index(*size, random)),
            };
            to.push(format!("{path}{part}"));
        }
        Ty::Matrix(columns, rows) => {
            let column = format!("{path}[{}]", index(*columns, random));
            let of = Ty::Vector(*rows, Scalar::Float);
            parts(&column, &of, wanted, names, random, to);
        }
        Ty::Array(of, count) => {
            let element = format!("{path}[{}]", index(*count, random));
            parts(&element, of, wanted, names, random, to);
        }
        Ty::Struct(index) => {
            for member in &names.0[*index].members {
                let path = format!("{path}.{}", member.name);
                parts(&path, &member.ty, wanted, names, random, to);
            }
        }
        _ => {}
    }
}
